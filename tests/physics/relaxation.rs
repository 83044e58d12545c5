//! A solid that relaxes: creep under a sphere, order in the time step, limits, and adhesion that
//! depends on time.

use tabor::study::{State, StepRow};
use tabor::theory::viscoelastic::Solid;

use crate::bench::{Solved, solve_table};
use crate::controls::{LAWS, adhesion, rough};
use crate::shared::trials::tests;

/// Relaxed modulus, branch modulus; the branch's time is 1.
const RELAXED: f64 = 0.1;
const BRANCH: f64 = 0.9;

fn sphere(adhesion: &str, loading: &str) -> String {
    format!(
        r#"
        [grid]
        points = 64
        size = 2.0
        boundary = "free"
        [solid]
        contact_modulus = {RELAXED}
        [[solid.relaxation]]
        modulus = {BRANCH}
        time = 1.0
        [[surface]]
        kind = "sphere"
        radius = 1.0
        {adhesion}
        [loading]
        {loading}
        [solver]
        tolerance = 1e-8
        "#
    )
}

/// A force that makes a contact of 10 pixels at once and of 21 in the end.
const FORCE: f64 = 0.04;

fn held(duration: f64, steps: usize) -> String {
    format!(
        "control = \"force\"\nstart = {FORCE}\n[[loading.ramp]]\nhold = {duration}\nsteps = {steps}"
    )
}

/// Lee & Radok 1960: under a constant force the approach grows as `(J E_0)^(2/3)`. The pixels make
/// some 5e-4 of the approach (10 pixels across the radius), steps of a twentieth of the branch's
/// time a tenth of that.
fn a_sphere_creeps() {
    let theory = Solid::new(RELAXED, BRANCH, 1.0).expect("a solid");
    let solved = solve_table(&sphere("", &held(3.0, 60)));
    let mut worst: f64 = 0.0;
    for row in solved.rows() {
        let time = row.time.expect("a time");
        let expected = (0.75 * FORCE * theory.creep(time)).powf(2.0 / 3.0);
        let error = row.approach.expect("an approach") / expected - 1.0;
        worst = worst.max(error.abs());
        assert!(error.abs() < 6e-4, "at {time}: {error:e}");
    }
    let last = solved.rows().last().expect("rows");
    assert!((last.time.expect("a time") - 3.0).abs() < 1e-12);
    println!("creep: off by {worst:.1e} at most");
}

/// Halving the step divides the error by four.
fn second_order_in_the_time_step() {
    let approach = |steps: usize| {
        let solved = solve_table(&sphere("", &held(2.0, steps)));
        solved
            .rows()
            .last()
            .and_then(|row| row.approach)
            .expect("an approach")
    };
    let exact = approach(160);
    let errors = [5, 10, 20].map(|steps| (approach(steps) - exact).abs());
    for pair in errors.windows(2) {
        let ratio = pair[0] / pair[1];
        println!("errors {:.2e} {:.2e}: ratio {ratio:.2}", pair[0], pair[1]);
        // The contact grows by whole pixels, which is not smooth in time.
        assert!(ratio > 3.0 && ratio < 5.5, "{errors:?}");
    }
}

/// At once the solid is the sum of its springs, in the end the relaxed one: the same rows as those
/// of elastic solids, for every law and both boundaries.
fn instant_and_relaxed_limits() {
    let elastic = |modulus: f64, text: &str| {
        let (start, rest) = text.split_once("[[solid.relaxation]]").expect("a branch");
        let (_, rest) = rest.split_once("time = 1.0").expect("its time");
        let start = start.replace(
            &format!("contact_modulus = {RELAXED}"),
            &format!("contact_modulus = {modulus}"),
        );
        solve_table(&format!("{start}{rest}"))
    };
    let close = |a: &Solved, b: &Solved, what: &str| {
        let (a, b) = (
            a.rows().last().expect("a row"),
            b.rows().last().expect("a row"),
        );
        for (name, a, b) in [
            ("force", a.force, b.force),
            ("approach", a.approach.unwrap(), b.approach.unwrap()),
            ("energy", a.elastic_energy, b.elastic_energy),
        ] {
            assert!((a - b).abs() <= 1e-6 * b.abs(), "{what}: {name} {a} {b}");
        }
    };
    // The automatic taper goes by the relaxed modulus, the elastic solid's by its own.
    let taper = |law: &str, length: f64| match law {
        "maugis-dugdale" => format!("\ntaper = {length}"),
        _ => String::new(),
    };
    for law in ["", "maugis-dugdale", "exponential", "lennard-jones"] {
        // Long ranges: one equilibrium a load, whatever the way to it.
        let table = match law {
            "" => String::new(),
            law => adhesion(law, 2e-3, 0.1) + &taper(law, 0.05),
        };
        let at_once = sphere(
            &table,
            &format!(
                "control = \"force\"\nstart = {FORCE}\n[[loading.ramp]]\nto = {FORCE}\nsteps = 1\nduration = 0"
            ),
        );
        close(
            &solve_table(&at_once),
            &elastic(RELAXED + BRANCH, &at_once),
            law,
        );
        let late = sphere(&table, &held(1e9, 2));
        close(&solve_table(&late), &elastic(RELAXED, &late), law);
        let cell = |loading: &str| {
            let text = rough(
                &match law {
                    "" => String::new(),
                    law => adhesion(law, 2e-6, 3e-3) + &taper(law, 1e-3),
                },
                loading,
            );
            text.replace(
                "contact_modulus = 1.0",
                &format!("contact_modulus = {RELAXED}\n[[solid.relaxation]]\nmodulus = {BRANCH}\ntime = 1.0"),
            )
        };
        let late = cell(
            "control = \"mean-gap\"\nstart = 0.012\n[[loading.ramp]]\nto = 0.01\nsteps = 1\nduration = 0\n[[loading.ramp]]\nhold = 1e9\nsteps = 2",
        );
        close(&solve_table(&late), &elastic(RELAXED, &late), law);
    }
}

/// Pull-off after a dwell and at a rate: both a longer dwell and a faster pull hold more.
fn dwell_and_rate_raise_pull_off() {
    let pull_off = |law: &str, dwell: f64, duration: f64| {
        let solved = solve_table(&sphere(
            &adhesion(law, 2e-3, 0.03),
            &format!(
                "control = \"approach\"\nstart = 0.02\n[[loading.ramp]]\nhold = {dwell}\nsteps = 8\n[[loading.ramp]]\nto = -0.25\nsteps = 54\nduration = {duration}"
            ),
        ));
        solved.rows().map(|row| -row.force).fold(0.0, f64::max)
    };
    for law in ["maugis-dugdale", "exponential"] {
        let slow = pull_off(law, 4.0, 100.0);
        let fast = pull_off(law, 4.0, 1.0);
        let short = pull_off(law, 0.01, 1.0);
        println!("{law}: slow {slow:.4e}, fast {fast:.4e}, fast after a short dwell {short:.4e}");
        assert!(fast > 1.1 * slow, "{law}: {fast} {slow}");
        assert!(fast > 1.02 * short, "{law}: {fast} {short}");
    }
}

/// A loop costs work, whatever the law; none of it is called a jump.
fn a_loop_dissipates() {
    for law in LAWS {
        let solved = solve_table(&sphere(
            &adhesion(law, 2e-4, 0.05),
            "control = \"approach\"\nstart = -0.02\n[[loading.ramp]]\nto = 0.05\nsteps = 10\nduration = 1\n[[loading.ramp]]\nto = -0.02\nsteps = 10\nduration = 1",
        ));
        let lost = solved.end.hysteresis_energy.expect("a closed path");
        let most = solved
            .rows()
            .map(|row| row.elastic_energy)
            .fold(0.0, f64::max);
        assert!(lost > 0.05 * most, "{law}: {lost} of {most}");
        assert!(solved.end.jump_in_steps.is_empty() && solved.end.jump_off_steps.is_empty());
    }
}

/// Without pressure the surface comes back as the branch's spring relaxes through it: the sphere
/// that touches again after a pause meets the same solid, after none a dented one.
fn a_dent_recovers() {
    let again = |pause: f64| {
        let solved = solve_table(&sphere(
            "",
            &format!(
                "control = \"approach\"\nstart = 0.06\n[[loading.ramp]]\nhold = 5\nsteps = 10\n[[loading.ramp]]\nto = -0.5\nsteps = 1\nduration = 0\n[[loading.ramp]]\nhold = {pause}\nsteps = 10\n[[loading.ramp]]\nto = 0.06\nsteps = 1\nduration = 0"
            ),
        ));
        let rows: Vec<_> = solved.rows().map(|row| row.force).collect();
        (rows[0], rows[rows.len() - 1])
    };
    // The spring recovers with the time of creep, ten times the branch's.
    let (first, after_long) = again(300.0);
    let (_, at_once) = again(1e-3);
    assert!(
        (after_long / first - 1.0).abs() < 1e-4,
        "{after_long} {first}"
    );
    assert!(at_once < 0.6 * first, "{at_once} {first}");
}

/// Under no load the surfaces part, and the springs of the solid still pull at each other: what they store falls to nothing as it recovers.
fn a_solid_without_load_stores_energy_while_it_recovers() {
    let solved = solve_table(&sphere(
        "",
        &format!(
            "control = \"force\"\nstart = {FORCE}\n[[loading.ramp]]\nhold = 1.0\nsteps = 5\n[[loading.ramp]]\nto = 0.0\nsteps = 1\nduration = 0.1\n[[loading.ramp]]\nhold = 300.0\nsteps = 6"
        ),
    ));
    let rows: Vec<&StepRow> = solved.rows().collect();
    let stored: Vec<f64> = rows[5..].iter().map(|row| row.elastic_energy).collect();
    assert!(rows[6..].iter().all(|row| row.state == State::Separated));
    assert!(
        stored.windows(2).all(|pair| pair[1] < pair[0]),
        "{stored:?}"
    );
    assert!(stored[1] > 1e-3 * stored[0], "{stored:?}");
    assert!(
        stored[7] < 1e-3 * stored[0] && stored[7] >= 0.0,
        "{stored:?}"
    );
}

tests![
    a_solid_without_load_stores_energy_while_it_recovers,
    a_sphere_creeps,
    second_order_in_the_time_step,
    instant_and_relaxed_limits,
    dwell_and_rate_raise_pull_off,
    a_loop_dissipates,
    a_dent_recovers,
];
