//! The error variants of the crate, read from its source: one list that nobody has to keep.

use std::fs;
use std::path::{Path, PathBuf};

use crate::shared::trials::tests;

/// A variant of an error enum.
#[derive(Debug)]
pub struct Variant {
    /// As in `FileError::Ragged`.
    pub name: String,
    /// Its file.
    pub file: PathBuf,
    /// The fixed parts of its message, in order; none where it passes another message on.
    pub fixed: Vec<String>,
}

impl Variant {
    /// Whether `message` has the fixed parts, in order.
    pub fn is_in(&self, message: &str) -> bool {
        let mut rest = message;
        self.fixed
            .iter()
            .all(|part| match rest.split_once(part.as_str()) {
                Some((_, after)) => {
                    rest = after;
                    true
                }
                None => false,
            })
    }
}

/// All variants of all enums in `src` that derive `Error`.
pub fn all() -> Vec<Variant> {
    let mut variants = Vec::new();
    walk(
        &Path::new(env!("CARGO_MANIFEST_DIR")).join("src"),
        &mut variants,
    );
    variants
}

fn walk(folder: &Path, variants: &mut Vec<Variant>) {
    for entry in fs::read_dir(folder).expect("src is there").flatten() {
        let path = entry.path();
        if path.is_dir() {
            walk(&path, variants);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let text = fs::read_to_string(&path).expect("source is text");
            of_file(&text, &path, variants);
        }
    }
}

/// Variants of the error enums of one file.
fn of_file(text: &str, file: &Path, variants: &mut Vec<Variant>) {
    // Without comments, which hold brackets of their own.
    let code: String = text
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"))
        .map(|line| format!("{line}\n"))
        .collect();
    let mut rest = code.as_str();
    while let Some(at) = rest.find("#[derive(") {
        rest = &rest[at..];
        let derive_end = rest.find(")]").expect("a derive ends");
        let derives = &rest[..derive_end];
        let is_error = derives
            .split(|c: char| !c.is_alphanumeric())
            .any(|word| word == "Error");
        rest = &rest[derive_end + 2..];
        // What the attribute stands on, up to the first brace.
        let Some(brace) = rest.find('{') else { return };
        let head = &rest[..brace];
        let Some((_, name)) = head.split_once("enum ") else {
            continue;
        };
        if !is_error {
            continue;
        }
        let name = name.trim().split('<').next().expect("a name");
        of_body(&rest[brace + 1..], name, file, variants);
    }
}

/// Variants of a body that begins after its brace.
fn of_body(body: &str, name: &str, file: &Path, variants: &mut Vec<Variant>) {
    let bytes = body.as_bytes();
    let (mut at, mut depth, mut fixed, mut expects_name) = (0, 0_i32, Vec::new(), true);
    while at < bytes.len() {
        match bytes[at] {
            b'"' => at = string_end(body, at),
            b'#' if depth == 0 => {
                let end = attribute_end(body, at);
                if body[at..].starts_with("#[error(") {
                    fixed = fixed_parts(&body[at..end]);
                }
                at = end;
                continue;
            }
            b'{' | b'(' => depth += 1,
            b'}' if depth == 0 => return,
            b'}' | b')' => depth -= 1,
            b',' if depth == 0 => expects_name = true,
            first if depth == 0 && expects_name && first.is_ascii_uppercase() => {
                let end = body[at..]
                    .find(|c: char| !c.is_alphanumeric())
                    .map_or(body.len(), |length| at + length);
                variants.push(Variant {
                    name: format!("{name}::{}", &body[at..end]),
                    file: file.to_owned(),
                    fixed: std::mem::take(&mut fixed),
                });
                expects_name = false;
                at = end;
                continue;
            }
            _ => {}
        }
        at += 1;
    }
}

/// Place of the quotation mark that ends the string which begins at `start`.
fn string_end(text: &str, start: usize) -> usize {
    let bytes = text.as_bytes();
    let mut at = start + 1;
    while bytes[at] != b'"' {
        at += if bytes[at] == b'\\' { 2 } else { 1 };
    }
    at
}

/// Place after the attribute that begins at `start`.
fn attribute_end(text: &str, start: usize) -> usize {
    let bytes = text.as_bytes();
    let (mut at, mut depth) = (start, 0);
    loop {
        match bytes[at] {
            b'"' => at = string_end(text, at),
            b'[' => depth += 1,
            b']' => {
                depth -= 1;
                if depth == 0 {
                    return at + 1;
                }
            }
            _ => {}
        }
        at += 1;
    }
}

/// The text of an `#[error("...")]` between its placeholders; parts of a few letters are left out.
fn fixed_parts(attribute: &str) -> Vec<String> {
    let Some(start) = attribute.find('"') else {
        return Vec::new();
    };
    let literal = &attribute[start + 1..string_end(attribute, start)];
    // A line may be broken by a backslash, which swallows the blanks that follow.
    let mut joined = String::new();
    let mut lines = literal.split("\\\n");
    joined.push_str(lines.next().unwrap_or(""));
    lines.for_each(|line| joined.push_str(line.trim_start()));
    let joined = joined.replace("\\\"", "\"").replace("\\\\", "\\");
    let mut parts = vec![String::new()];
    let mut inside = false;
    for letter in joined.chars() {
        match letter {
            '{' => {
                inside = true;
                parts.push(String::new());
            }
            '}' => inside = false,
            other if !inside => parts.last_mut().expect("one at least").push(other),
            _ => {}
        }
    }
    parts.retain(|part| part.trim().len() > 3);
    parts
}

fn variants_are_found_with_their_messages() {
    let text = r##"
/// An enum { with a brace in its comment.
#[derive(Clone, Debug, thiserror::Error)]
pub enum Sample<T> {
    /// One.
    #[error("no {what} here; {}, \"{name}\" is", list.join("}"))]
    First { what: String, name: String },
    #[error(transparent)]
    Second(#[from] Other),
    #[error(
        "a long \
         message of {0}"
    )]
    Third(T),
    Fourth,
}
#[derive(Clone)]
enum NoError { Fifth }
"##;
    let mut found = Vec::new();
    of_file(text, Path::new("sample.rs"), &mut found);
    let names: Vec<&str> = found.iter().map(|variant| variant.name.as_str()).collect();
    assert_eq!(
        names,
        [
            "Sample::First",
            "Sample::Second",
            "Sample::Third",
            "Sample::Fourth"
        ]
    );
    assert_eq!(found[0].fixed, [" here; ", "\" is"]);
    assert!(found[1].fixed.is_empty());
    assert_eq!(found[2].fixed, ["a long message of "]);
    assert!(found[0].is_in("no scene here; a, b, \"x\" is") && !found[0].is_in("\" is here; "));
}

tests![variants_are_found_with_their_messages,];
