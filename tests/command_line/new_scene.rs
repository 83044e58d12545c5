//! `tabor new`: scenes to begin with, which pass the check and run.

use std::fs;

use crate::shared::binary::{errors, number, table, tabor};
use crate::shared::trials::tests;

/// Kinds, and what makes a scene of each small enough for a test.
const KINDS: [(&str, &[&str]); 6] = [
    ("sphere", &["grid.points=64"]),
    ("rough", &["grid.points=64", "surface.0.shortest=3 um"]),
    ("afm", &["grid.points=64"]),
    ("pillars", &["solver.tolerance=1e-3"]),
    (
        "seal",
        &[
            "grid.points=64",
            "surface.0.shortest=15 um",
            "surface.0.rolloff=50 um",
        ],
    ),
    ("mems", &["grid.points=64", "surface.0.shortest=150 nm"]),
];

fn every_new_scene_passes_the_check_and_runs() {
    let place = tempfile::tempdir().expect("a folder");
    for (kind, smaller) in KINDS {
        let output = tabor(place.path(), &["new", kind]);
        assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
        assert!(output.stdout.is_empty(), "{kind}");
        let scene = format!("{kind}/scene.toml");
        // The check warns of nothing: grid and law of the scene suit each other.
        let output = tabor(place.path(), &["check", &scene]);
        assert_eq!(output.status.code(), Some(0), "{kind}: {}", errors(&output));
        assert!(errors(&output).is_empty(), "{kind}: {}", errors(&output));
        let out = format!("{kind}/out");
        let mut call = vec!["run", &scene, "--out", &out, "--quiet"];
        smaller.iter().for_each(|set| call.extend(["--set", set]));
        let output = tabor(place.path(), &call);
        assert_eq!(output.status.code(), Some(0), "{kind}: {}", errors(&output));
        let rows = table(&place.path().join(&out).join("curve.csv"));
        assert!(rows.iter().all(|row| row["converged"] == "true"), "{kind}");
        // It touches, and what adheres lets go.
        let touches = |row: &&_| number(row, "contact_area_fraction") > Some(0.0);
        assert!(rows.iter().any(|row| touches(&row)), "{kind}");
        let is_apart = rows.last().is_some_and(|row| row["state"] == "separated");
        assert_eq!(is_apart, kind != "seal", "{kind}");
    }
    // What is there stays.
    fs::write(place.path().join("rough/scene.toml"), "mine").expect("written");
    let output = tabor(place.path(), &["new", "rough"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(errors(&output).contains("rough/scene.toml: is there already"));
    let text = fs::read_to_string(place.path().join("rough/scene.toml")).expect("a scene");
    assert_eq!(text, "mine");
}

tests![every_new_scene_passes_the_check_and_runs,];
