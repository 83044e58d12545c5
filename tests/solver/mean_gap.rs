//! The trial step under a prescribed mean gap, by linearity, against the step itself.

use std::f64::consts::TAU;

use tabor::kernel::mean_gap::{CURVATURE_BY_LINEARITY, RESTORE_MEAN_GAP};
use tabor::kernel::scalar::ACCEPT_TRIAL;
use tabor::kernel::trial::LINEAR_TRIAL;
use tabor::kernel::update::ADVANCE;
use tabor::kernel::{Kernel, Params, Rows, SUMS, Scalars, Whole};
use tabor::law::Law;

use crate::shared::trials::tests;

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
        prescribed_mean_gap: true,
        may_detach: false,
        points: POINTS as f64,
        smooth_stiffness: 1.0,
        level_compliance: 1.0,
        own_compliance: 0.75,
        neighbour_compliance: 0.062,
        softening: 0.7,
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
    /// Gap of the base, empty without one.
    outer_gap: Vec<f64>,
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
        let [shift, length, beta] = [0.6, 1.0, 1.0].map(|scale| scale * draw(&|x| x)[0]);
        let of_heights = pressed(&heights);
        let displaced: Vec<f64> = open.iter().zip(&heights).map(|(g, h)| g + h).collect();
        let whole = pressed(&displaced);
        let mean_pressure = -product(&open, &whole) / open.iter().sum::<f64>();
        let scalars = Scalars {
            descent_factor: -1.0,
            beta,
            mean_gap_shift: shift,
            trial_length: 10f64.powf(2.0 * length - 0.5),
            ..Scalars::start(mean_pressure, false)
        };
        let state = State {
            outer_gap: Vec::new(),
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
        // The pressure starts at that of the base with the mean pressure, and K (base + c) is what it differs by from
        // what stands in the place of K h.
        let mean = self.scalars.mean_pressure;
        let pressure: Vec<f64> = self.pressure.iter().map(|p| p + mean).collect();
        let of_open = pressed(&self.gap);
        let rigid = pressure.iter().zip(&of_open).map(|(p, own)| p - own);
        State {
            outer_gap: base,
            gap,
            rigid: rigid.collect(),
            pressure,
            scalars: Scalars {
                mean_pressure: 0.0,
                ..self.scalars
            },
            ..self
        }
    }

    fn open(&self) -> Vec<f64> {
        match self.outer_gap.is_empty() {
            true => self.gap.clone(),
            false => self
                .gap
                .iter()
                .zip(&self.outer_gap)
                .map(|(c, g)| g + c)
                .collect(),
        }
    }

    fn run(&mut self, kernel: &'static Kernel) {
        let before = &mut vec![0.0; POINTS][..];
        let mut sums = [0.0; SUMS];
        for (sum, reduce) in sums.iter_mut().zip(kernel.reduces) {
            *sum = reduce.neutral();
        }
        let tries = std::ptr::eq(kernel, &LINEAR_TRIAL);
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
            whole: Whole::none(),
            around: Whole::none(),
            factor: &[],
            outer_gap: &self.outer_gap,
            reduces: kernel.reduces,
        };
        (kernel.twin)(&mut rows, &params(), &self.scalars, &mut sums);
        for (&sum, value) in kernel.sums.iter().zip(sums) {
            self.scalars.sums.set(sum, value);
        }
    }
}

/// Slope, curvature, step to first contact and the mean of the trial step s as they follow from s0, against
/// those taken from s itself; and the pressure after a step along s against K of the gap there. All of
/// it in double precision, in which sums of 48 terms, or of 48 squared, err by some tens of roundings of
/// their size.
fn restored_step_follows_by_linearity_from_the_step_before_it() {
    let rounding = 500.0 * f64::EPSILON;
    // Cut, uncut and lost trials; shares to restore above and below zero.
    let mut met = [0; 5];
    for seed in 0..400 {
        let mut state = State::draw(seed);
        let mean = state.scalars.mean_pressure;
        let open = state.open();
        state.run(&LINEAR_TRIAL);
        let (d, first) = (state.direction.clone(), state.lines.clone());
        let length = state.scalars.trial_length;
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
        let y: Vec<f64> = (0..POINTS).map(|i| state.pressure[i] + mean).collect();
        let cut = open.iter().zip(&uncut).any(|(g, moved)| g + moved < 0.0);
        let bent = pressed(&s);

        state.scalars.curvature = product(&first, &pressed(&first));
        let params = params();
        (RESTORE_MEAN_GAP.run)(&params, &mut state.scalars);
        (ACCEPT_TRIAL.run)(&params, &mut state.scalars);
        let scalars = state.scalars;
        assert!(
            (scalars.mean_gap_correction - restore).abs() <= rounding,
            "{seed}"
        );
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
        assert_eq!(scalars.cut, cut, "{seed}");
        // A closed point that would go on down is cut too, and does not move.
        let closes = open.iter().zip(&first).any(|(g, s)| *g > 0.0 && *s == -g);
        if closes {
            assert_eq!(scalars.first_touch, 1.0, "{seed}");
            assert!((touch - 1.0).abs() <= rounding * touch, "{seed}");
        } else if touch.is_finite() {
            // Its inverse is the sum of a share and c, which may all but cancel.
            let apart = (1.0 / scalars.first_touch - 1.0 / touch).abs();
            assert!(apart <= rounding, "{seed}: {} {touch}", scalars.first_touch);
        } else {
            assert!(1.0 / scalars.first_touch <= rounding, "{seed}");
        }
        met[0] += usize::from(closes);
        met[1] += usize::from(!closes);
        met[2] += usize::from(restore > 0.01);
        met[3] += usize::from(restore < -0.01);
        if !scalars.accepted {
            met[4] += 1;
            continue;
        }
        (CURVATURE_BY_LINEARITY.run)(&params, &mut state.scalars);
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
        state.run(&ADVANCE[0]);
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

tests![restored_step_follows_by_linearity_from_the_step_before_it];
