//! CPU seconds of an iteration on one thread, by law and precision, and of whole solves in double and in mixed
//! precision.
//!
//! `cargo bench --bench iterations [-- --points N] [-- --turns N]`: one rough contact under a mean pressure on N x N
//! points (1024 unless told). Iterations are timed with 1/K as the preconditioner, as far from a solution, and with the
//! levels, as near one. All precisions and laws take their turns one after another, so that other load on the machine
//! meets them alike, and the least of each counts.

#[path = "shared/rough.rs"]
mod rough;

use std::error::Error;
use std::path::Path;

use cpu_time::ProcessTime;
use tabor::backend::Backend;
use tabor::backend::cpu::{self, with_threads};
use tabor::kernel::Status;
use tabor::scene::Scene;
use tabor::solver::{ContactSolver, Hold, Load, Start};
use tabor::study::{Setup, walk};
use tabor::surface::Surface;

use rough::{PRESSURE, rough};

type Failure = Box<dyn Error + Send + Sync>;

/// Points each way unless told.
const POINTS: usize = 1024;
/// Turns unless told.
const TURNS: usize = 3;
/// Iterations before those that are timed, with each preconditioner. So few with the second: single precision
/// reaches its rounding soon, where a solve ends.
const BEFORE: [usize; 2] = [8, 2];
/// Iterations that are timed.
const TIMED: usize = 6;
/// Tolerance of the whole solves.
const TOLERANCE: f64 = 1e-6;
/// The laws: Maugis-Dugdale, to which the others are compared, comes first.
const LAWS: [(&str, &str); 4] = [
    (
        "Maugis-Dugdale",
        "[adhesion]\nlaw = \"maugis-dugdale\"\nwork_of_adhesion = 1e-4\nrange = 2e-3",
    ),
    ("no adhesion", ""),
    (
        "exponential",
        "[adhesion]\nlaw = \"exponential\"\nwork_of_adhesion = 1e-4\nrange = 2e-3",
    ),
    (
        "Lennard-Jones",
        "[adhesion]\nlaw = \"lennard-jones\"\nwork_of_adhesion = 1e-4\nrange = 2e-3",
    ),
];

fn setup(points: usize, adhesion: &str) -> Result<Setup, Failure> {
    let text = rough(
        points,
        "",
        &format!("{adhesion}\n[solver]\ntolerance = {TOLERANCE:e}"),
    );
    let scene = Scene::parse(&text, "iterations", Path::new("."), &[])?;
    let surface = Surface::build(&scene)?;
    Ok(Setup::new(scene, surface))
}

/// CPU seconds of an iteration, with 1/K and with the levels.
fn iteration(setup: &Setup, mut backend: Box<dyn Backend + Send>) -> Result<[f64; 2], Failure> {
    let problem = &setup.problem;
    let pressure = PRESSURE / problem.scales.pressure;
    let load = Load {
        hold: Hold::Pressure(pressure),
        zero_stiffness: 0.0,
        zero_compliance: ContactSolver::pressure_compliance(problem, pressure),
    };
    let mut solver = ContactSolver::new(&mut *backend, problem);
    // No residual is small enough, so that every iteration does its work.
    solver.begin(&load, &Start::Cold, 0.0, false)?;
    let mut seconds = [0.0; 2];
    for (place, seconds) in seconds.iter_mut().enumerate() {
        if place == 1 {
            solver.precondition_by_levels();
        }
        let mut last = solver.iterate()?;
        for _ in 1..BEFORE[place] {
            last = solver.iterate()?;
        }
        let first = last.iterations;
        let clock = ProcessTime::now();
        for _ in 0..TIMED {
            last = solver.iterate()?;
        }
        if last.status != Status::Running {
            return Err(
                "the solve ended before the iterations that are timed; take more points".into(),
            );
        }
        *seconds = clock.elapsed().as_secs_f64() / f64::from(last.iterations - first);
    }
    Ok(seconds)
}

/// CPU seconds of a whole solve, its iterations and its residual.
fn solve(setup: &Setup, mixed: bool) -> Result<(f64, usize, f64), Failure> {
    let make = || -> Box<dyn Backend + Send> {
        if mixed {
            cpu::mixed(None)
        } else {
            cpu::double(None)
        }
    };
    let clock = ProcessTime::now();
    let end = walk(setup, &make, &mut ())?;
    let row = &end.rows[0];
    assert!(row.converged);
    Ok((clock.elapsed().as_secs_f64(), row.iterations, row.residual))
}

/// The least of all turns, number by number.
fn keep_least<const COUNT: usize>(least: &mut [f64; COUNT], turn: [f64; COUNT]) {
    for (least, seconds) in least.iter_mut().zip(turn) {
        *least = least.min(seconds);
    }
}

fn measure(points: usize, turns: usize) -> Result<(), Failure> {
    let mut setups = Vec::new();
    for (_, adhesion) in LAWS {
        setups.push(setup(points, adhesion)?);
    }
    let mut iterations = [[[f64::INFINITY; 2]; 2]; LAWS.len()];
    for _ in 0..turns {
        for (setup, [double, single]) in setups.iter().zip(&mut iterations) {
            keep_least(double, iteration(setup, cpu::double(None))?);
            keep_least(single, iteration(setup, cpu::single(None))?);
        }
    }
    println!("{points} x {points} points, CPU milliseconds of an iteration on one thread\n");
    println!(
        "| law | preconditioner | double | single | single over double | double over Maugis-Dugdale's |"
    );
    println!("|---|---|---|---|---|---|");
    for ((law, _), [double, single]) in LAWS.iter().zip(iterations) {
        for (place, name) in ["1/K", "levels"].iter().enumerate() {
            println!(
                "| {law} | {name} | {:.1} | {:.1} | {:.2} | {:.2} |",
                1e3 * double[place],
                1e3 * single[place],
                single[place] / double[place],
                double[place] / iterations[0][0][place]
            );
        }
    }
    println!("\nWhole solves to {TOLERANCE:e}, CPU seconds on one thread (iterations, residual)\n");
    println!("| law | double | mixed | mixed over double |\n|---|---|---|---|");
    for ((law, _), setup) in LAWS.iter().zip(&setups) {
        let mut least = [f64::INFINITY; 2];
        let mut ends = [(0, 0.0); 2];
        for _ in 0..turns {
            let [double, mixed] = [solve(setup, false)?, solve(setup, true)?];
            keep_least(&mut least, [double.0, mixed.0]);
            ends = [(double.1, double.2), (mixed.1, mixed.2)];
        }
        println!(
            "| {law} | {:.2} ({}, {:.0e}) | {:.2} ({}, {:.0e}) | {:.2} |",
            least[0],
            ends[0].0,
            ends[0].1,
            least[1],
            ends[1].0,
            ends[1].1,
            least[1] / least[0]
        );
    }
    Ok(())
}

fn main() -> Result<(), Failure> {
    let (mut points, mut turns) = (POINTS, TURNS);
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        let mut number = || -> Result<usize, Failure> {
            let text = arguments
                .next()
                .ok_or(format!("{argument} takes a number"))?;
            Ok(text.parse()?)
        };
        match argument.as_str() {
            "--points" => points = number()?,
            "--turns" => turns = number()?,
            // Cargo says so to every bench.
            "--bench" => {}
            other => return Err(format!("unknown argument {other}").into()),
        }
    }
    with_threads(Some(1), || measure(points, turns))?
}
