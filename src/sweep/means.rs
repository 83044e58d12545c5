//! A quantity of the runs over one key, a curve for each value of another, averaged over all others.

use super::outcome::{Outcome, quantity_names, unit_of_quantity};
use super::study::Study;
use crate::output::csv_line::csv_line;

/// Most curves that are chosen where the study names none; more cannot be told apart.
const MOST_CURVES: usize = 10;
/// Quantities that are averaged if the study names none, the first that the runs have.
const CHOSEN: [&str; 2] = ["pull_off_force", "largest_contact_area_fraction"];

/// Mean and spread of a quantity.
pub(super) struct Means {
    /// The quantity.
    pub quantity: String,
    /// Its SI unit; `%` for a share.
    pub unit: &'static str,
    /// The key along x.
    pub x: String,
    /// The key of which each value has a curve.
    pub series: Option<String>,
    /// The keys that are averaged over.
    pub others: Vec<String>,
    /// The curves in the order of their values.
    pub curves: Vec<Curve>,
    /// The number of runs.
    pub runs: usize,
    /// Finished cases without a number along x, which are in no mean.
    pub left_out: usize,
    /// Finished cases with a number along x that lack the quantity, which are in no mean either.
    pub lacking: usize,
}

/// The means for one value of the series.
pub(super) struct Curve {
    /// That value as a cell; empty without a series.
    pub value: String,
    /// Its points from left to right.
    pub points: Vec<Mean>,
}

/// The mean over the runs at one place.
pub(super) struct Mean {
    /// Value of the key along x.
    pub x: f64,
    /// The number of runs.
    pub runs: usize,
    /// Their mean.
    pub mean: f64,
    /// Their standard deviation; `None` for one run.
    pub deviation: Option<f64>,
}

impl Means {
    /// The means over the finished cases, or what is missing for them.
    pub fn new(study: &Study, outcomes: &[&Outcome]) -> Result<Means, String> {
        let finished: Vec<&Outcome> = outcomes
            .iter()
            .copied()
            .filter(|outcome| outcome.is_finished())
            .collect();
        let keys: Vec<&str> = study.keys().collect();
        let (x, series) = places(study, &keys, &finished).ok_or(
            "[plot]: no key takes several numbers, along which means could be drawn; give an axis of numbers",
        )?;
        let has_x = |outcome: &&Outcome| number(&outcome.values[x]).is_some();
        let left_out = finished.len() - finished.iter().copied().filter(has_x).count();
        if left_out == finished.len() {
            return Err(format!(
                "plot.x: no finished case has a number at {}; take a key with numbers as x, and this one as series",
                keys[x]
            ));
        }
        let quantity = quantity(study, &finished)?;
        let values = match series {
            Some(series) => distinct(&finished, series),
            None => vec![""],
        };
        let curves = values.iter().map(|value| {
            let is_own =
                |outcome: &&&Outcome| series.is_none_or(|key| outcome.values[key] == *value);
            let points = finished.iter().filter(is_own).filter_map(|outcome| {
                let x = number(&outcome.values[x])?;
                Some([x, outcome.quantity(&quantity)?])
            });
            Curve {
                value: (*value).to_owned(),
                points: averaged(points.collect()),
            }
        });
        let curves: Vec<Curve> = curves.filter(|curve| !curve.points.is_empty()).collect();
        let points = curves.iter().flat_map(|curve| &curve.points);
        let runs: usize = points.map(|point| point.runs).sum();
        let is_other =
            |key: &usize| *key != x && Some(*key) != series && distinct(&finished, *key).len() > 1;
        if runs == 0 {
            return Err(format!(
                "[plot]: no finished case has both a number at {} and {}",
                keys[x], quantity
            ));
        }
        Ok(Means {
            unit: unit_of_quantity(&quantity, &finished),
            quantity,
            x: keys[x].to_owned(),
            series: series.map(|key| keys[key].to_owned()),
            others: (0..keys.len())
                .filter(is_other)
                .map(|key| keys[key].to_owned())
                .collect(),
            curves,
            lacking: finished.len() - left_out - runs,
            runs,
            left_out,
        })
    }

    /// As CSV, one row a point: the values of the keys, the number of runs, their mean and standard deviation.
    pub fn table(&self) -> String {
        let series = self.series.iter().map(String::as_str);
        let head = [
            self.x.as_str(),
            "runs",
            self.quantity.as_str(),
            "standard_deviation",
        ];
        let mut text = csv_line(series.chain(head));
        for curve in &self.curves {
            let value = self.series.iter().map(|_| curve.value.clone());
            for point in &curve.points {
                let deviation = point.deviation.map(|value| format!("{value:?}"));
                let cells = [
                    format!("{:?}", point.x),
                    point.runs.to_string(),
                    format!("{:?}", point.mean),
                    deviation.unwrap_or_default(),
                ];
                text.push_str(&csv_line(value.clone().chain(cells)));
            }
        }
        text
    }
}

/// The keys along x and of the curves: what the study names, else the first with several values that are no seeds.
fn places(study: &Study, keys: &[&str], outcomes: &[&Outcome]) -> Option<(usize, Option<usize>)> {
    let place = |name: &Option<String>| {
        let name = name.as_ref()?;
        keys.iter().position(|key| key == name)
    };
    let count = |key: usize| distinct(outcomes, key).len();
    let is_number =
        |key: usize| (outcomes.iter()).all(|outcome| number(&outcome.values[key]).is_some());
    let series = place(&study.plot.series);
    let varied = |key: &usize| count(*key) > 1 && !keys[*key].ends_with("seed");
    let x = place(&study.plot.x).or_else(|| {
        (0..keys.len())
            .filter(varied)
            .find(|key| Some(*key) != series && is_number(*key))
    })?;
    let series = series.or_else(|| {
        (0..keys.len())
            .filter(varied)
            .find(|key| *key != x && count(*key) <= MOST_CURVES)
    });
    Some((x, series.filter(|key| *key != x)))
}

/// What the study names, else the first choice that the runs have; or that they do not have it.
fn quantity(study: &Study, outcomes: &[&Outcome]) -> Result<String, String> {
    let is_there = |name: &str| outcomes.iter().any(|it| it.quantity(name).is_some());
    let named = study.plot.y.as_deref();
    let chosen = match named {
        Some(name) => Some(name).filter(|name| is_there(name)),
        None => CHOSEN.into_iter().find(|name| is_there(name)),
    };
    chosen.map(str::to_owned).ok_or_else(|| {
        let others: Vec<String> = quantity_names().filter(|name| is_there(name)).collect();
        format!(
            "plot.y: no finished case has {}; they have {}",
            named.unwrap_or(&CHOSEN.join(" or ")),
            others.join(", ")
        )
    })
}

/// The distinct values of a key, numbers in their order.
fn distinct<'a>(outcomes: &[&'a Outcome], key: usize) -> Vec<&'a str> {
    let mut values: Vec<&str> = outcomes.iter().map(|it| it.values[key].as_str()).collect();
    values.sort_by(|a, b| {
        let [first, second] = [a, b].map(|text| number(text).unwrap_or(f64::INFINITY));
        first.total_cmp(&second).then_with(|| a.cmp(b))
    });
    values.dedup();
    values
}

fn number(cell: &str) -> Option<f64> {
    cell.parse().ok().filter(|number: &f64| number.is_finite())
}

/// The means of `[x, y]` over equal x.
fn averaged(mut points: Vec<[f64; 2]>) -> Vec<Mean> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let groups = points.chunk_by(|a, b| a[0] == b[0]);
    groups
        .map(|group| {
            let runs = group.len() as f64;
            let mean = group.iter().map(|[_, y]| y).sum::<f64>() / runs;
            let squares = group.iter().map(|[_, y]| (y - mean).powi(2));
            let deviation = || (squares.sum::<f64>() / (runs - 1.0)).sqrt();
            Mean {
                x: group[0][0],
                runs: group.len(),
                mean,
                deviation: (group.len() > 1).then(deviation),
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_and_deviations_are_those_of_each_place() {
        let means = averaged(vec![[2.0, 5.0], [1.0, 1.0], [1.0, 3.0], [1.0, 5.0]]);
        let found: Vec<_> = means
            .iter()
            .map(|it| (it.x, it.runs, it.mean, it.deviation))
            .collect();
        // The squares about 3 add up to 8, over two degrees of freedom.
        assert_eq!(found, [(1.0, 3, 3.0, Some(2.0)), (2.0, 1, 5.0, None)]);
    }
}
