//! Plans of the transforms of a grid.

use std::sync::Arc;

use realfft::{ComplexToReal, RealToComplex};
use rustfft::Fft;

use crate::plans::Planned;

/// Transforms along the rows and the columns of a grid.
pub struct Plans<T> {
    pub(super) row_forward: Arc<dyn RealToComplex<T>>,
    pub(super) row_backward: Arc<dyn ComplexToReal<T>>,
    pub(super) column_forward: Arc<dyn Fft<T>>,
    pub(super) column_backward: Arc<dyn Fft<T>>,
}

impl<T: Planned> Plans<T> {
    /// Plans for `[nx, ny]` points.
    pub(super) fn new([nx, ny]: [usize; 2]) -> Self {
        Plans {
            row_forward: T::real_forward(nx),
            row_backward: T::real_backward(nx),
            column_forward: T::complex_forward(ny),
            column_backward: T::complex_backward(ny),
        }
    }
}
