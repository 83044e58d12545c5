//! GMRES for Newton's systems, which are the identity plus the smooth coupling of distant contacts:
//! about fifteen matrix products in place of an elimination. Saad & Schultz 1986.

use nalgebra::DVector;

/// Largest Krylov space; the systems here need far fewer directions.
const MOST: usize = 200;

/// Solves `apply(x) = right` to a residual of `tolerance` times that of zero; `None` if it fails.
pub(super) fn solve(
    apply: impl Fn(&DVector<f64>) -> DVector<f64>,
    right: &DVector<f64>,
    tolerance: f64,
) -> Option<DVector<f64>> {
    let norm = right.norm();
    if norm == 0.0 {
        return Some(DVector::zeros(right.len()));
    }
    let mut directions = vec![right / norm];
    // Columns of the triangular matrix that rotations make of the Hessenberg matrix.
    let mut columns: Vec<Vec<f64>> = Vec::new();
    let mut rotations: Vec<(f64, f64)> = Vec::new();
    let mut target = vec![norm];
    for step in 0..MOST.min(right.len()) {
        let mut next = apply(&directions[step]);
        let mut column: Vec<f64> = Vec::with_capacity(step + 2);
        for direction in &directions {
            let share = next.dot(direction);
            next.axpy(-share, direction, 1.0);
            column.push(share);
        }
        let length = next.norm();
        for (i, (c, s)) in rotations.iter().enumerate() {
            let (upper, lower) = (column[i], column[i + 1]);
            column[i] = c * upper + s * lower;
            column[i + 1] = c * lower - s * upper;
        }
        let hypotenuse = column[step].hypot(length);
        if !hypotenuse.is_finite() || hypotenuse == 0.0 {
            return None;
        }
        let (c, s) = (column[step] / hypotenuse, length / hypotenuse);
        column[step] = hypotenuse;
        rotations.push((c, s));
        columns.push(column);
        target.push(-s * target[step]);
        target[step] *= c;
        let last = step + 1 == right.len();
        if target[step + 1].abs() <= tolerance * norm || length == 0.0 || last {
            let mut shares = vec![0.0; step + 1];
            for i in (0..=step).rev() {
                let known: f64 = (i + 1..=step).map(|j| columns[j][i] * shares[j]).sum();
                shares[i] = (target[i] - known) / columns[i][i];
            }
            let mut solution = DVector::zeros(right.len());
            for (share, direction) in shares.iter().zip(&directions) {
                solution.axpy(*share, direction, 1.0);
            }
            return Some(solution);
        }
        directions.push(next / length);
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DMatrix;

    #[test]
    fn gmres_agrees_with_elimination() {
        for size in [1, 2, 40] {
            let matrix = DMatrix::from_fn(size, size, |i, j| {
                f64::from(i == j) + 1.0 / (1.0 + i.abs_diff(2 * j) as f64)
            });
            let known = DVector::from_fn(size, |i, _| (i as f64 + 1.0).sin());
            let right = &matrix * &known;
            let found = solve(|x| &matrix * x, &right, 1e-13).expect("a solution");
            assert!((found - known).amax() < 1e-9, "{size}");
        }
        let nothing = solve(|x| x * f64::NAN, &DVector::from_element(2, 1.0), 1e-6);
        assert!(nothing.is_none());
    }
}
