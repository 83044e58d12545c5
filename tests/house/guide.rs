//! Pages that follow the source: each passage of the one on adding an effect stands in the
//! file that it names, and the files that it names are all that an effect touches.

use std::fs;
use std::path::{Path, PathBuf};

/// Passages of the page: the file that each names, and its text. Shell commands name none.
fn passages(page: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let mut file = None;
    let mut lines = page.lines();
    while let Some(line) = lines.next() {
        let named = line
            .strip_prefix('`')
            .and_then(|rest| rest.strip_suffix('`'));
        if let Some(named) = named {
            file = Some(named.to_owned());
        } else if let Some(kind) = line.strip_prefix("```") {
            let text: Vec<&str> = lines
                .by_ref()
                .take_while(|line| !line.starts_with("```"))
                .collect();
            if kind == "sh" {
                continue;
            }
            let file = file.take().expect("a passage names its file just above it");
            found.push((file, text.join("\n")));
        }
    }
    found
}

#[test]
fn every_passage_stands_in_its_file() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = fs::read_to_string(root.join("docs/add_an_effect.md")).expect("the page is there");
    let passages = passages(&page);
    assert!(passages.len() >= 7, "only {} passages", passages.len());
    for (file, text) in passages {
        let content = fs::read_to_string(root.join(&file)).expect("the file is there");
        // Line ends are the checkout's.
        let content = content.replace("\r\n", "\n");
        assert!(
            !text.trim().is_empty() && content.contains(&text),
            "{file} does not hold\n{text}"
        );
    }
}

/// The page on adding a law: its passages stand in their files, which are four, and none is a kernel.
#[test]
fn a_further_law_touches_four_files() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = fs::read_to_string(root.join("docs/add_a_law.md")).expect("the page is there");
    let passages = passages(&page);
    let mut files: Vec<&str> = passages.iter().map(|(file, _)| file.as_str()).collect();
    files.sort_unstable();
    files.dedup();
    println!("a further law touches {} files: {files:?}", files.len());
    assert_eq!(files.len(), 4, "{files:?}");
    for (file, text) in &passages {
        let content = fs::read_to_string(root.join(file)).expect("the file is there");
        let content = content.replace("\r\n", "\n");
        assert!(content.contains(text), "{file} does not hold\n{text}");
    }
    // No other file of the source has to distinguish laws with a constraint: none matches the exponential
    // law but those that add to it where they can, such as its constructor for programs in Rust.
    let says_more = [
        "src/scene/laws.rs",
        "src/effect/adhesion.rs",
        "src/compare/spectrum.rs",
        "src/scene/adhesion.rs",
    ];
    let mut others = Vec::new();
    let mut folders = vec![root.join("src")];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a folder").flatten() {
            let path = entry.path();
            let name = path
                .strip_prefix(root)
                .expect("below")
                .display()
                .to_string();
            if path.is_dir() {
                folders.push(path);
            } else if fs::read_to_string(&path).is_ok_and(|text| {
                text.contains("Law::Exponential(") || text.contains("LawName::Exponential")
            }) && !files.contains(&name.replace('\\', "/").as_str())
            {
                others.push(name.replace('\\', "/"));
            }
        }
    }
    // A picture of the shaders shows one law of each kind.
    others.retain(|name| !says_more.contains(&name.as_str()) && !name.ends_with("snapshot.rs"));
    assert!(others.is_empty(), "{others:?}");
}

/// Files that friction needs: what a further effect such as friction touches.
const NEEDED: [&str; 6] = [
    "src/scene/tables.rs",
    "src/effect/friction.rs",
    "src/effect/mod.rs",
    "docs/effects.md",
    "/friction.rs",
    "/main.rs",
];

/// Other files that name friction, and why an effect can do without each: told by the end of its path.
const BESIDES: [(&str, &str); 21] = [
    ("/report_page.rs", "shows the columns of every effect"),
    ("docs/add_an_effect.md", "shows how friction was added"),
    ("/guide.rs", "counts"),
    ("CHANGELOG.md", "has a line for every change"),
    ("README.md", "says what another program does"),
    (
        "examples/scenes/ground.toml",
        "a shipped scene may show an effect",
    ),
    ("docs/scenes.md", "and then says what comes out"),
    ("src/theory/friction.rs", "a closed form to compare with"),
    ("src/theory/mod.rs", "names that file"),
    ("/sphere.rs", "checks that closed form"),
    ("src/elastic/mod.rs", "a base without friction"),
    ("src/elastic/layer.rs", "a base without friction"),
    ("/layer.rs", "a layer on such a base"),
    (
        "/scenes.rs",
        "mistakes of a declared table, for which friction stands",
    ),
    (
        "/scene_mutations.rs",
        "a word among those that scenes are mutated with",
    ),
    ("fuzz/scene.dict", "likewise"),
    ("/layers.rs", "names effects that a path must not name"),
    (
        "contact/builder.rs",
        "a method of its own; Contact::tables sets every table",
    ),
    ("contact/phrases.rs", "names that method in mistakes"),
    ("command_line/contact.rs", "tries that method"),
    ("/resume.rs", "a scene that has many effects on"),
];

/// Text files below a folder.
fn text_files(folder: &Path, found: &mut Vec<(PathBuf, String)>) {
    for entry in fs::read_dir(folder).expect("a folder").flatten() {
        let path = entry.path();
        // Inputs of the fuzzer, and pages that the site copies from elsewhere.
        let is_left_out = path
            .file_name()
            .is_some_and(|name| name == "corpus" || name == "generated");
        if path.is_dir() {
            if !is_left_out {
                text_files(&path, found);
            }
        } else if let Ok(text) = fs::read_to_string(&path) {
            found.push((path, text));
        }
    }
}

/// A further effect touches few files: those that friction needs, among all that name it.
#[test]
fn a_further_effect_touches_six_files() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = Vec::new();
    for folder in [
        "src", "docs", "tests", "examples", "shaders", "fuzz", "benches",
    ] {
        text_files(&root.join(folder), &mut files);
    }
    for file in ["README.md", "CHANGELOG.md", "Cargo.toml"] {
        let path = root.join(file);
        files.push((path.clone(), fs::read_to_string(path).expect("a file")));
    }
    let (mut needed, mut besides, mut unknown) = (Vec::new(), 0, Vec::new());
    for (path, text) in files {
        let relative = path.strip_prefix(root).expect("it lies below").to_owned();
        // Always with the separator of this page.
        let name = relative.to_string_lossy().replace('\\', "/");
        let is_table = name.ends_with(".csv") || name.ends_with(".json") || name.ends_with(".py");
        let text = text.to_lowercase().replace("frictionless", "");
        if is_table || !(text.contains("friction") || text.contains("shear_strength")) {
            continue;
        }
        let is_test_list = name.starts_with("tests/physics/") && text.contains("mod friction;");
        let is_test = name.starts_with("tests/") && name.ends_with("/friction.rs");
        if NEEDED[..4].contains(&name.as_str()) || is_test || is_test_list {
            needed.push(name);
        } else if BESIDES.iter().any(|(other, _)| name.ends_with(other)) {
            besides += 1;
        } else {
            unknown.push(name);
        }
    }
    println!(
        "a further effect touches {} files: {needed:?}",
        needed.len()
    );
    println!("{besides} others name friction, which an effect can do without");
    assert!(
        unknown.is_empty(),
        "not known to name friction: {unknown:?}"
    );
    assert_eq!(needed.len(), NEEDED.len(), "{needed:?}");
    // The page shows the same files.
    let page = fs::read_to_string(root.join("docs/add_an_effect.md")).expect("the page is there");
    for name in needed {
        assert!(
            page.contains(&format!("| `{name}` |")),
            "{name} is not on the page"
        );
    }
}

/// An effect is one file: none names another, but for those that vary the law of `[adhesion]`.
#[test]
fn no_effect_names_another() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/effect");
    let mut files = Vec::new();
    text_files(&folder, &mut files);
    assert!(files.len() >= 15, "{} files", files.len());
    for (path, text) in files {
        let name = path
            .file_name()
            .expect("a name")
            .to_string_lossy()
            .into_owned();
        if name == "mod.rs" {
            continue;
        }
        let named = text.lines().filter(|line| line.contains("super::"));
        for line in named {
            let allowed = [
                "super::adhesion::",
                "super::attracted_pixels::",
                "super::edge::Edge",
                "super::LIST",
                "super::*",
            ];
            assert!(
                allowed.iter().any(|allowed| line.contains(allowed)),
                "{name}: {line}"
            );
        }
    }
}

/// The pages of keys have the keys that scenes are read by, with the same lines, and no others.
#[test]
fn every_key_of_a_scene_is_explained() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let read = |name: &str| fs::read_to_string(root.join(name)).expect("the file is there");
    // `("key", "value")`, or a line `key = value,` of a section; a table's head stands for itself.
    let source = read("src/scene/keys.rs");
    let (_, listed) = source.split_once("const FIRST").expect("a list");
    let (listed, _) = listed.split_once("const BEFORE").expect("its end");
    let mut expected: Vec<(String, String)> = Vec::new();
    for line in listed.lines().map(str::trim) {
        let (key, value) = match (quoted(line).as_slice(), line.split_once(" = ")) {
            ([key, value], _) if line.contains("(\"") => (key.clone(), value.clone()),
            (_, Some((key, value))) if !key.contains(' ') && line.ends_with(',') => {
                (key.to_owned(), value.trim_end_matches(',').to_owned())
            }
            _ => continue,
        };
        // The head of a table, and no list of texts or numbers.
        let is_head = value.starts_with('[')
            && !value[1..].starts_with(|first: char| first == '"' || first.is_ascii_digit());
        let example = if is_head {
            value
        } else {
            format!("{key} = {value}")
        };
        // What stands for a later version is no key yet.
        if !line.starts_with("later:") {
            expected.push((key, example));
        }
    }
    // Declared tables: `name: Type {` opens one, and `key: Dimension = "value",` is a key of it.
    let source = read("src/scene/tables.rs");
    let (_, declared) = source.split_once("\ntables! {").expect("declarations");
    let (declared, _) = declared.split_once("\n}\n").expect("an end");
    let lines = declared.lines().map(str::trim);
    for line in lines.filter(|line| !line.starts_with("//")) {
        let Some((name, rest)) = line.split_once(": ") else {
            continue;
        };
        let example = match rest.split_once(" = ") {
            Some((_, value)) => format!("{name} = {}", value.trim_end_matches(',')),
            None => format!("[{name}]"),
        };
        expected.push((name.to_owned(), example));
    }
    let mut shown: Vec<(String, String)> = [read("docs/scene_file.md"), read("docs/effects.md")]
        .iter()
        .flat_map(|page| page.lines())
        .filter_map(|line| {
            let mut cells = line.strip_prefix("| `")?.split("` | `");
            let key = cells.next()?.to_owned();
            let (example, _) = cells.next()?.split_once("` |")?;
            Some((key, example.to_owned()))
        })
        .collect();
    expected.sort();
    shown.sort();
    assert!(expected.len() > 60, "{} keys", expected.len());
    assert_eq!(shown, expected);
}

/// The texts in quotes of a line of Rust.
fn quoted(line: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut text: Option<String> = None;
    let mut letters = line.chars();
    while let Some(letter) = letters.next() {
        match (letter, &mut text) {
            ('"', None) => text = Some(String::new()),
            ('"', Some(_)) => found.extend(text.take()),
            ('\\', Some(text)) => text.extend(letters.next()),
            (letter, Some(text)) => text.push(letter),
            (_, None) => {}
        }
    }
    found
}

#[test]
fn the_citation_has_the_version_of_the_crate() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(root.join("CITATION.cff")).expect("the file is there");
    let line = format!("version: {}", env!("CARGO_PKG_VERSION"));
    assert!(text.lines().any(|known| known == line), "{line}");
}
