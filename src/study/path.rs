//! A loading path, step after step, each from the state of the one before.

use super::between::{Between, Watched};
use super::checkpoint::{Checkpoint, Earlier};
use super::jumps::{Confirmed, Jump, Jumps, Verdict, confirm};
use super::observer::{FinishedStep, Observer, WalkEnd, WalkError};
use super::planned::Planned;
use super::pull_off;
use super::row::{State, StepRow};
use super::setup::Setup;
use super::step::SolvedStep;
use super::walker::{Carried, Means, Walker};
use crate::backend::BackendError;
use crate::clock::Clock;
use crate::kernel::Scalars;
use crate::solver::MakeBackend;

/// Walks a path from its first step. Ends at the first step that does not converge, which is handed
/// on like any other.
pub fn walk<O: Observer>(
    setup: &Setup,
    make_backend: MakeBackend,
    observer: &mut O,
) -> Result<WalkEnd, WalkError<O::Error>> {
    walk_on(setup, make_backend, observer, Earlier::default())
}

/// Walks a path from the step after those done earlier. The rows, jumps and transforms of all of
/// them are in the end that it returns.
pub fn walk_on<O: Observer>(
    setup: &Setup,
    make_backend: MakeBackend,
    observer: &mut O,
    earlier: Earlier,
) -> Result<WalkEnd, WalkError<O::Error>> {
    let mut walk = Walk::begin(setup, earlier);
    while walk.step(setup, make_backend, observer)? {}
    Ok(walk.end(setup))
}

/// A path on its way: its solver as the last step has left it, and what is known of the steps so far.
pub(crate) struct Walk {
    /// Of the steps so far.
    end: WalkEnd,
    jumps: Jumps,
    stage: Stage,
}

/// Where a path stands.
enum Stage {
    /// Before a step with another problem than those before it, or before the first.
    Before(Carried),
    Within(Box<Stretch>),
    /// After a step that ended it.
    Ended,
}

/// Steps with the same problem, which one solver takes.
struct Stretch {
    walker: Walker,
    /// How long each takes, s, where the problem depends on it.
    duration: f64,
    /// Transforms of other solvers: those of earlier stretches, and further ones of this one.
    others: f64,
    /// The state that the last step left, where it is at hand.
    standing: Option<Carried>,
}

impl Walk {
    /// A path before the step after those done earlier.
    pub fn begin(setup: &Setup, earlier: Earlier) -> Walk {
        let Earlier { rows, checkpoint } = earlier;
        let carried = Carried::from_checkpoint(setup, &checkpoint);
        let mut end = WalkEnd {
            jump_in_steps: checkpoint.jump_in_steps,
            jump_off_steps: checkpoint.jump_off_steps,
            pull_off: checkpoint.pull_off,
            transforms: checkpoint.transforms,
            ..WalkEnd::default()
        };
        let last_jump = end.jump_in_steps.last().max(end.jump_off_steps.last());
        let mut jumps = Jumps::new(setup);
        jumps.resume(&rows, checkpoint.points, last_jump == Some(&rows.len()));
        end.rows = rows;
        Walk {
            end,
            jumps,
            stage: Stage::Before(carried),
        }
    }

    /// The steps so far.
    pub fn so_far(&self) -> &WalkEnd {
        &self.end
    }

    /// How it ended, or stands.
    pub fn end(&self, setup: &Setup) -> WalkEnd {
        let jumped = [&self.end.jump_in_steps[..], &self.end.jump_off_steps].concat();
        let found = self
            .jumps
            .hysteresis(&setup.scene.loading.path, &self.end.rows, &jumped)
            // Attraction that is summed afterwards makes one curve of both ways, whose force is not the slope of its energies.
            .filter(|_| !setup.sums_attraction());
        // What a solid or an edge loses by its rate cannot be told from an error.
        let has_rates = setup.effects.depend_on_duration() || setup.effects.hide_jumps();
        let uncertainty = found.filter(|_| !has_rates);
        WalkEnd {
            hysteresis_energy: found.map(|found| found.energy),
            hysteresis_uncertainty: uncertainty.map(|found| found.uncertainty),
            ..self.end.clone()
        }
    }

    /// Solves the next step; whether there may be one after it. Of the setup only the loads behind this step may change
    /// from step to step.
    pub fn step<O: Observer>(
        &mut self,
        setup: &Setup,
        make_backend: MakeBackend,
        observer: &mut O,
    ) -> Result<bool, WalkError<O::Error>> {
        let Some(planned) = Planned::after(setup, &self.end.rows) else {
            return Ok(false);
        };
        let means = Means {
            setup,
            make_backend,
            tolerance: setup.scene.solver.tolerance,
        };
        let mut stretch = match self.stretch(&means, planned.duration)? {
            Some(stretch) => stretch,
            None => return Ok(false),
        };
        let goes_on = stretch.step(&means, planned, observer, &mut self.end, &mut self.jumps)?;
        if goes_on {
            self.stage = Stage::Within(stretch);
        }
        Ok(goes_on)
    }

    /// The stretch that the next step belongs to, of its duration; `None` where the path has ended. If the step fails, it
    /// has.
    fn stretch(
        &mut self,
        means: &Means,
        duration: f64,
    ) -> Result<Option<Box<Stretch>>, BackendError> {
        let depends = means.setup.effects.depend_on_duration();
        let carried = match std::mem::replace(&mut self.stage, Stage::Ended) {
            Stage::Ended => return Ok(None),
            Stage::Before(carried) => carried,
            Stage::Within(stretch) if !depends || stretch.duration == duration => {
                return Ok(Some(stretch));
            }
            // Its solver goes before the next one comes.
            Stage::Within(stretch) => stretch.left()?,
        };
        Ok(Some(Box::new(Stretch {
            walker: Walker::new(means, duration, carried),
            duration,
            others: self.end.transforms,
            standing: None,
        })))
    }
}

impl Stretch {
    /// The state that its last step left.
    fn left(mut self) -> Result<Carried, BackendError> {
        match self.standing {
            Some(left) => Ok(left),
            None => self.walker.carried(),
        }
    }

    /// Solves a step; whether the path goes on.
    fn step<O: Observer>(
        &mut self,
        means: &Means,
        Planned { value, duration }: Planned,
        observer: &mut O,
        end: &mut WalkEnd,
        jumps: &mut Jumps,
    ) -> Result<bool, WalkError<O::Error>> {
        let clock = Clock::start();
        let setup = means.setup;
        let walker = &mut self.walker;
        let index = end.rows.len();
        let step = index + 1;
        let state = match self.standing.take() {
            Some(state) => Some(state),
            None if looks_back(setup, &end.rows, jumps) && walker.is_loaded() => {
                Some(walker.carried()?)
            }
            None => None,
        };
        let mut watch = |watched: Watched| match watched {
            Watched::Iteration(scalars) => observer.iteration(step, scalars),
            Watched::Search(search) => {
                observer.search(step, search);
                true
            }
        };
        let mut iteration = |scalars: &Scalars| watch(Watched::Iteration(scalars));
        let mut solved = walker.advance(means, value, duration, &mut iteration)?;
        if !walker.is_interrupted() {
            walker.measure(setup, &mut solved, &mut iteration)?;
        }
        if walker.is_interrupted() {
            end.transforms = self.others + walker.solver.transforms();
            end.interrupted = true;
            return Ok(false);
        }
        if solved.converged {
            walker.settle()?;
        }
        let mut row = walker.row(setup, step, value, &solved);
        row.time = time(setup, duration, end.rows.last());
        let between = Between {
            means: *means,
            from: Planned::of_step(setup, &end.rows, index).unwrap_or(value),
            to: value,
            duration,
            walker,
            watch: &mut watch,
            transforms: 0.0,
            interrupted: false,
        };
        let found = look_between(between, jumps, end.rows.last(), state, &row, &solved)?;
        self.others += found.transforms;
        end.transforms = self.others + walker.solver.transforms();
        if found.interrupted {
            end.interrupted = true;
            return Ok(false);
        }
        if let Some(let_go) = found.pull_off {
            end.pull_off = Some(let_go.greater(end.pull_off));
        }
        match found.jump {
            Some(Jump::In) => end.jump_in_steps.push(step),
            Some(Jump::Off) => end.jump_off_steps.push(step),
            None => {}
        }
        jumps.take(&row, solved.evaluation.as_ref(), found.jump.is_some());
        row.seconds = clock.seconds();
        end.rows.push(row);
        let row = &end.rows[index];
        let finished = FinishedStep {
            row,
            evaluation: solved.evaluation,
            jump: found.jump,
            jump_is_guessed: found.jump_is_guessed,
            is_last: !row.converged || Planned::after(setup, &end.rows).is_none(),
        };
        observer.step(finished).map_err(WalkError::Observer)?;
        if !row.converged {
            end.unreachable = solved.unreachable;
            return Ok(false);
        }
        if observer.wants_checkpoint() {
            let left = walker.carried()?;
            let checkpoint = Checkpoint {
                fields: left.checkpoint_fields(),
                evaluated_under: walker.solver.evaluated_under(),
                points: jumps.points().map(<[_]>::to_vec),
                jump_in_steps: end.jump_in_steps.clone(),
                jump_off_steps: end.jump_off_steps.clone(),
                pull_off: end.pull_off,
                transforms: end.transforms,
            };
            let kept = observer.checkpoint(step, &checkpoint);
            kept.map_err(WalkError::Observer)?;
            let needed = walker.is_loaded() && looks_back(setup, &end.rows, jumps);
            self.standing = needed.then_some(left);
        }
        Ok(true)
    }
}

/// Whether the state before the step after these rows may be needed, to look between the two.
fn looks_back(setup: &Setup, rows: &[StepRow], jumps: &Jumps) -> bool {
    let lets_go = |planned: Planned| pull_off::may_let_go(setup, planned.value);
    Planned::after(setup, rows).is_some_and(|planned| jumps.watches() || lets_go(planned))
}

/// Time at the end of a step of a duration, s, where the path has durations.
fn time(setup: &Setup, duration: f64, before: Option<&StepRow>) -> Option<f64> {
    setup.scene.loading.durations.as_ref()?;
    let before = before.and_then(|row| row.time).unwrap_or(0.0);
    Some(before + duration)
}

/// Residual of a state whose tension is compared with others, over the tolerance of pull-off.
const ASKED: f64 = 0.01;

/// Result of a search between two steps.
#[derive(Default)]
struct Found {
    jump: Option<Jump>,
    /// Whether the search ended before it could tell; `jump` is then a guess.
    jump_is_guessed: bool,
    pull_off: Option<pull_off::PullOff>,
    /// Transforms of further solvers.
    transforms: f64,
    interrupted: bool,
}

/// Looks between a step and the one before it, whose state is at hand where that may be needed. The
/// walker is left where the step left it.
fn look_between(
    mut between: Between,
    jumps: &Jumps,
    before: Option<&StepRow>,
    state: Option<Carried>,
    row: &StepRow,
    solved: &SolvedStep,
) -> Result<Found, BackendError> {
    let mut found = Found::default();
    let (Some(before), true) = (before, row.converged) else {
        return Ok(found);
    };
    let verdict = jumps.judge(row, solved.evaluation.as_ref());
    if let Verdict::Jumped(way) = verdict {
        found.jump = Some(way);
    }
    let Some(state) = state else {
        return Ok(found);
    };
    let held = before.state != State::Separated;
    let lets_go = held
        && solved.evaluation.is_none()
        && pull_off::may_let_go(between.means.setup, between.to);
    if let Verdict::Perhaps { way, least } = verdict {
        let left = between.walker.carried()?;
        let (setup, tolerance, first) =
            (between.means.setup, between.means.tolerance, state.clone());
        let jumped = match confirm(&mut between, before, state, row, least)? {
            Confirmed::Jumped(ends) => {
                if let (Some(ends), Some(spring)) = (ends, setup.spring())
                    && way == Jump::Off
                {
                    // As well as pull-off is asked for, and no better than the steps.
                    let wanted = ASKED * setup.scene.loading.pull_off_tolerance;
                    between.means.tolerance = between.means.tolerance.min(wanted).max(tolerance);
                    found.pull_off =
                        pull_off::find_on_spring(&mut between, (first, before), spring, *ends)?;
                }
                true
            }
            Confirmed::Smooth => false,
            Confirmed::Guessed(jumped) => {
                found.jump_is_guessed = true;
                jumped
            }
            Confirmed::Interrupted => false,
        };
        found.jump = jumped.then_some(way);
        between.walker.go_back(&left);
    } else if lets_go {
        let left = between.walker.carried()?;
        found.pull_off = pull_off::find(&mut between, before.step, state)?;
        between.walker.go_back(&left);
    }
    found.transforms = between.transforms;
    found.interrupted = between.interrupted;
    Ok(found)
}
