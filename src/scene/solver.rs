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
/// ready. On 256 x 256 an H200 takes twice as long as 16 threads (docs/benchmarks.md).
const FEWEST_POINTS: usize = 512 * 512;

/// Points of the surface from which `auto` takes mixed precision on the processor: it is faster with every law there, while fewer
/// points gain less than the steps of a path lose in further rounds.
const FEWEST_POINTS_IN_MIXED: usize = 256 * 256;
/// Least tolerance for which it does: rounds reach it on every scene.
const LEAST_TOLERANCE_OF_MIXED: f64 = 1e-10;

impl Scene {
    /// The precision of a solve on a graphics processor; `auto` goes by the tolerance.
    #[doc(hidden)]
    pub fn arithmetic_on_gpu(&self) -> Precision {
        match self.solver.precision {
            Precision::Auto if self.solver.tolerance >= Precision::SINGLE_FLOOR => {
                Precision::Single
            }
            // The corrections of mixed precision have no hardness limit.
            Precision::Auto if self.solid.hardness.is_some() => Precision::Double,
            Precision::Auto => Precision::Mixed,
            asked => asked,
        }
    }

    /// The precision of a solve on the processor, on a surface of so many points.
    #[doc(hidden)]
    pub fn arithmetic_on_processor(&self, points: usize) -> Precision {
        let gains = points >= FEWEST_POINTS_IN_MIXED
            && self.solver.tolerance >= LEAST_TOLERANCE_OF_MIXED
            && self.solid.hardness.is_none();
        match self.solver.precision {
            Precision::Auto if gains => Precision::Mixed,
            Precision::Auto => Precision::Double,
            asked => asked,
        }
    }

    /// Whether it asks for single precision, or leaves the choice to a graphics processor that would take it.
    #[doc(hidden)]
    pub fn is_single(&self) -> bool {
        let on_gpu = self.solver.backend == BackendName::Gpu;
        let precision = if on_gpu {
            self.arithmetic_on_gpu()
        } else {
            self.solver.precision
        };
        precision == Precision::Single
    }

    /// Whether a run with so many solved points looks for a graphics processor: the scene asks for one, or leaves the
    /// choice and the points are enough for one.
    pub(crate) fn looks_for_adapters(&self, points: usize) -> bool {
        match self.solver.backend {
            BackendName::Cpu => false,
            BackendName::Gpu => true,
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
