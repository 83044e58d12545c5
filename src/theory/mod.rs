//! Closed forms and asperity models to compare the full field with.
//!
//! One file a theory, each with plain functions and their source. SI units unless a name or its
//! comment says *reduced*; [`tabor_map`] defines the reduced units. Force, pressure and approach
//! are positive in compression; a cohesive traction is positive in attraction, and a work of
//! adhesion is positive. Outside its range a theory returns a [`TheoryError`].
//!
//! | subject | file |
//! |---|---|
//! | range of each theory, units, laws | [`tabor_map`], [`laws`] |
//! | sphere, no adhesion | [`hertz`], [`cone_punch`] |
//! | rigid adhesive sphere | [`bradley`], [`derjaguin`], [`dmt`] |
//! | soft adhesive sphere | [`jkr`], [`maugis_dugdale`], [`lennard_jones_sphere`], [`rate`] |
//! | other effects on a sphere | [`capillary`], [`friction`], [`conductance`], [`viscoelastic`] |
//! | wave | [`westergaard`], [`cohesive_wave`] |
//! | rough surface by its summits | [`gw`], [`gw_m`], [`fuller_tabor`], [`icha`] |
//! | rough surface by its spectrum | [`spectrum`], [`persson`], [`persson_gap`], [`bam`],
//! [`pastewka_robbins`] |
//! | the elastic body | [`love`], [`kernel_eigenvalue`], [`layer`] |

mod block_solve;
pub(crate) mod error;
#[doc(hidden)]
pub mod quadrature;
mod ring;
#[doc(hidden)]
pub mod roots;
#[doc(hidden)]
pub mod special;

pub mod laws;
pub mod tabor_map;

pub mod bam;
pub mod bradley;
pub mod capillary;
pub mod cohesive_wave;
pub mod conductance;
pub mod cone_punch;
pub mod derjaguin;
pub mod dmt;
pub mod friction;
pub mod fuller_tabor;
pub mod gw;
pub mod gw_m;
pub mod hertz;
pub mod icha;
pub mod jkr;
#[doc(hidden)]
pub mod kernel_eigenvalue;
pub mod layer;
mod lennard_jones_curve;
pub mod lennard_jones_sphere;
pub mod love;
pub mod maugis_dugdale;
pub mod pastewka_robbins;
pub mod persson;
pub mod persson_gap;
pub mod rate;
pub mod spectrum;
pub mod viscoelastic;
pub mod westergaard;

pub use error::TheoryError;
pub use laws::Law;
pub use spectrum::Spectrum;
pub use tabor_map::Sphere;
