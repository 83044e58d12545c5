//! `accuracy.png`: error against seconds, both logarithmic, one panel a quantity.

use super::errors::Errors;
use super::report::{Report, Row};
use super::setting::{Taper, Varied};
use crate::output::plot::{Axis, Figure, Panel, PlotPoint, Series};

/// Smaller errors are drawn at this value: a logarithmic axis has no zero.
const LEAST: f64 = 1e-7;
/// Title of a panel and the error it shows.
type Shown = (&'static str, fn(&Errors) -> Option<f64>);

/// The varied quantities, in the order of colours and marks.
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

/// Index of a row in [`KINDS`].
fn kind(row: &Row) -> usize {
    let name = match (row.varied, row.setting.taper) {
        (Varied::Taper, Taper::Half) => "half the taper",
        (Varied::Taper, _) => "no taper",
        (varied, _) => varied.name(),
    };
    let known = KINDS.iter().position(|kind| *kind == name);
    debug_assert!(known.is_some(), "{name} has a colour");
    known.unwrap_or(0)
}

/// The picture of a report. Colour and mark show what a setting varies; the line joins the Pareto
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
            "line: Pareto front; dashed: uncertainty of the reference, {}",
            reference.map_or("none", |found| found.words.as_str())
        ),
        // Unused kinds have no legend entry; the others keep their colours.
        names: (0..KINDS.len())
            .map(|index| {
                if report.rows.iter().any(|row| kind(row) == index) {
                    KINDS[index].to_owned()
                } else {
                    String::new()
                }
            })
            .collect(),
        panels,
        ..Figure::default()
    }
}

fn panel(report: &Report, title: &str, of: fn(&Errors) -> Option<f64>) -> Panel {
    let place = |row: &Row| {
        let error = of(&row.errors)?.max(LEAST);
        Some(PlotPoint::new(row.measured.seconds, error))
    };
    let pareto = report.pareto(of);
    let front = pareto.iter().map(|index| &report.rows[*index]);
    let mut series = vec![Series::line(0, front.filter_map(place).collect())];
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
        series.push(Series::line(0, vec![at(first), at(last)]));
    }
    series.extend(marks(report, place));
    Panel {
        title: title.to_owned(),
        x: Axis::logarithmic("seconds", "s"),
        y: Axis::logarithmic(title, ""),
        series,
    }
}

/// Error in time of the response to the path against the number of steps, for all grids together:
/// it depends little on the grid.
fn in_time(report: &Report) -> Panel {
    let title = "error in time of force or gap, same grid";
    let place = |row: &Row| {
        let error = row.in_time?.force?.max(LEAST);
        Some(PlotPoint::new(row.measured.steps_solved as f64, error))
    };
    Panel {
        title: title.to_owned(),
        x: Axis::logarithmic("steps", ""),
        y: Axis::logarithmic(title, ""),
        series: marks(report, place),
    }
}

/// One mark a row, by what it varies.
fn marks(report: &Report, place: impl Fn(&Row) -> Option<PlotPoint>) -> Vec<Series> {
    let of_kind = |index: usize| report.rows.iter().filter(move |row| kind(row) == index);
    (0..KINDS.len())
        .map(|name| Series::marks(name, of_kind(name).filter_map(&place).collect()))
        .collect()
}
