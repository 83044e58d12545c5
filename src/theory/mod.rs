//! Closed forms and asperity models that the full field is judged by.
//!
//! One file a theory, each of plain functions with their source. SI units unless a name or its
//! comment says *reduced*; then [`tabor_map`] says what the unit is. Force, pressure and approach
//! are positive in compression; a cohesive traction is positive where it attracts, and a work of
//! adhesion is positive. What lies outside a theory's range comes back as a [`TheoryError`].
//!
//! | question | file |
//! |---|---|
//! | which theory holds, and in what units | [`tabor_map`], [`laws`] |
//! | one sphere, hard | [`hertz`], [`cone_punch`] |
//! | one sphere, rigid and adhesive | [`bradley`], [`derjaguin`], [`dmt`] |
//! | one sphere, soft and adhesive | [`jkr`], [`maugis_dugdale`], [`lennard_jones_sphere`], [`rate`] |
//! | what else a sphere does | [`capillary`], [`friction`], [`conductance`], [`viscoelastic`] |
//! | a wave | [`westergaard`], [`cohesive_wave`] |
//! | a rough surface by its summits | [`gw`], [`gw_m`], [`fuller_tabor`], [`icha`] |
//! | a rough surface by its spectrum | [`spectrum`], [`persson`], [`persson_gap`], [`bam`], [`pastewka_robbins`] |
//! | the elastic body itself | [`love`], [`kernel_eigenvalue`], [`layer`] |

mod block_solve;
pub mod error;
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
