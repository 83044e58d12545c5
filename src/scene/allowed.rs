//! The numbers that keys take.

/// The numbers that a key takes.
#[derive(Clone, Copy)]
pub(super) struct Allowed {
    pub test: fn(f64) -> bool,
    pub words: &'static str,
}

impl Allowed {
    /// Numbers that pass `test`; `words` completes "it must be ...".
    pub const fn new(test: fn(f64) -> bool, words: &'static str) -> Self {
        Allowed { test, words }
    }

    /// Every finite number.
    pub const FINITE: Allowed = Allowed::new(|_| true, "finite");
    /// Every finite number above zero.
    pub const POSITIVE: Allowed = Allowed::new(|value| value > 0.0, "finite and above 0");
    /// Every finite number but the negative ones.
    pub const NOT_NEGATIVE: Allowed = Allowed::new(|value| value >= 0.0, "finite and at least 0");
}

/// Least and largest magnitude of a number other than 0, in SI units: far beyond anything that two
/// surfaces do, and such that products of several of them are numbers still.
const SANE: [f64; 2] = [1e-30, 1e30];
/// [`SANE`] in words.
pub(super) const SANE_WORDS: &str =
    "0 or between 1e-30 and 1e30 in SI units; check the powers of ten";

/// Whether a number has a magnitude that one can compute with.
pub(super) fn is_sane(value: f64) -> bool {
    value == 0.0 || (SANE[0]..=SANE[1]).contains(&value.abs())
}
