//! Tests of the problem of a solve.

use super::*;

/// A sketch has the softness of the problem itself: on a half-space exactly; on a layer it looks along the axes alone, and a free
/// boundary's waves are those of a periodic cell.
#[test]
fn sketches_have_the_softest_wave() {
    let (modulus, law) = (2e6, Law::HardWall);
    let layer = Layer {
        thickness: 2e-6,
        poisson_ratio: 0.5,
        base: crate::elastic::Base::Bonded,
    };
    for points in [[24, 24], [32, 20], [2, 16]] {
        let grid = Grid::new(points, [1e-6 * points[0] as f64, 1e-6 * points[1] as f64]);
        let heights: Vec<f64> = (0..grid.len()).map(|i| 1e-9 * (i % 3) as f64).collect();
        for (boundary, on_layer, bound) in [
            (Boundary::Periodic, false, 1e-12),
            (Boundary::Periodic, true, 0.05),
            (Boundary::Free, false, 0.5),
        ] {
            let problem = Problem::new(grid, boundary, modulus, &heights, 0.1, law);
            let sketch = Problem::sketch(grid, boundary, modulus, law);
            let [problem, sketch] = [problem, sketch].map(|problem| match on_layer {
                true => problem.on_layer(layer),
                false => problem,
            });
            // Both in Pa/m.
            let softest = |problem: &Problem| {
                problem.stiffness_min() * problem.scales.pressure / problem.scales.length
            };
            let found = softest(&sketch) / softest(&problem);
            assert!(
                (found - 1.0).abs() <= bound,
                "{points:?} {boundary:?}: {found}"
            );
            if boundary == Boundary::Free {
                let zero = |problem: &Problem| {
                    problem.stiffness.zero_mode() * problem.scales.pressure / problem.scales.length
                };
                let found = zero(&sketch) / zero(&problem);
                assert!((found - 1.0).abs() < 0.05, "{points:?}: {found}");
            }
        }
    }
}

#[test]
fn good_sizes_are_even_and_smooth() {
    for (points, size) in [
        (1, 2),
        (3, 4),
        (127, 128),
        (129, 140 - 10),
        (255, 256),
        (2 * 127 - 1, 256),
    ] {
        let found = good_size(points);
        assert!(found >= points && found.is_multiple_of(2));
        if points != 129 {
            assert_eq!(found, size);
        }
    }
    assert_eq!(good_size(129), 140);
    assert_eq!(good_size(22), 24);
}
