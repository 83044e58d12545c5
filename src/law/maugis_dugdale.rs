//! The Maugis-Dugdale law: a constant tension up to a range (Maugis 1992), with an optional taper.

use super::Cohesion;
use crate::real::Real;

/// Tension `peak_tension` up to about `range`, falling linearly to zero over the width `taper`
/// centred on the range, so that the work of adhesion is `peak_tension * range` for every taper.
///
/// The sharp law (`taper = 0`) traps the edge of a contact between pixels; a taper of some pixels'
/// worth of elastic opening frees it. Surfaces that approach feel it `taper/2` before the range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaugisDugdale<T> {
    /// Constant tension.
    pub peak_tension: T,
    /// Work of adhesion over peak tension.
    pub range: T,
    /// Width of the linear end, at most twice the range; 0 for the sharp law.
    pub taper: T,
}

impl MaugisDugdale<f64> {
    /// No tension at any gap.
    pub const NOTHING: Self = MaugisDugdale {
        peak_tension: 0.0,
        range: 0.0,
        taper: 0.0,
    };

    /// The same constants in the kernel's number.
    #[inline]
    pub fn cast<T: Real>(self) -> MaugisDugdale<T> {
        MaugisDugdale {
            peak_tension: T::from_double(self.peak_tension),
            range: T::from_double(self.range),
            taper: T::from_double(self.taper),
        }
    }
}

impl<T: Real> MaugisDugdale<T> {
    /// Share of the taper that a length takes, by its inverse, which is the same at all points.
    #[inline(always)]
    fn of_taper(&self, length: T) -> T {
        length * (T::one() / self.taper)
    }

    /// Share of the taper that is left beyond a gap: above 1 before it, negative behind it.
    #[inline(always)]
    fn left(&self, gap: T) -> T {
        self.of_taper(self.range - gap) + T::from_double(0.5)
    }
}

impl<T: Real> Cohesion<T> for MaugisDugdale<T> {
    #[inline(always)]
    fn traction(&self, gap: T) -> T {
        if self.taper > T::zero() {
            self.peak_tension * self.left(gap).most(T::zero()).least(T::one())
        } else if gap < self.range {
            self.peak_tension
        } else {
            T::zero()
        }
    }

    #[inline(always)]
    fn difference(&self, gap: T, step: T) -> T {
        if self.taper <= T::zero() {
            return self.traction(gap + step) - self.traction(gap);
        }
        let (zero, one) = (T::zero(), T::one());
        let (left, moved) = (self.left(gap), self.of_taper(step));
        // Only the part of the way that lies on the taper counts.
        let lost = if left > one {
            (moved - (left - one)).most(zero).least(one)
        } else if left < zero {
            -(left - moved).most(zero).least(one)
        } else {
            moved.most(left - one).least(left)
        };
        -self.peak_tension * lost
    }

    #[inline(always)]
    fn energy(&self, gap: T) -> T {
        let half = T::from_double(0.5) * self.taper;
        if gap <= self.range - half {
            -self.peak_tension * (self.range - gap)
        } else if gap < self.range + half {
            let left = self.range + half - gap;
            -self.peak_tension * left * left / (T::from_double(2.0) * self.taper)
        } else {
            T::zero()
        }
    }

    #[inline(always)]
    fn slope(&self, gap: T) -> T {
        let half = T::from_double(0.5) * self.taper;
        if gap > self.range - half && gap < self.range + half {
            -self.peak_tension / self.taper
        } else {
            T::zero()
        }
    }
}
