//! Plans of the transforms of a grid.

use std::sync::Arc;

use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use rustfft::{Fft, FftNum, FftPlanner};

/// Transforms along the rows and the columns of a grid.
pub struct Plans<T> {
    pub(super) row_forward: Arc<dyn RealToComplex<T>>,
    pub(super) row_backward: Arc<dyn ComplexToReal<T>>,
    pub(super) column_forward: Arc<dyn Fft<T>>,
    pub(super) column_backward: Arc<dyn Fft<T>>,
}

impl<T: FftNum> Plans<T> {
    /// Plans for `[nx, ny]` points.
    ///
    /// Planners are generic and long to compile: who calls this with a number of its own compiles every
    /// algorithm of theirs for it. Hence one function for each number, in this crate
    /// ([`CpuReal::plans`](super::CpuReal::plans)), and programs and tests compile none.
    pub(super) fn new([nx, ny]: [usize; 2]) -> Self {
        let mut real_planner = RealFftPlanner::new();
        let mut planner = FftPlanner::new();
        Plans {
            row_forward: real_planner.plan_fft_forward(nx),
            row_backward: real_planner.plan_fft_inverse(nx),
            column_forward: planner.plan_fft_forward(ny),
            column_backward: planner.plan_fft_inverse(ny),
        }
    }
}
