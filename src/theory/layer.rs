//! Elastic layer on a rigid base: compliance over that of the half-space, mode by mode.
//!
//! `displacement = (2/(E* q)) M(q h) pressure` for a layer of thickness h with `E* = E/(1-nu^2)`.

use super::error::{TheoryError, positive, within};

fn checked(k: f64, poisson_ratio: f64) -> Result<(f64, f64), TheoryError> {
    let nu = within(
        "poisson_ratio",
        poisson_ratio,
        (-1.0..=0.5).contains(&poisson_ratio),
        "between -1 and 0.5",
    )?;
    Ok((positive("k", k)?, nu))
}

/// `M(k)` of a layer that is bonded to its base, `k = q h`:
/// `((3-4nu) sinh 2k - 2k)/((3-4nu) cosh 2k + 2k^2 + 5 - 12nu + 8nu^2)`.
///
/// 1 for a thick layer. For a thin incompressible one it falls with `(2/3) k^3`.
pub fn bonded(k: f64, poisson_ratio: f64) -> Result<f64, TheoryError> {
    let (k, nu) = checked(k, poisson_ratio)?;
    let factor = 3.0 - 4.0 * nu;
    // Both sides times 2 exp(-2k), so that a thick layer does not overflow.
    let fade = (-2.0 * k).exp();
    let numerator = factor * (1.0 - fade * fade) - 4.0 * k * fade;
    let constant = 2.0 * k * k + 5.0 - 12.0 * nu + 8.0 * nu * nu;
    let denominator = factor * (1.0 + fade * fade) + 2.0 * constant * fade;
    // sinh 2k - 2k cancels for a thin incompressible layer.
    if k < 0.1 {
        let x = 2.0 * k;
        let cubic =
            x.powi(3) / 6.0 * (1.0 + x * x / 20.0 * (1.0 + x * x / 42.0 * (1.0 + x * x / 72.0)));
        let numerator = factor * cubic + (factor - 1.0) * x;
        return Ok(numerator / (factor * x.cosh() + constant));
    }
    Ok(numerator / denominator)
}

/// `M(k)` of a layer that slides on its base without friction: `(cosh 2k - 1)/(sinh 2k + 2k)`.
pub fn sliding(k: f64) -> Result<f64, TheoryError> {
    let k = positive("k", k)?;
    // cosh 2k - 1 = 2 sinh^2 k, and both sides times 2 exp(-2k).
    let fade = (-2.0 * k).exp();
    let numerator = (1.0 - fade) * (1.0 - fade);
    Ok(if k < 1e-4 {
        0.5 * k
    } else {
        numerator / (1.0 - fade * fade + 4.0 * k * fade)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thin_and_thick_limits() {
        let k = 1e-3;
        assert!((bonded(k, 0.5).unwrap() / (2.0 / 3.0 * k.powi(3)) - 1.0).abs() < 1e-5);
        assert!((sliding(k).unwrap() / (0.5 * k) - 1.0).abs() < 1e-5);
        assert_eq!(bonded(1e3, 0.3).unwrap(), 1.0);
        assert_eq!(sliding(1e3).unwrap(), 1.0);
        for nu in [0.0, 0.3, 0.5] {
            let jump = bonded(0.1, nu).unwrap() / bonded(0.1 - 1e-12, nu).unwrap() - 1.0;
            assert!(jump.abs() < 1e-9, "{nu}: {jump:e}");
        }
        assert!(bonded(0.0, 0.3).is_err());
    }
}
