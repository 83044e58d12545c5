//! Writes a synthetic force curve: `cargo run --release --example force_curve`.
//!
//! A Maugis-Dugdale sphere of 10 um touches a flat and leaves it, with an unknown zero of the
//! approach and noise of 2 % of the pull-off. Redirected to `examples/force_curve.csv` it is the
//! curve of `docs/fit.md`.

use std::f64::consts::{PI, TAU};

use tabor::fit::Model;
use tabor::fit::model::{IndenterModel, Parameters};

const RADIUS: f64 = 10e-6;
/// Points of one direction.
const POINTS: usize = 160;
const NOISE: f64 = 20e-9;

/// Random numbers between 0 and 1: splitmix64.
struct Random(u64);

impl Random {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Of variance 1 (Box & Muller 1958).
    fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (TAU * self.uniform()).cos()
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let truth = Parameters {
        contact_modulus: 7.7e9,
        work_of_adhesion: 0.03,
        maugis_parameter: 0.6,
        approach_offset: 12e-9,
        force_offset: 0.0,
        baseline_slope: 0.0,
    };
    let modulus = 4.0 * truth.contact_modulus / 3.0;
    let unit = (PI * truth.work_of_adhesion / modulus).powi(2) * RADIUS;
    let unit = unit.cbrt();
    // The attraction starts at the range, 2/(pi lambda) in these units, and ends beyond it.
    let range = 2.0 / (PI * truth.maugis_parameter);
    let grip = range + 0.5 * (8.0 * truth.maugis_parameter / (3.0 * PI)).powi(2);
    let place = |i: usize| -2.5 + 6.5 * i as f64 / (POINTS - 1) as f64;
    let ways = (0..POINTS)
        .map(|i| (place(i), -range))
        .chain((0..POINTS - 1).rev().map(|i| (place(i), -grip)));
    let model = IndenterModel::new(Model::MaugisDugdale, RADIUS);
    let mut random = Random(7);
    println!("# sphere of radius 10 um; made by `cargo run --release --example force_curve`");
    println!("approach [nm],force [nN]");
    for (approach, last) in ways {
        let at = truth.approach_offset + unit * approach;
        let force = if approach < last {
            0.0
        } else {
            model.forces(&truth, &[at])?[0]
        };
        let force = force + NOISE * random.normal();
        println!("{:.4},{:.3}", 1e9 * at, 1e9 * force);
    }
    Ok(())
}
