//! Pull-off of stiff cones and of crests of stiff waves against the pixels across what is attracted where they touch: figures of
//! `docs/solver.md`, "Accuracy", and the limits of the warnings.
//!
//! `cargo run --release --example apex_study` pulls cones off whose apex lies between four points of the grid and on one, and straight
//! and round crests, and prints the error of each law, in %, against the rigid limit: the greatest tension over the undeformed gap, summed on
//! many points. A minute on two cores.

use std::error::Error;
use std::path::Path;

use rayon::prelude::*;
use tabor::backend::cpu::{self, with_threads};
use tabor::scene::Scene;
use tabor::study::{Setup, walk};
use tabor::surface::Surface;

const WORK: f64 = 0.05;
const LAWS: [&str; 3] = ["maugis-dugdale", "exponential", "lennard-jones"];
const PIXELS: [f64; 8] = [2.0, 3.0, 4.0, 5.0, 7.0, 10.0, 15.0, 30.0];
/// A cone: half angle, deg, range, m, and `w tan(half_angle)/(E* range)`.
const HALF_ANGLE: f64 = 80.0;
const RANGE: f64 = 1e-9;
const OPENING: f64 = 3e-4;
/// Discs across its grid.
const MARGIN: f64 = 4.0;
/// Waves: amplitude and length, m, and points of each.
const AMPLITUDE: f64 = 20e-9;
const LENGTH: f64 = 2e-6;
const WAVE_POINTS: usize = 64;
/// Their Tabor number.
const TABOR_NUMBER: f64 = 0.01;
/// Points each way that the rigid limit is summed on, and clearances over the range that are tried: negative ones, where the core of
/// Lennard-Jones repels, of that law alone.
const FINE: usize = 1024;
const CLEARANCES: [f64; 14] = [
    -0.3, -0.25, -0.2, -0.15, -0.1, -0.05, 0.0, 0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.5,
];

type Failure = Box<dyn Error + Send + Sync>;

#[derive(Clone, Copy)]
enum Shape {
    ConeBetween,
    ConeOnPoint,
    Ridges,
    Crests,
}

/// The scene of so many pixels across what is attracted, and the depth of a place, as shares of the cell, below the highest, m.
fn case(shape: Shape, law: &str, pixels: f64) -> (String, Box<dyn Fn(f64, f64) -> f64>) {
    let slope = HALF_ANGLE.to_radians().tan();
    let (grid, surface, modulus, range, load, depth): (
        _,
        _,
        _,
        _,
        _,
        Box<dyn Fn(f64, f64) -> f64>,
    ) = match shape {
        Shape::ConeBetween | Shape::ConeOnPoint => {
            let pixel = 2.0 * RANGE * slope / pixels;
            let points = 2 * ((0.5 * MARGIN * pixels).ceil() as usize).max(8);
            let size = points as f64 * pixel;
            let middle = match shape {
                Shape::ConeOnPoint => 0.5 * size,
                _ => 0.5 * (size - pixel),
            };
            let surface = format!(
                "kind = \"cone\"\nhalf_angle = {HALF_ANGLE}\ncentre = [{middle:e}, {middle:e}]"
            );
            let depth = move |x: f64, y: f64| (x - 0.5).hypot(y - 0.5) * size / slope;
            (
                format!("points = {points}\nsize = {size:e}\nboundary = \"free\""),
                surface,
                WORK * slope / (OPENING * RANGE),
                RANGE,
                "control = \"force\"\npath = [1e-9, 0]",
                Box::new(depth),
            )
        }
        Shape::Ridges | Shape::Crests => {
            let number = std::f64::consts::TAU / LENGTH;
            let radius = 1.0 / (AMPLITUDE * number * number);
            let pixel = LENGTH / WAVE_POINTS as f64;
            let range = (0.5 * pixels * pixel).powi(2) / (2.0 * radius);
            let modulus = WORK * (radius / (TABOR_NUMBER * range).powi(3)).sqrt();
            let (rows, across) = match shape {
                Shape::Ridges => (4, "\"inf\"".to_owned()),
                _ => (WAVE_POINTS, format!("{LENGTH:e}")),
            };
            let height = rows as f64 * pixel;
            let is_round = matches!(shape, Shape::Crests);
            let depth = move |x: f64, y: f64| {
                let turn = |share: f64| (std::f64::consts::TAU * share).cos();
                AMPLITUDE * (1.0 - turn(x) * if is_round { turn(y) } else { 1.0 })
            };
            (
                format!("points = [{WAVE_POINTS}, {rows}]\nsize = [{LENGTH:e}, {height:e}]"),
                format!(
                    "kind = \"wavy\"\namplitude = {AMPLITUDE:e}\nwavelength = [{LENGTH:e}, {across}]"
                ),
                modulus,
                range,
                "control = \"pressure\"\npath = [1e3, 0]",
                Box::new(depth),
            )
        }
    };
    let text = format!(
        "[grid]\n{grid}\n[solid]\ncontact_modulus = {modulus:e}\n[[surface]]\n{surface}\n[adhesion]\nlaw = \"{law}\"\nwork_of_adhesion = {WORK}\nrange = {range:e}\n[loading]\n{load}\nuntil = \"apart\"\n"
    );
    (text, depth)
}

/// Error of a pull-off, as a share.
fn error(shape: Shape, law: &str, pixels: f64) -> Result<f64, Failure> {
    let (text, depth) = case(shape, law, pixels);
    let scene = Scene::parse(&text, "apex_study", Path::new("."), &[])?;
    let surface = Surface::build(&scene)?;
    let setup = Setup::new(scene, surface);
    let cpu = || cpu::double(None);
    let end = with_threads(Some(1), || walk(&setup, &cpu, &mut ()))??;
    let held = end.pull_off.ok_or("no pull-off")?.lower;
    let share = |index: usize| (index as f64 + 0.5) / FINE as f64;
    let range = setup.law.range();
    let has_wall = law != "lennard-jones";
    let clearances = CLEARANCES.iter();
    let tensions = clearances.filter(|clearance| **clearance >= 0.0 || !has_wall);
    let tensions = tensions.map(|clearance| {
        let places = (0..FINE * FINE).map(|at| depth(share(at % FINE), share(at / FINE)));
        let sum: f64 = places
            .map(|depth| setup.law.traction(depth + clearance * range))
            .sum();
        sum / (FINE * FINE) as f64
    });
    let rigid = tensions.fold(0.0, f64::max) * setup.surface.grid.area();
    Ok(held / rigid - 1.0)
}

fn main() -> Result<(), Failure> {
    let shapes = [
        ("cone between points", Shape::ConeBetween),
        ("cone on a point", Shape::ConeOnPoint),
        ("straight crests", Shape::Ridges),
        ("round crests", Shape::Crests),
    ];
    let head = PIXELS.map(|pixels| pixels.to_string()).join(" | ");
    println!("| pixels across | | {head} |");
    println!("|---|---|{}", "---|".repeat(PIXELS.len()));
    for (name, shape) in shapes {
        for law in LAWS {
            let cells = PIXELS
                .into_par_iter()
                .map(|pixels| error(shape, law, pixels));
            let row = cells.collect::<Result<Vec<f64>, Failure>>()?;
            let row: Vec<String> = row
                .iter()
                .map(|error| format!("{:+.0}", 100.0 * error))
                .collect();
            println!("| {name} | {law} | {} |", row.join(" | "));
        }
    }
    Ok(())
}
