//! The whole catalogue, for the tests that go through it in a loop.
#![allow(dead_code)]

use tabor::kernel::{Kernel, ScalarKernel, coarse, common, core, scalar, wall};

/// Every kernel over points.
pub static KERNELS: &[&Kernel] = &[
    &common::LOAD_DISPLACEMENT,
    &common::LOAD_FIELD,
    &common::STORE_PRESSURE,
    &wall::WALL_RESIDUAL,
    &wall::WALL_FREE,
    &wall::WALL_FREE_KEPT,
    &wall::WALL_DESCENT,
    &wall::WALL_DESCENT_TWO_BAND,
    &wall::WALL_TRIAL,
    &wall::WALL_DIRECT,
    &wall::WALL_TRIAL_HELD,
    &wall::WALL_SEARCH,
    &wall::WALL_ADVANCE,
    &wall::WALL_BALANCE,
    &core::CORE_RESIDUAL,
    &core::CORE_FREE,
    &core::CORE_DESCENT,
    &core::CORE_DIRECT,
    &core::CORE_TRIAL,
    &core::CORE_SEARCH,
    &core::CORE_ADVANCE,
    &core::CORE_BALANCE,
    &coarse::COARSE_RESTRICT,
    &coarse::COARSE_SHARE,
    &coarse::COARSE_WEIGHT,
    &coarse::COARSE_LOAD,
    &coarse::COARSE_STORE,
];

/// Every scalar kernel.
pub static SCALAR_KERNELS: &[&ScalarKernel] = &[
    &scalar::JUDGE,
    &scalar::DIRECT,
    &scalar::RESTORE_WALL,
    &scalar::RESTORE_CORE,
    &scalar::ACCEPT,
    &scalar::STEP_WALL,
    &scalar::SEARCH_WALL,
    &scalar::SETTLE_WALL,
    &scalar::LENGTHEN_WALL,
    &scalar::STEP_CORE,
    &scalar::SEARCH_CORE,
    &scalar::LENGTHEN_CORE,
    &scalar::BALANCE_WALL,
    &scalar::BALANCE_CORE,
];
