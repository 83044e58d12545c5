//! `[[surface]]`: the parts that add up to the heights.

use std::path::Path;

use super::allowed::Allowed;
use super::document::{Node, Table, Value};
use super::keys::{self, Section};
use super::reader::Reader;
use super::{
    Boundary, Detrend, Edges, Fill, GridScene, HeightFileScene, Preparation, Roughness,
    SelfAffineScene, SurfacePart,
};
use crate::units::{self, Dimension};

/// The kinds of surface with their keys.
const KINDS: &[(&str, &Section)] = &[
    ("self-affine", &keys::SELF_AFFINE),
    ("sphere", &keys::SPHERE),
    ("cone", &keys::CONE),
    ("wavy", &keys::WAVY),
    ("flat", &keys::FLAT),
    ("file", &keys::FILE),
];

/// Relative deviation from a whole number of waves that is accepted, as for the band of self-affine
/// surfaces.
const WHOLE_WAVES: f64 = 1e-9;

/// Reads every `[[surface]]`; checks wavelengths against `grid` if it could be read.
pub(super) fn read(
    scene: &Reader,
    grid: Option<&GridScene>,
    folder: &Path,
) -> Option<Vec<SurfacePart>> {
    const EXAMPLE: &str = "[[surface]] with kind = \"sphere\" and radius = \"1 um\"";
    scene.require_as("surface", EXAMPLE);
    let readers = scene.tables("surface", section_of)?;
    if scene.is_empty_list("surface") {
        scene.conflict("surface", format!("is empty; add for example {EXAMPLE}"));
    }
    let parts: Vec<Option<SurfacePart>> = readers
        .iter()
        .map(|part| read_part(part, grid, folder))
        .collect();
    parts.into_iter().collect()
}

/// The keys of a part by its kind; those of every kind if it is missing or unknown.
fn section_of(table: &Table) -> &'static Section {
    let kind = table.get("kind");
    KINDS
        .iter()
        .find(|(name, _)| kind.is_some_and(|entry| entry.node.is_text(name)))
        .map_or(&keys::SURFACE, |(_, section)| section)
}

fn read_part(part: &Reader, grid: Option<&GridScene>, folder: &Path) -> Option<SurfacePart> {
    part.require(&["kind"]);
    let (kind, _) = part.choice("kind", KINDS, |(name, _)| name)?;
    match kind {
        "self-affine" => self_affine(part),
        "sphere" => {
            part.require(&["radius"]);
            let radius = length(part, "radius");
            let centre = centre(part);
            Some(SurfacePart::Sphere {
                radius: radius?,
                centre: centre?,
            })
        }
        "cone" => {
            const ANGLE: Allowed = Allowed::new(
                |angle| angle > 0.0 && angle < std::f64::consts::FRAC_PI_2,
                "above 0 and below 90 degrees",
            );
            part.require(&["half_angle"]);
            let half_angle = part.quantity("half_angle", Dimension::Angle, ANGLE);
            let centre = centre(part);
            Some(SurfacePart::Cone {
                half_angle: half_angle?,
                centre: centre?,
            })
        }
        "wavy" => wavy(part, grid),
        "file" => file(part, folder),
        _ => Some(SurfacePart::Flat),
    }
}

fn length(part: &Reader, key: &str) -> Option<f64> {
    part.quantity(key, Dimension::Length, Allowed::POSITIVE)
}

/// The apex: `Some(None)` is the middle of the grid.
fn centre(part: &Reader) -> Option<Option<[f64; 2]>> {
    part.optional("centre", |key| {
        part.two(key, |node, name| {
            part.quantity_in(node, key, name, Dimension::Length, Allowed::FINITE)
        })
    })
}

fn self_affine(part: &Reader) -> Option<SurfacePart> {
    const HURST: Allowed = Allowed::new(|hurst| hurst > 0.0 && hurst < 1.0, "above 0 and below 1");
    part.require(&["hurst"]);
    let hurst = part.quantity("hurst", Dimension::Dimensionless, HURST);
    let rms_height = length(part, "rms_height").map(Roughness::RmsHeight);
    let rms_slope = part
        .quantity("rms_slope", Dimension::Dimensionless, Allowed::POSITIVE)
        .map(Roughness::RmsSlope);
    let roughness = match (part.has("rms_height"), part.has("rms_slope")) {
        (true, true) => {
            part.conflict(
                "rms_slope",
                "rms_height is given too; give one of the two, each fixes the amplitude",
            );
            None
        }
        (false, false) => {
            part.require_as(
                "rms_height",
                "rms_height = \"0.52 nm\"` or `rms_slope = 0.1",
            );
            None
        }
        _ => rms_height.or(rms_slope),
    };
    part.require(&["longest", "rolloff", "shortest"]);
    let [longest, rolloff, shortest] =
        ["longest", "rolloff", "shortest"].map(|key| length(part, key));
    let misplaced = |key: &str, length: f64, how: &str, other: f64| {
        let [length, other] = [length, other].map(metres);
        part.conflict(
            key,
            format!(
                "{length} is {how} = {other}; wavelengths must be ordered shortest < rolloff <= longest"
            ),
        );
    };
    if let (Some(longest), Some(rolloff)) = (longest, rolloff)
        && rolloff > longest
    {
        misplaced("rolloff", rolloff, "longer than longest", longest);
    }
    if let (Some(shortest), Some(rolloff)) = (shortest, rolloff)
        && shortest >= rolloff
    {
        misplaced("shortest", shortest, "not shorter than rolloff", rolloff);
    }
    let seed = part.or("seed", 1, |key| {
        u64::try_from(part.whole_number(key, 0, i64::MAX)?).ok()
    });
    Some(SurfacePart::SelfAffine(SelfAffineScene {
        hurst: hurst?,
        roughness: roughness?,
        longest: longest?,
        rolloff: rolloff?,
        shortest: shortest?,
        seed: seed?,
    }))
}

fn metres(length: f64) -> String {
    units::format_si(length, "m")
}

fn wavy(part: &Reader, grid: Option<&GridScene>) -> Option<SurfacePart> {
    part.require(&["amplitude", "wavelength"]);
    let amplitude = length(part, "amplitude");
    let one = |node: &Node, name: &str| {
        let is_infinite = matches!(node.value, Value::Float(value) if value == f64::INFINITY);
        if is_infinite || node.is_text("inf") {
            Some(f64::INFINITY)
        } else {
            part.quantity_in(node, "wavelength", name, Dimension::Length, WAVELENGTH)
        }
    };
    const WAVELENGTH: Allowed = Allowed::new(|value| value > 0.0, "above 0, or \"inf\"");
    let node = part.node("wavelength")?;
    let wavelength = match node.value {
        Value::List(_) => part.two("wavelength", one)?,
        // A single number means waves along x.
        _ => [one(node, "wavelength")?, f64::INFINITY],
    };
    if wavelength == [f64::INFINITY; 2] {
        part.conflict(
            "wavelength",
            "is infinite along both axes; give a finite one, or take kind = \"flat\"",
        );
    }
    check_whole_waves(part, wavelength, grid);
    Some(SurfacePart::Wavy {
        amplitude: amplitude?,
        wavelength,
    })
}

/// Notes each wavelength that does not divide a periodic cell, with the nearest one that does.
fn check_whole_waves(part: &Reader, wavelength: [f64; 2], grid: Option<&GridScene>) {
    let Some(GridScene {
        size: Some(size),
        boundary: Boundary::Periodic,
        ..
    }) = grid
    else {
        return;
    };
    for (axis, (size, wavelength)) in ["x", "y"].iter().zip(size.iter().zip(wavelength)) {
        if wavelength.is_infinite() {
            continue;
        }
        let waves = size / wavelength;
        let whole = waves.round().max(1.0);
        if (waves - whole).abs() > WHOLE_WAVES * whole {
            part.conflict(
                "wavelength",
                format!(
                    "{} along {axis} does not divide the periodic size {}; the nearest that does is {}",
                    metres(wavelength),
                    metres(*size),
                    metres(size / whole)
                ),
            );
        }
    }
}

fn file(part: &Reader, folder: &Path) -> Option<SurfacePart> {
    const SCALE: Allowed = Allowed::new(|scale| scale != 0.0, "finite and not 0");
    part.require(&["path"]);
    let path = part.text("path").filter(|path| {
        if path.is_empty() {
            part.conflict("path", "is empty; name a file, relative to the scene file");
        }
        !path.is_empty()
    });
    let unit = match part.node("unit").map(|node| &node.value) {
        None => Some(1.0),
        // A unit alone, as in "nm", or a length, as in "0.5 nm" or 5e-10.
        Some(Value::Text(text)) if !units::starts_like_a_number(text) => {
            let factor = units::unit_factor(text, Dimension::Length);
            factor
                .map_err(|error| part.report("unit", error.into()))
                .ok()
        }
        Some(_) => length(part, "unit"),
    };
    let scale = part.or("scale", 1.0, |key| {
        part.quantity(key, Dimension::Dimensionless, SCALE)
    });
    let [black, white] = ["black", "white"].map(|key| {
        part.optional(key, |key| {
            part.quantity(key, Dimension::Length, Allowed::FINITE)
        })
    });
    for (given, other) in [("black", "white"), ("white", "black")] {
        if part.has(given) && !part.has(other) {
            part.conflict(
                given,
                format!("is given without {other}; a grey image needs the heights of both"),
            );
        }
    }
    let detrend = part.word_or("detrend", Detrend::None);
    let fill = part.word_or("fill", Fill::None);
    let preparation = preparation(part);
    Some(SurfacePart::File(HeightFileScene {
        path: folder.join(path?),
        unit: unit?,
        scale: scale?,
        black: black?,
        white: white?,
        detrend: detrend?,
        fill: fill?,
        preparation: preparation?,
    }))
}

/// Reads what is done to a map besides.
fn preparation(part: &Reader) -> Option<Preparation> {
    const MOST: i64 = 65536;
    const TIMES: Allowed = Allowed::new(|times| times >= 1.0, "at least 1");
    let profile = part.or("profile", false, |key| part.truth(key));
    let count = |key: &str, node: &Node, name: &str, least: i64| {
        let number = part.whole_number_in(node, key, name, least, MOST)?;
        usize::try_from(number).ok()
    };
    let crop = part.optional("crop", |key| {
        let list = part.list(key, "a list of x, y, points along x and points along y")?;
        let numbers = list.iter().enumerate();
        let numbers: Vec<Option<usize>> = numbers
            .map(|(index, (name, node))| count(key, node, name, i64::from(index >= 2)))
            .collect();
        let numbers: Vec<usize> = numbers.into_iter().collect::<Option<_>>()?;
        let Ok(crop) = numbers.try_into() else {
            part.conflict(
                key,
                "has four numbers: x and y of the first point, points along x and y",
            );
            return None;
        };
        Some(crop)
    });
    let outliers = part.optional("outliers", |key| {
        part.quantity(key, Dimension::Dimensionless, TIMES)
    });
    let edges = part.word_or("edges", Edges::None);
    let resample = part.optional("resample", |key| {
        part.one_or_two(key, |node, name| count(key, node, name, 1))
    });
    Some(Preparation {
        profile: profile?,
        crop: crop?,
        outliers: outliers?,
        edges: edges?,
        resample: resample?,
    })
}
