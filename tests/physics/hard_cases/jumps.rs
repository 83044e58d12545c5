//! Jump-in and jump-off, both ways and repeated.

use std::f64::consts::PI;

use super::case::{Case, Contact, Law};
use super::paths::Path;
use super::run::Run;
use super::spheres::{self, SPHERE};

/// Steps each way of a loop.
const STEPS: usize = 24;
const LOOPS: usize = 2;

/// Loops between two places in equal steps.
fn loops(from: f64, to: f64) -> Vec<f64> {
    let mut path = vec![from];
    for _ in 0..LOOPS {
        path.extend((1..=2 * STEPS).map(|i| {
            let there = i.min(2 * STEPS - i) as f64 / STEPS as f64;
            from + (to - from) * there
        }));
    }
    path
}

/// Every loop is the first one again: it begins from surfaces that have forgotten.
fn repeats(run: &Run, path: &Path, force: f64) {
    let turn = 2 * STEPS;
    for i in 1..=turn {
        let (first, again) = (&run.rows[i], &run.rows[i + turn]);
        let off = (first.force - again.force).abs();
        assert!(
            off <= 100.0 * path.tolerance * force,
            "step {}: {} {}",
            i + 1,
            first.force,
            again.force
        );
        assert_eq!(first.state, again.state);
    }
    for name in ["jump_in_steps", "jump_off_steps"] {
        let steps = run.steps(name);
        let (first, again) = steps.split_at(steps.len() / LOOPS);
        assert!(!first.is_empty(), "{name}: {steps:?}");
        let moved: Vec<usize> = first.iter().map(|step| step + turn).collect();
        assert_eq!(moved, again, "{name}");
    }
}

/// At lambda 2 the surfaces snap together at an approach of -h0 and part at the fold of the closed form.
fn sphere() -> Case {
    let contact = spheres::window(32, 2.0, 0.0);
    let pixel = contact.pixel()[0];
    let range = 1.0 / PI;
    let taper = (6.0 * spheres::WORK / range * pixel / spheres::MODULUS).min(2.0 * range);
    let (fold, step) = (-0.938_636_589_498_f64, 0.1);
    let path = loops(-1.6, 0.8);
    let places = path.clone();
    Case::new("sphere, two loops through both jumps", contact, SPHERE)
        .under("approach", path)
        .last_step_only()
        .so_that(move |run, path| {
            repeats(run, path, 2.0);
            let [inwards, off] = ["jump_in_steps", "jump_off_steps"].map(|name| {
                let steps = run.steps(name);
                assert_eq!(steps.len(), LOOPS, "{name}");
                places[steps[0] - 1]
            });
            // The taper brings the snap half its width earlier.
            assert!(
                inwards > -range - 0.5 * taper - step && inwards < -range + step,
                "{inwards}"
            );
            assert!(
                (off - fold).abs() < step + 0.05 * fold.abs(),
                "{off}, not {fold}"
            );
        })
}

fn rough() -> Case {
    let surface = "[[surface]]\nkind = \"self-affine\"\nhurst = 0.8\nrms_height = 0.01\nlongest = 1.0\n\
                   rolloff = 0.5\nshortest = 0.125\nseed = 5\n";
    let law = Law::MaugisDugdale {
        work: 1e-3,
        range: 6e-3,
        // The automatic one, twice the range on so few points, leaves no jump to repeat.
        taper: Some(1.04e-2),
    };
    Case::new(
        "rough, two loops through both jumps",
        Contact::cell(32, law),
        surface,
    )
    .under("mean-gap", loops(0.045, 0.005))
    .last_step_only()
    .so_that(|run, path| {
        let force = run
            .rows
            .iter()
            .map(|row| row.force.abs())
            .fold(0.0, f64::max);
        repeats(run, path, force);
    })
}

/// Torn off and pressed again, three times.
fn torn() -> Case {
    let contact = spheres::window(32, 1.0, 0.2);
    Case::new("sphere, torn off and pressed three times", contact, SPHERE)
        .under("force", [0.2, -3.0, 0.2, -3.0, 0.2, -3.0, 0.2])
        .so_that(|run, _| {
            assert_eq!(run.steps("jump_off_steps"), [2, 4, 6]);
            assert_eq!(run.steps("jump_in_steps"), [3, 5, 7]);
            for i in [2, 4, 6] {
                assert_eq!(run.rows[i].contact, run.rows[0].contact);
            }
        })
}

pub fn cases() -> Vec<Case> {
    vec![sphere(), rough(), torn()]
}
