//! Devices: their limits, and how their failures are caught.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::Duration;

use super::GpuBackend;
use super::adapter::{AdapterChoice, AdapterDescription, choose, describe, enumerate, instance};
use super::error::GpuError;
use super::layout::{Number, Wide};
use super::level::LevelPlan;
use super::loops::Loops;
use super::pipelines::Pipelines;
use super::slabs::Limits;
use super::space;
use super::transfer::Transfers;
use crate::backend::Shape;

/// Threads of this process that are inside a driver.
static IN_DRIVERS: AtomicUsize = AtomicUsize::new(0);

/// Whether a thread waits for a device or its driver, for example to compile a shader. Such a wait cannot
/// be cancelled and has no time limit.
pub fn keeps_waiting() -> bool {
    IN_DRIVERS.load(Ordering::Relaxed) > 0
}

/// Counts a thread as inside a driver while it lives.
struct InDriver;

impl InDriver {
    fn enter() -> InDriver {
        IN_DRIVERS.fetch_add(1, Ordering::Relaxed);
        InDriver
    }
}

impl Drop for InDriver {
    fn drop(&mut self) {
        IN_DRIVERS.fetch_sub(1, Ordering::Relaxed);
    }
}

/// A graphics processor, ready to compute. Copies share the device and its compiled kernels.
#[derive(Clone)]
pub struct GpuDevice {
    inner: Arc<Inner>,
}

struct Inner {
    device: wgpu::Device,
    queue: wgpu::Queue,
    description: AdapterDescription,
    pipelines: Pipelines,
    transfers: Mutex<Transfers>,
    loops: Loops,
    lost: Arc<OnceLock<String>>,
    /// Whether the compiler undoes compensated sums.
    plain_sums: OnceLock<bool>,
    /// Dispatches left before the device is lost, for tests.
    left: Option<AtomicU64>,
    /// Dispatches left before fields are set to NaN, for tests.
    sound: Option<AtomicU64>,
    /// Bytes left, for tests.
    memory: Option<AtomicU64>,
    /// Added time of compiling a shader, for tests.
    compiling: Option<Duration>,
}

impl GpuDevice {
    /// Opens the device of an adapter.
    pub fn new(choice: &AdapterChoice) -> Result<Self, GpuError> {
        let mut choice = choice.clone();
        if choice.name.is_none() {
            choice.name = std::env::var("WGPU_ADAPTER_NAME")
                .ok()
                .filter(|name| !name.is_empty());
        }
        let found = enumerate(&instance());
        let descriptions: Vec<_> = found.iter().map(describe).collect();
        let place = choose(&descriptions, &choice)?;
        let adapter = &found[place];
        let mut description = descriptions[place].clone();
        let faults = choice.faults();
        description.limits = faults.narrowed(description.limits);
        description.double &= !(faults.without_double || faults.plain_sums);
        let loops = match description.software() && !faults.unrolled {
            true => Loops::Kept,
            false => Loops::Unrolled,
        };
        // Timestamps cost nothing until they are asked for.
        let mut required_features = adapter.features() & wgpu::Features::TIMESTAMP_QUERY;
        if description.double {
            required_features |= wgpu::Features::SHADER_F64;
        }
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("tabor"),
            required_features,
            required_limits: adapter.limits(),
            ..Default::default()
        }))
        .map_err(|error| GpuError::NoDevice {
            adapter: description.name.clone(),
            reason: error.to_string(),
        })?;
        let lost = Arc::new(OnceLock::new());
        let first = Arc::clone(&lost);
        device.set_device_lost_callback(move |reason, message| {
            let _ = first.set(format!("the device was lost ({reason:?}): {message}"));
        });
        // Without a handler an error outside of every scope would end the program.
        let first = Arc::clone(&lost);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            let _ = first.set(error.to_string());
        }));
        let device = GpuDevice {
            inner: Arc::new(Inner {
                device,
                queue,
                description,
                pipelines: Pipelines::default(),
                transfers: Mutex::default(),
                loops,
                lost,
                plain_sums: OnceLock::new(),
                left: faults.lost_after.map(AtomicU64::new),
                sound: faults.not_a_number_after.map(AtomicU64::new),
                memory: faults.memory.map(AtomicU64::new),
                compiling: faults.compiling.map(Duration::from_millis),
            }),
        };
        if device.wide() == Wide::Compensated {
            let survive = !faults.plain_sums && GpuBackend::new(&device)?.sums_survive()?;
            let _ = device.inner.plain_sums.set(!survive);
        }
        Ok(device)
    }

    /// The adapter's description.
    pub fn description(&self) -> &AdapterDescription {
        &self.inner.description
    }

    /// The number type of sums on this device.
    pub fn wide(&self) -> Wide {
        let features = self.inner.device.features();
        if features.contains(wgpu::Features::SHADER_F64) {
            Wide::Double
        } else if self.inner.plain_sums.get() == Some(&true) {
            Wide::Single
        } else {
            Wide::Compensated
        }
    }

    /// What becomes of the loops of its shaders.
    pub(super) fn loops(&self) -> Loops {
        self.inner.loops
    }

    /// Whether both are the same device.
    pub(super) fn is(&self, other: &GpuDevice) -> bool {
        Arc::ptr_eq(&self.inner, &other.inner)
    }

    /// Limits of its bindings and workgroups.
    pub fn limits(&self) -> Limits {
        self.inner.description.limits
    }

    /// Number of buffers that a field of this shape is split into in single precision.
    pub fn slabs(&self, shape: Shape) -> Result<usize, GpuError> {
        LevelPlan::laid_out(shape, &self.limits(), Number::Single).map(|plan| plan.slabs)
    }

    /// Counts a dispatch, and destroys the device if it is to be lost now.
    pub(super) fn count_dispatch(&self) {
        if let Some(left) = &self.inner.left
            && left.fetch_sub(1, Ordering::Relaxed) == 1
        {
            self.inner.device.destroy();
        }
    }

    /// Counts a dispatch; says whether fields are to be set to NaN after it.
    pub(super) fn poisons(&self) -> bool {
        let sound = self.inner.sound.as_ref();
        sound.is_some_and(|sound| sound.fetch_sub(1, Ordering::Relaxed) == 1)
    }

    /// A storage buffer of zeros.
    pub(super) fn allocate(&self, name: &str, bytes: usize) -> Result<wgpu::Buffer, GpuError> {
        let bytes_wanted = bytes as u64;
        let out_of_memory = || GpuError::OutOfMemory {
            adapter: self.description().name.clone(),
            name: name.to_string(),
            bytes: bytes_wanted,
        };
        if let Some(memory) = &self.inner.memory {
            let take = |left: u64| left.checked_sub(bytes_wanted);
            memory
                .fetch_update(Ordering::Relaxed, Ordering::Relaxed, take)
                .map_err(|_| out_of_memory())?;
        }
        let make =
            |device: &wgpu::Device| space::buffer(device, name, bytes, wgpu::BufferUsages::STORAGE);
        self.guarded(make).map_err(|error| match error {
            GpuError::OutOfMemory { .. } => out_of_memory(),
            other => other,
        })
    }

    pub(super) fn queue(&self) -> &wgpu::Queue {
        &self.inner.queue
    }

    /// Whether the device was lost: nothing computes on it any more.
    pub fn is_lost(&self) -> bool {
        self.loss().is_some()
    }

    /// Why the device was lost, if it was.
    pub(super) fn loss(&self) -> Option<GpuError> {
        self.inner
            .lost
            .get()
            .map(|reason| GpuError::Device(reason.clone()))
    }

    /// Calls a function with the device and returns its errors.
    pub(super) fn guarded<R>(&self, work: impl FnOnce(&wgpu::Device) -> R) -> Result<R, GpuError> {
        match self.watched(work) {
            (_, Some(error)) => Err(error),
            (result, None) => Ok(result),
        }
    }

    /// The same, with the result; a handle to an object that could not be made must not be used.
    pub(super) fn watched<R>(
        &self,
        work: impl FnOnce(&wgpu::Device) -> R,
    ) -> (R, Option<GpuError>) {
        let _waits = InDriver::enter();
        let device = &self.inner.device;
        let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let internal = device.push_error_scope(wgpu::ErrorFilter::Internal);
        let validation = device.push_error_scope(wgpu::ErrorFilter::Validation);
        let result = work(device);
        let errors = [
            pollster::block_on(validation.pop()),
            pollster::block_on(internal.pop()),
            pollster::block_on(memory.pop()),
        ];
        let failure = errors
            .into_iter()
            .flatten()
            .next()
            .map(|error| match error {
                wgpu::Error::OutOfMemory { .. } => GpuError::OutOfMemory {
                    adapter: self.description().name.clone(),
                    name: "a buffer".to_string(),
                    bytes: 0,
                },
                other => GpuError::Device(other.to_string()),
            });
        (result, failure.or_else(|| self.loss()))
    }

    /// Its shaders.
    pub(super) fn pipelines(&self) -> &Pipelines {
        &self.inner.pipelines
    }

    /// Waits for the device. Where the driver says meanwhile that it is lost, wgpu panics; here that is an error as well.
    pub(super) fn wait(&self, until: wgpu::PollType) -> Result<(), GpuError> {
        let waited =
            self.guarded(|device| catch_unwind(AssertUnwindSafe(|| device.poll(until))))?;
        let error = match waited {
            Ok(Ok(_)) => return Ok(()),
            Ok(Err(error)) => error.to_string(),
            Err(panic) => panic
                .downcast_ref::<String>()
                .map_or_else(|| "the device is lost".to_string(), String::clone),
        };
        Err(GpuError::Device(error))
    }

    /// Calls a function with what fields pass through. The lock is not held meanwhile: all threads convert a field, and one of
    /// them may take up other work on this device.
    pub(super) fn transfer<R>(&self, work: impl FnOnce(&mut Transfers) -> R) -> R {
        let held = || {
            let held = self.inner.transfers.lock();
            held.unwrap_or_else(PoisonError::into_inner)
        };
        let mut transfers = std::mem::take(&mut *held());
        let result = work(&mut transfers);
        *held() = transfers;
        result
    }

    /// A shader compiled with the layouts of its groups.
    pub(super) fn compiled(
        &self,
        name: &str,
        source: &str,
        layouts: &[wgpu::BindGroupLayout],
    ) -> Result<wgpu::ComputePipeline, GpuError> {
        self.guarded(|device| {
            if let Some(time) = self.inner.compiling {
                std::thread::sleep(time);
            }
            let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(name),
                source: wgpu::ShaderSource::Wgsl(source.into()),
            });
            let layouts: Vec<_> = layouts.iter().map(Some).collect();
            let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(name),
                bind_group_layouts: &layouts,
                immediate_size: 0,
            });
            device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(name),
                layout: Some(&layout),
                module: &module,
                entry_point: Some(name),
                compilation_options: wgpu::PipelineCompilationOptions {
                    // Every kernel writes its workgroup memory before it reads it.
                    zero_initialize_workgroup_memory: false,
                    ..Default::default()
                },
                cache: None,
            })
        })
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::backend::gpu::quietly;

    /// The software driver's device, where there is one.
    pub fn software_device() -> Option<GpuDevice> {
        let choice = AdapterChoice {
            software: true,
            ..AdapterChoice::default()
        };
        // Without the output of its driver.
        let made = quietly(|| GpuDevice::new(&choice)).expect("no panic");
        if made.is_err() {
            let required = std::env::var("TABOR_REQUIRE_GPU").is_ok_and(|value| value == "1");
            assert!(!required, "TABOR_REQUIRE_GPU is set");
        }
        made.ok()
    }

    /// A buffer larger than any device's memory and a shader that is not WGSL: wgpu's errors come back as
    /// tabor's.
    #[test]
    fn what_a_device_cannot_do_is_an_error() {
        let Some(device) = software_device() else {
            return;
        };
        let refused = device.allocate("far too long", 1 << 50);
        assert!(refused.is_err(), "{refused:?}");
        let refused = device.pipeline("nothing", "no shader".to_string(), Vec::new());
        let refused = refused.ready();
        assert!(refused.is_err(), "{refused:?}");
        assert!(device.allocate("short", 16).is_ok());
    }
}
