//! Stiffness of the half-space or of a layer: one real factor for each wavevector.
//!
//! All values are for a contact modulus of 1 and in units of one reduced length: the stiffness of a
//! wave is the pressure amplitude for a displacement amplitude of 1.

mod half_space;
mod layer;
mod layered;
mod love;
mod stiffness;

pub use half_space::{HalfSpace, periodic_stiffness, wave_stiffness};
pub use layer::{Base, Layer, bonded_compliance, frictionless_compliance};
pub use layered::LayeredSpace;
pub use love::{FreeKernel, free_stiffness, love_displacement};
pub use stiffness::{Stiffness, StiffnessTable};
