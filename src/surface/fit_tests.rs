//! Surfaces of known parameters, whole and cut out of larger ones.

use std::f64::consts::PI;

use super::super::self_affine;
use super::*;

/// A spectrum with the given numbers of waves to the roll-off and to the cut-off, in a cell of 1
/// um.
fn spectrum(hurst: f64, rolloff: f64, short: f64, cell: f64) -> SelfAffineSpectrum {
    let first = 2.0 * PI / cell;
    SelfAffineSpectrum {
        hurst,
        long: first,
        rolloff: rolloff * first,
        short: short * first,
        plateau: 1.0,
    }
    .with_rms_height(1e-9)
}

fn relative(found: f64, expected: f64) -> f64 {
    (found / expected - 1.0).abs()
}

#[test]
fn a_generated_surface_gives_its_parameters_back() {
    // The amplitudes are exact. The error is the width of the rings (12 %; the mean of a power law
    // over a ring lies off its middle by up to 1 %, equally for all) and of the pixels at the
    // cut-off, half a wave of 60.
    for (hurst, rolloff, short, seed) in [
        (0.3, 4.0, 60.0, 1),
        (0.5, 8.0, 60.0, 2),
        (0.8, 4.0, 60.0, 3),
        (0.9, 6.0, 100.0, 4),
    ] {
        let asked = spectrum(hurst, rolloff, short, 1e-6);
        let grid = Grid::new([256, 256], [1e-6, 1e-6]);
        let heights = self_affine::heights(&asked, &grid, seed);
        let found = fit(&grid, &heights, Boundary::Periodic).unwrap();
        let case = format!("{asked:?} {found:?}");
        assert!((found.spectrum.hurst - hurst).abs() < 0.02, "{case}");
        assert!(
            relative(found.spectrum.rolloff, asked.rolloff) < 0.06,
            "{case}"
        );
        assert!(relative(found.spectrum.short, asked.short) < 0.01, "{case}");
        assert!(relative(found.spectrum.long, asked.long) < 1e-9, "{case}");
        assert!(
            found.rolloff_seen && found.cutoff_seen && found.hurst_inside,
            "{case}"
        );
        // The surface generated from the fit is as rough.
        let sums = band_sums(&asked, [1e-6, 1e-6]);
        assert!(
            relative(found.sums.height.sqrt(), sums.height.sqrt()) < 0.03,
            "{case}"
        );
        assert!(
            relative(found.sums.slope.sqrt(), sums.slope.sqrt()) < 0.03,
            "{case}"
        );
    }
}

#[test]
fn a_patch_of_a_larger_surface_gives_its_parameters() {
    // A quarter of the cell under a Hann window: its few long modes scatter like squares of
    // Gaussian numbers. An independent implementation of this estimate, over thirty patches each of
    // Hurst exponent 0.4 and 0.8, scatters by 0.034 in the exponent (mean off by 0.01) and by 12 to
    // 16 % in the roll-off (mean off by 5 %); the cut-off scatters by 0.3 waves of 60. Three
    // standard deviations of each.
    for (hurst, seed) in [(0.4, 1), (0.6, 2), (0.8, 3), (0.8, 4)] {
        let asked = spectrum(hurst, 8.0, 120.0, 2e-6);
        let whole = Grid::new([512, 512], [2e-6, 2e-6]);
        let heights = self_affine::heights(&asked, &whole, seed);
        let patch: Vec<f64> = (0..256)
            .flat_map(|row| heights[row * 512..row * 512 + 256].iter().copied())
            .collect();
        let grid = Grid::new([256, 256], [1e-6, 1e-6]);
        let found = fit(&grid, &patch, Boundary::Free).unwrap();
        let case = format!("{asked:?} {found:?}");
        assert!((found.spectrum.hurst - hurst).abs() < 0.11, "{case}");
        assert!(
            relative(found.spectrum.rolloff, asked.rolloff) < 0.5,
            "{case}"
        );
        assert!(relative(found.spectrum.short, asked.short) < 0.02, "{case}");
        assert!(found.rolloff_seen && found.cutoff_seen, "{case}");
    }
}

#[test]
fn the_cutoff_of_a_few_waves_lies_in_the_band() {
    // Eight waves across the surface are four across a patch of a quarter of it, fewer than the cut-off is refined by.
    // The rings about the cut-off bound it: they are 12 % wide each, and a window smears it over two waves of four.
    for seed in 1..=8 {
        let asked = spectrum(0.8, 1.0, 8.0, 2e-6);
        let whole = Grid::new([64, 64], [2e-6, 2e-6]);
        let heights = self_affine::heights(&asked, &whole, seed);
        let patch: Vec<f64> = (0..32)
            .flat_map(|row| heights[row * 64..row * 64 + 32].iter().copied())
            .collect();
        let grid = Grid::new([32, 32], [1e-6, 1e-6]);
        let found = fit(&grid, &patch, Boundary::Free).unwrap();
        let case = format!("{asked:?} {found:?}");
        assert!(found.spectrum.short > found.spectrum.rolloff, "{case}");
        assert!(relative(found.spectrum.short, asked.short) < 0.6, "{case}");
    }
}

#[test]
fn missing_rolloff_and_cutoff_are_reported() {
    let asked = spectrum(0.7, 1.0, 127.0, 1e-6);
    let grid = Grid::new([256, 256], [1e-6, 1e-6]);
    let heights = self_affine::heights(&asked, &grid, 5);
    let found = fit(&grid, &heights, Boundary::Periodic).unwrap();
    assert!(!found.rolloff_seen && !found.cutoff_seen, "{found:?}");
    assert_eq!(found.spectrum.rolloff, found.spectrum.long);
    assert!(relative(found.spectrum.short, asked.short) < 1e-9);
    assert!((found.spectrum.hurst - 0.7).abs() < 0.02, "{found:?}");
    // The rings near the first mode hold 4 modes each; the slope follows from all the others: 3 %.
    assert!(relative(found.sums.slope, band_sums(&asked, [1e-6; 2]).slope) < 0.06);
}

#[test]
fn maps_without_a_spectrum_are_refused() {
    let grid = Grid::new([64, 64], [1.0, 1.0]);
    assert_eq!(
        fit(&grid, &vec![2.0; 4096], Boundary::Periodic),
        Err(BandFitError::Flat)
    );
    let scan: Vec<f64> = (0..4096).map(|i| f64::from((i * 7) % 5)).collect();
    for points in [[4096, 1], [1, 4096]] {
        let grid = Grid::new(points, [1.0, 1.0]);
        let refused = fit(&grid, &scan, Boundary::Periodic);
        assert_eq!(refused, Err(BandFitError::LineScan));
    }
    let grid = Grid::new([4, 4], [1.0, 1.0]);
    let heights: Vec<f64> = (0..16).map(|i| f64::from((i * 7) % 5)).collect();
    let refused = fit(&grid, &heights, Boundary::Free);
    assert!(
        matches!(refused, Err(BandFitError::TooFewRings { .. })),
        "{refused:?}"
    );
}
