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

mod shown;
mod table;

use std::fmt;

use thiserror::Error;

pub use shown::format_si;
use table::{Unit, find_unit};
pub(crate) use table::{prefix_of, takes_prefix};

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

/// Whether a text is a quantity rather than a unit alone.
pub(crate) fn starts_like_a_number(text: &str) -> bool {
    text.trim_start()
        .starts_with(|first: char| first.is_ascii_digit() || "+-.".contains(first))
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

#[cfg(test)]
mod tests;
