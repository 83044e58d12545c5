// Keeps the preconditioned residual in v.
@group(1) @binding(0) var<storage, read> gap: array<real>;
@group(1) @binding(1) var<storage, read> pressure: array<real>;
@group(1) @binding(2) var<storage, read> free_before: array<real>;

fn pass_point(index: u32, on_surface: bool, line_value: real) -> real {
    let here = descent_in_v(gap[index], pressure[index], line_value, on_surface);
    let z = wide(here.z);
    add_sum(0u, z * wide(here.y));
    add_sum(1u, z * (wide(here.y) - wide(free_before[index])));
    return here.z;
}
