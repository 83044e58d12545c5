//! The tables of `docs/accuracy.md` from a table of `tabor accuracy`.

use std::collections::BTreeMap;
use std::fmt::Write;

/// The studies: names of their scenes, tables, pictures and parts of the page.
pub const STUDIES: [&str; 4] = ["sphere", "rough", "adhesive", "creep"];

/// A row by the names of its columns.
type Row = BTreeMap<String, String>;

/// The errors, by column and name.
const ERRORS: [(&str, &str); 4] = [
    ("error_area", "area"),
    ("error_force", "force or gap"),
    ("error_pressure", "pressure"),
    ("error_pull_off", "pull-off"),
];

/// Reads a table.
pub fn read(table: &str) -> Result<Vec<Row>, String> {
    let mut lines = table.lines();
    let names: Vec<&str> = lines.next().ok_or("an empty table")?.split(',').collect();
    lines
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            if cells.len() != names.len() {
                return Err(format!("not as many cells as columns: {line}"));
            }
            let named = names.iter().zip(cells);
            Ok(named
                .map(|(name, cell)| ((*name).to_owned(), cell.to_owned()))
                .collect())
        })
        .collect()
}

fn number(row: &Row, name: &str) -> Option<f64> {
    row.get(name)?.parse().ok()
}

fn percent(value: Option<f64>) -> String {
    match value.map(|value| 100.0 * value) {
        None => "-".to_owned(),
        Some(0.0) => "0 %".to_owned(),
        Some(value) if value < 1e-4 => format!("{value:.0e} %"),
        Some(value) => {
            let decimals = (1.0 - value.log10().floor()).max(0.0) as usize;
            format!("{value:.decimals$} %")
        }
    }
}

fn seconds(row: &Row) -> String {
    number(row, "seconds").map_or_else(String::new, |seconds| {
        let decimals = (1.0 - seconds.log10().floor()).max(0.0) as usize;
        format!("{seconds:.decimals$}")
    })
}

fn two_digits(value: Option<f64>) -> String {
    value.map_or_else(
        || "-".to_owned(),
        |value| {
            let decimals = (1.0 - value.log10().floor()).max(0.0) as usize;
            format!("{value:.decimals$}")
        },
    )
}

/// A table in Markdown.
fn markdown(head: &[String], lines: &[Vec<String>]) -> String {
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let mut text = line(head);
    text.push_str(&format!("|{}\n", "---|".repeat(head.len())));
    for cells in lines {
        text.push_str(&line(cells));
    }
    text
}

fn head(first: &[&str], errors: &[(&str, &str)]) -> Vec<String> {
    let errors = errors.iter().map(|(_, name)| format!("error of {name}"));
    first
        .iter()
        .map(|name| (*name).to_owned())
        .chain(errors)
        .collect()
}

/// All tables of a study.
pub fn tables(table: &str) -> Result<String, String> {
    let rows = read(table)?;
    let of =
        |varied: &str| -> Vec<&Row> { rows.iter().filter(|row| row["varied"] == varied).collect() };
    // Errors that were not measured have no column.
    let errors: Vec<(&str, &str)> = ERRORS
        .into_iter()
        .filter(|(column, _)| rows.iter().any(|row| number(row, column).is_some()))
        .collect();
    let cells = |row: &Row| -> Vec<String> {
        errors
            .iter()
            .map(|(column, _)| percent(number(row, column)))
            .collect()
    };
    let own = of("grid");
    let adhesive = own.iter().any(|row| number(row, "chi").is_some());
    let mut text = String::from("Grids, with the scene's own settings:\n\n");
    let lines: Vec<Vec<String>> = own
        .iter()
        .map(|row| {
            let mut line = vec![row["points"].clone(), seconds(row)];
            if adhesive {
                line.push(two_digits(number(row, "chi")));
                line.push(two_digits(number(row, "zone_pixels")));
            }
            line.extend(cells(row));
            line
        })
        .collect();
    let first: &[&str] = if adhesive {
        &["points a side", "seconds", "chi", "pixels across the zone"]
    } else {
        &["points a side", "seconds"]
    };
    text.push_str(&markdown(&head(first, &errors), &lines));
    let orders: Vec<String> = errors
        .iter()
        .filter_map(|(column, name)| Some(format!("{name} {:.1}", order(&own, column)?)))
        .collect();
    let uncertain: Vec<String> = [
        ("uncertainty_area", "area"),
        ("uncertainty_force", "force or gap"),
        ("uncertainty_pressure", "pressure"),
        ("uncertainty_pull_off", "pull-off"),
    ]
    .into_iter()
    .filter_map(|(column, name)| {
        let value = number(rows.first()?, column)?;
        (value > 0.0).then(|| format!("{name} {}", percent(Some(value))))
    })
    .collect();
    // Writing to a string cannot fail.
    let _ = writeln!(text, "\nOrder of convergence: {}.", orders.join(", "));
    if !uncertain.is_empty() {
        let _ = writeln!(
            text,
            "Uncertainty of the reference: {}.",
            uncertain.join(", ")
        );
    }
    let mut tapers = of("taper");
    tapers.sort_by_key(|row| {
        (
            row["points"].parse::<usize>().unwrap_or(0),
            row["taper"].len(),
        )
    });
    if !tapers.is_empty() {
        text.push_str("\nThe same without the taper, and with one of another length:\n\n");
        let lines: Vec<Vec<String>> = tapers
            .iter()
            .map(|row| {
                let taper = number(row, "taper").filter(|taper| *taper > 0.0);
                let mut line = vec![
                    row["points"].clone(),
                    two_digits(number(row, "zone_pixels")),
                    taper.map_or_else(
                        || "none".to_owned(),
                        |taper| format!("{} nm", two_digits(Some(1e9 * taper))),
                    ),
                    seconds(row),
                ];
                line.extend(cells(row));
                line
            })
            .collect();
        let first = [
            "points a side",
            "pixels across the zone",
            "taper",
            "seconds",
        ];
        text.push_str(&markdown(&head(&first, &errors), &lines));
    }
    text.push_str("\nPrecision and tolerance, by the change from double precision at the scene's own tolerance on the same grid (the largest of all errors):\n\n");
    let floors: Vec<Vec<String>> = floors(&rows);
    let first = [
        "precision",
        "backend",
        "tolerance",
        "largest change",
        "on the finest grid",
        "on grids",
    ]
    .map(str::to_owned);
    text.push_str(&markdown(&first, &floors));
    let models: Vec<&Row> = ["range", "dmt", "no adhesion"]
        .iter()
        .flat_map(|name| of(name))
        .collect();
    if !models.is_empty() {
        text.push_str("\nOther models, judged by the full law, each on its finest grid:\n\n");
        let lines: Vec<Vec<String>> = finest(&models)
            .into_iter()
            .map(|row| {
                let mut line = vec![row["varied"].clone(), row["points"].clone(), seconds(row)];
                line.extend(cells(row));
                line
            })
            .collect();
        let first = ["model", "points a side", "seconds"];
        text.push_str(&markdown(&head(&first, &errors), &lines));
    }
    let timed = |row: &Row| number(row, "error_in_time").is_some();
    let mut steps: Vec<&Row> = of("steps");
    if own.iter().any(|row| timed(row)) {
        let rows: Vec<&Row> = rows.iter().filter(|row| timed(row)).collect();
        text.push_str(&in_time(&rows, &errors));
    } else if !steps.is_empty() {
        let most = steps
            .iter()
            .filter_map(|row| number(row, "points"))
            .fold(0.0, f64::max);
        steps.retain(|row| number(row, "points") == Some(most));
        steps.extend(own.iter().filter(|row| number(row, "points") == Some(most)));
        steps.sort_by(|a, b| {
            number(a, "steps")
                .unwrap_or(0.0)
                .total_cmp(&number(b, "steps").unwrap_or(0.0))
        });
        let _ = writeln!(text, "\nSteps of the path, on {most} points a side:\n");
        let lines: Vec<Vec<String>> = steps
            .iter()
            .map(|row| {
                let mut line = vec![row["steps"].clone(), seconds(row)];
                line.extend(cells(row));
                line
            })
            .collect();
        text.push_str(&markdown(&head(&["steps", "seconds"], &errors), &lines));
    }
    Ok(text)
}

/// Numbered steps and those of `steps = "auto"` on the finest grid.
fn in_time(rows: &[&Row], errors: &[(&str, &str)]) -> String {
    let points = |row: &Row| number(row, "points").unwrap_or(0.0);
    let most = rows.iter().map(|row| points(row)).fold(0.0, f64::max);
    let mut rows: Vec<&Row> = rows
        .iter()
        .copied()
        .filter(|row| points(row) == most)
        .collect();
    let asked = |row: &Row| number(row, "time_tolerance");
    let count = |row: &Row| number(row, "steps").unwrap_or(0.0);
    rows.sort_by(|a, b| {
        let order = asked(a).is_some().cmp(&asked(b).is_some());
        order.then(count(a).total_cmp(&count(b)))
    });
    let lines: Vec<Vec<String>> = rows
        .into_iter()
        .map(|row| {
            let steps = match asked(row) {
                None => "equal on each ramp".to_owned(),
                Some(error) => format!("`\"auto\"` to {error:e}"),
            };
            let mut line = vec![steps, row["steps"].clone(), seconds(row)];
            line.push(percent(number(row, "error_in_time")));
            line.extend(
                errors
                    .iter()
                    .map(|(column, _)| percent(number(row, column))),
            );
            line
        })
        .collect();
    let first = ["steps", "of them", "seconds", "force or gap, in time"];
    let table = markdown(&head(&first, errors), &lines);
    format!(
        "\nSteps of the path, on {most} points a side, with what they change of the force or gap on this grid:\n\n{table}"
    )
}

/// The row of each model with the most points.
fn finest<'a>(rows: &[&'a Row]) -> Vec<&'a Row> {
    let mut found: Vec<&Row> = Vec::new();
    for row in rows {
        match found
            .iter_mut()
            .find(|known| known["varied"] == row["varied"])
        {
            Some(known) if number(known, "points") < number(row, "points") => *known = row,
            Some(_) => {}
            None => found.push(row),
        }
    }
    found
}

/// Each precision and tolerance, with its largest change over the grids and that on the finest.
fn floors(rows: &[Row]) -> Vec<Vec<String>> {
    let mut groups: BTreeMap<[String; 3], Vec<(f64, f64)>> = BTreeMap::new();
    for row in rows {
        if !["precision", "tolerance"].contains(&row["varied"].as_str()) {
            continue;
        }
        let key = ["precision", "backend", "tolerance"].map(|name| row[name].clone());
        if let (Some(points), Some(change)) = (number(row, "points"), number(row, "change")) {
            groups.entry(key).or_default().push((points, change));
        }
    }
    let mut lines = Vec::new();
    for (key, mut changes) in groups {
        changes.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (Some(first), Some(last)) = (changes.first(), changes.last()) else {
            continue;
        };
        let grids = if first.0 == last.0 {
            first.0.to_string()
        } else {
            format!("{} to {}", first.0, last.0)
        };
        let largest = changes.iter().map(|change| change.1).fold(0.0, f64::max);
        let mut line = key.to_vec();
        line.extend([percent(Some(largest)), percent(Some(last.1)), grids]);
        lines.push(line);
    }
    lines
}

/// Least-squares slope of the logarithms of error against pixel size over all grids.
fn order(own: &[&Row], column: &str) -> Option<f64> {
    let points: Vec<(f64, f64)> = own
        .iter()
        .filter_map(|row| {
            let error = number(row, column).filter(|error| *error > 0.0)?;
            Some((number(row, "points")?.ln(), error.ln()))
        })
        .collect();
    if points.len() < 3 {
        return None;
    }
    let count = points.len() as f64;
    let x = points.iter().map(|p| p.0).sum::<f64>() / count;
    let y = points.iter().map(|p| p.1).sum::<f64>() / count;
    let across: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    let along: f64 = points.iter().map(|p| (p.0 - x).powi(2)).sum();
    Some(-across / along)
}
