//! Linear systems of a few hundred unknowns by blocks, so that the work is matrix products.

use nalgebra::DMatrix;

const BLOCK: usize = 48;

/// Solves `matrix * x = sides`; `None` if a block on the diagonal is singular.
///
/// Pivots only within a block. That suffices for matrices near the identity, and for systems whose
/// solution is checked by its residual; it is several times faster than elimination column by
/// column.
pub(crate) fn solve(mut matrix: DMatrix<f64>, mut sides: DMatrix<f64>) -> Option<DMatrix<f64>> {
    let (size, columns) = (matrix.nrows(), sides.ncols());
    let mut from = 0;
    while from < size {
        let block = BLOCK.min(size - from);
        let to = from + block;
        let rest = size - to;
        let pivot = matrix.view((from, from), (block, block)).into_owned().lu();
        let row = pivot.solve(&matrix.view((from, to), (block, rest)))?;
        let side = pivot.solve(&sides.view((from, 0), (block, columns)))?;
        let below = matrix.view((to, from), (rest, block)).into_owned();
        matrix
            .view_mut((to, to), (rest, rest))
            .gemm(-1.0, &below, &row, 1.0);
        sides
            .view_mut((to, 0), (rest, columns))
            .gemm(-1.0, &below, &side, 1.0);
        matrix.view_mut((from, to), (block, rest)).copy_from(&row);
        sides.view_mut((from, 0), (block, columns)).copy_from(&side);
        from = to;
    }
    // The diagonal is now the identity: back substitution through the rows of blocks.
    let mut to = size;
    while to > 0 {
        let from = (to - 1) / BLOCK * BLOCK;
        let known = sides.view((to, 0), (size - to, columns)).into_owned();
        let row = matrix.view((from, to), (to - from, size - to));
        sides
            .view_mut((from, 0), (to - from, columns))
            .gemm(-1.0, &row, &known, 1.0);
        to = from;
    }
    Some(sides)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn block_solve_reproduces_a_known_solution() {
        for size in [1, 48, 50, 131] {
            let matrix = DMatrix::from_fn(size, size, |i, j| {
                f64::from(i == j) + 0.3 / (1.0 + i.abs_diff(j) as f64)
            });
            let known = DMatrix::from_fn(size, 2, |i, j| (i as f64 + 1.0).sin() + j as f64);
            let solved = solve(matrix.clone(), &matrix * &known).expect("a solution");
            assert!((solved - known).amax() < 1e-12, "{size}");
        }
        assert!(solve(DMatrix::zeros(3, 3), DMatrix::zeros(3, 1)).is_none());
    }
}
