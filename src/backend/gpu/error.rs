//! Errors of the graphics processor.

use crate::backend::BackendError;

/// Why the graphics processor cannot do what was asked.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GpuError {
    /// No driver, or no driver of the kind asked for.
    #[error("no graphics adapter found{0}")]
    NoAdapter(String),
    /// No adapter has the name asked for.
    #[error("no graphics adapter has `{wanted}` in its name; there are: {found}")]
    NoSuchAdapter {
        /// The name asked for.
        wanted: String,
        /// Names of the adapters found.
        found: String,
    },
    /// The adapter does not give a device.
    #[error("the adapter `{adapter}` gives no device: {reason}")]
    NoDevice {
        /// Its name.
        adapter: String,
        /// The driver's message.
        reason: String,
    },
    /// A grid that the transforms do not take.
    #[error(
        "a grid of {nx} x {ny} points has no transform on the graphics processor: both numbers must be even, with no prime factor above 7, and at most {largest}"
    )]
    Size {
        /// Points along x.
        nx: usize,
        /// Points along y.
        ny: usize,
        /// Longest line that fits this adapter.
        largest: usize,
    },
    /// A buffer over the adapter's limits.
    #[error("`{name}` takes {bytes} bytes, and this adapter binds at most {limit} bytes at a time")]
    TooLarge {
        /// Which buffer.
        name: String,
        /// Its length.
        bytes: u64,
        /// The adapter's limit.
        limit: u64,
    },
    /// Fields in a precision that the adapter does not have.
    #[error(
        "{0} has no double precision (SHADER_F64); precision = \"mixed\" reaches the same tolerances without"
    )]
    Precision(String),
    /// A kernel that has no shader.
    #[error("kernel `{0}` has no shader")]
    NoShader(&'static str),
    /// A kernel was given the wrong number of fields.
    #[error("kernel `{kernel}` takes {expected} fields and was given {given}")]
    Fields {
        /// The kernel.
        kernel: &'static str,
        /// How many fields it declares.
        expected: usize,
        /// How many it was given.
        given: usize,
    },
    /// The device has no memory left for a buffer.
    #[error(
        "out of memory on {adapter}: there is no room for `{name}`, of {bytes} bytes; take fewer points, or Device::cpu()"
    )]
    OutOfMemory {
        /// The adapter's name.
        adapter: String,
        /// Which buffer.
        name: String,
        /// Its length.
        bytes: u64,
    },
    /// Non-finite numbers on the device.
    #[error(
        "numbers on {0} are no longer finite: the device erred, or single precision does not hold this scene; Device::cpu() tells which"
    )]
    NotFinite(String),
    /// The device refused or failed.
    #[error("{0}")]
    Device(String),
}

impl From<wgpu::MapRangeError> for GpuError {
    fn from(error: wgpu::MapRangeError) -> Self {
        GpuError::Device(error.to_string())
    }
}

impl From<GpuError> for BackendError {
    fn from(error: GpuError) -> Self {
        match error {
            GpuError::Fields {
                kernel,
                expected,
                given,
            } => BackendError::Fields {
                kernel,
                expected,
                given,
            },
            other => BackendError::Device(other.to_string()),
        }
    }
}
