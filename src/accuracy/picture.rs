//! `accuracy.png`: error against seconds, both logarithmic, a panel a quantity.

use super::judge::Errors;
use super::setting::Varied;
use super::study::{Report, Row};
use crate::output::panels::{Axis, Figure, Panel, PlotPoint, Series};

/// Errors below this are drawn at it: what is exact has no place on a logarithmic axis.
const LEAST: f64 = 1e-7;
/// A panel's title, and which error it shows.
type Shown = (&'static str, fn(&Errors) -> Option<f64>);

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
    let panels: Vec<Panel> = shown
        .into_iter()
        .filter(|(_, of)| judged(*of))
        .map(|(title, of)| panel(report, title, of))
        .collect();
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
        names: Varied::ALL.map(|varied| varied.name().to_owned()).to_vec(),
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
    for (name, varied) in Varied::ALL.into_iter().enumerate() {
        let of_kind = report.rows.iter().filter(|row| row.varied == varied);
        series.push(Series {
            name,
            points: of_kind.filter_map(place).collect(),
            line: false,
            marks: true,
        });
    }
    let axis = |name: &str, unit: &str| Axis {
        name: name.to_owned(),
        unit: unit.to_owned(),
        logarithmic: true,
    };
    Panel {
        title: title.to_owned(),
        x: axis("seconds", "s"),
        y: axis(title, ""),
        series,
    }
}
