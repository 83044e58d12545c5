//! The Lennard-Jones 9-3 surface law (Muller, Yushchenko & Derjaguin 1983; Greenwood 1997).
//!
//! `sigma = (8 w / 3 eps) (r^3 - r^9)` with `r = eps / (gap + eps)`: the gap is measured from the
//! distance of zero force and may be negative, where the law repels like a steep spring.

use super::Cohesion;
use crate::real::Real;

/// The 9-3 law; its own repulsion takes the place of the wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LennardJones<T> {
    /// Work of adhesion w from the zero-force distance.
    pub work_of_adhesion: T,
    /// Zero-force distance eps between the surfaces' own planes.
    pub range: T,
}

/// Smallest distance over `range` at which the powers are evaluated: nearer, r^9 would overflow
/// what any load can balance, and the law is constant.
const NEAREST: f64 = 0.02;
/// Pressure in units of `8 w / 3 eps` that the law reaches nowhere.
const MOST_PRESSURE: f64 = 1e18;
/// Newton's steps to the ninth root after the first, which is the mean of the eighth root, eight times, and 1. They leave
/// it too large by 2e-4 at 1e4 of these units, by 0.2 % at 1e6.
const ROOT_STEPS: usize = 2;

impl LennardJones<f64> {
    /// The same constants in the kernel's number.
    pub fn cast<T: Real>(self) -> LennardJones<T> {
        LennardJones {
            work_of_adhesion: T::from_double(self.work_of_adhesion),
            range: T::from_double(self.range),
        }
    }

    /// Largest tension, `16 w / (9 sqrt(3) eps)`.
    pub fn peak_tension(&self) -> f64 {
        16.0 / (9.0 * 3f64.sqrt()) * self.work_of_adhesion / self.range
    }

    /// The same law with its traction multiplied by a factor.
    pub fn times(&self, factor: f64) -> Self {
        LennardJones {
            work_of_adhesion: factor * self.work_of_adhesion,
            ..*self
        }
    }

    /// Gap down to which the law is the 9-3 law; no state lies below.
    pub fn least_gap(&self) -> f64 {
        (NEAREST - 1.0) * self.range
    }

    /// Gap at which the tension is largest, `(3^(1/6) - 1) eps`.
    pub fn peak_gap(&self) -> f64 {
        (3f64.powf(1.0 / 6.0) - 1.0) * self.range
    }
}

/// `r^9` from which the law repels by at least a pressure, in units of `8 w / 3 eps`, from the repulsive power
/// alone: `1.3 P + 2.5` leaves P after r^3.
#[inline(always)]
fn ninth_power<T: Real>(load: T) -> T {
    T::from_double(1.3) * load + T::from_double(2.5)
}

impl LennardJones<f64> {
    /// A gap, just below that of zero force or deeper, at which the law repels by at least this pressure, and by
    /// no more than a third beyond it.
    pub fn repelling(&self, pressure: f64) -> f64 {
        let load = (pressure * (3.0 / 8.0) * self.range / self.work_of_adhesion).max(0.0);
        self.range * (ninth_power(load).powf(-1.0 / 9.0) - 1.0)
    }
}

impl<T: Real> LennardJones<T> {
    /// eps over the distance.
    #[inline(always)]
    fn ratio(&self, gap: T) -> T {
        self.range / (gap + self.range).most(T::from_double(NEAREST) * self.range)
    }

    /// `8 w / 3 eps`.
    #[inline(always)]
    fn scale(&self) -> T {
        T::from_double(8.0 / 3.0) * self.work_of_adhesion / self.range
    }
}

impl<T: Real> Cohesion<T> for LennardJones<T> {
    #[inline(always)]
    fn traction(&self, gap: T) -> T {
        let r = self.ratio(gap);
        let cube = r * r * r;
        self.scale() * (cube - cube * cube * cube)
    }

    #[inline(always)]
    fn difference(&self, gap: T, step: T) -> T {
        let distance = gap + self.range;
        let nearest = T::from_double(NEAREST) * self.range;
        // By how much r^3 and r^9 grow, as shares of themselves.
        let x = step / distance;
        let (one, three) = (T::one(), T::from_double(3.0));
        let cubes = (one + x) * (one + x) * (one + x);
        let third = -x * (three + x * (three + x)) / cubes;
        let ninth = third * (three + third * (three + third));
        let r = self.ratio(gap);
        let cube = r * r * r;
        let gained = self.scale() * (cube * third - cube * cube * cube * ninth);
        // Both are made, and one is chosen, so that several points go side by side.
        let subtracted = self.traction(gap + step) - self.traction(gap);
        if (distance <= nearest) | (distance + step <= nearest) {
            subtracted
        } else {
            gained
        }
    }

    /// As `repelling`, by Newton's method for the ninth root from the eighth, so that several points
    /// go side by side. Each step leaves the root too large, and the gap below.
    #[inline(always)]
    fn repelling_gap(&self, pressure: T) -> T {
        let load = pressure * T::from_double(3.0 / 8.0) * self.range / self.work_of_adhesion;
        let load = load.most(T::zero()).least(T::from_double(MOST_PRESSURE));
        let power = ninth_power(load);
        let nearer = |r: T, rest: T| (T::from_double(8.0) * r + rest) * T::from_double(1.0 / 9.0);
        let mut r = nearer(power.sqrt().sqrt().sqrt(), T::one());
        for _ in 0..ROOT_STEPS {
            let fourth = r * r * r * r;
            r = nearer(r, power / (fourth * fourth));
        }
        self.range * (T::one() / r - T::one())
    }

    #[inline(always)]
    fn energy(&self, gap: T) -> T {
        let r = self.ratio(gap);
        let square = r * r;
        let eighth = square * square * square * square;
        -self.work_of_adhesion
            * (T::from_double(4.0 / 3.0) * square - T::from_double(1.0 / 3.0) * eighth)
    }

    #[inline(always)]
    fn slope(&self, gap: T) -> T {
        let r = self.ratio(gap);
        let fourth = r * r * r * r;
        let tenth = fourth * fourth * r * r;
        T::from_double(8.0 / 3.0) * self.work_of_adhesion / (self.range * self.range)
            * (T::from_double(9.0) * tenth - T::from_double(3.0) * fourth)
    }

    #[inline(always)]
    fn bend(&self, gap: T) -> T {
        let r = self.ratio(gap);
        let square = r * r;
        let fifth = square * square * r;
        self.scale() / (self.range * self.range)
            * fifth
            * (T::from_double(12.0) - T::from_double(90.0) * (square * square * square))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of the reduced law at half and twice the range, computed apart from this code.
    #[test]
    fn known_values() {
        let law = LennardJones {
            work_of_adhesion: 1.0,
            range: 1.0,
        };
        for (gap, energy, traction, slope, bend) in [
            (0.0_f64, -1.0_f64, 0.0_f64, 16.0_f64, -208.0_f64),
            (0.5, -0.579586445, 0.720757337, -1.1640502, 1.4393470),
            (2.0, -0.148097343, 0.0986299514, -0.09835899, 0.1303324),
        ] {
            assert!((law.energy(gap) - energy).abs() < 1e-9);
            assert!((law.traction(gap) - traction).abs() < 1e-9);
            assert!((law.slope(gap) - slope).abs() < 1e-7);
            assert!((law.bend(gap) - bend).abs() < 1e-6);
        }
        assert!((law.peak_tension() - 1.02640048).abs() < 1e-8);
        assert!((law.peak_gap() - 0.200936955).abs() < 1e-9);
        assert!(law.slope(law.peak_gap()).abs() < 1e-12);
    }
}
