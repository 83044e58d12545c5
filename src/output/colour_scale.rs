//! The colour of each value, and the ticks of the colour bar.

use super::palette::{self, Rgb};
use super::si::{decimal_exponent, fixed};
use crate::scene::FieldName;

/// Tension below this share of the largest pressure is rounding and gets no colours of its own.
const NEGLIGIBLE: f64 = 1e-9;

/// Values and their colours, low at the bottom of the bar.
#[derive(Clone, Debug)]
pub struct ColourScale {
    /// Colours from `low` to `high`.
    colours: &'static [Rgb],
    /// Value at the bottom of the bar.
    pub low: f64,
    /// Value at the top.
    pub high: f64,
    /// Whether zero lies in the middle of the bar and each sign has half of it.
    pub two_sided: bool,
}

impl ColourScale {
    /// The scale for the finite `values` of a field.
    ///
    /// Zero pressure always has the neutral colour. If the pressure has both signs, each sign gets
    /// a whole half of the colour map, so that the tension of an adhesive zone is visible beside a
    /// much larger pressure. The other fields run from their least to their greatest value.
    pub fn new(field: FieldName, values: &[f64]) -> ColourScale {
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let greatest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        ColourScale::between(field, [least, greatest])
    }

    /// The same of a field's least and greatest value.
    pub(super) fn between(field: FieldName, [least, greatest]: [f64; 2]) -> ColourScale {
        // Of no values.
        let (least, greatest) = match least <= greatest {
            true => (least, greatest),
            false => (0.0, 0.0),
        };
        if field != FieldName::Pressure {
            return ColourScale {
                colours: palette::rising(),
                low: least,
                high: greatest,
                two_sided: false,
            };
        }
        let compressed = greatest > NEGLIGIBLE * -least;
        let tense = -least > NEGLIGIBLE * greatest;
        let (colours, low, high) = match (tense, compressed) {
            (true, true) => (palette::signed(), least, greatest),
            (true, false) => (palette::tension(), least, 0.0),
            // Zero pressure everywhere is drawn in the neutral colour.
            (false, _) => (palette::compression(), 0.0, greatest.max(0.0)),
        };
        ColourScale {
            colours,
            low,
            high,
            two_sided: tense && compressed,
        }
    }

    /// Position of a value on the bar, from 0 at the bottom to 1 at the top.
    pub fn fraction(&self, value: f64) -> f64 {
        let fraction = if self.two_sided {
            let end = if value < 0.0 { -self.low } else { self.high };
            0.5 + 0.5 * value / end
        } else if self.high > self.low {
            (value - self.low) / (self.high - self.low)
        } else if self.low == 0.0 {
            0.0
        } else {
            0.5
        };
        fraction.clamp(0.0, 1.0)
    }

    /// Value at a position on the bar: the inverse of [`ColourScale::fraction`].
    pub fn value(&self, fraction: f64) -> f64 {
        if !self.two_sided {
            return self.low + fraction * (self.high - self.low);
        }
        let signed = 2.0 * fraction - 1.0;
        signed * if signed < 0.0 { -self.low } else { self.high }
    }

    /// Colour at a position on the bar.
    pub fn colour_at(&self, fraction: f64) -> Rgb {
        let last = self.colours.len() - 1;
        self.colours[(fraction * last as f64).round() as usize]
    }

    /// Colour of a value.
    pub fn colour(&self, value: f64) -> Rgb {
        self.colour_at(self.fraction(value))
    }

    /// Whether all values have one colour, so that the bar has a single label.
    pub fn is_constant(&self) -> bool {
        self.low == self.high
    }

    /// The largest magnitude on the bar, which determines the prefix of its unit.
    pub(super) fn magnitude(&self) -> f64 {
        self.low.abs().max(self.high.abs())
    }

    /// Values to be labelled and their labels in units of `unit`, most important first.
    ///
    /// The ends and a zero between them come first, then round values; the caller omits those
    /// without space.
    pub(super) fn ticks(&self, unit: f64) -> Vec<(f64, String)> {
        if self.is_constant() {
            return vec![(self.low, end_label(self.low / unit, self.low / unit))];
        }
        let (low, high) = (self.low / unit, self.high / unit);
        let mut ticks = Vec::new();
        if self.two_sided {
            ticks.push((self.high, end_label(high, high)));
            ticks.push((self.low, end_label(low, low)));
            ticks.push((0.0, "0".to_owned()));
            ticks.extend(round_values(0.0, high, 3));
            ticks.extend(round_values(low, 0.0, 3));
        } else {
            ticks.push((self.high, end_label(high, high - low)));
            ticks.push((self.low, end_label(low, high - low)));
            ticks.extend(round_values(low, high, 6));
        }
        for tick in &mut ticks[if self.two_sided { 3 } else { 2 }..] {
            tick.0 *= unit;
        }
        ticks
    }
}

/// A value at the end of a range of length `span`, to three digits of that range.
fn end_label(value: f64, span: f64) -> String {
    fixed(value, 2 - decimal_exponent(span, 3))
}

/// Multiples of a round step strictly between `low` and `high`, at most `most` of them, with labels.
pub(crate) fn round_values(low: f64, high: f64, most: usize) -> Vec<(f64, String)> {
    let step = round_up((high - low) / (most + 1) as f64);
    let decimals = -decimal_exponent(step, 1);
    let first = (low / step).floor() as i64;
    (first..=first + most as i64 + 2)
        .map(|multiple| multiple as f64 * step)
        .filter(|value| low < *value && *value < high)
        .map(|value| (value, fixed(value, decimals)))
        .collect()
}

/// The least of 1, 2 or 5 times a power of ten that is not below `value`.
fn round_up(value: f64) -> f64 {
    let candidates = round_numbers(value);
    let found = candidates
        .into_iter()
        .find(|candidate| *candidate >= value * (1.0 - 1e-9));
    found.unwrap_or(candidates[3])
}

/// The greatest of 1, 2 or 5 times a power of ten that is not above `value`.
pub(super) fn round_down(value: f64) -> f64 {
    let candidates = round_numbers(value);
    let found = candidates
        .into_iter()
        .rev()
        .find(|candidate| *candidate <= value * (1.0 + 1e-9));
    found.unwrap_or(candidates[0])
}

/// 1, 2, 5 and 10 times the power of ten at or below `value`.
fn round_numbers(value: f64) -> [f64; 4] {
    let exponent = decimal_exponent(value, 12);
    // Parsed from their decimal form: 5 times 1e-6 is not the double nearest to 5e-6.
    [1, 2, 5, 10].map(|factor| {
        let text = format!("{factor}e{exponent}");
        text.parse().expect("a power of ten is a number")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pressure_of_one_sign_starts_at_the_neutral_colour() {
        let scale = ColourScale::new(FieldName::Pressure, &[2.0, 5.0]);
        assert_eq!((scale.low, scale.high), (0.0, 5.0));
        assert_eq!(scale.colour(0.0), palette::compression()[0]);
        let scale = ColourScale::new(FieldName::Pressure, &[-2.0, -5.0]);
        assert_eq!((scale.low, scale.high), (-5.0, 0.0));
        assert_eq!(scale.colour(0.0), palette::compression()[0]);
        let scale = ColourScale::new(FieldName::Pressure, &[0.0, 0.0]);
        assert!(scale.is_constant());
        assert_eq!(scale.colour(0.0), palette::compression()[0]);
        let scale = ColourScale::new(FieldName::Pressure, &[-1e-12, 3.0]);
        assert_eq!(scale.low, 0.0);
    }

    #[test]
    fn each_sign_has_its_arm_and_zero_the_middle() {
        let scale = ColourScale::new(FieldName::Pressure, &[-1.0, 0.0, 100.0]);
        assert_eq!(scale.colour(0.0), palette::compression()[0]);
        assert_eq!(scale.colour(-1.0), palette::tension()[0]);
        assert_eq!(scale.colour(100.0), *palette::compression().last().unwrap());
        for value in [-1.0, -0.3, 0.0, 7.0, 100.0] {
            assert!((scale.value(scale.fraction(value)) - value).abs() < 1e-12);
        }
    }

    #[test]
    fn constant_fields_have_one_colour_and_one_label() {
        let scale = ColourScale::new(FieldName::Gap, &[3e-9, 3e-9]);
        assert_eq!(scale.fraction(3e-9), 0.5);
        assert_eq!(scale.ticks(1e-9), vec![(3e-9, "3".to_owned())]);
    }

    #[test]
    fn ticks_are_round_and_the_ends_exact() {
        let scale = ColourScale::new(FieldName::Pressure, &[0.0, 12.34e6]);
        let labels: Vec<String> = scale.ticks(1e6).into_iter().map(|tick| tick.1).collect();
        assert_eq!(labels, ["12.3", "0", "2", "4", "6", "8", "10", "12"]);
        let scale = ColourScale::new(FieldName::Pressure, &[-0.0512e9, 12.3e9]);
        let labels: Vec<String> = scale.ticks(1e9).into_iter().map(|tick| tick.1).collect();
        assert_eq!(
            labels,
            ["12.3", "-0.0512", "0", "5", "10", "-0.04", "-0.02"]
        );
        let scale = ColourScale::new(FieldName::Heights, &[1.000_01, 1.000_02]);
        assert_eq!(scale.ticks(1.0)[0].1, "1.00002");
    }

    #[test]
    fn round_lengths_are_the_nearest_decimal_numbers() {
        assert_eq!(round_down(1.3e-6), 1e-6);
        assert_eq!(round_down(4.99e-6), 2e-6);
        assert_eq!(round_down(5.0e-6), 5e-6);
        assert_eq!(round_up(0.21), 0.5);
        assert_eq!(round_up(6.0), 10.0);
    }
}
