//! The whole catalogue, for the tests that go through it in a loop.

use tabor::kernel::{KERNELS, Kernel};

pub use tabor::kernel::SCALAR_KERNELS;

/// Every kernel over points, variant by variant.
pub fn variants() -> impl Iterator<Item = &'static Kernel> {
    KERNELS.iter().copied().flatten()
}
