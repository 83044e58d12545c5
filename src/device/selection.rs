//! Where a run computes, and in which arithmetic: what the scene names, or what suits it best.

use std::sync::Arc;

#[cfg(feature = "gpu")]
use super::adapter_choice;
use super::error::DeviceError;
use crate::backend::Backend;
use crate::backend::cpu;
#[cfg(feature = "gpu")]
use crate::backend::gpu::{GpuBackend, GpuDevice};
use crate::backend::ranks::Ranks;
use crate::scene::{BackendName, Precision};
use crate::study::Setup;

/// The device that a run computes on.
pub struct SelectedDevice {
    place: Place,
    precision: Precision,
    /// The processes that hold the rows of the contact together.
    ranks: Option<Arc<dyn Ranks>>,
    /// A remark on the choice, for the user.
    pub remark: Option<String>,
}

/// A processor, with what it takes to use it.
pub(super) enum Place {
    Processor,
    #[cfg(feature = "gpu")]
    Gpu(GpuDevice),
}

impl Place {
    fn is_gpu(&self) -> bool {
        !matches!(self, Place::Processor)
    }
}

/// The arithmetic of a setup on the processor.
fn on_processor(setup: &Setup) -> Precision {
    setup
        .scene
        .arithmetic_on_processor(setup.problem.grid.len())
}

impl SelectedDevice {
    /// Takes what a scene asks for. Drivers that print while they start are heard if `verbose`.
    ///
    /// # Errors
    /// A graphics processor that is asked for and cannot be had, or cannot take the grid.
    pub fn new(setup: &Setup, verbose: bool) -> Result<SelectedDevice, DeviceError> {
        let (place, remark) = match setup.scene.solver.backend {
            BackendName::Cpu => (Place::Processor, None),
            #[cfg(feature = "gpu")]
            BackendName::Gpu => adapter_choice::asked(setup, verbose)?,
            #[cfg(feature = "gpu")]
            BackendName::Auto => adapter_choice::best_for(setup, verbose),
            #[cfg(not(feature = "gpu"))]
            BackendName::Gpu => return Err(DeviceError::NotBuilt),
            #[cfg(not(feature = "gpu"))]
            BackendName::Auto => (Place::Processor, None),
        };
        #[cfg(not(feature = "gpu"))]
        let _ = verbose;
        let precision = if place.is_gpu() {
            setup.scene.arithmetic_on_gpu()
        } else {
            on_processor(setup)
        };
        let sums = match &place {
            #[cfg(feature = "gpu")]
            Place::Gpu(device) => adapter_choice::plain_sums(device),
            Place::Processor => None,
        };
        let remarks: Vec<String> = remark.into_iter().chain(sums).collect();
        Ok(SelectedDevice {
            place,
            precision,
            ranks: None,
            remark: (!remarks.is_empty()).then(|| remarks.join("; ")),
        })
    }

    /// The processor, where the scene leaves the choice and the graphics processor has failed.
    pub fn fallback(&self, setup: &Setup) -> Option<SelectedDevice> {
        let may = setup.scene.solver.backend == BackendName::Auto && self.place.is_gpu();
        may.then(|| SelectedDevice {
            place: Place::Processor,
            precision: on_processor(setup),
            ranks: None,
            remark: None,
        })
    }

    /// The processors of several ranks, which hold the rows of the contact together.
    ///
    /// # Errors
    /// A scene that asks for a graphics processor.
    pub fn on_ranks(setup: &Setup, ranks: Arc<dyn Ranks>) -> Result<SelectedDevice, DeviceError> {
        if setup.scene.solver.backend == BackendName::Gpu {
            return Err(DeviceError::Ranks {
                ranks: ranks.count(),
            });
        }
        Ok(SelectedDevice {
            place: Place::Processor,
            precision: on_processor(setup),
            ranks: Some(ranks),
            remark: None,
        })
    }

    /// A backend on it.
    pub fn backend(&self) -> Box<dyn Backend + Send> {
        let ranks = self.ranks.clone();
        match (&self.place, self.precision) {
            #[cfg(feature = "gpu")]
            (Place::Gpu(device), Precision::Mixed) => {
                Box::new(GpuBackend::on(device).expecting_finite().corrected())
            }
            #[cfg(feature = "gpu")]
            (Place::Gpu(device), precision) => Box::new(
                GpuBackend::on(device)
                    .expecting_finite()
                    .keeping(adapter_choice::number(precision)),
            ),
            (Place::Processor, Precision::Single) => cpu::single(ranks),
            (Place::Processor, Precision::Mixed) => cpu::mixed(ranks),
            (Place::Processor, _) => cpu::double(ranks),
        }
    }

    /// `cpu` or `gpu`.
    pub fn name(&self) -> &'static str {
        match self.place {
            Place::Processor => BackendName::Cpu.name(),
            #[cfg(feature = "gpu")]
            Place::Gpu(_) => BackendName::Gpu.name(),
        }
    }

    /// Name of the adapter, on a graphics processor.
    pub fn adapter(&self) -> Option<String> {
        match &self.place {
            Place::Processor => None,
            #[cfg(feature = "gpu")]
            Place::Gpu(device) => Some(device.description().name.clone()),
        }
    }

    /// Where it is and in which arithmetic, in words.
    pub fn words(&self) -> String {
        let adapter = self
            .adapter()
            .map_or_else(String::new, |name| format!(" ({name})"));
        format!(
            "{}{adapter}, {} precision",
            self.name(),
            self.precision.name()
        )
    }

    /// Its arithmetic.
    pub fn precision(&self) -> Precision {
        self.precision
    }
}
