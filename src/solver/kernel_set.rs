//! What a law asks of the solver: its kernels, and the numbers that stay fixed.

use super::problem::Problem;
use crate::kernel::{Kernel, Params, core, scalar, wall};
use crate::law::Law;

/// The kernels of one family of laws.
pub(super) struct KernelSet {
    pub(super) residual: &'static Kernel,
    pub(super) free: &'static Kernel,
    pub(super) descent: &'static Kernel,
    pub(super) search: &'static Kernel,
    pub(super) advance: &'static Kernel,
    pub(super) balance: &'static Kernel,
    pub(super) balance_scalar: &'static scalar::ScalarKernel,
    pub(super) step: &'static scalar::ScalarKernel,
    pub(super) search_scalar: &'static scalar::ScalarKernel,
    pub(super) lengthen: &'static scalar::ScalarKernel,
}

static WALL: KernelSet = KernelSet {
    residual: &wall::WALL_RESIDUAL,
    free: &wall::WALL_FREE,
    descent: &wall::WALL_DESCENT,
    search: &wall::WALL_SEARCH,
    advance: &wall::WALL_ADVANCE,
    balance: &wall::WALL_BALANCE,
    balance_scalar: &scalar::BALANCE_WALL,
    step: &scalar::STEP_WALL,
    search_scalar: &scalar::SEARCH_WALL,
    lengthen: &scalar::LENGTHEN_WALL,
};

static CORE: KernelSet = KernelSet {
    residual: &core::CORE_RESIDUAL,
    free: &core::CORE_FREE,
    descent: &core::CORE_DESCENT,
    search: &core::CORE_SEARCH,
    advance: &core::CORE_ADVANCE,
    balance: &core::CORE_BALANCE,
    balance_scalar: &scalar::BALANCE_CORE,
    step: &scalar::STEP_CORE,
    search_scalar: &scalar::SEARCH_CORE,
    lengthen: &scalar::LENGTHEN_CORE,
};

impl KernelSet {
    /// Those of a law.
    pub(super) fn of(law: &Law) -> &'static KernelSet {
        if law.has_wall() { &WALL } else { &CORE }
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
        epsilon,
    }
}
