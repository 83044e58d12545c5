//! Wavy surfaces on a periodic boundary: Westergaard, and the two-dimensional wave.

use std::f64::consts::PI;

use crate::bench::{solve, solve_table};
use crate::shared::trials::tests;
use crate::tables::table;

const POINTS: usize = 512;

fn wave(points: &str, size: &str, wavelength: &str, path: &[f64]) -> String {
    format!(
        r#"
        [grid]
        points = {points}
        size = {size}
        [solid]
        contact_modulus = 1.0
        [[surface]]
        kind = "wavy"
        amplitude = 0.01
        wavelength = {wavelength}
        [loading]
        control = "pressure"
        path = {path:?}
        [solver]
        tolerance = 1e-9
        "#
    )
}

/// Contact share and mean gap of every tabulated load, from first touch to full contact.
fn westergaard() {
    let table = table("westergaard_load_area.csv");
    let full = PI * 0.01;
    let path: Vec<f64> = table
        .column("pbar_over_pstar")
        .iter()
        .map(|p| p * full)
        .collect();
    let solved = solve_table(&wave(
        &format!("[{POINTS}, 1]"),
        "[1.0, 1.0]",
        "[1.0, \"inf\"]",
        &path,
    ));
    for (i, row) in solved.rows().enumerate() {
        let fraction = table.number(i, "contact_fraction");
        // Each of the two edges lies somewhere within a pixel.
        let allowed = 2.0 / POINTS as f64;
        assert!(
            (row.contact_area_fraction - fraction).abs() <= allowed,
            "load {i}: {} {fraction}",
            row.contact_area_fraction
        );
        // The gap's own error is that of the pressure's square-root edge: first order in the
        // pixel times what the edge carries, largest in the middle of the curve.
        let gap = row.mean_gap.unwrap() / 0.01;
        let expected = table.number(i, "mean_gap_over_Delta");
        assert!(
            (gap - expected).abs() < 2e-4,
            "load {i}: gap {gap} {expected}"
        );
    }
    // Beyond full contact the mean gap is nothing at all.
    let closed = solve_table(&wave(
        &format!("[{POINTS}, 1]"),
        "[1.0, 1.0]",
        "[1.0, \"inf\"]",
        &[full * 1.001, full * 50.0],
    ));
    for row in closed.rows() {
        assert_eq!(row.contact_area_fraction, 1.0);
        assert_eq!(row.mean_gap, Some(0.0));
    }
}

/// A wall of tension along a line: the width that its cell is given changes neither the law of "auto" nor the curve.
fn the_width_of_a_line_contact_is_of_no_account() {
    let curve = |width: f64| {
        solve_table(&format!(
            r#"
            [grid]
            points = [128, 1]
            size = [1.0, {width}]
            [solid]
            contact_modulus = 1.0
            [[surface]]
            kind = "wavy"
            amplitude = 0.01
            wavelength = [1.0, "inf"]
            [adhesion]
            law = "maugis-dugdale"
            work_of_adhesion = 1e-5
            range = "auto"
            [loading]
            control = "pressure"
            path = [0.01, 0.0, -0.0005]
            [solver]
            tolerance = 1e-9
            "#
        ))
    };
    let [narrow, square, wide] = [1.0 / 1024.0, 1.0 / 128.0, 10.0].map(curve);
    for ((narrow, square), wide) in narrow.rows().zip(square.rows()).zip(wide.rows()) {
        for other in [narrow, wide] {
            assert_eq!(other.contact_area_fraction, square.contact_area_fraction);
            let [gap, expected] = [other, square].map(|row| row.mean_gap.unwrap());
            // Sums over a row of another unit of length, and the tolerance.
            assert!((gap - expected).abs() < 1e-7 * expected, "{gap} {expected}");
        }
    }
}

fn westergaard_pressure_profile() {
    let share: f64 = 0.3;
    let mean = PI * 0.01 * (0.5 * PI * share).sin().powi(2);
    let solved = solve(&wave(
        &format!("[{POINTS}, 1]"),
        "[1.0, 1.0]",
        "[1.0, \"inf\"]",
        &[mean],
    ));
    let edge = (0.5 * PI * share).sin();
    let mut squares = 0.0;
    for (i, pressure) in solved.fields(0).pressure.iter().enumerate() {
        let psi = PI * i as f64 / POINTS as f64;
        let inside = edge * edge - psi.sin() * psi.sin();
        let exact = 2.0 * mean * psi.cos().abs() * inside.max(0.0).sqrt() / (edge * edge);
        squares += (pressure - exact).powi(2);
    }
    let rms = (squares / POINTS as f64).sqrt() / mean;
    // The two edge pixels are off by the square root of a pixel's share of the half width,
    // sqrt(1/77) of the peak (2.1 times the mean over sin psi_a), spread over 512 points.
    assert!(rms < 0.02, "{rms}");
}

/// Crests touch as Hertz spheres: A -> pi (3 p/(8 pi p*))^(2/3) (Johnson, Greenwood & Higginson
/// 1985). At 5e-4 of p* neighbouring crests raise the area by a few per mille; the pixels count
/// 400 points to a few per cent without correction and to one with it.
fn low_limit_of_the_two_dimensional_wave() {
    let full = 2f64.sqrt() * PI * 0.01;
    let load = 5e-4;
    let solved = solve_table(&wave("512", "1.0", "[1.0, 1.0]", &[load * full]));
    let area = solved.steps[0].row.contact_area_fraction_corrected.unwrap();
    let limit = PI * (3.0 * load / (8.0 * PI)).powf(2.0 / 3.0);
    assert!((area / limit - 1.0).abs() < 0.03, "{area} {limit}");
}

tests![
    westergaard,
    the_width_of_a_line_contact_is_of_no_account,
    westergaard_pressure_profile,
    low_limit_of_the_two_dimensional_wave,
];
