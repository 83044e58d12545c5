//! Follows a path on one thread until the surfaces separate or a given condition holds.

use std::convert::Infallible;
use std::error::Error;
use std::path::Path;

use tabor::backend::cpu::{self, with_threads};
use tabor::kernel::Scalars;
use tabor::scene::Scene;
use tabor::study::{FinishedStep, Observer, Setup, StepRow, WalkEnd, walk};
use tabor::surface::Surface;

/// Errors of the study.
pub type Failure = Box<dyn Error + Send + Sync>;

/// Ends a path after the first row for which `is_last` holds.
struct Until<F> {
    is_last: F,
    ended: bool,
}

impl<F: Fn(&StepRow) -> bool> Observer for Until<F> {
    type Error = Infallible;

    fn step(&mut self, step: FinishedStep) -> Result<(), Infallible> {
        self.ended = (self.is_last)(step.row);
        Ok(())
    }

    fn iteration(&mut self, _: usize, _: &Scalars) -> bool {
        !self.ended
    }
}

/// Solves a scene on `heights`, or on its own heights if none are given, until `is_last`.
pub fn solve(
    text: &str,
    heights: Option<&[f64]>,
    is_last: impl Fn(&StepRow) -> bool + Send,
) -> Result<WalkEnd, Failure> {
    let scene = Scene::parse(text, "study.toml", Path::new("."), &[])
        .map_err(|errors| format!("{errors}\n{text}"))?;
    let mut surface = Surface::build(&scene)?;
    if let Some(heights) = heights {
        surface.highest = heights.iter().copied().fold(f64::MIN, f64::max);
        surface.heights = heights.to_vec().into();
    }
    let setup = Setup::new(scene, surface);
    let cpu = || cpu::double(None);
    let mut until = Until {
        is_last,
        ended: false,
    };
    let end = with_threads(Some(1), || walk(&setup, &cpu, &mut until))??;
    let wrong = end.rows.iter().find(|row| !row.converged);
    match wrong {
        Some(row) if !end.interrupted => {
            Err(format!("step {} did not converge:\n{text}", row.step).into())
        }
        _ => Ok(end),
    }
}

/// `share` as a percentage with its sign.
pub fn percent(share: f64) -> String {
    format!("{:+.1}", 100.0 * share)
}
