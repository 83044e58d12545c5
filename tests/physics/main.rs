//! The full field against closed forms and independent tables.

use std::process::ExitCode;

mod bench;
mod capillary;
mod conductance;
mod cone;
mod controls;
mod dmt;
mod energy;
mod friction;
mod halving;
mod hard_cases;
mod hardness;
mod hertz;
mod invariants;
mod layer;
mod leakage;
mod lennard_jones;
mod maugis_dugdale;
mod pairs;
mod pattern;
mod plates;
mod precisions;
mod pull_off;
mod rate;
mod relaxation;
mod rough;
#[path = "../shared/mod.rs"]
mod shared;
mod spring;
mod tables;
mod taper;
mod time_steps;
mod waves;
mod wear;

fn main() -> ExitCode {
    // The longest first: nothing else is left to do beside it at the end.
    shared::trials::run([
        hard_cases::tests(),
        hard_cases::extremes::tests(),
        capillary::tests(),
        cone::tests(),
        conductance::tests(),
        controls::tests(),
        dmt::tests(),
        energy::tests(),
        friction::tests(),
        halving::tests(),
        hardness::tests(),
        hertz::tests(),
        invariants::tests(),
        layer::tests(),
        leakage::tests(),
        lennard_jones::tests(),
        maugis_dugdale::tests(),
        pairs::tests(),
        pattern::tests(),
        plates::tests(),
        precisions::tests(),
        pull_off::tests(),
        rate::tests(),
        relaxation::tests(),
        rough::tests(),
        spring::tests(),
        tables::tests(),
        taper::tests(),
        time_steps::tests(),
        waves::tests(),
        wear::tests(),
    ])
}
