//! The graphics processor: shaders, each kernel and transform against its twin on the processor, whole
//! solves, and runs through the command line.

use std::process::ExitCode;

mod catalogue;
mod convolution;
mod kernels;
mod loops;
mod path;
mod run;
mod shaders;
#[path = "../shared/mod.rs"]
mod shared;
mod slabs;
mod solve;
mod twins;
mod watching;
mod without_adapter;

fn main() -> ExitCode {
    shared::trials::run([
        catalogue::tests(),
        convolution::tests(),
        kernels::tests(),
        loops::tests(),
        path::tests(),
        run::tests(),
        shaders::tests(),
        slabs::tests(),
        solve::tests(),
        twins::tests(),
        without_adapter::tests(),
    ])
}
