//! A loading path, step after step, each from the state of the one before.

use std::ops::Range;

use super::between::{Between, Watched};
use super::checkpoint::{Checkpoint, Earlier};
use super::jumps::{Jump, Jumps, Verdict, confirm};
use super::observer::{FinishedStep, Observer, WalkEnd, WalkError};
use super::planned::Planned;
use super::pull_off;
use super::row::{State, StepRow};
use super::setup::Setup;
use super::step::SolvedStep;
use super::walker::{Carried, Walker};
use crate::backend::BackendError;
use crate::clock::Clock;
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
    let Earlier { rows, checkpoint } = earlier;
    let mut carried = Carried::from_checkpoint(setup, &checkpoint);
    let mut end = WalkEnd {
        jump_in_steps: checkpoint.jump_in_steps,
        jump_off_steps: checkpoint.jump_off_steps,
        pull_off: checkpoint.pull_off,
        transforms: checkpoint.transforms,
        ..WalkEnd::default()
    };
    let done = rows.len();
    let last_jump = end.jump_in_steps.last().max(end.jump_off_steps.last());
    let mut jumps = Jumps::new(setup);
    jumps.resume(&rows, checkpoint.points, last_jump == Some(&done));
    end.rows = rows;
    for steps in stretches(setup, done) {
        let stretch = Stretch {
            setup,
            make_backend,
            steps,
        };
        if Planned::after(setup, &end.rows).is_none() {
            break;
        }
        match stretch.walk(observer, &mut end, &mut jumps, carried)? {
            Some(left) => carried = left,
            None => break,
        }
    }
    end.hysteresis_energy = jumps.hysteresis(&end.rows);
    Ok(end)
}

/// The steps after the first `done`, in stretches with the same problem: one, or one for each duration where
/// the problem depends on it. The last ones may hold steps that the path does not come to.
fn stretches(setup: &Setup, done: usize) -> Box<dyn Iterator<Item = Range<usize>>> {
    let loading = &setup.scene.loading;
    let planned = loading.path.len().max(done);
    match &loading.durations {
        Some(durations) if setup.effects.depend_on_duration() => {
            let mut stretches: Vec<Range<usize>> = Vec::new();
            for step in done..loading.path.len() {
                match stretches.last_mut() {
                    Some(last) if durations[last.start] == durations[step] => last.end = step + 1,
                    _ => stretches.push(step..step + 1),
                }
            }
            // Further steps have durations of their own.
            let further = (planned..usize::MAX).map(|step| step..step + 1);
            Box::new(stretches.into_iter().chain(further))
        }
        _ => Box::new(std::iter::once(done..usize::MAX)),
    }
}

/// Steps of a path with the same problem, which one solver takes.
struct Stretch<'s> {
    setup: &'s Setup,
    make_backend: MakeBackend<'s>,
    steps: Range<usize>,
}

impl Stretch<'_> {
    /// Walks the steps from the state that the path carries. Returns that after them, or `None` if the path
    /// ends.
    fn walk<O: Observer>(
        &self,
        observer: &mut O,
        end: &mut WalkEnd,
        jumps: &mut Jumps,
        carried: Carried,
    ) -> Result<Option<Carried>, WalkError<O::Error>> {
        let setup = self.setup;
        let planned = Planned::after(setup, &end.rows);
        let duration = planned.map_or(0.0, |planned| planned.duration);
        let problem = setup.effects.problem_over(setup, duration);
        let mut backend = (self.make_backend)();
        let mut walker = Walker::new(setup, self.make_backend, &mut *backend, &problem, carried);
        // Transforms of earlier stretches, and of further solvers of this one.
        let mut others = end.transforms;
        let mut standing: Option<Carried> = None;
        for index in self.steps.clone() {
            let clock = Clock::start();
            let step = index + 1;
            let Some(Planned { value, duration }) = Planned::after(setup, &end.rows) else {
                break;
            };
            let state = match standing.take() {
                Some(state) => Some(state),
                None if self.looks_back(index, &end.rows, jumps) && walker.is_loaded() => {
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
            let mut solved = walker.advance(value, duration, &mut |scalars| {
                watch(Watched::Iteration(scalars))
            })?;
            if walker.is_interrupted() {
                end.transforms = others + walker.solver.transforms();
                end.interrupted = true;
                return Ok(None);
            }
            walker.measure(&mut solved)?;
            if solved.converged {
                walker.settle()?;
            }
            let mut row = walker.row(step, value, &solved);
            row.time = self.time(duration, end.rows.last());
            let between = Between {
                from: Planned::of_step(setup, &end.rows, index).unwrap_or(value),
                to: value,
                duration,
                walker: &mut walker,
                watch: &mut watch,
                transforms: 0.0,
                interrupted: false,
            };
            let found = look_between(between, jumps, end.rows.last(), state, &row, &solved)?;
            others += found.transforms;
            end.transforms = others + walker.solver.transforms();
            if found.interrupted {
                end.interrupted = true;
                return Ok(None);
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
                is_last: !row.converged || Planned::after(setup, &end.rows).is_none(),
            };
            observer.step(finished).map_err(WalkError::Observer)?;
            if !row.converged {
                end.unreachable = solved.unreachable;
                return Ok(None);
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
                let needed = walker.is_loaded() && self.looks_back(index + 1, &end.rows, jumps);
                standing = needed.then_some(left);
            }
        }
        Ok(Some(match standing {
            Some(left) => left,
            None => walker.carried()?,
        }))
    }

    /// Whether the state before the step after these rows may be needed, to look between the two.
    fn looks_back(&self, index: usize, rows: &[StepRow], jumps: &Jumps) -> bool {
        let lets_go = |planned: Planned| pull_off::may_let_go(self.setup, planned.value);
        self.steps.contains(&index)
            && Planned::after(self.setup, rows)
                .is_some_and(|planned| jumps.watches() || lets_go(planned))
    }

    /// Time at the end of a step of a duration, s, where the path has durations.
    fn time(&self, duration: f64, before: Option<&StepRow>) -> Option<f64> {
        self.setup.scene.loading.durations.as_ref()?;
        let before = before.and_then(|row| row.time).unwrap_or(0.0);
        Some(before + duration)
    }
}

/// Result of a search between two steps.
#[derive(Default)]
struct Found {
    jump: Option<Jump>,
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
        && pull_off::may_let_go(between.walker.setup(), between.to);
    if let Verdict::Perhaps { way, least } = verdict {
        let left = between.walker.carried()?;
        let jumped = confirm(&mut between, before, state, row, least)?;
        found.jump = jumped.unwrap_or(false).then_some(way);
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
