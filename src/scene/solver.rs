//! `[solver]`: how well, how long, and where.

use super::keys;
use super::mistake::SceneError;
use super::reader::{Allowed, Reader};
use super::types::{BackendName, Precision, SolverScene};
use crate::units::Dimension;

/// What this version can do; the other words of the contract are refused by name.
const PRECISIONS: &[Precision] = &[Precision::Auto, Precision::Double];
const BACKENDS: &[BackendName] = &[BackendName::Auto, BackendName::Cpu];

impl Default for SolverScene {
    fn default() -> Self {
        SolverScene {
            tolerance: 1e-6,
            max_iterations: 5000,
            precision: Precision::Auto,
            backend: BackendName::Auto,
        }
    }
}

/// Reads `[solver]`; what it leaves out has its default.
pub(super) fn read(scene: &Reader) -> Option<SolverScene> {
    const TOLERANCE: Allowed = Allowed::new(
        |tolerance| tolerance > 0.0 && tolerance <= 0.1,
        "above 0 and at most 0.1",
    );
    let default = SolverScene::default();
    if !scene.has("solver") {
        return Some(default);
    }
    let solver = scene.table("solver", &keys::SOLVER)?;
    let tolerance = if solver.has("tolerance") {
        solver.quantity("tolerance", Dimension::Dimensionless, TOLERANCE)
    } else {
        Some(default.tolerance)
    };
    let max_iterations = if solver.has("max_iterations") {
        solver
            .whole_number("max_iterations", 1, i64::MAX)
            .and_then(|count| usize::try_from(count).ok())
    } else {
        Some(default.max_iterations)
    };
    let precision = available(
        &solver,
        "precision",
        Precision::ALL,
        Precision::name,
        |one| PRECISIONS.contains(&one),
    );
    let backend = available(
        &solver,
        "backend",
        BackendName::ALL,
        BackendName::name,
        |one| BACKENDS.contains(&one),
    );
    Some(SolverScene {
        tolerance: tolerance?,
        max_iterations: max_iterations?,
        precision: precision?.unwrap_or(default.precision),
        backend: backend?.unwrap_or(default.backend),
    })
}

/// A choice that this version has: `Some(None)` where the key is absent.
fn available<T: Copy>(
    solver: &Reader,
    key: &str,
    choices: &[T],
    name: fn(T) -> &'static str,
    is_available: fn(T) -> bool,
) -> Option<Option<T>> {
    if !solver.has(key) {
        return Some(None);
    }
    let choice = solver.choice(key, choices, name)?;
    if is_available(choice) {
        return Some(Some(choice));
    }
    let others: Vec<String> = choices
        .iter()
        .filter(|other| is_available(**other))
        .map(|other| format!("\"{}\"", name(*other)))
        .collect();
    solver.report(
        key,
        SceneError::NotInThisVersion {
            what: format!("{key} = \"{}\"", name(choice)),
            instead: format!("take {}", others.join(" or ")),
        },
    );
    None
}
