//! The stiffness of a solid over a grid's wavevectors, as a formula or as a table.

use std::ops::Range;
use std::sync::Arc;

use super::half_space::HalfSpace;
use super::layered::LayeredSpace;

/// Stiffness at each wavevector for a contact modulus of 1.
#[derive(Clone, Debug, PartialEq)]
pub enum Stiffness {
    /// The periodic half-space, by its formula.
    HalfSpace(HalfSpace),
    /// A periodic layer, by its formula.
    Layer(LayeredSpace),
    /// Of a free boundary, whose kernel is transformed: one value for each wavevector.
    Table(StiffnessTable),
}

impl Stiffness {
    /// Stiffness of the zero wavevector: 0 on a periodic grid, whose mean displacement is
    /// undetermined.
    pub fn zero_mode(&self) -> f64 {
        match self {
            Stiffness::HalfSpace(_) | Stiffness::Layer(_) => 0.0,
            Stiffness::Table(table) => table.axes[0][0],
        }
    }

    /// The largest stiffness; 1 without any wave.
    pub fn largest(&self) -> f64 {
        let largest = match self {
            Stiffness::HalfSpace(half_space) => half_space.largest(),
            Stiffness::Layer(layer) => layer.largest(),
            Stiffness::Table(table) => table.ends[1],
        };
        if largest > 0.0 { largest } else { 1.0 }
    }

    /// The least stiffness of a nonzero wavevector; 1 without any wave.
    pub fn least(&self) -> f64 {
        let least = match self {
            Stiffness::HalfSpace(half_space) => half_space.least(),
            Stiffness::Layer(layer) => layer.least(),
            Stiffness::Table(table) => table.ends[0],
        };
        if least.is_finite() { least } else { 1.0 }
    }

    /// That of the wavevector (kx, ky), indexed as in a spectrum; of a table that of a held column, or of a wave along x or
    /// y, which are all held.
    pub fn at(&self, kx: usize, ky: usize) -> f64 {
        match self {
            Stiffness::HalfSpace(half_space) => half_space.stiffness(kx, ky),
            Stiffness::Layer(layer) => layer.stiffness(kx, ky),
            Stiffness::Table(table) => table.at(kx, ky),
        }
    }
}

/// The stiffness of the wavevectors in some columns of the half spectrum, and what is asked of the others.
#[derive(Clone, Debug, PartialEq)]
pub struct StiffnessTable {
    columns: Range<usize>,
    /// Whoever needs them shares them.
    values: Arc<Vec<f64>>,
    /// Those of the waves along x and along y, the zero wavevector first.
    axes: [Arc<Vec<f64>>; 2],
    /// The least but for the zero wavevector, and the largest.
    ends: [f64; 2],
}

impl StiffnessTable {
    /// A table of some `columns` (x index), one after another, each of `ny/2 + 1` values; of all columns together the
    /// waves along both `axes`, and the `ends`: the least value but for that of the zero wavevector, and the largest.
    pub fn new(
        columns: Range<usize>,
        values: Vec<f64>,
        axes: [Vec<f64>; 2],
        ends: [f64; 2],
    ) -> Self {
        debug_assert_eq!(values.len(), columns.len() * axes[1].len());
        StiffnessTable {
            columns,
            values: Arc::new(values),
            axes: axes.map(Arc::new),
            ends,
        }
    }

    /// One that only tells the zero wavevector and the softest wave.
    pub fn sketch(zero_mode: f64, softest: f64) -> Self {
        StiffnessTable::new(
            0..0,
            Vec::new(),
            [vec![zero_mode], vec![zero_mode]],
            [softest, zero_mode.max(softest)],
        )
    }

    /// The held columns.
    pub fn columns(&self) -> Range<usize> {
        self.columns.clone()
    }

    /// That of the wavevector (kx, ky) of a held column, or along an axis.
    ///
    /// # Panics
    /// On a column that another process holds.
    pub fn at(&self, kx: usize, ky: usize) -> f64 {
        if ky == 0 {
            return self.axes[0][kx];
        }
        if kx == 0 {
            return self.axes[1][ky];
        }
        self.values[(kx - self.columns.start) * self.axes[1].len() + ky]
    }

    /// The same of a level of fewer waves, `count` along each axis, of which it holds other columns.
    pub fn below(&self, columns: Range<usize>, values: Vec<f64>, count: [usize; 2]) -> Self {
        let [x, y] = &self.axes;
        let axes = [x[..count[0]].to_vec(), y[..count[1]].to_vec()];
        StiffnessTable::new(columns, values, axes, self.ends)
    }

    /// The first `count` values of each of some columns that are held, one column after another.
    pub fn low(&self, columns: Range<usize>, count: usize) -> Vec<f64> {
        let column = self.axes[1].len();
        let starts = columns.map(|kx| (kx - self.columns.start) * column);
        let parts = starts.flat_map(|start| &self.values[start..start + count]);
        parts.copied().collect()
    }
}
