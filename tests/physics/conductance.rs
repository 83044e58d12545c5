//! What a contact conducts: by its frozen stiffness.

use std::f64::consts::PI;

use crate::bench::{Solved, solve_table};
use crate::controls::{LAWS, adhesion, rough};
use crate::shared::trials::tests;

/// Conductivities whose harmonic mean is 1: with E* = 1 a conductance is a stiffness.
const BODIES: &str = "[conductance]\nconductivity = 0.75\ncounter_conductivity = 1.5\n";

fn conductance(solved: &Solved, step: usize) -> f64 {
    let row = &solved.steps[step].row;
    row.column("conductance").expect("a conductance")
}

fn sphere(boundary: &str, points: usize, size: f64, tables: &str, loading: &str) -> String {
    format!(
        "[grid]\npoints = {points}\nsize = {size}\nboundary = \"{boundary}\"\n[solid]\ncontact_modulus = 1.0\n[[surface]]\nkind = \"sphere\"\nradius = 1.0\n{BODIES}{tables}[loading]\n{loading}\n"
    )
}

/// One circular spot conducts 2 a k: Hertz' circle at a given force. The contact of whole pixels, 16
/// to 26 across the radius, is as wide as Hertz' to a hundredth of the radius.
fn a_circle_conducts_by_its_radius() {
    let path = "control = \"approach\"\npath = [-0.1, 0.04, 0.1]";
    let solved = solve_table(&sphere("free", 128, 1.6, "", path));
    assert_eq!(conductance(&solved, 0), 0.0);
    for (step, approach) in [(1, 0.04f64), (2, 0.1)] {
        let expected = 2.0 * approach.sqrt();
        let found = conductance(&solved, step);
        println!("at {approach}: {found:.5} {expected:.5}");
        assert!((found / expected - 1.0).abs() < 0.01, "{found} {expected}");
    }
}

/// What sticks conducts by its width too, not by the slope of its load curve, which at pull-off is 0.
fn a_sphere_that_adheres_conducts_by_its_width() {
    for law in LAWS {
        let table = adhesion(law, 0.02, 0.02) + "\n";
        let load = "control = \"force\"\npath = [0.05, 0.0, -0.08]";
        let solved = solve_table(&sphere("free", 128, 3.0, &table, load));
        for step in 0..3 {
            let row = &solved.steps[step].row;
            let radius = (row.contact_area_fraction * 9.0 / PI).sqrt();
            let found = conductance(&solved, step);
            println!("{law} at {}: {found:.5} {:.5}", row.force, 2.0 * radius);
            // A circle of 13 to 22 pixels across the radius.
            assert!(
                (found / (2.0 * radius) - 1.0).abs() < 0.02,
                "{law}: {found}"
            );
        }
    }
}

/// In a square lattice of spots each is hindered by the others: the displacement of a spot's own load
/// less that of the uniform one, `1/(2a) - C/(pi L)` with the lattice's C = 3.900265 (Borwein et al. 1988,
/// the square Wigner crystal), and from there on a term in (a/L)^3 below 0.4 (a/L)^3 sqrt(pi)^3, 2e-3 here.
fn neighbours_hinder_a_spot() {
    let load = "control = \"force\"\npath = [1.333e-3]";
    let solved = solve_table(&sphere("periodic", 256, 1.0, "", load));
    let row = &solved.steps[0].row;
    let radius = (row.contact_area_fraction / PI).sqrt();
    let expected = 1.0 / (0.5 / radius - 3.900265 / PI);
    let found = conductance(&solved, 0);
    println!(
        "a/L {radius:.4}: {found:.5} {expected:.5}, alone {:.5}",
        2.0 * radius
    );
    assert!((found / expected - 1.0).abs() < 0.01, "{found} {expected}");
}

/// Without adhesion the load curve of a discrete contact is straight while no point opens or closes,
/// and its slope is the frozen stiffness; over longer steps the slope lies between those of the ends.
fn the_slope_of_the_load_curve() {
    let gap = 0.008;
    let path: Vec<f64> = [0.0, 1e-6, 2e-6, 3e-6, 0.02, 0.04]
        .iter()
        .map(|closed| gap * (1.0 - closed))
        .collect();
    let text = rough("", &format!("control = \"mean-gap\"\npath = {path:?}"));
    let solved = solve_table(
        &text
            .replace("[loading]", &format!("{BODIES}[loading]"))
            .replace("tolerance = 1e-9", "tolerance = 1e-12"),
    );
    let rows: Vec<_> = solved.rows().collect();
    let mut straight = 0;
    for (step, pair) in rows.windows(2).enumerate() {
        let moved = pair[0].mean_gap.expect("a gap") - pair[1].mean_gap.expect("a gap");
        let slope = (pair[1].force - pair[0].force) / moved;
        let ends = [step, step + 1].map(|step| conductance(&solved, step));
        println!("{slope:.7} {:.7} {:.7}", ends[0], ends[1]);
        if step < 3 {
            if pair[0].contact_area_fraction == pair[1].contact_area_fraction {
                straight += 1;
                // The force is known to 1e-12 and changes by 1e-5 or so.
                assert!((slope / ends[0] - 1.0).abs() < 1e-5, "{slope} {ends:?}");
            }
        } else {
            assert!(ends[0] < slope && slope < ends[1], "{slope} {ends:?}");
        }
    }
    assert!(straight >= 2, "points change at every step");
}

/// What conducts does not depend on what holds it: the same surface closed everywhere has no
/// constriction left, and its column is empty.
fn full_contact_has_no_constriction() {
    let text = rough("", "control = \"pressure\"\npath = [0.01, 10.0]");
    let solved = solve_table(&text.replace("[loading]", &format!("{BODIES}[loading]")));
    assert!(conductance(&solved, 0) > 0.0);
    let row = &solved.steps[1].row;
    assert_eq!(row.contact_area_fraction, 1.0);
    assert_eq!(row.column("conductance"), None);
}

tests![
    a_circle_conducts_by_its_radius,
    a_sphere_that_adheres_conducts_by_its_width,
    neighbours_hinder_a_spot,
    the_slope_of_the_load_curve,
    full_contact_has_no_constriction,
];
