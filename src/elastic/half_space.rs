//! The periodic half-space in Fourier space.

use crate::grid::Grid;

/// Stiffness `|q|/2` of a half-space of unit contact modulus, per length in units of `unit` metres.
///
/// Shape `[nx/2 + 1, ny/2 + 1]`, the column (x) index running slowest; the zero mode is 0, since a
/// periodic cell leaves the mean displacement open.
///
/// # Source
/// Westergaard 1939; Stanley & Kato 1997, doi:10.1115/1.2833523.
pub fn periodic_stiffness(grid: &Grid, unit: f64) -> Vec<f64> {
    let mut values = Vec::with_capacity((grid.nx / 2 + 1) * (grid.ny / 2 + 1));
    for kx in 0..=grid.nx / 2 {
        for ky in 0..=grid.ny / 2 {
            values.push(0.5 * unit * grid.wavenumber(kx, ky));
        }
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The spectral eigenvalues of the unit cell with 8 points: u/p = 2/(E* |q|).
    #[test]
    fn known_eigenvalues() {
        let values = periodic_stiffness(&Grid::new([8, 8], [1.0, 1.0]), 1.0);
        assert_eq!(values[0], 0.0);
        assert!((1.0 / values[5] - std::f64::consts::FRAC_1_PI).abs() < 1e-15);
        assert!((1.0 / values[4 * 5 + 4] - 0.0562697698).abs() < 1e-10);
    }
}
