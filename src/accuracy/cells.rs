//! Means of a field over the cells of a coarser grid, so that fields on different grids can be
//! compared.
//!
//! A point represents the pixel around it. A cell takes its share of each pixel that it covers, for
//! any ratio of the two grids, so the mean over all cells of a periodic field equals the mean of
//! the field.

use crate::grid::Grid;
use crate::scene::Boundary;

/// Means of a field on `grid` over the cells of a grid of `cells` points, shape `[cells_y,
/// cells_x]`. Beyond the edge of a free grid the field is 0.
pub fn means(field: &[f64], grid: &Grid, cells: [usize; 2], boundary: Boundary) -> Vec<f64> {
    let along_x = shares(grid.nx, cells[0], boundary);
    let along_y = shares(grid.ny, cells[1], boundary);
    // Rows first, so that the larger field is read once.
    let narrow: Vec<f64> = field
        .chunks(grid.nx)
        .flat_map(|row| along_x.iter().map(|cell| mean(cell, |pixel| row[pixel])))
        .collect();
    along_y
        .iter()
        .flat_map(|cell| {
            let narrow = &narrow;
            (0..cells[0]).map(move |x| mean(cell, |pixel| narrow[pixel * cells[0] + x]))
        })
        .collect()
}

fn mean(cell: &[(usize, f64)], value: impl Fn(usize) -> f64) -> f64 {
    cell.iter()
        .map(|(pixel, share)| share * value(*pixel))
        .sum()
}

/// The pixels that each cell covers, and the share of the cell that each fills.
fn shares(pixels: usize, cells: usize, boundary: Boundary) -> Vec<Vec<(usize, f64)>> {
    let width = pixels as f64 / cells as f64;
    (0..cells)
        .map(|cell| {
            // In pixels; pixel i covers i - 1/2 to i + 1/2.
            let low = (cell as f64 - 0.5) * width;
            let high = (cell as f64 + 0.5) * width;
            let first = (low + 0.5).floor() as i64;
            let last = (high + 0.5).ceil() as i64;
            (first..last)
                .filter_map(|pixel| {
                    let from = low.max(pixel as f64 - 0.5);
                    let to = high.min(pixel as f64 + 0.5);
                    let inside = (0..pixels as i64).contains(&pixel);
                    if to <= from || (boundary == Boundary::Free && !inside) {
                        return None;
                    }
                    let wrapped = pixel.rem_euclid(pixels as i64) as usize;
                    Some((wrapped, (to - from) / width))
                })
                .collect()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_twice_as_wide_takes_halves_of_its_neighbours() {
        let shares = shares(4, 2, Boundary::Periodic);
        assert_eq!(shares[0], [(3, 0.25), (0, 0.5), (1, 0.25)]);
        assert_eq!(shares[1], [(1, 0.25), (2, 0.5), (3, 0.25)]);
        let free = super::shares(4, 2, Boundary::Free);
        assert_eq!(free[0], [(0, 0.5), (1, 0.25)]);
    }

    #[test]
    fn means_keep_the_mean_and_a_plane_wave() {
        let grid = Grid::new([12, 10], [1.0, 1.0]);
        let field: Vec<f64> = (0..120).map(|i| f64::from(i * 37 % 101)).collect();
        let whole = field.iter().sum::<f64>() / 120.0;
        for cells in [[12, 10], [6, 5], [5, 3], [1, 1]] {
            let means = means(&field, &grid, cells, Boundary::Periodic);
            let mean = means.iter().sum::<f64>() / means.len() as f64;
            assert!((mean - whole).abs() < 1e-12 * whole, "{cells:?}");
        }
        assert_eq!(means(&field, &grid, [12, 10], Boundary::Periodic), field);
        // The mean of a cosine over a cell of width D is the cosine times sin(q D/2)/(q D/2). Whole
        // pixels with half pixels at the ends are the trapezoid rule, with an error of (2
        // pi/512)^2/12 = 1.3e-5.
        let fine = Grid::new([512, 1], [1.0, 1.0]);
        let wave: Vec<f64> = (0..512)
            .map(|i| (std::f64::consts::TAU * f64::from(i) / 512.0).cos())
            .collect();
        let found = means(&wave, &fine, [8, 1], Boundary::Periodic);
        let half = std::f64::consts::PI / 8.0;
        assert!(
            (found[0] - half.sin() / half).abs() < 1.5e-5,
            "{}",
            found[0]
        );
        assert!(found[2].abs() < 1e-12);
    }
}
