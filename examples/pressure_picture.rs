//! Draws the pressure of a rough contact.
//!
//! `cargo run --release --example pressure_picture [FILE]` presses a self-affine surface against a
//! half-space and writes the pressure field as a PNG (default `pressure.png`), with colour bar,
//! scale bar and load.

use std::error::Error;
use std::path::{Path, PathBuf};

use tabor::backend::Backend;
use tabor::backend::cpu::CpuBackend;
use tabor::kernel::Scalars;
use tabor::output::{Load, OutputError, Picture, write_picture};
use tabor::scene::{FieldName, Scene};
use tabor::study::{FinishedStep, Observer, Setup, walk};
use tabor::surface::Surface;

const SCENE: &str = r#"
title = "Rough surface without adhesion"
[grid]
points = 512
size = "20 um"
[solid]
contact_modulus = "100 MPa"
[[surface]]
kind = "self-affine"
hurst = 0.8
rms_slope = 0.12
longest = "20 um"
rolloff = "5 um"
shortest = "0.4 um"
[loading]
control = "pressure"
path = ["1 MPa"]
"#;

/// Draws each step.
struct Draw<'a> {
    setup: &'a Setup,
    path: PathBuf,
}

impl Observer for Draw<'_> {
    type Error = OutputError;

    fn step(&mut self, step: FinishedStep) -> Result<(), OutputError> {
        // Separated surfaces have no field to draw.
        let Some(fields) = step.evaluation else {
            return Ok(());
        };
        let scene = &self.setup.scene;
        let picture = Picture {
            title: scene.title.as_deref(),
            field: FieldName::Pressure,
            step: None,
            load: Some(Load::new(scene.loading.control, step.row.mean_pressure)),
            grid: self.setup.surface.grid,
            values: &fields.pressure,
        };
        write_picture(&self.path, &picture)
    }

    fn iteration(&mut self, _: usize, _: &Scalars) -> bool {
        true
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let path = PathBuf::from(std::env::args_os().nth(1).unwrap_or("pressure.png".into()));
    let scene = Scene::parse(SCENE, "pressure_picture", Path::new("."), &[])?;
    let surface = Surface::build(&scene)?;
    let setup = Setup::new(scene, surface);
    let make_backend = || -> Box<dyn Backend + Send> { Box::new(CpuBackend::<f64>::new()) };
    let mut draw = Draw {
        setup: &setup,
        path,
    };
    let end = walk(&setup, &make_backend, &mut draw)?;
    println!(
        "{}: {:.1} % in contact",
        draw.path.display(),
        100.0 * end.rows[0].contact_area_fraction
    );
    Ok(())
}
