//! `[solver]`: how well, how long, and where.

use super::keys;
use super::mistake::SceneError;
use super::reader::{Allowed, Reader};
use super::types::{BackendName, Precision, SolverScene};
use crate::units::Dimension;

/// Default tolerance of double precision; single precision takes its floor.
const TOLERANCE: f64 = 1e-6;

impl Default for SolverScene {
    fn default() -> Self {
        SolverScene {
            tolerance: TOLERANCE,
            max_iterations: 5000,
            precision: Precision::Auto,
            backend: BackendName::Auto,
        }
    }
}

impl SolverScene {
    /// The arithmetic of a solve: what `auto` stands for on this backend.
    pub fn arithmetic(&self) -> Precision {
        match (self.precision, self.backend) {
            (Precision::Auto, BackendName::Gpu) => Precision::Single,
            (Precision::Auto, _) => Precision::Double,
            (other, _) => other,
        }
    }
}

/// Reads `[solver]`; what it leaves out has its default.
pub(super) fn read(scene: &Reader) -> Option<SolverScene> {
    const ALLOWED: Allowed = Allowed::new(
        |tolerance| tolerance > 0.0 && tolerance <= 0.1,
        "above 0 and at most 0.1",
    );
    let default = SolverScene::default();
    if !scene.has("solver") {
        return Some(default);
    }
    let solver = scene.table("solver", &keys::SOLVER)?;
    let tolerance = if solver.has("tolerance") {
        solver
            .quantity("tolerance", Dimension::Dimensionless, ALLOWED)
            .map(Some)
    } else {
        Some(None)
    };
    let max_iterations = if solver.has("max_iterations") {
        solver
            .whole_number("max_iterations", 1, i64::MAX)
            .and_then(|count| usize::try_from(count).ok())
    } else {
        Some(default.max_iterations)
    };
    let precision = if solver.has("precision") {
        solver.choice("precision", Precision::ALL, Precision::name)
    } else {
        Some(default.precision)
    };
    let backend = if solver.has("backend") {
        solver.choice("backend", BackendName::ALL, BackendName::name)
    } else {
        Some(default.backend)
    };
    let here = match (precision, backend) {
        (Some(precision), Some(backend)) => is_here(&solver, precision, backend),
        _ => None,
    };
    let mut settings = SolverScene {
        tolerance: TOLERANCE,
        max_iterations: max_iterations?,
        precision: precision?,
        backend: backend?,
    };
    here?;
    let arithmetic = settings.arithmetic();
    settings.tolerance = match tolerance? {
        Some(asked) if arithmetic == Precision::Single && asked < Precision::SINGLE_FLOOR => {
            solver.report("tolerance", below_the_floor(asked, &settings));
            return None;
        }
        Some(asked) => asked,
        None if arithmetic == Precision::Single => Precision::SINGLE_FLOOR,
        None => TOLERANCE,
    };
    Some(settings)
}

/// Whether this version has the arithmetic where it is asked for.
fn is_here(solver: &Reader, precision: Precision, backend: BackendName) -> Option<()> {
    let instead = match (precision, backend) {
        (Precision::Mixed, BackendName::Gpu) => "take \"single\", or backend = \"cpu\"",
        (Precision::Mixed, _) => "take \"auto\", \"single\" or \"double\"",
        (Precision::Double, BackendName::Gpu) => {
            "take \"single\", or backend = \"cpu\" for double precision"
        }
        _ => return Some(()),
    };
    let on_the_gpu = match backend {
        BackendName::Gpu => " on the GPU",
        _ => "",
    };
    solver.report(
        "precision",
        SceneError::NotInThisVersion {
            what: format!("precision = \"{}\"{on_the_gpu}", precision.name()),
            instead: instead.to_owned(),
        },
    );
    None
}

/// A tolerance that single precision does not reach.
fn below_the_floor(asked: f64, settings: &SolverScene) -> SceneError {
    let (who, way_out) = match settings.backend {
        BackendName::Gpu => (
            "backend = \"gpu\", in single precision,",
            "backend = \"cpu\"",
        ),
        _ => ("precision = \"single\"", "precision = \"double\""),
    };
    SceneError::OutOfRange {
        found: format!("{asked:e}"),
        allowed: format!(
            "at least {:e}, the floor of 32-bit numbers, for {who} or go with {way_out}",
            Precision::SINGLE_FLOOR
        ),
    }
}
