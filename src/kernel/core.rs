//! Kernels of the Lennard-Jones law, whose steep core takes the place of the wall.
//!
//! Below the gap of largest tension the iteration works in `v = g - (sigma_max - sigma(g))/k`,
//! in which the core is no stiffer than `k`. With D = max(sigma'(g), 0) the change of variable is
//! dg = S2 dv, S2 = k/(k + D). Points of a pad have no law: S2 = 1.

use crate::kernel::{Params, Rows, SUMS, Scalars, kernel};
use crate::law::{Cohesion, Law, LennardJones};
use crate::real::Real;

/// Largest number of Newton steps in the inversion of v(g).
const NEWTON_STEPS: usize = 25;

/// The law, its variable and their constants in the kernel's number.
#[derive(Clone, Copy)]
struct Core<T> {
    law: LennardJones<T>,
    /// k.
    stiffness: T,
    /// sigma_max.
    peak: T,
    /// Gap of the largest tension.
    peak_gap: T,
    /// Where the inversion stops.
    precision: T,
}

impl<T: Real> Core<T> {
    /// The core at a point of a block with these factors on its tension, if there are any.
    #[inline(always)]
    fn at(mut self, factor: &[T], index: usize) -> Self {
        if let Some(&factor) = factor.get(index) {
            self.law.work_of_adhesion = factor * self.law.work_of_adhesion;
            self.peak = factor * self.peak;
        }
        self
    }

    fn new(params: &Params) -> Self {
        let law = match params.law {
            Law::LennardJones(law) => law,
            // Other laws have a wall and never come here; any constants keep this total.
            _ => LennardJones {
                work_of_adhesion: 1.0,
                range: 1.0,
            },
        };
        Core {
            law: law.cast(),
            stiffness: T::of(params.core_stiffness),
            peak: T::of(law.peak_tension()),
            peak_gap: T::of(law.peak_gap()),
            precision: T::of(2.0 * params.epsilon * law.range),
        }
    }

    /// D at a gap.
    #[inline(always)]
    fn hardening(&self, gap: T) -> T {
        self.law.slope(gap).max(T::zero())
    }

    /// S2 at a gap; 1 on a pad.
    #[inline(always)]
    fn share(&self, gap: T, on_surface: bool) -> T {
        if on_surface {
            self.stiffness / (self.stiffness + self.hardening(gap))
        } else {
            T::one()
        }
    }

    #[inline(always)]
    fn variable(&self, gap: T) -> T {
        if gap < self.peak_gap {
            gap - (self.peak - self.law.traction(gap)) / self.stiffness
        } else {
            gap
        }
    }

    /// The gap at a value of v, by Newton's method from the tangent at `gap`.
    fn gap_at(&self, target: T, gap: T) -> T {
        if target >= self.peak_gap {
            return target;
        }
        // v is concave here: from the left every step stays on the left of the root, so only the
        // start needs a bound, which the repulsive power alone gives.
        let load = ((self.stiffness * (self.peak_gap - target) - self.peak)
            * T::of(3.0 / 8.0)
            * self.law.range
            / self.law.work_of_adhesion)
            .max(T::zero());
        let bound =
            self.law.range * ((T::of(1.3) * load + T::of(2.5)).powf(T::of(-1.0 / 9.0)) - T::one());
        let mut x = gap + (target - self.variable(gap)) * self.share(gap, true);
        x = x.max(bound).min(self.peak_gap);
        for _ in 0..NEWTON_STEPS {
            let error = self.variable(x) - target;
            let next = (x - error * self.share(x, true))
                .max(bound)
                .min(self.peak_gap);
            let moved = (next - x).abs();
            x = next;
            if moved <= self.precision {
                break;
            }
        }
        x
    }
}

fn add_core_residual<T: Real>(sums: &mut [f64; SUMS], gap: T, y: T, traction: T, on_surface: bool) {
    let y = y.double();
    sums[0] += y * y;
    if on_surface {
        let traction = traction.double();
        sums[1] += traction * traction;
        let gap = gap.double();
        if gap < sums[2] {
            sums[2] = gap;
        }
        sums[3] += gap * gap;
    }
}

fn core_residual<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let core = Core::<T>::new(params);
    let factor = rows.factor;
    let [gap, pressure, ..] = rows.reads;
    let mean = T::of(scalars.mean_pressure);
    layout.points(|i, on_surface| {
        let core = core.at(factor, i);
        let traction = if on_surface {
            core.law.traction(gap[i])
        } else {
            T::zero()
        };
        add_core_residual(
            sums,
            gap[i],
            pressure[i] + mean + traction,
            traction,
            on_surface,
        );
    });
}
kernel!(
    /// The stopping measure of the present state. Reads gap, pressure.
    CORE_RESIDUAL, core_residual, Sweep, reads 2, writes 0, whole false,
    sums [Add, Add, Min, Add], gate Always
);

fn core_free<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let core = Core::<T>::new(params);
    let factor = rows.factor;
    let [gap, pressure, ..] = rows.reads;
    let lines = &mut *rows.lines;
    let mean = T::of(scalars.mean_pressure);
    layout.points(|i, on_surface| {
        let core = core.at(factor, i);
        let traction = if on_surface {
            core.law.traction(gap[i])
        } else {
            T::zero()
        };
        let y = pressure[i] + mean + traction;
        add_core_residual(sums, gap[i], y, traction, on_surface);
        lines[i] = core.share(gap[i], on_surface) * y;
    });
}
kernel!(
    /// Loads S2 y and sums the stopping measure on the way. Reads gap, pressure.
    CORE_FREE, core_free, Load, reads 2, writes 0, whole false,
    sums [Add, Add, Min, Add], gate Fresh
);

fn core_descent<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let core = Core::<T>::new(params);
    let factor = rows.factor;
    let [gap, pressure, direction, _] = rows.reads;
    let lines = &*rows.lines;
    let [z_out, y_before, _] = &mut rows.writes;
    let mean = T::of(scalars.mean_pressure);
    layout.points(|i, on_surface| {
        let core = core.at(factor, i);
        let (traction, hardening) = if on_surface {
            (core.law.traction(gap[i]), core.hardening(gap[i]))
        } else {
            (T::zero(), T::zero())
        };
        let y = pressure[i] + mean + traction;
        let share = core.stiffness / (core.stiffness + hardening);
        // z / S2: the long-range part, and the local part that the core's own stiffness answers.
        let z = lines[i] + hardening / core.stiffness * y / (hardening + core.stiffness);
        let y = share * y;
        let (zd, yd, d) = (z.double(), y.double(), direction[i].double());
        let change = yd - y_before[i].double();
        let s2 = share.double();
        sums[0] += zd * yd;
        sums[1] += zd * change;
        sums[2] += d * change;
        sums[3] += d * yd;
        sums[4] += s2 * zd;
        sums[5] += s2;
        sums[6] += yd;
        sums[7] += change;
        sums[8] += s2 * d;
        z_out[i] = z;
        y_before[i] = y;
    });
}
kernel!(
    /// Stores the preconditioned residual in v. Reads gap, pressure, direction; writes z and
    /// replaces the old S2 y by the new one.
    CORE_DESCENT, core_descent, Store, reads 3, writes 2, whole false,
    sums [Add, Add, Add, Add, Add, Add, Add, Add, Add], gate Fresh
);

fn core_direct<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let core = Core::<T>::new(params);
    let factor = rows.factor;
    let [gap, z, ..] = rows.reads;
    let [direction, step, _] = &mut rows.writes;
    let factors = [scalars.descent, scalars.memory, scalars.shift].map(T::of);
    let length = T::of(scalars.trial);
    layout.points(|i, on_surface| {
        let core = core.at(factor, i);
        let d = factors[0] * z[i] + factors[1] * direction[i] + factors[2];
        direction[i] = d;
        let s = if on_surface {
            core.gap_at(core.variable(gap[i]) + length * d, gap[i]) - gap[i]
        } else {
            length * d
        };
        step[i] = s;
        sums[0] += s.double();
        sums[1] += core.share(gap[i] + s, on_surface).double();
    });
}
kernel!(
    /// Turns the direction and finds the trial step by inverting v. Reads gap, z; updates
    /// direction, writes step.
    CORE_DIRECT, core_direct, Sweep, reads 2, writes 2, whole false,
    sums [Add, Add], gate Running
);

fn core_trial<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let core = Core::<T>::new(params);
    let factor = rows.factor;
    let [gap, pressure, ..] = rows.reads;
    let step = &mut *rows.writes[0];
    let lines = &mut *rows.lines;
    let mean = T::of(scalars.mean_pressure);
    let restore = T::of(scalars.restore);
    layout.points(|i, on_surface| {
        let core = core.at(factor, i);
        let mut s = step[i];
        if restore != T::zero() {
            s -= restore * core.share(gap[i] + s, on_surface);
        }
        step[i] = s;
        lines[i] = s;
        let elastic = pressure[i] + mean;
        let traction = if on_surface {
            core.law.traction(gap[i])
        } else {
            T::zero()
        };
        let s = s.double();
        sums[0] += s * (elastic + traction).double();
        if s > sums[2] {
            sums[2] = s;
        }
        if s < sums[3] {
            sums[3] = s;
        }
        sums[5] += s * elastic.double();
    });
}
kernel!(
    /// Loads the trial step, with its mean taken off in proportion to the local compliance where
    /// the mean gap is held. Reads gap, pressure; updates step.
    CORE_TRIAL, core_trial, Load, reads 2, writes 1, whole false,
    sums [Add, Min, Max, Min, Max, Add], gate Running
);

fn core_search<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let core = Core::<T>::new(params);
    let factor = rows.factor;
    let [gap, step, ..] = rows.reads;
    let t = T::of(scalars.step);
    layout.points(|i, on_surface| {
        let core = core.at(factor, i);
        if on_surface {
            let moved = gap[i] + t * step[i];
            let change = core.law.traction(moved) - core.law.traction(gap[i]);
            let energy = core.law.energy(gap[i]);
            sums[0] += change.double() * step[i].double();
            sums[1] += (core.law.energy(moved) - energy).double();
            sums[2] += energy.double().abs();
        }
    });
}
kernel!(
    /// Sums `<sigma(g + t s) - sigma(g), s>`, the change of the energy of adhesion and its size.
    /// Reads gap, step.
    CORE_SEARCH, core_search, Sweep, reads 2, writes 0, whole false,
    sums [Add, Add, Add], gate Searching
);

fn core_advance<T: Real>(rows: &mut Rows<T>, _: &Params, scalars: &Scalars, _: &mut [f64; SUMS]) {
    let count = rows.len();
    let step = &rows.reads[0][..count];
    let lines = &rows.lines[..count];
    let [gap, pressure, _] = &mut rows.writes;
    let t = T::of(scalars.step);
    for i in 0..count {
        gap[i] += t * step[i];
        pressure[i] += t * lines[i];
    }
}
kernel!(
    /// Takes K s and steps: g += t s, p += t K s. Reads step; updates gap, pressure.
    CORE_ADVANCE, core_advance, Store, reads 1, writes 2, whole false,
    sums [], gate Accepted
);

fn core_balance<T: Real>(rows: &mut Rows<T>, params: &Params, _: &Scalars, sums: &mut [f64; SUMS]) {
    let layout = rows.layout();
    let core = Core::<T>::new(params);
    let factor = rows.factor;
    let [gap, pressure, ..] = rows.reads;
    layout.points(|i, on_surface| {
        let core = core.at(factor, i);
        let share = core.share(gap[i], on_surface);
        let traction = if on_surface {
            core.law.traction(gap[i])
        } else {
            T::zero()
        };
        sums[0] += (share * (pressure[i] + traction)).double();
        sums[1] += share.double();
    });
}
kernel!(
    /// The sums that give the mean pressure under a held mean gap. Reads gap, pressure.
    CORE_BALANCE, core_balance, Sweep, reads 2, writes 0, whole false,
    sums [Add, Add], gate Running
);
