//! Records each step of a run as it ends: row, fields, pictures, state, report.

use std::borrow::Cow;

use rayon::prelude::*;

use super::RunObserver;
use super::earlier_files::lost;
use super::on_ranks::Ask;
use super::run_directory::{RunDirectory, STATE, solver};
use super::warnings::{unreached_steps, warnings_at_end};
use crate::clock::Clock;
use crate::device::SelectedDevice;
use crate::kernel::Scalars;
use crate::output::{
    CurveWriter, OutputError, RunFolder, SavedState, Seconds, Summary, write_field_rows,
    write_volume,
};
#[cfg(feature = "images")]
use crate::output::{Load, Picture, plot, report::Report, write_picture_rows, write_within};
use crate::scene::{Control, FieldName, Precision, StepChoice};
#[cfg(feature = "images")]
use crate::study::Planned;
use crate::study::{
    Checkpoint, Evaluation, FinishedStep, Observer, Search, Setup, StepRow, WalkEnd, step_warnings,
};
use crate::units::format_si;

/// Least time between two refreshed reports, s.
const REFRESH: f64 = 2.0;
/// A report is refreshed only after so many times what the last one took.
const REFRESH_COST: f64 = 20.0;
/// The end of the warning of a step that has no fields.
const NO_FIELDS: &str = ", so there are no fields to write";

/// Records the steps of one run in its folder.
pub(super) struct RunRecorder<'a> {
    setup: &'a Setup,
    device: &'a SelectedDevice,
    observer: &'a mut dyn RunObserver,
    folder: RunFolder,
    curve: CurveWriter,
    /// Whether pictures and the report are written.
    draws: bool,
    /// The last step's fields, where only those are asked for.
    last: Option<(usize, Evaluation)>,
    rows: Vec<StepRow>,
    /// Warnings of the run, besides those of its scene.
    warnings: Vec<String>,
    /// Jumps and transforms up to the last finished step.
    tallies: Checkpoint,
    /// Whether the last recorded step ends the path.
    is_over: bool,
    /// Steps whose state is on the disk.
    committed: usize,
    /// Whether pictures and fields of a run that ended early are still to be cleared away.
    stale: bool,
    seconds: Seconds,
    clock: Clock,
    output_seconds: f64,
    scene: String,
    solver: serde_json::Value,
    /// When the report was written last, and the seconds that it took.
    refreshed: Option<(Clock, f64)>,
}

impl<'a> RunRecorder<'a> {
    /// A recorder of the steps after those in the directory; `seconds` have passed by phase.
    pub fn new(
        setup: &'a Setup,
        device: &'a SelectedDevice,
        directory: RunDirectory,
        seconds: Seconds,
        draws: bool,
        scene: String,
        observer: &'a mut dyn RunObserver,
    ) -> Self {
        let earlier = directory.earlier;
        let recorder = RunRecorder {
            setup,
            device,
            folder: directory.folder,
            curve: directory.curve,
            draws,
            last: None,
            tallies: tallies(&earlier.checkpoint),
            is_over: false,
            committed: earlier.rows.len(),
            rows: earlier.rows,
            warnings: directory.warnings,
            stale: true,
            seconds,
            clock: Clock::start(),
            output_seconds: 0.0,
            scene,
            solver: solver(&setup.scene),
            refreshed: None,
            observer,
        };
        let kept = recorder.kept();
        recorder.observer.kept(&kept);
        recorder
    }

    fn single(&self) -> bool {
        self.device.precision() == Precision::Single
    }

    /// Seconds of earlier runs and of this one, by phase.
    fn seconds_so_far(&self) -> Seconds {
        let mut seconds = self.seconds.clone();
        let solve = self.clock.seconds() - self.output_seconds;
        seconds.add("solve", solve);
        seconds.add("output", self.output_seconds);
        seconds
    }

    /// The results so far of a path that a failure of the device cut short.
    pub fn end_so_far(&self) -> WalkEnd {
        WalkEnd {
            rows: self.rows.clone(),
            jump_in_steps: self.tallies.jump_in_steps.clone(),
            jump_off_steps: self.tallies.jump_off_steps.clone(),
            pull_off: self.tallies.pull_off,
            hysteresis_energy: None,
            hysteresis_uncertainty: None,
            interrupted: true,
            unreachable: None,
            transforms: self.tallies.transforms,
        }
    }

    /// Tells the observer which steps an early end keeps.
    pub fn report_kept(&mut self) {
        let kept = self.kept();
        self.observer.ended_early(&kept);
    }

    /// The steps that an early end keeps, in words.
    fn kept(&self) -> String {
        let place = self.folder.path().display();
        match (self.folder.expect_present(), self.committed) {
            (Err(_), _) => format!("note: {place} is gone, and the steps in it"),
            (Ok(()), 0) => {
                format!("note: no step was finished; resuming starts at step 1 in {place}")
            }
            (Ok(()), 1) => format!("note: step 1 is kept in {place}; resuming continues after it"),
            (Ok(()), steps) => {
                format!(
                    "note: steps 1 to {steps} are kept in {place}; resuming continues after them"
                )
            }
        }
    }

    fn warn(&mut self, text: String) {
        self.observer.warning(&text);
        self.warnings.push(text);
    }

    fn warn_no_fields(&mut self, row: &StepRow) {
        let why = match row.converged {
            true => "is separated: the load has no equilibrium",
            // An unreachable value ends the run, which says why.
            false => "has no solution",
        };
        self.warn(format!("step {} {why}{NO_FIELDS}", row.step));
    }

    /// Warns of the fields before a last step without any, if a run that was killed has solved and not written them.
    fn warn_lost(&mut self) {
        if self.setup.scene.output.steps == StepChoice::Last
            && self.rows.last().is_some_and(|row| row.approach.is_none())
            && let Some(text) = lost(&self.folder, self.setup, &self.rows, self.draws)
            && !self.warnings.contains(&text)
        {
            self.warn(text);
        }
    }

    /// Warnings of the scene and of the run.
    fn all_warnings(&self) -> Vec<String> {
        [self.setup.warnings.as_slice(), &self.warnings].concat()
    }

    fn keep_step(&mut self, step: FinishedStep) -> Result<(), OutputError> {
        // A folder that was removed is not created again with half of a run in it.
        self.folder.expect_present()?;
        let number = step.row.step;
        let output = &self.setup.scene.output;
        if std::mem::take(&mut self.stale) {
            let only_last = output.steps == StepChoice::Last;
            // A last step without fields leaves those of the step before it, which the run that is resumed has written.
            let has_none = step.is_last && step.evaluation.is_none();
            self.folder.remove_steps(|other| {
                let stays = has_none && other + 1 == number;
                other >= number || only_last && !stays
            })?;
        }
        for text in step_warnings(self.setup, &step, &self.warnings) {
            self.warn(text);
        }
        let is_end = step.is_last;
        self.is_over = is_end;
        let asked = !(output.images.is_empty() && output.fields.is_empty());
        match (&output.steps, step.evaluation) {
            (StepChoice::Last, None) if is_end && asked => self.warn_no_fields(step.row),
            (StepChoice::Last, Some(evaluation)) if is_end => {
                self.last = None;
                self.write_fields(number, &evaluation)?;
            }
            (StepChoice::Last, evaluation) => {
                // In case the path ends early.
                let kept = evaluation.filter(|_| asked);
                self.last = kept.map(|evaluation| (number, evaluation));
            }
            // Said of the first of them: a whole path may follow.
            (StepChoice::All, None)
                if asked && !self.warnings.iter().any(|text| text.ends_with(NO_FIELDS)) =>
            {
                self.warn_no_fields(step.row);
            }
            (StepChoice::All, Some(evaluation)) => self.write_fields(number, &evaluation)?,
            (StepChoice::List(list), Some(evaluation)) if list.contains(&number) => {
                self.write_fields(number, &evaluation)?;
            }
            (StepChoice::List(list), None) if list.contains(&number) => {
                self.warn_no_fields(step.row)
            }
            _ => {}
        }
        self.restore_curve(false)?;
        self.curve.append(step.row)?;
        self.rows.push(step.row.clone());
        self.observer.step(step.row);
        Ok(())
    }

    /// Writes the curve again if another program changed it.
    fn restore_curve(&mut self, whole: bool) -> Result<(), OutputError> {
        if let Some(text) = self.curve.restore(whole)? {
            self.warn(text);
        }
        Ok(())
    }

    fn commit(&mut self, step: usize, state: &Checkpoint) -> Result<(), OutputError> {
        self.folder.expect_present()?;
        let saved = SavedState {
            scene: self.scene.clone(),
            solver: self.solver.clone(),
            machine: self.device.words(),
            finished: step,
            curve: self.curve.checksum(),
            warnings: self.warnings.clone(),
            single: self.single() && !self.setup.scene.solid.remembers(),
            checkpoint: Cow::Borrowed(state),
        };
        let path = self.folder.state_path(STATE);
        let share = &self.setup.problem.share;
        match share.ranks() {
            None => saved.write(&path)?,
            Some(ranks) => saved.write_shared(&path, share, &|| {
                Ask::State.send(ranks);
            })?,
        }
        self.committed = step;
        let kept = self.kept();
        self.observer.kept(&kept);
        self.tallies = tallies(state);
        let due = self
            .refreshed
            .is_none_or(|(when, cost)| when.seconds() > REFRESH.max(REFRESH_COST * cost));
        if due && !self.is_over {
            self.refresh(None)?;
        }
        Ok(())
    }

    /// Writes the report again, and with the summary of an ended run the picture of the curve.
    #[cfg(feature = "images")]
    fn refresh(&mut self, summary: Option<&Summary>) -> Result<(), OutputError> {
        if !self.draws {
            return Ok(());
        }
        let clock = Clock::start();
        if summary.is_some() {
            let figure = plot::run_figure(&self.setup.scene, &self.rows);
            let path = self.folder.curve_picture_path();
            let bytes = figure.png().map_err(OutputError::write("write", &path))?;
            write_within(&path, &bytes)?;
            // Two panels side by side as wide as a page.
            let figure = plot::Figure {
                style: plot::SMALL,
                ..figure
            };
            let path = self.folder.curve_vector_path();
            write_within(&path, figure.svg_file().as_bytes())?;
        }
        let text = Report {
            setup: self.setup,
            machine: self.device.words(),
            rows: &self.rows,
            tallies: &self.tallies,
            warnings: &self.all_warnings(),
            pictures: &self.folder.pictures(),
            summary,
        }
        .html();
        write_within(&self.folder.report_path(), text.as_bytes())?;
        self.refreshed = Some((Clock::start(), clock.seconds()));
        Ok(())
    }

    /// There is nothing to draw with.
    #[cfg(not(feature = "images"))]
    fn refresh(&mut self, _: Option<&Summary>) -> Result<(), OutputError> {
        debug_assert!(!self.draws);
        Ok(())
    }

    /// Writes the files of the end of a run, finished or not.
    pub fn finish(
        &mut self,
        end: &WalkEnd,
        summarise: impl FnOnce(Seconds, Vec<String>) -> Summary,
    ) -> Result<Summary, OutputError> {
        let clock = Clock::start();
        self.folder.expect_present()?;
        self.restore_curve(true)?;
        match self.last.take() {
            Some((step, evaluation)) => self.write_fields(step, &evaluation)?,
            None => self.warn_lost(),
        }
        self.output_seconds += clock.seconds();
        let others = unreached_steps(self.setup, &end.rows);
        for text in warnings_at_end(self.setup, self.device, end)
            .into_iter()
            .chain(others)
        {
            self.warn(text);
        }
        self.tallies = Checkpoint {
            jump_in_steps: end.jump_in_steps.clone(),
            jump_off_steps: end.jump_off_steps.clone(),
            pull_off: end.pull_off,
            transforms: end.transforms,
            ..Checkpoint::default()
        };
        let summary = summarise(self.seconds_so_far(), self.all_warnings());
        summary.write(&self.folder.summary_path())?;
        self.refresh(Some(&summary))?;
        Ok(summary)
    }

    fn write_fields(&mut self, step: usize, evaluation: &Evaluation) -> Result<(), OutputError> {
        let (setup, folder, single) = (self.setup, &self.folder, self.single());
        let fields = &setup.scene.output.fields;
        let grid = &setup.surface.grid;
        let array = |field: FieldName| {
            let mut rows = |take: &mut dyn FnMut(&[f64])| rows_of(setup, evaluation, field, take);
            write_field_rows(&folder.field_path(step, field), grid, &mut rows, single)
        };
        let volume = || {
            let mut rows = |field, take: &mut dyn FnMut(&[f64])| {
                rows_of(setup, evaluation, field, take);
            };
            write_volume(&folder.volume_path(step), grid, fields, &mut rows, single)
        };
        if fields.is_empty() {
            // Nor is there a volume.
        } else if setup.problem.share.is_whole() {
            // Files are written side by side; but of the fields that are made for them, one is held at a time.
            let (ready, made): (Vec<FieldName>, Vec<FieldName>) =
                fields.iter().partition(|field| evaluation.holds(**field));
            let arrays = || ready.par_iter().try_for_each(|field| array(*field));
            let (arrays, volume) = rayon::join(arrays, volume);
            arrays.and(volume)?;
            made.into_iter().try_for_each(array)?;
        } else {
            // Ranks send one field after another.
            fields.iter().copied().try_for_each(array)?;
            volume()?;
        }
        self.write_pictures(step, evaluation)
    }

    #[cfg(feature = "images")]
    fn write_pictures(&mut self, step: usize, evaluation: &Evaluation) -> Result<(), OutputError> {
        if !self.draws {
            return Ok(());
        }
        let setup = self.setup;
        let loading = &setup.scene.loading;
        let value = Planned::of_step(setup, &self.rows, step);
        for &field in &setup.scene.output.images {
            let mut rows = |take: &mut dyn FnMut(&[f64])| rows_of(setup, evaluation, field, take);
            let picture = Picture {
                title: setup.scene.title.as_deref(),
                field,
                step: Some(step),
                load: value.map(|value| Load::on_path(loading, value)),
                grid: setup.surface.grid,
                values: &[],
            };
            let path = self.folder.image_path(step, field);
            match write_picture_rows(&path, &picture, &mut rows) {
                // A field that cannot be drawn is no reason to lose the rest.
                Err(error @ OutputError::NotFinite { .. }) => self.warn(error.to_string()),
                other => other?,
            }
        }
        Ok(())
    }

    /// There is nothing to draw with.
    #[cfg(not(feature = "images"))]
    fn write_pictures(&mut self, _: usize, _: &Evaluation) -> Result<(), OutputError> {
        debug_assert!(!self.draws);
        Ok(())
    }
}

/// Hands out all rows of a field: those of the other ranks as they send them.
fn rows_of(setup: &Setup, evaluation: &Evaluation, field: FieldName, take: &mut dyn FnMut(&[f64])) {
    let share = &setup.problem.share;
    if let Some(ranks) = share.ranks() {
        Ask::Field(field).send(ranks);
    }
    let values = evaluation.field(field, &setup.surface.heights);
    // Rows that a rank which has ended does not send are missed by who takes them.
    let _ = share.to_first(&values, share.surface()[0], take);
}

/// A checkpoint without its fields.
fn tallies(state: &Checkpoint) -> Checkpoint {
    Checkpoint {
        fields: Vec::new(),
        evaluated_under: state.evaluated_under,
        points: None,
        jump_in_steps: state.jump_in_steps.clone(),
        jump_off_steps: state.jump_off_steps.clone(),
        pull_off: state.pull_off,
        transforms: state.transforms,
    }
}

impl Observer for RunRecorder<'_> {
    type Error = OutputError;

    fn step(&mut self, step: FinishedStep) -> Result<(), OutputError> {
        let clock = Clock::start();
        let kept = self.keep_step(step);
        self.output_seconds += clock.seconds();
        kept
    }

    fn iteration(&mut self, step: usize, scalars: &Scalars) -> bool {
        self.observer
            .iteration(step, scalars.iterations as usize, scalars.residual)
    }

    fn search(&mut self, step: usize, search: Search) {
        let unit = match self.setup.scene.loading.control {
            Control::Pressure => "Pa",
            _ => "N",
        };
        let tension = |load: f64| format_si(-load, unit);
        let words = match search {
            Search::PullOff { held, parted } => {
                format!("pull-off between {} and {}", tension(held), tension(parted))
            }
            Search::Jump => "looks for a jump".to_owned(),
        };
        self.observer.search(step, &words);
    }

    fn wants_checkpoint(&self) -> bool {
        true
    }

    fn checkpoint(&mut self, step: usize, state: &Checkpoint) -> Result<(), OutputError> {
        let clock = Clock::start();
        let kept = self.commit(step, state);
        self.output_seconds += clock.seconds();
        kept
    }
}
