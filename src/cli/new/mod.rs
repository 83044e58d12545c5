//! `tabor new`: a commented scene to begin with.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::{Failure, say};
use crate::output::{OutputError, write_atomically};

/// Points of the map of pillars a side.
const POINTS: usize = 96;
/// Pillars a side.
const PILLARS: usize = 4;
/// Radius of a pillar in distances between pillars.
const RADIUS: f64 = 0.3;
/// Height of the caps over their rim, and the greatest difference between two pillars, nm.
const CAP: f64 = 400.0;
const SCATTER: f64 = 300.0;
/// Depth of the ground between the pillars, nm.
const DEPTH: f64 = 3000.0;

#[derive(Debug, Args)]
pub(super) struct NewArguments {
    /// What touches
    #[arg(value_enum, value_name = "KIND")]
    kind: Kind,
    /// Folder for the scene [default: the kind, in the current folder]
    #[arg(value_name = "DIR")]
    folder: Option<PathBuf>,
}

/// A kind of contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Kind {
    /// A sphere on a soft solid: approach, contact and pull-off
    Sphere,
    /// A rough surface on a soft solid: loading, unloading and pull-off
    Rough,
    /// A colloidal probe on a cantilever: a force curve
    Afm,
    /// Pillars of a height map on a soft solid, which let go one by one
    Pillars,
    /// A rubber seal on a machined face: how much leaks through its gaps
    Seal,
    /// Two surfaces of a micromachine in humid air: stiction
    Mems,
}

impl Kind {
    fn scene(self) -> &'static str {
        match self {
            Kind::Sphere => include_str!("sphere.toml"),
            Kind::Rough => include_str!("rough.toml"),
            Kind::Afm => include_str!("afm.toml"),
            Kind::Pillars => include_str!("pillars.toml"),
            Kind::Seal => include_str!("seal.toml"),
            Kind::Mems => include_str!("mems.toml"),
        }
    }
}

/// Writes the scene of a kind, and the files that it reads.
pub(super) fn new(arguments: &NewArguments) -> Result<(), Failure> {
    let name = || {
        let value = arguments.kind.to_possible_value();
        value.map_or_else(PathBuf::new, |value| value.get_name().into())
    };
    let folder = arguments.folder.clone().unwrap_or_else(name);
    let mut files = vec![("scene.toml", arguments.kind.scene().to_owned())];
    if arguments.kind == Kind::Pillars {
        files.push(("pillars.txt", pillars()));
    }
    for (file, _) in &files {
        let path = folder.join(file);
        if path.exists() {
            let reason = "is there already; give another DIR";
            return Err(OutputError::refused(&path, reason).into());
        }
    }
    for (file, text) in &files {
        write_atomically(&folder.join(file), text.as_bytes())?;
    }
    let scene = folder.join("scene.toml");
    say(&format!(
        "{} written; next: tabor check {0}, then tabor run {0}",
        scene.display()
    ));
    Ok(())
}

/// Heights of round pillars with curved caps, nm, a row a line.
fn pillars() -> String {
    let mut text = String::from("# heights in nm\n");
    let side = POINTS as f64 / PILLARS as f64;
    for y in 0..POINTS {
        let row = (0..POINTS).map(|x| {
            let cell = [x, y].map(|at| (at as f64 + 0.5) / side);
            let [across, down] = cell.map(|at| at - at.floor() - 0.5);
            let radius = across.hypot(down) / RADIUS;
            if radius >= 1.0 {
                return -DEPTH;
            }
            // Scattered without a pattern: multiples of 7 modulo the number of pillars.
            let number = cell[1].floor() * PILLARS as f64 + cell[0].floor();
            let count = (PILLARS * PILLARS) as f64;
            let lowered = SCATTER * ((7.0 * number) % count) / count;
            -CAP * radius * radius - lowered
        });
        let cells: Vec<String> = row.map(|height| format!("{height:.1}")).collect();
        // A string takes every text.
        let _ = writeln!(text, "{}", cells.join(" "));
    }
    text
}
