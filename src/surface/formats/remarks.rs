//! Lengths that the comments of a text state, in the form of Gwyddion's text export, and the units in the heads of its columns.

use super::length::length_unit;
use crate::units::{Dimension, name_and_unit, parse_quantity, quoted};

/// What comments begin with.
const COMMENT: [char; 5] = ['#', '%', '/', ' ', '\t'];

/// What stands between heads, besides the brackets of their units.
const BETWEEN_HEADS: [char; 5] = [' ', '\t', ',', ';', '"'];

/// Names of heights in the head of a column.
const HEIGHTS: [&str; 8] = [
    "z",
    "h",
    "height",
    "heights",
    "topography",
    "topo",
    "elevation",
    "depth",
];

/// Comments that Gwyddion writes above the numbers.
const GWYDDION_ENTRIES: usize = 4;

/// Words in the names of lengths that are not those of a map's sides.
const OTHER_LENGTHS: [&str; 8] = [
    "offset",
    "origin",
    "position",
    "resolution",
    "spacing",
    "step",
    "pitch",
    "pixel",
];

/// What comments say.
#[derive(Clone, Default)]
pub(super) struct Remarks {
    width: Option<f64>,
    height: Option<f64>,
    /// Metres per unit of the numbers.
    pub unit: Option<f64>,
    /// Their unit, if it is no length.
    other_unit: Option<String>,
    /// Metres per unit of x and y of points with coordinates.
    lateral_unit: Option<f64>,
    /// Whether it is a text of SPIP, whose entries have other names.
    is_spip: bool,
    /// Whether a mask of void pixels follows the numbers.
    pub has_void_pixels: bool,
    /// Of the header line.
    heads: Heads,
    /// Of comments above the numbers, for each number of units the last.
    comments: Vec<Heads>,
    /// The values of the last three comments of the form `name: value`, as a length and as a unit.
    last: [(Option<f64>, Option<f64>); 3],
    /// How many there are.
    entries: usize,
    /// Whether one is named as a distance that is no width or height.
    has_other_lengths: bool,
}

impl Remarks {
    /// Width and height, if both are stated.
    pub fn size(&self) -> Option<[f64; 2]> {
        Some([self.width?, self.height?])
    }

    /// Reads the heads of the columns, `x [um], y [um], z [nm]` or `x/um; y/um; z/nm` or `x_um, y_um, z_nm`.
    pub fn take_heads(&mut self, line: &str) {
        self.heads = Heads::new(line);
        if !line.contains(['[', '(']) {
            self.heads.units = line.split(BETWEEN_HEADS).filter_map(bare_unit).collect();
        }
    }

    /// Reads a comment above the numbers, which may hold these heads: how many columns there are is not known yet.
    pub fn take_comment_above(&mut self, comment: &str) {
        let comment = comment.trim_start_matches(COMMENT).trim_end();
        let heads = Heads::new(comment);
        let count = heads.units.len();
        // Many comments have one unit in brackets, `scan 5 (um)`.
        if count == 0 || (count == 1 && !is_head_of_heights(comment)) {
            return;
        }
        self.comments.retain(|other| other.units.len() != count);
        self.comments.push(heads);
    }

    /// The columns of x, y and z, if the heads of so many columns name x and y, so that the columns hold points.
    pub fn named_points(&self, columns: usize) -> Option<[usize; 3]> {
        self.named_columns(columns, Heads::points)
    }

    /// The columns of the places and the heights of a profile, if the heads of two columns name both.
    pub fn named_profile(&self) -> Option<[usize; 2]> {
        self.named_columns(2, Heads::profile)
    }

    fn named_columns<T>(&self, columns: usize, named: impl Fn(&Heads) -> Option<T>) -> Option<T> {
        let of_columns = || named(self.heads_with_units(columns)?);
        named(&self.heads).or_else(of_columns)
    }

    /// The columns of the numbers of points or a profile behind those of their places.
    fn order(&self, columns: usize) -> [usize; 3] {
        match (columns, self.named_points(columns), self.named_profile()) {
            (2, _, Some([place, height])) => [place, place, height],
            (2, ..) => [0, 0, 1],
            (3.., Some(order), _) => order,
            _ => [0, 1, columns.saturating_sub(1)],
        }
    }

    /// The heads of so many columns, if each has a unit: the header's, or those of a comment.
    fn heads_with_units(&self, columns: usize) -> Option<&Heads> {
        let heads = match self.heads.units.is_empty() {
            true => &self.comments[..],
            false => std::slice::from_ref(&self.heads),
        };
        heads.iter().find(|heads| heads.units.len() == columns)
    }

    /// The units in the heads of so many columns, if each has one.
    fn column_units(&self, columns: usize) -> Option<&[f64]> {
        self.heads_with_units(columns).map(|heads| &heads.units[..])
    }

    /// Metres per unit of the numbers in so many columns; of a profile or points that of the heights.
    pub fn number_unit(&self, columns: usize, has_places: bool) -> Option<f64> {
        let of_heads = self.column_units(columns).and_then(|units| {
            let unit = units[self.order(columns)[2]];
            let is_that = has_places || units.iter().all(|other| *other == unit);
            is_that.then_some(unit)
        });
        self.unit.or(of_heads)
    }

    /// Metres per unit of x and y of a profile or points in so many columns.
    pub fn lateral_units(&self, columns: usize) -> Option<[f64; 2]> {
        let [x, y, _] = self.order(columns);
        let of_heads = match self.column_units(columns) {
            Some(units @ ([_, _] | [_, _, _])) => Some([units[x], units[y]]),
            _ => None,
        };
        self.lateral_unit.map(|unit| [unit; 2]).or(of_heads)
    }

    /// Whether the heads give units of which none is that of the numbers.
    pub fn leaves_units(&self, columns: usize, has_places: bool) -> bool {
        let are_heads = !self.heads.units.is_empty() || self.column_units(columns).is_some();
        are_heads && self.number_unit(columns, has_places).is_none()
    }

    /// A warning where a comment gives the numbers a unit that is not a length.
    pub fn other_unit(&self) -> Option<String> {
        let unit = quoted(self.other_unit.as_deref()?);
        Some(format!(
            "its comments give the unit {unit} of the values, which is not a length: unit says how long one is"
        ))
    }

    /// Reads a comment: `# Width: 5.0 um`, `# Height: 5.0 um`, `# Value units: m`, `# Lateral units: um`.
    pub fn take_comment(&mut self, comment: &str) {
        let comment = comment.trim_start_matches(COMMENT);
        if let Some((name, value)) = comment.split_once('=') {
            self.take_entry_of_spip(name.trim(), value.trim());
        }
        let Some((name, value)) = comment.split_once(':') else {
            return;
        };
        let (length, unit) = (length(value), length_unit(value));
        match name.trim().to_ascii_lowercase().as_str() {
            "width" => self.width = length,
            "height" => self.height = length,
            "value units" => self.take_unit(value),
            "lateral units" => self.lateral_unit = unit,
            _ => {}
        }
        self.last = [self.last[1], self.last[2], (length, unit)];
        self.entries += 1;
        let mut words = name.split(|c: char| !c.is_alphabetic());
        self.has_other_lengths |=
            words.any(|word| OTHER_LENGTHS.contains(&word.to_ascii_lowercase().as_str()));
        self.take_by_order();
    }

    fn take_unit(&mut self, unit: &str) {
        let unit = unit.trim();
        self.unit = length_unit(unit);
        let is_other = self.unit.is_none() && !unit.is_empty();
        self.other_unit = is_other.then(|| unit.to_owned());
    }

    /// Reads a comment of SPIP, or as Gwyddion exports for it: `# x-length = 300`, in nm.
    ///
    /// # Source
    /// Gwyddion, `spip-asc.c`.
    fn take_entry_of_spip(&mut self, name: &str, value: &str) {
        self.is_spip |= (name, value) == ("File Format", "ASCII");
        if !self.is_spip {
            return;
        }
        let nanometres = || length(&format!("{value} nm"));
        match name {
            "x-length" => self.width = nanometres(),
            "y-length" => self.height = nanometres(),
            // The unit counts, where it is given too.
            "Bit2nm" => self.unit = self.unit.or_else(nanometres),
            "z-unit" => self.take_unit(value),
            "voidpixels" => self.has_void_pixels = value.parse() != Ok(0.0),
            _ => {}
        }
    }

    /// Gwyddion writes channel, width, height and unit in this order above all else, with names in the language of its user.
    fn take_by_order(&mut self) {
        let is_known = self.width.is_some() || self.height.is_some();
        if is_known || self.has_other_lengths || self.entries != GWYDDION_ENTRIES {
            return;
        }
        if let [(Some(width), _), (Some(height), _), (_, Some(unit))] = self.last {
            self.width = Some(width);
            self.height = Some(height);
            self.unit = Some(unit);
        }
    }
}

/// What the heads of columns say.
#[derive(Clone, Default)]
struct Heads {
    /// Metres in the units of length.
    units: Vec<f64>,
    /// What the columns hold, where each has one head.
    named: Vec<Option<Named>>,
}

/// What a head names.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Named {
    X,
    Y,
    Heights,
}

impl Heads {
    fn new(line: &str) -> Self {
        Heads {
            units: units(line),
            named: named(line),
        }
    }

    fn column(&self, wanted: Named) -> Option<usize> {
        self.named.iter().position(|named| *named == Some(wanted))
    }

    /// The columns of x, y and what the third is, if x and y are named.
    fn points(&self) -> Option<[usize; 3]> {
        let [x, y] = [self.column(Named::X)?, self.column(Named::Y)?];
        let z = (0..3).find(|column| ![x, y].contains(column))?;
        // Of other names it is not known which words are one head.
        (z == 2 || self.named.len() == 3).then_some([x, y, z])
    }

    /// The columns of places and heights, if a head names the heights, or x and y, which are the heights then.
    fn profile(&self) -> Option<[usize; 2]> {
        let y = || self.column(Named::X).and(self.column(Named::Y));
        let heights = self.column(Named::Heights).or_else(y)?;
        (self.named.len() == 2).then(|| [1 - heights, heights])
    }
}

/// Whether a comment with one unit is the head of a column of heights: the unit stands in square brackets, but not behind a
/// number, `scan 5 [um]`; or in brackets at the end behind a name of heights, `z (nm)`.
fn is_head_of_heights(comment: &str) -> bool {
    let Some(head) = heads(comment).find(|head| unit(head).is_some()) else {
        return false;
    };
    let (name, _) = name_and_unit(head);
    let mut words = name.split(|c: char| !c.is_alphanumeric());
    let names_heights = words.any(|word| HEIGHTS.contains(&word.to_ascii_lowercase().as_str()));
    let is_behind_number = name.ends_with(|c: char| c.is_ascii_digit() || c == '.');
    match head.contains('[') {
        true => names_heights || !is_behind_number,
        false => names_heights && comment.ends_with(head),
    }
}

/// Metres in the units of length of a line of heads.
fn units(line: &str) -> Vec<f64> {
    heads(line).filter_map(unit).collect()
}

/// The heads in a line, each of which ends with its unit in brackets.
fn heads(line: &str) -> impl Iterator<Item = &str> {
    line.split_inclusive([']', ')'])
}

/// Metres in the unit of a head, if it is one of length.
fn unit(head: &str) -> Option<f64> {
    length_unit(name_and_unit(head).1?)
}

/// Metres in the unit behind the last slash or underscore of a head, `Z/\u{b5}m`, if it is one of length.
fn bare_unit(head: &str) -> Option<f64> {
    let (name, unit) = head.trim().rsplit_once(['/', '_'])?;
    let is_name = name.starts_with(char::is_alphabetic);
    length_unit(unit).filter(|_| is_name)
}

/// What the heads in a line name, each by its first word.
fn named(line: &str) -> Vec<Option<Named>> {
    let between: &[char] = match line.contains([',', ';', '\t']) {
        true => &[',', ';', '\t'],
        false => &[' '],
    };
    let heads = line
        .split(between)
        .map(|head| head.trim_matches(BETWEEN_HEADS))
        .filter(|head| !head.is_empty() && !head.starts_with(['[', '(']));
    let named = heads.map(|head| {
        let word = head.split(|c: char| !c.is_alphanumeric()).next()?;
        match word.to_ascii_lowercase().as_str() {
            "x" => Some(Named::X),
            "y" => Some(Named::Y),
            word => HEIGHTS.contains(&word).then_some(Named::Heights),
        }
    });
    named.collect()
}

/// A positive length with its unit, m.
fn length(text: &str) -> Option<f64> {
    let text = text
        .trim()
        .replacen(',', ".", usize::from(!text.contains('.')));
    let text = text.as_str();
    // For supported units this is the double nearest to the digits.
    if let Ok(length) = parse_quantity(text, Dimension::Length) {
        return (length > 0.0).then_some(length);
    }
    let end = text.find(|c: char| !(c.is_ascii_digit() || "+-.eE ".contains(c)))?;
    let (number, name) = text.split_at(end);
    let value: f64 = number.trim().parse().ok()?;
    let metres = value * length_unit(name)?;
    (metres.is_finite() && metres > 0.0).then_some(metres)
}
