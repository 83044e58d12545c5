//! Displacement of a half-space under axisymmetric pressure, without a grid's error.
//!
//! The pressure is a polynomial on each of a row of radial panels, given at Gauss points; the
//! matrix maps it to displacement at the same points, times E*, and is good to about 1e-11.

use super::quadrature::gauss_legendre;
use super::special::elliptic_complement;
use nalgebra::DMatrix;
use std::f64::consts::PI;

/// Points of a panel.
const ORDER: usize = 10;

/// Radial panels with their Gauss points.
#[derive(Clone, Debug)]
pub(crate) struct Rings {
    /// Ends of the panels, ascending from 0.
    edges: Vec<f64>,
    /// Radii of the points, ascending.
    pub(crate) radii: Vec<f64>,
    /// Weights of `int f(r) dr`.
    pub(crate) weights: Vec<f64>,
    unit_nodes: Vec<f64>,
    unit_weights: Vec<f64>,
    barycentric: Vec<f64>,
}

impl Rings {
    /// Panels of `width` up to `fine`, then each twice as wide as the last, up to `far` at least.
    pub(crate) fn new(width: f64, fine: f64, far: f64) -> Self {
        let count = (fine / width).ceil().max(1.0);
        let mut edges: Vec<f64> = (0..=count as usize)
            .map(|i| fine * i as f64 / count)
            .collect();
        let (mut end, mut wide) = (fine, fine / count);
        // Twice as wide each time: `far` is met after no more panels than its logarithm over that of `wide`.
        while end < far {
            wide *= 2.0;
            end += wide;
            edges.push(end);
        }
        let (unit_nodes, unit_weights) = gauss_legendre(ORDER);
        let mut radii = Vec::new();
        let mut weights = Vec::new();
        for panel in edges.windows(2) {
            let (middle, half) = (0.5 * (panel[0] + panel[1]), 0.5 * (panel[1] - panel[0]));
            radii.extend(unit_nodes.iter().map(|x| middle + half * x));
            weights.extend(unit_weights.iter().map(|w| half * w));
        }
        // Barycentric weights of Gauss points (Wang & Xiang 2012).
        let barycentric = unit_nodes
            .iter()
            .zip(&unit_weights)
            .enumerate()
            .map(|(i, (x, w))| ((1.0 - x * x) * w).sqrt() * if i % 2 == 0 { 1.0 } else { -1.0 })
            .collect();
        Rings {
            edges,
            radii,
            weights,
            unit_nodes,
            unit_weights,
            barycentric,
        }
    }

    /// Values of the panel's polynomials at `x` in [-1, 1].
    fn shapes(&self, x: f64) -> [f64; ORDER] {
        let mut shapes = [0.0; ORDER];
        let mut sum = 0.0;
        for (i, (node, weight)) in self.unit_nodes.iter().zip(&self.barycentric).enumerate() {
            if x == *node {
                let mut exact = [0.0; ORDER];
                exact[i] = 1.0;
                return exact;
            }
            shapes[i] = weight / (x - node);
            sum += shapes[i];
        }
        shapes.map(|shape| shape / sum)
    }

    /// The field with `values` at the points, at radius `r`; the outermost panel goes on.
    pub(crate) fn interpolate(&self, values: &[f64], r: f64) -> f64 {
        let panels = self.edges.len() - 1;
        let panel = self.edges.partition_point(|edge| *edge <= r);
        let panel = panel.saturating_sub(1).min(panels - 1);
        let (from, to) = (self.edges[panel], self.edges[panel + 1]);
        let shapes = self.shapes((2.0 * r - from - to) / (to - from));
        let values = &values[panel * ORDER..(panel + 1) * ORDER];
        shapes.iter().zip(values).map(|(s, v)| s * v).sum()
    }

    /// Displacement at each point under the pressures at all points, times E*.
    pub(crate) fn compliance(&self) -> DMatrix<f64> {
        let points = self.radii.len();
        let panels = self.edges.len() - 1;
        let mut matrix = DMatrix::zeros(points, points);
        for i in 0..points {
            let r = self.radii[i];
            for panel in 0..panels {
                let columns = panel * ORDER..(panel + 1) * ORDER;
                if panel.abs_diff(i / ORDER) > 1 {
                    for j in columns {
                        matrix[(i, j)] = self.weights[j] * ring(r, self.radii[j]);
                    }
                } else {
                    for (j, value) in columns.zip(self.near(r, panel)) {
                        matrix[(i, j)] = value;
                    }
                }
            }
        }
        matrix
    }

    /// Displacement at `r` under each polynomial of a panel that holds or adjoins it.
    fn near(&self, r: f64, panel: usize) -> [f64; ORDER] {
        let (from, to) = (self.edges[panel], self.edges[panel + 1]);
        let mut sums = [0.0; ORDER];
        // Parts no longer than their distance from the logarithm at r; what is left is nothing.
        let smallest = 1e-13 * (to - from);
        let mut parts = vec![(from, to)];
        while let Some((a, b)) = parts.pop() {
            let distance = (a - r).max(r - b).max(0.0);
            let cut = if a < r && r < b { r } else { 0.5 * (a + b) };
            // Between neighbouring numbers there is nothing to cut.
            if b - a > distance.max(smallest) && a < cut && cut < b {
                parts.extend([(a, cut), (cut, b)]);
                continue;
            }
            for (node, weight) in self.unit_nodes.iter().zip(&self.unit_weights) {
                let s = 0.5 * (a + b) + 0.5 * (b - a) * node;
                if s == r {
                    continue;
                }
                let value = 0.5 * (b - a) * weight * ring(r, s);
                let shapes = self.shapes((2.0 * s - from - to) / (to - from));
                for (sum, shape) in sums.iter_mut().zip(shapes) {
                    *sum += value * shape;
                }
            }
        }
        sums
    }
}

/// Displacement at `r` under a unit of pressure times width on the ring of radius `s`, times E*:
/// `(4/pi) s/(r+s) K(4 r s/(r+s)^2)`. Johnson 1985, section 3.8.
fn ring(r: f64, s: f64) -> f64 {
    let sum = r + s;
    let complement = ((r - s) / sum).powi(2);
    4.0 / PI * s / sum * elliptic_complement(complement).0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smooth_pressure_gives_its_displacement() {
        // Pressure (1 + r^2)^(-3/2) gives displacement 2 (1 + r^2)^(-1/2): its Hankel transform
        // is exp(-q), and the half-space multiplies by 2/q.
        let rings = Rings::new(0.5, 3.0, 1e6);
        let pressure: Vec<f64> = rings
            .radii
            .iter()
            .map(|r| (1.0 + r * r).powf(-1.5))
            .collect();
        let displacement = rings.compliance() * nalgebra::DVector::from_vec(pressure);
        for (r, got) in rings.radii.iter().zip(displacement.iter()) {
            let expected = 2.0 / (1.0 + r * r).sqrt();
            assert!((got - expected).abs() < 1e-8, "{r}: {got} {expected}");
        }
    }
}
