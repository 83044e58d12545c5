//! Makes the heights of a punch with pillars, like a gecko's foot: round caps on a square lattice,
//! slightly domed, with rounded rims, of slightly different heights.
//!
//! ```text
//! cargo run --release --example patterned_punch > examples/scenes/patterned_punch.txt
//! ```

use std::fmt::Write;

/// Points a side.
const POINTS: usize = 96;
/// Size of a side, um.
const SIZE: f64 = 48.0;
/// Pillars a side.
const PILLARS: usize = 4;
/// Radius of a cap, um.
const CAP: f64 = 4.0;
/// Width of the rounded rim, um.
const RIM: f64 = 1.5;
/// Depth of the valleys between the pillars, nm.
const DEPTH: f64 = 3000.0;
/// Height difference between the middle and the rim of a cap, nm.
const DOME: f64 = 20.0;

/// Largest height difference between pillars, nm.
const SCATTER: f64 = 1200.0;

/// Height of each pillar below the highest, as a share of [`SCATTER`].
const SHORTER: [[f64; PILLARS]; PILLARS] = [
    [0.9, 0.2, 0.6, 1.0],
    [0.4, 0.0, 0.3, 0.7],
    [0.8, 0.1, 0.5, 0.3],
    [0.6, 0.9, 0.2, 0.7],
];

/// Height (nm) relative to the cap's at a distance (um) from the middle of a pillar.
fn pillar(distance: f64) -> f64 {
    let dome = -DOME * (distance / CAP).powi(2).min(1.0);
    // A quarter of a sine from the cap down to the valley.
    let rim = ((distance - CAP) / RIM).clamp(0.0, 1.0);
    dome - (DEPTH - DOME) * (1.0 - (std::f64::consts::PI * rim).cos()) / 2.0
}

fn main() {
    let pixel = SIZE / POINTS as f64;
    let pitch = SIZE / PILLARS as f64;
    // From the middle of the nearest pillar; points are at the middles of their pixels.
    let offset = |index: usize| {
        let place = (index as f64 + 0.5) * pixel;
        (place % pitch) - 0.5 * pitch
    };
    let lattice = |index: usize| index * PILLARS / POINTS;
    let mut text = format!(
        "# Punch with {PILLARS} x {PILLARS} pillars, made by: cargo run --release --example patterned_punch\n\
         # Width: {SIZE} um\n# Height: {SIZE} um\n# Value units: nm\n"
    );
    for row in 0..POINTS {
        for column in 0..POINTS {
            let shorter = SCATTER * SHORTER[lattice(row)][lattice(column)];
            let cap = pillar(offset(column).hypot(offset(row))) - shorter;
            let height = cap.max(-DEPTH);
            let end = if column + 1 < POINTS { ' ' } else { '\n' };
            // Whole nanometres are a hundredth of the law's range. Writing to a string cannot fail.
            let _ = write!(text, "{height:.0}{end}");
        }
    }
    print!("{text}");
}
