//! What a theory can refuse, and the checks that refuse it.

/// Why a theory gives no number.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TheoryError {
    /// An input lies where the theory says nothing.
    #[error("{name} = {value:e} is out of range: it must be {allowed}")]
    OutOfRange {
        /// Name of the input, as in the function's signature.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What would be accepted.
        allowed: &'static str,
    },
    /// The theory has no state at these values (a tension beyond pull-off, for instance).
    #[error("{what} does not exist for these values")]
    NoSolution {
        /// What was asked for.
        what: &'static str,
    },
    /// A numerical method ran out of steps before it reached its tolerance.
    #[error("{what} did not converge")]
    NotConverged {
        /// The method.
        what: &'static str,
    },
}

/// `value`, if it is finite and greater than zero.
pub(crate) fn positive(name: &'static str, value: f64) -> Result<f64, TheoryError> {
    within(
        name,
        value,
        value > 0.0 && value.is_finite(),
        "positive and finite",
    )
}

/// `value`, if it is finite and not negative.
pub(crate) fn not_negative(name: &'static str, value: f64) -> Result<f64, TheoryError> {
    within(
        name,
        value,
        value >= 0.0 && value.is_finite(),
        "zero or more, and finite",
    )
}

/// `value`, if it is finite.
pub(crate) fn finite(name: &'static str, value: f64) -> Result<f64, TheoryError> {
    within(name, value, value.is_finite(), "finite")
}

/// `value`, if `accepted`.
pub(crate) fn within(
    name: &'static str,
    value: f64,
    accepted: bool,
    allowed: &'static str,
) -> Result<f64, TheoryError> {
    if accepted {
        Ok(value)
    } else {
        Err(TheoryError::OutOfRange {
            name,
            value,
            allowed,
        })
    }
}
