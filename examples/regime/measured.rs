//! Curves as an instrument measures them: a full field seen through a spring, at even steps of its base, with noise.

use std::f64::consts::{PI, TAU};

use tabor::fit::Sample;

use super::problems::{Point, Problem};
use super::random::Random;

/// Measurements of one field, by their noise over `2 pi w R`; without attraction the noise is a share of the load.
pub const NOISES: [(f64, f64); 5] = [
    (0.002, 0.01),
    (0.01, 0.03),
    (0.03, 0.1),
    (0.1, 0.3),
    (0.3, 2.0),
];
const NOISE_WITHOUT_ATTRACTION: (f64, f64) = (0.001, 0.05);
/// Tabor number from which the force may jump under a prescribed approach, and the change of force in a step, over
/// `2 pi w R`, that is a jump.
const JUMPS_FROM: f64 = 0.8;
const JUMP: f64 = 0.25;

/// A measurement.
pub struct Measurement {
    /// Noise over `2 pi w R`, or over the greatest load without attraction.
    pub noise: f64,
    /// Spring constant over that of the tip at pull-off; infinite for a rigid instrument.
    pub spring: f64,
    /// Whether the baseline is fitted.
    pub baseline: bool,
    /// The points.
    pub samples: Vec<Sample>,
}

/// Measures a field once more, in the range of noise of a number below [`NOISES`].
pub fn measure(problem: &Problem, field: &[Point], copy: usize) -> Measurement {
    let mut random = Random(100_000 + (problem.number * NOISES.len() + copy) as u64);
    let greatest = field.iter().map(|point| point.1).fold(0.0, f64::max);
    let attracts = problem.work() > 0.0;
    let ((low, high), unit) = if attracts {
        (NOISES[copy], TAU)
    } else {
        (NOISE_WITHOUT_ATTRACTION, greatest)
    };
    let noise = random.between(low, high);
    let stretch = (PI / problem.modulus()).powf(2.0 / 3.0) + problem.work();
    let spring = if random.share() < 0.3 {
        f64::INFINITY
    } else {
        let (soft, stiff) = problem.springs();
        random.between(soft, stiff)
    };
    let stiffness = spring * unit / stretch;
    let points = random.one_of(&[80, 130, 200]);
    let way_out = random.share();
    let baseline = random.share() < 0.25;
    let offset = random.normal() * stretch;
    let deepest = field.len() / 2;
    let base: Vec<f64> = field
        .iter()
        .map(|(approach, force)| approach + force / stiffness)
        .collect();
    let first = base[0] - way_out * 0.5 * (base[deepest] - base[0]);
    let mut samples = Vec::new();
    let place = |at: usize| first + (base[deepest] - first) * at as f64 / (points - 1) as f64;
    let directions = [
        (
            Way::new(problem, field, &base, true),
            (0..points).collect::<Vec<_>>(),
        ),
        (
            Way::new(problem, field, &base, false),
            (0..points - 1).rev().collect(),
        ),
    ];
    for (way, places) in directions {
        for at in places {
            let base = place(at);
            let force = way.force(base) + noise * unit * random.normal();
            samples.push(Sample {
                approach: base - force / stiffness + offset,
                force,
            });
        }
    }
    Measurement {
        noise,
        spring,
        baseline,
        samples,
    }
}

/// The states of one direction that a moving base passes, in the order of the base: the force, and whether the next
/// state is reached without a jump.
struct Way {
    states: Vec<(f64, f64, bool)>,
    /// Force out of reach of the field: the power of the distance with which it fades.
    fades: f64,
    loading: bool,
}

impl Way {
    fn new(problem: &Problem, field: &[Point], base: &[f64], loading: bool) -> Self {
        let deepest = field.len() / 2;
        let order: Vec<usize> = if loading {
            (0..=deepest).collect()
        } else {
            (deepest..field.len()).collect()
        };
        let sign = if loading { 1.0 } else { -1.0 };
        // A base that would have to turn back jumps over these states.
        let mut kept: Vec<usize> = vec![order[0]];
        for at in order {
            if sign * (base[at] - base[kept[kept.len() - 1]]) > 0.0 {
                kept.push(at);
            }
        }
        let jumps = |one: usize, next: usize| {
            let change = (field[next].1 - field[one].1) / TAU;
            let unstable = if loading {
                change < -JUMP
            } else {
                change > JUMP
            };
            one + 1 != next || (problem.tabor > JUMPS_FROM && field[one].1 < 0.1 * TAU && unstable)
        };
        let mut states: Vec<(f64, f64, bool)> = kept
            .iter()
            .enumerate()
            .map(|(place, at)| {
                let smooth = kept.get(place + 1).is_some_and(|next| !jumps(*at, *next));
                (base[*at], field[*at].1, smooth)
            })
            .collect();
        states.dedup_by(|one, other| one.0 == other.0);
        let fades = match problem.law {
            "lennard-jones" => 2.0,
            "exponential" => 8.0,
            _ => f64::INFINITY,
        };
        Way {
            states,
            fades,
            loading,
        }
    }

    fn force(&self, base: f64) -> f64 {
        let passed = self.states.partition_point(|state| {
            if self.loading {
                state.0 <= base
            } else {
                state.0 >= base
            }
        });
        let far = if self.loading {
            self.states[0]
        } else {
            self.states[self.states.len() - 1]
        };
        let is_far = if self.loading {
            passed == 0
        } else {
            passed == self.states.len()
        };
        if is_far {
            let reach = 1.0 - far.0;
            return far.1 * (reach / (reach + far.0 - base)).powf(self.fades);
        }
        let Some(at) = passed.checked_sub(1) else {
            return self.states[0].1;
        };
        let (from, force, smooth) = self.states[at];
        match self.states.get(at + 1) {
            Some((to, next, _)) if smooth => force + (next - force) * (base - from) / (to - from),
            _ => force,
        }
    }
}
