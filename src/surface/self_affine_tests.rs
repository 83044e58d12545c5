//! Checks of the self-affine surface against tabulated values and against itself on other grids.

use super::super::statistics::whole;
use super::*;
use approx::assert_relative_eq;
use proptest::prelude::*;

/// q_L = 1, q_0 = 4, q_1 = 64 in a cell of 2 pi: lengths of order 1.
fn unit_spectrum() -> SelfAffineSpectrum {
    SelfAffineSpectrum {
        hurst: 0.8,
        long: 1.0,
        rolloff: 4.0,
        short: 64.0,
        plateau: 1.0,
    }
    .with_rms_height(1.0)
}

fn scene(hurst: f64, magnification: f64, roughness: Roughness) -> SelfAffineScene {
    SelfAffineScene {
        hurst,
        roughness,
        longest: 2.0 * PI / 2.5e5,
        rolloff: 2.0 * PI / 1e6,
        shortest: 2.0 * PI / (magnification * 1e6),
        seed: 1,
    }
}

#[test]
fn phases() {
    assert_eq!(mix(0), 16294208416658607535);
    assert_eq!(phase_fraction(1, 1, 0), 0.12907305915441503);
    assert_eq!(phase_fraction(1, 0, 1), 0.9140224628703029);
    assert_eq!(phase_fraction(1, 3, -5), 0.8627749877947676);
}

#[test]
fn heights_of_the_tabulated_surface() {
    let grid = Grid::new([256, 256], [2.0 * PI, 2.0 * PI]);
    let heights = heights(&unit_spectrum(), &grid, 1);
    let at = |ix: usize, iy: usize| heights[iy * grid.nx + ix];
    let close =
        |found: f64, expected: f64| assert_relative_eq!(found, expected, max_relative = 1e-9);
    close(at(0, 0), 1.5243987524461033);
    close(at(0, 1), 1.393813096757373);
    close(at(1, 0), 1.2782832730154166);
    close(at(10, 20), 0.39451394541118423);
    let rms = (heights.iter().map(|h| h * h).sum::<f64>() / grid.len() as f64).sqrt();
    close(rms, 1.0104845813945431);
    close(
        heights.iter().copied().fold(f64::MIN, f64::max),
        4.0509345684879055,
    );
    close(
        heights.iter().copied().fold(f64::MAX, f64::min),
        -4.324479767217936,
    );
}

#[test]
fn sums_over_the_band() {
    // hurst, sum before rescaling, slope and Laplacian after it
    for (hurst, before, slope, curvature) in [
        (
            0.8,
            2.760997857294428e-19,
            0.0011397533839009979,
            8868.6575373435,
        ),
        (
            0.4,
            2.742570912328238e-19,
            0.0019518270533840322,
            19356.379759874126,
        ),
    ] {
        let size = [2.0 * PI / 2.5e5; 2];
        let scene = scene(hurst, 16.0, Roughness::RmsHeight(0.52e-9));
        let (spectrum, promised) = scaled_spectrum(&scene, size).unwrap();
        let continuous = spectrum.with_rms_height(0.52e-9);
        assert_relative_eq!(
            band_sums(&continuous, size).height,
            before,
            max_relative = 1e-10
        );
        let sums = band_sums(&spectrum, size);
        assert_relative_eq!(sums.height.sqrt(), 0.52e-9, max_relative = 1e-14);
        assert_relative_eq!(promised.slope, sums.slope, max_relative = 1e-14);
        assert_relative_eq!(sums.slope.sqrt(), slope, max_relative = 1e-10);
        assert_relative_eq!(sums.curvature.sqrt(), curvature, max_relative = 1e-10);
    }
}

#[test]
fn rms_slope_sets_the_slope() {
    let size = [2.0 * PI / 2.5e5, PI / 2.5e5];
    let scene = scene(0.3, 8.0, Roughness::RmsSlope(0.02));
    let (spectrum, _) = scaled_spectrum(&scene, size).unwrap();
    let sums = band_sums(&spectrum, size);
    assert_relative_eq!(sums.slope.sqrt(), 0.02, max_relative = 1e-14);
}

#[test]
fn a_coarse_grid_reports_missing_waves() {
    let scene = scene(0.8, 16.0, Roughness::RmsHeight(0.52e-9));
    let size = [2.0 * PI / 2.5e5; 2];
    let build_on = |points: [usize; 2], warnings: &mut Vec<String>| {
        let grid = Grid::new(points, size);
        build(&scene, &grid, &whole(&grid), warnings)
    };
    let mut warnings = Vec::new();
    build_on([130, 130], &mut warnings).unwrap();
    assert_eq!(warnings, Vec::<String>::new());
    build_on([128, 128], &mut warnings).unwrap();
    assert!(
        warnings[0].contains("too coarse for 4 of the 12852 waves"),
        "{warnings:?}"
    );
    build_on([32, 32], &mut warnings).unwrap();
    assert!(
        warnings[1].contains("% missing); take more than 128 x 128 points"),
        "{warnings:?}"
    );
    // A strip that is narrower than the shortest wave has enough of any points across.
    let strip = Grid::new([32, 3], [size[0], size[1] / 100.0]);
    let mut warnings = Vec::new();
    build(&scene, &strip, &whole(&strip), &mut warnings).unwrap();
    assert!(
        warnings[0].contains("% missing); take more than 128 points along x"),
        "{warnings:?}"
    );
}

#[test]
fn values_outside_the_model_are_refused() {
    let good = scene(0.8, 16.0, Roughness::RmsHeight(1e-9));
    let size = [2.0 * PI / 2.5e5; 2];
    let refused = |change: &dyn Fn(&mut SelfAffineScene), fragment: &str| {
        let mut scene = good.clone();
        change(&mut scene);
        let message = scaled_spectrum(&scene, size).unwrap_err().to_string();
        assert!(message.contains(fragment), "{message}");
    };
    refused(&|s| s.hurst = 1.1, "hurst = 1.1");
    refused(&|s| s.hurst = f64::NAN, "hurst = NaN");
    refused(&|s| s.longest = f64::INFINITY, "longest = inf");
    refused(&|s| s.rolloff = -1.0, "rolloff = -1");
    refused(&|s| s.shortest = 0.0, "shortest = 0");
    refused(&|s| s.roughness = Roughness::RmsSlope(0.0), "rms_slope = 0");
    refused(&|s| s.rolloff = 1.0, "longest >= rolloff >= shortest");
    refused(&|s| s.shortest = 1e-12, "waves across the grid");
    refused(
        &|s| (s.longest, s.rolloff, s.shortest) = (1e-4, 1e-4, 9e-5),
        "no wave of the grid",
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// A finer grid samples the same surface: the waves do not depend on the grid.
    #[test]
    fn the_surface_does_not_change_with_the_grid(
        half_points in (17_usize..40, 17_usize..40),
        seed in any::<u64>(),
        hurst in 0.0..1.0_f64,
        aspect in 0.6..1.6_f64,
    ) {
        let spectrum = SelfAffineSpectrum { hurst, long: 1.0, rolloff: 2.0, short: 10.0, plateau: 1.0 };
        let size = [2.0 * PI, 2.0 * PI * aspect];
        let points = [half_points.0 * 2 - 1, half_points.1 * 2];
        let coarse = Grid::new(points, size);
        let fine = Grid::new([2 * points[0], 2 * points[1]], size);
        let on_coarse = heights(&spectrum, &coarse, seed);
        let on_fine = heights(&spectrum, &fine, seed);
        let largest = on_coarse.iter().fold(0.0_f64, |most, h| most.max(h.abs()));
        for iy in 0..coarse.ny {
            for ix in 0..coarse.nx {
                let difference = on_coarse[iy * coarse.nx + ix] - on_fine[2 * iy * fine.nx + 2 * ix];
                prop_assert!(difference.abs() <= 1e-12 * largest);
            }
        }
    }
}
