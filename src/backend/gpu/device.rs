//! Adapters and devices: which one is taken, what it allows, and how its failures are caught.

use std::collections::HashMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use super::GpuBackend;
use super::error::GpuError;
use super::layout::{Number, Wide};
use super::level::LevelPlan;
use super::plan::GroupLimits;
use super::slabs::{LONGEST_BINDING, Limits};
use super::space;
use crate::backend::Shape;

/// Which adapter to take.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct AdapterChoice {
    /// Part of its name, in any case; also from the environment variable `WGPU_ADAPTER_NAME`.
    pub name: Option<String>,
    /// Whether a driver that computes on the processor will do. It is slower there than this
    /// program's own CPU backend, so only tests and explicit wishes want it.
    pub software: bool,
    /// Whether the device is taken for one without double precision: for tests of what such devices do.
    pub without_double: bool,
    /// Bytes that may be bound at a time, where that is to be less than the adapter takes: for tests of
    /// grids past the limits.
    pub binding_limit: Option<u64>,
    /// Bytes of a field that go into one buffer, where that is to be less than the adapter binds: for
    /// tests of grids in several slabs.
    pub slab_bytes: Option<u64>,
    /// Dispatches after which the device is given up: for tests of its loss.
    pub lost_after: Option<u64>,
    /// Bytes after which it has no memory left: for tests of that.
    pub memory: Option<u64>,
    /// Dispatches after which some number of each field is none: for tests of that.
    pub not_a_number_after: Option<u64>,
    /// Whether compensated sums are taken to come out wrong: for tests of plain ones.
    pub plain_sums: bool,
}

impl AdapterChoice {
    /// An adapter's limits, narrowed as the tests ask.
    pub fn narrowed(&self, limits: Limits) -> Limits {
        let binding = limits.binding.min(self.binding_limit.unwrap_or(u64::MAX));
        let slab = binding.min(self.slab_bytes.unwrap_or(u64::MAX));
        Limits {
            binding,
            slab,
            ..limits
        }
    }
}

/// An adapter in words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AdapterDescription {
    /// Its name.
    pub name: String,
    /// The interface through which it is reached, as `Vulkan`.
    pub interface: String,
    /// The driver and its version, as it says.
    pub driver: String,
    /// What computes behind it.
    pub kind: AdapterKind,
    /// Whether it has double precision.
    pub double: bool,
    /// What it binds and what a workgroup may hold.
    pub limits: Limits,
}

/// What computes behind an adapter, best first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum AdapterKind {
    /// A graphics card of its own memory.
    Discrete,
    /// A graphics processor that shares the memory.
    Integrated,
    /// One lent by a host.
    Virtual,
    /// Something else.
    Other,
    /// The processor itself.
    Software,
}

impl AdapterKind {
    /// The kind in words.
    pub fn name(self) -> &'static str {
        match self {
            AdapterKind::Discrete => "discrete GPU",
            AdapterKind::Integrated => "integrated GPU",
            AdapterKind::Virtual => "virtual GPU",
            AdapterKind::Other => "device of another kind",
            AdapterKind::Software => "software, computes on the processor",
        }
    }
}

impl AdapterDescription {
    /// Whether it computes on the processor.
    pub fn software(&self) -> bool {
        self.kind == AdapterKind::Software
    }

    /// Whether its transforms and bindings take fields of so many points each way in this number.
    pub fn takes(&self, points: [usize; 2], number: Number) -> bool {
        let shape = Shape::whole(points[0], points[1]);
        LevelPlan::laid_out(shape, &self.limits, number).is_ok()
    }

    /// Points along the side of the largest square grid whose fields in this number its transforms and
    /// bindings take.
    pub fn largest_side(&self, number: Number) -> usize {
        self.limits.largest_side(number)
    }
}

fn group_limits(limits: &wgpu::Limits) -> GroupLimits {
    let threads = limits
        .max_compute_invocations_per_workgroup
        .min(limits.max_compute_workgroup_size_x)
        .min(limits.max_compute_workgroup_size_y);
    GroupLimits {
        threads: threads as usize,
        memory: limits.max_compute_workgroup_storage_size as usize,
    }
}

fn limits(found: &wgpu::Limits) -> Limits {
    let binding = found
        .max_storage_buffer_binding_size
        .min(found.max_buffer_size)
        .min(LONGEST_BINDING);
    Limits {
        group: group_limits(found),
        binding,
        slab: binding,
        bindings: found.max_storage_buffers_per_shader_stage as usize,
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
    pipelines: Mutex<HashMap<String, wgpu::ComputePipeline>>,
    lost: Arc<OnceLock<String>>,
    /// Whether the compiler undoes compensated sums.
    plain_sums: OnceLock<bool>,
    /// Dispatches left before the device is given up, where it is to be.
    left: Option<AtomicU64>,
    /// Dispatches left before numbers are none, where they are to be.
    sound: Option<AtomicU64>,
    /// Bytes left, where they are counted.
    memory: Option<AtomicU64>,
}

fn instance() -> wgpu::Instance {
    wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env())
}

fn describe(adapter: &wgpu::Adapter) -> AdapterDescription {
    let info = adapter.get_info();
    AdapterDescription {
        interface: format!("{:?}", info.backend),
        driver: [info.driver, info.driver_info].join(" ").trim().to_string(),
        kind: match info.device_type {
            wgpu::DeviceType::DiscreteGpu => AdapterKind::Discrete,
            wgpu::DeviceType::IntegratedGpu => AdapterKind::Integrated,
            wgpu::DeviceType::VirtualGpu => AdapterKind::Virtual,
            wgpu::DeviceType::Other => AdapterKind::Other,
            wgpu::DeviceType::Cpu => AdapterKind::Software,
        },
        double: adapter.features().contains(wgpu::Features::SHADER_F64),
        limits: limits(&adapter.limits()),
        name: info.name,
    }
}

/// All adapters that drivers offer here.
pub fn adapters() -> Vec<AdapterDescription> {
    enumerate(&instance()).iter().map(describe).collect()
}

fn enumerate(instance: &wgpu::Instance) -> Vec<wgpu::Adapter> {
    pollster::block_on(instance.enumerate_adapters(wgpu::Backends::all()))
}

/// The place of the adapter to take among those there are.
fn choose(found: &[AdapterDescription], choice: &AdapterChoice) -> Result<usize, GpuError> {
    if let Some(wanted) = &choice.name {
        let lower = wanted.to_lowercase();
        return found
            .iter()
            .position(|adapter| adapter.name.to_lowercase().contains(&lower))
            .ok_or_else(|| GpuError::NoSuchAdapter {
                wanted: wanted.clone(),
                found: match found {
                    [] => "none".to_string(),
                    _ => found
                        .iter()
                        .map(|adapter| format!("`{}`", adapter.name))
                        .collect::<Vec<_>>()
                        .join(", "),
                },
            });
    }
    found
        .iter()
        .enumerate()
        .filter(|(_, adapter)| choice.software || !adapter.software())
        .map(|(place, adapter)| (adapter.kind, place))
        .min()
        .map(|(_, place)| place)
        .ok_or_else(|| {
            GpuError::NoAdapter(match found {
                [] => String::new(),
                _ => format!(" but {}, which computes on the processor", found[0].name),
            })
        })
}

impl GpuDevice {
    /// Takes an adapter and readies its device.
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
        description.limits = choice.narrowed(description.limits);
        description.double &= !(choice.without_double || choice.plain_sums);
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
                pipelines: Mutex::new(HashMap::new()),
                lost,
                plain_sums: OnceLock::new(),
                left: choice.lost_after.map(AtomicU64::new),
                sound: choice.not_a_number_after.map(AtomicU64::new),
                memory: choice.memory.map(AtomicU64::new),
            }),
        };
        if device.wide() == Wide::Compensated {
            let survive = !choice.plain_sums && GpuBackend::new(&device)?.sums_survive()?;
            let _ = device.inner.plain_sums.set(!survive);
        }
        Ok(device)
    }

    /// The adapter in words.
    pub fn description(&self) -> &AdapterDescription {
        &self.inner.description
    }

    /// The number in which sums are kept here.
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

    /// Whether both are one.
    pub(super) fn is(&self, other: &GpuDevice) -> bool {
        Arc::ptr_eq(&self.inner, &other.inner)
    }

    /// What it binds and what a workgroup may hold.
    pub fn limits(&self) -> Limits {
        self.inner.description.limits
    }

    /// Buffers that a field of this shape in single precision is cut into.
    pub fn slabs(&self, shape: Shape) -> Result<usize, GpuError> {
        LevelPlan::laid_out(shape, &self.limits(), Number::Single).map(|plan| plan.slabs)
    }

    /// Counts a dispatch, and gives the device up where it is to be lost.
    pub(super) fn count_dispatch(&self) {
        if let Some(left) = &self.inner.left
            && left.fetch_sub(1, Ordering::Relaxed) == 1
        {
            self.inner.device.destroy();
        }
    }

    /// Counts a dispatch towards that after which numbers are none; whether this is the one.
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

    /// What ended the device, if it is no more.
    pub(super) fn loss(&self) -> Option<GpuError> {
        self.inner
            .lost
            .get()
            .map(|reason| GpuError::Device(reason.clone()))
    }

    /// Does something with the device and catches what it has to say against it.
    pub(super) fn guarded<R>(&self, work: impl FnOnce(&wgpu::Device) -> R) -> Result<R, GpuError> {
        match self.watched(work) {
            (_, Some(error)) => Err(error),
            (result, None) => Ok(result),
        }
    }

    /// The same, with what came of it; handles to what could not be made are not to be used.
    pub(super) fn watched<R>(
        &self,
        work: impl FnOnce(&wgpu::Device) -> R,
    ) -> (R, Option<GpuError>) {
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

    /// Compiles a shader, or finds it among those compiled before.
    pub(super) fn pipeline(
        &self,
        name: &str,
        source: String,
        layouts: &[&wgpu::BindGroupLayout],
    ) -> Result<wgpu::ComputePipeline, GpuError> {
        let mut pipelines = self
            .inner
            .pipelines
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        if let Some(pipeline) = pipelines.get(&source) {
            return Ok(pipeline.clone());
        }
        let pipeline = self.guarded(|device| {
            let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(name),
                source: wgpu::ShaderSource::Wgsl(source.as_str().into()),
            });
            let layouts: Vec<_> = layouts.iter().map(|&layout| Some(layout)).collect();
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
        })?;
        pipelines.insert(source, pipeline.clone());
        Ok(pipeline)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn adapter(name: &str, kind: AdapterKind) -> AdapterDescription {
        AdapterDescription {
            name: name.to_string(),
            interface: "Vulkan".to_string(),
            driver: String::new(),
            kind,
            double: true,
            limits: Limits {
                group: GroupLimits {
                    threads: 1024,
                    memory: 32768,
                },
                binding: 1 << 27,
                slab: 1 << 27,
                bindings: 32,
            },
        }
    }

    #[test]
    fn a_software_adapter_is_taken_only_where_it_will_do() {
        let found = [
            adapter("software", AdapterKind::Software),
            adapter("small", AdapterKind::Integrated),
            adapter("Large One", AdapterKind::Discrete),
        ];
        let mut choice = AdapterChoice::default();
        assert_eq!(choose(&found, &choice), Ok(2));
        assert_eq!(choose(&found[..2], &choice), Ok(1));
        let refused = choose(&found[..1], &choice);
        assert!(matches!(refused, Err(GpuError::NoAdapter(_))));
        choice.software = true;
        assert_eq!(choose(&found[..1], &choice), Ok(0));
        assert_eq!(choose(&found, &choice), Ok(2));
        choice.name = Some("SMALL".to_string());
        assert_eq!(choose(&found, &choice), Ok(1));
        choice.name = Some("other".to_string());
        let refused = choose(&found, &choice).map_err(|error| error.to_string());
        assert_eq!(
            refused,
            Err("no graphics adapter has `other` in its name; there are: `software`, `small`, `Large One`".to_string())
        );
        assert!(choose(&[], &AdapterChoice::default()).is_err());
    }

    #[test]
    fn the_largest_grid_keeps_both_limits() {
        let mut found = adapter("one", AdapterKind::Discrete);
        let (single, double) = (Number::Single, Number::Double);
        // Eight slabs of 128 MiB, of the 28 that 32 bindings leave; lines of two numbers in 32 KiB.
        assert_eq!(found.largest_side(single), 16384);
        assert_eq!(found.largest_side(double), 8192);
        found.limits.slab = 1 << 20;
        // 16 MiB in sixteen slabs; four times as many would not be bound together.
        assert_eq!(found.largest_side(single), 2048);
        assert_eq!(found.largest_side(double), 1024);
        found.limits.bindings = 8;
        // Four slabs beside four other buffers.
        assert_eq!(found.largest_side(single), 1024);
        assert!(found.takes([4096, 256], single) && !found.takes([4096, 258], single));
        assert!(!found.takes([4096, 256], double));
        assert!(!found.takes([32768, 2], single));
    }

    /// More than any device has, in one buffer and in a kernel's text: wgpu's own errors come back as
    /// ours.
    #[test]
    fn what_a_device_cannot_do_is_an_error() {
        let choice = AdapterChoice {
            software: true,
            ..AdapterChoice::default()
        };
        let Ok(device) = GpuDevice::new(&choice) else {
            let required = std::env::var("TABOR_REQUIRE_GPU").is_ok_and(|value| value == "1");
            assert!(!required, "TABOR_REQUIRE_GPU is set");
            return;
        };
        let refused = device.allocate("far too long", 1 << 50);
        assert!(refused.is_err(), "{refused:?}");
        let refused = device.pipeline("nothing", "no shader".to_string(), &[]);
        assert!(refused.is_err(), "{refused:?}");
        assert!(device.allocate("short", 16).is_ok());
    }
}
