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

impl<T: Real> Exponential<T> {
    /// Ranges that a length takes, by their inverse, which is the same at all points.
    #[inline(always)]
    fn ranges(&self, length: T) -> T {
        length * (T::one() / self.range)
    }

    /// The tension at zero gap.
    #[inline(always)]
    fn peak(&self) -> T {
        self.work_of_adhesion / self.range
    }
}

impl<T: Real> Cohesion<T> for Exponential<T> {
    #[inline(always)]
    fn traction(&self, gap: T) -> T {
        let [decay, _] = self.ranges(-gap).exponentials();
        self.peak() * decay
    }

    #[inline(always)]
    fn difference(&self, gap: T, step: T) -> T {
        let ranges = self.ranges(-step);
        let far = ranges > T::from_double(MOST_RANGES);
        // One exponential for either way, so that several points go side by side.
        let argument = if far {
            self.ranges(-(gap + step))
        } else {
            ranges
        };
        let [growth, gain] = argument.exponentials();
        let here = self.traction(gap);
        if far {
            self.peak() * growth - here
        } else {
            here * gain
        }
    }

    #[inline(always)]
    fn energy(&self, gap: T) -> T {
        let [decay, _] = self.ranges(-gap).exponentials();
        -self.work_of_adhesion * decay
    }

    #[inline(always)]
    fn slope(&self, gap: T) -> T {
        self.ranges(-self.traction(gap))
    }
}
