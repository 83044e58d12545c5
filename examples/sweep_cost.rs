//! What a sweep costs beside its solves: the CPU seconds of `tabor sweep` over 200 seeds on 128 x 128 points, over the
//! sum of those of the same solves alone, each on one thread. Linux.
//!
//! `cargo build --release && cargo run --release --example sweep_cost`: the scene of the shipped study, a load and the
//! search for its pull-off; and under one load alone, so that each solve is short.

use std::error::Error;
use std::ops::RangeInclusive;
use std::path::Path;
use std::process::Command;

use cpu_time::ProcessTime;
use tabor::backend::cpu::{self, with_threads};
use tabor::scene::Scene;
use tabor::study::{Setup, walk};
use tabor::surface::Surface;

/// Runs of a sweep.
const RUNS: usize = 200;
/// Clock ticks a second in /proc.
const TICKS: f64 = 100.0;
/// The scene of the shipped study.
const SCENE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/studies/rubber.toml");
/// Names and paths of loads, and how often a sweep and its solves alone are measured, one after the other, so that both
/// meet the same machine.
const PATHS: [(&str, &str, usize); 2] = [
    ("a load and its pull-off", "[\"2 MPa\", \"-5 MPa\"]", 1),
    ("one load", "[\"2 MPa\"]", 11),
];

fn main() -> Result<(), Box<dyn Error>> {
    for (name, path, rounds) in PATHS {
        compare(name, path, rounds)?;
    }
    Ok(())
}

/// Prints the cost of a sweep under a path of loads.
fn compare(name: &str, path: &str, rounds: usize) -> Result<(), Box<dyn Error>> {
    let mut measured = Vec::new();
    for round in 0..rounds {
        let seeds = round * RUNS + 1..=(round + 1) * RUNS;
        let [solves, surfaces] = alone(path, seeds.clone())?;
        measured.push([solves, surfaces, sweep(path, seeds)?]);
    }
    let median = |value: &dyn Fn([f64; 3]) -> f64| {
        let mut values: Vec<f64> = measured.iter().copied().map(value).collect();
        values.sort_by(f64::total_cmp);
        values[rounds / 2]
    };
    println!(
        "{name}: {RUNS} solves alone {:.2} CPU seconds, their surfaces {:.2}; swept {:.2}: {:.3} times the solves, {:.3} times solves and surfaces (medians of {rounds})",
        median(&|[solves, _, _]| solves),
        median(&|[_, surfaces, _]| surfaces),
        median(&|[_, _, swept]| swept),
        median(&|[solves, _, swept]| swept / solves),
        median(&|[solves, surfaces, swept]| swept / (solves + surfaces)),
    );
    Ok(())
}

/// CPU seconds of a sweep, its start included.
fn sweep(path: &str, seeds: RangeInclusive<usize>) -> Result<f64, Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let study = format!(
        "scene = {SCENE:?}\nset.loading.path = {path}\n[[axis]]\nkey = \"surface.0.seed\"\nfrom = {}\nto = {}\ncount = {RUNS}\n",
        seeds.start(),
        seeds.end()
    );
    std::fs::write(folder.path().join("study.toml"), study)?;
    let before = children_seconds()?;
    let status = Command::new(std::env::current_exe()?.with_file_name("../tabor"))
        .current_dir(folder.path())
        .args([
            "sweep",
            "study.toml",
            "--quiet",
            "--threads",
            "1",
            "--jobs",
            "1",
        ])
        .status()?;
    if !status.success() {
        return Err(format!("the sweep ended with {status}").into());
    }
    Ok(children_seconds()? - before)
}

/// CPU seconds of all solves, one by one, and those of their surfaces.
fn alone(path: &str, seeds: RangeInclusive<usize>) -> Result<[f64; 2], Box<dyn Error>> {
    let [mut solves, mut surfaces] = [0.0; 2];
    for seed in seeds {
        let clock = ProcessTime::now();
        let set = [
            ("surface.0.seed".to_owned(), seed.to_string()),
            ("loading.path".to_owned(), path.to_owned()),
        ];
        let scene = Scene::read(Path::new(SCENE), &set)?;
        let surface = Surface::build(&scene)?;
        let setup = Setup::new(scene, surface);
        surfaces += clock.elapsed().as_secs_f64();
        let backend = || cpu::double(None);
        let clock = ProcessTime::now();
        with_threads(Some(1), || walk(&setup, &backend, &mut ()))??;
        solves += clock.elapsed().as_secs_f64();
    }
    Ok([solves, surfaces])
}

/// CPU seconds of the children of this process that have ended.
fn children_seconds() -> Result<f64, Box<dyn Error>> {
    let text = std::fs::read_to_string("/proc/self/stat")?;
    // The name of the program may have spaces; no field behind its bracket has. The 14th and 15th of these are user and
    // system time of children.
    let (_, fields) = text.rsplit_once(')').ok_or("no name")?;
    let fields: Vec<&str> = fields.split_whitespace().collect();
    let ticks = fields[13].parse::<f64>()? + fields[14].parse::<f64>()?;
    Ok(ticks / TICKS)
}
