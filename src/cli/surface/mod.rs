//! `tabor surface`: what a surface is like, and the self-affine scene that is like it.

mod memory;
mod report;

use std::path::PathBuf;

use clap::builder::TypedValueParser;

use super::patience::Patience;
use super::quantity::quantity;
use super::{Failure, SceneArguments, folder_or_default, key_and_value, one_of, print, warn};
use crate::output::{
    OutputError, Picture, RunFolder, visible_line, write_atomically, write_picture,
};
use crate::run::memory_check;
use crate::scene::{Boundary, Detrend, FieldName, Fill, GridScene, HeightFileScene, SurfacePart};
use crate::surface::{Surface, SurfaceError};
use crate::units::{Dimension, RANGE_WORDS, in_range};
use report::Report;

/// Extension of scenes; every other file holds heights.
const SCENE: &str = "toml";

#[derive(Debug, clap::Args)]
pub(super) struct SurfaceArguments {
    /// A scene (.toml), or a file of heights
    source: PathBuf,
    /// Size of the map, as "25 um" or "25 um, 12.5 um" (x, y)
    #[arg(long, value_name = "S", value_parser = size)]
    size: Option<[f64; 2]>,
    /// Folder for the pictures [default: the file's name with _surface, in the current folder]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Override a key of the scene, as in surface.0.hurst=0.4; may be repeated
    #[arg(long, value_name = "KEY=VALUE", value_parser = key_and_value)]
    set: Vec<(String, String)>,
    #[command(flatten)]
    file: FileArguments,
}

/// What a scene would say of a height file.
#[derive(Debug, Default, clap::Args)]
#[command(next_help_heading = "For a file of heights")]
struct FileArguments {
    /// Unit of the heights, where the file does not say it [default: m]
    #[arg(long, value_name = "U", value_parser = unit)]
    unit: Option<f64>,
    /// Factor on the heights [default: 1]
    #[arg(long, value_name = "F", value_parser = factor, allow_hyphen_values = true)]
    scale: Option<f64>,
    /// Height of black in a grey image, as "0 nm"
    #[arg(long, value_name = "H", value_parser = length, allow_hyphen_values = true)]
    black: Option<f64>,
    /// Height of white in a grey image
    #[arg(long, value_name = "H", value_parser = length, allow_hyphen_values = true)]
    white: Option<f64>,
    /// What to take off: none, mean, plane or quadratic [default: none]
    #[arg(long, value_name = "KIND", value_parser = word(Detrend::ALL, Detrend::name))]
    detrend: Option<Detrend>,
    /// Missing pixels: none or interpolate [default: none]
    #[arg(long, value_name = "HOW", value_parser = word(Fill::ALL, Fill::name))]
    fill: Option<Fill>,
    /// Edges: free for a patch, periodic for a map that repeats [default: free]
    #[arg(long, value_name = "KIND", value_parser = word(Boundary::ALL, Boundary::name))]
    boundary: Option<Boundary>,
}

impl FileArguments {
    fn is_empty(&self) -> bool {
        [self.unit, self.scale, self.black, self.white] == [None; 4]
            && self.detrend.is_none()
            && self.fill.is_none()
            && self.boundary.is_none()
    }
}

fn length(text: &str) -> Result<f64, String> {
    quantity(text, Dimension::Length)
}

/// A number without a unit.
fn factor(text: &str) -> Result<f64, String> {
    let value = text.parse().map_err(|_| "write a number".to_owned())?;
    if in_range(value) {
        Ok(value)
    } else {
        Err(format!("must be {RANGE_WORDS}"))
    }
}

/// A unit alone, as in `nm`, or a length, as in `0.5 nm`.
fn unit(text: &str) -> Result<f64, String> {
    crate::units::unit_factor(text, Dimension::Length).or_else(|_| length(text))
}

fn size(text: &str) -> Result<[f64; 2], String> {
    let sides: Vec<f64> = text
        .split(',')
        .map(|side| length(side.trim()))
        .collect::<Result<_, _>>()?;
    match sides[..] {
        [side] => Ok([side; 2]),
        [x, y] => Ok([x, y]),
        _ => Err("give one length, or two: \"25 um, 12.5 um\"".to_owned()),
    }
}

/// One of some words, as the thing that it names.
fn word<T: Copy + Send + Sync + 'static>(
    all: &'static [T],
    name: fn(T) -> &'static str,
) -> impl TypedValueParser<Value = T> {
    one_of(all, name).map(move |word| {
        let found = all.iter().find(|one| name(**one) == word);
        *found.expect("clap takes the words of the list alone")
    })
}

/// Prints the report and writes the pictures.
pub(super) fn surface(arguments: &SurfaceArguments) -> Result<(), Failure> {
    let _patience = Patience::new("a coarser map takes less");
    let source = &arguments.source;
    let is_scene = source
        .extension()
        .is_some_and(|extension| extension == SCENE);
    let (surface, boundary) = if is_scene {
        of_scene(arguments)?
    } else {
        of_file(arguments)?
    };
    let path = folder_or_default(arguments.out.as_deref(), source, "_surface");
    let folder = RunFolder::open(&path, &format!("surface of {}", source.display()))?;
    for warning in &surface.warnings {
        warn(plain(warning, is_scene));
    }
    let report = Report::of(source, &surface, boundary);
    // The table first: it stands even where no picture can be written.
    print(&report.text())?;
    write_pictures(&folder, &report)?;
    Ok(())
}

/// The surface of a scene, with its own boundary.
fn of_scene(arguments: &SurfaceArguments) -> Result<(Surface, Boundary), Failure> {
    if !arguments.file.is_empty() {
        return Err(Failure::Usage(
            "--unit, --scale, --black, --white, --detrend, --fill and --boundary are for files of heights; a scene says them itself (or --set surface.0.unit=...)"
                .to_owned(),
        ));
    }
    let mut set = arguments.set.clone();
    if let Some([x, y]) = arguments.size {
        set.push(("grid.size".to_owned(), format!("[{x:e}, {y:e}]")));
    }
    let path = arguments.source.clone();
    let described = SceneArguments { path, set };
    let scene = described.read()?;
    memory_check::check_files(&scene)?;
    let boundary = scene.grid.boundary;
    let refuse = |points| memory::check_statistics(&arguments.source, points, boundary);
    if let Some(points) = scene.grid.points {
        refuse(points)?;
    }
    let surface = Surface::build(&scene).map_err(|error| described.surface_failure(error))?;
    // Of a grid that a height file carries.
    refuse([surface.grid.nx, surface.grid.ny])?;
    Ok((surface, boundary))
}

/// The surface of a file, as a patch with free edges unless the call says otherwise.
fn of_file(arguments: &SurfaceArguments) -> Result<(Surface, Boundary), Failure> {
    if !arguments.set.is_empty() {
        return Err(Failure::Usage(
            "--set overrides keys of a scene, and this is a file of heights; it has options of its own, see --help"
                .to_owned(),
        ));
    }
    let file = &arguments.file;
    let boundary = file.boundary.unwrap_or(Boundary::Free);
    memory::check_map(&arguments.source, boundary)?;
    let grid = GridScene {
        points: None,
        size: arguments.size,
        boundary,
    };
    let part = SurfacePart::File(HeightFileScene {
        path: arguments.source.clone(),
        unit: file.unit.unwrap_or(1.0),
        scale: file.scale.unwrap_or(1.0),
        black: file.black,
        white: file.white,
        detrend: file.detrend.unwrap_or(Detrend::None),
        fill: file.fill.unwrap_or(Fill::None),
    });
    let surface = Surface::from_parts(&grid, &[part]).map_err(|error| {
        let text = match error {
            // There are no parts to count here.
            SurfaceError::Part { problem, .. } => problem.to_string(),
            SurfaceError::SizeMissing => format!(
                "{}: the file does not say its size; give --size \"10 um\"",
                arguments.source.display()
            ),
            other => format!("{}: {other}", arguments.source.display()),
        };
        Failure::Usage(visible_line(&text))
    })?;
    let points = [surface.grid.nx, surface.grid.ny];
    memory::check_statistics(&arguments.source, points, boundary)?;
    Ok((surface, boundary))
}

/// A warning without the number of the one part that a file is.
fn plain(warning: &str, is_scene: bool) -> &str {
    match warning.split_once(": ") {
        Some((_, rest)) if !is_scene => rest,
        _ => warning,
    }
}

/// `heights.png`, `psd.png`, `psd.csv` and `scene.toml`.
fn write_pictures(folder: &RunFolder, report: &Report) -> Result<(), OutputError> {
    let title = report.title();
    write_picture(
        &folder.path().join("heights.png"),
        &Picture {
            title: Some(&title),
            field: FieldName::Heights,
            step: None,
            load: None,
            grid: report.surface.grid,
            values: &report.surface.heights,
        },
    )?;
    report.spectrum().write(&folder.path().join("psd.png"))?;
    write_atomically(&folder.path().join("psd.csv"), report.table().as_bytes())?;
    if let Some(scene) = report.scene() {
        write_atomically(&folder.path().join("scene.toml"), scene.as_bytes())?;
    }
    Ok(())
}

#[cfg(test)]
#[path = "hostile_tests.rs"]
mod tests;
