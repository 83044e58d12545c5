//! The CPU's elastic operator: forward, multiply, backward against a plain discrete Fourier
//! transform and against what an elastic half-space must be.

use std::f64::consts::PI;

use proptest::prelude::*;
use tabor::backend::cpu::{self, with_threads};
use tabor::backend::{Backend, Factors, Shape};
use tabor::elastic::{free_stiffness, love_displacement, periodic_stiffness};
use tabor::grid::Grid;
use tabor::kernel::displacement::{LOAD_FIELD, STORE_FIELD};
use tabor::kernel::{Gate, Params};
use tabor::law::{Exponential, Law, LennardJones};
use tabor::scene::Boundary;
use tabor::solver::{ContactSolver, Hold, Load, Problem, Start};

use crate::shared::trials::tests;

fn params() -> Params {
    Params {
        law: Law::HardWall,
        stiffness_max: 1.0,
        pressure_floor: 1.0,
        tolerance: 0.0,
        heights_norm: 1.0,
        prescribed_mean_gap: false,
        may_detach: false,
        points: 1.0,
        smooth_stiffness: 1.0,
        level_compliance: 1.0,
        own_compliance: 0.75,
        neighbour_compliance: 0.062,
        softening: 0.7,
        hardness: f64::INFINITY,
        epsilon: f64::EPSILON,
    }
}

/// K applied to a field, and the energy `<s, K s>` that comes with it.
fn apply(
    mut backend: Box<dyn Backend + Send>,
    points: [usize; 2],
    spectrum: &[f64],
    field: &[f64],
) -> (Vec<f64>, f64) {
    let level = backend.level("fine", Shape::whole(points[0], points[1]));
    let (source, result) = (
        backend.field(level, "source"),
        backend.field(level, "result"),
    );
    let spectrum = backend.spectrum(level, "stiffness", Factors::Table(spectrum));
    backend.set_params(&params());
    backend.write(source, field);
    backend.run(&LOAD_FIELD, level, &[source]);
    backend.multiply(spectrum, true, Gate::Always);
    backend.run(&STORE_FIELD, level, &[result]);
    let curvature = backend.scalars().expect("cpu").curvature;
    (backend.read(result).expect("cpu").into(), curvature)
}

/// Seeded values between -1 and 1.
pub fn values(count: usize, seed: u64) -> Vec<f64> {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    (0..count)
        .map(|_| {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        })
        .collect()
}

fn stiffness(points: [usize; 2]) -> Vec<f64> {
    periodic_stiffness(&Grid::new(points, [1.0, 1.3]), 1.0, None)
}

/// The value of a half-plane spectrum (columns slowest) at any wavevector, by evenness.
fn at(spectrum: &[f64], [nx, ny]: [usize; 2], kx: usize, ky: usize) -> f64 {
    spectrum[kx.min(nx - kx) * (ny / 2 + 1) + ky.min(ny - ky)]
}

/// The same operator by sums over all points and wavevectors.
fn plain(points: [usize; 2], spectrum: &[f64], field: &[f64]) -> Vec<f64> {
    let [nx, ny] = points;
    let wave = |k: usize, i: usize, n: usize| {
        let phase = 2.0 * PI * ((k * i) % n) as f64 / n as f64;
        (phase.cos(), phase.sin())
    };
    let mut result = vec![0.0; nx * ny];
    for ky in 0..ny {
        for kx in 0..nx {
            let turns: Vec<(f64, f64)> = (0..nx * ny)
                .map(|i| {
                    let ((a, b), (c, d)) = (wave(kx, i % nx, nx), wave(ky, i / nx, ny));
                    (a * c - b * d, a * d + b * c)
                })
                .collect();
            let (mut re, mut im) = (0.0, 0.0);
            for (value, (cos, sin)) in field.iter().zip(&turns) {
                re += value * cos;
                im += value * sin;
            }
            let factor = at(spectrum, points, kx, ky) / (nx * ny) as f64;
            for (value, (cos, sin)) in result.iter_mut().zip(&turns) {
                *value += factor * (re * cos + im * sin);
            }
        }
    }
    result
}

fn norm(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>().sqrt()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn difference(a: &[f64], b: &[f64]) -> f64 {
    norm(&a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>())
}

/// Largest value of a spectrum, which bounds what the operator makes of a field.
fn largest(spectrum: &[f64]) -> f64 {
    spectrum.iter().copied().fold(0.0, f64::max)
}

/// Rounding of a fast transform grows with the logarithm of its length; some tens of eps cover
/// every size here, primes included. The plain sums' own phases are good to as much.
const ROUNDING: f64 = 1e-13;

/// Odd, prime, rectangular, thin and tiny grids, and any factors (not only a half-space's).
fn equals_a_plain_transform() {
    for points in [
        [1, 1],
        [2, 2],
        [1, 8],
        [8, 1],
        [1, 7],
        [7, 1],
        [2, 9],
        [9, 2],
        [3, 3],
        [5, 4],
        [8, 8],
        [16, 6],
        [15, 9],
        [17, 13],
        [13, 17],
        [18, 25],
        [31, 8],
        [24, 20],
    ] {
        let count = points[0] * points[1];
        let any: Vec<f64> = values((points[0] / 2 + 1) * (points[1] / 2 + 1), 7)
            .iter()
            .map(|v| v + 1.5)
            .collect();
        for spectrum in [stiffness(points), any] {
            let field = values(count, 3);
            let (found, energy) = apply(cpu::double(None), points, &spectrum, &field);
            let expected = plain(points, &spectrum, &field);
            let scale = largest(&spectrum) * norm(&field);
            let error = difference(&found, &expected);
            assert!(
                error <= ROUNDING * scale,
                "{points:?}: off by {error:e} of {scale:e}"
            );
            let exact = dot(&field, &expected);
            assert!(
                (energy - exact).abs() <= ROUNDING * scale * norm(&field),
                "{points:?}: {energy} {exact}"
            );
        }
    }
}

/// A cosine is an eigenvector: E* q/2 times itself.
fn waves_are_eigenvectors() {
    let (nx, ny) = (48, 20);
    let grid = Grid::new([nx, ny], [1.0, 1.3]);
    for (kx, ky) in [(1, 0), (0, 3), (5, 2), (24, 10)] {
        let field: Vec<f64> = (0..nx * ny)
            .map(|i| {
                let (x, y) = ((i % nx) as f64 / nx as f64, (i / nx) as f64 / ny as f64);
                (2.0 * PI * (kx as f64 * x + ky as f64 * y)).cos()
            })
            .collect();
        let eigenvalue = 0.5 * 2.0 * PI * (kx as f64).hypot(ky as f64 / 1.3);
        let (found, _) = apply(
            cpu::double(None),
            [nx, ny],
            &periodic_stiffness(&grid, 1.0, None),
            &field,
        );
        let expected: Vec<f64> = field.iter().map(|value| eigenvalue * value).collect();
        assert!(
            difference(&found, &expected) <= ROUNDING * 200.0 * norm(&field),
            "{kx}, {ky}"
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    /// `<a, Kb> = <b, Ka>`, `<a, Ka> >= 0` and as the energy sum says, K shifts with its field.
    fn symmetric_positive_and_at_home_everywhere(
        nx in 1usize..40,
        ny in 1usize..40,
        shift_x in 0usize..40,
        shift_y in 0usize..40,
        seed in 0u64..1000,
    ) {
        let points = [nx, ny];
        let spectrum = stiffness(points);
        let (a, b) = (values(nx * ny, seed), values(nx * ny, seed + 1000));
        let scale = largest(&spectrum).max(1e-300) * norm(&a) * norm(&b).max(norm(&a));
        let (ka, energy) = apply(cpu::double(None), points, &spectrum, &a);
        let (kb, _) = apply(cpu::double(None), points, &spectrum, &b);
        prop_assert!((dot(&a, &kb) - dot(&b, &ka)).abs() <= ROUNDING * scale);
        prop_assert!(energy >= 0.0);
        prop_assert!((energy - dot(&a, &ka)).abs() <= ROUNDING * scale);
        let moved = |field: &[f64]| -> Vec<f64> {
            (0..nx * ny)
                .map(|i| field[(i / nx + shift_y) % ny * nx + (i % nx + shift_x) % nx])
                .collect()
        };
        let (shifted, _) = apply(cpu::double(None), points, &spectrum, &moved(&a));
        prop_assert!(difference(&shifted, &moved(&ka)) <= ROUNDING * largest(&spectrum) * norm(&a));
        // A constant costs nothing.
        let (rigid, energy) = apply(cpu::double(None), points, &spectrum, &vec![1.0; nx * ny]);
        prop_assert!(norm(&rigid) <= ROUNDING * largest(&spectrum) * ((nx * ny) as f64).sqrt());
        prop_assert!(energy.abs() <= ROUNDING * largest(&spectrum) * (nx * ny) as f64);
    }

    /// Single precision is the same operator to its own rounding.
    fn the_single_twin_is_close(nx in 1usize..70, ny in 1usize..70, seed in 0u64..1000) {
        let points = [nx, ny];
        let spectrum = stiffness(points);
        let field = values(nx * ny, seed);
        let (double, energy) = apply(cpu::double(None), points, &spectrum, &field);
        let (single, energy_single) = apply(cpu::single(None), points, &spectrum, &field);
        let scale = largest(&spectrum) * norm(&field);
        // Eight or so roundings of 6e-8 along a value's way.
        prop_assert!(difference(&double, &single) <= 1e-6 * scale);
        prop_assert!((energy - energy_single).abs() <= 1e-6 * scale * norm(&field));
    }
}

/// On the doubled grid the inverse operator is Love's sum over loaded pixels, pixel by pixel.
fn the_free_boundary_is_loves_sum() {
    for (surface, pixel) in [
        ([6, 5], [1.0, 1.0]),
        ([4, 8], [0.5, 2.0]),
        ([1, 7], [1.0, 1.5]),
        ([2, 2], [1.0, 1.0]),
    ] {
        let [nx, ny] = surface;
        let doubled = [2 * nx, 2 * ny];
        let stiffness = free_stiffness(doubled, pixel);
        let compliance: Vec<f64> = stiffness.iter().map(|value| 1.0 / value).collect();
        let loads = values(nx * ny, 11);
        let mut padded = vec![0.0; 4 * nx * ny];
        for (i, load) in loads.iter().enumerate() {
            padded[i / nx * 2 * nx + i % nx] = *load;
        }
        let (displacement, _) = apply(cpu::double(None), doubled, &compliance, &padded);
        let scale = largest(&compliance) * norm(&loads);
        for i in 0..nx * ny {
            let mut expected = 0.0;
            for (j, load) in loads.iter().enumerate() {
                let x = ((i % nx) as f64 - (j % nx) as f64) * pixel[0];
                let y = ((i / nx) as f64 - (j / nx) as f64) * pixel[1];
                expected += load * love_displacement(x, y, 0.5 * pixel[0], 0.5 * pixel[1]);
            }
            let found = displacement[i / nx * 2 * nx + i % nx];
            assert!(
                (found - expected).abs() <= ROUNDING * scale,
                "{surface:?} at {i}: {found} {expected}"
            );
        }
        // The stiffness undoes it.
        let (back, energy) = apply(cpu::double(None), doubled, &stiffness, &displacement);
        let condition = largest(&stiffness) * scale;
        assert!(
            difference(&back, &padded) <= ROUNDING * condition,
            "{surface:?}"
        );
        assert!(energy > 0.0);
    }
}

/// Rows are cut into the same blocks whatever the number of threads.
fn bitwise_the_same_on_any_number_of_threads() {
    for points in [[64, 64], [50, 77], [9, 130]] {
        let spectrum = stiffness(points);
        let field = values(points[0] * points[1], 5);
        let on = |threads| {
            with_threads(Some(threads), || {
                apply(cpu::double(None), points, &spectrum, &field)
            })
            .expect("threads")
        };
        let (one, two, five) = (on(1), on(2), on(5));
        for other in [two, five] {
            assert!(
                one.0
                    .iter()
                    .zip(&other.0)
                    .all(|(a, b)| a.to_bits() == b.to_bits()),
                "{points:?}"
            );
            assert_eq!(one.1.to_bits(), other.1.to_bits(), "{points:?}");
        }
    }
}

/// So a whole solve is, sums, decisions and coarse level included.
fn a_solve_is_bitwise_the_same_on_any_number_of_threads() {
    let grid = Grid::new([96, 80], [1.0, 1.0]);
    let heights = values(grid.len(), 21);
    for (boundary, law) in [
        (Boundary::Periodic, Law::HardWall),
        (Boundary::Free, Law::HardWall),
        (
            Boundary::Periodic,
            Law::LennardJones(LennardJones {
                work_of_adhesion: 0.1,
                range: 0.5,
            }),
        ),
        (
            Boundary::Free,
            Law::Exponential(Exponential {
                work_of_adhesion: 0.1,
                range: 0.5,
            }),
        ),
    ] {
        let problem = Problem::new(grid, boundary, 1.0, &heights, 50.0, law);
        let load = Load {
            hold: Hold::Pressure(0.01),
            zero_stiffness: 0.0,
            zero_compliance: ContactSolver::pressure_compliance(&problem, 0.01),
        };
        let on = |threads| {
            with_threads(Some(threads), || {
                let mut backend = cpu::double(None);
                let mut solver = ContactSolver::new(&mut *backend, &problem);
                solver
                    .begin(&load, &Start::Cold, 1e-12, false)
                    .expect("cpu");
                for _ in 0..25 {
                    solver.iterate().expect("cpu");
                }
                solver.gap().expect("cpu")
            })
            .expect("threads")
        };
        let (one, two) = (on(1), on(2));
        assert!(
            one.iter()
                .zip(&two)
                .all(|(a, b)| a.to_bits() == b.to_bits()),
            "{boundary:?} {law:?}"
        );
        assert!(one.iter().any(|gap| *gap != one[0]));
    }
}

tests![
    equals_a_plain_transform,
    waves_are_eigenvectors,
    symmetric_positive_and_at_home_everywhere,
    the_single_twin_is_close,
    the_free_boundary_is_loves_sum,
    bitwise_the_same_on_any_number_of_threads,
    a_solve_is_bitwise_the_same_on_any_number_of_threads,
];
