// The sums that give the mean pressure under a held mean gap.
@group(1) @binding(0) var<storage, read> gap: array<real>;
@group(1) @binding(1) var<storage, read> pressure: array<real>;

fn point(index: u32, on_surface: bool) {
    add_balance(gap[index], pressure[index], on_surface);
}
