//! Whether compensated sums survive a device's compiler.
//!
//! WGSL has no way to forbid that `(a + b) - a` becomes `b`. The compensated sums hide their steps
//! from the compiler, but a compiler may see through it. A device without double precision is therefore
//! tested once with sums whose rounding errors are known.

use super::bindings::{Access, WORKING};
use super::recorder::Part;
use super::source::{self, PAIRS};
use super::{GpuBackend, GpuError, space};

/// Pairs whose sums round: mixed signs and sizes, all digits in use.
fn pairs() -> [[f32; 2]; PAIRS] {
    std::array::from_fn(|i| {
        let digits = |seed: u32| -> f32 {
            let mixed = seed.wrapping_mul(2_654_435_761).rotate_left(13) ^ seed;
            1.0 + (mixed >> 9) as f32 / 8_388_608.0
        };
        let i = i as u32;
        let small = digits(7 * i + 3) * (-(1.0 + (i % 23) as f32)).exp2();
        let sign = if i.is_multiple_of(3) { -1.0 } else { 1.0 };
        [digits(5 * i + 1), sign * small]
    })
}

impl GpuBackend {
    /// Whether sums and their rounding errors are right to the last bit.
    pub(super) fn sums_survive(&mut self) -> Result<bool, GpuError> {
        let values = self.storage("sums", 8 + 8 * PAIRS)?;
        let given = self.storage("pairs", 8 * PAIRS)?;
        let numbers = pairs();
        self.recorder
            .write(&given, 0, bytemuck::cast_slice(&numbers))?;
        let shared = [&self.params, &self.scalars, &values];
        let prepared = self.prepare(
            "check",
            source::two_sums(),
            &[(WORKING, &shared), (&[Access::Read], &[&given])],
            [1, 1],
        )?;
        self.recorder.dispatch(prepared)?;
        let bytes = self.recorder.read(&[Part {
            buffer: &values,
            start: 8,
            length: 8 * PAIRS,
        }])?;
        let found = bytes.chunks_exact(4).map(space::single_of);
        let right = pairs().into_iter().flat_map(|[a, b]| {
            let sum = a + b;
            // Exact in double precision: both have few digits.
            let lost = f64::from(a) + f64::from(b) - f64::from(sum);
            [sum, lost as f32]
        });
        Ok(found.eq(right))
    }
}
