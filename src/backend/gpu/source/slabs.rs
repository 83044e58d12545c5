//! Shader code for grids in several slabs: the place in the grid of a slab's point, the slab of a
//! column's place, and fields read as a whole.

use std::fmt::Write;

use super::super::level::LevelPlan;

/// A field that a kernel reads at any point, or at the neighbours of each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Whole {
    /// Its points along x and y.
    pub shape: [usize; 2],
    /// Its slabs.
    pub slabs: usize,
}

impl From<[usize; 2]> for Whole {
    fn from(shape: [usize; 2]) -> Self {
        Whole { shape, slabs: 1 }
    }
}

impl Whole {
    /// A field of a level.
    pub fn new(plan: &LevelPlan) -> Self {
        Whole {
            shape: plan.shape,
            slabs: plan.slabs,
        }
    }

    /// Declares the field's bindings in group 1, from one on, its size and the function that reads it, all named
    /// after `word`.
    pub(super) fn declare(self, source: &mut String, word: &str, binding: usize) {
        let [width, height] = self.shape;
        for slab in 0..self.slabs {
            let _ = writeln!(
                source,
                "@group(1) @binding({}) var<storage, read> {word}_{slab}: array<real>;",
                binding + slab
            );
        }
        let size = word.to_uppercase();
        let _ = writeln!(
            source,
            "const {size}_WIDTH: u32 = {width}u;\nconst {size}_HEIGHT: u32 = {height}u;\n\
             fn {word}_at(column: u32, row: u32) -> real {{"
        );
        if self.slabs == 1 {
            let _ = writeln!(source, "return {word}_0[row * {width}u + column];\n}}");
            return;
        }
        let pairs = height / 2;
        let slab_pairs = pairs / self.slabs;
        let _ = writeln!(
            source,
            "let partner = row >= {pairs}u;\n\
             let pair = select(row, row - {pairs}u, partner);\n\
             let place = (pair % {slab_pairs}u + select(0u, {slab_pairs}u, partner)) * {width}u + column;\n\
             switch pair / {slab_pairs}u {{"
        );
        for slab in 1..self.slabs {
            let _ = writeln!(source, "case {slab}u: {{ return {word}_{slab}[place]; }}");
        }
        let _ = writeln!(source, "default: {{ return {word}_0[place]; }}\n}}\n}}");
    }
}

/// Declares the index of this slab or part, where there are several, and the row in the grid of a
/// point of the slab.
pub(super) fn declare_turn(source: &mut String, plan: &LevelPlan) {
    if plan.turns() > 1 {
        source.push_str(
            "struct Slab {\n    number: u32,\n}\n@group(0) @binding(3) var<uniform> slab: Slab;\n",
        );
    }
}

/// Defines `row_of`, the row in the grid of a point of this slab.
pub(super) fn row_of(source: &mut String, plan: &LevelPlan) {
    let width = plan.shape[0];
    source.push_str("fn row_of(index: u32) -> u32 {\n");
    if plan.slabs == 1 {
        let _ = writeln!(source, "return index / {width}u;\n}}");
        return;
    }
    let (pairs, slab_pairs) = (plan.pairs(), plan.slab_pairs());
    let _ = writeln!(
        source,
        "let row = index / {width}u;\n\
         return slab.number * {slab_pairs}u + select(row, row + {between}u, row >= {slab_pairs}u);\n}}",
        between = pairs - slab_pairs,
    );
}

/// The expression that adds to a number of this turn what those before it have used of it, `each`
/// of them.
pub(super) fn after_turns(turns: usize, each: usize) -> String {
    match turns {
        1 => String::new(),
        _ => format!("slab.number * {each}u + "),
    }
}

/// The condition that holds in one workgroup of all turns.
pub(super) fn first_turn(turns: usize) -> &'static str {
    match turns {
        1 => "",
        _ => "slab.number == 0u && ",
    }
}

/// The work space of all slabs, as the columns see it: `base` is the column's first place.
pub(super) struct Work {
    slabs: usize,
    slab_pairs: usize,
}

impl Work {
    pub(super) fn new(plan: &LevelPlan) -> Self {
        Work {
            slabs: plan.slabs,
            slab_pairs: plan.slab_pairs(),
        }
    }

    /// Declares the slabs from binding 1 of group 1 on, and what reaches a place in any of them.
    pub(super) fn declare(&self, source: &mut String) {
        if self.slabs == 1 {
            source.push_str(
                "@group(1) @binding(1) var<storage, read_write> work: array<vec2<real>>;\n",
            );
            return;
        }
        for slab in 0..self.slabs {
            let _ = writeln!(
                source,
                "@group(1) @binding({}) var<storage, read_write> work_{slab}: array<vec2<real>>;",
                slab + 1
            );
        }
        let pairs = self.slab_pairs;
        let _ = writeln!(
            source,
            "fn read_work(base: u32, pair: u32) -> vec2<real> {{\nlet place = base + pair % {pairs}u;\nswitch pair / {pairs}u {{"
        );
        for slab in 1..self.slabs {
            let _ = writeln!(source, "case {slab}u: {{ return work_{slab}[place]; }}");
        }
        let _ = writeln!(
            source,
            "default: {{ return work_0[place]; }}\n}}\n}}\n\
             fn write_work(base: u32, pair: u32, value: vec2<real>) {{\nlet place = base + pair % {pairs}u;\nswitch pair / {pairs}u {{"
        );
        for slab in 1..self.slabs {
            let _ = writeln!(source, "case {slab}u: {{ work_{slab}[place] = value; }}");
        }
        source.push_str("default: { work_0[place] = value; }\n}\n}\n");
    }

    /// The slab in which all pairs `first..first + count` lie, where it is one.
    fn slab_of(&self, first: usize, count: usize) -> Option<usize> {
        let slab = first / self.slab_pairs;
        let last = (first + count.max(1) - 1) / self.slab_pairs;
        (slab == last && slab < self.slabs).then_some(slab)
    }

    /// Reads a pair of the column at `base`, in any slab.
    pub(super) fn read_at(&self, base: &str, pair: &str) -> String {
        match self.slabs {
            1 => format!("work[{base} + {pair}]"),
            _ => format!("read_work({base}, {pair})"),
        }
    }

    /// Writes it.
    pub(super) fn write_at(&self, base: &str, pair: &str, value: &str) -> String {
        match self.slabs {
            1 => format!("work[{base} + {pair}] = {value};"),
            _ => format!("write_work({base}, {pair}, {value});"),
        }
    }

    /// Reads pair `j + first` of the column at `base`, where j is below `count`.
    pub(super) fn read(&self, base: &str, first: usize, count: usize) -> String {
        match self.slab_of(first, count) {
            _ if self.slabs == 1 => format!("work[{base} + (j + {first}u)]"),
            Some(slab) => {
                let within = first - slab * self.slab_pairs;
                format!("work_{slab}[{base} + (j + {within}u)]")
            }
            None => format!("read_work({base}, j + {first}u)"),
        }
    }

    /// Writes it.
    pub(super) fn write(&self, base: &str, first: usize, count: usize, value: &str) -> String {
        match self.slab_of(first, count) {
            None if self.slabs > 1 => format!("write_work({base}, j + {first}u, {value});"),
            _ => format!("{} = {value};", self.read(base, first, count)),
        }
    }
}
