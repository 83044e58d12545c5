// What every kernel sees: the fixed numbers, those the algorithm moves, and room for sums.
// `wide`, `Params`, `Scalars` and the names of a status are declared by the program that joins these sources.
struct Partials {
    // Transforms of rows run on this level, forward and back one each, a multiplication two.
    transforms: u32,
    // One value a workgroup, sum after sum.
    values: array<part>,
}
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read_write> partials: Partials;

// By the exponent's bits: a comparison of a number with itself may be optimised away.
fn is_finite(value: wide) -> bool {
    return (bitcast<u32>(f32(IN_SINGLE * value)) & 0x7f800000u) != 0x7f800000u;
}

fn is_nan(value: wide) -> bool {
    return (bitcast<u32>(f32(value)) & 0x7fffffffu) > 0x7f800000u;
}
