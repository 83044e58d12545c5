//! Pull-off of stiff spheres and summits against the pixels across the disc over which they are attracted: the tables of
//! `docs/solver.md`, "Accuracy".
//!
//! `cargo run --release --example reach_study` pulls spheres off at five places between the pixels, at Tabor numbers of 0.03, 0.2 and 0.7,
//! and prints the least and the greatest error of each law, in %: against Maugis 1992 with the Maugis-Dugdale law, and against 24
//! pixels with the exponential one. Then rough surfaces, with the radius 2 over their rms curvature, against the same surfaces on
//! grids of two to eight times the points each way; and the same with the Maugis-Dugdale law by chi and by their rms height over the
//! range. Ten minutes on two cores.

use std::error::Error;
use std::f64::consts::PI;
use std::path::Path;

use rayon::prelude::*;
use tabor::backend::cpu::{self, with_threads};
use tabor::scene::Scene;
use tabor::study::{Setup, walk};
use tabor::surface::Surface;
use tabor::surface::spectrum::SpectralMoments;
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

/// Points of the rough surfaces, each way, and of their shortest waves.
const ROUGH_POINTS: usize = 64;
const SHORTEST: usize = 8;
/// Pixels across the disc on them, and how many times the points the same surface is compared on.
const ROUGH_PIXELS: [(f64, usize); 5] = [(1.0, 8), (2.0, 4), (3.0, 4), (4.0, 4), (5.0, 2)];
const ROUGH_TABOR_NUMBERS: [f64; 3] = [0.05, 0.2, 0.7];
/// Hurst exponent and seed of each.
const ROUGH: [(f64, u64); 4] = [(0.5, 1), (0.5, 2), (0.8, 1), (0.8, 2)];
const ROUGH_MODULUS: f64 = 1e9;
const ROUGH_PIXEL: f64 = 1e-6 / ROUGH_POINTS as f64;
/// Pixels over the width of a cohesive zone on them, w dx/(E* range^2), and how many times the points they are compared on.
const CHI: [(f64, usize); 5] = [(0.05, 2), (0.1, 4), (0.2, 4), (0.3, 4), (0.5, 8)];
/// Rms height over the range.
const ROUGHNESS: [f64; 4] = [2.0, 3.0, 5.0, 8.0];
/// Relative accuracy of their pull-off.
const ROUGH_ACCURACY: f64 = 0.02;

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

/// The least and the greatest of errors, in %.
fn span(errors: &[f64]) -> String {
    let least = errors.iter().copied().fold(f64::INFINITY, f64::min);
    let most = errors.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    format!("{:+.0} to {:+.0}", 100.0 * least, 100.0 * most)
}

/// The least and the greatest error over Tabor numbers and places.
fn cell(law: Law, pixels: f64) -> Result<String, Failure> {
    let mut errors = Vec::new();
    for tabor in TABOR_NUMBERS {
        let right = reference(law, tabor)?;
        for place in PLACES {
            errors.push(pull_off(law, tabor, pixels, place)? / right - 1.0);
        }
    }
    Ok(span(&errors))
}

/// A rough surface on so many times the points, with these tables, pressed to a hundredth of E* times its rms slope and pulled off.
fn rough((hurst, seed): (f64, u64), times: usize, tables: &str) -> Result<Setup, Failure> {
    let points = ROUGH_POINTS * times;
    let shortest = SHORTEST as f64 / ROUGH_POINTS as f64;
    let text = format!(
        r#"
        [grid]
        points = {points}
        size = "1 um"
        [solid]
        contact_modulus = {ROUGH_MODULUS}
        [[surface]]
        kind = "self-affine"
        hurst = {hurst}
        rms_slope = 0.1
        longest = "1 um"
        rolloff = "0.5 um"
        shortest = "{shortest} um"
        seed = {seed}
        {tables}
        [loading]
        control = "pressure"
        path = [{}, 0]
        until = "apart"
        pull_off_tolerance = {ROUGH_ACCURACY}
        "#,
        1e-3 * ROUGH_MODULUS
    );
    let scene = Scene::parse(&text, "reach_study", Path::new("."), &[])?;
    let surface = Surface::build(&scene)?;
    Ok(Setup::new(scene, surface))
}

/// The greatest tension that its path holds, N.
fn rough_pull_off(setup: &Setup) -> Result<f64, Failure> {
    let cpu = || cpu::double(None);
    let end = with_threads(Some(1), || walk(setup, &cpu, &mut ()))??;
    let least = end.rows.iter().map(|row| row.force).fold(0.0, f64::min);
    Ok(end.pull_off.map_or(-least, |found| found.lower.max(-least)))
}

/// The least and the greatest error over surfaces and numbers of each, where `adhesion` says the work of adhesion, J/m^2, and the
/// range, m, by the spectral moments of a surface and a number.
fn rough_cell(
    law: Law,
    numbers: &[f64],
    times: usize,
    adhesion: impl Fn(&SpectralMoments, f64) -> Option<[f64; 2]> + Sync,
) -> Result<String, Failure> {
    let cases: Vec<((f64, u64), f64)> = ROUGH
        .iter()
        .flat_map(|surface| numbers.iter().map(|number| (*surface, *number)))
        .collect();
    let errors = cases
        .into_par_iter()
        .map(|(surface, number)| {
            let moments = rough(surface, 1, "")?.statistics.moments;
            let [work, range] = adhesion(&moments, number).ok_or("no summits")?;
            let name = match law {
                Law::MaugisDugdale => "maugis-dugdale",
                Law::Exponential => "exponential",
            };
            let adhesion = format!(
                "[adhesion]\nlaw = \"{name}\"\nwork_of_adhesion = {work:e}\nrange = {range:e}"
            );
            let [coarse, fine] =
                [1, times].map(|times| rough_pull_off(&rough(surface, times, &adhesion)?));
            Ok(coarse? / fine? - 1.0)
        })
        .collect::<Result<Vec<f64>, Failure>>()?;
    Ok(span(&errors))
}

/// Work of adhesion and range where so many pixels lie across the disc of a summit and the Tabor number is this, with the radius of
/// warnings, 2 over the rms curvature.
fn by_reach(moments: &SpectralMoments, pixels: f64, tabor: f64) -> Option<[f64; 2]> {
    let radius = moments.mean_radius()?;
    let range = (0.5 * pixels * ROUGH_PIXEL).powi(2) / (2.0 * radius);
    let work = ROUGH_MODULUS * ((tabor * range).powi(3) / radius).sqrt();
    Some([work, range])
}

/// Work of adhesion and range for a chi and a range of the rms height over so much.
fn by_chi(moments: &SpectralMoments, chi: f64, roughness: f64) -> [f64; 2] {
    let range = moments.rms_height() / roughness;
    [chi * ROUGH_MODULUS * range * range / ROUGH_PIXEL, range]
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
    let head = ROUGH_PIXELS
        .map(|(pixels, _)| pixels.to_string())
        .join(" | ");
    println!("\n| pixels across a summit's disc | {head} |");
    println!("|---|{}", "---|".repeat(ROUGH_PIXELS.len()));
    for (name, law) in laws {
        let row = ROUGH_PIXELS
            .iter()
            .map(|(pixels, times)| {
                rough_cell(law, &ROUGH_TABOR_NUMBERS, *times, |moments, tabor| {
                    by_reach(moments, *pixels, tabor)
                })
            })
            .collect::<Result<Vec<_>, _>>()?;
        println!("| {name} | {} |", row.join(" | "));
    }
    let head = CHI.map(|(chi, _)| chi.to_string()).join(" | ");
    println!("\n| chi of a rough surface | {head} |");
    println!("|---|{}", "---|".repeat(CHI.len()));
    for roughness in ROUGHNESS {
        let row = CHI
            .iter()
            .map(|(chi, times)| {
                rough_cell(Law::MaugisDugdale, &[roughness], *times, |moments, of| {
                    Some(by_chi(moments, *chi, of))
                })
            })
            .collect::<Result<Vec<_>, _>>()?;
        println!("| rms height {roughness} ranges | {} |", row.join(" | "));
    }
    Ok(())
}
