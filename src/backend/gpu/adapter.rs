//! Adapters: listing them, their limits, and the choice of one.

use super::error::GpuError;
use super::faults::Faults;
use super::layout::Number;
use super::level::LevelPlan;
use super::plan::GroupLimits;
use super::slabs::{LONGEST_BINDING, Limits};
use crate::backend::Shape;

/// Which adapter to take.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct AdapterChoice {
    /// Part of its name, in any case; also from the environment variable `WGPU_ADAPTER_NAME`.
    pub name: Option<String>,
    /// Whether a software driver, which computes on the processor, is accepted. It is slower than the CPU
    /// backend, so only tests and explicit requests want it.
    pub software: bool,
    /// Faults injected by tests.
    #[cfg(feature = "fault-injection")]
    pub faults: Faults,
}

impl AdapterChoice {
    /// Faults injected by tests; none in a release.
    pub(crate) fn faults(&self) -> Faults {
        #[cfg(feature = "fault-injection")]
        let faults = self.faults;
        #[cfg(not(feature = "fault-injection"))]
        let faults = Faults::default();
        faults
    }

    /// Whether its device is made to fail.
    pub(crate) fn injects_faults(&self) -> bool {
        self.faults() != Faults::default()
    }
}

/// Description of an adapter.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AdapterDescription {
    /// Its name.
    pub name: String,
    /// The interface through which it is reached, as `Vulkan`.
    pub interface: String,
    /// Name and version of its driver.
    pub driver: String,
    /// The kind of processor behind it.
    pub kind: AdapterKind,
    /// Whether it has double precision.
    pub double: bool,
    /// Limits of its bindings and workgroups.
    pub limits: Limits,
}

/// The kind of processor behind an adapter, best first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum AdapterKind {
    /// A graphics card with its own memory.
    Discrete,
    /// A graphics processor that shares the machine's memory.
    Integrated,
    /// A virtual one, shared by a host.
    Virtual,
    /// Something else.
    Other,
    /// The processor itself.
    Software,
}

impl AdapterKind {
    /// Its name.
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

    /// Whether its transforms and bindings take fields of this many points along x and y in this number type.
    pub fn takes(&self, points: [usize; 2], number: Number) -> bool {
        let shape = Shape::whole(points[0], points[1]);
        LevelPlan::laid_out(shape, &self.limits, number).is_ok()
    }

    /// Points along the side of the largest square grid whose fields fit its transforms and bindings in this
    /// number type.
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
        longest_line: usize::MAX,
    }
}

pub(super) fn instance() -> wgpu::Instance {
    wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env())
}

pub(super) fn describe(adapter: &wgpu::Adapter) -> AdapterDescription {
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

pub(super) fn enumerate(instance: &wgpu::Instance) -> Vec<wgpu::Adapter> {
    pollster::block_on(instance.enumerate_adapters(wgpu::Backends::all()))
}

/// Index of the adapter to use.
pub(super) fn choose(
    found: &[AdapterDescription],
    choice: &AdapterChoice,
) -> Result<usize, GpuError> {
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
                longest_line: usize::MAX,
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
        // Eight slabs of 128 MiB and sixteen, of the 28 that 32 bindings leave, but for a spare half of
        // longer columns; a workgroup of 32 KiB holds half of such a line in double.
        assert_eq!(found.largest_side(single), 16384);
        assert_eq!(found.largest_side(double), 16384);
        found.limits.slab = 1 << 20;
        // 16 MiB in sixteen slabs; four times as many would not be bound together.
        assert_eq!(found.largest_side(single), 2048);
        assert_eq!(found.largest_side(double), 1024);
        found.limits.bindings = 8;
        // Four slabs beside four other buffers.
        assert_eq!(found.largest_side(single), 1024);
        assert!(found.takes([4096, 256], single) && !found.takes([4096, 258], single));
        assert!(!found.takes([4096, 256], double));
        // Lines of any length.
        assert!(found.takes([65536, 2], single) && found.takes([2, 65536], double));
    }
}
