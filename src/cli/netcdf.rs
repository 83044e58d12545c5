//! `tabor netcdf`: a run as one self-describing file.

use std::fs;
use std::path::PathBuf;

use clap::Args;

use super::{Failure, say};
use crate::output::write_netcdf;

#[derive(Debug, Args)]
pub(super) struct NetcdfArguments {
    /// Folder of a run
    run: PathBuf,
    /// The file [default: RUN.nc, beside the folder]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// Writes the file.
pub(super) fn netcdf(arguments: &NetcdfArguments) -> Result<(), Failure> {
    let beside = || {
        // `.` and `..` have no name of their own.
        let run = match arguments.run.file_name() {
            Some(_) => arguments.run.clone(),
            None => fs::canonicalize(&arguments.run).unwrap_or_else(|_| arguments.run.clone()),
        };
        let mut name = run.file_name().unwrap_or_default().to_owned();
        name.push(".nc");
        run.with_file_name(name)
    };
    let file = arguments.out.clone().unwrap_or_else(beside);
    write_netcdf(&arguments.run, &file)?;
    say(&format!("{} written", file.display()));
    Ok(())
}
