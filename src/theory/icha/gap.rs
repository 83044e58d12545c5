//! The gap of a set of contacts over a whole height map.
//!
//! Each contact's displacement has two parts. On the grid it is that of a Gaussian load of the same
//! force, summed over all contacts and images by one convolution with the half-space's operator.
//! Near the contact the difference from Hertz's displacement is added point by point. A Gaussian
//! with the second moment of Hertz's pressure leaves a difference that decreases as r^-5; a wider
//! one, where pixels demand it, leaves r^-3. The difference is cut off at eight standard
//! deviations, where it is below 2e-3 of the contact's own displacement there.

use std::f64::consts::PI;

use rayon::prelude::*;

use super::Contact;
use super::pair::pair;
use crate::elastic::periodic_stiffness;
use crate::grid::Grid;
use crate::surface::fourier;

/// Least standard deviation of a Gaussian load, pixels: its waves beyond the grid's are below 1e-5.
const NARROWEST: f64 = 1.6;
/// Standard deviations that contain the Gaussian load, to 1e-7.
const GAUSSIAN_REACH: f64 = 5.5;
/// Standard deviations at which the near difference is cut off.
const NEAR_REACH: f64 = 8.0;
/// Nodes of the Gaussian's displacement over the near part; linear interpolation is accurate to
/// 1e-6.
const NODES: usize = 2048;

/// A gap field and its contact points.
#[derive(Clone, Debug, PartialEq)]
pub struct GapField {
    /// Gap, m, shape `[ny, nx]`: 0 in the circles of contacts, and where the model overlaps outside
    /// them.
    pub gap: Vec<f64>,
    /// Whether a point lies in the circle of a contact.
    pub in_contact: Vec<bool>,
    /// Share of the points outside the circles where the model overlaps, an error of the model.
    pub overlapping: f64,
}

impl GapField {
    /// Mean over the cell, m.
    pub fn mean(&self) -> f64 {
        self.gap.iter().sum::<f64>() / self.gap.len() as f64
    }

    /// Mean over the cell of a `traction` of the gap where there is one: the DMT force approach. Where the model overlaps the surfaces
    /// would touch, and do not attract each other, though no circle is there.
    pub fn mean_outside(&self, traction: impl Fn(f64) -> f64) -> f64 {
        let outside = self.gap.iter().filter(|gap| **gap > 0.0);
        outside.map(|&gap| traction(gap)).sum::<f64>() / self.gap.len() as f64
    }
}

/// The gap under a plane at height `plane` (m).
pub(super) fn gap_field(
    grid: &Grid,
    heights: &[f64],
    plane: f64,
    contacts: &[Contact],
) -> GapField {
    let gaussians: Vec<GaussianLoad> = contacts
        .iter()
        .map(|contact| GaussianLoad::new(contact, grid))
        .collect();
    let mut displacement = gaussian_displacement(grid, &gaussians);
    let profile = profile();
    // Only few contacts affect a row; each row gathers them in order, so that sums do not depend on
    // threads.
    displacement
        .par_chunks_mut(grid.nx)
        .enumerate()
        .for_each(|(iy, row)| {
            for gaussian in &gaussians {
                gaussian.add_near(grid, iy, row, &profile);
            }
        });
    let mut gap: Vec<f64> = displacement
        .iter()
        .zip(heights)
        .map(|(u, h)| plane - h + u)
        .collect();
    let mut in_contact = vec![false; gap.len()];
    in_contact
        .par_chunks_mut(grid.nx)
        .enumerate()
        .for_each(|(iy, row)| {
            for gaussian in &gaussians {
                let radius = gaussian.contact.contact_radius;
                gaussian.each_within(grid, iy, radius, |ix, _| row[ix] = true);
            }
        });
    let overlaps = gap
        .iter()
        .zip(&in_contact)
        .filter(|(g, inside)| **g < 0.0 && !**inside);
    let overlapping = overlaps.count() as f64 / gap.len() as f64;
    for (gap, inside) in gap.iter_mut().zip(&in_contact) {
        *gap = if *inside { 0.0 } else { gap.max(0.0) };
    }
    GapField {
        gap,
        in_contact,
        overlapping,
    }
}

/// A contact, and the standard deviation of its Gaussian load on the grid, m.
struct GaussianLoad {
    contact: Contact,
    deviation: f64,
}

impl GaussianLoad {
    fn new(contact: &Contact, grid: &Grid) -> Self {
        let narrowest = NARROWEST * grid.dx().max(grid.dy());
        GaussianLoad {
            contact: *contact,
            // <r^2> of Hertz's pressure is (2/5) a^2, that of the Gaussian twice its variance.
            deviation: (contact.contact_radius / 5f64.sqrt()).max(narrowest),
        }
    }

    /// Calls `at` with each column of row `iy` within `reach` (m) of an image, and the distance.
    fn each_within(&self, grid: &Grid, iy: usize, reach: f64, mut at: impl FnMut(usize, f64)) {
        let (dx, dy) = (grid.dx(), grid.dy());
        let [x, y] = self.contact.asperity.position;
        // The nearest image of the contact to the row; the convolution includes all other images.
        let across = iy as f64 * dy - y;
        let across = across - grid.ly * (across / grid.ly).round();
        let half = reach * reach - across * across;
        if half <= 0.0 {
            return;
        }
        let half = half.sqrt().min(0.5 * grid.lx - 0.25 * dx);
        let first = ((x - half) / dx).ceil() as i64;
        let last = ((x + half) / dx).floor() as i64;
        for column in first..=last {
            let along = column as f64 * dx - x;
            at(
                column.rem_euclid(grid.nx as i64) as usize,
                along.hypot(across),
            );
        }
    }

    /// Adds the difference between Hertz's displacement and the Gaussian's to a row.
    fn add_near(&self, grid: &Grid, iy: usize, row: &mut [f64], profile: &[f64]) {
        let (contact, deviation) = (&self.contact, self.deviation);
        let unit = contact.load_over_modulus() / (PI * deviation);
        self.each_within(grid, iy, NEAR_REACH * deviation, |ix, distance| {
            let (hertz, _) = pair(contact.contact_radius, contact.asperity.radius, distance);
            let place = distance / deviation * (NODES as f64 / NEAR_REACH);
            let node = (place as usize).min(NODES - 1);
            let share = place - node as f64;
            let gaussian = profile[node] * (1.0 - share) + profile[node + 1] * share;
            row[ix] += hertz - unit * gaussian;
        });
    }
}

/// Displacement of all Gaussian loads over the modulus, m, by one convolution.
fn gaussian_displacement(grid: &Grid, gaussians: &[GaussianLoad]) -> Vec<f64> {
    let mut pressure = vec![0.0; grid.len()];
    pressure
        .par_chunks_mut(grid.nx)
        .enumerate()
        .for_each(|(iy, row)| {
            for gaussian in gaussians {
                let s = gaussian.deviation;
                let top = gaussian.contact.load_over_modulus() / (2.0 * PI * s * s);
                gaussian.each_within(grid, iy, GAUSSIAN_REACH * s, |ix, distance| {
                    row[ix] += top * (-0.5 * (distance / s).powi(2)).exp();
                });
            }
        });
    let mut columns = fourier::analyse(grid, &pressure);
    let stiffness = periodic_stiffness(grid, 1.0, None);
    let half = grid.ny / 2 + 1;
    for (kx, column) in columns.chunks_mut(grid.ny).enumerate() {
        for (ky, value) in column.iter_mut().enumerate() {
            let stiffness = stiffness[kx * half + ky.min(grid.ny - ky)];
            *value = if stiffness > 0.0 {
                *value / stiffness
            } else {
                Default::default()
            };
        }
    }
    fourier::synthesise(grid, columns)
}

/// `sqrt(pi/2) exp(-x) I_0(x)`, x = t^2/4, against t = distance/deviation from 0 to the near
/// cut-off: the displacement of a Gaussian load in units of load/(pi E* deviation).
fn profile() -> Vec<f64> {
    // The mean of a smooth periodic function over a full period: the trapezoid rule is exact to
    // rounding from about sixty nodes on.
    const TURN: usize = 96;
    (0..=NODES)
        .map(|node| {
            let t = NEAR_REACH * node as f64 / NODES as f64;
            let x = 0.25 * t * t;
            let mean = (0..TURN)
                .map(|i| {
                    let angle = 2.0 * PI * i as f64 / TURN as f64;
                    (-x * (1.0 - angle.cos())).exp()
                })
                .sum::<f64>()
                / TURN as f64;
            (0.5 * PI).sqrt() * mean
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::Asperity;
    use super::super::newton::displacement_by;
    use super::*;
    use crate::theory::icha::lattice::Lattice;

    /// Points on which the model overlaps outside its circles attracted by the whole peak of a law that pulls hardest at gap 0.
    #[test]
    fn what_overlaps_does_not_attract() {
        let field = GapField {
            gap: vec![0.0, 0.0, 2.0, 3.0],
            in_contact: vec![true, false, false, false],
            overlapping: 0.25,
        };
        let found = field.mean_outside(|gap| (-gap).exp());
        let sum = (-2_f64).exp() + (-3_f64).exp();
        assert!((found - sum / 4.0).abs() < 1e-15, "{found}");
    }

    /// The two-part field against the sum over contacts, images by the lattice's table: a contact
    /// below a pixel, one of ten pixels, and one of 40 across the edge of the cell.
    #[test]
    fn the_split_field_is_the_sum_over_contacts() {
        let grid = Grid::new([256, 192], [4.0, 3.0]);
        let contact = |x: f64, y: f64, contact_radius: f64| Contact {
            asperity: Asperity {
                position: [x, y],
                height: 0.0,
                radius: 1.0,
            },
            contact_radius,
        };
        let contacts = [
            contact(1.003, 1.004, 0.01),
            contact(2.51, 1.1, 0.08),
            contact(3.9, 2.95, 0.3),
        ];
        let lattice = Lattice::periodic([4.0, 3.0]);
        let deepest = contacts[2].indentation();
        let flat = vec![0.0; grid.len()];
        // The plane is so high that nothing is clipped.
        let field = gap_field(&grid, &flat, 1.0, &contacts);
        let mut worst: f64 = 0.0;
        for (i, gap) in field.gap.iter().enumerate() {
            if field.in_contact[i] {
                continue;
            }
            let at = [(i % 256) as f64 * grid.dx(), (i / 256) as f64 * grid.dy()];
            let sum: f64 = contacts
                .iter()
                .map(|c| displacement_by(c, at, &lattice).0)
                .sum();
            worst = worst.max((gap - 1.0 - sum).abs());
        }
        // The sum treats images as point loads, the field does not: a^2 load/(5 R E* A) everywhere
        // and half of that again where an image is nearest, R = 1.5 its distance: 7e-4 of the
        // deepest.
        assert!(worst < 1e-3 * deepest, "{:e}", worst / deepest);
        let area = field.in_contact.iter().filter(|c| **c).count() as f64 * grid.pixel_area();
        let circles: f64 = contacts.iter().map(Contact::area).sum();
        assert!((area / circles - 1.0).abs() < 0.02);
    }
}
