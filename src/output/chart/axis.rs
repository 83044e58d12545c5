//! An axis: its range, its unit, its ticks.

use super::super::colour_scale::round_values;
use super::super::si::scaled_unit;

/// Share of the range left empty at either end.
const MARGIN: f64 = 0.05;

/// One axis of a chart.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Axis {
    name: &'static str,
    unit: String,
    /// SI units in one of the axis.
    factor: f64,
    low: f64,
    high: f64,
}

impl Axis {
    /// An axis for `values` in SI units. Fractions are shown in per cent and begin at zero.
    pub fn new(name: &'static str, unit: &str, values: impl Iterator<Item = f64>) -> Axis {
        let is_share = unit.is_empty();
        let (mut low, mut high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
            (l.min(v), h.max(v))
        });
        if low > high {
            (low, high) = (0.0, 0.0);
        }
        if is_share {
            low = 0.0;
        }
        // A single value still gets a range.
        if low == high {
            let room = if low == 0.0 { 1.0 } else { 0.5 * low.abs() };
            high += room;
            low -= if is_share { 0.0 } else { room };
        }
        let (factor, unit) = if is_share {
            (0.01, "%".to_owned())
        } else {
            let scaled = scaled_unit(low.abs().max(high.abs()), unit);
            (scaled.factor, scaled.name)
        };
        let room = MARGIN * (high - low);
        Axis {
            name,
            unit,
            factor,
            low: if is_share { low } else { low - room },
            high: high + room,
        }
    }

    /// As in "approach (nm)".
    pub fn label(&self) -> String {
        format!("{} ({})", self.name, self.unit)
    }

    /// Position of a value, from 0 at the low end to 1 at the high one.
    pub fn share(&self, value: f64) -> f64 {
        (value - self.low) / (self.high - self.low)
    }

    /// Round values, SI, with their labels in the axis' unit.
    pub fn ticks(&self, most: usize) -> Vec<(f64, String)> {
        let (low, high) = (self.low / self.factor, self.high / self.factor);
        // A tick exactly at the end of the axis is kept.
        let hair = 1e-9 * (high - low);
        round_values(low - hair, high + hair, most)
            .into_iter()
            .map(|(value, label)| (value * self.factor, label))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_in_the_unit_of_the_axis() {
        let axis = Axis::new("approach", "m", [-320e-9, 160e-9].into_iter());
        assert_eq!(axis.label(), "approach (nm)");
        let ticks = axis.ticks(6);
        let labels: Vec<&str> = ticks.iter().map(|tick| tick.1.as_str()).collect();
        assert_eq!(labels, ["-300", "-200", "-100", "0", "100"]);
        assert!((ticks[0].0 + 300e-9).abs() < 1e-20);
        assert!((axis.share(-320e-9) - 0.05 / 1.1).abs() < 1e-12);
    }

    #[test]
    fn shares_begin_at_zero_and_lone_values_have_room() {
        let axis = Axis::new("contact area", "", [0.25, 0.5].into_iter());
        assert_eq!(axis.label(), "contact area (%)");
        assert_eq!(axis.share(0.0), 0.0);
        assert_eq!(axis.ticks(6)[0], (0.0, "0".to_owned()));
        let mut none = Axis::new("force", "N", std::iter::empty());
        assert!(none.share(0.0).is_finite());
        none = Axis::new("force", "N", [5e-6].into_iter());
        assert!((none.share(5e-6) - 0.5).abs() < 1e-12);
        assert!(!none.ticks(6).is_empty());
    }
}
