//! Axes: linear or logarithmic, with round ticks in a suitable unit.

use super::super::colour_scale::round_values;
use super::super::si::{fixed, scaled_unit};
use super::drawing::Ink;

/// Share of the range left empty at either end.
const AIR: f64 = 0.04;
/// Most decades of a logarithmic axis below its greatest value: lower values are rounding.
const DECADES: f64 = 16.0;
/// Decades up to which 2 and 5 times the powers of ten have labels, and above which not every power has.
const FEW: f64 = 2.2;
const MANY: f64 = 6.0;
/// The unit of a share: its axis begins at zero.
const PER_CENT: &str = "%";

/// Definition of an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The quantity.
    pub name: String,
    /// Its SI unit; empty for a number without one, `%` for a share that is shown in per cent.
    pub unit: String,
    /// Logarithmic.
    pub logarithmic: bool,
}

impl Axis {
    /// A linear axis.
    pub fn linear(name: &str, unit: &str) -> Axis {
        Axis {
            name: name.to_owned(),
            unit: unit.to_owned(),
            logarithmic: false,
        }
    }

    /// A logarithmic axis.
    pub fn logarithmic(name: &str, unit: &str) -> Axis {
        Axis {
            logarithmic: true,
            ..Axis::linear(name, unit)
        }
    }
}

/// A round value on an axis.
pub(super) struct Tick {
    /// Position from 0 to 1.
    pub share: f64,
    pub label: String,
}

impl Tick {
    /// The ink of its line: that of zero is darker.
    pub fn ink(&self) -> Ink {
        if self.label == "0" {
            Ink::Zero
        } else {
            Ink::Grid
        }
    }
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
    pub fn new(axis: &Axis, values: impl Iterator<Item = f64>) -> Scale {
        let logarithmic = axis.logarithmic;
        let is_share = axis.unit == PER_CENT;
        let fits = |value: &f64| value.is_finite() && (!logarithmic || *value > 0.0);
        let (mut low, mut high) = values
            .filter(fits)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                (low.min(value), high.max(value))
            });
        if low > high {
            (low, high) = (if logarithmic { 0.1 } else { 0.0 }, 1.0);
        }
        if is_share {
            low = low.min(0.0);
        }
        let (factor, unit) = match axis.unit.as_str() {
            "" => (1.0, String::new()),
            PER_CENT => (0.01, PER_CENT.to_owned()),
            unit => {
                let scaled = scaled_unit(low.abs().max(high.abs()), unit);
                (scaled.factor, scaled.name)
            }
        };
        if logarithmic {
            low = low.max(high * 10f64.powf(-DECADES)).log10();
            high = high.log10();
        }
        // A single value still has a range.
        if high - low <= 1e-9 * (low.abs() + high.abs()) {
            let room = match high {
                _ if logarithmic => 0.5,
                0.0 => 1.0,
                high => 0.5 * high.abs(),
            };
            high += room;
            low -= if is_share { 0.0 } else { room };
        }
        let air = AIR * (high - low);
        Scale {
            name: axis.name.clone(),
            unit,
            logarithmic,
            factor,
            low: if is_share && low == 0.0 {
                low
            } else {
                low - air
            },
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

    /// Round values in the unit of the labels: on a linear axis at most `most`.
    pub fn ticks(&self, most: usize) -> Vec<Tick> {
        let values = if self.logarithmic {
            self.decades()
        } else {
            let (low, high) = (self.low / self.factor, self.high / self.factor);
            // A tick exactly at the end of the axis is kept.
            let hair = 1e-9 * (high - low);
            round_values(low - hair, high + hair, most)
        };
        values
            .into_iter()
            .filter_map(|(value, label)| {
                let share = self.share(value * self.factor)?;
                Some(Tick { share, label })
            })
            .collect()
    }

    fn decades(&self) -> Vec<(f64, String)> {
        let unit = self.factor.log10();
        let first = (self.low - unit).floor() as i32;
        let last = (self.high - unit).ceil() as i32;
        let span = self.high - self.low;
        let multiples: &[f64] = if span < FEW { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let stride = (span / MANY).ceil().max(1.0) as i32;
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
                (value, label)
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scale(name: &str, unit: &str, logarithmic: bool, values: &[f64]) -> Scale {
        let axis = Axis {
            logarithmic,
            ..Axis::linear(name, unit)
        };
        Scale::new(&axis, values.iter().copied())
    }

    fn labels(scale: &Scale, most: usize) -> Vec<String> {
        let ticks = scale.ticks(most).into_iter();
        ticks.map(|tick| tick.label).collect()
    }

    #[test]
    fn ticks_are_round_in_the_unit_of_the_labels() {
        let linear = scale("load", "Pa", false, &[0.0, 4.3e6]);
        assert_eq!(linear.label(), "load (MPa)");
        assert_eq!(labels(&linear, 4), ["0", "1", "2", "3", "4"]);
        let decades = scale("load", "Pa", true, &[1e3, 2e6, f64::NAN, -1.0]);
        assert_eq!(labels(&decades, 4), ["0.001", "0.01", "0.1", "1"]);
        assert!(decades.share(0.0).is_none() && decades.share(2e6).is_some());
        let one = scale("load", "Pa", false, &[3e6]);
        assert_eq!(one.share(3e6), Some(0.5));
        assert!(!scale("load", "Pa", true, &[]).ticks(4).is_empty());
        let approach = scale("approach", "m", false, &[-320e-9, 160e-9]);
        assert_eq!(approach.label(), "approach (nm)");
        assert_eq!(labels(&approach, 6), ["-300", "-200", "-100", "0", "100"]);
        let first = approach.ticks(6)[0].share;
        assert!((first - approach.share(-300e-9).expect("on the axis")).abs() < 1e-12);
    }

    #[test]
    fn shares_begin_at_zero_and_lone_values_have_room() {
        let area = scale("contact area", "%", false, &[0.25, 0.5]);
        assert_eq!(area.label(), "contact area (%)");
        assert_eq!(area.share(0.0), Some(0.0));
        assert_eq!(labels(&area, 6)[0], "0");
        assert!(scale("force", "N", false, &[]).share(0.0).is_some());
        let one = scale("force", "N", false, &[5e-6]);
        assert!((one.share(5e-6).expect("on the axis") - 0.5).abs() < 1e-12);
        assert!(!one.ticks(6).is_empty());
        assert_eq!(scale("force", "N", false, &[0.0]).share(0.0), Some(0.5));
    }

    #[test]
    fn points_lie_where_their_logarithms_say() {
        let axis = scale("density", "", true, &[1e-30, 1e-32, 1e-34]);
        let [low, middle, high] = [1e-34, 1e-32, 1e-30].map(|value| axis.share(value));
        let (low, high) = (low.expect("on the axis"), high.expect("on the axis"));
        assert!((middle.expect("on the axis") - 0.5 * (low + high)).abs() < 1e-12);
        assert_eq!(
            labels(&axis, 4),
            ["1e-34", "1e-33", "1e-32", "1e-31", "1e-30"]
        );
    }
}
