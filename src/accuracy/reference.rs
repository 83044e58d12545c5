//! References: a closed form, or the same scene in double precision on finer grids.

use super::errors::{Errors, change};
use super::measure::{Measured, Point};
use super::richardson::{Extrapolated, extrapolate};

/// Ratio of points a side between successive grids.
const RATIO: f64 = 2.0;

/// The reference solution.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// At each step of the scene; `None` where the reference has no value.
    pub steps: Vec<Option<Point>>,
    /// Greatest tension, N, positive.
    pub pull_off: Option<f64>,
    /// Mean pressure over the cells of the coarsest grid, Pa.
    pub profile: Option<Vec<f64>>,
    /// Relative uncertainty, of each quantity.
    pub uncertainty: Errors,
    /// Observed orders of convergence, as in [`Errors::all`].
    pub orders: [Option<f64>; 4],
    /// Description.
    pub words: String,
    /// Its finest grid; `None` for a closed form.
    pub points: Option<[usize; 2]>,
}

impl Reference {
    /// Extrapolates from runs of the same path on successively doubled grids, the coarsest first.
    /// Needs at least one run; with one the uncertainty is infinite. `path_steps` describes the number
    /// of steps.
    pub fn numeric(levels: &[Measured], points: [usize; 2], path_steps: &str) -> Option<Reference> {
        let fine = levels.last()?;
        let areas = Curve::extrapolate(levels, |point| Some(point.area));
        let answers = Curve::extrapolate(levels, |point| point.answer);
        let steps = fine.steps.iter().enumerate().map(|(step, own)| {
            (*own).map(|own| Point {
                area: areas.values[step].unwrap_or(own.area),
                answer: answers.values[step],
            })
        });
        let profiles: Option<Vec<Vec<f64>>> =
            levels.iter().map(|level| level.profile.clone()).collect();
        let profile = profiles.map(|profiles| extrapolate(&profiles, RATIO));
        let tensions: Option<Vec<Vec<f64>>> = levels
            .iter()
            .map(|level| level.pull_off.map(|force| vec![force]))
            .collect();
        let tension = tensions.map(|tensions| extrapolate(&tensions, RATIO));
        let relative = |found: &Extrapolated, more: f64| {
            let size =
                |values: &[f64]| values.iter().map(|value| value * value).sum::<f64>().sqrt();
            let scale = size(&found.values);
            (scale > 0.0).then(|| (size(&found.uncertainty) + more) / scale)
        };
        let pull_off = tension.as_ref().map(|found| found.values[0]);
        Some(Reference {
            steps: steps.collect(),
            pull_off: pull_off.or(fine.pull_off),
            profile: profile.as_ref().map(|found| found.values.clone()),
            uncertainty: Errors {
                area: areas.uncertainty(),
                force: answers.uncertainty(),
                pressure: profile.as_ref().and_then(|found| relative(found, 0.0)),
                pull_off: match &tension {
                    Some(found) => relative(found, fine.pull_off_step),
                    // On some grid the contact did not separate.
                    None => fine.pull_off.map(|_| f64::INFINITY),
                },
            },
            orders: [
                areas.order,
                answers.order,
                profile.and_then(|found| found.order),
                tension.and_then(|found| found.order),
            ],
            words: format!(
                "double precision on {} x {} points with {path_steps}, extrapolated from {} grids",
                points[0],
                points[1],
                levels.len().min(3)
            ),
            points: Some(points),
        })
    }

    /// Adds the uncertainty in time: the difference that halving the reference's steps makes on one
    /// grid. Still finer steps would change no more than that.
    pub fn add_steps(&mut self, coarser: &Measured, finer: &Measured) {
        let change = change(coarser, finer);
        self.uncertainty = self.uncertainty.both(change, |known, more| {
            known.map(|known| known + more.unwrap_or(0.0))
        });
    }
}

/// One quantity at each step of the scene, extrapolated over grids.
struct Curve {
    values: Vec<Option<f64>>,
    /// Uncertainty of each value.
    off: Vec<f64>,
    order: Option<f64>,
}

impl Curve {
    fn extrapolate(levels: &[Measured], of: impl Fn(&Point) -> Option<f64>) -> Curve {
        let value = |level: &Measured, step: usize| level.steps[step].as_ref().and_then(&of);
        let count = levels.last().map_or(0, |fine| fine.steps.len());
        // The last three grids decide; a grid on which the contact separated has no value to
        // extrapolate.
        let last = &levels[levels.len().saturating_sub(3)..];
        let common: Vec<usize> = (0..count)
            .filter(|step| last.iter().all(|level| value(level, *step).is_some()))
            .collect();
        let grids: Vec<Vec<f64>> = last
            .iter()
            .map(|level| {
                common
                    .iter()
                    .filter_map(|step| value(level, *step))
                    .collect()
            })
            .collect();
        let found = extrapolate(&grids, RATIO);
        let mut values: Vec<Option<f64>> = (0..count)
            .map(|step| last.last().and_then(|fine| value(fine, step)))
            .collect();
        // If grids disagree on whether there is a value, the whole value is uncertain.
        let mut off: Vec<f64> = (0..count)
            .map(|step| {
                let known = last.iter().filter_map(|level| value(level, step));
                known.map(f64::abs).fold(0.0, f64::max)
            })
            .collect();
        for (index, step) in common.into_iter().enumerate() {
            values[step] = Some(found.values[index]);
            off[step] = found.uncertainty[index];
        }
        Curve {
            values,
            off,
            order: found.order,
        }
    }

    /// Defined like errors: the area between over the area below.
    fn uncertainty(&self) -> Option<f64> {
        let below: f64 = self.values.iter().flatten().map(|value| value.abs()).sum();
        (below > 0.0).then(|| self.off.iter().sum::<f64>() / below)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Areas `0.2 + h`, gaps `1 - 2 h` of which one grid has none, and a pull-off of `3 + h`.
    fn level(h: f64, parted: bool) -> Measured {
        let point = |area: f64, answer: Option<f64>| Some(Point { area, answer });
        Measured {
            steps: vec![
                point(0.2 + h, Some(1.0 - 2.0 * h)),
                None,
                point(0.0, (!parted).then_some(4.0)),
            ],
            pull_off: Some(3.0 + h),
            pull_off_step: 0.0,
            profile: Some(vec![5.0 + h, 0.0]),
            seconds: 1.0,
            iterations: 1,
            transforms: 1.0,
            steps_solved: 3,
            converged: true,
        }
    }

    #[test]
    fn three_grids_of_first_order_give_the_limit() {
        let levels = [level(0.04, false), level(0.02, false), level(0.01, false)];
        let found = Reference::numeric(&levels, [64, 64], "twice the steps").expect("three grids");
        let first = found.steps[0].expect("compared");
        assert!((first.area - 0.2).abs() < 1e-12, "{}", first.area);
        assert!((first.answer.expect("held") - 1.0).abs() < 1e-12);
        assert_eq!(found.steps[1], None);
        assert!((found.pull_off.expect("a tension") - 3.0).abs() < 1e-12);
        assert!((found.profile.expect("a field")[0] - 5.0).abs() < 1e-12);
        // The remaining error of the finest grid: 0.01 of 0.2, 0.02 of 1 + 4, 0.01 of 5, 0.01 of 3.
        let expected = [0.05, 0.004, 0.002, 0.01 / 3.0];
        for (found, expected) in found.uncertainty.all().into_iter().zip(expected) {
            assert!((found.expect("known") - expected).abs() < 1e-9);
        }
        for order in found.orders {
            assert!((order.expect("an order") - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn disagreement_of_grids_increases_uncertainty() {
        let mut levels = [level(0.04, false), level(0.02, true), level(0.01, false)];
        levels[2].pull_off_step = 0.3;
        let found = Reference::numeric(&levels, [64, 64], "twice the steps").expect("three grids");
        let last = found.steps[2].expect("compared");
        assert_eq!(last.answer, Some(4.0));
        // All of the 4 of 5, and 0.02.
        assert!((found.uncertainty.force.expect("known") - 4.02 / 5.0).abs() < 1e-9);
        // The next load asked for is larger by 0.3 of 3.
        assert!((found.uncertainty.pull_off.expect("known") - 0.31 / 3.0).abs() < 1e-9);
    }
}
