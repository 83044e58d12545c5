//! Mixed precision: iterations in single, the state and its residual in double.
//!
//! A first solve in single precision brings the residual near what its rounding allows. Then come
//! rounds: the residual y of the gap g is taken in double precision, and the same iteration, in
//! single, looks for the correction c that removes it, with c >= -g at a wall. All that it works
//! with is relative to c, so each round gains some digits, whatever the law.

use super::contact::{ContactSolver, Load, Outcome};
use super::outer_state::OuterState;
use crate::backend::{Backend, BackendError, Field};
use crate::kernel::{Scalars, Status};

/// Tolerance of the first solve: what single precision reaches on every scene.
pub(super) const FIRST_TOLERANCE: f64 = 1e-4;
/// Share of a round's first residual at which it ends: what single precision gains in one.
const GAIN: f64 = 3e-4;
/// Share of the tolerance that a round aims at, for what its rounding leaves besides.
const AIM: f64 = 0.5;
/// Iterations of a round.
const ROUND_ITERATIONS: usize = 100;
/// A round that leaves more than this share of the residual has gained nothing. Where gaps lie on a kink of
/// the law to the rounding of single precision, rounds take it for the other side's and gain a third each.
const NO_GAIN: f64 = 0.8;
/// Rounds that a solve may take. One that gains takes a fifth of the residual away at least, and three digits as
/// a rule, of the sixteen there are.
pub const MOST_ROUNDS: usize = 60;
/// Rounds without gain, in a row, that end a solve.
const LOST_ROUNDS: usize = 4;
/// Trials, lost ones included, that may be made for each iteration allowed.
pub const TRIALS_PER_ITERATION: usize = 4;

impl ContactSolver<'_> {
    /// The state in double precision, made when it is first asked for; `None` where the backend's own
    /// numbers will do.
    pub(super) fn outer(&mut self) -> Option<&mut OuterState> {
        // The corrections are those of a wall; what flows is left to the backend's own numbers.
        if self.outer.is_none() && self.problem.hardness.is_none() {
            let double = self.backend.in_double(self.problem.shape)?;
            self.outer = Some(OuterState::new(
                double,
                self.backend,
                self.level,
                self.problem,
            ));
        }
        self.outer.as_mut()
    }

    /// Iterates until the end that the scalars say, for at most so many iterations after those
    /// `before`, or until `watch` has enough. Returns the last scalars and whether `watch` had enough.
    fn run_out(
        &mut self,
        before: usize,
        most: usize,
        watch: &mut dyn FnMut(&Scalars) -> bool,
    ) -> Result<(Scalars, bool), BackendError> {
        let mut tried = 0;
        let mut done = 0;
        loop {
            let (recorded, scalars) = self.advance(most.saturating_sub(done).max(1))?;
            tried += recorded;
            done = (scalars.iterations as usize).saturating_sub(before);
            let goes_on = watch(&scalars);
            let over = done >= most || tried >= TRIALS_PER_ITERATION * most.max(1);
            if scalars.status != Status::Running || over || !goes_on {
                return Ok((scalars, !goes_on));
            }
        }
    }

    /// Solves a load that has begun: in single precision first, then in rounds of corrections.
    pub(super) fn solve_in_rounds(
        &mut self,
        load: &Load,
        tolerance: f64,
        max_iterations: usize,
        watch: &mut dyn FnMut(&Scalars) -> bool,
    ) -> Result<Outcome, BackendError> {
        let params = self.params;
        let (first, mut stopped) = self.run_out(0, max_iterations, watch)?;
        let mut iterations = first.iterations as usize;
        let mut status = first.status;
        let mut end = self.refer(|outer, iterating, gap| {
            outer.begin(load, tolerance, &params);
            outer.copy_gap(iterating, gap)?;
            outer.evaluate()
        })?;
        let mut lost = 0;
        let mut rounds = 0;
        loop {
            let at_floor = end.numerator <= self.rounding_floor(&end);
            let over = stopped || iterations >= max_iterations;
            if status == Status::PulledOff || end.status != Status::Running {
                // What the surfaces did in single precision they did; all else is judged in double.
                status = match status {
                    Status::PulledOff => status,
                    _ => end.status,
                };
                break;
            }
            if at_floor || lost >= LOST_ROUNDS || rounds == MOST_ROUNDS || over {
                status = match (at_floor, over) {
                    (true, _) => Status::Converged,
                    (false, true) => Status::Running,
                    (false, false) => Status::Stalled,
                };
                break;
            }
            rounds += 1;
            // By the numerator, where there is no pressure yet to measure it by.
            let before = [end.residual, end.numerator];
            let most = ROUND_ITERATIONS.min(max_iterations - iterations);
            let round = self.correct(&end, tolerance, most, iterations, watch)?;
            iterations = round.0.iterations as usize;
            status = round.0.status;
            stopped = round.1;
            end = self.refer(|outer, iterating, correction| {
                outer.add(iterating, correction)?;
                outer.evaluate()
            })?;
            let gained = match before[0].is_finite() {
                true => end.residual <= NO_GAIN * before[0],
                false => end.numerator <= NO_GAIN * before[1],
            };
            lost = match gained {
                true => 0,
                false => lost + 1,
            };
        }
        Ok(Outcome::new(
            status,
            iterations,
            end.residual,
            end.mean_pressure,
        ))
    }

    /// The numerator that rounding in double precision leaves, of a pad's points too, which have no
    /// gap of their own to be measured by.
    fn rounding_floor(&self, end: &Scalars) -> f64 {
        let shape = self.problem.shape;
        let padded = shape.len() as f64 / shape.surface_len() as f64;
        self.outer
            .as_ref()
            .map_or(0.0, |outer| outer.rounding_floor(end))
            * padded.sqrt()
    }

    /// Does something with the state in double precision, the backend of the iterations and the field
    /// that these work on.
    fn refer<R>(
        &mut self,
        work: impl FnOnce(&mut OuterState, &mut dyn Backend, Field) -> Result<R, BackendError>,
    ) -> Result<R, BackendError> {
        match &mut self.outer {
            Some(outer) => work(outer, self.backend, self.gap),
            // Only solvers with one come here.
            None => Err(BackendError::Device("no state in double precision".into())),
        }
    }

    /// One round: looks for the correction of the base, whose evaluation is `end`.
    fn correct(
        &mut self,
        end: &Scalars,
        tolerance: f64,
        most: usize,
        iterations: usize,
        watch: &mut dyn FnMut(&Scalars) -> bool,
    ) -> Result<(Scalars, bool), BackendError> {
        let base = self.refer(|outer, iterating, _| outer.hand_outer_state(iterating))?;
        if let (true, Some(heights_pressure)) = (self.params.fixed_gap, &self.heights_pressure) {
            let rigid = heights_pressure.field();
            self.refer(|outer, iterating, _| outer.hand_rigid(iterating, rigid))?;
        }
        for field in [
            self.gap,
            self.pressure,
            self.direction,
            self.previous_residual,
        ] {
            self.backend.clear(field);
        }
        self.backend.set_outer_state(Some(base));
        let mut params = self.params;
        // The scale of the base's residual; where that has no pressure, what is off balance itself.
        let residual = match end.residual.is_finite() {
            true => end.residual,
            false => 1.0,
        };
        params.tolerance = (AIM * tolerance).max(GAIN * residual);
        params.heights_norm = 0.0;
        params.pressure_floor = end.numerator / residual;
        self.backend.set_params(&params);
        let mut scalars = Scalars::start(0.0, false);
        scalars.iterations = iterations as u32;
        self.backend.set_scalars(&scalars);
        self.ready();
        let round = self.run_out(iterations, most, watch);
        self.backend.set_outer_state(None);
        round
    }
}
