// Stores the preconditioned residual in v and replaces the old S2 y by the new one.
@group(1) @binding(0) var<storage, read> gap: array<real>;
@group(1) @binding(1) var<storage, read> pressure: array<real>;
@group(1) @binding(2) var<storage, read> direction: array<real>;
@group(1) @binding(3) var<storage, read_write> descent: array<real>;
@group(1) @binding(4) var<storage, read_write> free_before: array<real>;

fn store_point(index: u32, on_surface: bool, line_value: real) {
    let g = gap[index];
    let y_here = pressure[index] + real(scalars.mean_pressure) + attraction(g, on_surface);
    let hard = hardening(g, on_surface);
    let stiffness = real(params.core_stiffness);
    let s2 = stiffness / (stiffness + hard);
    // z / S2: the long-range part, and the local part that the core's own stiffness answers.
    let z = line_value + hard / stiffness * y_here / (hard + stiffness);
    let y = s2 * y_here;
    let d = wide(direction[index]);
    let change = wide(y) - wide(free_before[index]);
    add_sum(0u, wide(z) * wide(y));
    add_sum(1u, wide(z) * change);
    add_sum(2u, d * change);
    add_sum(3u, d * wide(y));
    add_sum(4u, wide(s2) * wide(z));
    add_sum(5u, wide(s2));
    add_sum(6u, wide(y));
    add_sum(7u, change);
    add_sum(8u, wide(s2) * d);
    descent[index] = z;
    free_before[index] = y;
}
