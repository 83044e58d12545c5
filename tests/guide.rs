//! The page that shows how to add an effect shows what is there: each of its passages stands in the
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
