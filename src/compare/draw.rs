//! `compare.png`: area, mean gap, attraction and pull-off against load, one colour a model.

use super::Comparison;
use super::table::Row;
use crate::output::plot::{Axis, DISTINCT, Figure, Panel, Pen, PlotPoint, Series};

const COUNT: usize = DISTINCT.len();
/// Pens of models, and the same pale for rows out of their range.
const PENS: [Pen; 2 * COUNT] = {
    let mut pens = [DISTINCT[0]; 2 * COUNT];
    let mut i = 0;
    while i < COUNT {
        pens[i] = DISTINCT[i];
        pens[COUNT + i] = pale(DISTINCT[i]);
        i += 1;
    }
    pens
};

/// Two thirds of the way to white.
const fn pale(pen: Pen) -> Pen {
    let [r, g, b] = pen.colour;
    Pen {
        colour: [lighter(r), lighter(g), lighter(b)],
        ..pen
    }
}

const fn lighter(level: u8) -> u8 {
    255 - (255 - level) / 3
}

/// The figure of all rows.
pub(super) fn figure(comparison: &Comparison, rows: &[Row]) -> Figure {
    let mut models: Vec<&'static str> = Vec::new();
    for row in rows {
        if !models.contains(&row.model) {
            models.push(row.model);
        }
    }
    let mut names: Vec<String> = models
        .iter()
        .map(|model| {
            let of_model = rows.iter().filter(|row| row.model == *model);
            format!(
                "{model} {:.2} s",
                of_model.map(|row| row.seconds).sum::<f64>()
            )
        })
        .collect();
    // The pens of rows out of range have no names.
    names.resize(COUNT + models.len(), String::new());
    let series = |value: fn(&Row) -> Option<f64>, within: bool| {
        models.iter().enumerate().map(move |(name, model)| {
            // A path may go back and forth: points are joined in the order of the path.
            let of_model = rows.iter().filter(|row| row.model == *model);
            let points = of_model
                .filter(|row| row.limit.is_none() == within)
                .filter_map(|row| {
                    Some(PlotPoint {
                        x: row.state.mean_pressure,
                        y: value(row)?,
                        hollow: !within,
                    })
                });
            let pen = if within { name } else { COUNT + name };
            Series::marked_line(pen, points.collect())
        })
    };
    let panel = |title: &str, unit: &str, value: fn(&Row) -> Option<f64>| Panel {
        title: title.to_owned(),
        x: Axis::linear("mean pressure", "Pa"),
        y: Axis::linear(title, unit),
        series: series(value, true).chain(series(value, false)).collect(),
    };
    let title = comparison.setup.scene.title.clone();
    Figure {
        title: title.unwrap_or_else(|| "Models of one rough surface".to_owned()),
        note: "pale, dashed: out of the model's range; seconds of all its rows".to_owned(),
        names,
        pens: &PENS,
        panels: vec![
            panel("contact area", "", |row| row.state.contact_area_fraction),
            panel("mean gap", "m", |row| row.state.mean_gap),
            panel("adhesive pressure", "Pa", |row| row.state.adhesive_pressure),
            panel("pull-off pressure", "Pa", |row| row.pull_off),
        ],
        ..Figure::default()
    }
}
