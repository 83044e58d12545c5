//! The graphics processor: shaders, each kernel and transform against its twin on the processor, whole
//! solves, and runs through the command line.

use std::process::ExitCode;

mod catalogue;
mod convolution;
mod kernels;
mod run;
mod shaders;
#[path = "../shared/mod.rs"]
mod shared;
mod slabs;
mod solve;
mod watching;
mod without_adapter;

fn main() -> ExitCode {
    shared::trials::run([
        convolution::tests(),
        kernels::tests(),
        run::tests(),
        shaders::tests(),
        slabs::tests(),
        solve::tests(),
        without_adapter::tests(),
    ])
}
