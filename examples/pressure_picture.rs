//! A rough contact as a picture of its pressure.
//!
//! `cargo run --release --example pressure_picture [FILE]` presses a self-affine surface against a
//! half-space and writes the pressure field as a PNG (default `pressure.png`), with colour bar,
//! scale bar and load.

use std::error::Error;
use std::path::PathBuf;

use tabor::output::{Load, Picture, write_picture};
use tabor::scene::FieldName;
use tabor::{Contact, Control, Grid, Roughness, SelfAffine};

fn main() -> Result<(), Box<dyn Error>> {
    let path = PathBuf::from(std::env::args_os().nth(1).unwrap_or("pressure.png".into()));
    let grid = Grid::new([512, 512], [20e-6, 20e-6]);
    let rough = SelfAffine {
        hurst: 0.8,
        roughness: Roughness::RmsSlope(0.12),
        longest: 20e-6,
        rolloff: 5e-6,
        shortest: 0.4e-6,
        seed: 1,
    };
    let load = Control::MeanPressure(1e6);
    let solution = Contact::new(rough.heights(grid)?, grid.points(), grid.size())
        .contact_modulus(100e6)
        .solve(load)?;
    let picture = Picture {
        title: Some("Rough surface without adhesion"),
        field: FieldName::Pressure,
        step: None,
        load: Some(Load::new(load.kind(), load.value())),
        grid,
        values: &solution.pressure,
    };
    write_picture(&path, &picture)?;
    println!(
        "{}: {:.1} % in contact",
        path.display(),
        100.0 * solution.contact_area_fraction
    );
    Ok(())
}
