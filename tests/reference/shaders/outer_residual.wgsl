alias real = f32;
// declarations.wgsl
// common.wgsl
@group(0) @binding(1) var<storage, read> scalars: Scalars;
// gate.wgsl
// sums.wgsl
// reduce.wgsl
fn row_of(index: u32) -> u32 {
return index / 8u;
}
fn in_domain(index: u32) -> bool { return true; }
@group(1) @binding(0) var<storage, read> field_gap: array<real>;
fn read_gap(index: u32) -> real { return fields_here.gap; }
@group(1) @binding(1) var<storage, read> field_pressure: array<real>;
fn read_pressure(index: u32) -> real { return fields_here.pressure; }
@group(1) @binding(2) var<storage, read_write> field_residual: array<real>;
fn write_residual(index: u32, value: real) { field_residual[index] = value; }
const law_factor: real = 1.0;
struct Fields { gap: real, pressure: real,  }
var<private> fields_here: Fields;
fn fields_at(index: u32) -> Fields { return Fields(field_gap[index], field_pressure[index], ); }
fn visit(index: u32, fields: Fields, line: real) -> real { fields_here = fields; return at(index, in_domain(index), line); }
const WIDTH: u32 = 8u;
const HEIGHT: u32 = 8u;
// exp in single precision, where the device has it.
fn exponential(x: f32) -> f32 {
    return exp(x);
}

// exp(x) - 1 without cancellation: the series where it is short.
fn exp_less_one(x: f32) -> f32 {
    if (abs(x) > 0.5) {
        return exp(x) - 1.0;
    }
    let tail = 1.0 + x / 5.0 * (1.0 + x / 6.0 * (1.0 + x / 7.0 * (1.0 + x / 8.0)));
    return x * (1.0 + x / 2.0 * (1.0 + x / 3.0 * (1.0 + x / 4.0 * tail)));
}
// Tension that falls by e over each range.
fn law_traction(gap_here: real) -> real {
    let range = real(params.law_range);
    return law_factor * real(params.law_work) / range * exponential(-gap_here / range);
}

fn law_energy(gap_here: real) -> real {
    return -law_factor * real(params.law_work) * exponential(-gap_here / real(params.law_range));
}

fn law_slope(gap_here: real) -> real {
    return -law_traction(gap_here) / real(params.law_range);
}

// Ranges of a closing step beyond which its exponential may be past single precision. The gap it starts
// from then has next to no tension that could cancel.
const MOST_RANGES: real = 80.0;

// The gain of the traction over a step, to the rounding of the gain itself.
fn law_difference(gap_here: real, step: real) -> real {
    let ranges = -step / real(params.law_range);
    if (ranges > MOST_RANGES) {
        return law_traction(gap_here + step) - law_traction(gap_here);
    }
    return law_traction(gap_here) * exp_less_one(ranges);
}

// A law with a wall has no repulsion of its own.
fn law_repelling_gap(pressure: real) -> real {
    return 0.0;
}

// Asked of a law without a wall alone.
fn law_bend(gap_here: real) -> real {
    return 0.0;
}
// How kernels see the law where the unknown is the gap itself. Twins: law/mod.rs,
// law/adhesion_map.rs.
fn open(gap: real) -> real {
    return gap;
}

// The value of the unknown at which the surfaces touch.
fn closed_gap() -> real {
    return 0.0;
}

fn traction(gap: real) -> real {
    return law_traction(gap);
}

fn slope(gap: real) -> real {
    return law_slope(gap);
}

// What of a pressure enters the scale of the stopping measure.
fn weighed(pressure: real) -> real {
    return pressure;
}

fn corrects() -> bool {
    return false;
}

fn change(gap: real, moved: real) -> real {
    return law_traction(gap + moved) - law_traction(gap);
}

// The change of the energy of adhesion, and the size of what it was taken from.
fn energy_change(gap: real, moved: real) -> vec2<real> {
    let energy = law_energy(gap);
    return vec2<real>(law_energy(gap + moved) - energy, abs(energy));
}
// y of the outer state; without a law on the pad.
fn at(index: u32, in_domain: bool, line: real) -> real {
    let elastic = read_pressure(index) + real(scalars.mean_pressure);
    var pull = real(0.0);
    if (in_domain) {
        pull = traction(read_gap(index));
    }
    write_residual(index, elastic + pull);
    return line;
}
@compute @workgroup_size(256)
fn outer_residual(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) index_in_group: u32) {
if (!gate_always()) { return; }
for (var index = group.x * 256u + index_in_group; index < 64u; index = index + 256u) {
visit(index, fields_at(index), 0.0);
}
}
