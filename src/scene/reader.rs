//! A cursor over one table of a scene that collects mistakes and continues.
//!
//! Every getter returns `None` both for an absent key and, after noting the mistake, for a wrong
//! one; [`Reader::has`] tells the two apart.

use std::cell::RefCell;

use super::allowed::{Allowed, RANGE_WORDS, in_range};
use super::document::{Entry, Location, Node, Table, Value};
use super::keys::{self, Section};
use super::mistake::{Mistake, SceneError, SceneErrors};
use super::suggestion::suggestion;
use super::words::Word;
use crate::units::{self, Dimension, UnitError};

/// The mistakes found so far in one scene.
pub(super) struct Log {
    file: String,
    mistakes: RefCell<Vec<Mistake>>,
}

impl Log {
    pub fn new(file: &str) -> Self {
        Log {
            file: file.into(),
            mistakes: RefCell::new(Vec::new()),
        }
    }

    /// Notes a mistake.
    pub fn add(&self, place: Location, key: &str, error: SceneError) {
        self.mistakes.borrow_mut().push(Mistake {
            file: self.file.clone(),
            line: match place {
                Location::Line(line) => Some(line),
                Location::Set | Location::Nowhere => None,
            },
            key: key.into(),
            from_set: place == Location::Set,
            error,
        });
    }

    pub fn is_empty(&self) -> bool {
        self.mistakes.borrow().is_empty()
    }

    /// The mistakes by line; those without one come last.
    pub fn into_errors(self) -> SceneErrors {
        let mut mistakes = self.mistakes.into_inner();
        mistakes.sort_by_key(|mistake| mistake.line.unwrap_or(usize::MAX));
        SceneErrors(mistakes)
    }
}

/// SI value of a bare number or of a text with a unit.
fn quantity_of(node: &Node, dimension: Dimension) -> Option<Result<f64, UnitError>> {
    let number = |value| match dimension {
        Dimension::Angle => units::angle_from_number(value),
        _ => value,
    };
    match &node.value {
        Value::Integer(value) => Some(Ok(number(*value as f64))),
        Value::Float(value) => Some(Ok(number(*value))),
        // A pure number in quotes is a mistake, not a unit.
        Value::Text(text) if dimension != Dimension::Dimensionless => {
            Some(units::parse_quantity(text, dimension))
        }
        _ => None,
    }
}

/// A cursor over one table.
pub(super) struct Reader<'a> {
    table: &'a Table,
    place: Location,
    path: String,
    section: &'static Section,
    log: &'a Log,
    /// Known keys that an unknown key was probably meant to be.
    misspelled: Vec<&'static str>,
}

impl<'a> Reader<'a> {
    /// Opens a table and notes each key that is not in `section`. `path` is its dotted name.
    pub fn open(
        table: &'a Table,
        place: Location,
        path: &str,
        section: &'static Section,
        log: &'a Log,
    ) -> Self {
        let mut reader = Reader {
            table,
            place,
            path: path.into(),
            section,
            log,
            misspelled: Vec::new(),
        };
        table
            .entries
            .iter()
            .for_each(|entry| reader.check_key(entry));
        reader
    }

    fn check_key(&mut self, entry: &Entry) {
        let name = entry.name.as_str();
        if self.section.keys.iter().any(|(known, _)| *known == name) {
            return;
        }
        if let Some((_, what)) = self.section.later.iter().find(|(later, _)| *later == name) {
            self.not_in_this_version(name, what, "take it out of the scene");
            return;
        }
        let meant = suggestion(name, self.section.names());
        self.misspelled.extend(meant);
        let elsewhere = keys::all()
            .filter(|section| section.names().any(|known| known == name))
            .map(|section| section.title.to_string());
        let known = self.section.keys.iter();
        let error = SceneError::UnknownKey {
            section: self.section.title.into(),
            nearest: meant.map(str::to_owned),
            known: known.map(|(known, _)| (*known).into()).collect(),
            elsewhere: elsewhere.collect(),
        };
        self.report_at(entry.place, name, error);
    }

    /// Whether the key is present, right or wrong.
    pub fn has(&self, key: &str) -> bool {
        self.table.get(key).is_some()
    }

    /// The raw value of a key.
    pub fn node(&self, key: &str) -> Option<&'a Node> {
        self.table.get(key).map(|entry| &entry.node)
    }

    /// The dotted name of a key of this table.
    pub fn dotted(&self, key: &str) -> String {
        match (self.path.is_empty(), key.is_empty()) {
            (true, _) => shown_key(key),
            (false, true) => self.path.clone(),
            (false, false) => format!("{}.{}", self.path, shown_key(key)),
        }
    }

    /// Notes a mistake at a key, or at the table's head if the key is absent.
    pub fn report(&self, key: &str, error: SceneError) {
        let place = self.table.get(key).map_or(self.place, |entry| entry.place);
        self.report_at(place, key, error);
    }

    /// Notes a mistake of a key at another location.
    pub fn report_at(&self, place: Location, key: &str, error: SceneError) {
        self.log.add(place, &self.dotted(key), error);
    }

    /// Notes that a key cannot be combined with others.
    pub fn conflict(&self, key: &str, reason: impl Into<String>) {
        let reason = reason.into();
        self.report(key, SceneError::Conflict { reason });
    }

    /// Notes that a key asks for what this version lacks, with the remedy.
    pub fn not_in_this_version(&self, key: &str, what: &str, instead: &str) {
        let (what, instead) = (what.to_string(), instead.to_string());
        self.report(key, SceneError::NotInThisVersion { what, instead });
    }

    /// Notes each of these keys that is absent.
    pub fn require(&self, required: &[&str]) {
        for key in required {
            self.require_as(key, &self.section.example(key));
        }
    }

    /// Notes that a key is absent, with an example line.
    pub fn require_as(&self, key: &str, example: &str) {
        // A misspelled key has been noted already and does not count as missing.
        if !self.has(key) && !self.misspelled.contains(&key) {
            let example = example.into();
            self.report(key, SceneError::Missing { example });
        }
    }

    /// What `read` makes of a key, or the default where the key is absent.
    pub fn or<T>(&self, key: &str, default: T, read: impl FnOnce(&str) -> Option<T>) -> Option<T> {
        if self.has(key) {
            read(key)
        } else {
            Some(default)
        }
    }

    /// What `read` makes of a key: `Some(None)` where the key is absent, `None` after a mistake.
    pub fn optional<T>(
        &self,
        key: &str,
        read: impl FnOnce(&str) -> Option<T>,
    ) -> Option<Option<T>> {
        self.or(key, None, |key| read(key).map(Some))
    }

    /// Whether a key has this text.
    pub fn is_text(&self, key: &str, text: &str) -> bool {
        self.node(key).is_some_and(|node| node.is_text(text))
    }

    fn wrong_type(&self, node: &Node, key: &str, name: &str, expected: &str) {
        let error = SceneError::WrongType {
            found: node.described(),
            expected: expected.into(),
            example: self.section.example(key),
        };
        self.report_at(node.place, name, error);
    }

    fn out_of_range(&self, node: &Node, name: &str, allowed: &str) {
        let error = SceneError::OutOfRange {
            found: node.shown(),
            allowed: allowed.into(),
        };
        self.report_at(node.place, name, error);
    }

    /// A dimensional value in SI units; a pure number if `dimension` has no unit.
    pub fn quantity(&self, key: &str, dimension: Dimension, allowed: Allowed) -> Option<f64> {
        self.quantity_in(self.node(key)?, key, key, dimension, allowed)
    }

    /// A dimensional value within the value of `key`; `name` says which.
    pub fn quantity_in(
        &self,
        node: &Node,
        key: &str,
        name: &str,
        dimension: Dimension,
        allowed: Allowed,
    ) -> Option<f64> {
        match quantity_of(node, dimension) {
            Some(Ok(value)) if !value.is_finite() || !(allowed.test)(value) => {
                self.out_of_range(node, name, allowed.words);
                None
            }
            Some(Ok(value)) if !in_range(value) => {
                self.out_of_range(node, name, RANGE_WORDS);
                None
            }
            Some(Ok(value)) => Some(value),
            Some(Err(error)) => {
                self.report_at(node.place, name, error.into());
                None
            }
            None => {
                self.wrong_type(node, key, name, dimension.words());
                None
            }
        }
    }

    /// A whole number within limits, both included.
    pub fn whole_number(&self, key: &str, least: i64, most: i64) -> Option<i64> {
        self.whole_number_in(self.node(key)?, key, key, least, most)
    }

    /// A whole number within the value of `key`; `name` says which.
    pub fn whole_number_in(
        &self,
        node: &Node,
        key: &str,
        name: &str,
        least: i64,
        most: i64,
    ) -> Option<i64> {
        match node.value {
            Value::Integer(number) if (least..=most).contains(&number) => Some(number),
            Value::Integer(_) => {
                let words = if most == i64::MAX {
                    format!("a whole number of at least {least}")
                } else {
                    format!("a whole number from {least} to {most}")
                };
                self.out_of_range(node, name, &words);
                None
            }
            _ => {
                self.wrong_type(node, key, name, "a whole number");
                None
            }
        }
    }

    /// True or false.
    pub fn truth(&self, key: &str) -> Option<bool> {
        let node = self.node(key)?;
        if let Value::Boolean(truth) = node.value {
            return Some(truth);
        }
        self.wrong_type(node, key, key, "true or false");
        None
    }

    /// One of the words of a choice.
    pub fn word<T: Word>(&self, key: &str) -> Option<T> {
        self.choice(key, T::WORDS, T::word)
    }

    /// One of the words of a choice, or the default where the key is absent.
    pub fn word_or<T: Word>(&self, key: &str, default: T) -> Option<T> {
        self.or(key, default, |key| self.word(key))
    }

    /// A text.
    pub fn text(&self, key: &str) -> Option<&'a str> {
        let node = self.node(key)?;
        match &node.value {
            Value::Text(text) => Some(text),
            _ => {
                self.wrong_type(node, key, key, "a text in quotes");
                None
            }
        }
    }

    /// One of several words.
    pub fn choice<T: Copy>(
        &self,
        key: &str,
        choices: &[T],
        name: fn(T) -> &'static str,
    ) -> Option<T> {
        self.choice_in(self.node(key)?, key, key, choices, name)
    }

    /// One of several words within the value of `key`; `at` says which.
    pub fn choice_in<T: Copy>(
        &self,
        node: &Node,
        key: &str,
        at: &str,
        choices: &[T],
        name: fn(T) -> &'static str,
    ) -> Option<T> {
        let Value::Text(text) = &node.value else {
            self.wrong_type(node, key, at, "a word in quotes");
            return None;
        };
        let found = choices.iter().find(|choice| name(**choice) == text);
        if found.is_none() {
            let allowed = choices.iter().map(|choice| name(*choice));
            let error = SceneError::UnknownWord {
                found: units::quoted(text),
                nearest: suggestion(text, allowed.clone()).map(str::to_owned),
                allowed: allowed.map(str::to_string).collect(),
            };
            self.report_at(node.place, at, error);
        }
        found.copied()
    }

    /// Whether the key is a list without entries.
    pub fn is_empty_list(&self, key: &str) -> bool {
        matches!(self.node(key).map(|node| &node.value), Some(Value::List(list)) if list.is_empty())
    }

    /// The entries of a list, each with its dotted name within this table.
    pub fn list(&self, key: &str, expected: &str) -> Option<Vec<(String, &'a Node)>> {
        let node = self.node(key)?;
        match &node.value {
            Value::List(list) => Some(numbered(key, list)),
            _ => {
                self.wrong_type(node, key, key, expected);
                None
            }
        }
    }

    /// One value for both axes, or a list of two: x, y.
    pub fn one_or_two<T: Copy>(
        &self,
        key: &str,
        read: impl Fn(&Node, &str) -> Option<T>,
    ) -> Option<[T; 2]> {
        let node = self.node(key)?;
        match &node.value {
            Value::List(_) => self.two(key, read),
            _ => read(node, key).map(|value| [value, value]),
        }
    }

    /// A list of two values: x, y.
    pub fn two<T>(&self, key: &str, read: impl Fn(&Node, &str) -> Option<T>) -> Option<[T; 2]> {
        let node = self.node(key)?;
        match &node.value {
            Value::List(list) if list.len() == 2 => {
                // Both are read before returning, so that both mistakes are noted.
                let x = read(&list[0], &format!("{key}.0"));
                let y = read(&list[1], &format!("{key}.1"));
                Some([x?, y?])
            }
            _ => {
                self.wrong_type(node, key, key, "a list of two values, x and y");
                None
            }
        }
    }

    /// A table inside this one.
    pub fn table(&self, key: &str, section: &'static Section) -> Option<Reader<'a>> {
        let node = self.node(key)?;
        match &node.value {
            Value::Table(table) => {
                let path = self.dotted(key);
                Some(Reader::open(table, node.place, &path, section, self.log))
            }
            _ => {
                self.wrong_type(node, key, key, "a table");
                None
            }
        }
    }

    /// Opens a table that has been read, to note conflicts between tables.
    pub fn table_again(&self, key: &str, section: &'static Section) -> Option<Reader<'a>> {
        let node = self.node(key)?;
        match &node.value {
            Value::Table(table) => Some(Reader {
                table,
                place: node.place,
                path: self.dotted(key),
                section,
                log: self.log,
                misspelled: Vec::new(),
            }),
            _ => None,
        }
    }

    /// The tables of an array of tables inside this one; `section` picks the keys of each.
    pub fn tables(
        &self,
        key: &str,
        section: impl Fn(&Table) -> &'static Section,
    ) -> Option<Vec<Reader<'a>>> {
        let list = self.list(key, "an array of tables")?;
        let mut readers = Vec::with_capacity(list.len());
        for (name, node) in list {
            match &node.value {
                Value::Table(table) => readers.push(Reader::open(
                    table,
                    node.place,
                    &self.dotted(&name),
                    section(table),
                    self.log,
                )),
                _ => self.wrong_type(node, key, &name, "a table"),
            }
        }
        Some(readers)
    }
}

fn numbered<'a>(key: &str, list: &'a [Node]) -> Vec<(String, &'a Node)> {
    list.iter()
        .enumerate()
        .map(|(index, node)| (format!("{key}.{index}"), node))
        .collect()
}

/// A key as TOML shows it: in quotes unless it is a bare word.
pub(super) fn shown_key(key: &str) -> String {
    let bare = |letter: char| letter.is_ascii_alphanumeric() || "-_.".contains(letter);
    if key.chars().all(bare) && key.len() <= 60 {
        key.into()
    } else {
        units::quoted(key)
    }
}
