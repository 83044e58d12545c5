//! Cost and results of interacting asperities and of the full field under the same loads.
//!
//! `cargo run --release --example icha_cost [POINTS]`: a self-affine surface of POINTS x POINTS
//! (default 1024), Hurst exponent 0.8, roll-off at a quarter of the side, 8 pixels across the
//! shortest wave. Both solve each load without a previous state; CPU seconds of all threads.

use std::error::Error;
use std::path::Path;

use cpu_time::ProcessTime;
use tabor::backend::cpu;
use tabor::scene::Scene;
use tabor::study::{Setup, walk};
use tabor::surface::Surface;
use tabor::theory::icha::{Icha, MergeRule};

/// Mean pressures in E* times the rms slope.
const LOADS: [f64; 4] = [0.005, 0.02, 0.05, 0.1];

fn main() -> Result<(), Box<dyn Error>> {
    let points: usize = match std::env::args().nth(1) {
        Some(text) => text.parse()?,
        None => 1024,
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
        "#,
        8.0 / points as f64
    );
    let mut scene = Scene::parse(&scene, "icha_cost", Path::new("."), &[])?;
    let surface = Surface::build(&scene)?;
    let clock = ProcessTime::now();
    let now = || clock.elapsed().as_secs_f64();
    let before = now();
    let asperities = Icha::new(surface.grid, &surface.heights)?;
    println!(
        "{} summits found in {:.2} s, once a surface",
        asperities.summits().len(),
        now() - before
    );
    println!(
        "load   field: seconds area    mean gap   ICHA: contact gap    area    mean gap   ratio"
    );
    let cpu = || cpu::double(None);
    for load in LOADS {
        scene.loading.path = vec![load];
        let setup = Setup::new(scene.clone(), surface.clone());
        let before = now();
        let end = walk(&setup, &cpu, &mut ())?;
        let field = now() - before;
        let before = now();
        let pressed = asperities.loading(MergeRule::Volume).press(load)?;
        let contact = now() - before;
        let before = now();
        let gap = pressed.gap(&asperities);
        let gap_seconds = now() - before;
        let row = &end.rows[0];
        println!(
            "{load:<13} {field:7.2} {:.5} {:.5}   {contact:13.2} {gap_seconds:.2} {:.5} {:.5} {:7.2}",
            row.contact_area_fraction_corrected
                .unwrap_or(row.contact_area_fraction),
            row.mean_gap.unwrap_or(f64::NAN),
            pressed.contact_area_fraction(),
            gap.mean(),
            (contact + gap_seconds) / field
        );
    }
    Ok(())
}
