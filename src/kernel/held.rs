//! The trial step of a wall under a held mean gap, without a pass of its own that scales it back.
//!
//! The trial step is s = s0 + c (g + s0), with s0 = max(-g, a d) and c such that its mean is zero; c is
//! known only when s0 is. All that s is asked for follows from what s0 and g are asked for, since
//! s = (1 + c) s0 + c g, and K g = p - K h with K h the pressure of the heights, which a solve has once.
//! So one pass turns the direction, loads s0 and takes these sums, and the step adds c K (g + s0) to K s0.
//! Where a base is corrected, g is its open gap, and in place of K h stands what the pressure of the
//! correction differs by from K g: minus the pressure that the base's own gap makes.
//!
//! A mean gap is held on periodic grids alone, which have no pad.

use super::floor::{Floor, Rigid};
use super::points::{Made, Point, PointKernel};
use super::scalar::scalar_kernel;
use super::wall::{Directing, Here, step_of};
use crate::kernel::{Params, ScalarKernel, Scalars, point_kernel};
use crate::law::Cohesion;
use crate::real::Real;

/// Roundings of what they are taken from within which the parts of s cancel each other.
const VANISHES: f64 = 8.0;

/// Of the sums over s0 those of the curvature: <s0, K g> and <g, K g>.
const OF_CURVATURE: [usize; 2] = [8, 9];

/// The new direction and its trial step before the held mean gap is restored.
#[derive(Clone, Copy)]
struct TrialHeld<T, F> {
    floor: F,
    mean: T,
    directing: Directing<T>,
    length: T,
}

impl<T: Real, F: Floor<T>> PointKernel<T, 3, 1, 10> for TrialHeld<T, F> {
    #[inline(always)]
    fn of(params: &Params, scalars: &Scalars) -> Self {
        TrialHeld {
            floor: F::of(params),
            mean: T::of(scalars.mean_pressure),
            directing: Directing::of(scalars),
            length: T::of(scalars.trial),
        }
    }

    #[inline(always)]
    fn at(&self, law: &impl Cohesion<T>, point: Point<T, 3, 1>) -> Made<T, 1, 10> {
        let ([gap, pressure, rigid], [direction]) = (point.reads, point.writes);
        let on_surface = point.on_surface;
        let here = Here::at(&self.floor, law, gap, pressure + self.mean, on_surface);
        let d = self.directing.turn(point.line, direction, here.free);
        let way = [self.length * d, T::zero()];
        let (step, cut) = step_of(&self.floor, &here, way, on_surface);
        let open = here.state.open;
        let closing = (-step / open).double();
        let [s, y, g, bent] = [step, here.y, open, pressure - rigid].map(T::double);
        Made {
            writes: [d],
            line: step,
            terms: [
                s * y,
                if open > T::zero() {
                    closing
                } else {
                    f64::NEG_INFINITY
                },
                s,
                s,
                if cut { 1.0 } else { 0.0 },
                s,
                g,
                g * y,
                s * bent,
                g * bent,
            ],
        }
    }
}

point_kernel!(
    /// Turns the direction by the kept z and loads the trial step s0 as it is before the held mean gap is
    /// restored; slots of its sums as `restore_wall` and `curve_wall` read them. Reads gap, pressure, the
    /// pressure of the heights; updates direction.
    WALL_TRIAL_HELD, wall_trial_held, Resume, TrialHeld over Rigid by each_point, reads 3, writes 1,
    sums [Add, Max, Max, Min, Max, Add, Add, Add, Add, Add], gate Running
);

fn restore_wall(params: &Params, scalars: &mut Scalars) {
    if scalars.waits() {
        return;
    }
    let [slope, closing, up, down, _, step, open, open_slope, ..] = scalars.sums;
    let trial = open + step;
    let restore = if trial > 0.0 { -step / trial } else { 0.0 };
    let whole = 1.0 + restore;
    scalars.restore = restore;
    scalars.sums[0] = whole * slope + restore * open_slope;
    // s touches where -s/g is largest, and with s0/g linear so is s/g. An open point that was cut, whose -s0/g
    // is 1, touches at the step 1 exactly.
    let most = if closing < 1.0 {
        whole * closing - restore
    } else {
        1.0
    };
    let touches = open > 0.0 && most > 0.0;
    scalars.sums[1] = if touches { 1.0 / most } else { f64::INFINITY };
    if open > 0.0 && trial <= 0.0 {
        // Nothing is left of the gap that could be scaled back to the mean: the trial is lost.
        scalars.sums[0] = 0.0;
    }
    if open > 0.0 && most <= VANISHES * params.epsilon * (closing.abs() + restore.abs()) {
        // Since the sum of s is zero, -s/g is above zero somewhere unless s vanishes. Here it does but for
        // its rounding, which has no mean of zero and would be taken any distance. The direction is lost.
        scalars.sums[..4].copy_from_slice(&[0.0, f64::INFINITY, 0.0, 0.0]);
        return;
    }
    // The largest and the least s differ from these by c g. They are asked twice. Whether the step vanishes:
    // s0 = 0 has c = 0; a step that c undoes, s0 as g, has no slope and is a lost trial. And for the size of
    // the roundings that leave a point open that has closed: |c| is at most the largest s0 over the mean
    // gap, so these are too small at most by the largest gap over the mean one.
    scalars.sums[2] = whole * up;
    scalars.sums[3] = whole * down;
}
scalar_kernel!(
    /// The share of a trial gap that brings it back to the held mean, and in place of the sums over s0 those
    /// over s that `accept` reads.
    RESTORE_WALL, restore_wall
);

fn curve_wall(params: &Params, scalars: &mut Scalars) {
    if scalars.waits() || !scalars.accepted {
        return;
    }
    let restore = scalars.restore;
    let whole = 1.0 + restore;
    let [mixed, own] = OF_CURVATURE.map(|slot| scalars.sums[slot]);
    let terms = [
        whole * whole * scalars.curvature,
        2.0 * whole * restore * mixed,
        restore * restore * own,
    ];
    let [step, mixed, own] = terms;
    scalars.curvature = step + mixed + own;
    // K g is a difference of pressures that are as large as K h: where gaps are below the rounding of the
    // heights its sums have no digits left. What they make of the curvature must not be taken for a motion
    // without any; a small curvature leaves the step to where the trial was cut or a point touches.
    let least = params.epsilon * (step + mixed.abs() + own.abs());
    if scalars.curvature < least {
        scalars.curvature = least;
    }
}
scalar_kernel!(
    /// <s, K s> from <s0, K s0>, which the convolution has handed in.
    CURVE_WALL, curve_wall
);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::scalar::ACCEPT;
    use crate::kernel::wall::WALL_ADVANCE;
    use crate::kernel::{Rows, SUMS, Whole};
    use crate::law::Law;
    use std::f64::consts::TAU;

    const POINTS: usize = 48;

    /// Seeded numbers between -1 and 1.
    struct Seeded(u64);

    impl Seeded {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1);
            (self.0 >> 11) as f64 / 2f64.powi(52) - 1.0
        }
    }

    fn params() -> Params {
        Params {
            law: Law::HardWall,
            stiffness_max: POINTS as f64 / 2.0,
            pressure_floor: 0.0,
            tolerance: 0.0,
            heights_norm: 1.0,
            fixed_gap: true,
            may_detach: false,
            points: POINTS as f64,
            core_stiffness: 1.0,
            hardness: f64::INFINITY,
            epsilon: f64::EPSILON,
        }
    }

    /// K as a dense matrix, by its definition: |q| at each wave of a line, so that its mean is 0.
    fn pressed(values: &[f64]) -> Vec<f64> {
        let kernel: Vec<f64> = (0..POINTS)
            .map(|x| {
                let wave = |q: usize| {
                    let stiffness = q.min(POINTS - q) as f64;
                    stiffness * (TAU * (q * x % POINTS) as f64 / POINTS as f64).cos()
                };
                (0..POINTS).map(wave).sum::<f64>() / POINTS as f64
            })
            .collect();
        (0..POINTS)
            .map(|i| {
                let at = |j: usize| kernel[(i + POINTS - j) % POINTS] * values[j];
                (0..POINTS).map(at).sum()
            })
            .collect()
    }

    fn product(a: &[f64], b: &[f64]) -> f64 {
        a.iter().zip(b).map(|(a, b)| a * b).sum()
    }

    fn size(a: &[f64], b: &[f64]) -> f64 {
        a.iter().zip(b).map(|(a, b)| (a * b).abs()).sum()
    }

    /// A state in the middle of a solve: closed, barely open and wide open points.
    struct State {
        /// Gap of the base, 0 without one, and its y less the correction's own part.
        base: [Vec<f64>; 2],
        /// The unknown, the pressure that belongs to it, and what stands in the place of K h.
        gap: Vec<f64>,
        pressure: Vec<f64>,
        rigid: Vec<f64>,
        direction: Vec<f64>,
        lines: Vec<f64>,
        scalars: Scalars,
    }

    impl State {
        fn draw(seed: u64) -> State {
            let mut random = Seeded(seed);
            let mut draw = |make: &dyn Fn(f64) -> f64| -> Vec<f64> {
                (0..POINTS).map(|_| make(random.next())).collect()
            };
            // One point in ten is barely open, in some states only: it is cut by any step down.
            let least = if seed.is_multiple_of(3) { 0.3 } else { 1e-7 };
            let open = draw(&|x| match x {
                x if x < -0.2 => 0.0,
                x if x < 0.0 => least * (0.1 - x),
                x => least + 3.0 * x,
            });
            let heights = draw(&|x| 2.0 * x);
            let (direction, lines) = (draw(&|x| x), draw(&|x| x));
            let [shift, length, memory] = [0.6, 1.0, 1.0].map(|scale| scale * draw(&|x| x)[0]);
            let of_heights = pressed(&heights);
            let displaced: Vec<f64> = open.iter().zip(&heights).map(|(g, h)| g + h).collect();
            let whole = pressed(&displaced);
            let mean_pressure = -product(&open, &whole) / open.iter().sum::<f64>();
            let scalars = Scalars {
                descent: -1.0,
                memory,
                shift,
                trial: 10f64.powf(2.0 * length - 0.5),
                ..Scalars::start(mean_pressure, false)
            };
            let state = State {
                base: [Vec::new(), Vec::new()],
                gap: open,
                pressure: whole,
                rigid: of_heights,
                direction,
                lines,
                scalars,
            };
            match seed % 2 {
                0 => state,
                // The same contact as a correction of a base: of all but a part of the gap.
                _ => state.corrected(draw(&|x| x)),
            }
        }

        fn corrected(self, parts: Vec<f64>) -> State {
            let part = |share: f64| share.max(0.0) * 1e-3;
            let gap: Vec<f64> = self
                .gap
                .iter()
                .zip(&parts)
                .map(|(g, x)| part(*x) * g)
                .collect();
            let base: Vec<f64> = self.gap.iter().zip(&gap).map(|(g, c)| g - c).collect();
            let pressure = pressed(&gap);
            let mean = self.scalars.mean_pressure;
            let total = self
                .pressure
                .iter()
                .zip(&pressure)
                .map(|(p, c)| p - c + mean);
            State {
                base: [base.clone(), total.collect()],
                gap,
                pressure,
                rigid: pressed(&base).iter().map(|p| -p).collect(),
                scalars: Scalars {
                    mean_pressure: 0.0,
                    ..self.scalars
                },
                ..self
            }
        }

        fn open(&self) -> Vec<f64> {
            match self.base[0].is_empty() {
                true => self.gap.clone(),
                false => self
                    .gap
                    .iter()
                    .zip(&self.base[0])
                    .map(|(c, g)| g + c)
                    .collect(),
            }
        }

        fn run(&mut self, kernel: &'static crate::kernel::Kernel) {
            let before = &mut vec![0.0; POINTS][..];
            let mut sums = [0.0; SUMS];
            for (sum, reduce) in sums.iter_mut().zip(kernel.sums) {
                *sum = reduce.neutral();
            }
            let tries = std::ptr::eq(kernel, &WALL_TRIAL_HELD);
            let (gap, pressure) = (self.gap.clone(), self.pressure.clone());
            let old = self.direction.clone();
            let nothing = || -> &mut [f64] { &mut [] };
            let mut rows = Rows {
                first: 0,
                width: POINTS,
                count: 1,
                surface: [POINTS, 1],
                lines: &mut self.lines,
                reads: match tries {
                    true => [&gap, &pressure, &self.rigid, &[]],
                    false => [&old, &self.rigid, &[], &[]],
                },
                writes: match tries {
                    true => [&mut self.direction, nothing(), nothing(), nothing()],
                    false => [&mut self.gap, &mut self.pressure, before, nothing()],
                },
                whole: Whole {
                    values: &[],
                    points: [0, 0],
                },
                factor: &[],
                base: [&self.base[0], &self.base[1]],
                reduces: kernel.sums,
            };
            (kernel.twin)(&mut rows, &params(), &self.scalars, &mut sums);
            self.scalars.sums = sums;
        }
    }

    /// Slope, curvature, step to first contact and the mean of the trial step s as they follow from s0, against
    /// those taken from s itself; and the pressure after a step along s against K of the gap there. All of
    /// it in double precision, in which sums of 48 terms, or of 48 squared, err by some tens of roundings of
    /// their size.
    #[test]
    fn what_is_asked_of_the_restored_step_follows_from_the_step_before_it() {
        let rounding = 500.0 * f64::EPSILON;
        // Cut, uncut and lost trials; shares to restore above and below zero.
        let mut met = [0; 5];
        for seed in 0..400 {
            let mut state = State::draw(seed);
            let mean = state.scalars.mean_pressure;
            let open = state.open();
            state.run(&WALL_TRIAL_HELD);
            let (d, first) = (state.direction.clone(), state.lines.clone());
            let length = state.scalars.trial;
            let uncut: Vec<f64> = d.iter().map(|d| length * d).collect();
            let expected: Vec<f64> = open.iter().zip(&uncut).map(|(g, m)| m.max(-g)).collect();
            assert_eq!(first, expected, "{seed}");
            let [gaps, steps] = [&open, &first].map(|values| values.iter().sum::<f64>());
            let restore = -steps / (gaps + steps);
            let s: Vec<f64> = open
                .iter()
                .zip(&first)
                .map(|(g, s)| s + restore * (g + s))
                .collect();
            let y: Vec<f64> = (0..POINTS)
                .map(|i| state.pressure[i] + mean + state.base[1].get(i).unwrap_or(&0.0))
                .collect();
            let cut = open.iter().zip(&uncut).any(|(g, moved)| g + moved < 0.0);
            let bent = pressed(&s);

            state.scalars.curvature = product(&first, &pressed(&first));
            let params = params();
            (RESTORE_WALL.run)(&params, &mut state.scalars);
            (ACCEPT.run)(&params, &mut state.scalars);
            let scalars = state.scalars;
            assert!((scalars.restore - restore).abs() <= rounding, "{seed}");
            let slope = product(&s, &y);
            // The closed points' y is no part of it: s is zero there.
            let slope_size = size(&first, &y) + size(&open, &y);
            assert!(
                (scalars.slope - slope).abs() <= rounding * slope_size,
                "{seed}"
            );
            let touch = open
                .iter()
                .zip(&s)
                .filter(|(_, s)| **s < 0.0)
                .map(|(g, s)| g / -s)
                .fold(f64::INFINITY, f64::min);
            assert_eq!(scalars.truncated, cut, "{seed}");
            // A closed point that would go on down is cut too, and does not move.
            let closes = open.iter().zip(&first).any(|(g, s)| *g > 0.0 && *s == -g);
            if closes {
                assert_eq!(scalars.step_first, 1.0, "{seed}");
                assert!((touch - 1.0).abs() <= rounding * touch, "{seed}");
            } else if touch.is_finite() {
                // Its inverse is the sum of a share and c, which may all but cancel.
                let apart = (1.0 / scalars.step_first - 1.0 / touch).abs();
                assert!(apart <= rounding, "{seed}: {} {touch}", scalars.step_first);
            } else {
                assert!(1.0 / scalars.step_first <= rounding, "{seed}");
            }
            met[0] += usize::from(closes);
            met[1] += usize::from(!closes);
            met[2] += usize::from(restore > 0.01);
            met[3] += usize::from(restore < -0.01);
            if !scalars.accepted {
                met[4] += 1;
                continue;
            }
            (CURVE_WALL.run)(&params, &mut state.scalars);
            let curvature = product(&s, &bent);
            let widest = [&s, &first, &open]
                .map(|values| product(values, values))
                .into_iter()
                .fold(0.0, f64::max);
            let error = (state.scalars.curvature - curvature).abs();
            assert!(
                error <= rounding * params.stiffness_max * widest,
                "{seed}: {} {curvature}",
                state.scalars.curvature
            );

            let t = 0.7;
            state.scalars.step = t;
            let (before, pressure) = (state.gap.clone(), state.pressure.clone());
            state.lines = pressed(&first);
            state.run(&WALL_ADVANCE);
            let after = state.open();
            let held = after.iter().sum::<f64>() - gaps;
            assert!(
                held.abs() <= rounding * size(&s, &vec![1.0; POINTS]).max(gaps),
                "{seed}"
            );
            for i in 0..POINTS {
                let moved = pressure[i] + t * bent[i];
                let scale = params.stiffness_max * widest.sqrt() + pressure[i].abs();
                assert!(
                    (state.pressure[i] - moved).abs() <= rounding * scale,
                    "{seed}"
                );
                let gap = before[i] + t * s[i];
                assert!(
                    (state.gap[i] - gap).abs() <= rounding * widest.sqrt(),
                    "{seed}"
                );
            }
        }
        println!("cut, uncut, c above and below 0, lost: {met:?}");
        assert!(met.iter().all(|&count| count >= 30), "{met:?}");
    }
}
