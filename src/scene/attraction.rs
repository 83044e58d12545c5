//! Contents of `[adhesion]` and `[capillary]`, in SI units.

use std::path::PathBuf;

use serde::Serialize;

use super::words::words;
use super::{GridValues, resolved};
use crate::law::{Exponential, Law, LennardJones, MaugisDugdale};

/// How much longer than with a taper the shortest range of a law that ends sharply is: chi is 0.02 then, and 0.5 with one.
const SHARP: f64 = 5.0;

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
    /// A factor on the tension at each point (an effect).
    pub map: Option<AdhesionMap>,
    /// How the work of adhesion grows with the speed of a receding edge (an effect).
    pub rate: Option<RateScene>,
}

/// Work of adhesion of an edge that recedes at a speed v: `w (1 + (v/v*)^n)`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RateScene {
    /// Speed v* at which it doubles, m/s.
    pub reference_speed: f64,
    /// Exponent n.
    pub exponent: f64,
}

/// Source of the factors on a law's tension.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
#[non_exhaustive]
pub enum AdhesionMap {
    /// A file with one factor a point; the path is resolved against the scene's folder.
    File(#[serde(serialize_with = "resolved::path")] PathBuf),
    /// One factor a point, given as an array.
    Factors(GridValues),
    /// Two factors that alternate every half period.
    Pattern {
        /// The shape of the pattern.
        #[serde(rename = "pattern")]
        kind: PatternKind,
        /// Period, m.
        period: f64,
        /// One factor.
        low: f64,
        /// The other, which the first point has.
        high: f64,
    },
}

words! {
    /// Shape of a pattern of two factors.
    PatternKind {
        /// A checkerboard: alternating along x and y.
        Checker = "checker",
        /// Stripes: alternating along x.
        Stripe = "stripe",
    }
}

/// `[capillary]`: a liquid that condenses between the surfaces.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
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
    #[serde(serialize_with = "resolved::degrees")]
    pub contact_angle: f64,
}

/// The range of a cohesive law: a length, or `auto`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Range {
    /// The shortest range that the grid resolves at this work of adhesion.
    Auto,
    /// A length, m.
    #[serde(untagged)]
    Length(f64),
}

words! {
    /// The names of the cohesive laws.
    LawName {
        /// Constant tension up to a range.
        MaugisDugdale = "maugis-dugdale",
        /// The 9-3 surface law with its own repulsion.
        LennardJones = "lennard-jones",
        /// Tension falling exponentially.
        Exponential = "exponential",
    }
}

impl LawName {
    /// `peak_tension * range / work_of_adhesion` of the law.
    ///
    /// Lennard-Jones: the traction `(8 w / 3 eps)(s^3 - s^9)` is largest at `s^6 = 1/3`.
    #[doc(hidden)]
    pub fn shape(self) -> f64 {
        match self {
            LawName::MaugisDugdale | LawName::Exponential => 1.0,
            LawName::LennardJones => 16.0 / (9.0 * 3f64.sqrt()),
        }
    }

    /// The shortest range at which pull-off is still within some per cent of JKR's, over
    /// `sqrt(w dx / E*)`. A Maugis-Dugdale law that ends sharply, without a taper, needs 25 times the cohesive zone.
    pub(crate) fn shortest_range(self, is_sharp: bool) -> f64 {
        match self {
            LawName::MaugisDugdale if is_sharp => SHARP * 2f64.sqrt(),
            LawName::MaugisDugdale => 2f64.sqrt(),
            LawName::Exponential => 1.0,
            LawName::LennardJones => 1.25,
        }
    }

    /// The law of this work of adhesion and range, with this width of a linear end if it has one.
    pub fn law(self, work_of_adhesion: f64, range: f64, taper: f64) -> Law {
        match self {
            LawName::MaugisDugdale => Law::MaugisDugdale(MaugisDugdale {
                peak_tension: work_of_adhesion / range,
                range,
                taper,
            }),
            LawName::LennardJones => Law::LennardJones(LennardJones {
                work_of_adhesion,
                range,
            }),
            LawName::Exponential => Law::Exponential(Exponential {
                work_of_adhesion,
                range,
            }),
        }
    }
}

words! {
    /// How the attraction is computed.
    Treatment {
        /// Solved together with the contact.
        Full = "full",
        /// Summed over the gap of the solution without adhesion (DMT force approach).
        Dmt = "dmt",
    }
}
