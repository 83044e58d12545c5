//! A law as the correction of a known state feels it.
//!
//! Where a solution is kept in double precision and iterations run in single, the unknown is the
//! correction c of an outer gap g, and the pressure starts at the residual y(g) of the outer state. What the law
//! adds to it is `sigma(g + c) - sigma(g)`, a difference that is taken without cancellation, so that
//! single precision is relative to c and not to g.

use super::{Cohesion, LawField};
use crate::real::Real;

/// A law at one point around an outer state.
#[derive(Clone, Copy, Debug)]
pub struct Correction<L, T> {
    /// The law.
    pub law: L,
    /// Factor on its tension.
    pub factor: T,
    /// Gap of the outer state.
    pub gap: T,
}

/// A law around an outer state that differs from point to point.
#[derive(Clone, Copy, Debug)]
pub struct CorrectedField<L>(pub L);

impl<T: Real, L: Cohesion<T>> LawField<T> for CorrectedField<L> {
    type Here = Correction<L, T>;
    #[inline(always)]
    fn here(&self, factor: T, gap: T) -> Correction<L, T> {
        Correction {
            law: self.0,
            factor,
            gap,
        }
    }
}

impl<T: Real, L: Cohesion<T>> Cohesion<T> for Correction<L, T> {
    #[inline(always)]
    fn traction(&self, correction: T) -> T {
        self.factor * self.law.difference(self.gap, correction)
    }

    /// None to first order in the correction: the outer state's traction is part of the pressure.
    #[inline(always)]
    fn energy(&self, _correction: T) -> T {
        T::zero()
    }

    #[inline(always)]
    fn slope(&self, correction: T) -> T {
        self.factor * self.law.slope(self.gap + correction)
    }

    #[inline(always)]
    fn difference(&self, correction: T, step: T) -> T {
        self.factor * self.law.difference(self.gap + correction, step)
    }

    #[inline(always)]
    fn change(&self, correction: T, step: T) -> T {
        self.difference(correction, step)
    }

    /// The first order exactly, and the rest by Simpson's rule over the step, which is short beside
    /// the range of a law.
    #[inline(always)]
    fn energy_change(&self, correction: T, step: T) -> [T; 2] {
        let first = step * self.traction(correction);
        let middle = self.difference(correction, T::from_double(0.5) * step);
        let rest = step / T::from_double(6.0)
            * (T::from_double(4.0) * middle + self.difference(correction, step));
        [first + rest, first.abs()]
    }

    #[inline(always)]
    fn open(&self, correction: T) -> T {
        self.gap + correction
    }

    #[inline(always)]
    fn closed_gap(&self) -> T {
        -self.gap
    }

    #[inline(always)]
    fn corrects(&self) -> bool {
        true
    }

    /// The scale is the outer state's.
    #[inline(always)]
    fn weighed(&self, _pressure: T) -> T {
        T::zero()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::{Exponential, LennardJones, MaugisDugdale};

    /// Largest error of `difference` in single precision over the traction's own slope times the
    /// step, against plain subtraction in double, for steps down to 1e-9 of the range.
    fn worst(single: impl Cohesion<f32>, double: impl Cohesion<f64>) -> f64 {
        let mut worst = 0.0f64;
        for gap in [0.013f32, 0.11, 0.27, 0.395, 0.47, 0.55, 0.62, 0.81, 1.37] {
            for step in [1e-3f32, -1e-3, 1e-6, -1e-6, 1e-9, -1e-9] {
                let (g, s) = (f64::from(gap), f64::from(step));
                // Of steps below its rounding the double subtraction knows no more than the slope.
                let exact = if s.abs() < 1e-7 {
                    double.slope(g) * s
                } else {
                    double.traction(g + s) - double.traction(g)
                };
                let error = (f64::from(single.difference(gap, step)) - exact).abs();
                let scale = double.slope(g).abs().max(1e-3) * s.abs();
                worst = worst.max(error / scale);
            }
        }
        worst
    }

    #[test]
    fn differences_keep_their_digits() {
        let exponential = Exponential {
            work_of_adhesion: 0.3,
            range: 0.2,
        };
        let lennard_jones = LennardJones {
            work_of_adhesion: 0.3,
            range: 0.4,
        };
        let dugdale = MaugisDugdale {
            peak_tension: 0.5,
            range: 0.5,
            taper: 0.3,
        };
        // Rounding of r^9 and of exp, some 1e-6, and not that over the relative step.
        assert!(worst(exponential.cast::<f32>(), exponential) < 1e-5);
        assert!(worst(lennard_jones.cast::<f32>(), lennard_jones) < 2e-5);
        assert!(worst(dugdale.cast::<f32>(), dugdale) < 1e-5);
    }

    #[test]
    fn a_step_from_far_away_gains_a_number() {
        let law = Exponential {
            work_of_adhesion: 1e-6,
            range: 1e-6,
        };
        // exp(1e6) overflows in every precision.
        assert_eq!(law.difference(1.0, -1.0), 1.0);
        assert_eq!(law.cast::<f32>().difference(1.0, -1.0), 1.0);
        // On either side of where the one form hands over to the other.
        for ranges in [79.9, 80.1] {
            let gained = law.difference(100e-6, -ranges * 1e-6);
            let exact = (ranges - 100.0f64).exp();
            assert!((gained - exact).abs() <= 1e-12 * exact, "{gained} {exact}");
        }
    }

    #[test]
    fn a_taper_is_left_at_both_ends() {
        let law = MaugisDugdale {
            peak_tension: 2.0,
            range: 1.0,
            taper: 0.5,
        };
        for gap in [0.5, 0.74, 0.76, 1.0, 1.24, 1.26, 1.5] {
            for step in [-1.0, -0.3, -0.02, 0.02, 0.3, 1.0] {
                let exact: f64 = law.traction(gap + step) - law.traction(gap);
                assert!(
                    (law.difference(gap, step) - exact).abs() < 1e-14,
                    "{gap} {step}"
                );
            }
        }
    }
}
