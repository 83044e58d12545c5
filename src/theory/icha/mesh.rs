//! The smooth part of the interaction of many point loads in a periodic cell, by Fourier transforms
//! on a coarse mesh: Ewald's splitting with B-splines (Essmann et al. 1995, doi:10.1063/1.470117),
//! for the surface of a half-space.
//!
//! A point load displaces by `1/(pi r)` over the modulus. The smooth part `erf(alpha r)/(pi r)` is
//! computed here with all its images; the rest vanishes beyond [`Mesh::reach`].

use std::f64::consts::PI;
use std::fmt;
use std::sync::Arc;

use num_complex::Complex;
use realfft::{ComplexToReal, RealToComplex};
use rustfft::Fft;

use crate::plans::Planned;
use crate::theory::special::{erf, erfc};

/// Points of a spline's support along each axis.
const ORDER: usize = 6;
/// `alpha` times the spacing: the mesh omits erfc(2.6) = 2e-4 at its shortest wave.
const SPLIT: f64 = 0.6;
/// `alpha r` beyond which the part near a load is left out: erfc(3) = 2e-5.
const REACH: f64 = 3.0;
/// Mesh points a side over the square root of the number of loads, chosen so that transforms and
/// neighbours cost the same.
const FINENESS: f64 = 1.6;
/// Limits of the points a side.
const POINTS: [usize; 2] = [32, 2048];
/// Nodes of the table of `erf(t)/t`; linear interpolation is accurate to 3e-7.
const NODES: usize = 2048;

/// A mesh over the cell.
#[derive(Clone)]
pub(super) struct Mesh {
    points: [usize; 2],
    spacing: [f64; 2],
    /// Splitting parameter alpha, 1/m.
    alpha: f64,
    /// Displacement of a wave times modulus over load, 1/m; column by column.
    influence: Vec<f64>,
    table: Vec<f64>,
    forward: Arc<dyn RealToComplex<f64>>,
    backward: Arc<dyn ComplexToReal<f64>>,
    down: Arc<dyn Fft<f64>>,
    up: Arc<dyn Fft<f64>>,
}

impl fmt::Debug for Mesh {
    fn fmt(&self, to: &mut fmt::Formatter) -> fmt::Result {
        write!(to, "Mesh({} x {})", self.points[0], self.points[1])
    }
}

/// Position of a point on the mesh.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stencil {
    corner: [usize; 2],
    weights: [[f64; ORDER]; 2],
}

impl Mesh {
    /// A mesh over a cell of `size` (m) suited to a number of loads.
    pub fn new(size: [f64; 2], loads: usize) -> Self {
        let wanted = FINENESS * (loads as f64 / (size[0] * size[1])).sqrt();
        let points = size.map(|side| {
            let points = (wanted * side) as usize;
            points.clamp(POINTS[0], POINTS[1]).next_power_of_two()
        });
        let spacing = [0, 1].map(|axis| size[axis] / points[axis] as f64);
        let alpha = SPLIT / spacing[0].max(spacing[1]);
        let area = size[0] * size[1];
        let [nx, ny] = points;
        let damping = points.map(|count| {
            let spline = splines(0.0);
            let of = |wave: usize| {
                let turn = 2.0 * PI * wave as f64 / count as f64;
                let sum: Complex<f64> = (1..ORDER)
                    .map(|k| Complex::from_polar(spline[k], turn * k as f64))
                    .sum();
                sum.norm_sqr()
            };
            (0..count).map(of).collect::<Vec<f64>>()
        });
        let mut influence = Vec::with_capacity((nx / 2 + 1) * ny);
        for kx in 0..=nx / 2 {
            for ky in 0..ny {
                let qx = 2.0 * PI / size[0] * kx as f64;
                let qy = 2.0 * PI / size[1] * ky.min(ny - ky) as f64;
                let q = qx.hypot(qy);
                let value = if q > 0.0 {
                    2.0 * erfc(q / (2.0 * alpha)) / q
                } else {
                    // The mean of the total is 0, so this is minus that of the near part.
                    -2.0 / (alpha * PI.sqrt())
                };
                influence.push(value / (area * damping[0][kx] * damping[1][ky]));
            }
        }
        let table = (0..=NODES)
            .map(|node| {
                let t = REACH * node as f64 / NODES as f64;
                if t > 0.0 { erf(t) / t } else { 2.0 / PI.sqrt() }
            })
            .collect();
        Mesh {
            points,
            spacing,
            alpha,
            influence,
            table,
            forward: f64::real_forward(nx),
            backward: f64::real_backward(nx),
            down: f64::complex_forward(ny),
            up: f64::complex_backward(ny),
        }
    }

    /// Distance beyond which the mesh contains all of a point load's displacement, m.
    pub fn reach(&self) -> f64 {
        REACH / self.alpha
    }

    /// The mesh's part of a point load's displacement times modulus over load at a distance from
    /// it, without its other images, 1/m.
    pub fn smooth(&self, distance: f64) -> f64 {
        let place = distance * self.alpha * (NODES as f64 / REACH);
        let node = place as usize;
        if node >= NODES {
            return 1.0 / (PI * distance);
        }
        let share = place - node as f64;
        let value = self.table[node] * (1.0 - share) + self.table[node + 1] * share;
        value * self.alpha / PI
    }

    /// The stencil of a position (m, within the cell).
    pub fn stencil(&self, position: [f64; 2]) -> Stencil {
        let scaled = [0, 1].map(|axis| position[axis] / self.spacing[axis]);
        Stencil {
            corner: [0, 1].map(|axis| (scaled[axis] as usize) & (self.points[axis] - 1)),
            weights: scaled.map(|place| splines(place - place.floor())),
        }
    }

    /// Displacement times modulus, m, of all loads over the modulus (m^2), at each mesh point; read
    /// with [`Mesh::at`].
    pub fn displacement<'a>(&self, loads: impl Iterator<Item = (&'a Stencil, f64)>) -> Vec<f64> {
        let [nx, ny] = self.points;
        let mut values = vec![0.0; nx * ny];
        for (stencil, load) in loads {
            for (j, along_y) in stencil.weights[1].iter().enumerate() {
                let row = ((stencil.corner[1] + ny - j) & (ny - 1)) * nx;
                for (i, along_x) in stencil.weights[0].iter().enumerate() {
                    let column = (stencil.corner[0] + nx - i) & (nx - 1);
                    values[row + column] += load * along_y * along_x;
                }
            }
        }
        let held = nx / 2 + 1;
        let mut columns = vec![Complex::default(); held * ny];
        let mut row_spectrum = self.forward.make_output_vec();
        let mut scratch = self.forward.make_scratch_vec();
        for (iy, row) in values.chunks_mut(nx).enumerate() {
            // The lengths are those of the plan.
            let _ = self
                .forward
                .process_with_scratch(row, &mut row_spectrum, &mut scratch);
            for (kx, value) in row_spectrum.iter().enumerate() {
                columns[kx * ny + iy] = *value;
            }
        }
        let mut scratch = vec![Complex::default(); self.down.get_inplace_scratch_len()];
        self.down.process_with_scratch(&mut columns, &mut scratch);
        for (value, influence) in columns.iter_mut().zip(&self.influence) {
            *value *= influence;
        }
        scratch.resize(self.up.get_inplace_scratch_len(), Complex::default());
        self.up.process_with_scratch(&mut columns, &mut scratch);
        let mut scratch = self.backward.make_scratch_vec();
        for (iy, row) in values.chunks_mut(nx).enumerate() {
            for (kx, value) in row_spectrum.iter_mut().enumerate() {
                *value = columns[kx * ny + iy];
            }
            // Real by symmetry; the transform would refuse a rounding error in the imaginary part.
            row_spectrum[0].im = 0.0;
            row_spectrum[nx / 2].im = 0.0;
            let _ = self
                .backward
                .process_with_scratch(&mut row_spectrum, row, &mut scratch);
        }
        values
    }

    /// Value of a mesh field at a stencil.
    pub fn at(&self, field: &[f64], stencil: &Stencil) -> f64 {
        let [nx, ny] = self.points;
        let mut sum = 0.0;
        for (j, along_y) in stencil.weights[1].iter().enumerate() {
            let row = ((stencil.corner[1] + ny - j) & (ny - 1)) * nx;
            let mut along = 0.0;
            for (i, along_x) in stencil.weights[0].iter().enumerate() {
                along += along_x * field[row + ((stencil.corner[0] + nx - i) & (nx - 1))];
            }
            sum += along_y * along;
        }
        sum
    }
}

/// Values of the B-spline at `share`, `share + 1`, ... from the left end of its support.
fn splines(share: f64) -> [f64; ORDER] {
    let mut values = [0.0; ORDER];
    values[0] = 1.0;
    for order in 2..=ORDER {
        let narrower = values;
        for j in 0..order {
            let place = share + j as f64;
            let left = if j + 1 < order {
                place * narrower[j]
            } else {
                0.0
            };
            let right = if j > 0 {
                (order as f64 - place) * narrower[j - 1]
            } else {
                0.0
            };
            values[j] = (left + right) / (order - 1) as f64;
        }
    }
    values
}
