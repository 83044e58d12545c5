//! How a run ends.

use std::fmt;

use serde_json::{Value, json};

use super::memory_check::MemoryError;
use super::warnings::{greatest_force, is_loose};
use crate::backend::BackendError;
use crate::backend::ranks::RankError;
use crate::device::{DeviceError, SelectedDevice};
use crate::effect::Effect;
use crate::output::{Effects, OutputError, Seconds, Summary, peak_memory_bytes};
use crate::scene::LoadingScene;
use crate::study::{
    Setup, StepRow, Tension, Unreachable, WalkEnd, count_of_steps, largest_contact,
};
use crate::surface::SurfaceError;

/// Why a run could not begin or continue.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RunError {
    /// The surface cannot be built.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// The memory does not hold it.
    #[error(transparent)]
    Memory(#[from] MemoryError),
    /// The device that it asks for cannot be used.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// The device failed.
    #[error(transparent)]
    Backend(#[from] BackendError),
    /// The folder is not this run's, or cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// Another process of the same contact has ended.
    #[error(transparent)]
    Rank(#[from] RankError),
}

/// How far a run came.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum RunStatus {
    /// Every step is solved.
    Finished,
    /// The last row did not reach the tolerance, and the steps after it were not begun.
    NotConverged {
        /// The step, from 1.
        step: usize,
        /// The residual that it ended with.
        residual: f64,
        /// Its iterations.
        iterations: usize,
        /// The residual asked for.
        tolerance: f64,
        /// Why it did not, if that is not for its iterations.
        unreachable: Option<Unreachable>,
    },
    /// The observer ended it.
    Interrupted {
        /// Steps that are finished.
        finished: usize,
        /// Steps of the path; as many as are finished where it goes on until the surfaces part.
        steps: usize,
    },
}

impl fmt::Display for RunStatus {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            RunStatus::Finished => write!(formatter, "finished"),
            RunStatus::NotConverged {
                step,
                residual,
                iterations,
                tolerance,
                ..
            } => write!(
                formatter,
                "step {step} did not converge: residual {residual:.1e} after {iterations} iterations, asked {tolerance:.1e}"
            ),
            RunStatus::Interrupted { finished, steps } => {
                write!(
                    formatter,
                    "interrupted after {}",
                    count_of_steps(*finished, *steps)
                )
            }
        }
    }
}

/// Results of a run besides its folder.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RunEnd {
    /// One row a step, those of a resumed run included, SI.
    pub rows: Vec<StepRow>,
    /// Content of `summary.json`.
    pub summary: Summary,
    /// How far it came.
    pub status: RunStatus,
}

impl RunEnd {
    /// Whether pull-off is known no better than between two loads that are further apart than asked, since one between them did
    /// not converge.
    pub fn pull_off_is_loose(&self, loading: &LoadingScene) -> bool {
        let bounds = self.summary.pull_off_lower.zip(self.summary.pull_off_upper);
        bounds.is_some_and(|(lower, upper)| {
            is_loose(loading, [lower, upper], greatest_force(&self.rows))
        })
    }

    /// The end of a path.
    pub(super) fn new(setup: &Setup, end: WalkEnd, summary: Summary) -> Self {
        let status = match end.rows.last() {
            _ if end.interrupted => RunStatus::Interrupted {
                finished: end.rows.len(),
                steps: setup.scene.loading.path.len().max(end.rows.len()),
            },
            Some(row) if !row.converged => RunStatus::NotConverged {
                step: row.step,
                residual: row.residual,
                iterations: row.iterations,
                tolerance: setup.scene.solver.tolerance,
                unreachable: end.unreachable,
            },
            _ => RunStatus::Finished,
        };
        RunEnd {
            rows: end.rows,
            summary,
            status,
        }
    }
}

/// The scene as resolved, with the range and the taper that `"auto"` stands for, and the points and the size of a height file.
fn resolved_scene(setup: &Setup) -> Value {
    let mut scene = setup.scene.resolved_json();
    let grid = setup.surface.grid;
    for (key, value) in [
        ("points", json!([grid.nx, grid.ny])),
        ("size", json!([grid.lx, grid.ly])),
    ] {
        if let Some(table) = scene["grid"].as_object_mut() {
            table.entry(key).or_insert(value);
        }
    }
    for (key, length) in [("range", setup.law.range()), ("taper", setup.law.taper())] {
        match scene.pointer_mut(&format!("/adhesion/{key}")) {
            Some(value) if value == "auto" => *value = json!(length),
            _ => {}
        }
    }
    scene
}

/// The summary of a path that ended.
pub(super) fn summary(
    setup: &Setup,
    device: &SelectedDevice,
    end: &WalkEnd,
    seconds: Seconds,
    warnings: Vec<String>,
) -> Summary {
    let names = |on: bool| -> Vec<String> {
        Effect::ALL
            .iter()
            .filter(|effect| effect.is_on(&setup.scene) == on)
            .map(|effect| effect.name().to_owned())
            .collect()
    };
    let tension = Tension::at_end(&setup.scene.loading, end);
    let [lower, upper] = tension
        .bounds()
        .map_or([None; 2], |bounds| bounds.map(Some));
    Summary {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        scene: resolved_scene(setup),
        effects: Effects {
            on: names(true),
            off: names(false),
        },
        backend: device.name().to_owned(),
        adapter: device.adapter(),
        precision: device.precision().name().to_owned(),
        seconds,
        transforms: end.transforms + setup.transforms,
        peak_memory_bytes: peak_memory_bytes(),
        largest_contact_area_fraction: largest_contact(&end.rows)
            .map(|row| row.contact_area_fraction),
        pull_off_force: tension.pull_off(),
        pull_off_step: tension.step(),
        pull_off_lower: lower,
        pull_off_upper: upper,
        jump_in_steps: end.jump_in_steps.clone(),
        jump_off_steps: end.jump_off_steps.clone(),
        hysteresis_energy: end.hysteresis_energy,
        hysteresis_uncertainty: end.hysteresis_uncertainty,
        warnings,
    }
}
