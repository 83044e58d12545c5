//! Memory: what a run takes, what a check announces, and what spoiled scenes ask for. The counter of
//! allocations counts the whole process, so that these tests run one after the other.

use std::alloc::System;
use std::process::ExitCode;

use stats_alloc::{INSTRUMENTED_SYSTEM, StatsAlloc};

mod allocation;
mod peak;
mod plan;
mod scene_mutations;
#[path = "../shared/mod.rs"]
mod shared;

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

fn main() -> ExitCode {
    shared::trials::run_one_by_one([
        allocation::tests(),
        peak::tests(),
        plan::tests(),
        scene_mutations::tests(),
    ])
}
