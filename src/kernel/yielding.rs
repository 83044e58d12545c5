//! Kernels of a solid whose pressure saturates: those of the wall over a floor that flows, see
//! [`floor`](super::floor). A gap below zero is the depth that has flowed in this solve.

use super::floor::{Balance, Floor, Yielding, trial_step};
use super::{step, wall};
use crate::kernel::{Params, Rows, SUMS, Scalars, kernel};
use crate::law::{Cohesion, LawField};
use crate::real::Real;
use crate::with_law_field;

fn yield_residual<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    wall::residual::<T, Yielding<T>>(rows, params, scalars, sums);
}
kernel!(
    /// The stopping measure of the present state. Reads gap, pressure.
    YIELD_RESIDUAL, yield_residual, Sweep, reads 2, writes 0, whole false,
    sums [Add, Add, Min, Add], gate Always
);

fn yield_free<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    wall::free::<T, Yielding<T>>(rows, params, scalars, sums);
}
kernel!(
    /// Loads yF and sums the stopping measure on the way. Reads gap, pressure.
    YIELD_FREE, yield_free, Load, reads 2, writes 0, whole false,
    sums [Add, Add, Min, Add], gate Fresh
);

fn yield_free_kept<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    yield_free(rows, params, scalars, sums);
    wall::keep_lines(rows, 0);
}
kernel!(
    /// As `yield_free`, and keeps yF in a field for the coarse level. Reads gap, pressure; writes yF.
    YIELD_FREE_KEPT, yield_free_kept, Load, reads 2, writes 1, fresh 1, whole false,
    sums [Add, Add, Min, Add], gate Fresh
);

fn yield_descent<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    wall::descent::<T, Yielding<T>, false>(rows, params, scalars, sums);
}
kernel!(
    /// Keeps the preconditioned residual z on free points. Reads gap, pressure, the old yF.
    YIELD_DESCENT, yield_descent, Keep, reads 3, writes 0, whole false,
    sums [Add, Add], gate Ahead
);

fn yield_descent_held<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    wall::descent::<T, Yielding<T>, true>(rows, params, scalars, sums);
}
kernel!(
    /// The same where the mean gap is held. Reads gap, pressure, the old yF, direction.
    YIELD_DESCENT_HELD, yield_descent_held, Keep, reads 4, writes 0, whole false,
    sums [Add, Add, Add, Add, Add, Add, Add, Add, Add], gate Ahead
);

fn yield_trial<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    wall::trial::<T, Yielding<T>>(rows, params, scalars, sums);
}
kernel!(
    /// Turns the direction by the kept z and loads the trial step s. Reads gap, pressure; updates
    /// direction.
    YIELD_TRIAL, yield_trial, Resume, reads 2, writes 1, whole false,
    sums [Add, Min, Max, Min, Max], gate Running
);

fn yield_direct<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let [gap, pressure, ..] = rows.reads;
    let z = &*rows.lines;
    let direction = &mut rows.writes[0];
    let mean = T::of(scalars.mean_pressure);
    let factors = [scalars.descent, scalars.memory, scalars.shift].map(T::of);
    let length = T::of(scalars.trial);
    let floor = Yielding::of(params);
    with_law_field!(params.law, rows.factor, rows.base, T, law => layout.points(|i, on_surface| {
        let law = LawField::<T>::at(&law, i);
        let Balance { y, free } =
            wall::balance(&floor, &law, gap[i], pressure[i] + mean, on_surface);
        let d = wall::new_direction(z[i], direction[i], factors, free);
        direction[i] = d;
        let step = trial_step(gap[i], length * d, T::zero(), floor.goes_down(gap[i], y));
        sums[0] += step.double();
        sums[1] += gap[i].double();
        sums[2] += (-(gap[i] + step)).max(T::zero()).double();
    }));
}
kernel!(
    /// Turns the direction by the kept z and sums the trial step, the gap, and the depth of the trial
    /// (fixed mean gap). Reads gap, pressure; updates direction.
    YIELD_DIRECT, yield_direct, Peek, reads 2, writes 1, whole false,
    sums [Add, Add, Add], gate Running
);

fn yield_trial_held<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let [gap, pressure, direction, _] = rows.reads;
    let lines = &mut *rows.lines;
    let mean = T::of(scalars.mean_pressure);
    let length = T::of(scalars.trial);
    let restore = T::of(scalars.restore);
    let floor = Yielding::of(params);
    // A trial that no scaling brings back is lost: one that moves and does not descend.
    let lost = !(restore > -T::one() && restore < T::one());
    if lost {
        sums[2] = 1.0;
    }
    with_law_field!(params.law, rows.factor, rows.base, T, law => layout.points(|i, on_surface| {
        let law = LawField::<T>::at(&law, i);
        if lost {
            lines[i] = T::zero();
            return;
        }
        let y = wall::balance(&floor, &law, gap[i], pressure[i] + mean, on_surface).y;
        let here = [gap[i], y, length * direction[i], restore];
        let (step, cut) = wall::step_of(&floor, here, on_surface);
        wall::add_trial(sums, [step, y, gap[i]], cut, on_surface);
        lines[i] = step;
    }));
}
kernel!(
    /// Loads the trial step scaled back to the held mean gap. Reads gap, pressure, direction.
    YIELD_TRIAL_HELD, yield_trial_held, Load, reads 3, writes 0, whole false,
    sums [Add, Min, Max, Min, Max], gate Running
);

fn yield_search<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let [gap, direction, pressure, _] = rows.reads;
    let mean = T::of(scalars.mean_pressure);
    let length = T::of(scalars.trial);
    let restore = T::of(scalars.restore);
    let t = T::of(scalars.step);
    let floor = Yielding::of(params);
    with_law_field!(params.law, rows.factor, rows.base, T, law => layout.points(|i, on_surface| {
        let law = LawField::<T>::at(&law, i);
        if on_surface {
            let y = floor.balance(&law, gap[i], pressure[i] + mean).y;
            // Below zero the pressure does not change.
            if !floor.goes_down(gap[i], y) {
                let step = trial_step(gap[i], length * direction[i], restore, false);
                let change = law.change(gap[i], t * step);
                sums[0] += change.double() * step.double();
            }
        }
    }));
}
kernel!(
    /// Sums `<sigma(g + t s) - sigma(g), s>`. Reads gap, direction, pressure.
    YIELD_SEARCH, yield_search, Sweep, reads 3, writes 0, whole false,
    sums [Add], gate Searching
);

fn yield_turn<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    step::turn::<T, Yielding<T>>(rows, params, scalars, sums);
}
kernel!(
    /// Takes K s and steps, then loads the new yF. Reads direction; updates gap, pressure; writes the
    /// old yF.
    YIELD_TURN, yield_turn, Turn, reads 1, writes 3, fresh 1, whole false,
    sums [Add, Add, Min, Add, Add, Add], gate Running
);

fn yield_turn_kept<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    yield_turn(rows, params, scalars, sums);
    wall::keep_lines(rows, 3);
}
kernel!(
    /// As `yield_turn`, and keeps the new yF in a field for the coarse level. Writes it after the others.
    YIELD_TURN_KEPT, yield_turn_kept, Turn, reads 1, writes 4, fresh 2, whole false,
    sums [Add, Add, Min, Add, Add, Add], gate Running
);

fn yield_advance<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    step::advance::<T, Yielding<T>, false>(rows, params, scalars, sums);
}
kernel!(
    /// Takes K s and steps, where the mean gap is held; sums as `yield_balance`. Reads direction; updates
    /// gap, pressure; writes the old yF.
    YIELD_ADVANCE, yield_advance, Store, reads 1, writes 3, fresh 1, whole false,
    sums [Add, Add, Min], gate Running
);

fn yield_balance<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    step::balance_sums::<T, Yielding<T>>(rows, params, scalars, sums);
}
kernel!(
    /// The sums that give the mean pressure under a held mean gap. Reads gap, pressure.
    YIELD_BALANCE, yield_balance, Sweep, reads 2, writes 0, whole false,
    sums [Add, Add, Min], gate Running
);
