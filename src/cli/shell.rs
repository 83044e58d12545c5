//! What a shell and a reader of manuals want: completions and man pages, made from the arguments.

use std::path::Path;

use clap::CommandFactory;

use super::{Arguments, Failure, print_bytes};
use crate::output::OutputError;

/// Prints the completions of a shell.
pub(super) fn completions(shell: clap_complete::Shell) -> Result<(), Failure> {
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), "tabor", &mut text);
    print_bytes(&text)
}

/// Prints the man page of `tabor`, or writes that one and one a command into a folder.
pub(super) fn man(folder: Option<&Path>) -> Result<(), Failure> {
    let mut command = Arguments::command();
    // Names of the pages and `help` come with the build.
    command.build();
    let Some(folder) = folder else {
        return print_bytes(&page(&command)?);
    };
    std::fs::create_dir_all(folder).map_err(OutputError::write("create the folder", folder))?;
    let shown = |command: &&clap::Command| command.get_name() != "help" && !command.is_hide_set();
    for command in std::iter::once(&command).chain(command.get_subcommands().filter(shown)) {
        let name = command
            .get_display_name()
            .unwrap_or_else(|| command.get_name())
            .replace(' ', "-");
        let path = folder.join(format!("{name}.1"));
        std::fs::write(&path, page(command)?).map_err(OutputError::write("write", &path))?;
    }
    Ok(())
}

fn page(command: &clap::Command) -> Result<Vec<u8>, Failure> {
    let mut text = Vec::new();
    clap_mangen::Man::new(command.clone())
        .render(&mut text)
        .map_err(Failure::Print)?;
    Ok(text)
}
