//! `treatment = "dmt"`, the DMT force approach: attraction summed over the gap of the solution without it,
//! and under a prescribed load a search for the repulsive load with that net load.

use crate::backend::BackendError;
use crate::grid::Boundary;
use crate::law::Law;
use crate::scene::{Scene, Treatment};
use crate::solver::Start;
use crate::study::control::Position;
use crate::study::{
    Attempt, Evaluation, Hooks, HostBytes, Plan, Setup, Sizes, SolvedStep, held_across, separated,
};

/// Tabor number beyond which pull-off is more than a fifth off (a sphere at 1.3: 1.21 of 2 pi w R, which no equilibrium exceeds).
const MOST_TABOR: f64 = 1.0;
/// Most hard-wall solves in one step.
const MOST_SOLVES: usize = 240;
/// Repulsive loads below this share of the law's peak are a first touch.
const TOUCH: f64 = 1e-9;
/// Factor between successive repulsive loads of the search from above, where no bound allows a longer step:
/// two solutions closer to each other than this may both be missed.
const RUNG: f64 = 1.15;
/// The same below the share of the peak at which few summits touch.
const LIGHT_RUNG: f64 = 1.5;
const LIGHT: f64 = 1e-3;
/// Solves that look for a minimum of the net load between three repulsive loads.
const DIP_SOLVES: usize = 12;

/// Width of a bracket, over the largest repulsive load, below which the net load counts as jumping.
const JUMP_WIDTH: f64 = 1e-10;

/// One repulsive load and what is left of it.
struct Balance {
    /// Repulsive mean pressure over all solved points, Pa.
    repulsive: f64,
    /// Net mean pressure less the asked one, Pa.
    excess: f64,
    /// No lesser repulsive load has more attraction than this, Pa.
    most_attraction: f64,
    solved: SolvedStep,
}

/// Relative difference up to which the sum over the field equals the prescribed load.
const SAME: f64 = 1e-3;

/// Whether the sum over a field (N) is the prescribed load (N), to what the search resolves; at a jump of
/// the net load it is not.
fn meets(setup: &Setup, asked: f64, sum: f64) -> bool {
    let peak = setup.law.peak_tension() * setup.largest_law_factor();
    // The error of the search: its tolerance, or the width of a bracket without a jump.
    let share = (setup.scene.solver.tolerance * 1e-3).max(10.0 * JUMP_WIDTH);
    let reached = share * peak * setup.surface.grid.area();
    (sum - asked).abs() <= SAME * asked.abs() + reached
}

/// Attraction that does not deform the contact.
pub(super) struct Dmt;

impl Hooks for Dmt {
    fn name(&self) -> &'static str {
        "dmt treatment"
    }

    fn purpose(&self) -> &'static str {
        "attraction is summed over the gap of the contact without it, which it does not deform"
    }

    fn is_on(&self, scene: &Scene) -> bool {
        let adhesion = scene.adhesion.as_ref();
        adhesion.is_some_and(|adhesion| adhesion.treatment == Treatment::Dmt)
    }

    fn remove_from(&self, scene: &mut Scene) {
        if let Some(adhesion) = &mut scene.adhesion {
            adhesion.treatment = Treatment::Full;
        }
    }

    fn example(&self) -> &'static [(&'static str, &'static str)] {
        &[super::adhesion::EXAMPLE, ("adhesion.treatment", "dmt")]
    }

    fn matters(&self, plan: &Plan) -> String {
        let holds = "holds at Tabor numbers well below 1";
        match plan.regime.and_then(|regime| regime.tabor) {
            Some(tabor) => format!("{holds}: here {tabor:.3}"),
            None => holds.to_owned(),
        }
    }

    fn warnings(&self, plan: &Plan) -> Vec<String> {
        let tabor = plan.regime.and_then(|regime| regime.tabor);
        let soft = tabor.filter(|tabor| *tabor > MOST_TABOR);
        let words = |tabor: f64| {
            format!(
                "treatment = \"dmt\" holds at Tabor numbers well below 1, and here it is {tabor:.2}: the attraction would deform the contact, and pull-off comes out too high; take treatment = \"full\""
            )
        };
        soft.map(words).into_iter().collect()
    }

    fn solved_law(&self, _: Law) -> Law {
        Law::HardWall
    }

    fn host_bytes(&self, _: &Sizes) -> HostBytes {
        HostBytes {
            // Both ends of a bracket.
            results: 2,
            ..HostBytes::default()
        }
    }

    // Loading and unloading are the same curve.
    fn hides_jumps(&self) -> bool {
        true
    }

    fn solve_value(&self, attempt: &mut Attempt) -> Option<Result<SolvedStep, BackendError>> {
        attempt.controller.is_load().then(|| {
            let (setup, controller) = (attempt.setup, attempt.controller);
            let asked = controller.mean_pressure(attempt.value);
            let mut solved = search(attempt)?;
            if let Some(found) = &mut solved.evaluation {
                solved.load_is_met = meets(setup, controller.force(asked), found.force);
                let net = Position {
                    mean_pressure: asked,
                    ..found.position
                };
                found.missed = controller.missed(&net, found.force);
            }
            Ok(solved)
        })
    }
}

/// The largest repulsive load with the prescribed net load; separated if there is none.
///
/// The net load is not monotone in the repulsive one. The search comes from above, where no attraction
/// suffices, by steps that cannot pass a solution, and by factors of [`RUNG`] where there is no such step.
fn search(attempt: &mut Attempt) -> Result<SolvedStep, BackendError> {
    let (setup, controller) = (attempt.setup, attempt.controller);
    let asked = controller.mean_pressure(attempt.value);
    let peak = setup.law.peak_tension() * setup.largest_law_factor();
    let covered = setup.surface.grid.len() as f64 / setup.problem.shape.len() as f64;
    let tolerance = setup.scene.solver.tolerance;
    let mut iterations = 0;
    let mut loaded = attempt.loaded;
    let mut balance = |repulsive: f64| -> Result<Balance, BackendError> {
        let load = controller.pressure_load(repulsive);
        let start = match (loaded, setup.problem.boundary) {
            (true, _) => Start::Present,
            (false, Boundary::Periodic) => Start::Cold,
            (false, Boundary::Free) => Start::Gap(controller.undeformed_gap(0.0, None).into()),
        };
        let outcome = attempt.solve(&load, &start)?;
        loaded = true;
        iterations += outcome.iterations;
        let solved = attempt.finish(&load, &outcome)?;
        let net = solved
            .evaluation
            .as_ref()
            .map_or(0.0, |evaluation| evaluation.force / controller.force(1.0));
        let most_attraction = solved.evaluation.as_ref().map_or(0.0, |evaluation| {
            most_attraction(setup, evaluation) / controller.force(1.0)
        });
        Ok(Balance {
            repulsive,
            excess: net - asked,
            most_attraction,
            solved,
        })
    };
    // From above: the attraction is at most the peak everywhere, so here the net load is too large.
    let mut upper = balance((asked + peak * covered).max(TOUCH * peak))?;
    let scale = upper.repulsive;
    let mut lower: Option<Balance> = None;
    // The repulsive load above `upper`, while the net load may have a minimum between the two.
    let mut above: Option<(f64, f64)> = None;
    let mut dip: Option<Dip> = None;
    let mut width = f64::INFINITY;
    for _ in 0..MOST_SOLVES {
        let done = |excess: f64| excess.abs() <= tolerance * (asked.abs() + scale * 1e-3);
        // A law with tension at zero gap makes the net load jump as a point leaves the contact;
        // where the prescribed load lies within such a jump, its two sides are one state.
        let at_a_jump = width <= JUMP_WIDTH * scale;
        // A tension beyond the one asked for would count as held.
        let is_nearer =
            |low: &mut Balance| low.excess.abs() < upper.excess.abs() && asked + low.excess >= 0.0;
        if at_a_jump && let Some(near) = lower.take_if(is_nearer) {
            upper = near;
        }
        if !upper.solved.converged || done(upper.excess) || at_a_jump {
            upper.solved.iterations = iterations;
            return Ok(upper.solved);
        }
        let next = match &lower {
            None => match &dip {
                Some(dip) => dip.next(),
                // No solution lies above the bound from the greatest attraction of any lesser load; where that
                // is no progress, one factor down.
                None => {
                    let factor = if upper.repulsive < LIGHT * peak {
                        LIGHT_RUNG
                    } else {
                        RUNG
                    };
                    (asked + upper.most_attraction).min(upper.repulsive / factor)
                }
            },
            Some(low) => {
                let span = upper.repulsive - low.repulsive;
                // Regula falsi where it works, halves where it does not.
                let share = upper.excess / (upper.excess - low.excess);
                let share = if span > 0.5 * width {
                    0.5
                } else {
                    share.clamp(0.05, 0.95)
                };
                width = span;
                upper.repulsive - share * span
            }
        };
        if lower.is_none() && next <= TOUCH * peak {
            let Some(clearance) = held_across(setup, -asked / covered) else {
                return Ok(SolvedStep {
                    iterations,
                    ..separated()
                });
            };
            let load = controller.clearance_load(clearance);
            let start = Start::Gap(controller.gap_at_clearance(clearance).into());
            let outcome = attempt.solve(&load, &start)?;
            let mut solved = attempt.finish(&load, &outcome)?;
            solved.iterations += iterations;
            return Ok(solved);
        }
        let found = balance(next)?;
        if !found.solved.converged || done(found.excess) {
            upper = found;
            lower = None;
            continue;
        }
        if found.excess <= 0.0 {
            if let Some(dip) = dip.take() {
                // The state above the dip is known by its numbers only.
                upper = balance(dip.places[0].0)?;
            }
            lower = Some(found);
            continue;
        }
        if lower.is_some() {
            upper = found;
        } else if let Some(searched) = &mut dip {
            if !searched.narrow((found.repulsive, found.excess)) {
                // The minimum holds no solution: the search continues below it.
                let below = searched.after;
                dip = None;
                upper = balance(below)?;
                above = None;
            }
        } else {
            let here = (upper.repulsive, upper.excess);
            let places = above.map(|above| [above, here, (found.repulsive, found.excess)]);
            above = Some(here);
            upper = found;
            dip = places.and_then(Dip::from_places);
        }
    }
    upper.solved.iterations = iterations;
    upper.solved.converged = false;
    Ok(upper.solved)
}

/// Upper bound of the attraction in all states of a lesser repulsive load, N: each point pulls by the most
/// that it can as its gap widens, and points in contact by the peak.
fn most_attraction(setup: &Setup, evaluation: &Evaluation) -> f64 {
    let law = setup.law;
    let (gap, width) = (&evaluation.gap, setup.surface.grid.nx);
    let [sum] = setup.problem.share.sums(gap.len() / width, |row, [sum]| {
        let line = gap.iter().enumerate().skip(row * width).take(width);
        for (i, gap) in line {
            *sum += setup.law_factor(i) * law.traction_beyond(gap.max(0.0));
        }
    });
    sum * setup.surface.grid.pixel_area()
}

/// Three repulsive loads from above, with the excess of each, of which the middle one has the least.
struct Dip {
    places: [(f64, f64); 3],
    /// The repulsive load at which the search continues if the minimum holds no solution.
    after: f64,
    solves: usize,
}

impl Dip {
    /// A minimum that may reach a solution: its middle lies below both others by more than a quarter of its
    /// excess.
    fn from_places(places: [(f64, f64); 3]) -> Option<Dip> {
        let [(_, left), (_, middle), (after, right)] = places;
        let depth = left.min(right) - middle;
        (depth > 0.0 && 4.0 * depth > middle).then_some(Dip {
            places,
            after,
            solves: 0,
        })
    }

    /// The middle, in logarithms, of the wider side.
    fn next(&self) -> f64 {
        let [(left, _), (middle, _), (right, _)] = self.places;
        if left / middle > middle / right {
            (left * middle).sqrt()
        } else {
            (middle * right).sqrt()
        }
    }

    /// Takes a state between the three; says whether to continue.
    fn narrow(&mut self, found: (f64, f64)) -> bool {
        let [left, middle, right] = self.places;
        self.places = match (found.0 > middle.0, found.1 < middle.1) {
            (true, true) => [left, found, middle],
            (true, false) => [found, middle, right],
            (false, true) => [middle, found, right],
            (false, false) => [left, middle, found],
        };
        self.solves += 1;
        self.solves < DIP_SOLVES
    }
}
