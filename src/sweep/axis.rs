//! The values of an axis, as text that `--set` takes.

use serde::Deserialize;
use toml::Value;

use crate::units::number_and_rest;

/// Most values of a range.
const MOST_VALUES: usize = 100_000;

/// An `[[axis]]` of a study.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct AxisTable {
    /// A key of the scene.
    key: Option<String>,
    /// Several keys that change together.
    keys: Option<Vec<String>>,
    /// Values; with `keys`, a list of the values of all keys each.
    values: Option<Vec<Value>>,
    /// First value of a range.
    from: Option<Value>,
    /// Last value of a range.
    to: Option<Value>,
    /// Number of values of a range.
    count: Option<usize>,
    /// How a range is spaced.
    spacing: Option<Spacing>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Spacing {
    Linear,
    Log,
}

/// Keys that change together, and their values one after another.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Axis {
    /// The keys.
    pub keys: Vec<String>,
    /// For each value of the axis, the text of each key.
    pub values: Vec<Vec<String>>,
}

impl AxisTable {
    /// The keys in words, for messages.
    pub fn words(&self) -> String {
        match (&self.key, &self.keys) {
            (Some(key), _) => key.clone(),
            (None, Some(keys)) => keys.join(", "),
            (None, None) => "no key".to_owned(),
        }
    }

    /// The axis, or what is wrong with it.
    pub fn read(&self) -> Result<Axis, String> {
        let (keys, together) = match (&self.key, &self.keys) {
            (Some(key), None) => (vec![key.clone()], false),
            (None, Some(keys)) if !keys.is_empty() => (keys.clone(), true),
            _ => {
                return Err("give one key, such as key = \"surface.0.seed\", or several that change together, such as keys = [\"grid.points\", \"surface.0.shortest\"]".into());
            }
        };
        let ranged = self.from.is_some() || self.to.is_some() || self.count.is_some();
        if self.values.is_some() && !ranged && self.spacing.is_some() {
            return Err(
                "spacing is that of a range (from, to and count); values are taken as they are"
                    .into(),
            );
        }
        let values = match (&self.values, ranged) {
            (Some(values), false) => values
                .iter()
                .map(|value| texts(value, keys.len(), together))
                .collect::<Result<Vec<_>, String>>()?,
            (None, true) if together => {
                return Err(
                    "a range is of one key; give the values of several as a list of lists".into(),
                );
            }
            (None, true) => self.range()?.into_iter().map(|text| vec![text]).collect(),
            (Some(_), true) => return Err("give values or from, to and count, not both".into()),
            (None, false) => {
                return Err("give values = [...], or from, to and count".into());
            }
        };
        if values.is_empty() {
            return Err("has no values; give at least one, or leave the axis out".into());
        }
        Ok(Axis { keys, values })
    }

    /// The texts of a range.
    fn range(&self) -> Result<Vec<String>, String> {
        let (Some(from), Some(to), Some(count)) = (&self.from, &self.to, self.count) else {
            return Err("a range needs from, to and count".into());
        };
        if !(1..=MOST_VALUES).contains(&count) {
            return Err(format!("count must be between 1 and {MOST_VALUES}"));
        }
        let (first, last) = (End::read(from)?, End::read(to)?);
        if first.unit != last.unit {
            return Err(format!(
                "write both ends of a range in one unit, not in {} and {}",
                first.unit_in_words(),
                last.unit_in_words()
            ));
        }
        if count == 1 && first.number != last.number {
            return Err(format!(
                "count = 1 leaves out to = {to}; give values = [{from}], or a larger count"
            ));
        }
        let spacing = self.spacing.unwrap_or(Spacing::Linear);
        if spacing == Spacing::Log && (first.number <= 0.0 || last.number <= 0.0) {
            return Err("a logarithmic range needs positive ends".into());
        }
        let whole = first.is_whole && last.is_whole;
        let at = |index: usize| match index {
            0 => first.number,
            index if index + 1 == count => last.number,
            index => {
                let share = index as f64 / (count - 1) as f64;
                without_rounding(match spacing {
                    Spacing::Linear => first.number + share * (last.number - first.number),
                    Spacing::Log => first.number * (last.number / first.number).powf(share),
                })
            }
        };
        let text = |number: f64| match first.unit.as_str() {
            // Between whole numbers lie whole ones: points, seeds.
            "" if whole => format!("{}", number.round() as i64),
            "" => format!("{number:?}"),
            unit => format!("\"{number:?} {unit}\""),
        };
        let texts: Vec<String> = (0..count).map(|index| text(at(index))).collect();
        if let Some(pair) = texts.windows(2).find(|pair| pair[0] == pair[1]) {
            let between = if whole {
                ", or write from and to with a decimal point, between which values need not be whole"
            } else {
                ""
            };
            return Err(format!(
                "{} comes twice; take a smaller count{between}",
                pair[0]
            ));
        }
        Ok(texts)
    }
}

/// The texts of one value of an axis.
fn texts(value: &Value, keys: usize, together: bool) -> Result<Vec<String>, String> {
    if !together {
        return Ok(vec![value.to_string()]);
    }
    match value {
        Value::Array(list) if list.len() == keys => {
            Ok(list.iter().map(ToString::to_string).collect())
        }
        _ => Err(format!(
            "{value} is not a list of {keys} values, one for each of the keys"
        )),
    }
}

/// An end of a range.
struct End {
    number: f64,
    unit: String,
    is_whole: bool,
}

impl End {
    fn read(value: &Value) -> Result<End, String> {
        let (number, unit, is_whole) = match value {
            Value::Integer(number) => (*number as f64, String::new(), true),
            Value::Float(number) => (*number, String::new(), false),
            Value::String(text) => {
                let (number, unit) = number_and_rest(text).ok_or_else(|| {
                    format!("\"{text}\" is not a number with a unit, such as \"25 um\"")
                })?;
                (number, unit.to_owned(), false)
            }
            other => return Err(format!("{other} is not a number, or a number with a unit")),
        };
        if !number.is_finite() {
            return Err("the ends of a range must be finite".into());
        }
        Ok(End {
            number,
            unit,
            is_whole,
        })
    }

    fn unit_in_words(&self) -> String {
        match self.unit.as_str() {
            "" => "SI".to_owned(),
            unit => unit.to_owned(),
        }
    }
}

/// A number without what rounding adds behind the twelfth digit: 0.15, not 0.15000000000000002.
fn without_rounding(number: f64) -> f64 {
    format!("{number:.11e}").parse().unwrap_or(number)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Axis, String> {
        toml::from_str::<AxisTable>(text).expect("an axis").read()
    }

    fn of_one(text: &str) -> Vec<String> {
        read(text).expect("values").values.concat()
    }

    #[test]
    fn ranges_end_where_they_say() {
        assert_eq!(
            of_one("key = \"k\"\nfrom = 64\nto = 256\ncount = 3"),
            ["64", "160", "256"]
        );
        assert_eq!(
            of_one("key = \"k\"\nfrom = 64\nto = 256\ncount = 3\nspacing = \"log\""),
            ["64", "128", "256"]
        );
        assert_eq!(
            of_one(
                "key = \"k\"\nfrom = \"1 mJ/m^2\"\nto = \"100 mJ/m^2\"\ncount = 3\nspacing = \"log\""
            ),
            ["\"1.0 mJ/m^2\"", "\"10.0 mJ/m^2\"", "\"100.0 mJ/m^2\""]
        );
        assert_eq!(
            of_one("key = \"k\"\nfrom = 0.1\nto = 0.3\ncount = 2"),
            ["0.1", "0.3"]
        );
        assert_eq!(
            of_one("key = \"k\"\nfrom = 0.1\nto = 0.1\ncount = 1"),
            ["0.1"]
        );
        assert_eq!(
            of_one("key = \"k\"\nfrom = 0.1\nto = 0.2\ncount = 3"),
            ["0.1", "0.15", "0.2"]
        );
    }

    #[test]
    fn lists_keep_their_words() {
        assert_eq!(
            of_one("key = \"k\"\nvalues = [1, 0.5, \"2 nm\", true]"),
            ["1", "0.5", "\"2 nm\"", "true"]
        );
        let together =
            read("keys = [\"a\", \"b\"]\nvalues = [[1, 2], [3, \"4 um\"]]").expect("values");
        assert_eq!(together.values, [["1", "2"], ["3", "\"4 um\""]]);
    }

    #[test]
    fn mistakes_say_how_to_mend_them() {
        for (text, word) in [
            ("values = [1]", "give one key"),
            ("key = \"k\"", "give values"),
            ("key = \"k\"\nvalues = []", "no values"),
            ("key = \"k\"\nvalues = [1]\ncount = 3", "not both"),
            ("key = \"k\"\nfrom = 1", "needs from, to and count"),
            ("key = \"k\"\nfrom = 1\nto = 2\ncount = 0", "between 1 and"),
            (
                "key = \"k\"\nfrom = \"1 nm\"\nto = \"2 nm\"\ncount = 1",
                "leaves out to = \"2 nm\"; give values = [\"1 nm\"]",
            ),
            (
                "key = \"k\"\nvalues = [1, 10]\nspacing = \"log\"",
                "spacing is that of a range",
            ),
            (
                "key = \"k\"\nfrom = 0\nto = 2\ncount = 2\nspacing = \"log\"",
                "positive",
            ),
            (
                "key = \"k\"\nfrom = \"1 nm\"\nto = \"1 um\"\ncount = 2",
                "one unit",
            ),
            (
                "key = \"k\"\nfrom = \"far\"\nto = \"1 um\"\ncount = 2",
                "with a unit",
            ),
            ("key = \"k\"\nfrom = nan\nto = 1.0\ncount = 2", "finite"),
            ("key = \"k\"\nfrom = 1\nto = 3\ncount = 5", "decimal point"),
            (
                "key = \"k\"\nfrom = 1.0\nto = 1.0\ncount = 2",
                "1.0 comes twice; take a smaller count",
            ),
            ("keys = [\"a\", \"b\"]\nvalues = [[1]]", "list of 2"),
            (
                "keys = [\"a\", \"b\"]\nfrom = 1\nto = 2\ncount = 2",
                "one key",
            ),
        ] {
            let said = read(text).expect_err(text);
            assert!(said.contains(word), "{text}: {said}");
        }
    }
}
