//! Reduced attraction of two facing surfaces: gap in units of the range, energy in w, traction in
//! w/range, slope in w/range^2.
//!
//! The energy is -1 at gap 0 and 0 far away. The traction, its derivative with the gap, is positive
//! in attraction. The hard wall at gap 0 is not part of the law.

/// How the attraction decreases with the gap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Law {
    /// Lennard-Jones 9-3, gap measured from zero traction; repulsive at gaps in (-1, 0).
    ///
    /// Muller, Yushchenko & Derjaguin 1983; Greenwood 1997.
    LennardJones,
    /// Only its attractive part: energy `-1/(1 + gap)^2`. Derjaguin, Muller & Toporov 1975.
    Cubic,
    /// Energy `-exp(-gap)`.
    Exponential,
    /// Traction 1 up to gap 1, then 0. Maugis 1992, after Dugdale 1960.
    Dugdale,
}

impl Law {
    /// Every law.
    #[doc(hidden)]
    pub const ALL: [Law; 4] = [
        Law::LennardJones,
        Law::Cubic,
        Law::Exponential,
        Law::Dugdale,
    ];

    /// Energy per area, in w; not positive at gaps of zero or more.
    pub fn energy(self, gap: f64) -> f64 {
        match self {
            Law::LennardJones => {
                let s2 = (1.0 + gap).powi(-2);
                -s2 * (4.0 - s2.powi(3)) / 3.0
            }
            Law::Cubic => -(1.0 + gap).powi(-2),
            Law::Exponential => -(-gap).exp(),
            Law::Dugdale => (gap - 1.0).min(0.0),
        }
    }

    /// Traction, in w/range; positive attracts.
    pub fn traction(self, gap: f64) -> f64 {
        match self {
            Law::LennardJones => {
                // 1 - (1 + gap)^(-6), without cancellation near zero traction.
                let rest = -(-6.0 * gap.ln_1p()).exp_m1();
                8.0 / 3.0 * (1.0 + gap).powi(-3) * rest
            }
            Law::Cubic => 2.0 * (1.0 + gap).powi(-3),
            Law::Exponential => (-gap).exp(),
            Law::Dugdale => f64::from(gap <= 1.0),
        }
    }

    /// Derivative of the traction with the gap, in w/range^2; 0 on either side of Dugdale's step.
    pub fn slope(self, gap: f64) -> f64 {
        match self {
            Law::LennardJones => {
                let s4 = (1.0 + gap).powi(-4);
                8.0 / 3.0 * s4 * (9.0 * (1.0 + gap).powi(-6) - 3.0)
            }
            Law::Cubic => -6.0 * (1.0 + gap).powi(-4),
            Law::Exponential => -(-gap).exp(),
            Law::Dugdale => 0.0,
        }
    }

    /// Greatest traction at gaps of zero or more, in w/range.
    pub fn peak_tension(self) -> f64 {
        match self {
            Law::LennardJones => 16.0 / (9.0 * 3.0_f64.sqrt()),
            Law::Cubic => 2.0,
            Law::Exponential | Law::Dugdale => 1.0,
        }
    }

    /// Gap of the greatest traction, in units of the range.
    #[doc(hidden)]
    pub fn peak_gap(self) -> f64 {
        match self {
            Law::LennardJones => 3.0_f64.powf(1.0 / 6.0) - 1.0,
            Law::Cubic | Law::Exponential | Law::Dugdale => 0.0,
        }
    }

    /// Gap at which the traction decreases fastest, and its slope there, which limits the mesh
    /// size.
    #[doc(hidden)]
    pub fn steepest(self) -> (f64, f64) {
        let gap = match self {
            Law::LennardJones => 7.5_f64.powf(1.0 / 6.0) - 1.0,
            Law::Cubic | Law::Exponential => 0.0,
            Law::Dugdale => return (1.0, f64::NEG_INFINITY),
        };
        (gap, self.slope(gap))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::theory::quadrature::{integrate, integrate_to_infinity};

    #[test]
    fn traction_is_the_slope_of_the_energy_and_integrates_to_one() {
        for law in Law::ALL {
            assert!((law.energy(0.0) + 1.0).abs() < 1e-15, "{law:?}");
            let near = integrate(|u| law.traction(u), 0.0, 1.0, 1e-12, 0.0).unwrap();
            let far =
                integrate_to_infinity(|u| law.traction(u), 1.0 + 1e-12, 1.0, 1e-12, 1e-14).unwrap();
            assert!((near + far - 1.0).abs() < 1e-11, "{law:?}");
            for gap in [0.1, 0.5, 0.9, 1.5, 4.0] {
                let step = 1e-5;
                let traction = (law.energy(gap + step) - law.energy(gap - step)) / (2.0 * step);
                let slope = (law.traction(gap + step) - law.traction(gap - step)) / (2.0 * step);
                assert!((traction - law.traction(gap)).abs() < 1e-8, "{law:?} {gap}");
                assert!((slope - law.slope(gap)).abs() < 1e-7, "{law:?} {gap}");
            }
            let peak = law.traction(law.peak_gap());
            assert!((peak - law.peak_tension()).abs() < 1e-14, "{law:?}");
        }
    }
}
