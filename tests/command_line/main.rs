//! The program from outside: every command, its files and pictures, what it refuses and how, and how runs end.

use std::process::ExitCode;

mod accuracy;
mod compare;
mod contact;
mod cut_edges;
mod force_curves;
mod hostile_calls;
mod instrument_curves;
mod kept;
mod mistakes;
mod new_scene;
mod pictures;
mod plot;
#[cfg(unix)]
mod recipes;
mod report_page;
mod resume;
mod run;
mod scenes;
#[path = "../shared/mod.rs"]
mod shared;
mod shell;
mod step_warnings;
mod surface;
mod sweep;
mod theory;

fn main() -> ExitCode {
    shared::trials::run([
        accuracy::tests(),
        compare::tests(),
        contact::tests(),
        cut_edges::tests(),
        force_curves::tests(),
        hostile_calls::tests(),
        instrument_curves::tests(),
        kept::tests(),
        mistakes::tests(),
        mistakes::pull_off::tests(),
        mistakes::scenes::tests(),
        mistakes::variants::tests(),
        new_scene::tests(),
        pictures::tests(),
        plot::tests(),
        #[cfg(unix)]
        recipes::tests(),
        report_page::tests(),
        resume::tests(),
        run::tests(),
        scenes::tests(),
        shell::tests(),
        step_warnings::tests(),
        surface::tests(),
        sweep::tests(),
        theory::tests(),
    ])
}
