//! Errors of theories, and the checks of their input.

/// Why a theory gives no result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TheoryError {
    /// An input outside the theory's range.
    #[error("{name} = {value:e} is out of range: it must be {allowed}")]
    OutOfRange {
        /// Name of the input, as in the function's signature.
        name: &'static str,
        /// Its value.
        value: f64,
        /// The accepted values.
        allowed: &'static str,
    },
    /// The theory has no state at these values, for instance at a tension beyond pull-off.
    #[error("{what} does not exist for these values")]
    NoSolution {
        /// The quantity asked for.
        what: &'static str,
    },
    /// A numerical method ran out of steps before it reached its tolerance.
    #[error("{what} did not converge")]
    NotConverged {
        /// Name of the method.
        what: &'static str,
    },
}

/// `value` if it is finite and positive.
pub(crate) fn positive(name: &'static str, value: f64) -> Result<f64, TheoryError> {
    within(
        name,
        value,
        value > 0.0 && value.is_finite(),
        "positive and finite",
    )
}

/// `value` if it is finite and not negative.
pub(crate) fn not_negative(name: &'static str, value: f64) -> Result<f64, TheoryError> {
    within(
        name,
        value,
        value >= 0.0 && value.is_finite(),
        "zero or more, and finite",
    )
}

/// `value` if it is finite.
pub(crate) fn finite(name: &'static str, value: f64) -> Result<f64, TheoryError> {
    within(name, value, value.is_finite(), "finite")
}

/// A variable if it lies in a range; with its name and the range in words.
macro_rules! between {
    ($name:ident in $range:expr, $allowed:literal) => {
        $crate::theory::error::within(
            stringify!($name),
            $name,
            ($range).contains(&$name),
            $allowed,
        )
    };
}
pub(crate) use between;

/// `value` if `accepted` holds.
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
