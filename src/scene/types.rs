//! A scene in SI units, checked by itself but not yet against its surface.

use std::path::PathBuf;

use serde::Serialize;

use super::attraction::{AdhesionScene, CapillaryScene};
use super::parts::SurfacePart;
use super::resolved;
use super::tables::EffectTables;
use super::words::words;
use crate::elastic::Layer;
pub use crate::grid::Boundary;

/// A scene: every value in SI units, defaults filled in.
///
/// An effect that the scene does not name is `None`; later code neither allocates nor runs anything
/// for it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Scene {
    /// Title, for pictures and reports.
    pub title: Option<String>,
    /// `[grid]`.
    pub grid: GridScene,
    /// `[solid]`.
    pub solid: SolidScene,
    /// `[[surface]]`: the heights are the sum of these parts; never empty.
    pub surfaces: Vec<SurfacePart>,
    /// `[adhesion]`, an effect; or the law equivalent to `[capillary]`.
    pub adhesion: Option<AdhesionScene>,
    /// `[capillary]`, an effect.
    pub capillary: Option<CapillaryScene>,
    /// Tables of effects that hold numbers alone.
    pub tables: EffectTables,
    /// `[loading]`.
    pub loading: LoadingScene,
    /// `[solver]`.
    pub solver: SolverScene,
    /// `[output]`.
    pub output: OutputScene,
    /// Folder of the scene file, against which paths in it are resolved.
    pub folder: PathBuf,
}

/// `[grid]`: points and size may be left out if a height file provides them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GridScene {
    /// The boundary condition.
    #[serde(serialize_with = "resolved::word")]
    pub boundary: Boundary,
    /// Points along x and y.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub points: Option<[usize; 2]>,
    /// Size along x and y, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub size: Option<[f64; 2]>,
}

/// `[solid]`: the elastic half-space.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct SolidScene {
    /// Contact modulus E*, Pa, with the counter-face's share where one is given.
    pub contact_modulus: f64,
    /// Poisson ratio of the solid, if the scene gives one.
    pub poisson_ratio: Option<f64>,
    /// A layer of this thickness on a rigid base in place of the half-space (an effect).
    pub layer: Option<Layer>,
    /// Largest net pressure, at which the solid yields, Pa (an effect).
    pub hardness: Option<f64>,
    /// Maxwell branches in parallel with the contact modulus, which is then the relaxed one (an
    /// effect); empty for an elastic solid.
    pub relaxation: Vec<RelaxationScene>,
}

impl SolidScene {
    /// Whether a path carries more state than its gap from step to step. That state is in double
    /// precision even if the gap is not.
    pub fn remembers(&self) -> bool {
        !self.relaxation.is_empty() || self.hardness.is_some()
    }
}

/// One Maxwell branch of `[[solid.relaxation]]`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RelaxationScene {
    /// Contact modulus of the branch, Pa.
    pub modulus: f64,
    /// Time in which its stress falls to 1/e, s.
    pub time: f64,
}

/// `[loading]`.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct LoadingScene {
    /// Which quantity the path prescribes.
    pub control: Control,
    /// The prescribed values in SI units, one a step; never empty.
    pub path: Vec<f64>,
    /// Duration of each step, s, as long as the path; `None` if the path has no durations. The
    /// first is 0.
    pub durations: Option<Vec<f64>>,
    /// Spring between the prescribed approach and the body, N/m (an effect).
    pub spring: Option<f64>,
    /// How closely pull-off is bracketed under a prescribed load: the greatest relative difference
    /// between a tension that the contact does not carry and one that it does; 0 for no bracketing.
    pub pull_off_tolerance: f64,
    /// Whether further steps behind the path pull until the surfaces separate.
    pub until_apart: bool,
}

words! {
    /// Which quantity a loading path prescribes.
    Control {
        /// Mean pressure, Pa.
        Pressure = "pressure",
        /// Total force, N.
        Force = "force",
        /// Approach, m.
        Approach = "approach",
        /// Mean gap, m.
        MeanGap = "mean-gap",
    }
}

/// `[solver]`.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct SolverScene {
    /// Tolerance of the residual.
    pub tolerance: f64,
    /// Iteration limit of a step.
    pub max_iterations: usize,
    /// Precision of its numbers.
    pub precision: Precision,
    /// Processor or graphics processor.
    pub backend: BackendName,
}

words! {
    /// Precision of a solve.
    Precision {
        /// Chosen by tabor.
        Auto = "auto",
        /// 32 bit.
        Single = "single",
        /// 32-bit iterations corrected in 64 bit.
        Mixed = "mixed",
        /// 64 bit.
        Double = "double",
    }
}

impl Precision {
    /// Least tolerance that single precision reaches on every scene.
    #[doc(hidden)]
    pub const SINGLE_FLOOR: f64 = 1e-4;
}

words! {
    /// The processor or a graphics processor.
    BackendName {
        /// Chosen by tabor.
        Auto = "auto",
        /// Threads of this machine's processor.
        Cpu = "cpu",
        /// A graphics processor.
        Gpu = "gpu",
    }
}

/// `[output]`.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct OutputScene {
    /// Fields written as PNG.
    pub images: Vec<FieldName>,
    /// Fields written as .npy.
    pub fields: Vec<FieldName>,
    /// The steps whose images and fields are written.
    pub steps: StepChoice,
}

words! {
    /// A field that can be written.
    #[derive(Hash)]
    FieldName {
        /// Net normal traction, Pa, positive in compression.
        Pressure = "pressure",
        /// Gap, m.
        Gap = "gap",
        /// Normal surface displacement, m, positive into the solid.
        Displacement = "displacement",
        /// Heights, m.
        Heights = "heights",
    }
}

impl FieldName {
    /// The SI unit of its values.
    pub fn unit(self) -> &'static str {
        match self {
            FieldName::Pressure => "Pa",
            _ => "m",
        }
    }
}

/// Selects the steps whose images and fields are written.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum StepChoice {
    /// The last one.
    Last,
    /// Every one.
    All,
    /// These, numbered from 1.
    #[serde(untagged)]
    List(Vec<usize>),
}
