//! Pages that follow the source: each passage of the one on adding an effect stands in the
//! file that it names.

use std::fs;
use std::path::Path;

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
    assert!(passages.len() >= 10, "only {} passages", passages.len());
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

/// The page of keys has the keys that scenes are read by, with the same lines, and no others.
#[test]
fn every_key_of_a_scene_is_explained() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let read = |name: &str| fs::read_to_string(root.join(name)).expect("the file is there");
    // Pairs of texts in the source: a key, and a line that sets it.
    let source = read("src/scene/keys.rs");
    let (_, listed) = source.split_once("pub(super) const SCENE").expect("a list");
    let (listed, _) = listed.split_once("pub(super) const ALL").expect("its end");
    let listed: Vec<&str> = listed.split("later:").collect();
    let texts: Vec<String> = listed
        .iter()
        // What stands for a later version is one line, before the next section.
        .enumerate()
        .flat_map(|(index, part)| part.lines().skip(usize::from(index > 0)))
        .filter(|line| !line.trim_start().starts_with("//") && !line.contains("title:"))
        .flat_map(quoted)
        .collect();
    let mut expected: Vec<(String, String)> = texts
        .chunks(2)
        .map(|pair| (pair[0].clone(), pair[1].clone()))
        .collect();
    let page = read("docs/scene_file.md");
    let mut shown: Vec<(String, String)> = page
        .lines()
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
