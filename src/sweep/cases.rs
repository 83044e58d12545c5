//! The cases of a study: every combination of the values of its axes.

use std::fmt;
use std::path::Path;
use std::str::FromStr;

use serde_json::Value;

use super::axis::Axis;

/// A case: a scene with one value for each axis.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Case {
    /// Its number, from 1.
    pub number: usize,
    /// Keys and values, as `--set` takes them.
    pub settings: Vec<(String, String)>,
}

impl Case {
    /// The case in words.
    pub fn words(&self) -> String {
        let each: Vec<String> = self
            .settings
            .iter()
            .map(|(key, value)| format!("{key}={value}"))
            .collect();
        each.join(" ")
    }
}

/// All cases; the last axis changes fastest.
pub(super) fn cases(axes: &[Axis]) -> impl Iterator<Item = Case> {
    let count: usize = axes.iter().map(|axis| axis.values.len()).product();
    (0..count).map(|index| {
        let mut rest = index;
        let mut settings = Vec::new();
        for axis in axes.iter().rev() {
            let values = &axis.values[rest % axis.values.len()];
            rest /= axis.values.len();
            let pairs = axis.keys.iter().cloned().zip(values.iter().cloned());
            settings.splice(0..0, pairs);
        }
        Case {
            number: index + 1,
            settings,
        }
    })
}

/// A share of the cases, for one of several processes: `2/8` is the second of eight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Share {
    /// Its number, from 1.
    pub number: usize,
    /// The number of shares.
    pub of: usize,
}

impl Share {
    /// Whether the case of this number belongs to it.
    pub fn has(self, case: usize) -> bool {
        (case - 1) % self.of == self.number - 1
    }
}

impl fmt::Display for Share {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}/{}", self.number, self.of)
    }
}

impl FromStr for Share {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let parts = text.split_once('/');
        let number = |part: &str| part.trim().parse::<usize>().ok();
        match parts.and_then(|(first, second)| Some((number(first)?, number(second)?))) {
            Some((number, of)) if (1..=of).contains(&number) => Ok(Share { number, of }),
            _ => Err("write i/n, as in 2/8 for the second of eight shares".to_owned()),
        }
    }
}

/// The value at a key of a resolved scene, such as `surface.0.rms_slope`; `None` for keys of ramps, since a resolved
/// scene with durations has a ramp for each step.
pub(super) fn value_at<'a>(resolved: &'a Value, key: &str) -> Option<&'a Value> {
    let mut names = key.split('.').map(str::trim);
    if names.next() == Some("loading") && names.next() == Some("ramp") {
        return None;
    }
    key.split('.')
        .try_fold(resolved, |value, name| match value {
            Value::Array(list) => list.get(name.trim().parse::<usize>().ok()?),
            other => other.get(name.trim()),
        })
}

/// A word that a shell reads as it is.
pub(super) fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "/._-+=,:@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

/// The command that runs one of `count` cases of a study in a folder.
pub fn command(
    study: &Path,
    folder: &Path,
    case: &Case,
    count: usize,
    set: &[(String, String)],
) -> String {
    let [study, folder] = [study, folder].map(|path| quoted(&path.display().to_string()));
    let set: String = set
        .iter()
        .map(|(key, value)| format!(" --set {}", quoted(&format!("{key}={value}"))))
        .collect();
    format!(
        "tabor sweep {study} --out {folder} --only {}/{count}{set}",
        case.number
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_axis_changes_fastest() {
        let axis = |key: &str, values: &[&str]| Axis {
            keys: vec![key.to_owned()],
            values: values
                .iter()
                .map(|value| vec![(*value).to_owned()])
                .collect(),
        };
        let all: Vec<Case> =
            cases(&[axis("a", &["1", "2"]), axis("b", &["3", "4", "5"])]).collect();
        let words: Vec<String> = all.iter().map(Case::words).collect();
        assert_eq!(
            words,
            [
                "a=1 b=3", "a=1 b=4", "a=1 b=5", "a=2 b=3", "a=2 b=4", "a=2 b=5"
            ]
        );
        let shares: Vec<Share> = ["1/2", "2/2"]
            .map(|text| text.parse().expect("a share"))
            .into();
        for case in &all {
            assert_eq!(
                shares.iter().filter(|share| share.has(case.number)).count(),
                1
            );
        }
        for wrong in ["", "1", "0/2", "3/2", "1/0", "a/b", "-1/2"] {
            assert!(wrong.parse::<Share>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn words_for_a_shell() {
        assert_eq!(quoted("a/b.toml"), "a/b.toml");
        assert_eq!(quoted("two words"), "'two words'");
        assert_eq!(quoted("it's"), r"'it'\''s'");
    }
}
