//! `compare.png`: area, mean gap, attraction and pull-off against load, one colour a model.

use super::Comparison;
use super::table::Row;
use crate::output::plot::{Axis, Figure, Panel, PlotPoint, Series};

/// The figure of all rows.
pub(super) fn figure(comparison: &Comparison, rows: &[Row]) -> Figure {
    let mut models: Vec<&'static str> = Vec::new();
    for row in rows {
        if !models.contains(&row.model) {
            models.push(row.model);
        }
    }
    let names = models
        .iter()
        .map(|model| {
            let of_model = rows.iter().filter(|row| row.model == *model);
            format!(
                "{model} {:.2} s",
                of_model.map(|row| row.seconds).sum::<f64>()
            )
        })
        .collect();
    let panel = |title: &str, unit: &str, value: fn(&Row) -> Option<f64>| Panel {
        title: title.to_owned(),
        x: Axis::linear("mean pressure", "Pa"),
        y: Axis::linear(title, unit),
        series: models
            .iter()
            .enumerate()
            .map(|(name, model)| {
                // A path may go back and forth: points are joined in the order of the path.
                let of_model = rows.iter().filter(|row| row.model == *model);
                let points = of_model.filter_map(|row| {
                    Some(PlotPoint {
                        x: row.state.mean_pressure,
                        y: value(row)?,
                        hollow: row.limit.is_some(),
                    })
                });
                Series::marked_line(name, points.collect())
            })
            .collect(),
    };
    let title = comparison.setup.scene.title.clone();
    Figure {
        title: title.unwrap_or_else(|| "Models of one rough surface".to_owned()),
        note: "hollow, dashed: out of the model's range; seconds of all its rows".to_owned(),
        names,
        panels: vec![
            panel("contact area", "", |row| row.state.contact_area_fraction),
            panel("mean gap", "m", |row| row.state.mean_gap),
            panel("adhesive pressure", "Pa", |row| row.state.adhesive_pressure),
            panel("pull-off pressure", "Pa", |row| row.pull_off),
        ],
        ..Figure::default()
    }
}
