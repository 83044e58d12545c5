//! Tests of the folder of a run.

use super::*;

fn touch(path: &Path) {
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, "x").unwrap();
}

#[test]
fn a_new_folder_is_marked_and_an_empty_one_is_taken() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("a/b");
    RunFolder::open(&path, "one").unwrap();
    let marker: serde_json::Value =
        serde_json::from_slice(&fs::read(path.join("state/scene.json")).unwrap()).unwrap();
    assert_eq!(marker["fingerprint"], "one");
    assert_eq!(marker["tabor"], env!("CARGO_PKG_VERSION"));
    RunFolder::open(place.path().join("a/b").as_path(), "one").unwrap();
}

#[test]
fn a_folder_is_held_until_its_run_ends() {
    let place = tempfile::tempdir().unwrap();
    let first = RunFolder::open(place.path(), "one").unwrap();
    touch(&first.curve_path());
    let copy = first.clone();
    drop(first);
    for open in [RunFolder::open, |path: &Path, scene: &str| {
        RunFolder::resume(path, scene).map(|(folder, _)| folder)
    }] {
        let refused = open(place.path(), "one").unwrap_err().to_string();
        let me = format!("process {}", std::process::id());
        assert!(refused.contains(&me), "{refused}");
    }
    assert!(copy.curve_path().exists(), "nothing was touched");
    drop(copy);
    let lock = fs::read(place.path().join("state/lock")).unwrap();
    assert!(lock.is_empty(), "nobody holds it");
    RunFolder::open(place.path(), "one").unwrap();
}

#[test]
fn foreign_folders_other_scenes_and_files_are_refused_untouched() {
    let place = tempfile::tempdir().unwrap();
    let foreign = place.path().join("thesis");
    touch(&foreign.join("summary.json"));
    touch(&foreign.join("state/scene.json"));
    let refused = |path: &Path, fingerprint: &str| {
        matches!(
            RunFolder::open(path, fingerprint),
            Err(OutputError::Refused { .. })
        )
    };
    assert!(refused(&foreign, "one"));
    assert_eq!(fs::read(foreign.join("summary.json")).unwrap(), b"x");
    assert!(refused(&foreign.join("summary.json"), "one"));

    let other = place.path().join("other");
    let folder = RunFolder::open(&other, "one").unwrap();
    touch(&folder.curve_path());
    assert!(refused(&other, "two"));
    assert!(folder.curve_path().exists());
}

#[test]
fn the_same_scene_replaces_its_own_files_and_no_others() {
    let place = tempfile::tempdir().unwrap();
    let folder = RunFolder::open(place.path(), "one").unwrap();
    let own = [
        folder.curve_path(),
        folder.summary_path(),
        folder.report_path(),
        folder.image_path(3, FieldName::Pressure),
        folder.field_path(12345, FieldName::Gap),
        folder.volume_path(3),
        folder.curve_picture_path(),
        folder.curve_vector_path(),
        folder.state_path("step.json"),
        place
            .path()
            .join("fields/.step_0001_gap.npy.tabor-unfinished"),
    ];
    let others = [
        place.path().join("notes.txt"),
        place.path().join("images/step_0003_annotated.png"),
        place.path().join("images/step_3_gap.png"),
        place.path().join("fields/step_0003_gap.npz"),
        place.path().join("state/mine.npy"),
    ];
    for path in own.iter().chain(&others) {
        touch(path);
    }
    // The run that wrote them has ended.
    drop(folder);
    let (unfinished, whole) = own.split_last().unwrap();
    RunFolder::resume(place.path(), "one").unwrap();
    assert!(whole.iter().all(|path| path.exists()) && !unfinished.exists());
    RunFolder::open(place.path(), "one").unwrap();
    assert!(own.iter().all(|path| !path.exists()));
    assert!(others.iter().all(|path| path.exists()));
}

#[test]
fn resuming_starts_a_run_where_there_is_none() {
    let place = tempfile::tempdir().unwrap();
    let cut_short = place.path().join("cut_short");
    touch(&cut_short.join("state/.scene.json.tabor-unfinished"));
    for path in [place.path().join("none"), cut_short] {
        let (_, there) = RunFolder::resume(&path, "one").unwrap();
        assert!(!there);
        touch(&path.join("fields/.step_0001_gap.npy.tabor-unfinished"));
        let (folder, there) = RunFolder::resume(&path, "one").unwrap();
        assert!(there);
        let left = fs::read_dir(path.join("fields")).unwrap().count();
        assert_eq!(left, 0, "what was being written is gone");
        folder.expect_present().unwrap();
        fs::remove_dir_all(&path).unwrap();
        assert!(folder.expect_present().is_err());
    }
    let foreign = place.path().join("foreign");
    touch(&foreign.join("state/mine"));
    let outcome = RunFolder::resume(&foreign, "one");
    assert!(matches!(outcome, Err(OutputError::Refused { .. })));
}

#[test]
fn steps_are_known_by_their_names() {
    let cases = [
        ("step_0003_gap.png", Some(3)),
        ("step_12345_pressure.npy", Some(12345)),
        ("step_0003.vti", Some(3)),
        ("step_3.vti", None),
        ("step_0003_gap.vti", None),
        ("step_0003_mine.png", None),
        ("step_+003.vti", None),
    ];
    for (name, step) in cases {
        assert_eq!(step_of(name), step, "{name}");
    }
}
