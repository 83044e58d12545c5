//! Contact modulus, range parameters, reduced units, and the range of each theory.
//!
//! Two sets of reduced units are in use. *Maugis units*, with `K = 4 E*/3`: radius
//! `a* = (pi w R^2/K)^(1/3)`, force `pi w R`, approach `a*^2/R`. *Lennard-Jones units*: heights in
//! the range of the law, radii in `sqrt(R range)`, traction in `w/range`, force in `2 pi w R`.

use super::error::{TheoryError, between, finite, not_negative, positive, within};
use std::f64::consts::PI;

/// Approach in Lennard-Jones units over `tabor_parameter` times approach in Maugis units,
/// `(9 pi^2/16)^(1/3)`.
pub(crate) const LJ_PER_MAUGIS_APPROACH: f64 = 1.770_682_754_000_227;

/// Maugis' lambda over Tabor's mu for a Dugdale law with the work and the peak tension of a
/// Lennard-Jones law, `2 (16/(9 sqrt 3)) (9/(16 pi))^(1/3)` (Johnson & Greenwood 1997).
#[doc(hidden)]
pub const LAMBDA_PER_MU_MATCHED: f64 = 1.157_011_634_850_799_5;

/// Tabor parameter below which the pull-off of the DMT force method is at point contact, so that
/// its magnitude is correct: `(sqrt2 i0)^(-2/3)`, `i0 = (4/3)(B(-1/2, 7/2) - B(-1/2, 19/2))`.
///
/// The 0.24 of Pashley 1984 and Greenwood 2007.
#[doc(hidden)]
pub const FORCE_DMT_LIMIT: f64 = 0.236_959_952_979_233_6;

/// Tabor parameter above which the pull-off agrees with JKR within 2 %.
pub(crate) const JKR_LIMIT: f64 = 5.0;

/// A paraboloid `r^2/(2 radius)` against a half-space, with or without adhesion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    radius: f64,
    contact_modulus: f64,
    work_of_adhesion: f64,
}

impl Sphere {
    /// Checks and stores `radius` (m), `contact_modulus` (Pa) and `work_of_adhesion` (J/m^2, 0
    /// without adhesion).
    pub fn new(
        radius: f64,
        contact_modulus: f64,
        work_of_adhesion: f64,
    ) -> Result<Self, TheoryError> {
        Ok(Sphere {
            radius: positive("radius", radius)?,
            contact_modulus: positive("contact_modulus", contact_modulus)?,
            work_of_adhesion: not_negative("work_of_adhesion", work_of_adhesion)?,
        })
    }

    /// Radius of curvature R at the apex, m.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Contact modulus E*, Pa.
    pub fn contact_modulus(&self) -> f64 {
        self.contact_modulus
    }

    /// Work of adhesion w, J/m^2.
    pub fn work_of_adhesion(&self) -> f64 {
        self.work_of_adhesion
    }

    /// Maugis' modulus `K = 4 E*/3`, Pa.
    pub fn maugis_modulus(&self) -> f64 {
        4.0 * self.contact_modulus / 3.0
    }

    /// Maugis' units of this sphere, used by the JKR and Maugis-Dugdale files.
    pub fn maugis_scales(&self) -> Result<MaugisScales, TheoryError> {
        positive("work_of_adhesion", self.work_of_adhesion)?;
        let force = PI * self.work_of_adhesion * self.radius;
        let radius = (force * self.radius / self.maugis_modulus()).cbrt();
        Ok(MaugisScales {
            radius,
            force,
            approach: radius * radius / self.radius,
        })
    }
}

/// Units in which JKR has no parameter and Maugis-Dugdale one (Maugis 1992).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct MaugisScales {
    /// `a* = (pi w R^2/K)^(1/3)`, m.
    pub radius: f64,
    /// `pi w R`, N.
    pub force: f64,
    /// `a*^2/R`, m.
    pub approach: f64,
}

impl MaugisScales {
    /// Unit of stiffness `force/approach = K a*`, N/m.
    pub fn stiffness(&self) -> f64 {
        self.force / self.approach
    }
}

/// Contact modulus of two elastic bodies, `1/E* = (1-nu1^2)/E1 + (1-nu2^2)/E2`, Pa.
///
/// Each body is (Young's modulus in Pa, Poisson's ratio); an infinite modulus is a rigid body.
/// Johnson 1985.
pub fn contact_modulus(first: (f64, f64), second: (f64, f64)) -> Result<f64, TheoryError> {
    let mut compliance = 0.0;
    for (young_modulus, poisson_ratio) in [first, second] {
        within(
            "young_modulus",
            young_modulus,
            young_modulus > 0.0,
            "greater than zero",
        )?;
        between!(poisson_ratio in -1.0..=0.5, "between -1 and 0.5")?;
        compliance += (1.0 - poisson_ratio * poisson_ratio) / young_modulus;
    }
    positive("contact modulus of the pair", 1.0 / compliance)
}

/// Dupre's work of adhesion `gamma1 + gamma2 - gamma12`, J/m^2; twice the surface energy for a
/// single material.
pub fn work_of_adhesion(
    surface_energies: [f64; 2],
    interface_energy: f64,
) -> Result<f64, TheoryError> {
    not_negative(
        "surface energies less interface energy",
        surface_energies[0] + surface_energies[1] - finite("interface_energy", interface_energy)?,
    )
}

/// Tabor's parameter `mu = (R w^2/(E*^2 range^3))^(1/3)`, where `range` (m) is the equilibrium
/// distance of a Lennard-Jones or cubic law. Tabor 1977.
pub fn tabor_parameter(sphere: &Sphere, range: f64) -> Result<f64, TheoryError> {
    let range = positive("range", range)?;
    let opening = sphere.work_of_adhesion / (sphere.contact_modulus * range);
    Ok((sphere.radius / range * opening * opening).cbrt())
}

/// Maugis' parameter `lambda = 2 sigma0 (R/(pi w K^2))^(1/3)` of a Dugdale law with the tension
/// `peak_tension` (Pa). Maugis 1992.
pub fn maugis_parameter(sphere: &Sphere, peak_tension: f64) -> Result<f64, TheoryError> {
    positive("work_of_adhesion", sphere.work_of_adhesion)?;
    let peak_tension = not_negative("peak_tension", peak_tension)?;
    let modulus = sphere.maugis_modulus();
    Ok(2.0
        * peak_tension
        * (sphere.radius / (PI * sphere.work_of_adhesion * modulus * modulus)).cbrt())
}

/// Approach in units of the range, from Maugis units.
#[doc(hidden)]
pub fn lj_from_maugis_approach(approach: f64, tabor_parameter: f64) -> f64 {
    LJ_PER_MAUGIS_APPROACH * tabor_parameter * approach
}

/// Approach in Maugis units, from units of the range.
#[doc(hidden)]
pub fn maugis_from_lj_approach(approach: f64, tabor_parameter: f64) -> f64 {
    approach / (LJ_PER_MAUGIS_APPROACH * tabor_parameter)
}

/// The valid theory of a sphere at a Tabor parameter (Johnson & Greenwood 1997).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Regime {
    /// Stiff, small, long-ranged: Hertz profile with the attraction summed outside it
    /// ([`super::dmt`]).
    ForceDmt,
    /// Intermediate: [`super::maugis_dugdale`], or the full field.
    Intermediate,
    /// Soft, large, short-ranged: [`super::jkr`].
    Jkr,
}

/// The regime of `tabor_parameter`.
pub fn regime(tabor_parameter: f64) -> Result<Regime, TheoryError> {
    let tabor_parameter = positive("tabor_parameter", tabor_parameter)?;
    Ok(if tabor_parameter < FORCE_DMT_LIMIT {
        Regime::ForceDmt
    } else if tabor_parameter < JKR_LIMIT {
        Regime::Intermediate
    } else {
        Regime::Jkr
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::theory::special::beta;

    #[test]
    fn constants_follow_from_their_formulas() {
        let close = |got: f64, formula: f64| assert!((got / formula - 1.0).abs() < 1e-14);
        close(LJ_PER_MAUGIS_APPROACH, (9.0 * PI * PI / 16.0).cbrt());
        let peak = 16.0 / (9.0 * 3.0_f64.sqrt());
        close(
            LAMBDA_PER_MU_MATCHED,
            2.0 * peak * (9.0 / (16.0 * PI)).cbrt(),
        );
        let i0 = 4.0 / 3.0 * (beta(-0.5, 3.5) - beta(-0.5, 9.5));
        close(FORCE_DMT_LIMIT, (2.0_f64.sqrt() * i0).powf(-2.0 / 3.0));
    }

    #[test]
    fn bad_input_is_named() {
        let error = Sphere::new(-1.0, 1e9, 0.05).unwrap_err();
        assert_eq!(
            error.to_string(),
            "radius = -1e0 is out of range: it must be positive and finite"
        );
        assert!(contact_modulus((f64::INFINITY, 0.3), (f64::INFINITY, 0.3)).is_err());
        assert!(contact_modulus((f64::INFINITY, 0.3), (1e9, 0.3)).is_ok());
        assert!(regime(f64::NAN).is_err());
    }
}
