//! `steps = "auto"`: the asked error in time is kept, with fewer steps than equal ones would take.

use tabor::theory::viscoelastic::Solid;

use crate::bench::{Solved, solve_table};
use crate::controls::adhesion;
use crate::shared::trials::tests;

/// Relaxed modulus, branch modulus; the branch's time is 1, that of creep 10.
const RELAXED: f64 = 0.1;
const BRANCH: f64 = 0.9;
const FORCE: f64 = 0.04;

fn sphere(branches: &str, adhesion: &str, loading: &str) -> Solved {
    solve_table(&format!(
        r#"
        [grid]
        points = 32
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

/// An egg box on a periodic grid, whose mean gap is its amplitude where it first touches.
fn waves(branches: &str, loading: &str) -> Solved {
    solve_table(&format!(
        r#"
        [grid]
        points = 32
        size = 1.0
        [solid]
        contact_modulus = {RELAXED}
        {branches}
        [[surface]]
        kind = "wavy"
        amplitude = 0.02
        wavelength = [1.0, 1.0]
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

/// Two branches, pressed within 2, held for 10, drawn back within 3; `around` makes a scene of
/// the branches and `[loading]`, of which `keys` are the first. With how many steps, and what answers the
/// path at the times that all such paths share.
fn pressed_held_and_drawn(
    around: &dyn Fn(&str, &str) -> Solved,
    keys: &str,
    values: [f64; 3],
    steps: [&str; 3],
) -> (usize, Vec<f64>) {
    let two = format!(
        "[[solid.relaxation]]\nmodulus = 0.3\ntime = 0.1\n{}",
        one_branch()
    );
    let [start, up, down] = values;
    let [pressed, held, drawn] = steps;
    let solved = around(
        &two,
        &format!(
            "{keys}\nstart = {start}\n[[loading.ramp]]\nto = {up}\nduration = 2\nsteps = {pressed}\n[[loading.ramp]]\nhold = 10\nsteps = {held}\n[[loading.ramp]]\nto = {down}\nduration = 3\nsteps = {drawn}"
        ),
    );
    let shared = |time: f64| {
        [2.0, 12.0, 13.5, 15.0]
            .iter()
            .any(|t| (time - t).abs() < 1e-9)
    };
    let is_load = keys.contains("force") || keys.contains("pressure");
    let values: Vec<f64> = solved
        .rows()
        .filter(|row| shared(row.time.expect("a time")))
        .map(|row| match is_load {
            true => row.approach.expect("an approach"),
            false => row.force,
        })
        .collect();
    assert_eq!(values.len(), 4, "{keys}");
    (solved.rows().count(), values)
}

/// Every control, and a spring, at the times that all paths share, against equal steps that are
/// several times as short as the shortest would have to be.
fn ramps_keep_the_asked_error() {
    let attracts = adhesion("exponential", 2e-3, 0.1);
    let alone = |branches: &str, loading: &str| sphere(branches, "", loading);
    let sticky = |branches: &str, loading: &str| sphere(branches, &attracts, loading);
    type Around<'a> = &'a dyn Fn(&str, &str) -> Solved;
    let cases: [(&str, Around, &str, [f64; 3]); 6] = [
        ("force", &alone, "force", [1e-4, 0.04, 0.01]),
        ("approach", &alone, "approach", [1e-3, 0.15, 0.14]),
        ("attraction", &sticky, "approach", [-0.1, 0.1, 0.02]),
        // As stiff as the relaxed sphere at this approach, `2 E sqrt(R d)`.
        (
            "spring",
            &alone,
            "approach\"\nspring = \"0.08 N/m",
            [1e-3, 0.3, 0.2],
        ),
        ("pressure", &waves, "pressure", [1e-4, 4e-3, 1e-3]),
        ("mean gap", &waves, "mean-gap", [0.019, 0.008, 0.012]),
    ];
    for (name, around, control, values) in cases {
        let control = format!("control = \"{control}\"");
        let (_, fine) = pressed_held_and_drawn(around, &control, values, ["256", "512", "256"]);
        let greatest = fine
            .iter()
            .fold(0.0, |most: f64, value| most.max(value.abs()));
        for tolerance in [1e-2, 1e-3] {
            let keys = format!("{control}\ntime_tolerance = {tolerance}");
            let (steps, found) = pressed_held_and_drawn(around, &keys, values, ["\"auto\""; 3]);
            let errors = found.iter().zip(&fine).map(|(a, b)| (a - b).abs());
            let error = errors.fold(0.0, f64::max) / greatest;
            println!("{name}, asked {tolerance}: {error:.2e} in {steps} steps");
            assert!(error < tolerance, "{name}: {error:e}");
        }
    }
}

/// A spring neither holds a position nor a load: the contact answers in times between those of relaxation, 0.1 s, and of creep, 100 s. Over a
/// fast ramp and a long hold the steps found are as good as they should be, beside equal ones.
fn a_spring_has_its_own_times() {
    let scene = |tolerance: &str, ramp: &str, hold: &str| {
        solve_table(&format!(
            r#"
            [grid]
            points = 32
            size = 1.5e-6
            boundary = "free"
            [solid]
            contact_modulus = 1e5
            [[solid.relaxation]]
            modulus = 1e8
            time = 0.1
            [[surface]]
            kind = "sphere"
            radius = 2e-6
            [loading]
            control = "approach"
            spring = 50.0
            {tolerance}
            start = 0.0
            [[loading.ramp]]
            to = 8e-8
            duration = 0.01
            steps = {ramp}
            [[loading.ramp]]
            hold = 1.0
            steps = {hold}
            "#
        ))
    };
    let (found, fine) = (
        scene("time_tolerance = 1e-2", "\"auto\"", "\"auto\""),
        scene("", "16", "512"),
    );
    let at = |solved: &Solved| -> Vec<[f64; 2]> {
        solved
            .rows()
            .filter_map(|row| Some([row.time?, row.force]))
            .collect()
    };
    let (found, fine) = (at(&found), at(&fine));
    let greatest = fine
        .iter()
        .fold(0.0, |most: f64, [_, force]| most.max(*force));
    let mut compared = 0;
    for [time, force] in &found {
        let same = fine.iter().find(|[other, _]| (other - time).abs() < 1e-9);
        let Some([_, expected]) = same.filter(|_| *time > 0.01) else {
            continue;
        };
        let error = (force - expected).abs() / greatest;
        assert!(error < 1e-2, "at {time} s: {force:e} {expected:e}");
        compared += 1;
    }
    println!(
        "{} steps for {}, {compared} times compared",
        found.len(),
        fine.len()
    );
    assert!(compared > 10, "{compared}");
}

tests![
    a_spring_has_its_own_times,
    creep_keeps_the_asked_error_with_fewer_steps,
    ramps_keep_the_asked_error,
];
