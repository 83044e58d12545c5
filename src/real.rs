//! The two kinds of number that a solve may run in.

use rustfft::FftNum;
use rustfft::num_traits::{Float, NumAssign};

/// A floating-point number that fields may hold: `f64`, or `f32` beside a graphics processor.
pub trait Real: FftNum + Float + NumAssign + Default + Send + Sync + 'static {
    /// Rounds a double to this type.
    fn of(value: f64) -> Self;
    /// This number as a double.
    fn double(self) -> f64;
    /// Relative rounding error of this type.
    const EPSILON: f64;
}

impl Real for f64 {
    fn of(value: f64) -> Self {
        value
    }
    fn double(self) -> f64 {
        self
    }
    const EPSILON: f64 = f64::EPSILON;
}

impl Real for f32 {
    fn of(value: f64) -> Self {
        value as f32
    }
    fn double(self) -> f64 {
        f64::from(self)
    }
    const EPSILON: f64 = f32::EPSILON as f64;
}
