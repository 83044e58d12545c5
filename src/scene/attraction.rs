//! What `[adhesion]` and `[capillary]` say, in SI units.

use std::path::PathBuf;

use super::GridValues;

/// `[adhesion]`.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct AdhesionScene {
    /// Which cohesive law.
    pub law: LawName,
    /// Work of adhesion w, J/m^2.
    pub work_of_adhesion: f64,
    /// Range of the law, m (Maugis-Dugdale h0, Lennard-Jones epsilon, exponential rho).
    pub range: Range,
    /// Taper of Maugis-Dugdale; `None` is `auto`, `Some(0.0)` sharp.
    pub taper: Option<f64>,
    /// How the attraction is found.
    pub treatment: Treatment,
    /// A factor on the tension point by point (an effect).
    pub map: Option<AdhesionMap>,
    /// How the work of adhesion grows with the speed of a receding edge (an effect).
    pub rate: Option<RateScene>,
}

/// Work of adhesion of an edge that recedes at a speed v: `w (1 + (v/v*)^n)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RateScene {
    /// Speed v* at which it doubles, m/s.
    pub reference_speed: f64,
    /// Exponent n.
    pub exponent: f64,
}

/// Where the factors on a law's tension come from.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum AdhesionMap {
    /// A file of one factor a point; the path is resolved against the scene's folder.
    File(PathBuf),
    /// One factor a point, given as an array.
    Factors(GridValues),
    /// Two factors in turn, each for half a period.
    Pattern {
        /// How they take turns.
        kind: PatternKind,
        /// Period, m.
        period: f64,
        /// One factor.
        low: f64,
        /// The other, which the first point has.
        high: f64,
    },
}

/// How two factors take turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PatternKind {
    /// Along x and y.
    Checker,
    /// Along x.
    Stripe,
}

impl PatternKind {
    /// Every one of them.
    pub const ALL: &[PatternKind] = &[PatternKind::Checker, PatternKind::Stripe];

    /// The word used in scenes.
    pub fn name(self) -> &'static str {
        match self {
            PatternKind::Checker => "checker",
            PatternKind::Stripe => "stripe",
        }
    }
}

/// `[capillary]`: a liquid that condenses between the surfaces.
#[derive(Clone, Debug, PartialEq)]
pub struct CapillaryScene {
    /// Relative humidity, from 0 to below 1.
    pub humidity: f64,
    /// Surface tension of the liquid, N/m.
    pub surface_tension: f64,
    /// Molar volume of the liquid, m^3/mol.
    pub molar_volume: f64,
    /// Temperature, K.
    pub temperature: f64,
    /// Contact angle on both surfaces, rad.
    pub contact_angle: f64,
}

/// The range of a cohesive law: a length, or the shortest that the grid resolves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Range {
    /// A length, m.
    Length(f64),
    /// The shortest that the grid resolves at this work of adhesion.
    Auto,
}

/// The names of the cohesive laws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LawName {
    /// Constant tension up to a range.
    MaugisDugdale,
    /// The 9-3 surface law with its own repulsion.
    LennardJones,
    /// Tension falling exponentially.
    Exponential,
}

impl LawName {
    /// Every one of them.
    pub const ALL: &[LawName] = &[
        LawName::MaugisDugdale,
        LawName::LennardJones,
        LawName::Exponential,
    ];

    /// The word used in scenes.
    pub fn name(self) -> &'static str {
        match self {
            LawName::MaugisDugdale => "maugis-dugdale",
            LawName::LennardJones => "lennard-jones",
            LawName::Exponential => "exponential",
        }
    }
}

/// How the attraction is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Treatment {
    /// Solved together with the contact.
    Full,
    /// Summed over the gap of the solution without adhesion (DMT force approach).
    Dmt,
}

impl Treatment {
    /// Every one of them.
    pub const ALL: &[Treatment] = &[Treatment::Full, Treatment::Dmt];

    /// The word used in scenes.
    pub fn name(self) -> &'static str {
        match self {
            Treatment::Full => "full",
            Treatment::Dmt => "dmt",
        }
    }
}
