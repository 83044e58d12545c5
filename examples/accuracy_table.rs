//! Time for accuracy: a scene over grids and tolerances; prints the table of `docs/benchmarks.md`.
//!
//! `cargo run --release --example accuracy_table [POINTS]` solves the first two steps of
//! `examples/scenes/rough.toml`, up to 1 MPa, on 256, 512 and 1024 points to 1e-4, 1e-6 and 1e-8, and
//! compares them with POINTS (default 2048) points at 1e-8.

use std::error::Error;
use std::path::Path;
use std::time::Instant;

use tabor::device::SelectedDevice;
use tabor::scene::Scene;
use tabor::study::{Setup, walk};
use tabor::surface::Surface;

struct Answer {
    contact: f64,
    corrected: f64,
    mean_gap: f64,
    transforms: f64,
    seconds: f64,
}

fn solve(points: usize, tolerance: f64) -> Result<Answer, Box<dyn Error>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/scenes/rough.toml");
    let overrides = [
        ("grid.points", points.to_string()),
        ("solver.tolerance", format!("{tolerance:e}")),
        ("solver.backend", "\"cpu\"".to_owned()),
        ("loading.path", "[\"0.5 MPa\", \"1 MPa\"]".to_owned()),
        ("output.steps", "\"last\"".to_owned()),
    ]
    .map(|(key, value)| (key.to_owned(), value));
    let scene = Scene::read(&path, &overrides)?;
    let surface = Surface::build(&scene)?;
    let setup = Setup::new(scene, surface);
    let device = SelectedDevice::new(&setup, false)?;
    let make_backend = || device.backend();
    let clock = Instant::now();
    let end = walk(&setup, &make_backend, &mut ())?;
    let row = end.rows.last().ok_or("the path has two steps")?;
    Ok(Answer {
        contact: row.contact_area_fraction,
        corrected: row.contact_area_fraction_corrected.ok_or("a wall")?,
        mean_gap: row.mean_gap.ok_or("in contact")?,
        transforms: end.transforms,
        seconds: clock.elapsed().as_secs_f64(),
    })
}

fn main() -> Result<(), Box<dyn Error>> {
    let finest: usize = match std::env::args().nth(1) {
        Some(text) => text.parse()?,
        None => 2048,
    };
    let reference = solve(finest, 1e-8)?;
    println!(
        "Reference: {finest} points, 1e-8, {:.0} transforms, {:.1} s: contact {:.3} %, corrected {:.3} %, mean gap {:.4} nm\n",
        reference.transforms,
        reference.seconds,
        100.0 * reference.contact,
        100.0 * reference.corrected,
        1e9 * reference.mean_gap
    );
    println!(
        "| points | tolerance | seconds | transforms | contact area off by | corrected | mean gap off by |"
    );
    println!("|---|---|---|---|---|---|---|");
    for points in [256, 512, 1024] {
        for tolerance in [1e-4, 1e-6, 1e-8] {
            let answer = solve(points, tolerance)?;
            let off = |value: f64, exact: f64| 100.0 * (value / exact - 1.0);
            println!(
                "| {points} | {tolerance:.0e} | {:.2} | {:.0} | {:+.3} % | {:+.3} % | {:+.3} % |",
                answer.seconds,
                answer.transforms,
                off(answer.contact, reference.contact),
                off(answer.corrected, reference.corrected),
                off(answer.mean_gap, reference.mean_gap)
            );
        }
    }
    Ok(())
}
