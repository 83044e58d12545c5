//! `tabor run`: the main job.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use super::machine::Machine;
use super::{Failure, RunArguments, read_scene, room};
use crate::backend::cpu::with_threads;
use crate::effect::Effect;
use crate::kernel::Scalars;
use crate::output::{
    CurveWriter, Effects, Load, OutputError, Picture, Progress, RunFolder, Seconds, Summary,
    peak_memory_bytes, write_field, write_field_single, write_picture,
};
use crate::scene::{FieldName, Precision, Scene, StepChoice};
use crate::study::{Evaluation, FinishedStep, Observer, Setup, StepRow, WalkEnd, WalkError, walk};
use crate::surface::Surface;
use crate::units::format_si;

/// Solves a scene and writes its folder.
pub(super) fn run(arguments: &RunArguments) -> Result<(), Failure> {
    if arguments.resume {
        return Err(Failure::Usage(
            "--resume is not in this version; run again without it".to_owned(),
        ));
    }
    let mut seconds = Seconds::default();
    let clock = Instant::now();
    let scene = read_scene(&arguments.scene, &arguments.overrides())?;
    seconds.add("scene", clock.elapsed().as_secs_f64());
    let clock = Instant::now();
    room::refuse_scene(&scene)?;
    let surface = Surface::build(&scene).map_err(|error| Failure::Surface {
        path: arguments.scene.clone(),
        error,
    })?;
    // Of a grid that a height file carries.
    room::refuse(&scene, surface.grid)?;
    let setup = Setup::new(scene, surface);
    seconds.add("surface", clock.elapsed().as_secs_f64());
    let clock = Instant::now();
    let machine = Machine::of(&setup)?;
    seconds.add("device", clock.elapsed().as_secs_f64());
    let interrupted = watch_for_interrupts();
    let path = arguments
        .out
        .clone()
        .unwrap_or_else(|| default_folder(&arguments.scene));
    let folder = RunFolder::open(&path, &fingerprint(&setup.scene))?;
    let curve = CurveWriter::create(&folder.curve_path())?;
    if let Some(remark) = &machine.remark {
        eprintln!("note: {remark}");
    }
    for warning in &setup.warnings {
        eprintln!("warning: {warning}");
    }
    let progress = Progress::new(setup.scene.loading.path.len(), arguments.quiet);
    let mut keeper = Keeper {
        setup: &setup,
        single: machine.precision() == Precision::Single,
        folder: &folder,
        curve,
        progress,
        interrupted,
        last: None,
        warnings: setup.warnings.clone(),
        output_seconds: 0.0,
    };
    let clock = Instant::now();
    let make_backend = || machine.backend();
    let threads = arguments.threads.map(usize::from);
    let walked = with_threads(threads, || walk(&setup, &make_backend, &mut keeper))?;
    let solved = clock.elapsed().as_secs_f64();
    let end = match walked {
        Ok(end) => end,
        Err(WalkError::Backend(error)) => return Err(error.into()),
        Err(WalkError::Observer(error)) => return Err(error.into()),
    };
    keeper.finish()?;
    seconds.add("solve", solved - keeper.output_seconds);
    seconds.add("output", keeper.output_seconds);
    let warnings = std::mem::take(&mut keeper.warnings);
    summarise(&setup, &machine, &end, seconds, warnings).write(&folder.summary_path())?;
    drop(keeper);
    if !arguments.quiet {
        print_table(&end.rows);
    }
    judge(&setup, &end)
}

/// The scene's name without `.toml`, in the current folder.
fn default_folder(scene: &Path) -> PathBuf {
    PathBuf::from(scene.file_stem().unwrap_or(scene.as_os_str()))
}

/// What makes a scene the same scene: all but how it is solved.
fn fingerprint(scene: &Scene) -> String {
    let mut resolved = scene.resolved_json();
    if let Some(table) = resolved.as_object_mut() {
        table.remove("solver");
    }
    resolved.to_string()
}

/// Ctrl-C asks the run to end after the current iteration.
fn watch_for_interrupts() -> Arc<AtomicBool> {
    let flag = Arc::new(AtomicBool::new(false));
    let raised = Arc::clone(&flag);
    // A second handler in one process is refused; then the first one's default stands.
    if let Err(error) = ctrlc::set_handler(move || raised.store(true, Ordering::Relaxed)) {
        eprintln!("warning: Ctrl-C will end the run without a summary: {error}");
    }
    flag
}

/// Keeps each step as it ends.
struct Keeper<'a> {
    setup: &'a Setup,
    /// Whether fields are known in single precision only.
    single: bool,
    folder: &'a RunFolder,
    curve: CurveWriter,
    progress: Progress,
    interrupted: Arc<AtomicBool>,
    /// The last step's fields, where only those are asked for.
    last: Option<(usize, Evaluation)>,
    warnings: Vec<String>,
    output_seconds: f64,
}

impl Observer for Keeper<'_> {
    type Error = OutputError;

    fn step(&mut self, step: FinishedStep) -> Result<(), OutputError> {
        let clock = Instant::now();
        self.curve.append(step.row)?;
        let number = step.row.step;
        self.progress.finished_steps(number);
        let output = &self.setup.scene.output;
        match (&output.steps, step.evaluation) {
            (StepChoice::Last, evaluation) => {
                self.last = evaluation.map(|evaluation| (number, evaluation));
            }
            (StepChoice::All, Some(evaluation)) => self.write_fields(number, &evaluation)?,
            (StepChoice::List(list), Some(evaluation)) if list.contains(&number) => {
                self.write_fields(number, &evaluation)?;
            }
            (StepChoice::List(list), None) if list.contains(&number) => self.no_fields(number),
            _ => {}
        }
        self.output_seconds += clock.elapsed().as_secs_f64();
        Ok(())
    }

    fn iteration(&mut self, _step: usize, scalars: &Scalars) -> bool {
        self.progress
            .iteration(scalars.iterations as usize, scalars.residual);
        !self.interrupted.load(Ordering::Relaxed)
    }
}

impl Keeper<'_> {
    fn warn(&mut self, text: String) {
        self.progress.say(&format!("warning: {text}"));
        self.warnings.push(text);
    }

    fn no_fields(&mut self, step: usize) {
        self.warn(format!(
            "step {step} is separated: the load has no equilibrium, so there are no fields to write"
        ));
    }

    fn finish(&mut self) -> Result<(), OutputError> {
        let clock = Instant::now();
        let output = &self.setup.scene.output;
        let asked = !(output.images.is_empty() && output.fields.is_empty());
        if output.steps == StepChoice::Last && asked {
            match self.last.take() {
                Some((step, evaluation)) => self.write_fields(step, &evaluation)?,
                None => {
                    let steps = self.setup.scene.loading.path.len();
                    self.no_fields(steps);
                }
            }
        }
        self.output_seconds += clock.elapsed().as_secs_f64();
        Ok(())
    }

    fn write_fields(&mut self, step: usize, evaluation: &Evaluation) -> Result<(), OutputError> {
        let setup = self.setup;
        let grid = setup.surface.grid;
        let values = |name: FieldName| evaluation.field(name, &setup.surface.heights);
        for &field in &setup.scene.output.fields {
            let path = self.folder.field_path(step, field);
            match self.single {
                true => write_field_single(&path, &grid, &values(field))?,
                false => write_field(&path, &grid, &values(field))?,
            }
        }
        let loading = &setup.scene.loading;
        for &field in &setup.scene.output.images {
            let values = values(field);
            let picture = Picture {
                title: setup.scene.title.as_deref(),
                field,
                step: Some(step),
                load: loading
                    .path
                    .get(step - 1)
                    .map(|&value| Load::new(loading.control, value)),
                grid,
                values: &values,
            };
            match write_picture(&self.folder.image_path(step, field), &picture) {
                // A field that cannot be drawn is no reason to lose the rest.
                Err(error @ OutputError::NotFinite { .. }) => self.warn(error.to_string()),
                other => other?,
            }
        }
        Ok(())
    }
}

fn summarise(
    setup: &Setup,
    machine: &Machine,
    end: &WalkEnd,
    seconds: Seconds,
    warnings: Vec<String>,
) -> Summary {
    let names = |on: bool| -> Vec<String> {
        Effect::ALL
            .iter()
            .filter(|effect| effect.is_on(&setup.scene) == on)
            .map(|effect| effect.name().to_owned())
            .collect()
    };
    let pull_off = end
        .rows
        .iter()
        .filter(|row| row.force < 0.0)
        .min_by(|a, b| a.force.total_cmp(&b.force));
    Summary {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        scene: setup.scene.resolved_json(),
        effects: Effects {
            on: names(true),
            off: names(false),
        },
        backend: machine.name().to_owned(),
        adapter: machine.adapter(),
        precision: machine.precision().name().to_owned(),
        seconds,
        transforms: end.transforms + setup.transforms,
        peak_memory_bytes: peak_memory_bytes(),
        largest_contact_area_fraction: end
            .rows
            .iter()
            .map(|row| row.contact_area_fraction)
            .reduce(f64::max),
        pull_off_force: pull_off.map(|row| -row.force),
        pull_off_step: pull_off.map(|row| row.step),
        jump_in_steps: end.jump_in_steps.clone(),
        jump_off_steps: end.jump_off_steps.clone(),
        hysteresis_energy: end.hysteresis_energy,
        warnings,
    }
}

/// A short table of the steps on standard error.
fn print_table(rows: &[StepRow]) {
    /// Steps shown at either end of a long path.
    const SHOWN: usize = 12;
    eprintln!(
        "{:>5} {:>12} {:>12} {:>12} {:>9} {:>6} {:>9}  state",
        "step", "approach", "force", "pressure", "contact", "iter", "residual"
    );
    for (index, row) in rows.iter().enumerate() {
        if index >= SHOWN && index + SHOWN < rows.len() {
            if index == SHOWN {
                eprintln!("{:>5}", "...");
            }
            continue;
        }
        eprintln!(
            "{:>5} {:>12} {:>12} {:>12} {:>8.3}% {:>6} {:>9.1e}  {}{}",
            row.step,
            row.approach
                .map_or_else(|| "-".to_owned(), |value| format_si(value, "m")),
            format_si(row.force, "N"),
            format_si(row.mean_pressure, "Pa"),
            100.0 * row.contact_area_fraction,
            row.iterations,
            row.residual,
            row.state.name(),
            if row.converged { "" } else { ", not converged" }
        );
    }
}

/// The end of a run as its exit status.
fn judge(setup: &Setup, end: &WalkEnd) -> Result<(), Failure> {
    if end.interrupted {
        return Err(Failure::Interrupted);
    }
    match end.rows.last() {
        Some(row) if !row.converged => Err(Failure::NotConverged {
            step: row.step,
            residual: row.residual,
            iterations: row.iterations,
            tolerance: setup.scene.solver.tolerance,
            remedy: if row.residual.is_finite() {
                "allow more max_iterations, or take smaller steps"
            } else {
                "the surfaces cannot be closed further than full contact: end the path earlier"
            },
        }),
        _ => Ok(()),
    }
}
