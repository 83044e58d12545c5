//! The commands of `docs/recipes.md`, as they stand there, on small files of instruments.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::shared::binary::{self, summary};
use crate::shared::trials::tests;

/// Files of the recipes, and the samples that stand for them.
const FILES: [(&str, &str); 3] = [
    ("map.spm", "bruker_map.spm"),
    ("curve.jpk-force", "jpk_alone.jpk-force"),
    ("contact.dat", "zygo_map.dat"),
];

/// Runs the commands under a heading in a folder with the files, and returns the folder and what they said.
fn run(heading: &str) -> (tempfile::TempDir, String) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(root.join("docs/recipes.md")).expect("the page");
    let (_, recipe) = text.split_once(&format!("## {heading}")).expect("a recipe");
    let (_, block) = recipe.split_once("```sh\n").expect("commands");
    let (block, _) = block.split_once("```").expect("their end");
    let calls = block
        .lines()
        .filter(|line| line.starts_with("tabor "))
        .count();
    assert!((1..=3).contains(&calls), "{block}");
    let folder = tempfile::tempdir().expect("a folder");
    for (name, sample) in FILES {
        fs::copy(
            root.join("tests/files").join(sample),
            folder.path().join(name),
        )
        .expect("copied");
    }
    let program = PathBuf::from(env!("CARGO_BIN_EXE_tabor"));
    let paths = std::env::var_os("PATH").unwrap_or_default();
    let paths = program
        .parent()
        .map(Path::to_path_buf)
        .into_iter()
        .chain(std::env::split_paths(&paths));
    let mut shell = Command::new("sh");
    shell.args(["-e", "-c", block]).current_dir(folder.path());
    shell.env("PATH", std::env::join_paths(paths).expect("a path"));
    // Where software stands in for a graphics processor, its shaders would take the time.
    let output = binary::without_adapter(&mut shell)
        .output()
        .expect("a shell");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    (folder, said)
}

fn a_map_leads_to_its_pull_off_and_how_far_it_is_converged() {
    let (folder, said) = run("From a measured map");
    let found = summary(&folder.path().join("pulled"));
    let force = found["pull_off_force"].as_f64().expect("a pull-off force");
    // Less than the law could hold on the whole of the map, 93.75 nm wide.
    assert!(
        force > 0.0 && force < 0.05 / 0.5e-9 * 93.75e-9 * 93.75e-9,
        "{force:e}"
    );
    assert!(said.contains("the pull-off force is"), "{said}");
    let end = said
        .lines()
        .find(|line| line.starts_with("the scene as it is, 48 points, is converged to: "));
    let end = end.unwrap_or_else(|| panic!("no statement: {said}"));
    for quantity in ["contact area", "pull-off"] {
        assert!(end.contains(&format!("{quantity} ")), "{end}");
    }
    // The statement is no better than what another grid gives: this one is pulled on twice as many points.
    let output = binary::tabor(
        folder.path(),
        &[
            "run",
            "map/measured.toml",
            "--out",
            "finer",
            "--set",
            "surface.0.resample=96",
        ],
    );
    assert_eq!(binary::status(&output), 0, "{}", binary::errors(&output));
    let finer = summary(&folder.path().join("finer"))["pull_off_force"]
        .as_f64()
        .expect("a force");
    let stated = end
        .rsplit_once("pull-off ")
        .and_then(|(_, rest)| rest.strip_suffix(" %"));
    let stated: f64 = stated
        .and_then(|share| share.parse().ok())
        .expect("per cent");
    let change = 100.0 * (force / finer - 1.0).abs();
    assert!(
        change < stated + 5.0,
        "{change} % where {stated} % are stated"
    );
}

fn a_raw_curve_leads_to_work_of_adhesion_and_modulus() {
    let (folder, said) = run("From an instrument's force curve");
    let text = fs::read_to_string(folder.path().join("fit/fit.json")).expect("a result");
    let found: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let modulus = &found["contact_modulus"];
    let (value, deviation) = (modulus["value"].as_f64(), modulus["uncertainty"].as_f64());
    // A gel or a cell.
    assert!(
        value.is_some_and(|value| (10.0..1e6).contains(&value)),
        "{modulus}"
    );
    assert!(deviation > Some(0.0), "{modulus}");
    assert!(said.contains("E* = ") && said.contains(" +- "), "{said}");
    assert!(folder.path().join("fit/fit.csv").is_file());
}

fn a_contact_leads_to_its_resistance_and_stiction() {
    let (folder, _) = run("From a contact's map");
    let rows = binary::table(&folder.path().join("closed/curve.csv"));
    let resistance = |row: usize| binary::number(&rows[row], "resistance").expect("a resistance");
    assert!(resistance(0) > resistance(1) && resistance(1) > 0.0);
    assert!(summary(&folder.path().join("closed"))["pull_off_force"].as_f64() > Some(0.0));
    let page = fs::read_to_string(folder.path().join("closed/report.html")).expect("a page");
    for card in ["Resistance", "Pull-off", "Attraction left at zero load"] {
        assert!(page.contains(&format!("<dt>{card}</dt>")), "{card}");
    }
}

tests![
    a_map_leads_to_its_pull_off_and_how_far_it_is_converged,
    a_raw_curve_leads_to_work_of_adhesion_and_modulus,
    a_contact_leads_to_its_resistance_and_stiction,
];
