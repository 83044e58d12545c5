//! `[solver]`: tolerance, iterations, precision and backend.

use super::allowed::Allowed;
use super::keys;
use super::mistake::SceneError;
use super::reader::Reader;
use super::{BackendName, Precision, Scene, SolverScene};
use crate::units::Dimension;

/// Default tolerance in double precision; single precision uses its least tolerance.
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

/// Solved points from which `auto` looks for a graphics processor: fewer fill none, and are done before one is
/// ready.
const FEWEST_POINTS: usize = 256 * 256;
/// The same where the scene asks for double precision, which many adapters compute slowly.
const FEWEST_POINTS_IN_DOUBLE: usize = 512 * 512;

impl SolverScene {
    /// The precision for which `auto` stands: on a graphics processor it depends on the tolerance;
    /// `has_hardness` is true for a solid with a hardness.
    fn arithmetic_on(&self, gpu: bool, has_hardness: bool) -> Precision {
        match (self.precision, gpu) {
            (Precision::Auto, true) if self.tolerance >= Precision::SINGLE_FLOOR => {
                Precision::Single
            }
            // The corrections of mixed precision have no hardness limit.
            (Precision::Auto, true) if has_hardness => Precision::Double,
            (Precision::Auto, true) => Precision::Mixed,
            (Precision::Auto, false) => Precision::Double,
            (other, _) => other,
        }
    }
}

impl Scene {
    /// The precision of a solve on a graphics processor or on the processor.
    pub(crate) fn arithmetic_on(&self, gpu: bool) -> Precision {
        let has_hardness = self.solid.hardness.is_some();
        self.solver.arithmetic_on(gpu, has_hardness)
    }

    /// The same on the scene's backend; `auto` counts as the processor here.
    #[doc(hidden)]
    pub fn arithmetic(&self) -> Precision {
        self.arithmetic_on(self.solver.backend == BackendName::Gpu)
    }

    /// Whether a run with so many solved points looks for a graphics processor: the scene asks for one, or leaves the
    /// choice and the points are enough for one.
    pub(crate) fn looks_for_adapters(&self, points: usize) -> bool {
        match self.solver.backend {
            BackendName::Cpu => false,
            BackendName::Gpu => true,
            BackendName::Auto if self.arithmetic_on(true) == Precision::Double => {
                points >= FEWEST_POINTS_IN_DOUBLE
            }
            BackendName::Auto => points >= FEWEST_POINTS,
        }
    }
}

/// Reads `[solver]` and fills in its defaults.
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
    let tolerance = solver.optional("tolerance", |key| {
        solver.quantity(key, Dimension::Dimensionless, ALLOWED)
    });
    let max_iterations = solver.or("max_iterations", default.max_iterations, |key| {
        usize::try_from(solver.whole_number(key, 1, i64::MAX)?).ok()
    });
    let precision = solver.word_or("precision", default.precision);
    let backend = solver.word_or("backend", default.backend);
    let mut settings = SolverScene {
        tolerance: TOLERANCE,
        max_iterations: max_iterations?,
        precision: precision?,
        backend: backend?,
    };
    let single = settings.precision == Precision::Single;
    settings.tolerance = match tolerance? {
        Some(asked) if single && asked < Precision::SINGLE_FLOOR => {
            solver.report("tolerance", below_the_floor(asked));
            return None;
        }
        Some(asked) => asked,
        None if single => Precision::SINGLE_FLOOR,
        None => TOLERANCE,
    };
    Some(settings)
}

/// The error for a tolerance that single precision does not reach.
fn below_the_floor(asked: f64) -> SceneError {
    SceneError::OutOfRange {
        found: format!("{asked:e}"),
        allowed: format!(
            "at least {:e}, the limit of 32-bit numbers, for precision = \"single\"; \"mixed\" and \"double\" go below",
            Precision::SINGLE_FLOOR
        ),
    }
}
