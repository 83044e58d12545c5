//! The periodic half-space, or a layer, in Fourier space.

use std::f64::consts::PI;

use super::layer::Layer;
use crate::grid::Grid;

/// Stiffness of a wave of `wavenumber` (1/m, above 0) for a contact modulus of 1, 1/m: `|q|/2`,
/// divided by the layer's relative compliance if there is a layer.
#[inline]
pub fn wave_stiffness(wavenumber: f64, layer: Option<&Layer>) -> f64 {
    let half_space = 0.5 * wavenumber;
    match layer {
        Some(layer) => half_space / layer.compliance(wavenumber),
        None => half_space,
    }
}

/// Stiffness of a half-space or of a layer of unit contact modulus, for lengths in units of `unit`
/// metres.
///
/// Shape `[nx/2 + 1, ny/2 + 1]`, the column (x) index running slowest. The zero mode is 0: a
/// periodic cell leaves the mean displacement undetermined.
///
/// # Source
/// Westergaard 1939; Stanley & Kato 1997, doi:10.1115/1.2833523.
pub fn periodic_stiffness(grid: &Grid, unit: f64, layer: Option<&Layer>) -> Vec<f64> {
    let mut values = Vec::with_capacity((grid.nx / 2 + 1) * (grid.ny / 2 + 1));
    for kx in 0..=grid.nx / 2 {
        for ky in 0..=grid.ny / 2 {
            let wavenumber = grid.wavenumber(kx, ky);
            values.push(if wavenumber > 0.0 {
                unit * wave_stiffness(wavenumber, layer)
            } else {
                0.0
            });
        }
    }
    values
}

/// A periodic half-space of unit contact modulus, for lengths in units of `unit` metres: stiffness
/// `unit |q|/2`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace {
    grid: Grid,
    unit: f64,
}

impl HalfSpace {
    /// The half-space of a grid.
    pub fn new(grid: Grid, unit: f64) -> Self {
        HalfSpace { grid, unit }
    }

    /// Stiffness of the wavevector (kx, ky), indexed as in a spectrum; 0 at the zero wavevector.
    #[inline]
    pub fn stiffness(&self, kx: usize, ky: usize) -> f64 {
        self.unit * wave_stiffness(self.grid.wavenumber(kx, ky), None)
    }

    /// Stiffness of the longest waves along x and along y. That of a wavevector is the length `|(kx
    /// steps[0], ky steps[1])|`.
    pub fn steps(&self) -> [f64; 2] {
        [self.grid.lx, self.grid.ly].map(|length| self.unit * PI / length)
    }

    /// The largest stiffness, that of the shortest waves; 0 without any wave.
    pub fn largest(&self) -> f64 {
        self.stiffness(self.grid.nx / 2, self.grid.ny / 2)
    }

    /// The least stiffness, that of the longest wave; infinite without any wave.
    pub fn least(&self) -> f64 {
        let along_x = (self.grid.nx > 1).then(|| self.stiffness(1, 0));
        let along_y = (self.grid.ny > 1).then(|| self.stiffness(0, 1));
        let both = along_x.into_iter().chain(along_y);
        both.fold(f64::INFINITY, f64::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The spectral eigenvalues of the unit cell with 8 points: u/p = 2/(E* |q|).
    #[test]
    fn known_eigenvalues() {
        let values = periodic_stiffness(&Grid::new([8, 8], [1.0, 1.0]), 1.0, None);
        assert_eq!(values[0], 0.0);
        assert!((1.0 / values[5] - std::f64::consts::FRAC_1_PI).abs() < 1e-15);
        assert!((1.0 / values[4 * 5 + 4] - 0.0562697698).abs() < 1e-10);
    }

    /// Formula and table agree, on grids of any parity, and so do their extremes.
    #[test]
    fn formula_and_table_agree() {
        for (points, size) in [
            ([8, 8], [1.0, 1.0]),
            ([6, 10], [2.0, 1.3]),
            ([7, 1], [1.0, 3.0]),
            ([2, 9], [1.0, 3.0]),
        ] {
            let grid = Grid::new(points, size);
            let table = periodic_stiffness(&grid, 0.3, None);
            let formula = HalfSpace::new(grid, 0.3);
            let [x, y] = formula.steps();
            let rows = grid.ny / 2 + 1;
            for (index, &value) in table.iter().enumerate() {
                let (kx, ky) = (index / rows, index % rows);
                assert_eq!(formula.stiffness(kx, ky), value);
                // Equal up to a few roundings of a double.
                let length = (kx as f64 * x).hypot(ky as f64 * y);
                assert!((length - value).abs() <= 1e-15 * value);
            }
            let ends = table[1..]
                .iter()
                .fold([f64::INFINITY, 0.0], |ends, &value| {
                    [ends[0].min(value), ends[1].max(value)]
                });
            assert_eq!([formula.least(), formula.largest()], ends, "{points:?}");
        }
        let point = HalfSpace::new(Grid::new([1, 1], [1.0, 1.0]), 1.0);
        assert_eq!([point.least(), point.largest()], [f64::INFINITY, 0.0]);
    }
}
