//! Which WGSL belongs to which word of the catalogue.

use crate::law::Law;

/// The WGSL of a kernel: its own part and those it builds on, joined in this order.
#[derive(Clone, Copy)]
pub struct Shader {
    /// The word of the catalogue.
    pub name: &'static str,
    /// Sources.
    pub parts: &'static [&'static str],
    /// Whether it asks for the cohesive law.
    pub law: bool,
}

macro_rules! part {
    ($name:literal) => {
        include_str!(concat!("../../../shaders/", $name, ".wgsl"))
    };
}

macro_rules! shaders {
    ($($name:literal $law:literal [$($part:literal),*];)*) => {
        &[$(Shader { name: $name, parts: &[$(part!($part),)* part!($name)], law: $law }),*]
    };
}

/// What every kernel sees.
pub const COMMON: &str = part!("common");
/// Sums over a workgroup.
pub const REDUCE: &str = part!("reduce");
/// One function a gate.
pub const GATE: &str = part!("gate");
/// Products of complex numbers.
pub const FFT: &str = part!("fft");

const SHADERS: &[Shader] = shaders! {
    "load_displacement" false [];
    "load_field" false [];
    "store_pressure" false [];
};

/// The shader of a kernel, if it has one.
pub fn shader(name: &str) -> Option<&'static Shader> {
    SHADERS.iter().find(|shader| shader.name == name)
}

/// The laws as far as their WGSL differs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LawPart {
    /// No attraction.
    HardWall,
    /// Constant tension, tapered or not.
    MaugisDugdale,
    /// Exponential tension.
    Exponential,
    /// The 9-3 law.
    LennardJones,
}

impl LawPart {
    /// Which of them a law is.
    pub fn of(law: &Law) -> Self {
        match law {
            Law::HardWall => LawPart::HardWall,
            Law::MaugisDugdale(_) => LawPart::MaugisDugdale,
            Law::Exponential(_) => LawPart::Exponential,
            Law::LennardJones(_) => LawPart::LennardJones,
        }
    }

    /// Its WGSL: `law_traction`, `law_energy` and `law_slope` of a gap.
    pub fn source(self) -> &'static str {
        ""
    }
}
