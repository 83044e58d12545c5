//! `tabor sweep` from outside: cases, tables, shares, what a kill leaves, and what it refuses.

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use crate::shared::binary::{command, errors, tabor};
use crate::shared::trials::tests;

const SCENE: &str = r#"
[grid]
points = 32
size = "2 um"
[solid]
contact_modulus = "50 MPa"
[[surface]]
kind = "self-affine"
hurst = 0.8
rms_slope = 0.1
longest = "2 um"
rolloff = "1 um"
shortest = "0.25 um"
[adhesion]
law = "maugis-dugdale"
work_of_adhesion = "10 mJ/m^2"
range = "10 nm"
[loading]
control = "pressure"
path = ["0.2 MPa", "1 MPa", "-5 MPa"]
"#;

const STUDY: &str = r#"
title = "Slope and adhesion"
scene = "scene.toml"
[[axis]]
key = "surface.0.rms_slope"
from = 0.05
to = 0.1
count = 2
[[axis]]
key = "adhesion.work_of_adhesion"
values = ["5 mJ/m^2", "10 mJ/m^2"]
[[axis]]
key = "surface.0.seed"
values = [1, 2, 3]
"#;

/// A folder with the scene and the study.
fn folder(study: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("scene.toml"), SCENE).expect("written");
    fs::write(folder.path().join("study.toml"), study).expect("written");
    folder
}

/// Rows of a table by the names of their columns.
fn rows(path: &Path) -> Vec<std::collections::HashMap<String, String>> {
    let mut reader = csv::Reader::from_path(path).expect("a table");
    reader
        .deserialize()
        .map(|row| row.expect("a row"))
        .collect()
}

/// A table without its seconds.
fn without_seconds(path: &Path) -> Vec<Vec<(String, String)>> {
    let mut all = Vec::new();
    for row in rows(path) {
        let mut row: Vec<_> = row
            .into_iter()
            .filter(|(name, _)| name != "seconds")
            .collect();
        row.sort();
        all.push(row);
    }
    all
}

fn a_study_is_one_tidy_table() {
    let place = folder(STUDY);
    let output = tabor(place.path(), &["sweep", "study.toml", "--out", "out"]);
    assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    assert!(
        errors(&output).contains("12 of 12 cases solved"),
        "{}",
        errors(&output)
    );
    let out = place.path().join("out");
    let steps = rows(&out.join("sweep.csv"));
    assert_eq!(steps.len(), 36);
    // Values are in SI, as the scene understood them.
    assert_eq!(steps[0]["adhesion.work_of_adhesion"], "0.005");
    assert_eq!(steps[0]["surface.0.rms_slope"], "0.05");
    assert_eq!(steps[2]["step"], "3");
    let runs = rows(&out.join("runs.csv"));
    assert_eq!(runs.len(), 12);
    assert!(runs.iter().all(|run| run["status"] == "finished"));
    // A case is a run of its scene, to the last bit.
    let last = &runs[11];
    let set = [
        "surface.0.rms_slope=0.1",
        "adhesion.work_of_adhesion=\"10 mJ/m^2\"",
        "surface.0.seed=3",
    ];
    let mut call = vec!["run", "scene.toml", "--out", "one", "--quiet"];
    set.iter().for_each(|set| call.extend(["--set", set]));
    let one = tabor(place.path(), &call);
    assert_eq!(one.status.code(), Some(0), "{}", errors(&one));
    let curve = rows(&place.path().join("one/curve.csv"));
    for (row, step) in curve.iter().zip(&steps[33..]) {
        for (name, value) in row.iter().filter(|(name, _)| *name != "seconds") {
            assert_eq!(&step[name], value, "{name}");
        }
    }
    let text = fs::read_to_string(place.path().join("one/summary.json")).expect("a summary");
    let summary: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(
        last["pull_off_force"].parse::<f64>().ok(),
        summary["pull_off_force"].as_f64()
    );
    // The picture has a size, and its SVG is text.
    assert!(
        fs::metadata(out.join("sweep.png"))
            .expect("a picture")
            .len()
            > 1000
    );
    let svg = fs::read_to_string(out.join("sweep.svg")).expect("a picture");
    assert!(svg.contains("<svg") && svg.contains("rms slope"), "{svg}");
}

fn shares_join_to_the_whole() {
    let place = folder(STUDY);
    let whole = tabor(
        place.path(),
        &["sweep", "study.toml", "--out", "whole", "--quiet"],
    );
    assert_eq!(whole.status.code(), Some(0), "{}", errors(&whole));
    // Two shares in one folder, the third in one of its own.
    for (share, out) in [("1/3", "joined"), ("2/3", "joined"), ("3/3", "third")] {
        let call = [
            "sweep",
            "study.toml",
            "--out",
            out,
            "--only",
            share,
            "--quiet",
        ];
        let output = tabor(place.path(), &call);
        assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    }
    let call = ["sweep", "study.toml", "--out", "joined", "--merge", "third"];
    let output = tabor(place.path(), &call);
    assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    for table in ["sweep.csv", "runs.csv"] {
        let [whole, joined] = ["whole", "joined"].map(|name| place.path().join(name).join(table));
        assert_eq!(without_seconds(&whole), without_seconds(&joined), "{table}");
    }
    // A line of the list is a command for one case.
    let list = tabor(
        place.path(),
        &["sweep", "study.toml", "--out", "listed", "--list"],
    );
    let lines = String::from_utf8(list.stdout).expect("text");
    assert_eq!(lines.lines().count(), 12);
    let words: Vec<&str> = lines
        .lines()
        .nth(4)
        .expect("a line")
        .split(' ')
        .skip(1)
        .collect();
    let one = tabor(place.path(), &words);
    assert_eq!(one.status.code(), Some(0), "{}", errors(&one));
    let runs = rows(&place.path().join("listed/runs.csv"));
    assert_eq!(runs.len(), 1);
    assert_eq!(runs[0]["case"], "5");
}

fn a_killed_study_repeats_no_finished_case() {
    let place = folder(STUDY);
    let call = [
        "sweep",
        "study.toml",
        "--out",
        "out",
        "--jobs",
        "1",
        "--quiet",
    ];
    let cases = place.path().join("out/cases.jsonl");
    let finished = || fs::read_to_string(&cases).unwrap_or_default();
    let mut child = command(place.path(), &call).spawn().expect("it runs");
    let begun = Instant::now();
    while finished().lines().count() < 3 && begun.elapsed() < Duration::from_secs(120) {
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().expect("killed");
    child.wait().expect("ended");
    let before = finished();
    assert!((3..12).contains(&before.lines().count()), "{before}");
    // A line that was being written is dropped.
    fs::write(&cases, format!("{before}{{\"number\":9")).expect("written");
    let output = tabor(place.path(), &["sweep", "study.toml", "--out", "out"]);
    assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    let after = finished();
    assert!(after.starts_with(&before), "{after}");
    assert_eq!(after.lines().count(), 12);
    assert_eq!(rows(&place.path().join("out/runs.csv")).len(), 12);
}

fn a_case_that_fails_is_listed_and_the_others_are_solved() {
    // The range of a scene must be below its heights' grid: one iteration is too few for the adhesive cases.
    let study = STUDY.replace(
        "key = \"surface.0.seed\"\nvalues = [1, 2, 3]",
        "key = \"solver.max_iterations\"\nvalues = [1, 2000]",
    );
    let place = folder(&study);
    let output = tabor(place.path(), &["sweep", "study.toml", "--out", "out"]);
    assert_eq!(output.status.code(), Some(3), "{}", errors(&output));
    assert!(
        errors(&output).contains("4 of 8 cases did not end well"),
        "{}",
        errors(&output)
    );
    let runs = rows(&place.path().join("out/runs.csv"));
    for run in &runs {
        let expected = match run["solver.max_iterations"].as_str() {
            "1" => "not-converged",
            _ => "finished",
        };
        assert_eq!(run["status"], expected);
        assert_eq!(
            run["message"].contains("did not converge"),
            expected == "not-converged"
        );
    }
}

fn what_is_no_study_is_refused_in_one_message() {
    let axis = "scene = \"scene.toml\"\n[[axis]]\n";
    for (study, expected) in [
        ("scene = 3", "study.toml"),
        ("scene = \"scene.toml\"\n", "there is no [[axis]]"),
        (
            &format!("{axis}key = \"surface.0.seed\"\nvalues = []\n"),
            "no values",
        ),
        (
            &format!("{axis}key = \"surface.0.sed\"\nvalues = [1]\n"),
            "sed",
        ),
        (
            &format!("{axis}key = \"surface.0.hurst\"\nvalues = [0.5, 7]\n"),
            "hurst",
        ),
        (
            &format!("{axis}key = \"surface.0.seed\"\nvalues = [1]\nvalue = 2\n"),
            "value",
        ),
        (
            &format!(
                "{axis}key = \"surface.0.seed\"\nfrom = 1\nto = 100000\ncount = 100000\n[[axis]]\nkey = \"grid.points\"\nfrom = 1\nto = 2\ncount = 100\n"
            ),
            "cases are more than",
        ),
        (
            &format!("plot = {{ y = \"pull\" }}\n{axis}key = \"surface.0.seed\"\nvalues = [1]\n"),
            "plot.y",
        ),
        (
            &format!("plot = {{ x = \"pull\" }}\n{axis}key = \"surface.0.seed\"\nvalues = [1]\n"),
            "plot.x",
        ),
    ] {
        let place = folder(study);
        let output = tabor(place.path(), &["sweep", "study.toml", "--out", "out"]);
        assert_eq!(
            output.status.code(),
            Some(2),
            "{study}: {}",
            errors(&output)
        );
        assert!(
            errors(&output).contains(expected),
            "{study}: {}",
            errors(&output)
        );
        assert!(!place.path().join("out").exists(), "{study}");
    }
    let place = folder(STUDY);
    // A folder of something else, and one of another study.
    fs::create_dir(place.path().join("mine")).expect("made");
    fs::write(place.path().join("mine/notes.txt"), "mine").expect("written");
    let output = tabor(place.path(), &["sweep", "study.toml", "--out", "mine"]);
    assert_eq!(output.status.code(), Some(2), "{}", errors(&output));
    let call = [
        "sweep",
        "study.toml",
        "--out",
        "out",
        "--only",
        "1/12",
        "--quiet",
    ];
    assert_eq!(tabor(place.path(), &call).status.code(), Some(0));
    fs::write(
        place.path().join("study.toml"),
        STUDY.replace("[1, 2, 3]", "[1, 2]"),
    )
    .expect("written");
    let output = tabor(place.path(), &["sweep", "study.toml", "--out", "out"]);
    assert_eq!(output.status.code(), Some(2), "{}", errors(&output));
    assert!(
        errors(&output).contains("another study"),
        "{}",
        errors(&output)
    );
}

tests![
    a_study_is_one_tidy_table,
    shares_join_to_the_whole,
    a_killed_study_repeats_no_finished_case,
    a_case_that_fails_is_listed_and_the_others_are_solved,
    what_is_no_study_is_refused_in_one_message,
];
