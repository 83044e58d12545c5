//! Inputs of one check.

use serde_json::Value;

/// A check's numbers under the names of its `expected`, or the reason there are none.
pub type Answer = Result<Value, Box<dyn std::error::Error>>;

/// Named inputs; a missing one is NaN, which every theory refuses or returns.
pub struct Inputs<'a> {
    values: &'a Value,
    expected: &'a Value,
}

impl<'a> Inputs<'a> {
    pub fn new(values: &'a Value, expected: &'a Value) -> Self {
        Inputs { values, expected }
    }

    pub fn number(&self, name: &str) -> f64 {
        self.values[name].as_f64().unwrap_or(f64::NAN)
    }

    pub fn numbers<const N: usize>(&self, names: [&str; N]) -> [f64; N] {
        names.map(|name| self.number(name))
    }

    pub fn text(&self, name: &str) -> &str {
        self.values[name].as_str().unwrap_or_default()
    }

    /// Rows of numbers.
    pub fn rows(&self, name: &str) -> Vec<Vec<f64>> {
        let row = |row: &Value| {
            let row = row.as_array().into_iter().flatten();
            row.map(|v| v.as_f64().unwrap_or(f64::NAN)).collect()
        };
        self.values[name]
            .as_array()
            .into_iter()
            .flatten()
            .map(row)
            .collect()
    }

    /// Names under an entry of `expected`, where those are inputs themselves (loads, say).
    pub fn asked(&self, entry: &str) -> Vec<String> {
        self.expected[entry]
            .as_object()
            .map(|entries| entries.keys().cloned().collect())
            .unwrap_or_default()
    }
}
