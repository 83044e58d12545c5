//! The paths on which cases run: a backend and an arithmetic, as many as the build has.

use std::path::Path as FilePath;

use tabor::scene::Scene;

use crate::shared::device;
use crate::shared::trials::is_long;

/// One way to compute.
#[derive(Debug)]
pub struct Path {
    /// What the table calls it.
    pub name: &'static str,
    /// `--backend`.
    pub backend: &'static str,
    /// `--precision`.
    pub precision: &'static str,
    /// Relative rounding error of the fields it writes.
    pub epsilon: f64,
    /// The tolerance asked of it: what `algorithms` were measured at, and the floor of `single`.
    pub tolerance: f64,
    /// How the names of the cases begin that it tries; none where it tries all.
    only: &'static [&'static str],
}

/// Cases whose numbers are stretched. Shaders in double precision are slow to
/// compile in software, and in all else they are single's.
const STRETCHED: &[&str] = &[
    "heights a million times",
    "origin",
    "rough, tolerance",
    "units",
];

/// All that there may be. The first is the judge of the others.
pub const PATHS: [Path; 6] = [
    path("CPU double", "cpu", "double"),
    path("CPU mixed", "cpu", "mixed"),
    path("CPU single", "cpu", "single"),
    Path {
        only: STRETCHED,
        ..path("GPU double", "gpu", "double")
    },
    path("GPU mixed", "gpu", "mixed"),
    path("GPU single", "gpu", "single"),
];

const fn path(name: &'static str, backend: &'static str, precision: &'static str) -> Path {
    let single = matches!(precision.as_bytes(), b"single");
    Path {
        name,
        backend,
        precision,
        epsilon: if single {
            f32::EPSILON as f64
        } else {
            f64::EPSILON
        },
        tolerance: if single { 1e-4 } else { 1e-8 },
        only: &[],
    }
}

const SMALLEST: &str = r#"
    [grid]
    points = 4
    size = 1.0
    [solid]
    contact_modulus = 1.0
    [[surface]]
    kind = "flat"
    [loading]
    control = "pressure"
    path = [1.0]
"#;

impl Path {
    /// Whether the build accepts it: an arithmetic that a version lacks is refused in the scene.
    pub fn is_built(&self) -> bool {
        Scene::parse(
            SMALLEST,
            "smallest.toml",
            FilePath::new("."),
            &self.settings(),
        )
        .is_ok()
    }

    /// What it sets in a scene.
    pub fn settings(&self) -> [(String, String); 2] {
        [("backend", self.backend), ("precision", self.precision)]
            .map(|(key, word)| (format!("solver.{key}"), format!("\"{word}\"")))
    }

    /// Whether this machine has what it takes; where it must and has not, the test fails.
    pub fn is_here(&self) -> bool {
        self.backend == "cpu" || device::found().is_some()
    }

    /// Whether it tries a case of this name, at this place in the list.
    ///
    /// A software driver takes longer to compile the shaders of a case than all else here. So on the graphics
    /// processor every eighth case is tried, in mixed and in single precision in turn, and every fourth of those that double
    /// precision is for.
    pub fn tries(&self, case: &str, place: usize) -> bool {
        let turn = match (self.backend, self.precision) {
            ("gpu", "double") => is_long() || place.is_multiple_of(4),
            ("gpu", "mixed") => is_long() || place.is_multiple_of(16),
            ("gpu", "single") => is_long() || place % 16 == 8,
            _ => true,
        };
        turn && (self.only.is_empty() || self.only.iter().any(|word| case.starts_with(word)))
    }

    pub fn is_single(&self) -> bool {
        self.precision == "single"
    }
}
