//! A loading path, step after step, each from the state of the one before.

use std::borrow::Cow;
use std::ops::Range;
use std::time::Instant;

use super::conductance;
use super::control::Controller;
use super::dmt;
use super::flow::{Flow, load_on};
use super::hand_over::{Earlier, GAP, HandOver, HandedField};
use super::jumps::{Jump, Jumps};
use super::observer::{FinishedStep, Observer, Unreachable, WalkEnd, WalkError};
use super::rate::RatedStep;
use super::relaxation::{History, effective_modulus, stretches};
use super::row::{State, StepRow};
use super::setup::Setup;
use super::step::{SolvedStep, finish, separated, solve, unreachable};
use super::wear;
use crate::backend::BackendError;
use crate::kernel::Scalars;
use crate::law::Law;
use crate::scene::{Boundary, Control};
use crate::solver::{ContactSolver, Hold, Load, MakeBackend, Start};

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
    let Earlier { rows, hand_over } = earlier;
    let mut jumps = Jumps::new(setup);
    if let Some(row) = rows.last() {
        jumps.go_on(row, hand_over.points.clone());
    }
    let mut gap = hand_over.field(GAP).map(<[f64]>::to_vec);
    let mut history = History::of(setup, &hand_over);
    let mut flow = Flow::of(setup, &hand_over);
    let mut end = WalkEnd {
        jump_in_steps: hand_over.jump_in_steps,
        jump_off_steps: hand_over.jump_off_steps,
        transforms: hand_over.transforms,
        ..WalkEnd::default()
    };
    let done = rows.len();
    end.rows = rows;
    for stretch in stretches(&setup.scene, done) {
        let walking = Stretch {
            setup,
            make_backend,
            steps: stretch,
        };
        let path = Path {
            gap: &mut gap,
            history: &mut history,
            flow: &mut flow,
        };
        let goes_on = walking.walk(observer, &mut end, &mut jumps, path)?;
        if !goes_on {
            break;
        }
    }
    end.hysteresis_energy = jumps.hysteresis(&end.rows);
    Ok(end)
}

/// What a path carries from step to step.
struct Path<'a> {
    /// `None` where the surfaces are apart.
    gap: &'a mut Option<Vec<f64>>,
    /// `None` for a solid that does not relax.
    history: &'a mut Option<History>,
    /// `None` for a solid that cannot flow.
    flow: &'a mut Option<Flow>,
}

/// Steps of a path that meet one modulus, so that one solver takes them.
struct Stretch<'s> {
    setup: &'s Setup,
    make_backend: MakeBackend<'s>,
    steps: Range<usize>,
}

impl Stretch<'_> {
    /// Walks the steps from what the path carries, which is left as the last of them has it. Returns
    /// whether the path goes on.
    fn walk<O: Observer>(
        &self,
        observer: &mut O,
        end: &mut WalkEnd,
        jumps: &mut Jumps,
        Path { gap, history, flow }: Path,
    ) -> Result<bool, WalkError<O::Error>> {
        let setup = self.setup;
        let duration = self.duration(self.steps.start);
        let problem = match history {
            Some(_) => Cow::Owned(setup.problem.stiffened(
                effective_modulus(&setup.scene.solid, duration),
                setup.solved_law(),
            )),
            None => Cow::Borrowed(&setup.problem),
        };
        let mut backend = (self.make_backend)();
        let mut solver = ContactSolver::new(&mut *backend, &problem);
        let mut state = PathState {
            setup,
            controller: Controller::new(setup, &problem),
            loaded: gap.is_some(),
            interrupted: false,
        };
        if let Some(gap) = gap {
            solver.set_gap(gap);
        }
        if let Some(flow) = flow {
            flow.lower(&mut solver);
        }
        let before = end.transforms;
        let mut goes_on = true;
        for index in self.steps.clone() {
            let clock = Instant::now();
            let step = index + 1;
            let value = setup.scene.loading.path[index];
            let offset = history.as_ref().map(|history| {
                let offset = history.offset(&setup.scene.solid, duration);
                solver.set_offset(&offset);
                offset
            });
            let asked = Asked {
                value,
                duration: self.duration(index),
                make_backend: self.make_backend,
            };
            let mut solved = state.step(&mut solver, &asked, &mut |scalars| {
                observer.iteration(step, scalars)
            })?;
            if state.interrupted {
                end.interrupted = true;
                goes_on = false;
                break;
            }
            if let (Some(history), Some(offset)) = (history.as_mut(), offset) {
                state.relax(&mut solver, &mut solved, history, offset, duration)?;
            }
            let conductance = match solved.converged {
                true => conductance::of(setup, &mut solver, solved.evaluation.as_ref())?,
                false => None,
            };
            if setup.scene.conductance.is_some() && conductance.is_none() {
                solved.converged = false;
            }
            if let Some(flow) = flow.as_mut().filter(|_| solved.converged && state.loaded) {
                flow.settle(&mut solver)?;
            }
            let mut row = state.row(step, value, &solved, clock.elapsed().as_secs_f64());
            row.conductance = conductance.filter(|conductance| conductance.is_finite());
            row.time = self.time(index, end.rows.last());
            row.plastic_energy = flow.as_ref().map(Flow::energy);
            let jump = jumps.step(&row, solved.evaluation.as_ref());
            match jump {
                Some(Jump::In) => end.jump_in_steps.push(step),
                Some(Jump::Off) => end.jump_off_steps.push(step),
                None => {}
            }
            let finished = FinishedStep {
                row: &row,
                evaluation: solved.evaluation,
                jump,
            };
            observer.step(finished).map_err(WalkError::Observer)?;
            let converged = row.converged;
            end.rows.push(row);
            end.transforms = before + solver.transforms();
            if !converged {
                end.unreachable = solved.unreachable;
                goes_on = false;
                break;
            }
            if observer.wants_hand_over() {
                let handed = HandOver {
                    fields: state.handed_fields(&mut solver, history.as_ref(), flow.as_ref())?,
                    points: jumps.points().map(<[_]>::to_vec),
                    jump_in_steps: end.jump_in_steps.clone(),
                    jump_off_steps: end.jump_off_steps.clone(),
                    transforms: end.transforms,
                };
                let kept = observer.hand_over(step, &handed);
                kept.map_err(WalkError::Observer)?;
            }
        }
        // What an interrupted step took is counted too.
        end.transforms = before + solver.transforms();
        *gap = match state.loaded {
            true => Some(solver.gap()?),
            false => None,
        };
        Ok(goes_on)
    }

    /// How long a step takes, s; 0 where the path has no durations.
    fn duration(&self, index: usize) -> f64 {
        let durations = self.setup.scene.loading.durations.as_ref();
        // A path that is gone on with at its end has no step there.
        durations
            .and_then(|durations| durations.get(index).copied())
            .unwrap_or(0.0)
    }

    /// Time at the end of a step, s, where the path has durations.
    fn time(&self, index: usize, before: Option<&StepRow>) -> Option<f64> {
        self.setup.scene.loading.durations.as_ref()?;
        let before = before.and_then(|row| row.time).unwrap_or(0.0);
        Some(before + self.duration(index))
    }
}

/// Share of the mean gap below which a point moved by it is closed: the rounding of that mean in
/// double precision.
const CLOSED: f64 = 1e-13;

/// The mean, taken about the first of the values: that of equal ones is exact on any grid.
fn mean_of(values: &[f64]) -> f64 {
    let first = values[0];
    first + values.iter().map(|value| value - first).sum::<f64>() / values.len() as f64
}

/// What is asked of a step.
struct Asked<'s> {
    value: f64,
    /// How long it takes, s.
    duration: f64,
    make_backend: MakeBackend<'s>,
}

/// What one step hands to the next.
struct PathState<'s> {
    setup: &'s Setup,
    controller: Controller<'s>,
    /// Whether the solver's gap belongs to a solved step.
    loaded: bool,
    interrupted: bool,
}

impl PathState<'_> {
    fn step(
        &mut self,
        solver: &mut ContactSolver,
        asked: &Asked,
        watch: &mut dyn FnMut(&Scalars) -> bool,
    ) -> Result<SolvedStep, BackendError> {
        let setup = self.setup;
        let &Asked {
            value,
            duration,
            make_backend,
        } = asked;
        let mut going = true;
        let mut watch = |scalars: &Scalars| {
            going = watch(scalars);
            going
        };
        let is_load = self.controller.is_load();
        let solved = if setup.dmt && is_load {
            dmt::step(
                setup,
                &self.controller,
                solver,
                value,
                self.loaded,
                make_backend,
                &mut watch,
            )?
        } else if is_load && setup.problem.law == Law::HardWall && value <= 0.0 {
            // A wall alone carries no tension, and at zero load it only touches.
            separated()
        } else if self.controller.is_beyond_closure(value) {
            unreachable(Unreachable::BeyondClosure)
        } else if self.controller.is_beyond_hardness(value) {
            unreachable(Unreachable::BeyondHardness)
        } else {
            let load = load_on(solver, self.controller.load(value));
            let start = self.start(solver, &load, value)?;
            match setup.scene.adhesion.as_ref().and_then(|a| a.rate) {
                Some(rate) => {
                    let rated = RatedStep {
                        setup,
                        controller: &self.controller,
                        rate,
                        duration,
                        loaded: self.loaded,
                        make_backend,
                    };
                    rated.solve(solver, &load, start, &mut watch)?
                }
                None => {
                    let outcome = solve(setup, solver, &load, &start, make_backend, &mut watch)?;
                    finish(setup, &self.controller, solver, &load, &outcome)?
                }
            }
        };
        self.interrupted = !going;
        self.loaded = solved.evaluation.is_some();
        Ok(solved)
    }

    /// The fields from which the next step starts.
    fn handed_fields(
        &self,
        solver: &mut ContactSolver,
        history: Option<&History>,
        flow: Option<&Flow>,
    ) -> Result<Vec<HandedField>, BackendError> {
        let mut fields = history.map_or_else(Vec::new, History::handed_fields);
        fields.extend(flow.and_then(Flow::handed_field));
        if self.loaded {
            fields.push(HandedField {
                name: GAP.to_owned(),
                values: solver.gap()?,
            });
        }
        Ok(fields)
    }

    /// Ends a step of a solid that relaxes: its displacement goes to the history, and what its
    /// springs store to the step.
    fn relax(
        &self,
        solver: &mut ContactSolver,
        solved: &mut SolvedStep,
        history: &mut History,
        offset: Vec<f64>,
        duration: f64,
    ) -> Result<(), BackendError> {
        let solid = &self.setup.scene.solid;
        let Some(evaluation) = &mut solved.evaluation else {
            // Free of pressure it recovers: the displacement is what undoes the past.
            let displacement = offset.into_iter().map(|moved| -moved).collect();
            history.advance(solid, duration, displacement);
            return Ok(());
        };
        let problem = solver.problem();
        let rigid =
            (evaluation.displacement_offset + problem.height_origin) / problem.scales.length;
        let mut displacement = solver.gap()?;
        let heights = problem.padded(&problem.heights, 0.0);
        for (u, h) in displacement.iter_mut().zip(heights) {
            *u += h + rigid;
        }
        for (u, depth) in displacement.iter_mut().zip(solver.flowed()) {
            *u -= depth;
        }
        history.advance(solid, duration, displacement);
        let mut energy = 0.0;
        let modulus = effective_modulus(solid, duration);
        energy += solid.contact_modulus / modulus * solver.energy_of(&history.displacement)?;
        for (branch, spring) in history.branches(solid) {
            energy += branch.modulus / modulus * solver.energy_of(spring)?;
        }
        let unit = problem.scales.length * problem.scales.pressure * problem.grid.pixel_area();
        evaluation.elastic_energy = energy * unit;
        Ok(())
    }

    /// The last gap, moved to a new mean gap where one is held; the undeformed gap at the beginning.
    fn start(
        &self,
        solver: &mut ContactSolver,
        load: &Load,
        value: f64,
    ) -> Result<Start, BackendError> {
        let problem = &self.setup.problem;
        if !self.loaded {
            return Ok(
                if problem.boundary == Boundary::Free || self.controller.is_sprung() {
                    Start::Gap(self.controller.undeformed_gap(value, solver.flowed()))
                } else {
                    Start::Cold
                },
            );
        }
        let Hold::Gap(target) = load.hold else {
            return Ok(Start::Present);
        };
        let mut gap = solver.gap()?;
        let mean = mean_of(&gap);
        let least = gap.iter().copied().fold(f64::INFINITY, f64::min);
        // Open surfaces move rigidly; a wall in contact stays where it is and the rest scales.
        if !problem.law.has_wall() || (least > 0.0 && least + target - mean >= 0.0) {
            let moved = target - mean;
            // Surfaces that meet in this very step meet everywhere they should.
            let rounding = CLOSED.max(8.0 * solver.epsilon()) * mean.abs();
            for g in &mut gap {
                *g += moved;
                if problem.law.has_wall() && *g <= rounding {
                    *g = 0.0;
                }
            }
        } else if target <= 0.0 && problem.hardness.is_some() {
            // Pressed in beyond closure: the solid flows all over.
            gap.fill(target);
        } else if mean > 0.0 {
            gap.iter_mut().for_each(|g| *g *= target / mean);
        } else {
            return Ok(Start::Cold);
        }
        Ok(Start::Gap(gap))
    }

    fn row(&self, step: usize, value: f64, solved: &SolvedStep, seconds: f64) -> StepRow {
        let area = self.setup.surface.grid.area();
        let control = self.setup.scene.loading.control;
        let evaluation = solved.evaluation.as_ref();
        // Where a load was asked the residual was met at that load, so that load it is.
        let (force, mean_pressure) = match (control, evaluation) {
            (_, None) => (0.0, 0.0),
            (Control::Force, Some(_)) => (value, value / area),
            (Control::Pressure, Some(_)) => (value * area, value),
            (_, Some(evaluation)) => (evaluation.force, evaluation.force / area),
        };
        StepRow {
            step,
            time: None,
            approach: evaluation.map(|e| e.position.approach),
            mean_gap: evaluation.map(|e| e.position.mean_gap),
            force,
            mean_pressure,
            contact_area_fraction: evaluation.map_or(0.0, |e| e.contact),
            attractive_area_fraction: evaluation.map_or(0.0, |e| e.attracted),
            elastic_energy: evaluation.map_or(0.0, |e| e.elastic_energy),
            adhesive_energy: evaluation.map_or(0.0, |e| e.adhesive_energy),
            iterations: solved.iterations,
            residual: solved.residual,
            converged: solved.converged,
            seconds,
            contact_area_fraction_corrected: match evaluation {
                Some(evaluation) => evaluation.contact_corrected,
                None => self.setup.problem.law.has_wall().then_some(0.0),
            },
            state: evaluation.map_or(State::Separated, |e| e.state),
            friction_force: self.setup.scene.friction.map(|friction| {
                friction.shear_strength * evaluation.map_or(0.0, |e| e.contact) * area
            }),
            plastic_energy: None,
            conductance: None,
            wear_rate: self
                .setup
                .scene
                .wear
                .map(|wear| wear::rate(wear, evaluation, self.setup.surface.grid.pixel_area())),
        }
    }
}
