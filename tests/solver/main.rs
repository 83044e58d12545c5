//! The solver's parts and its iterates: the elastic operator, each backend against the plain text of the
//! method, what one step of a path hands to the next, and a contact over several ranks.

use std::process::ExitCode;

mod checkpoint;
mod iterates;
mod mean_gap;
mod operator;
mod ranks;
mod ranks_files;
#[path = "../shared/mod.rs"]
mod shared;

fn main() -> ExitCode {
    // The longest first: nothing else is left to do beside it at the end.
    shared::trials::run([
        iterates::tests(),
        checkpoint::tests(),
        ranks::tests(),
        ranks_files::tests(),
        mean_gap::tests(),
        operator::tests(),
    ])
}
