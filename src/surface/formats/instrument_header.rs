//! Headers of instruments that are text in sections: Nanoscope (images and force curves) and Nanosurf.

use super::bytes::latin_1;
use super::length::length_unit;

/// First bytes of Nanoscope files of images, and of one force curve.
pub(crate) const NANOSCOPE_IMAGES: &[u8] = b"\\*File list";
pub(crate) const NANOSCOPE_FORCE: &[u8] = b"\\*Force file list";
/// End of a Nanoscope header, in lower case.
const NANOSCOPE_END: &str = "\\*file list end";
/// Sections with the sensitivities of Nanoscope.
const SENSITIVITIES: [&str; 2] = ["scanner list", "ciao scan list"];

/// A section: its name, and its keys and values.
pub(crate) struct Section {
    pub name: String,
    entries: Vec<(String, String)>,
}

impl Section {
    /// The value of a key.
    pub fn find(&self, key: &str) -> Option<&str> {
        let entry = self.entries.iter().find(|(name, _)| name == key);
        entry.map(|(_, value)| value.as_str())
    }

    /// All keys with their values, in the order of the file.
    pub fn entries(&self) -> &[(String, String)] {
        &self.entries
    }
}

/// What a line of a header is.
enum Line {
    Heading(String),
    Entry(String, String),
    Other,
}

/// The sections of lines; entries before the first heading belong to none.
fn sections(lines: impl Iterator<Item = Line>) -> Vec<Section> {
    let mut sections: Vec<Section> = Vec::new();
    for line in lines {
        match (line, sections.last_mut()) {
            (Line::Heading(name), _) => sections.push(Section {
                name,
                entries: Vec::new(),
            }),
            (Line::Entry(key, value), Some(section)) => section.entries.push((key, value)),
            _ => {}
        }
    }
    sections
}

/// The lines of a header as text.
fn lines(header: &[u8]) -> impl Iterator<Item = String> {
    header
        .split(|byte| *byte == b'\n')
        .map(|line| latin_1(line.trim_ascii()))
}

/// Sections `[Name]` of entries `key=value`.
pub(crate) fn bracketed_sections(header: &[u8]) -> Vec<Section> {
    sections(lines(header).map(|line| {
        let heading = line
            .strip_prefix('[')
            .and_then(|line| line.strip_suffix(']'));
        match (heading, line.split_once('=')) {
            (Some(name), _) => Line::Heading(name.to_owned()),
            (None, Some((key, value))) => Line::Entry(key.to_owned(), value.to_owned()),
            (None, None) => Line::Other,
        }
    }))
}

/// Sections `\*Name` of entries `\key: value`, names in lower case, up to the end of the header or the first line that does
/// not belong to it.
pub(crate) fn nanoscope_sections(bytes: &[u8]) -> Vec<Section> {
    let lines = lines(bytes)
        .take_while(|line| line.starts_with('\\') && line.to_ascii_lowercase() != NANOSCOPE_END);
    sections(lines.map(|line| {
        let line = &line[1..];
        match (line.strip_prefix('*'), line.split_once(": ")) {
            (Some(name), _) => Line::Heading(name.to_ascii_lowercase()),
            (None, Some((key, value))) => {
                Line::Entry(key.to_ascii_lowercase(), value.trim().to_owned())
            }
            (None, None) => Line::Other,
        }
    }))
}

/// Length of a volt, m/V, by the sensitivity that a scale such as `V [Sens. Zsens] (0.0067 V/LSB) 440 V` names, as in
/// `\@Sens. Zsens: V 20.8 nm/V`. `None` where that is no length.
pub(crate) fn sensitivity(scale: &str, sections: &[Section]) -> Option<f64> {
    let (name, _) = scale.split_once('[')?.1.split_once(']')?;
    let key = format!("@{}", name.to_ascii_lowercase());
    // A later section replaces what an earlier one says.
    let found = sections
        .iter()
        .filter(|section| SENSITIVITIES.contains(&section.name.as_str()))
        .filter_map(|section| section.find(&key))
        .next_back()?;
    let (value, unit) = found.strip_prefix('V')?.trim().split_once(' ')?;
    let (length, per) = unit.split_once('/')?;
    let value: f64 = value.parse().ok()?;
    let length = value * length_unit(length)? / volts(&format!("1 {per}"))?;
    length.is_finite().then_some(length)
}

/// A voltage such as `329.99 mV`, in volts.
pub(crate) fn volts(text: &str) -> Option<f64> {
    let (number, unit) = text.trim().split_once(' ')?;
    let factor = match unit.trim() {
        "V" => 1.0,
        "mV" => 1e-3,
        "uV" | "~V" | "\u{b5}V" => 1e-6,
        _ => return None,
    };
    Some(number.parse::<f64>().ok()? * factor)
}
