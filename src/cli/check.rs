//! `tabor check`: physics, accuracy, memory and cost of a scene, without solving it.

use std::f64::consts::PI;

use super::{CheckArguments, Failure, print, warn};
use crate::backend::dry_run::Place;
use crate::effect::Effect;
use crate::law::Law;
use crate::run::memory_check;
use crate::scene::{Boundary, Control};
use crate::study::{Cost, Memory, Plan};
use crate::surface::{Source, Top};
use crate::theory::{Sphere, hertz};
use crate::units::format_si;

/// Reads and validates a scene and prints a report.
pub(super) fn check(arguments: &CheckArguments) -> Result<(), Failure> {
    let scene = arguments.scene.read()?;
    let ranks = arguments.ranks.map_or(1, usize::from);
    memory_check::check_files(&scene, ranks)?;
    let plan = Plan::for_scene(scene).map_err(|error| arguments.scene.surface_failure(error))?;
    let place = plan.place();
    let cost = plan.cost(place)?;
    #[cfg(feature = "gpu")]
    if place.on_gpu() {
        crate::device::check_points(cost.points)?;
    }
    let mut report = describe(&plan, &cost, arguments.verbose)?;
    if arguments.ranks.is_some() {
        report += &on_ranks(&plan, &cost, ranks);
    }
    print(&report)?;
    for warning in &plan.warnings {
        warn(warning);
    }
    if let Some(warning) = wider_than_grid(&plan) {
        warn(&warning);
    }
    // A scene may be looked at here and run elsewhere.
    if let Err(error) = memory_check::check_grid(&plan.scene, plan.outline.grid) {
        warn(&Failure::from(error).to_string());
    }
    Ok(())
}

/// A warning of a sphere whose contact is bound to reach the edge of a free grid. The run warns where it does.
///
/// Of adhesion it takes DMT's pull-off force as a load, and of an approach Hertz's radius: less than any contact has.
fn wider_than_grid(plan: &Plan) -> Option<String> {
    let (scene, grid) = (&plan.scene, plan.outline.grid);
    let (solid, loading) = (&scene.solid, &scene.loading);
    let is_plain = solid.layer.is_none() && !solid.remembers() && loading.spring.is_none();
    if scene.grid.boundary != Boundary::Free || !is_plain {
        return None;
    }
    let most = loading.path.iter().copied().fold(0.0, f64::max);
    let work = if plan.law.is_adhesive() && plan.outline.map.is_none() {
        plan.law.work_of_adhesion()
    } else {
        0.0
    };
    let sphere = Sphere::new(
        plan.outline.top.sphere_radius()?,
        solid.contact_modulus,
        work,
    )
    .ok()?;
    let radius = match loading.control {
        Control::Force => {
            let attraction = 2.0 * PI * work * sphere.radius();
            hertz::contact_radius(&sphere, most + attraction)
        }
        Control::Approach => hertz::contact_radius_at_approach(&sphere, most),
        // A free boundary takes no other.
        Control::Pressure | Control::MeanGap => return None,
    };
    let radius = radius
        .ok()
        .filter(|radius| *radius >= 0.5 * grid.lx.min(grid.ly))?;
    Some(format!(
        "the contact of this sphere will be at least {} wide, and the free grid is {} x {}: the run would solve a sphere that is cut off; take a larger grid.size with more points",
        format_si(2.0 * radius, "m"),
        format_si(grid.lx, "m"),
        format_si(grid.ly, "m"),
    ))
}

/// What each of so many ranks takes, and what they send.
fn on_ranks(plan: &Plan, cost: &Cost, ranks: usize) -> String {
    let memory = Memory::on_ranks(&plan.scene, plan.outline.grid, cost, ranks);
    let [nx, ny] = cost.points;
    let number = cost.place.number();
    // Half a spectrum of complex numbers there and back, all but the share that a rank has already.
    let spectrum = 2 * number * (nx / 2 + 1) * ny;
    let sent = 2 * spectrum as u64 * (ranks as u64 - 1) / ranks as u64;
    format!(
        "ranks         {ranks}: {} on each, {} of it the solver's; a convolution sends {}\n",
        mebibytes(memory.machine),
        mebibytes(memory.solver),
        mebibytes(sent)
    )
}

fn mebibytes(bytes: u64) -> String {
    format!("{:.1} MiB", bytes as f64 / f64::from(1 << 20))
}

/// The report: physics, effects, accuracy, memory and cost. With `verbose` also the fields and kernels
/// of the solver and the effects that are off.
fn describe(plan: &Plan, cost: &Cost, verbose: bool) -> Result<String, Failure> {
    let mut lines = physics(plan);
    lines.extend(effects(plan, cost, verbose)?);
    lines.extend(accuracy(plan));
    lines.extend(resources(plan, cost, verbose));
    if verbose {
        lines.extend(internals(plan, cost));
    }
    lines.push(String::new());
    Ok(lines.join("\n"))
}

/// Grid, solid, surface, loading, law and regime.
fn physics(plan: &Plan) -> Vec<String> {
    let scene = &plan.scene;
    let grid = plan.outline.grid;
    let moments = plan.outline.moments;
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
                Source::Heights => "from the heights",
                Source::Spectrum => "from the spectrum on this grid",
                Source::Estimate => "estimated without the heights",
            }
        ),
        format!(
            "loading       {}, {} steps{}{}",
            scene.loading.control.name(),
            scene.loading.path.len(),
            step_times(scene.loading.durations.as_deref()),
            if scene.loading.until_apart {
                ", then on until the surfaces are apart"
            } else {
                ""
            }
        ),
    ];
    if plan.outline.has_flats {
        lines.push(
            "model         pillars are rigid, as the whole counter-face is: they do not bend, and only the solid deforms"
                .to_owned(),
        );
    }
    let Some(regime) = &plan.regime else {
        return lines;
    };
    lines.push(format!(
        "law           {}: work of adhesion {}, range {}, peak tension {}",
        scene
            .adhesion
            .as_ref()
            .map_or("", |adhesion| adhesion.law.name()),
        format_si(plan.law.work_of_adhesion(), "J/m^2"),
        format_si(plan.law.range(), "m"),
        format_si(plan.law.peak_tension(), "Pa"),
    ));
    if let Law::MaugisDugdale(law) = plan.law
        && law.taper > 0.0
    {
        let [reach, range] =
            [law.range + 0.5 * law.taper, law.range].map(|gap| format_si(gap, "m"));
        let effect = if reach == range {
            "too short beside the range to change anything".to_owned()
        } else {
            format!(
                "the attraction ends at a gap of {reach} in place of {range}, so jump-in comes earlier"
            )
        };
        lines.push(format!(
            "taper         {}: {effect}",
            format_si(law.taper, "m")
        ));
    }
    lines.push(match regime.tabor {
        Some(tabor) => format!(
            "regime        Tabor number {tabor:.3} (radius {}): {}",
            format_si(regime.radius, "m"),
            regime.name()
        ),
        None if matches!(plan.outline.top, Top::Cone { .. }) => {
            "regime        a cone: no radius, and no Tabor number".to_owned()
        }
        None => "regime        flats and walls: no curvature, and no Tabor number".to_owned(),
    });
    lines
}

/// The effects of the scene: what each does, when it matters and how much memory it takes.
fn effects(plan: &Plan, cost: &Cost, verbose: bool) -> Result<Vec<String>, Failure> {
    let mut lines = Vec::new();
    for effect in Effect::ALL {
        if !effect.is_on(&plan.scene) {
            if verbose {
                lines.push(format!("effect off    {}", effect.name()));
            }
            continue;
        }
        lines.push(format!(
            "effect on     {}: {}",
            effect.name(),
            effect.purpose()
        ));
        lines.push(format!("              {}", effect.matters(plan)));
        let found = effect.cost(&plan.scene, cost, plan.outline.grid)?;
        let bytes = u64::try_from(found.bytes.unsigned_abs()).unwrap_or(u64::MAX);
        let bytes = mebibytes(bytes);
        // What rounds to nothing is neither more nor less.
        let is_less = found.bytes < 0 && bytes != mebibytes(0);
        lines.push(if is_less {
            format!("              memory {bytes} less than without it")
        } else {
            format!("              memory +{bytes}")
        });
        if verbose {
            lines.push(format!(
                "              fields {}; kernels {}",
                change(&found.fields_added, &found.fields_spared),
                change(&found.passes_added, &found.passes_spared),
            ));
        }
    }
    Ok(lines)
}

/// How the grid resolves roughness and adhesion.
fn accuracy(plan: &Plan) -> Vec<String> {
    let mut lines = Vec::new();
    if let Some(pixels) = plan.pixels_a_wave() {
        lines.push(format!(
            "accuracy      {pixels:.1} pixels across the shortest wave"
        ));
    }
    if let Some(regime) = &plan.regime {
        lines.push(format!(
            "accuracy      {:.2} pixels across the cohesive zone; chi = w dx/(E* range^2) = {:.3}",
            regime.zone_pixels, regime.chi
        ));
    }
    lines
}

/// Memory, precision and the work of an iteration.
fn resources(plan: &Plan, cost: &Cost, verbose: bool) -> Vec<String> {
    let scene = &plan.scene;
    let memory = Memory::new(scene, plan.outline.grid, cost);
    let adapter = if memory.adapter > 0 {
        format!(", {} on the adapter", mebibytes(memory.adapter))
    } else {
        String::new()
    };
    let machine = if memory.machine > memory.without_search {
        format!(
            "{} on this machine, {} if it looks for a jump within a step",
            mebibytes(memory.without_search),
            mebibytes(memory.machine)
        )
    } else {
        format!("{} on this machine", mebibytes(memory.machine))
    };
    let mut lines = vec![format!("memory        {machine}{adapter}")];
    if memory.drivers > 0 {
        lines.push(format!(
            "              with {} for graphics drivers, which a run on the processor (--backend cpu) does not load",
            mebibytes(memory.drivers)
        ));
    }
    if !cost.reference.is_empty() {
        let device = if cost.place.on_gpu() {
            "GPU if it supports that, else on the processor"
        } else {
            "processor"
        };
        lines.push(format!(
            "              with {} for the double-precision state of mixed precision, on the {device}",
            mebibytes(cost.reference_bytes() as u64)
        ));
    }
    lines.push(format!(
        "cost          {:.1} Fourier transforms an iteration near a solution on {} x {} points, in {}",
        cost.transforms,
        cost.points[0],
        cost.points[1],
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
            "largest grid  {}",
            crate::device::largest_here(scene.grid.boundary, verbose)
        ));
    }
    #[cfg(not(feature = "gpu"))]
    let _ = verbose;
    lines
}

/// Fields and kernels of the solver.
fn internals(plan: &Plan, cost: &Cost) -> Vec<String> {
    let memory = Memory::new(&plan.scene, plan.outline.grid, cost);
    vec![
        format!(
            "solver        {} in {} fields, {} tables and the work space of the transforms",
            mebibytes(memory.solver),
            cost.fields.len(),
            cost.spectra.len()
        ),
        format!(
            "fields        {}",
            join(cost.fields.iter().map(|field| field.name))
        ),
        format!("kernels       {}", join(cost.passes.iter().copied())),
    ]
}

fn join(names: impl Iterator<Item = &'static str>) -> String {
    names.collect::<Vec<_>>().join(", ")
}

/// A change such as `+2 (step, search), -1 (coarse)`.
fn change(added: &[&'static str], spared: &[&'static str]) -> String {
    let part = |sign: &str, names: &[&'static str]| {
        (!names.is_empty()).then(|| format!("{sign}{} ({})", names.len(), names.join(", ")))
    };
    let parts: Vec<String> = [part("+", added), part("-", spared)]
        .into_iter()
        .flatten()
        .collect();
    if parts.is_empty() {
        "unchanged".to_owned()
    } else {
        parts.join(", ")
    }
}

/// The shortest and the longest duration of a step, if the path has durations.
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
