//! Which WGSL belongs to which word of the catalogue.

use super::layout::Number;
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

/// Kernels of a solid that flows, which are those of the wall with another part around them.
macro_rules! over_flow {
    ($($name:literal of $wall:literal [$($part:literal),*];)*) => {
        &[$(Shader { name: $name, parts: &[part!("yielding"), $(part!($part),)* part!($wall)], law: true }),*]
    };
}

/// What every kernel sees.
pub const COMMON: &str = part!("common");
/// Sums over a workgroup.
pub const REDUCE: &str = part!("reduce");
/// Sums as they are.
pub const SUMS: &str = part!("sums");
/// Sums with what rounding takes from them.
pub const SUMS_COMPENSATED: &str = part!("sums_compensated");
/// One function a gate.
pub const GATE: &str = part!("gate");
/// How kernels see a law where the unknown is the gap.
pub const WHOLE_GAP: &str = part!("whole_gap");
/// How they see it where the unknown is a correction of a base gap.
pub const CORRECTION: &str = part!("correction");
/// Copies a buffer.
pub const COPY: &str = part!("copy");
/// Products of complex numbers.
pub const FFT: &str = part!("fft");
/// Factors out of a table.
pub const FACTOR_TABLE: &str = part!("factor_table");
/// The stiffness of a half-space, and the factors that are made of it.
pub const HALF_SPACE: &str = part!("half_space");
/// The stiffness.
pub const FACTOR_STIFFNESS: &str = part!("factor_stiffness");
/// The compliance.
pub const FACTOR_COMPLIANCE: &str = part!("factor_compliance");
/// The compliance to short waves.
pub const FACTOR_SHORT_COMPLIANCE: &str = part!("factor_short_compliance");
/// exp in single precision.
pub const EXP_SINGLE: &str = part!("exp_single");
/// exp in double precision.
pub const EXP_DOUBLE: &str = part!("exp_double");

const SHADERS: &[Shader] = shaders! {
    "load_displacement" false [];
    "load_field" false [];
    "store_pressure" false [];
    "wall_residual" true ["wall"];
    "wall_free" true ["wall"];
    "wall_free_kept" true ["wall"];
    "wall_descent" true ["wall", "descend"];
    "wall_descent_held" true ["wall", "descend"];
    "wall_trial" true ["wall"];
    "wall_trial_held" true ["wall"];
    "wall_search" true ["wall"];
    "wall_turn" true ["wall", "step"];
    "wall_turn_kept" true ["wall", "step"];
    "wall_advance" true ["wall", "step"];
    "wall_balance" true ["wall"];
    "yield_direct" true ["yielding"];
    "yield_trial_held" true ["yielding"];
    "yield_search" true ["yielding"];
    "yield_advance" true ["yielding", "step"];
    "core_residual" true ["core"];
    "core_free" true ["core"];
    "core_descent" true ["core"];
    "core_descent_held" true ["core"];
    "core_direct" true ["core"];
    "core_trial" true ["core"];
    "core_trial_held" true ["core"];
    "core_search" true ["core"];
    "core_turn" true ["core"];
    "core_advance" true ["core"];
    "core_balance" true ["core"];
    "two_band_descent" false ["descend", "neighbours"];
    "two_band_descent_held" false ["descend", "neighbours"];
    "base_total" true [];
    "base_rigid" false [];
    "base_add_wall" false [];
    "base_add_core" true ["core"];
    "base_hold_wall" false [];
    "base_hold_core" true ["core"];
    "coarse_restrict" false [];
    "coarse_share" false [];
    "coarse_weigh" false [];
    "coarse_store" false [];
};

const OVER_FLOW: &[Shader] = over_flow! {
    "yield_residual" of "wall_residual" [];
    "yield_free" of "wall_free" [];
    "yield_free_kept" of "wall_free_kept" [];
    "yield_descent" of "wall_descent" ["descend"];
    "yield_descent_held" of "wall_descent_held" ["descend"];
    "yield_trial" of "wall_trial" [];
    "yield_turn" of "wall_turn" ["step"];
    "yield_turn_kept" of "wall_turn_kept" ["step"];
    "yield_balance" of "wall_balance" [];
};

/// Parts of the scalar kernels: those of every law, of a wall, of its held mean gap, of the Lennard-Jones
/// core, of the base of corrections.
const SCALAR_PARTS: [&str; 5] = [
    part!("scalar"),
    part!("scalar_wall"),
    part!("scalar_held"),
    part!("scalar_core"),
    part!("scalar_base"),
];

/// The parts from which a scalar kernel is called, if one of them defines it.
pub fn scalar(name: &str) -> Option<Vec<&'static str>> {
    let definition = format!("\nfn {name}() {{");
    let found = SCALAR_PARTS
        .iter()
        .position(|part| part.contains(&definition))?;
    let mut parts = vec![SCALAR_PARTS[0]];
    if found > 0 {
        parts.push(SCALAR_PARTS[found]);
    }
    Some(parts)
}

/// The shader of a kernel, if it has one.
pub fn shader(name: &str) -> Option<&'static Shader> {
    SHADERS
        .iter()
        .chain(OVER_FLOW)
        .find(|shader| shader.name == name)
}

/// Whether a kernel asks for the cohesive law.
pub fn asks_for_law(name: &str) -> bool {
    shader(name).is_some_and(|shader| shader.law)
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

    /// Its WGSL: `law_traction`, `law_energy` and `law_slope` of a gap in this number, after what they
    /// build on.
    pub fn sources(self, number: Number) -> &'static [&'static str] {
        match (self, number) {
            (LawPart::HardWall, _) => &[part!("law_hard_wall")],
            (LawPart::MaugisDugdale, _) => &[part!("law_maugis_dugdale")],
            (LawPart::Exponential, Number::Single) => &[EXP_SINGLE, part!("law_exponential")],
            (LawPart::Exponential, Number::Double) => &[EXP_DOUBLE, part!("law_exponential")],
            (LawPart::LennardJones, _) => &[part!("law_lennard_jones")],
        }
    }
}
