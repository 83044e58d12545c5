//! What a problem asks of the solver: its kernels, those of a wall, of a solid that flows or of the
//! Lennard-Jones core, and the numbers that stay fixed.

use super::problem::Problem;
use crate::kernel::{Kernel, Params, base, core, scalar, wall, yielding};

/// The kernels of one family of laws.
pub(super) struct KernelSet {
    pub residual: &'static Kernel,
    pub free: &'static Kernel,
    pub descent: &'static Kernel,
    pub search: &'static Kernel,
    pub advance: &'static Kernel,
    pub balance: &'static Kernel,
    /// The direction and the trial where the mean gap is held, and the trial where it is not; for
    /// Lennard-Jones the direction is found, and the trial loaded, in one way.
    pub direct: &'static Kernel,
    pub trial_held: &'static Kernel,
    pub trial: &'static Kernel,
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
    search: &wall::WALL_SEARCH,
    advance: &wall::WALL_ADVANCE,
    balance: &wall::WALL_BALANCE,
    direct: &wall::WALL_DIRECT,
    trial_held: &wall::WALL_TRIAL_HELD,
    trial: &wall::WALL_TRIAL,
    restore: &scalar::RESTORE_WALL,
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
    search: &yielding::YIELD_SEARCH,
    advance: &yielding::YIELD_ADVANCE,
    balance: &yielding::YIELD_BALANCE,
    direct: &yielding::YIELD_DIRECT,
    trial_held: &yielding::YIELD_TRIAL_HELD,
    trial: &yielding::YIELD_TRIAL,
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
    search: &core::CORE_SEARCH,
    advance: &core::CORE_ADVANCE,
    balance: &core::CORE_BALANCE,
    direct: &core::CORE_DIRECT,
    trial_held: &core::CORE_TRIAL,
    trial: &core::CORE_TRIAL,
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
        heights_norm: problem.heights.iter().map(|h| h * h).sum::<f64>().sqrt(),
        fixed_gap: false,
        may_detach: false,
        points,
        core_stiffness: 0.2 * stiffness_max,
        hardness: problem.hardness.unwrap_or(f64::INFINITY),
        epsilon,
    }
}
