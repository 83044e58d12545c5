//! The exponential law: tension `(w/rho) exp(-gap/rho)` in front of a hard wall.

use super::Cohesion;
use crate::real::Real;

/// Tension that falls by e over each `range`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exponential<T> {
    /// Work of adhesion w.
    pub work_of_adhesion: T,
    /// Decay length rho.
    pub range: T,
}

/// Ranges of a closing step beyond which its exponential may be past single precision. The gap it starts
/// from then has next to no tension that could cancel.
const MOST_RANGES: f64 = 80.0;

impl Exponential<f64> {
    /// The same constants in the kernel's number.
    pub fn cast<T: Real>(self) -> Exponential<T> {
        Exponential {
            work_of_adhesion: T::from_double(self.work_of_adhesion),
            range: T::from_double(self.range),
        }
    }
}

impl<T: Real> Cohesion<T> for Exponential<T> {
    #[inline(always)]
    fn traction(&self, gap: T) -> T {
        self.work_of_adhesion / self.range * (-gap / self.range).exp()
    }

    #[inline(always)]
    fn difference(&self, gap: T, step: T) -> T {
        let ranges = -step / self.range;
        if ranges > T::from_double(MOST_RANGES) {
            return self.traction(gap + step) - self.traction(gap);
        }
        self.traction(gap) * ranges.exp_m1()
    }

    #[inline(always)]
    fn energy(&self, gap: T) -> T {
        -self.work_of_adhesion * (-gap / self.range).exp()
    }

    #[inline(always)]
    fn slope(&self, gap: T) -> T {
        -self.traction(gap) / self.range
    }
}
