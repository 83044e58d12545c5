//! Kernels on the lines of a transform: the shader around the kernel's own part.
//!
//! A workgroup works on some pairs of rows. Before the first stage of a forward transform and after the
//! last one of an inverse, a thread holds the values of a pair at places that are the same for both;
//! the kernel's own part runs there, and retained rows are stored in the work space in that order.

use std::fmt::Write;

use super::super::butterfly::Direction;
use super::super::catalogue;
use super::super::fft::LineWriter;
use super::super::level::LevelPlan;
use super::slabs::first_turn;
use super::visits::visits;
use super::{ends, frame, long};
use crate::kernel::Kernel;

/// The beginning of a kernel on pairs of rows; `pair` is this thread's pair.
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
         if ({first_turn}group.x == 0u && index_in_group == 0u) {{ partials.transforms = partials.transforms + {transforms}u; }}\n",
        name = kernel.name,
        first_turn = first_turn(plan.slabs),
    );
}

/// The entry point of a kernel on lines.
pub fn rows_main(source: &mut String, kernel: &Kernel, plan: &LevelPlan) {
    let form = kernel.form;
    let (open, close) = frame(kernel);
    head(source, kernel, plan, &open);
    let (first, last) = ends(&plan.rows);
    let mut writer = long::row_writer(plan);
    let (begin, end) = long::row_frame(plan);
    source.push_str(&begin);
    let take = |writer: &mut LineWriter, radix: usize| {
        writer.source.push_str("if (inside) {\n");
        writer.butterflies(radix, |source, each| {
            for leg in 0..each.radix {
                let at = long::row_place(plan, &each.position(leg));
                let _ = writeln!(source, "{} = {at};", each.name(leg));
            }
        });
        writer.source.push_str("}\n");
    };
    let give = |writer: &mut LineWriter, radix: usize| {
        writer.source.push_str("if (inside) {\n");
        writer.butterflies(radix, |source, each| {
            for leg in 0..each.radix {
                let at = long::row_place(plan, &each.position(leg));
                let _ = writeln!(source, "{at} = {};", each.name(leg));
            }
        });
        writer.source.push_str("}\n");
    };
    if form.after_inverse() {
        take(&mut writer, last);
        long::row_turn(&mut writer, plan, Direction::Inverse);
        writer.transform(Direction::Inverse);
    } else if form.takes_retained() {
        take(&mut writer, first);
    }
    writer.source.push_str("if (inside) {\n");
    visits(&mut writer, form, plan, first);
    writer.source.push_str("}\n");
    if form.before_forward() {
        writer.transform(Direction::Forward);
        long::row_turn(&mut writer, plan, Direction::Forward);
        give(&mut writer, last);
    } else if form.retains() {
        give(&mut writer, first);
    }
    source.push_str(&writer.source);
    source.push_str(end);
    source.push_str(close);
    source.push_str("}\n");
}
