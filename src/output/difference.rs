//! Finds the first difference of two resolved scenes or studies, for messages.

use serde_json::Value;

/// The first key in which two scenes differ, to follow "another scene"; empty if they cannot be
/// compared.
pub(crate) fn difference(there: &str, here: &str) -> String {
    let read = |text: &str| serde_json::from_str::<Value>(text).ok();
    let (Some(there), Some(here)) = (read(there), read(here)) else {
        return String::new();
    };
    first("", Some(&there), Some(&here)).map_or_else(String::new, |(key, there, here)| {
        format!(" ({key} is {there} there and {here} here)")
    })
}

/// The key and its two values.
fn first(
    key: &str,
    there: Option<&Value>,
    here: Option<&Value>,
) -> Option<(String, String, String)> {
    if there == here {
        return None;
    }
    let below = |name: &str| match key {
        "" => name.to_owned(),
        _ => format!("{key}.{name}"),
    };
    match (there, here) {
        (Some(Value::Object(old)), Some(Value::Object(new))) => old
            .keys()
            .chain(new.keys())
            .find_map(|name| first(&below(name), old.get(name), new.get(name))),
        (Some(Value::Array(old)), Some(Value::Array(new))) if old.len() == new.len() => old
            .iter()
            .zip(new)
            .enumerate()
            .find_map(|(index, (old, new))| {
                first(&below(&index.to_string()), Some(old), Some(new))
            }),
        _ => Some((key.to_owned(), words(there), words(here))),
    }
}

/// A value in a message.
fn words(value: Option<&Value>) -> String {
    match value {
        None => "missing".to_owned(),
        Some(Value::Array(values)) => format!("a list of {}", values.len()),
        Some(Value::Object(_)) => "a table".to_owned(),
        Some(value) => value.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_key_that_differs_is_named() {
        let there = r#"{"grid":{"points":[64,64]},"surface":[{"hurst":0.8}],"path":[1,2]}"#;
        let cases = [
            (
                there.replace("0.8", "0.7"),
                " (surface.0.hurst is 0.8 there and 0.7 here)",
            ),
            (
                there.replace("[1,2]", "[1]"),
                " (path is a list of 2 there and a list of 1 here)",
            ),
            (
                there.replace("\"path\"", "\"way\""),
                " (path is a list of 2 there and missing here)",
            ),
            (
                there.replace("{\"points\":[64,64]}", "3"),
                " (grid is a table there and 3 here)",
            ),
            ("not JSON".to_owned(), ""),
        ];
        for (here, words) in cases {
            assert_eq!(difference(there, &here), words);
        }
    }
}
