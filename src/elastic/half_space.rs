//! The periodic half-space, or a layer, in Fourier space.

use super::layer::Layer;
use crate::grid::Grid;

/// Stiffness of a wave of `wavenumber` (1/m, above 0) for a contact modulus of 1, 1/m: `|q|/2`, over
/// the layer's relative compliance where there is one.
pub fn wave_stiffness(wavenumber: f64, layer: Option<&Layer>) -> f64 {
    let half_space = 0.5 * wavenumber;
    match layer {
        Some(layer) => half_space / layer.compliance(wavenumber),
        None => half_space,
    }
}

/// Stiffness of a half-space, or of a layer, of unit contact modulus, per length in units of `unit`
/// metres.
///
/// Shape `[nx/2 + 1, ny/2 + 1]`, the column (x) index running slowest; the zero mode is 0, since a
/// periodic cell leaves the mean displacement open.
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
}
