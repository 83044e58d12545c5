//! Runs the reference first, then each setting that the time allows, the cheapest first.

use super::closed_form::closed_form;
use super::error::AccuracyError;
use super::errors::{Errors, change, relative_errors};
use super::forecast::{Forecast, Work};
use super::grid_independent::GridIndependentSurface;
use super::grids::{halved_grids, twice};
use super::measure::{Measured, Unfinished, compared, measure};
use super::provider::{BackendProvider, Listener};
use super::reference::Reference;
use super::report::{LeftOut, Report, Row, duration};
use super::setting::{Setting, Varied, others, strongest};
use super::steps::Steps;
use crate::clock::Clock;
use crate::grid::Grid;
use crate::kernel::Scalars;
use crate::law::Law;
use crate::scene::{BackendName, Control, Scene, Treatment};
use crate::study::{Setup, resolve_law};

/// Share of the budget for the reference.
const REFERENCE_SHARE: f64 = 0.6;
/// Share of the remaining budget for one more grid.
const OWN_SHARE: f64 = 0.3;
/// Tolerance of the reference over the scene's.
const TIGHTER: f64 = 0.1;

/// An accuracy study of a scene within a budget of seconds.
pub struct Study<'a> {
    same: GridIndependentSurface,
    provider: &'a dyn BackendProvider,
    /// Since the study was prepared.
    clock: Clock,
    budget: f64,
    cells: [usize; 2],
    grids: Vec<[usize; 2]>,
    forecast: Forecast,
    /// Whether an adapter has built its shaders.
    warm: bool,
    report: Report,
}

/// Why a run gave no row.
enum Skipped {
    /// It would take too long.
    Late(f64),
    /// It reached the time limit.
    OutOfTime(f64),
    /// Ctrl-C.
    Interrupted,
    /// It cannot be run on this machine.
    Impossible(String),
}

/// A finished run.
struct FinishedRun {
    measured: Measured,
    range: Option<f64>,
    taper: Option<f64>,
    chi: Option<f64>,
    zone_pixels: Option<f64>,
}

impl<'a> Study<'a> {
    /// Prepares the study of a scene.
    ///
    /// # Errors
    /// A surface that cannot be built or belongs to one grid; too few points.
    pub fn new(
        scene: &Scene,
        provider: &'a dyn BackendProvider,
        budget: f64,
    ) -> Result<Study<'a>, AccuracyError> {
        let clock = Clock::start();
        let mut same = GridIndependentSurface::new(scene)?;
        // The steps of the path itself are compared, and pull-off by a load that nothing carries.
        if std::mem::take(&mut same.scene.loading.until_apart) {
            same.scene
                .loading
                .path
                .extend(unbearable_load(&same.scene, &same.grid));
        }
        // Models are compared with the full law, and other precisions with double precision on the
        // processor.
        if let Some(adhesion) = &mut same.scene.adhesion {
            adhesion.treatment = Treatment::Full;
        }
        if same.scene.is_single() {
            same.scene.solver.tolerance = same
                .scene
                .solver
                .tolerance
                .min(crate::scene::SolverScene::default().tolerance);
        }
        let grids = halved_grids([same.grid.nx, same.grid.ny])?;
        let cells = grids[0];
        let mut reference = closed_form(&same.scene, cells);
        if let Some(reference) = &mut reference {
            for (step, compared) in reference.steps.iter_mut().zip(compared(&same.scene)) {
                *step = step.filter(|_| compared);
            }
        }
        let report = Report {
            scene: same.scene.clone(),
            reference,
            rows: Vec::new(),
            left_out: Vec::new(),
            interrupted: false,
        };
        Ok(Study {
            same,
            provider,
            clock,
            budget,
            cells,
            grids,
            forecast: Forecast::default(),
            warm: false,
            report,
        })
    }

    /// Runs the study. Rows go to the listener as they finish.
    ///
    /// # Errors
    /// No reference within the budget; errors of the listener.
    pub fn run(mut self, listener: &mut dyn Listener) -> Result<Report, AccuracyError> {
        // Find output errors before minutes of work, not after.
        listener.row(&self.report)?;
        for warning in std::mem::take(&mut self.same.warnings) {
            listener.note(&warning);
        }
        let mut judged = self.grids.clone();
        if self.report.reference.is_none() {
            judged = self.solve_reference(listener)?;
        }
        if !self.report.interrupted {
            self.own(&mut judged, listener)?;
        }
        if !self.report.interrupted {
            self.run_variations(&judged, listener)?;
        }
        Ok(self.report)
    }

    /// Remaining seconds.
    fn left(&self) -> f64 {
        (self.budget - self.clock.seconds()).max(0.0)
    }

    /// Solves the reference grid by grid while time allows; returns the grids coarse enough to be
    /// compared with it.
    fn solve_reference(
        &mut self,
        listener: &mut dyn Listener,
    ) -> Result<Vec<[usize; 2]>, AccuracyError> {
        let mut grids = self.grids.clone();
        let finest = grids[grids.len() - 1];
        grids.push(twice(finest));
        let allowed = REFERENCE_SHARE * self.budget;
        let finer = Steps::for_reference(&self.report.scene);
        let mut levels: Vec<(Setting, FinishedRun)> = Vec::new();
        let mut ended = String::new();
        for points in &grids {
            let own = Setting::own(&self.report.scene, *points);
            let setting = Setting {
                tolerance: TIGHTER * own.tolerance,
                steps: finer,
                ..own
            };
            let spent = self.budget - self.left();
            match self.attempt(&setting, (allowed - spent).max(0.0), listener) {
                Ok(done) if done.measured.converged => levels.push((setting, done)),
                Ok(_) => {
                    ended = "a step did not converge".to_owned();
                    self.skip(&setting, "the reference did not converge".to_owned());
                    break;
                }
                // A grid that cannot resolve the surface is skipped; a finer one may do.
                Err(Skipped::Impossible(reason)) if levels.is_empty() => {
                    self.skip(&setting, reason.clone());
                    ended = reason;
                }
                Err(missed) => {
                    let interrupted = matches!(missed, Skipped::Interrupted);
                    ended = missed.words();
                    if interrupted {
                        self.report.interrupted = true;
                    } else {
                        self.skip(&setting, format!("as a reference: {ended}"));
                    }
                    break;
                }
            }
        }
        let measured: Vec<Measured> = levels
            .iter()
            .map(|level| level.1.measured.clone())
            .collect();
        if levels.len() < 2 {
            if !self.report.interrupted {
                return Err(AccuracyError::NoReference { reason: ended });
            }
            // Measured runs are kept, without errors.
            for (setting, done) in levels {
                self.keep(setting, done, listener)?;
            }
            return Ok(Vec::new());
        }
        let top = levels[levels.len() - 1].0;
        let steps_solved = match finer {
            Steps::Doubled => "twice the steps".to_owned(),
            _ => format!("{} steps", measured[0].steps_solved),
        };
        self.report.reference = Reference::numeric(&measured, top.points, &steps_solved);
        // Compared grids are at most half as fine as the finest.
        let coarser = levels.len() - 1;
        let judged: Vec<[usize; 2]> = levels[..coarser]
            .iter()
            .map(|level| level.0.points)
            .collect();
        for points in self
            .grids
            .iter()
            .filter(|points| points[0] >= top.points[0] && points[1] >= top.points[1])
        {
            self.report.left_out.push(LeftOut {
                words: format!("{} x {}", points[0], points[1]),
                reason: "every setting: there was no time for a reference twice as fine".to_owned(),
            });
        }
        for (setting, done) in levels.into_iter().take(coarser) {
            self.keep(setting, done, listener)?;
        }
        Ok(judged)
    }

    /// Runs the scene's own setting on each grid, and drops the grids for which there is no time.
    fn own(
        &mut self,
        judged: &mut Vec<[usize; 2]>,
        listener: &mut dyn Listener,
    ) -> Result<(), AccuracyError> {
        let mut run = Vec::new();
        for points in judged.iter() {
            let setting = Setting::own(&self.report.scene, *points);
            // Leave time for the variations on the coarser grids; the first grid gets all the time
            // it needs.
            let share = if run.is_empty() { 1.0 } else { OWN_SHARE };
            match self.attempt(&setting, share * self.left(), listener) {
                Ok(done) => {
                    run.push(*points);
                    self.keep(setting, done, listener)?;
                }
                Err(Skipped::Interrupted) => {
                    self.report.interrupted = true;
                    break;
                }
                Err(missed) => self.skip(&setting, missed.words()),
            }
        }
        *judged = run;
        self.add_time_uncertainty(judged, listener)?;
        listener.row(&self.report)
    }

    /// Once the comparison steps of the reference are known on a grid that the reference also has,
    /// adds their difference to its uncertainty. Uses the finest such grid; if they are not the
    /// scene's own steps, solves them on the coarsest grid.
    fn add_time_uncertainty(
        &mut self,
        judged: &[[usize; 2]],
        listener: &mut dyn Listener,
    ) -> Result<(), AccuracyError> {
        let beside = Steps::for_time_uncertainty(&self.report.scene);
        if let (false, Some(points)) = (beside == Steps::AsGiven, judged.first()) {
            let setting = Setting {
                steps: beside,
                ..Setting::own(&self.report.scene, *points)
            };
            match self.attempt(&setting, self.left(), listener) {
                Ok(done) => self.keep(setting, done, listener)?,
                Err(Skipped::Interrupted) => self.report.interrupted = true,
                Err(missed) => self.skip(&setting, missed.words()),
            }
        }
        let rows = &self.report.rows;
        let is_plain = |row: &&Row| {
            let own = Setting::own(&self.report.scene, row.setting.points);
            row.setting
                == Setting {
                    steps: beside,
                    ..own
                }
        };
        let finer = Steps::for_reference(&self.report.scene);
        let Some(coarser) = rows.iter().rev().find(is_plain) else {
            return Ok(());
        };
        let finer = rows
            .iter()
            .find(|row| row.setting.points == coarser.setting.points && row.setting.steps == finer);
        if let (Some(reference), Some(finer)) = (&mut self.report.reference, finer)
            && reference.points.is_some()
        {
            reference.add_steps(&coarser.measured, &finer.measured);
        }
        Ok(())
    }

    /// Runs all other settings on those grids, the cheapest first, while time allows.
    fn run_variations(
        &mut self,
        judged: &[[usize; 2]],
        listener: &mut dyn Listener,
    ) -> Result<(), AccuracyError> {
        let arithmetics = self.provider.arithmetics();
        let mut waiting: Vec<Setting> = judged
            .iter()
            .flat_map(|points| others(&self.report.scene, *points, arithmetics))
            .filter(|setting| {
                // Some were run for the reference or its uncertainty.
                setting.steps == Steps::AsGiven
                    || !self.report.rows.iter().any(|row| {
                        row.setting.points == setting.points && row.setting.steps == setting.steps
                    })
            })
            .collect();
        // Each round takes one away.
        while !waiting.is_empty() {
            let cost = |setting: &Setting| self.seconds(setting);
            let next =
                (0..waiting.len()).min_by(|a, b| cost(&waiting[*a]).total_cmp(&cost(&waiting[*b])));
            let Some(next) = next else { break };
            let setting = waiting.swap_remove(next);
            match self.attempt(&setting, self.left(), listener) {
                Ok(done) => self.keep(setting, done, listener)?,
                Err(Skipped::Interrupted) => {
                    self.report.interrupted = true;
                    break;
                }
                Err(missed) => self.skip(&setting, missed.words()),
            }
        }
        if self.report.interrupted {
            for setting in waiting {
                self.skip(&setting, "interrupted".to_owned());
            }
        }
        Ok(())
    }

    fn seconds(&self, setting: &Setting) -> f64 {
        self.forecast.seconds(&self.work(setting))
    }

    fn work(&self, setting: &Setting) -> Work {
        let (scene, path) = setting.apply(&self.report.scene);
        let size = [self.same.grid.lx, self.same.grid.ly];
        let grid = Grid::new(setting.points, size);
        Work::new(setting, &scene, grid, path.loading.path.len())
    }

    /// Runs a setting if it is predicted to end within `allowed` seconds.
    fn attempt(
        &mut self,
        setting: &Setting,
        allowed: f64,
        listener: &mut dyn Listener,
    ) -> Result<FinishedRun, Skipped> {
        let (scene, path) = setting.apply(&self.report.scene);
        let work = self.work(setting);
        let predicted = self.forecast.seconds(&work);
        let is_late = predicted > allowed;
        // An unsupported setting is reported as such, not by its duration.
        if is_late && setting.backend != BackendName::Gpu {
            return Err(Skipped::Late(predicted));
        }
        let size = [self.same.grid.lx, self.same.grid.ly];
        let fits = self.provider.fits(&scene, Grid::new(setting.points, size));
        fits.map_err(Skipped::Impossible)?;
        let surface = self.same.on(&scene);
        let surface = surface.map_err(|error| Skipped::Impossible(error.to_string()))?;
        let setup = Setup::new(scene, surface);
        let bench = self.provider.provide(&setup).map_err(Skipped::Impossible)?;
        if is_late {
            return Err(Skipped::Late(predicted));
        }
        if let Some(remark) = &bench.remark {
            listener.note(remark);
        }
        listener.begins(&setting.words(&self.report.scene), predicted);
        let (began, clock, budget) = (Clock::start(), self.clock, self.budget);
        let mut interrupted = false;
        let mut watch = |step: usize, scalars: &Scalars| {
            interrupted = !listener.iteration(step, scalars.iterations as usize, scalars.residual);
            !interrupted && began.seconds() < allowed && clock.seconds() < budget
        };
        let mut run = || {
            let own = &self.report.scene;
            measure(&setup, &path, own, self.cells, &*bench.make, &mut watch)
        };
        let mut end = run();
        if setting.backend == BackendName::Gpu && !self.warm && end.is_ok() {
            // The first run builds shaders, which later runs reuse, so its time is not
            // representative.
            end = run();
        }
        self.warm |= setting.backend == BackendName::Gpu;
        match end {
            Ok(measured) => {
                self.forecast.learn(&work, measured.seconds);
                let adhesive = setup.law.is_adhesive();
                Ok(FinishedRun {
                    measured,
                    range: adhesive.then(|| setup.law.range()),
                    taper: match setup.law {
                        Law::MaugisDugdale(law) => Some(law.taper),
                        _ => None,
                    },
                    chi: setup.regime.map(|regime| regime.chi),
                    zone_pixels: setup.regime.map(|regime| regime.zone_pixels),
                })
            }
            Err(Unfinished::Stopped) if interrupted => Err(Skipped::Interrupted),
            Err(Unfinished::Stopped) => {
                let took = began.seconds();
                // It takes at least this long; similar settings will not be tried again.
                self.forecast.learn(&work, took.max(predicted));
                Err(Skipped::OutOfTime(took))
            }
            Err(Unfinished::Backend(error)) => Err(Skipped::Impossible(error.to_string())),
        }
    }

    fn skip(&mut self, setting: &Setting, reason: String) {
        let words = setting.words(&self.report.scene);
        self.report.left_out.push(LeftOut { words, reason });
    }

    /// Computes the errors of a run and passes its row on.
    fn keep(
        &mut self,
        setting: Setting,
        done: FinishedRun,
        listener: &mut dyn Listener,
    ) -> Result<(), AccuracyError> {
        let reference = self.report.reference.as_ref();
        let errors = reference.map_or_else(Errors::default, |found| {
            relative_errors(&done.measured, found)
        });
        let varied = setting.varied(&self.report.scene);
        let base = self
            .report
            .rows
            .iter()
            .find(|row| row.varied == Varied::Nothing && row.setting.points == setting.points);
        let change = match (varied, base) {
            (Varied::Nothing, _) | (_, None) => None,
            (_, Some(base)) => change(&done.measured, &base.measured).largest(),
        };
        let by_time = match varied {
            Varied::Nothing | Varied::Steps | Varied::TimeTolerance => self.report.rows.iter(),
            _ => [].iter(),
        };
        let in_time = by_time
            .filter(|row| row.setting.steps == Steps::Finest)
            .find(|row| row.setting.points == setting.points)
            .map(|finest| self::change(&done.measured, &finest.measured));
        self.report.rows.push(Row {
            varied,
            in_time,
            setting,
            measured: done.measured,
            errors,
            change,
            range: done.range,
            taper: done.taper,
            chi: done.chi,
            zone_pixels: done.zone_pixels,
        });
        listener.row(&self.report)
    }
}

/// A tension beyond the law's own on every grid of a study, in the unit of the control; `None` where a position is
/// prescribed, a step takes time, or nothing attracts.
fn unbearable_load(scene: &Scene, grid: &Grid) -> Option<f64> {
    let adhesion = scene.adhesion.as_ref()?;
    let area = match scene.loading.control {
        Control::Pressure => 1.0,
        Control::Force => grid.area(),
        Control::Approach | Control::MeanGap => return None,
    };
    let strongest = strongest(adhesion);
    // The finest grid, that of the reference, has the greatest tension if the range is "auto".
    let pixel = 0.5 * grid.longer_pixel();
    let law = resolve_law(adhesion, pixel, scene.solid.contact_modulus, strongest);
    let tension = strongest * law.peak_tension();
    scene.loading.durations.is_none().then(|| -tension * area)
}

impl Skipped {
    fn words(&self) -> String {
        match self {
            Skipped::Late(seconds) => format!("would take about {}", duration(*seconds)),
            Skipped::OutOfTime(seconds) => format!("not done after {}", duration(*seconds)),
            Skipped::Interrupted => "interrupted".to_owned(),
            Skipped::Impossible(reason) => reason.clone(),
        }
    }
}
