//! The floating-point types of fields: single and double precision.

mod exponential;

use rustfft::FftNum;
use rustfft::num_traits::{Float, NumAssign};

/// A floating-point type of fields: `f64` or `f32`.
pub trait Real: FftNum + Float + NumAssign + Default + Send + Sync + 'static {
    /// Rounds a double to this type.
    fn from_double(value: f64) -> Self;
    /// Converts to double.
    fn double(self) -> f64;
    /// Relative rounding error of this type.
    const EPSILON: f64;
    /// `[exp(x), exp(x) - 1]` to three units of the last place, several at a time where a loop over points asks.
    fn exponentials(self) -> [Self; 2];
    /// The lesser of two numbers, as a single processor instruction; `self` if either is NaN.
    #[inline(always)]
    fn least(self, other: Self) -> Self {
        if other < self { other } else { self }
    }
    /// The greater of two numbers; `self` if either is NaN.
    #[inline(always)]
    fn most(self, other: Self) -> Self {
        if other > self { other } else { self }
    }
}

impl Real for f64 {
    #[inline(always)]
    fn from_double(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn double(self) -> f64 {
        self
    }
    #[inline(always)]
    fn exponentials(self) -> [Self; 2] {
        exponential::double(self)
    }
    const EPSILON: f64 = f64::EPSILON;
}

impl Real for f32 {
    #[inline(always)]
    fn from_double(value: f64) -> Self {
        value as f32
    }
    #[inline(always)]
    fn double(self) -> f64 {
        f64::from(self)
    }
    #[inline(always)]
    fn exponentials(self) -> [Self; 2] {
        exponential::single(self)
    }
    const EPSILON: f64 = f32::EPSILON as f64;
}
