//! The shader that copies a buffer, to measure its rate.

use super::super::catalogue;

/// Most workgroups; each of their threads copies several numbers beyond.
const GROUPS: usize = 32768;

/// The shader that copies this many groups of four numbers, and its workgroups. The entry point is `copy`.
pub fn copy(count: usize, threads: usize) -> (String, usize) {
    let groups = count.div_ceil(threads).min(GROUPS);
    let stride = groups * threads;
    let source = format!(
        "const COPY_COUNT: u32 = {count}u;\n\
         const COPY_THREADS: u32 = {threads}u;\n\
         const COPY_STRIDE: u32 = {stride}u;\n{}",
        catalogue::COPY
    );
    (source, groups)
}
