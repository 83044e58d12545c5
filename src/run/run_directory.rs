//! The folder of a run, opened for its first step or to resume after the last finished one.

use std::borrow::Cow;
use std::fs;
use std::path::Path;

use crc32fast::Hasher;

use super::earlier_files::lost;
use crate::backend::Share;
use crate::device::SelectedDevice;
use crate::output::{
    Curve, CurveWriter, EMPTY_CHECKSUM, FRESH, OutputError, RunFolder, SavedState, StateFile,
    set_aside,
};
use crate::scene::{AdhesionMap, AdhesionScene, Precision, Scene};
use crate::study::{Checkpoint, Column, Earlier, Planned, Setup};

/// A folder ready to be written, and what is in it already.
pub(super) struct RunDirectory {
    pub folder: RunFolder,
    pub curve: CurveWriter,
    /// Steps done already.
    pub earlier: Earlier,
    /// The state after them, where its numbers are left for several ranks to read.
    pub state: Option<StateFile>,
    /// Warnings of the run so far.
    pub warnings: Vec<String>,
    /// Remarks for the user.
    pub remarks: Vec<String>,
    /// Warnings that are shown before the first step.
    pub lost: Vec<String>,
}

/// Identifies a scene: everything but how it is solved, heights read from files included.
///
/// Every rank takes part.
pub(super) fn fingerprint(setup: &Setup) -> String {
    let mut resolved = setup.scene.identity();
    if let Some(table) = resolved.as_object_mut() {
        table.remove("solver");
        let share = &setup.problem.share;
        let heights = checksum(&setup.surface.heights, share);
        table.insert("checksum of the heights".to_owned(), heights.into());
        let is_file = |law: &AdhesionScene| matches!(law.map, Some(AdhesionMap::File(_)));
        if setup.scene.adhesion.as_ref().is_some_and(is_file)
            && let Some(map) = &setup.surface.adhesion_map
        {
            let map = checksum(map, share);
            table.insert("checksum of the adhesion map".to_owned(), map.into());
        }
    }
    resolved.to_string()
}

/// Checksum of values over the grid, of which each process holds some rows.
fn checksum(values: &[f64], share: &Share) -> u32 {
    let mut own = Hasher::new();
    for value in values {
        own.update(&value.to_le_bytes());
    }
    let own = own.finalize();
    let Some(all) = share.all([f64::from(own), size_of_val(values) as f64]) else {
        return own;
    };
    let parts = all.chunks_exact(2);
    let whole = parts.fold(Hasher::new(), |mut whole, part| {
        whole.combine(&Hasher::new_with_initial_len(
            part[0] as u32,
            part[1] as u64,
        ));
        whole
    });
    whole.finalize()
}

/// `[solver]` as resolved.
pub(super) fn solver(scene: &Scene) -> serde_json::Value {
    scene.resolved_json()["solver"].take()
}

/// Treatment of an earlier run of the same scene in the folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ExistingRun {
    /// It is resumed after its last finished step.
    Resume,
    /// Its files are removed.
    Overwrite,
    /// It stays, and the new run is refused.
    Refuse,
}

impl RunDirectory {
    /// Opens the folder at `path` for a scene of this fingerprint. Pictures of an earlier run are looked for if this one `draws`.
    pub fn open(
        path: &Path,
        setup: &Setup,
        device: &SelectedDevice,
        existing: ExistingRun,
        draws: bool,
        scene: String,
    ) -> Result<RunDirectory, OutputError> {
        let resume = existing == ExistingRun::Resume;
        let (folder, there) = if resume {
            RunFolder::resume(path, &scene)?
        } else {
            RunFolder::take(path, &scene)?
        };
        if there && existing == ExistingRun::Refuse {
            return Err(OutputError::refused(
                path,
                "holds a run of this scene; resume it, overwrite it, or name another folder",
            ));
        }
        let resumed = resume_from(&folder, &scene, setup, device, resume && there, draws)?;
        let mut opened = match resumed {
            Some(opened) => opened,
            None => start(folder, there, scene, setup, device, resume)?,
        };
        let unheld = opened.folder.warning().map(str::to_owned);
        opened.lost.extend(unheld);
        Ok(opened)
    }
}

/// Begins at the first step.
fn start(
    folder: RunFolder,
    there: bool,
    scene: String,
    setup: &Setup,
    device: &SelectedDevice,
    resume: bool,
) -> Result<RunDirectory, OutputError> {
    let mut remarks = Vec::new();
    if resume {
        let path = folder.path().display();
        remarks.push(format!("{path}: nothing to resume, starts at step 1"));
    } else {
        remarks.extend(keep_rows(&folder, &scene, setup, there)?);
    }
    // In this order, each change leaves a folder that can be resumed: the state of no steps fits any curve, the
    // old one until the new one takes its name. From here on a missing state is a lost one.
    folder.write_marker(&scene)?;
    let (state, curve) = (folder.state_path(STATE), folder.curve_path());
    SavedState {
        scene,
        solver: solver(&setup.scene),
        machine: device.words(),
        finished: 0,
        curve: EMPTY_CHECKSUM,
        warnings: Vec::new(),
        single: device.precision() == Precision::Single && !setup.scene.solid.remembers(),
        checkpoint: Cow::Owned(Checkpoint::default()),
    }
    .write(&state)?;
    folder.remove_own_files(&[&state, &curve])?;
    let curve = CurveWriter::create(&curve, Column::for_scene(&setup.scene))?;
    Ok(RunDirectory {
        folder,
        curve,
        earlier: Earlier::default(),
        state: None,
        warnings: Vec::new(),
        remarks,
        lost: Vec::new(),
    })
}

/// The file that holds the state, after its prefix.
pub(super) const STATE: &str = "step.bin";

/// Sets the curve aside before a run from the first step takes its name, where the steps in it cannot be
/// resumed; of others `--resume` would have kept the rows. Says so.
fn keep_rows(
    folder: &RunFolder,
    scene: &str,
    setup: &Setup,
    there: bool,
) -> Result<Option<String>, OutputError> {
    let path = folder.curve_path();
    let rows = fs::read(&path).map_or(0, |bytes| {
        bytes.iter().filter(|byte| **byte == b'\n').count()
    });
    // Its head is a line too.
    if !there || rows < 2 || sound(folder, scene, setup).is_ok() {
        return Ok(None);
    }
    let kept = set_aside(&path)?;
    Ok(Some(format!(
        "the rows of the earlier run are kept in {}",
        kept.display()
    )))
}

/// The state and the curve of a folder, if steps can be resumed from them.
///
/// # Errors
/// Refused where one is damaged, missing, or does not belong to the other or to the scene; the way out keeps
/// the rows.
fn sound(
    folder: &RunFolder,
    scene: &str,
    setup: &Setup,
) -> Result<Option<(StateFile, Curve)>, OutputError> {
    let path = folder.state_path(STATE);
    let curve = Curve::read(&folder.curve_path(), Column::for_scene(&setup.scene))?;
    let refuse = |reason: String| {
        let reason = format!("{reason}; {FRESH}");
        Err(OutputError::refused(&path, reason))
    };
    let Some(file) = StateFile::open(&path)? else {
        return match curve.rows().len() {
            0 => Ok(None),
            rows => refuse(format!("is missing, where curve.csv has {rows} steps")),
        };
    };
    let state = &file.state;
    if state.scene != scene {
        return refuse("is of another scene".to_owned());
    }
    let points = setup.problem.shape.len();
    let loading = &setup.scene.loading;
    if (state.finished > loading.path.len() && !loading.until_apart)
        || file.lengths.iter().any(|length| *length != points)
        || (state.checkpoint.points.is_some() && file.points != setup.surface.grid.len())
    {
        return refuse("does not fit the scene".to_owned());
    }
    curve.expect(state.finished, state.curve)?;
    Ok(Some((file, curve)))
}

/// What is in a folder of this scene, if it is `there` to be resumed; `None` where the run ended before it
/// came to its first step.
fn resume_from(
    folder: &RunFolder,
    scene: &str,
    setup: &Setup,
    device: &SelectedDevice,
    there: bool,
    draws: bool,
) -> Result<Option<RunDirectory>, OutputError> {
    if !there {
        return Ok(None);
    }
    let Some((file, curve)) = sound(folder, scene, setup)? else {
        return Ok(None);
    };
    let (mut state, file) = if setup.problem.share.is_whole() {
        (file.read_all()?, None)
    } else {
        (file.state.clone(), Some(file))
    };
    if state.finished == 0 {
        // Of an earlier run, where the one that was to replace it ended before it had removed them.
        folder.remove_own_files(&[&folder.state_path(STATE), &folder.curve_path()])?;
    }
    let failed = curve
        .rows()
        .get(state.finished)
        .is_some_and(|row| !row.converged);
    let now = solver(&setup.scene);
    // Other words for the same place and arithmetic change nothing.
    let said = |solver: &serde_json::Value| {
        let mut solver = solver.clone();
        if let Some(table) = solver.as_object_mut()
            && state.machine == device.words()
        {
            table.retain(|key, _| key != "backend" && key != "precision");
        }
        solver
    };
    let is_changed = said(&state.solver) != said(&now) && state.finished > 0;
    if is_changed && !failed {
        return Err(OutputError::refused(
            &folder.state_path(STATE),
            format!(
                "was solved with [solver] {}, and here it is {now}: it may change only where a step did not converge; put it back, or name another folder",
                state.solver
            ),
        ));
    }
    if is_changed && file.is_none() {
        // Before the row goes that lets it change: this run may end before it finishes a step, and be resumed too.
        state.solver = now;
        state.write(&folder.state_path(STATE))?;
    }
    let mut remarks = Vec::new();
    let mut warnings = state.warnings;
    let total = setup.scene.loading.path.len();
    let rows = &curve.rows()[..state.finished];
    remarks.push(match state.finished {
        0 => "no step was finished, starts at step 1".to_owned(),
        finished if Planned::after(setup, rows).is_none() => {
            format!("all {finished} steps were finished")
        }
        finished if finished >= total => {
            format!("{finished} steps were finished, continues after them")
        }
        finished => format!("{finished} of {total} steps were finished, continues after them"),
    });
    if state.finished > 0 && state.machine != device.words() {
        let text = format!(
            "steps 1 to {} were solved on {}, the others on {}",
            state.finished,
            state.machine,
            device.words()
        );
        remarks.push(text.clone());
        warnings.push(text);
    }
    let lost = lost(folder, setup, rows, draws);
    warnings.extend(
        lost.iter()
            .filter(|text| !warnings.contains(text))
            .cloned()
            .collect::<Vec<_>>(),
    );
    let (curve, rows) = curve.resume(state.finished, state.curve)?;
    Ok(Some(RunDirectory {
        folder: folder.clone(),
        curve,
        earlier: Earlier {
            rows,
            checkpoint: state.checkpoint.into_owned(),
        },
        state: file,
        warnings,
        remarks,
        lost: lost.into_iter().collect(),
    }))
}
