//! Shaders of lines that are too long for a workgroup: the second pass of rows, and columns in three.
//!
//! A column's `ny` complex numbers are stored in its own `ny/2` places and those of its mirror image; the
//! two columns that are their own mirror images have a spare half.

use std::fmt::Write;

use super::super::butterfly::{Direction, literal};
use super::super::catalogue;
use super::super::fft::LineWriter;
use super::super::layout::Wide;
use super::super::level::LevelPlan;
use super::super::plan::LinePlan;
use super::slabs::{self, Work, after_turns, first_turn};
use super::{FactorSource, curvature, ends, gate_name, preamble};
use crate::kernel::Gate;

/// The three passes over long columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pass {
    /// Separates two columns and begins their transform.
    First,
    /// Ends it, multiplies, and begins the inverse.
    Middle,
    /// Ends the inverse and joins the columns.
    Last,
}

impl Pass {
    /// All passes, in order.
    pub const ALL: [Pass; 3] = [Pass::First, Pass::Middle, Pass::Last];
}

/// The WGSL that turns what a thread holds of part `part` of a line, after the first pass forward or
/// before it back; `turn` is the function.
pub(super) fn turn_parts(writer: &mut LineWriter, radix: usize, turn: &str, part: &str) {
    writer.butterflies(radix, |source, each| {
        for leg in 0..each.radix {
            let _ = writeln!(
                source,
                "{name} = {turn}({name}, roots[{part} * {at}]);",
                name = each.name(leg),
                at = each.position(leg),
            );
        }
    });
}

/// Where a place of this thread's line lies in the grid's rows.
pub(super) fn row_index(plan: &LevelPlan, position: &str) -> String {
    let width = plan.shape[0];
    match plan.row_parts() {
        1 => format!("pair * {width}u + {position}"),
        parts => format!("pair * {width}u + {position} * {parts}u + part"),
    }
}

/// Where it lies in the work space.
pub(super) fn row_place(plan: &LevelPlan, position: &str) -> String {
    let pairs = plan.slab_pairs();
    match plan.row_parts() {
        1 => format!("work[{position} * {pairs}u + pair]"),
        parts => format!("work[({position} * {parts}u + part) * {pairs}u + pair]"),
    }
}

/// What finds a thread's line, `pair` and, of long rows, `part`, around what is done with it.
pub(super) fn row_frame(plan: &LevelPlan) -> (String, &'static str) {
    let pairs = plan.slab_pairs();
    match plan.row_parts() {
        1 => (
            format!("let pair = group.x * LINES + line;\nlet inside = pair < {pairs}u;\n"),
            "",
        ),
        parts => {
            let (beside, at_once) = (plan.pairs_at_once(), plan.row_parts_at_once());
            let open = format!(
                "let pair = group.x * {beside}u + line % {beside}u;\n\
                 for (var block = 0u; block < {parts}u; block = block + {at_once}u) {{\n\
                 let part = block + line / {beside}u;\n\
                 let inside = pair < {pairs}u && part < {parts}u;\n"
            );
            (open, "}\n")
        }
    }
}

/// The writer of a kernel on rows.
pub(super) fn row_writer(plan: &LevelPlan) -> LineWriter<'_> {
    let writer = LineWriter::new(&plan.rows, true);
    match plan.row_parts() {
        1 => writer,
        _ => writer.again(),
    }
}

/// Turns what threads hold after the first pass over long rows, or before the last one back.
pub(super) fn row_turn(writer: &mut LineWriter, plan: &LevelPlan, direction: Direction) {
    if plan.row_parts() > 1 {
        let (_, last) = ends(&plan.rows);
        let turn = match direction {
            Direction::Forward => "turn",
            Direction::Inverse => "turn_back",
        };
        writer.source.push_str("if (inside) {\n");
        turn_parts(writer, last, turn, "part");
        writer.source.push_str("}\n");
    }
}

/// The second pass of long rows forward, or the first one back; `None` where rows are not long. Its
/// entry point is `rows_then`; its workgroups along y are the waves of the first pass.
pub fn rows_then(plan: &LevelPlan, direction: Direction, gate: Gate, wide: Wide) -> Option<String> {
    let then = plan.rows_then.as_ref()?;
    let (pairs, length) = (plan.slab_pairs(), then.length);
    let mut source = plan.number.declaration();
    preamble(&mut source, wide, "read");
    slabs::declare_turn(&mut source, plan);
    source.push_str(&LineWriter::declarations(then));
    source.push_str(catalogue::FFT);
    let [x, y] = LineWriter::workgroup_size(then, true);
    let _ = write!(
        source,
        "@group(1) @binding(0) var<storage, read> roots: array<vec2<real>>;\n\
         @group(1) @binding(1) var<storage, read_write> work: array<vec2<real>>;\n\
         @compute @workgroup_size({x}, {y})\n\
         fn rows_then(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) place: vec3<u32>) {{\n\
         if (!{gate}()) {{ return; }}\n\
         let line = place.x;\n\
         let thread = place.y;\n\
         let pair = group.x * LINES + line;\n\
         let inside = pair < {pairs}u;\n\
         let first = group.y * {length}u;\n",
        gate = gate_name(gate),
    );
    let (first, last) = ends(then);
    let [from, to] = match direction {
        Direction::Forward => [first, last],
        Direction::Inverse => [last, first],
    };
    let mut writer = LineWriter::new(then, true);
    let pass = |writer: &mut LineWriter, radix: usize, takes: bool| {
        writer.source.push_str("if (inside) {\n");
        writer.butterflies(radix, |source, each| {
            for leg in 0..each.radix {
                let name = each.name(leg);
                let at = format!("work[(first + {}) * {pairs}u + pair]", each.position(leg));
                let _ = match takes {
                    true => writeln!(source, "{name} = {at};"),
                    false => writeln!(source, "{at} = {name};"),
                };
            }
        });
        writer.source.push_str("}\n");
    };
    pass(&mut writer, from, true);
    writer.transform(direction);
    pass(&mut writer, to, false);
    source.push_str(&writer.source);
    source.push_str("}\n");
    Some(source)
}

/// Declares the spare halves and what reaches any of a column's places.
fn column_places(source: &mut String, plan: &LevelPlan, work: &Work) {
    let pairs = plan.pairs();
    let _ = write!(
        source,
        "@group(1) @binding({spare}) var<storage, read_write> spare: array<vec2<real>>;\n\
         var<private> here: u32;\nvar<private> there: u32;\n\
         var<private> own: bool;\nvar<private> own_half: u32;\n\
         fn take(at: u32) -> vec2<real> {{\n\
         if (at < {pairs}u) {{ return {lower}; }}\n\
         if (own) {{ return spare[own_half + at - {pairs}u]; }}\n\
         return {upper};\n}}\n\
         fn give(at: u32, value: vec2<real>) {{\n\
         if (at < {pairs}u) {{ {to_lower} }}\n\
         else if (own) {{ spare[own_half + at - {pairs}u] = value; }}\n\
         else {{ {to_upper} }}\n}}\n",
        spare = plan.slabs + 2,
        lower = work.read_at("here", "at"),
        upper = work.read_at("there", &format!("at - {pairs}u")),
        to_lower = work.write_at("here", "at", "value"),
        to_upper = work.write_at("there", &format!("at - {pairs}u"), "value"),
    );
}

/// One of the three passes over long columns; `None` where columns are not long. The entry point is
/// `multiply`. In the first and the last pass workgroups along y go over the parts of a column.
pub fn multiply_long(
    plan: &LevelPlan,
    pass: Pass,
    factors: FactorSource,
    energy: bool,
    gate: Gate,
    wide: Wide,
) -> Option<String> {
    let then = plan.columns_then.as_ref()?;
    let energy = energy && pass == Pass::Middle;
    let line: &LinePlan = match pass {
        Pass::Middle => then,
        Pass::First | Pass::Last => &plan.columns,
    };
    let [width, _] = plan.shape;
    let pairs = plan.pairs();
    let work = Work::new(plan);
    let mut source = plan.number.declaration();
    preamble(&mut source, wide, "read");
    slabs::declare_turn(&mut source, plan);
    if energy {
        curvature(&mut source, plan, line);
    }
    source.push_str(&LineWriter::declarations(line));
    source.push_str(catalogue::FFT);
    if pass == Pass::Middle {
        factors.define(&mut source, plan);
    }
    work.declare(&mut source);
    column_places(&mut source, plan, &work);
    let interleaved = pass != Pass::Middle;
    let [x, y] = LineWriter::workgroup_size(line, interleaved);
    let (of_line, of_thread) = match interleaved {
        true => ("x", "y"),
        false => ("y", "x"),
    };
    let counts = match pass {
        Pass::First => format!(
            "if ({}group.x == 0u && group.y == 0u && index_in_group == 0u) {{ partials.transforms = partials.transforms + 2u; }}\n",
            first_turn(plan.parts)
        ),
        _ => String::new(),
    };
    let _ = write!(
        source,
        "@group(1) @binding(0) var<storage, read> roots: array<vec2<real>>;\n\
         @group(1) @binding({factors}) var<storage, read> factors: array<real>;\n\
         @compute @workgroup_size({x}, {y})\n\
         fn multiply(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) place: vec3<u32>, @builtin(local_invocation_index) index_in_group: u32) {{\n\
         if (!{gate}()) {{ return; }}\n\
         {start}{counts}\
         let line = place.{of_line};\n\
         let thread = place.{of_thread};\n\
         let column = {before}group.x;\n\
         let mirror = select({width}u - column, 0u, column == 0u);\n\
         own = column == 0u || 2u * column == {width}u;\n\
         own_half = select({pairs}u, 0u, column == 0u);\n\
         here = {here} * {slab_pairs}u;\n\
         there = {there} * {slab_pairs}u;\n",
        factors = 1 + plan.slabs,
        gate = gate_name(gate),
        start = if energy { "start_sums();\n" } else { "" },
        before = after_turns(plan.parts, plan.part_columns()),
        here = plan.place_of("column"),
        there = plan.place_of("mirror"),
        slab_pairs = plan.slab_pairs(),
    );
    let inside = match plan.parts {
        1 => String::new(),
        _ => format!(" && column < {}u", plan.column_count()),
    };
    match pass {
        Pass::Middle => middle(&mut source, plan, then, &inside, energy),
        Pass::First | Pass::Last => {
            let _ = writeln!(
                source,
                "let part = group.y * LINES + line;\nlet inside = part < {}u{inside};",
                then.length
            );
            match pass {
                Pass::First => first_pass(&mut source, plan, then, &work),
                _ => last_pass(&mut source, plan, then, &work),
            }
        }
    }
    if energy {
        source.push_str("hand_in(group.x, index_in_group);\n");
    }
    source.push_str("}\n");
    Some(source)
}

/// Point `then a + b`, of b `part`, from both columns apart to wave c.
fn first_pass(source: &mut String, plan: &LevelPlan, then: &LinePlan, work: &Work) {
    let length = then.length;
    let (first, last) = ends(&plan.columns);
    let mut writer = LineWriter::new(&plan.columns, true);
    writer.source.push_str("if (inside) {\n");
    writer.butterflies(first, |source, each| {
        for leg in 0..first / 2 {
            let _ = writeln!(
                source,
                "{{ let at = {at} * {length}u + part;\n\
                 let z = {z};\n\
                 let mirror_z = {mirror};\n\
                 {a} = 0.5 * vec2<real>(z.x + mirror_z.x, z.y - mirror_z.y);\n\
                 {b} = 0.5 * vec2<real>(z.y + mirror_z.y, mirror_z.x - z.x); }}",
                at = each.position(leg),
                z = work.read_at("here", "at"),
                mirror = work.read_at("there", "at"),
                a = each.name(leg),
                b = each.name(leg + first / 2),
            );
        }
    });
    writer.source.push_str("}\n");
    writer.transform(Direction::Forward);
    writer.source.push_str("if (inside) {\n");
    turn_parts(&mut writer, last, "turn", "part");
    writer.butterflies(last, |source, each| {
        for leg in 0..each.radix {
            let _ = writeln!(
                source,
                "give({} * {length}u + part, {});",
                each.position(leg),
                each.name(leg)
            );
        }
    });
    writer.source.push_str("}\n");
    source.push_str(&writer.source);
}

/// All waves c of a column in turn, `LINES` at a time: over b to d, times the factor of `c + first d`,
/// and back.
fn middle(source: &mut String, plan: &LevelPlan, then: &LinePlan, inside: &str, energy: bool) {
    let waves = plan.columns.length;
    let length = then.length;
    let height = plan.shape[1];
    let _ = writeln!(
        source,
        "for (var block = 0u; block < {waves}u; block = block + LINES) {{\n\
         let wave = block + line;\n\
         let inside = wave < {waves}u{inside};"
    );
    let (first, last) = ends(then);
    let mut writer = LineWriter::new(then, false).again();
    writer.source.push_str("if (inside) {\n");
    writer.butterflies(first, |source, each| {
        for leg in 0..each.radix {
            let _ = writeln!(
                source,
                "{} = take(wave * {length}u + {});",
                each.name(leg),
                each.position(leg)
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
                "{{ let row = wave + {at} * {waves}u;\n\
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
        for leg in 0..each.radix {
            let _ = writeln!(
                source,
                "give(wave * {length}u + {}, {});",
                each.position(leg),
                each.name(leg)
            );
        }
    });
    writer.source.push_str("}\n");
    source.push_str(&writer.source);
    source.push_str("}\n");
}

/// From wave c back to point `then a + b`, of b `part`, and both columns together.
fn last_pass(source: &mut String, plan: &LevelPlan, then: &LinePlan, work: &Work) {
    let length = then.length;
    let (first, last) = ends(&plan.columns);
    let mut writer = LineWriter::new(&plan.columns, true);
    writer.source.push_str("if (inside) {\n");
    writer.butterflies(last, |source, each| {
        for leg in 0..each.radix {
            let _ = writeln!(
                source,
                "{} = take({} * {length}u + part);",
                each.name(leg),
                each.position(leg)
            );
        }
    });
    turn_parts(&mut writer, last, "turn_back", "part");
    writer.source.push_str("}\n");
    writer.transform(Direction::Inverse);
    writer.source.push_str("if (inside) {\n");
    writer.butterflies(first, |source, each| {
        for leg in 0..first / 2 {
            let (a, b) = (each.name(leg), each.name(leg + first / 2));
            let _ = writeln!(
                source,
                "{{ let at = {} * {length}u + part;\n{}\nif (!own) {{ {} }} }}",
                each.position(leg),
                work.write_at(
                    "here",
                    "at",
                    &format!("vec2<real>({a}.x - {b}.y, {a}.y + {b}.x)")
                ),
                work.write_at(
                    "there",
                    "at",
                    &format!("vec2<real>({a}.x + {b}.y, {b}.x - {a}.y)")
                ),
            );
        }
    });
    writer.source.push_str("}\n");
    source.push_str(&writer.source);
}
