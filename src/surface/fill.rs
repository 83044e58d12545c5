//! Interpolates missing pixels from their neighbours.

/// Iteration limit of the membrane solve; a hole a few thousand pixels wide needs as many.
const MOST_ITERATIONS: usize = 20_000;

/// Residual, relative to that of a start from the mean, at which the solve ends.
const TOLERANCE: f64 = 1e-10;

/// Replaces non-finite heights by a membrane stretched over the finite ones; returns the number
/// replaced.
///
/// Shape `[rows, columns]`, row-major. Each replaced pixel is the mean of its neighbours (up to 4;
/// always 4 on a periodic map, across the edges). This is the discrete Laplace equation with pixels
/// taken as square, solved by conjugate gradients; the number of iterations grows with the diameter
/// of the largest hole. Without any finite pixel nothing is replaced.
pub(super) fn interpolate(
    values: &mut [f64],
    rows: usize,
    columns: usize,
    periodic: bool,
) -> usize {
    let missing: Vec<usize> = (0..values.len())
        .filter(|index| !values[*index].is_finite())
        .collect();
    if missing.is_empty() || missing.len() == values.len() {
        return 0;
    }
    let known = (values.len() - missing.len()) as f64;
    let finite = values.iter().filter(|value| value.is_finite());
    let mean = finite.map(|value| value / known).sum::<f64>();

    // Index of a missing pixel in the list of unknowns; `missing.len()` for a known pixel.
    let none = missing.len();
    let mut slot = vec![none; values.len()];
    for (index, pixel) in missing.iter().enumerate() {
        slot[*pixel] = index;
    }
    // The equations: degree * unknown - sum of unknown neighbours = sum of known neighbours.
    let mut neighbours = Vec::with_capacity(none);
    let mut degrees = Vec::with_capacity(none);
    let mut residual = Vec::with_capacity(none);
    for pixel in &missing {
        let mut slots = [none; 4];
        let (mut degree, mut load) = (0.0, 0.0);
        let around = neighbours_of(*pixel, rows, columns, periodic);
        for (place, neighbour) in slots.iter_mut().zip(around.into_iter().flatten()) {
            *place = slot[neighbour];
            degree += 1.0;
            if slot[neighbour] == none {
                load += values[neighbour] - mean;
            }
        }
        neighbours.push(slots);
        degrees.push(degree);
        residual.push(load);
    }
    drop(slot);
    let unknown = solve_membrane(&neighbours, &degrees, residual);
    for (pixel, height) in missing.iter().zip(&unknown) {
        values[*pixel] = mean + height;
    }
    none
}

/// Conjugate gradients for the membrane from a start of 0; `residual` is the right-hand side.
fn solve_membrane(neighbours: &[[usize; 4]], degrees: &[f64], mut residual: Vec<f64>) -> Vec<f64> {
    let count = degrees.len();
    let mut unknown = vec![0.0; count];
    let mut direction = residual.clone();
    let mut image = vec![0.0; count];
    let mut square = dot(&residual, &residual);
    let target = square * TOLERANCE * TOLERANCE;
    for _ in 0..MOST_ITERATIONS {
        if square <= target || !square.is_finite() {
            break;
        }
        for (index, slots) in neighbours.iter().enumerate() {
            let around: f64 = slots.iter().filter_map(|slot| direction.get(*slot)).sum();
            image[index] = degrees[index] * direction[index] - around;
        }
        let step = square / dot(&direction, &image);
        for index in 0..count {
            unknown[index] += step * direction[index];
            residual[index] -= step * image[index];
        }
        let next = dot(&residual, &residual);
        let turn = next / square;
        for (direction, residual) in direction.iter_mut().zip(&residual) {
            *direction = residual + turn * *direction;
        }
        square = next;
    }
    unknown
}

/// Scalar product.
fn dot(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(a, b)| a * b).sum()
}

/// The neighbours of a pixel; `None` beyond a free edge.
fn neighbours_of(pixel: usize, rows: usize, columns: usize, periodic: bool) -> [Option<usize>; 4] {
    let (row, column) = (pixel / columns, pixel % columns);
    let step = |at: usize, count: usize, forward: bool| -> Option<usize> {
        let next = if forward { at + 1 } else { at + count - 1 };
        let inside = if forward { next < count } else { at > 0 };
        // On an axis of one point a pixel is not its own neighbour.
        (count > 1 && (inside || periodic)).then_some(next % count)
    };
    [
        step(column, columns, false).map(|column| row * columns + column),
        step(column, columns, true).map(|column| row * columns + column),
        step(row, rows, false).map(|row| row * columns + column),
        step(row, rows, true).map(|row| row * columns + column),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn a_plane_is_filled_exactly() {
        // A plane solves the Laplace equation; the hole does not touch the edges.
        let plane = |i: usize| 3.0 + 0.5 * (i % 12) as f64 - 2.0 * (i / 12) as f64;
        let mut values: Vec<f64> = (0..120).map(plane).collect();
        for row in 2..7 {
            for column in 3..9 {
                values[row * 12 + column] = f64::NAN;
            }
        }
        values[8 * 12 + 1] = f64::INFINITY;
        assert_eq!(interpolate(&mut values, 10, 12, false), 31);
        for (index, value) in values.iter().enumerate() {
            assert_relative_eq!(*value, plane(index), max_relative = 1e-8, epsilon = 1e-8);
        }
    }

    #[test]
    fn a_hole_at_a_periodic_edge_has_neighbours_opposite() {
        let row = [f64::NAN, 1.0, 2.0, 7.0];
        let mut free = row;
        interpolate(&mut free, 1, 4, false);
        assert_relative_eq!(free[0], 1.0, max_relative = 1e-12);
        let mut periodic = row;
        interpolate(&mut periodic, 1, 4, true);
        assert_relative_eq!(periodic[0], 4.0, max_relative = 1e-12);
    }

    #[test]
    fn a_map_without_finite_pixels_is_unchanged() {
        let mut values = [f64::NAN; 4];
        assert_eq!(interpolate(&mut values, 2, 2, true), 0);
        assert_eq!(interpolate(&mut [1.0; 4], 2, 2, true), 0);
    }
}
