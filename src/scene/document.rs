//! A scene's text as a tree whose values know their line.
//!
//! `[[surface]]`, `surface = [{ ... }]` and dotted keys give the same tree, and `--set` can replace
//! any part of it before it is read.

use toml_edit as toml;

use super::mistake::SceneError;
use crate::units::quoted;

/// Where a value was written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Location {
    /// This line of the file, from 1.
    Line(usize),
    /// A `--set` of the command line.
    Set,
    /// Not in the file.
    Nowhere,
}

/// A value with its location.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub value: Value,
    pub place: Location,
}

/// A TOML value.
#[derive(Clone, Debug)]
pub(super) enum Value {
    Text(String),
    Integer(i64),
    Float(f64),
    Boolean(bool),
    Date(String),
    List(Vec<Node>),
    Table(Table),
}

/// A table: its entries in the order of the file.
#[derive(Clone, Debug, Default)]
pub(super) struct Table {
    pub entries: Vec<Entry>,
}

/// A key with its value.
#[derive(Clone, Debug)]
pub(super) struct Entry {
    pub name: String,
    /// Location of the key; its value may begin on a later line.
    pub place: Location,
    pub node: Node,
}

impl Node {
    /// Whether the value is this text.
    pub fn is_text(&self, text: &str) -> bool {
        matches!(&self.value, Value::Text(found) if found == text)
    }

    /// The value as messages show it.
    pub fn shown(&self) -> String {
        match &self.value {
            Value::Text(text) => quoted(text),
            Value::Integer(number) => number.to_string(),
            Value::Float(number) => format!("{number:?}").replace("NaN", "nan"),
            Value::Boolean(truth) => truth.to_string(),
            Value::Date(date) => date.clone(),
            Value::List(_) => "a list".into(),
            Value::Table(_) => "a table".into(),
        }
    }

    /// The value and its kind, for messages that expected another kind.
    pub fn described(&self) -> String {
        match &self.value {
            Value::Text(_) => format!("the text {}", self.shown()),
            Value::Integer(_) | Value::Float(_) => format!("the number {}", self.shown()),
            Value::Boolean(_) => format!("the truth value {}", self.shown()),
            Value::Date(_) => format!("the date {}", self.shown()),
            Value::List(list) => format!("a list of {}", list.len()),
            Value::Table(_) => "a table".into(),
        }
    }
}

impl Table {
    /// The entry of a key.
    pub fn get(&self, name: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.name == name)
    }

    /// The entry of a key, to be changed.
    pub fn get_mut(&mut self, name: &str) -> Option<&mut Entry> {
        self.entries.iter_mut().find(|entry| entry.name == name)
    }

    /// Replaces or adds an entry.
    pub fn set(&mut self, name: &str, node: Node) {
        let place = node.place;
        match self.get_mut(name) {
            Some(entry) => {
                entry.place = place;
                entry.node = node;
            }
            None => self.entries.push(Entry {
                name: name.into(),
                place,
                node,
            }),
        }
    }
}

/// Parses the text of a scene.
///
/// # Errors
/// The first place where the text is no TOML, with its line.
pub(super) fn parse(text: &str) -> Result<Table, (Option<usize>, SceneError)> {
    let lines = Lines::new(text);
    let document = toml::Document::parse(text).map_err(|error| {
        (
            error.span().map(|span| lines.line(span.start)),
            syntax(&error),
        )
    })?;
    Ok(table(document.as_table(), Location::Nowhere, &|offset| {
        Location::Line(lines.line(offset))
    }))
}

/// Parses one value given on the command line: TOML, or else a number that TOML writes otherwise or has no room for, such as `.5`, or
/// else a bare word as it stands.
///
/// # Errors
/// A list, a table or a quotation that is not closed.
pub(super) fn parse_set(text: &str) -> Result<Node, SceneError> {
    match text.trim().parse::<toml::Value>() {
        Ok(found) => Ok(value(&found, Location::Set, &|_| Location::Set)),
        Err(error) if text.trim_start().starts_with(['[', '{', '"', '\'']) => Err(syntax(&error)),
        Err(_) => Ok(Node {
            value: match text.trim().parse() {
                Ok(number) => Value::Float(number),
                Err(_) => Value::Text(text.trim().into()),
            },
            place: Location::Set,
        }),
    }
}

fn syntax(error: &toml::TomlError) -> SceneError {
    SceneError::Syntax {
        reason: error
            .message()
            .lines()
            .map(str::trim)
            .collect::<Vec<_>>()
            .join("; "),
    }
}

/// Offsets at which the lines of a text begin.
struct Lines {
    starts: Vec<usize>,
}

impl Lines {
    fn new(text: &str) -> Self {
        let after_breaks = text.match_indices('\n').map(|(at, _)| at + 1);
        Lines {
            starts: std::iter::once(0).chain(after_breaks).collect(),
        }
    }

    /// Number of the line that holds a byte, from 1.
    fn line(&self, offset: usize) -> usize {
        self.starts.partition_point(|start| *start <= offset)
    }
}

/// A TOML table; `at` turns an offset into a location, and `parent` is that of entries without an offset, as
/// the inline tables of a `--set` have them. The parser bounds the depth, so recursion is safe.
fn table(from: &dyn toml::TableLike, parent: Location, at: &dyn Fn(usize) -> Location) -> Table {
    let entries = from
        .iter()
        .filter_map(|(name, item)| {
            let key_span = from.get_key_value(name).and_then(|(key, _)| key.span());
            let span = key_span.or_else(|| item.span());
            let place = span.map_or(parent, |span| at(span.start));
            Some(Entry {
                name: name.into(),
                place,
                node: item_node(item, place, at)?,
            })
        })
        .collect();
    Table { entries }
}

fn item_node(item: &toml::Item, parent: Location, at: &dyn Fn(usize) -> Location) -> Option<Node> {
    let place = item.span().map_or(parent, |span| at(span.start));
    match item {
        toml::Item::None => None,
        toml::Item::Value(found) => Some(value(found, parent, at)),
        toml::Item::Table(found) => Some(Node {
            value: Value::Table(table(found, place, at)),
            place,
        }),
        toml::Item::ArrayOfTables(found) => {
            let parts = found.iter().map(|part| Node {
                value: Value::Table(table(part, place, at)),
                place: part.span().map_or(place, |span| at(span.start)),
            });
            Some(Node {
                value: Value::List(parts.collect()),
                place,
            })
        }
    }
}

fn value(from: &toml::Value, parent: Location, at: &dyn Fn(usize) -> Location) -> Node {
    let place = from.span().map_or(parent, |span| at(span.start));
    let value = match from {
        toml::Value::String(text) => Value::Text(text.value().clone()),
        toml::Value::Integer(number) => Value::Integer(*number.value()),
        toml::Value::Float(number) => Value::Float(*number.value()),
        toml::Value::Boolean(truth) => Value::Boolean(*truth.value()),
        toml::Value::Datetime(date) => Value::Date(date.value().to_string()),
        toml::Value::Array(list) => {
            Value::List(list.iter().map(|entry| value(entry, place, at)).collect())
        }
        toml::Value::InlineTable(found) => Value::Table(table(found, place, at)),
    };
    Node { value, place }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_value_knows_its_line() {
        let root = parse("a = 1\n\n[b]\nc = [\n  2,\n  3]\n[[d]]\n[[d]]\ne.f = 4\n").expect("TOML");
        let place = |name: &str| root.get(name).map(|entry| entry.place);
        assert_eq!(place("a"), Some(Location::Line(1)));
        assert_eq!(place("b"), Some(Location::Line(3)));
        let Some(Value::Table(b)) = root.get("b").map(|entry| &entry.node.value) else {
            panic!("no table");
        };
        let Some(Value::List(c)) = b.get("c").map(|entry| &entry.node.value) else {
            panic!("no list");
        };
        assert_eq!(c[0].place, Location::Line(5));
        assert_eq!(c[1].place, Location::Line(6));
        let Some(Value::List(d)) = root.get("d").map(|entry| &entry.node.value) else {
            panic!("no array of tables");
        };
        assert_eq!(d[0].place, Location::Line(7));
        assert_eq!(d[1].place, Location::Line(8));
        let Value::Table(last) = &d[1].value else {
            panic!("no table");
        };
        assert_eq!(
            last.get("e").map(|entry| entry.place),
            Some(Location::Line(9))
        );
    }

    #[test]
    fn bare_words_of_the_command_line_are_text() {
        let text = |word: &str| match parse_set(word).map(|node| node.value) {
            Ok(Value::Text(text)) => text,
            other => panic!("{word}: {other:?}"),
        };
        assert_eq!(text("25 um"), "25 um");
        assert_eq!(text("'25 um'"), "25 um");
        assert_eq!(text("1\nb = 2"), "1\nb = 2");
        for number in ["1e3", "9223372036854775808", ".5", "1."] {
            let read = parse_set(number).map(|node| node.value);
            assert!(
                matches!(read, Ok(Value::Float(read)) if Ok(read) == number.parse()),
                "{number}"
            );
        }
        assert!(parse_set("[1, 2").is_err());
    }
}
