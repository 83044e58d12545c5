// Copies a buffer, some numbers at a time: how fast memory is to a kernel that does nothing else.
@group(0) @binding(0) var<storage, read> original: array<vec4<u32>>;
@group(0) @binding(1) var<storage, read_write> copied: array<vec4<u32>>;

@compute @workgroup_size(COPY_THREADS)
fn copy(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) thread: u32) {
    for (var index = group.x * COPY_THREADS + thread; index < COPY_COUNT; index = index + COPY_STRIDE) {
        copied[index] = original[index];
    }
}
