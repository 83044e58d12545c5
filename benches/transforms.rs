//! How many real two-dimensional transforms solves take, which is exact on any machine, and their CPU seconds
//! on one thread and on two.
//!
//! `cargo bench --bench transforms [-- --seed N] [--points N]`: the hard wall from 256 to 4096 points each way
//! (`--points`: up to so many), the whole path of `rough.toml` on 256, 512 and 1024, and what a step of other
//! shipped scenes takes on average; as in `summary.json`, that of the surface's statistics is among them. `--seed`
//! replaces the seeds of all random surfaces. A transform on a coarser grid counts in proportion to its points.

#[path = "shared/rough.rs"]
mod rough;

use std::error::Error;
use std::path::{Path, PathBuf};
use std::time::Instant;

use cpu_time::ProcessTime;
use tabor::backend::cpu::{self, with_threads};
use tabor::scene::{Scene, SurfacePart};
use tabor::study::{Setup, walk};
use tabor::surface::Surface;

use rough::rough;

type Failure = Box<dyn Error + Send + Sync>;

/// Threads of each run.
const THREADS: [usize; 2] = [1, 2];
/// Most points each way of the wall unless told.
const POINTS: usize = 4096;
/// Shipped scenes of which the average step counts.
const STEPS_OF: [&str; 5] = [
    "lennard_jones_sphere",
    "sphere_pull_off",
    "humid_tip",
    "ground",
    "contact_challenge",
];

/// What a scene took.
struct Taken {
    steps: usize,
    transforms: f64,
    /// CPU seconds and seconds of each number of threads.
    seconds: Vec<[f64; 2]>,
}

fn run(scene: &Scene) -> Result<Taken, Failure> {
    let mut taken = Taken {
        steps: 0,
        transforms: 0.0,
        seconds: Vec::new(),
    };
    for threads in THREADS {
        let walked = with_threads(Some(threads), || -> Result<_, Failure> {
            let surface = Surface::build(scene)?;
            let setup = Setup::new(scene.clone(), surface);
            let make = || cpu::double(None);
            let (clock, cpu) = (Instant::now(), ProcessTime::now());
            let end = walk(&setup, &make, &mut ())?;
            Ok((
                end.rows.len(),
                setup.transforms + end.transforms,
                [cpu.elapsed().as_secs_f64(), clock.elapsed().as_secs_f64()],
            ))
        })??;
        (taken.steps, taken.transforms) = (walked.0, walked.1);
        taken.seconds.push(walked.2);
    }
    Ok(taken)
}

fn print(name: &str, count: f64, taken: &Taken) {
    let seconds = taken
        .seconds
        .iter()
        .map(|[cpu, wall]| format!(" {cpu:.2} ({wall:.2}) |"));
    println!("| {name} | {count:.1} |{}", seconds.collect::<String>());
}

fn wall(points: usize, seed: u64) -> Result<Scene, Failure> {
    let seed = format!("seed = {seed}");
    let text = rough(points, &seed, "[solver]\ntolerance = 5e-9");
    Ok(Scene::parse(&text, "wall", Path::new("."), &[])?)
}

fn shipped(name: &str, set: &[(String, String)]) -> Result<Scene, Failure> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/scenes");
    let path: PathBuf = folder.join(name).with_extension("toml");
    Ok(Scene::read(&path, set)?)
}

/// Sets the seed of each random surface of a shipped scene.
fn seeded(name: &str, seed: Option<u64>) -> Result<Vec<(String, String)>, Failure> {
    let Some(seed) = seed else {
        return Ok(Vec::new());
    };
    let scene = shipped(name, &[])?;
    let places = 0..scene.surfaces.len();
    let random =
        places.filter(|&place| matches!(scene.surfaces[place], SurfacePart::SelfAffine(_)));
    Ok(random
        .map(|place| (format!("surface.{place}.seed"), seed.to_string()))
        .collect())
}

fn main() -> Result<(), Failure> {
    let (mut seed, mut most) = (None, POINTS);
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        let mut number = || -> Result<u64, Failure> {
            let text = arguments
                .next()
                .ok_or(format!("{argument} takes a number"))?;
            Ok(text.parse()?)
        };
        match argument.as_str() {
            "--seed" => seed = Some(number()?),
            "--points" => most = usize::try_from(number()?)?,
            // Cargo says so to every bench.
            "--bench" => {}
            other => return Err(format!("unknown argument {other}").into()),
        }
    }
    println!("| scene | transforms | CPU s (s) on 1 thread | on 2 |\n|---|---|---|---|");
    let sizes = std::iter::successors(Some(256), |points| Some(2 * points));
    for points in sizes.take_while(|points| *points <= most) {
        let taken = run(&wall(points, seed.unwrap_or(1))?)?;
        print(
            &format!("hard wall, {points} points"),
            taken.transforms,
            &taken,
        );
    }
    for points in [256, 512, 1024]
        .into_iter()
        .filter(|points| *points <= most)
    {
        for (search, tolerance) in [("", "0"), (", with its search of the pull-off", "0.01")] {
            let mut set = seeded("rough", seed)?;
            set.push(("grid.points".to_owned(), points.to_string()));
            set.push((
                "loading.pull_off_tolerance".to_owned(),
                tolerance.to_owned(),
            ));
            let taken = run(&shipped("rough", &set)?)?;
            let name = format!("rough.toml, {points} points, the path{search}");
            print(&name, taken.transforms, &taken);
        }
    }
    for name in STEPS_OF {
        let taken = run(&shipped(name, &seeded(name, seed)?)?)?;
        let count = taken.transforms / taken.steps as f64;
        print(&format!("{name}.toml, a step"), count, &taken);
    }
    Ok(())
}
