//! `tabor sweep` from outside: cases, tables, shares, what a kill leaves, and what it refuses.

use std::collections::HashMap;
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use crate::shared::binary::{BINARY, command, errors, tabor};
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

/// Rough surfaces that let go within the last step, in which some loads take more than 30 iterations.
const LETS_GO: &str = r#"
[grid]
points = 32
size = "4 um"
[solid]
contact_modulus = "40 MPa"
[[surface]]
kind = "self-affine"
hurst = 0.8
rms_height = "80 nm"
longest = "4 um"
rolloff = "2 um"
shortest = "1 um"
[adhesion]
law = "maugis-dugdale"
work_of_adhesion = "50 mJ/m^2"
range = "40 nm"
[loading]
control = "pressure"
path = ["100 kPa", "1 MPa", "0 Pa", "-1 MPa"]
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
fn rows(path: &Path) -> Vec<HashMap<String, String>> {
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
        fs::metadata(out.join("means.png"))
            .expect("a picture")
            .len()
            > 1000
    );
    let svg = fs::read_to_string(out.join("means.svg")).expect("a picture");
    assert!(svg.contains("<svg") && svg.contains(">rms slope<"), "{svg}");
    assert!(svg.contains(">work of adhesion 5 mJ/m^2<"), "{svg}");
    // Mean and standard deviation over the seeds, from the column of the runs.
    let means = rows(&out.join("means.csv"));
    assert_eq!(means.len(), 4);
    for mean in &means {
        let keys = ["surface.0.rms_slope", "adhesion.work_of_adhesion"];
        let own = |run: &&HashMap<String, String>| {
            keys.iter()
                .all(|key| run[*key].parse::<f64>() == mean[*key].parse::<f64>())
        };
        let forces = runs
            .iter()
            .filter(own)
            .map(|run| run["pull_off_force"].parse::<f64>().expect("a number"));
        let forces: Vec<f64> = forces.collect();
        assert_eq!(mean["runs"], "3");
        assert_eq!(forces.len(), 3);
        let expected = forces.iter().sum::<f64>() / 3.0;
        let squares = forces.iter().map(|force| (force - expected).powi(2));
        let spread = (squares.sum::<f64>() / 2.0).sqrt();
        // The same three numbers: rounding alone may differ.
        let number = |name: &str| mean[name].parse::<f64>().expect("a number");
        assert!((number("pull_off_force") - expected).abs() <= 1e-14 * expected);
        assert!((number("standard_deviation") - spread).abs() <= 1e-12 * expected);
        assert!(spread > 0.0, "seeds differ");
    }
}

fn shares_join_to_the_whole() {
    let place = folder(STUDY);
    let whole = tabor(
        place.path(),
        &[
            "sweep",
            "study.toml",
            "--out",
            "whole",
            "--quiet",
            "--jobs",
            "3",
            "--threads",
            "1",
        ],
    );
    assert_eq!(whole.status.code(), Some(0), "{}", errors(&whole));
    // Two shares in one folder, the third in one of its own; on other threads, with the same bits.
    for (share, out) in [("1/3", "joined"), ("2/3", "joined"), ("3/3", "third")] {
        let call = [
            "sweep",
            "study.toml",
            "--out",
            out,
            "--only",
            share,
            "--quiet",
            "--jobs",
            "1",
            "--threads",
            "2",
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
    let call = ["sweep", "study.toml", "--out", "listed", "--merge"];
    let output = tabor(place.path(), &call);
    assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
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
    // One iteration is too few for any of these cases.
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

fn a_case_that_did_not_converge_is_solved_again() {
    let place =
        folder("scene = \"scene.toml\"\naxis = [{ key = \"surface.0.seed\", values = [1, 2] }]\n");
    let call = ["sweep", "study.toml", "--out", "out", "--only", "1/2"];
    assert_eq!(tabor(place.path(), &call).status.code(), Some(0));
    let first = fs::read_to_string(place.path().join("out/cases_1of2.jsonl")).expect("a case");
    let hasty = [
        "sweep",
        "study.toml",
        "--out",
        "out",
        "--set",
        "solver.max_iterations=3",
    ];
    let output = tabor(place.path(), &hasty);
    assert_eq!(output.status.code(), Some(3), "{}", errors(&output));
    assert!(errors(&output).contains("case 2: step 1 did not converge"));
    let output = tabor(place.path(), &["sweep", "study.toml", "--out", "out"]);
    assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    let runs = rows(&place.path().join("out/runs.csv"));
    assert_eq!(runs.len(), 2);
    assert!(runs.iter().all(|run| run["status"] == "finished"));
    // The first case stands as it was.
    let kept = fs::read_to_string(place.path().join("out/cases_1of2.jsonl")).expect("a case");
    assert_eq!(first, kept);
}

/// Pull-off between two loads, one of which did not converge, is no result: more iterations find it.
fn a_case_whose_pull_off_is_not_known_as_asked_is_solved_again() {
    let study = r#"
        scene = "scene.toml"
        [set]
        solver.max_iterations = 30
        [[axis]]
        key = "surface.0.seed"
        values = [1]
    "#;
    let folder = folder(study);
    let path = folder.path();
    fs::write(path.join("scene.toml"), LETS_GO).expect("written");
    let bounds = |row: &HashMap<String, String>| {
        ["pull_off_lower", "pull_off_upper"].map(|name| row[name].parse::<f64>().expect("a force"))
    };
    let output = tabor(path, &["sweep", "study.toml", "--out", "out"]);
    assert_eq!(output.status.code(), Some(3), "{}", errors(&output));
    let row = &rows(&path.join("out/runs.csv"))[0];
    assert_eq!(row["status"], "not-converged");
    assert!(row["message"].contains("did not converge; allow more max_iterations"));
    let [lower, upper] = bounds(row);
    assert!(upper > 1.01 * lower, "{lower} to {upper}");
    let set = ["--set", "solver.max_iterations=5000"];
    let again = [&["sweep", "study.toml", "--out", "out"][..], &set].concat();
    let output = tabor(path, &again);
    assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    let row = &rows(&path.join("out/runs.csv"))[0];
    assert_eq!(row["status"], "finished");
    let [lower, upper] = bounds(row);
    assert!(upper <= 1.01 * lower, "{lower} to {upper}");
}

/// Folders that are asked for once their cases are finished are not made, and that is said.
fn folders_of_cases_that_are_finished_are_told_to_be_missing() {
    let study = "scene = \"scene.toml\"\naxis = [{ key = \"surface.0.seed\", values = [1, 2] }]\n";
    let place = folder(study);
    let sweep = || {
        let output = tabor(place.path(), &["sweep", "study.toml", "--out", "out"]);
        assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
        errors(&output)
    };
    assert!(!sweep().contains("folders"));
    fs::write(
        place.path().join("study.toml"),
        format!("folders = [2]\n{study}"),
    )
    .expect("written");
    let said = sweep();
    assert!(
        said.contains(
            "folders: 1 of the cases that were finished before have none, the first of them case 2"
        ),
        "{said}"
    );
    assert!(!place.path().join("out/case_0002").exists());
}

/// Crops of a map, files, values that change together, and folders of chosen cases.
fn axes_take_lists_files_and_several_keys() {
    let place = folder(
        r#"
scene = "map.toml"
folders = [4]
set.solver.tolerance = 1e-5
[[axis]]
keys = ["surface.0.crop", "solid.young_modulus"]
values = [[[0, 0, 16, 16], "1 MPa"], [[16, 0, 16, 16], "2 MPa"], [[0, 16, 16, 16], "3 MPa"]]
[[axis]]
key = "loading.path.0"
from = "1 kPa"
to = "4 kPa"
count = 3
spacing = "log"
"#,
    );
    let map: String = (0..32)
        .map(|y| {
            let row = (0..32).map(|x| format!("{} ", (x * 7 + y * 11) % 13));
            row.collect::<String>() + "\n"
        })
        .collect();
    fs::write(place.path().join("map.txt"), &map).expect("written");
    let scene = "[grid]\nsize = \"3.2 um\"\n[solid]\nyoung_modulus = \"1 MPa\"\npoisson_ratio = 0.3\n[[surface]]\nkind = \"file\"\npath = \"map.txt\"\nunit = \"nm\"\n[loading]\ncontrol = \"pressure\"\npath = [1e3]\n";
    fs::write(place.path().join("map.toml"), scene).expect("written");
    let call = ["sweep", "study.toml", "--out", "out", "--quiet"];
    let output = tabor(place.path(), &call);
    assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    let runs = rows(&place.path().join("out/runs.csv"));
    assert_eq!(runs.len(), 9);
    let cells = |name: &str| -> Vec<&str> { runs.iter().map(|run| run[name].as_str()).collect() };
    assert_eq!(cells("loading.path.0")[..3], ["1000", "2000", "4000"]);
    assert_eq!(cells("surface.0.crop")[3], "[16, 0, 16, 16]");
    assert_eq!(cells("solid.young_modulus")[3], "2000000");
    // The folder of a case is that of its run.
    let set = [
        "surface.0.crop=[16, 0, 16, 16]",
        "solid.young_modulus=2 MPa",
        "loading.path.0=1 kPa",
        "solver.tolerance=1e-5",
    ];
    let mut call = vec!["run", "map.toml", "--out", "one", "--quiet"];
    set.iter().for_each(|set| call.extend(["--set", set]));
    let one = tabor(place.path(), &call);
    assert_eq!(one.status.code(), Some(0), "{}", errors(&one));
    let [kept, alone] = ["out/case_0004", "one"]
        .map(|folder| without_seconds(&place.path().join(folder).join("curve.csv")));
    assert_eq!(kept, alone);
    assert!(!place.path().join("out/case_0001").exists());
    let areas: std::collections::BTreeSet<&str> =
        cells("last_contact_area_fraction").into_iter().collect();
    assert!(areas.len() > 6, "places and loads differ: {areas:?}");
    // Another content of the map is another study; a map that is not there is a case that failed.
    fs::write(place.path().join("map.txt"), map.replacen('1', "2", 1)).expect("written");
    let call = ["sweep", "study.toml", "--out", "out", "--quiet"];
    let output = tabor(place.path(), &call);
    assert_eq!(output.status.code(), Some(2), "{}", errors(&output));
    assert!(
        errors(&output).contains("checksums of files"),
        "{}",
        errors(&output)
    );
    let study = "scene = \"map.toml\"\naxis = [{ key = \"surface.0.path\", values = [\"map.txt\", \"absent.txt\"] }]\n";
    fs::write(place.path().join("study.toml"), study).expect("written");
    let output = tabor(place.path(), &["sweep", "study.toml", "--out", "paths"]);
    assert_eq!(output.status.code(), Some(3), "{}", errors(&output));
    assert!(errors(&output).contains("case 2: ") && errors(&output).contains("absent.txt"));
    let runs = rows(&place.path().join("paths/runs.csv"));
    assert_eq!(
        [&runs[0]["status"], &runs[1]["status"]],
        ["finished", "failed"]
    );
}

/// A limit on the length of files stands in for a full disk.
#[cfg(target_os = "linux")]
fn a_full_disk_ends_a_study_and_keeps_what_is_finished() {
    let place = folder(STUDY);
    // In units of 1024 bytes: the study is identified in about 2 of them, a case takes 1.
    let script = "ulimit -f 5; exec \"$0\" sweep study.toml --out out --jobs 1 --quiet";
    let limited = std::process::Command::new("bash")
        .current_dir(place.path())
        .args(["-c", script, BINARY])
        .output()
        .expect("there is a shell");
    assert_eq!(limited.status.code(), Some(1), "{}", errors(&limited));
    let said = errors(&limited);
    assert_eq!(said.lines().count(), 1, "{said}");
    assert!(said.contains("cannot write out/cases.jsonl: "), "{said}");
    let cases = place.path().join("out/cases.jsonl");
    let before = fs::read_to_string(&cases).expect("cases");
    let whole = before.lines().filter(|line| line.ends_with('}')).count();
    assert!((1..12).contains(&whole), "{before}");
    let output = tabor(place.path(), &["sweep", "study.toml", "--out", "out"]);
    assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    assert!(errors(&output).contains(&format!(
        "{whole} cases are finished already; {} are left",
        12 - whole
    )));
    assert_eq!(rows(&place.path().join("out/runs.csv")).len(), 12);
}

/// Other systems have no such limit.
#[cfg(not(target_os = "linux"))]
fn a_full_disk_ends_a_study_and_keeps_what_is_finished() {}

/// The shipped study has the cases that its page tells of, and the last of them runs.
fn the_shipped_study_runs() {
    let study = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/studies/roughness.toml");
    let study = study.to_str().expect("a name");
    let place = tempfile::tempdir().expect("a folder");
    let list = tabor(place.path(), &["sweep", study, "--list"]);
    assert_eq!(list.status.code(), Some(0), "{}", errors(&list));
    assert_eq!(
        list.stdout.iter().filter(|byte| **byte == b'\n').count(),
        210
    );
    let mut call = vec![
        "sweep",
        study,
        "--only",
        "210/210",
        "--set",
        "grid.points=64",
    ];
    call.extend(["--set", "surface.0.shortest=3.2 um"]);
    let output = tabor(place.path(), &call);
    assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    let said = errors(&output);
    assert!(
        said.contains("1 of 1 cases solved; those of share 210/210"),
        "{said}"
    );
}

/// What `[plot]` names and no run has is warned of, and pictures of another `[plot]` do not stay.
fn a_plot_of_what_is_not_there_is_warned_of() {
    let place = folder("");
    let out = place.path().join("out");
    let sweep = |plot: &str| {
        let study = format!(
            "scene = \"scene.toml\"\nset.loading.path = [2e5]\nplot = {{ {plot} }}\n[[axis]]\nkey = \"adhesion.law\"\nvalues = [\"maugis-dugdale\", \"exponential\"]\n[[axis]]\nkey = \"adhesion.range\"\nvalues = [\"auto\", \"20 nm\"]\n[[axis]]\nkey = \"surface.0.seed\"\nvalues = [1, 2]\n"
        );
        fs::write(place.path().join("study.toml"), study).expect("written");
        let call = ["sweep", "study.toml", "--out", "out", "--quiet"];
        let output = tabor(place.path(), &call);
        assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
        (errors(&output), out.join("means.csv").exists())
    };
    let (said, is_there) = sweep("x = \"surface.0.seed\"");
    assert!(is_there && !said.contains("plot"), "{said}");
    assert!(out.join("means.png").exists());
    for (plot, expected) in [
        (
            "x = \"adhesion.law\"",
            "plot.x: no finished case has a number at adhesion.law; take a key with numbers as x",
        ),
        (
            "x = \"surface.0.seed\", y = \"hysteresis_energy\"",
            "plot.y: no finished case has hysteresis_energy; they have largest_contact_area_fraction, ",
        ),
    ] {
        let (said, is_there) = sweep(plot);
        assert!(
            said.contains(expected) && said.contains("no means and no picture"),
            "{said}"
        );
        assert!(!is_there && !out.join("means.png").exists(), "{plot}");
    }
    let (said, is_there) = sweep("x = \"adhesion.range\"");
    assert!(
        is_there && said.contains("without a number at adhesion.range, which are in no mean: 4"),
        "{said}"
    );
}

/// A case whose load is still carried has no pull-off, and is in no mean of it.
fn cases_without_what_is_averaged_are_told() {
    let place = folder("");
    let study = "scene = \"scene.toml\"\nset.loading.path = [2e5, 0]\n[[axis]]\nkey = \"loading.path.1\"\nvalues = [1e5, -1e9]\n\
                 [[axis]]\nkey = \"surface.0.seed\"\nvalues = [1, 2]\n";
    fs::write(place.path().join("study.toml"), study).expect("written");
    let call = ["sweep", "study.toml", "--out", "out", "--quiet"];
    let output = tabor(place.path(), &call);
    assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    let said = errors(&output);
    assert!(
        said.contains("finished cases without pull_off_force, which are in no mean: 2"),
        "{said}"
    );
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
                "{axis}key = \"surface.0.seed\"\nfrom = 1\nto = 100000\ncount = 100000\n[[axis]]\nkey = \"grid.points\"\nfrom = 1\nto = 100\ncount = 100\n"
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
        (
            &format!(
                "plot = {{ x = \"surface.0.seed\", series = \"surface.0.seed\" }}\n{axis}key = \"surface.0.seed\"\nvalues = [1]\n"
            ),
            "plot.series: surface.0.seed is x already",
        ),
        (
            &format!("{axis}key = \"surface.0.seed\"\nvalues = [1, 2, 1]\n"),
            "axis 1 (surface.0.seed): 1 comes twice; leave one of them out",
        ),
        (
            &format!("{axis}key = \"adhesion.work_of_adhesion\"\nvalues = [\"50 mJ/m^2\", 0.05]\n"),
            "0.05 is the same as \"50 mJ/m^2\"",
        ),
        (
            &format!("{axis}key = \"grid.points\"\nvalues = [32, [32, 32]]\n"),
            "[32, 32] is the same as 32",
        ),
        // A key that the resolved scene does not have: it has the loads of the ramp.
        (
            &format!(
                "{axis}key = \"loading\"\nvalues = [{{ control = \"pressure\", start = 0.0, ramp = [{{ to = 1e6, steps = 2 }}] }}]\n[[axis]]\nkey = \"loading.start\"\nvalues = [\"1 kPa\", 1000.0]\n"
            ),
            "axis 2 (loading.start): 1000.0 is the same as \"1 kPa\"",
        ),
        (
            &format!(
                "{axis}keys = [\"surface.0.seed\", \"grid.points\"]\nvalues = [[1, 32], [2, 32], [1, 32]]\n"
            ),
            "axis 1 (surface.0.seed, grid.points): 1, 32 comes twice",
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
    a_case_that_did_not_converge_is_solved_again,
    a_case_whose_pull_off_is_not_known_as_asked_is_solved_again,
    axes_take_lists_files_and_several_keys,
    folders_of_cases_that_are_finished_are_told_to_be_missing,
    a_full_disk_ends_a_study_and_keeps_what_is_finished,
    the_shipped_study_runs,
    a_plot_of_what_is_not_there_is_warned_of,
    cases_without_what_is_averaged_are_told,
    what_is_no_study_is_refused_in_one_message,
];
