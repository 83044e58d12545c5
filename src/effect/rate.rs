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
use crate::study::control::Position;
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
/// First step of the search for the position that carries a load, over the range, and the least over that.
const POSITION_STEP: f64 = 0.05;
const LEAST_POSITION_STEP: f64 = 1e-2;
/// Positions that are tried.
const MOST_POSITIONS: usize = 40;
/// Share of a load up to which a position carries it.
const LOAD_AGREES: f64 = 1e-3;

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
    let mut trials = Trials::new(rate, attempt, start)?;
    let (low, approach) = match trials.agree(load)? {
        Agreed::At(solved) => return Ok(*solved),
        Agreed::LetsGo { low, approach } => (low, approach),
    };
    match trials.held_at_a_position(approach)? {
        Some(solved) => Ok(solved),
        None => trials.trial(load, low),
    }
}

/// What becomes of a contact under a load.
enum Agreed {
    /// Factor and speed agree, or cannot.
    At(Box<SolvedStep>),
    /// The last equilibrium of the raised law is at more than the factor `low` and at an approach, m; beyond it the contact
    /// separates by itself.
    LetsGo { low: f64, approach: f64 },
}

/// Solves of one step, all from the state before it.
struct Trials<'t, 'a> {
    rate: RateScene,
    attempt: &'t mut Attempt<'a>,
    /// The gap before, on the surface; `None` where there was no contact.
    before: Option<Vec<f64>>,
    /// The edge before.
    edge: Edge,
    start: Start,
    iterations: usize,
}

impl<'t, 'a> Trials<'t, 'a> {
    fn new(
        rate: RateScene,
        attempt: &'t mut Attempt<'a>,
        start: &Start,
    ) -> Result<Self, BackendError> {
        let before = if attempt.loaded {
            Some(attempt.problem.surface_part(&attempt.solver.gap()?))
        } else {
            None
        };
        let start = match start {
            Start::Present => Start::Gap(attempt.solver.gap()?),
            other => other.clone(),
        };
        let gap = before.iter().flatten();
        let touched: Vec<bool> = gap.map(|&gap| gap <= 0.0).collect();
        let edge = match &before {
            Some(_) => edge_of(attempt.problem, &touched)?,
            None => Edge::default(),
        };
        Ok(Trials {
            rate,
            attempt,
            before,
            edge,
            start,
            iterations: 0,
        })
    }

    /// Solves a load with a factor.
    fn trial(&mut self, load: &Load, factor: f64) -> Result<SolvedStep, BackendError> {
        let attempt = &mut *self.attempt;
        let setup = attempt.setup;
        let raised = self.before.as_ref().filter(|_| factor > 1.0).map(|gap| {
            let range = attempt.problem.law.range();
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
        let outcome = attempt.solve(load, &self.start)?;
        let outcome = attempt.restart_stalled(load, outcome)?;
        self.iterations += outcome.iterations;
        let mut solved = attempt.finish(load, &outcome)?;
        solved.iterations = self.iterations;
        Ok(solved)
    }

    /// The edge of a solved state.
    fn edge_after(&self, solved: &SolvedStep) -> Result<Edge, BackendError> {
        let touches = match &solved.evaluation {
            Some(found) => {
                let points = found.points.iter();
                points.map(|p| *p == PointState::Contact).collect()
            }
            None => vec![false; self.before.as_ref().map_or(0, Vec::len)],
        };
        edge_of(self.attempt.problem, &touches)
    }

    /// Solves a load with the factor of the speed that its edge then has.
    fn agree(&mut self, load: &Load) -> Result<Agreed, BackendError> {
        let (rate, edge, duration) = (self.rate, self.edge, self.attempt.duration);
        // The factor of the speed found in a trial, less the factor of the trial.
        let excess =
            |later: &Edge, factor: f64| rate.factor(edge.recession(later, duration)) - factor;
        let plain = self.trial(load, 1.0)?;
        if self.before.is_none() {
            return Ok(Agreed::At(Box::new(plain)));
        }
        let left = self.edge_after(&plain)?;
        let first = excess(&left, 1.0);
        if !plain.converged || first <= AGREE {
            return Ok(Agreed::At(Box::new(plain)));
        }
        // Its fields are not held beside those of the others.
        drop(plain);
        let (mut low, mut low_excess, mut low_area) = (1.0, first, left.area);
        let (mut high, mut high_excess) = (1.0 + first, None);
        let mut factor = high;
        let mut solves = 0;
        loop {
            solves += 1;
            let solved = self.trial(load, factor)?;
            let left = self.edge_after(&solved)?;
            let found = excess(&left, factor);
            let narrow = high - low <= AGREE * high && found <= 0.0;
            if let Some(held) = &solved.evaluation
                && narrow
                && low_area < LET_GO * left.area
            {
                let approach = held.position.approach;
                return Ok(Agreed::LetsGo { low, approach });
            }
            // Where pixels separate one by one no factor may agree; the edge waits for the next pixel.
            let agrees = solves < MOST_SOLVES;
            if !solved.converged || found.abs() <= AGREE * factor || narrow || !agrees {
                return Ok(Agreed::At(Box::new(SolvedStep {
                    converged: solved.converged && agrees,
                    // Each solve may have converged: what has not is the factor.
                    residual: match agrees {
                        true => solved.residual,
                        false => solved.residual.max(found.abs() / factor),
                    },
                    ..solved
                })));
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
    }

    /// The state that carries the prescribed load, or that of the spring, where the law of one factor carries none: an edge that
    /// recedes faster toughens, and peels on while the load grows. It is an equilibrium of the prescribed position that is not one of
    /// the load; `approach` (m) is that of the last one that is. `None` if no position carries the load.
    fn held_at_a_position(&mut self, approach: f64) -> Result<Option<SolvedStep>, BackendError> {
        let (setup, controller) = (self.attempt.setup, *self.attempt.controller);
        let value = self.attempt.value;
        let spring = setup.spring();
        let asked = |approach: f64| match spring {
            Some(spring) => spring * (value - approach),
            None => controller.force(controller.mean_pressure(value)),
        };
        let is_free = controller.is_load() || spring.is_some();
        // Plastic depths would move the position.
        if !is_free || asked(approach) >= 0.0 || self.attempt.problem.hardness.is_some() {
            return Ok(None);
        }
        let first_step = POSITION_STEP * setup.law.range();
        let mut step = first_step;
        let (mut held, mut held_lack) = (approach, f64::INFINITY);
        // A position whose tension exceeds the one asked for; and one too far out, which holds less than one before or nothing.
        let mut over: Option<(f64, f64)> = None;
        let mut too_far: Option<f64> = None;
        let mut next = approach;
        for trials in 1..=MOST_POSITIONS {
            let tension = -asked(next);
            let solved = match self.agree(&controller.position_load(next))? {
                Agreed::At(solved) => Some(solved).filter(|solved| solved.converged),
                Agreed::LetsGo { .. } => None,
            };
            let position = solved
                .as_ref()
                .and_then(|solved| Some(solved.evaluation.as_ref()?.position));
            // What is left of the tension asked for.
            let lack = position.map(|held| tension + controller.force(held.mean_pressure));
            match lack {
                Some(lack) if lack.abs() <= LOAD_AGREES * tension => {
                    return Ok(solved.map(|mut solved| {
                        if let Some(found) = &mut solved.evaluation {
                            let asked = Position {
                                mean_pressure: -tension / controller.force(1.0),
                                ..found.position
                            };
                            found.missed = controller.missed(&asked, found.force);
                        }
                        *solved
                    }));
                }
                Some(lack) if lack <= 0.0 => over = Some((next, lack)),
                Some(lack) if over.is_some() || lack < held_lack => {
                    (held, held_lack) = (next, lack);
                }
                _ => too_far = Some(next),
            }
            next = match (over, too_far) {
                // The first one, whose factor is known to a share alone.
                (Some((over, _)), _) if held_lack.is_infinite() => {
                    step *= 2.0;
                    over + step
                }
                (Some((over, excess)), _) => {
                    let share = match trials % 3 {
                        0 => 0.5,
                        _ => held_lack / (held_lack - excess),
                    };
                    held + share.clamp(CORNER, 1.0 - CORNER) * (over - held)
                }
                (None, Some(_)) if held_lack.is_infinite() => break,
                (None, Some(far)) => 0.5 * (held + far),
                (None, None) => {
                    step *= 2.0;
                    held - step
                }
            };
            if held_lack.is_finite() && (next - held).abs() < LEAST_POSITION_STEP * first_step {
                break;
            }
        }
        Ok(None)
    }
}

/// The edge of the points that touch.
fn edge_of(problem: &Problem, touches: &[bool]) -> Result<Edge, BackendError> {
    Edge::new(touches, &problem.share, &problem.grid, problem.boundary)
}
