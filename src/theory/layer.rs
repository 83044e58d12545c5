//! Elastic layer on a rigid base: compliance over that of the half-space, mode by mode.
//!
//! `displacement = (2/(E* q)) M(q h) pressure` for a layer of thickness h with `E* = E/(1-nu^2)`.
//! The solver uses the inverse of the same functions.

use super::error::{TheoryError, between, positive};
use crate::elastic::{bonded_compliance, frictionless_compliance};

/// `M(k)` of a layer of `poisson_ratio` (-1 to 1/2) that is bonded to its base, `k = q h`.
pub fn bonded(k: f64, poisson_ratio: f64) -> Result<f64, TheoryError> {
    let nu = between!(poisson_ratio in -1.0..=0.5, "between -1 and 0.5")?;
    Ok(bonded_compliance(positive("k", k)?, nu))
}

/// `M(k)` of a layer that slides on its base without friction, `k = q h`.
pub fn sliding(k: f64) -> Result<f64, TheoryError> {
    Ok(frictionless_compliance(positive("k", k)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invalid_layers_are_refused() {
        assert!(bonded(0.0, 0.3).is_err());
        assert!(bonded(1.0, 0.51).is_err());
        assert!(sliding(f64::NAN).is_err());
    }
}
