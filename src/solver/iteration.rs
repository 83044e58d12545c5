//! One iteration, recorded as a fixed list of kernels: each carries out a step of the plain text
//! ([`plain`](super::plain)), which its comment in [`kernel`](crate::kernel) names.

use super::contact::ContactSolver;
use super::multilevel::{EXACT_UNTIL, Multilevel};
use crate::backend::BackendError;
use crate::kernel::{Gate, Scalars, Status, displacement, scalar, step_length};

/// Most evaluations of one line search on a backend that looks at each, above the scalar kernels' own
/// bounds.
const SEARCHES: usize = 48;
/// Passes of a line search in one round on a backend that does not look: a search that needs more continues in
/// the next round, which does nothing else. At a wall a pass tries several steps, and most searches need no more.
const SEARCHES_AT_ONCE: usize = 1;
/// The same without a wall, where the trial evaluates the first step and an iteration takes four passes on average. One that
/// is not needed costs two dispatches that idle, a round all of them.
const SEARCHES_WITHOUT_WALL: usize = 4;

impl ContactSolver<'_> {
    /// Loads and measures the residual of the present state: every round starts from its transformed rows.
    pub(super) fn ready(&mut self) {
        let state = [self.gap, self.pressure];
        match in_use(&self.levels, self.exact) {
            Some(levels) => levels.load_residual(&mut *self.backend, state),
            None => self
                .backend
                .run(self.kernels.load_residual, self.level, &state),
        }
        self.backend.scalar(&scalar::TEST_CONVERGENCE);
    }

    /// p = K*(g + h) afresh, and the mean pressure that a prescribed mean gap takes.
    pub(super) fn refresh(&mut self) -> Result<(), BackendError> {
        let fields = [self.gap, self.heights];
        self.backend
            .run(&displacement::LOAD_DISPLACEMENT, self.level, &fields);
        self.backend.multiply(self.stiffness, false, Gate::Always);
        self.backend
            .run(&displacement::STORE_FIELD, self.level, &[self.pressure]);
        self.balance();
        Ok(())
    }

    /// One iteration.
    pub fn iterate(&mut self) -> Result<Scalars, BackendError> {
        self.record()?;
        let scalars = self.backend.scalars()?;
        self.leave_exact(&scalars);
        Ok(scalars)
    }

    /// Takes 1/K for a state that is far from a solution, if the levels might lead elsewhere from there.
    pub(super) fn choose_preconditioner(&mut self) -> Result<(), BackendError> {
        if self.levels.is_none() || self.preconditioner.is_none() {
            return Ok(());
        }
        if self.backend.scalars()?.residual >= EXACT_UNTIL {
            self.exact = true;
            let state = [self.gap, self.pressure];
            let load = self.kernels.load_residual;
            self.backend.run(load, self.level, &state);
        }
        Ok(())
    }

    /// Continues with the levels, as iterations near a solution do.
    pub fn precondition_by_levels(&mut self) {
        if let Some(levels) = &self.levels {
            self.exact = false;
            levels.load_residual(&mut *self.backend, [self.gap, self.pressure]);
        }
    }

    /// Continues with the levels once a step has come near a solution.
    fn leave_exact(&mut self, scalars: &Scalars) {
        let stepped = scalars.accepted && !scalars.repeat && !scalars.waits();
        if self.exact && stepped && scalars.residual < EXACT_UNTIL {
            self.precondition_by_levels();
        }
    }

    /// Up to `most` iterations, as many as the backend records before it looks; one while the preconditioner may
    /// change after it. Returns how many, including those that did nothing after the end.
    pub fn advance(&mut self, most: usize) -> Result<(usize, Scalars), BackendError> {
        let may_change = self.exact && self.levels.is_some();
        let rounds = if may_change {
            1
        } else {
            self.backend.look_every().min(most).max(1)
        };
        for _ in 0..rounds {
            self.record()?;
        }
        let scalars = self.backend.scalars()?;
        self.leave_exact(&scalars);
        Ok((rounds, scalars))
    }

    /// Records one iteration, from the rows of the residual to those of the next one. All decisions are
    /// taken by the scalar kernels; where looking is free a search stops when it is over.
    fn record(&mut self) -> Result<(), BackendError> {
        let (level, kernels) = (self.level, &self.kernels);
        let (g, p, d) = (self.gap, self.pressure, self.direction);
        let previous = self.previous_residual;
        let mean_gap = self.params.prescribed_mean_gap;
        let backend = &mut *self.backend;
        match in_use(&self.levels, self.exact) {
            Some(levels) => {
                let direction = mean_gap.then_some(d);
                levels.descend(backend, &self.params, [g, p, previous], direction);
            }
            None => {
                if let Some(preconditioner) = self.preconditioner {
                    backend.multiply(preconditioner, false, Gate::Ahead);
                }
                if mean_gap {
                    backend.run(kernels.mean_gap.descent, level, &[g, p, previous, d]);
                } else {
                    backend.run(kernels.descent, level, &[g, p, previous]);
                }
            }
        }
        backend.scalar(&scalar::CONJUGATE_DIRECTION);
        if mean_gap {
            self.try_at_mean_gap();
        } else {
            match self.step {
                Some(step) => backend.run(kernels.trial, level, &[g, p, d, step]),
                None => backend.run(kernels.trial, level, &[g, p, d]),
            }
            backend.scalar(&scalar::ACCEPT_TRIAL);
            backend.multiply(self.stiffness, true, Gate::Accepted);
        }
        self.backend.scalar(&step_length::STEP_LENGTH);
        if self.problem.law.has_tail() {
            self.search()?;
        }
        self.backend.scalar(&step_length::SNAP_TO_CONTACT);
        if mean_gap {
            self.advance_at_mean_gap();
            return Ok(());
        }
        let backend = &mut *self.backend;
        let without_step = [d, g, p, previous];
        let with_step = self.step.map(|step| [d, step, g, p, previous]);
        let state = with_step
            .as_ref()
            .map_or(&without_step[..], |fields| fields);
        match in_use(&self.levels, self.exact) {
            Some(levels) => levels.update_state(backend, state),
            None => backend.run(self.kernels.update_state, level, state),
        }
        backend.scalar(&step_length::ADAPT_TRIAL_LENGTH);
        backend.scalar(&scalar::TEST_CONVERGENCE);
        Ok(())
    }

    /// Records the line search, or the part of it that belongs to a round.
    fn search(&mut self) -> Result<(), BackendError> {
        let search = self.kernels.search;
        // The pressure tells to which side a closed point may move.
        let moved = self.step.unwrap_or(self.direction);
        let fields = [self.gap, moved, self.pressure];
        let fields = &fields[..search.fields()];
        let looks = self.backend.look_every() == 1;
        let most = match (looks, self.step) {
            (true, _) => SEARCHES,
            (false, None) => SEARCHES_AT_ONCE,
            (false, Some(_)) => SEARCHES_WITHOUT_WALL,
        };
        for _ in 0..most {
            if looks && !self.backend.scalars()?.is_open(Gate::Searching) {
                break;
            }
            self.backend.run(search, self.level, fields);
            self.backend.scalar(&step_length::SEARCH);
        }
        Ok(())
    }

    /// The stopping measure of the present gap, from pressures evaluated afresh.
    pub fn evaluate(&mut self) -> Result<Scalars, BackendError> {
        let mut scalars = self.backend.scalars()?;
        scalars.status = Status::Running;
        scalars.repeat = false;
        scalars.searching = false;
        scalars.lost = 0;
        scalars.stalls = 0;
        self.backend.set_scalars(&scalars);
        self.refresh()?;
        let fields = [self.gap, self.pressure];
        self.backend.run(self.kernels.residual, self.level, &fields);
        self.backend.scalar(&scalar::TEST_CONVERGENCE);
        self.backend.scalars()
    }
}

/// The levels, unless the preconditioner is 1/K for now.
fn in_use(levels: &Option<Multilevel>, exact: bool) -> Option<&Multilevel> {
    levels.as_ref().filter(|_| !exact)
}
