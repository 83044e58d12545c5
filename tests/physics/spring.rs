//! A sphere on a cantilever: it snaps in and off where a line of the spring's slope touches the curve
//! of force against approach.
//!
//! Units of the Lennard-Jones tables: range, radius and work of adhesion 1, forces in 2 pi w R.

use std::f64::consts::PI;

use tabor::study::Jump;

use crate::bench::{solve, solve_table};
use crate::shared::trials::tests;
use crate::tables::table;

/// Tabor number: without a spring this sphere follows its whole curve.
const MU: f64 = 0.5;
/// Side of the window in sqrt(R eps).
const SIDE: f64 = 20.0;
/// Steps from the one snap to the other.
const WAY_BACK: u32 = 12;
/// Error of a force, in 2 pi w R, of this grid (as for the table's own test, to which the attraction outside the
/// window adds 4e-4).
const FORCE_ERROR: f64 = 1.9e-3;

/// The far end of a spring is at `A + F/k`. Along the curve of equilibria it first rises, falls from
/// where the line touches the curve to where it touches it again, and rises: a spring's far end that
/// comes in snaps at the maximum, one that leaves at the minimum. Both are found to the error of a
/// force over the stiffness and a step.
fn snaps_where_the_line_touches_the_curve() {
    let curve = table("lj_curve_mu0.5.csv");
    for stiffness in [0.15, 0.3] {
        let far_end =
            |row: usize| curve.number(row, "A") + curve.number(row, "F_over_2piwR") / stiffness;
        let ends: Vec<f64> = (0..curve.len()).map(far_end).collect();
        // The folds of the far end, each between two others: a parabola through the three rows.
        let folds: Vec<f64> = ends
            .windows(3)
            .filter(|three| (three[1] - three[0]) * (three[2] - three[1]) < 0.0)
            .map(|three| {
                let (rise, bend) = (three[2] - three[0], three[2] - 2.0 * three[1] + three[0]);
                three[1] - rise * rise / (8.0 * bend)
            })
            .collect();
        assert_eq!(folds.len(), 2, "{folds:?}");
        let (inwards, outwards) = (folds[0], folds[1]);
        let step = 0.02;
        let error = FORCE_ERROR / stiffness;
        let sweep = |from: f64, to: f64| {
            let count = ((to - from).abs() / step).round() as usize;
            (0..=count)
                .map(move |i| from + (to - from) * i as f64 / count as f64)
                .collect::<Vec<f64>>()
        };
        // Four times the errors here, and a snap before that is found where the steps begin.
        let span = 3.0 * step;
        let mut path = vec![inwards - 1.0];
        path.extend(sweep(inwards - span, inwards + span));
        // Back from there in steps that a contact can follow.
        let (turn, away) = (inwards + span, outwards + span);
        path.extend(
            (1..WAY_BACK).map(|i| turn + (away - turn) * f64::from(i) / f64::from(WAY_BACK)),
        );
        path.extend(sweep(outwards + span, outwards - span));
        let solved = solve_table(&format!(
            "[grid]\npoints = 256\nsize = {SIDE}\nboundary = \"free\"\n[solid]\ncontact_modulus = {:e}\n[[surface]]\nkind = \"sphere\"\nradius = 1.0\n[adhesion]\nlaw = \"lennard-jones\"\nwork_of_adhesion = 1.0\nrange = 1.0\n[loading]\ncontrol = \"approach\"\nspring = {:e}\npath = {path:?}\n",
            MU.powf(-1.5),
            stiffness * 2.0 * PI,
        ));
        let jumps: Vec<(Jump, f64)> = solved
            .steps
            .iter()
            .zip(&path)
            .filter_map(|(solved, far)| solved.jump.map(|jump| (jump, *far)))
            .collect();
        println!("k {stiffness}: snap-in {inwards:.4}, snap-off {outwards:.4}, found {jumps:?}");
        let [(Jump::In, found_in), (Jump::Off, found_off)] = jumps[..] else {
            panic!("{jumps:?}");
        };
        assert!(
            found_in > inwards - error && found_in < inwards + step + error,
            "in at {found_in}, expected {inwards}"
        );
        assert!(
            found_off < outwards + error && found_off > outwards - step - error,
            "off at {found_off}, expected {outwards}"
        );
    }
}

/// A spring far softer than the contact lets go only where the load is the greatest that the contact carries: there the curve
/// has the slope of no spring. It was left steps before by points that moved by the spring's whole step, many ranges of the law.
fn a_soft_spring_holds_as_much_as_a_prescribed_force() {
    // 2 pi w R with lengths over the radius and stresses over E*.
    let (work, range, side) = (1e-4, 5e-3, 0.8);
    let scale = 2.0 * PI * work;
    let stiffness = 1e-4 * side;
    // The spring's far end moves by this force a step, and so far past the greatest.
    let (steps, span) = (60, 1.6 * scale);
    for law in [
        "lennard-jones\"",
        "exponential\"",
        "maugis-dugdale\"",
        "maugis-dugdale\"\ntaper = 0.0",
    ] {
        let contact = format!(
            "[grid]\npoints = 48\nsize = {side}\nboundary = \"free\"\n[solid]\ncontact_modulus = 1.0\n[[surface]]\nkind = \"sphere\"\nradius = 1.0\n[adhesion]\nlaw = \"{law}\nwork_of_adhesion = {work:e}\nrange = {range:e}\n"
        );
        let force = |path: String| {
            let steps = solve(&format!("{contact}[loading]\n{path}")).steps;
            let forces = steps.into_iter().filter(|step| step.row.converged);
            forces.fold(0.0, |most: f64, step| most.max(-step.row.force))
        };
        // Both in steps of as much force.
        let step = span / f64::from(steps);
        let values = |scale: f64| -> Vec<f64> {
            (0..=steps)
                .map(|i| (0.3 * span - step * f64::from(i)) / scale)
                .collect()
        };
        let held = force(format!("control = \"force\"\npath = {:?}\n", values(1.0)));
        let sprung = force(format!(
            "control = \"approach\"\nspring = {stiffness:e}\npath = {:?}\n",
            values(stiffness)
        ));
        println!(
            "{law}: {} by force, {} by the spring",
            held / scale,
            sprung / scale
        );
        assert!(held > 0.5 * scale, "{law}: {held:e}");
        // Each ends less than a step before the greatest force. The spring's far end lies off by what the sphere moves, some ranges.
        let apart = step + 10.0 * range * stiffness;
        assert!((sprung - held).abs() < apart, "{law}: {held:e} {sprung:e}");
    }
}

/// Long steps of the far end bracket the pull-off that a prescribed force has, to the tolerance that both are asked for, also where
/// their last one adds a tenth of it.
fn long_steps_of_a_spring_bracket_its_pull_off() {
    let (work, range, side, tolerance) = (1e-4, 5e-3, 0.8, 0.004);
    let scale = 2.0 * PI * work;
    let stiffness = 1e-3 * side;
    let path: Vec<f64> = (0..14)
        .map(|i| 0.2 * scale - 0.12 * scale * f64::from(i))
        .collect();
    for law in ["lennard-jones\"", "maugis-dugdale\""] {
        let pull_off = |loading: String| {
            let text = format!(
                "[grid]\npoints = 48\nsize = {side}\nboundary = \"free\"\n[solid]\ncontact_modulus = 1.0\n[[surface]]\nkind = \"sphere\"\nradius = 1.0\n[adhesion]\nlaw = \"{law}\nwork_of_adhesion = {work:e}\nrange = {range:e}\n[loading]\npull_off_tolerance = {tolerance}\n{loading}"
            );
            let end = solve_table(&text).end;
            let found = end
                .pull_off
                .unwrap_or_else(|| panic!("{law}: no pull-off in {:?}", end.rows));
            let greatest = end
                .rows
                .iter()
                .fold(0.0, |most: f64, row| most.max(-row.force));
            (found, greatest)
        };
        let (by_force, _) = pull_off(format!("control = \"force\"\npath = {path:?}\n"));
        let far_ends: Vec<f64> = path.iter().map(|force| force / stiffness).collect();
        let (sprung, of_steps) = pull_off(format!(
            "control = \"approach\"\nspring = {stiffness:e}\npath = {far_ends:?}\n"
        ));
        println!("{law}: {by_force:?}, {sprung:?}, of the steps {of_steps:e}");
        assert!(
            of_steps < (1.0 - 2.0 * tolerance) * by_force.lower,
            "{law}: the steps alone show it"
        );
        assert!(
            sprung.upper - sprung.lower <= tolerance * sprung.upper,
            "{law}: {sprung:?}"
        );
        // States between the steps are solved to 1e-4.
        let error = 1e-3 * by_force.upper;
        assert!(
            sprung.lower < by_force.upper + error && sprung.upper > by_force.lower - error,
            "{law}: {sprung:?} {by_force:?}"
        );
    }
}

/// On a stiffer spring the tension has begun to fall before the contact jumps: the greatest lies between the step and the states next to
/// the jump.
fn the_greatest_tension_before_a_jump_is_bracketed() {
    let (work, range, side) = (1e-4, 5e-3, 0.8);
    let scale = 2.0 * PI * work;
    let contact = format!(
        "[grid]\npoints = 48\nsize = {side}\nboundary = \"free\"\n[solid]\ncontact_modulus = 1.0\n[[surface]]\nkind = \"sphere\"\nradius = 1.0\n[adhesion]\nlaw = \"lennard-jones\"\nwork_of_adhesion = {work:e}\nrange = {range:e}\n[loading]\n"
    );
    let forces: Vec<f64> = (0..40)
        .map(|i| scale * (0.2 - 0.04 * f64::from(i)))
        .collect();
    let by_force = solve_table(&format!(
        "{contact}control = \"force\"\npull_off_tolerance = 1e-3\npath = {forces:?}\n"
    ));
    let by_force = by_force.end.pull_off.expect("it lets go");
    let mut bracketed = 0;
    for (stiffness, steps) in [
        (0.04, 6),
        (0.04, 7),
        (0.04, 8),
        (0.06, 6),
        (0.06, 7),
        (0.06, 9),
    ] {
        let span = 4.0 * range + 1.4 * scale / stiffness;
        let far_ends: Vec<f64> = (0..=steps)
            .map(|i| 2.0 * range - span * f64::from(i) / f64::from(steps))
            .collect();
        let end = solve_table(&format!(
            "{contact}control = \"approach\"\nspring = {stiffness:e}\npath = {far_ends:?}\n"
        ))
        .end;
        println!(
            "k {stiffness}, {steps} steps: {:?}, by force {by_force:?}",
            end.pull_off
        );
        // Where a step itself has more than what is behind it, there is no bracket.
        let Some(found) = end.pull_off else {
            continue;
        };
        bracketed += 1;
        assert!(found.upper - found.lower <= 0.01 * found.upper, "{found:?}");
        let error = 2e-3 * by_force.upper;
        assert!(
            found.lower < by_force.upper + error && found.upper > by_force.lower - error,
            "k {stiffness}, {steps} steps: {found:?} {by_force:?}"
        );
    }
    assert!(bracketed >= 2, "{bracketed}");
}

tests![
    the_greatest_tension_before_a_jump_is_bracketed,
    snaps_where_the_line_touches_the_curve,
    a_soft_spring_holds_as_much_as_a_prescribed_force,
    long_steps_of_a_spring_bracket_its_pull_off,
];
