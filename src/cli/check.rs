//! `tabor check`: what a scene would do and cost.

use super::{CheckArguments, Failure, print, read_scene, warn};
use crate::backend::tally::Place;
use crate::effect::Effect;
use crate::run::memory_check;
use crate::study::{Cost, Memory, Plan};
use crate::surface::Source;
use crate::units::format_si;

/// Reads and validates a scene and prints what it found.
pub(super) fn check(arguments: &CheckArguments) -> Result<(), Failure> {
    let scene = read_scene(&arguments.scene, &arguments.set)?;
    memory_check::check_files(&scene)?;
    let plan = Plan::of(scene).map_err(|error| Failure::Surface {
        path: arguments.scene.clone(),
        error,
    })?;
    let place = Place::of(&plan.scene);
    let cost = plan.cost(place)?;
    #[cfg(feature = "gpu")]
    if place.on_gpu() {
        crate::device::check_points(cost.points)?;
    }
    print(&describe(&plan, &cost, arguments.verbose)?)?;
    for warning in &plan.warnings {
        warn(warning);
    }
    // A scene may be looked at here and run elsewhere.
    if let Err(error) = memory_check::check_grid(&plan.scene, plan.outline.grid) {
        warn(&Failure::from(error).to_string());
    }
    Ok(())
}

fn mebibytes(bytes: u64) -> String {
    format!("{:.1} MiB", bytes as f64 / f64::from(1 << 20))
}

/// The report, line by line.
fn describe(plan: &Plan, cost: &Cost, verbose: bool) -> Result<String, Failure> {
    let scene = &plan.scene;
    let grid = plan.outline.grid;
    let moments = plan.outline.moments;
    let memory = Memory::of(scene, grid, cost);
    let mut lines = vec![
        format!(
            "grid          {} x {} points, {} x {}, {} boundary",
            grid.nx,
            grid.ny,
            format_si(grid.lx, "m"),
            format_si(grid.ly, "m"),
            scene.grid.boundary.name()
        ),
        format!(
            "solid         contact modulus {}",
            format_si(scene.solid.contact_modulus, "Pa")
        ),
        format!(
            "surface       rms height {}, rms slope {:.3e}, rms curvature {:.3e} 1/m ({})",
            format_si(moments.rms_height(), "m"),
            moments.rms_slope(),
            moments.rms_curvature(),
            match plan.outline.source {
                Source::Heights => "of the heights",
                Source::Spectrum => "of the spectrum on this grid",
                Source::Estimate => "estimated without the heights",
            }
        ),
        format!(
            "loading       {}, {} steps{}",
            scene.loading.control.name(),
            scene.loading.path.len(),
            step_times(scene.loading.durations.as_deref())
        ),
    ];
    if let Some(pixels) = plan.pixels_a_wave() {
        lines.push(format!(
            "waves         {pixels:.1} pixels across the shortest"
        ));
    }
    if let Some(regime) = &plan.regime {
        lines.push(format!(
            "law           {}: work of adhesion {}, range {}, peak tension {}{}",
            scene
                .adhesion
                .as_ref()
                .map_or("", |adhesion| adhesion.law.name()),
            format_si(plan.law.work_of_adhesion(), "J/m^2"),
            format_si(plan.law.range(), "m"),
            format_si(plan.law.peak_tension(), "Pa"),
            match plan.law {
                crate::law::Law::MaugisDugdale(law) if law.taper > 0.0 => {
                    format!(
                        ", taper {}: it attracts up to {}, and jump-in comes as much earlier",
                        format_si(law.taper, "m"),
                        format_si(law.range + 0.5 * law.taper, "m")
                    )
                }
                _ => String::new(),
            }
        ));
        let radius = if regime.radius.is_finite() {
            format!("radius {}", format_si(regime.radius, "m"))
        } else {
            "flat surface".to_owned()
        };
        lines.push(format!(
            "regime        Tabor number {:.3} ({radius}): {}",
            regime.tabor,
            regime.name()
        ));
        lines.push(format!(
            "resolution    {:.2} pixels across the cohesive zone, chi {:.3}",
            regime.zone_pixels, regime.chi
        ));
    }
    lines.push(format!(
        "memory        {} at most on this machine{}",
        mebibytes(memory.machine),
        if memory.adapter > 0 {
            format!(", {} on the adapter", mebibytes(memory.adapter))
        } else {
            String::new()
        }
    ));
    lines.push(format!(
        "solver        {} in {} fields, {} tables and the transforms' work space, in {}",
        mebibytes(memory.solver),
        cost.fields.len(),
        cost.spectra.len(),
        match cost.place {
            Place::Double => "double precision",
            Place::Single => "single precision",
            Place::Gpu => "single precision on the GPU",
            Place::GpuDouble => "double precision on the GPU",
        }
    ));
    #[cfg(feature = "gpu")]
    if cost.place == Place::Gpu {
        lines.push(format!(
            "largest       {}",
            crate::device::largest_here(scene.grid.boundary, verbose)
        ));
    }
    #[cfg(not(feature = "gpu"))]
    let _ = verbose;
    if !cost.reference.is_empty() {
        lines.push(format!(
            "corrections   {} of state in double precision on the {}",
            mebibytes(cost.reference_bytes() as u64),
            match cost.place.on_gpu() {
                true => "GPU where that has it, else on the processor",
                false => "processor",
            }
        ));
    }
    lines.push(format!(
        "fields        {}",
        join(cost.fields.iter().map(|field| field.name))
    ));
    lines.push(format!(
        "an iteration  {}",
        join(cost.passes.iter().copied())
    ));
    for effect in Effect::ALL {
        if !effect.is_on(scene) {
            lines.push(format!(
                "effect off    {}: no field, no pass",
                effect.name()
            ));
            continue;
        }
        lines.push(format!(
            "effect on     {}: {}",
            effect.name(),
            effect.purpose()
        ));
        lines.push(format!("              {}", effect.matters(plan)));
        let found = effect.cost(scene, cost, grid)?;
        lines.push(format!(
            "              fields {}; passes {}; {}{}",
            change(&found.fields_added, &found.fields_spared),
            change(&found.passes_added, &found.passes_spared),
            if found.bytes < 0 { "-" } else { "+" },
            mebibytes(u64::try_from(found.bytes.unsigned_abs()).unwrap_or(u64::MAX))
        ));
    }
    lines.push(String::new());
    Ok(lines.join("\n"))
}

fn join(names: impl Iterator<Item = &'static str>) -> String {
    names.collect::<Vec<_>>().join(", ")
}

/// As in `+2 (step, search), -1 (coarse)`.
fn change(added: &[&'static str], spared: &[&'static str]) -> String {
    let part = |sign: &str, names: &[&'static str]| {
        (!names.is_empty()).then(|| format!("{sign}{} ({})", names.len(), names.join(", ")))
    };
    let parts: Vec<String> = [part("+", added), part("-", spared)]
        .into_iter()
        .flatten()
        .collect();
    if parts.is_empty() {
        "the same".to_owned()
    } else {
        parts.join(", ")
    }
}

/// The shortest and the longest step of a path that says how long they take.
fn step_times(durations: Option<&[f64]>) -> String {
    let taking = durations.unwrap_or(&[]).iter().copied();
    let mut taking = taking.filter(|duration| *duration > 0.0);
    let Some(first) = taking.next() else {
        return String::new();
    };
    let (least, most) = taking.fold((first, first), |(least, most), duration| {
        (least.min(duration), most.max(duration))
    });
    if least == most {
        format!(" of {}", format_si(least, "s"))
    } else {
        format!(" of {} to {}", format_si(least, "s"), format_si(most, "s"))
    }
}
