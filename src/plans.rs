//! Plans of one-dimensional Fourier transforms, made once a process: the many short runs of a study share them.

use std::sync::{Arc, LazyLock, Mutex, PoisonError};

use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use rustfft::{Fft, FftNum, FftPlanner};

/// The planners of a kind of number, with the plans that they made.
struct Planners<T: FftNum> {
    real: RealFftPlanner<T>,
    complex: FftPlanner<T>,
}

/// The planners of this process for a kind of number.
type Shared<T> = LazyLock<Mutex<Planners<T>>>;

impl<T: FftNum> Planners<T> {
    fn new() -> Mutex<Self> {
        Mutex::new(Planners {
            real: RealFftPlanner::new(),
            complex: FftPlanner::new(),
        })
    }

    /// A plan of theirs. A thread that ended amid planning leaves them sound: a plan is kept once it is whole.
    fn plan<P>(shared: &Shared<T>, plan: impl FnOnce(&mut Self) -> P) -> P {
        plan(&mut shared.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

/// A number whose transforms are planned.
pub trait Planned: FftNum {
    /// From so many real values to their half spectrum.
    fn real_forward(points: usize) -> Arc<dyn RealToComplex<Self>>;
    /// From a half spectrum to so many real values.
    fn real_backward(points: usize) -> Arc<dyn ComplexToReal<Self>>;
    /// From so many complex values to their spectrum.
    fn complex_forward(points: usize) -> Arc<dyn Fft<Self>>;
    /// From a spectrum to so many complex values.
    fn complex_backward(points: usize) -> Arc<dyn Fft<Self>>;
}

/// The plans of a number. Planners are generic and long to compile: functions for each number in this crate, which are
/// not inlined, spare the programs and tests that call them compiling their own.
macro_rules! planned {
    ($number:ty, $planners:ident) => {
        static $planners: Shared<$number> = LazyLock::new(Planners::new);

        impl Planned for $number {
            #[inline(never)]
            fn real_forward(points: usize) -> Arc<dyn RealToComplex<Self>> {
                Planners::plan(&$planners, |with| with.real.plan_fft_forward(points))
            }
            #[inline(never)]
            fn real_backward(points: usize) -> Arc<dyn ComplexToReal<Self>> {
                Planners::plan(&$planners, |with| with.real.plan_fft_inverse(points))
            }
            #[inline(never)]
            fn complex_forward(points: usize) -> Arc<dyn Fft<Self>> {
                Planners::plan(&$planners, |with| with.complex.plan_fft_forward(points))
            }
            #[inline(never)]
            fn complex_backward(points: usize) -> Arc<dyn Fft<Self>> {
                Planners::plan(&$planners, |with| with.complex.plan_fft_inverse(points))
            }
        }
    };
}

planned!(f64, DOUBLE);
planned!(f32, SINGLE);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plan_is_made_once() {
        assert!(Arc::ptr_eq(
            &f64::real_forward(1000),
            &f64::real_forward(1000)
        ));
        assert!(Arc::ptr_eq(
            &f32::complex_backward(1000),
            &f32::complex_backward(1000)
        ));
        assert_eq!(f64::real_backward(1000).len(), 1000);
    }
}
