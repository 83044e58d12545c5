//! Every shipped scene runs, finds what it found before, and is shown.

use std::fs;
use std::path::{Path, PathBuf};

use crate::shared::binary::{self, number, table};
use crate::shared::trials::tests;

/// What every shipped scene found, by its name.
const RECORDED: &str = include_str!("../reference/shipped_scenes.toml");

/// Share of the cell by which a contact area may differ. Solves end at 1e-6 of the pressure, which leaves the state of
/// some pixels at rims open: 3 of them on the smallest grid (72 x 72), 8 on 128 x 128.
const AREA: f64 = 5e-4;
/// Relative difference of mean gaps, pressures and of a pull-off force that a row has. Near pull-off a contact is so soft
/// that an error of 1e-6 in the pressure is one of its root, 1e-3, in how far the contact has gone.
const RELATIVE: f64 = 1e-3;

fn expect_near(found: f64, recorded: f64, relative: f64, context: &str) {
    assert!(
        (found - recorded).abs() <= relative * recorded.abs(),
        "{context}: {found:e}, recorded {recorded:e}"
    );
}

fn shipped() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/scenes");
    let entries = fs::read_dir(folder).expect("the scenes are there");
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    paths.retain(|path| path.extension().is_some_and(|end| end == "toml"));
    paths.sort();
    paths
}

/// Every shipped scene runs to its end at its own size and finds the contact, the gap, the pull-off and the jumps that
/// it found before.
fn every_shipped_scene_finds_what_is_recorded() {
    let recorded: toml::Table = RECORDED.parse().expect("TOML");
    let results = tempfile::tempdir().expect("a temporary folder");
    let scenes = shipped();
    assert_eq!(scenes.len(), recorded.len(), "one record a scene");
    for path in scenes {
        let name = path.file_stem().and_then(|name| name.to_str());
        let name = name.expect("a name");
        let recorded = (recorded.get(name)).unwrap_or_else(|| panic!("{name} has no record"));
        let out = results.path().join(name);
        let mut command = binary::command(results.path(), &["run", "--quiet", "--backend", "cpu"]);
        command.arg(&path).arg("--out").arg(&out);
        if let Some(points) = recorded.get("points") {
            command.args(["--set", &format!("grid.points={points}")]);
        }
        let output = command.output().expect("the binary runs");
        let message = binary::errors(&output);
        assert_eq!(output.status.code(), Some(0), "{name}: {message}");
        compare(name, &out, recorded);
    }
}

fn compare(name: &str, out: &Path, recorded: &toml::Value) {
    let rows = table(&out.join("curve.csv"));
    assert!(rows.iter().all(|row| row["converged"] == "true"), "{name}");
    assert_eq!(
        Some(rows.len() as i64),
        recorded["rows"].as_integer(),
        "{name}"
    );
    for step in recorded["step"].as_array().expect("steps") {
        let index = step["step"].as_integer().expect("a step");
        let row = &rows[usize::try_from(index - 1).expect("a step from 1 on")];
        let context = |column: &str| format!("{name}, step {index}, {column}");
        let found = |column: &str| number(row, column).expect("a number");
        let kept = |column: &str| step[column].as_float().expect("a number");
        let area = "contact_area_fraction";
        let apart = (found(area) - kept(area)).abs();
        assert!(apart <= AREA, "{}: {apart:e} apart", context(area));
        for column in ["mean_gap", "mean_pressure"] {
            expect_near(found(column), kept(column), RELATIVE, &context(column));
        }
    }
    let summary = binary::summary(out);
    for jumps in ["jump_in_steps", "jump_off_steps"] {
        let kept: Vec<i64> = recorded[jumps].clone().try_into().expect("steps");
        assert_eq!(summary[jumps], serde_json::json!(kept), "{name}, {jumps}");
    }
    let pull_off = summary["pull_off_force"].as_f64();
    let kept = recorded
        .get("pull_off_force")
        .and_then(toml::Value::as_float);
    assert_eq!(pull_off.is_some(), kept.is_some(), "{name}, pull-off");
    if let (Some(found), Some(kept)) = (pull_off, kept) {
        // Under a held load it is searched for, to a tolerance of the scene's own.
        let searched = summary["scene"]["loading"]["pull_off_tolerance"].as_f64();
        expect_near(
            found,
            kept,
            searched.unwrap_or(RELATIVE),
            &format!("{name}, pull-off"),
        );
    }
}

/// Every scene has its section in docs/scenes.md, with pictures that are there and small.
fn every_shipped_scene_is_shown() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = fs::read_to_string(root.join("docs/scenes.md")).expect("the page is there");
    let mut sections = page.split("\n## ");
    sections.next();
    let sections: Vec<(&str, &str)> = sections
        .map(|section| section.split_once('\n').expect("a section has text"))
        .collect();
    for entry in fs::read_dir(root.join("examples/scenes"))
        .expect("the scenes are there")
        .flatten()
    {
        let path = entry.path();
        if path.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        let name = path.file_stem().and_then(|name| name.to_str());
        let section = sections.iter().find(|(title, _)| Some(*title) == name);
        let (_, text) = section.unwrap_or_else(|| panic!("{name:?} is not in docs/scenes.md"));
        let pictures: Vec<&str> = text
            .split("](pictures/")
            .skip(1)
            .filter_map(|rest| rest.split(')').next())
            .collect();
        assert!(!pictures.is_empty(), "{name:?} has no picture");
        for picture in pictures {
            let path = root.join("docs/pictures").join(picture);
            let bytes = fs::metadata(&path)
                .unwrap_or_else(|error| panic!("{picture}: {error}"))
                .len();
            assert!(bytes < 150_000, "{picture} has {bytes} bytes");
        }
    }
}

tests![
    every_shipped_scene_finds_what_is_recorded,
    every_shipped_scene_is_shown,
];
