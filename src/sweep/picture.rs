//! The picture of a study: means as marks, their spread as bars.

use super::means::{Curve, Means};
use super::study::Study;
use crate::output::plot::{Axis, Figure, LARGE, Panel, PlotPoint, Series};
use crate::units::format_si;

/// Ratio of the ends of an axis from which it is logarithmic.
const DECADES: f64 = 30.0;

/// The picture of the means of a study.
pub(super) fn picture(study: &Study, means: &Means) -> Figure {
    let points = || means.curves.iter().flat_map(|curve| &curve.points);
    let y = axis(
        &means.quantity,
        means.unit,
        points().map(|point| point.mean),
    );
    let series = (means.curves.iter().enumerate())
        .flat_map(|(name, curve)| drawn(name, curve, y.logarithmic))
        .collect();
    let names = match &means.series {
        None => Vec::new(),
        Some(key) => (means.curves.iter())
            .map(|curve| format!("{} {}", words(key), in_words(&curve.value, study.unit(key))))
            .collect(),
    };
    let note = match means.others.as_slice() {
        [] => format!("{} runs", means.runs),
        others => format!(
            "{} runs; mean and standard deviation over {}",
            means.runs,
            others.join(", ")
        ),
    };
    Figure {
        title: study.title(),
        note,
        names,
        panels: vec![Panel {
            title: words(&means.quantity),
            x: axis(
                &means.x,
                study.unit(&means.x),
                points().map(|point| point.x),
            ),
            y,
            series,
        }],
        columns: 1,
        style: LARGE,
        ..Figure::default()
    }
}

/// A line through the means, and a bar of one standard deviation on both sides of each.
fn drawn(name: usize, curve: &Curve, logarithmic: bool) -> Vec<Series> {
    let mut series = Vec::new();
    for point in &curve.points {
        let Some(deviation) = point.deviation.filter(|deviation| *deviation > 0.0) else {
            continue;
        };
        let [low, high] = [point.mean - deviation, point.mean + deviation];
        // A bar that reaches below zero ends where the other half would on this axis.
        let low = if logarithmic && low <= 0.0 {
            point.mean * point.mean / high
        } else {
            low
        };
        let ends = [low, high].map(|y| PlotPoint::new(point.x, y));
        series.push(Series::line(name, ends.into()));
    }
    let means = curve.points.iter();
    let means = means.map(|point| PlotPoint::new(point.x, point.mean));
    series.push(Series::marked_line(name, means.collect()));
    series
}

/// A logarithmic axis where values span decades.
fn axis(name: &str, unit: &str, values: impl Iterator<Item = f64>) -> Axis {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    if low > 0.0 && high > DECADES * low {
        Axis::logarithmic(&words(name), unit)
    } else {
        Axis::linear(&words(name), unit)
    }
}

/// The last name of a key in words.
fn words(key: &str) -> String {
    key.rsplit('.').next().unwrap_or(key).replace('_', " ")
}

fn in_words(cell: &str, unit: &str) -> String {
    match cell.parse() {
        Ok(number) => format_si(number, unit),
        Err(_) => cell.to_owned(),
    }
}
