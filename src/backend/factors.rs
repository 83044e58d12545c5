//! What the waves of a convolution are multiplied by.

use std::fmt;
use std::ops::Range;

use rayon::prelude::*;

use super::Shape;
use crate::elastic::HalfSpace;

/// One real, even factor a wavevector.
#[derive(Clone, Copy)]
pub enum Factors<'a> {
    /// A table of them, as [`Shape::spectrum_len`] says.
    Table(&'a [f64]),
    /// That of each wavevector (kx, ky), indexed as in a spectrum: a backend makes a table of the columns that it holds, and
    /// asks for no other ones.
    Each(&'a (dyn Fn([usize; 2]) -> f64 + Sync)),
    /// Those of a half-space: a backend may compute them where it needs them, and hold nothing.
    HalfSpace(HalfSpace, Response),
}

impl fmt::Debug for Factors<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            // Not millions of numbers.
            Factors::Table(values) => write!(formatter, "Table({} numbers)", values.len()),
            Factors::Each(_) => formatter.write_str("Each(..)"),
            Factors::HalfSpace(half_space, response) => {
                write!(formatter, "HalfSpace({half_space:?}, {response:?})")
            }
        }
    }
}

/// What is asked of an elastic solid of stiffness K at a wavevector.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Response {
    /// K.
    Stiffness,
    /// 1/K.
    Compliance,
}

impl Response {
    /// The factor of a wave of this stiffness; 0 where that is 0.
    pub fn factor(self, stiffness: f64) -> f64 {
        match self {
            Response::Stiffness => stiffness,
            _ if stiffness <= 0.0 => 0.0,
            Response::Compliance => 1.0 / stiffness,
        }
    }
}

impl Factors<'_> {
    /// The factors of a shape, one after another.
    pub fn tabulated<T: Copy + Default + Send>(
        &self,
        shape: Shape,
        number: impl Fn(f64) -> T + Send + Sync,
    ) -> Vec<T> {
        self.tabulated_columns(shape, 0..shape.points[0] / 2 + 1, number)
    }

    /// Those of some columns of a shape.
    pub fn tabulated_columns<T: Copy + Default + Send>(
        &self,
        shape: Shape,
        columns: Range<usize>,
        number: impl Fn(f64) -> T + Send + Sync,
    ) -> Vec<T> {
        let column = shape.points[1] / 2 + 1;
        match *self {
            Factors::Table(values) => {
                debug_assert_eq!(values.len(), shape.spectrum_len());
                let held = &values[columns.start * column..columns.end * column];
                held.iter().map(|&value| number(value)).collect()
            }
            Factors::Each(factor) => each(columns, column, &|wave| number(factor(wave))),
            Factors::HalfSpace(half_space, response) => each(columns, column, &|[kx, ky]| {
                number(response.factor(half_space.stiffness(kx, ky)))
            }),
        }
    }
}

/// A value for each wavevector of some columns, each of so many; compiled once for a type.
fn each<T: Copy + Default + Send>(
    columns: Range<usize>,
    column: usize,
    value: &(dyn Fn([usize; 2]) -> T + Sync),
) -> Vec<T> {
    let first = columns.start;
    let mut values = vec![T::default(); columns.len() * column];
    let lines = values.par_chunks_exact_mut(column).enumerate();
    lines.for_each(|(line, values)| {
        for (ky, at) in values.iter_mut().enumerate() {
            *at = value([first + line, ky]);
        }
    });
    values
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Grid;

    /// All factors, and those of some columns, are the same ones of a table and of each wavevector.
    #[test]
    fn columns_of_a_table() {
        let shape = Shape::whole(6, 5);
        let factor = |[kx, ky]: [usize; 2]| (10 * kx + ky) as f64;
        let table: Vec<f64> = (0..12)
            .map(|index| factor([index / 3, index % 3]))
            .collect();
        for factors in [Factors::Table(&table), Factors::Each(&factor)] {
            assert_eq!(factors.tabulated(shape, |x| x), table, "{factors:?}");
            assert_eq!(factors.tabulated_columns(shape, 1..3, |x| x), table[3..9]);
            assert!(factors.tabulated_columns(shape, 4..4, |x| x).is_empty());
        }
    }

    /// The unit cell's first wave along x: K = pi, and what is made of it.
    #[test]
    fn responses_of_a_wave() {
        let half_space = HalfSpace::new(Grid::new([4, 4], [1.0, 1.0]), 1.0);
        let shape = Shape::whole(4, 4);
        let first = |response| {
            let values = Factors::HalfSpace(half_space, response).tabulated(shape, |x| x);
            assert_eq!(values.len(), 9);
            assert_eq!(values[0], 0.0);
            values[3]
        };
        let pi = std::f64::consts::PI;
        assert!((first(Response::Stiffness) - pi).abs() < 1e-15);
        assert!((first(Response::Compliance) - 1.0 / pi).abs() < 1e-15);
    }
}
