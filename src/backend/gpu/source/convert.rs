//! The shader that converts a field to another number type.

use super::super::layout::Number;
use super::super::level::{SWEEP_GROUPS, SWEEP_THREADS};

/// The shader, and its workgroups. Group 0 binds the source and the target; the entry point is `convert`.
pub fn convert(there: Number, here: Number, points: usize) -> (String, usize) {
    let groups = points.div_ceil(SWEEP_THREADS).min(SWEEP_GROUPS);
    let (from, to) = (there.name(), here.name());
    let text = format!(
        "@group(0) @binding(0) var<storage, read> there: array<{from}>;\n\
         @group(0) @binding(1) var<storage, read_write> here: array<{to}>;\n\
         @compute @workgroup_size({SWEEP_THREADS})\n\
         fn convert(@builtin(global_invocation_id) id: vec3<u32>) {{\n\
         for (var index = id.x; index < {points}u; index = index + {stride}u) {{\n\
         here[index] = {to}(there[index]);\n\
         }}\n}}\n",
        stride = groups * SWEEP_THREADS,
    );
    (text, groups)
}
