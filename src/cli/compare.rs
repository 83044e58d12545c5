//! `tabor compare`: one rough surface through several models.

use super::patience::Patience;
use super::{CompareArguments, Failure, folder_or_default, note, say, warn};
use crate::backend::cpu::in_pool;
use crate::compare::{self, CompareError, Row};
use crate::device::SelectedDevice;
use crate::run::memory_check;
use crate::study::Setup;
use crate::surface::Surface;
use crate::units::format_si;

/// Compares and writes `compare.csv` and `compare.png`.
pub(super) fn compare(arguments: &CompareArguments) -> Result<(), Failure> {
    let _patience = Patience::new("compare.csv has the rows so far; a coarser grid takes less");
    let scene = arguments.scene.read()?;
    // Before a surface is built of which nothing could be said.
    compare::check_scene(&scene)?;
    let folder = folder_or_default(arguments.out.as_deref(), &arguments.scene.path, "_compare");
    let outputs = ["csv", "png", "svg"].map(|end| folder.join("compare").with_extension(end));
    arguments.scene.expect_apart(&scene, outputs)?;
    memory_check::check_scene(&scene)?;
    let surface = Surface::build(&scene).map_err(|error| arguments.scene.surface_failure(error))?;
    // Of a grid that a height file carries.
    memory_check::check_grid(&scene, surface.grid)?;
    let setup = Setup::new(scene, surface);
    for warning in &setup.warnings {
        warn(warning);
    }
    let device = SelectedDevice::new(&setup, arguments.verbose)?;
    if let Some(remark) = &device.remark {
        note(remark);
    }
    let compared = in_pool(|| compare::compare(setup, &|| device.backend(), &folder))?;
    for text in &compared.notes {
        note(text);
    }
    print(&compared.rows);
    Ok(())
}

impl From<CompareError> for Failure {
    fn from(error: CompareError) -> Self {
        match error {
            CompareError::Unsuited(text) => Failure::Usage(text),
            CompareError::Output(error) => error.into(),
            CompareError::Backend(error) => error.into(),
        }
    }
}

/// The table on standard error.
fn print(rows: &[Row]) {
    say(&format!(
        "{:<10} {:>12} {:>9} {:>11} {:>12} {:>12} {:>8}  out of range",
        "model", "pressure", "contact", "mean gap", "attraction", "pull-off", "seconds"
    ));
    let si = |value: Option<f64>, unit: &str| {
        value.map_or_else(|| "-".to_owned(), |value| format_si(value, unit))
    };
    for row in rows {
        say(&format!(
            "{:<10} {:>12} {:>9} {:>11} {:>12} {:>12} {:>8.2}  {}",
            row.model,
            format_si(row.state.mean_pressure, "Pa"),
            row.state
                .contact_area_fraction
                .map_or_else(|| "-".to_owned(), |share| format!("{:.3}%", 100.0 * share)),
            si(row.state.mean_gap, "m"),
            si(row.state.adhesive_pressure, "Pa"),
            si(row.pull_off, "Pa"),
            row.seconds,
            row.limit.unwrap_or_default()
        ));
    }
}
