//! Limits on the numbers of a key.

pub(super) use crate::units::{RANGE_WORDS, in_range};

/// The limits on the numbers of a key.
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
    /// Every finite number of at least zero.
    pub const NOT_NEGATIVE: Allowed = Allowed::new(|value| value >= 0.0, "finite and at least 0");
}
