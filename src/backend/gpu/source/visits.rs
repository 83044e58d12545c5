//! A kernel's own part at the points of a thread: the real and imaginary parts of its values are points of the upper and the
//! lower row of a pair.

use std::fmt::Write;

use super::super::fft::LineWriter;
use super::super::level::LevelPlan;
use super::super::loops::{Loops, hidden};
use super::super::plan::LinePlan;
use super::long;
use crate::kernel::Form;

/// Values of a thread whose fields are read before the kernel's own part runs on the first: as many as its registers have room for.
const LEGS_TOGETHER: usize = 2;

/// Whether the kernel's own part takes the values of its rows.
fn takes_line(form: Form) -> bool {
    !matches!(form, Form::Load | Form::Retain)
}

/// Whether it leaves others in their place.
fn gives_line(form: Form) -> bool {
    !matches!(form, Form::Store | Form::ReadRetained)
}

/// Points between the two rows of a pair.
fn between_rows(plan: &LevelPlan) -> usize {
    plan.slab_pairs() * plan.shape[0]
}

/// Runs the kernel's own part on the values of the butterflies of a radix.
pub fn visits(writer: &mut LineWriter, form: Form, plan: &LevelPlan, radix: usize) {
    match plan.loops {
        Loops::Unrolled => written_out(writer, form, plan, radix),
        Loops::Kept => as_loop(writer, form, plan, radix),
    }
}

fn written_out(writer: &mut LineWriter, form: Form, plan: &LevelPlan, radix: usize) {
    let half = between_rows(plan);
    writer.butterflies(radix, |source, each| {
        let legs: Vec<usize> = (0..each.radix).collect();
        for together in legs.chunks(LEGS_TOGETHER) {
            for leg in together {
                let index = long::row_index(plan, &each.position(*leg));
                let _ = writeln!(
                    source,
                    "let index{leg} = {index};\n\
                     let upper{leg} = fields_at(index{leg});\n\
                     let lower{leg} = fields_at(index{leg} + {half}u);"
                );
            }
            for leg in together {
                let name = each.name(*leg);
                let line = |part: &str| match takes_line(form) {
                    true => format!("{name}.{part}"),
                    false => "0.0".to_owned(),
                };
                let upper = format!("visit(index{leg}, upper{leg}, {})", line("x"));
                let lower = format!("visit(index{leg} + {half}u, lower{leg}, {})", line("y"));
                let _ = match gives_line(form) {
                    true => writeln!(
                        source,
                        "{{ let upper = {upper};\n{name} = vec2<real>(upper, {lower}); }}"
                    ),
                    false => writeln!(source, "{upper};\n{lower};"),
                };
            }
        }
    });
}

fn as_loop(writer: &mut LineWriter, form: Form, plan: &LevelPlan, radix: usize) {
    let LinePlan {
        length, threads, ..
    } = plan.rows;
    let stride = length / radix;
    let values = stride.div_ceil(threads) * radix;
    let count = 2 * values;
    let each = |text: &dyn Fn(usize) -> String| (0..values).map(text).collect::<String>();
    let (from, line) = match takes_line(form) {
        true => (each(&|k| format!("v{k}.x, v{k}.y, ")), "numbers[number]"),
        false => (String::new(), "0.0"),
    };
    let (into, back) = match gives_line(form) {
        true => {
            let back = |k| {
                format!(
                    "v{k} = vec2<real>(numbers[{}], numbers[{}]);\n",
                    2 * k,
                    2 * k + 1
                )
            };
            ("numbers[number] = ", each(&back))
        }
        false => ("", String::new()),
    };
    let _ = write!(
        writer.source,
        "{{ var numbers = array<real, {count}>({from});\n\
         for (var number = 0u; number < {hidden}; number = number + 1u) {{\n\
         let value = number / 2u;\n\
         let j = thread + (value / {radix}u) * {threads}u;\n\
         if (j < {stride}u) {{\n\
         let index = {index} + (number % 2u) * {half}u;\n\
         {into}visit(index, fields_at(index), {line});\n\
         }}\n}}\n\
         {back}}}\n",
        hidden = hidden(count),
        index = long::row_index(plan, &format!("(j + (value % {radix}u) * {stride}u)")),
        half = between_rows(plan),
    );
}
