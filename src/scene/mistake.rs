//! What can be wrong with a scene, said in its author's words.

use std::fmt;

use thiserror::Error;

use crate::units::UnitError;

/// What is wrong at one place of a scene, and what would be right.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SceneError {
    /// The file cannot be read.
    #[error("cannot be read: {reason}")]
    Unreadable {
        /// What the system says.
        reason: String,
    },
    /// The text is not TOML.
    #[error("not valid TOML: {reason}")]
    Syntax {
        /// What the parser says.
        reason: String,
    },
    /// A key or table that does not exist.
    #[error("unknown key in {section}; did you mean `{nearest}`? It takes {}{}", known.join(", "), elsewhere_hint(.elsewhere))]
    UnknownKey {
        /// The table, as it is named in the contract.
        section: String,
        /// The known key that is spelled most alike.
        nearest: String,
        /// All keys of the table.
        known: Vec<String>,
        /// The tables that do have a key of this name.
        elsewhere: Vec<String>,
    },
    /// A key or table without which the scene says too little.
    #[error("missing; add for example `{example}`")]
    Missing {
        /// A line that would do.
        example: String,
    },
    /// A value of the wrong kind.
    #[error("{found} where {expected} is expected; write for example `{example}`")]
    WrongType {
        /// What stands there.
        found: String,
        /// What should.
        expected: String,
        /// A line that would do.
        example: String,
    },
    /// A dimensional value with a wrong or missing unit, or none at all.
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
    /// A word that is none of those allowed.
    #[error("{found} is none of {}; did you mean \"{nearest}\"?", quoted_list(.allowed))]
    UnknownWord {
        /// The word as written.
        found: String,
        /// The allowed word that is spelled most alike.
        nearest: String,
        /// All allowed words.
        allowed: Vec<String>,
    },
    /// Values that are right by themselves and cannot stand together.
    #[error("{reason}")]
    Conflict {
        /// What excludes what, and the way out.
        reason: String,
    },
    /// Something the scene format knows and this version of tabor cannot do.
    #[error("{what} is not in this version; {instead}")]
    NotInThisVersion {
        /// The effect or choice.
        what: String,
        /// The way out.
        instead: String,
    },
    /// A `--set` that leads nowhere.
    #[error("{reason}")]
    Override {
        /// Where it stops, and how to write it.
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

fn elsewhere_hint(tables: &[String]) -> String {
    if tables.is_empty() {
        String::new()
    } else {
        format!("; a key of this name belongs in {}", tables.join(", "))
    }
}

/// One mistake with its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Mistake {
    /// The scene file, as it was named by the caller.
    pub file: String,
    /// Line in the file, from 1; `None` where nothing in the file stands for it.
    pub line: Option<usize>,
    /// The key, dotted as `--set` takes it, tables of an array counted from 0: `surface.0.hurst`.
    /// Empty where the whole file is meant.
    pub key: String,
    /// Whether the value came from `--set` and not from the file.
    pub from_set: bool,
    /// What is wrong, and what would be right.
    pub error: SceneError,
}

impl fmt::Display for Mistake {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.file)?;
        if self.from_set {
            formatter.write_str(", from --set")?;
        } else if let Some(line) = self.line {
            write!(formatter, ":{line}")?;
        }
        if !self.key.is_empty() {
            write!(formatter, ": {}", self.key)?;
        }
        write!(formatter, ": {}", self.error)
    }
}

impl std::error::Error for Mistake {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(&self.error)
    }
}

/// Mistakes that are shown; a file of many more is no scene, or one slip makes them all.
const MOST_SHOWN: usize = 20;

/// All mistakes of a scene, in the order of its lines; the first 20 are shown, one a line, and the number
/// of the others.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneErrors(pub Vec<Mistake>);

impl SceneErrors {
    /// What is shown: a line a mistake, and one for the number of those left out.
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

impl fmt::Display for SceneErrors {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let lines: Vec<String> = self.lines().collect();
        formatter.write_str(&lines.join("\n"))
    }
}

impl std::error::Error for SceneErrors {}
