//! Energy: solves only lower it, and paths lose it only in jumps.

use tabor::backend::cpu;
use tabor::kernel::Status;
use tabor::solver::{ContactSolver, Hold, Load, Problem, Start};
use tabor::study::{PointState, StepRow, dissipation};

use crate::bench::{Solved, setup, solve, solve_on};
use crate::shared::trials::tests;

/// A rough cell of side 1 and modulus 1; `adhesion` and `loading` are the lines of those tables.
pub fn rough(points: usize, adhesion: &str, loading: &str) -> String {
    format!(
        r#"
        [grid]
        points = {points}
        size = 1.0
        [solid]
        contact_modulus = 1.0
        [[surface]]
        kind = "self-affine"
        hurst = 0.8
        rms_height = {RMS_HEIGHT}
        longest = 1.0
        rolloff = 0.5
        shortest = 0.125
        seed = 5
        {adhesion}
        [loading]
        {loading}
        [solver]
        tolerance = 1e-9
        "#
    )
}

pub const RMS_HEIGHT: f64 = 0.01;

/// The adhesive laws; of one work of adhesion and range unless a test says otherwise.
pub fn laws(work: f64, range: f64) -> [(&'static str, String); 4] {
    [
        ("sharp", "maugis-dugdale", "taper = 0.0"),
        ("tapered", "maugis-dugdale", ""),
        ("exponential", "exponential", ""),
        ("Lennard-Jones", "lennard-jones", ""),
    ]
    .map(|(name, law, more)| {
        let table = format!(
            "[adhesion]\nlaw = \"{law}\"\nwork_of_adhesion = {work:e}\nrange = {range:e}\n{more}"
        );
        (name, table)
    })
}

/// `<u,Ku>/2 + <V(g)>` never rises from one iteration to the next at a held mean gap, for any law,
/// from nearly apart to nearly closed.
fn a_solve_only_lowers_the_energy() {
    let mut cases = vec![("hard wall", String::new())];
    // chi = w dx/range^2 = 0.3: a cohesive zone of a few pixels.
    cases.extend(laws(1.7e-4, 3e-3));
    for (name, adhesion) in cases {
        let setup = setup(&rough(
            64,
            &adhesion,
            "control = \"mean-gap\"\npath = [0.01]",
        ));
        let problem = &setup.problem;
        for share in [2.5, 1.0, 0.2] {
            let load = Load {
                hold: Hold::Gap(share * RMS_HEIGHT / problem.scales.length),
                zero_stiffness: 0.0,
                zero_compliance: 1.0 / problem.stiffness_min(),
            };
            falls(&format!("{name}, gap {share}"), problem, &load, 1e-9);
        }
    }
}

/// Solves a held mean gap and sees that the energy falls in each iteration.
pub fn falls(name: &str, problem: &Problem, load: &Load, tolerance: f64) {
    let mut backend = cpu::double(None);
    let mut solver = ContactSolver::new(&mut *backend, problem);
    solver
        .begin(load, &Start::Cold, tolerance, false)
        .expect("cpu");
    let mut before = f64::INFINITY;
    let mut iterations = 0;
    loop {
        let (gap, elastic) = (
            solver.gap().expect("cpu"),
            solver.elastic_pressure().expect("cpu"),
        );
        let (mut energy, mut square) = (0.0, 0.0);
        for ((g, h), p) in gap.iter().zip(problem.heights.iter()).zip(&elastic) {
            energy += 0.5 * p * (g + h) + problem.law.energy(*g);
            square += (g + h) * (g + h);
        }
        // K u is carried along, with rounding of K_max |u| an iteration.
        let rounding = 1e-15 * problem.stiffness_max() * square * f64::from(iterations + 4);
        assert!(
            energy <= before + rounding,
            "{name}: rises by {:.1e} (rounding {rounding:.1e}) in iteration {iterations}",
            energy - before
        );
        before = energy;
        let scalars = solver.iterate().expect("cpu");
        iterations += 1;
        if scalars.status != Status::Running {
            assert_eq!(scalars.status, Status::Converged, "{name}");
            break;
        }
        assert!(iterations < 5000, "{name}: {:.1e}", scalars.residual);
    }
    println!("{name}: {iterations} iterations");
}

/// What a path lost.
struct Losses {
    /// Largest loss of a step without a jump, over w times the area that changed state (one pixel
    /// at least).
    largest_share: f64,
    /// Sum of the absolute losses of these steps, J.
    smooth: f64,
    /// Sum of the losses of the steps that jumped, J.
    jumps: f64,
    /// w times the area that changed state on the whole path, J.
    changed: f64,
    /// Area of the loop in force over approach, J.
    hysteresis: f64,
    count_in: usize,
    count_off: usize,
}

fn losses(solved: &Solved) -> Losses {
    let work = solved.setup.law.work_of_adhesion() * solved.setup.surface.grid.pixel_area();
    let mut losses = Losses {
        largest_share: 0.0,
        smooth: 0.0,
        jumps: 0.0,
        changed: 0.0,
        hysteresis: solved.end.hysteresis_energy.expect("a closed path"),
        count_in: solved.end.jump_in_steps.len(),
        count_off: solved.end.jump_off_steps.len(),
    };
    let points = |i: usize| -> &[PointState] { &solved.fields(i).points };
    for (i, pair) in solved.steps.windows(2).enumerate() {
        let lost = dissipation(&pair[0].row, &pair[1].row).expect("held");
        let changed = points(i)
            .iter()
            .zip(points(i + 1))
            .filter(|(a, b)| a != b)
            .count();
        let changed = work * changed.max(1) as f64;
        losses.changed += changed;
        if pair[1].jump.is_some() {
            losses.jumps += lost;
        } else {
            losses.smooth += lost.abs();
            losses.largest_share = losses.largest_share.max(lost.abs() / changed);
        }
    }
    losses
}

/// There and back between two places in equal steps.
pub fn loop_path(from: f64, to: f64, steps: usize) -> Vec<f64> {
    let mut path: Vec<f64> = (0..=steps)
        .map(|i| from + (to - from) * i as f64 / steps as f64)
        .collect();
    path.extend_from_within(..steps);
    path[steps + 1..].reverse();
    path
}

/// A Lennard-Jones sphere in the units of its tables; the windows taken leave the cohesive length
/// two pixels or more.
pub fn sphere(mu: f64, side: f64, path: &[f64]) -> Solved {
    solve(&format!(
        r#"
        [grid]
        points = 64
        size = {side}
        boundary = "free"
        [solid]
        contact_modulus = {:e}
        [[surface]]
        kind = "sphere"
        radius = 1.0
        [adhesion]
        law = "lennard-jones"
        work_of_adhesion = 1.0
        range = 1.0
        [loading]
        control = "approach"
        path = {path:?}
        [solver]
        tolerance = 1e-9
        "#,
        mu.powf(-1.5),
    ))
}

/// Checks a loop walked in steps and in half steps.
fn check(name: &str, coarse: &Losses, fine: &Losses) {
    for (steps, losses) in [("steps", coarse), ("half steps", fine)] {
        println!(
            "{name}, {steps}: share {:.1e}, smooth {:.2e}, jumps {:.4e} ({} in, {} off), loop {:.4e}",
            losses.largest_share,
            losses.smooth,
            losses.jumps,
            losses.count_in,
            losses.count_off,
            losses.hysteresis
        );
        assert!(
            losses.largest_share < 0.01,
            "{name}, {steps}: a step without a jump loses energy"
        );
        // What is stored adds up to nothing over a loop, so its area is the sum of the losses.
        let rest = (losses.hysteresis - losses.jumps).abs();
        assert!(
            rest <= losses.smooth * (1.0 + 1e-9) + 1e-9 * losses.changed,
            "{name}, {steps}"
        );
        assert!(
            rest < 0.01 * losses.changed,
            "{name}, {steps}: the loop is not the jumps' sum"
        );
    }
}

/// A step's work is a trapezium, wrong by the cube of its length, over an area that changes with
/// its length: halved steps must lose four times less, here at least three.
fn smooth_paths_lose_nothing() {
    let [coarse, fine] =
        [60, 120].map(|steps| losses(&sphere(0.5, 16.0, &loop_path(-3.0, 0.6, steps))));
    check("sphere, mu 0.5", &coarse, &fine);
    assert_eq!(
        coarse.count_in + coarse.count_off + fine.count_in + fine.count_off,
        0
    );
    assert!(
        fine.smooth < coarse.smooth / 3.0,
        "{:e} {:e}",
        coarse.smooth,
        fine.smooth
    );
}

/// With folds the whole loop is the jump in and the jump off. (The order is asked of the path without
/// folds: next to one the force is a square root of the approach, and what a step seems to lose
/// depends on where the fold falls in it.)
fn a_loop_is_the_sum_of_its_jumps() {
    let [coarse, fine] =
        [100, 200].map(|steps| losses(&sphere(2.0, 8.0, &loop_path(-3.8, -1.8, steps))));
    check("sphere, mu 2", &coarse, &fine);
    for losses in [&coarse, &fine] {
        assert_eq!((losses.count_in, losses.count_off), (1, 1));
        assert!((losses.hysteresis / losses.jumps - 1.0).abs() < 0.01);
    }
}

/// The same on a rough surface, in mean gap: a range so long and an attraction so weak that no
/// asperity snaps, and a taper as wide as the range, for a step that crosses the whole of a narrow
/// one sees its tension vanish within it.
fn rough_loops() {
    for (name, adhesion) in &mut laws(2e-5, 3e-3)[1..] {
        if *name == "tapered" {
            adhesion.push_str("taper = 3e-3");
        }
        let [coarse, fine] = [100, 200].map(|steps| {
            let path = loop_path(3.5 * RMS_HEIGHT, 1.5 * RMS_HEIGHT, steps);
            losses(&solve(&rough(
                64,
                adhesion,
                &format!("control = \"mean-gap\"\npath = {path:?}"),
            )))
        });
        check(name, &coarse, &fine);
        assert!(
            fine.smooth < coarse.smooth / 3.0,
            "{name}: {:e} {:e}",
            coarse.smooth,
            fine.smooth
        );
    }
}

/// Jumps are found in steps that are long against them, and the stated uncertainty of the energy of a loop holds: a force that stays
/// level and then falls within one step may enclose no area with the straight line.
fn long_steps_find_the_jumps_and_say_how_well_the_loss_is_known() {
    // Spheres on whose 128 points the law is resolved.
    let loop_of = |law: &str,
                   [size, radius, modulus, range, start, inmost]: [&str; 6],
                   steps: usize| {
        let solved = solve(&format!(
            "[grid]\npoints = 128\nsize = \"{size}\"\nboundary = \"free\"\n[solid]\ncontact_modulus = \"{modulus}\"\n\
             [[surface]]\nkind = \"sphere\"\nradius = \"{radius}\"\n\
             [adhesion]\nlaw = \"{law}\"\nwork_of_adhesion = \"50 mJ/m^2\"\nrange = \"{range}\"\n\
             [loading]\ncontrol = \"approach\"\nstart = \"{start}\"\n\
             [[loading.ramp]]\nto = \"{inmost}\"\nsteps = {steps}\n[[loading.ramp]]\nto = \"{start}\"\nsteps = {steps}\n"
        ));
        let end = &solved.end;
        let loss = end.hysteresis_energy.expect("a closed path");
        let uncertainty = end.hysteresis_uncertainty.expect("of a law");
        let jumps = [&end.jump_in_steps, &end.jump_off_steps].map(Vec::len);
        println!("{law}, {steps} steps: {loss:.3e} J, known to {uncertainty:.1e}, jumps {jumps:?}");
        assert_eq!(
            jumps,
            [1, 1],
            "{law}, {steps} steps: {:?} {:?}",
            end.jump_in_steps,
            end.jump_off_steps
        );
        (loss, uncertainty)
    };
    // A step that presses far beyond its jump.
    loop_of(
        "maugis-dugdale",
        ["60 um", "100 um", "1 MPa", "250 nm", "-1.6 um", "2.5 um"],
        1,
    );
    // Attraction sets in smoothly at the start of the step that jumps.
    loop_of(
        "maugis-dugdale",
        ["4 um", "2 um", "5 MPa", "60 nm", "-300 nm", "50 nm"],
        7,
    );
    for (law, sphere) in [
        (
            "lennard-jones",
            ["40 um", "50 um", "5 MPa", "80 nm", "-900 nm", "300 nm"],
        ),
        (
            "maugis-dugdale",
            ["60 um", "100 um", "1 MPa", "250 nm", "-1.6 um", "0.6 um"],
        ),
    ] {
        let (truth, of_truth) = loop_of(law, sphere, 40);
        for steps in [2, 3, 5, 8, 12] {
            let (loss, uncertainty) = loop_of(law, sphere, steps);
            assert!(
                (loss - truth).abs() <= uncertainty + of_truth,
                "{law}, {steps} steps"
            );
        }
    }
}

/// A loop that returns to its place but not to its state loses the work done less the growth of the stored energy: for a plastic solid
/// that is the work of plastic flow. A path that does not move is no loop, and an elastic contact loses less than the uncertainty.
fn what_is_stored_at_the_end_of_a_loop_is_not_lost() {
    let loop_of = |solid: &str, path: &[f64]| {
        let text = rough(64, "", &format!("control = \"approach\"\npath = {path:?}"));
        let solved = solve(&text.replace(
            "contact_modulus = 1.0",
            &format!("contact_modulus = 1.0\n{solid}"),
        ));
        let flow = |row: &StepRow| row.column("plastic_energy").unwrap_or(0.0);
        let rows: Vec<&StepRow> = solved.rows().collect();
        let grown = flow(rows[rows.len() - 1]) - flow(rows[0]);
        (
            solved.end.hysteresis_energy,
            solved.end.hysteresis_uncertainty,
            grown,
        )
    };
    let inwards = |share: usize| RMS_HEIGHT * (0.5 + 0.1 * share as f64);
    let path: Vec<f64> = (0..8).chain((0..7).rev()).map(inwards).collect();
    let (lost, uncertainty, grown) = loop_of("hardness = 0.03", &path);
    let (lost, uncertainty) = (lost.expect("a loop"), uncertainty.expect("without rates"));
    println!("lost {lost:.3e}, known to {uncertainty:.1e}, flow {grown:.3e}");
    assert!(grown > 0.0 && uncertainty < 0.1 * grown);
    assert!((lost - grown).abs() <= uncertainty, "{lost:e} {grown:e}");
    let (lost, uncertainty, _) = loop_of("", &path);
    assert!(lost.expect("a loop").abs() <= uncertainty.expect("without rates"));
    assert_eq!(loop_of("", &[inwards(3); 4]).0, None);
}

/// Under a mean gap the work is that of the approach, which presses a layer together: a loop that begins apart and ends stuck loses
/// what its steps do, and not what the gap alone would say.
fn a_loop_of_a_layer_under_a_mean_gap_loses_what_its_steps_do() {
    let path = loop_path(4.0 * RMS_HEIGHT, 2.0 * RMS_HEIGHT, 12);
    let loading = format!("control = \"mean-gap\"\npath = {path:?}");
    let text = rough(64, &laws(4e-3, 6e-3)[1].1, &loading);
    let solid = "contact_modulus = 1.0\npoisson_ratio = 0.3\nthickness = 1.0";
    let solved = solve(&text.replace("contact_modulus = 1.0", solid));
    let rows: Vec<&StepRow> = solved.rows().collect();
    let steps = rows
        .windows(2)
        .filter_map(|pair| dissipation(pair[0], pair[1]));
    let lost: f64 = steps.sum();
    let found = solved.end.hysteresis_energy.expect("a closed path");
    let by_gap = |pair: &[&StepRow]| {
        let gaps = pair[0].mean_gap.zip(pair[1].mean_gap).expect("gaps");
        0.5 * (pair[0].force + pair[1].force) * (gaps.0 - gaps.1)
            + dissipation(pair[0], pair[1]).expect("places")
            - 0.5
                * (pair[0].force + pair[1].force)
                * (pair[1].approach.expect("a place") - pair[0].approach.expect("a place"))
    };
    let narrow: f64 = rows.windows(2).map(by_gap).sum();
    println!("lost {lost:.4e}, found {found:.4e}, by the gap alone {narrow:.4e}");
    assert!(
        lost > 0.0 && (found / lost - 1.0).abs() < 1e-6,
        "{lost:e} {found:e}"
    );
    assert!((narrow / lost - 1.0).abs() > 0.1, "{narrow:e}");
}

/// A loop through a spring is closed by its far end, which the path prescribes: the surfaces return to the tolerance alone.
fn a_loop_through_a_spring_is_closed_by_its_far_end() {
    let scene = |precision: &str| {
        format!(
            "[grid]\npoints = 64\nsize = \"40 um\"\nboundary = \"free\"\n[solid]\ncontact_modulus = \"50 MPa\"\n\
             [[surface]]\nkind = \"sphere\"\nradius = \"50 um\"\n\
             [adhesion]\nlaw = \"maugis-dugdale\"\nwork_of_adhesion = \"50 mJ/m^2\"\nrange = \"200 nm\"\n\
             [loading]\ncontrol = \"approach\"\nspring = \"20 N/m\"\nstart = \"1 um\"\n\
             [[loading.ramp]]\nto = \"-3 um\"\nsteps = 30\n[[loading.ramp]]\nto = \"1 um\"\nsteps = 30\n\
             [solver]\ntolerance = 1e-4\nprecision = \"{precision}\"\n"
        )
    };
    let [double, single] = ["double", "single"].map(|precision| {
        let text = scene(precision);
        let solved = match precision {
            "single" => solve_on(&text, &|| cpu::single(None)),
            _ => solve(&text),
        };
        let loss = solved.end.hysteresis_energy.expect("a closed path");
        let uncertainty = solved.end.hysteresis_uncertainty.expect("of a law");
        println!("{precision}: {loss:.4e} J, known to {uncertainty:.1e}");
        (loss, uncertainty)
    });
    assert!(double.0 > double.1, "the loop loses more than is doubted");
    assert!((single.0 - double.0).abs() <= double.1 + single.1);
}

/// Without adhesion loading and unloading are one curve.
fn no_adhesion_no_loop() {
    let path = loop_path(3.0 * RMS_HEIGHT, 0.5 * RMS_HEIGHT, 12);
    let solved = solve(&rough(
        64,
        "",
        &format!("control = \"mean-gap\"\npath = {path:?}"),
    ));
    let enclosed = solved.end.hysteresis_energy.expect("a closed path");
    let work: f64 = solved
        .steps
        .windows(2)
        .map(|pair| 0.5 * (pair[0].row.force + pair[1].row.force) * 2.5 * RMS_HEIGHT / 12.0)
        .sum();
    // Each force is solved to a residual of 1e-9.
    assert!(enclosed.abs() < 1e-7 * work, "{enclosed:e} of {work:e}");
    assert!(solved.end.jump_in_steps.is_empty() && solved.end.jump_off_steps.is_empty());
}

tests![
    a_solve_only_lowers_the_energy,
    smooth_paths_lose_nothing,
    a_loop_is_the_sum_of_its_jumps,
    rough_loops,
    no_adhesion_no_loop,
    long_steps_find_the_jumps_and_say_how_well_the_loss_is_known,
    what_is_stored_at_the_end_of_a_loop_is_not_lost,
    a_loop_of_a_layer_under_a_mean_gap_loses_what_its_steps_do,
    a_loop_through_a_spring_is_closed_by_its_far_end,
];
