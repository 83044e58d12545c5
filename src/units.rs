//! Dimensional values: reads text with a unit into SI, and formats SI values for people.
//!
//! The only place that knows unit names. A scene has `25e-6` or `"25 um"`; the header of a force
//! curve has `[nN]`; messages and pictures show `25 µm`.
//!
//! ```
//! use tabor::units::{Dimension, format_si, parse_quantity};
//!
//! assert_eq!(parse_quantity("25 um", Dimension::Length), Ok(25e-6));
//! assert_eq!(format_si(1.33e12, "Pa"), "1.33 TPa");
//! assert!(parse_quantity("25 nN", Dimension::Length).is_err());
//! ```

use std::fmt;

use thiserror::Error;

/// Declares the dimensions, each with its SI unit, words for messages, and an example value.
macro_rules! dimensions {
    ($( $(#[$doc:meta])* $Name:ident: $unit:literal, $words:literal, $example:literal; )+) => {
        /// The dimension of a value, which determines its units.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Dimension {
            $( $(#[$doc])* $Name, )+
        }

        impl Dimension {
            /// The SI unit in messages; empty for a pure number.
            pub fn unit(self) -> &'static str {
                match self { $( Dimension::$Name => $unit, )+ }
            }

            /// The dimension with its units, for messages: `a length in m`.
            pub fn words(self) -> &'static str {
                match self { $( Dimension::$Name => $words, )+ }
            }

            /// An example value for messages.
            pub fn example(self) -> &'static str {
                match self { $( Dimension::$Name => $example, )+ }
            }
        }
    };
}

dimensions! {
    /// A pure number, without a unit.
    Dimensionless: "", "a number without a unit", "0.5";
    /// m.
    Length: "m", "a length in m", "\"25 um\"";
    /// Pa.
    Pressure: "Pa", "a pressure in Pa", "\"1.5 GPa\"";
    /// N.
    Force: "N", "a force in N", "\"20 nN\"";
    /// J.
    Energy: "J", "an energy in J", "\"1 fJ\"";
    /// J/m^2, which is N/m: the same dimension as [`Dimension::ForcePerLength`].
    EnergyPerArea: "J/m^2", "an energy per area in J/m^2 or N/m", "\"50 mJ/m^2\"";
    /// N/m, which is J/m^2: the same dimension as [`Dimension::EnergyPerArea`].
    ForcePerLength: "N/m", "a force per length in N/m or J/m^2", "\"0.2 N/m\"";
    /// s, or min.
    Time: "s", "a time in s or min", "\"10 ms\"";
    /// Hz.
    Frequency: "Hz", "a frequency in Hz", "\"5 kHz\"";
    /// K.
    Temperature: "K", "a temperature in K", "\"298.15 K\"";
    /// m^3/mol.
    MolarVolume: "m^3/mol", "a molar volume in m^3/mol", "\"18 cm^3/mol\"";
    /// m/s.
    Speed: "m/s", "a speed in m/s", "\"1 um/s\"";
    /// W/(m K), or S/m.
    Conductivity: "W/(m K)", "a conductivity in W/(m K) or S/m", "\"400 W/(m K)\"";
    /// m^3/(N m), which is 1/Pa: the volume worn off per load and length of sliding.
    SpecificWear: "m^3/(N m)", "a specific wear rate in m^3/(N m) or 1/Pa", "\"1e-6 mm^3/(N m)\"";
    /// Pa s.
    Viscosity: "Pa s", "a viscosity in Pa s", "\"1 mPa s\"";
    /// 1/m: a curvature, a wave number.
    PerLength: "1/m", "a reciprocal length in 1/m", "\"0.1 1/um\"";
    /// 1/m^2: a count per area.
    PerArea: "1/m^2", "a count per area in 1/m^2", "\"10 1/um^2\"";
    /// V.
    Voltage: "V", "a voltage in V", "\"0.5 V\"";
    /// m/V.
    LengthPerVoltage: "m/V", "a length per voltage in m/V", "\"50 nm/V\"";
    /// rad or deg; the SI value is in radians, but see [`angle_from_number`].
    Angle: "rad", "an angle in deg or rad", "\"70 deg\"";
}

impl Dimension {
    /// The unit of a bare number in a scene: degrees for an angle, SI for all else.
    #[cfg(feature = "cli")]
    pub(crate) fn unit_in_scenes(self) -> &'static str {
        if self == Dimension::Angle {
            "deg"
        } else {
            self.unit()
        }
    }

    /// Whether values of the two dimensions are interchangeable.
    pub fn is_same_as(self, other: Dimension) -> bool {
        let canonical = |dimension| match dimension {
            Dimension::ForcePerLength => Dimension::EnergyPerArea,
            _ => dimension,
        };
        canonical(self) == canonical(other)
    }
}

impl fmt::Display for Dimension {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.words())
    }
}

/// Why a text is not a value of the required dimension.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum UnitError {
    /// The text does not begin with a number.
    #[error("{text} does not begin with a number; give {expected}, such as {}", expected.example())]
    NoNumber {
        /// The text, quoted.
        text: String,
        /// What was expected.
        expected: Dimension,
    },
    /// A decimal comma.
    #[error("{text} has a decimal comma; write a point, as in {}", expected.example())]
    DecimalComma {
        /// The text, quoted.
        text: String,
        /// What was expected.
        expected: Dimension,
    },
    /// A number without a unit.
    #[error(
        "{text} has no unit; give {expected}, such as {}, or a bare number in {}",
        expected.example(),
        bare_unit(*expected)
    )]
    NoUnit {
        /// The text, quoted.
        text: String,
        /// What was expected.
        expected: Dimension,
    },
    /// An unknown unit.
    #[error("{unit} is not a unit that is known here; give {expected}, such as {}", expected.example())]
    UnknownUnit {
        /// The unit, quoted.
        unit: String,
        /// What was expected.
        expected: Dimension,
    },
    /// A unit of another dimension.
    #[error("{unit} is {found}; give {expected}, such as {}", expected.example())]
    WrongUnit {
        /// The unit, quoted.
        unit: String,
        /// What the unit measures.
        found: Dimension,
        /// What was expected.
        expected: Dimension,
    },
    /// What is no share from 0 to 1.
    #[error("{text} must be a share, such as 0.1 or 10%")]
    NoShare {
        /// The text, quoted.
        text: String,
    },
    /// A value too large for a 64-bit number.
    #[error("{text} is too large; give {expected}, such as {}", expected.example())]
    NotFinite {
        /// The text, quoted.
        text: String,
        /// What was expected.
        expected: Dimension,
    },
}

/// The unit of a number written without one.
fn bare_unit(dimension: Dimension) -> &'static str {
    match dimension {
        Dimension::Angle => "degrees",
        _ => dimension.unit(),
    }
}

/// Least and largest magnitude of a nonzero number in SI units: far beyond any contact problem, and
/// such that products of several of them do not overflow. Scenes, files and the command line use
/// it.
const RANGE: [f64; 2] = [1e-30, 1e30];
/// The larger of the two.
pub(crate) const LARGEST: f64 = RANGE[1];
/// [`RANGE`] in words.
pub(crate) const RANGE_WORDS: &str =
    "0 or between 1e-30 and 1e30 in SI units; check the powers of ten";

/// Whether a number has a magnitude that one can compute with.
pub(crate) fn in_range(value: f64) -> bool {
    value == 0.0 || (RANGE[0]..=RANGE[1]).contains(&value.abs())
}

/// Text in quotes for a message: one line, cut to a readable length.
pub(crate) fn quoted(text: &str) -> String {
    const LONGEST: usize = 60;
    if text.chars().count() > LONGEST {
        let start: String = text.chars().take(LONGEST).collect();
        format!("{:?}...", start)
    } else {
        format!("{text:?}")
    }
}

/// A sentence from elsewhere for a message, cut to a readable length.
pub(crate) fn cut(text: &str) -> String {
    const LONGEST: usize = 200;
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.to_owned(),
    }
}

/// The relation of a unit to SI: a power of ten, kept separately so that `25 um` is exactly
/// `25e-6`, and a factor for the few units that are not powers of ten.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Unit {
    power: i32,
    factor: f64,
    dimension: Dimension,
}

impl Unit {
    fn new(dimension: Dimension, power: i32, factor: f64) -> Self {
        Unit {
            power,
            factor,
            dimension,
        }
    }
}

/// Units that take a prefix on their first letter.
const PREFIXED: &[(&str, Dimension)] = &[
    ("m", Dimension::Length),
    ("Pa", Dimension::Pressure),
    ("N", Dimension::Force),
    ("J", Dimension::Energy),
    ("s", Dimension::Time),
    ("Hz", Dimension::Frequency),
    ("N/m", Dimension::ForcePerLength),
    ("J/m^2", Dimension::EnergyPerArea),
    ("J/m²", Dimension::EnergyPerArea),
    ("m/s", Dimension::Speed),
    ("V", Dimension::Voltage),
    ("m/V", Dimension::LengthPerVoltage),
    ("Pa s", Dimension::Viscosity),
    ("W/(m K)", Dimension::Conductivity),
    ("W/m/K", Dimension::Conductivity),
    ("S/m", Dimension::Conductivity),
];

/// Units of results that are shown with a prefix and never read.
const SHOWN: [&str; 3] = ["W/K", "S", "ohm"];

/// Units without prefixes, with their size in SI: a power of ten and a factor.
const PLAIN: &[(&str, Dimension, i32, f64)] = &[
    ("min", Dimension::Time, 0, 60.0),
    ("K", Dimension::Temperature, 0, 1.0),
    ("m^3/mol", Dimension::MolarVolume, 0, 1.0),
    ("m³/mol", Dimension::MolarVolume, 0, 1.0),
    ("cm^3/mol", Dimension::MolarVolume, -6, 1.0),
    ("cm³/mol", Dimension::MolarVolume, -6, 1.0),
    ("m^3/(N m)", Dimension::SpecificWear, 0, 1.0),
    ("m³/(N m)", Dimension::SpecificWear, 0, 1.0),
    ("mm^3/(N m)", Dimension::SpecificWear, -9, 1.0),
    ("mm³/(N m)", Dimension::SpecificWear, -9, 1.0),
    ("1/Pa", Dimension::SpecificWear, 0, 1.0),
    ("deg", Dimension::Angle, 0, std::f64::consts::PI / 180.0),
    ("°", Dimension::Angle, 0, std::f64::consts::PI / 180.0),
    ("rad", Dimension::Angle, 0, 1.0),
];

/// Prefixes with their powers of ten, the one that is written first; both code points of the Greek letter
/// are in use.
const PREFIXES: &[(char, i32)] = &[
    ('z', -21),
    ('a', -18),
    ('f', -15),
    ('p', -12),
    ('n', -9),
    ('\u{b5}', -6),
    ('u', -6),
    ('\u{3bc}', -6),
    ('m', -3),
    ('k', 3),
    ('M', 6),
    ('G', 9),
    ('T', 12),
];

fn find_unit(name: &str) -> Option<Unit> {
    if let Some(&(_, dimension, power, factor)) = PLAIN.iter().find(|(plain, ..)| *plain == name) {
        return Some(Unit::new(dimension, power, factor));
    }
    let prefixed = |name: &str, power| {
        let known = PREFIXED.iter().find(|(unit, _)| *unit == name);
        known.map(|&(_, dimension)| Unit::new(dimension, power, 1.0))
    };
    let whole = |name: &str| {
        prefixed(name, 0).or_else(|| {
            let first = name.chars().next()?;
            let &(_, power) = PREFIXES.iter().find(|(prefix, _)| *prefix == first)?;
            prefixed(&name[first.len_utf8()..], power)
        })
    };
    whole(name).or_else(|| {
        // "1/um", or "/um" right behind the number, and their squares.
        let below = name.strip_prefix("1/").or_else(|| name.strip_prefix('/'))?;
        let square = below.strip_suffix("^2").or_else(|| below.strip_suffix('²'));
        let length =
            whole(square.unwrap_or(below)).filter(|unit| unit.dimension == Dimension::Length)?;
        let (times, dimension) = match square {
            Some(_) => (2, Dimension::PerArea),
            None => (1, Dimension::PerLength),
        };
        Some(Unit::new(dimension, -times * length.power, 1.0))
    })
}

fn expect_unit(name: &str, expected: Dimension) -> Result<Unit, UnitError> {
    // "J / m^2" is the same unit; other spaces are not accepted, or "m m" would be a millimetre.
    let tight = name.split('/').map(str::trim).collect::<Vec<_>>().join("/");
    let unit = find_unit(&tight).ok_or_else(|| UnitError::UnknownUnit {
        unit: quoted(name),
        expected,
    })?;
    if unit.dimension.is_same_as(expected) {
        Ok(unit)
    } else {
        Err(UnitError::WrongUnit {
            unit: quoted(name),
            found: unit.dimension,
            expected,
        })
    }
}

/// SI value of one `name`, such as 1e-9 for `nN`: for units that stand apart from their numbers.
///
/// # Errors
/// [`UnitError::UnknownUnit`] or [`UnitError::WrongUnit`] if `name` is not a unit of `expected`.
pub fn unit_factor(name: &str, expected: Dimension) -> Result<f64, UnitError> {
    let unit = expect_unit(name.trim(), expected)?;
    Ok(scale("1", 0, unit))
}

/// The head of a column, `force [nN]` or `force (nN)`, as name and unit.
pub(crate) fn name_and_unit(text: &str) -> (&str, Option<&str>) {
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some((name, rest)) = text.split_once(open) {
            return (name.trim(), Some(rest.trim_end().trim_end_matches(close)));
        }
    }
    (text, None)
}

/// SI value of a text such as `25 um` or `0.2J/m²`; the space before the unit is optional.
///
/// The value is the double nearest to the written decimal: `25 um` is `25e-6` to the last bit. A
/// pure number has no unit, every other dimension requires one. Angles are returned in radians.
///
/// # Errors
/// [`UnitError`] with the expected unit: a missing number or unit, an unknown unit or one of
/// another dimension, or a number beyond the largest double.
pub fn parse_quantity(text: &str, expected: Dimension) -> Result<f64, UnitError> {
    let trimmed = text.trim();
    let text = quoted(text);
    let Some((digits, exponent, rest)) = split_number(trimmed) else {
        return Err(UnitError::NoNumber { text, expected });
    };
    if rest.starts_with(',') {
        return Err(UnitError::DecimalComma { text, expected });
    }
    let name = rest.trim_start();
    let unit = match (name.is_empty(), expected) {
        (true, Dimension::Dimensionless) => Unit::new(expected, 0, 1.0),
        (true, _) => return Err(UnitError::NoUnit { text, expected }),
        (false, _) => expect_unit(name, expected)?,
    };
    let value = scale(digits, exponent, unit);
    if value.is_finite() {
        Ok(value)
    } else {
        Err(UnitError::NotFinite { text, expected })
    }
}

/// A share from 0 to 1, as a number or in per cent: `0.1` or `10%`.
///
/// # Errors
/// [`UnitError::NoShare`].
pub fn parse_share(text: &str) -> Result<f64, UnitError> {
    let (number, unit) = match text.trim().strip_suffix('%') {
        Some(number) => (number.trim(), 0.01),
        None => (text.trim(), 1.0),
    };
    let share = number.parse().map(|number: f64| number * unit);
    share
        .ok()
        .filter(|share| (0.0..=1.0).contains(share))
        .ok_or_else(|| UnitError::NoShare { text: quoted(text) })
}

/// SI value and dimension of a text with a unit of any dimension; `None` for other texts.
#[cfg(feature = "cli")]
pub(crate) fn parse_any_quantity(text: &str) -> Option<(f64, Dimension)> {
    let (digits, exponent, rest) = split_number(text.trim())?;
    let unit = find_unit(rest.trim())?;
    let value = scale(digits, exponent, unit);
    value.is_finite().then_some((value, unit.dimension))
}

/// The number that a text begins with, and the text behind it; `None` if it does not begin with a finite number.
#[cfg(feature = "cli")]
pub(crate) fn number_and_rest(text: &str) -> Option<(f64, &str)> {
    let (digits, exponent, rest) = split_number(text.trim())?;
    let number = scale(
        digits,
        exponent,
        Unit::new(Dimension::Dimensionless, 0, 1.0),
    );
    number.is_finite().then_some((number, rest.trim()))
}

/// Angle in radians of a bare number, which is in degrees.
pub fn angle_from_number(degrees: f64) -> f64 {
    degrees.to_radians()
}

/// `digits * 10^exponent` in `unit`, rounded once; infinite if it is too large.
fn scale(digits: &str, exponent: i32, unit: Unit) -> f64 {
    let power = exponent.saturating_add(unit.power);
    // The digits were checked by `split_number`, so this parse cannot fail.
    let number: f64 = format!("{digits}e{power}").parse().unwrap_or(f64::NAN);
    if unit.factor == 1.0 {
        number
    } else {
        number * unit.factor
    }
}

/// Digits with sign and point, power of ten, and the rest of the text; `None` if it does not begin
/// with a number.
fn split_number(text: &str) -> Option<(&str, i32, &str)> {
    let bytes = text.as_bytes();
    let digits_from = |mut at: usize| {
        let start = at;
        while bytes.get(at).is_some_and(u8::is_ascii_digit) {
            at += 1;
        }
        (at, at - start)
    };
    let sign = usize::from(matches!(bytes.first(), Some(b'+' | b'-')));
    let (mut end, mut count) = digits_from(sign);
    if bytes.get(end) == Some(&b'.') {
        let (after, more) = digits_from(end + 1);
        end = after;
        count += more;
    }
    if count == 0 {
        return None;
    }
    let digits = &text[..end];
    let mut exponent = 0;
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let signed = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let (after, count) = digits_from(end + 1 + signed);
        if count > 0 {
            let written = &text[end + 1..after];
            // An exponent beyond i32 has the effect of the largest one: infinite or zero.
            let limit = if written.starts_with('-') {
                i32::MIN / 2
            } else {
                i32::MAX / 2
            };
            exponent = written.parse().unwrap_or(limit);
            end = after;
        }
    }
    Some((digits, exponent, &text[end..]))
}

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

/// The prefix of a power of ten, if it has one; none stands for 0.
pub(crate) fn prefix_of(power: i32) -> Option<String> {
    let known = PREFIXES.iter().find(|(_, known)| *known == power);
    let letter = known.map(|(letter, _)| letter.to_string());
    letter.or_else(|| (power == 0).then(String::new))
}

/// Whether a prefix may stand before a unit: not before a power, where it would be squared too.
pub(crate) fn takes_prefix(unit: &str) -> bool {
    PREFIXED.iter().any(|(known, _)| *known == unit) || SHOWN.contains(&unit)
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

#[cfg(test)]
mod tests {
    use super::Dimension::*;
    use super::*;

    #[test]
    fn shares_are_numbers_or_per_cent() {
        for text in ["0.1", "10%", " 10 % ", "1e-1"] {
            assert_eq!(parse_share(text), Ok(0.1), "{text}");
        }
        for text in ["1.1", "-1%", "101 %", "nan", "%", "0,1", "1 um"] {
            let refused = Err(UnitError::NoShare { text: quoted(text) });
            assert_eq!(parse_share(text), refused);
        }
    }

    #[test]
    fn quantities_are_the_nearest_double() {
        for (text, dimension, value) in [
            ("25 um", Length, 25e-6),
            ("25um", Length, 25e-6),
            ("25 µm", Length, 25e-6),
            ("25 μm", Length, 25e-6),
            ("  2.5e1  um ", Length, 25e-6),
            ("+.5 nm", Length, 0.5e-9),
            ("5. m", Length, 5.0),
            ("-1.5 fm", Length, -1.5e-15),
            ("4.1 zJ", Energy, 4.1e-21),
            ("2 aN", Force, 2e-18),
            ("1 mm", Length, 1e-3),
            ("1 km", Length, 1e3),
            ("1.33 TPa", Pressure, 1.33e12),
            ("10 MPa", Pressure, 1e7),
            ("-3 GPa", Pressure, -3e9),
            ("3 pPa", Pressure, 3e-12),
            ("20 nN", Force, 20e-9),
            ("7 mN", Force, 7e-3),
            ("0.3 fJ", Energy, 0.3e-15),
            ("0.2 J/m^2", EnergyPerArea, 0.2),
            ("0.2J/m²", EnergyPerArea, 0.2),
            ("50 mJ / m^2", EnergyPerArea, 0.05),
            ("50 mN/m", EnergyPerArea, 0.05),
            ("0.2 N/m", ForcePerLength, 0.2),
            ("0.2 J/m^2", ForcePerLength, 0.2),
            ("10 ms", Time, 0.01),
            ("1.5 min", Time, 90.0),
            ("5 kHz", Frequency, 5e3),
            ("298.15 K", Temperature, 298.15),
            ("18e-6 m^3/mol", MolarVolume, 18e-6),
            ("18e-6 m³/mol", MolarVolume, 18e-6),
            ("18 cm^3/mol", MolarVolume, 18e-6),
            ("18 cm³ / mol", MolarVolume, 18e-6),
            ("3 um/s", Speed, 3e-6),
            ("3 m/s", Speed, 3.0),
            ("3 mW/(m K)", Conductivity, 3e-3),
            ("3 W/m/K", Conductivity, 3.0),
            ("3e-6 mm^3/(N m)", SpecificWear, 3e-15),
            ("0.3mm³ / (N m)", SpecificWear, 3e-10),
            ("3e-15 m^3/(N m)", SpecificWear, 3e-15),
            ("3e-15 1/Pa", SpecificWear, 3e-15),
            ("3 mPa s", Viscosity, 3e-3),
            ("0.1 1/um", PerLength, 1e5),
            ("9e3/m", PerLength, 9e3),
            ("10 1/um^2", PerArea, 1e13),
            ("2 / mm²", PerArea, 2e6),
            ("0.5", Dimensionless, 0.5),
            ("180 deg", Angle, std::f64::consts::PI),
            ("1.5 rad", Angle, 1.5),
            ("1e-99999999999 m", Length, 0.0),
        ] {
            assert_eq!(parse_quantity(text, dimension), Ok(value), "{text}");
        }
    }

    #[test]
    fn wrong_units_say_which_was_expected() {
        for (text, dimension, message) in [
            (
                "25",
                Length,
                "\"25\" has no unit; give a length in m, such as \"25 um\", or a bare number in m",
            ),
            (
                "25 nN",
                Length,
                "\"nN\" is a force in N; give a length in m, such as \"25 um\"",
            ),
            (
                "25 furlong",
                Length,
                "\"furlong\" is not a unit that is known here; give a length in m",
            ),
            ("25 Km", Length, "\"Km\" is not a unit"),
            ("25 m m", Length, "\"m m\" is not a unit"),
            ("25 mmin", Time, "\"mmin\" is not a unit"),
            ("25 mK", Temperature, "\"mK\" is not a unit"),
            ("25 um^2", Length, "\"um^2\" is not a unit"),
            (
                "2,5 um",
                Length,
                "\"2,5 um\" has a decimal comma; write a point",
            ),
            ("wide", Length, "\"wide\" does not begin with a number"),
            ("", Length, "\"\" does not begin with a number"),
            ("inf m", Length, "\"inf m\" does not begin with a number"),
            ("nan m", Length, "\"nan m\" does not begin with a number"),
            ("- 5 m", Length, "\"- 5 m\" does not begin with a number"),
            (". m", Length, "\". m\" does not begin with a number"),
            ("1e999 m", Length, "\"1e999 m\" is too large"),
            ("1e99999999999 m", Length, "is too large"),
            ("5e m", Length, "\"e m\" is not a unit"),
            (
                "5 J",
                EnergyPerArea,
                "\"J\" is an energy in J; give an energy per area in J/m^2 or N/m",
            ),
            (
                "5 1/um",
                PerArea,
                "\"1/um\" is a reciprocal length in 1/m; give a count per area in 1/m^2",
            ),
            ("5 1/s", PerLength, "\"1/s\" is not a unit"),
            (
                "5 Pa",
                Dimensionless,
                "\"Pa\" is a pressure in Pa; give a number without a unit",
            ),
            (
                "30",
                Angle,
                "\"30\" has no unit; give an angle in deg or rad, such as \"70 deg\", or a bare number in degrees",
            ),
        ] {
            let error = parse_quantity(text, dimension).expect_err(text).to_string();
            assert!(error.contains(message), "{text}: {error}");
        }
    }

    #[test]
    fn units_without_numbers_are_parsed() {
        assert_eq!(unit_factor("nN", Force), Ok(1e-9));
        assert_eq!(unit_factor(" µm ", Length), Ok(1e-6));
        assert_eq!(unit_factor("min", Time), Ok(60.0));
        assert!(unit_factor("", Length).is_err());
        assert!(unit_factor("nm", Force).is_err());
    }

    #[test]
    fn bare_angles_are_degrees() {
        assert_eq!(angle_from_number(180.0), std::f64::consts::PI);
        assert_eq!(parse_quantity("1 rad", Angle), Ok(1.0));
        assert_eq!(
            parse_quantity("90°", Angle),
            parse_quantity("90 deg", Angle)
        );
        assert!(parse_quantity("90 m", Angle).is_err());
    }

    #[test]
    fn numbers_for_people_have_a_prefix_and_four_digits() {
        for (value, unit, text) in [
            (25e-6, "m", "25 µm"),
            (1.33e12, "Pa", "1.33 TPa"),
            (0.2, "J/m^2", "200 mJ/m^2"),
            (0.0, "N", "0 N"),
            (-3.14159e-9, "N", "-3.142 nN"),
            (999.96, "m", "1 km"),
            (999.94, "m", "999.9 m"),
            (123456.0, "Pa", "123.5 kPa"),
            (1.0, "m", "1 m"),
            (0.001, "s", "1 ms"),
            (9.9999e-10, "m", "1 nm"),
            (1e-15, "m", "1 fm"),
            (1.5e-16, "m", "150 am"),
            (4.11e-21, "J", "4.11 zJ"),
            (1.5e-24, "m", "1.5e-24 m"),
            (2e15, "Pa", "2e15 Pa"),
            (6.25e-10, "m^2", "6.25e-10 m^2"),
            (0.25, "m^2", "0.25 m^2"),
            (298.15, "K", "298.1 K"),
            (0.1234567, "", "0.1235"),
            (1e-6, "", "1e-6"),
            (f64::INFINITY, "m", "inf m"),
        ] {
            assert_eq!(format_si(value, unit), text, "{value} {unit}");
        }
    }

    #[test]
    fn formatted_values_can_be_parsed() {
        for exponent in -15..15 {
            let value = 1.234 * 10f64.powi(exponent);
            let text = format_si(value, "Pa");
            let back = parse_quantity(&text, Pressure).expect("own text");
            assert!((back / value - 1.0).abs() < 1e-12, "{value}: {text}");
        }
    }
}
