//! The graphics processor: shaders, each kernel and transform against its twin on the processor, whole
//! solves, and runs through the command line.

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
