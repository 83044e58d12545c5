//! Contents of the `[[surface]]` parts, in SI units.

use std::path::PathBuf;

use serde::Serialize;

use super::words::words;
use super::{GridValues, resolved};

/// One `[[surface]]` part.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum SurfacePart {
    /// Self-affine roughness with a roll-off and a cut-off.
    SelfAffine(SelfAffineScene),
    /// Paraboloid `-r^2/(2 radius)`.
    Sphere {
        /// Radius of curvature, m.
        radius: f64,
        /// Apex (x, y), m; `None` is the middle of the grid.
        #[serde(skip_serializing_if = "Option::is_none")]
        centre: Option<[f64; 2]>,
    },
    /// Cone `-r / tan(half_angle)`.
    Cone {
        /// Angle between axis and flank, rad.
        #[serde(serialize_with = "resolved::degrees")]
        half_angle: f64,
        /// Apex (x, y), m; `None` is the middle of the grid.
        #[serde(skip_serializing_if = "Option::is_none")]
        centre: Option<[f64; 2]>,
    },
    /// `amplitude cos(2 pi x / wavelength_x) cos(2 pi y / wavelength_y)`; an infinite wavelength gives 1.
    Wavy {
        /// Amplitude, m.
        amplitude: f64,
        /// Wavelengths along x and y, m; `f64::INFINITY` for none.
        #[serde(serialize_with = "resolved::wavelengths")]
        wavelength: [f64; 2],
    },
    /// A flat part.
    Flat,
    /// Heights read from a file.
    File(HeightFileScene),
    /// Heights given as an array, m.
    #[serde(rename = "array")]
    Heights(GridValues),
}

/// Self-affine roughness: spectrum flat from `longest` to `rolloff`, then falling as `q^(-2 hurst - 2)` to `shortest`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SelfAffineScene {
    /// Hurst exponent, between 0 and 1.
    pub hurst: f64,
    /// What fixes the amplitude.
    #[serde(flatten)]
    pub roughness: Roughness,
    /// Longest wavelength, m.
    pub longest: f64,
    /// Roll-off wavelength, m.
    pub rolloff: f64,
    /// Shortest wavelength, m.
    pub shortest: f64,
    /// Seed of the phases.
    pub seed: u64,
}

/// The moment that fixes a self-affine amplitude.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Roughness {
    /// Root mean square height, m.
    RmsHeight(f64),
    /// Root mean square slope.
    RmsSlope(f64),
}

/// A height map from a file.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HeightFileScene {
    /// Path, already resolved against the scene's folder.
    #[serde(serialize_with = "resolved::path")]
    pub path: PathBuf,
    /// Metres per unit of the file's numbers.
    pub unit: f64,
    /// Further factor on the heights.
    pub scale: f64,
    /// The trend to subtract.
    pub detrend: Detrend,
    /// How to treat missing pixels.
    pub fill: Fill,
    /// Height of black in a grey image, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub black: Option<f64>,
    /// Height of white in a grey image, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub white: Option<f64>,
    /// What else is done to the map.
    #[serde(flatten)]
    pub preparation: Preparation,
}

/// What is done to a measured map besides, in this order; by default nothing.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Preparation {
    /// Whether the file is a line scan, and the surface the profile that repeats across it.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub profile: bool,
    /// The part that is kept: x and y of its first point, points along x and y.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub crop: Option<[usize; 4]>,
    /// Points that stand out of their neighbours by more than so many standard deviations are interpolated.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub outliers: Option<f64>,
    /// How a map that is not periodic is made so.
    #[serde(skip_serializing_if = "Edges::is_none")]
    pub edges: Edges,
    /// Points along x and y that the map is brought to.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub resample: Option<[usize; 2]>,
}

words! {
    /// How a map that is not periodic is made so.
    #[derive(Default)]
    Edges {
        /// It is not.
        #[default]
        None = "none",
        /// Heights go to their mean over an eighth of each side.
        Window = "window",
        /// The map and its mirror images, twice as long along both sides.
        Mirror = "mirror",
    }
}

impl Edges {
    fn is_none(&self) -> bool {
        *self == Edges::None
    }
}

words! {
    /// The trend subtracted from a measured height map.
    Detrend {
        /// Nothing.
        None = "none",
        /// The mean.
        Mean = "mean",
        /// The least-squares plane.
        Plane = "plane",
        /// The least-squares quadratic surface.
        Quadratic = "quadratic",
        /// The mean of each row.
        Lines = "lines",
    }
}

words! {
    /// How missing (NaN) pixels are treated.
    Fill {
        /// Refuse them and report their number.
        None = "none",
        /// Interpolate from the neighbours.
        Interpolate = "interpolate",
    }
}
