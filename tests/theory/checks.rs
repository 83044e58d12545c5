//! Every number of `tests/reference/theory_checks.json`, and the tables beside it, against
//! `tabor::theory`.
//!
//! A key names a function before its `#`; the rest tells sets of inputs apart. The environment
//! variable `TABOR_THEORY_CHECKS` names another file of the same form to be checked instead.

mod elastic;
mod inputs;
mod rough;
mod sphere;
mod surfaces;
mod tables;

use inputs::{Answer, Inputs};
use serde_json::Value;

/// Functions of the file that are not built yet, and why.
const NOT_BUILT: [(&str, &str); 0] = [];

/// The answer to a check, or nothing for a function that is not known.
fn evaluate(function: &str, inputs: &Inputs) -> Option<Answer> {
    sphere::evaluate(function, inputs)
        .or_else(|| rough::evaluate(function, inputs))
        .or_else(|| elastic::evaluate(function, inputs))
        .or_else(|| surfaces::evaluate(function, inputs))
}

/// Every number of `expected` that `got` misses, one line each.
fn misses(key: &str, got: &Value, expected: &Value, tolerance: (f64, f64)) -> Vec<String> {
    match expected {
        Value::Object(entries) => entries
            .iter()
            .flat_map(|(name, value)| {
                misses(&format!("{key}.{name}"), &got[name], value, tolerance)
            })
            .collect(),
        Value::Array(entries) => entries
            .iter()
            .enumerate()
            .flat_map(|(i, value)| misses(&format!("{key}[{i}]"), &got[i], value, tolerance))
            .collect(),
        _ => {
            let (relative, absolute) = tolerance;
            match (got.as_f64(), expected.as_f64()) {
                (Some(g), Some(e)) if (g - e).abs() <= absolute + relative * e.abs() => Vec::new(),
                _ => vec![format!("{key}: got {got}, expected {expected}")],
            }
        }
    }
}

#[test]
fn every_check_of_the_file() {
    let path = std::env::var("TABOR_THEORY_CHECKS").unwrap_or_else(|_| {
        concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/tests/reference/theory_checks.json"
        )
        .to_owned()
    });
    let text = std::fs::read_to_string(&path).expect("the file of checks is readable");
    let file: Value = serde_json::from_str(&text).expect("the file of checks is JSON");
    let checks = file["checks"].as_object().expect("it holds `checks`");
    let mut failures = Vec::new();
    let mut left_out = std::collections::BTreeMap::<&str, usize>::new();
    for (key, check) in checks {
        let function = key.split('#').next().unwrap_or_default();
        let inputs = Inputs::new(&check["inputs"], &check["expected"]);
        let answer = evaluate(function, &inputs);
        let not_built = NOT_BUILT.iter().find(|(name, _)| *name == function);
        match (answer, not_built) {
            (Some(_), Some(_)) => failures.push(format!("{key}: built, and listed as not built")),
            (None, Some((name, _))) => *left_out.entry(name).or_default() += 1,
            (None, None) => failures.push(format!("{key}: no such function")),
            (Some(Err(error)), None) => failures.push(format!("{key}: {error}")),
            (Some(Ok(got)), None) => {
                let tolerance = |name: &str| check[name].as_f64().unwrap_or(0.0);
                let tolerance = (tolerance("rtol"), tolerance("atol"));
                failures.extend(misses(key, &got, &check["expected"], tolerance));
            }
        }
    }
    for (name, reason) in NOT_BUILT {
        if let Some(count) = left_out.get(name) {
            println!("not built: {name} ({count} checks): {reason}");
        }
    }
    assert!(
        failures.is_empty(),
        "{} of {} checks fail:\n{}",
        failures.len(),
        checks.len(),
        failures.join("\n")
    );
}

#[test]
fn a_wrong_or_missing_number_is_a_failure() {
    let expected = serde_json::json!({ "a": 1.0, "b": [2.0, 3.0] });
    let got = serde_json::json!({ "a": 1.0 + 1e-9, "b": [2.0] });
    let lines = misses("key", &got, &expected, (1e-8, 0.0));
    assert_eq!(lines, ["key.b[1]: got null, expected 3.0"]);
    assert_eq!(misses("key", &got, &expected, (1e-10, 0.0)).len(), 2);
}
