//! The short table of the steps at the end of a run.

use std::io::{Write, stderr};

use crate::study::StepRow;
use crate::units::format_si;

/// Steps shown at either end of a long path.
const SHOWN: usize = 12;

/// Prints the steps on standard error.
pub(super) fn print(rows: &[StepRow]) {
    // A terminal that is gone is no reason to fail a run that is done.
    let _ = stderr().lock().write_all(table(rows).as_bytes());
}

fn table(rows: &[StepRow]) -> String {
    let mut text = format!(
        "{:>5} {:>12} {:>12} {:>12} {:>9} {:>6} {:>9}  state\n",
        "step", "approach", "force", "pressure", "contact", "iter", "residual"
    );
    for (index, row) in rows.iter().enumerate() {
        if index >= SHOWN && index + SHOWN < rows.len() {
            if index == SHOWN {
                text.push_str(&format!("{:>5}\n", "..."));
            }
            continue;
        }
        let shown = |value: f64, unit: &str| match value.is_nan() {
            true => "-".to_owned(),
            false => format_si(value, unit),
        };
        let share = 100.0 * row.contact_area_fraction;
        text.push_str(&format!(
            "{:>5} {:>12} {:>12} {:>12} {:>9} {:>6} {:>9.1e}  {}\n",
            row.step,
            shown(row.approach.unwrap_or(f64::NAN), "m"),
            shown(row.force, "N"),
            shown(row.mean_pressure, "Pa"),
            if share.is_nan() {
                "-".to_owned()
            } else {
                format!("{share:.3}%")
            },
            row.iterations,
            row.residual,
            row.state_words()
        ));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::State;

    #[test]
    fn long_paths_are_cut_in_the_middle() {
        let row = |step: usize| StepRow {
            step,
            time: None,
            approach: (step < 30).then_some(-25e-9),
            mean_gap: None,
            force: 1.5e-6,
            mean_pressure: 2e6,
            contact_area_fraction: 0.125,
            attractive_area_fraction: 0.0,
            elastic_energy: 0.0,
            adhesive_energy: 0.0,
            iterations: 41,
            residual: 9.96e-7,
            converged: step < 29,
            seconds: 1.0,
            contact_area_fraction_corrected: None,
            state: State::Contact,
            columns: Vec::new(),
        };
        let text = table(&(1..=30).map(row).collect::<Vec<_>>());
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 1 + 12 + 1 + 12);
        let words = |line: &str| {
            line.split_whitespace()
                .map(str::to_owned)
                .collect::<Vec<_>>()
        };
        assert_eq!(
            words(lines[12]),
            [
                "12", "-25", "nm", "1.5", "µN", "2", "MPa", "12.500%", "41", "1.0e-6", "contact"
            ]
        );
        assert_eq!(words(lines[13]), ["..."]);
        assert_eq!(words(lines[14])[0], "19");
        assert_eq!(words(lines[25])[..2], ["30", "-"]);
        assert!(lines[24].ends_with("contact, not converged"));
        assert!(lines[25].ends_with(" no solution"));
        assert_eq!(table(&[row(1)]).lines().count(), 2);
    }
}
