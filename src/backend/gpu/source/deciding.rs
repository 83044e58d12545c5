//! Shaders of the decisions: partial sums put together, then scalar kernels.

use std::fmt::Write;

use super::super::catalogue;
use super::super::error::GpuError;
use super::super::layout::Wide;
use super::super::level::{SWEEP_SUMS_AT_ONCE, SWEEP_THREADS};
use super::{gate_name, preamble, reduction};
use crate::kernel::{Gate, Reduce, ScalarKernel};

/// Where a reduction's results go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Results {
    /// The scalars' sums, put together as the kernel says.
    Sums(&'static [Reduce]),
    /// The curvature, over so many points.
    Curvature(usize),
}

/// A reduction: what it puts together, of how many workgroups, behind which gate.
#[derive(Clone, Copy, Debug)]
pub struct Reduction {
    /// Where its results go.
    pub results: Results,
    /// Workgroups that handed in partial sums.
    pub groups: usize,
    /// The gate of the kernel that wrote them.
    pub gate: Gate,
}

/// One dispatch that decides: puts partial sums together in a fixed order, if the gate of the kernel
/// that wrote them was open, then runs scalar kernels one after another. An error where one of them
/// has no shader. Its entry point is `decide`.
pub fn decide(
    reduction_first: Option<Reduction>,
    kernels: &[&ScalarKernel],
    wide: Wide,
) -> Result<String, GpuError> {
    let mut source = String::new();
    preamble(&mut source, wide, "read_write");
    let mut parts: Vec<&str> = Vec::new();
    for kernel in kernels {
        let found = catalogue::scalar(kernel.name).ok_or(GpuError::NoShader(kernel.name))?;
        for part in found {
            if !parts.contains(&part) {
                parts.push(part);
            }
        }
    }
    parts.iter().for_each(|part| source.push_str(part));
    let threads = match reduction_first {
        Some(first) => {
            put_together(&mut source, first);
            SWEEP_THREADS
        }
        None => 1,
    };
    let _ = writeln!(
        source,
        "@compute @workgroup_size({threads})\n\
         fn decide(@builtin(local_invocation_index) thread: u32) {{"
    );
    if reduction_first.is_some() {
        source.push_str("put_together(thread);\nstorageBarrier();\n");
    }
    source.push_str("if (thread == 0u) {\n");
    for kernel in kernels {
        let _ = writeln!(source, "{}();", kernel.name);
    }
    source.push_str("}\n}\n");
    Ok(source)
}

/// Writes the function that puts partial sums together.
fn put_together(source: &mut String, what: Reduction) {
    let (reduces, target) = match what.results {
        Results::Sums(reduces) => (reduces, "scalars.sums[first + thread] = total".to_string()),
        Results::Curvature(points) => (
            &[Reduce::Add] as &[Reduce],
            format!("scalars.curvature = total / wide({points}.0)"),
        ),
    };
    let (groups, count) = (what.groups, reduces.len());
    let at_once = SWEEP_SUMS_AT_ONCE.min(count);
    reduction(source, reduces, SWEEP_THREADS, at_once);
    let _ = write!(
        source,
        "fn put_together(thread: u32) {{\n\
         start_sums();\n\
         for (var slot = 0u; slot < {count}u; slot = slot + 1u) {{\n\
         var total = part_of(slot);\n\
         for (var group = thread; group < {groups}u; group = group + {SWEEP_THREADS}u) {{\n\
         total = join_slot(slot, total, partials.values[slot * {groups}u + group]);\n\
         }}\n\
         set_part(slot, total);\n\
         }}\n\
         for (var first = 0u; first < {count}u; first = first + SUMS_AT_ONCE) {{\n\
         gather(first, thread);\n\
         if (thread < SUMS_AT_ONCE && first + thread < {count}u && {gate}()) {{\n\
         let total = part_value(group_values[thread * GROUP_THREADS]);\n\
         {target};\n\
         }}\n}}\n}}\n",
        gate = gate_name(what.gate),
    );
}

/// Sums of 64 pairs with what rounding took from them, to see whether that survives a compiler. Its
/// entry point is `check`.
pub fn two_sums() -> String {
    let mut source = String::new();
    preamble(&mut source, Wide::Compensated, "read");
    let _ = writeln!(
        source,
        "@group(1) @binding(0) var<storage, read> pairs: array<vec2<f32>>;\n\
         @compute @workgroup_size({PAIRS})\n\
         fn check(@builtin(local_invocation_index) thread: u32) {{\n\
         partials.values[thread] = two_sum(pairs[thread].x, pairs[thread].y);\n\
         }}"
    );
    source
}

/// Pairs of [`two_sums`].
pub const PAIRS: usize = 64;
