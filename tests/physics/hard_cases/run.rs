//! A scene as its user sees it: exit status, messages, curve and fields.

use std::collections::HashMap;
use std::fs::{self, File};
use std::path::Path as FilePath;
use std::process::Stdio;
use std::time::{Duration, Instant};

use tabor::scene::Scene;
use tabor::{RunError, RunObserver, RunOptions, RunStatus};
use tempfile::TempDir;

use super::case::Case;
use super::paths::Path;
use crate::shared::binary::command;

/// Longest time for one run, on a machine that is busy with other things: the slowest takes seconds.
const LONGEST: Duration = Duration::from_secs(300);

/// One row of the curve.
#[derive(Debug, Clone)]
pub struct Row {
    pub approach: Option<f64>,
    pub mean_gap: Option<f64>,
    pub force: f64,
    pub mean_pressure: f64,
    pub contact: f64,
    pub elastic_energy: f64,
    pub iterations: usize,
    pub residual: f64,
    pub converged: bool,
    pub state: String,
}

/// A finished run.
pub struct Run {
    pub status: i32,
    pub messages: String,
    pub rows: Vec<Row>,
    folder: TempDir,
}

/// Runs a case on a path: through the binary on the processor, through the library on the graphics processor,
/// since a software driver compiles shaders anew in each process, which takes longer than all else here.
pub fn run(case: &Case, path: &Path) -> Run {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("scene.toml"), case.scene(path)).expect("a scene");
    for (name, heights) in &case.files {
        write_npy(&folder.path().join(name), case.contact.points, heights);
    }
    let (status, messages) = match path.backend {
        "gpu" => run_library(path, folder.path()),
        _ => run_binary(case, path, folder.path()),
    };
    let curve = fs::read_to_string(folder.path().join("out/curve.csv")).unwrap_or_default();
    let run = Run {
        status,
        rows: rows(&curve),
        messages,
        folder,
    };
    check(case, path, &run, &curve);
    run
}

/// The exit status and the messages of the binary.
fn run_binary(case: &Case, path: &Path, folder: &FilePath) -> (i32, String) {
    let messages = folder.join("messages");
    let call = ["run", "scene.toml", "--out", "out", "--threads", "1"];
    let mut child = command(folder, &call)
        .args(["--backend", path.backend, "--precision", path.precision])
        .stdout(Stdio::null())
        .stderr(File::create(&messages).expect("a file"))
        .spawn()
        .expect("the binary runs");
    let begun = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().expect("a child") {
            break status;
        }
        if begun.elapsed() > LONGEST {
            child.kill().expect("a child");
            panic!("{} on {}: no end after {LONGEST:?}", case.name, path.name);
        }
        std::thread::sleep(Duration::from_millis(3));
    };
    let said = fs::read_to_string(messages).unwrap_or_default();
    (status.code().unwrap_or(-1), said)
}

/// Keeps what a run says, and ends one that takes too long.
struct Listener {
    begun: Instant,
    said: String,
}

impl RunObserver for Listener {
    fn warning(&mut self, text: &str) {
        self.said.push_str(&format!("warning: {text}\n"));
    }

    fn iteration(&mut self, _step: usize, _iteration: usize, _residual: f64) -> bool {
        self.begun.elapsed() < LONGEST
    }
}

/// The status that the binary would exit with, and the same messages.
fn run_library(path: &Path, folder: &FilePath) -> (i32, String) {
    let scene = match Scene::read(&folder.join("scene.toml"), &path.settings()) {
        Ok(scene) => scene,
        Err(errors) => return (2, errors.to_string()),
    };
    let mut listener = Listener {
        begun: Instant::now(),
        said: String::new(),
    };
    let options = RunOptions::new().threads(1);
    match tabor::run_with(scene, &folder.join("out"), &options, &mut listener) {
        Ok(end) => match end.status {
            RunStatus::Finished => (0, listener.said),
            // What the binary makes its last message of.
            RunStatus::NotConverged { residual, .. } => {
                (3, format!("{}residual {residual:.3e}", listener.said))
            }
            other => panic!("{other:?} after {LONGEST:?}"),
        },
        Err(error @ (RunError::Surface(_) | RunError::Device(_))) => (2, error.to_string()),
        Err(error) => panic!("{}: {error}", path.name),
    }
}

/// What holds of every run: a status, finite numbers, and a message where it ends early.
fn check(case: &Case, path: &Path, run: &Run, curve: &str) {
    let what = format!("{} on {}: {}", case.name, path.name, run.messages);
    let status = run.status;
    assert!(matches!(status, 0 | 2 | 3), "{what}: status {status}");
    assert!(!run.messages.contains("panicked"), "{what}");
    for word in ["NaN", "nan", "inf"] {
        let found = curve.lines().skip(1).find(|line| line.contains(word));
        assert!(found.is_none(), "{what}: {found:?}");
    }
    for row in &run.rows {
        assert!(row.iterations <= case.max_iterations, "{what}");
        assert!(!row.converged || row.residual.is_finite(), "{what}");
    }
    let (last, others) = match run.rows.split_last() {
        Some((last, others)) => (Some(last), others),
        None => (None, &[][..]),
    };
    assert!(others.iter().all(|row| row.converged), "{what}");
    match status {
        0 => {
            assert_eq!(run.rows.len(), case.path.len(), "{what}");
            assert!(last.is_some_and(|row| row.converged), "{what}");
        }
        2 => {
            let said = (case.refused)(case, path)
                .unwrap_or_else(|| panic!("{what}: it may not be refused"));
            assert!(
                said.iter().all(|part| run.messages.contains(part)),
                "{what}: not {said:?}"
            );
            assert!(run.rows.is_empty(), "{what}");
        }
        _ => {
            // By how much it missed stands in the row and in the message.
            let missed = last.is_some_and(|row| {
                !row.converged && row.residual.is_finite() && row.residual > case.tolerance(path)
            });
            assert!(missed && run.messages.contains("residual"), "{what}");
            let residual = last.map_or(f64::NAN, |row| row.residual);
            if path.backend == "gpu" {
                assert!(
                    run.messages.contains(&format!("residual {residual:.3e}")),
                    "{what}"
                );
            }
        }
    }
}

impl Run {
    /// A field of a step (from 1); `None` where none was written.
    pub fn field(&self, step: usize, name: &str) -> Option<Vec<f64>> {
        let path = format!("out/fields/step_{step:04}_{name}.npy");
        let bytes = fs::read(self.folder.path().join(path)).ok()?;
        let file = npyz::NpyFile::new(&bytes[..]).expect("an npy file");
        Some(match file.dtype().descr().as_str() {
            "'<f4'" => {
                let values: Vec<f32> = file.into_vec().expect("float32");
                values.into_iter().map(f64::from).collect()
            }
            _ => file.into_vec().expect("float64"),
        })
    }

    /// A list of the summary, such as `jump_in_steps`.
    pub fn steps(&self, name: &str) -> Vec<usize> {
        let text = fs::read_to_string(self.folder.path().join("out/summary.json"));
        let summary: serde_json::Value =
            serde_json::from_str(&text.expect("a summary")).expect("JSON");
        let steps = summary[name].as_array().expect("a list");
        let number = |step: &serde_json::Value| step.as_u64().expect("a number") as usize;
        steps.iter().map(number).collect()
    }

    pub fn states(&self) -> Vec<&str> {
        self.rows.iter().map(|row| row.state.as_str()).collect()
    }
}

fn rows(curve: &str) -> Vec<Row> {
    let mut lines = curve.lines();
    let head: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    lines
        .map(|line| {
            let cells: HashMap<&str, &str> = head.iter().copied().zip(line.split(',')).collect();
            let number = |name: &str| cells[name].parse::<f64>().ok();
            let given = |name: &str| number(name).expect("a number");
            Row {
                approach: number("approach"),
                mean_gap: number("mean_gap"),
                force: given("force"),
                mean_pressure: given("mean_pressure"),
                contact: given("contact_area_fraction"),
                elastic_energy: given("elastic_energy"),
                iterations: given("iterations") as usize,
                residual: given("residual"),
                converged: cells["converged"] == "true",
                state: cells["state"].to_owned(),
            }
        })
        .collect()
}

fn write_npy(path: &FilePath, [nx, ny]: [usize; 2], values: &[f64]) {
    use npyz::WriterBuilder;
    let file = File::create(path).expect("a file");
    let mut writer = npyz::WriteOptions::new()
        .default_dtype()
        .shape(&[ny as u64, nx as u64])
        .writer(file)
        .begin_nd()
        .expect("an npy file");
    writer.extend(values.iter().copied()).expect("numbers");
    writer.finish().expect("an npy file");
}
