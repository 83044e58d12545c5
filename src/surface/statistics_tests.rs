//! Tests of statistics of heights.

use super::super::self_affine;
use super::super::spectrum::SelfAffineSpectrum;
use super::*;
use approx::assert_relative_eq;

#[test]
fn coefficients_are_those_of_the_waves() {
    for points in [[12, 10], [9, 7], [8, 1], [1, 6]] {
        let grid = Grid::new(points, [3.0, 2.0]);
        let (k, l) = ((points[0] - 1) / 4, (points[1] as i64 - 1) / 4);
        let heights: Vec<f64> = (0..grid.len())
            .map(|i| {
                let (x, y) = (
                    (i % grid.nx) as f64 / grid.nx as f64,
                    (i / grid.nx) as f64 / grid.ny as f64,
                );
                5.0 + (2.0 * PI * (k as f64 * x - l as f64 * y) + 0.3).cos()
            })
            .collect();
        let spectrum = fourier::analyse(&grid, &heights);
        if k > 0 {
            let found = spectrum[mode_index(&grid, k, -l)];
            assert_relative_eq!(found.re, 0.5 * 0.3_f64.cos(), max_relative = 1e-12);
            assert_relative_eq!(found.im, 0.5 * 0.3_f64.sin(), max_relative = 1e-12);
        }
        let back = fourier::synthesise(&grid, spectrum);
        for (found, expected) in back.iter().zip(&heights) {
            assert_relative_eq!(found, expected, max_relative = 1e-12);
        }
    }
}

#[test]
fn moments_of_a_self_affine_surface_are_the_sums_over_its_band() {
    let spectrum = SelfAffineSpectrum {
        hurst: 0.6,
        long: 1.0,
        rolloff: 3.0,
        short: 20.0,
        plateau: 1.0,
    };
    let grid = Grid::new([64, 81], [2.0 * PI, 3.0 * PI]);
    let sums = self_affine::band_sums(&spectrum, [grid.lx, grid.ly]);
    let heights = self_affine::heights(&spectrum, &grid, 9);
    let moments = Statistics::from_heights(&grid, &heights, Boundary::Periodic).moments;
    assert_relative_eq!(moments.m0, sums.height, max_relative = 1e-12);
    assert_relative_eq!(moments.rms_slope(), sums.slope.sqrt(), max_relative = 1e-12);
    assert_relative_eq!(
        moments.rms_curvature(),
        sums.curvature.sqrt(),
        max_relative = 1e-12
    );
    assert!(moments.nayak().unwrap() > 1.5);
}

#[test]
fn moments_of_an_egg_box() {
    // h = cos x cos y: <h^2> = 1/4, <|grad h|^2> = 1/2, lap h = -2 h.
    let grid = Grid::new([16, 16], [2.0 * PI, 2.0 * PI]);
    let heights: Vec<f64> = (0..256)
        .map(|i| {
            let at = |i: usize| (2.0 * PI * i as f64 / 16.0).cos();
            7.0 + at(i % 16) * at(i / 16)
        })
        .collect();
    let statistics = Statistics::from_heights(&grid, &heights, Boundary::Periodic);
    assert_relative_eq!(statistics.mean, 7.0, max_relative = 1e-14);
    assert_eq!((statistics.lowest, statistics.highest), (6.0, 8.0));
    assert_relative_eq!(statistics.moments.rms_height(), 0.5, max_relative = 1e-13);
    assert_relative_eq!(
        statistics.moments.rms_slope(),
        0.5_f64.sqrt(),
        max_relative = 1e-12
    );
    assert_relative_eq!(
        statistics.moments.rms_curvature(),
        1.0,
        max_relative = 1e-12
    );
}

/// h = cos 2x: <h'^2> = 2, <h''^2> = 8, and a Nayak number of 1, as a wave has along its profile.
#[test]
fn a_line_scan_has_its_own_moments() {
    for points in [[16, 1], [1, 16], [16, 4]] {
        let grid = Grid::new(points, [2.0 * PI, 2.0 * PI]);
        let along = |i: usize| if points[0] == 1 { i } else { i % 16 };
        let heights: Vec<f64> = (0..grid.len())
            .map(|i| (4.0 * PI * along(i) as f64 / 16.0).cos())
            .collect();
        let statistics = Statistics::from_heights(&grid, &heights, Boundary::Periodic);
        let moments = statistics.along_a_profile(&grid);
        let expected = if points[1] == 4 {
            // As if the waves of a surface ran in all directions.
            [0.5, 1.0, 3.0]
        } else {
            [0.5, 2.0, 8.0]
        };
        for (found, expected) in [moments.m0, moments.m2, moments.m4].iter().zip(expected) {
            assert_relative_eq!(*found, expected, max_relative = 1e-12);
        }
    }
}

#[test]
fn differences_of_a_quadratic_are_exact() {
    // h = x^2 + 3 y: Laplacian 2; forward differences 2 x + dx along x, 3 along y.
    let grid = Grid::new([4, 3], [4.0, 6.0]);
    let heights: Vec<f64> = (0..12)
        .map(|i| ((i % 4) as f64).powi(2) + 6.0 * (i / 4) as f64)
        .collect();
    let moments = Statistics::from_heights(&grid, &heights, Boundary::Free).moments;
    assert_relative_eq!(moments.rms_curvature(), 2.0, max_relative = 1e-14);
    assert_relative_eq!(
        2.0 * moments.m2,
        (1.0 + 9.0 + 25.0) / 3.0 + 9.0,
        max_relative = 1e-14
    );
    let line = Grid::new([3, 1], [3.0, 1.0]);
    let moments = Statistics::from_heights(&line, &[0.0, 1.0, 2.0], Boundary::Free).moments;
    assert_eq!((2.0 * moments.m2, moments.m4), (1.0, 0.0));
    // A profile along x or y: h = x^2.
    for points in [[5, 1], [1, 5]] {
        let line = Grid::new(points, points.map(|points| points as f64));
        let squares = [0.0, 1.0, 4.0, 9.0, 16.0];
        let moments = Statistics::from_heights(&line, &squares, Boundary::Free).moments;
        assert_relative_eq!(moments.rms_curvature(), 2.0, max_relative = 1e-14);
    }
}

/// The window keeps the mean square of a wave, also of a profile.
#[test]
fn the_spectrum_of_a_free_profile_has_its_mean_square() {
    for points in [[64, 1], [1, 64], [64, 2]] {
        let grid = Grid::new(points, [1.0, 1.0]);
        let along = |i: usize| if points[0] == 1 { i } else { i % 64 };
        let heights: Vec<f64> = (0..grid.len())
            .map(|i| (2.0 * PI * 8.0 * along(i) as f64 / 64.0).sin())
            .collect();
        let rings = radial_spectrum(&grid, &heights, Boundary::Free);
        let power = |ring: &SpectrumRing| ring.density * ring.modes as f64;
        let square = 4.0 * PI * PI * rings.iter().map(power).sum::<f64>();
        assert_relative_eq!(square, 0.5, max_relative = 1e-9);
    }
}

#[test]
fn the_radial_spectrum_follows_the_density() {
    let spectrum = SelfAffineSpectrum {
        hurst: 0.8,
        long: 1.0,
        rolloff: 4.0,
        short: 30.0,
        plateau: 2.0,
    };
    let grid = Grid::new([80, 80], [2.0 * PI, 2.0 * PI]);
    let heights = self_affine::heights(&spectrum, &grid, 3);
    let rings = radial_spectrum(&grid, &heights, Boundary::Periodic);
    assert_relative_eq!(rings[0].wavenumber, 1.0, max_relative = 1e-12);
    assert_eq!(rings[0].modes, 4);
    assert_eq!(
        rings.iter().map(|ring| ring.modes).sum::<usize>(),
        80 * 80 - 1
    );
    for ring in rings.iter().filter(|ring| ring.wavenumber < 26.0) {
        // A ring is 12 % wide, over which C falls by a third: its mean lies near its middle.
        let expected = spectrum.density(ring.wavenumber);
        assert_relative_eq!(ring.density, expected, max_relative = 0.02);
    }
    // The window keeps the mean square of a surface that is not periodic.
    let free = radial_spectrum(&grid, &heights, Boundary::Free);
    let total = |rings: &[SpectrumRing]| -> f64 {
        rings
            .iter()
            .map(|ring| ring.density * ring.modes as f64)
            .sum()
    };
    assert_relative_eq!(total(&free), total(&rings), max_relative = 0.4);
}

#[test]
fn edges_of_a_map_that_repeats_are_like_its_steps() {
    let grid = Grid::new([32, 16], [1.0, 1.0]);
    let waves: Vec<f64> = (0..512)
        .map(|i| (2.0 * PI * (i % 32) as f64 / 32.0).sin())
        .collect();
    let [along_x, along_y] = edge_jumps(&grid, &whole(&grid), &waves);
    assert!(along_x.0 < 2.0 * along_x.1, "{along_x:?}");
    assert_eq!(along_y, (0.0, 0.0));
    let tilted: Vec<f64> = (0..512).map(|i| (i / 32) as f64).collect();
    assert_eq!(edge_jumps(&grid, &whole(&grid), &tilted)[1], (15.0, 1.0));
}
