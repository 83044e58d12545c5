//! What no choice of origin, axes, units or grid may change, and what every solution has: asked of
//! random contacts.
//!
//! `TABOR_INVARIANTS=2000 cargo test --release --test physics invariants` tries more than the usual few.
//!
//! The laws are so weak and long-ranged that the energy is convex at a held mean gap (their slope is at
//! most `SOFTENING` of the softest wave's stiffness), so that there is one solution and two solves may be
//! compared; without adhesion there is one at any load.

use std::f64::consts::PI;

use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use tabor::grid::Grid;
use tabor::kernel::Status;
use tabor::law::{Exponential, Law, LennardJones, MaugisDugdale};
use tabor::scene::Boundary;
use tabor::solver::{ContactSolver, Hold, Load, Problem, Start};

use crate::bench::cpu;
use crate::energy;
use crate::shared::trials::tests;

/// Cases of a usual run, for each property.
const CASES: u32 = 12;
const TOLERANCE: f64 = 1e-9;
/// Steepest slope of a law over the stiffness of the softest wave.
const SOFTENING: f64 = 0.8;

/// One wave of the heights: wave numbers, amplitude, phase.
type Wave = ([i32; 2], f64, f64);

/// A random contact, its grid still open.
#[derive(Clone, Debug)]
struct Contact {
    size: [f64; 2],
    waves: Vec<Wave>,
    /// Which law: 0 is the wall alone.
    law: u8,
    /// Range over the largest height that the waves may reach.
    range: f64,
    /// Mean gap over the same, or pressure over what flattens the steepest sum of the waves.
    load: f64,
    /// Of the wall: whether the pressure is held in place of the mean gap.
    pressed: bool,
}

fn contacts(laws: std::ops::Range<u8>) -> impl Strategy<Value = Contact> {
    let wave = ([-3..=3_i32, -3..=3_i32], 0.1..1.0_f64, 0.0..2.0 * PI);
    (
        [0.5..2.0_f64, 0.5..2.0_f64],
        prop::collection::vec(wave, 2..7),
        laws,
        0.05..0.5_f64,
        0.05..1.0_f64,
        any::<bool>(),
    )
        .prop_map(|(size, waves, law, range, load, pressed)| Contact {
            size,
            waves,
            law,
            range,
            load,
            pressed: pressed && law == 0,
        })
        .prop_filter("a surface that is flat", |contact| {
            contact.waves.iter().any(|(number, ..)| *number != [0, 0])
        })
}

fn grids() -> impl Strategy<Value = [usize; 2]> {
    let side = || prop::sample::select(vec![12, 13, 15, 16, 18, 20, 24]);
    [side(), side()]
}

/// What a unit of side, height and modulus is worth, SI.
#[derive(Clone, Copy)]
struct Units {
    lateral: f64,
    vertical: f64,
    modulus: f64,
}

const ONE: Units = Units {
    lateral: 1.0,
    vertical: 1.0,
    modulus: 1.0,
};

impl Units {
    fn pressure(self) -> f64 {
        self.modulus * self.vertical / self.lateral
    }
}

/// A solved state in units of the contact.
struct Solution {
    gap: Vec<f64>,
    /// Elastic pressure, mean pressure and attraction together: the wall's reaction where it touches,
    /// and otherwise what is off balance.
    y: Vec<f64>,
    traction: Vec<f64>,
    mean_pressure: f64,
    /// Norms by which gaps and pressures of two solves of one contact may differ.
    gap_error: f64,
    pressure_error: f64,
}

impl Contact {
    /// Largest height that the waves may reach.
    fn height(&self) -> f64 {
        0.01 * self.waves.iter().map(|wave| wave.1).sum::<f64>()
    }

    fn heights(&self, [nx, ny]: [usize; 2]) -> Vec<f64> {
        let at = |ix: usize, iy: usize| {
            let (x, y) = (ix as f64 / nx as f64, iy as f64 / ny as f64);
            let wave = |([kx, ky], amplitude, phase): &Wave| {
                amplitude * (2.0 * PI * (f64::from(*kx) * x + f64::from(*ky) * y) + phase).cos()
            };
            0.01 * self.waves.iter().map(wave).sum::<f64>()
        };
        (0..nx * ny).map(|i| at(i % nx, i / nx)).collect()
    }

    /// Stiffness of the softest wave, pi E* over the longer side.
    fn softest(&self) -> f64 {
        PI / self.size[0].max(self.size[1])
    }

    fn problem(&self, points: [usize; 2], heights: &[f64], units: Units) -> Problem {
        let heights: Vec<f64> = heights
            .iter()
            .map(|height| height * units.vertical)
            .collect();
        let range = self.range * self.height() * units.vertical;
        // The work of adhesion whose law is as steep as it may be.
        let work = SOFTENING * self.softest() * units.modulus / units.lateral * range * range;
        let law = match self.law {
            0 => Law::HardWall,
            1 => Law::MaugisDugdale(MaugisDugdale {
                peak_tension: work / range,
                range,
                taper: range,
            }),
            2 => Law::Exponential(Exponential {
                work_of_adhesion: work,
                range,
            }),
            _ => Law::LennardJones(LennardJones {
                work_of_adhesion: work / STEEPEST,
                range,
            }),
        };
        let grid = Grid::new(points, self.size.map(|side| side * units.lateral));
        // The slope sets no more than a floor of the stopping measure.
        let slope = self.height() * units.vertical / units.lateral;
        Problem::new(
            grid,
            Boundary::Periodic,
            units.modulus,
            &heights,
            slope,
            law,
        )
    }

    fn hold(&self, problem: &Problem, units: Units) -> Load {
        if self.pressed {
            let flattens = self.softest() * self.height() * units.pressure();
            let pressure = self.load * flattens / problem.scales.pressure;
            return Load {
                hold: Hold::Pressure(pressure),
                zero_stiffness: 0.0,
                zero_compliance: ContactSolver::pressure_compliance(problem, pressure),
            };
        }
        let gap = self.load * self.height() * units.vertical;
        Load {
            hold: Hold::Gap(gap / problem.scales.length),
            zero_stiffness: 0.0,
            zero_compliance: 1.0 / problem.stiffness_min(),
        }
    }

    fn solve(&self, points: [usize; 2], heights: &[f64], units: Units) -> Solution {
        let problem = self.problem(points, heights, units);
        let load = self.hold(&problem, units);
        let mut backend = cpu();
        let mut solver = ContactSolver::new(&mut *backend, &problem);
        let outcome = solver
            .solve(
                &load,
                &Start::Cold,
                TOLERANCE,
                3000,
                false,
                &cpu,
                &mut |_| true,
            )
            .expect("cpu");
        assert_eq!(outcome.status, Status::Converged, "{outcome:?} {self:?}");
        let (gap, elastic) = (
            solver.gap().expect("cpu"),
            solver.elastic_pressure().expect("cpu"),
        );
        let traction: Vec<f64> = gap.iter().map(|g| problem.law.traction(*g)).collect();
        let y: Vec<f64> = (elastic.iter().zip(&traction))
            .map(|(elastic, traction)| elastic + outcome.mean_pressure + traction)
            .collect();
        // Two solves may each be off balance by the tolerance, which moves the softest wave, softened by
        // the law, the most.
        let size = norm(&y).max(norm(&traction));
        let softest = problem.stiffness_min() * (1.0 - SOFTENING);
        let gap_error = 2.0 * TOLERANCE * size / softest + 1e-14 * norm(&problem.padded_heights());
        let [length, pressure] = [
            problem.scales.length / units.vertical,
            problem.scales.pressure / units.pressure(),
        ];
        let scaled = |values: &[f64], unit: f64| values.iter().map(|value| value * unit).collect();
        Solution {
            gap: scaled(&gap, length),
            y: scaled(&y, pressure),
            traction: scaled(&traction, pressure),
            mean_pressure: outcome.mean_pressure * pressure,
            gap_error: gap_error * length,
            pressure_error: gap_error * problem.stiffness_max() * pressure,
        }
    }
}

/// Steepest fall of the Lennard-Jones law in w/range^2.
const STEEPEST: f64 = 1.252_757_65;

fn norm(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>().sqrt()
}

/// `map` says which point of the first a point of the second is.
fn same(
    one: &Solution,
    other: &Solution,
    map: impl Fn(usize) -> usize,
) -> Result<(), TestCaseError> {
    for (a, b, allowed) in [
        (&one.gap, &other.gap, one.gap_error),
        (&one.y, &other.y, one.pressure_error),
    ] {
        let apart: Vec<f64> = (0..b.len()).map(|i| a[map(i)] - b[i]).collect();
        let off = norm(&apart);
        prop_assert!(off <= allowed, "apart by {off:e}, {allowed:e} allowed");
    }
    Ok(())
}

fn check<S: Strategy>(strategy: S, test: impl Fn(S::Value) -> Result<(), TestCaseError>)
where
    S::Value: std::fmt::Debug,
{
    let cases = std::env::var("TABOR_INVARIANTS").map_or(CASES, |text| {
        text.parse().expect("TABOR_INVARIANTS is a number of cases")
    });
    let config = Config {
        cases,
        failure_persistence: None,
        ..Config::default()
    };
    let numbers = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    let result = TestRunner::new_with_rng(config, numbers).run(&strategy, test);
    if let Err(error) = result {
        panic!("{error}");
    }
}

fn the_origin_of_heights() {
    check(
        (contacts(0..4), grids(), -1e3..1e3_f64),
        |(contact, points, shift)| {
            let heights = contact.heights(points);
            let moved: Vec<f64> = heights.iter().map(|height| height + shift).collect();
            let mut one = contact.solve(points, &heights, ONE);
            let other = contact.solve(points, &moved, ONE);
            // The moved heights are rounded before anything is solved.
            let rounding = f64::EPSILON * shift.abs() * (heights.len() as f64).sqrt();
            let stiffest = one.pressure_error / one.gap_error;
            one.gap_error += rounding * stiffest / contact.softest() / (1.0 - SOFTENING);
            one.pressure_error = one.gap_error * stiffest;
            same(&one, &other, |i| i)
        },
    );
}

fn the_origin_of_places() {
    check(
        (contacts(0..4), grids(), 0..24_usize, 0..24_usize),
        |(contact, points, dx, dy)| {
            let [nx, ny] = points;
            let heights = contact.heights(points);
            let from = |i: usize| (i / nx + dy) % ny * nx + (i % nx + dx) % nx;
            let moved: Vec<f64> = (0..heights.len()).map(|i| heights[from(i)]).collect();
            let one = contact.solve(points, &heights, ONE);
            same(&one, &contact.solve(points, &moved, ONE), from)
        },
    );
}

fn left_and_right() {
    check((contacts(0..4), grids()), |(contact, points)| {
        let nx = points[0];
        let heights = contact.heights(points);
        let from = |i: usize| i / nx * nx + (nx - 1 - i % nx);
        let mirrored: Vec<f64> = (0..heights.len()).map(|i| heights[from(i)]).collect();
        let one = contact.solve(points, &heights, ONE);
        same(&one, &contact.solve(points, &mirrored, ONE), from)
    });
}

fn a_quarter_turn() {
    check((contacts(0..4), grids()), |(contact, [nx, ny])| {
        let heights = contact.heights([nx, ny]);
        // Point (x, y) of the turned grid, ny wide, is (y, ny - 1 - x) of the first.
        let from = |i: usize| (ny - 1 - i % ny) * nx + i / ny;
        let turned: Vec<f64> = (0..heights.len()).map(|i| heights[from(i)]).collect();
        let one = contact.solve([nx, ny], &heights, ONE);
        let mut other = contact.clone();
        other.size.reverse();
        same(&one, &other.solve([ny, nx], &turned, ONE), from)
    });
}

fn units() {
    let decades = || -12.0..12.0_f64;
    check(
        (contacts(0..4), grids(), [decades(), decades(), decades()]),
        |(contact, points, decades)| {
            let [lateral, vertical, modulus] = decades.map(|decade| 10_f64.powf(decade));
            let units = Units {
                lateral,
                vertical,
                modulus,
            };
            let heights = contact.heights(points);
            let one = contact.solve(points, &heights, ONE);
            same(&one, &contact.solve(points, &heights, units), |i| i)
        },
    );
}

/// Twice the points: contact changes by no more than the points along its edge, the
/// mean gap or the pressure by a pixel over the shortest wave.
fn refinement() {
    check(contacts(0..4), |contact| {
        let [coarse, fine] =
            [24, 48].map(|side| contact.solve([side; 2], &contact.heights([side; 2]), ONE));
        let core = contact.law == 3;
        let touches = |solution: &Solution, i: usize| match core {
            true => solution.gap[i] < 0.0,
            false => solution.gap[i] == 0.0,
        };
        let share = |solution: &Solution| {
            let count = solution.gap.len();
            (0..count).filter(|i| touches(solution, *i)).count() as f64 / count as f64
        };
        // Share of the points with a neighbour, to the right or above, that does otherwise.
        let edge = |solution: &Solution, side: usize| {
            let count = side * side;
            let differs = |i: &usize| {
                let [x, y] = [i % side, i / side];
                let neighbours = [y * side + (x + 1) % side, (y + 1) % side * side + x];
                neighbours
                    .into_iter()
                    .any(|other| touches(solution, *i) != touches(solution, other))
            };
            (0..count).filter(differs).count() as f64 / count as f64
        };
        let off = (share(&coarse) - share(&fine)).abs();
        // A crest that one grid just misses is an edge on the other alone.
        let allowed = edge(&coarse, 24).max(edge(&fine, 48)) + 1.0 / 576.0;
        prop_assert!(
            off <= allowed,
            "contact differs by {off}, {allowed} allowed"
        );
        let mean = |solution: &Solution| match contact.pressed {
            true => solution.gap.iter().sum::<f64>() / solution.gap.len() as f64 / contact.height(),
            false => solution.mean_pressure / contact.softest() / contact.height(),
        };
        // The shortest wave has eight pixels.
        let off = (mean(&coarse) - mean(&fine)).abs();
        prop_assert!(
            off <= 0.125 * mean(&fine).abs().max(1.0),
            "{} {}",
            mean(&coarse),
            mean(&fine)
        );
        Ok(())
    });
}

fn more_load_more_contact() {
    check(
        (contacts(0..1), grids(), 1.0..3.0_f64),
        |(contact, points, more)| {
            let contact = Contact {
                pressed: true,
                ..contact
            };
            let heavier = Contact {
                load: contact.load * more,
                ..contact.clone()
            };
            let heights = contact.heights(points);
            let count = |contact: &Contact| {
                let solution = contact.solve(points, &heights, ONE);
                solution.gap.iter().filter(|gap| **gap == 0.0).count()
            };
            let counts = [count(&contact), count(&heavier)];
            prop_assert!(counts[0] <= counts[1], "{counts:?}");
            Ok(())
        },
    );
}

fn energy_never_rises() {
    check((contacts(0..4), grids()), |(contact, points)| {
        let contact = Contact {
            pressed: false,
            ..contact
        };
        let problem = contact.problem(points, &contact.heights(points), ONE);
        let load = contact.hold(&problem, ONE);
        energy::falls(&format!("{contact:?}"), &problem, &load, TOLERANCE);
        Ok(())
    });
}

/// No overlap, no pulling wall, no tension beyond the law's, no reaction across a gap; and the
/// pressures add up to the load.
fn admissible_and_in_balance() {
    check((contacts(0..4), grids()), |(contact, points)| {
        let solution = contact.solve(points, &contact.heights(points), ONE);
        let count = solution.gap.len() as f64;
        let wall = contact.law != 3;
        // The stopping measure's own numerator and denominator bound what is off.
        let size = norm(&solution.y) + norm(&solution.traction);
        let allowed = 2.0 * TOLERANCE * size
            + 1e-13 * solution.pressure_error / solution.gap_error * norm(&solution.gap);
        let mut off = Vec::new();
        let mut net = 0.0;
        for ((gap, y), traction) in solution.gap.iter().zip(&solution.y).zip(&solution.traction) {
            prop_assert!(!wall || *gap >= 0.0);
            let closed = wall && *gap == 0.0;
            off.push(if closed { y.min(0.0) } else { *y });
            net += if closed {
                y.max(0.0) - traction
            } else {
                -traction
            };
        }
        prop_assert!(
            norm(&off) <= allowed,
            "off balance by {:e}, {allowed:e} allowed",
            norm(&off)
        );
        let off = (net / count - solution.mean_pressure).abs();
        prop_assert!(
            off <= allowed / count.sqrt(),
            "the mean is off by {off:e}, {allowed:e} allowed"
        );
        Ok(())
    });
}

tests![
    the_origin_of_heights,
    the_origin_of_places,
    left_and_right,
    a_quarter_turn,
    units,
    refinement,
    more_load_more_contact,
    energy_never_rises,
    admissible_and_in_balance,
];
