//! `tabor surface`: what a surface is like, and the self-affine scene that is like it.

mod measured;
mod memory;
mod report;

use std::path::{Path, PathBuf};

use clap::builder::TypedValueParser;

use super::flags::with_file_options;
use super::patience::Patience;
use super::quantity::quantity;
use super::{Failure, SceneArguments, folder_or_default, key_and_value, one_of, print, warn};
use crate::output::{
    OutputError, Picture, RunFolder, expect_apart, visible_line, write_atomically, write_field,
    write_picture,
};
use crate::run::memory_check;
use crate::scene::{
    Boundary, Detrend, Edges, FieldName, Fill, GridScene, HeightFileScene, Preparation, SurfacePart,
};
use crate::study::implausible_surface;
use crate::surface::{Surface, SurfaceError};
use crate::units::{Dimension, RANGE_WORDS, in_range, starts_like_a_number, unit_factor};
use measured::measured_scene;
use report::Report;

/// Extension of scenes; every other file holds heights.
const SCENE: &str = "toml";
/// Most points of a side.
const MOST_SIDE: usize = 65536;

#[derive(Debug, clap::Args)]
pub(super) struct SurfaceArguments {
    /// A scene (.toml), or a file of heights
    source: PathBuf,
    /// Size of the map as it is measured, after crop and mirror, as "25 um" or "25 um, 12.5 um" (x, y)
    #[arg(long, value_name = "S", value_parser = size)]
    size: Option<[f64; 2]>,
    /// Folder for the pictures [default: the file's name with _surface, in the current folder]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Override a key of the scene, as in surface.0.hurst=0.4, or set one in the scene that is written of a file; may be repeated
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
    /// What to take off: none, mean, plane, quadratic, or lines, the mean of each row [default: none]
    #[arg(long, value_name = "KIND", value_parser = word(Detrend::ALL, Detrend::name))]
    detrend: Option<Detrend>,
    /// Missing pixels: none or interpolate [default: none]
    #[arg(long, value_name = "HOW", value_parser = word(Fill::ALL, Fill::name))]
    fill: Option<Fill>,
    /// Take a line scan as a profile that repeats across
    #[arg(long)]
    profile: bool,
    /// Keep a part: x and y of its first point, points along x and y, as "0, 0, 256, 256"
    #[arg(long, value_name = "X,Y,NX,NY", value_parser = part)]
    crop: Option<[usize; 4]>,
    /// Interpolate points that stand out of their neighbours by more than so many standard deviations
    #[arg(long, value_name = "N", value_parser = times)]
    outliers: Option<f64>,
    /// Make a map periodic: none, window or mirror [default: none]
    #[arg(long, value_name = "HOW", value_parser = word(Edges::ALL, Edges::name))]
    edges: Option<Edges>,
    /// Bring the map to so many points, as "512" or "512, 256" (x, y)
    #[arg(long, value_name = "N", value_parser = points)]
    resample: Option<[usize; 2]>,
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
            && self.preparation() == Preparation::default()
    }

    fn preparation(&self) -> Preparation {
        Preparation {
            profile: self.profile,
            crop: self.crop,
            outliers: self.outliers,
            edges: self.edges.unwrap_or_default(),
            resample: self.resample,
        }
    }
}

/// So many whole numbers up to the most points of a side.
fn whole<const N: usize>(text: &str) -> Result<[usize; N], String> {
    let numbers = text.split(',').map(|number| number.trim().parse());
    let numbers: Result<Vec<usize>, _> = numbers.collect();
    let numbers = numbers
        .ok()
        .filter(|numbers| numbers.iter().all(|one| *one <= MOST_SIDE));
    numbers
        .and_then(|numbers| numbers.try_into().ok())
        .ok_or_else(|| {
            format!("give {N} whole numbers up to {MOST_SIDE}, with commas between them")
        })
}

/// The first point of a part, and its points along x and y.
fn part(text: &str) -> Result<[usize; 4], String> {
    let part @ [_, _, nx, ny] = whole(text)?;
    match [nx, ny].contains(&0) {
        true => Err("a part has at least one point along x and along y".to_owned()),
        false => Ok(part),
    }
}

fn points(text: &str) -> Result<[usize; 2], String> {
    let points = whole::<2>(text).or_else(|_| whole::<1>(text).map(|[side]| [side; 2]));
    points
        .ok()
        .filter(|points| !points.contains(&0))
        .ok_or_else(|| format!("give one or two whole numbers from 1 to {MOST_SIDE}"))
}

/// A number of standard deviations.
fn times(text: &str) -> Result<f64, String> {
    factor(text)
        .ok()
        .filter(|times| *times >= 1.0)
        .ok_or_else(|| "write a number of at least 1".to_owned())
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
    match starts_like_a_number(text) {
        true => length(text),
        false => unit_factor(text, Dimension::Length).map_err(|error| error.to_string()),
    }
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
    let path = folder_or_default(arguments.out.as_deref(), source, "_surface");
    let (surface, boundary, part) = if is_scene {
        let (surface, boundary) = surface_of_scene(arguments, &path)?;
        (surface, boundary, None)
    } else {
        expect_apart([&path], [source.as_path()])?;
        let (surface, boundary, part) = surface_of_file(arguments)?;
        (surface, boundary, Some(part))
    };
    let mut report = Report::new(source, &surface, boundary);
    report.is_windowed = arguments.file.edges == Some(Edges::Window);
    let slope = report.statistics.moments.rms_slope();
    let measured = match &part {
        None => None,
        Some(part) => Some(measured_scene(arguments, part, &surface, slope, &path)?),
    };
    let folder = RunFolder::open(&path, &format!("surface of {}", source.display()))?;
    for warning in &surface.warnings {
        if is_scene {
            warn(warning);
        } else {
            warn(&with_file_options(plain(warning)));
        }
    }
    for warning in implausible_surface(&surface.grid, slope) {
        warn(&warning);
    }
    if !is_scene {
        for key in arguments.set.iter().map(|(key, _)| key.trim()) {
            if ["grid.size", "grid.points"].contains(&key) || key.starts_with("surface") {
                warn(&format!(
                    "--set {key} is for measured.toml alone: statistics and load are those of the map without it; \
                     --size, --resample, --scale and the other options are for both"
                ));
            }
        }
    }
    // The table first: it stands even where no picture can be written.
    print(&report.text())?;
    write_pictures(&folder, &report)?;
    if let Some(measured) = measured {
        write_atomically(&folder.path().join(measured::NAME), measured.as_bytes())?;
    }
    // The heights themselves, where the call has changed those of the file.
    if arguments.file.preparation() != Preparation::default() {
        write_field(
            &folder.path().join("heights.npy"),
            &surface.grid,
            &surface.heights,
        )?;
    }
    Ok(())
}

/// The surface of a scene, with its own boundary.
fn surface_of_scene(
    arguments: &SurfaceArguments,
    out: &Path,
) -> Result<(Surface, Boundary), Failure> {
    if !arguments.file.is_empty() {
        return Err(Failure::Usage(
            "options such as --unit, --detrend and --boundary are for files of heights; a scene says them itself (or --set surface.0.unit=...)"
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
    described.expect_apart(&scene, [out.to_path_buf()])?;
    memory_check::check_files(&scene, 1)?;
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
fn surface_of_file(
    arguments: &SurfaceArguments,
) -> Result<(Surface, Boundary, HeightFileScene), Failure> {
    let file = &arguments.file;
    let boundary = file.boundary.unwrap_or(Boundary::Free);
    memory::check_map(&arguments.source, boundary)?;
    let grid = GridScene {
        points: None,
        size: arguments.size,
        boundary,
    };
    let part = HeightFileScene {
        path: arguments.source.clone(),
        unit: file.unit.unwrap_or(1.0),
        scale: file.scale.unwrap_or(1.0),
        black: file.black,
        white: file.white,
        detrend: file.detrend.unwrap_or(Detrend::None),
        fill: file.fill.unwrap_or(Fill::None),
        preparation: file.preparation(),
    };
    let parts = [SurfacePart::File(part.clone())];
    let surface = Surface::from_parts(&grid, &parts).map_err(|error| {
        let text = match error {
            // There are no parts to count here.
            SurfaceError::Part { problem, .. } => problem.to_string(),
            SurfaceError::SizeMissing => format!(
                "{}: the file does not say its size; give --size \"10 um\"",
                arguments.source.display()
            ),
            other => format!("{}: {other}", arguments.source.display()),
        };
        Failure::Usage(visible_line(&with_file_options(&text)))
    })?;
    let points = [surface.grid.nx, surface.grid.ny];
    memory::check_statistics(&arguments.source, points, boundary)?;
    Ok((surface, boundary, part))
}

/// A warning without the number of the one part that a file is.
fn plain(warning: &str) -> &str {
    warning.split_once(": ").map_or(warning, |(_, rest)| rest)
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
    let spectrum = report.spectrum();
    spectrum.write(&folder.path().join("psd.png"))?;
    let (tables, figure) = report.distributions();
    figure.write(&folder.path().join("statistics.png"))?;
    for (name, table) in tables {
        write_atomically(&folder.path().join(name), table.as_bytes())?;
    }
    write_atomically(&folder.path().join("psd.csv"), report.table().as_bytes())?;
    if let Some(scene) = report.scene() {
        write_atomically(&folder.path().join("scene.toml"), scene.as_bytes())?;
    }
    Ok(())
}

#[cfg(test)]
#[path = "hostile_tests.rs"]
mod tests;
