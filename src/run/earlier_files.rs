//! Files of an earlier run in a folder that is resumed: whether those of its finished steps are whole.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use crate::output::RunFolder;
use crate::output::volume::VOLUME_END;
use crate::scene::StepChoice;
use crate::study::{Planned, Setup, StepRow};

/// The last bytes of every PNG file: the chunk that ends it.
const PNG_END: &[u8] = b"\0\0\0\0IEND\xae\x42\x60\x82";

/// Most files that a warning names.
const NAMED: usize = 8;

/// A warning of fields and pictures of the finished steps with these rows that are not there or cut short; `None`
/// where all are whole. Pictures are looked for if the run `draws`.
pub(super) fn lost(
    folder: &RunFolder,
    setup: &Setup,
    finished: &[StepRow],
    draws: bool,
) -> Option<String> {
    let found: Vec<PathBuf> = expected(folder, setup, finished, draws)
        .into_iter()
        .filter(|path| !is_whole(path))
        .collect();
    let names: Vec<String> = found
        .iter()
        .take(NAMED)
        .map(|path| path.display().to_string())
        .collect();
    let more = match found.len() - names.len() {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    (!found.is_empty()).then(|| {
        format!(
            "files of finished steps are missing or cut short: {}{more}; their steps are not solved again: a run into another folder writes them",
            names.join(", ")
        )
    })
}

/// The files that finished steps have written.
fn expected(folder: &RunFolder, setup: &Setup, finished: &[StepRow], draws: bool) -> Vec<PathBuf> {
    let output = &setup.scene.output;
    let last = finished.last();
    let is_over =
        Planned::after(setup, finished).is_none() || last.is_some_and(|row| !row.converged);
    // A last step without fields leaves those of the step before it.
    let drawn = finished.len() - usize::from(last.is_some_and(|row| row.approach.is_none()));
    let asked = |step: &usize| match &output.steps {
        StepChoice::All => true,
        StepChoice::List(list) => list.contains(step),
        // Those of an earlier end are cleared away when the run is resumed.
        StepChoice::Last => is_over && *step == drawn,
    };
    // Without a position there is no state, and nothing was written.
    let has_fields = |step: &usize| finished[*step - 1].approach.is_some();
    let mut paths = Vec::new();
    for step in (1..=finished.len()).filter(asked).filter(has_fields) {
        paths.extend(
            output
                .images
                .iter()
                .filter(|_| draws)
                .map(|&field| folder.image_path(step, field)),
        );
        paths.extend(
            output
                .fields
                .iter()
                .map(|&field| folder.field_path(step, field)),
        );
        if !output.fields.is_empty() {
            paths.push(folder.volume_path(step));
        }
    }
    paths
}

/// Whether a file is there to its end. Pictures and volumes end in marks of their own; an array of NumPy
/// gives its length in its head. The bytes between are not read: whole folders are gigabytes.
fn is_whole(path: &Path) -> bool {
    let Ok(mut file) = File::open(path) else {
        return false;
    };
    let whole = match path.extension().and_then(|extension| extension.to_str()) {
        Some("png") => ends_in(&mut file, PNG_END),
        Some("vti") => ends_in(&mut file, VOLUME_END),
        _ => array_is_whole(file),
    };
    whole.unwrap_or(false)
}

fn ends_in(file: &mut File, end: &[u8]) -> std::io::Result<bool> {
    file.seek(SeekFrom::End(-(end.len() as i64)))?;
    let mut found = Vec::new();
    file.read_to_end(&mut found)?;
    Ok(found == end)
}

fn array_is_whole(file: File) -> std::io::Result<bool> {
    let length = file.metadata()?.len();
    let mut reader = std::io::BufReader::new(file);
    let header = npyz::NpyHeader::from_reader(&mut reader)?;
    let width = header.dtype().num_bytes().unwrap_or(0);
    let values: u64 = header.shape().iter().product();
    let head = reader.stream_position()?;
    Ok(length == head + values * width as u64)
}
