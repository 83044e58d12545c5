//! Cones: contacts of a few pixels at a tip, and Sneddon's law.

use std::f64::consts::PI;

use crate::bench::solve;
use crate::shared::trials::tests;

fn cone(grid: &str, half_angle: f64, loading: &str) -> String {
    format!(
        "[grid]\n{grid}\n[solid]\ncontact_modulus = 1.0\n[[surface]]\nkind = \"cone\"\nhalf_angle = {half_angle}\n[loading]\n{loading}\n[solver]\ntolerance = 1e-8\n"
    )
}

/// The first direction from undeformed surfaces leads through the wall at the tip, whatever its length. The four pixels around the
/// apex bear the load in equal parts.
fn four_pixels_at_the_tip_bear_a_small_load() {
    let mean = 1e-3;
    let loading = format!("control = \"pressure\"\npath = [{mean}]");
    let points = 32;
    let solved = solve(&cone(
        &format!("points = {points}\nsize = 1.0"),
        45.0,
        &loading,
    ));
    assert!(solved.steps[0].row.converged);
    let each = mean * f64::from(points * points) / 4.0;
    let bearing: Vec<f64> = solved
        .fields(0)
        .pressure
        .iter()
        .copied()
        .filter(|pressure| *pressure != 0.0)
        .collect();
    assert_eq!(bearing.len(), 4);
    for pressure in bearing {
        // The tolerance, of the norm of these four.
        assert!((pressure / each - 1.0).abs() < 1e-6, "{pressure} {each}");
    }
}

/// F = (2/pi) E* delta^2 tan(alpha) (Sneddon 1965).
fn force_at_an_approach() {
    let (half_angle, approach) = (80.0_f64, 0.02);
    let slope = half_angle.to_radians().tan();
    let loading = format!("control = \"approach\"\npath = [{approach}]");
    let solved = solve(&cone(
        "points = 128\nsize = 0.25\nboundary = \"free\"",
        half_angle,
        &loading,
    ));
    let exact = 2.0 / PI * approach * approach * slope;
    let force = solved.steps[0].row.force;
    // The radius, 0.0722, is 37 pixels: the apex between four pixels is cut by 0.7 of one, 1.2e-4 of the approach's 0.02.
    assert!((force / exact - 1.0).abs() < 0.02, "{force} {exact}");
}

tests![
    four_pixels_at_the_tip_bear_a_small_load,
    force_at_an_approach,
];
