//! The surface of `examples/scenes/rough.toml`, compared with itself on a grid on which a narrow
//! taper does not trap the edge.

use std::sync::{Arc, OnceLock};

use tabor::study::{State, WalkEnd};

use crate::run::{Failure, percent, solve};
use crate::{Part, TAPERS, Taper};

const SCENE: &str = include_str!("../scenes/rough.toml");
const SIZE: f64 = 20e-6;
const MODULUS: f64 = 100e6;
const WORK: f64 = 50e-3;
const RANGE: f64 = 20e-9;
/// Points of the reference, with the narrowest taper.
const FINEST: usize = 1024;
/// Step of the tension, Pa.
const STEP: f64 = 0.5e3;

const LEGEND: &str = "rough.toml, loaded to 4 MPa and pulled off: contact area at no load after unloading off by % \
(staircase taken off), pull-off off by % (steps of 1.5 %), areas at 1 MPa on loading and unloading apart by %, transforms; \
against 1024 points with a width of 2";

/// Compared quantities.
#[derive(Clone, Copy)]
struct Found {
    area: f64,
    pull_off: f64,
    apart: f64,
    transforms: f64,
}

pub fn part() -> Result<Part, Failure> {
    let reference = Arc::new(OnceLock::new());
    let rows = [128, 256, 512].map(|points| {
        let jobs = TAPERS.map(|taper| -> crate::Job {
            let reference = Arc::clone(&reference);
            Box::new(move || {
                let reference = reference
                    .get_or_init(|| find(FINEST, TAPERS[0]).map_err(|error| error.to_string()));
                let reference = reference.as_ref().map_err(Clone::clone)?;
                let found = find(points, taper)?;
                Ok(format!(
                    "{} {} {} {:.0}",
                    percent(found.area / reference.area - 1.0),
                    percent(found.pull_off / reference.pull_off - 1.0),
                    percent(found.apart),
                    found.transforms
                ))
            })
        });
        let chi = WORK * SIZE / points as f64 / (MODULUS * RANGE * RANGE);
        (format!("{points} points"), chi, jobs.into())
    });
    Ok(Part {
        name: "rough",
        legend: LEGEND,
        rows: rows.into(),
    })
}

fn find(points: usize, taper: Taper) -> Result<Found, Failure> {
    let length = taper.length(WORK / RANGE, SIZE / points as f64, MODULUS, RANGE);
    let mut path = vec![0.5e6, 1e6, 2e6, 4e6, 2e6, 1e6, 0.5e6, 0.0, -20e3, -30e3];
    path.extend((1..60).map(|i| -30e3 - STEP * f64::from(i)));
    let head = SCENE.split("[loading]").next().unwrap_or(SCENE);
    let text = head
        .replace("points = 512 ", &format!("points = {points} "))
        .replace(
            "range = \"20 nm\"",
            &format!("range = {RANGE:e}\ntaper = {length:e}"),
        );
    let text = format!("{text}\n[loading]\ncontrol = \"pressure\"\npath = {path:?}\n");
    let end: WalkEnd = solve(&text, None, |row| row.state == State::Separated)?;
    let area = |step: usize| {
        let row = &end.rows[step - 1];
        row.contact_area_fraction_corrected
            .unwrap_or(row.contact_area_fraction)
    };
    let held = end.rows.iter().filter(|row| row.state == State::Contact);
    Ok(Found {
        area: area(8),
        pull_off: held.map(|row| -row.mean_pressure).fold(0.0, f64::max) + 0.5 * STEP,
        apart: area(6) / area(2) - 1.0,
        transforms: end.transforms,
    })
}
