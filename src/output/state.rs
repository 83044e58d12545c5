//! `state/last_step.bin`: the checkpoint after the last finished step, on the disk.
//!
//! One file, so that one rename makes a step finished: a line that names the form, the length of a
//! JSON head as eight bytes, the head, the numbers that it announces (little-endian), and a CRC-32
//! of everything before it. The numbers are kept as the backend has them: in 32 bits where it
//! computes in 32.

use std::borrow::Cow;
use std::fs::File;
use std::io::{self, BufReader, Cursor, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crc32fast::Hasher;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::error::{FRESH, OutputError};
use super::folder::stream_within;
use crate::backend::long_field::LongField;
use crate::backend::{BackendError, Share};
use crate::study::{Checkpoint, CheckpointField, PointState, PullOff};

/// First line of the file. A change of the form changes the number.
const FORM: &[u8] = b"tabor state 3\n";
/// Bytes of the head's length.
const LENGTH_BYTES: usize = 8;
/// Numbers that are put into bytes at once.
const PIECE: usize = 1 << 14;
/// Bytes of the checksum.
const CHECKSUM_BYTES: usize = 4;

/// A run as it stands after its last finished step.
#[derive(Clone, Debug, PartialEq)]
pub struct SavedState<'a> {
    /// Identifies the scene.
    pub scene: String,
    /// `[solver]` of the scene, as resolved.
    pub solver: Value,
    /// Where the steps were solved: backend, adapter and precision.
    pub machine: String,
    /// Finished steps.
    pub finished: usize,
    /// Checksum of the rows up to the last finished step, as the curve's writer has it.
    pub curve: u32,
    /// Warnings of the run so far, besides those of its scene.
    pub warnings: Vec<String>,
    /// Whether fields are known in single precision only.
    pub single: bool,
    /// Start of the next step.
    pub checkpoint: Cow<'a, Checkpoint>,
}

/// The JSON head.
#[derive(Debug, Serialize, Deserialize)]
struct Head {
    tabor: String,
    scene: String,
    solver: Value,
    machine: String,
    finished: usize,
    curve: u32,
    warnings: Vec<String>,
    /// Text, because a number of JSON need not come back to the last bit.
    transforms: String,
    /// Text, like these.
    evaluated_under: Option<String>,
    jump_in_steps: Vec<usize>,
    jump_off_steps: Vec<usize>,
    /// Step, lower and upper tension, as text like the transforms.
    pull_off: Option<(usize, String, String)>,
    single: bool,
    /// Names and lengths of the fields.
    fields: Vec<(String, usize)>,
    /// Points whose contact state follows the fields, one byte each.
    points: Option<usize>,
}

impl SavedState<'_> {
    /// Writes the state to `path`, whole or not at all.
    pub fn write(&self, path: &Path) -> Result<(), OutputError> {
        stream_within(path, |file| self.encode(file, None))
    }

    /// The same of several ranks, of which each has its rows of the fields: the first one writes. `ask` is called
    /// once, before the others are to [hand theirs over](hand_over).
    pub fn write_shared(
        &self,
        path: &Path,
        share: &Share,
        ask: &dyn Fn(),
    ) -> Result<(), OutputError> {
        stream_within(path, |file| self.encode(file, Some((share, ask))))
    }

    /// The form of the file in memory, for another process of the same run.
    pub fn to_bytes(&self) -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        self.encode(&mut bytes, None)?;
        Ok(bytes)
    }

    /// The state that [`to_bytes`](Self::to_bytes) gave; `None` for other bytes.
    pub fn from_bytes(bytes: &[u8]) -> Option<SavedState<'static>> {
        let file = StateFile::check(Cursor::new(bytes), Path::new("")).ok()?;
        file.read_all().ok()
    }

    /// Writes the form to `out`, numbers one after another: a field is large, and a second one of bytes would be
    /// held for no more than this.
    fn encode(&self, out: &mut impl Write, shared: Option<(&Share, &dyn Fn())>) -> io::Result<()> {
        let all = shared.map(|(share, _)| share.shape());
        let state = &self.checkpoint;
        let head = serde_json::to_vec(&Head {
            tabor: env!("CARGO_PKG_VERSION").to_owned(),
            scene: self.scene.clone(),
            solver: self.solver.clone(),
            machine: self.machine.clone(),
            finished: self.finished,
            curve: self.curve,
            warnings: self.warnings.clone(),
            transforms: format!("{:?}", state.transforms),
            evaluated_under: state
                .evaluated_under
                .map(|stiffness| format!("{stiffness:?}")),
            jump_in_steps: state.jump_in_steps.clone(),
            jump_off_steps: state.jump_off_steps.clone(),
            pull_off: state.pull_off.map(|found| {
                let [lower, upper] = [found.lower, found.upper].map(|force| format!("{force:?}"));
                (found.step, lower, upper)
            }),
            single: self.single,
            fields: state
                .fields
                .iter()
                .map(|field| {
                    let length = all.map_or(field.values.len(), |shape| shape.len());
                    (field.name.clone(), length)
                })
                .collect(),
            points: state
                .points
                .as_ref()
                .map(|points| all.map_or(points.len(), |shape| shape.surface_len())),
        })?;
        let mut checked = Hasher::new();
        let mut write = |bytes: &[u8]| {
            checked.update(bytes);
            out.write_all(bytes)
        };
        write(FORM)?;
        write(&(head.len() as u64).to_le_bytes())?;
        write(&head)?;
        let mut piece = Vec::with_capacity(PIECE * size_of::<f64>());
        let mut written = Ok(());
        if let Some((_, ask)) = shared {
            ask();
        }
        // To the end, whatever becomes of what is written: the other ranks hand over all.
        let gone = hand_over(state, shared.map(|(share, _)| share), &mut |rows| {
            if written.is_err() {
                return;
            }
            written = match rows {
                StateRows::Numbers(values) => values.chunks(PIECE).try_for_each(|values| {
                    piece.clear();
                    for value in values {
                        if self.single {
                            piece.extend((*value as f32).to_le_bytes());
                        } else {
                            piece.extend(value.to_le_bytes());
                        }
                    }
                    write(&piece)
                }),
                StateRows::Points(points) => write(points),
            };
        });
        written?;
        gone.map_err(io::Error::other)?;
        out.write_all(&checked.finalize().to_le_bytes())
    }

    /// Reads the state at `path`, if there is a file.
    ///
    /// # Errors
    /// Refused where the file is damaged, or of another version of tabor.
    pub fn read(path: &Path) -> Result<Option<SavedState<'static>>, OutputError> {
        StateFile::open(path)?.map(StateFile::read_all).transpose()
    }
}

/// Rows of a state's fields.
pub enum StateRows<'a> {
    /// Of numbers.
    Numbers(&'a [f64]),
    /// Of the states of points.
    Points(&'a [u8]),
}

/// Hands the fields of a state to `take`, which is called on the first rank alone, row after row.
///
/// # Errors
/// Another rank has ended.
pub fn hand_over(
    state: &Checkpoint,
    share: Option<&Share>,
    take: &mut dyn FnMut(StateRows),
) -> Result<(), BackendError> {
    for field in &state.fields {
        match share {
            None => take(StateRows::Numbers(&field.values)),
            Some(share) => {
                let width = share.shape().points[0];
                share.to_first(&field.values, width, &mut |rows| {
                    take(StateRows::Numbers(rows));
                })?;
            }
        }
    }
    let Some(points) = &state.points else {
        return Ok(());
    };
    match share {
        None => points.chunks(PIECE).for_each(|points| {
            let bytes: Vec<u8> = points.iter().map(|point| *point as u8).collect();
            take(StateRows::Points(&bytes));
        }),
        Some(share) => {
            let bytes: Vec<u8> = points.iter().map(|point| *point as u8).collect();
            share.to_first(&bytes, share.surface()[0], &mut |rows| {
                take(StateRows::Points(rows));
            })?;
        }
    }
    Ok(())
}

/// A state that was found whole, on the disk or in memory. Its numbers are read when they are asked for, so that a process
/// which keeps some of them need not hold all.
#[derive(Debug)]
pub struct StateFile<R = BufReader<File>> {
    /// The state without its numbers: fields and points are empty.
    pub state: SavedState<'static>,
    /// How many numbers each of its fields has.
    pub lengths: Vec<usize>,
    /// How many points it has.
    pub points: usize,
    /// From the first number that has not been read.
    file: R,
    path: PathBuf,
}

impl StateFile {
    /// Opens the state at `path`, if there is a file.
    ///
    /// # Errors
    /// As [`SavedState::read`].
    pub fn open(path: &Path) -> Result<Option<StateFile>, OutputError> {
        match File::open(path) {
            Ok(file) => StateFile::check(BufReader::new(file), path).map(Some),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(OutputError::write("read", path)(error)),
        }
    }
}

impl<R: Read + Seek> StateFile<R> {
    /// Reads the file once through for its checksum, and then its head.
    fn check(mut file: R, path: &Path) -> Result<Self, OutputError> {
        let refused = |reason: String| OutputError::refused(path, reason);
        let damaged = || refused(format!("is damaged; {FRESH}"));
        let unread = |cause| OutputError::write("read", path)(cause);
        let length = file.seek(SeekFrom::End(0)).map_err(unread)?;
        file.rewind().map_err(unread)?;
        let mut form = [0; FORM.len()];
        if file.read_exact(&mut form).is_err() || form != FORM {
            return Err(refused(format!(
                "is not a state of this version of tabor, or was cut short; {FRESH}"
            )));
        }
        let mut left = (length - FORM.len() as u64)
            .checked_sub(CHECKSUM_BYTES as u64)
            .ok_or_else(damaged)?;
        let mut checked = Hasher::new();
        checked.update(&form);
        let mut piece = vec![0; PIECE * size_of::<f64>()];
        let mut unchecked = left;
        while unchecked > 0 {
            let count = unchecked.min(piece.len() as u64) as usize;
            file.read_exact(&mut piece[..count]).map_err(unread)?;
            checked.update(&piece[..count]);
            unchecked -= count as u64;
        }
        let mut checksum = [0; CHECKSUM_BYTES];
        file.read_exact(&mut checksum).map_err(unread)?;
        if checked.finalize() != u32::from_le_bytes(checksum) {
            return Err(damaged());
        }

        let mut take = |count: u64| {
            left = left.checked_sub(count).ok_or_else(damaged)?;
            Ok(count as usize)
        };
        file.seek(SeekFrom::Start(FORM.len() as u64))
            .map_err(unread)?;
        let mut head_length = [0; LENGTH_BYTES];
        take(LENGTH_BYTES as u64)?;
        file.read_exact(&mut head_length).map_err(unread)?;
        let mut head = vec![0; take(u64::from_le_bytes(head_length))?];
        file.read_exact(&mut head).map_err(unread)?;
        let head: Head = serde_json::from_slice(&head).map_err(|_| damaged())?;
        if head.tabor != env!("CARGO_PKG_VERSION") {
            return Err(refused(format!(
                "was written by tabor {}, and this is {}, which may round differently; {FRESH}",
                head.tabor,
                env!("CARGO_PKG_VERSION")
            )));
        }
        let width = if head.single { 4 } else { 8 };
        for (_, count) in &head.fields {
            take((*count as u64).checked_mul(width).ok_or_else(damaged)?)?;
        }
        take(head.points.unwrap_or(0) as u64)?;
        if left > 0 {
            return Err(damaged());
        }
        let number = |text: String| text.parse().map_err(|_| damaged());
        let state = SavedState {
            scene: head.scene,
            solver: head.solver,
            machine: head.machine,
            finished: head.finished,
            curve: head.curve,
            warnings: head.warnings,
            single: head.single,
            checkpoint: Cow::Owned(Checkpoint {
                fields: (head.fields.iter())
                    .map(|(name, _)| CheckpointField {
                        name: name.clone(),
                        values: Arc::default(),
                    })
                    .collect(),
                evaluated_under: head.evaluated_under.map(number).transpose()?,
                points: head.points.map(|_| Vec::new()),
                jump_in_steps: head.jump_in_steps,
                jump_off_steps: head.jump_off_steps,
                pull_off: match head.pull_off {
                    None => None,
                    Some((step, lower, upper)) => Some(PullOff {
                        step,
                        lower: number(lower)?,
                        upper: number(upper)?,
                    }),
                },
                transforms: number(head.transforms)?,
            }),
        };
        Ok(StateFile {
            state,
            lengths: head.fields.iter().map(|(_, count)| *count).collect(),
            points: head.points.unwrap_or(0),
            file,
            path: path.to_path_buf(),
        })
    }

    /// The next numbers of the fields, which come one field after another.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn numbers(&mut self, values: &mut [f64]) -> Result<(), OutputError> {
        let mut piece = vec![0; PIECE * size_of::<f64>()];
        for values in values.chunks_mut(PIECE) {
            let width = if self.state.single { 4 } else { 8 };
            let bytes = &mut piece[..values.len() * width];
            let read = self.file.read_exact(bytes);
            read.map_err(OutputError::write("read", &self.path))?;
            if self.state.single {
                take_numbers(bytes, values, |bytes| f64::from(f32::from_le_bytes(bytes)));
            } else {
                take_numbers(bytes, values, f64::from_le_bytes);
            }
        }
        Ok(())
    }

    /// The next states of points, after all fields.
    ///
    /// # Errors
    /// The file cannot be read, or has other bytes.
    pub fn states(&mut self, states: &mut [u8]) -> Result<(), OutputError> {
        let read = self.file.read_exact(states);
        read.map_err(OutputError::write("read", &self.path))?;
        if states
            .iter()
            .all(|&byte| PointState::from_byte(byte).is_some())
        {
            Ok(())
        } else {
            Err(OutputError::refused(
                &self.path,
                format!("is damaged; {FRESH}"),
            ))
        }
    }

    /// The whole state.
    ///
    /// # Errors
    /// As [`numbers`](Self::numbers) and [`states`](Self::states).
    pub fn read_all(mut self) -> Result<SavedState<'static>, OutputError> {
        let mut checkpoint = self.state.checkpoint.clone().into_owned();
        for (place, field) in checkpoint.fields.iter_mut().enumerate() {
            let mut values = LongField::zeros(self.lengths[place]);
            self.numbers(&mut values)?;
            field.values = Arc::new(values);
        }
        if let Some(points) = &mut checkpoint.points {
            let mut states = vec![0; self.points];
            self.states(&mut states)?;
            points.extend(states.into_iter().filter_map(PointState::from_byte));
        }
        Ok(SavedState {
            checkpoint: Cow::Owned(checkpoint),
            ..self.state
        })
    }
}

/// Numbers of `N` bytes each.
fn take_numbers<const N: usize>(bytes: &[u8], values: &mut [f64], number: impl Fn([u8; N]) -> f64) {
    let (chunks, _) = bytes.as_chunks::<N>();
    for (value, chunk) in values.iter_mut().zip(chunks) {
        *value = number(*chunk);
    }
}

#[cfg(test)]
#[path = "state_tests.rs"]
mod tests;
