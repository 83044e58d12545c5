//! What a problem asks of the solver: its kernels, those of a wall, of a solid that flows or of the
//! Lennard-Jones core, and the numbers that stay fixed.

use super::contact::{Hold, Load};
use super::problem::Problem;
use crate::kernel::{Kernel, Params, base, core, held, scalar, wall, yielding};

/// The kernels of one family of laws. Those that end in `held` and `direct`, `advance` and `balance` are
/// asked where the mean gap is held; in their place without it stand `descent`, `trial` and `turn`.
pub(super) struct KernelSet {
    pub residual: &'static Kernel,
    pub free: &'static Kernel,
    pub descent: &'static Kernel,
    pub descent_held: &'static Kernel,
    /// What sums a trial before the held mean gap is restored; `None` where a trial needs the restoring for
    /// nothing but numbers, which follow by linearity.
    pub direct: Option<&'static Kernel>,
    pub trial: &'static Kernel,
    pub trial_held: &'static Kernel,
    pub search: &'static Kernel,
    pub turn: &'static Kernel,
    pub advance: &'static Kernel,
    pub balance: &'static Kernel,
    pub restore: &'static scalar::ScalarKernel,
    pub balance_scalar: &'static scalar::ScalarKernel,
    pub step: &'static scalar::ScalarKernel,
    pub search_scalar: &'static scalar::ScalarKernel,
    pub lengthen: &'static scalar::ScalarKernel,
    /// What adds a correction to its base, and what holds the base's mean gap.
    pub base_add: &'static Kernel,
    pub base_hold: &'static Kernel,
}

static WALL: KernelSet = KernelSet {
    residual: &wall::WALL_RESIDUAL,
    free: &wall::WALL_FREE,
    descent: &wall::WALL_DESCENT,
    descent_held: &wall::WALL_DESCENT_HELD,
    direct: None,
    trial: &wall::WALL_TRIAL,
    trial_held: &wall::WALL_TRIAL_HELD,
    search: &wall::WALL_SEARCH,
    turn: &wall::WALL_TURN,
    advance: &wall::WALL_ADVANCE,
    balance: &wall::WALL_BALANCE,
    restore: &held::RESTORE_WALL,
    balance_scalar: &scalar::BALANCE_WALL,
    step: &scalar::STEP_WALL,
    search_scalar: &scalar::SEARCH_WALL,
    lengthen: &scalar::LENGTHEN_WALL,
    base_add: &base::BASE_ADD_WALL,
    base_hold: &base::BASE_HOLD_WALL,
};

static YIELD: KernelSet = KernelSet {
    residual: &yielding::YIELD_RESIDUAL,
    free: &yielding::YIELD_FREE,
    descent: &yielding::YIELD_DESCENT,
    descent_held: &yielding::YIELD_DESCENT_HELD,
    direct: Some(&yielding::YIELD_DIRECT),
    trial: &yielding::YIELD_TRIAL,
    trial_held: &yielding::YIELD_TRIAL_HELD,
    search: &yielding::YIELD_SEARCH,
    turn: &yielding::YIELD_TURN,
    advance: &yielding::YIELD_ADVANCE,
    balance: &yielding::YIELD_BALANCE,
    restore: &scalar::RESTORE_YIELD,
    balance_scalar: &scalar::BALANCE_WALL,
    step: &scalar::STEP_WALL,
    search_scalar: &scalar::SEARCH_WALL,
    lengthen: &scalar::LENGTHEN_WALL,
    base_add: &base::BASE_ADD_WALL,
    base_hold: &base::BASE_HOLD_WALL,
};

static CORE: KernelSet = KernelSet {
    residual: &core::CORE_RESIDUAL,
    free: &core::CORE_FREE,
    descent: &core::CORE_DESCENT,
    descent_held: &core::CORE_DESCENT_HELD,
    direct: Some(&core::CORE_DIRECT),
    trial: &core::CORE_TRIAL,
    trial_held: &core::CORE_TRIAL_HELD,
    search: &core::CORE_SEARCH,
    turn: &core::CORE_TURN,
    advance: &core::CORE_ADVANCE,
    balance: &core::CORE_BALANCE,
    restore: &scalar::RESTORE_CORE,
    balance_scalar: &scalar::BALANCE_CORE,
    step: &scalar::STEP_CORE,
    search_scalar: &scalar::SEARCH_CORE,
    lengthen: &scalar::LENGTHEN_CORE,
    base_add: &base::BASE_ADD_CORE,
    base_hold: &base::BASE_HOLD_CORE,
};

impl KernelSet {
    /// Those of a problem.
    pub(super) fn of(problem: &Problem) -> &'static KernelSet {
        match problem.hardness {
            _ if !problem.law.has_wall() => &CORE,
            Some(_) => &YIELD,
            None => &WALL,
        }
    }
}

/// The numbers of a problem that stay fixed whatever the load.
pub(super) fn fixed_params(problem: &Problem, epsilon: f64) -> Params {
    let points = problem.shape.surface_len() as f64;
    let stiffness_max = problem.stiffness_max();
    Params {
        law: problem.law,
        stiffness_max,
        pressure_floor: 1e-6
            * (problem.rms_slope * problem.scales.lateral / problem.scales.length)
            * points.sqrt(),
        tolerance: 0.0,
        heights_norm: rounded_beside(problem),
        fixed_gap: false,
        may_detach: false,
        points,
        core_stiffness: 0.2 * stiffness_max,
        hardness: problem.hardness.unwrap_or(f64::INFINITY),
        epsilon,
    }
}

/// Roundings of its range that a Lennard-Jones gap is found to: those of the inversion of its variable.
const CORE_ROUNDINGS: f64 = 2.0;

/// Norm over the surface points of what a gap is rounded beside, whatever the load. A gap of the
/// Lennard-Jones law counts from a range away, and where its traction vanishes it is a difference of two
/// parts, whose rounding is that of the range times the slope there, 16 w/range^2.
fn rounded_beside(problem: &Problem) -> f64 {
    let heights = problem.heights.iter().map(|h| h * h).sum::<f64>().sqrt();
    if problem.law.has_wall() {
        return heights;
    }
    let steep = problem.law.slope(0.0).abs() / problem.stiffness_max();
    let points = problem.shape.surface_len() as f64;
    heights.max(CORE_ROUNDINGS * problem.law.range() * steep.max(1.0) * points.sqrt())
}

/// The same under a load: what holds the mean displacement presses with its far end's whole pressure, and
/// takes most of it back.
pub(super) fn rounded_beside_under(own: f64, params: &Params, load: &Load) -> f64 {
    match load.hold {
        Hold::Pressure(far_end) if load.zero_stiffness > 0.0 => {
            own.max(far_end.abs() * params.points.sqrt() / params.stiffness_max)
        }
        _ => own,
    }
}
