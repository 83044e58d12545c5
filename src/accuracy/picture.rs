//! `accuracy.png`: error against seconds, both logarithmic, a panel a quantity.

use super::judge::Errors;
use super::report::{Report, Row};
use super::setting::{Taper, Varied};
use crate::output::panels::{Axis, Figure, Panel, PlotPoint, Series};

/// Errors below this are drawn at it: what is exact has no place on a logarithmic axis.
const LEAST: f64 = 1e-7;
/// A panel's title, and which error it shows.
type Shown = (&'static str, fn(&Errors) -> Option<f64>);

/// What a row varies, by the order of colours and marks.
const KINDS: [&str; 10] = [
    "grid",
    "tolerance",
    "precision",
    "no taper",
    "steps",
    "range",
    "dmt",
    "no adhesion",
    "half the taper",
    "time tolerance",
];

/// Which of [`KINDS`] a row is.
fn kind(row: &Row) -> usize {
    match (row.varied, row.setting.taper) {
        (Varied::Nothing, _) => 0,
        (Varied::Tolerance, _) => 1,
        (Varied::Precision, _) => 2,
        (Varied::Taper, Taper::Half) => 8,
        (Varied::Taper, _) => 3,
        (Varied::Steps, _) => 4,
        (Varied::Range, _) => 5,
        (Varied::Dmt, _) => 6,
        (Varied::NoAdhesion, _) => 7,
        (Varied::TimeTolerance, _) => 9,
    }
}

/// The picture of a report. Each colour and mark is what a setting varies; the line joins the
/// front; the dashed line is the uncertainty of the reference.
pub fn picture(report: &Report) -> Figure {
    let shown: [Shown; 4] = [
        ("error of contact area", |errors| errors.area),
        ("error of force or gap", |errors| errors.force),
        ("error of the pressure field", |errors| errors.pressure),
        ("error of pull-off", |errors| errors.pull_off),
    ];
    let judged =
        |of: fn(&Errors) -> Option<f64>| report.rows.iter().any(|row| of(&row.errors).is_some());
    let mut panels: Vec<Panel> = shown
        .into_iter()
        .filter(|(_, of)| judged(*of))
        .map(|(title, of)| panel(report, title, of))
        .collect();
    if report.rows.iter().any(|row| row.in_time.is_some()) {
        panels.push(in_time(report));
    }
    let reference = report.reference.as_ref();
    Figure {
        title: report
            .scene
            .title
            .clone()
            .unwrap_or_else(|| "What accuracy costs".to_owned()),
        note: format!(
            "line: front; dashed: uncertainty of the reference, {}",
            reference.map_or("none", |found| found.words.as_str())
        ),
        // What nothing varied has no entry; the others keep their colours.
        names: (0..KINDS.len())
            .map(
                |index| match report.rows.iter().any(|row| kind(row) == index) {
                    true => KINDS[index].to_owned(),
                    false => String::new(),
                },
            )
            .collect(),
        panels,
        columns: 2,
    }
}

fn panel(report: &Report, title: &str, of: fn(&Errors) -> Option<f64>) -> Panel {
    let place = |row: &Row| {
        Some(PlotPoint {
            x: row.measured.seconds,
            y: of(&row.errors)?.max(LEAST),
            hollow: false,
        })
    };
    let front = report.front(of);
    let mut series = vec![Series {
        name: 0,
        points: front
            .iter()
            .filter_map(|index| place(&report.rows[*index]))
            .collect(),
        line: true,
        marks: false,
    }];
    let seconds = report.rows.iter().map(|row| row.measured.seconds);
    let (first, last) = seconds.fold((f64::INFINITY, 0.0_f64), |(low, high), seconds| {
        (low.min(seconds), high.max(seconds))
    });
    let uncertainty = report.uncertainty(of);
    if uncertainty > 0.0 && uncertainty.is_finite() {
        let at = |x: f64| PlotPoint {
            x,
            y: uncertainty.max(LEAST),
            hollow: true,
        };
        series.push(Series {
            name: 0,
            points: vec![at(first), at(last)],
            line: true,
            marks: false,
        });
    }
    series.extend(marks(report, place));
    Panel {
        title: title.to_owned(),
        x: axis("seconds", "s"),
        y: axis(title, ""),
        series,
    }
}

/// Error in time of what answers the path against the number of steps, of all grids: a grid changes
/// little of it.
fn in_time(report: &Report) -> Panel {
    let title = "error in time of force or gap, same grid";
    let place = |row: &Row| {
        Some(PlotPoint {
            x: row.measured.walked as f64,
            y: row.in_time?.force?.max(LEAST),
            hollow: false,
        })
    };
    Panel {
        title: title.to_owned(),
        x: axis("steps", ""),
        y: axis(title, ""),
        series: marks(report, place),
    }
}

/// A mark a row, by what it varies.
fn marks(report: &Report, place: impl Fn(&Row) -> Option<PlotPoint>) -> Vec<Series> {
    let of_kind = |index: usize| report.rows.iter().filter(move |row| kind(row) == index);
    (0..KINDS.len())
        .map(|name| Series {
            name,
            points: of_kind(name).filter_map(&place).collect(),
            line: false,
            marks: true,
        })
        .collect()
}

fn axis(name: &str, unit: &str) -> Axis {
    Axis {
        name: name.to_owned(),
        unit: unit.to_owned(),
        logarithmic: true,
    }
}
