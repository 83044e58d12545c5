//! `steps = "auto"`: the asked error in time is kept, with fewer steps than equal ones would take.

use tabor::theory::viscoelastic::Solid;

use crate::bench::{Solved, solve_table};
use crate::controls::adhesion;

/// Relaxed modulus, branch modulus; the branch's time is 1, that of creep 10.
const RELAXED: f64 = 0.1;
const BRANCH: f64 = 0.9;
const FORCE: f64 = 0.04;

fn sphere(branches: &str, adhesion: &str, loading: &str) -> Solved {
    solve_table(&format!(
        r#"
        [grid]
        points = 48
        size = 2.0
        boundary = "free"
        [solid]
        contact_modulus = {RELAXED}
        {branches}
        [[surface]]
        kind = "sphere"
        radius = 1.0
        {adhesion}
        [loading]
        {loading}
        [solver]
        tolerance = 1e-8
        "#
    ))
}

fn one_branch() -> String {
    format!("[[solid.relaxation]]\nmodulus = {BRANCH}\ntime = 1.0")
}

/// Lee & Radok 1960: as long as the contact grows, the approach at a time is the elastic one of the
/// modulus `1/J(t)`, which on pixels too is that of the relaxed modulus under a force `E_inf J(t)`
/// times as large. So the pixels err alike on both sides, and what is left is the error in time.
fn error_in_time(solved: &Solved) -> f64 {
    let theory = Solid::new(RELAXED, BRANCH, 1.0).expect("a solid");
    let forces: Vec<String> = solved
        .rows()
        .map(|row| {
            let time = row.time.expect("a time");
            format!("{:e}", FORCE * RELAXED * theory.creep(time))
        })
        .collect();
    let elastic = sphere(
        "",
        "",
        &format!("control = \"force\"\npath = [{}]", forces.join(", ")),
    );
    let approaches = |solved: &Solved| -> Vec<f64> {
        let rows = solved.rows();
        rows.map(|row| row.approach.expect("an approach")).collect()
    };
    let (found, expected) = (approaches(solved), approaches(&elastic));
    let greatest = expected.iter().copied().fold(0.0, f64::max);
    let pairs = found.iter().zip(&expected);
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / greatest
}

/// A force held for a while, with keys of `[loading]` and the steps.
fn held(keys: &str, steps: &str) -> Solved {
    sphere(
        &one_branch(),
        "",
        &format!(
            "control = \"force\"\nstart = {FORCE}\n{keys}\n[[loading.ramp]]\nhold = 40\nsteps = {steps}"
        ),
    )
}

#[test]
fn creep_keeps_the_asked_error_with_fewer_steps() {
    for tolerance in [1e-2, 1e-3] {
        let auto = held(&format!("time_tolerance = {tolerance}"), "\"auto\"");
        let steps = auto.rows().count() - 1;
        let error = error_in_time(&auto);
        // A fifth more equal steps than that still err more.
        let more = steps * 6 / 5;
        let equal = error_in_time(&held("", &more.to_string()));
        println!(
            "asked {tolerance}: {error:.2e} in {steps} steps, {equal:.2e} in {more} equal ones"
        );
        assert!(error < tolerance, "{tolerance}: {error:e}");
        assert!(error < equal, "{tolerance}: {error:e} {equal:e}");
    }
}

/// Two branches, pressed within 2, held for 10, drawn back within 3: at the times that all paths
/// share, against equal steps that are several times as short as the shortest would have to be.
#[test]
fn ramps_keep_the_asked_error() {
    let two = format!(
        "[[solid.relaxation]]\nmodulus = 0.3\ntime = 0.1\n{}",
        one_branch()
    );
    let run = |law: &str, control: &str, values: [f64; 3], steps: [&str; 3], keys: &str| {
        let [start, up, down] = values;
        let [pressed, held, drawn] = steps;
        let solved = sphere(
            &two,
            law,
            &format!(
                "control = \"{control}\"\nstart = {start}\n{keys}\n[[loading.ramp]]\nto = {up}\nduration = 2\nsteps = {pressed}\n[[loading.ramp]]\nhold = 10\nsteps = {held}\n[[loading.ramp]]\nto = {down}\nduration = 3\nsteps = {drawn}"
            ),
        );
        let shared = |time: f64| {
            [2.0, 12.0, 13.5, 15.0]
                .iter()
                .any(|t| (time - t).abs() < 1e-9)
        };
        let values: Vec<f64> = solved
            .rows()
            .filter(|row| shared(row.time.expect("a time")))
            .map(|row| match control {
                "force" => row.approach.expect("an approach"),
                _ => row.force,
            })
            .collect();
        assert_eq!(values.len(), 4, "{control}");
        (solved.rows().count(), values)
    };
    let attracts = adhesion("exponential", 2e-3, 0.1);
    for (law, control, values) in [
        ("", "force", [1e-4, 0.04, 0.01]),
        ("", "approach", [1e-3, 0.15, 0.14]),
        (attracts.as_str(), "approach", [-0.1, 0.1, 0.02]),
    ] {
        let (_, fine) = run(law, control, values, ["256", "512", "256"], "");
        let greatest = fine
            .iter()
            .fold(0.0, |most: f64, value| most.max(value.abs()));
        for tolerance in [1e-2, 1e-3] {
            let keys = format!("time_tolerance = {tolerance}");
            let (steps, found) = run(law, control, values, ["\"auto\""; 3], &keys);
            let errors = found.iter().zip(&fine).map(|(a, b)| (a - b).abs());
            let error = errors.fold(0.0, f64::max) / greatest;
            println!("{control} {law:.20}, asked {tolerance}: {error:.2e} in {steps} steps");
            assert!(error < tolerance, "{control} {law}: {error:e}");
        }
    }
}
