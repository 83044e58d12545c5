//! The one device that all tests of a binary share, and seeded numbers.

use std::panic::resume_unwind;
use std::sync::OnceLock;

use tabor::backend::gpu::{AdapterChoice, GpuBackend, GpuDevice, Number, quietly};

/// A device, software drivers included. Without one the test that asks is skipped with a word,
/// or fails where `TABOR_REQUIRE_GPU=1` says that there must be one: a missing driver on a test
/// machine would pass unseen.
pub fn device() -> Option<&'static GpuDevice> {
    static DEVICE: OnceLock<Option<GpuDevice>> = OnceLock::new();
    DEVICE.get_or_init(|| ready(false)).as_ref()
}

/// The same where it has double precision; one without is as good as none.
pub fn device_with_double() -> Option<&'static GpuDevice> {
    let device = device()?;
    if !device.description().double {
        eprintln!("skipped: the adapter has no double precision");
        return None;
    }
    Some(device)
}

/// A device that is taken for one without double precision, which keeps its sums in single.
pub fn device_without_double() -> Option<GpuDevice> {
    ready(true)
}

fn ready(without_double: bool) -> Option<GpuDevice> {
    device_with(&AdapterChoice {
        without_double,
        ..AdapterChoice::default()
    })
}

/// A device of a choice, software drivers included, and told of as the shared one.
pub fn device_with(choice: &AdapterChoice) -> Option<GpuDevice> {
    let choice = AdapterChoice {
        software: true,
        ..choice.clone()
    };
    // Without what its driver prints at its start.
    let made = quietly(|| GpuDevice::new(&choice));
    match made.unwrap_or_else(|panic| resume_unwind(panic)) {
        Ok(device) => Some(device),
        Err(error) => {
            let required = std::env::var("TABOR_REQUIRE_GPU").is_ok_and(|v| v == "1");
            assert!(!required, "TABOR_REQUIRE_GPU is set, but: {error}");
            eprintln!("skipped: no adapter ({error})");
            None
        }
    }
}

/// A backend on the shared device.
pub fn backend(device: &GpuDevice) -> GpuBackend {
    GpuBackend::new(device).expect("two small buffers fit any device")
}

/// A backend on the shared device whose fields are in double precision.
pub fn double_backend(device: &GpuDevice) -> GpuBackend {
    backend(device).keeping(Number::Double)
}

/// Numbers in [-0.5, 0.5) from a seed.
pub struct Numbers(pub u64);

impl Numbers {
    /// The next number (splitmix64).
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    }

    /// So many of them, in all their digits.
    pub fn doubles(&mut self, count: usize) -> Vec<f64> {
        (0..count).map(|_| self.next()).collect()
    }

    /// So many of them, rounded to what a field in single precision holds.
    pub fn field(&mut self, count: usize) -> Vec<f64> {
        (0..count).map(|_| f64::from(self.next() as f32)).collect()
    }
}

/// Norm of the difference over the norm of the reference; NaN if either holds one.
pub fn relative_difference(values: &[f64], reference: &[f64]) -> f64 {
    assert_eq!(values.len(), reference.len());
    let square = |sum: f64, x: f64| sum + x * x;
    let difference = values
        .iter()
        .zip(reference)
        .map(|(a, b)| a - b)
        .fold(0.0, square);
    let norm = reference.iter().copied().fold(0.0, square);
    (difference / norm).sqrt()
}
