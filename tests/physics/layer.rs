//! An elastic layer on a rigid base: flattened waves, spheres on thin and thick layers, and every
//! control on it.

use std::f64::consts::PI;

use crate::bench::{solve, solve_table};
use crate::controls::{LAWS, adhesion, agree, rough};
use crate::shared::trials::tests;
use crate::tables::table;

/// Bonded and frictionless compliance over that of the half-space at `k = q h`, written out as the
/// closed forms stand; no cancellation at the k used here.
fn compliance(base: &str, k: f64, nu: f64) -> f64 {
    let x = 2.0 * k;
    if base == "frictionless" {
        return (x.cosh() - 1.0) / (x.sinh() + x);
    }
    let factor = 3.0 - 4.0 * nu;
    (factor * x.sinh() - x) / (factor * x.cosh() + 2.0 * k * k + 5.0 - 12.0 * nu + 8.0 * nu * nu)
}

fn wave(base: &str, nu: f64, thickness: f64, pressure: f64) -> String {
    format!(
        r#"
        [grid]
        points = [32, 24]
        size = [1.0, 0.75]
        [solid]
        contact_modulus = 2.0
        poisson_ratio = {nu}
        thickness = {thickness}
        base = "{base}"
        [[surface]]
        kind = "wavy"
        amplitude = 0.01
        wavelength = [1.0, 0.375]
        [loading]
        control = "pressure"
        path = [{pressure}]
        [solver]
        tolerance = 1e-10
        "#
    )
}

/// Pressed flat, a wave meets exactly its own stiffness: the pressure's amplitude, the energy and
/// the approach are closed forms for either base and any Poisson ratio.
fn a_flattened_wave() {
    let q = 2.0 * PI * (1.0f64 + (1.0f64 / 0.375).powi(2)).sqrt();
    for base in ["bonded", "frictionless"] {
        for nu in [0.0, 0.3, 0.5] {
            for thickness in [0.03, 0.1, 1.0] {
                let stiffness = q / compliance(base, q * thickness, nu);
                let amplitude = 0.01 * stiffness;
                let mean = 1.5 * amplitude;
                let solved = solve(&wave(base, nu, thickness, mean));
                let what = format!("{base}, nu {nu}, h {thickness}");
                let (row, fields) = (&solved.steps[0].row, solved.fields(0));
                assert_eq!(row.contact_area_fraction, 1.0, "{what}");
                for (i, pressure) in fields.pressure.iter().enumerate() {
                    let (x, y) = ((i % 32) as f64 / 32.0, (i / 32) as f64 / 32.0);
                    let expected =
                        mean + amplitude * (2.0 * PI * x).cos() * (2.0 * PI * y / 0.375).cos();
                    // The tolerance of the solve.
                    assert!(
                        (pressure - expected).abs() < 1e-9 * mean,
                        "{what}: point {i}"
                    );
                }
                // u = p h (1 - 2 nu)/(E* (1 - nu)^2) of the mean pressure.
                let uniform = thickness * (1.0 - 2.0 * nu) / (2.0 * (1.0 - nu) * (1.0 - nu));
                let approach = 0.01 + mean * uniform;
                assert!(
                    (row.approach.unwrap() - approach).abs() < 1e-9 * approach,
                    "{what}"
                );
                let energy = 0.75 * (0.5 * mean * mean * uniform + amplitude * 0.01 / 8.0);
                assert!(
                    (row.elastic_energy - energy).abs() < 1e-8 * energy,
                    "{what}"
                );
                let mean_displacement = fields
                    .field(
                        tabor::scene::FieldName::Displacement,
                        &solved.setup.surface.heights,
                    )
                    .iter()
                    .sum::<f64>()
                    / 768.0;
                assert!(
                    (mean_displacement - mean * uniform).abs() < 1e-9 * approach,
                    "{what}"
                );
            }
        }
    }
}

/// A sphere on layers from a third to four times as thick as the contact is wide, against the
/// dual integral equations solved apart (`tests/reference/layer_sphere.py`).
///
/// The cell repeats every 16 thicknesses, over which a layer forgets a load (exp of -1.5 a
/// thickness or faster). What is left is the grid: a Hertz contact of n pixels across its radius
/// has a force error of about 0.05/n^1.5 at its worst, here below 2e-3 at the 11 pixels of the least.
fn spheres_on_layers() {
    let table = table("layer_sphere.csv");
    for base in ["bonded", "frictionless"] {
        for nu in [0.3, 0.5] {
            let rows: Vec<usize> = (0..table.len())
                .filter(|&row| {
                    table.text(row, "base") == base && table.number(row, "poisson_ratio") == nu
                })
                .collect();
            assert_eq!(rows.len(), 4);
            // The approach is prescribed by the load: the cell's mean displacement is its own.
            let path: Vec<f64> = rows.iter().map(|&row| table.number(row, "force")).collect();
            let solved = solve_table(&format!(
                r#"
                [grid]
                points = 512
                size = 16.0
                [solid]
                contact_modulus = 1.0
                poisson_ratio = {nu}
                thickness = 1.0
                base = "{base}"
                [[surface]]
                kind = "sphere"
                radius = 50.0
                [loading]
                control = "force"
                path = {path:?}
                [solver]
                tolerance = 1e-7
                "#
            ));
            for (row, at) in solved.rows().zip(rows) {
                // Without friction a layer widens where the cell is wide; the cell's own mean cannot.
                let widening = match base {
                    "frictionless" => 1.0 - (1.0 - 2.0 * nu) / ((1.0 - nu) * (1.0 - nu)),
                    _ => 0.0,
                };
                let indentation = row.approach.unwrap() + widening * row.mean_pressure;
                let expected = table.number(at, "indentation");
                let radius = (row.contact_area_fraction_corrected.unwrap() * 256.0 / PI).sqrt();
                let expected_radius = table.number(at, "contact_radius");
                println!(
                    "{base}, nu {nu}, indentation {expected}: off by {:.1e}, radius by {:.1e}",
                    indentation / expected - 1.0,
                    radius / expected_radius - 1.0
                );
                assert!((indentation / expected - 1.0).abs() < 2e-3);
                // The edge is known to half a pixel.
                assert!((radius - expected_radius).abs() < 0.5 * 16.0 / 512.0);
            }
        }
    }
}

/// A layer ten times as thick as the cell is wide is a half-space, but for the mean displacement.
fn a_thick_layer_is_a_half_space() {
    let loading = "control = \"pressure\"\npath = [0.004]";
    let half_space = solve(&rough("", loading));
    let layer = solve(&on_layer("thickness = 10.0", "", loading));
    let (row, expected) = (&layer.steps[0].row, &half_space.steps[0].row);
    // M(k) is 1 to rounding at the smallest k = 20 pi.
    assert_eq!(row.contact_area_fraction, expected.contact_area_fraction);
    assert!((row.mean_gap.unwrap() - expected.mean_gap.unwrap()).abs() < 1e-10);
    let uniform = 10.0 * 0.4 / (0.7 * 0.7);
    assert!((row.approach.unwrap() - expected.approach.unwrap() - 0.004 * uniform).abs() < 1e-10);
}

/// The rough cell of the controls' tests on a layer a fifth as thick as it is wide.
fn on_layer(solid: &str, adhesion: &str, loading: &str) -> String {
    rough(adhesion, loading).replace(
        "contact_modulus = 1.0",
        &format!("contact_modulus = 1.0\npoisson_ratio = 0.3\n{solid}"),
    )
}

fn all_controls_agree_on_a_layer() {
    for solid in [
        "thickness = 0.2",
        "thickness = 0.05\nbase = \"frictionless\"",
        "thickness = 0.05",
    ] {
        let text = |adhesion: &str, loading: &str| on_layer(solid, adhesion, loading);
        for law in LAWS {
            agree(
                &format!("{law}, {solid}"),
                &text,
                &adhesion(law, 2e-5, 3e-3),
                ("mean-gap", [0.008, 0.012]),
                &["approach", "pressure", "force"],
                0.75,
                0.01,
            );
        }
        agree(
            &format!("hard wall, {solid}"),
            &text,
            "",
            ("mean-gap", [0.008, 0.012]),
            &["approach", "pressure", "force"],
            0.75,
            0.01,
        );
    }
}

/// Attraction summed afterwards does not yield the layer; the other controls find the same state.
fn attraction_summed_over_the_gap_of_a_layer() {
    let table = format!(
        "{}\ntreatment = \"dmt\"",
        adhesion("exponential", 2e-5, 3e-3)
    );
    let by_load = solve_table(&on_layer(
        "thickness = 0.2",
        &table,
        "control = \"pressure\"\npath = [5e-3]",
    ));
    let row = &by_load.steps[0].row;
    let again = solve_table(&on_layer(
        "thickness = 0.2",
        &table,
        &format!(
            "control = \"approach\"\npath = [{:e}]",
            row.approach.unwrap()
        ),
    ));
    let found = &again.steps[0].row;
    assert!((found.mean_pressure - row.mean_pressure).abs() < 1e-5 * 5e-3);
    assert_eq!(found.contact_area_fraction, row.contact_area_fraction);
}

tests![
    a_flattened_wave,
    spheres_on_layers,
    a_thick_layer_is_a_half_space,
    all_controls_agree_on_a_layer,
    attraction_summed_over_the_gap_of_a_layer,
];
