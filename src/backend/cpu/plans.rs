//! Plans of the transforms of a grid.

use std::sync::Arc;

use rustfft::Fft;

use super::CpuReal;
use super::row_transform::RowTransform;
use crate::real::Real;

/// Transforms along the rows and the columns of a grid.
pub struct Plans<T: Real> {
    pub(super) rows: RowTransform<T>,
    pub(super) column_forward: Arc<dyn Fft<T>>,
    pub(super) column_backward: Arc<dyn Fft<T>>,
}

impl<T: CpuReal> Plans<T> {
    /// Plans for `[nx, ny]` points.
    pub(super) fn new([nx, ny]: [usize; 2]) -> Self {
        Plans {
            rows: RowTransform::new(nx),
            column_forward: T::complex_forward(ny),
            column_backward: T::complex_backward(ny),
        }
    }
}
