//! Waves on a half-space: Westergaard 1939, with adhesion Johnson 1995, and the egg-box of
//! Johnson, Greenwood & Higginson 1985.
//!
//! The line wave has the undeformed gap `D (1 - cos(2 pi x/wavelength))` and touches over half
//! widths `a` around its crests. Pressures are in units of `p* = pi E* D/wavelength`, the mean
//! pressure of full contact, gaps in units of the amplitude D, lengths in wavelengths.

use super::error::{TheoryError, between, not_negative, positive};
use super::roots::root;
use std::f64::consts::PI;

/// Adhesion parameter above which the line wave closes completely without load: `3^(3/4)/4`.
#[doc(hidden)]
pub const CRITICAL_ADHESION: f64 = 0.569_876_764_238_694_4;

/// `p* = pi E* D/wavelength` of the line wave, Pa.
pub fn full_contact_pressure(
    contact_modulus: f64,
    amplitude: f64,
    wavelength: f64,
) -> Result<f64, TheoryError> {
    Ok(
        PI * positive("contact_modulus", contact_modulus)? * positive("amplitude", amplitude)?
            / positive("wavelength", wavelength)?,
    )
}

/// Johnson's adhesion parameter `alpha = sqrt(2 wavelength w/(pi^2 D^2 E*))`.
pub fn adhesion_parameter(
    contact_modulus: f64,
    amplitude: f64,
    wavelength: f64,
    work_of_adhesion: f64,
) -> Result<f64, TheoryError> {
    let slope = positive("amplitude", amplitude)? / positive("wavelength", wavelength)?;
    let length = not_negative("work_of_adhesion", work_of_adhesion)?
        / positive("contact_modulus", contact_modulus)?;
    Ok((2.0 * length / (PI * PI * slope * amplitude)).sqrt())
}

fn checked(half_width: f64) -> Result<f64, TheoryError> {
    between!(half_width in 0.0..=0.5, "between 0 and half a wavelength")
}

/// Mean pressure at a `half_width` of contact, in p*: `sin^2(pi a)`.
pub fn mean_pressure(half_width: f64) -> Result<f64, TheoryError> {
    Ok((PI * checked(half_width)?).sin().powi(2))
}

/// Half width of contact at a `mean_pressure` (in p*, 0 to 1), in wavelengths.
pub fn half_width(mean_pressure: f64) -> Result<f64, TheoryError> {
    between!(mean_pressure in 0.0..=1.0, "between 0 and 1")?;
    Ok(mean_pressure.sqrt().asin() / PI)
}

/// Pressure at `x` (wavelengths from a crest), in p*:
/// `2 cos(pi x) sqrt(sin^2(pi a) - sin^2(pi x))`, 0 outside.
pub fn pressure(half_width: f64, x: f64) -> Result<f64, TheoryError> {
    let edge = (PI * checked(half_width)?).sin();
    let (sine, cosine) = (PI * x).sin_cos();
    let inside = (edge - sine) * (edge + sine);
    Ok(2.0 * cosine.abs() * inside.max(0.0).sqrt())
}

/// Gap at `x` (wavelengths from a crest), in D:
/// `2 s sqrt(s^2 - e^2) - 2 e^2 acosh(s/e)` with `s = sin(pi x)`, `e = sin(pi a)`; 0 in contact.
///
/// Integrated from the slope `2 cos(pi x) sqrt(s^2 - e^2)` that Westergaard's function gives.
pub fn gap(half_width: f64, x: f64) -> Result<f64, TheoryError> {
    let edge = (PI * checked(half_width)?).sin();
    let sine = (PI * x).sin().abs();
    if sine <= edge {
        return Ok(0.0);
    }
    let root = ((sine - edge) * (sine + edge)).sqrt();
    let closed = if edge == 0.0 {
        0.0
    } else {
        edge * edge * (root / edge).asinh()
    };
    Ok(2.0 * (sine * root - closed))
}

/// Mean gap at a `mean_pressure` (in p*, 0 to 1), in D: `1 - p + p log p`.
pub fn mean_gap(mean_pressure: f64) -> Result<f64, TheoryError> {
    half_width(mean_pressure)?;
    Ok(if mean_pressure == 0.0 {
        1.0
    } else {
        1.0 - mean_pressure + mean_pressure * mean_pressure.ln()
    })
}

/// Mean pressure of the adhesive wave at a `half_width` of contact, in p*: `sin^2(pi a) - alpha
/// sqrt(tan(pi a))`. Johnson 1995; zero range of adhesion, as in JKR.
pub fn adhesive_mean_pressure(half_width: f64, adhesion: f64) -> Result<f64, TheoryError> {
    let angle = PI * checked(half_width)?;
    Ok(angle.sin().powi(2) - not_negative("adhesion", adhesion)? * angle.tan().abs().sqrt())
}

/// Extrema of the adhesive wave: pull-off and closure.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct AdhesiveExtrema {
    /// Greatest tension, in p*, positive.
    pub pull_off: f64,
    /// Its `pi a`.
    pub pull_off_angle: f64,
    /// Mean pressure, in p*, beyond which the contact is complete; negative if it closes unloaded.
    pub closing_pressure: f64,
    /// Its `pi a`.
    pub closing_angle: f64,
}

/// Extrema of [`adhesive_mean_pressure`]: the roots of `4 t^(3/2) = alpha (1 + t^2)^2`, `t = tan(pi
/// a)`. None for `adhesion` above 1.065.
pub fn adhesive_extrema(adhesion: f64) -> Result<AdhesiveExtrema, TheoryError> {
    let adhesion = positive("adhesion", adhesion)?;
    let excess = |log: f64| {
        let t = log.exp();
        // The logarithm of the condition is smooth over many decades of adhesion.
        4.0_f64.ln() + 1.5 * log - adhesion.ln() - 2.0 * (t * t).ln_1p()
    };
    let steepest = 0.5 * 0.6_f64.ln();
    let pull_off = root("a pull-off", excess, -300.0, steepest, 1e-15)?
        .exp()
        .atan();
    let closing = root("a closing pressure", excess, steepest, 300.0, 1e-15)?
        .exp()
        .atan();
    Ok(AdhesiveExtrema {
        pull_off: -adhesive_mean_pressure(pull_off / PI, adhesion)?,
        pull_off_angle: pull_off,
        closing_pressure: adhesive_mean_pressure(closing / PI, adhesion)?,
        closing_angle: closing,
    })
}

/// Contact area fraction of the egg-box `D cos cos` at low `mean_pressure`, in units of
/// `sqrt2 pi E* D/wavelength`: `pi (3 p/(8 pi))^(2/3)`, which is Hertz on its two crests.
#[doc(hidden)]
pub fn egg_box_area_low(mean_pressure: f64) -> Result<f64, TheoryError> {
    let mean_pressure = not_negative("mean_pressure", mean_pressure)?;
    Ok(PI * (3.0 * mean_pressure / (8.0 * PI)).cbrt().powi(2))
}

/// The same near full contact: `1 - (3/(2 pi)) (1 - p)`. As printed in the source, not derived
/// again.
#[doc(hidden)]
pub fn egg_box_area_high(mean_pressure: f64) -> Result<f64, TheoryError> {
    between!(mean_pressure in 0.0..=1.0, "between 0 and 1")?;
    Ok(1.0 - 3.0 / (2.0 * PI) * (1.0 - mean_pressure))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::theory::quadrature::integrate;

    #[test]
    fn profiles_have_the_stated_means() {
        let a = 0.17;
        let mean = mean_pressure(a).unwrap();
        let pressed = integrate(|x| 2.0 * pressure(a, x).unwrap(), 0.0, a, 1e-12, 0.0).unwrap();
        let open = integrate(|x| 2.0 * gap(a, x).unwrap(), a, 0.5, 1e-12, 0.0).unwrap();
        assert!((pressed - mean).abs() < 1e-12);
        assert!((open - mean_gap(mean).unwrap()).abs() < 1e-12);
        assert!((half_width(mean).unwrap() - a).abs() < 1e-15);
    }

    #[test]
    fn unloaded_wave_closes_at_the_critical_adhesion() {
        let at = adhesive_extrema(CRITICAL_ADHESION).unwrap();
        assert!(at.closing_pressure.abs() < 1e-14);
        assert!(adhesive_extrema(1.2).is_err());
        assert!((CRITICAL_ADHESION - 3.0_f64.powf(0.75) / 4.0).abs() < 1e-15);
    }
}
