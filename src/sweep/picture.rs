//! `sweep.png`: a quantity of the runs over one key, a curve for each value of another, with mean and spread over
//! all others.

use serde_json::Value;

use super::outcome::Outcome;
use super::study::Study;
use crate::output::plot::{Axis, Figure, LARGE, Panel, PlotPoint, Series};

/// Most curves; more cannot be told apart.
const MOST_CURVES: usize = 10;
/// Quantities that are drawn if the study names none, the first that the runs have.
const DRAWN: [&str; 2] = ["pull_off_force", "largest_contact_area_fraction"];
/// Ratio of the ends of an axis from which it is logarithmic.
const DECADES: f64 = 30.0;

/// What is drawn over what.
struct Drawn<'a> {
    x: usize,
    y: &'a str,
    series: Option<usize>,
}

/// The picture of the finished cases; `None` where there is nothing to draw.
pub(super) fn picture(study: &Study, outcomes: &[&Outcome]) -> Option<Figure> {
    let keys: Vec<&str> = study.keys().collect();
    let drawn = choose(study, &keys, outcomes)?;
    let values = match drawn.series {
        Some(series) => distinct(outcomes.iter().map(|outcome| &outcome.values[series])),
        None => vec![&Value::Null],
    };
    let mut all: Vec<(f64, f64)> = Vec::new();
    let mut series = Vec::new();
    for (name, value) in values.iter().enumerate() {
        let own = outcomes.iter().filter(|outcome| {
            drawn
                .series
                .is_none_or(|key| outcome.values[key] == **value)
        });
        let mut points: Vec<(f64, f64)> = own
            .filter_map(|outcome| {
                Some((
                    outcome.values[drawn.x].as_f64()?,
                    outcome.quantity(drawn.y)?,
                ))
            })
            .collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let groups = points.chunk_by(|a, b| a.0 == b.0);
        let mut means = Vec::new();
        for group in groups {
            let (mean, spread) = mean_and_spread(group);
            means.push(PlotPoint::new(group[0].0, mean));
            if spread > 0.0 {
                let ends = [mean - spread, mean + spread];
                series.push(Series::line(
                    name,
                    ends.map(|y| PlotPoint::new(group[0].0, y)).into(),
                ));
            }
        }
        all.extend(means.iter().map(|point| (point.x, point.y)));
        series.push(Series::marked_line(name, means));
    }
    if all.is_empty() {
        return None;
    }
    let names = match drawn.series {
        None => vec![String::new()],
        Some(key) => values
            .iter()
            .map(|value| format!("{} = {}", short(keys[key]), in_words(value)))
            .collect(),
    };
    let runs = outcomes.len();
    Some(Figure {
        title: study.title(),
        note: format!("{runs} runs; mean, and bars of one standard deviation over all other keys"),
        names,
        panels: vec![Panel {
            title: drawn.y.replace('_', " "),
            x: axis(keys[drawn.x], all.iter().map(|(x, _)| *x)),
            y: axis(drawn.y, all.iter().map(|(_, y)| *y)),
            series,
        }],
        columns: 1,
        style: LARGE,
        ..Figure::default()
    })
}

/// What the study names, or the first keys with several numbers that are no seeds.
fn choose<'a>(study: &'a Study, keys: &[&str], outcomes: &[&Outcome]) -> Option<Drawn<'a>> {
    let place = |name: &Option<String>| {
        let name = name.as_ref()?;
        keys.iter().position(|key| key == name)
    };
    let varies = |key: &usize| {
        let key = *key;
        distinct(outcomes.iter().map(|outcome| &outcome.values[key])).len() > 1
    };
    let is_number = |key: usize| {
        let numbers = outcomes.iter().map(|outcome| &outcome.values[key]);
        numbers.clone().any(Value::is_number)
    };
    let series = place(&study.plot.series);
    let is_seed = |key: usize| keys[key].ends_with("seed");
    let candidates: Vec<usize> = (0..keys.len())
        .filter(varies)
        .filter(|key| !is_seed(*key))
        .collect();
    let x = place(&study.plot.x).or_else(|| {
        let mut free = candidates
            .iter()
            .copied()
            .filter(|key| Some(*key) != series);
        free.find(|key| is_number(*key))
    })?;
    let series = series.or_else(|| {
        let few = |key: &usize| {
            distinct(outcomes.iter().map(|outcome| &outcome.values[*key])).len() <= MOST_CURVES
        };
        candidates.iter().copied().filter(few).find(|key| *key != x)
    });
    let has = |name: &str| {
        outcomes
            .iter()
            .any(|outcome| outcome.quantity(name).is_some())
    };
    let y = match &study.plot.y {
        Some(name) => name.as_str(),
        None => DRAWN.into_iter().find(|name| has(name))?,
    };
    Some(Drawn { x, y, series })
}

/// The distinct values, numbers in their order.
fn distinct<'a>(values: impl Iterator<Item = &'a Value>) -> Vec<&'a Value> {
    let mut found: Vec<&Value> = Vec::new();
    for value in values {
        if !found.contains(&value) {
            found.push(value);
        }
    }
    let number = |value: &Value| value.as_f64().unwrap_or(f64::INFINITY);
    found.sort_by(|a, b| number(a).total_cmp(&number(b)));
    found
}

/// Mean of a group, and its standard deviation.
fn mean_and_spread(group: &[(f64, f64)]) -> (f64, f64) {
    let count = group.len() as f64;
    let mean = group.iter().map(|(_, y)| y).sum::<f64>() / count;
    if group.len() < 2 {
        return (mean, 0.0);
    }
    let square = group.iter().map(|(_, y)| (y - mean).powi(2)).sum::<f64>();
    (mean, (square / (count - 1.0)).sqrt())
}

/// A logarithmic axis where values span decades.
fn axis(name: &str, values: impl Iterator<Item = f64>) -> Axis {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    let words = short(name).replace('_', " ");
    if low > 0.0 && high > DECADES * low {
        Axis::logarithmic(&words, "SI")
    } else {
        Axis::linear(&words, "SI")
    }
}

/// The last name of a key.
fn short(key: &str) -> &str {
    key.rsplit('.').next().unwrap_or(key)
}

fn in_words(value: &Value) -> String {
    match value {
        Value::Number(number) => number
            .as_f64()
            .map_or_else(String::new, |number| format!("{number:.4}"))
            .trim_end_matches('0')
            .trim_end_matches('.')
            .to_owned(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}
