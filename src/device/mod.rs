//! Where a run computes: the processor, or a graphics processor where the feature `gpu` is on.

#[cfg(feature = "gpu")]
mod adapter_choice;
#[cfg(feature = "gpu")]
mod adapters;
mod error;
mod selection;

#[cfg(feature = "gpu")]
pub use adapter_choice::{best, check_points, largest_here};
#[cfg(feature = "gpu")]
pub use adapters::list;
pub use error::DeviceError;
pub use selection::SelectedDevice;

use crate::scene::{BackendName, Scene};

/// Whether there is an adapter, and it could take the grid of a scene.
#[cfg(feature = "gpu")]
pub fn has_adapter_for(scene: &Scene, verbose: bool) -> bool {
    adapter_choice::may_take_adapters(scene) && !list(verbose).is_empty()
}

/// A build without the feature `gpu` has no adapter.
#[cfg(not(feature = "gpu"))]
pub fn has_adapter_for(_scene: &Scene, _verbose: bool) -> bool {
    false
}

/// Where the arithmetic of a solve is to run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Device {
    backend: BackendName,
    hears_drivers: bool,
}

impl Device {
    /// A graphics processor where there is one and the grid is worth it, else the processor.
    pub fn auto() -> Self {
        Device::from(BackendName::Auto)
    }

    /// The threads of this machine's processor.
    pub fn cpu() -> Self {
        Device::from(BackendName::Cpu)
    }

    /// A graphics processor, through Vulkan, Metal or Direct3D 12; software drivers will do. A solve fails
    /// with a [`DeviceError`] on a machine without an adapter.
    pub fn gpu() -> Self {
        Device::from(BackendName::Gpu)
    }

    /// Lets graphics drivers print to standard error while they start, which they are kept from otherwise.
    pub fn hear_drivers(self) -> Self {
        Device {
            hears_drivers: true,
            ..self
        }
    }

    /// The word for it in a scene.
    pub fn backend(self) -> BackendName {
        self.backend
    }

    /// Whether drivers are heard.
    pub(crate) fn hears_drivers(self) -> bool {
        self.hears_drivers
    }
}

impl Default for Device {
    fn default() -> Self {
        Device::auto()
    }
}

impl From<BackendName> for Device {
    fn from(backend: BackendName) -> Self {
        Device {
            backend,
            hears_drivers: false,
        }
    }
}
