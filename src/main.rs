//! The command line of tabor.

use std::process::ExitCode;

fn main() -> ExitCode {
    tabor::command_line()
}
