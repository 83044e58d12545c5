//! Attraction outside an undisturbed Hertz contact: Derjaguin, Muller & Toporov 1975, Muller,
//! Yushchenko & Derjaguin 1983, Maugis 1992.
//!
//! Lennard-Jones units (see [`super::tabor_map`]): contact radius in `sqrt(R range)`, approach in
//! the range, force in `2 pi w R`. The attraction then depends on the contact radius only; the
//! Tabor parameter weighs it against Hertz.

use super::error::{TheoryError, not_negative, positive};
use super::hertz::reduced_gap;
use super::laws::Law;
use super::quadrature::{integrate, integrate_to_infinity};
use super::roots::{minimum, positive_root};
use std::f64::consts::PI;

/// `i0 = (4/3) (B(-1/2, 7/2) - B(-1/2, 19/2))` of the Lennard-Jones law, which determines how the
/// attraction of the force method increases from point contact.
#[doc(hidden)]
pub const POINT_CONTACT_INTEGRAL: f64 = 6.130_170_723_587_996;

/// How the attraction outside the contact is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Method {
    /// The derivative of the energy at fixed profile (DMT-T; with Lennard-Jones IDMT-T).
    Thermodynamic,
    /// The sum of the traction (DMT-F).
    Force,
    /// `2 pi w R` at every contact radius (DMT-M, Maugis 1992).
    Constant,
}

/// Hertz force at an `approach` of zero or more: `(2/(3 pi)) (approach/tabor_parameter)^(3/2)`.
pub(crate) fn hertz_force(approach: f64, tabor_parameter: f64) -> Result<f64, TheoryError> {
    let ratio = not_negative("approach", approach)? / positive("tabor_parameter", tabor_parameter)?;
    Ok(2.0 / (3.0 * PI) * ratio.powf(1.5))
}

/// Attraction at a `contact_radius`, positive.
pub fn attraction(method: Method, law: Law, contact_radius: f64) -> Result<f64, TheoryError> {
    let a = not_negative("contact_radius", contact_radius)?;
    match method {
        Method::Constant => Ok(1.0),
        // Both start from the traction of the undeformed sphere, whose integral is 1.
        _ if a == 0.0 => Ok(1.0),
        Method::Force => outside(law, a, |_, gap| law.traction(gap)),
        // 4 int sigma acos(a/r) r dr, and acos(a/r) = atan(x/a).
        Method::Thermodynamic => outside(law, a, |x, gap| {
            2.0 / PI * law.traction(gap) * (x / a).atan()
        }),
    }
}

/// Energy gained by the contact and its surroundings, in `2 pi w R range`, positive.
///
/// Its derivative with the approach is the thermodynamic attraction. There is no further `pi w R`:
/// the moving edge compensates for the gain of the contact area.
#[doc(hidden)]
pub fn energy_gain(law: Law, contact_radius: f64) -> Result<f64, TheoryError> {
    let a = not_negative("contact_radius", contact_radius)?;
    Ok(0.5 * a * a + outside(law, a, |_, gap| -law.energy(gap))?)
}

/// Force at an `approach`: Hertz less the attraction; at a negative approach, that of the rigid
/// sphere at the gap `-approach`.
pub fn force(
    method: Method,
    law: Law,
    approach: f64,
    tabor_parameter: f64,
) -> Result<f64, TheoryError> {
    positive("tabor_parameter", tabor_parameter)?;
    if approach < 0.0 {
        return Ok(super::bradley::reduced_force(law, -approach));
    }
    Ok(hertz_force(approach, tabor_parameter)? - attraction(method, law, approach.sqrt())?)
}

/// Contact radius and force of the greatest tension in contact.
///
/// For the force method with Lennard-Jones this is at point contact, -1, up to
/// [`super::tabor_map::FORCE_DMT_LIMIT`]; beyond, it is at a finite radius with a tension above `2
/// pi w R`, which no real sphere reaches.
pub fn pull_off(method: Method, law: Law, tabor_parameter: f64) -> Result<(f64, f64), TheoryError> {
    positive("tabor_parameter", tabor_parameter)?;
    let at = |a: f64| force(method, law, a * a, tabor_parameter).unwrap_or(f64::INFINITY);
    let (radius, least) = minimum(at, 0.0, 2.0 + 3.0 * tabor_parameter);
    let touching = at(0.0);
    Ok(if least < touching {
        (radius, least)
    } else {
        (0.0, touching)
    })
}

/// `lim attraction/radius^(2/3)` of the force method with Lennard-Jones far from point contact.
///
/// Near the edge the gap is `(8 sqrt2/(3 pi)) sqrt(a) (r-a)^(3/2)`; the rest is a beta function.
#[doc(hidden)]
pub fn force_method_large_radius() -> f64 {
    use super::special::beta;
    let edge = (3.0 * PI / (8.0 * 2.0_f64.sqrt())).cbrt().powi(2);
    edge * 16.0 / 9.0 * (beta(2.0 / 3.0, 7.0 / 3.0) - beta(2.0 / 3.0, 25.0 / 3.0))
}

/// `lim (attraction - 1)/radius^3` of the force method with Lennard-Jones at point contact.
#[doc(hidden)]
pub fn force_method_small_radius() -> f64 {
    2.0 * 2.0_f64.sqrt() / (3.0 * PI) * POINT_CONTACT_INTEGRAL
}

/// `int_a^inf value(x, gap) r dr` with `x^2 = r^2 - a^2`, so that `r dr = x dx`.
fn outside(law: Law, a: f64, value: impl Fn(f64, f64) -> f64) -> Result<f64, TheoryError> {
    let gap = |x: f64| {
        if a == 0.0 {
            0.5 * x * x
        } else {
            a * a * reduced_gap(x / a)
        }
    };
    let integrand = |x: f64| x * value(x, gap(x));
    // Where the gap is about one range, at point contact and for a large radius.
    let scale = 1.0 + a.cbrt();
    if law == Law::Dugdale {
        let rim = positive_root("the cohesive rim", |x| gap(x) - 1.0, scale)?;
        integrate(integrand, 0.0, rim, 1e-12, 0.0)
    } else {
        integrate_to_infinity(integrand, 0.0, scale, 1e-12, 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::theory::tabor_map::FORCE_DMT_LIMIT;

    #[test]
    fn thermodynamic_attraction_is_the_slope_of_the_energy() {
        for law in Law::ALL {
            let (approach, step) = (0.8, 1e-4);
            let gain = |delta: f64| energy_gain(law, delta.sqrt()).unwrap();
            let slope = (gain(approach + step) - gain(approach - step)) / (2.0 * step);
            let pull = attraction(Method::Thermodynamic, law, approach.sqrt()).unwrap();
            assert!((slope - pull).abs() < 1e-7, "{law:?}: {slope} {pull}");
        }
    }

    #[test]
    fn thermodynamic_attraction_falls_from_one_to_a_half() {
        for law in Law::ALL {
            let at = |a| attraction(Method::Thermodynamic, law, a).unwrap();
            assert!((at(1e-4) - 1.0).abs() < 1e-3);
            assert!((at(100.0) - 0.5).abs() < 3e-2);
            assert!(at(0.1) > at(0.5) && at(0.5) > at(3.0));
        }
    }

    #[test]
    fn force_method_leaves_point_contact_at_its_limit() {
        let radius = |mu| pull_off(Method::Force, Law::LennardJones, mu).unwrap().0;
        assert!(radius(0.98 * FORCE_DMT_LIMIT) < 1e-6);
        assert!(radius(1.02 * FORCE_DMT_LIMIT) > 1e-3);
        let large = attraction(Method::Force, Law::LennardJones, 1e4).unwrap();
        assert!((large / 1e4_f64.powf(2.0 / 3.0) / force_method_large_radius() - 1.0).abs() < 1e-3);
    }
}
