//! Prefixed units of axes, and the digits of their ticks.

use crate::units::{prefix_of, takes_prefix};

/// A prefixed unit, such as "µm", with its factor 1e-6.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ScaledUnit {
    /// SI units in one of these.
    pub factor: f64,
    /// Prefix and unit.
    pub name: String,
}

/// The prefixed `unit` in which `value` lies between 1 and 1000. A unit that takes no prefix, such as m^3/m, has a power
/// of ten before it, and so has a power without a prefix.
pub(crate) fn scaled_unit(value: f64, unit: &str) -> ScaledUnit {
    let digits = if value == 0.0 || !value.is_finite() {
        0
    } else {
        decimal_exponent(value, 4)
    };
    let power = digits.div_euclid(3) * 3;
    let prefix = prefix_of(power).filter(|_| unit.is_empty() || takes_prefix(unit));
    let name = match prefix {
        Some(prefix) => format!("{prefix}{unit}"),
        None if power == 0 => unit.to_owned(),
        None => format!("1e{power} {unit}").trim_end().to_owned(),
    };
    ScaledUnit {
        factor: 10f64.powi(power),
        name,
    }
}

/// Power of ten of the leading digit of `value` rounded to this many digits: 999.99996 has 3.
///
/// Read from the formatted number, because a logarithm may fall just short of a whole number.
pub(super) fn decimal_exponent(value: f64, digits: i32) -> i32 {
    let text = format!("{:.*e}", (digits - 1).max(0) as usize, value);
    text.split_once('e')
        .and_then(|(_, exponent)| exponent.parse().ok())
        .unwrap_or(0)
}

/// `value` to so many decimals, without zeros at the end.
pub(super) fn fixed(value: f64, decimals: i32) -> String {
    let mut text = format!("{value:.*}", decimals.clamp(0, 12) as usize);
    if text.contains('.') {
        let trimmed = text.trim_end_matches('0').trim_end_matches('.').len();
        text.truncate(trimmed);
    }
    if text == "-0" { "0".to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prefixes_keep_numbers_short() {
        let cases = [
            (1.25e-6, "µm", 1e-6),
            (10e6, "MPa", 1e6),
            (-999.99996e-9, "µm", 1e-6),
            (0.0, "Pa", 1.0),
            (2.5e-17, "am", 1e-18),
            (4.1e-26, "1e-27 m", 1e-27),
            (4.1e17, "1e15 Pa", 1e15),
            (1e-3, "mm", 1e-3),
            // A prefix would be cubed.
            (3e-15, "1e-15 m^3/(s Pa)", 1e-15),
            (3.0, "m^3/(s Pa)", 1.0),
        ];
        for (value, name, factor) in cases {
            let unit = match name {
                _ if name.contains('^') => "m^3/(s Pa)",
                _ if name.ends_with('m') => "m",
                _ => "Pa",
            };
            let scaled = scaled_unit(value, unit);
            assert_eq!(scaled.name, name);
            assert!((scaled.factor / factor - 1.0).abs() < 1e-12);
        }
        assert_eq!(fixed(-0.001, 2), "0");
        assert_eq!(fixed(1200.0, -1), "1200");
    }
}
