//! Force curves of JPK instruments (.jpk-force): a ZIP archive of headers of keys and values, and of channels as big-endian
//! integers.
//!
//! Each segment (extend, retract) has a header, whose keys may refer to those that all share, and channels: the deflection
//! in volts, and heights that fall as the probe comes closer. A channel is converted slot by slot, each linear in the one
//! before: volts to metres to newtons.
//!
//! # Source
//! The headers themselves (file format versions 0.12 to 2.0), read as afmformats 0.18 reads them.

use std::collections::HashMap;
use std::io::{Cursor, Read};
use std::path::Path;

use zip::ZipArchive;

use super::columns::CurveColumns;
use super::curve_file::{ForceCurve, MOST_BYTES, Sample, name};
use super::error::FitError;

/// First bytes of a file.
pub(super) const MAGIC: &[u8] = b"PK\x03\x04";
/// The headers of the file, of a segment, and those that segments share.
const HEADER: &str = "header.properties";
const SEGMENT_HEADER: &str = "segment-header.properties";
const SHARED_HEADER: &str = "shared-data/header.properties";
/// The first curve of a file of many.
const MAP: &str = "index/0/header.properties";
/// Channels of the height, the measured ones first, with the slot in metres.
const HEIGHTS: [(&str, &str); 5] = [
    ("measuredHeight", "nominal"),
    ("capacitiveSensorHeight", "nominal"),
    ("strainGaugeHeight", "nominal"),
    ("height", "calibrated"),
    ("head-height", "calibrated"),
];
const DEFLECTION: &str = "vDeflection";
/// Most slots of a conversion.
const MOST_SLOTS: usize = 8;

type Properties = HashMap<String, String>;

/// The archive with the name for messages.
struct Archive<'a> {
    zip: ZipArchive<Cursor<&'a [u8]>>,
    path: &'a Path,
}

/// A linear conversion.
#[derive(Clone, Copy)]
struct Line {
    factor: f64,
    offset: f64,
}

impl Line {
    /// The values themselves.
    const SAME: Line = Line {
        factor: 1.0,
        offset: 0.0,
    };

    /// This conversion of the results of another.
    fn after(self, other: Line) -> Line {
        Line {
            factor: self.factor * other.factor,
            offset: self.factor * other.offset + self.offset,
        }
    }
}

/// Reads a curve: its segments that move, in their order.
pub(super) fn read(bytes: &[u8], path: &Path, how: &CurveColumns) -> Result<ForceCurve, FitError> {
    let zip = ZipArchive::new(Cursor::new(bytes));
    let zip = zip.map_err(|error| broken(path, format!("its archive is not whole ({error})")))?;
    let mut archive = Archive { zip, path };
    if !how.choices.is_empty() {
        return Err(broken(
            path,
            "its columns are known; choose none".to_owned(),
        ));
    }
    if archive.holds(MAP) {
        let what = "it holds a map of curves; save them one by one into a folder and fit that";
        return Err(broken(path, what.to_owned()));
    }
    let general = archive.properties(HEADER)?;
    let shared = if archive.holds(SHARED_HEADER) {
        archive.properties(SHARED_HEADER)?
    } else {
        Properties::new()
    };
    let mut curve = ForceCurve::default();
    let mut start = 0.0;
    for segment in 0.. {
        let folder = format!("segments/{segment}/");
        let header = format!("{folder}{SEGMENT_HEADER}");
        if !archive.holds(&header) {
            break;
        }
        let mut properties = general.clone();
        properties.extend(archive.properties(&header)?);
        add_shared(&mut properties, &shared);
        let segment = Segment {
            folder,
            properties,
            path,
        };
        start = segment.append(&mut archive, how, start, &mut curve)?;
    }
    if curve.samples.is_empty() {
        return Err(broken(
            path,
            "it holds no segment of a force curve".to_owned(),
        ));
    }
    Ok(curve)
}

fn broken(path: &Path, what: String) -> FitError {
    FitError::Broken {
        path: name(path),
        format: ".jpk-force",
        what,
    }
}

impl Archive<'_> {
    fn holds(&self, entry: &str) -> bool {
        self.zip.index_for_name(entry).is_some()
    }

    fn bytes(&mut self, entry: &str) -> Result<Vec<u8>, FitError> {
        let path = self.path;
        let missing = |error| broken(path, format!("{entry} cannot be read ({error})"));
        let file = self.zip.by_name(entry).map_err(missing)?;
        let mut bytes = Vec::new();
        file.take(MOST_BYTES)
            .read_to_end(&mut bytes)
            .map_err(|error| broken(path, format!("{entry} cannot be read ({error})")))?;
        Ok(bytes)
    }

    /// A header: `key=value`, one a line.
    fn properties(&mut self, entry: &str) -> Result<Properties, FitError> {
        let bytes = self.bytes(entry)?;
        let text = String::from_utf8_lossy(&bytes);
        let pairs = text
            .lines()
            .filter(|line| !line.starts_with('#'))
            .filter_map(|line| line.split_once('='))
            .map(|(key, value)| (key.trim().to_owned(), value.trim().to_owned()));
        Ok(pairs.collect())
    }
}

/// Puts what `channel.height.lcd-info.*=2` refers to, the keys `lcd-info.2.NAME`, in as `channel.height.NAME`.
fn add_shared(properties: &mut Properties, shared: &Properties) {
    let references: Vec<(String, String)> = properties
        .iter()
        .filter_map(|(key, number)| {
            let (owner, kind) = key.strip_suffix(".*")?.rsplit_once('.')?;
            Some((owner.to_owned(), format!("{kind}.{number}.")))
        })
        .collect();
    for (owner, prefix) in references {
        for (key, value) in shared {
            if let Some(rest) = key.strip_prefix(&prefix) {
                properties.insert(format!("{owner}.{rest}"), value.clone());
            }
        }
    }
}

/// A segment of a curve.
struct Segment<'a> {
    folder: String,
    properties: Properties,
    path: &'a Path,
}

impl Segment<'_> {
    fn text(&self, key: &str) -> Option<&str> {
        self.properties.get(key).map(String::as_str)
    }

    fn number(&self, key: &str) -> Option<f64> {
        let number: f64 = self.text(key)?.parse().ok()?;
        number.is_finite().then_some(number)
    }

    fn missing(&self, key: &str) -> FitError {
        broken(
            self.path,
            format!("{}{SEGMENT_HEADER} has no {key}", self.folder),
        )
    }

    /// Adds the points of the segment, whose first is at the time `start` (s), and returns the time of its end.
    fn append(
        &self,
        archive: &mut Archive,
        how: &CurveColumns,
        start: f64,
        curve: &mut ForceCurve,
    ) -> Result<f64, FitError> {
        let duration = self
            .number("force-segment-header.duration")
            .unwrap_or(f64::NAN);
        let style = self.text("force-segment-header.settings.style");
        let style = style.or(self.text("force-segment-header.settings.segment-settings.style"));
        if style == Some("pause") {
            return Ok(start + duration);
        }
        let (force, spring) = self.force(how)?;
        let known = |(channel, _): &&(&str, &str)| self.text(&file_key(channel)).is_some();
        let Some((channel, slot)) = HEIGHTS.iter().find(known) else {
            return Err(self.missing("channel of a height"));
        };
        let height = self.to_slot(channel, slot)?;
        let heights = self.values(archive, channel)?;
        let deflections = self.values(archive, DEFLECTION)?;
        if heights.len() != deflections.len() {
            let (heights, deflections) = (heights.len(), deflections.len());
            let what = format!("{heights} heights for {deflections} deflections");
            return Err(broken(self.path, what));
        }
        let step = duration / heights.len() as f64;
        for (index, (raw_height, volts)) in heights.into_iter().zip(deflections).enumerate() {
            let force = force.factor * volts + force.offset;
            let position = -(height.factor * raw_height + height.offset);
            curve.samples.push(Sample {
                approach: position - force / spring,
                force,
            });
            curve.times.push(start + step * index as f64);
        }
        (curve.spring, curve.has_positions) = (Some(spring), true);
        Ok(start + duration)
    }

    /// From volts to newtons, and the spring constant: the call's own calibration, else that of the file.
    fn force(&self, how: &CurveColumns) -> Result<(Line, f64), FitError> {
        let key = |slot: &str| conversion_key(DEFLECTION, slot, "scaling.multiplier");
        let sensitivity = how.sensitivity.map(|factor| Line {
            factor,
            offset: 0.0,
        });
        let to_length = match sensitivity {
            Some(line) => line,
            None => self
                .to_slot(DEFLECTION, "distance")
                .map_err(|_| FitError::NoSensitivity {
                    path: name(self.path),
                })?,
        };
        let spring = how.spring.or_else(|| self.number(&key("force")));
        let spring = spring.filter(|spring| *spring > 0.0);
        let spring = spring.ok_or_else(|| FitError::NoSpring {
            path: name(self.path),
            column: "deflection",
        })?;
        let to_force = Line {
            factor: spring,
            offset: 0.0,
        };
        Ok((to_force.after(to_length), spring))
    }

    /// From the stored unit of a channel to a slot.
    fn to_slot(&self, channel: &str, slot: &str) -> Result<Line, FitError> {
        let base_key = format!("channel.{channel}.conversion-set.conversions.base");
        let base = self
            .text(&base_key)
            .ok_or_else(|| self.missing(&base_key))?;
        let mut found = Line::SAME;
        let mut at = slot;
        for _ in 0..MOST_SLOTS {
            if at == base {
                return Ok(found);
            }
            let number = |what: &str| {
                let key = conversion_key(channel, at, what);
                self.number(&key).ok_or_else(|| self.missing(&key))
            };
            let line = Line {
                factor: number("scaling.multiplier")?,
                offset: number("scaling.offset")?,
            };
            found = found.after(line);
            let key = conversion_key(channel, at, "base-calibration-slot");
            at = self.text(&key).ok_or_else(|| self.missing(&key))?;
        }
        Err(broken(
            self.path,
            format!("the conversions of {channel} have no end"),
        ))
    }

    /// The numbers of a channel in its stored unit, volts.
    fn values(&self, archive: &mut Archive, channel: &str) -> Result<Vec<f64>, FitError> {
        let key = file_key(channel);
        let file = self.text(&key).ok_or_else(|| self.missing(&key))?;
        let bytes = archive.bytes(&format!("{}{file}", self.folder))?;
        let either = |key: &str| {
            let older = format!("channel.{channel}.data.{key}");
            let newer = format!("channel.{channel}.{key}");
            self.text(&older).or(self.text(&newer))
        };
        let kind = either("encoder.type")
            .or(either("type"))
            .unwrap_or_default();
        let scale = |key: &str, usual: f64| {
            let number =
                either(&format!("encoder.scaling.{key}")).and_then(|text| text.parse().ok());
            number
                .filter(|number: &f64| number.is_finite())
                .unwrap_or(usual)
        };
        let (factor, offset) = (scale("multiplier", 1.0), scale("offset", 0.0));
        let values: Vec<f64> = match kind.trim_end_matches("-limited") {
            "signedshort" => numbers(&bytes, |number| i16::from_be_bytes(number).into()),
            "unsignedshort" => numbers(&bytes, |number| u16::from_be_bytes(number).into()),
            "signedinteger" => numbers(&bytes, |number| i32::from_be_bytes(number).into()),
            "unsignedinteger" => numbers(&bytes, |number| u32::from_be_bytes(number).into()),
            "signedlong" => numbers(&bytes, |number| i64::from_be_bytes(number) as f64),
            "float-data" | "float" => numbers(&bytes, |number| f32::from_be_bytes(number).into()),
            "double-data" | "double" => numbers(&bytes, f64::from_be_bytes),
            other => {
                let what = format!("numbers of the unknown type {other:?} in {channel}");
                return Err(broken(self.path, what));
            }
        };
        Ok(values
            .into_iter()
            .map(|value| factor * value + offset)
            .collect())
    }
}

fn file_key(channel: &str) -> String {
    format!("channel.{channel}.data.file.name")
}

fn conversion_key(channel: &str, slot: &str, what: &str) -> String {
    format!("channel.{channel}.conversion-set.conversion.{slot}.{what}")
}

/// Numbers of N bytes each; a rest is left out.
fn numbers<const N: usize>(bytes: &[u8], number: impl Fn([u8; N]) -> f64) -> Vec<f64> {
    let chunks = bytes.chunks_exact(N);
    chunks
        .map(|chunk| {
            let mut bytes = [0; N];
            bytes.copy_from_slice(chunk);
            number(bytes)
        })
        .collect()
}
