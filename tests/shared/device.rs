//! The devices that the tests of a binary share: as many as there are tests at a time that ask for one. A software driver
//! compiles the shaders of a device one after another.

use std::panic::resume_unwind;
use std::sync::{Mutex, MutexGuard, PoisonError};

use tabor::backend::gpu::{
    AdapterChoice, Faults, GpuBackend, GpuDevice, GpuError, Number, quietly,
};

use super::trials::ignore;

/// A device, software drivers included, or why there is none.
type Made = &'static Result<GpuDevice, GpuError>;

/// Those that no running test has.
static FREE: Mutex<Vec<Made>> = Mutex::new(Vec::new());

fn free() -> MutexGuard<'static, Vec<Made>> {
    FREE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The one that a test has, on whose thread this is, until the thread ends.
struct Taken(Made);

impl Taken {
    fn new() -> Taken {
        let another = || &*Box::leak(Box::new(made(&AdapterChoice::default())));
        let last = free().pop();
        Taken(last.unwrap_or_else(another))
    }
}

impl Drop for Taken {
    fn drop(&mut self) {
        free().push(self.0);
    }
}

fn shared() -> Made {
    thread_local! {
        static TAKEN: Taken = Taken::new();
    }
    TAKEN.with(|taken| taken.0)
}

/// A device; without one the test that asks is ignored, or fails where `TABOR_REQUIRE_GPU=1` says that there
/// must be one.
pub fn device() -> &'static GpuDevice {
    shared().as_ref().unwrap_or_else(|error| missing(error))
}

/// The same for a test that has something to show without one.
pub fn found() -> Option<&'static GpuDevice> {
    let found = shared().as_ref();
    if let (Err(error), true) = (&found, is_required()) {
        missing(error);
    }
    found.ok()
}

/// The device where it has double precision; one without is as good as none.
pub fn device_with_double() -> &'static GpuDevice {
    let device = device();
    if !device.description().double {
        ignore("the adapter has no double precision");
    }
    device
}

/// A device that is taken for one without double precision, which keeps its sums in single.
pub fn device_without_double() -> GpuDevice {
    device_with(&AdapterChoice {
        faults: Faults {
            without_double: true,
            ..Faults::default()
        },
        ..AdapterChoice::default()
    })
}

/// A device of a choice, software drivers included.
pub fn device_with(choice: &AdapterChoice) -> GpuDevice {
    made(choice).unwrap_or_else(|error| missing(&error))
}

fn made(choice: &AdapterChoice) -> Result<GpuDevice, GpuError> {
    let choice = AdapterChoice {
        software: true,
        ..choice.clone()
    };
    // Without what its driver prints at its start.
    quietly(|| GpuDevice::new(&choice)).unwrap_or_else(|panic| resume_unwind(panic))
}

fn is_required() -> bool {
    std::env::var("TABOR_REQUIRE_GPU").is_ok_and(|value| value == "1")
}

fn missing(error: &GpuError) -> ! {
    assert!(!is_required(), "TABOR_REQUIRE_GPU is set, but: {error}");
    ignore(format!("no adapter: {error}"))
}

/// A backend on the shared device.
pub fn backend(device: &GpuDevice) -> GpuBackend {
    GpuBackend::new(device).expect("two small buffers fit any device")
}

/// A backend on the shared device whose fields are in double precision.
pub fn double_backend(device: &GpuDevice) -> GpuBackend {
    backend(device).keeping(Number::Double)
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
