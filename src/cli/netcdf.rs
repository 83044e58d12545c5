//! `tabor netcdf`: a run as one self-describing file.

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
        let mut name = arguments.run.file_name().unwrap_or_default().to_owned();
        name.push(".nc");
        arguments.run.with_file_name(name)
    };
    let file = arguments.out.clone().unwrap_or_else(beside);
    write_netcdf(&arguments.run, &file)?;
    say(&format!("{} written", file.display()));
    Ok(())
}
