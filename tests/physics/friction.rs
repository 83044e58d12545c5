//! Friction as a shear strength times the area in contact.

use std::f64::consts::PI;

use tabor::theory::friction;
use tabor::theory::maugis_dugdale::MaugisDugdale;
use tabor::theory::tabor_map::{Sphere, maugis_parameter};

use crate::bench::solve_table;

/// An adhesive sphere towards JKR's limit rubs at no load too: with the area of Maugis' contact of the
/// same law, to half a pixel of its radius of 47 pixels, 2 % of the area. JKR's own is some per cent more.
#[test]
fn a_sphere_that_adheres_rubs_at_no_load() {
    let solved = solve_table(
        r#"
        [grid]
        points = 256
        size = 6.0
        boundary = "free"
        [solid]
        contact_modulus = 1.0
        [[surface]]
        kind = "sphere"
        radius = 1.0
        [adhesion]
        law = "maugis-dugdale"
        work_of_adhesion = 0.1
        range = 0.07
        [friction]
        shear_strength = 0.3
        [loading]
        control = "force"
        path = [0.4, 0.0]
        "#,
    );
    let sphere = Sphere::new(1.0, 1.0, 0.1).expect("a sphere");
    let lambda = maugis_parameter(&sphere, 0.1 / 0.07).expect("a parameter");
    let maugis = MaugisDugdale::new(lambda).expect("a sphere");
    // Maugis' unit of length, (pi w R^2/K)^(1/3).
    let length = (PI * 0.1 / sphere.maugis_modulus()).cbrt();
    for row in solved.rows() {
        let found = row.friction_force.expect("a friction force");
        let area = row.contact_area_fraction * 36.0;
        assert!((found - 0.3 * area).abs() < 1e-12);
        let states = maugis
            .states_at_force(row.force / (PI * 0.1))
            .expect("equilibria");
        // The stable one is the largest.
        let radius = states
            .iter()
            .map(|state| state.contact_radius)
            .fold(0.0, f64::max);
        let expected = 0.3 * PI * (radius * length).powi(2);
        let limit = friction::jkr_force(&sphere, 0.3, row.force).expect("a force");
        println!("at {}: {found:.4} {expected:.4}, JKR {limit:.4}", row.force);
        assert!((found / expected - 1.0).abs() < 0.02, "{found} {expected}");
        assert!(found < limit);
    }
    // Hertz at the same load would rub a third less.
    let hertz = 0.3 * PI * (0.75f64 * 0.4).powf(2.0 / 3.0);
    let loaded = solved.rows().next().and_then(|row| row.friction_force);
    assert!(loaded.expect("a friction force") > 1.3 * hertz);
}
