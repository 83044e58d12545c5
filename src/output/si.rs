//! Numbers as people write them: three or four digits and a prefix.

/// Prefixes with their powers of ten, rising.
const PREFIXES: [(i32, &str); 10] = [
    (-15, "f"),
    (-12, "p"),
    (-9, "n"),
    (-6, "µ"),
    (-3, "m"),
    (0, ""),
    (3, "k"),
    (6, "M"),
    (9, "G"),
    (12, "T"),
];

/// The factor and the name of a unit that suits a value, such as 1e-6 and "µm".
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ScaledUnit {
    /// SI units in one of these.
    pub factor: f64,
    /// Prefix and unit.
    pub name: String,
}

/// The prefixed `unit` in which `value` lies between 1 and 1000, as far as prefixes reach.
pub(super) fn scaled_unit(value: f64, unit: &str) -> ScaledUnit {
    let digits = if value == 0.0 || !value.is_finite() {
        0
    } else {
        decimal_exponent(value, 4)
    };
    let (power, prefix) = PREFIXES
        .iter()
        .rev()
        .find(|(power, _)| *power <= digits)
        .unwrap_or(&PREFIXES[0]);
    ScaledUnit {
        factor: 10f64.powi(*power),
        name: format!("{prefix}{unit}"),
    }
}

/// A value with its prefixed unit to four significant digits: `1.25e-6` m is "1.25 µm".
pub(super) fn format_si(value: f64, unit: &str) -> String {
    let scaled = scaled_unit(value, unit);
    format!("{} {}", significant(value / scaled.factor, 4), scaled.name)
}

/// `value` to so many significant digits, without zeros at the end; a power of ten where that is shorter.
pub(super) fn significant(value: f64, digits: i32) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{}", value.abs());
    }
    let magnitude = decimal_exponent(value, digits);
    if !(-5..=6).contains(&magnitude) {
        return format!("{value:.*e}", (digits - 1) as usize);
    }
    fixed(value, digits - 1 - magnitude)
}

/// Power of ten of the leading digit once `value` is rounded to so many digits: 999.99996 has 3.
///
/// Read from the formatted number, because a logarithm may fall just short of a whole one.
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
            (1.25e-6, "m", "1.25 µm"),
            (10e6, "Pa", "10 MPa"),
            (-999.99996e-9, "m", "-1 µm"),
            (0.0, "N", "0 N"),
            (-0.0, "N", "0 N"),
            (1.33e12, "Pa", "1.33 TPa"),
            (123_456.0, "Pa", "123.5 kPa"),
            (2.5e-17, "m", "0.025 fm"),
            (1.0, "m", "1 m"),
            (1e-3, "m", "1 mm"),
            (1e-9, "N", "1 nN"),
        ];
        for (value, unit, expected) in cases {
            assert_eq!(format_si(value, unit), expected);
        }
        assert_eq!(significant(3.0e-7, 3), "3.00e-7");
        assert_eq!(fixed(-0.001, 2), "0");
        assert_eq!(fixed(1200.0, -1), "1200");
    }
}
