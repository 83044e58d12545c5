//! Which graphics processor is taken, and whether it takes the grid.

use super::adapters;
use super::error::DeviceError;
use super::selection::Place;
use crate::backend::gpu::{
    AdapterChoice, AdapterDescription, GpuDevice, GpuError, Number, Wide, radices,
};
use crate::scene::{Boundary, Precision, Scene};
use crate::study::Setup;

/// What the command line calls the processor, in remarks on the choice.
const PROCESSOR: &str = "--backend cpu";

/// The graphics processor that a scene asks for by name, with a remark.
///
/// # Errors
/// None that can be used, or none that takes the grid in the scene's precision.
pub(super) fn asked(setup: &Setup, verbose: bool) -> Result<(Place, Option<String>), DeviceError> {
    check_points(setup.problem.shape.points)?;
    let choice = AdapterChoice {
        software: true,
        ..choice()
    };
    let device = adapters::open(&choice, verbose)?;
    let found = device.description();
    let precision = setup.scene.arithmetic_on_gpu();
    if precision == Precision::Double && !found.double {
        return Err(GpuError::Precision(found.name.clone()).into());
    }
    check_limits(setup, found, number(precision))?;
    let remark = found.software().then(|| {
        format!(
            "on {}, which is software on the processor: {PROCESSOR} is faster",
            found.name
        )
    });
    Ok((Place::Gpu(device), remark))
}

/// The number of the fields on a graphics processor.
pub(super) fn number(precision: Precision) -> Number {
    match precision {
        Precision::Double => Number::Double,
        // What corrects in mixed precision goes where it fits.
        Precision::Auto | Precision::Single | Precision::Mixed => Number::Single,
    }
}

/// Any adapter.
#[cfg(not(feature = "fault-injection"))]
fn choice() -> AdapterChoice {
    AdapterChoice::default()
}

/// The adapter that the environment asks for: `TABOR_TEST_GPU`, for tests of what no sound adapter
/// does, is a list of `software` (`auto` takes it for a graphics processor), `nodouble` (it has no
/// double precision), `binding=BYTES` (it binds no more), `slab=BYTES` (a buffer holds no more of a
/// field), `line=POINTS` (a workgroup holds no longer line), `memory=BYTES` (it has no more),
/// `lost=DISPATCHES` (it is lost after so many), `nan=DISPATCHES` (numbers are NaN after so many),
/// `compiling=MILLISECONDS` (a shader takes so much longer to compile),
/// `plain-sums` (its compiler undoes the compensation of sums) and `unrolled` (a software driver gets
/// the shaders of a graphics processor).
#[cfg(feature = "fault-injection")]
fn choice() -> AdapterChoice {
    let asked = std::env::var("TABOR_TEST_GPU").unwrap_or_default();
    let number = |key: &str| -> Option<u64> {
        asked
            .split(',')
            .find_map(|word| word.strip_prefix(key)?.strip_prefix('='))
            .and_then(|value| value.parse().ok())
    };
    AdapterChoice {
        software: asked.split(',').any(|word| word == "software"),
        faults: crate::backend::gpu::Faults {
            without_double: asked.split(',').any(|word| word == "nodouble"),
            binding_limit: number("binding"),
            slab_bytes: number("slab"),
            longest_line: number("line").map(|points| points as usize),
            lost_after: number("lost"),
            memory: number("memory"),
            not_a_number_after: number("nan"),
            compiling: number("compiling"),
            plain_sums: asked.split(',').any(|word| word == "plain-sums"),
            unrolled: asked.split(',').any(|word| word == "unrolled"),
        },
        ..AdapterChoice::default()
    }
}

/// The remark on a device whose compiler undoes compensated sums.
pub(super) fn plain_sums(device: &GpuDevice) -> Option<String> {
    (device.wide() == Wide::Single).then(|| {
        format!(
            "{} adds in plain single precision: it has no double, and its driver undoes the compensation of sums",
            device.description().name
        )
    })
}

/// A graphics processor that is one, where the grid is worth it; else the processor. Says why only
/// where there is a choice.
pub(super) fn best_for(setup: &Setup, verbose: bool) -> (Place, Option<String>) {
    let settings = &setup.scene.solver;
    let choice = choice();
    let precision = setup.scene.arithmetic_on_gpu();
    let in_double = precision == Precision::Double;
    if !choice.software && !setup.scene.looks_for_adapters(setup.problem.shape.len()) {
        return (Place::Processor, None);
    }
    // No adapter transforms these points, so none is asked for.
    if check_points(setup.problem.shape.points).is_err() {
        return (Place::Processor, None);
    }
    let mut found = adapters::list(verbose);
    for adapter in &mut found {
        adapter.limits = choice.faults().narrowed(adapter.limits);
        adapter.double &= !choice.faults().without_double;
    }
    let chosen = if choice.software {
        found.first()
    } else {
        best(&found)
    };
    let Some(best) = chosen else {
        return (Place::Processor, None);
    };
    let stays = |why: String| {
        let remark = format!("on the processor, not on {}: {why}", best.name);
        (Place::Processor, Some(remark))
    };
    if in_double && !best.double {
        return stays("it has no double precision".to_owned());
    }
    if let Err(error) = check_limits(setup, best, number(precision)) {
        return stays(error.in_words(PROCESSOR));
    }
    match adapters::open(&choice, verbose) {
        Ok(device) if device.description().software() && !choice.software => {
            stays("WGPU_ADAPTER_NAME names one that computes on the processor".to_owned())
        }
        Ok(device) => {
            let why = match (settings.precision, precision) {
                (Precision::Auto, Precision::Double) => ", for the solid flows",
                (Precision::Auto, Precision::Mixed) => {
                    ", for the tolerance is below its floor in single"
                }
                (Precision::Auto, _) => ", which the tolerance allows",
                _ => "",
            };
            let remark = format!(
                "on {}, in {} precision{why}",
                device.description().name,
                precision.name()
            );
            (Place::Gpu(device), Some(remark))
        }
        Err(error) => stays(error.to_string()),
    }
}

/// Whether an adapter could take the grid of a scene, as far as that is known before its surface is built.
pub(super) fn may_take_adapters(scene: &Scene) -> bool {
    let solved = |points: [usize; 2]| match scene.grid.boundary {
        Boundary::Periodic => points,
        Boundary::Free => points.map(|count| count.saturating_mul(2)),
    };
    let points = scene.grid.points.map(solved);
    // A grid that is finer or coarser by halves has the same prime factors.
    points.is_none_or(|points| {
        let even = points.map(|count| count.saturating_mul(2));
        even.into_iter().all(|count| radices(count).is_some())
    })
}

/// The adapter that `auto` takes where it can: the best one that is no software.
pub fn best(found: &[AdapterDescription]) -> Option<&AdapterDescription> {
    found
        .iter()
        .filter(|adapter| !adapter.software())
        .min_by_key(|adapter| adapter.kind)
}

/// The largest grid of the adapter that `--backend gpu` takes here, in words.
pub fn largest_here(boundary: Boundary, verbose: bool) -> String {
    let found = adapters::list(verbose);
    match best(&found).or(found.first()) {
        None => "no adapter here".to_owned(),
        Some(adapter) => {
            let side = largest_with(adapter, boundary, Number::Single);
            let single = format!("{side} x {side} points in single and mixed precision");
            let double = match adapter.double {
                true => {
                    let side = largest_with(adapter, boundary, Number::Double);
                    format!(", {side} x {side} in double")
                }
                false => String::new(),
            };
            format!("{single}{double}, on {}", adapter.name)
        }
    }
}

/// Points along the side of the largest square surface that an adapter takes.
fn largest_with(adapter: &AdapterDescription, boundary: Boundary, number: Number) -> usize {
    let largest = adapter.largest_side(number);
    match boundary {
        Boundary::Periodic => largest,
        Boundary::Free => largest / 2,
    }
}

/// Refuses grids that are past what an adapter transforms and binds.
fn check_limits(
    setup: &Setup,
    adapter: &AdapterDescription,
    number: Number,
) -> Result<(), DeviceError> {
    let shape = setup.problem.shape;
    if adapter.takes(shape.points, number) {
        return Ok(());
    }
    Err(DeviceError::Limits {
        points: shape.surface,
        adapter: adapter.name.clone(),
        side: largest_with(adapter, setup.scene.grid.boundary, number),
        in_double: number == Number::Double,
    })
}

/// Refuses solved points that have no transform on a graphics processor.
///
/// # Errors
/// The nearest points that have one.
pub fn check_points(points: [usize; 2]) -> Result<(), DeviceError> {
    let is_good = |points: usize| radices(points).is_some();
    if points.into_iter().all(is_good) {
        return Ok(());
    }
    let near = |points: usize| -> String {
        if is_good(points) {
            return points.to_string();
        }
        let below = (2..points).rev().find(|&size| is_good(size));
        let above = crate::solver::good_size(points);
        match below {
            Some(below) => format!("{below} or {above}"),
            None => above.to_string(),
        }
    };
    let [nx, ny] = points;
    let instead = if nx == ny {
        near(nx)
    } else {
        format!("{} along x, {} along y", near(nx), near(ny))
    };
    Err(DeviceError::Points { points, instead })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::backend::gpu::{AdapterKind, GroupLimits, Limits};

    #[test]
    fn auto_never_takes_software() {
        let adapter = |name: &str, kind| AdapterDescription {
            name: name.to_owned(),
            interface: "Vulkan".to_owned(),
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
        };
        let found = [
            adapter("software", AdapterKind::Software),
            adapter("small", AdapterKind::Integrated),
            adapter("large", AdapterKind::Discrete),
        ];
        assert_eq!(best(&found[..1]), None);
        assert_eq!(best(&found[..2]), Some(&found[1]));
        assert_eq!(best(&found), Some(&found[2]));
    }
}
