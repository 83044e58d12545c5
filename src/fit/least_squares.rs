//! Nonlinear least squares by the method of Levenberg 1944 and Marquardt 1963, for a few variables.

use nalgebra::{DMatrix, DVector};

const MOST_ROUNDS: usize = 120;
/// Relative change of the sum of squares that ends the search.
const LEAST_GAIN: f64 = 1e-7;
const FIRST_DAMPING: f64 = 1e-3;
const MOST_DAMPING: f64 = 1e12;
/// Step of the derivatives; the variables are of the order of 1.
const DIFFERENCE: f64 = 1e-5;

/// A sum of squares of residuals that depend on variables and on discrete choices.
///
/// The choices (the branch of each point) are updated at each step and fixed during
/// differentiation.
pub(super) trait Problem {
    /// The discrete choices.
    type Choice;

    /// The best choices for the variables, and the residuals with them; `None` if there are none.
    fn choose(&self, variables: &DVector<f64>) -> Option<(Self::Choice, DVector<f64>)>;

    /// The residuals with given choices.
    fn residuals(&self, variables: &DVector<f64>, choice: &Self::Choice) -> Option<DVector<f64>>;
}

/// Result of a search.
#[derive(Clone, Debug)]
pub(super) struct Minimum {
    pub variables: DVector<f64>,
    pub residuals: DVector<f64>,
    /// Jacobian: one row a residual, one column a variable.
    pub jacobian: DMatrix<f64>,
    /// Whether the search converged.
    pub converged: bool,
}

impl Minimum {
    pub fn sum(&self) -> f64 {
        self.residuals.norm_squared()
    }
}

/// The local minimum reached from `start`.
pub(super) fn minimise<P: Problem>(problem: &P, start: DVector<f64>) -> Option<Minimum> {
    let count = start.len();
    let mut variables = start;
    let (mut choice, mut residuals) = problem.choose(&variables)?;
    let mut damping = FIRST_DAMPING;
    let mut jacobian = derivatives(problem, &variables, &choice, residuals.len())?;
    for _ in 0..MOST_ROUNDS {
        let normal = jacobian.tr_mul(&jacobian);
        let gradient = jacobian.tr_mul(&residuals);
        let scale = normal.diagonal().max().max(f64::MIN_POSITIVE);
        let mut next = None;
        while damping < MOST_DAMPING {
            let mut damped = normal.clone();
            for i in 0..count {
                // A variable without effect must not make the matrix singular.
                damped[(i, i)] += damping * normal[(i, i)].max(1e-12 * scale);
            }
            let step = damped.cholesky().map(|factors| factors.solve(&-&gradient));
            // Limit a step to a factor of three.
            let step = step.map(|step| {
                let longest = step.amax();
                if longest > 1.1 {
                    step * (1.1 / longest)
                } else {
                    step
                }
            });
            let tried = step.and_then(|step| {
                let variables = &variables + step;
                let (choice, residuals) = problem.choose(&variables)?;
                Some((variables, choice, residuals))
            });
            if let Some(tried) = tried
                && tried.2.norm_squared() < residuals.norm_squared()
            {
                next = Some(tried);
                break;
            }
            damping *= 4.0;
        }
        let Some((new, new_choice, new_residuals)) = next else {
            return Some(Minimum {
                variables,
                residuals,
                jacobian,
                converged: true,
            });
        };
        let gain = 1.0 - new_residuals.norm_squared() / residuals.norm_squared();
        damping = (damping / 8.0).max(1e-12);
        (variables, choice, residuals) = (new, new_choice, new_residuals);
        jacobian = derivatives(problem, &variables, &choice, residuals.len())?;
        if gain < LEAST_GAIN && damping < 1.0 {
            return Some(Minimum {
                variables,
                residuals,
                jacobian,
                converged: true,
            });
        }
    }
    Some(Minimum {
        variables,
        residuals,
        jacobian,
        converged: false,
    })
}

fn derivatives<P: Problem>(
    problem: &P,
    variables: &DVector<f64>,
    choice: &P::Choice,
    rows: usize,
) -> Option<DMatrix<f64>> {
    let mut jacobian = DMatrix::zeros(rows, variables.len());
    for column in 0..variables.len() {
        let beside = |step: f64| {
            let mut moved = variables.clone();
            moved[column] += step;
            problem.residuals(&moved, choice)
        };
        let slope = (beside(DIFFERENCE)? - beside(-DIFFERENCE)?) / (2.0 * DIFFERENCE);
        jacobian.set_column(column, &slope);
    }
    Some(jacobian)
}

/// Covariance of the variables at a `variance` of the residuals; NaN in the rows and columns of
/// variables without effect.
pub(super) fn covariance(jacobian: &DMatrix<f64>, variance: f64) -> DMatrix<f64> {
    let count = jacobian.ncols();
    let norms: Vec<f64> = jacobian.column_iter().map(|column| column.norm()).collect();
    let largest = norms.iter().fold(0.0_f64, |most, norm| most.max(*norm));
    let felt: Vec<usize> = (0..count).filter(|i| norms[*i] > 1e-9 * largest).collect();
    let mut result = DMatrix::from_element(count, count, f64::NAN);
    let normal = DMatrix::from_fn(felt.len(), felt.len(), |i, j| {
        jacobian.column(felt[i]).dot(&jacobian.column(felt[j])) / (norms[felt[i]] * norms[felt[j]])
    });
    if let Some(inverse) = normal.try_inverse() {
        for (i, row) in felt.iter().enumerate() {
            for (j, column) in felt.iter().enumerate() {
                result[(*row, *column)] =
                    variance * inverse[(i, j)] / (norms[*row] * norms[*column]);
            }
        }
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `a exp(b x)` through points generated from it.
    struct Growth(Vec<(f64, f64)>);

    impl Problem for Growth {
        type Choice = ();

        fn choose(&self, v: &DVector<f64>) -> Option<((), DVector<f64>)> {
            Some(((), self.residuals(v, &())?))
        }

        fn residuals(&self, v: &DVector<f64>, (): &()) -> Option<DVector<f64>> {
            let rest = |(x, y): &(f64, f64)| v[0] * (v[1] * x).exp() - y;
            Some(DVector::from_iterator(
                self.0.len(),
                self.0.iter().map(rest),
            ))
        }
    }

    #[test]
    fn known_numbers_come_back() {
        let points = (0..20).map(|i| f64::from(i) / 10.0);
        let points: Vec<_> = points.map(|x| (x, 0.7 * (1.3_f64 * x).exp())).collect();
        let found = minimise(&Growth(points), DVector::from_vec(vec![2.0, 0.1])).unwrap();
        assert!(found.converged);
        assert!((found.variables[0] - 0.7).abs() < 1e-7 && (found.variables[1] - 1.3).abs() < 1e-7);
    }

    #[test]
    fn covariance_of_a_straight_line() {
        // Intercept and slope over x = -1, 0, 1: variances 1/3 and 1/2; the third variable has no
        // effect.
        let jacobian =
            DMatrix::from_row_slice(3, 3, &[1.0, -1.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0]);
        let covariance = covariance(&jacobian, 2.0);
        assert!((covariance[(0, 0)] - 2.0 / 3.0).abs() < 1e-12);
        assert!((covariance[(1, 1)] - 1.0).abs() < 1e-12);
        assert!(covariance[(0, 1)].abs() < 1e-12 && covariance[(2, 2)].is_nan());
    }
}
