//! The surroundings of a set of asperities: an infinite half-space, or the images of a periodic
//! cell.
//!
//! The displacement of a periodic half-space under a point load is the lattice sum of `1/(pi E* r)`
//! less its mean (the mode that a cell leaves undetermined). Near the load it is the nearest
//! image's own term plus a smooth remainder, which does not depend on the load's shape and is
//! tabulated once.

use std::f64::consts::PI;

use super::mesh::Mesh;
use crate::theory::special::erfc;

/// Intervals of the table along each half side; its linear interpolation is accurate to 1e-4 of
/// 1/L.
const INTERVALS: usize = 64;
/// Cut-off of the two Ewald sums: both complementary error functions are below 1e-16 there.
const CUT: f64 = 6.0;

/// The surroundings of a set of asperities.
#[derive(Clone, Debug)]
pub(super) struct Lattice {
    /// Sides of the cell, m; `None` on an infinite half-space.
    size: Option<[f64; 2]>,
    /// Displacement times modulus over load by all images but the nearest, 1/m, on a quarter of the
    /// cell, x running fastest.
    rest: Vec<f64>,
    /// Least displacement times modulus over load anywhere in the cell, 1/m; not positive.
    pub least: f64,
    /// Mesh for sums over many loads; `None` if all pairs are summed.
    pub mesh: Option<Mesh>,
}

impl Lattice {
    /// An infinite half-space.
    pub fn infinite() -> Self {
        Lattice {
            size: None,
            rest: Vec::new(),
            least: 0.0,
            mesh: None,
        }
    }

    /// A periodic cell of `size` (m).
    pub fn periodic(size: [f64; 2]) -> Self {
        let mut rest = Vec::with_capacity((INTERVALS + 1) * (INTERVALS + 1));
        let mut least: f64 = 0.0;
        for row in 0..=INTERVALS {
            for column in 0..=INTERVALS {
                let share = |index: usize| 0.5 * index as f64 / INTERVALS as f64;
                let (x, y) = (share(column) * size[0], share(row) * size[1]);
                let value = rest_at([x, y], size);
                let distance = x.hypot(y);
                if distance > 0.0 {
                    least = least.min(value + 1.0 / (PI * distance));
                }
                rest.push(value);
            }
        }
        Lattice {
            size: Some(size),
            rest,
            least,
            mesh: None,
        }
    }

    /// Adds a mesh suited to a number of loads.
    pub fn with_mesh(mut self, loads: usize) -> Self {
        self.mesh = self.size.map(|size| Mesh::new(size, loads));
        self
    }

    /// Sides of the cell, m; infinite for an infinite half-space.
    pub fn size(&self) -> [f64; 2] {
        self.size.unwrap_or([f64::INFINITY; 2])
    }

    /// Whether the cell is periodic.
    pub fn is_periodic(&self) -> bool {
        self.size.is_some()
    }

    /// Vector from `from` to the nearest image of `to`, m.
    pub fn offset(&self, from: [f64; 2], to: [f64; 2]) -> [f64; 2] {
        let straight = [to[0] - from[0], to[1] - from[1]];
        match self.size {
            None => straight,
            Some(size) => [0, 1]
                .map(|axis| straight[axis] - size[axis] * (straight[axis] / size[axis]).round()),
        }
    }

    /// A position wrapped back into the cell.
    pub fn wrapped(&self, position: [f64; 2]) -> [f64; 2] {
        match self.size {
            None => position,
            Some(size) => [0, 1].map(|axis| position[axis].rem_euclid(size[axis])),
        }
    }

    /// Displacement times modulus over load by all images but the nearest, at `offset` from it, 1/m.
    pub fn rest(&self, offset: [f64; 2]) -> f64 {
        let Some(size) = self.size else {
            return 0.0;
        };
        let place = |axis: usize| {
            let scaled = offset[axis].abs() / size[axis] * (2 * INTERVALS) as f64;
            let index = (scaled as usize).min(INTERVALS - 1);
            (index, scaled - index as f64)
        };
        let ((column, s), (row, t)) = (place(0), place(1));
        let at = row * (INTERVALS + 1) + column;
        let (below, above) = (
            &self.rest[at..at + 2],
            &self.rest[at + INTERVALS + 1..][..2],
        );
        (1.0 - t) * ((1.0 - s) * below[0] + s * below[1])
            + t * ((1.0 - s) * above[0] + s * above[1])
    }
}

/// The remainder at an offset within half a side of the load, by Ewald's two sums.
///
/// Real space has `erfc(alpha r)/(pi r)` of each image, Fourier space `2 erfc(q/(2 alpha))/q` of
/// each wave; the mean of the first is subtracted.
fn rest_at(offset: [f64; 2], size: [f64; 2]) -> f64 {
    let area = size[0] * size[1];
    let alpha = (PI / area).sqrt();
    let reach = [0, 1].map(|axis| (CUT / (alpha * size[axis])).ceil() as i64 + 1);
    let mut sum = -2.0 / (area * alpha * PI.sqrt());
    for k in -reach[0]..=reach[0] {
        for l in -reach[1]..=reach[1] {
            let distance = (offset[0] + k as f64 * size[0]).hypot(offset[1] + l as f64 * size[1]);
            sum += if (k, l) != (0, 0) {
                erfc(alpha * distance) / (PI * distance)
            } else if distance > 0.0 {
                (erfc(alpha * distance) - 1.0) / (PI * distance)
            } else {
                -2.0 * alpha / (PI * PI.sqrt())
            };
        }
    }
    let step = size.map(|side| 2.0 * PI / side);
    let most = [0, 1].map(|axis| (2.0 * CUT * alpha / step[axis]).ceil() as i64);
    for k in -most[0]..=most[0] {
        for l in -most[1]..=most[1] {
            let q = [k as f64 * step[0], l as f64 * step[1]];
            let wavenumber = q[0].hypot(q[1]);
            if wavenumber > 0.0 {
                let phase = q[0] * offset[0] + q[1] * offset[1];
                sum += 2.0 / (area * wavenumber) * erfc(wavenumber / (2.0 * alpha)) * phase.cos();
            }
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lattice_constant_of_a_square_is_the_published_one() {
        // Charges on a square lattice in a neutral plane: -3.900264920001956/L a unit charge
        // (Bonsall & Maradudin 1977), here over pi.
        let found = rest_at([0.0, 0.0], [2.0, 2.0]);
        assert!(
            (found * PI * 2.0 + 3.900264920001956).abs() < 1e-9,
            "{found}"
        );
        // A cell of two such cells, loaded once and once more half a side away, equals the small
        // cell.
        let small = rest_at([0.3, 0.2], [1.0, 1.0]);
        let both = rest_at([0.3, 0.2], [2.0, 1.0])
            + rest_at([-0.7, 0.2], [2.0, 1.0])
            + 1.0 / (PI * f64::hypot(0.7, 0.2));
        assert!((small - both).abs() < 1e-12, "{small} {both}");
    }

    #[test]
    fn the_table_meets_the_sums_and_its_least_value_bounds_them() {
        let size = [3.0, 2.0];
        let lattice = Lattice::periodic(size);
        for offset in [[0.0, 0.0], [0.31, -0.77], [-1.5, 1.0], [1.2, 0.01]] {
            let exact = rest_at(offset, size);
            assert!((lattice.rest(offset) - exact).abs() < 2e-4, "{offset:?}");
            let distance = f64::hypot(offset[0], offset[1]);
            assert!(exact + 1.0 / (PI * distance) >= lattice.least - 1e-12);
        }
        assert_eq!(lattice.wrapped([-0.5, 2.5]), [2.5, 0.5]);
        assert_eq!(lattice.offset([0.2, 0.2], [2.9, 0.3])[0].signum(), -1.0);
    }
}
