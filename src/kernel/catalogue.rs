//! Every kernel with all its variants.

use super::{Kernel, ScalarKernel};
use super::{
    descent, displacement, mean_gap, measure, refinement, scalar, search, step_length, trial,
    two_band, update,
};

/// Every kernel over points, variant by variant.
pub static KERNELS: &[&[Kernel]] = &[
    one(&displacement::LOAD_DISPLACEMENT),
    one(&displacement::LOAD_FIELD),
    one(&displacement::LOAD_FIELD_AHEAD),
    one(&displacement::STORE_FIELD),
    &measure::RESIDUAL,
    &measure::LOAD_RESIDUAL,
    &measure::LOAD_AND_RETAIN_RESIDUAL,
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
    &update::UPDATE_AND_RETAIN,
    &update::ADVANCE,
    &update::BALANCE,
    one(&two_band::COARSEN),
    one(&two_band::WEIGH),
    one(&two_band::STORE_WEIGHTED),
    one(&two_band::TWO_BAND_DESCENT),
    one(&two_band::MEAN_GAP_TWO_BAND_DESCENT),
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
