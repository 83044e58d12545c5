//! The whole catalogue, for the tests that go through it in a loop.

use tabor::kernel::{KERNELS, Kernel};

use crate::shared::trials::tests;

pub use tabor::kernel::SCALAR_KERNELS;

/// Every kernel over points, variant by variant.
pub fn variants() -> impl Iterator<Item = &'static Kernel> {
    KERNELS.iter().copied().flatten()
}

/// Every kernel over points by name. Each is compared with its twin by `kernels.rs`, which goes through the
/// catalogue: a kernel that is not named here makes a test fail until somebody has looked that its variants are
/// met there.
const NAMES: [&str; 26] = [
    "add_correction",
    "advance",
    "balance",
    "coarsen",
    "descent",
    "direction",
    "free_share",
    "level_descent",
    "load_displacement",
    "load_field",
    "load_residual",
    "load_trial",
    "load_weighted",
    "outer_pressure",
    "outer_residual",
    "refine",
    "residual",
    "restore_outer_gap",
    "search",
    "soften",
    "store_field",
    "store_retained",
    "store_weighted",
    "trial",
    "update_state",
    "weigh",
];

/// Every scalar kernel by name.
const SCALAR_NAMES: [&str; 11] = [
    "accept_trial",
    "adapt_trial_length",
    "conjugate_direction",
    "curvature_by_linearity",
    "mean_pressure",
    "restore_mean_gap",
    "restore_outer_mean_gap",
    "search",
    "snap_to_contact",
    "step_length",
    "test_convergence",
];

/// The fused path stays small, and no kernel is without a test that names it.
fn every_kernel_is_named_here_and_there_are_few() {
    let mut names: Vec<&str> = variants().map(|kernel| kernel.name).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names, NAMES);
    let mut scalars: Vec<&str> = SCALAR_KERNELS.iter().map(|kernel| kernel.name).collect();
    scalars.sort_unstable();
    assert_eq!(scalars, SCALAR_NAMES);
    println!(
        "{} kernels over points, {} scalar kernels",
        names.len(),
        scalars.len()
    );
    assert!(names.len() <= 30 && scalars.len() <= 12);
    // Variants are told apart.
    let mut told: Vec<String> = variants().map(Kernel::variant).collect();
    let count = told.len();
    told.sort_unstable();
    told.dedup();
    assert_eq!(told.len(), count);
}

tests![every_kernel_is_named_here_and_there_are_few];
