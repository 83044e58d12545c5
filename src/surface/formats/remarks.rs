//! Lengths that the comments of a text state, in the form of Gwyddion's text export.

use super::length::length_unit;
use crate::units::{Dimension, parse_quantity};

/// What comments say.
#[derive(Clone, Copy, Default)]
pub(super) struct Remarks {
    width: Option<f64>,
    height: Option<f64>,
    /// Metres per unit of the numbers.
    pub unit: Option<f64>,
    /// Metres per unit of x and y of points with coordinates.
    pub lateral_unit: Option<f64>,
    /// The values of the last three comments of the form `name: value`, as a length and as a unit.
    last: [(Option<f64>, Option<f64>); 3],
}

impl Remarks {
    /// Width and height, if both are stated.
    pub fn size(&self) -> Option<[f64; 2]> {
        Some([self.width?, self.height?])
    }

    /// Reads a comment: `# Width: 5.0 um`, `# Height: 5.0 um`, `# Value units: m`, `# Lateral units: um`.
    pub fn take_comment(&mut self, comment: &str) {
        let comment = comment.trim_start_matches(['#', '%', '/', ' ']);
        let Some((name, value)) = comment.split_once(':') else {
            return;
        };
        let (length, unit) = (length(value), length_unit(value));
        match name.trim().to_ascii_lowercase().as_str() {
            "width" => self.width = length,
            "height" => self.height = length,
            "value units" => self.unit = unit,
            "lateral units" => self.lateral_unit = unit,
            _ => {}
        }
        self.last = [self.last[1], self.last[2], (length, unit)];
        self.take_by_order();
    }

    /// Gwyddion writes width, height and unit in this order, with names in the language of its user.
    fn take_by_order(&mut self) {
        if self.width.is_some() || self.height.is_some() {
            return;
        }
        if let [(Some(width), _), (Some(height), _), (_, Some(unit))] = self.last {
            self.width = Some(width);
            self.height = Some(height);
            self.unit = Some(unit);
        }
    }
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
