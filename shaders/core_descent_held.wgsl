// As core_descent, where the mean gap is held.
@group(1) @binding(0) var<storage, read> gap: array<real>;
@group(1) @binding(1) var<storage, read> pressure: array<real>;
@group(1) @binding(2) var<storage, read> free_before: array<real>;
@group(1) @binding(3) var<storage, read> direction: array<real>;

fn pass_point(index: u32, on_surface: bool, line_value: real) -> real {
    let here = descent_in_v(gap[index], pressure[index], line_value, on_surface);
    let z = wide(here.z);
    let y = wide(here.y);
    let s2 = wide(here.s2);
    let d = wide(direction[index]);
    let change = y - wide(free_before[index]);
    add_sum(0u, z * y);
    add_sum(1u, z * change);
    add_sum(2u, d * change);
    add_sum(3u, d * y);
    add_sum(4u, s2 * z);
    add_sum(5u, s2);
    add_sum(6u, y);
    add_sum(7u, change);
    add_sum(8u, s2 * d);
    return here.z;
}
