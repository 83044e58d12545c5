//! Assembled shaders of every kernel, as `examples/shaders.rs` writes them and
//! `tests/reference/shaders` keeps them.

use super::super::catalogue;
use super::super::error::GpuError;
use super::super::layout::{self, Number, Wide};
use super::super::loops::Loops;
use super::super::plan::GroupLimits;
use super::{Decision, FactorSource, LawSource, LevelPlan, Reduction, Results, Whole};
use crate::backend::Shape;
use crate::kernel::{Constraint, Gate, KERNELS, Kernel, SCALAR_KERNELS};
use crate::law::{Exponential, Law, LennardJones, MaugisDugdale};

/// Limits that every adapter offers.
const LIMITS: GroupLimits = GroupLimits {
    threads: 256,
    memory: 16384,
};

/// The law in a kernel's snapshot.
fn law_of(kernel: &Kernel) -> Law {
    match kernel.constraint {
        Some(Constraint::Smooth) => Law::LennardJones(LennardJones {
            work_of_adhesion: 1.0,
            range: 1.0,
        }),
        Some(Constraint::HardnessLimit) => Law::MaugisDugdale(MaugisDugdale {
            peak_tension: 1.0,
            range: 1.0,
            taper: 0.0,
        }),
        _ => Law::Exponential(Exponential {
            work_of_adhesion: 1.0,
            range: 1.0,
        }),
    }
}

/// Every kernel in all its variants on a small level in single precision with sums in double, by name; the
/// parts that all share; the decisions; a multiplication; and kernels around an outer state, with a map of
/// adhesion, a pad, compensated sums, and in double precision.
///
/// # Errors
/// A kernel without a shader.
pub fn representative() -> Result<Vec<(String, String)>, GpuError> {
    let whole = Shape::whole(8, 8);
    let padded = Shape {
        points: [8, 8],
        surface: [5, 4],
    };
    let show = |kernel: &'static Kernel, shape, number, wide, law: LawSource| {
        let plan = LevelPlan::new(shape, LIMITS, number)?;
        let other = if kernel.name == "coarsen" { 16 } else { 4 };
        super::kernel(kernel, &plan, Whole::from([other, other]), law, wide)
    };
    let (single, double) = (Number::Single, Wide::Double);
    let mut all = vec![("declarations".to_owned(), layout::declarations(double))];
    for (name, part) in [
        ("common", catalogue::COMMON),
        ("gate", catalogue::GATE),
        ("sums", catalogue::SUMS),
        ("reduce", catalogue::REDUCE),
    ] {
        all.push((name.to_owned(), part.to_owned()));
    }
    let shared = all.clone();
    for kernel in KERNELS.iter().copied().flatten() {
        let law = LawSource::uniform(law_of(kernel).shader());
        all.push((kernel.variant(), show(kernel, whole, single, double, law)?));
        if kernel.name == "load_residual" && kernel.writes.is_empty() {
            let corrected = LawSource {
                factor: Some(kernel.fields()),
                outer_gap: Some(kernel.fields() + 1),
                ..law
            };
            let text = show(kernel, padded, single, Wide::Compensated, corrected)?;
            all.push((format!("{}-corrected", kernel.variant()), text));
            let text = show(kernel, whole, Number::Double, double, law)?;
            all.push((format!("{}-double", kernel.variant()), text));
        }
    }
    let sums = |kernel: &'static Kernel| {
        Decision::Sums(Reduction {
            results: Results::Sums(kernel.sums),
            groups: 7,
            first: 0,
            gate: kernel.gate,
        })
    };
    let mut parts: Vec<_> = KERNELS[4].iter().take(1).map(sums).collect();
    parts.extend(SCALAR_KERNELS.iter().map(|kernel| Decision::Scalar(kernel)));
    all.push((
        "decide".to_owned(),
        super::decide(&parts, double, Loops::Unrolled)?,
    ));
    let plan = LevelPlan::new(whole, LIMITS, single)?;
    let multiply = super::multiply(&plan, FactorSource::Stiffness, true, Gate::Running, double);
    all.push(("multiply".to_owned(), multiply));
    for (name, text) in all.iter_mut().skip(shared.len()) {
        for (part, common) in &shared {
            *text = text.replacen(common, &format!("// {part}.wgsl\n"), 1);
        }
        debug_assert!(!text.is_empty(), "{name}");
    }
    Ok(all)
}
