//! The units, their prefixes, and what they are in SI.

use super::Dimension;

/// The relation of a unit to SI: a power of ten, kept separately so that `25 um` is exactly
/// `25e-6`, and a factor for the few units that are not powers of ten.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Unit {
    pub(super) power: i32,
    pub(super) factor: f64,
    pub(super) dimension: Dimension,
}

impl Unit {
    pub(super) fn new(dimension: Dimension, power: i32, factor: f64) -> Self {
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

/// The unit of a name, with its prefix; `None` of an unknown one.
pub(super) fn find_unit(name: &str) -> Option<Unit> {
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
