//! Mixed precision: iterations in single, the state and its residual in double.
//!
//! In rounds the residual y of the gap g is taken in double precision, and the same iteration, in
//! single, finds the correction c that removes it, with c >= -g at a wall. Its rounding is relative to c,
//! so each round gains some digits, whatever the law: the closer a start is, the more. A path that moves on by a
//! small step is mostly solved in one or two rounds. Only a start that is far is first solved in single precision.

use std::borrow::Cow;

use super::contact::ContactSolver;
use super::load::{Load, Outcome, Start};
use super::outer_state::OuterState;
use crate::backend::{Backend, BackendError, Field};
use crate::kernel::{Scalars, Status};
use crate::law::Law;

/// Tolerance of the first solve: what single precision reaches on every scene.
pub(super) const FIRST_TOLERANCE: f64 = 1e-4;
/// Share of its first residual at which a round ends: what single precision can gain.
const GAIN: f64 = 1e-4;
/// The same without attraction, where nothing but the rounding of the gap stands in the way.
const GAIN_AT_WALL: f64 = 3e-6;
/// Ranges by which the core of a law that repels by itself gives way to the residual of a near start. Trials of corrections follow
/// the core's slope, which is good for short ones.
const NEAR: f64 = 0.02;
/// Share of the tolerance that a round aims at, which leaves room for rounding.
const AIM: f64 = 0.8;
/// Iterations of a round.
const ROUND_ITERATIONS: usize = 100;
/// A round that leaves more than this share of the residual has gained nothing. Rounds gain only a third
/// each where gaps lie on a kink of the law, on whose other side single precision sees them.
const NO_GAIN: f64 = 0.8;
/// Rounds that a solve may take. A round removes a fifth of the residual at least, and three digits of
/// sixteen as a rule.
pub const MOST_ROUNDS: usize = 60;
/// Rounds without gain, in a row, that end a solve.
const LOST_ROUNDS: usize = 4;
/// Trials, lost ones included, that may be made for each iteration allowed.
pub const TRIALS_PER_ITERATION: usize = 4;

/// Held points from which iterations and state work in turn: memory of shorter fields stays with the allocator (glibc on 64
/// bits, below 32 MiB), in pieces that do not fit the other's.
const FEWEST_IN_TURN: usize = 1 << 23;

/// Whether, with so many held points, alone or on one of several ranks, the iterations of mixed precision rest while its state is
/// evaluated, and the other way round. The allocator of a rank gives all back at once.
pub fn works_in_turn(held: usize, is_alone: bool) -> bool {
    held >= FEWEST_IN_TURN || !is_alone
}

impl ContactSolver<'_> {
    /// The state in double precision, made at its first use; `None` where the backend's own numbers
    /// suffice.
    pub(super) fn outer(&mut self) -> Option<&mut OuterState> {
        // A hardness has no corrections: it is solved in the backend's own numbers.
        if self.outer.is_none() && self.problem.hardness.is_none() {
            let double = self.backend.in_double(self.problem.shape)?;
            self.outer = Some(OuterState::new(
                double,
                &mut *self.backend,
                self.level,
                &self.problem,
            ));
        }
        self.outer.as_mut()
    }

    /// Iterates until the scalars say that the solve has ended, for at most `most` iterations after those
    /// `before`, or until `watch` ends it. Returns the last scalars and whether `watch` ended it.
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
            let continues = watch(&scalars);
            let over = done >= most || tried >= TRIALS_PER_ITERATION * most.max(1);
            if scalars.status != Status::Running || over || !continues {
                return Ok((scalars, !continues));
            }
        }
    }

    /// Solves a load in rounds of corrections; one whose start is far, in single precision first.
    pub(super) fn solve_in_rounds(
        &mut self,
        load: &Load,
        start: Cow<Start>,
        tolerance: f64,
        max_iterations: usize,
        careful: bool,
        watch: &mut dyn FnMut(&Scalars) -> bool,
    ) -> Result<Outcome, BackendError> {
        let (mut iterations, mut status, mut stopped) = (0, Status::Running, false);
        let near = match &*start {
            // The careful descent moves the gap itself. Corrections of undeformed surfaces would be as large as their gap.
            _ if careful => None,
            Start::Cold => None,
            _ => self.near_start(load, &start, tolerance)?,
        };
        let mut end = match near {
            Some(end) => {
                drop(start);
                end
            }
            None => {
                self.hand_start(&start)?;
                self.begin(load, &start, tolerance.max(FIRST_TOLERANCE), careful)?;
                drop(start);
                let first = self.run_out(0, max_iterations, watch)?;
                // Corrections ask for no heights.
                self.release_heights();
                self.rest_in_turn();
                (iterations, status) = (first.0.iterations as usize, first.0.status);
                stopped = first.1;
                let params = self.params;
                self.with_outer(|outer, iterating, gap| {
                    outer.begin(load, tolerance, &params);
                    outer.copy_gap(iterating, gap)?;
                    outer.evaluate()
                })?
            }
        };
        let mut lost = 0;
        let mut rounds = 0;
        loop {
            let at_floor = end.numerator <= self.rounding_floor(&end);
            let over = stopped || iterations >= max_iterations;
            if status == Status::PulledOff || end.status != Status::Running {
                // A pull-off in single precision counts; all else is judged in double.
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
            // The numerator alone if there is no pressure yet.
            let before = [end.residual, end.numerator];
            let most = ROUND_ITERATIONS.min(max_iterations - iterations);
            let round = self.correct(&end, tolerance, most, iterations, watch)?;
            iterations = round.0.iterations as usize;
            status = round.0.status;
            stopped = round.1;
            end = self.with_outer(|outer, iterating, correction| {
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
        self.set_evaluated(load);
        Ok(Outcome::new(
            status,
            iterations,
            end.residual,
            end.mean_pressure,
        ))
    }

    /// Residual of the start of a solve in double precision; `None` where its corrections would be too large.
    fn near_start(
        &mut self,
        load: &Load,
        start: &Start,
        tolerance: f64,
    ) -> Result<Option<Scalars>, BackendError> {
        self.set_load(load, tolerance);
        let params = self.params;
        let is_evaluated = self.is_evaluated(load, start);
        let end = self.with_outer(|outer, _, _| {
            outer.begin(load, tolerance, &params);
            if let Start::Gap(gap) = start {
                outer.set_gap(gap);
            }
            if is_evaluated {
                outer.measure()
            } else {
                outer.evaluate()
            }
        })?;
        // By how much the core of a law that repels by itself would give way to this residual.
        let local = end.numerator / (params.points.sqrt() * params.smooth_stiffness);
        let is_near = params.law.has_wall() || local <= NEAR * params.law.range();
        Ok(is_near.then_some(end))
    }

    /// Hands the present gap, which is the outer state's, to where the iterations run.
    fn hand_start(&mut self, start: &Start) -> Result<(), BackendError> {
        // What has been evaluated is the pressure in double precision.
        self.forget_evaluated();
        if matches!(start, Start::Present) {
            self.with_outer(|outer, iterating, gap| outer.hand_gap(iterating, gap))?;
        }
        Ok(())
    }

    /// Whether the iterations rest while the state in double precision is evaluated, and the other way round.
    fn works_in_turn(&self) -> bool {
        let share = &self.problem.share;
        works_in_turn(share.len(), share.is_whole())
    }

    /// Lets go of all that the next round makes anew, where memory is worth it.
    fn rest_in_turn(&mut self) {
        if self.works_in_turn() {
            self.rest();
            self.backend.release(self.pressure);
        }
    }

    /// The numerator that rounding in double precision leaves, which the points of the pad add to.
    fn rounding_floor(&self, end: &Scalars) -> f64 {
        let shape = self.problem.shape;
        let padded = shape.len() as f64 / shape.surface_len() as f64;
        self.outer
            .as_ref()
            .map_or(0.0, |outer| outer.rounding_floor(end))
            * padded.sqrt()
    }

    /// Calls a function with the outer state, the backend of the iterations and the field of their gap.
    fn with_outer<R>(
        &mut self,
        work: impl FnOnce(&mut OuterState, &mut dyn Backend, Field) -> Result<R, BackendError>,
    ) -> Result<R, BackendError> {
        match &mut self.outer {
            Some(outer) => work(outer, &mut *self.backend, self.gap),
            // Only solvers with an outer state come here.
            None => Err(BackendError::Device("no state in double precision".into())),
        }
    }

    /// One round: finds the correction of the outer state, whose evaluation is `end`.
    fn correct(
        &mut self,
        end: &Scalars,
        tolerance: f64,
        most: usize,
        iterations: usize,
        watch: &mut dyn FnMut(&Scalars) -> bool,
    ) -> Result<(Scalars, bool), BackendError> {
        if let (true, Some(outer)) = (self.works_in_turn(), &mut self.outer) {
            outer.rest_work();
        }
        let pressure = self.pressure;
        let outer_gap =
            self.with_outer(|outer, iterating, _| outer.hand_outer_state(iterating, pressure))?;
        if self.params.prescribed_mean_gap && self.kernels.is_linear() {
            let rigid = self.heights_pressure();
            self.with_outer(|outer, iterating, _| outer.hand_rigid(iterating, rigid))?;
        }
        if let (true, Some(outer)) = (self.works_in_turn(), &mut self.outer) {
            outer.rest();
        }
        for field in [self.gap, self.direction, self.previous_residual] {
            self.backend.clear(field);
        }
        self.backend.set_outer_gap(Some(outer_gap));
        let mut params = self.params;
        // The scale of the outer residual; without a pressure there, its numerator.
        let residual = match end.residual.is_finite() {
            true => end.residual,
            false => 1.0,
        };
        let gain = match params.law {
            Law::HardWall => GAIN_AT_WALL,
            _ => GAIN,
        };
        params.tolerance = (AIM * tolerance).max(gain * residual);
        params.heights_norm = 0.0;
        params.pressure_floor = end.numerator / residual;
        self.backend.set_params(&params);
        let mut scalars = Scalars::start(0.0, false);
        scalars.iterations = iterations as u32;
        self.backend.set_scalars(&scalars);
        self.exact = self.levels.is_none();
        self.ready();
        self.choose_preconditioner()?;
        let round = self.run_out(iterations, most, watch);
        self.backend.set_outer_gap(None);
        self.rest_in_turn();
        if self.works_in_turn() {
            self.backend.release(outer_gap);
        }
        round
    }
}
