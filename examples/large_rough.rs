//! A large rough surface pressed against a half-space, without adhesion, on the CPU.
//!
//! `cargo run --release --example large_rough [POINTS]`: a grid of POINTS x POINTS (default 4096)
//! and one line on its cost. Self-affine, Hurst exponent 0.8, roll-off at a quarter of the side, 8
//! pixels across the shortest wave, rms slope 1; mean pressure 0.05 E* times the rms slope.

use std::convert::Infallible;
use std::error::Error;
use std::path::Path;
use std::time::Instant;

use tabor::device::SelectedDevice;
use tabor::kernel::Scalars;
use tabor::output::peak_memory_bytes;
use tabor::scene::Scene;
use tabor::study::{FinishedStep, Observer, Setup, walk};
use tabor::surface::Surface;

/// Prints every tenth iteration on standard error.
struct Report;

impl Observer for Report {
    type Error = Infallible;

    fn step(&mut self, _: FinishedStep) -> Result<(), Infallible> {
        Ok(())
    }

    fn iteration(&mut self, _: usize, scalars: &Scalars) -> bool {
        if (scalars.iterations as usize).is_multiple_of(10) {
            eprintln!(
                "iteration {:>3}, residual {:.1e}",
                scalars.iterations, scalars.residual
            );
        }
        true
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let points: usize = match std::env::args().nth(1) {
        Some(text) => text.parse()?,
        None => 4096,
    };
    let scene = format!(
        r#"
        [grid]
        points = {points}
        size = 1.0
        [solid]
        contact_modulus = 1.0
        [[surface]]
        kind = "self-affine"
        hurst = 0.8
        rms_slope = 1.0
        longest = 1.0
        rolloff = 0.25
        shortest = {:e}
        [loading]
        control = "pressure"
        path = [0.05]
        [solver]
        backend = "cpu"
        "#,
        8.0 / points as f64
    );
    let scene = Scene::parse(&scene, "large_rough", Path::new("."), &[])?;
    let surface = Surface::build(&scene)?;
    let setup = Setup::new(scene, surface);
    let device = SelectedDevice::new(&setup, false)?;
    let make_backend = || device.backend();
    let clock = Instant::now();
    let end = walk(&setup, &make_backend, &mut Report)?;
    let seconds = clock.elapsed().as_secs_f64();
    let row = &end.rows[0];
    println!(
        "{points} x {points} points: contact area {:.4} %, residual {:.1e}, {} iterations, {:.1} transforms, {seconds:.1} s, peak memory {}",
        100.0 * row.contact_area_fraction,
        row.residual,
        row.iterations,
        end.transforms,
        match peak_memory_bytes() {
            Some(bytes) => format!("{:.2} GiB", bytes as f64 / f64::from(1 << 30)),
            None => "unknown".to_owned(),
        }
    );
    Ok(())
}
