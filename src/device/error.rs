//! Errors in the choice of a device.

#[cfg(feature = "gpu")]
use crate::backend::gpu::GpuError;

/// The processor, as Rust asks for it.
const PROCESSOR: &str = "Device::cpu()";

/// Why the graphics processor that a scene asks for is not used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum DeviceError {
    /// This machine has no graphics processor, or it failed.
    #[error("the GPU cannot be used: {reason}; {PROCESSOR} does without")]
    Unusable {
        /// The reason.
        reason: String,
    },
    /// tabor was built without the feature `gpu`.
    #[error(
        "this build of tabor knows no GPU (it is without the feature `gpu`); {PROCESSOR} does without"
    )]
    NotBuilt,
    /// A graphics processor is asked for, and several ranks share the contact.
    #[error("a contact over {ranks} ranks is solved on their processors; take {PROCESSOR}")]
    Ranks {
        /// How many ranks there are.
        ranks: usize,
    },
    /// Points that have no transform on it.
    #[error(
        "grid.points: {} x {} points have no transform on the GPU, which takes even numbers without a prime factor above 7: take {instead}, or {PROCESSOR}",
        points[0], points[1]
    )]
    Points {
        /// Solved points along x and y.
        points: [usize; 2],
        /// The nearest that have one, in words.
        instead: String,
    },
    /// More points than an adapter takes.
    #[error(
        "grid.points: {} x {} points are past the limits of {adapter}, which takes up to {side} x {side} here{}: take fewer points, or {PROCESSOR}",
        points[0], points[1], if *in_double { " in double precision" } else { "" }
    )]
    Limits {
        /// Points of the grid along x and y.
        points: [usize; 2],
        /// The adapter's name.
        adapter: String,
        /// Points along the side of the largest square grid that it takes.
        side: usize,
        /// Whether that is the side in double precision.
        in_double: bool,
    },
}

#[cfg(any(feature = "cli", feature = "gpu"))]
impl DeviceError {
    /// The message for readers who ask for the processor in other words.
    pub(crate) fn in_words(&self, processor: &str) -> String {
        self.to_string().replace(PROCESSOR, processor)
    }
}

#[cfg(feature = "gpu")]
impl From<GpuError> for DeviceError {
    fn from(error: GpuError) -> Self {
        DeviceError::Unusable {
            reason: error.to_string(),
        }
    }
}
