//! The study: a reference first, then each setting that the time allows, the cheapest next.

use std::time::{Duration, Instant};

use super::closed::closed;
use super::error::AccuracyError;
use super::forecast::{Forecast, Work};
use super::grids::{ladder, twice};
use super::judge::{Errors, change, judge};
use super::measure::{Measured, Unfinished, compared, measure};
use super::reference::Reference;
use super::report::{LeftOut, Report, Row, duration};
use super::same_surface::SameSurface;
use super::setting::{Setting, Varied, others};
use super::steps::Steps;
use super::workplace::{Listener, Workplace};
use crate::grid::Grid;
use crate::kernel::Scalars;
use crate::law::Law;
use crate::scene::{BackendName, Precision, Scene, Treatment};
use crate::study::Setup;

/// Share of the time that the reference may take.
const REFERENCE_SHARE: f64 = 0.6;
/// Share of what is then left that one more grid may take.
const OWN_SHARE: f64 = 0.3;
/// How much tighter the reference is solved than the scene asks.
const TIGHTER: f64 = 0.1;

/// Judges a scene within a budget of seconds.
pub struct Study<'a> {
    same: SameSurface,
    workplace: &'a dyn Workplace,
    deadline: Instant,
    budget: f64,
    cells: [usize; 2],
    grids: Vec<[usize; 2]>,
    forecast: Forecast,
    /// Whether an adapter has built its shaders.
    warm: bool,
    report: Report,
}

/// How a run ended that gave no row.
enum Missed {
    /// It would not end in time.
    Late(f64),
    /// It ran into the end of the time.
    OutOfTime(f64),
    /// Ctrl-C.
    Interrupted,
    /// It cannot be run here.
    Impossible(String),
}

/// A run that ended.
struct Done {
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
    /// A surface that cannot be built or has one grid only; too few points.
    pub fn new(
        scene: &Scene,
        workplace: &'a dyn Workplace,
        budget: f64,
    ) -> Result<Study<'a>, AccuracyError> {
        let started = Instant::now();
        let mut same = SameSurface::of(scene)?;
        // The full law is what models are judged by, and double precision on the processor what
        // every other arithmetic is.
        if let Some(adhesion) = &mut same.scene.adhesion {
            adhesion.treatment = Treatment::Full;
        }
        if same.scene.arithmetic() == Precision::Single {
            same.scene.solver.tolerance = same
                .scene
                .solver
                .tolerance
                .min(crate::scene::SolverScene::default().tolerance);
        }
        let grids = ladder([same.grid.nx, same.grid.ny])?;
        let cells = grids[0];
        let mut reference = closed(&same.scene, cells);
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
            workplace,
            deadline: started + Duration::from_secs_f64(budget),
            budget,
            cells,
            grids,
            forecast: Forecast::default(),
            warm: false,
            report,
        })
    }

    /// Runs it. Rows go to the listener as they end.
    ///
    /// # Errors
    /// No reference within the budget; what the listener cannot keep.
    pub fn run(mut self, listener: &mut dyn Listener) -> Result<Report, AccuracyError> {
        // What cannot be kept is better known before minutes of work than after.
        listener.row(&self.report)?;
        for warning in std::mem::take(&mut self.same.warnings) {
            listener.note(&warning);
        }
        let mut judged = self.grids.clone();
        if self.report.reference.is_none() {
            judged = self.climb(listener)?;
        }
        if !self.report.interrupted {
            self.own(&mut judged, listener)?;
        }
        if !self.report.interrupted {
            self.vary(&judged, listener)?;
        }
        Ok(self.report)
    }

    /// Seconds that are left.
    fn left(&self) -> f64 {
        (self.deadline - Instant::now().min(self.deadline)).as_secs_f64()
    }

    /// Solves the reference grid by grid while the time allows, and says which grids are coarse
    /// enough to be judged by it.
    fn climb(&mut self, listener: &mut dyn Listener) -> Result<Vec<[usize; 2]>, AccuracyError> {
        let mut grids = self.grids.clone();
        let finest = grids[grids.len() - 1];
        grids.push(twice(finest));
        let allowed = REFERENCE_SHARE * self.budget;
        let finer = Steps::of_reference(&self.report.scene);
        let mut levels: Vec<(Setting, Done)> = Vec::new();
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
                    self.leave_out(&setting, "the reference did not converge".to_owned());
                    break;
                }
                // A grid that cannot hold the surface has nothing to say; a finer one may.
                Err(Missed::Impossible(reason)) if levels.is_empty() => {
                    self.leave_out(&setting, reason.clone());
                    ended = reason;
                }
                Err(missed) => {
                    let interrupted = matches!(missed, Missed::Interrupted);
                    ended = missed.words();
                    if interrupted {
                        self.report.interrupted = true;
                    } else {
                        self.leave_out(&setting, format!("as a reference: {ended}"));
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
            // What was measured is kept, without a judgement.
            for (setting, done) in levels {
                self.keep(setting, done, listener)?;
            }
            return Ok(Vec::new());
        }
        let top = levels[levels.len() - 1].0;
        let walked = match finer {
            Steps::Doubled => "twice the steps".to_owned(),
            _ => format!("{} steps", measured[0].walked),
        };
        self.report.reference = Reference::numeric(&measured, top.points, &walked);
        // What is judged is at most half as fine as the finest.
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
                reason: "every setting: the time gave no reference twice as fine".to_owned(),
            });
        }
        for (setting, done) in levels.into_iter().take(coarser) {
            self.keep(setting, done, listener)?;
        }
        Ok(judged)
    }

    /// Runs the scene's own way on each grid, and drops the grids for which there is no time.
    fn own(
        &mut self,
        judged: &mut Vec<[usize; 2]>,
        listener: &mut dyn Listener,
    ) -> Result<(), AccuracyError> {
        let mut run = Vec::new();
        for points in judged.iter() {
            let setting = Setting::own(&self.report.scene, *points);
            // What is varied on the coarser grids needs its time too; the first grid needs its own.
            let share = if run.is_empty() { 1.0 } else { OWN_SHARE };
            match self.attempt(&setting, share * self.left(), listener) {
                Ok(done) => {
                    run.push(*points);
                    self.keep(setting, done, listener)?;
                }
                Err(Missed::Interrupted) => {
                    self.report.interrupted = true;
                    break;
                }
                Err(missed) => self.leave_out(&setting, missed.words()),
            }
        }
        *judged = run;
        self.judge_in_time(judged, listener)?;
        listener.row(&self.report)
    }

    /// Once the steps that stand beside those of the reference are known on a grid that it has too,
    /// what its own change belongs to its uncertainty. The finest such grid says it; where they are
    /// not the scene's own, they are walked on the coarsest.
    fn judge_in_time(
        &mut self,
        judged: &[[usize; 2]],
        listener: &mut dyn Listener,
    ) -> Result<(), AccuracyError> {
        let beside = Steps::beside_reference(&self.report.scene);
        if let (false, Some(points)) = (beside == Steps::AsGiven, judged.first()) {
            let setting = Setting {
                steps: beside,
                ..Setting::own(&self.report.scene, *points)
            };
            match self.attempt(&setting, self.left(), listener) {
                Ok(done) => self.keep(setting, done, listener)?,
                Err(Missed::Interrupted) => self.report.interrupted = true,
                Err(missed) => self.leave_out(&setting, missed.words()),
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
        let finer = Steps::of_reference(&self.report.scene);
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

    /// Runs everything else on those grids, the cheapest next, while there is time.
    fn vary(
        &mut self,
        judged: &[[usize; 2]],
        listener: &mut dyn Listener,
    ) -> Result<(), AccuracyError> {
        let arithmetics = self.workplace.arithmetics();
        let mut waiting: Vec<Setting> = judged
            .iter()
            .flat_map(|points| others(&self.report.scene, *points, arithmetics))
            .filter(|setting| {
                // The reference has walked some, and what it stands beside.
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
                Err(Missed::Interrupted) => {
                    self.report.interrupted = true;
                    break;
                }
                Err(missed) => self.leave_out(&setting, missed.words()),
            }
        }
        if self.report.interrupted {
            for setting in waiting {
                self.leave_out(&setting, "interrupted".to_owned());
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
        Work::of(setting, &scene, grid, path.loading.path.len())
    }

    /// Runs a setting if it will end within `allowed` seconds.
    fn attempt(
        &mut self,
        setting: &Setting,
        allowed: f64,
        listener: &mut dyn Listener,
    ) -> Result<Done, Missed> {
        let (scene, path) = setting.apply(&self.report.scene);
        let work = self.work(setting);
        let predicted = self.forecast.seconds(&work);
        let is_late = predicted > allowed;
        // What a graphics processor cannot do is said rather than how long it would take.
        if is_late && setting.backend != BackendName::Gpu {
            return Err(Missed::Late(predicted));
        }
        let size = [self.same.grid.lx, self.same.grid.ly];
        let fits = self.workplace.fits(&scene, Grid::new(setting.points, size));
        fits.map_err(Missed::Impossible)?;
        let surface = self.same.on(&scene);
        let surface = surface.map_err(|error| Missed::Impossible(error.to_string()))?;
        let setup = Setup::new(scene, surface);
        let bench = self.workplace.bench(&setup).map_err(Missed::Impossible)?;
        if is_late {
            return Err(Missed::Late(predicted));
        }
        if let Some(remark) = &bench.remark {
            listener.note(remark);
        }
        listener.begins(&setting.words(&self.report.scene), predicted);
        let began = Instant::now();
        let until = (began + Duration::from_secs_f64(allowed)).min(self.deadline);
        let mut interrupted = false;
        let mut watch = |step: usize, scalars: &Scalars| {
            interrupted = !listener.goes_on(step, scalars.iterations as usize, scalars.residual);
            !interrupted && Instant::now() < until
        };
        let mut run = || {
            let own = &self.report.scene;
            measure(&setup, &path, own, self.cells, &*bench.make, &mut watch)
        };
        let mut end = run();
        if setting.backend == BackendName::Gpu && !self.warm && end.is_ok() {
            // The first run builds shaders, which later ones find: it is no measure of any.
            end = run();
        }
        self.warm |= setting.backend == BackendName::Gpu;
        match end {
            Ok(measured) => {
                self.forecast.learn(&work, measured.seconds);
                let adhesive = setup.law.is_adhesive();
                Ok(Done {
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
            Err(Unfinished::Stopped) if interrupted => Err(Missed::Interrupted),
            Err(Unfinished::Stopped) => {
                let took = began.elapsed().as_secs_f64();
                // So much at least: what is like it will not be tried again.
                self.forecast.learn(&work, took.max(predicted));
                Err(Missed::OutOfTime(took))
            }
            Err(Unfinished::Backend(error)) => Err(Missed::Impossible(error.to_string())),
        }
    }

    fn leave_out(&mut self, setting: &Setting, reason: String) {
        let words = setting.words(&self.report.scene);
        self.report.left_out.push(LeftOut { words, reason });
    }

    /// Judges a run and hands its row on.
    fn keep(
        &mut self,
        setting: Setting,
        done: Done,
        listener: &mut dyn Listener,
    ) -> Result<(), AccuracyError> {
        let reference = self.report.reference.as_ref();
        let errors = reference.map_or_else(Errors::default, |found| judge(&done.measured, found));
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

impl Missed {
    fn words(&self) -> String {
        match self {
            Missed::Late(seconds) => format!("would take about {}", duration(*seconds)),
            Missed::OutOfTime(seconds) => format!("not done after {}", duration(*seconds)),
            Missed::Interrupted => "interrupted".to_owned(),
            Missed::Impossible(reason) => reason.clone(),
        }
    }
}
