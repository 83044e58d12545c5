//! `summary.json`: the run and its main results, for programs.

use std::path::Path;

use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};
use serde_json::Value;

use super::error::OutputError;
use super::folder::write_within;

/// Content of `summary.json`, SI units; `None` is written as `null`.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Summary {
    /// Version of tabor.
    pub version: String,
    /// The scene as resolved, with its defaults and the lengths of the law that `"auto"` stands for.
    pub scene: Value,
    /// The effects that ran and those that did not.
    pub effects: Effects,
    /// The backend: `cpu` or `gpu`.
    pub backend: String,
    /// Name of the graphics adapter, if one was used.
    pub adapter: Option<String>,
    /// Arithmetic: `single`, `mixed` or `double`.
    pub precision: String,
    /// Wall-clock seconds by phase.
    pub seconds: Seconds,
    /// Number of real two-dimensional transforms; other grids count in proportion to their points.
    pub transforms: f64,
    /// Largest resident memory of the process, if the system reports it.
    pub peak_memory_bytes: Option<u64>,
    /// Largest contact area fraction among the steps.
    pub largest_contact_area_fraction: Option<f64>,
    /// The pull-off force, N, positive: under a prescribed load the greatest tension known to be
    /// carried before the contact separated, else the largest tension among the steps of a path
    /// that continues beyond it.
    pub pull_off_force: Option<f64>,
    /// The step of that tension, or the last step that carried its load.
    pub pull_off_step: Option<usize>,
    /// Under a prescribed load: the greatest tension known to be carried, N.
    pub pull_off_lower: Option<f64>,
    /// Under a prescribed load: the least tension known not to be carried, N.
    pub pull_off_upper: Option<f64>,
    /// Steps in which surfaces jumped into contact.
    pub jump_in_steps: Vec<usize>,
    /// Steps in which surfaces jumped out of contact.
    pub jump_off_steps: Vec<usize>,
    /// Energy lost over a path that returns to its start, J.
    pub hysteresis_energy: Option<f64>,
    /// How far from it the energy may be, J, for what lies between the steps.
    pub hysteresis_uncertainty: Option<f64>,
    /// The warnings printed on standard error.
    pub warnings: Vec<String>,
}

/// Names of the effects that the scene switched on, and of the others.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct Effects {
    /// Named by the scene.
    pub on: Vec<String>,
    /// Supported by this version, not named by the scene.
    pub off: Vec<String>,
}

/// Wall-clock seconds by phase, in order of first use.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Seconds {
    phases: Vec<(String, f64)>,
}

impl Seconds {
    /// Adds `seconds` to `phase`.
    pub fn add(&mut self, phase: &str, seconds: f64) {
        match self.phases.iter_mut().find(|(name, _)| name == phase) {
            Some((_, sum)) => *sum += seconds,
            None => self.phases.push((phase.to_owned(), seconds)),
        }
    }

    /// Seconds of `phase` so far.
    pub fn get(&self, phase: &str) -> Option<f64> {
        let found = self.phases.iter().find(|(name, _)| name == phase);
        found.map(|(_, seconds)| *seconds)
    }
}

impl Serialize for Seconds {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.phases.len()))?;
        for (phase, seconds) in &self.phases {
            map.serialize_entry(phase, seconds)?;
        }
        map.end()
    }
}

impl Summary {
    /// Writes the summary to `path`, in one piece.
    pub fn write(&self, path: &Path) -> Result<(), OutputError> {
        let mut text = serde_json::to_string_pretty(self)
            .map_err(|error| OutputError::write("write", path)(error.into()))?;
        text.push('\n');
        write_within(path, text.as_bytes())
    }
}

/// Largest resident memory of this process so far, bytes; `None` if the system does not report it.
pub fn peak_memory_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    parse_peak_memory(&status)
}

/// Reads the high-water mark, such as `VmHWM:   12345 kB`.
fn parse_peak_memory(status: &str) -> Option<u64> {
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes * 1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_keys_are_those_of_the_contract() {
        let mut seconds = Seconds::default();
        seconds.add("solve", 1.0);
        seconds.add("output", 0.5);
        seconds.add("solve", 2.0);
        assert_eq!(seconds.get("solve"), Some(3.0));
        let summary = Summary {
            version: "0.1.0".into(),
            scene: serde_json::json!({ "title": "a" }),
            effects: Effects::default(),
            backend: "cpu".into(),
            adapter: None,
            precision: "double".into(),
            seconds,
            transforms: 12.0,
            peak_memory_bytes: None,
            largest_contact_area_fraction: Some(0.25),
            pull_off_force: None,
            pull_off_step: None,
            pull_off_lower: None,
            pull_off_upper: None,
            jump_in_steps: vec![2],
            jump_off_steps: vec![],
            hysteresis_energy: None,
            hysteresis_uncertainty: None,
            warnings: vec![],
        };
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("summary.json");
        summary.write(&path).unwrap();
        let read: Value = serde_json::from_slice(&std::fs::read(&path).unwrap()).unwrap();
        let keys: Vec<&str> = read
            .as_object()
            .unwrap()
            .keys()
            .map(String::as_str)
            .collect();
        let expected = [
            "version",
            "scene",
            "effects",
            "backend",
            "adapter",
            "precision",
            "seconds",
            "transforms",
            "peak_memory_bytes",
            "largest_contact_area_fraction",
            "pull_off_force",
            "pull_off_step",
            "pull_off_lower",
            "pull_off_upper",
            "jump_in_steps",
            "jump_off_steps",
            "hysteresis_energy",
            "hysteresis_uncertainty",
            "warnings",
        ];
        assert_eq!(keys, expected);
        assert_eq!(read["seconds"]["solve"], 3.0);
        assert!(read["pull_off_force"].is_null());
    }

    #[test]
    fn peak_memory_is_read_in_bytes() {
        let status = "VmPeak:\t  999 kB\nVmHWM:\t   1500 kB\nThreads:\t1\n";
        assert_eq!(parse_peak_memory(status), Some(1_536_000));
        assert_eq!(parse_peak_memory("Threads:\t1\n"), None);
        if cfg!(target_os = "linux") {
            assert!(peak_memory_bytes().is_some_and(|bytes| bytes > 100_000));
        }
    }
}
