//! The stiffness of a solid over a grid's wavevectors, as a formula or as a table.

use super::half_space::HalfSpace;

/// Stiffness at each wavevector for a contact modulus of 1.
#[derive(Clone, Debug, PartialEq)]
pub enum Stiffness {
    /// The periodic half-space, by its formula.
    HalfSpace(HalfSpace),
    /// One value for each wavevector: `[nx/2 + 1, ny/2 + 1]`, the column (x) index running slowest.
    Table(Vec<f64>),
}

impl Stiffness {
    /// Stiffness of the zero wavevector: 0 on a periodic grid, whose mean displacement is
    /// undetermined.
    pub fn zero_mode(&self) -> f64 {
        match self {
            Stiffness::HalfSpace(_) => 0.0,
            Stiffness::Table(values) => values[0],
        }
    }

    /// The largest stiffness; 1 without any wave.
    pub fn largest(&self) -> f64 {
        let largest = match self {
            Stiffness::HalfSpace(half_space) => half_space.largest(),
            Stiffness::Table(values) => values.iter().copied().fold(0.0, f64::max),
        };
        if largest > 0.0 { largest } else { 1.0 }
    }

    /// The least stiffness of a nonzero wavevector; 1 without any wave.
    pub fn least(&self) -> f64 {
        let least = match self {
            Stiffness::HalfSpace(half_space) => half_space.least(),
            Stiffness::Table(values) => values[1..].iter().copied().fold(f64::INFINITY, f64::min),
        };
        if least.is_finite() { least } else { 1.0 }
    }
}
