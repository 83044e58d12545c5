//! Every kernel with all its variants.

use super::{Kernel, ScalarKernel};
use super::{
    descent, displacement, mean_gap, measure, multilevel, refinement, scalar, search, step_length,
    trial, update,
};

/// Every kernel over points, variant by variant.
pub static KERNELS: &[&[Kernel]] = &[
    one(&displacement::LOAD_DISPLACEMENT),
    one(&displacement::LOAD_FIELD),
    one(&displacement::LOAD_FIELD_AHEAD),
    one(&displacement::STORE_FIELD),
    &measure::RESIDUAL,
    &measure::LOAD_RESIDUAL,
    &measure::STORE_RESIDUAL,
    &descent::DESCENT,
    &descent::MEAN_GAP_DESCENT,
    &trial::TRIAL,
    one(&trial::LINEAR_TRIAL),
    one(&trial::TWO_SIDED_DIRECTION),
    one(&trial::SMOOTH_DIRECTION),
    one(&trial::TWO_SIDED_LOAD_TRIAL),
    one(&trial::SMOOTH_LOAD_TRIAL),
    &search::SEARCH,
    &update::UPDATE_STATE,
    &update::UPDATE_AND_STORE,
    &update::ADVANCE,
    &update::BALANCE,
    one(&multilevel::COARSEN),
    one(&multilevel::FREE_SHARE),
    one(&multilevel::WEIGH),
    one(&multilevel::LOAD_WEIGHTED),
    one(&multilevel::STORE_WEIGHTED),
    one(&multilevel::REFINE),
    &multilevel::SOFTEN,
    one(&multilevel::STORE_RETAINED),
    &multilevel::LEVEL_DESCENT,
    &multilevel::MEAN_GAP_LEVEL_DESCENT,
    one(&refinement::OUTER_RESIDUAL),
    one(&refinement::OUTER_PRESSURE),
    &refinement::ADD_CORRECTION,
    &refinement::RESTORE_OUTER_GAP,
];

/// A kernel without variants.
const fn one(kernel: &'static Kernel) -> &'static [Kernel] {
    std::slice::from_ref(kernel)
}

/// Every scalar kernel.
pub static SCALAR_KERNELS: &[&ScalarKernel] = &[
    &scalar::TEST_CONVERGENCE,
    &scalar::CONJUGATE_DIRECTION,
    &scalar::ACCEPT_TRIAL,
    &mean_gap::RESTORE_MEAN_GAP,
    &mean_gap::CURVATURE_BY_LINEARITY,
    &mean_gap::MEAN_PRESSURE,
    &mean_gap::RESTORE_OUTER_MEAN_GAP,
    &step_length::STEP_LENGTH,
    &step_length::SEARCH,
    &step_length::SNAP_TO_CONTACT,
    &step_length::ADAPT_TRIAL_LENGTH,
];
