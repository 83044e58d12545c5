//! `state/last_step.bin`: the checkpoint after the last finished step, on the disk.
//!
//! One file, so that one rename makes a step finished: a line that names the form, the length of a
//! JSON head as eight bytes, the head, the numbers that it announces (little-endian), and a CRC-32
//! of everything before it. The numbers are kept as the backend has them: in 32 bits where it
//! computes in 32.

use std::borrow::Cow;
use std::fs;
use std::io::{self, Write};
use std::path::Path;
use std::sync::Arc;

use crc32fast::Hasher;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::error::{FRESH, OutputError};
use super::folder::stream_within;
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
        decode(bytes).ok()
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

    /// Reads the state at `path`; `None` where there is none.
    ///
    /// # Errors
    /// Refused where the file is damaged, or of another version of tabor.
    pub fn read(path: &Path) -> Result<Option<SavedState<'static>>, OutputError> {
        match fs::read(path) {
            Ok(bytes) => decode(&bytes)
                .map(Some)
                .map_err(|reason| OutputError::refused(path, reason)),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(OutputError::write("read", path)(error)),
        }
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

/// The state in `bytes`, or why there is none in it and the way out.
fn decode(bytes: &[u8]) -> Result<SavedState<'static>, String> {
    let damaged = || format!("is damaged; {FRESH}");
    let content = bytes.strip_prefix(FORM).ok_or_else(|| {
        format!("is not a state of this version of tabor, or was cut short; {FRESH}")
    })?;
    let (checked, checksum) = bytes
        .split_last_chunk::<CHECKSUM_BYTES>()
        .ok_or_else(damaged)?;
    if crc32fast::hash(checked) != u32::from_le_bytes(*checksum) {
        return Err(damaged());
    }
    let content = &content[..content.len().saturating_sub(CHECKSUM_BYTES)];
    let (length, content) = content
        .split_first_chunk::<LENGTH_BYTES>()
        .ok_or_else(damaged)?;
    let length = usize::try_from(u64::from_le_bytes(*length)).map_err(|_| damaged())?;
    let (head, mut content) = content.split_at_checked(length).ok_or_else(damaged)?;
    let head: Head = serde_json::from_slice(head).map_err(|_| damaged())?;
    if head.tabor != env!("CARGO_PKG_VERSION") {
        return Err(format!(
            "was written by tabor {}, and this is {}, which may round differently; {FRESH}",
            head.tabor,
            env!("CARGO_PKG_VERSION")
        ));
    }
    let mut take = |bytes: usize| -> Result<&[u8], String> {
        let (part, rest) = content.split_at_checked(bytes).ok_or_else(damaged)?;
        content = rest;
        Ok(part)
    };
    let width = if head.single { 4 } else { 8 };
    let mut fields = Vec::new();
    for (name, count) in head.fields {
        let part = take(count.checked_mul(width).ok_or_else(damaged)?)?;
        let values = if head.single {
            numbers(part, |bytes| f64::from(f32::from_le_bytes(bytes)))
        } else {
            numbers(part, f64::from_le_bytes)
        };
        fields.push(CheckpointField {
            name,
            values: Arc::new(values),
        });
    }
    let points = match head.points {
        None => None,
        Some(count) => {
            let states = take(count)?.iter().map(|&byte| PointState::from_byte(byte));
            Some(states.collect::<Option<Vec<_>>>().ok_or_else(damaged)?)
        }
    };
    if !content.is_empty() {
        return Err(damaged());
    }
    Ok(SavedState {
        scene: head.scene,
        solver: head.solver,
        machine: head.machine,
        finished: head.finished,
        curve: head.curve,
        warnings: head.warnings,
        single: head.single,
        checkpoint: Cow::Owned(Checkpoint {
            fields,
            evaluated_under: match head.evaluated_under {
                None => None,
                Some(stiffness) => Some(stiffness.parse().map_err(|_| damaged())?),
            },
            points,
            jump_in_steps: head.jump_in_steps,
            jump_off_steps: head.jump_off_steps,
            pull_off: match head.pull_off {
                None => None,
                Some((step, lower, upper)) => Some(PullOff {
                    step,
                    lower: lower.parse().map_err(|_| damaged())?,
                    upper: upper.parse().map_err(|_| damaged())?,
                }),
            },
            transforms: head.transforms.parse().map_err(|_| damaged())?,
        }),
    })
}

/// The numbers of `N` bytes each in `bytes`.
fn numbers<const N: usize>(bytes: &[u8], number: impl Fn([u8; N]) -> f64) -> Vec<f64> {
    let (chunks, _) = bytes.as_chunks::<N>();
    chunks.iter().map(|chunk| number(*chunk)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state(single: bool) -> SavedState<'static> {
        let values = vec![0.1, -0.0, f64::MIN_POSITIVE, 1e300, f64::INFINITY];
        let values = if single {
            values.iter().map(|v| f64::from(*v as f32)).collect()
        } else {
            values
        };
        SavedState {
            scene: "a \"scene\"".into(),
            solver: serde_json::json!({ "tolerance": 1e-6 }),
            machine: "cpu, double".into(),
            finished: 3,
            curve: 0xdead_beef,
            warnings: vec!["step 2 is separated".into()],
            single,
            checkpoint: Cow::Owned(Checkpoint {
                fields: vec![CheckpointField {
                    name: "gap".into(),
                    values: Arc::new(values),
                }],
                evaluated_under: Some(0.1),
                points: Some(vec![
                    PointState::Contact,
                    PointState::Separated,
                    PointState::Attracted,
                ]),
                jump_in_steps: vec![2],
                jump_off_steps: vec![],
                pull_off: Some(PullOff {
                    step: 2,
                    lower: 0.1,
                    upper: 0.1 + f64::EPSILON,
                }),
                transforms: 1234.5625,
            }),
        }
    }

    fn bytes_of(state: &SavedState) -> Vec<u8> {
        let mut bytes = Vec::new();
        state.encode(&mut bytes, None).unwrap();
        bytes
    }

    #[test]
    fn states_come_back_bit_for_bit() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("state/last_step.bin");
        assert_eq!(SavedState::read(&path).unwrap(), None);
        for single in [false, true] {
            let state = state(single);
            state.write(&path).unwrap();
            let read = SavedState::read(&path).unwrap().unwrap();
            let bits = |state: &SavedState| -> Vec<u64> {
                let values = state.checkpoint.fields[0].values.iter();
                values.map(|value| value.to_bits()).collect()
            };
            assert_eq!(bits(&read), bits(&state));
            assert_eq!(read, state);
        }
    }

    #[test]
    fn every_cut_and_every_flipped_bit_is_noticed() {
        let bytes = bytes_of(&state(false));
        assert!(decode(&bytes).is_ok());
        for end in 0..bytes.len() {
            assert!(decode(&bytes[..end]).is_err(), "cut at {end}");
        }
        for at in 0..bytes.len() {
            let mut flipped = bytes.clone();
            flipped[at] ^= 1 << (at % 8);
            assert!(decode(&flipped).is_err(), "flipped at {at}");
        }
        let mut longer = bytes;
        longer.push(0);
        assert!(decode(&longer).is_err());
    }

    #[test]
    fn a_state_of_another_version_says_so() {
        let mut bytes = bytes_of(&state(false));
        bytes.truncate(bytes.len() - CHECKSUM_BYTES);
        let version = format!("\"tabor\":\"{}\"", env!("CARGO_PKG_VERSION"));
        let at = bytes
            .windows(version.len())
            .position(|window| window == version.as_bytes())
            .unwrap();
        bytes[at + 9] = b'7';
        bytes.extend(crc32fast::hash(&bytes).to_le_bytes());
        let reason = decode(&bytes).unwrap_err();
        assert!(reason.contains("written by tabor 7"), "{reason}");
        // Well formed, but announcing more than the file holds: no allocation of that size.
        let mut huge = bytes_of(&state(false));
        huge.truncate(huge.len() - CHECKSUM_BYTES);
        let text = b"[\"gap\",5]";
        let at = huge.windows(text.len()).position(|w| w == text).unwrap();
        huge.splice(at..at + text.len(), *b"[\"gap\",4611686018427387904]");
        let grown = 18;
        let length = u64::from_le_bytes(huge[FORM.len()..FORM.len() + 8].try_into().unwrap());
        huge[FORM.len()..FORM.len() + 8].copy_from_slice(&(length + grown).to_le_bytes());
        huge.extend(crc32fast::hash(&huge).to_le_bytes());
        assert!(decode(&huge).unwrap_err().contains("damaged"));
    }
}
