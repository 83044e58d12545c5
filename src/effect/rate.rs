//! `rate` in `[adhesion]`: the work of adhesion of a receding edge grows with its speed.
//!
//! The tension is raised by the factor `1 + (v/v*)^n` on the points that were in contact or attracted when the
//! step began; v is the mean speed at which the edge recedes in the step. A greater factor slows the edge,
//! so factor and speed agree at one value, which is bracketed and found. Where an edge advances, and on
//! points that come into contact in the step, the law is unchanged.
//!
//! Each trial starts from the state before the step, so that the result depends on nothing else.

use super::edge::Edge;
use crate::backend::BackendError;
use crate::scene::{RateScene, Scene};
use crate::solver::{Load, Problem, Start};
use crate::study::{Attempt, DOUBLE, Hooks, HostBytes, Plan, PointState, Sizes, SolvedStep};
use crate::units::format_si;

/// Relative error up to which factor and speed agree.
const AGREE: f64 = 2e-3;
/// Solves of one step at most. Every third halves the bracket: 13 halvings of its logarithm narrow a factor of a million to
/// the agreement.
const MOST_SOLVES: usize = 60;
/// Ratio of the ends of a bracket above which its logarithm is halved.
const WIDE: f64 = 100.0;
/// Least distance of a trial from the ends of its bracket, as a share of the bracket.
const CORNER: f64 = 0.05;

/// Share of its area below which a contact counts as separating by itself.
const LET_GO: f64 = 0.5;

/// The rate of a scene's adhesion.
fn rate_of(scene: &Scene) -> Option<RateScene> {
    scene.adhesion.as_ref().and_then(|adhesion| adhesion.rate)
}

/// A work of adhesion that grows with the speed of a receding edge.
pub(super) struct Rate;

impl Hooks for Rate {
    fn name(&self) -> &'static str {
        "rate"
    }

    fn purpose(&self) -> &'static str {
        "the work of adhesion grows with the speed at which the contact recedes, found in several solves a step"
    }

    fn is_on(&self, scene: &Scene) -> bool {
        rate_of(scene).is_some()
    }

    fn remove_from(&self, scene: &mut Scene) {
        if let Some(adhesion) = &mut scene.adhesion {
            adhesion.rate = None;
        }
    }

    fn example(&self) -> &'static [(&'static str, &'static str)] {
        &[
            super::adhesion::EXAMPLE,
            (
                "adhesion.rate",
                "{ reference_speed = 0.05, exponent = 0.5 }",
            ),
        ]
    }

    fn matters(&self, plan: &Plan) -> String {
        let grid = plan.outline.grid;
        let [x, y] = grid.varying(grid.size());
        let path: f64 = plan.scene.loading.durations.iter().flatten().sum();
        let reference = rate_of(&plan.scene).map_or(0.0, |rate| rate.reference_speed);
        format!(
            "matters where contacts recede at speeds not far below the reference: half the cell within the path's {} would be {:.2e} of it; one speed stands for the whole edge",
            format_si(path, "s"),
            0.5 * x.min(y) / path / reference
        )
    }

    fn pose(&self, problem: Problem, _: &Scene, _: Option<&[f64]>) -> Problem {
        if problem.law_factor.is_some() {
            return problem;
        }
        // A receding edge has a factor.
        let ones = vec![1.0; problem.heights.len()];
        problem.with_adhesion_map(ones)
    }

    fn host_bytes(&self, sizes: &Sizes) -> HostBytes {
        HostBytes {
            // Factors of one, and those of the present speed.
            kept: 2 * DOUBLE * sizes.points,
            // The gap before, on the surface and as the start of each trial.
            passing: DOUBLE * (sizes.points + sizes.solved),
            // The first trial.
            results: 1,
        }
    }

    // The dissipation of a moving edge cannot be told from that of a jump.
    fn hides_jumps(&self) -> bool {
        true
    }

    fn solve_load(
        &self,
        attempt: &mut Attempt,
        load: &Load,
        start: &Start,
    ) -> Option<Result<SolvedStep, BackendError>> {
        let rate = rate_of(&attempt.setup.scene)?;
        Some(solve(rate, attempt, load, start))
    }
}

/// Solves a load from a start, with the factor of the speed that its edge then has.
fn solve(
    rate: RateScene,
    attempt: &mut Attempt,
    load: &Load,
    start: &Start,
) -> Result<SolvedStep, BackendError> {
    let setup = attempt.setup;
    let duration = attempt.duration;
    let problem = attempt.problem;
    let before = if attempt.loaded {
        Some(problem.surface_part(&attempt.solver.gap()?))
    } else {
        None
    };
    let start = match start {
        Start::Present => Start::Gap(attempt.solver.gap()?),
        other => other.clone(),
    };
    let mut iterations = 0;
    let mut trial = |factor: f64| -> Result<SolvedStep, BackendError> {
        let raised = before.as_ref().filter(|_| factor > 1.0).map(|gap| {
            let range = problem.law.range();
            let own = |point: usize| setup.law_factor(point);
            gap.iter()
                .enumerate()
                .map(|(point, &g)| {
                    if g < range {
                        factor * own(point)
                    } else {
                        own(point)
                    }
                })
                .collect()
        });
        attempt.solver.set_law_factor(raised);
        let outcome = attempt.solve(load, &start)?;
        let outcome = attempt.restart_stalled(load, outcome)?;
        iterations += outcome.iterations;
        let mut solved = attempt.finish(load, &outcome)?;
        solved.iterations = iterations;
        Ok(solved)
    };
    let plain = trial(1.0)?;
    let Some(gap) = &before else {
        return Ok(plain);
    };
    let touched: Vec<bool> = gap.iter().map(|&g| g <= 0.0).collect();
    let edge_of =
        |touches: &[bool]| Edge::new(touches, &problem.share, &problem.grid, problem.boundary);
    let edge = edge_of(&touched)?;
    let later = |solved: &SolvedStep| {
        let touches: Vec<bool> = match &solved.evaluation {
            Some(found) => found
                .points
                .iter()
                .map(|p| *p == PointState::Contact)
                .collect(),
            None => vec![false; touched.len()],
        };
        edge_of(&touches)
    };
    // The factor of the speed found in a trial, less the factor of the trial.
    let excess = |later: &Edge, factor: f64| rate.factor(edge.recession(later, duration)) - factor;
    let left = later(&plain)?;
    let first = excess(&left, 1.0);
    if !plain.converged || first <= AGREE {
        return Ok(plain);
    }
    let (mut low, mut low_excess, mut low_area) = (1.0, first, left.area);
    let (mut high, mut high_excess) = (1.0 + first, None);
    let mut factor = high;
    for solves in 1.. {
        let solved = trial(factor)?;
        let left = later(&solved)?;
        let found = excess(&left, factor);
        let narrow = high - low <= AGREE * high && found <= 0.0;
        if narrow && low_area < LET_GO * left.area {
            // The last equilibrium of the raised law: beyond it the contact separates by itself.
            return trial(low);
        }
        // Where pixels separate one by one no factor may agree; the edge waits for the next pixel.
        if !solved.converged || found.abs() <= AGREE * factor || narrow || solves == MOST_SOLVES {
            let agrees = solves < MOST_SOLVES;
            return Ok(SolvedStep {
                converged: solved.converged && agrees,
                // Each solve may have converged: what has not is the factor.
                residual: match agrees {
                    true => solved.residual,
                    false => solved.residual.max(found.abs() / factor),
                },
                ..solved
            });
        }
        if found > 0.0 {
            (low, low_excess, low_area) = (factor, found, left.area);
        } else {
            (high, high_excess) = (factor, Some(found));
        }
        let share = match high_excess {
            Some(most) => (low_excess / (low_excess - most)).clamp(CORNER, 1.0 - CORNER),
            None => 1.0,
        };
        // Every third trial halves the bracket, in case the straight line converges slowly; the upper side is
        // solved last.
        factor = match high - low <= AGREE * high {
            true => high,
            false if solves % 3 != 0 => low + share * (high - low),
            false if high > WIDE * low => (low * high).sqrt(),
            false => 0.5 * (low + high),
        };
    }
    Ok(plain)
}
