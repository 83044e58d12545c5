//! The program from outside: every command, its files and pictures, what it refuses and how, and how runs end.

mod accuracy;
mod compare;
mod hostile_calls;
mod kept;
mod mistakes;
mod pictures;
mod report_page;
mod resume;
mod run;
mod scenes;
#[path = "../shared/mod.rs"]
mod shared;
mod shell;
mod surface;
mod theory;
