//! A kernel in Rust and its WGSL share their names, function for function, and the assembled shaders are
//! those that `tests/reference/shaders` keeps.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use tabor::backend::gpu::source::representative;

use crate::catalogue::variants;
use crate::shared::trials::tests;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &Path) -> String {
    let text =
        fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    // Line ends are the checkout's.
    text.replace("\r\n", "\n")
}

/// Names of the functions of a source.
fn functions(text: &str) -> Vec<&str> {
    let names = text.lines().filter_map(|line| {
        let (before, rest) = line.trim_start().split_once("fn ")?;
        let head = before.split_whitespace();
        let plain = head
            .into_iter()
            .all(|word| word.starts_with("pub") || word == "const" || word.starts_with("in "));
        let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_')?;
        (plain && !line.trim_start().starts_with("//")).then(|| &rest[..end])
    });
    names.collect()
}

/// The Rust files that a part of WGSL names as its twins.
fn twins(text: &str) -> Vec<PathBuf> {
    let comments = text.lines().filter_map(|line| line.strip_prefix("// "));
    let text = comments.collect::<Vec<_>>().join(" ");
    let Some((_, named)) = text.split_once("Twins: ") else {
        return Vec::new();
    };
    let files = named
        .split([' ', ','])
        .map(|word| word.trim_end_matches('.'));
    files
        .filter(|word| word.ends_with(".rs"))
        .map(|file| root().join("src").join(file))
        .collect()
}

/// Parts of the frame around kernels, which the processor has no twin of.
const FRAME: [&str; 11] = [
    "common",
    "copy",
    "exp_double",
    "exp_single",
    "factor_compliance",
    "factor_stiffness",
    "factor_table",
    "fft",
    "gate",
    "half_space",
    "reduce",
];

fn wgsl_and_rust_share_the_names_of_functions() {
    let files: BTreeMap<&str, &str> = variants()
        .map(|kernel| (kernel.name, kernel.file))
        .collect();
    let mut compared = 0;
    for entry in fs::read_dir(root().join("shaders"))
        .expect("a folder")
        .flatten()
    {
        let path = entry.path();
        let stem = path
            .file_stem()
            .and_then(|stem| stem.to_str())
            .expect("a name");
        if FRAME.contains(&stem) || stem.starts_with("sums") {
            continue;
        }
        let text = read(&path);
        let mut named = twins(&text);
        named.extend(files.get(stem).map(|file| root().join(file)));
        assert!(!named.is_empty(), "{stem}.wgsl names no file of Rust");
        let rust: String = named.iter().map(|file| read(file)).collect();
        let known = functions(&rust);
        for function in functions(&text) {
            // A kernel over rows is its own twin; of one over points it is the function `at`.
            let twin = known.contains(&function) || (function == "at" && known.contains(&stem));
            assert!(twin, "{stem}.wgsl: no `{function}` in {named:?}");
            compared += 1;
        }
        if files.contains_key(stem) {
            assert!(functions(&text).contains(&"at"), "{stem}.wgsl has no `at`");
        }
    }
    // Each kernel has a file of its own.
    for name in files.keys() {
        let path = root().join("shaders").join(format!("{name}.wgsl"));
        assert!(path.is_file(), "{}", path.display());
    }
    assert!(compared > 90, "only {compared} functions");
}

/// Each constraint has all functions of the trait, on both sides.
fn every_constraint_has_every_function_in_wgsl() {
    let rust = read(&root().join("src/kernel/constraint.rs"));
    let (_, body) = rust
        .split_once("pub trait GapConstraint")
        .expect("the trait");
    let (body, _) = body.split_once("\n}\n").expect("its end");
    let asked: Vec<&str> = functions(body)
        .into_iter()
        .filter(|name| !["new", "run"].contains(name))
        .collect();
    assert!(asked.len() >= 10, "{asked:?}");
    for part in ["unilateral", "hardness_limit", "smooth"] {
        let text = read(&root().join("shaders").join(format!("{part}.wgsl")));
        for name in &asked {
            assert!(
                functions(&text).contains(name),
                "{part}.wgsl has no `{name}`"
            );
        }
    }
}

/// A law has its WGSL beside its Rust: `law_traction` is `traction`, and so on.
fn laws_share_the_names_of_functions() {
    let shared = read(&root().join("src/law/mod.rs"));
    for law in [
        "exponential",
        "hard_wall",
        "lennard_jones",
        "maugis_dugdale",
    ] {
        let text = read(&root().join("src/law").join(format!("{law}.wgsl")));
        let own = root().join("src/law").join(format!("{law}.rs"));
        let rust = if own.is_file() {
            read(&own)
        } else {
            String::new()
        };
        let known = [functions(&rust), functions(&shared)].concat();
        let found = functions(&text);
        assert!(found.len() >= 5, "{law}: {found:?}");
        for function in found {
            let twin = function.strip_prefix("law_").expect("a function of a law");
            assert!(known.contains(&twin), "{law}.wgsl: no `{twin}`");
        }
    }
}

/// Whether a shader is kept: one of each kernel, and the other constraints where they differ most.
fn is_kept(name: &str) -> bool {
    let other = name.contains("-hardness_limit") || name.contains("-smooth");
    let differ = [
        "trial",
        "direction",
        "load_trial",
        "search",
        "add_correction",
    ];
    !other || differ.contains(&name.split('-').next().unwrap_or_default())
}

/// The variable that has the copies renewed.
const RENEW: &str = "TABOR_RENEW_SHADERS";

/// What a shader is now against what it was, line by line. Where a difference is meant the copies are renewed
/// by `TABOR_RENEW_SHADERS=1 cargo test --release --test gpu twins::`, and the difference is then git's.
fn assembled_shaders_are_those_that_are_kept() {
    let folder = root().join("tests/reference/shaders");
    let now: BTreeMap<String, String> = representative()
        .unwrap_or_else(|error| panic!("{error}"))
        .into_iter()
        .filter(|(name, _)| is_kept(name))
        .collect();
    // Each kernel is among them.
    for kernel in variants() {
        let is_of = |name: &String| name.split('-').next() == Some(kernel.name);
        assert!(now.keys().any(is_of), "{}", kernel.name);
    }
    if std::env::var(RENEW).is_ok_and(|value| value == "1") {
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).expect("a folder");
        for (name, text) in &now {
            fs::write(folder.join(format!("{name}.wgsl")), text).expect("a file");
        }
    }
    let kept: BTreeMap<String, String> = fs::read_dir(&folder)
        .expect("a folder")
        .flatten()
        .map(|entry| {
            let path = entry.path();
            let stem = path
                .file_stem()
                .and_then(|stem| stem.to_str())
                .expect("a name");
            (stem.to_owned(), read(&path))
        })
        .collect();
    let names: Vec<&String> = now.keys().collect();
    assert_eq!(
        names,
        kept.keys().collect::<Vec<_>>(),
        "other shaders than kept"
    );
    let mut differences = String::new();
    for (name, text) in &now {
        let (now, kept): (Vec<_>, Vec<_>) = (text.lines().collect(), kept[name].lines().collect());
        if now == kept {
            continue;
        }
        let same = now.iter().zip(&kept).take_while(|(a, b)| a == b).count();
        let left = now.len().min(kept.len()) - same;
        let pairs = now.iter().rev().zip(kept.iter().rev());
        let tail = pairs.take(left).take_while(|(a, b)| a == b).count();
        differences += &format!("\n{name}.wgsl from line {}:\n", same + 1);
        for line in &kept[same..kept.len() - tail] {
            differences += &format!("- {line}\n");
        }
        for line in &now[same..now.len() - tail] {
            differences += &format!("+ {line}\n");
        }
    }
    assert!(
        differences.is_empty(),
        "{differences}\nIf this is meant: {RENEW}=1 cargo test --release --test gpu twins::"
    );
}

tests![
    wgsl_and_rust_share_the_names_of_functions,
    every_constraint_has_every_function_in_wgsl,
    laws_share_the_names_of_functions,
    assembled_shaders_are_those_that_are_kept,
];
