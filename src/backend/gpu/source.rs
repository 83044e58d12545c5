//! Whole shaders, joined from parts: a kernel of the catalogue inside the code that its form needs.
//!
//! Group 0 binds the params, the scalars and the level's partial sums; group 1 the kernel's fields
//! in declared order; group 2 the roots of unity and the work space of a transform. All are
//! bound whether a kernel uses them or not. A kernel's own part is a function `at` of a point: its index,
//! whether it is in the domain, and the value of the row that the kernel reads; it returns the value of the
//! row that the kernel writes. Fields are read and written by functions named after them.

mod convert;
mod copy;
mod deciding;
mod factors;
mod long;
mod members;
mod rows;
mod slabs;
mod snapshot;
mod sums;
mod visits;

use std::fmt::Write;

use super::butterfly::{Direction, literal};
use super::catalogue::{self, Shader};
use super::error::GpuError;
use super::fft::LineWriter;
use super::layout::{self, Number, Wide};
pub use super::level::LevelPlan;
use super::level::{Place, SWEEP_SUMS_AT_ONCE, SWEEP_THREADS};
use super::plan::LinePlan;
use crate::kernel::{Form, Gate, Kernel, Reduce};
use crate::law::{Law, LawShader};
pub use convert::convert;
pub use copy::copy;
pub use deciding::{Decision, PAIRS, Reduction, Results, decide, two_sums};
pub use factors::{FactorSource, OWN_FACTORS};
pub use long::{Pass, multiply_long, rows_then};
pub use members::copy_members;
use rows::rows_main;
pub use slabs::Whole;
use slabs::{Work, after_turns, first_turn};
pub use snapshot::representative;
use sums::{Summed, Team};

/// The law of a kernel: its WGSL, and where the factors on its tension are bound.
#[derive(Clone, Copy, Debug)]
pub struct LawSource {
    /// Which law.
    pub shader: LawShader,
    /// Binding of the factors in group 1; `None` where the law is the same everywhere.
    pub factor: Option<usize>,
    /// Binding of the outer gap in group 1; `None` where the unknown is the gap itself.
    pub outer_gap: Option<usize>,
}

impl LawSource {
    /// This law with the same tension everywhere.
    pub fn uniform(shader: LawShader) -> LawSource {
        LawSource {
            shader,
            factor: None,
            outer_gap: None,
        }
    }
}

/// The WGSL function of a gate.
pub fn gate_name(gate: Gate) -> &'static str {
    match gate {
        Gate::Always => "gate_always",
        Gate::Running => "gate_running",
        // Before the next decisions the gate is that after the last ones.
        Gate::Fresh | Gate::Ahead => "gate_fresh",
        Gate::Accepted => "gate_accepted",
        Gate::Searching => "gate_searching",
    }
}

/// The parts before a kernel: number types and gates.
fn preamble(source: &mut String, wide: Wide, access: &str) {
    source.push_str(&layout::declarations(wide));
    source.push_str(catalogue::COMMON);
    let _ = writeln!(
        source,
        "@group(0) @binding(1) var<storage, {access}> scalars: Scalars;"
    );
    source.push_str(catalogue::GATE);
    source.push_str(match wide {
        Wide::Compensated => catalogue::SUMS_COMPENSATED,
        Wide::Single | Wide::Double => catalogue::SUMS,
    });
    source.push_str(catalogue::REDUCE);
}

fn in_domain(source: &mut String, plan: &LevelPlan) {
    let [width, _] = plan.shape;
    let [nx, ny] = plan.surface;
    let body = if plan.shape == plan.surface {
        "true".to_string()
    } else {
        format!("index % {width}u < {nx}u && row_of(index) < {ny}u")
    };
    let _ = writeln!(
        source,
        "fn in_domain(index: u32) -> bool {{ return {body}; }}"
    );
}

/// The shader of a kernel on a level, for all its slabs. `whole` is the field that it reads at any point; one that it
/// reads around each is of the same level.
pub fn kernel(
    kernel: &Kernel,
    plan: &LevelPlan,
    whole: impl Into<Whole>,
    law: LawSource,
    wide: Wide,
) -> Result<String, GpuError> {
    let shader = catalogue::shader(kernel.name).ok_or(GpuError::NoShader(kernel.name))?;
    let mut source = plan.number.declaration();
    preamble(&mut source, wide, "read");
    slabs::declare_turn(&mut source, plan);
    if !kernel.sums.is_empty() {
        let (threads, at_once) = match kernel.form {
            Form::Sweep => (SWEEP_THREADS, SWEEP_SUMS_AT_ONCE),
            _ => (plan.rows.group_threads(), plan.rows.sums_at_once),
        };
        let at_once = at_once.min(kernel.sums.len());
        let (sums, team) = (
            Summed::of_kernel(kernel),
            Team {
                threads,
                at_once,
                loops: plan.loops,
            },
        );
        let first = plan.first_partial(Place::for_form(kernel.form));
        let groups = [plan.slabs, plan.slab_groups(kernel.form)];
        sums::declare(&mut source, &sums);
        sums::hand_in(&mut source, &sums, team, groups, first);
    }
    slabs::row_of(&mut source, plan);
    in_domain(&mut source, plan);
    fields(&mut source, kernel, law);
    let [width, height] = plan.shape;
    let _ = writeln!(
        source,
        "const WIDTH: u32 = {width}u;\nconst HEIGHT: u32 = {height}u;"
    );
    let mut binding = kernel.written().end;
    if kernel.around.is_some() {
        let around = Whole::new(plan);
        around.declare(&mut source, "around", binding);
        binding += around.slabs;
    }
    if kernel.whole {
        whole.into().declare(&mut source, "whole", binding);
    }
    join(&mut source, kernel, shader, law, plan.number);
    match kernel.form {
        Form::Sweep => sweep_main(&mut source, kernel, plan),
        _ => rows_main(&mut source, kernel, plan),
    }
    Ok(source)
}

/// The kernel's fields: their bindings; `fields_at`, which reads all of them at a point; `visit`, which runs the kernel's own part
/// there; and the functions by which that part reads and writes them. A field that only other variants bind reads as zero and is
/// not written.
///
/// They are read before the kernel's own part, so that a thread can ask for those of its next points before it works on one: a
/// compiler moves no reading before the writing of another point.
fn fields(source: &mut String, kernel: &Kernel, law: LawSource) {
    let bound: Vec<&str> = kernel.reads.iter().chain(kernel.writes).copied().collect();
    let updated = bound.len() - kernel.fresh;
    // Members of a point's fields, and the arrays they are read from.
    let mut members: Vec<(&str, String)> = Vec::new();
    for (binding, &name) in bound.iter().enumerate() {
        let written = kernel.written().contains(&binding);
        let access = if written { "read_write" } else { "read" };
        let _ = writeln!(
            source,
            "@group(1) @binding({binding}) var<storage, {access}> field_{name}: array<real>;"
        );
        if binding < updated {
            members.push((name, format!("field_{name}")));
            let _ = writeln!(
                source,
                "fn read_{name}(index: u32) -> real {{ return fields_here.{name}; }}"
            );
        }
        if written {
            let _ = writeln!(
                source,
                "fn write_{name}(index: u32, value: real) {{ field_{name}[index] = value; }}"
            );
        }
    }
    for name in kernel.unbound {
        let _ = writeln!(
            source,
            "fn read_{name}(index: u32) -> real {{ return 0.0; }}\n\
             fn write_{name}(index: u32, value: real) {{}}"
        );
    }
    let mut arrive = String::new();
    if kernel.law || kernel.constraint.is_some() {
        let known = [("law_factor", law.factor), ("known_gap", law.outer_gap)];
        for (name, binding) in known {
            if let Some(binding) = binding {
                let _ = writeln!(
                    source,
                    "@group(1) @binding({binding}) var<storage, read> {name}s: array<real>;\n\
                     var<private> {name}: real;"
                );
                members.push((name, format!("{name}s")));
                let _ = write!(arrive, "{name} = fields.{name}; ");
            }
        }
        if law.factor.is_none() {
            source.push_str("const law_factor: real = 1.0;\n");
        }
    }
    // A structure has a member.
    let (declared, read) = match members.is_empty() {
        true => ("none: u32,".to_owned(), "0u".to_owned()),
        false => (
            members
                .iter()
                .map(|(name, _)| format!("{name}: real, "))
                .collect(),
            members
                .iter()
                .map(|(_, array)| format!("{array}[index], "))
                .collect(),
        ),
    };
    let _ = writeln!(
        source,
        "struct Fields {{ {declared} }}\n\
         var<private> fields_here: Fields;\n\
         fn fields_at(index: u32) -> Fields {{ return Fields({read}); }}\n\
         fn visit(index: u32, fields: Fields, line: real) -> real {{ fields_here = fields; {arrive}return at(index, in_domain(index), line); }}"
    );
}

fn join(source: &mut String, kernel: &Kernel, shader: &Shader, law: LawSource, number: Number) {
    if let Some((flag, set)) = kernel.flag {
        let _ = writeln!(source, "const {flag}: bool = {set};");
    }
    let mut parts = Vec::new();
    if kernel.law || kernel.constraint.is_some() {
        let asked = if kernel.law {
            law.shader
        } else {
            Law::HardWall.shader()
        };
        parts.extend(catalogue::law(asked, number));
        parts.push(match law.outer_gap {
            Some(_) => catalogue::CORRECTION,
            None => catalogue::WHOLE_GAP,
        });
    }
    if let Some(constraint) = kernel.constraint {
        parts.push(catalogue::CONSTRAINT);
        parts.push(catalogue::constraint(constraint));
    }
    parts.extend(shader.parts);
    sums::ignore_others(source, kernel, &parts);
    parts.into_iter().for_each(|part| source.push_str(part));
}

/// Code of a kernel before and after its points.
fn frame(kernel: &Kernel) -> (String, &'static str) {
    let mut open = format!("if (!{}()) {{ return; }}\n", gate_name(kernel.gate));
    if kernel.sums.is_empty() {
        (open, "")
    } else {
        open.push_str("start_sums();\n");
        (open, "hand_in(group.x, index_in_group);\n")
    }
}

fn sweep_main(source: &mut String, kernel: &Kernel, plan: &LevelPlan) {
    let (open, close) = frame(kernel);
    let stride = plan.slab_groups(Form::Sweep) * SWEEP_THREADS;
    let _ = write!(
        source,
        "@compute @workgroup_size({SWEEP_THREADS})\n\
         fn {}(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) index_in_group: u32) {{\n\
         {open}\
         for (var index = group.x * {SWEEP_THREADS}u + index_in_group; index < {points}u; index = index + {stride}u) {{\n\
         visit(index, fields_at(index), 0.0);\n\
         }}\n\
         {close}}}\n",
        kernel.name,
        points = plan.slab_points(),
    );
}

/// First and last radix of a forward transform.
fn ends(plan: &LinePlan) -> (usize, usize) {
    // A plan has at least one radix.
    let first = plan.radices.first().copied().unwrap_or(1);
    (first, plan.radices.last().copied().unwrap_or(1))
}

/// The curvature as the sum of a multiplication in workgroups of the threads of a line's plan.
fn curvature(source: &mut String, plan: &LevelPlan, line: &LinePlan) {
    let sums = [Summed::new("curvature", Reduce::Add)];
    let team = Team {
        threads: line.group_threads(),
        at_once: 1,
        loops: plan.loops,
    };
    let groups = [plan.parts, plan.part_groups()];
    sums::declare(source, &sums);
    sums::hand_in(
        source,
        &sums,
        team,
        groups,
        plan.first_partial(Place::Columns),
    );
}

/// The columns: their transform, the factors, and the transform back, in place.
///
/// Work holds z = p(y) + i p(y + ny/2), transformed along x. Its values at kx and -kx give the
/// transforms A and B of the two halves of the rows apart: `A = (z(kx) + conj z(-kx))/2`,
/// `B = (z(kx) - conj z(-kx))/2i`. Since the first radix is even, the lower legs of a butterfly
/// are values of A and the upper ones those of B at the same places.
pub fn multiply(
    plan: &LevelPlan,
    factors: FactorSource,
    energy: bool,
    gate: Gate,
    wide: Wide,
) -> String {
    let columns = &plan.columns;
    let [width, height] = plan.shape;
    let pairs = plan.slab_pairs();
    let work = Work::new(plan);
    let mut source = plan.number.declaration();
    preamble(&mut source, wide, "read");
    slabs::declare_turn(&mut source, plan);
    if energy {
        curvature(&mut source, plan, columns);
    }
    source.push_str(&LineWriter::declarations(columns));
    source.push_str(catalogue::FFT);
    factors.define(&mut source, plan);
    let [x, y] = LineWriter::workgroup_size(columns, false);
    work.declare(&mut source);
    let _ = write!(
        source,
        "@group(1) @binding(0) var<storage, read> roots: array<vec2<real>>;\n\
         @group(1) @binding({factors}) var<storage, read> factors: array<real>;\n\
         @compute @workgroup_size({x}, {y})\n\
         fn multiply(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) place: vec3<u32>, @builtin(local_invocation_index) index_in_group: u32) {{\n\
         if (!{gate}()) {{ return; }}\n\
         {start}\
         let thread = place.x;\n\
         let line = place.y;\n\
         let column = {before}group.x * LINES + line;\n\
         let inside = {inside};\n\
         let own = column == 0u || 2u * column == {width}u;\n\
         let here = {here} * {pairs}u;\n\
         let mirror_column = select({width}u - column, 0u, column == 0u);\n\
         let there = {there} * {pairs}u;\n\
         if ({first_turn}group.x == 0u && index_in_group == 0u) {{ partials.transforms = partials.transforms + 2u; }}\n",
        gate = gate_name(gate),
        start = if energy { "start_sums();\n" } else { "" },
        factors = 1 + plan.slabs,
        here = plan.place_of("column"),
        there = plan.place_of("mirror_column"),
        before = after_turns(plan.parts, plan.part_columns()),
        first_turn = first_turn(plan.parts),
        inside = match plan.parts {
            1 => format!("column < {}u", plan.column_count()),
            _ => format!(
                "group.x * LINES + line < {}u && column < {}u",
                plan.part_columns(),
                plan.column_count()
            ),
        },
    );
    let (first, last) = ends(columns);
    let mut writer = LineWriter::new(columns, false);
    writer.source.push_str("if (inside) {\n");
    writer.butterflies(first, |source, each| {
        for leg in 0..first / 2 {
            let _ = writeln!(
                source,
                "{{ let z = {z};\n\
                 let mirror = {mirror};\n\
                 {a} = 0.5 * vec2<real>(z.x + mirror.x, z.y - mirror.y);\n\
                 {b} = 0.5 * vec2<real>(z.y + mirror.y, mirror.x - z.x); }}",
                z = work.read("here", leg * each.stride, each.stride),
                mirror = work.read("there", leg * each.stride, each.stride),
                a = each.name(leg),
                b = each.name(leg + first / 2),
            );
        }
    });
    writer.source.push_str("}\n");
    writer.transform(Direction::Forward);
    let scale = literal(1.0 / plan.points() as f64);
    writer.source.push_str("if (inside) {\n");
    if energy {
        writer
            .source
            .push_str("let weight = select(real(2.0), real(1.0), own);\n");
    }
    writer.butterflies(last, |source, each| {
        for leg in 0..each.radix {
            let name = each.name(leg);
            let _ = writeln!(
                source,
                "{{ let row = {at};\n\
                 let factor = factor_of(column, min(row, {height}u - row));",
                at = each.position(leg),
            );
            if energy {
                let _ = writeln!(
                    source,
                    "into_curvature(wide(weight * factor * dot({name}, {name})));"
                );
            }
            let _ = writeln!(source, "{name} = ({scale} * factor) * {name}; }}");
        }
    });
    writer.source.push_str("}\n");
    writer.transform(Direction::Inverse);
    writer.source.push_str("if (inside) {\n");
    writer.butterflies(first, |source, each| {
        for leg in 0..first / 2 {
            let (a, b) = (each.name(leg), each.name(leg + first / 2));
            let own = format!("vec2<real>({a}.x - {b}.y, {a}.y + {b}.x)");
            let mirror = format!("vec2<real>({a}.x + {b}.y, {b}.x - {a}.y)");
            let (from, count) = (leg * each.stride, each.stride);
            let _ = writeln!(
                source,
                "{}\nif (!own) {{ {} }}",
                work.write("here", from, count, &own),
                work.write("there", from, count, &mirror),
            );
        }
    });
    writer.source.push_str("}\n");
    source.push_str(&writer.source);
    if energy {
        source.push_str("hand_in(group.x, index_in_group);\n");
    }
    source.push_str("}\n");
    source
}
