//! Every shipped scene runs to its end, at reduced size.

use std::fs;
use std::path::Path;
use std::process::Command;

/// Points a side at most, so that all scenes together take seconds.
const POINTS: u64 = 64;

#[test]
fn every_shipped_scene_runs() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/scenes");
    let results = tempfile::tempdir().expect("a temporary folder");
    let mut count = 0;
    for entry in fs::read_dir(&folder)
        .expect("the scenes are there")
        .flatten()
    {
        let path = entry.path();
        if path.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        let text = fs::read_to_string(&path).expect("a scene");
        let name = path
            .file_stem()
            .and_then(|name| name.to_str())
            .expect("a name")
            .to_owned();
        let mut command = Command::new(env!("CARGO_BIN_EXE_tabor"));
        command
            .arg("run")
            .arg(&path)
            .arg("--quiet")
            .arg("--out")
            .arg(results.path().join(&name));
        // A height file brings its own points.
        if !text.contains("kind = \"file\"") {
            command.args(["--set", &format!("grid.points={POINTS}")]);
        }
        // Waves that the small grid cannot hold are left out, with a warning.
        let output = command.output().expect("the binary runs");
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{name}: {message}");
        let curve =
            fs::read_to_string(results.path().join(&name).join("curve.csv")).expect("a curve");
        assert!(curve.lines().count() > 1, "{name}");
        assert!(
            curve.lines().skip(1).all(|line| line.contains(",true,")),
            "{name}"
        );
        count += 1;
    }
    assert!(count >= 2);
}
