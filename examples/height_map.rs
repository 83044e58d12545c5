//! Makes a synthetic height map of a ground surface, as from a profiler.
//!
//! `cargo run --release --example height_map > examples/scenes/ground.txt` makes the map of
//! `examples/scenes/ground.toml`: 128 x 128 heights in nm on 10 um x 10 um. Self-affine roughness,
//! scratches along a lay, a little instrument noise, and the tilt of a sample that was not level.
//! Every run gives the same numbers.

use std::f64::consts::TAU;

use tabor::grid::Grid;
use tabor::surface::self_affine::{heights, mix};
use tabor::surface::spectrum::SelfAffineSpectrum;

const POINTS: usize = 128;
const SIZE: f64 = 10e-6;
const SEED: u64 = 7;
const SCRATCHES: u64 = 90;
/// Rise along x and y, m/m.
const TILT: [f64; 2] = [0.021, -0.008];

/// Number `index` of a sequence of uniform numbers in `[0, 1)`.
fn uniform(index: u64) -> f64 {
    (mix(mix(SEED) ^ index) >> 11) as f64 / (1_u64 << 53) as f64
}

/// Distance between two positions on a closed line.
fn distance(a: f64, b: f64, length: f64) -> f64 {
    let apart = (a - b).rem_euclid(length);
    apart.min(length - apart)
}

/// Depth of all scratches at a point: meandering grooves along y with tapered ends.
fn scratches(x: f64, y: f64) -> f64 {
    (0..SCRATCHES)
        .map(|scratch| {
            let draw = |which: u64| uniform(8 * scratch + which);
            let wander = 0.02 * SIZE * (draw(5) - 0.5) * (TAU * (y / SIZE + draw(6))).sin();
            let width = SIZE * (0.01 + 0.015 * draw(1));
            let depth = 90e-9 * draw(2).powi(2);
            let half_length = SIZE * (0.2 + 0.4 * draw(3));
            let across = distance(x, SIZE * draw(0) + wander, SIZE) / width;
            let along = distance(y, SIZE * draw(4), SIZE) / half_length;
            depth * (-across * across).exp() / (1.0 + along.powi(8))
        })
        .sum()
}

fn main() {
    let grid = Grid::new([POINTS; 2], [SIZE; 2]);
    let spectrum = SelfAffineSpectrum {
        hurst: 0.8,
        long: TAU / SIZE,
        rolloff: TAU / (0.5 * SIZE),
        short: TAU / (0.08 * SIZE),
        plateau: 1.0,
    };
    let rough = heights(&spectrum.with_rms_height(25e-9), &grid, SEED);
    println!("# Ground surface, made by: cargo run --release --example height_map");
    println!("# Width: 10 um");
    println!("# Height: 10 um");
    println!("# Value units: nm");
    for (row, line) in rough.chunks_exact(POINTS).enumerate() {
        let heights: Vec<String> = line
            .iter()
            .enumerate()
            .map(|(column, rough)| {
                let (x, y) = (column as f64 * grid.dx(), row as f64 * grid.dy());
                let noise = 1e-9 * (uniform(1 << 32 | (row * POINTS + column) as u64) - 0.5);
                let height = rough - scratches(x, y) + TILT[0] * x + TILT[1] * y + noise;
                format!("{:.1}", 1e9 * height)
            })
            .collect();
        println!("{}", heights.join(" "));
    }
}
