//! Whole solves on the graphics processor in single, mixed and double precision, and in mixed on the
//! processor, against the CPU in double.

use tabor::backend::Backend;
use tabor::backend::cpu;
use tabor::backend::gpu::{GpuBackend, GpuDevice, Traffic, Wide};
use tabor::grid::Grid;
use tabor::kernel::{Form, Status};
use tabor::law::{Exponential, Law, LennardJones, MaugisDugdale};
use tabor::scene::*;
use tabor::solver::{ContactSolver, Hold, Load, Outcome, Problem, Start};
use tabor::surface::Surface;

use crate::catalogue::variants;
use crate::shared::device::{
    backend, device, device_with_double, device_without_double, double_backend, relative_difference,
};
use crate::shared::trials::{is_long, tests};
use crate::watching::Watching;

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
        gap: solver
            .gap()
            .unwrap_or_else(|error| panic!("{error}"))
            .into(),
        pressure: solver
            .elastic_pressure()
            .unwrap_or_else(|error| panic!("{error}"))
            .into(),
        transforms: solver.transforms(),
    }
}

/// Solves on both; `bound` is for gaps and elastic pressures, relative L2.
fn compare(device: &GpuDevice, name: &str, problem: &Problem, load: &Load, bound: f64) {
    let cpu = || cpu::double(None);
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
    let grid = GridScene {
        points: Some([points, points]),
        size: Some([1.0, 1.0]),
        boundary: Boundary::Periodic,
    };
    let part = SurfacePart::SelfAffine(SelfAffineScene {
        hurst: 0.8,
        roughness: Roughness::RmsSlope(1.0),
        longest: 1.0,
        rolloff: 0.25,
        shortest: 8.0 / points as f64,
        seed: 1,
    });
    Surface::from_parts(&grid, &[part]).unwrap_or_else(|error| panic!("{error:?}"))
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
        Boundary::Free => 1.0 / problem.stiffness.zero_mode(),
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

fn rough_hard_wall() {
    let device = device();
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
    compare(device, "rough hard wall at pressure", &problem, &load, 1e-3);
}

/// Sums in single precision, halved in order, do as well at this tolerance.
fn rough_hard_wall_without_double_precision() {
    let device = device_without_double();
    assert_eq!(device.wide(), Wide::Compensated);
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

fn sphere_with_maugis_dugdale_on_a_free_boundary() {
    let device = device();
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

fn rough_lennard_jones_at_a_held_gap() {
    let device = device();
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

fn rough_wall_with_tail_at_a_held_gap() {
    let device = device();
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

/// A solid that flows, alone under a pressure and sticking at a held gap; depths and gaps alike are
/// bounded as gaps are above.
fn rough_solid_that_flows() {
    let device = device();
    let surface = rough(64);
    let problem = |law| {
        let (grid, heights) = (surface.grid, &surface.heights);
        Problem::new(grid, Boundary::Periodic, 1.0, heights, 1.0, law).with_hardness(0.3)
    };
    let wall = problem(Law::HardWall);
    let load = at_pressure(&wall, 0.1);
    compare(device, "hardness at pressure", &wall, &load, 1e-3);
    let sticky = problem(Law::MaugisDugdale(MaugisDugdale {
        peak_tension: 0.05,
        range: 5e-3,
        taper: 5e-3,
    }));
    let load = at_gap(&sticky, 0.02);
    compare(device, "hardness at a held gap", &sticky, &load, 2e-3);
}

fn looking_less_often_changes_no_bit() {
    let device = device();
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
        // A direction that was readied and not taken: two transforms, and the half that brings it back.
        let more = eight.transforms - one.transforms;
        assert!((0.0..=2.5).contains(&more), "{more} transforms more");
    }
}

/// What mixed precision is to reach on every law, boundary and control.
const TIGHT: f64 = 1e-9;

/// The laws in the units of the test surfaces, whose contact modulus and cell are 1.
fn laws() -> [(&'static str, Law); 5] {
    let dugdale = |taper| {
        Law::MaugisDugdale(MaugisDugdale {
            peak_tension: 0.05,
            range: 5e-3,
            taper,
        })
    };
    [
        ("hard wall", Law::HardWall),
        ("sharp Maugis-Dugdale", dugdale(0.0)),
        ("tapered Maugis-Dugdale", dugdale(5e-3)),
        (
            "exponential",
            Law::Exponential(Exponential {
                work_of_adhesion: 2.5e-4,
                range: 5e-3,
            }),
        ),
        (
            "Lennard-Jones",
            Law::LennardJones(LennardJones {
                work_of_adhesion: 2.5e-4,
                range: 5e-3,
            }),
        ),
    ]
}

/// A spring of the softest wave's own stiffness, stretched to where it presses this much.
fn with_spring(problem: &Problem, pressure: f64) -> Load {
    let stiffness = problem.stiffness_min();
    Load {
        hold: Hold::Pressure(pressure / problem.scales.pressure + stiffness * problem.highest()),
        zero_stiffness: stiffness,
        zero_compliance: 1.0 / stiffness,
    }
}

/// Every law under every control that a boundary has.
fn contacts(points: usize) -> Vec<(String, Problem, Load)> {
    let surface = rough(points);
    let (grid, heights) = sphere(points / 2);
    let mut found = Vec::new();
    for (name, law) in laws() {
        let periodic = Problem::new(
            surface.grid,
            Boundary::Periodic,
            1.0,
            &surface.heights,
            1.0,
            law,
        );
        let free = Problem::new(grid, Boundary::Free, 1.0, &heights, 0.4, law);
        for (control, load) in [
            ("pressure", at_pressure(&periodic, 0.05)),
            ("gap", at_gap(&periodic, 0.03)),
            ("spring", with_spring(&periodic, 0.05)),
        ] {
            found.push((format!("{name}, {control}"), periodic.clone(), load));
        }
        let approach = Load {
            hold: Hold::Pressure(0.01 / free.scales.length * free.stiffness.zero_mode()),
            zero_stiffness: free.stiffness.zero_mode(),
            zero_compliance: 1.0 / free.stiffness.zero_mode(),
        };
        let force = at_pressure(&free, 0.002);
        found.push((format!("{name}, free, force"), free.clone(), force));
        found.push((format!("{name}, free, approach"), free, approach));
    }
    found
}

/// The stopping measure of a gap, by the processor in double precision alone.
fn true_residual(problem: &Problem, load: &Load, gap: &[f64]) -> f64 {
    let mut backend = cpu::double(None);
    let mut solver = ContactSolver::new(&mut *backend, problem);
    solver
        .begin(load, &Start::Gap(gap.to_vec().into()), TIGHT, false)
        .and_then(|()| solver.evaluate())
        .unwrap_or_else(|error| panic!("{error}"))
        .residual
}

/// Solves to `TIGHT` in mixed precision and checks it in double; returns the worst residual.
fn tight(
    name: &str,
    problem: &Problem,
    load: &Load,
    make: &dyn Fn() -> Box<dyn Backend + Send>,
) -> f64 {
    let double = || cpu::double(None);
    let reference = solve(problem, load, &Start::Cold, TIGHT, &double);
    let clock = std::time::Instant::now();
    let mixed = solve(problem, load, &Start::Cold, TIGHT, make);
    let took = clock.elapsed();
    let residual = true_residual(problem, load, &mixed.gap);
    let apart = relative_difference(&mixed.gap, &reference.gap);
    println!(
        "{name}: {:?} {} iterations ({} in double), residual {:.1e}, again {residual:.1e}, gap apart {apart:.1e}, {took:.1?}",
        mixed.outcome.status,
        mixed.outcome.iterations,
        reference.outcome.iterations,
        mixed.outcome.residual,
    );
    assert_eq!(mixed.outcome.status, reference.outcome.status, "{name}");
    if mixed.outcome.status != Status::Converged {
        return 0.0;
    }
    assert!(residual <= TIGHT, "{name}: {residual:e}");
    residual
}

fn mixed_precision_on_the_processor_reaches_the_tolerance_of_double() {
    let mixed = || cpu::mixed(None);
    let mut worst = 0.0f64;
    for (name, problem, load) in contacts(64) {
        worst = worst.max(tight(&name, &problem, &load, &mixed));
    }
    println!("worst residual {worst:.1e}");
}

/// All laws on one boundary, and on the other those whose pad differs most: every pair of a law and a boundary is a shader of its own, which
/// software compiles slowly. `TABOR_LONG=1` takes all pairs.
fn few_contacts() -> Vec<(String, Problem, Load)> {
    let mut contacts = contacts(32);
    contacts.retain(|(name, ..)| {
        let free = name.contains("free");
        let differs = name.starts_with("exponential") || name.starts_with("Lennard-Jones");
        is_long() || !free || differs
    });
    contacts
}

fn mixed_precision_on_the_device_reaches_the_tolerance_of_double() {
    let device = device();
    let mixed = || -> Box<dyn Backend + Send> { Box::new(backend(device).corrected()) };
    let mut worst = 0.0f64;
    for (name, problem, load) in few_contacts() {
        worst = worst.max(tight(&name, &problem, &load, &mixed));
    }
    println!("worst residual {worst:.1e}");
}

/// Solves to `TIGHT` in double precision on the device and on the processor: the same iterations, give or
/// take a few where rounding decides whether one more is made, and the same gap to the tolerance.
fn double_precision_on_the_device_solves_as_the_processor_does() {
    let device = device_with_double();
    let cpu = || cpu::double(None);
    let gpu = || -> Box<dyn Backend + Send> { Box::new(double_backend(device)) };
    let surface = rough(32);
    let (grid, heights) = (surface.grid, &surface.heights);
    let flowing =
        Problem::new(grid, Boundary::Periodic, 1.0, heights, 1.0, laws()[2].1).with_hardness(0.3);
    let held = at_gap(&flowing, 0.02);
    let mut all = few_contacts();
    all.push(("hardness, gap".to_owned(), flowing, held));
    for (name, problem, load) in all {
        let reference = solve(&problem, &load, &Start::Cold, TIGHT, &cpu);
        let ours = solve(&problem, &load, &Start::Cold, TIGHT, &gpu);
        let apart = relative_difference(&ours.gap, &reference.gap);
        let counts = [&ours, &reference].map(|solution| solution.outcome.iterations);
        println!(
            "{name}: {:?} {counts:?} iterations, gap apart {apart:.1e}",
            ours.outcome.status
        );
        assert_eq!(ours.outcome.status, reference.outcome.status, "{name}");
        if ours.outcome.status != Status::Converged {
            continue;
        }
        let more = counts[0].abs_diff(counts[1]);
        assert!(more <= 1 + counts[1] / 20, "{name}: {counts:?}");
        // The residual weighs short waves by their stiffness, up to some times that of the gap's own.
        assert!(apart <= 10.0 * TIGHT, "{name}: {apart:e}");
        let residual = true_residual(&problem, &load, &ours.gap);
        assert!(residual <= TIGHT, "{name}: {residual:e}");
    }
}

/// Fields that passes move, in numbers a point of the fine grid: those bound, twice where they are
/// updated, and the work space, which a multiplication updates, beside its table where it has one.
fn fields_moved(passes: &[String]) -> f64 {
    let mut moved = 0.0;
    // Points of the level over those of the fine one; a halving leaves a quarter.
    let (fine, mut level) = (1.0, 1.0);
    for name in passes {
        if name.starts_with("multiply") {
            moved += level * if name == "multiply" { 2.0 } else { 2.25 };
            continue;
        }
        let kernel = variants()
            .find(|kernel| kernel.variant() == *name)
            .unwrap_or_else(|| panic!("{name} is in no catalogue"));
        let before = level;
        match kernel.name {
            "coarsen" => level /= 4.0,
            "refine" | "soften" | "level_descent" => level *= 4.0,
            _ => {}
        }
        let written = 2 * kernel.writes.len() - kernel.fresh;
        let read = kernel.reads.len() + usize::from(kernel.around.is_some());
        moved += level * (read + written) as f64;
        if kernel.whole {
            moved += if kernel.name == "free_share" {
                fine
            } else {
                before
            };
        }
        moved += level
            * match kernel.form {
                Form::Sweep => 0.0,
                Form::Load | Form::Store | Form::ReadRetained | Form::Retain => 1.0,
                // The work space is read and written.
                Form::RetainRows | Form::FromRetained | Form::InverseThenForward => 2.0,
            };
    }
    assert_eq!(level, fine);
    moved
}

/// Dispatches and passes of so many iterations that are not looked at, with what readies them: those near a
/// solution, where the preconditioner has its levels.
fn iterations(
    device: &GpuDevice,
    problem: &Problem,
    load: &Load,
    count: usize,
) -> (Traffic, Vec<String>) {
    let mut watching = Watching::over(backend(device).looking_every(count));
    let mut solver = ContactSolver::new(&mut watching, problem);
    solver
        .begin(load, &Start::Cold, 0.0, false)
        .and_then(|()| {
            solver.precondition_by_levels();
            solver.advance(count)
        })
        .unwrap_or_else(|error| panic!("{error}"));
    let passes = watching.here.lock().expect("nobody panics here").clone();
    (watching.inner.traffic(), passes)
}

/// The table on the crate page: dispatches and fields moved by an iteration, with the evaluations of a step
/// length that belong to it.
fn an_iteration_costs_what_the_crate_page_says() {
    let device = device();
    let page = include_str!("../../src/lib.rs");
    let mut missing = Vec::new();
    let surface = rough(64);
    let flowing = "the same with a hardness, a mean gap";
    for (title, law, held) in [
        ("no adhesion, a pressure", laws()[0].1, false),
        ("sharp Maugis-Dugdale, a pressure", laws()[1].1, false),
        ("sharp Maugis-Dugdale, a mean gap", laws()[1].1, true),
        (flowing, laws()[1].1, true),
        ("exponential, a pressure", laws()[3].1, false),
        ("Lennard-Jones, a pressure", laws()[4].1, false),
        ("Lennard-Jones, a mean gap", laws()[4].1, true),
    ] {
        let problem = Problem::new(
            surface.grid,
            Boundary::Periodic,
            1.0,
            &surface.heights,
            1.0,
            law,
        );
        let problem = match title == flowing {
            true => problem.with_hardness(0.3),
            false => problem,
        };
        let load = match held {
            true => at_gap(&problem, 0.03),
            false => at_pressure(&problem, 0.05),
        };
        let (before, passes_before) = iterations(device, &problem, &load, 2);
        let (after, passes) = iterations(device, &problem, &load, 3);
        let passes = &passes[passes_before.len()..];
        let dispatches = after.dispatches - before.dispatches;
        let row = format!("| {title} | {dispatches} | {:.1} |", fields_moved(passes));
        println!("{row} {passes:?}");
        if !page.contains(&format!("//! {row}")) {
            missing.push(row);
        }
    }
    assert!(missing.is_empty(), "not on the crate page: {missing:?}");
}

/// A whole solve in mixed precision: every iteration is on the device, and so is all that corrects it where
/// the device has double precision: then nothing crosses the bus after the start. Elsewhere the processor
/// does that and nothing else, and fields cross the bus for the corrections alone.
fn nothing_but_corrections_crosses_the_bus() {
    let device = device();
    let without = device_without_double();
    // As the other tests here have it, whose shaders serve.
    let surface = rough(32);
    let load = |problem: &Problem, held: bool| match held {
        true => at_gap(problem, 0.03),
        false => at_pressure(problem, 0.05),
    };
    for (device, law, held, corrected) in [
        (device, laws()[1].1, false, true),
        (device, laws()[4].1, true, true),
        (&without, laws()[1].1, true, true),
        (device, laws()[1].1, false, false),
    ] {
        let problem = Problem::new(
            surface.grid,
            Boundary::Periodic,
            1.0,
            &surface.heights,
            1.0,
            law,
        );
        let load = load(&problem, held);
        let nobody = || -> Box<dyn Backend + Send> { panic!("no coarse start on this grid") };
        let gpu: GpuBackend = match corrected {
            true => backend(device).corrected(),
            false => backend(device),
        };
        let mut watching = Watching::over(gpu);
        let tolerance = if corrected { TIGHT } else { 1e-4 };
        let mut solver = ContactSolver::new(&mut watching, &problem);
        let outcome = solver
            .solve(
                &load,
                &Start::Cold,
                tolerance,
                500,
                false,
                &nobody,
                &mut |_| true,
            )
            .unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(outcome.status, Status::Converged);
        let traffic = watching.inner.traffic();
        let double = watching.double.lock().expect("nobody panics here").clone();
        let evaluations = double
            .iter()
            .filter(|&name| name == "load_displacement")
            .count();
        println!("{outcome:?} {traffic:?}, {evaluations} evaluations");
        // An iteration takes seven passes at least, levels of the preconditioner aside.
        assert!(traffic.dispatches >= 7 * outcome.iterations as u64);
        // What stands beside evaluates and corrects, and does not iterate.
        let of_outer = |name: &String| {
            let kernel = name.split('-').next().unwrap_or_default();
            [
                "load_displacement",
                "multiply",
                "store_field",
                "balance",
                "residual",
                "outer_residual",
                "outer_pressure",
                "add_correction",
                "restore_outer_gap",
            ]
            .contains(&kernel)
        };
        assert!(double.iter().all(of_outer), "{double:?}");
        // What the heights press is found in the same way, once, where a held gap takes it.
        let linear = held && law.has_wall();
        let others = 1 + usize::from(linear && corrected);
        let rounds = evaluations.saturating_sub(others) as u64;
        assert_eq!(corrected, rounds > 0);
        assert!(rounds <= 4, "{rounds} rounds");
        // The start goes up once, and so do the heights unless what stands beside on the device holds them; without corrections
        // nothing comes down.
        let beside = corrected && device.description().double;
        let through_the_host = corrected && !beside;
        let [up, down] = match through_the_host {
            true => [(2 + u64::from(linear)) * rounds, 1 + rounds],
            false => [0, 0],
        };
        assert_eq!(traffic.fields_up, 1 + u64::from(!beside) + up);
        assert_eq!(traffic.fields_down, down);
    }
}

/// The same problem twice, sums in double or compensated in single, in all precisions.
fn the_same_problem_twice_gives_the_same_bits() {
    let device = device();
    let single_sums = device_without_double();
    let (grid, heights) = sphere(32);
    let problem = Problem::new(grid, Boundary::Periodic, 1.0, &heights, 0.3, laws()[2].1);
    let load = at_gap(&problem, 0.05);
    for device in [device, &single_sums] {
        for precision in [Precision::Single, Precision::Mixed, Precision::Double] {
            if precision == Precision::Double && !device.description().double {
                continue;
            }
            let gpu = || -> Box<dyn Backend + Send> {
                Box::new(match precision {
                    Precision::Mixed => backend(device).corrected(),
                    Precision::Double => double_backend(device),
                    _ => backend(device),
                })
            };
            let tolerance = match precision {
                Precision::Single => 1e-4,
                _ => TIGHT,
            };
            let [one, two] =
                [(); 2].map(|()| solve(&problem, &load, &Start::Cold, tolerance, &gpu));
            assert_eq!(one.outcome.status, Status::Converged);
            assert_eq!(one.outcome, two.outcome);
            assert!(one.gap == two.gap && one.pressure == two.pressure);
        }
    }
}

tests![
    rough_hard_wall,
    rough_hard_wall_without_double_precision,
    sphere_with_maugis_dugdale_on_a_free_boundary,
    rough_lennard_jones_at_a_held_gap,
    rough_wall_with_tail_at_a_held_gap,
    rough_solid_that_flows,
    looking_less_often_changes_no_bit,
    mixed_precision_on_the_processor_reaches_the_tolerance_of_double,
    mixed_precision_on_the_device_reaches_the_tolerance_of_double,
    double_precision_on_the_device_solves_as_the_processor_does,
    an_iteration_costs_what_the_crate_page_says,
    nothing_but_corrections_crosses_the_bus,
    the_same_problem_twice_gives_the_same_bits,
];
