//! Flat surfaces, spikes, plateaus and steps.

use std::f64::consts::PI;

use super::case::{Case, Contact, Law};
use super::paths::Path;
use super::truth::Fields;
use crate::shared::random::Random;

const FLAT: &str = "[[surface]]\nkind = \"flat\"\n";
pub const FILE: &str = "[[surface]]\nkind = \"file\"\npath = \"heights.npy\"\n";
pub const NAME: &str = "heights.npy";

/// So weak and long-ranged that the uniform state is the only one: w/range^2 below the softest pi E*.
const WORK: f64 = 1e-3;
const RANGE: f64 = 0.05;
const PEAK: f64 = WORK / RANGE;

/// Numbers in [0, 1) from a seed.
pub fn noise(count: usize, seed: u64) -> Vec<f64> {
    let mut random = Random(seed);
    (0..count).map(|_| random.share()).collect()
}

fn close(found: f64, expected: f64, path: &Path) {
    let off = (found - expected).abs();
    let allowed = (10.0 * path.tolerance) * expected.abs();
    assert!(off <= allowed, "{found:e}, not {expected:e}");
}

fn flats() -> Vec<Case> {
    let cell = |law| Contact::cell(16, law);
    vec![
        Case::new("flat on flat, wall", cell(Law::Wall), FLAT)
            .under("pressure", [0.3, 1e6, 0.0, 0.3])
            .so_that(|run, _| {
                assert_eq!(run.states(), ["contact", "contact", "separated", "contact"]);
                let pressure = run.field(4, "pressure").expect("a field");
                assert!(
                    pressure.iter().all(|p| (p - 0.3).abs() < 1e-6),
                    "{pressure:?}"
                );
            }),
        Case::new(
            "flat on flat, Maugis-Dugdale",
            cell(Law::MaugisDugdale {
                work: WORK,
                range: RANGE,
                taper: None,
            }),
            FLAT,
        )
        .under("pressure", [0.3, -0.5 * PEAK, -1.5 * PEAK, 0.3])
        .so_that(|run, _| {
            assert_eq!(run.states(), ["contact", "contact", "separated", "contact"]);
            assert!([0, 1, 3].iter().all(|i| run.rows[*i].contact == 1.0));
        }),
        Case::new(
            "flat on flat, exponential at prescribed gaps",
            cell(Law::Exponential {
                work: WORK,
                range: RANGE,
            }),
            FLAT,
        )
        .under("mean-gap", [2.0 * RANGE, 0.5 * RANGE, 0.0, 0.5 * RANGE])
        .so_that(|run, path| {
            for (row, share) in run.rows.iter().zip([2.0_f64, 0.5]) {
                close(row.mean_pressure, -PEAK * (-share).exp(), path);
            }
            close(run.rows[3].mean_pressure, -PEAK * (-0.5_f64).exp(), path);
        }),
        // sigma at half the range and at twice it, of w/range (theory of the 9-3 law).
        Case::new(
            "flat on flat, Lennard-Jones at prescribed gaps",
            cell(Law::LennardJones {
                work: WORK,
                range: RANGE,
            }),
            FLAT,
        )
        .under("mean-gap", [2.0 * RANGE, 0.5 * RANGE])
        .so_that(|run, path| {
            for (row, share) in run.rows.iter().zip([0.098_629_951_4, 0.720_757_337]) {
                close(row.mean_pressure, -PEAK * share, path);
            }
        }),
        Case::new(
            "flat on flat, Lennard-Jones pressed",
            cell(Law::LennardJones {
                work: WORK,
                range: RANGE,
            }),
            FLAT,
        )
        .under("pressure", [PEAK, 100.0 * PEAK])
        .so_that(|run, path| {
            for (row, share) in run.rows.iter().zip([1.0, 100.0]) {
                let near = RANGE / (row.mean_gap.expect("a gap") + RANGE);
                let repelled = 8.0 / 3.0 * PEAK * (near.powi(9) - near.powi(3));
                close(repelled, share * PEAK, path);
            }
        }),
    ]
}

/// A rigid strip on every wave: p = pbar cos(pi x)/sqrt(sin^2(pi a) - sin^2(pi x)), which is the flat
/// punch repeated (its integral is pbar, and its displacement flat).
fn punch() -> Case {
    let heights = (0..64 * 4).map(|i| {
        if (16..48).contains(&(i % 64)) {
            1.0
        } else {
            0.0
        }
    });
    let contact = Contact {
        points: [64, 4],
        size: [1.0, 0.0625],
        ..Contact::cell(64, Law::Wall)
    };
    Case::new("a strip with sharp edges", contact, FILE)
        .with_file(NAME, heights.collect())
        .under("pressure", [0.01])
        .so_that(|run, _| {
            assert_eq!(run.rows[0].contact, 0.5);
            let fields = Fields::at_step(run, 1).expect("fields");
            for i in 24..40 {
                let x = (i as f64 + 0.5) / 64.0 - 0.5;
                let room = (PI * 0.25).sin().powi(2) - (PI * x).sin().powi(2);
                let expected = 0.01 * (PI * x).cos() / room.sqrt();
                // The edge lies somewhere within half a pixel: pi cot(pi a)/128 of the pressure in the middle.
                let off = (fields.pressure[i] / expected - 1.0).abs();
                assert!(
                    off < 0.025 + 0.5 * (x.abs() / 0.125) * 0.025,
                    "{x}: off by {off}"
                );
            }
        })
}

fn steps() -> Vec<Case> {
    let stairs: Vec<f64> = (0..1024)
        .map(|i| 0.01 * ((i % 32 / 8) as f64 + (i / 32 / 8) as f64))
        .collect();
    let board: Vec<f64> = (0..1024)
        .map(|i| {
            if (i % 32 / 4 + i / 32 / 4) % 2 == 0 {
                0.01
            } else {
                0.0
            }
        })
        .collect();
    let adhesive = Law::MaugisDugdale {
        work: 1e-4,
        range: 4e-3,
        taper: None,
    };
    let cell = |law| Contact::cell(32, law);
    vec![
        Case::new("stairs, wall", cell(Law::Wall), FILE)
            .with_file(NAME, stairs.clone())
            .under("pressure", [0.003, 0.1]),
        Case::new("stairs, Maugis-Dugdale", cell(adhesive), FILE)
            .with_file(NAME, stairs)
            .under("pressure", [0.01, -0.002]),
        Case::new("plateaus, wall", cell(Law::Wall), FILE)
            .with_file(NAME, board.clone())
            .under("pressure", [0.01, 1.0]),
        Case::new("plateaus, Maugis-Dugdale", cell(adhesive), FILE)
            .with_file(NAME, board)
            .under("pressure", [0.01, -0.002]),
    ]
}

fn spikes() -> Vec<Case> {
    let mut one = vec![0.0; 1024];
    one[528] = 0.1;
    let many: Vec<f64> = noise(1024, 7)
        .into_iter()
        .map(|x| if x > 0.95 { 4.0 * (x - 0.95) } else { 0.0 })
        .collect();
    let white: Vec<f64> = noise(1024, 3).into_iter().map(|x| 0.01 * x).collect();
    let cell = |law| Contact::cell(32, law);
    let exponential = Law::Exponential {
        work: 1e-5,
        range: 2e-3,
    };
    vec![
        Case::new("one spike", cell(Law::Wall), FILE)
            .with_file(NAME, one)
            .under("pressure", [1e-4, 1.0])
            .so_that(|run, _| {
                assert_eq!(run.rows[0].contact, 1.0 / 1024.0);
                assert!(run.rows[1].contact > 0.5);
            }),
        Case::new("a surface of spikes", cell(Law::Wall), FILE)
            .with_file(NAME, many)
            .under("pressure", [1e-3, 0.1, 10.0]),
        Case::new("white noise, wall", cell(Law::Wall), FILE)
            .with_file(NAME, white.clone())
            .under("pressure", [0.01, 0.1]),
        Case::new("white noise, exponential", cell(exponential), FILE)
            .with_file(NAME, white)
            .under("pressure", [0.01, -1e-4]),
    ]
}

pub fn cases() -> Vec<Case> {
    let mut cases = flats();
    cases.push(punch());
    cases.extend(steps());
    cases.extend(spikes());
    cases
}
