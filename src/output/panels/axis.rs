//! Axes of panels: linear or logarithmic, with round ticks in a suitable unit.

use super::super::si::{decimal_exponent, fixed, scaled_unit};

/// Share of the range left empty at either end.
const AIR: f64 = 0.04;
/// Most decades of a logarithmic axis below its greatest value.
const DECADES: f64 = 8.0;
/// Least step of a linear axis, as a share of its range.
const STEP: f64 = 0.19;

/// Definition of an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The quantity.
    pub name: String,
    /// Its SI unit; empty for a number without one.
    pub unit: String,
    /// Logarithmic.
    pub logarithmic: bool,
}

/// An axis fitted to its values.
pub(super) struct Scale {
    name: String,
    unit: String,
    logarithmic: bool,
    /// SI units in one of the labels'.
    factor: f64,
    low: f64,
    high: f64,
}

impl Scale {
    pub fn new(axis: &Axis, values: &[f64]) -> Scale {
        let fits = |value: &f64| value.is_finite() && (!axis.logarithmic || *value > 0.0);
        let (mut low, mut high) = values
            .iter()
            .copied()
            .filter(fits)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                (low.min(value), high.max(value))
            });
        if low > high {
            (low, high) = if axis.logarithmic {
                (0.1, 1.0)
            } else {
                (0.0, 1.0)
            };
        }
        let scaled = scaled_unit(low.abs().max(high.abs()), &axis.unit);
        let (factor, unit) = if axis.unit.is_empty() {
            (1.0, String::new())
        } else {
            (scaled.factor, scaled.name)
        };
        if axis.logarithmic {
            low = low.max(high * 10f64.powf(-DECADES)).log10();
            high = high.log10();
        }
        if high - low <= 1e-9 * (low.abs() + high.abs()) {
            let room = if axis.logarithmic {
                0.5
            } else {
                0.5 * high.abs() + f64::MIN_POSITIVE
            };
            low -= room;
            high += room;
        }
        let air = AIR * (high - low);
        Scale {
            name: axis.name.clone(),
            unit,
            logarithmic: axis.logarithmic,
            factor,
            low: low - air,
            high: high + air,
        }
    }

    /// As in "load (MPa)".
    pub fn label(&self) -> String {
        if self.unit.is_empty() {
            self.name.clone()
        } else {
            format!("{} ({})", self.name, self.unit)
        }
    }

    /// The unit of the labels.
    pub fn unit(&self) -> &str {
        &self.unit
    }

    /// Position of a value between 0 and 1; `None` if it cannot be shown.
    pub fn share(&self, value: f64) -> Option<f64> {
        let place = if self.logarithmic {
            value.log10()
        } else {
            value
        };
        let share = (place - self.low) / (self.high - self.low);
        (0.0..=1.0).contains(&share).then_some(share)
    }

    /// Round values by position, with labels.
    pub fn ticks(&self) -> Vec<(f64, String)> {
        let mut ticks = if self.logarithmic {
            self.decades()
        } else {
            self.steps()
        };
        ticks.retain(|(share, _)| (0.0..=1.0).contains(share));
        ticks
    }

    fn decades(&self) -> Vec<(f64, String)> {
        let unit = self.factor.log10();
        let (first, last) = (
            (self.low - unit).floor() as i32,
            (self.high - unit).ceil() as i32,
        );
        let span = self.high - self.low;
        // Over few decades also 2 and 5 times the powers of ten; over many only every other power.
        let multiples: &[f64] = match span {
            span if span < 2.2 => &[1.0, 2.0, 5.0],
            _ => &[1.0],
        };
        let stride = if span > 6.0 { 2 } else { 1 };
        (first..=last)
            .filter(|decade| decade.rem_euclid(stride) == 0)
            .flat_map(|decade| multiples.iter().map(move |multiple| (decade, *multiple)))
            .map(|(decade, multiple)| {
                let value = multiple * 10f64.powi(decade);
                let label = if (-3..5).contains(&decade) {
                    fixed(value, -decade.min(0))
                } else {
                    format!("{multiple}e{decade}")
                };
                let place = value.log10() + unit;
                ((place - self.low) / (self.high - self.low), label)
            })
            .collect()
    }

    fn steps(&self) -> Vec<(f64, String)> {
        let (low, high) = (self.low / self.factor, self.high / self.factor);
        let least = STEP * (high - low);
        let decade = decimal_exponent(least, 3);
        let (step, decimals) = [1.0, 2.0, 5.0, 10.0]
            .iter()
            .map(|multiple| multiple * 10f64.powi(decade))
            .find(|step| *step >= least * (1.0 - 1e-9))
            .map_or((least, 3 - decade), |step| {
                (step, -decimal_exponent(step, 3))
            });
        let (first, last) = ((low / step).ceil() as i64, (high / step).floor() as i64);
        (first..=last)
            .map(|index| {
                let value = index as f64 * step;
                ((value - low) / (high - low), fixed(value, decimals.max(0)))
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scale(logarithmic: bool, values: &[f64]) -> Scale {
        let axis = Axis {
            name: "load".into(),
            unit: "Pa".into(),
            logarithmic,
        };
        Scale::new(&axis, values)
    }

    #[test]
    fn ticks_are_round_in_the_unit_of_the_labels() {
        let linear = scale(false, &[0.0, 4.3e6]);
        assert_eq!(linear.label(), "load (MPa)");
        let labels: Vec<String> = linear.ticks().into_iter().map(|tick| tick.1).collect();
        assert_eq!(labels, ["0", "1", "2", "3", "4"]);
        let decades = scale(true, &[1e3, 2e6, f64::NAN, -1.0]);
        let labels: Vec<String> = decades.ticks().into_iter().map(|tick| tick.1).collect();
        assert_eq!(labels, ["0.001", "0.01", "0.1", "1"]);
        assert!(decades.share(0.0).is_none() && decades.share(2e6).is_some());
        let one = scale(false, &[3e6]);
        assert_eq!(one.share(3e6), Some(0.5));
        assert!(!scale(true, &[]).ticks().is_empty());
    }
}
