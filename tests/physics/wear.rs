//! What sliding wears off: Archard's coefficient times the load that presses.

use std::f64::consts::PI;

use tabor::study::State;
use tabor::theory::maugis_dugdale::MaugisDugdale;
use tabor::theory::tabor_map::{Sphere, maugis_parameter};

use crate::bench::solve_table;
use crate::shared::trials::tests;

/// Worn volume for each load and length of sliding, in the units of these scenes.
const SPECIFIC: f64 = 0.3;

/// A sphere of radius 1 on a solid of modulus 1 that stands alone.
fn sphere(points: usize, size: f64, adhesion: &str, loading: &str) -> String {
    format!(
        "[grid]\npoints = {points}\nsize = {size}\nboundary = \"free\"\n[solid]\ncontact_modulus = 1.0\n[[surface]]\nkind = \"sphere\"\nradius = 1.0\n{adhesion}[wear]\nspecific_wear_rate = {SPECIFIC}\n[loading]\n{loading}\n"
    )
}

/// Without adhesion everything presses, so the load is the net force: the same sum, so the same to the
/// rounding of one product. Hertz' force of the sphere is met to its discretisation, as
/// `hertz.rs` has it, and a surface that does not touch wears nothing.
fn a_sphere_without_adhesion_wears_by_its_load() {
    let depths = [-0.1_f64, 0.02, 0.05];
    let loading = format!("control = \"approach\"\npath = {depths:?}");
    let solved = solve_table(&sphere(64, 1.0, "", &loading));
    for (row, depth) in solved.rows().zip(depths) {
        let worn = row.column("wear_rate").expect("a wear rate");
        if depth < 0.0 {
            assert_eq!(worn, 0.0);
            continue;
        }
        assert!((worn / (SPECIFIC * row.force) - 1.0).abs() < 4.0 * f64::EPSILON);
        let hertz = 4.0 / 3.0 * depth.powf(1.5);
        assert!((worn / (SPECIFIC * hertz) - 1.0).abs() < 0.01, "{worn}");
    }
    // No load, and no state that carries it.
    let solved = solve_table(&sphere(64, 1.0, "", "control = \"force\"\npath = [0.0]"));
    let row = solved.rows().next().expect("a row");
    assert_eq!(row.state, State::Separated);
    assert_eq!(row.column("wear_rate"), Some(0.0));
}

/// A sphere that sticks wears at no load too: by the part of Maugis' pressure (1992)
/// that presses, integrated here. The contact is met to half a pixel of its radius of 47 pixels, and
/// its load goes with the cube of that: 3 %.
fn a_sphere_that_sticks_wears_at_no_load() {
    let adhesion = "[adhesion]\nlaw = \"maugis-dugdale\"\nwork_of_adhesion = 0.1\nrange = 0.07\n";
    let loading = "control = \"force\"\npath = [0.4, 0.0]";
    let solved = solve_table(&sphere(256, 6.0, adhesion, loading));
    let tension = 0.1 / 0.07;
    let body = Sphere::new(1.0, 1.0, 0.1).expect("a sphere");
    let lambda = maugis_parameter(&body, tension).expect("a parameter");
    let maugis = MaugisDugdale::new(lambda).expect("a sphere");
    // Maugis' unit of length, (pi w R^2/K)^(1/3).
    let length = (PI * 0.1 / body.maugis_modulus()).cbrt();
    for row in solved.rows() {
        let states = maugis
            .states_at_force(row.force / (PI * 0.1))
            .expect("equilibria");
        // The stable one is the largest.
        let state = states
            .iter()
            .max_by(|a, b| a.contact_radius.total_cmp(&b.contact_radius))
            .expect("a state");
        let [a, c] = [state.contact_radius, state.cohesive_radius].map(|r| r * length);
        let net = |r: f64| {
            let hertz = 2.0 / PI * (a * a - r * r).sqrt();
            let pull = ((2.0 * a * a - c * c - r * r) / (c * c - r * r)).acos();
            hertz - tension / PI * pull
        };
        let rings = 20_000;
        let width = a / f64::from(rings);
        let pressing: f64 = (0..rings)
            .map(|ring| (f64::from(ring) + 0.5) * width)
            .map(|r| 2.0 * PI * r * width * net(r).max(0.0))
            .sum();
        let worn = row.column("wear_rate").expect("a wear rate");
        let expected = SPECIFIC * pressing;
        println!("at {}: {worn:.5} {expected:.5}", row.force);
        assert!((worn / expected - 1.0).abs() < 0.03, "{worn} {expected}");
        // Neither the net load nor nothing at all.
        assert!(worn > 1.2 * SPECIFIC * row.force && worn > 0.01);
    }
}

/// Where the attraction does not deform the contact, what presses at no load is all of the attraction:
/// the law's tension on the ring where the gap of Hertz is within its range, and 2 pi w R, which
/// Derjaguin, Muller & Toporov have for a range that is far longer than the contact is deep. The ring of
/// 46 pixels of radius is counted in whole pixels, to less than 1 % of its area; the finite range
/// leaves some per cent more than the limit.
fn without_its_own_deformation_attraction_presses_with_all_of_itself() {
    let (work, range) = (1e-5, 1e-2);
    let adhesion = format!(
        "[adhesion]\nlaw = \"maugis-dugdale\"\nwork_of_adhesion = {work}\nrange = {range}\ntaper = 0\ntreatment = \"dmt\"\n"
    );
    let loading = "control = \"force\"\npath = [0.0]";
    let solved = solve_table(&sphere(128, 0.4, &adhesion, loading));
    let bisect = |mut low: f64, mut high: f64, rises: &dyn Fn(f64) -> f64| {
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            match rises(middle) < 0.0 {
                true => low = middle,
                false => high = middle,
            }
        }
        low
    };
    let attraction = |a: f64| {
        let gap = |c: f64| {
            let x = c / a;
            a * a / PI * ((x * x - 1.0).sqrt() + (x * x - 2.0) * (1.0 / x).acos())
        };
        let c = bisect(a, 1.0, &|c| gap(c) - range);
        work / range * PI * (c * c - a * a)
    };
    // Hertz: the load that presses is 4 a^3/3.
    let load = |a: f64| 4.0 / 3.0 * a.powi(3);
    let pressing = load(bisect(1e-3, 0.2, &|a| load(a) - attraction(a)));
    let row = solved.rows().next().expect("a row");
    let found = row.column("wear_rate").expect("a wear rate") / SPECIFIC;
    println!("{found:e} {pressing:e} {:e}", 2.0 * PI * work);
    assert!(
        (found / pressing - 1.0).abs() < 0.01,
        "{found:e} {pressing:e}"
    );
    assert!((found / (2.0 * PI * work) - 1.0).abs() < 0.1, "{found:e}");
}

tests![
    a_sphere_without_adhesion_wears_by_its_load,
    a_sphere_that_sticks_wears_at_no_load,
    without_its_own_deformation_attraction_presses_with_all_of_itself,
];
