//! SI values for people, with a prefix.

use super::{prefix_of, takes_prefix};

/// A value with an engineering prefix and at most four digits: `25 µm`, `1.33 TPa`, `200 mJ/m^2`.
///
/// `unit` is an SI unit without a prefix. Units that take no prefix, such as `m^2` or `K`, and
/// values beyond f and T are written with a power of ten. An empty unit gives a bare number.
pub fn format_si(value: f64, unit: &str) -> String {
    let with_unit = |number: String, prefix: &str| {
        if unit.is_empty() {
            number
        } else {
            format!("{number} {prefix}{unit}")
        }
    };
    if value == 0.0 || !value.is_finite() {
        // Minus zero is shown as zero.
        return with_unit((value + 0.0).to_string(), "");
    }
    // Round to four digits first, so that 999.96 becomes 1 k and not 1000.
    let rounded = format!("{value:.3e}");
    let (mantissa, exponent) = rounded.split_once('e').unwrap_or((&rounded, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let group = exponent.div_euclid(3) * 3;
    if let Some(prefix) = prefix_of(group)
        && takes_prefix(unit)
    {
        with_unit(plain_number(mantissa, exponent - group), &prefix)
    } else if (-3..4).contains(&exponent) {
        with_unit(plain_number(mantissa, exponent), "")
    } else {
        with_unit(format!("{}e{exponent}", trim_zeros(mantissa)), "")
    }
}

/// `mantissa * 10^exponent` of a four-digit mantissa, without an exponent or trailing zeros.
fn plain_number(mantissa: &str, exponent: i32) -> String {
    // The mantissa was written by `format!("{:e}")`, so this parse cannot fail.
    let number: f64 = format!("{mantissa}e{exponent}").parse().unwrap_or(f64::NAN);
    let decimals = usize::try_from(3 - exponent).unwrap_or(0);
    trim_zeros(&format!("{number:.decimals$}")).to_string()
}

fn trim_zeros(number: &str) -> &str {
    if number.contains('.') {
        number.trim_end_matches('0').trim_end_matches('.')
    } else {
        number
    }
}
