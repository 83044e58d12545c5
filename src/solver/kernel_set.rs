//! Which kernels take the steps of an iteration: those of a wall, of a solid that flows, of the
//! Lennard-Jones core.

use crate::kernel::{Kernel, core, scalar, wall, yielding};

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
}

pub(super) static WALL: KernelSet = KernelSet {
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
};

pub(super) static YIELD: KernelSet = KernelSet {
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
};

pub(super) static CORE: KernelSet = KernelSet {
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
};
