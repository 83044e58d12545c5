//! Pull-off of stiff spheres against the pixels across the disc over which they are attracted: the table of `docs/solver.md`,
//! "Accuracy".
//!
//! `cargo run --release --example reach_study` pulls spheres off at five places between the pixels, at Tabor numbers of 0.03, 0.2 and 0.7,
//! and prints the least and the greatest error of each law, in %: against Maugis 1992 with the Maugis-Dugdale law, and against 24
//! pixels with the exponential one. A minute on two cores.

use std::error::Error;
use std::f64::consts::PI;

use rayon::prelude::*;
use tabor::theory::maugis_dugdale;
use tabor::theory::tabor_map::{Sphere, maugis_parameter};
use tabor::{Boundary, Contact, Control, Device, Exponential, MaugisDugdale, State};

const RADIUS: f64 = 1e-6;
const WORK: f64 = 0.05;
const RANGE: f64 = 1e-9;
const TABOR_NUMBERS: [f64; 3] = [0.03, 0.2, 0.7];
/// Across the disc of diameter `2 sqrt(2 R range)`.
const PIXELS: [f64; 10] = [0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 14.0];
/// Of the solution that the exponential law is compared with.
const REFERENCE: f64 = 24.0;
/// Places of the apex between the points, in pixels.
const PLACES: [[f64; 2]; 5] = [[0.0, 0.0], [0.5, 0.0], [0.5, 0.5], [0.25, 0.25], [0.3, 0.1]];
/// Factor from one tension to the next.
const STEP: f64 = 1.02;
/// Discs across the grid, and its points at least.
const MARGIN: f64 = 2.5;
const LEAST_POINTS: usize = 24;

type Failure = Box<dyn Error + Send + Sync>;

#[derive(Clone, Copy)]
enum Law {
    MaugisDugdale,
    Exponential,
}

/// Contact modulus of a Tabor number `(R w^2/(E*^2 range^3))^(1/3)`, Pa.
fn modulus(tabor: f64) -> f64 {
    (RADIUS * WORK * WORK / (RANGE * tabor).powi(3)).sqrt()
}

/// The greatest tension that is held, N.
fn pull_off(law: Law, tabor: f64, pixels: f64, [x, y]: [f64; 2]) -> Result<f64, Failure> {
    let pixel = 2.0 * (2.0 * RADIUS * RANGE).sqrt() / pixels;
    let points = ((MARGIN * pixels) as usize).max(LEAST_POINTS);
    let place = |index: usize, shift: f64| (index as f64 - (points / 2) as f64 - shift) * pixel;
    let heights: Vec<f64> = (0..points * points)
        .map(|point| {
            let away = place(point % points, x).hypot(place(point / points, y));
            -away * away / (2.0 * RADIUS)
        })
        .collect();
    let size = points as f64 * pixel;
    let contact = Contact::new(heights, [points, points], [size, size])
        .contact_modulus(modulus(tabor))
        .boundary(Boundary::Free)
        .device(Device::cpu())
        .threads(1);
    let contact = match law {
        Law::MaugisDugdale => contact.law(MaugisDugdale::new(WORK, RANGE)),
        Law::Exponential => contact.law(Exponential::new(WORK, RANGE)),
    };
    let unit = PI * WORK * RADIUS;
    let tensions = (0..).map(|step| 0.5 * unit * STEP.powi(step));
    let loads = [0.5 * unit, 0.0]
        .into_iter()
        .chain(tensions.map(|tension| -tension));
    let mut held = 0.0;
    for solution in contact.path(loads.map(Control::Force)) {
        let solution = solution?;
        if !solution.converged {
            return Err(format!("{pixels} pixels: a step did not converge").into());
        }
        if solution.state == State::Separated {
            break;
        }
        held = -solution.force;
    }
    Ok(held * 0.5 * (1.0 + STEP))
}

/// What the pull-off is compared with, N.
fn reference(law: Law, tabor: f64) -> Result<f64, Failure> {
    match law {
        Law::MaugisDugdale => {
            let lambda =
                maugis_parameter(&Sphere::new(RADIUS, modulus(tabor), WORK)?, WORK / RANGE)?;
            let pull_off = maugis_dugdale::MaugisDugdale::new(lambda)?.pull_off()?;
            Ok(-pull_off.force * PI * WORK * RADIUS)
        }
        Law::Exponential => pull_off(law, tabor, REFERENCE, PLACES[0]),
    }
}

/// The least and the greatest error over Tabor numbers and places.
fn cell(law: Law, pixels: f64) -> Result<String, Failure> {
    let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
    for tabor in TABOR_NUMBERS {
        let right = reference(law, tabor)?;
        for place in PLACES {
            let error = pull_off(law, tabor, pixels, place)? / right - 1.0;
            (least, most) = (least.min(error), most.max(error));
        }
    }
    Ok(format!("{:+.0} to {:+.0}", 100.0 * least, 100.0 * most))
}

fn main() -> Result<(), Failure> {
    let laws = [
        ("Maugis-Dugdale", Law::MaugisDugdale),
        ("exponential", Law::Exponential),
    ];
    let cells: Vec<(Law, f64)> = laws
        .iter()
        .flat_map(|(_, law)| PIXELS.map(|pixels| (*law, pixels)))
        .collect();
    // A solve takes one thread.
    let found = cells
        .into_par_iter()
        .map(|(law, pixels)| cell(law, pixels))
        .collect::<Result<Vec<_>, _>>()?;
    let head = PIXELS.map(|pixels| pixels.to_string()).join(" | ");
    println!("| pixels across the disc | {head} |");
    println!("|---|{}", "---|".repeat(PIXELS.len()));
    for ((name, _), row) in laws.iter().zip(found.chunks(PIXELS.len())) {
        println!("| {name} | {} |", row.join(" | "));
    }
    Ok(())
}
