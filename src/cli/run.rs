//! `tabor run`: the main job.

use std::path::{Path, PathBuf};
use std::time::Instant;

use super::interrupts::Interrupts;
use super::keeper::Keeper;
use super::machine::Machine;
use super::opening::{Opening, open};
use super::{Failure, RunArguments, note, read_scene, room, say, table, warn};
use crate::backend::BackendError;
use crate::backend::cpu::with_threads;
use crate::effect::Effect;
use crate::output::{Effects, Progress, Seconds, Summary, peak_memory_bytes};
use crate::study::{Setup, Tension, Unreachable, WalkEnd, WalkError, walk_on};
use crate::surface::Surface;

/// Solves a scene and writes its folder.
pub(super) fn run(arguments: &RunArguments) -> Result<(), Failure> {
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
    let machine = Machine::of(&setup, arguments.verbose)?;
    seconds.add("device", clock.elapsed().as_secs_f64());
    let interrupts = Interrupts::watch();
    match walk(arguments, &setup, &machine, &interrupts, seconds.clone())? {
        None => Ok(()),
        // The device failed and another may go on: what is solved is kept, as for `--resume`.
        Some((error, instead)) => {
            warn(&format!(
                "{error}; the processor goes on after the last finished step"
            ));
            let again = RunArguments {
                resume: true,
                ..arguments.clone()
            };
            walk(&again, &setup, &instead, &interrupts, seconds).map(drop)
        }
    }
}

/// Walks the path and writes its folder. Where the device fails and the scene leaves the choice,
/// returns what happened and what may go on.
fn walk(
    arguments: &RunArguments,
    setup: &Setup,
    machine: &Machine,
    interrupts: &Interrupts,
    mut seconds: Seconds,
) -> Result<Option<(BackendError, Machine)>, Failure> {
    let path = arguments
        .out
        .clone()
        .unwrap_or_else(|| default_folder(&arguments.scene));
    let Opening {
        folder,
        curve,
        earlier,
        warnings,
        remarks,
        lost,
    } = open(&path, setup, machine, arguments.resume)?;
    for remark in machine.remark.iter().chain(&remarks) {
        note(remark);
    }
    for warning in setup.warnings.iter().chain(&lost) {
        warn(warning);
    }
    seconds.add("solve", earlier.rows.iter().map(|row| row.seconds).sum());
    let progress = Progress::new(
        setup.scene.loading.path.len(),
        earlier.rows.len(),
        setup.scene.solver.tolerance,
        arguments.quiet,
    );
    let mut keeper = Keeper::new(
        setup,
        machine,
        &folder,
        curve,
        progress,
        interrupts.clone(),
        &earlier,
        warnings,
        seconds,
    );
    let make_backend = || machine.backend();
    let threads = arguments.threads.map(usize::from);
    let walked = with_threads(threads, || {
        walk_on(setup, &make_backend, &mut keeper, earlier)
    })?;
    let (end, failure) = match walked {
        Ok(end) => (end, None),
        Err(WalkError::Backend(error)) if let Some(instead) = machine.instead(setup) => {
            return Ok(Some((error, instead)));
        }
        // What is solved stands: it is summed up like any other end.
        Err(WalkError::Backend(error)) => (keeper.end_so_far(), Some(Failure::from(error))),
        Err(WalkError::Observer(error)) => {
            say(&keeper.kept());
            return Err(error.into());
        }
    };
    let steps = setup.scene.loading.path.len();
    let ended_early = failure.is_some() || end.interrupted;
    let written = keeper.finish(&end, |seconds, warnings| {
        summarise(setup, machine, &end, seconds, warnings)
    });
    if ended_early || written.is_err() {
        say(&keeper.kept());
    }
    drop(keeper);
    if let Some(failure) = failure {
        return Err(failure);
    }
    written?;
    if !arguments.quiet {
        table::print(&end.rows);
    }
    judge(setup, &end, steps).map(|()| None)
}

/// The scene's name without `.toml`, in the current folder.
fn default_folder(scene: &Path) -> PathBuf {
    PathBuf::from(scene.file_stem().unwrap_or(scene.as_os_str()))
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
    let tension = Tension::of(&setup.scene.loading, end);
    let [lower, upper] = tension
        .bounds()
        .map_or([None; 2], |bounds| bounds.map(Some));
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
        pull_off_force: tension.pull_off(),
        pull_off_step: tension.step(),
        pull_off_lower: lower,
        pull_off_upper: upper,
        jump_in_steps: end.jump_in_steps.clone(),
        jump_off_steps: end.jump_off_steps.clone(),
        hysteresis_energy: end.hysteresis_energy,
        warnings,
    }
}

/// The end of a run as its exit status.
fn judge(setup: &Setup, end: &WalkEnd, steps: usize) -> Result<(), Failure> {
    if end.interrupted {
        return Err(Failure::Interrupted {
            finished: end.rows.len(),
            steps,
        });
    }
    match end.rows.last() {
        Some(row) if !row.converged => Err(Failure::NotConverged {
            step: row.step,
            residual: row.residual,
            iterations: row.iterations,
            tolerance: setup.scene.solver.tolerance,
            remedy: match end.unreachable {
                None => "allow more max_iterations, or take smaller steps",
                Some(Unreachable::BeyondClosure) => {
                    "the surfaces cannot be closed further than full contact: end the path earlier"
                }
                Some(Unreachable::BeyondHardness) => {
                    "the solid flows everywhere before it bears this load: end the path earlier"
                }
            },
        }),
        _ => Ok(()),
    }
}
