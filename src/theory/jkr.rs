//! Soft sphere with adhesion of zero range: Johnson, Kendall & Roberts 1971.
//!
//! The first functions are reduced (Maugis units, see [`super::tabor_map`]); those that take a
//! [`Sphere`] are SI. The theory holds for Tabor parameters above about 5.

use super::error::{TheoryError, finite, positive, within};
use super::hertz;
use super::tabor_map::Sphere;
use std::f64::consts::PI;

/// Reduced load at which the sphere jumps off under load control.
pub(crate) const PULL_OFF_FORCE: f64 = -1.5;

/// Reduced force at a reduced contact radius: `A^3 - sqrt(6 A^3)`.
#[doc(hidden)]
pub fn reduced_force(radius: f64) -> f64 {
    let cube = radius.powi(3);
    cube - (6.0 * cube).sqrt()
}

/// Reduced approach at a reduced contact radius: `A^2 - (2/3) sqrt(6 A)`.
#[doc(hidden)]
pub fn reduced_approach(radius: f64) -> f64 {
    radius * radius - 2.0 / 3.0 * (6.0 * radius).sqrt()
}

/// Reduced slope of force against approach along the equilibria, in `K a*`.
///
/// `(9/2) A (1-x)/(3-x)` with `x = (A_c/A)^(3/2)`: 0 at [`pull_off`], infinite at [`grip`].
#[doc(hidden)]
pub fn reduced_stiffness(radius: f64) -> f64 {
    let x = (1.5 / radius.powi(3)).sqrt();
    4.5 * radius * (1.0 - x) / (3.0 - x)
}

/// Reduced contact radius at pull-off under load control: `1.5^(1/3)`.
pub fn pull_off() -> f64 {
    1.5_f64.cbrt()
}

/// Reduced contact radius at pull-off under displacement control (fixed grips), the least approach:
/// `6^(-1/3)`.
#[doc(hidden)]
pub fn grip() -> f64 {
    6.0_f64.cbrt().recip()
}

/// Reduced contact radius at zero load: `6^(1/3)`.
pub fn zero_load() -> f64 {
    6.0_f64.cbrt()
}

/// Reduced contact radius at zero approach: `(8/3)^(1/3)`.
pub fn zero_approach() -> f64 {
    (8.0_f64 / 3.0).cbrt()
}

/// Stable reduced contact radius at a reduced approach, at or above that of [`grip`].
#[doc(hidden)]
pub fn reduced_radius_at_approach(approach: f64) -> Result<f64, TheoryError> {
    let least = reduced_approach(grip());
    within(
        "approach",
        approach,
        approach >= least && approach.is_finite(),
        "no less than that of the grip limit, -0.9086 in Maugis units",
    )?;
    // With sqrt(A) = s + x, of which s is that of the fold, where the slope is 0: approach - least = x^2 (6 s^2 + 4 s x + x^2).
    // All terms are positive, so that the root is below that of each alone, and Newton's method comes down to it.
    let (s, beyond) = (grip().sqrt(), approach - least);
    let [square, cube] = [6.0 * s * s, 4.0 * s];
    let mut x = (beyond / square).sqrt().min(beyond.sqrt().sqrt());
    loop {
        let excess = x * x * (square + x * (cube + x)) - beyond;
        let step = excess / (x * (2.0 * square + x * (3.0 * cube + 4.0 * x)));
        // At the fold, and where rounding is left.
        if step.is_nan() || step <= 2.0 * f64::EPSILON * x {
            return Ok((s + x).powi(2));
        }
        x -= step;
    }
}

/// Contact radius under `force` (N), at or above the pull-off force, m; the stable one.
pub fn contact_radius(sphere: &Sphere, force: f64) -> Result<f64, TheoryError> {
    let tension = PI * sphere.work_of_adhesion() * sphere.radius();
    within(
        "force",
        force,
        force.is_finite() && force >= -1.5 * tension * (1.0 + 1e-14),
        "no less than the pull-off force, -1.5 pi w R",
    )?;
    // (sqrt(F + 1.5 pi w R) + sqrt(1.5 pi w R))^2: no difference of large numbers.
    let sum = (force + 1.5 * tension).max(0.0).sqrt() + (1.5 * tension).sqrt();
    Ok((0.75 * sphere.radius() / sphere.contact_modulus() * sum * sum).cbrt())
}

/// Stable contact radius at `approach` (m), m.
pub fn contact_radius_at_approach(sphere: &Sphere, approach: f64) -> Result<f64, TheoryError> {
    if sphere.work_of_adhesion() == 0.0 {
        return hertz::contact_radius_at_approach(sphere, approach);
    }
    let scales = sphere.maugis_scales()?;
    let reduced = approach / scales.approach;
    within(
        "approach",
        approach,
        approach.is_finite() && reduced >= reduced_approach(grip()),
        "no less than that of the grip limit, -3/4 (pi^2 w^2 R/E*^2)^(1/3)",
    )?;
    Ok(scales.radius * reduced_radius_at_approach(reduced)?)
}

/// Approach of the equilibrium with a contact radius, m: `a^2/R - sqrt(2 pi a w/E*)`.
pub fn approach(sphere: &Sphere, contact_radius: f64) -> f64 {
    hertz::approach(sphere, contact_radius) - opening(sphere, contact_radius)
}

/// Force of the equilibrium with a contact radius, N: `F_Hertz - sqrt(8 pi a^3 w E*)`.
pub fn force(sphere: &Sphere, contact_radius: f64) -> f64 {
    hertz::force(sphere, contact_radius)
        - hertz::stiffness(sphere, contact_radius) * opening(sphere, contact_radius)
}

/// Displacement of a flat punch of the contact radius away from the surface at equilibrium, m.
fn opening(sphere: &Sphere, contact_radius: f64) -> f64 {
    (2.0 * PI * contact_radius * sphere.work_of_adhesion() / sphere.contact_modulus()).sqrt()
}

/// Pressure at distance `r` from the axis, Pa: a Hertz contact less a flat punch; minus infinity
/// at the edge, 0 outside.
pub fn pressure(sphere: &Sphere, contact_radius: f64, r: f64) -> f64 {
    let a = contact_radius;
    let inside = (a - r) * (a + r) / (a * a);
    if inside < 0.0 {
        return 0.0;
    }
    let edge = (2.0 * sphere.work_of_adhesion() * sphere.contact_modulus() / (PI * a)).sqrt();
    hertz::pressure(sphere, a, r) - edge / inside.sqrt()
}

/// Gap outside the contact, m: the Hertz gap and `(2/pi) sqrt(2 pi a w/E*) acos(a/r)`.
pub fn gap(sphere: &Sphere, contact_radius: f64, r: f64) -> f64 {
    let edge = (contact_radius / r.abs()).min(1.0).acos();
    hertz::gap(sphere, contact_radius, r) + 2.0 / PI * opening(sphere, contact_radius) * edge
}

/// Stiffness along the equilibria, N/m; for a contact radius that does not follow (fast
/// oscillation) take [`hertz::stiffness`].
pub fn stiffness(sphere: &Sphere, contact_radius: f64) -> f64 {
    let radius = sphere.radius();
    let critical =
        9.0 * PI / 8.0 * sphere.work_of_adhesion() * radius * radius / sphere.contact_modulus();
    let x = (critical / contact_radius.powi(3)).sqrt();
    6.0 * sphere.contact_modulus() * contact_radius * (1.0 - x) / (3.0 - x)
}

/// Force at pull-off under load control, N (negative): `-1.5 pi w R`.
pub fn pull_off_force(sphere: &Sphere) -> f64 {
    PULL_OFF_FORCE * PI * sphere.work_of_adhesion() * sphere.radius()
}

/// Work of adhesion (J/m^2) and contact modulus (Pa) of a sphere of `radius` (m), from the
/// magnitude `pull_off` (N) of its pull-off force and the slope `stiffness` (N/m) of force against
/// approach, measured along equilibria at `force` (N).
///
/// Derived from the equations above. If the contact radius did not follow an oscillation, the
/// stiffness is `2 E* a` and this inversion does not apply.
pub fn from_measurement(
    radius: f64,
    pull_off: f64,
    force: f64,
    stiffness: f64,
) -> Result<Sphere, TheoryError> {
    let radius = positive("radius", radius)?;
    let pull_off = positive("pull_off", pull_off)?;
    let stiffness = positive("stiffness", stiffness)?;
    within(
        "force",
        finite("force", force)?,
        force > -pull_off,
        "more than minus the pull-off force",
    )?;
    let s = (1.0 + force / pull_off).sqrt();
    // a^3 E* follows from force and pull-off alone; the stiffness then separates E* from a.
    let cube_times_modulus = 0.75 * radius * pull_off * (1.0 + s) * (1.0 + s);
    let root = stiffness * (3.0 * s + 2.0) / (6.0 * s);
    Sphere::new(
        radius,
        root.powf(1.5) / cube_times_modulus.sqrt(),
        2.0 * pull_off / (3.0 * PI * radius),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_radius_is_found_from_its_approach() {
        let fold = reduced_approach(grip());
        assert!((reduced_radius_at_approach(fold).unwrap() / grip() - 1.0).abs() < 1e-15);
        for exponent in -14..=100 {
            let beyond = 10_f64.powi(exponent);
            let radius = reduced_radius_at_approach(fold + beyond).unwrap();
            let found = reduced_approach(radius);
            let rounding = 8.0 * f64::EPSILON * (fold + beyond).abs().max(1.0);
            assert!(
                (found - (fold + beyond)).abs() <= rounding,
                "{beyond:e}: {found:e}"
            );
            assert!(radius > grip());
        }
    }

    #[test]
    fn equilibrium_releases_the_work_of_adhesion() {
        let sphere = Sphere::new(1e-3, 1e6, 0.05).unwrap();
        for load in [-2e-4, 0.0, 3e-4] {
            let a = contact_radius(&sphere, load).unwrap();
            let delta = approach(&sphere, a);
            // Energy released per area as the edge recedes, E* (a^2/R - delta)^2/(2 pi a).
            let retreat = hertz::approach(&sphere, a) - delta;
            let released = sphere.contact_modulus() * retreat * retreat / (2.0 * PI * a);
            assert!((released / 0.05 - 1.0).abs() < 1e-12);
            // The load at any radius and approach, 2 E* (a delta - a^3/(3R)).
            let carried =
                2.0 * sphere.contact_modulus() * (a * delta - a.powi(3) / (3.0 * sphere.radius()));
            assert!((carried - load).abs() < 1e-17);
            assert!((force(&sphere, a) - load).abs() < 1e-17);
            assert!((contact_radius_at_approach(&sphere, delta).unwrap() / a - 1.0).abs() < 1e-13);
            let step = 1e-6 * a;
            let slope = (force(&sphere, a + step) - force(&sphere, a - step))
                / (approach(&sphere, a + step) - approach(&sphere, a - step));
            assert!((stiffness(&sphere, a) / slope - 1.0).abs() < 1e-7);
        }
        assert!(contact_radius(&sphere, -2.4e-4).is_err());
    }

    #[test]
    fn an_approach_beyond_the_grip_is_refused_in_its_own_units() {
        let (radius, modulus, work) = (1e-3, 1e6, 0.05);
        let sphere = Sphere::new(radius, modulus, work).unwrap();
        // As the message says it.
        let least = -0.75 * (PI * PI * work * work * radius / (modulus * modulus)).cbrt();
        assert!(contact_radius_at_approach(&sphere, least * (1.0 - 1e-12)).is_ok());
        let beyond = least * (1.0 + 1e-12);
        let error = contact_radius_at_approach(&sphere, beyond).unwrap_err();
        assert!(
            error.to_string().contains(&format!("{beyond:e}")),
            "{error}"
        );
    }
}
