//! The command line of tabor.
fn main() {}
