//! The processor and a graphics processor against the plain text of the method
//! (`src/solver/plain.rs`), iterate by iterate.

use tabor::backend::Backend;
use tabor::backend::cpu;
use tabor::elastic::{Base, Layer};
use tabor::grid::Grid;
use tabor::kernel::Status;
use tabor::law::{Exponential, Law, LennardJones, MaugisDugdale};
use tabor::scene::Boundary;
use tabor::solver::{ContactSolver, Hold, Load, Problem, Start, plain};

use crate::operator::values;
use crate::shared::device::{device_with_double, double_backend};
use crate::shared::trials::{is_long, tests};

/// Iterations that are compared one by one.
const COMPARED: usize = 10;
/// Tolerance of the solves.
const TOLERANCE: f64 = 1e-8;
const MOST: usize = 2000;
/// The case of a size that not every backend transforms.
const ODD: &str = "odd";

struct Iterate {
    gap: Vec<f64>,
    step: f64,
    residual: f64,
}

struct Walked {
    iterates: Vec<Iterate>,
    status: Status,
    iterations: usize,
    gap: Vec<f64>,
    mean_pressure: f64,
}

fn by_plain(problem: &Problem, load: &Load, start: &[f64], careful: bool) -> Walked {
    let mut iterates = Vec::new();
    let (outcome, gap) = plain::solve(
        problem,
        load,
        start,
        TOLERANCE,
        MOST,
        careful,
        &mut |gap, step, residual| {
            if iterates.len() < COMPARED {
                iterates.push(Iterate {
                    gap: gap.to_vec(),
                    step,
                    residual,
                });
            }
        },
    );
    Walked {
        iterates,
        status: outcome.status,
        iterations: outcome.iterations,
        gap,
        mean_pressure: outcome.mean_pressure,
    }
}

fn by_backend(
    make: &dyn Fn() -> Box<dyn Backend + Send>,
    problem: &Problem,
    load: &Load,
    start: &[f64],
    careful: bool,
) -> Walked {
    let mut backend = make();
    let mut solver = ContactSolver::new(&mut *backend, problem);
    let start = Start::Gap(start.to_vec().into());
    solver
        .begin(load, &start, TOLERANCE, careful)
        .expect("begins");
    let mut iterates: Vec<Iterate> = Vec::new();
    // Trials that are lost are rounds of their own here.
    for _ in 0..4 * COMPARED {
        let before = iterates.len();
        let scalars = solver.iterate().expect("iterates");
        if scalars.iterations as usize > before && scalars.accepted {
            iterates.push(Iterate {
                gap: solver.gap().expect("gap").into(),
                step: scalars.step,
                residual: scalars.residual,
            });
        }
        if iterates.len() == COMPARED || scalars.status != Status::Running {
            break;
        }
    }
    let outcome = solver
        .solve(load, &start, TOLERANCE, MOST, careful, make, &mut |_| true)
        .expect("solves");
    Walked {
        iterates,
        status: outcome.status,
        iterations: outcome.iterations,
        gap: solver.gap().expect("gap").into(),
        mean_pressure: outcome.mean_pressure,
    }
}

/// A rough surface: random numbers smoothed over some pixels.
fn rough(points: [usize; 2]) -> Vec<f64> {
    let [nx, ny] = points;
    let mut heights = values(nx * ny, 1);
    for _ in 0..12 {
        heights = (0..nx * ny)
            .map(|i| {
                let (x, y) = (i % nx, i / nx);
                let at = |x: usize, y: usize| heights[y % ny * nx + x % nx];
                0.4 * at(x, y)
                    + 0.15 * (at(x + 1, y) + at(x + nx - 1, y) + at(x, y + 1) + at(x, y + ny - 1))
            })
            .collect();
    }
    heights
}

fn problem(points: [usize; 2], boundary: Boundary, law: Law) -> Problem {
    let grid = Grid::new(points, [1.0, points[1] as f64 / points[0] as f64]);
    let heights: Vec<f64> = rough(points).iter().map(|h| 0.05 * h).collect();
    Problem::new(grid, boundary, 1.0, &heights, 0.3, law)
}

fn laws(work: f64, range: f64) -> Vec<(&'static str, Law)> {
    let dugdale = |taper: f64| {
        Law::MaugisDugdale(MaugisDugdale {
            peak_tension: work / range,
            range,
            taper,
        })
    };
    let exponential = Exponential {
        work_of_adhesion: work,
        range,
    };
    let lennard_jones = LennardJones {
        work_of_adhesion: work,
        range,
    };
    vec![
        ("hard wall", Law::HardWall),
        ("sharp", dugdale(0.0)),
        ("tapered", dugdale(0.5 * range)),
        ("exponential", Law::Exponential(exponential)),
        ("Lennard-Jones", Law::LennardJones(lennard_jones)),
    ]
}

/// What is prescribed, in reduced units of a problem.
fn loads(problem: &Problem) -> Vec<(&'static str, Load)> {
    let softest = ContactSolver::pressure_compliance(problem, 0.0);
    let pressure = 0.05 / problem.scales.pressure;
    let zero = problem.stiffness.zero_mode();
    if zero > 0.0 {
        // A free boundary: a force; an approach, which the half-space's own zero mode holds; and one
        // behind a spring as soft as that.
        return vec![
            (
                "force",
                Load {
                    hold: Hold::Pressure(0.2 * pressure),
                    zero_stiffness: 0.0,
                    zero_compliance: 1.0 / zero,
                },
            ),
            (
                "approach",
                Load {
                    hold: Hold::Pressure(0.5 * zero),
                    zero_stiffness: zero,
                    zero_compliance: 1.0 / zero,
                },
            ),
            (
                "spring",
                Load {
                    hold: Hold::Pressure(0.4 * zero),
                    zero_stiffness: 0.5 * zero,
                    zero_compliance: 2.0 / zero,
                },
            ),
        ];
    }
    vec![
        (
            "pressure",
            Load {
                hold: Hold::Pressure(pressure),
                zero_stiffness: 0.0,
                zero_compliance: ContactSolver::pressure_compliance(problem, pressure),
            },
        ),
        (
            "mean gap",
            Load {
                hold: Hold::Gap(0.6),
                zero_stiffness: 0.0,
                zero_compliance: softest,
            },
        ),
        (
            "spring",
            Load {
                hold: Hold::Pressure(0.3 / softest),
                zero_stiffness: 0.5 / softest,
                zero_compliance: 2.0 * softest,
            },
        ),
    ]
}

/// The undeformed surfaces at first touch, at the prescribed mean gap where there is one.
fn start(problem: &Problem, load: &Load) -> Vec<f64> {
    let highest = problem.highest();
    let mut gap: Vec<f64> = problem.heights.iter().map(|h| highest - h).collect();
    if let Hold::Gap(target) = load.hold {
        let mean = gap.iter().sum::<f64>() / gap.len() as f64;
        gap.iter_mut().for_each(|g| *g *= target / mean);
    }
    problem.padded(&gap, 0.0)
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most: f64, v| most.max(v.abs()))
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    let off = a.iter().zip(b).map(|(a, b)| (a - b).abs());
    off.fold(0.0, f64::max) / largest(b)
}

/// Compares one solve; says what it found.
fn compare(name: &str, walked: &Walked, plain: &Walked, [rounding, floor]: [f64; 2]) {
    let compared = walked.iterates.len().min(plain.iterates.len());
    let mut worst = [0.0_f64; 3];
    for (own, specified) in walked.iterates.iter().zip(&plain.iterates) {
        let off = [
            apart(&own.gap, &specified.gap),
            (own.step - specified.step).abs() / specified.step.abs(),
            ((own.residual - specified.residual).abs() - floor).max(0.0) / specified.residual,
        ];
        worst = [0, 1, 2].map(|i| worst[i].max(off[i]));
    }
    println!(
        "{name}: {compared} iterates, gap {:.1e}, step {:.1e}, residual {:.1e}; iterations {} ({}), {:?}, mean pressure {} ({})",
        worst[0],
        worst[1],
        worst[2],
        walked.iterations,
        plain.iterations,
        walked.status,
        walked.mean_pressure,
        plain.mean_pressure
    );
    assert!(
        walked.iterates.len() == plain.iterates.len() && compared > 0,
        "{name}"
    );
    assert!(worst.iter().all(|&off| off < rounding), "{name}: {worst:?}");
    assert_eq!(walked.status, plain.status, "{name}");
    assert_eq!(walked.status, Status::Converged, "{name}");
    assert!(walked.iterations.abs_diff(plain.iterations) <= 2, "{name}");
    assert!(apart(&walked.gap, &plain.gap) < 1e-6, "{name}");
}

/// Under what a case is compared.
#[derive(Clone, Copy, PartialEq)]
enum Controls {
    All,
    InTurn,
}

fn cases() -> Vec<(String, Problem)> {
    let mut cases = Vec::new();
    for (boundary, points, kind) in [
        (Boundary::Periodic, [32, 48], "periodic"),
        (Boundary::Free, [24, 20], "free"),
    ] {
        for (law, problem_law) in laws(2e-4, 5e-3) {
            cases.push((
                format!("{kind}, {law}"),
                problem(points, boundary, problem_law),
            ));
        }
    }
    let tapered = laws(2e-4, 5e-3)[2].1;
    let layer = Layer {
        thickness: 0.1,
        poisson_ratio: 0.4,
        base: Base::Bonded,
    };
    for law in [Law::HardWall, tapered] {
        let on_layer = problem([32, 32], Boundary::Periodic, law).on_layer(layer);
        cases.push((format!("layer, {law:?}"), on_layer));
    }
    let factor: Vec<f64> = values(32 * 32, 1).iter().map(|x| 1.0 + 0.5 * x).collect();
    let mapped = problem([32, 32], Boundary::Periodic, tapered).with_adhesion_map(factor);
    cases.push(("map of adhesion".into(), mapped));
    let factor: Vec<f64> = values(32 * 32, 1).iter().map(|x| 1.0 + 0.5 * x).collect();
    let smooth = laws(2e-4, 5e-3)[4].1;
    let mapped = problem([32, 32], Boundary::Periodic, smooth).with_adhesion_map(factor);
    cases.push(("map of Lennard-Jones".into(), mapped));
    // No coarse level: 27 and 25 cannot be halved.
    cases.push((
        ODD.into(),
        problem([27, 25], Boundary::Periodic, Law::HardWall),
    ));
    cases
}

/// Compares the cases of these boundaries on a backend, to a rounding and a floor of the residual: each under all `controls`, or under one,
/// the next of them in turn.
fn compare_all(
    make: &dyn Fn() -> Box<dyn Backend + Send>,
    boundaries: &[Boundary],
    controls: Controls,
    bounds: [f64; 2],
) {
    for (place, (name, problem)) in cases().into_iter().enumerate() {
        if !boundaries.contains(&problem.boundary) {
            continue;
        }
        // A graphics processor takes sizes of small prime factors alone.
        if name == ODD && !make().suits(problem.shape) {
            println!("{name}: no transform of this size here");
            continue;
        }
        let loads = loads(&problem);
        let in_turn = place % loads.len();
        for (index, (control, load)) in loads.into_iter().enumerate() {
            if controls == Controls::InTurn && index != in_turn {
                continue;
            }
            let start = start(&problem, &load);
            // The sharp law begins carefully in runs.
            let sharp = problem.law.is_adhesive() && !problem.law.has_tail();
            for careful in [false, true]
                .into_iter()
                .filter(|careful| sharp || !careful)
            {
                let name = format!(
                    "{name}, {control}{}",
                    if careful { ", careful" } else { "" }
                );
                let plain = by_plain(&problem, &load, &start, careful);
                let walked = by_backend(make, &problem, &load, &start, careful);
                compare(&name, &walked, &plain, bounds);
            }
        }
    }
}

/// Largest relative difference between two iterates, and the rounding of a residual. Sums are added in another order and a
/// prescribed mean gap is held by linearity: some hundred roundings, which ten iterations amplify by at most 1e4. A residual
/// near the tolerance of 1e-8 is a difference of numbers near 1, so that its own rounding is absolute.
const ROUNDING: [f64; 2] = [1e-8, 1e-14];

/// Gap, step length and residual of the first ten iterations, and the number of them all, for each
/// law, control and boundary.
fn the_processor_follows_the_plain_text() {
    let make = || cpu::double(None);
    let both = [Boundary::Periodic, Boundary::Free];
    compare_all(&make, &both, Controls::All, ROUNDING);
}

fn follows_on_the_graphics_processor(boundary: Boundary) {
    let device = device_with_double();
    let make = || -> Box<dyn Backend + Send> { Box::new(double_backend(device)) };
    let controls = if is_long() {
        Controls::All
    } else {
        Controls::InTurn
    };
    compare_all(&make, &[boundary], controls, ROUNDING);
}

/// The same on a graphics processor in double precision, whose sums and transforms round elsewhere. A software driver takes a second and more for each
/// solve: a case has one of the controls, the next one has another, and with `TABOR_LONG=1` each has all.
fn the_graphics_processor_follows_the_plain_text() {
    follows_on_the_graphics_processor(Boundary::Periodic);
}

fn the_graphics_processor_follows_the_plain_text_on_a_free_boundary() {
    follows_on_the_graphics_processor(Boundary::Free);
}

/// Under a tension that no law here carries every path says that the surfaces leave each other, after as
/// many iterations.
fn surfaces_that_leave_each_other(make: &dyn Fn() -> Box<dyn Backend + Send>) {
    for (name, law) in laws(2e-4, 5e-3) {
        let problem = problem([32, 32], Boundary::Periodic, law);
        let tension = 2.0 * law.peak_tension().max(0.01) / problem.scales.pressure;
        let load = Load {
            hold: Hold::Pressure(-tension),
            zero_stiffness: 0.0,
            zero_compliance: ContactSolver::pressure_compliance(&problem, tension),
        };
        let start = start(&problem, &load);
        let plain = by_plain(&problem, &load, &start, false);
        let walked = by_backend(make, &problem, &load, &start, false);
        println!(
            "{name}: {:?}, {} iterations",
            plain.status, plain.iterations
        );
        assert_eq!(plain.status, Status::PulledOff, "{name}");
        assert_eq!(walked.status, plain.status, "{name}");
        assert!(walked.iterations.abs_diff(plain.iterations) <= 2, "{name}");
    }
}

fn surfaces_leave_each_other_on_the_processor() {
    surfaces_that_leave_each_other(&|| cpu::double(None));
}

fn surfaces_leave_each_other_on_the_graphics_processor() {
    let device = device_with_double();
    surfaces_that_leave_each_other(&|| Box::new(double_backend(device)));
}

tests![
    the_graphics_processor_follows_the_plain_text,
    the_graphics_processor_follows_the_plain_text_on_a_free_boundary,
    the_processor_follows_the_plain_text,
    surfaces_leave_each_other_on_the_graphics_processor,
    surfaces_leave_each_other_on_the_processor,
];
