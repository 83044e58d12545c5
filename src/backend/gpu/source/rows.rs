//! Kernels that work on the lines of a transform: their shader around the kernel's own part.
//!
//! A workgroup works on some pairs of rows. Before the first stage of a forward transform and after the
//! last one of an inverse, a thread holds the values of a pair at places that are the same for both;
//! there the kernel's own part comes in, and lines that are kept lie in the work space by those places.

use std::fmt::Write;

use super::super::butterfly::Direction;
use super::super::catalogue;
use super::super::fft::LineWriter;
use super::super::level::LevelPlan;
use super::{ends, first_turn, frame};
use crate::kernel::{Form, Kernel};

/// The head of a kernel that works on pairs of rows; `pair` is this thread's.
fn head(source: &mut String, kernel: &Kernel, plan: &LevelPlan, open: &str) {
    source.push_str(&LineWriter::declarations(&plan.rows));
    source.push_str(catalogue::FFT);
    let [x, y] = LineWriter::workgroup_size(&plan.rows, true);
    let form = kernel.form;
    let transforms = u8::from(form.after_inverse()) + u8::from(form.before_forward());
    let _ = write!(
        source,
        "@group(2) @binding(0) var<storage, read> roots: array<vec2<real>>;\n\
         @group(2) @binding(1) var<storage, read_write> work: array<vec2<real>>;\n\
         @compute @workgroup_size({x}, {y})\n\
         fn {name}(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) place: vec3<u32>, @builtin(local_invocation_index) index_in_group: u32) {{\n\
         {open}\
         let line = place.x;\n\
         let thread = place.y;\n\
         let pair = group.x * LINES + line;\n\
         let inside = pair < {pairs}u;\n\
         if ({first_turn}group.x == 0u && index_in_group == 0u) {{ partials.transforms = partials.transforms + {transforms}u; }}\n",
        name = kernel.name,
        pairs = plan.slab_pairs(),
        first_turn = first_turn(plan.slabs),
    );
}

/// The entry point of a kernel on lines.
pub fn rows_main(source: &mut String, kernel: &Kernel, plan: &LevelPlan) {
    let form = kernel.form;
    let (open, close) = frame(kernel);
    head(source, kernel, plan, &open);
    let width = plan.shape[0];
    let (pairs, half) = (plan.slab_pairs(), plan.slab_pairs() * width);
    let (first, last) = ends(&plan.rows);
    let mut writer = LineWriter::new(&plan.rows, true);
    let take = |writer: &mut LineWriter, radix: usize| {
        writer.source.push_str("if (inside) {\n");
        writer.butterflies(radix, |source, each| {
            for leg in 0..each.radix {
                let (name, at) = (each.name(leg), each.position(leg));
                let _ = writeln!(source, "{name} = work[{at} * {pairs}u + pair];");
            }
        });
        writer.source.push_str("}\n");
    };
    let give = |writer: &mut LineWriter, radix: usize| {
        writer.source.push_str("if (inside) {\n");
        writer.butterflies(radix, |source, each| {
            for leg in 0..each.radix {
                let (name, at) = (each.name(leg), each.position(leg));
                let _ = writeln!(source, "work[{at} * {pairs}u + pair] = {name};");
            }
        });
        writer.source.push_str("}\n");
    };
    if form.after_inverse() {
        take(&mut writer, last);
        writer.transform(Direction::Inverse);
    } else if form.takes_kept() {
        take(&mut writer, first);
    }
    writer.source.push_str("if (inside) {\n");
    writer.butterflies(first, |source, each| {
        for leg in 0..each.radix {
            let name = each.name(leg);
            let at = |part: &str, offset: usize| match form {
                Form::Load => format!("load_point(index + {offset}u, arrive(index + {offset}u))"),
                Form::Store | Form::Peek => format!(
                    "store_point(index + {offset}u, arrive(index + {offset}u), {name}.{part})"
                ),
                _ => format!(
                    "pass_point(index + {offset}u, arrive(index + {offset}u), {name}.{part})"
                ),
            };
            let (upper, lower) = (at("x", 0), at("y", half));
            let position = each.position(leg);
            let _ = match form {
                Form::Store | Form::Peek => writeln!(
                    source,
                    "{{ let index = pair * {width}u + {position};\n{upper};\n{lower}; }}"
                ),
                _ => writeln!(
                    source,
                    "{{ let index = pair * {width}u + {position};\n\
                     let upper = {upper};\n{name} = vec2<real>(upper, {lower}); }}"
                ),
            };
        }
    });
    writer.source.push_str("}\n");
    if form.before_forward() {
        writer.transform(Direction::Forward);
        give(&mut writer, last);
    } else if form == Form::Keep {
        give(&mut writer, first);
    }
    source.push_str(&writer.source);
    source.push_str(close);
    source.push_str("}\n");
}
