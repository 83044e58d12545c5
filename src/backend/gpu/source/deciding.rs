//! Shaders of the decisions: adding up partial sums, then scalar kernels.

use std::fmt::Write;

use super::super::catalogue;
use super::super::error::GpuError;
use super::super::layout::Wide;
use super::super::level::{SWEEP_SUMS_AT_ONCE, SWEEP_THREADS};
use super::super::loops::Loops;
use super::sums::{self, Summed, Team};
use super::{gate_name, preamble};
use crate::kernel::{Gate, Reduce, ScalarKernel, Sum};

/// Where a reduction's results go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Results {
    /// The scalars' sums, combined as the kernel declares.
    Sums(&'static [Sum]),
    /// The curvature, over this many points.
    Curvature(usize),
}

impl Results {
    /// How they are combined.
    fn reduces(self) -> Vec<Reduce> {
        match self {
            Results::Sums(sums) => sums.iter().map(|sum| sum.reduce()).collect(),
            Results::Curvature(_) => vec![Reduce::Add],
        }
    }
}

/// A reduction of the partial sums of some workgroups, behind a gate.
#[derive(Clone, Copy, Debug)]
pub struct Reduction {
    /// Where its results go.
    pub results: Results,
    /// Number of workgroups with partial sums.
    pub groups: usize,
    /// The first of their partial sums.
    pub first: usize,
    /// The gate of the kernel that wrote them.
    pub gate: Gate,
}

/// One part of a decision.
#[derive(Clone, Copy)]
pub enum Decision {
    /// Partial sums, added up and stored in the scalars.
    Sums(Reduction),
    /// A scalar kernel.
    Scalar(&'static ScalarKernel),
}

/// One dispatch that adds up all partial sums in a fixed order, then runs its parts one after another: a
/// reduction's results are stored if the gate of the kernel that wrote them is open; a scalar kernel is run.
/// An error if a scalar kernel has no shader. The entry point is `decide`.
pub fn decide(parts: &[Decision], wide: Wide, loops: Loops) -> Result<String, GpuError> {
    let mut source = String::new();
    let reductions: Vec<Reduction> = parts
        .iter()
        .filter_map(|part| match part {
            Decision::Sums(reduction) => Some(*reduction),
            Decision::Scalar(_) => None,
        })
        .collect();
    preamble(&mut source, wide, "read_write");
    let mut shaders: Vec<&str> = Vec::new();
    for part in parts {
        let Decision::Scalar(kernel) = part else {
            continue;
        };
        let found = catalogue::scalar(kernel.name).ok_or(GpuError::NoShader(kernel.name))?;
        for shader in found {
            if !shaders.contains(&shader) {
                shaders.push(shader);
            }
        }
    }
    shaders.iter().for_each(|part| source.push_str(part));
    let threads = match reductions.is_empty() {
        true => 1,
        false => {
            put_together(&mut source, &reductions, loops);
            SWEEP_THREADS
        }
    };
    let _ = writeln!(
        source,
        "@compute @workgroup_size({threads})\n\
         fn decide(@builtin(local_invocation_index) thread: u32) {{"
    );
    if !reductions.is_empty() {
        source.push_str("put_together(thread);\n");
    }
    source.push_str("if (thread == 0u) {\n");
    let mut slot = 0;
    for part in parts {
        match part {
            Decision::Scalar(kernel) => {
                let _ = writeln!(source, "{}();", kernel.name);
            }
            Decision::Sums(reduction) => {
                let _ = writeln!(source, "if ({}()) {{", gate_name(reduction.gate));
                let count = reduction.results.reduces().len();
                for place in 0..count {
                    let total = format!("totals[{}]", slot + place);
                    let _ = match reduction.results {
                        Results::Sums(sums) => {
                            writeln!(source, "scalars.sums_{} = {total};", sums[place].name())
                        }
                        Results::Curvature(points) => {
                            writeln!(source, "scalars.curvature = {total} / wide({points}.0);")
                        }
                    };
                }
                slot += count;
                source.push_str("}\n");
            }
        }
    }
    source.push_str("}\n}\n");
    Ok(source)
}

/// Writes the function that adds up partial sums. Those of a reduction are read side by side, so that they do not
/// wait for one another.
fn put_together(source: &mut String, reductions: &[Reduction], loops: Loops) {
    let reduces = reductions.iter().flat_map(|what| what.results.reduces());
    let sums: Vec<Summed> = reduces
        .enumerate()
        .map(|(slot, reduce)| Summed::new(slot.to_string(), reduce))
        .collect();
    let team = Team {
        threads: SWEEP_THREADS,
        at_once: SWEEP_SUMS_AT_ONCE.min(sums.len()),
        loops,
    };
    sums::declare(source, &sums);
    sums::memory(source, team);
    let _ = write!(
        source,
        "var<workgroup> totals: array<wide, {}>;\n\
         fn put_together(thread: u32) {{\n\
         start_sums();\n",
        sums.len()
    );
    let mut rest = &sums[..];
    for what in reductions {
        let (own, after) = rest.split_at(what.results.reduces().len());
        let (groups, first) = (what.groups, what.first);
        let _ = writeln!(
            source,
            "for (var group = thread; group < {groups}u; group = group + {SWEEP_THREADS}u) {{"
        );
        for (slot, sum) in own.iter().enumerate() {
            let _ = writeln!(
                source,
                "sum_{name} = {join}(sum_{name}, partials.values[{place}u + group]);",
                name = sum.name,
                join = sum.parts_joined(),
                place = first + slot * groups,
            );
        }
        source.push_str("}\n");
        rest = after;
    }
    sums::join(source, &sums, team, |slot, value| {
        format!("totals[{slot}] = part_value({value});\n")
    });
    source.push_str("workgroupBarrier();\n}\n");
}

/// Compensated sums of 64 pairs, to test whether they survive the compiler. The entry point is `check`.
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
