//! What the waves of a convolution are multiplied by.

use std::ops::Range;

use super::Shape;
use crate::elastic::HalfSpace;

/// One real, even factor a wavevector.
#[derive(Clone, Copy, Debug)]
pub enum Factors<'a> {
    /// A table of them, as [`Shape::spectrum_len`] says.
    Table(&'a [f64]),
    /// Those of a half-space: a backend may compute them where it needs them, and hold nothing.
    HalfSpace(HalfSpace, Response),
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
    pub fn tabulated<T>(&self, shape: Shape, number: impl Fn(f64) -> T) -> Vec<T> {
        self.tabulated_columns(shape, 0..shape.points[0] / 2 + 1, number)
    }

    /// Those of some columns of a shape.
    pub fn tabulated_columns<T>(
        &self,
        shape: Shape,
        columns: Range<usize>,
        number: impl Fn(f64) -> T,
    ) -> Vec<T> {
        let ny = shape.points[1];
        let column = ny / 2 + 1;
        match *self {
            Factors::Table(values) => {
                debug_assert_eq!(values.len(), shape.spectrum_len());
                let held = &values[columns.start * column..columns.end * column];
                held.iter().map(|&value| number(value)).collect()
            }
            Factors::HalfSpace(half_space, response) => {
                let mut values = Vec::with_capacity(columns.len() * column);
                for kx in columns {
                    for ky in 0..=ny / 2 {
                        values.push(number(response.factor(half_space.stiffness(kx, ky))));
                    }
                }
                values
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Grid;

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
