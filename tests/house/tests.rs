//! The tests themselves: few binaries, and none of their tests is lost.

use std::fs;
use std::path::{Path, PathBuf};

/// Each binary is linked with the whole library, which costs more than most of its tests.
const MOST_BINARIES: usize = 8;

fn binaries() -> Vec<PathBuf> {
    let tests = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
    let entries = fs::read_dir(tests).expect("the folder is readable");
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    paths.retain(|path| {
        path.join("main.rs").exists() || path.extension().is_some_and(|end| end == "rs")
    });
    paths
}

#[test]
fn there_are_few_binaries() {
    let binaries = binaries();
    assert!(binaries.len() > 4, "{binaries:?}");
    assert!(binaries.len() <= MOST_BINARIES, "{binaries:?}");
}

/// In a binary with a harness of its own the compiler drops whatever `#[test]` marks, without a word.
#[test]
fn a_binary_with_a_list_of_tests_marks_none() {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml");
    let manifest = fs::read_to_string(manifest).expect("the manifest is readable");
    // Of the packages that the core has, so that lints of the core may take this binary along.
    let manifest: toml_edit::DocumentMut = manifest.parse().expect("TOML");
    let listed = manifest["test"].as_array_of_tables();
    let listed = listed.expect("sections of tests");
    assert!(listed.len() > 3, "{listed}");
    for section in listed {
        assert_eq!(section["harness"].as_bool(), Some(false), "{section}");
        let name = section["name"].as_str().expect("a name");
        let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("tests")
            .join(name);
        let mut files = Vec::new();
        crate::layers::rust_files(&folder, &mut files);
        assert!(files.len() > 2, "{name}: {files:?}");
        for file in files {
            let text = fs::read_to_string(&file).expect("the file is readable");
            let marked = text.lines().any(|line| line.trim() == "#[test]");
            assert!(
                !marked,
                "{}: tests of this binary are listed in tests![..], and #[test] drops them",
                file.display()
            );
        }
    }
}
