//! Options of `tabor fit` that ask something of a curve, beside a pull-off force in place of the curve.

use std::path::Path;

use super::calls::tabor;
use crate::shared::binary;
use crate::shared::trials::tests;

/// Options that belong to a pull-off force.
const ITS_OWN: [&str; 6] = ["radius", "pull-off", "stiffness", "load", "help", "version"];

/// All others, with a value where they take one.
const OF_A_CURVE: [(&str, Option<&str>); 14] = [
    ("cone", Some("20 deg")),
    ("pyramid", Some("20 deg")),
    ("out", Some("folder")),
    ("contact-at-zero", None),
    ("baseline", None),
    ("baseline-slope", None),
    ("columns", Some("approach=1")),
    ("sensitivity", Some("50 nm/V")),
    ("spring", Some("0.2 N/m")),
    ("spring-error", Some("10%")),
    ("radius-error", Some("10%")),
    ("relaxation", None),
    ("advise", None),
    ("range", Some("1 nm")),
];

/// Each is refused by name, and the table has all that the help lists.
fn what_asks_for_a_curve_is_refused_beside_a_pull_off() {
    let here = Path::new(".");
    let output = tabor(here, &["fit", "--help"], &[]);
    let help = String::from_utf8_lossy(&output.stdout);
    let mut listed: Vec<&str> = help
        .lines()
        .filter_map(|line| line.split_once("--"))
        .filter(|(before, _)| before.trim().is_empty() || before.trim().ends_with(','))
        .filter_map(|(_, name)| name.split(' ').next())
        .filter(|name| !ITS_OWN.contains(name))
        .collect();
    let mut known = OF_A_CURVE.map(|(name, _)| name).to_vec();
    listed.sort_unstable();
    known.sort_unstable();
    assert_eq!(listed, known, "{help}");
    for (name, value) in OF_A_CURVE {
        let option = format!("--{name}");
        let mut call = vec!["fit", "--pull-off", "1 uN", "--stiffness", "1 N/m", &option];
        call.extend(value);
        if !["cone", "pyramid"].contains(&name) {
            call.extend(["--radius", "5 um"]);
        }
        let output = tabor(here, &call, &[]);
        let message = binary::errors(&output);
        assert_eq!(output.status.code(), Some(2), "{call:?}: {message}");
        assert!(
            output.stdout.is_empty()
                && message.contains(&option)
                && message.contains("cannot be used with"),
            "{call:?}: {message}"
        );
    }
}

tests![what_asks_for_a_curve_is_refused_beside_a_pull_off];
