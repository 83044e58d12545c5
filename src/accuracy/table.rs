//! `accuracy.csv`, and the table on the terminal.

use std::fmt::Write;
use std::path::Path;

use super::errors::Errors;
use super::pareto;
use super::report::{Report, Row, duration};
use super::setting::Varied;
use super::steps::Steps;
use crate::output::csv_line::{csv_line, csv_number};
use crate::output::{OutputError, expect_table, write_atomically};

/// First columns of every `accuracy.csv`, including those of older versions.
const FIRST_COLUMNS: &str = "points,backend,precision,tolerance,steps,treatment,taper,seconds,error_area,error_force,error_pressure,error_pull_off,reference_uncertainty,pareto";

/// The columns after those.
const MORE_COLUMNS: &str = "error_largest,varied,range,chi,zone_pixels,change,iterations,transforms,converged,uncertainty_area,uncertainty_force,uncertainty_pressure,uncertainty_pull_off,time_tolerance,error_in_time";

/// Errors for which the cheapest setting is named.
pub const LEVELS: [f64; 3] = [0.1, 0.01, 0.001];

/// A setting is named for one quantity only if the others are wrong by at most so many times its level.
const OTHERS: f64 = 10.0;

/// A quantity of [`Errors`].
type Quantity = fn(&Errors) -> Option<f64>;

/// Each quantity, and all together.
const QUANTITIES: [(&str, Quantity); 5] = [
    ("contact area", |errors| errors.area),
    ("force or gap", |errors| errors.force),
    ("pressure", |errors| errors.pressure),
    ("pull-off", |errors| errors.pull_off),
    ("all of them", Errors::largest),
];

/// The table of all rows so far as CSV. Unknown values are empty.
pub fn csv(report: &Report) -> String {
    let mut text = format!("{FIRST_COLUMNS},{MORE_COLUMNS}\n");
    let pareto = report.pareto(Errors::largest);
    let uncertainty = report.reference.as_ref().map(|found| found.uncertainty);
    for (index, row) in report.rows.iter().enumerate() {
        let setting = &row.setting;
        let mut cells = vec![
            points(setting.points),
            setting.backend.name().to_owned(),
            setting.precision.name().to_owned(),
            format!("{:e}", setting.tolerance),
            row.measured.steps_solved.to_string(),
            setting.treatment(&report.scene).to_owned(),
            csv_number(row.taper),
            format!("{:.6}", row.measured.seconds),
        ];
        cells.extend(row.errors.all().map(csv_number));
        cells.push(csv_number(uncertainty.and_then(|known| known.largest())));
        cells.push(pareto.contains(&index).to_string());
        cells.push(csv_number(row.errors.largest()));
        cells.push(row.varied.name().to_owned());
        cells.extend([row.range, row.chi, row.zone_pixels, row.change].map(csv_number));
        cells.push(row.measured.iterations.to_string());
        cells.push(format!("{:e}", row.measured.transforms));
        cells.push(row.measured.converged.to_string());
        cells.extend(uncertainty.unwrap_or_default().all().map(csv_number));
        let time_tolerance = match setting.steps {
            Steps::Auto(tolerance) => Some(tolerance),
            _ => None,
        };
        cells.extend([time_tolerance, row.in_time.and_then(|errors| errors.force)].map(csv_number));
        text += &csv_line(cells);
    }
    text
}

/// Writes `accuracy.csv`, in one piece.
///
/// # Errors
/// An existing file of that name that is not such a table; errors of the system.
pub fn write_csv(path: &Path, report: &Report) -> Result<(), OutputError> {
    expect_place(path)?;
    write_atomically(path, csv(report).as_bytes())
}

/// Refuses a path with an existing file that is not such a table.
///
/// # Errors
/// [`OutputError::Refused`] in that case.
pub fn expect_place(path: &Path) -> Result<(), OutputError> {
    expect_table(path, FIRST_COLUMNS)
}

/// `256`, or `256x128`.
fn points([nx, ny]: [usize; 2]) -> String {
    if nx == ny {
        nx.to_string()
    } else {
        format!("{nx}x{ny}")
    }
}

/// Per cent with two digits.
fn percent(value: Option<f64>) -> String {
    match value.map(|value| 100.0 * value) {
        None => "-".to_owned(),
        Some(value) if !value.is_finite() => "?".to_owned(),
        Some(0.0) => "0 %".to_owned(),
        Some(value) if value < 1e-4 => format!("{value:.0e} %"),
        Some(value) => {
            let decimals = (1.0 - value.log10().floor()).max(0.0) as usize;
            format!("{value:.decimals$} %")
        }
    }
}

/// The report for the terminal.
pub fn screen(report: &Report) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let mut line = |words: String| {
        let _ = writeln!(text, "{words}");
    };
    if let Some(reference) = &report.reference {
        line(format!("reference: {}", reference.words));
    }
    line(format!(
        "  {:<58} {:>8} {:>9} {:>9} {:>9} {:>9}",
        "setting", "seconds", "area", "force", "pressure", "pull-off"
    ));
    let pareto = report.pareto(Errors::largest);
    let mut order: Vec<usize> = (0..report.rows.len()).collect();
    order.sort_by_key(|index| {
        let row = &report.rows[*index];
        (row.varied as usize, row.setting.points)
    });
    for index in order {
        let row = &report.rows[index];
        line(format!(
            "{} {}{}",
            if pareto.contains(&index) { "*" } else { " " },
            cells(
                &row.setting.words(&report.scene),
                &duration(row.measured.seconds),
                &row.errors
            ),
            if row.measured.converged {
                ""
            } else {
                "  not converged"
            }
        ));
    }
    if let Some(reference) = &report.reference {
        line(format!(
            "  {}",
            cells("uncertainty of the reference", "", &reference.uncertainty)
        ));
        line(
            "* on the Pareto front: nothing is both cheaper and better, by the largest of the errors"
                .to_owned(),
        );
    }
    for level in LEVELS {
        line(format!(
            "cheapest for {}:",
            percent(Some(level)).replace(".0", "")
        ));
        for (name, of) in QUANTITIES {
            if let Some(words) = cheapest(report, of, level) {
                line(format!("  {name:<13} {words}"));
            }
        }
    }
    let orders: Vec<String> = QUANTITIES
        .iter()
        .filter_map(|(name, of)| Some(format!("{name} {:.1}", report.order(of)?)))
        .collect();
    if !orders.is_empty() {
        line(format!(
            "order of convergence with the grid: {}",
            orders.join(", ")
        ));
    }
    for words in in_time(report) {
        line(words);
    }
    if let Some(words) = own_setting(report) {
        line(words);
    }
    if !report.left_out.is_empty() {
        line(format!("left out, {} settings:", report.left_out.len()));
        for left in &report.left_out {
            line(format!("  {}: {}", left.words, left.reason));
        }
    }
    text
}

/// How far the scene as it stands is converged: the error of each quantity with that of the reference.
fn own_setting(report: &Report) -> Option<String> {
    let own = |row: &&Row| {
        row.varied == Varied::Nothing && Some(row.setting.points) == report.scene.grid.points
    };
    let row = report.rows.iter().find(own)?;
    let within = QUANTITIES[..QUANTITIES.len() - 1]
        .iter()
        .filter_map(|(name, of)| {
            let error = of(&row.errors)? + report.uncertainty(of);
            error
                .is_finite()
                .then(|| format!("{name} {}", percent(Some(error))))
        });
    let within: Vec<String> = within.collect();
    (!within.is_empty()).then(|| {
        format!(
            "the scene as it is, {} points, is converged to: {}",
            points(row.setting.points),
            within.join(", ")
        )
    })
}

/// Error in time of the finest grid that has both numbered steps and `steps = "auto"`.
fn in_time(report: &Report) -> Vec<String> {
    let rows = || report.rows.iter().filter(|row| row.in_time.is_some());
    let is_auto = |row: &Row| row.varied == Varied::TimeTolerance;
    let grids = rows()
        .filter(|row| is_auto(row))
        .map(|row| row.setting.points);
    let Some(points) = grids.max() else {
        return Vec::new();
    };
    let mut rows: Vec<&Row> = rows().filter(|row| row.setting.points == points).collect();
    rows.sort_by_key(|row| (is_auto(row), row.measured.steps_solved));
    let mut lines =
        vec!["of which in time, from the steps of the reference on the same grid:".to_owned()];
    lines.extend(rows.into_iter().map(|row| {
        let words = row.setting.words(&report.scene);
        let words = format!("{words}: {} steps", row.measured.steps_solved);
        let errors = row.in_time.unwrap_or_default();
        format!(
            "  {}",
            cells(&words, &duration(row.measured.seconds), &errors)
        )
    }));
    lines
}

fn cells(words: &str, seconds: &str, errors: &Errors) -> String {
    let [area, force, pressure, pull_off] = errors.all().map(percent);
    format!("{words:<58} {seconds:>8} {area:>9} {force:>9} {pressure:>9} {pull_off:>9}")
}

/// An error, unless another quantity is wrong by more than [`OTHERS`] times the level.
fn sound(errors: &Errors, of: Quantity, level: f64) -> Option<f64> {
    let largest = errors.largest()?;
    of(errors).filter(|_| largest <= OTHERS * level)
}

/// Why no setting is known to reach a level, by the least error and the uncertainty of the reference.
fn missed(best: f64, uncertainty: f64, level: f64) -> String {
    let [best_words, accurate] = [best, uncertainty].map(|error| percent(Some(error)));
    if uncertainty > level {
        format!(
            "unknown: the reference itself is accurate only to {accurate}; a longer budget gives a better one"
        )
    } else if best + uncertainty <= level {
        let most = percent(Some(OTHERS * level));
        format!("none: those that reached it are off by more than {most} in another quantity")
    } else if best <= level {
        format!(
            "unknown: the least error is {best_words}, and the reference itself is accurate only to {accurate}"
        )
    } else {
        format!("none reached it; the least error is {best_words}")
    }
}

/// The cheapest setting for a level, or a note that none reached it; `None` without errors.
fn cheapest(report: &Report, of: Quantity, level: f64) -> Option<String> {
    let least =
        |costs: &[(f64, Option<f64>)]| costs.iter().filter_map(|cost| cost.1).reduce(f64::min);
    let best = least(&report.costs(of))?;
    let costs = report.costs(|errors| sound(errors, of, level));
    let uncertainty = report.uncertainty(of);
    Some(match pareto::cheapest(&costs, uncertainty, level) {
        Some(index) => {
            let row: &Row = &report.rows[index];
            format!(
                "{} ({})",
                row.setting.words(&report.scene),
                duration(row.measured.seconds)
            )
        }
        None => missed(best, uncertainty, level),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_setting_whose_other_quantities_are_wrong_is_not_named() {
        let errors = |pull_off: f64| Errors {
            area: Some(0.005),
            pull_off: Some(pull_off),
            ..Errors::default()
        };
        assert_eq!(sound(&errors(0.09), |e| e.area, 0.01), Some(0.005));
        assert_eq!(sound(&errors(0.11), |e| e.area, 0.01), None);
        assert_eq!(sound(&errors(0.11), |e| e.area, 0.1), Some(0.005));
        assert_eq!(sound(&errors(0.11), |e| e.force, 0.1), None);
    }

    #[test]
    fn a_level_that_is_missed_is_explained_without_contradiction() {
        for (best, uncertainty, words) in [
            (0.0012, 0.0001, "none reached it; the least error is 0.12 %"),
            (
                0.0005,
                0.002,
                "unknown: the reference itself is accurate only to 0.20 %",
            ),
            // Below the level, but not with what the reference may be wrong by.
            (
                0.00097,
                0.00024,
                "unknown: the least error is 0.097 %, and the reference itself is accurate only to 0.024 %",
            ),
            (
                0.0005,
                0.0001,
                "none: those that reached it are off by more than 1.0 %",
            ),
        ] {
            let found = missed(best, uncertainty, 0.001);
            assert!(found.starts_with(words), "{found}");
        }
    }

    #[test]
    fn shares_have_two_digits() {
        let cases = [
            (0.123, "12 %"),
            (1.78, "178 %"),
            (0.0123, "1.2 %"),
            (0.001, "0.10 %"),
            (0.000_123, "0.012 %"),
            (1e-7, "1e-5 %"),
            (0.0, "0 %"),
            (f64::INFINITY, "?"),
        ];
        for (value, words) in cases {
            assert_eq!(percent(Some(value)), words);
        }
        assert_eq!(percent(None), "-");
        assert_eq!(
            LEVELS.map(|level| (100.0 * level).to_string()),
            ["10", "1", "0.1"]
        );
    }
}
