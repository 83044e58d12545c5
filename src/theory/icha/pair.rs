//! Displacement by one Hertz contact at the place of another, and its derivative.

use std::f64::consts::PI;

/// Distance over contact radius beyond which the multipole series of the Hertz pressure is used.
const FAR: f64 = 8.0;

/// `U(r; a, R)` and `dU/d delta = (2/pi) asin(min(1, a/r))` at `distance` r.
///
/// Not symmetric: inside the circle of the contact the displaced surface is its paraboloid. Far
/// away four multipoles of `p ~ sqrt(a^2 - r^2)` are accurate to 1e-9 of U and need no arcsine.
pub(super) fn pair(contact_radius: f64, radius: f64, distance: f64) -> (f64, f64) {
    let a = contact_radius;
    if distance <= a {
        return ((a * a - 0.5 * distance * distance) / radius, 1.0);
    }
    let ratio = a / distance;
    if distance > FAR * a {
        let x = ratio * ratio;
        let point = 4.0 / (3.0 * PI) * a * a / radius * ratio;
        let displacement = point * (1.0 + x * (1.0 / 10.0 + x * (9.0 / 280.0 + x * (5.0 / 336.0))));
        let slope = ratio * (1.0 + x * (1.0 / 6.0 + x * (3.0 / 40.0 + x * (5.0 / 112.0))));
        return (displacement, 2.0 / PI * slope);
    }
    let angle = ratio.asin();
    let edge = a * ((distance - a) * (distance + a)).sqrt();
    let displacement = ((2.0 * a * a - distance * distance) * angle + edge) / (PI * radius);
    (displacement, 2.0 / PI * angle)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::theory::hertz::displacement_of;

    #[test]
    fn the_far_series_meets_the_closed_form() {
        for distance in [0.5, 0.999, 1.0, 1.5, 7.9, 8.001, 9.0, 20.0] {
            let (found, slope) = pair(1.0, 3.0, distance);
            let closed = displacement_of(3.0, 1.0, distance);
            // The closed form itself loses 1e-16 (r/a)^3 by cancellation.
            assert!((found / closed - 1.0).abs() < 2e-9, "{distance}");
            let step = 1e-5;
            let at = |delta: f64| pair((3.0 * delta).sqrt(), 3.0, distance).0;
            let numeric = (at(1.0 / 3.0 + step) - at(1.0 / 3.0 - step)) / (2.0 * step);
            // At r = a the slope has a square-root kink.
            let bound = if distance == 1.0 { 1e-2 } else { 1e-7 };
            assert!(
                (numeric - slope).abs() < bound,
                "{distance}: {numeric} {slope}"
            );
        }
    }
}
