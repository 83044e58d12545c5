//! Whole solves on the graphics processor in single precision, against the CPU in double.

mod gpu_shared;

use std::path::PathBuf;

use gpu_shared::{backend, device, device_with_single_sums, relative_difference};
use tabor::backend::Backend;
use tabor::backend::cpu::CpuBackend;
use tabor::backend::gpu::{GpuDevice, Wide};
use tabor::grid::Grid;
use tabor::kernel::Status;
use tabor::law::{Law, LennardJones, MaugisDugdale};
use tabor::scene::*;
use tabor::solver::{ContactSolver, Hold, Load, Outcome, Problem, Start};
use tabor::surface::Surface;

struct Solution {
    outcome: Outcome,
    gap: Vec<f64>,
    pressure: Vec<f64>,
    transforms: f64,
}

fn solve(
    problem: &Problem,
    load: &Load,
    start: &Start,
    tolerance: f64,
    make: &dyn Fn() -> Box<dyn Backend + Send>,
) -> Solution {
    let mut backend = make();
    let mut solver = ContactSolver::new(&mut *backend, problem);
    let outcome = solver
        .solve(load, start, tolerance, 2000, false, make, &mut |_| true)
        .unwrap_or_else(|error| panic!("{error}"));
    Solution {
        outcome,
        gap: solver.gap().unwrap_or_else(|error| panic!("{error}")),
        pressure: solver
            .elastic_pressure()
            .unwrap_or_else(|error| panic!("{error}")),
        transforms: solver.transforms(),
    }
}

/// Solves on both; `bound` is for gaps and elastic pressures, relative L2.
fn compare(device: &GpuDevice, name: &str, problem: &Problem, load: &Load, bound: f64) {
    let cpu = || -> Box<dyn Backend + Send> { Box::new(CpuBackend::<f64>::new()) };
    let gpu = || -> Box<dyn Backend + Send> { Box::new(backend(device)) };
    let clock = std::time::Instant::now();
    let reference = solve(problem, load, &Start::Cold, 1e-8, &cpu);
    let loose = solve(problem, load, &Start::Cold, 1e-4, &cpu);
    let between = clock.elapsed();
    let ours = solve(problem, load, &Start::Cold, 1e-4, &gpu);
    let errors = [
        relative_difference(&ours.gap, &reference.gap),
        relative_difference(&ours.pressure, &reference.pressure),
    ];
    let open = |solution: &Solution| solution.gap.iter().filter(|&&gap| gap > 0.0).count();
    println!(
        "{name}: {:?}, transforms {} (CPU {} to 1e-4, {} to 1e-8), errors {errors:?}, open {} ({}), mean pressure {} ({}); CPU {between:.1?}, GPU {:.1?}",
        ours.outcome.status,
        ours.transforms,
        loose.transforms,
        reference.transforms,
        open(&ours),
        open(&reference),
        ours.outcome.mean_pressure,
        reference.outcome.mean_pressure,
        clock.elapsed() - between,
    );
    assert_eq!(reference.outcome.status, Status::Converged, "{name}");
    assert_eq!(ours.outcome.status, Status::Converged, "{name}");
    assert!(ours.outcome.residual <= 1e-4, "{name}: {:?}", ours.outcome);
    assert!(
        errors.iter().all(|&error| error < bound),
        "{name}: {errors:?}"
    );
    let scale = reference.outcome.mean_pressure.abs().max(1e-3);
    let pressure = ours.outcome.mean_pressure - reference.outcome.mean_pressure;
    assert!(
        pressure.abs() < bound * scale,
        "{name}: mean pressure off by {pressure}"
    );
    // The work is that of the same solve in double precision, give or take some iterations.
    assert!(ours.transforms < 1.5 * loose.transforms + 12.0, "{name}");
}

fn rough(points: usize) -> Surface {
    let scene = Scene {
        title: None,
        grid: GridScene {
            points: Some([points, points]),
            size: Some([1.0, 1.0]),
            boundary: Boundary::Periodic,
        },
        solid: SolidScene {
            contact_modulus: 1.0,
            poisson_ratio: None,
            layer: None,
            relaxation: Vec::new(),
        },
        surfaces: vec![SurfacePart::SelfAffine(SelfAffineScene {
            hurst: 0.8,
            roughness: Roughness::RmsSlope(1.0),
            longest: 1.0,
            rolloff: 0.25,
            shortest: 8.0 / points as f64,
            seed: 1,
        })],
        capillary: None,
        friction: None,
        conductance: None,
        adhesion: None,
        loading: LoadingScene {
            control: Control::Pressure,
            durations: None,
            path: vec![0.05],
            spring: None,
        },
        solver: SolverScene {
            tolerance: 1e-4,
            max_iterations: 1000,
            precision: Precision::Auto,
            backend: BackendName::Auto,
        },
        output: OutputScene {
            images: vec![],
            fields: vec![],
            steps: StepChoice::Last,
        },
        folder: PathBuf::new(),
    };
    Surface::build(&scene).unwrap_or_else(|error| panic!("{error:?}"))
}

/// A paraboloid of unit radius over the unit square; slopes up to `1/2` at its sides.
fn sphere(points: usize) -> (Grid, Vec<f64>) {
    let grid = Grid::new([points, points], [1.0, 1.0]);
    let at = |i: usize| (i as f64 + 0.5) / points as f64 - 0.5;
    let heights = (0..points * points)
        .map(|index| {
            let (x, y) = (at(index % points), at(index / points));
            -0.5 * (x * x + y * y)
        })
        .collect();
    (grid, heights)
}

fn at_pressure(problem: &Problem, pressure: f64) -> Load {
    let reduced = pressure / problem.scales.pressure;
    let zero_compliance = match problem.boundary {
        Boundary::Periodic => ContactSolver::pressure_compliance(problem, reduced),
        Boundary::Free => 1.0 / problem.stiffness[0],
    };
    Load {
        hold: Hold::Pressure(reduced),
        zero_stiffness: 0.0,
        zero_compliance,
    }
}

fn at_gap(problem: &Problem, gap: f64) -> Load {
    Load {
        hold: Hold::Gap(gap / problem.scales.length),
        zero_stiffness: 0.0,
        zero_compliance: ContactSolver::pressure_compliance(problem, 0.0),
    }
}

#[test]
fn rough_hard_wall() {
    let Some(device) = device() else { return };
    let surface = rough(128);
    let problem = Problem::new(
        surface.grid,
        Boundary::Periodic,
        1.0,
        &surface.heights,
        1.0,
        Law::HardWall,
    );
    let load = at_pressure(&problem, 0.05);
    compare(device, "rough hard wall at pressure", &problem, &load, 1e-3);
}

/// Sums in single precision, halved in order, do as well at this tolerance.
#[test]
fn rough_hard_wall_without_double_precision() {
    let Some(device) = device_with_single_sums() else {
        return;
    };
    assert_eq!(device.wide(), Wide::Single);
    let surface = rough(64);
    let problem = Problem::new(
        surface.grid,
        Boundary::Periodic,
        1.0,
        &surface.heights,
        1.0,
        Law::HardWall,
    );
    let load = at_pressure(&problem, 0.05);
    compare(&device, "single sums", &problem, &load, 1e-3);
}

#[test]
fn sphere_with_maugis_dugdale_on_a_free_boundary() {
    let Some(device) = device() else { return };
    let (grid, heights) = sphere(32);
    let law = Law::MaugisDugdale(MaugisDugdale {
        peak_tension: 0.05,
        range: 0.01,
        taper: 0.006,
    });
    let problem = Problem::new(grid, Boundary::Free, 1.0, &heights, 0.4, law);
    let load = at_pressure(&problem, 0.002);
    compare(device, "sphere, Maugis-Dugdale", &problem, &load, 2e-3);
}

#[test]
fn rough_lennard_jones_at_a_held_gap() {
    let Some(device) = device() else { return };
    let surface = rough(64);
    let law = Law::LennardJones(LennardJones {
        work_of_adhesion: 5e-4,
        range: 5e-3,
    });
    let problem = Problem::new(
        surface.grid,
        Boundary::Periodic,
        1.0,
        &surface.heights,
        1.0,
        law,
    );
    let load = at_gap(&problem, 0.03);
    compare(device, "rough, Lennard-Jones", &problem, &load, 2e-3);
}

#[test]
fn rough_wall_with_tail_at_a_held_gap() {
    let Some(device) = device() else { return };
    let surface = rough(64);
    let law = Law::MaugisDugdale(MaugisDugdale {
        peak_tension: 0.05,
        range: 5e-3,
        taper: 5e-3,
    });
    let problem = Problem::new(
        surface.grid,
        Boundary::Periodic,
        1.0,
        &surface.heights,
        1.0,
        law,
    );
    let load = at_gap(&problem, 0.03);
    compare(device, "rough, Maugis-Dugdale", &problem, &load, 2e-3);
}

#[test]
fn looking_less_often_changes_no_bit() {
    let Some(device) = device() else { return };
    let (grid, heights) = sphere(32);
    let attraction = Law::MaugisDugdale(MaugisDugdale {
        peak_tension: 0.05,
        range: 0.01,
        taper: 0.005,
    });
    for law in [Law::HardWall, attraction] {
        let problem = Problem::new(grid, Boundary::Periodic, 1.0, &heights, 0.3, law);
        let load = Load {
            hold: Hold::Pressure(0.05),
            zero_stiffness: 0.0,
            zero_compliance: ContactSolver::pressure_compliance(&problem, 0.05),
        };
        let with = |rounds: usize| {
            let gpu =
                || -> Box<dyn Backend + Send> { Box::new(backend(device).looking_every(rounds)) };
            solve(&problem, &load, &Start::Cold, 1e-4, &gpu)
        };
        let (one, eight) = (with(1), with(8));
        assert_eq!(one.outcome.status, Status::Converged);
        assert_eq!(one.outcome, eight.outcome);
        assert_eq!(one.gap, eight.gap);
        assert_eq!(one.pressure, eight.pressure);
        assert_eq!(one.transforms, eight.transforms);
    }
}
