//! The WGSL of each kernel of the catalogue.

use super::layout::Number;
use crate::kernel::{Constraint, scalar};
use crate::law::LawShader;

/// The WGSL of a kernel: shared parts, then its own, joined in this order.
#[derive(Clone, Copy)]
pub struct Shader {
    /// The kernel's name.
    pub name: &'static str,
    /// Sources.
    pub parts: &'static [&'static str],
}

macro_rules! part {
    ($name:literal) => {
        include_str!(concat!("../../../shaders/", $name, ".wgsl"))
    };
}

macro_rules! shaders {
    ($($name:literal [$($part:literal),*];)*) => {
        &[$(Shader {
            name: $name,
            parts: &[$(part!($part),)* part!($name)],
        }),*]
    };
}

/// Included in every kernel.
pub const COMMON: &str = part!("common");
/// Sums over a workgroup.
pub const REDUCE: &str = part!("reduce");
/// Plain sums.
pub const SUMS: &str = part!("sums");
/// Compensated sums.
pub const SUMS_COMPENSATED: &str = part!("sums_compensated");
/// One function for each gate.
pub const GATE: &str = part!("gate");
/// Access to a law where the unknown is the gap.
pub const WHOLE_GAP: &str = part!("whole_gap");
/// Access to a law where the unknown is a correction of an outer state's gap.
pub const CORRECTION: &str = part!("correction");
/// Copies a buffer.
pub const COPY: &str = part!("copy");
/// Products of complex numbers.
pub const FFT: &str = part!("fft");
/// Factors from a table.
pub const FACTOR_TABLE: &str = part!("factor_table");
/// The stiffness of a half-space, and factors computed from it.
pub const HALF_SPACE: &str = part!("half_space");
/// The stiffness.
pub const FACTOR_STIFFNESS: &str = part!("factor_stiffness");
/// The compliance.
pub const FACTOR_COMPLIANCE: &str = part!("factor_compliance");
/// exp in single precision.
pub const EXP_SINGLE: &str = part!("exp_single");
/// exp in double precision.
pub const EXP_DOUBLE: &str = part!("exp_double");

const SHADERS: &[Shader] = shaders! {
    "load_displacement" [];
    "load_field" [];
    "store_field" [];
    "residual" ["measure"];
    "load_residual" ["measure"];
    "descent" ["descent_terms"];
    "trial" ["step", "trial_terms", "linear_trial_terms"];
    "direction" ["step"];
    "load_trial" ["step", "trial_terms"];
    "search" [];
    "update_state" ["step", "step_from", "measure"];
    "advance" ["step", "step_from", "balance_terms"];
    "balance" ["balance_terms"];
    "coarsen" ["interpolation"];
    "free_share" [];
    "weigh" [];
    "store_weighted" [];
    "refine" ["interpolation", "add_interpolated"];
    "load_weighted" [];
    "soften" ["interpolation", "add_interpolated", "finest_answer"];
    "store_retained" [];
    "level_descent" ["interpolation", "add_interpolated", "finest_answer", "descent_terms"];
    "outer_residual" [];
    "outer_pressure" [];
    "add_correction" [];
    "restore_outer_gap" [];
};

/// A point over a constraint of the gap.
pub const CONSTRAINT: &str = part!("constraint");

/// The functions of a constraint.
pub fn constraint(constraint: Constraint) -> &'static str {
    match constraint {
        Constraint::Unilateral => part!("unilateral"),
        Constraint::HardnessLimit => part!("hardness_limit"),
        Constraint::Smooth => part!("smooth"),
    }
}

/// Parts of the scalar kernels, the first of which the others build on.
const SCALAR_PARTS: [&str; 3] = [part!("scalar"), part!("mean_gap"), part!("step_length")];

/// The parts from which a scalar kernel is called, if one of them defines it.
pub fn scalar(name: &str) -> Option<Vec<&'static str>> {
    let definition = format!("\nfn {name}() {{");
    let found = SCALAR_PARTS
        .iter()
        .position(|part| part.contains(&definition))?;
    let mut parts = vec![scalar::CONSTANTS, SCALAR_PARTS[0]];
    if found > 0 {
        parts.push(SCALAR_PARTS[found]);
    }
    Some(parts)
}

/// The shader of a kernel, if it has one.
pub fn shader(name: &str) -> Option<&'static Shader> {
    SHADERS.iter().find(|shader| shader.name == name)
}

/// The WGSL of a law for fields in this number, after what it builds on.
pub fn law(law: LawShader, number: Number) -> Vec<&'static str> {
    let mut parts = Vec::new();
    if ["exponential(", "exp_less_one("]
        .iter()
        .any(|word| law.source.contains(word))
    {
        parts.push(match number {
            Number::Single => EXP_SINGLE,
            Number::Double => EXP_DOUBLE,
        });
    }
    parts.push(law.source);
    parts
}
