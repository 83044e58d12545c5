//! `fit.png`: the curve with the fitted model, and the residuals.

use super::choice::FitResult;
use super::headline::headline;
use super::segments::Segment;
use crate::output::plot::{Axis, DIRECTIONS, Figure, LARGE, Panel, PlotPoint, Series, Style};

/// Indices into [`DIRECTIONS`], and their names.
const LOADING: usize = 0;
const UNLOADING: usize = 1;
const MODEL: usize = 2;
const NAMES: [&str; 3] = ["loading", "unloading", "model"];
/// A large panel for the curve and a low one for the residuals.
const STYLE: Style = Style {
    width: 940,
    heights: &[500, 170],
    stroke: 1.5,
    mark: 2.0,
    ticks: 8,
    ..LARGE
};

/// The figure of a fit.
pub fn figure(result: &FitResult, title: &str) -> Figure {
    let fit = result.best();
    let samples = &result.measured.samples;
    let measured = |at: usize| samples[at].approach;
    // At a known position the approach of the model goes with its own deflection.
    let beam = result.measured.beam.as_ref();
    let of_model = |at: usize| {
        let rest = samples[at].force - fit.fitted[at];
        beam.map_or(measured(at), |beam| measured(at) + rest / beam.spring)
    };
    // A series for each segment: the data as marks, the model as a line.
    let panel = |title: &str, data: &dyn Fn(usize) -> f64, model: &dyn Fn(usize) -> f64| {
        let segments = result.measured.segments.iter();
        let points =
            |segment: &Segment, place: &dyn Fn(usize) -> f64, value: &dyn Fn(usize) -> f64| {
                let point = |at: usize| PlotPoint::new(place(at), value(at));
                segment.points.clone().map(point).collect::<Vec<_>>()
            };
        let marks = segments.clone().map(|segment| {
            let name = if segment.loading { LOADING } else { UNLOADING };
            Series::marks(name, points(segment, &measured, data))
        });
        let lines = segments.map(|segment| Series::line(MODEL, points(segment, &of_model, model)));
        Panel {
            title: title.to_owned(),
            x: Axis::linear("approach of the probe", "m"),
            y: Axis::linear(title, "N"),
            series: marks.chain(lines).collect(),
        }
    };
    Figure {
        title: title.to_owned(),
        note: headline(result),
        names: NAMES.map(str::to_owned).to_vec(),
        pens: DIRECTIONS,
        panels: vec![
            panel("force", &|at| samples[at].force, &|at| fit.fitted[at]),
            panel(
                "data - model",
                &|at| samples[at].force - fit.fitted[at],
                &|_| 0.0,
            ),
        ],
        columns: 1,
        style: STYLE,
    }
}
