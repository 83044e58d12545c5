//! What the tests of whole runs share: scenes, the binary, and folders compared file by file.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use serde_json::Value;

/// Adhesive, eight steps up and down and off, every kind of output.
pub const ROUGH: &str = r#"
title = "Rough & <small>"
[grid]
points = [64, 48]
size = ["2 um", "1.5 um"]
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
path = ["0.2 MPa", "1 MPa", "3 MPa", "1 MPa", 0, "-5 MPa", "0.2 MPa", "1 MPa"]
[output]
images = ["pressure", "gap"]
fields = ["pressure", "gap"]
steps = [1, 2, 3, 4, 5, 6, 7, 8]
"#;

/// Rows of the curve in `folder`, cell by cell; none where there is no curve yet.
pub fn rows(folder: &Path) -> Vec<Vec<String>> {
    let text = fs::read_to_string(folder.join("curve.csv")).unwrap_or_default();
    text.split_inclusive('\n')
        .filter(|line| line.ends_with('\n'))
        .skip(1)
        .map(|line| line.trim_end().split(',').map(str::to_owned).collect())
        .collect()
}

/// Every file of a run, by its place, without what may differ between equal runs: the seconds of
/// rows and summary, and its peak memory.
pub fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    collect(folder, "", &mut found);
    if let Some(curve) = found.get_mut("curve.csv") {
        let text = String::from_utf8(curve.clone()).expect("text");
        let seconds = text
            .lines()
            .next()
            .and_then(|head| head.split(',').position(|n| n == "seconds"));
        let kept: Vec<String> = text
            .lines()
            .map(|line| {
                let mut cells: Vec<&str> = line.split(',').collect();
                cells[seconds.expect("a column of seconds")] = "";
                cells.join(",")
            })
            .collect();
        *curve = kept.join("\n").into_bytes();
    }
    if let Some(summary) = found.get_mut("summary.json") {
        let mut value: Value = serde_json::from_slice(summary).expect("JSON");
        let table = value.as_object_mut().expect("a table");
        assert!(table.remove("seconds").is_some());
        assert!(table.remove("peak_memory_bytes").is_some());
        *summary = value.to_string().into_bytes();
    }
    found
}

fn collect(folder: &Path, place: &str, found: &mut BTreeMap<String, Vec<u8>>) {
    for entry in fs::read_dir(folder).expect("a folder").flatten() {
        let name = format!("{place}{}", entry.file_name().to_string_lossy());
        if entry.path().is_dir() {
            collect(&entry.path(), &format!("{name}/"), found);
        } else {
            found.insert(name, fs::read(entry.path()).expect("a file"));
        }
    }
}

/// Fails where two runs differ in a file.
pub fn expect_same(one: &Path, other: &Path, when: &str) {
    let (one, other) = (files(one), files(other));
    let names = |files: &BTreeMap<String, Vec<u8>>| files.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&one), names(&other), "{when}");
    for (name, bytes) in &one {
        assert!(*bytes == other[name], "{name} differs {when}");
    }
}
