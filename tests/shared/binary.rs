//! The binary as its user starts it, and what it leaves behind: for every test from outside.

use std::collections::HashMap;
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};

use serde_json::Value;
use tempfile::TempDir;

/// Where the binary is.
pub const BINARY: &str = env!("CARGO_BIN_EXE_tabor");

/// A command on the binary, from `folder`, which reads nothing. It takes one thread unless a test asks for more: tests run side by
/// side, and results have the same bits on any number.
pub fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(BINARY);
    command
        .current_dir(folder)
        .args(arguments)
        .env("RAYON_NUM_THREADS", "1")
        .stdin(Stdio::null());
    command
}

/// Runs the binary to its end.
pub fn tabor(folder: &Path, arguments: &[&str]) -> Output {
    command(folder, arguments)
        .output()
        .expect("the binary runs")
}

/// A file of graphics drivers that is not there.
pub const NO_DRIVERS: &str = "/nonexistent";

/// Leaves out the graphics processor, which may be software: for what does not ask about it.
pub fn without_adapter(command: &mut Command) -> &mut Command {
    with_drivers(command, NO_DRIVERS)
}

/// Takes the graphics drivers of a file, and no others.
pub fn with_drivers<'a>(command: &'a mut Command, drivers: &str) -> &'a mut Command {
    command
        .env("VK_DRIVER_FILES", drivers)
        .env("VK_ICD_FILENAMES", drivers)
}

/// Exit status of a run that ended by itself.
pub fn status(output: &Output) -> i32 {
    output.status.code().expect("it ended by itself")
}

/// What a run said on standard error.
pub fn errors(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Sends a signal such as `-INT` to a run; whether it was still there.
pub fn signal(child: &Child, signal: &str) -> bool {
    let sent = Command::new("kill")
        .args([signal, &child.id().to_string()])
        .status();
    sent.expect("there is a kill").success()
}

/// A folder with `scene.toml` in it.
pub fn scene(text: &str) -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::write(folder.path().join("scene.toml"), text).expect("the scene is written");
    folder
}

/// `summary.json` of a run.
pub fn summary(folder: &Path) -> Value {
    let bytes = fs::read(folder.join("summary.json")).expect("a summary");
    serde_json::from_slice(&bytes).expect("JSON")
}

/// The rows of a table with a head, by column.
pub fn table(path: &Path) -> Vec<HashMap<String, String>> {
    let text = fs::read_to_string(path).expect("there is a table");
    assert!(text.ends_with('\n'), "the last line is whole");
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().expect("a head").split(',').collect();
    lines
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            assert_eq!(cells.len(), names.len(), "{line}");
            let named = names.iter().zip(cells);
            named
                .map(|(name, cell)| ((*name).to_owned(), cell.to_owned()))
                .collect()
        })
        .collect()
}

/// A cell as a number; `None` where it is empty.
pub fn number(row: &HashMap<String, String>, name: &str) -> Option<f64> {
    let cell = &row[name];
    (!cell.is_empty()).then(|| cell.parse().expect("a number"))
}
