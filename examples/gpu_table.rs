//! What the kernels of an iteration take on the graphics processor, and at which share of the rate at
//! which it copies: the table and the picture of `docs/benchmarks.md`.
//!
//! `cargo run --release --example gpu_table [POINTS ...]` times iterations on rough surfaces of so many
//! points each way (default 256 512; what the device has no room for is left out) and writes
//! `gpu_table.png`. Times are the device's own, by timestamps; the time of an iteration is taken by the
//! host over some iterations that are not looked at. A device is chosen as `tabor` does, by
//! `WGPU_ADAPTER_NAME` or else the best there is, software included.

use std::error::Error;
use std::path::Path;
use std::time::Instant;

use tabor::backend::BackendError;
use tabor::backend::gpu::{AdapterChoice, GpuBackend, GpuDevice, KernelTime, Timings};
use tabor::kernel::Scalars;
use tabor::output::plot::{Axis, Figure, Panel, PlotPoint, Series};
use tabor::scene::Scene;
use tabor::solver::{ContactSolver, Hold, Load, Start};
use tabor::study::Setup;
use tabor::surface::Surface;

/// Rounds that are timed.
const ROUNDS: usize = 8;
/// Iterations before, and the most rounds that they may take: far from a solution a law without a wall searches its step for
/// several rounds, in which the other kernels idle.
const BEFORE: u32 = 8;
const MOST_BEFORE: usize = 128;
/// Mean pressure over the contact modulus times the rms slope, which is 1.
const PRESSURE: f64 = 0.05;
/// The laws of the table: title and scene.
const LAWS: [(&str, &str); 3] = [
    ("no adhesion", ""),
    (
        "sharp Maugis-Dugdale",
        "[adhesion]\nlaw = \"maugis-dugdale\"\nwork_of_adhesion = 2e-4\nrange = 2e-3\ntaper = 0",
    ),
    (
        "Lennard-Jones",
        "[adhesion]\nlaw = \"lennard-jones\"\nwork_of_adhesion = 2e-4\nrange = 4e-3",
    ),
];
/// Kernels in the picture, by what they do: the end of their name, and what they are called there.
const SHOWN: [(&str, &str); 5] = [
    ("multiply", "columns"),
    ("coarsen", "residual restricted"),
    ("level_descent", "residual preconditioned, rows"),
    ("trial", "rows back, trial, rows"),
    ("update_state", "rows back, step"),
];

/// A law on one grid.
struct Measured {
    law: usize,
    points: usize,
    /// Bytes a second.
    copy_rate: f64,
    /// Of one iteration.
    timings: Timings,
    /// Iterations that were timed.
    iterations: u32,
    /// Seconds of an iteration by the host's clock, nothing timed on the device.
    iteration: f64,
}

fn scene(points: usize, adhesion: &str) -> Result<Scene, Box<dyn Error>> {
    let text = format!(
        r#"
        [grid]
        points = {points}
        size = 1.0
        [solid]
        contact_modulus = 1.0
        [[surface]]
        kind = "self-affine"
        hurst = 0.8
        rms_slope = 1.0
        longest = 1.0
        rolloff = 0.25
        shortest = {:e}
        {adhesion}
        [loading]
        control = "pressure"
        path = [{PRESSURE}]
        "#,
        8.0 / points as f64
    );
    Ok(Scene::parse(&text, "gpu_table", Path::new("."), &[])
        .map_err(|errors| errors.to_string())?)
}

/// Brings a solve near its solution.
fn warm(solver: &mut ContactSolver) -> Result<Scalars, BackendError> {
    let (mut rounds, mut scalars) = solver.advance(ROUNDS)?;
    while scalars.iterations < BEFORE && rounds < MOST_BEFORE {
        let (more, after) = solver.advance(ROUNDS)?;
        rounds += more;
        scalars = after;
    }
    Ok(scalars)
}

/// Times iterations of a law on a surface; `None` where the device has no timestamps.
fn measure(
    device: &GpuDevice,
    law: usize,
    points: usize,
    surface: &Surface,
) -> Result<Option<Measured>, Box<dyn Error>> {
    let setup = Setup::new(scene(points, LAWS[law].1)?, surface.clone());
    let problem = &setup.problem;
    let pressure = PRESSURE / problem.scales.pressure;
    let load = Load {
        hold: Hold::Pressure(pressure),
        zero_stiffness: 0.0,
        zero_compliance: ContactSolver::pressure_compliance(problem, pressure),
    };
    let (mut timed, watch) = GpuBackend::on(device).looking_every(ROUNDS).timed();
    let Some(watch) = watch else {
        return Ok(None);
    };
    let mut solver = ContactSolver::new(&mut timed, problem);
    // No residual is small enough, so that none of the iterations idles.
    solver.begin(&load, &Start::Cold, 0.0, false)?;
    solver.precondition_by_levels();
    let before = warm(&mut solver)?;
    watch.take();
    let (_, after) = solver.advance(ROUNDS)?;
    // A round that goes on with a search is no iteration.
    let iterations = after.iterations - before.iterations;
    let mut timings = watch.take();
    for kernel in &mut timings.kernels {
        kernel.seconds /= f64::from(iterations);
        kernel.bytes /= u64::from(iterations);
    }
    let mut untimed = GpuBackend::on(device).looking_every(ROUNDS);
    let mut solver = ContactSolver::new(&mut untimed, problem);
    solver.begin(&load, &Start::Cold, 0.0, false)?;
    solver.precondition_by_levels();
    warm(&mut solver)?;
    let clock = Instant::now();
    solver.advance(ROUNDS)?;
    let iteration = clock.elapsed().as_secs_f64() / f64::from(iterations);
    let Some(copy_rate) = device.copy_rate(4 * (points * points) as u64)? else {
        return Ok(None);
    };
    Ok(Some(Measured {
        law,
        points,
        copy_rate,
        timings,
        iterations,
        iteration,
    }))
}

fn print(measured: &Measured) {
    let Measured {
        law,
        points,
        copy_rate,
        timings,
        iterations,
        iteration,
    } = measured;
    let field = 4.0 * (points * points) as f64;
    println!(
        "\n{}, a pressure, {points} x {points}, {iterations} iterations in {} rounds; a field is copied at {:.2} GB/s\n",
        LAWS[*law].0,
        ROUNDS,
        copy_rate / 1e9
    );
    println!("| kernel | dispatches | fields | device time (us) | GB/s | of the copy rate |");
    println!("|---|---|---|---|---|---|");
    let row = |kernel: &KernelTime| {
        let rate = kernel.rate();
        println!(
            "| {} | {} | {:.2} | {:.0} | {:.2} | {:.2} |",
            kernel.name,
            kernel.dispatches as f64 / f64::from(*iterations),
            kernel.bytes as f64 / field,
            1e6 * kernel.seconds,
            rate / 1e9,
            rate / copy_rate
        );
    };
    timings.kernels.iter().for_each(row);
    let total = timings.total();
    row(&total);
    let least = total.bytes as f64 / copy_rate;
    println!(
        "\nAn iteration takes {:.0} us by the host's clock: {:.1} times the {:.0} us that its counted bytes take at the copy rate.",
        1e6 * iteration,
        iteration / least,
        1e6 * least
    );
}

fn figure(device: &str, software: bool, all: &[Measured]) -> Figure {
    let panels = LAWS.iter().enumerate().map(|(law, (title, _))| {
        let of_law = || all.iter().filter(move |measured| measured.law == law);
        let point =
            |measured: &Measured, rate: f64| PlotPoint::new(measured.points as f64, rate / 1e9);
        let copies = of_law().map(|measured| point(measured, measured.copy_rate));
        let mut series = vec![Series::marked_line(0, copies.collect())];
        for (index, (end, _)) in SHOWN.iter().enumerate() {
            let found = of_law().filter_map(|measured| {
                let kernels = &measured.timings.kernels;
                let kernel = kernels.iter().find(|kernel| kernel.name.ends_with(end))?;
                Some(point(measured, kernel.rate()))
            });
            series.push(Series::marked_line(index + 1, found.collect()));
        }
        Panel {
            title: (*title).to_owned(),
            x: Axis::logarithmic("points along a side", ""),
            y: Axis::logarithmic("bytes moved a second", "GB/s"),
            series,
        }
    });
    Figure {
        title: format!("Kernels on {device}"),
        note: if software {
            "software that computes on the processor, no graphics processor".to_owned()
        } else {
            "counted bytes over device time".to_owned()
        },
        names: std::iter::once("copy")
            .chain(SHOWN.iter().map(|(_, name)| *name))
            .map(str::to_owned)
            .collect(),
        panels: panels.collect(),
        columns: 3,
        ..Figure::default()
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut sizes = std::env::args()
        .skip(1)
        .map(|text| text.parse())
        .collect::<Result<Vec<usize>, _>>()?;
    if sizes.is_empty() {
        sizes = vec![256, 512];
    }
    let device = GpuDevice::new(&AdapterChoice {
        software: true,
        ..AdapterChoice::default()
    })?;
    let description = device.description();
    println!(
        "{}, {}: {}.",
        description.name,
        description.driver,
        description.kind.name()
    );
    if description.software() {
        println!(
            "It is software: these times are those of the processor, and say nothing of a graphics processor."
        );
    }
    let mut all = Vec::new();
    for &points in &sizes {
        let surface = Surface::build(&scene(points, "")?)?;
        for law in 0..LAWS.len() {
            match measure(&device, law, points, &surface) {
                Ok(Some(measured)) => {
                    print(&measured);
                    all.push(measured);
                }
                Ok(None) => {
                    println!("The device has no timestamps: nothing to show.");
                    return Ok(());
                }
                Err(error) => println!("\n{points} x {points} is left out: {error}"),
            }
        }
    }
    figure(&description.name, description.software(), &all).write("gpu_table.png".as_ref())?;
    Ok(())
}
