//! Kernels of the Lennard-Jones law, whose steep core takes the place of the wall.
//!
//! Below the gap of largest tension the iteration works in `v = g - (sigma_max - sigma(g))/k`,
//! in which the core is no stiffer than `k`. With D = max(sigma'(g), 0) the change of variable is
//! dg = S2 dv, S2 = k/(k + D). Points of a pad have no law: S2 = 1.

pub use super::core_step::{CORE_ADVANCE, CORE_BALANCE, CORE_TURN};
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
pub(super) use with_or_without_base;

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
    pub(super) fn attraction(&self, gap: T, on_surface: bool) -> T {
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
        let bound = self
            .law
            .repelling(self.stiffness * (self.peak_gap - target) - self.peak);
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
pub(super) fn add_residual<T: Real, const BASE: bool>(
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

/// What the descent in v makes of a point.
struct Descent<T> {
    /// S2 y.
    y: T,
    /// z / S2: the long-range part, and the local part that the core's own stiffness answers.
    z: T,
    /// S2.
    share: T,
}

impl<T: Real, const BASE: bool> Core<T, BASE> {
    #[inline(always)]
    fn descent(&self, gap: T, elastic: T, line: T, on_surface: bool) -> Descent<T> {
        let hardening = if on_surface {
            self.hardening(gap)
        } else {
            T::zero()
        };
        let y = elastic + self.attraction(gap, on_surface);
        let share = self.stiffness / (self.stiffness + hardening);
        Descent {
            y: share * y,
            z: line + hardening / self.stiffness * y / (hardening + self.stiffness),
            share,
        }
    }
}

fn core_descent<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    if rows.base[0].is_empty() {
        descent::<T, false, false>(rows, params, scalars, sums);
    } else {
        descent::<T, true, false>(rows, params, scalars, sums);
    }
}

fn core_descent_held<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    if rows.base[0].is_empty() {
        descent::<T, false, true>(rows, params, scalars, sums);
    } else {
        descent::<T, true, true>(rows, params, scalars, sums);
    }
}

fn descent<T: Real, const BASE: bool, const HELD: bool>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let core = Core::<T, BASE>::new(params);
    let (factor, base) = (rows.factor, rows.base);
    let [gap, pressure, y_before, direction] = rows.reads;
    let lines = &mut *rows.lines;
    let mean = T::of(scalars.mean_pressure);
    layout.points(|i, on_surface| {
        let core = core.at(factor, base, i);
        let Descent { y, z, share } =
            core.descent(gap[i], pressure[i] + mean, lines[i], on_surface);
        let (zd, yd) = (z.double(), y.double());
        let change = yd - y_before[i].double();
        sums[0] += zd * yd;
        sums[1] += zd * change;
        if HELD {
            let (d, s2) = (direction[i].double(), share.double());
            sums[2] += d * change;
            sums[3] += d * yd;
            sums[4] += s2 * zd;
            sums[5] += s2;
            sums[6] += yd;
            sums[7] += change;
            sums[8] += s2 * d;
        }
        lines[i] = z;
    });
}
kernel!(
    /// Keeps the preconditioned residual in v. Reads gap, pressure, the old S2 y.
    CORE_DESCENT, core_descent, Keep, reads 3, writes 0, whole false,
    sums [Add, Add], gate Ahead
);
kernel!(
    /// The same where the mean gap is held. Reads gap, pressure, the old S2 y, direction.
    CORE_DESCENT_HELD, core_descent_held, Keep, reads 4, writes 0, whole false,
    sums [Add, Add, Add, Add, Add, Add, Add, Add, Add], gate Ahead
);

impl<T: Real, const BASE: bool> Core<T, BASE> {
    /// The trial step of a way in v.
    #[inline(always)]
    fn step(&self, gap: T, way: T, on_surface: bool) -> T {
        if !on_surface {
            way
        } else if BASE {
            // A correction is short: v follows its slope.
            self.share(gap, true) * way
        } else {
            self.gap_at(self.variable(gap) + way, gap) - gap
        }
    }

    /// The sums over a trial step: slots as `accept` reads them, then those of a search at step 1.
    #[inline(always)]
    fn add_trial(&self, sums: &mut [f64; SUMS], gap: T, elastic: T, step: T, on_surface: bool) {
        let all = elastic + self.attraction(gap, on_surface);
        let s = step.double();
        sums[0] += s * all.double();
        if s > sums[2] {
            sums[2] = s;
        }
        if s < sums[3] {
            sums[3] = s;
        }
        if on_surface {
            sums[5] += s * elastic.double();
            let (change, [energy, size]) = self.changes(gap, step);
            sums[6] += change.double() * s;
            sums[7] += energy.double();
            sums[8] += size.double();
        } else {
            // On a pad a base's residual is no law's: the search will not count it.
            sums[5] += s * all.double();
        }
    }
}

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
    let lines = &mut *rows.lines;
    let [direction, step, ..] = &mut rows.writes;
    let factors = [scalars.descent, scalars.memory, scalars.shift].map(T::of);
    let (length, mean) = (T::of(scalars.trial), T::of(scalars.mean_pressure));
    layout.points(|i, on_surface| {
        let core = core.at(factor, base, i);
        let d = factors[0] * lines[i] + factors[1] * direction[i] + factors[2];
        direction[i] = d;
        let s = core.step(gap[i], length * d, on_surface);
        step[i] = s;
        lines[i] = s;
        core.add_trial(sums, gap[i], pressure[i] + mean, s, on_surface);
    });
}
kernel!(
    /// Turns the direction by the kept z, finds the trial step by inverting v, and loads it. Reads gap,
    /// pressure; updates direction, writes step.
    CORE_TRIAL, core_trial, Resume, reads 2, writes 2, fresh 1, whole false,
    sums [Add, Min, Max, Min, Max, Add, Add, Add, Add], gate Running
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
    let gap = rows.reads[0];
    let z = &*rows.lines;
    let [direction, step, ..] = &mut rows.writes;
    let factors = [scalars.descent, scalars.memory, scalars.shift].map(T::of);
    let length = T::of(scalars.trial);
    layout.points(|i, on_surface| {
        let core = core.at(factor, base, i);
        let d = factors[0] * z[i] + factors[1] * direction[i] + factors[2];
        direction[i] = d;
        let s = core.step(gap[i], length * d, on_surface);
        step[i] = s;
        sums[0] += s.double();
        sums[1] += core.share(gap[i] + s, on_surface).double();
    });
}
kernel!(
    /// Turns the direction by the kept z and finds the trial step by inverting v (fixed mean gap). Reads
    /// gap; updates direction, writes step.
    CORE_DIRECT, core_direct, Peek, reads 1, writes 2, fresh 1, whole false,
    sums [Add, Add], gate Running
);

with_or_without_base!(core_trial_held, trial_held);

fn trial_held<T: Real, const BASE: bool>(
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
        let s = step[i] - restore * core.share(gap[i] + step[i], on_surface);
        step[i] = s;
        lines[i] = s;
        core.add_trial(sums, gap[i], pressure[i] + mean, s, on_surface);
    });
}
kernel!(
    /// Loads the trial step with its mean taken off in proportion to the local compliance. Reads gap,
    /// pressure; updates step.
    CORE_TRIAL_HELD, core_trial_held, Load, reads 2, writes 1, whole false,
    sums [Add, Min, Max, Min, Max, Add, Add, Add, Add], gate Running
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
