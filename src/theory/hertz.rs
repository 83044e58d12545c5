//! Sphere on a half-space without adhesion: Hertz 1882, in the notation of Johnson 1985.

use super::error::{TheoryError, not_negative};
use super::tabor_map::Sphere;
use std::f64::consts::PI;

/// Contact radius under a compressive `force` (N), m: `a^3 = 3 R F/(4 E*)`.
pub fn contact_radius(sphere: &Sphere, force: f64) -> Result<f64, TheoryError> {
    let force = not_negative("force", force)?;
    Ok((0.75 * sphere.radius() * force / sphere.contact_modulus()).cbrt())
}

/// Contact radius at an `approach` (m, zero or more), m: `a^2 = R delta`.
pub fn contact_radius_at_approach(sphere: &Sphere, approach: f64) -> Result<f64, TheoryError> {
    Ok((sphere.radius() * not_negative("approach", approach)?).sqrt())
}

/// Approach at a contact radius, m: `delta = a^2/R`.
pub fn approach(sphere: &Sphere, contact_radius: f64) -> f64 {
    contact_radius * contact_radius / sphere.radius()
}

/// Force at a contact radius, N: `F = (4/3) E* a^3/R`.
pub fn force(sphere: &Sphere, contact_radius: f64) -> f64 {
    4.0 / 3.0 * sphere.contact_modulus() * contact_radius.powi(3) / sphere.radius()
}

/// Stiffness `dF/d delta = 2 E* a`, N/m.
pub fn stiffness(sphere: &Sphere, contact_radius: f64) -> f64 {
    2.0 * sphere.contact_modulus() * contact_radius
}

/// Pressure at distance `r` from the axis, Pa: `(2E*/(pi R)) sqrt(a^2 - r^2)`, 0 outside.
pub fn pressure(sphere: &Sphere, contact_radius: f64, r: f64) -> f64 {
    let inside = (contact_radius * contact_radius - r * r).max(0.0);
    2.0 * sphere.contact_modulus() / (PI * sphere.radius()) * inside.sqrt()
}

/// Displacement of the surface at distance `r` from the axis, positive into the body, m.
pub fn displacement(sphere: &Sphere, contact_radius: f64, r: f64) -> f64 {
    displacement_of(sphere.radius(), contact_radius, r.abs())
}

/// a/r below which four terms of the displacement's series leave an error of 1e-14.
const FAR: f64 = 0.03;

/// Displacement `U(r; a, R)` around a Hertz contact; independent of the modulus.
pub(crate) fn displacement_of(radius: f64, contact_radius: f64, r: f64) -> f64 {
    let a = contact_radius;
    if r <= a {
        (a * a - 0.5 * r * r) / radius
    } else {
        let ratio = a / r;
        if ratio < FAR {
            // The two terms below cancel far away; this is their difference, in powers of a/r.
            let square = ratio * ratio;
            let series =
                4.0 / 3.0 + square * (2.0 / 15.0 + square * (3.0 / 70.0 + square * (5.0 / 252.0)));
            return a * a * ratio * series / (PI * radius);
        }
        ((2.0 * a * a - r * r) * ratio.asin() + a * ((r - a) * (r + a)).sqrt()) / (PI * radius)
    }
}

/// Gap outside the contact, m: `(a^2/(pi R)) (t - atan t + t^2 atan t)`, `t^2 = r^2/a^2 - 1`.
///
/// This form of Johnson 1985 eq. 3.42a does not cancel at the edge. 0 inside the contact; for a
/// point contact the undeformed `r^2/(2R)`.
pub fn gap(sphere: &Sphere, contact_radius: f64, r: f64) -> f64 {
    let (a, r) = (contact_radius, r.abs());
    if r <= a {
        0.0
    } else if a == 0.0 {
        0.5 * r * r / sphere.radius()
    } else {
        a * a / sphere.radius() * reduced_gap(((r - a) * (r + a)).sqrt() / a)
    }
}

/// Gap in units of `a^2/R`, of `t = sqrt(r^2/a^2 - 1)`.
pub(crate) fn reduced_gap(t: f64) -> f64 {
    if t < 0.05 {
        // t - atan t + t^2 atan t = sum (-1)^(n-1) 4n/(4n^2-1) t^(2n+1).
        let square = t * t;
        let mut power = t * square;
        let mut sum = 0.0;
        for n in 1..8 {
            let n = f64::from(n);
            sum += power * 4.0 * n / (4.0 * n * n - 1.0);
            power *= -square;
        }
        sum / PI
    } else {
        (t + (t * t - 1.0) * t.atan()) / PI
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn displacement_far_away_is_that_of_a_point_force() {
        let (near, far) = (0.3 / (FAR + 1e-9), 0.3 / (FAR - 1e-9));
        let at = |r: f64| displacement_of(2.0, 0.3, r);
        // The displacement falls as 1/r, by 7e-8 between these two.
        assert!((at(near) * near / (at(far) * far) - 1.0).abs() < 1e-10);
        // F/(pi E* r) with F = (4/3) E* a^3/R.
        let point = 4.0 / 3.0 * 0.3_f64.powi(3) / 2.0 / (PI * 3e5);
        assert!((at(3e5) / point - 1.0).abs() < 1e-11);
    }

    #[test]
    fn gap_is_shape_less_displacement() {
        let sphere = Sphere::new(2.0, 3.0, 0.0).unwrap();
        let a = 0.3;
        for r in [0.301, 0.303, 0.31, 0.5, 3.0] {
            let left = 0.5 * r * r / 2.0 - approach(&sphere, a) + displacement(&sphere, a, r);
            assert!((gap(&sphere, a, r) - left).abs() < 1e-15 * (1.0 + r * r));
            let step = 1e-6;
            let at = |delta: f64| gap(&sphere, (2.0 * delta).sqrt(), r);
            let delta = approach(&sphere, a);
            let rate = (at(delta + step) - at(delta - step)) / (2.0 * step);
            // -(2/pi) acos(a/r) outside, 0 inside.
            let expected = -2.0 / PI * (a / r).min(1.0).acos();
            assert!((rate - expected).abs() < 1e-4);
        }
    }
}
