//! Self-affine surfaces without adhesion against an independent boundary-element code.

use crate::bench::{setup, solve, solve_table};
use crate::shared::trials::tests;

pub const MODULUS: f64 = 1.33e12;

/// A surface of the study: 0.52 nm rough, rolled off at a quarter of the cell.
pub struct Surface {
    pub hurst: f64,
    /// Roll-off over the shortest wavelength.
    pub ratio: usize,
    pub points: usize,
    pub seed: u64,
}

/// Its scene; `adhesion` is that table or nothing.
pub fn scene(surface: &Surface, adhesion: &str, path: &[f64], tolerance: f64) -> String {
    let longest = 2.0 * std::f64::consts::PI / 2.5e5;
    format!(
        r#"
        [grid]
        points = {}
        size = {longest:e}
        [solid]
        contact_modulus = {MODULUS:e}
        [[surface]]
        kind = "self-affine"
        hurst = {}
        rms_height = "0.52 nm"
        longest = {longest:e}
        rolloff = {:e}
        shortest = {:e}
        seed = {}
        {adhesion}
        [loading]
        control = "pressure"
        path = {path:?}
        [solver]
        tolerance = {tolerance:e}
        "#,
        surface.points,
        surface.hurst,
        longest / 4.0,
        longest / (4 * surface.ratio) as f64,
        surface.seed,
    )
}

/// The number of contact pixels of each surface must be exactly that of the other code, and the
/// mean gap its own to 1e-6, which the other code's tolerance of 1e-9 allows for.
fn contact_pixels_of_four_surfaces() {
    for (ratio, points, seed, load, pixels, mean_gap) in [
        (32, 1024, 1, 0.0125, 28250, 1.4217969167162114),
        (16, 512, 1, 0.02, 11467, 1.258511872897629),
        (16, 512, 1, 0.06, 33791, 0.7325398828535684),
        (16, 256, 7, 0.02, 3011, 1.263595452272796),
    ] {
        let surface = Surface {
            hurst: 0.8,
            ratio,
            points,
            seed,
        };
        let slope = setup(&scene(&surface, "", &[1.0], 1e-6))
            .statistics
            .moments
            .rms_slope();
        let solved = solve_table(&scene(&surface, "", &[load * MODULUS * slope], 1e-9));
        let row = &solved.steps[0].row;
        let counted = row.contact_area_fraction * (points * points) as f64;
        assert_eq!(
            counted.round() as usize,
            pixels,
            "n = {points}, seed {seed}, load {load}"
        );
        let gap = row.mean_gap.unwrap() / 0.52e-9;
        assert!((gap / mean_gap - 1.0).abs() < 1e-6, "{gap} {mean_gap}");
    }
}

/// Pressed flat the pressure is that of the surface's own waves: p_rms = E* h'_rms/2 about the mean.
fn full_contact_at_a_large_load() {
    let surface = Surface {
        hurst: 0.8,
        ratio: 8,
        points: 128,
        seed: 3,
    };
    let slope = setup(&scene(&surface, "", &[1.0], 1e-6))
        .statistics
        .moments
        .rms_slope();
    let mean = 10.0 * MODULUS * slope;
    let solved = solve(&scene(&surface, "", &[mean], 1e-9));
    assert_eq!(solved.steps[0].row.contact_area_fraction, 1.0);
    let pressure = &solved.fields(0).pressure;
    let squares: f64 = pressure.iter().map(|p| (p - mean).powi(2)).sum();
    let rms = (squares / pressure.len() as f64).sqrt();
    // Nothing is approximated here: rounding of the transforms, relative to the mean pressure.
    assert!((rms / (0.5 * MODULUS * slope) - 1.0).abs() < 1e-9, "{rms}");
}

tests![
    contact_pixels_of_four_surfaces,
    full_contact_at_a_large_load,
];
