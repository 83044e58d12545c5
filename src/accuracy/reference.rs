//! What settings are judged by: a closed form, or the same scene in double precision on finer grids.

use super::judge::{Errors, change};
use super::measure::{Measured, Point};
use super::richardson::{Extrapolated, extrapolate};

/// The answer that errors are taken from.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// At each step of the scene; `None` where it says nothing.
    pub steps: Vec<Option<Point>>,
    /// Greatest tension, N, positive.
    pub pull_off: Option<f64>,
    /// Mean pressure over the cells of the coarsest grid, Pa.
    pub profile: Option<Vec<f64>>,
    /// How far it may itself be off, relative, as errors are.
    pub uncertainty: Errors,
    /// The orders of convergence that its grids show, as in [`Errors::all`].
    pub orders: [Option<f64>; 4],
    /// What it is, in words.
    pub words: String,
    /// Its finest grid; `None` for a closed form.
    pub points: Option<[usize; 2]>,
}

impl Reference {
    /// Extrapolates from runs of the same path on grids each twice as fine as the one before, the
    /// coarsest first. Needs one; the uncertainty of one alone is infinite.
    pub fn numeric(levels: &[Measured], points: [usize; 2]) -> Option<Reference> {
        let fine = levels.last()?;
        let ratio = 2.0;
        let series = |of: &dyn Fn(&Measured) -> Vec<f64>| -> Extrapolated {
            extrapolate(&levels.iter().map(of).collect::<Vec<_>>(), ratio)
        };
        let areas = series(&|level| each(level, |point| Some(point.area)));
        // Where one of the grids has let go there is no line to follow: the finest one stands, and
        // is as far off as the difference.
        let answers = series(&|level| each(level, |point| point.answer));
        let steps = fine.steps.iter().enumerate().map(|(step, own)| {
            let point = (*own)?;
            let answer = answers.values[step];
            Some(Point {
                area: areas.values[step],
                answer: point
                    .answer
                    .and(answer.is_finite().then_some(answer).or(point.answer)),
            })
        });
        let pull_off = series(&|level| vec![level.pull_off.unwrap_or(f64::NAN)]);
        let known = pull_off.values[0].is_finite().then_some(pull_off.values[0]);
        let empty = Vec::new();
        let profile = series(&|level| level.profile.as_ref().unwrap_or(&empty).clone());
        let relative = |uncertainty: &[f64], values: &[f64], norm: fn(&[f64]) -> f64| {
            let scale = norm(values);
            (scale > 0.0).then(|| norm(uncertainty) / scale)
        };
        let alone = levels.len() == 1;
        let beyond = |uncertainty: Option<f64>| match alone {
            true => uncertainty.map(|_| f64::INFINITY),
            false => uncertainty,
        };
        Some(Reference {
            steps: steps.collect(),
            pull_off: known.or(fine.pull_off),
            profile: fine.profile.as_ref().map(|_| profile.values.clone()),
            uncertainty: Errors {
                area: beyond(relative(&areas.uncertainty, &areas.values, largest)),
                force: beyond(relative(&answers.uncertainty, &answers.values, largest)),
                pressure: beyond(relative(
                    &profile.uncertainty,
                    &profile.values,
                    root_mean_square,
                )),
                pull_off: beyond(
                    fine.pull_off
                        .and_then(|_| relative(&pull_off.uncertainty, &pull_off.values, largest)),
                ),
            },
            orders: [&areas, &answers, &profile, &pull_off].map(|series| series.order),
            words: format!(
                "double precision on {} x {} points with twice the steps, extrapolated from {} grids",
                points[0],
                points[1],
                levels.len().min(3)
            ),
            points: Some(points),
        })
    }

    /// Adds what walking the path in twice the steps changed on one grid: what a still finer path
    /// would change is no more.
    pub fn add_steps(&mut self, own: &Measured, doubled: &Measured) {
        let change = change(own, doubled);
        let add =
            |known: Option<f64>, more: Option<f64>| known.map(|known| known + more.unwrap_or(0.0));
        self.uncertainty = Errors {
            area: add(self.uncertainty.area, change.area),
            force: add(self.uncertainty.force, change.force),
            pressure: add(self.uncertainty.pressure, change.pressure),
            pull_off: add(self.uncertainty.pull_off, change.pull_off),
        };
    }
}

/// A value at each step; NaN where there is none.
fn each(level: &Measured, of: fn(&Point) -> Option<f64>) -> Vec<f64> {
    let value = |point: &Option<Point>| point.as_ref().and_then(of).unwrap_or(f64::NAN);
    level.steps.iter().map(value).collect()
}

/// The largest magnitude; numbers that are none do not count.
fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| most.max(value.abs()))
}

fn root_mean_square(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>().sqrt()
}
