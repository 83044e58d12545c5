//! An edge that costs more the faster it recedes.
//!
//! Units of Maugis: K = 4E*/3 = 1, R = 1, w = 1/pi, so that forces are in pi w R and lengths in his; with
//! v* = 1 a speed of approach is in v* delta*/a*.

use std::f64::consts::PI;

use tabor::study::{State, StepRow};
use tabor::theory::maugis_dugdale::MaugisDugdale;
use tabor::theory::rate::reduced_pull_off;

use crate::bench::{Solved, solve_table};
use crate::shared::trials::tests;

const LAMBDA: f64 = 2.0;
const EXPONENT: f64 = 0.5;
const SIDE: f64 = 4.4;
const POINTS: usize = 72;

/// A sphere at JKR's zero load is drawn off at a speed, in `steps` of equal length. Its axis is off the
/// pixels' symmetry, so that they let go one or two at a time and not eight.
fn drawn_off(speed: f64, to: f64, steps: usize) -> Solved {
    let from = 1.1;
    solve_table(&format!(
        "[grid]\npoints = {POINTS}\nsize = {SIDE}\nboundary = \"free\"\n[solid]\ncontact_modulus = 0.75\n[[surface]]\nkind = \"sphere\"\nradius = 1.0\ncentre = [2.213, 2.187]\n[adhesion]\nlaw = \"maugis-dugdale\"\npeak_tension = {}\nrange = {}\nrate = {{ reference_speed = 1.0, exponent = {EXPONENT} }}\n[loading]\ncontrol = \"approach\"\nstart = {from}\n[[loading.ramp]]\nto = {to}\nsteps = {steps}\nduration = {}\n[solver]\ntolerance = 1e-5\n",
        0.5 * LAMBDA,
        2.0 / (PI * LAMBDA),
        (from - to) / speed,
    ))
}

/// Pull-off at a speed against the motion of JKR's edge, `dA/dt = -v* (G/w - 1)^(1/n)`, integrated apart
/// (`theory::rate`). JKR's own pull-off is 1.5, Maugis' at this lambda 1.535 (2.3 % more, and less as the
/// raised law draws nearer to JKR's); steps of the path are implicit Euler's, 2 % at these.
fn pull_off_at_a_speed() {
    let still = MaugisDugdale::new(LAMBDA).and_then(|sphere| sphere.pull_off());
    let still = -still.expect("a pull-off").force;
    for (speed, to, steps) in [(0.1, -0.75, 25), (1.0, -1.5, 26)] {
        let solved = drawn_off(speed, to, steps);
        let found = solved.rows().map(|row| -row.force).fold(0.0, f64::max);
        let expected = reduced_pull_off(speed, EXPONENT).expect("a pull-off");
        println!("speed {speed}: {found:.4}, JKR {expected:.4}, at rest {still:.4}");
        assert!((found / expected - 1.0).abs() < 0.05, "{found} {expected}");
        assert!(found > 1.1 * still);
        assert!(solved.end.jump_off_steps.is_empty(), "loss is no jump");
        // Each step by itself: the force at its approach is that of Maugis' sphere whose law is raised as
        // the speed of its own edge says. Raised by f, that law has lambda f^(2/3), and his scales of
        // radius, approach and force are f^(1/3), f^(2/3) and f times theirs.
        let mut compared = 0;
        // Up to pull-off: towards the fold beyond it any error of approach changes the state at will.
        let until = solved
            .rows()
            .position(|row| -row.force == found)
            .expect("a pull-off");
        for pair in solved.steps[..=until].windows(2) {
            let (before, now) = (&pair[0].row, &pair[1].row);
            let radius = |row: &StepRow| (row.contact_area_fraction * SIDE * SIDE / PI).sqrt();
            let passed = now.time.expect("a time") - before.time.expect("a time");
            let receding = (radius(before) - radius(now)) / passed;
            let raised = 1.0 + receding.max(0.0).powf(EXPONENT);
            // Down to ten pixels of radius, whose steps still say how fast the edge is. What is
            // left is the pixels: raised 1.8 times, a pixel is as wide as the cohesive zone.
            if radius(now) < 0.6 || radius(before) - radius(now) < 0.02 {
                continue;
            }
            let approach = now.approach.expect("held") / raised.powf(2.0 / 3.0);
            let states = MaugisDugdale::new(LAMBDA * raised.powf(2.0 / 3.0))
                .and_then(|sphere| sphere.states_at_approach(approach))
                .expect("states");
            let widest = states
                .iter()
                .max_by(|a, b| a.contact_radius.total_cmp(&b.contact_radius))
                .expect("a contact");
            let (expected, wide) = (widest.force * raised, widest.contact_radius * raised.cbrt());
            println!(
                "  v {receding:.4}: force {:.4} {expected:.4}, radius {:.3} {wide:.3}",
                now.force,
                radius(now)
            );
            compared += 1;
            assert!(
                (now.force - expected).abs() < 0.03 * found,
                "{} {expected}",
                now.force
            );
            assert!((radius(now) - wide).abs() < SIDE / POINTS as f64, "{wide}");
        }
        assert!(compared > 5, "{compared}");
    }
}

/// Under a load that grows an edge peels on beyond the last equilibrium of the law that its speed has raised, since it toughens as it
/// speeds up. Pull-off against implicit Euler's steps of JKR's moving edge, `dA/dt = -(G/w - 1)^(1/n)` with
/// `G/w = (A^3 - F)^2/(6 A^3)` (Maugis & Barquins 1978), of the same lengths; the edge itself carries 3.8. Without such states the sphere
/// let go at 3.1.
fn a_growing_load_peels_on() {
    const MOST: f64 = 6.0;
    const DURATION: f64 = 1.9;
    const STEPS: usize = 20;
    // A step of the edge from a radius; `None` where nothing carries the load at its end.
    let step = |from: f64, force: f64, duration: f64| {
        let radii = (1..20_000).map(|part| from * (1.0 - f64::from(part) / 20_000.0));
        radii.into_iter().find(|radius| {
            let cube = radius.powi(3);
            let excess = ((cube + force).powi(2) / (6.0 * cube) - 1.0).max(0.0);
            from - radius >= duration * excess.powf(1.0 / EXPONENT)
        })
    };
    let (mut radius, mut held) = (6.0_f64.cbrt(), 0.0);
    for at in 1..=STEPS {
        let force = MOST * at as f64 / STEPS as f64;
        let Some(next) = step(radius, force, DURATION / STEPS as f64) else {
            break;
        };
        (radius, held) = (next, force);
    }
    let mut parted = held + MOST / STEPS as f64;
    while parted - held > 0.05 * parted {
        let middle = 0.5 * (held + parted);
        match step(radius, middle, (middle - held) / MOST * DURATION) {
            Some(next) => (radius, held) = (next, middle),
            None => parted = middle,
        }
    }
    let solved = solve_table(&format!(
        "[grid]\npoints = 48\nsize = {SIDE}\nboundary = \"free\"\n[solid]\ncontact_modulus = 0.75\n[[surface]]\nkind = \"sphere\"\nradius = 1.0\n[adhesion]\nlaw = \"maugis-dugdale\"\npeak_tension = {}\nrange = {}\nrate = {{ reference_speed = 1.0, exponent = {EXPONENT} }}\n[loading]\ncontrol = \"force\"\nstart = 0.0\npull_off_tolerance = 0.05\n[[loading.ramp]]\nto = -{MOST}\nsteps = {STEPS}\nduration = {DURATION}\n[solver]\ntolerance = 1e-4\n",
        0.5 * LAMBDA,
        2.0 / (PI * LAMBDA),
    ));
    let found = solved.end.pull_off.expect("it lets go");
    println!(
        "{:.3} to {:.3}, JKR's edge {held:.3} to {parted:.3}",
        found.lower, found.upper
    );
    // The brackets are 5 % wide, and Maugis' law carries 2 % more at rest.
    assert!((found.lower / held - 1.0).abs() < 0.07, "{found:?} {held}");
    for row in solved.rows() {
        assert!(row.converged, "step {}: {:e}", row.step, row.residual);
    }
}

/// An edge that advances has the plain law, to the bit.
fn an_advancing_edge_has_the_plain_law() {
    let pressed = |rate: &str| {
        solve_table(&format!(
            "[grid]\npoints = 32\nsize = {SIDE}\nboundary = \"free\"\n[solid]\ncontact_modulus = 0.75\n[[surface]]\nkind = \"sphere\"\nradius = 1.0\n[adhesion]\nlaw = \"exponential\"\nwork_of_adhesion = 0.3\nrange = 0.3\n{rate}[loading]\ncontrol = \"approach\"\nstart = 0.1\n[[loading.ramp]]\nto = 0.9\nsteps = 4\nduration = 1\n"
        ))
    };
    let plain = pressed("");
    let rated = pressed("rate = { reference_speed = 1e-3, exponent = 0.3 }\n");
    for (a, b) in plain.rows().zip(rated.rows()) {
        assert_eq!((a.force, a.adhesive_energy), (b.force, b.adhesive_energy));
    }
}

/// A closed cell that lets go everywhere at once has no edge that could recede: the plain law.
fn full_contact_that_lets_go_at_once_has_no_edge() {
    let curve = |rate: &str| {
        solve_table(&format!(
            "[grid]\npoints = 8\nsize = 1.0\n[solid]\ncontact_modulus = 1.0\n[[surface]]\nkind = \"flat\"\n[adhesion]\nlaw = \"exponential\"\nwork_of_adhesion = 0.01\nrange = 0.1\n{rate}[loading]\ncontrol = \"mean-gap\"\nstart = 0.0\n[[loading.ramp]]\nto = 0.1\nsteps = 1\nduration = 1\n"
        ))
    };
    let plain = curve("");
    let rated = curve("rate = { reference_speed = 1.0, exponent = 0.5 }\n");
    for (rated, plain) in rated.rows().zip(plain.rows()) {
        assert_eq!((rated.force, rated.approach), (plain.force, plain.approach));
        assert!(rated.converged);
    }
}

/// A contact of a few pixels, parted at many times v*: the bracket of its factor is wide, and is narrowed all the same.
fn a_fast_edge_of_few_pixels_converges() {
    let solved = solve_table(
        r#"
        [grid]
        points = [32, 1]
        size = [4.716345760686151e-08, 2.3581728803430757e-08]
        boundary = "free"
        [solid]
        contact_modulus = 4087676.0462057926
        [[surface]]
        kind = "sphere"
        radius = 1.1876017963905377e-07
        [adhesion]
        law = "exponential"
        work_of_adhesion = 7.195435592772976e-05
        range = 5.851553270231713e-09
        rate = { reference_speed = 2.291370099337138e-08, exponent = 1.0 }
        [loading]
        control = "force"
        start = 5.195524031085084e-13
        [[loading.ramp]]
        to = -1.1099782013544263e-11
        steps = 4
        duration = 0.59627290691978
        [[loading.ramp]]
        to = -1.088951250613563e-11
        steps = 1
        duration = 0.004083142568559649
        [[loading.ramp]]
        hold = 7.288835397670586
        steps = 2
        [[loading.ramp]]
        to = 0.0
        steps = 4
        duration = 0.0011428692608228704
        "#,
    );
    assert_eq!(solved.rows().count(), 12);
    for row in solved.rows() {
        assert!(row.converged, "step {}: {:e}", row.step, row.residual);
    }
}

/// Edges so slow that they have the plain law: a soft solid comes through its jumps as without a rate, where a solve stalls and goes on from where
/// each point has moved by itself.
fn a_stalled_solve_goes_on_as_without_a_rate() {
    let states = ["", "rate = { reference_speed = \"1000 m/s\", exponent = 1.0 }"].map(|rate| {
        let solved = solve_table(&format!(
            "[grid]\npoints = 48\nsize = \"20 um\"\n[solid]\ncontact_modulus = \"1 MPa\"\n[[surface]]\nkind = \"self-affine\"\nhurst = 0.8\nrms_height = \"50 nm\"\nlongest = \"20 um\"\nrolloff = \"10 um\"\nshortest = \"2.5 um\"\nseed = 2\n[adhesion]\nlaw = \"maugis-dugdale\"\nwork_of_adhesion = \"50 mJ/m^2\"\nrange = \"300 nm\"\n{rate}\n[loading]\ncontrol = \"mean-gap\"\nstart = \"1 nm\"\nuntil = \"apart\"\n[[loading.ramp]]\nto = \"1.5 nm\"\nsteps = 1\nduration = \"1 s\"\n"
        ));
        let last = solved.steps.last().expect("rows");
        (solved.steps.len(), last.row.state)
    });
    assert_eq!(states[0].1, State::Separated);
    assert_eq!(states[0], states[1]);
}

tests![
    a_stalled_solve_goes_on_as_without_a_rate,
    full_contact_that_lets_go_at_once_has_no_edge,
    a_fast_edge_of_few_pixels_converges,
    pull_off_at_a_speed,
    a_growing_load_peels_on,
    an_advancing_edge_has_the_plain_law,
];
