//! Every shipped scene runs to its end, at reduced size.

use std::fs;
use std::path::Path;

use crate::shared::binary;
use crate::shared::trials::tests;

/// Points a side at most, so that all scenes together take seconds.
const POINTS: u64 = 64;

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
        let mut command = binary::command(results.path(), &["run"]);
        command
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
        let message = binary::errors(&output);
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

tests![every_shipped_scene_runs, every_shipped_scene_is_shown,];
