//! What a model takes: names, dimensions, what is allowed, what is assumed; and those parameters
//! that several models share.

use crate::units::Dimension;

/// A parameter of a model, given as `--name value`.
#[derive(Clone, Copy)]
pub(super) struct Parameter {
    /// As on the command line.
    pub name: &'static str,
    /// Which values it takes.
    pub kind: Kind,
    /// What happens if it is not given.
    pub need: Need,
    /// What it means.
    pub meaning: &'static str,
}

/// The values of a parameter.
#[derive(Clone, Copy)]
pub(super) enum Kind {
    /// A value with a dimension, within limits.
    Quantity(Dimension, Allowed),
    /// A count of 2 or more.
    Count,
    /// One of a few words.
    Word(&'static [&'static str]),
}

/// Limits of a value, in SI.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Allowed {
    /// Any finite number.
    Any,
    /// Above zero.
    Positive,
    /// Zero or more.
    NotNegative,
    /// Zero or less.
    NotPositive,
    /// Between the two, without them.
    Inside(f64, f64),
    /// Above zero, up to one.
    Share,
    /// Zero or more, below one.
    BelowOne,
}

impl Allowed {
    /// Whether a finite `value` is allowed.
    pub fn holds(self, value: f64) -> bool {
        match self {
            Allowed::Any => true,
            Allowed::Positive => value > 0.0,
            Allowed::NotNegative => value >= 0.0,
            Allowed::NotPositive => value <= 0.0,
            Allowed::Inside(low, high) => value > low && value < high,
            Allowed::Share => value > 0.0 && value <= 1.0,
            Allowed::BelowOne => (0.0..1.0).contains(&value),
        }
    }

    /// In words, after "must be"; angles are written in degrees.
    pub fn words(self, dimension: Dimension) -> String {
        match self {
            Allowed::Any => "finite".to_owned(),
            Allowed::Positive => "more than zero".to_owned(),
            Allowed::NotNegative => "zero or more".to_owned(),
            Allowed::NotPositive => "zero or less".to_owned(),
            Allowed::Inside(low, high) if dimension == Dimension::Angle => {
                format!("between {} and {} deg", low.to_degrees(), high.to_degrees())
            }
            Allowed::Inside(low, high) => format!("between {low} and {high}"),
            Allowed::Share => "more than 0 and no more than 1".to_owned(),
            Allowed::BelowOne => "zero or more and below 1".to_owned(),
        }
    }
}

/// Whether a parameter must be given.
#[derive(Clone, Copy)]
pub(super) enum Need {
    /// It must.
    Required,
    /// If not, it is this.
    Default(&'static str),
    /// If not, the model chooses; in words.
    Chosen(&'static str),
    /// Exactly one of this and the other named must be given.
    Either(&'static str),
    /// It must be given if the other named is; the two name each other.
    With(&'static str),
}

impl Parameter {
    /// A required quantity above zero.
    pub const fn positive(name: &'static str, dimension: Dimension, meaning: &'static str) -> Self {
        Parameter {
            name,
            kind: Kind::Quantity(dimension, Allowed::Positive),
            need: Need::Required,
            meaning,
        }
    }

    /// One of `words`; the first is the default.
    pub const fn word(
        name: &'static str,
        words: &'static [&'static str],
        meaning: &'static str,
    ) -> Self {
        Parameter {
            name,
            kind: Kind::Word(words),
            need: Need::Default(words[0]),
            meaning,
        }
    }

    /// The place of the first row, `chosen` by the model if it is not given.
    pub const fn from(
        dimension: Dimension,
        allowed: Allowed,
        chosen: &'static str,
        meaning: &'static str,
    ) -> Self {
        Parameter {
            name: "from",
            kind: Kind::Quantity(dimension, allowed),
            need: Need::Chosen(chosen),
            meaning,
        }
    }

    /// The place of the last row, `chosen` by the model if it is not given.
    pub const fn to(
        dimension: Dimension,
        allowed: Allowed,
        chosen: &'static str,
        meaning: &'static str,
    ) -> Self {
        Parameter {
            name: "to",
            ..Parameter::from(dimension, allowed, chosen, meaning)
        }
    }

    /// The approach of the first row.
    pub const fn from_approach(allowed: Allowed, chosen: &'static str) -> Self {
        let meaning = "approach of the first row";
        Parameter::from(Dimension::Length, allowed, chosen, meaning)
    }

    /// The approach of the last row.
    pub const fn to_approach(allowed: Allowed, chosen: &'static str) -> Self {
        let meaning = "approach of the last row";
        Parameter::to(Dimension::Length, allowed, chosen, meaning)
    }

    /// The same with another need.
    pub const fn needed(self, need: Need) -> Self {
        Parameter { need, ..self }
    }

    /// The same with a default.
    pub const fn or(self, default: &'static str) -> Self {
        self.needed(Need::Default(default))
    }
}

pub(super) const RADIUS: Parameter =
    Parameter::positive("radius", Dimension::Length, "radius of the sphere");
pub(super) const CONTACT_MODULUS: Parameter =
    Parameter::positive("contact_modulus", Dimension::Pressure, "E* of the pair");
pub(super) const WORK_OF_ADHESION: Parameter = Parameter::positive(
    "work_of_adhesion",
    Dimension::EnergyPerArea,
    "energy per area to separate the surfaces",
);
/// What every adhesive sphere has.
pub(super) const ADHESIVE_SPHERE: &[Parameter] = &[RADIUS, CONTACT_MODULUS, WORK_OF_ADHESION];
pub(super) const RANGE: Parameter = Parameter::positive(
    "range",
    Dimension::Length,
    "length over which the attraction acts",
);
pub(super) const LAW: Parameter = Parameter::word(
    "law",
    &["lennard-jones", "cubic", "exponential", "maugis-dugdale"],
    "how the attraction fades with the gap",
);
pub(super) const DIRECTION: Parameter = Parameter::word(
    "direction",
    &["apart", "together"],
    "which way the surfaces move, where that matters",
);
pub(super) const POINTS: Parameter = Parameter {
    name: "points",
    kind: Kind::Count,
    need: Need::Default("101"),
    meaning: "number of rows",
};
