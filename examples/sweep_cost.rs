//! What a sweep costs beside its solves: the CPU seconds of `tabor sweep` over 200 seeds of a rough scene on 128 x 128
//! points, over the sum of those of the same solves alone, both on one thread. Linux.
//!
//! `cargo run --release --example sweep_cost` after `cargo build --release`.

use std::error::Error;
use std::path::Path;
use std::process::Command;

use cpu_time::ProcessTime;
use tabor::backend::Backend;
use tabor::backend::cpu::{CpuBackend, with_threads};
use tabor::scene::Scene;
use tabor::study::{Setup, walk};
use tabor::surface::Surface;

/// Runs of the sweep.
const RUNS: usize = 200;
/// Clock ticks a second in /proc.
const TICKS: f64 = 100.0;

const SCENE: &str = r#"
[grid]
points = 128
size = "20 um"
[solid]
contact_modulus = "10 MPa"
[[surface]]
kind = "self-affine"
hurst = 0.8
rms_height = "50 nm"
longest = "20 um"
rolloff = "10 um"
shortest = "1.6 um"
[adhesion]
law = "maugis-dugdale"
work_of_adhesion = "50 mJ/m^2"
range = "60 nm"
[loading]
control = "pressure"
path = ["0.5 MPa", "2 MPa", 0]
"#;

/// CPU seconds of the children of this process that have ended.
fn children_seconds() -> Result<f64, Box<dyn Error>> {
    let text = std::fs::read_to_string("/proc/self/stat")?;
    // The name may have spaces; the fields behind its bracket have none. User and system time of children are the
    // 16th and 17th.
    let fields: Vec<&str> = text
        .rsplit(')')
        .next()
        .unwrap_or("")
        .split_whitespace()
        .collect();
    let ticks: f64 = fields[13].parse::<f64>()? + fields[14].parse::<f64>()?;
    Ok(ticks / TICKS)
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    std::fs::write(folder.path().join("scene.toml"), SCENE)?;
    let study = format!(
        "scene = \"scene.toml\"\n[[axis]]\nkey = \"surface.0.seed\"\nfrom = 1\nto = {RUNS}\ncount = {RUNS}\n"
    );
    std::fs::write(folder.path().join("study.toml"), study)?;
    let binary = std::env::current_exe()?.with_file_name("../tabor");
    for jobs in ["1", "2"] {
        let before = children_seconds()?;
        let clock = std::time::Instant::now();
        let out = format!("out_{jobs}");
        let status = Command::new(&binary)
            .current_dir(folder.path())
            .args([
                "sweep",
                "study.toml",
                "--out",
                &out,
                "--quiet",
                "--threads",
                "1",
                "--jobs",
                jobs,
            ])
            .status()?;
        assert!(status.success(), "{status}");
        println!(
            "sweep, {jobs} at a time: {:.2} CPU seconds in {:.2} s",
            children_seconds()? - before,
            clock.elapsed().as_secs_f64()
        );
    }
    // Alone: the heights and all that a solve needs are there, and only the solve is timed.
    let mut solves = 0.0;
    let mut surfaces = 0.0;
    for seed in 1..=RUNS {
        let clock = ProcessTime::now();
        let set = [("surface.0.seed".to_owned(), seed.to_string())];
        let scene = Scene::parse(SCENE, "scene.toml", Path::new("."), &set)?;
        let surface = Surface::build(&scene)?;
        surfaces += clock.elapsed().as_secs_f64();
        let setup = Setup::new(scene, surface);
        let backend = || -> Box<dyn Backend + Send> { Box::new(CpuBackend::<f64>::new()) };
        let clock = ProcessTime::now();
        with_threads(Some(1), || walk(&setup, &backend, &mut ()))??;
        solves += clock.elapsed().as_secs_f64();
    }
    println!("solves alone: {solves:.2} CPU seconds; their surfaces {surfaces:.2}");
    Ok(())
}
