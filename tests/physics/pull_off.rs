//! The tension at which a contact lets go of a prescribed load, narrowed down between two steps.

use std::f64::consts::PI;

use tabor::study::{PullOff, StepRow, Tension};
use tabor::theory::maugis_dugdale::MaugisDugdale;

use crate::bench::{Solved, solve_table};
use crate::shared::trials::tests;

/// A sphere in the units of Maugis (K = 4E*/3 = 1, R = 1, w = 1/pi), lambda 0.5, forces in pi w R. The taper
/// is a length, 2 sigma0 dx/E*, so that the law is this one whatever its default.
fn sphere(solid: &str, adhesion: &str, loading: &str) -> Solved {
    sphere_on(96, solid, adhesion, loading)
}

fn sphere_on(points: usize, solid: &str, adhesion: &str, loading: &str) -> Solved {
    solve_table(&format!(
        "[grid]\npoints = {points}\nsize = 5.0\nboundary = \"free\"\n[solid]\ncontact_modulus = 0.75\n{solid}\n[[surface]]\nkind = \"sphere\"\nradius = 1.0\n[adhesion]\nlaw = \"maugis-dugdale\"\npeak_tension = 0.25\nrange = {}\ntaper = 0.0347\n{adhesion}\n[loading]\n{loading}\n",
        4.0 / PI
    ))
}

fn found(solved: &Solved) -> PullOff {
    match Tension::at_end(&solved.setup.scene.loading, &solved.end) {
        Tension::LetGo(found) => found,
        other => panic!("{other:?}"),
    }
}

/// Rows but for their seconds, bit by bit.
fn bits(solved: &Solved) -> Vec<String> {
    let plain = |row: &StepRow| {
        let mut row = row.clone();
        row.seconds = 0.0;
        format!("{row:?}")
    };
    solved.rows().map(plain).collect()
}

/// The bounds are as near to each other as was asked, and hem in Maugis' closed form but for the grid's error:
/// 2.5e-3 of 2 pi w R at this lambda on 256 points, and in proportion to the pixel here.
fn bounds_hem_in_the_closed_form() {
    let exact = MaugisDugdale::new(0.5).and_then(|sphere| sphere.pull_off());
    let exact = -exact.expect("a pull-off").force;
    let allowed = 2.0 * 2.5e-3 * 256.0 / 96.0;
    let mut bounds = [0.0_f64, f64::INFINITY];
    // From compression and from tension, in one step and in several.
    for (tolerance, path, last) in [
        (1e-2, "[0.5, 0.0, -3.0]", 2),
        (1e-2, "[0.5, -20.0]", 1),
        (1e-4, "[0.5, -0.8, -1.2, -2.4]", 3),
        (0.1, "[0.5, -1.0, -2.4, -2.5, 0.5]", 2),
    ] {
        let solved = sphere(
            "",
            "",
            &format!("control = \"force\"\npath = {path}\npull_off_tolerance = {tolerance}"),
        );
        let PullOff { step, lower, upper } = found(&solved);
        println!("{path} to {tolerance}: {lower:.5} to {upper:.5}, exact {exact:.5}");
        assert_eq!(step, last, "{path}");
        assert!(
            lower < upper && upper - lower <= tolerance * upper,
            "{path}"
        );
        assert!(
            lower <= exact + allowed && upper >= exact - allowed,
            "{path}: {lower} {upper} {exact}"
        );
        bounds = [bounds[0].max(lower), bounds[1].min(upper)];
    }
    // However it is reached, one load is the greatest.
    assert!(bounds[0] < bounds[1], "{bounds:?}");
    // Nothing is narrowed down where that is not asked: the steps themselves are the bounds.
    let solved = sphere(
        "",
        "",
        "control = \"force\"\npath = [0.5, -1.0, -2.5]\npull_off_tolerance = 0",
    );
    let expected = PullOff {
        step: 2,
        lower: 1.0,
        upper: 2.5,
    };
    assert_eq!(found(&solved), expected);
}

/// What lies between two steps leaves no trace in them: rows are the same bits with and without, whatever the
/// solid remembers and the law depends on.
fn rows_stay_as_they_are() {
    let relaxing = "[[solid.relaxation]]\nmodulus = 2.0\ntime = 1.0";
    let rate = "rate = { reference_speed = 1.0, exponent = 0.5 }";
    let timed = "control = \"force\"\nstart = 0.5\n[[loading.ramp]]\nto = -1.2\nsteps = 3\nduration = 2\n[[loading.ramp]]\nto = -12.0\nsteps = 3\nduration = 1\n[[loading.ramp]]\nto = 0.7\nsteps = 2\nduration = 3";
    let plain = "control = \"force\"\npath = [0.5, -0.8, -3.0, -4.0, 0.5, 0.0]";
    for (name, solid, adhesion, loading) in [
        ("elastic", "", "", plain),
        ("hard", "hardness = 1.5", "", plain),
        ("summed afterwards", "", "treatment = \"dmt\"", plain),
        ("relaxing", relaxing, "", timed),
        ("receding at a rate", "", rate, timed),
    ] {
        let [with, without] = [0.01, 0.0].map(|tolerance| {
            let (control, rest) = loading.split_once('\n').expect("two lines");
            let loading = format!("{control}\npull_off_tolerance = {tolerance}\n{rest}");
            // Bits ask for no fine grid.
            sphere_on(48, solid, adhesion, &loading)
        });
        assert_eq!(bits(&with), bits(&without), "{name}");
        assert_eq!(with.end.jump_off_steps, without.end.jump_off_steps);
        let (near, far) = (found(&with), found(&without));
        println!("{name}: {near:?} in {far:?}");
        assert_eq!(near.step, far.step, "{name}");
        assert!(near.lower >= far.lower && near.upper <= far.upper, "{name}");
        assert!(near.upper - near.lower <= 0.01 * near.upper, "{name}");
        assert!(far.upper - far.lower > 0.01 * far.upper, "{name}");
        assert!(with.end.transforms > without.end.transforms, "{name}");
    }
}

/// Half way in load is half way in time: what is found between two steps of a solid that relaxes is what a
/// path of sixteen times as many steps finds between two of its own. That path's steps are short against the
/// relaxation; those of the first are not, and the loads tried meet the solid in ever shorter ones: what
/// implicit steps of a third of the time of relaxation are off by, some per cent of the pull-off.
fn time_goes_with_the_load() {
    let relaxing = "[[solid.relaxation]]\nmodulus = 2.0\ntime = 1.0";
    let pulled = |steps: usize| {
        let loading = format!(
            "control = \"force\"\nstart = 0.5\n[[loading.ramp]]\nhold = 10\nsteps = 4\n[[loading.ramp]]\nto = -6.0\nsteps = {steps}\nduration = 2"
        );
        found(&sphere(relaxing, "", &loading))
    };
    let (coarse, fine) = (pulled(6), pulled(96));
    let still = found(&sphere("", "", "control = \"force\"\npath = [0.5, -6.0]"));
    println!("{coarse:?}, {fine:?}, at rest {still:?}");
    assert!((coarse.lower / fine.lower - 1.0).abs() < 0.05);
    // Had the loads tried no time the solid would be stiff, had they all of it, soft.
    assert!(fine.lower > 1.05 * still.upper);
}

/// Without letting go there is no pull-off under a load; a held position shows it once it is passed.
fn what_still_holds_is_no_pull_off() {
    let says = |loading: &str| {
        let solved = sphere("", "", loading);
        Tension::at_end(&solved.setup.scene.loading, &solved.end)
    };
    let ends = says("control = \"force\"\npath = [0.5, -0.5, -1.0]");
    assert_eq!(
        ends,
        Tension::Holds {
            step: 3,
            force: 1.0
        }
    );
    assert_eq!(
        (ends.pull_off(), ends.step(), ends.bounds()),
        (None, None, None)
    );
    // Nor by a path that turns before it.
    let turned = says("control = \"force\"\npath = [0.5, -1.0, 0.5]");
    assert_eq!(turned.pull_off(), None);
    assert_eq!(
        says("control = \"force\"\npath = [0.5, 0.2]"),
        Tension::None
    );
    let places = [0.5, 0.0, -0.5, -0.7, -0.9];
    let rising = says(&format!(
        "control = \"approach\"\npath = {:?}",
        &places[..3]
    ));
    assert!(
        matches!(rising, Tension::Holds { step: 3, .. }),
        "{rising:?}"
    );
    let passed = says(&format!("control = \"approach\"\npath = {places:?}"));
    assert!(passed.pull_off().is_some(), "{passed:?}");
    assert_eq!(passed.bounds(), None);
}

/// Under a prescribed position pull-off is on the way out: neither the tension that draws the surfaces together nor one from
/// which the path turns back is.
fn pull_off_is_on_the_way_out() {
    let says = |path: &[f64]| {
        let solved = sphere("", "", &format!("control = \"approach\"\npath = {path:?}"));
        let steps = solved.rows().map(|row| row.step).collect::<Vec<_>>();
        println!(
            "{path:?}: {:?}",
            solved.rows().map(|row| row.force).collect::<Vec<_>>()
        );
        assert_eq!(steps.len(), path.len());
        Tension::at_end(&solved.setup.scene.loading, &solved.end)
    };
    let out = [0.5, 0.0, -0.5, -0.7, -0.9, -1.5];
    let passed = says(&out);
    let Tension::Passed { step, force } = passed else {
        panic!("{passed:?}");
    };
    // Whatever follows once they have parted.
    let again = says(&[&out[..], &[-0.5, 0.5]].concat());
    assert_eq!(again, passed);
    // Or goes before: a tension from which the path first presses on is on the way in.
    let pressed = says(&[&[-0.5], &out[..]].concat());
    assert!(
        matches!(pressed, Tension::Passed { step: later, .. } if later == step + 1),
        "{pressed:?}"
    );
    // The way in has tension, too, and the surfaces stay together.
    for path in [
        &[-0.3, 0.5, 0.4][..],
        &[-0.3, 0.5, 0.4, 0.6],
        &[-1.5, -0.3, 0.5, 0.3, 0.4],
    ] {
        let held = says(path);
        let first = 1 + path
            .iter()
            .position(|place| *place == -0.3)
            .expect("a place");
        assert!(
            matches!(held, Tension::Holds { step, .. } if step == first),
            "{held:?}"
        );
    }
    // One that turns back half way to it has held more than was passed before.
    let turned = says(&[0.5, out[step - 1], -1.5, 0.5, 0.0, -0.5]);
    assert!(
        matches!(turned, Tension::Passed { step: 2, force: passed } if (passed / force - 1.0).abs() < 1e-3),
        "{turned:?}"
    );
    let turned = says(&[-0.3, -0.31, 0.5, 0.0, -0.5, 0.5]);
    assert!(
        matches!(turned, Tension::Holds { step: 5, .. }),
        "{turned:?}"
    );
}

tests![
    bounds_hem_in_the_closed_form,
    rows_stay_as_they_are,
    time_goes_with_the_load,
    what_still_holds_is_no_pull_off,
    pull_off_is_on_the_way_out,
];
