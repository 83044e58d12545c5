//! Mistakes of a scene, in terms of the scene file.

use thiserror::Error;

use crate::units::UnitError;

/// A mistake at one place of a scene, with its remedy.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SceneError {
    /// The file cannot be read.
    #[error("cannot be read: {reason}")]
    Unreadable {
        /// Message of the system.
        reason: String,
    },
    /// The text is not TOML.
    #[error("not valid TOML: {reason}")]
    Syntax {
        /// Message of the parser.
        reason: String,
    },
    /// A key or table that does not exist.
    #[error("unknown key in {section}{}{}{}", meant(.nearest, "`"), takes(.nearest, known), elsewhere_hint(.elsewhere))]
    UnknownKey {
        /// The table's name.
        section: String,
        /// A known key of almost the same spelling.
        nearest: Option<String>,
        /// All keys of the table.
        known: Vec<String>,
        /// Tables that have a key of this name.
        elsewhere: Vec<String>,
    },
    /// A required key or table that is absent.
    #[error("missing; add for example `{example}`")]
    Missing {
        /// An example line.
        example: String,
    },
    /// A value of the wrong kind.
    #[error("{found} where {expected} is expected; write for example `{example}`")]
    WrongType {
        /// What was found.
        found: String,
        /// What was expected.
        expected: String,
        /// An example line.
        example: String,
    },
    /// A dimensional value with a wrong or missing unit.
    #[error(transparent)]
    Unit(#[from] UnitError),
    /// A number outside its limits.
    #[error("{found} is out of range; it must be {allowed}")]
    OutOfRange {
        /// The value as written.
        found: String,
        /// The limits.
        allowed: String,
    },
    /// A word that is not among those allowed.
    #[error("{found} is not one of {}{}", quoted_list(.allowed), meant(.nearest, "\""))]
    UnknownWord {
        /// The word as written.
        found: String,
        /// An allowed word of almost the same spelling.
        nearest: Option<String>,
        /// All allowed words.
        allowed: Vec<String>,
    },
    /// Values that cannot be combined.
    #[error("{reason}")]
    Conflict {
        /// The conflict and its remedy.
        reason: String,
    },
    /// A part of the scene format that this version lacks.
    #[error("{what} is not in this version; {instead}")]
    NotInThisVersion {
        /// The effect or choice.
        what: String,
        /// The remedy.
        instead: String,
    },
    /// A `--set` whose key does not exist.
    #[error("{reason}")]
    Override {
        /// Where the key fails, and how to write it.
        reason: String,
    },
}

fn quoted_list(words: &[String]) -> String {
    words
        .iter()
        .map(|word| format!("\"{word}\""))
        .collect::<Vec<_>>()
        .join(", ")
}

fn meant(nearest: &Option<String>, quote: &str) -> String {
    let nearest = nearest.as_ref();
    nearest.map_or_else(String::new, |nearest| {
        format!("; did you mean {quote}{nearest}{quote}?")
    })
}

fn takes(nearest: &Option<String>, known: &[String]) -> String {
    let begins = if nearest.is_some() { " It" } else { "; it" };
    format!("{begins} takes {}", known.join(", "))
}

fn elsewhere_hint(tables: &[String]) -> String {
    if tables.is_empty() {
        String::new()
    } else {
        format!("; a key of this name belongs in {}", tables.join(", "))
    }
}

/// One mistake with its location.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{file}{}{}: {error}", place(*.from_set, *.line), key_after_colon(.key))]
pub struct Mistake {
    /// The scene file as the caller named it.
    pub file: String,
    /// Line in the file, from 1; `None` if no line of the file is concerned.
    pub line: Option<usize>,
    /// The key, dotted as in an override, tables of an array counted from 0: `surface.0.hurst`. Empty
    /// for the whole file.
    pub key: String,
    /// Whether the value came from an override and not from the file.
    pub from_set: bool,
    /// The mistake and its remedy.
    #[source]
    pub error: SceneError,
}

fn place(from_set: bool, line: Option<usize>) -> String {
    match line {
        _ if from_set => ", from an override".to_string(),
        Some(line) => format!(":{line}"),
        None => String::new(),
    }
}

fn key_after_colon(key: &str) -> String {
    if key.is_empty() {
        String::new()
    } else {
        format!(": {key}")
    }
}

/// Mistakes shown; more usually come from a single error or from a file that is not a scene.
const MOST_SHOWN: usize = 20;

/// All mistakes of a scene in the order of its lines; displays the first 20, one a line, and the
/// number of the others.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{}", self.lines().collect::<Vec<_>>().join("\n"))]
pub struct SceneErrors(pub Vec<Mistake>);

impl SceneErrors {
    /// The displayed lines: one a mistake, and one with the number of omitted mistakes.
    pub fn lines(&self) -> impl Iterator<Item = String> {
        let left_out = match self.0.len().saturating_sub(MOST_SHOWN) {
            0 => None,
            1 => Some(format!("{}: 1 more mistake", self.0[0].file)),
            more => Some(format!("{}: {more} more mistakes", self.0[0].file)),
        };
        let shown = self.0.iter().take(MOST_SHOWN).map(Mistake::to_string);
        shown.chain(left_out)
    }
}
