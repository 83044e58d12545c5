//! Sums of a kernel: a variable of each thread for each of them, joined over a workgroup.
//!
//! All is written out, sum by sum: in an array with a computed index they would leave the registers, and a
//! compiler does not unroll the loops of a checked shader.

use std::fmt::Write;

use super::super::loops::Loops;
use super::slabs::after_turns;
use crate::kernel::{Kernel, Reduce, Sum};

/// A sum: its name in the shader, and how its terms are joined.
pub struct Summed {
    /// The name after `sum_` and `into_`.
    pub name: String,
    /// How terms are joined.
    pub reduce: Reduce,
}

impl Summed {
    /// A sum of this name and kind.
    pub fn new(name: impl Into<String>, reduce: Reduce) -> Self {
        let name = name.into();
        Summed { name, reduce }
    }

    /// Those of a kernel, in its order.
    pub fn of_kernel(kernel: &Kernel) -> Vec<Self> {
        let sums = kernel.sums.iter().zip(kernel.reduces);
        sums.map(|(sum, &reduce)| Summed::new(sum.name(), reduce))
            .collect()
    }

    /// The function that joins a term.
    fn term_joined(&self) -> &'static str {
        match self.reduce {
            Reduce::Add => "add",
            Reduce::Min => "least",
            Reduce::Max => "most",
        }
    }

    /// The function that joins two parts of a sum.
    pub fn parts_joined(&self) -> &'static str {
        match self.reduce {
            Reduce::Add => "join_add",
            Reduce::Min => "join_min",
            Reduce::Max => "join_max",
        }
    }

    /// The sum of nothing.
    fn neutral(&self) -> &'static str {
        match self.reduce {
            Reduce::Add => "wide(0.0)",
            Reduce::Min => "params.infinity",
            Reduce::Max => "-params.infinity",
        }
    }
}

/// The threads that join their sums.
#[derive(Clone, Copy)]
pub struct Team {
    /// Threads in a workgroup.
    pub threads: usize,
    /// Sums that are joined together.
    pub at_once: usize,
    /// What becomes of the loop over the halvings.
    pub loops: Loops,
}

/// Declares the sums of a thread; `start_sums` sets them to those of nothing.
pub fn declare(source: &mut String, sums: &[Summed]) {
    for sum in sums {
        let (name, join) = (&sum.name, sum.term_joined());
        let _ = writeln!(
            source,
            "var<private> sum_{name}: part;\n\
             fn into_{name}(term: wide) {{ sum_{name} = {join}(sum_{name}, term); }}"
        );
    }
    source.push_str("fn start_sums() {\n");
    for sum in sums {
        let _ = writeln!(source, "sum_{} = part_of({});", sum.name, sum.neutral());
    }
    source.push_str("}\n");
}

/// Terms that the parts of a kernel have for sums of other variants alone go nowhere.
pub fn ignore_others(source: &mut String, kernel: &Kernel, parts: &[&str]) {
    for sum in Sum::ALL.iter().filter(|sum| !kernel.sums.contains(sum)) {
        let function = format!("into_{}(", sum.name());
        if parts.iter().any(|part| part.contains(&function)) {
            let _ = writeln!(source, "fn {function}term: wide) {{}}");
        }
    }
}

/// Declares the memory in which a workgroup joins its sums.
pub fn memory(source: &mut String, team: Team) {
    let _ = writeln!(
        source,
        "var<workgroup> group_values: array<part, {}>;",
        team.threads * team.at_once
    );
}

/// Joins the sums of a workgroup, halved in a fixed order, some together so that barriers are few. `store` says
/// what becomes of a result: the index of a sum, and the expression of it.
pub fn join(
    source: &mut String,
    sums: &[Summed],
    team: Team,
    store: impl Fn(usize, &str) -> String,
) {
    let Team {
        threads, at_once, ..
    } = team;
    for (turn, together) in sums.chunks(at_once).enumerate() {
        if turn > 0 {
            source.push_str("workgroupBarrier();\n");
        }
        for (place, sum) in together.iter().enumerate() {
            let first = place * threads;
            let _ = writeln!(
                source,
                "group_values[{first}u + thread] = sum_{};",
                sum.name
            );
        }
        source.push_str("workgroupBarrier();\n");
        match team.loops {
            Loops::Unrolled => halvings(source, together, threads),
            Loops::Kept => loop_over_halvings(source, together, threads),
        }
        source.push_str("if (thread == 0u) {\n");
        for place in 0..together.len() {
            let value = format!("group_values[{}u]", place * threads);
            source.push_str(&store(turn * at_once + place, &value));
        }
        source.push_str("}\n");
    }
}

/// The halvings, one after another.
fn halvings(source: &mut String, together: &[Summed], threads: usize) {
    let mut left = threads;
    while left > 1 {
        let half = left.next_power_of_two() / 2;
        let _ = writeln!(source, "if (thread < {}u) {{", left - half);
        for (place, sum) in together.iter().enumerate() {
            let (first, other) = (place * threads, place * threads + half);
            let _ = writeln!(
                source,
                "group_values[{first}u + thread] = {}(group_values[{first}u + thread], group_values[{other}u + thread]);",
                sum.parts_joined(),
            );
        }
        source.push_str("}\nworkgroupBarrier();\n");
        left = half;
    }
}

/// The same as a loop.
fn loop_over_halvings(source: &mut String, together: &[Summed], threads: usize) {
    let half = threads.next_power_of_two() / 2;
    let _ = writeln!(
        source,
        "for (var half = {half}u; half > params.zero; half = half / 2u) {{\n\
         if (thread < min({threads}u, 2u * half) - half) {{"
    );
    for (place, sum) in together.iter().enumerate() {
        let first = place * threads;
        let _ = writeln!(
            source,
            "group_values[{first}u + thread] = {}(group_values[{first}u + thread], group_values[{first}u + half + thread]);",
            sum.parts_joined(),
        );
    }
    source.push_str("}\nworkgroupBarrier();\n}\n");
}

/// Code that stores a workgroup's sums at `first_partial` and beyond, for this many workgroups in each dispatch.
pub fn hand_in(
    source: &mut String,
    sums: &[Summed],
    team: Team,
    [turns, turn_groups]: [usize; 2],
    first_partial: usize,
) {
    let groups = turns * turn_groups;
    let before = after_turns(turns, turn_groups);
    memory(source, team);
    source.push_str("fn hand_in(group: u32, thread: u32) {\n");
    join(source, sums, team, |slot, value| {
        let first = first_partial + slot * groups;
        format!("partials.values[{first}u + {before}group] = {value};\n")
    });
    source.push_str("}\n");
}
