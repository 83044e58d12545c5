//! An elastic layer on a rigid base: its compliance relative to the half-space, wave by wave.
//!
//! `displacement = (2/(E* q)) M(q h) pressure` for a layer of thickness h, with `E* = E/(1 - nu^2)`.

/// Boundary condition at the rigid base.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Base {
    /// No displacement.
    Bonded,
    /// No normal displacement, no friction.
    Frictionless,
}

impl Base {
    /// Every base.
    pub const ALL: &[Base] = &[Base::Bonded, Base::Frictionless];

    /// The word used in scenes.
    pub fn name(self) -> &'static str {
        match self {
            Base::Bonded => "bonded",
            Base::Frictionless => "frictionless",
        }
    }
}

/// An elastic layer on a rigid base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layer {
    /// Thickness h, m.
    pub thickness: f64,
    /// Poisson ratio, above -1 and at most 1/2.
    pub poisson_ratio: f64,
    /// Boundary condition at the base.
    pub base: Base,
}

/// Below this `q h` the bonded layer's numerator is summed as a series: `sinh 2k - 2k` cancels.
const SERIES: f64 = 0.1;
/// Below this `q h` the frictionless layer's compliance is its limit `k/2` to rounding.
const LINEAR: f64 = 1e-6;

/// `M(k)` of a layer that is bonded to its base, `k = q h > 0`:
/// `((3-4nu) sinh 2k - 2k)/((3-4nu) cosh 2k + 2k^2 + 5 - 12nu + 8nu^2)`.
///
/// 1 for a thick layer; for a thin incompressible one it falls with `(2/3) k^3`.
///
/// # Source
/// Plane strain of a bonded layer, Johnson 1985, sec. 5.8; checked against a boundary solve.
pub fn bonded_compliance(k: f64, poisson_ratio: f64) -> f64 {
    let factor = 3.0 - 4.0 * poisson_ratio;
    let constant = 2.0 * k * k + 5.0 - 12.0 * poisson_ratio + 8.0 * poisson_ratio * poisson_ratio;
    if k < SERIES {
        let x = 2.0 * k;
        let cubic =
            x.powi(3) / 6.0 * (1.0 + x * x / 20.0 * (1.0 + x * x / 42.0 * (1.0 + x * x / 72.0)));
        return (factor * cubic + (factor - 1.0) * x) / (factor * x.cosh() + constant);
    }
    // Both sides times 2 exp(-2k), so that a thick layer does not overflow.
    let fade = (-2.0 * k).exp();
    let numerator = factor * (1.0 - fade * fade) - 4.0 * k * fade;
    let denominator = factor * (1.0 + fade * fade) + 2.0 * constant * fade;
    // constant grows with k^2 and fade falls faster; past overflow of k^2 the limit is exact.
    if denominator.is_finite() {
        numerator / denominator
    } else {
        1.0
    }
}

/// `M(k)` of a layer that slides on its base without friction, `k = q h > 0`:
/// `(cosh 2k - 1)/(sinh 2k + 2k)`.
///
/// # Source
/// Johnson 1985, sec. 5.8.
pub fn frictionless_compliance(k: f64) -> f64 {
    if k < LINEAR {
        return 0.5 * k;
    }
    // cosh 2k - 1 = 2 sinh^2 k; both sides times 2 exp(-2k).
    let fade = (-2.0 * k).exp();
    let shortfall = -(-2.0 * k).exp_m1();
    let rest = if fade > 0.0 { 4.0 * k * fade } else { 0.0 };
    shortfall * shortfall / (-(-4.0 * k).exp_m1() + rest)
}

impl Layer {
    /// Compliance over that of the half-space at a wave number (1/m, above 0): between 0 and 1.
    pub fn compliance(&self, wavenumber: f64) -> f64 {
        let k = wavenumber * self.thickness;
        match self.base {
            Base::Bonded => bonded_compliance(k, self.poisson_ratio),
            Base::Frictionless => frictionless_compliance(k),
        }
    }

    /// Displacement under a uniform unit pressure for a contact modulus of 1, m: `h (1 - 2 nu)/(1 -
    /// nu)^2`, which is `p h (1+nu)(1-2nu)/(E (1-nu))`.
    ///
    /// The cell cannot widen, whatever the base, so an incompressible layer does not deform at all.
    pub fn uniform_compliance(&self) -> f64 {
        let nu = self.poisson_ratio;
        self.thickness * (1.0 - 2.0 * nu) / ((1.0 - nu) * (1.0 - nu))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of a plane-strain boundary solve (k, nu, bonded, frictionless).
    #[test]
    fn values_of_an_independent_solve() {
        for (k, nu, bonded, frictionless) in [
            (0.5, 0.3, 0.206642486, 0.249669151),
            (1.0, 0.5, 0.240581681, 0.490894654),
            (3.0, 0.45, 0.903463358, 0.966311613),
        ] {
            assert!((bonded_compliance(k, nu) - bonded).abs() < 1e-9);
            assert!((frictionless_compliance(k) - frictionless).abs() < 1e-9);
        }
    }

    #[test]
    fn thin_and_thick_limits() {
        let k = 1e-3;
        // The next term of the incompressible series is of relative order k^2.
        assert!((bonded_compliance(k, 0.5) / (2.0 / 3.0 * k.powi(3)) - 1.0).abs() < 1e-5);
        assert!((frictionless_compliance(k) / (0.5 * k) - 1.0).abs() < 1e-5);
        for thick in [1e3, 1e200, f64::MAX] {
            assert_eq!(bonded_compliance(thick, 0.3), 1.0);
            assert_eq!(frictionless_compliance(thick), 1.0);
        }
        for nu in [0.0, 0.3, 0.5] {
            let jump = bonded_compliance(SERIES, nu) / bonded_compliance(SERIES - 1e-12, nu) - 1.0;
            assert!(jump.abs() < 1e-9, "{nu}: {jump:e}");
        }
        let jump =
            frictionless_compliance(LINEAR) / frictionless_compliance(LINEAR * (1.0 - 1e-12));
        assert!((jump - 1.0).abs() < 1e-9);
    }

    /// The bonded layer tends to its uniform compliance for long waves: `2 M/q`.
    #[test]
    fn long_waves_see_the_uniform_compliance() {
        for nu in [-0.4, 0.0, 0.3, 0.45] {
            let layer = Layer {
                thickness: 2.0,
                poisson_ratio: nu,
                base: Base::Bonded,
            };
            let q = 1e-6;
            let long = 2.0 / q * layer.compliance(q);
            assert!(
                (long / layer.uniform_compliance() - 1.0).abs() < 1e-6,
                "{nu}"
            );
        }
    }
}
