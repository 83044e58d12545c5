//! An elastic layer over a grid's wavevectors, by its formula.

use std::ops::Range;

use rayon::prelude::*;

use super::half_space::wave_stiffness;
use super::layer::Layer;
use crate::grid::Grid;

/// A periodic layer of unit contact modulus, for lengths in units of `unit` metres: stiffness `unit |q|/2` over its
/// relative compliance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayeredSpace {
    grid: Grid,
    unit: f64,
    layer: Layer,
    /// Its least and its largest stiffness.
    ends: [f64; 2],
}

impl LayeredSpace {
    /// The layer of a grid whose [`ends`](LayeredSpace::ends) over all columns are known.
    pub fn new(grid: Grid, unit: f64, layer: Layer, ends: [f64; 2]) -> Self {
        LayeredSpace {
            grid,
            unit,
            layer,
            ends,
        }
    }

    /// The least and the largest stiffness of the waves of some columns of the half spectrum, the zero wavevector aside;
    /// infinite and 0 without any wave. Of a thin layer the softest wave need not be the longest, so that all are asked.
    pub fn ends(grid: &Grid, unit: f64, layer: &Layer, columns: Range<usize>) -> [f64; 2] {
        let none = [f64::INFINITY, 0.0];
        let of_column = |kx: usize| {
            (0..=grid.ny / 2).fold(none, |ends, ky| {
                let wavenumber = grid.wavenumber(kx, ky);
                if wavenumber > 0.0 {
                    joined(ends, [unit * wave_stiffness(wavenumber, Some(layer)); 2])
                } else {
                    ends
                }
            })
        };
        let columns = columns.into_par_iter().map(of_column);
        columns.reduce(|| none, joined)
    }

    /// Stiffness of the wavevector (kx, ky), indexed as in a spectrum; 0 at the zero wavevector.
    pub fn stiffness(&self, kx: usize, ky: usize) -> f64 {
        let wavenumber = self.grid.wavenumber(kx, ky);
        if wavenumber > 0.0 {
            self.unit * wave_stiffness(wavenumber, Some(&self.layer))
        } else {
            0.0
        }
    }

    /// The largest stiffness; 0 without any wave.
    pub fn largest(&self) -> f64 {
        self.ends[1]
    }

    /// The least stiffness; infinite without any wave.
    pub fn least(&self) -> f64 {
        self.ends[0]
    }
}

/// The ends of both together.
fn joined(one: [f64; 2], other: [f64; 2]) -> [f64; 2] {
    [one[0].min(other[0]), one[1].max(other[1])]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elastic::{Base, periodic_stiffness};

    /// Formula and table agree in every bit, and so do their ends, over all columns at once and in parts: of a thick layer, of
    /// thin ones whose softest wave is the longest, and of one where it lies between.
    #[test]
    fn formula_and_table_agree() {
        for (points, size) in [
            ([16, 12], [1.0, 1.3]),
            ([7, 1], [1.0, 3.0]),
            ([1, 1], [1.0, 1.0]),
        ] {
            let grid = Grid::new(points, size);
            for (thickness, poisson_ratio, base) in [
                (10.0, 0.3, Base::Bonded),
                (0.02, 0.3, Base::Frictionless),
                (0.02, 0.3, Base::Bonded),
                (0.1, 0.5, Base::Bonded),
            ] {
                let layer = Layer {
                    thickness,
                    poisson_ratio,
                    base,
                };
                let table = periodic_stiffness(&grid, 0.3, Some(&layer));
                let columns = grid.nx / 2 + 1;
                let ends = LayeredSpace::ends(&grid, 0.3, &layer, 0..columns);
                let formula = LayeredSpace::new(grid, 0.3, layer, ends);
                let rows = grid.ny / 2 + 1;
                for (index, value) in table.iter().enumerate() {
                    let found = formula.stiffness(index / rows, index % rows);
                    assert_eq!(found.to_bits(), value.to_bits());
                }
                let least = table[1..].iter().copied().fold(f64::INFINITY, f64::min);
                let largest = table.iter().copied().fold(0.0, f64::max);
                assert_eq!([formula.least(), formula.largest()], [least, largest]);
                let parts = [0..columns / 3, columns / 3..columns];
                let [one, other] = parts.map(|part| LayeredSpace::ends(&grid, 0.3, &layer, part));
                assert_eq!(joined(one, other), ends);
            }
        }
    }
}
