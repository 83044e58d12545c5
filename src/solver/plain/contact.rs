//! What the method evaluates: pressures, the balance of each point, the preconditioner.

use super::waves::{Fourier, LongWaves, long_share};
use crate::elastic::Stiffness;
use crate::kernel::Params;
use crate::law::{Cohesion, imbalance};
use crate::law::{Law, LennardJones};
use crate::solver::contact::{Hold, Load};
use crate::solver::kernel_set::{fixed_params, rounded_beside_under};
use crate::solver::problem::Problem;

/// Floor of the stopping measure's pressures, over E* times the rms slope.
const LEAST_PRESSURE: f64 = 1e-6;
/// Ranges beyond which surfaces under tension have left each other.
const DETACHED_RANGES: f64 = 60.0;
/// k of the smooth law's variable over the largest stiffness.
const SMOOTH_STIFFNESS: f64 = 0.2;
/// Newton steps in the inversion of v(g).
const NEWTON_STEPS: usize = 25;

/// <a, b>.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// a/b, with 0/0 = 0.
pub fn quotient(a: f64, b: f64) -> f64 {
    if a == 0.0 { 0.0 } else { a / b }
}

/// The stopping measure with its numerator, and the least gap.
pub struct Measure {
    pub residual: f64,
    pub numerator: f64,
    pub least_gap: f64,
    /// Whether surfaces under tension have left each other.
    pub detached: bool,
}

/// A contact under a load: its convolutions and its law.
pub struct Contact<'a> {
    pub problem: &'a Problem,
    heights: Vec<f64>,
    /// Whether a point is surface; else it is of the pad.
    pub in_domain: Vec<bool>,
    /// Factor on the law's tension at each point.
    pub factor: Vec<f64>,
    fourier: Fourier,
    stiffness: Vec<f64>,
    compliance: Vec<f64>,
    long_waves: Option<LongWaves>,
    /// The prescribed mean pressure; `None` under a prescribed mean gap.
    pub mean_pressure: Option<f64>,
    /// Whether the surfaces may leave each other.
    pub may_detach: bool,
    /// Norm of what the gap is rounded beside: the heights, or what is larger.
    rounded_beside: f64,
    /// k of the smooth law's change of variable.
    smooth_stiffness: f64,
}

impl<'a> Contact<'a> {
    pub fn new(problem: &'a Problem, load: &Load) -> Self {
        let [width, rows] = problem.shape.points;
        let [nx, ny] = problem.shape.surface;
        let fourier = Fourier::new(width, rows);
        let mut stiffness = fourier.factors(|kx, ky| match &problem.stiffness {
            Stiffness::HalfSpace(half_space) => half_space.stiffness(kx, ky),
            Stiffness::Table(values) => values[kx * (rows / 2 + 1) + ky],
        });
        let mut compliance: Vec<f64> = stiffness
            .iter()
            .map(|k| if *k > 0.0 { 1.0 / k } else { 0.0 })
            .collect();
        let long_waves = LongWaves::new(problem, load.zero_compliance);
        if long_waves.is_some() {
            let pixel = problem.scales.lateral;
            let long =
                fourier.factors(|kx, ky| long_share(problem.grid.wavenumber(kx, ky) * pixel));
            compliance
                .iter_mut()
                .zip(long)
                .for_each(|(m, l)| *m *= 1.0 - l);
        }
        stiffness[0] = load.zero_stiffness;
        compliance[0] = match long_waves {
            Some(_) => 0.0,
            None => load.zero_compliance,
        };
        let mean_pressure = match load.hold {
            Hold::Pressure(pressure) => Some(pressure),
            Hold::Gap(_) => None,
        };
        let adhesive = problem.law.is_adhesive();
        let pulled = mean_pressure.is_some_and(|p| p < 0.0 || (p == 0.0 && adhesive));
        let whole = vec![1.0; nx * ny];
        let params: Params = fixed_params(problem, f64::EPSILON);
        Contact {
            problem,
            heights: problem.padded_heights().collect(),
            in_domain: (0..width * rows)
                .map(|i| i % width < nx && i / width < ny)
                .collect(),
            factor: problem.padded(problem.law_factor.as_ref().unwrap_or(&whole), 0.0),
            fourier,
            stiffness,
            compliance,
            long_waves,
            mean_pressure,
            may_detach: pulled && load.zero_stiffness == 0.0,
            rounded_beside: rounded_beside_under(params.heights_norm, &params, load),
            smooth_stiffness: SMOOTH_STIFFNESS * problem.stiffness_max(),
        }
    }

    /// K*values.
    pub fn stiffness_times(&self, values: &[f64]) -> Vec<f64> {
        self.fourier.convolve(values, &self.stiffness)
    }

    /// p = K*(g + h).
    pub fn elastic_pressure(&self, gap: &[f64]) -> Vec<f64> {
        let u: Vec<f64> = gap.iter().zip(&self.heights).map(|(g, h)| g + h).collect();
        self.stiffness_times(&u)
    }

    /// sigma(g) at a point, 0 on the pad.
    pub fn traction(&self, i: usize, gap: f64) -> f64 {
        self.factor[i] * self.problem.law.traction(gap)
    }

    /// y = p + mean pressure + sigma(g).
    pub fn imbalance(&self, gap: &[f64], pressure: &[f64], mean_pressure: f64) -> Vec<f64> {
        let at = |i: usize| imbalance(pressure[i] + mean_pressure, self.traction(i, gap[i]));
        (0..gap.len()).map(at).collect()
    }

    /// F: where g > 0 or y < 0; all points of a smooth law and of the pad.
    pub fn free(&self, gap: &[f64], y: &[f64]) -> Vec<bool> {
        let smooth = !self.problem.law.has_wall();
        let at = |i: usize| smooth || !self.in_domain[i] || gap[i] > 0.0 || y[i] < 0.0;
        (0..gap.len()).map(at).collect()
    }

    /// The mean pressure: prescribed, or -<w, p + sigma>/<w> with w the gap, for a smooth law S2: the
    /// one that holds the mean gap.
    pub fn mean_pressure(&self, gap: &[f64], pressure: &[f64]) -> f64 {
        if let Some(pressure) = self.mean_pressure {
            return pressure;
        }
        let y = self.imbalance(gap, pressure, 0.0);
        let weight: Vec<f64> = match self.problem.law {
            Law::LennardJones(_) => (0..gap.len()).map(|i| self.share(i, gap[i])).collect(),
            _ => gap.to_vec(),
        };
        let total: f64 = weight.iter().sum();
        if total > 0.0 {
            -dot(&weight, &y) / total
        } else {
            -y.iter().copied().fold(f64::INFINITY, f64::min)
        }
    }

    /// |min(y, g K_max)|, for a smooth law |y|, over the pressures that are there.
    pub fn measure(&self, gap: &[f64], y: &[f64]) -> Measure {
        let (mut violation, mut pressures) = (0.0, 0.0);
        let mut least_gap = f64::INFINITY;
        let stiffest = self.problem.stiffness_max();
        let wall = self.problem.law.has_wall();
        for i in 0..gap.len() {
            if !self.in_domain[i] {
                violation += y[i] * y[i];
                continue;
            }
            let off = if wall {
                y[i].min(gap[i] * stiffest)
            } else {
                y[i]
            };
            let reaction = if wall && gap[i] <= 0.0 {
                y[i].max(0.0)
            } else {
                0.0
            };
            violation += off * off;
            pressures += reaction * reaction + self.traction(i, gap[i]).powi(2);
            least_gap = least_gap.min(gap[i]);
        }
        let points = self.problem.shape.surface_len() as f64;
        let scales = self.problem.scales;
        let slope = self.problem.rms_slope * scales.lateral / scales.length;
        let least_pressure = LEAST_PRESSURE * slope * points.sqrt();
        let (numerator, pressures) = (violation.sqrt(), pressures.sqrt());
        // Between flat surfaces there may be no pressure at all: what rounding leaves of it is none.
        let floor = self.rounding(gap);
        let detached = self.may_detach && least_gap > DETACHED_RANGES * self.problem.law.range();
        let nothing = least_pressure == 0.0 && pressures.max(numerator) <= floor && !detached;
        Measure {
            residual: if nothing {
                0.0
            } else {
                quotient(numerator, pressures.max(least_pressure))
            },
            numerator,
            least_gap,
            detached,
        }
    }

    /// What rounding leaves of the measure's numerator.
    pub fn rounding(&self, gap: &[f64]) -> f64 {
        let on_surface = |i: &usize| self.in_domain[*i];
        let squares = (0..gap.len()).filter(on_surface).map(|i| gap[i] * gap[i]);
        let norm = squares.sum::<f64>().sqrt().max(self.rounded_beside);
        f64::EPSILON * self.problem.stiffness_max() * norm
    }

    /// 1 on F and 0 off it; for a smooth law S2, by which its variable changes with the gap.
    pub fn weight(&self, gap: &[f64], free: &[bool]) -> Vec<f64> {
        let at = |i: usize| match self.problem.law {
            Law::LennardJones(_) => self.share(i, gap[i]),
            _ => f64::from(u8::from(free[i])),
        };
        (0..gap.len()).map(at).collect()
    }

    /// z on F: the residual r times the compliance, with the long waves apart where there are two
    /// bands. For a smooth law the local stiffness D answers its part: z = M*r + D/k y/(D + k).
    pub fn precondition(
        &self,
        residual: &[f64],
        gap: &[f64],
        y: &[f64],
        free: &[bool],
    ) -> Vec<f64> {
        let mut z = self.fourier.convolve(residual, &self.compliance);
        if let Some(long_waves) = &self.long_waves {
            let long = long_waves.times(residual, free);
            z.iter_mut().zip(long).for_each(|(z, long)| *z += long);
        }
        let k = self.smooth_stiffness;
        for i in 0..z.len() {
            let stiff = self.hardening(i, gap[i]);
            z[i] += stiff / k * y[i] / (stiff + k);
            if !free[i] {
                z[i] = 0.0;
            }
        }
        z
    }

    /// Values on F; under a prescribed mean gap less their mean in the measure of a weight.
    pub fn without_mean(&self, values: &[f64], weight: &[f64], free: &[bool]) -> Vec<f64> {
        let mean = match self.mean_pressure {
            Some(_) => 0.0,
            None => quotient(dot(weight, values), weight.iter().sum()),
        };
        let at = |i: usize| if free[i] { values[i] - mean } else { 0.0 };
        (0..values.len()).map(at).collect()
    }

    /// The smooth law at a point of the surface.
    fn smooth_law(&self, i: usize) -> Option<LennardJones<f64>> {
        match self.problem.law {
            Law::LennardJones(law) if self.in_domain[i] => Some(LennardJones {
                work_of_adhesion: self.factor[i] * law.work_of_adhesion,
                range: law.range,
            }),
            _ => None,
        }
    }

    /// D = max(sigma'(g), 0), the local stiffness of a smooth law.
    fn hardening(&self, i: usize, gap: f64) -> f64 {
        self.smooth_law(i)
            .map_or(0.0, |law| law.slope(gap).max(0.0))
    }

    /// S2 = k/(k + D): dg = S2 dv.
    pub fn share(&self, i: usize, gap: f64) -> f64 {
        self.smooth_stiffness / (self.smooth_stiffness + self.hardening(i, gap))
    }

    /// v = g - (sigma_max - sigma(g))/k below the gap of largest tension, g above: in v the core is no
    /// stiffer than k.
    pub fn variable(&self, i: usize, gap: f64) -> f64 {
        match self.smooth_law(i) {
            Some(law) if gap < law.peak_gap() => {
                gap - (law.peak_tension() - law.traction(gap)) / self.smooth_stiffness
            }
            _ => gap,
        }
    }

    /// The gap of a value of v, by Newton's method from the tangent at `gap`; v is concave there, so a
    /// bound from below, which the repulsion alone gives, is all that it needs.
    pub fn gap_at(&self, i: usize, v: f64, gap: f64) -> f64 {
        let Some(law) = self.smooth_law(i).filter(|law| v < law.peak_gap()) else {
            return v;
        };
        let (k, range) = (self.smooth_stiffness, law.range);
        let load = (k * (law.peak_gap() - v) - law.peak_tension()) * 3.0 * range
            / (8.0 * law.work_of_adhesion);
        let bound = range * ((1.3 * load.max(0.0) + 2.5).powf(-1.0 / 9.0) - 1.0);
        let newton = |x: f64| {
            let next = x + (v - self.variable(i, x)) * self.share(i, x);
            next.max(bound).min(law.peak_gap())
        };
        let mut x = newton(gap);
        for _ in 0..NEWTON_STEPS {
            let last = x;
            x = newton(x);
            if (x - last).abs() <= 2.0 * f64::EPSILON * range {
                break;
            }
        }
        x
    }
}
