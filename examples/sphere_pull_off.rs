//! A sphere jumps into contact, is pressed on and pulled off: the force-distance loop.
//!
//! `cargo run --release --example sphere_pull_off > loop.csv` solves `examples/scenes/sphere_pull_off.toml`
//! and prints the loop as CSV on standard output, step by step, and the pull-off force in units of
//! `pi w R` on standard error: 2 in the limit of long ranges (DMT), 1.5 in that of short ones (JKR).

use std::error::Error;
use std::f64::consts::PI;
use std::path::Path;

use tabor::{Contact, Jump, Scene, SurfacePart};

fn main() -> Result<(), Box<dyn Error>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/scenes/sphere_pull_off.toml");
    let scene = Scene::read(&path, &[])?;
    let radius = match scene.surfaces[..] {
        [SurfacePart::Sphere { radius, .. }] => radius,
        _ => return Err("the surface is one sphere".into()),
    };
    let work = scene
        .adhesion
        .as_ref()
        .ok_or("it attracts")?
        .work_of_adhesion;
    let contact = Contact::from_scene(scene);
    println!("approach,force,contact_area_fraction,state,jump");
    let mut tension: f64 = 0.0;
    let mut lost = 0.0;
    let mut before: Option<[f64; 2]> = None;
    for solution in contact.path(contact.loads()) {
        let solution = solution?;
        let approach = solution.approach.unwrap_or(f64::NAN);
        let jump = match solution.jump {
            Some(Jump::In) => "in",
            Some(Jump::Off) => "off",
            _ => "",
        };
        println!(
            "{approach:.6e},{:.6e},{:.6},{},{jump}",
            solution.force,
            solution.contact_area_fraction,
            solution.state.name()
        );
        tension = tension.max(-solution.force);
        // The area of the loop, by trapezoids.
        if let Some([last_approach, last_force]) = before {
            lost += 0.5 * (solution.force + last_force) * (approach - last_approach);
        }
        before = Some([approach, solution.force]);
    }
    eprintln!(
        "pull-off {tension:.4e} N = {:.4} pi w R, energy lost {lost:.3e} J",
        tension / (PI * work * radius)
    );
    Ok(())
}
