//! Kernels of the Lennard-Jones law, whose steep core takes the place of the wall.
//!
//! Below the gap of largest tension the iteration works in `v = g - (sigma_max - sigma(g))/k`,
//! in which the core is no stiffer than `k`. With D = max(sigma'(g), 0) the change of variable is
//! dg = S2 dv, S2 = k/(k + D). Points of a pad have no law: S2 = 1.

use crate::kernel::{Params, Rows, SUMS, Scalars, kernel};
use crate::law::{Cohesion, Correction, Law, LennardJones};
use crate::real::Real;

/// Largest number of Newton steps in the inversion of v(g).
const NEWTON_STEPS: usize = 25;

/// The law, its variable and their constants in the kernel's number. With `BASE` the unknown is the
/// correction of a known gap (see [`crate::law::Correction`]).
#[derive(Clone, Copy)]
pub(super) struct Core<T, const BASE: bool> {
    law: LennardJones<T>,
    /// k.
    stiffness: T,
    /// sigma_max.
    peak: T,
    /// Gap of the largest tension.
    peak_gap: T,
    /// Where the inversion stops.
    precision: T,
    /// Gap and residual of the base at the point.
    base: [T; 2],
}

/// Gives a twin the kind of core that its rows ask for.
macro_rules! with_or_without_base {
    ($twin:ident, $inner:ident) => {
        fn $twin<T: Real>(
            rows: &mut Rows<T>,
            params: &Params,
            scalars: &Scalars,
            sums: &mut [f64; SUMS],
        ) {
            if rows.base[0].is_empty() {
                $inner::<T, false>(rows, params, scalars, sums);
            } else {
                $inner::<T, true>(rows, params, scalars, sums);
            }
        }
    };
}

impl<T: Real, const BASE: bool> Core<T, BASE> {
    /// The core at a point of a block with these factors on its tension and this base, if there are
    /// any.
    #[inline(always)]
    pub(super) fn at(mut self, factor: &[T], base: [&[T]; 2], index: usize) -> Self {
        if BASE {
            self.base = [base[0][index], base[1][index]];
        }
        if let Some(&factor) = factor.get(index) {
            self.law.work_of_adhesion = factor * self.law.work_of_adhesion;
            self.peak = factor * self.peak;
        }
        self
    }

    pub(super) fn new(params: &Params) -> Self {
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
            base: [T::zero(); 2],
        }
    }

    /// The gap itself.
    #[inline(always)]
    fn open(&self, gap: T) -> T {
        if BASE { self.base[0] + gap } else { gap }
    }

    /// sigma at a gap; around a base all of y that does not come from the correction's own pressure.
    #[inline(always)]
    fn attraction(&self, gap: T, on_surface: bool) -> T {
        match (BASE, on_surface) {
            (false, false) => T::zero(),
            (false, true) => self.law.traction(gap),
            (true, false) => self.base[1],
            (true, true) => self.base[1] + self.law.difference(self.base[0], gap),
        }
    }

    /// What a step changes: the traction, and the energy with its size.
    #[inline(always)]
    fn changes(&self, gap: T, step: T) -> (T, [T; 2]) {
        if BASE {
            let here = Correction {
                law: self.law,
                factor: T::one(),
                gap: self.base[0],
                residual: self.base[1],
            };
            (here.change(gap, step), here.energy_change(gap, step))
        } else {
            (
                self.law.change(gap, step),
                self.law.energy_change(gap, step),
            )
        }
    }

    /// D at a gap.
    #[inline(always)]
    fn hardening(&self, gap: T) -> T {
        self.law.slope(self.open(gap)).max(T::zero())
    }

    /// S2 at a gap; 1 on a pad.
    #[inline(always)]
    pub(super) fn share(&self, gap: T, on_surface: bool) -> T {
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

/// The terms of the stopping measure at one point. Around a base its scale is the base's.
fn add_residual<T: Real, const BASE: bool>(
    sums: &mut [f64; SUMS],
    core: &Core<T, BASE>,
    gap: T,
    y: T,
    traction: T,
    on_surface: bool,
) {
    let y = y.double();
    sums[0] += y * y;
    if on_surface {
        if !BASE {
            let traction = traction.double();
            sums[1] += traction * traction;
        }
        let open = core.open(gap).double();
        if open < sums[2] {
            sums[2] = open;
        }
        let gap = gap.double();
        sums[3] += gap * gap;
    }
}

with_or_without_base!(core_residual, residual);

fn residual<T: Real, const BASE: bool>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let core = Core::<T, BASE>::new(params);
    let (factor, base) = (rows.factor, rows.base);
    let [gap, pressure, ..] = rows.reads;
    let mean = T::of(scalars.mean_pressure);
    layout.points(|i, on_surface| {
        let core = core.at(factor, base, i);
        let traction = core.attraction(gap[i], on_surface);
        add_residual(
            sums,
            &core,
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

with_or_without_base!(core_free, free);

fn free<T: Real, const BASE: bool>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let core = Core::<T, BASE>::new(params);
    let (factor, base) = (rows.factor, rows.base);
    let [gap, pressure, ..] = rows.reads;
    let lines = &mut *rows.lines;
    let mean = T::of(scalars.mean_pressure);
    layout.points(|i, on_surface| {
        let core = core.at(factor, base, i);
        let traction = core.attraction(gap[i], on_surface);
        let y = pressure[i] + mean + traction;
        add_residual(sums, &core, gap[i], y, traction, on_surface);
        lines[i] = core.share(gap[i], on_surface) * y;
    });
}
kernel!(
    /// Loads S2 y and sums the stopping measure on the way. Reads gap, pressure.
    CORE_FREE, core_free, Load, reads 2, writes 0, whole false,
    sums [Add, Add, Min, Add], gate Fresh
);

with_or_without_base!(core_descent, descent);

fn descent<T: Real, const BASE: bool>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let core = Core::<T, BASE>::new(params);
    let (factor, base) = (rows.factor, rows.base);
    let [gap, pressure, direction, _] = rows.reads;
    let lines = &*rows.lines;
    let [z_out, y_before, _] = &mut rows.writes;
    let mean = T::of(scalars.mean_pressure);
    layout.points(|i, on_surface| {
        let core = core.at(factor, base, i);
        let traction = core.attraction(gap[i], on_surface);
        let hardening = if on_surface {
            core.hardening(gap[i])
        } else {
            T::zero()
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

with_or_without_base!(core_direct, direct);

fn direct<T: Real, const BASE: bool>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let core = Core::<T, BASE>::new(params);
    let (factor, base) = (rows.factor, rows.base);
    let [gap, z, ..] = rows.reads;
    let [direction, step, _] = &mut rows.writes;
    let factors = [scalars.descent, scalars.memory, scalars.shift].map(T::of);
    let length = T::of(scalars.trial);
    layout.points(|i, on_surface| {
        let core = core.at(factor, base, i);
        let d = factors[0] * z[i] + factors[1] * direction[i] + factors[2];
        direction[i] = d;
        let s = if !on_surface {
            length * d
        } else if BASE {
            // A correction is short: v follows its slope.
            core.share(gap[i], true) * length * d
        } else {
            core.gap_at(core.variable(gap[i]) + length * d, gap[i]) - gap[i]
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

with_or_without_base!(core_trial, trial);

fn trial<T: Real, const BASE: bool>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let core = Core::<T, BASE>::new(params);
    let (factor, base) = (rows.factor, rows.base);
    let [gap, pressure, ..] = rows.reads;
    let step = &mut *rows.writes[0];
    let lines = &mut *rows.lines;
    let mean = T::of(scalars.mean_pressure);
    let restore = T::of(scalars.restore);
    layout.points(|i, on_surface| {
        let core = core.at(factor, base, i);
        let mut s = step[i];
        if restore != T::zero() {
            s -= restore * core.share(gap[i] + s, on_surface);
        }
        step[i] = s;
        lines[i] = s;
        let elastic = pressure[i] + mean;
        let traction = core.attraction(gap[i], on_surface);
        let s = s.double();
        sums[0] += s * (elastic + traction).double();
        if s > sums[2] {
            sums[2] = s;
        }
        if s < sums[3] {
            sums[3] = s;
        }
        // On a pad a base's residual is no law's: the search will not count it.
        sums[5] += if on_surface {
            s * elastic.double()
        } else {
            s * (elastic + traction).double()
        };
    });
}
kernel!(
    /// Loads the trial step, with its mean taken off in proportion to the local compliance where
    /// the mean gap is held. Reads gap, pressure; updates step.
    CORE_TRIAL, core_trial, Load, reads 2, writes 1, whole false,
    sums [Add, Min, Max, Min, Max, Add], gate Running
);

with_or_without_base!(core_search, search);

fn search<T: Real, const BASE: bool>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let core = Core::<T, BASE>::new(params);
    let (factor, base) = (rows.factor, rows.base);
    let [gap, step, ..] = rows.reads;
    let t = T::of(scalars.step);
    layout.points(|i, on_surface| {
        let core = core.at(factor, base, i);
        if on_surface {
            let (change, [energy, size]) = core.changes(gap[i], t * step[i]);
            sums[0] += change.double() * step[i].double();
            sums[1] += energy.double();
            sums[2] += size.double();
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

with_or_without_base!(core_balance, balance);

fn balance<T: Real, const BASE: bool>(
    rows: &mut Rows<T>,
    params: &Params,
    _: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let core = Core::<T, BASE>::new(params);
    let (factor, base) = (rows.factor, rows.base);
    let [gap, pressure, ..] = rows.reads;
    layout.points(|i, on_surface| {
        let core = core.at(factor, base, i);
        let share = core.share(gap[i], on_surface);
        let traction = core.attraction(gap[i], on_surface);
        sums[0] += (share * (pressure[i] + traction)).double();
        sums[1] += share.double();
    });
}
kernel!(
    /// The sums that give the mean pressure under a held mean gap. Reads gap, pressure.
    CORE_BALANCE, core_balance, Sweep, reads 2, writes 0, whole false,
    sums [Add, Add], gate Running
);
