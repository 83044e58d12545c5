//! The map of the house is true: a module uses only modules above it.

use std::fs;
use std::path::{Path, PathBuf};

/// From the ground up, as the crate page lists them.
const ORDER: [&str; 27] = [
    "units",
    "clock",
    "grid",
    "shared_values",
    "real",
    "plans",
    "law",
    "elastic",
    "kernel",
    "backend",
    "solver",
    "scene",
    "surface",
    "study",
    "flow",
    "effect",
    "output",
    "device",
    "run",
    "contact",
    "theory",
    "compare",
    "fit",
    "accuracy",
    "sweep",
    "cli",
    "lib",
];

pub fn rust_files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder)
        .expect("the folder is readable")
        .flatten()
    {
        let path = entry.path();
        if path.is_dir() {
            rust_files(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

/// Modules that a file names through `crate::`, outside comments.
fn used_modules(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    for line in text
        .lines()
        .map(str::trim_start)
        .filter(|line| !line.starts_with("//"))
    {
        let mut rest = line;
        while let Some(at) = rest.find("crate::") {
            rest = &rest[at + "crate::".len()..];
            let name: String = rest
                .chars()
                .take_while(|c| c.is_ascii_alphanumeric() || *c == '_')
                .collect();
            found.push(name);
        }
    }
    found
}

#[test]
fn modules_look_up_only() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    rust_files(&source, &mut files);
    assert!(files.len() > 20, "too few files: {}", files.len());
    let place = |name: &str| ORDER.iter().position(|module| *module == name);
    let mut wrong = Vec::new();
    for file in files {
        let relative = file.strip_prefix(&source).expect("it lies below src");
        let first = relative
            .iter()
            .next()
            .and_then(|part| part.to_str())
            .expect("a name");
        let module = first.trim_end_matches(".rs");
        if module == "main" || module == "lib" {
            continue;
        }
        let Some(here) = place(module) else {
            wrong.push(format!("{module} is not on the map"));
            continue;
        };
        let text = fs::read_to_string(&file).expect("the file is readable");
        for used in used_modules(&text) {
            // Macros live at the root whatever their module.
            if used == "with_law" || used == "with_wall_law" {
                continue;
            }
            match place(&used) {
                Some(there) if there <= here => {}
                _ => wrong.push(format!("{} uses {used}", relative.display())),
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_solver_names_neither_threads_nor_graphics() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    for folder in ["solver", "study", "kernel"] {
        let mut files = Vec::new();
        rust_files(&source.join(folder), &mut files);
        for file in files {
            let text = fs::read_to_string(&file).expect("the file is readable");
            for name in ["rayon", "wgpu"] {
                assert!(!text.contains(name), "{} names {name}", file.display());
            }
        }
    }
}

/// The crate page lists the modules in the same order.
#[test]
fn the_crate_page_has_the_same_order() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/lib.rs");
    let page = fs::read_to_string(page).expect("the crate page");
    let names = page.lines().filter_map(|line| {
        // A private module has no page to link to.
        let name = line
            .strip_prefix("//! | [`")
            .or(line.strip_prefix("//! | `"))?;
        name.split_once('`').map(|(name, _)| name)
    });
    let names: Vec<&str> = names.collect();
    assert_eq!(names, ORDER[..ORDER.len() - 1]);
}

/// A path calls the hooks of a list of effects: no file of it asks what a scene says of one. The law of a
/// scene is found in `regime`.
#[test]
fn a_path_names_no_effect() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/study");
    let mut files = Vec::new();
    rust_files(&source, &mut files);
    assert!(files.len() > 15, "too few files: {}", files.len());
    for file in files {
        if file.ends_with("regime.rs") {
            continue;
        }
        let text = fs::read_to_string(&file).expect("the file is readable");
        let code = text
            .lines()
            .filter(|line| !line.trim_start().starts_with("//"));
        for line in code {
            for name in [
                "scene.tables",
                "solid.relaxation",
                "solid.hardness",
                "solid.layer",
                "scene.adhesion",
                "scene.capillary",
                "loading.spring",
                "Treatment",
                "friction",
                "conductance",
                "wear",
                "leakage",
                "plastic_energy",
            ] {
                assert!(!line.contains(name), "{}: {line}", file.display());
            }
        }
    }
}

/// What a browser has not got: clocks, threads of our own, signals. Rayon does without threads where there are
/// none, and `clock` without a clock.
#[test]
fn the_core_asks_for_no_clock_thread_or_signal() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    rust_files(&source, &mut files);
    let mut looked = 0;
    for file in files {
        let place = file.strip_prefix(&source).expect("below src");
        if ["cli", "backend/gpu", "clock.rs"]
            .iter()
            .any(|outside| place.starts_with(outside))
            || place.ends_with("tests.rs")
        {
            continue;
        }
        let text = fs::read_to_string(&file).expect("the file is readable");
        let code = text.split("#[cfg(test)]").next().unwrap_or_default();
        let lines = code.lines().map(str::trim_start);
        for line in lines.filter(|line| !line.starts_with("//")) {
            for word in [
                "Instant",
                "SystemTime",
                "thread::spawn",
                "thread::sleep",
                "thread::Builder",
                "signal_hook",
                "ctrlc",
            ] {
                assert!(!line.contains(word), "{}: {line}", place.display());
            }
        }
        looked += 1;
    }
    assert!(looked > 150, "only {looked} files");
}
