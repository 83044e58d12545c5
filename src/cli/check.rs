//! `tabor check`: what a scene would do and cost.

use std::io::Write;

use super::machine::refuse_size;
use super::{CheckArguments, Failure, read_scene};
use crate::effect::Effect;
use crate::scene::BackendName;
use crate::study::{Cost, Setup};
use crate::surface::Surface;
use crate::units::format_si;

/// Reads and validates a scene and prints what it found.
pub(super) fn check(arguments: &CheckArguments) -> Result<(), Failure> {
    let scene = read_scene(&arguments.scene, &arguments.set)?;
    let surface = Surface::build(&scene).map_err(|error| Failure::Surface {
        path: arguments.scene.clone(),
        error,
    })?;
    let setup = Setup::new(scene, surface);
    if setup.scene.solver.backend == BackendName::Gpu {
        refuse_size(&setup)?;
    }
    let text = describe(&setup)?;
    let mut out = std::io::stdout().lock();
    out.write_all(text.as_bytes())
        .and_then(|()| out.flush())
        .map_err(Failure::Print)?;
    for warning in &setup.warnings {
        eprintln!("warning: {warning}");
    }
    Ok(())
}

fn mebibytes(bytes: f64) -> String {
    format!("{:.1} MiB", bytes / f64::from(1 << 20))
}

/// The report, line by line.
fn describe(setup: &Setup) -> Result<String, Failure> {
    let scene = &setup.scene;
    let grid = setup.surface.grid;
    let moments = setup.statistics.moments;
    let cost = Cost::of(setup)?;
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
            "surface       rms height {}, rms slope {:.3e}, rms curvature {:.3e} 1/m",
            format_si(moments.rms_height(), "m"),
            moments.rms_slope(),
            moments.rms_curvature()
        ),
        format!(
            "loading       {}, {} steps",
            scene.loading.control.name(),
            scene.loading.path.len()
        ),
    ];
    if let Some(pixels) = setup.pixels_a_wave() {
        lines.push(format!(
            "waves         {pixels:.1} pixels across the shortest"
        ));
    }
    if let Some(regime) = &setup.regime {
        lines.push(format!(
            "law           {}: work of adhesion {}, range {}, peak tension {}{}",
            scene
                .adhesion
                .as_ref()
                .map_or("", |adhesion| adhesion.law.name()),
            format_si(setup.law.work_of_adhesion(), "J/m^2"),
            format_si(setup.law.range(), "m"),
            format_si(setup.law.peak_tension(), "Pa"),
            match setup.law {
                crate::law::Law::MaugisDugdale(law) if law.taper > 0.0 =>
                    format!(", taper {}", format_si(law.taper, "m")),
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
        "memory        {} in {} fields, {} tables and the transforms' work space; heights {}",
        mebibytes(cost.bytes() as f64),
        cost.fields.len(),
        cost.spectra.len(),
        mebibytes((grid.len() * size_of::<f64>()) as f64)
    ));
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
        lines.push(format!("              {}", effect.matters(setup)));
        let found = effect.cost(setup)?;
        lines.push(format!(
            "              fields {}; passes {}; {}{}",
            change(&found.fields_added, &found.fields_spared),
            change(&found.passes_added, &found.passes_spared),
            if found.bytes < 0 { "-" } else { "+" },
            mebibytes(found.bytes.unsigned_abs() as f64)
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
