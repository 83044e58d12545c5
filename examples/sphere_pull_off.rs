//! A sphere jumps into contact, is pressed on and pulled off: the force-distance loop.
//!
//! `cargo run --release --example sphere_pull_off > loop.csv` solves `examples/scenes/sphere_pull_off.toml`
//! and prints the loop as CSV on standard output, step by step, and the pull-off force in units of
//! `pi w R` on standard error: 2 in the limit of long ranges (DMT), 1.5 in that of short ones (JKR).

use std::error::Error;
use std::f64::consts::PI;
use std::io::{self, Write};
use std::path::Path;

use tabor::backend::Backend;
use tabor::backend::cpu::CpuBackend;
use tabor::kernel::Scalars;
use tabor::scene::Scene;
use tabor::study::{FinishedStep, Jump, Observer, Setup, walk};
use tabor::surface::Surface;

/// Prints each step as it ends.
struct Print;

impl Observer for Print {
    type Error = io::Error;

    fn step(&mut self, step: FinishedStep) -> io::Result<()> {
        let row = step.row;
        let approach = row.approach.unwrap_or(f64::NAN);
        let jump = match step.jump {
            Some(Jump::In) => "in",
            Some(Jump::Off) => "off",
            None => "",
        };
        writeln!(
            io::stdout(),
            "{approach:.6e},{:.6e},{:.6},{},{jump}",
            row.force,
            row.contact_area_fraction,
            row.state.name()
        )
    }

    fn iteration(&mut self, _: usize, _: &Scalars) -> bool {
        true
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/scenes/sphere_pull_off.toml");
    let scene = Scene::read(&path, &[])?;
    let surface = Surface::build(&scene)?;
    let radius = surface.sphere_radius.ok_or("the surface is one sphere")?;
    let setup = Setup::new(scene, surface);
    let make_backend = || -> Box<dyn Backend + Send> { Box::new(CpuBackend::<f64>::new()) };
    println!("approach,force,contact_area_fraction,state,jump");
    let end = walk(&setup, &make_backend, &mut Print)?;
    let tension = end.rows.iter().map(|row| -row.force).fold(0.0, f64::max);
    let unit = PI * setup.law.work_of_adhesion() * radius;
    eprintln!(
        "pull-off {tension:.4e} N = {:.4} pi w R at Tabor number {:.2}, energy lost {:.3e} J",
        tension / unit,
        setup.regime.map_or(f64::NAN, |regime| regime.tabor),
        end.hysteresis_energy.unwrap_or(0.0)
    );
    Ok(())
}
