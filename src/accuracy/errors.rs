//! Errors of a run relative to the reference.

use super::measure::{Measured, Point};
use super::reference::Reference;

/// Relative errors; `None` if there is nothing to compare.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Errors {
    /// Contact area: the area between the two curves over the steps, divided by the area below the
    /// reference.
    pub area: Option<f64>,
    /// The same for the response to the path: force, mean gap or approach.
    pub force: Option<f64>,
    /// Root mean square error of the pressure over the cells, divided by that of the reference.
    pub pressure: Option<f64>,
    /// Greatest tension.
    pub pull_off: Option<f64>,
}

impl Errors {
    /// All four.
    pub fn all(&self) -> [Option<f64>; 4] {
        [self.area, self.force, self.pressure, self.pull_off]
    }

    /// The errors that `of` makes of each of two.
    pub(super) fn both(
        self,
        other: Errors,
        of: impl Fn(Option<f64>, Option<f64>) -> Option<f64>,
    ) -> Errors {
        Errors {
            area: of(self.area, other.area),
            force: of(self.force, other.force),
            pressure: of(self.pressure, other.pressure),
            pull_off: of(self.pull_off, other.pull_off),
        }
    }

    /// The largest of those that are known.
    pub fn largest(&self) -> Option<f64> {
        self.all().into_iter().flatten().reduce(f64::max)
    }
}

/// Errors of a run; `None` if a step did not converge.
pub fn relative_errors(found: &Measured, reference: &Reference) -> Errors {
    if !found.converged {
        return Errors::default();
    }
    let difference = distance(
        [&found.steps, &reference.steps],
        [found.pull_off, reference.pull_off],
        [found.profile.as_deref(), reference.profile.as_deref()],
    );
    Errors {
        // Quantities that the reference lacks are not compared.
        pull_off: reference.pull_off.and(difference.pull_off),
        ..difference
    }
}

/// Difference of a run from another run of the same steps.
pub fn change(found: &Measured, base: &Measured) -> Errors {
    distance(
        [&found.steps, &base.steps],
        [found.pull_off, base.pull_off],
        [found.profile.as_deref(), base.profile.as_deref()],
    )
}

fn distance(
    steps: [&[Option<Point>]; 2],
    pull_off: [Option<f64>; 2],
    profile: [Option<&[f64]>; 2],
) -> Errors {
    let both = || {
        let pairs = steps[0].iter().zip(steps[1]);
        pairs.filter_map(|(found, there)| Some(((*found)?, (*there)?)))
    };
    let area = between(both().map(|(found, there)| (Some(found.area), Some(there.area))));
    let force = between(both().map(|(found, there)| (found.answer, there.answer)));
    let pull_off = match pull_off {
        [found, Some(there)] => Some((found.unwrap_or(0.0) - there).abs() / there),
        [_, None] => None,
    };
    let pressure = match profile {
        [Some(found), Some(there)] => {
            let square = |values: &mut dyn Iterator<Item = f64>| values.map(|v| v * v).sum::<f64>();
            let whole = square(&mut there.iter().copied());
            let off = square(&mut found.iter().zip(there).map(|(a, b)| a - b));
            (whole > 0.0).then(|| (off / whole).sqrt())
        }
        _ => None,
    };
    Errors {
        area,
        force,
        pressure,
        pull_off,
    }
}

/// The area between two curves over steps, divided by the area below the second. A step at which
/// only one of them has a value counts as completely wrong.
fn between(pairs: impl Iterator<Item = (Option<f64>, Option<f64>)>) -> Option<f64> {
    let (mut off, mut whole) = (0.0, 0.0);
    for (found, there) in pairs {
        off += match (found, there) {
            (Some(found), Some(there)) => (found - there).abs(),
            (found, there) => found.or(there).unwrap_or(0.0).abs(),
        };
        whole += there.unwrap_or(0.0).abs();
    }
    (whole > 0.0).then(|| off / whole)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measured(values: &[(f64, Option<f64>)], profile: &[f64]) -> Measured {
        Measured {
            steps: values
                .iter()
                .map(|(area, answer)| {
                    Some(Point {
                        area: *area,
                        answer: *answer,
                    })
                })
                .collect(),
            pull_off: None,
            pull_off_step: 0.0,
            profile: Some(profile.to_vec()),
            seconds: 1.0,
            iterations: 1,
            transforms: 1.0,
            steps_solved: values.len(),
            converged: true,
        }
    }

    #[test]
    fn errors_are_the_areas_between_curves() {
        let base = measured(
            &[(0.1, Some(1.0)), (0.4, Some(-4.0)), (0.0, None)],
            &[3.0, 4.0],
        );
        let mut found = measured(
            &[(0.12, Some(1.5)), (0.4, Some(-4.0)), (0.0, None)],
            &[3.0, 4.5],
        );
        let errors = change(&found, &base);
        assert!((errors.area.expect("areas") - 0.04).abs() < 1e-12);
        assert!((errors.force.expect("answers") - 0.1).abs() < 1e-12);
        assert!((errors.pressure.expect("a profile") - 0.1).abs() < 1e-12);
        assert_eq!(errors.pull_off, None);
        assert!(errors.largest() >= errors.force);
        // A skipped step is not compared; a step that separated is completely wrong.
        found.steps[0] = None;
        found.steps[1] = Some(Point {
            area: 0.0,
            answer: None,
        });
        let errors = change(&found, &base);
        assert_eq!((errors.area, errors.force), (Some(1.0), Some(1.0)));
    }

    #[test]
    fn missing_pull_off_is_an_error_of_100_percent() {
        let mut base = measured(&[(0.1, Some(1.0))], &[1.0]);
        base.pull_off = Some(2.0);
        let mut found = base.clone();
        found.pull_off = Some(2.5);
        assert_eq!(change(&found, &base).pull_off, Some(0.25));
        found.pull_off = None;
        assert_eq!(change(&found, &base).pull_off, Some(1.0));
    }
}
