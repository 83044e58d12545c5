//! The gap that a set of contacts leaves over a whole height map.
//!
//! Each contact's displacement is split in two. On the grid it is that of a Gaussian cloud of the
//! same load, summed over all contacts and images by one convolution with the half-space's
//! operator. Near the contact the difference to Hertz's own displacement is added point by point. A
//! cloud as wide as the pixels allow has the second moment of Hertz's pressure, so that the
//! difference falls as r^-5; a wider one leaves r^-3. It is cut off at eight standard deviations,
//! where it is below 2e-3 of the contact's own displacement there.

use std::f64::consts::PI;

use rayon::prelude::*;

use super::Contact;
use super::pair::pair;
use crate::elastic::periodic_stiffness;
use crate::grid::Grid;
use crate::surface::fourier;

/// Least standard deviation of a cloud, pixels: its waves beyond the grid's are below 1e-5.
const NARROWEST: f64 = 1.6;
/// Standard deviations within which a cloud's load lies, to 1e-7.
const CLOUD_REACH: f64 = 5.5;
/// Standard deviations at which the near part is cut off.
const NEAR_REACH: f64 = 8.0;
/// Nodes of the cloud's displacement over the near part; linear interpolation is good to 1e-6.
const NODES: usize = 2048;

/// A gap field, and where it is contact.
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

    /// Mean over the cell of a `traction` of the gap, outside the circles: the force approach of DMT.
    pub fn mean_outside(&self, traction: impl Fn(f64) -> f64) -> f64 {
        let outside = self
            .gap
            .iter()
            .zip(&self.in_contact)
            .filter(|(_, inside)| !**inside);
        outside.map(|(&gap, _)| traction(gap)).sum::<f64>() / self.gap.len() as f64
    }
}

/// The gap under a plane at height `plane` (m).
pub(super) fn gap_field(
    grid: &Grid,
    heights: &[f64],
    plane: f64,
    contacts: &[Contact],
) -> GapField {
    let clouds: Vec<Cloud> = contacts
        .iter()
        .map(|contact| Cloud::of(contact, grid))
        .collect();
    let mut displacement = clouds_displacement(grid, &clouds);
    let profile = profile();
    // Contacts are few to a row; each row gathers those that reach it, so that sums do not depend on
    // threads.
    displacement
        .par_chunks_mut(grid.nx)
        .enumerate()
        .for_each(|(iy, row)| {
            for cloud in &clouds {
                cloud.add_near(grid, iy, row, &profile);
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
            for cloud in &clouds {
                let radius = cloud.contact.contact_radius;
                cloud.each_within(grid, iy, radius, |ix, _| row[ix] = true);
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

/// A contact and the standard deviation of the cloud that stands for it on the grid, m.
struct Cloud {
    contact: Contact,
    deviation: f64,
}

impl Cloud {
    fn of(contact: &Contact, grid: &Grid) -> Self {
        let narrowest = NARROWEST * grid.dx().max(grid.dy());
        Cloud {
            contact: *contact,
            // <r^2> of Hertz's pressure is (2/5) a^2, that of the cloud twice its variance.
            deviation: (contact.contact_radius / 5f64.sqrt()).max(narrowest),
        }
    }

    /// Calls `at` with each column of row `iy` within `reach` (m) of an image, and the distance.
    fn each_within(&self, grid: &Grid, iy: usize, reach: f64, mut at: impl FnMut(usize, f64)) {
        let (dx, dy) = (grid.dx(), grid.dy());
        let [x, y] = self.contact.asperity.position;
        // The nearest image of the contact to the row; images beyond it are the convolution's.
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

    /// Adds to a row what Hertz's displacement is more than the cloud's.
    fn add_near(&self, grid: &Grid, iy: usize, row: &mut [f64], profile: &[f64]) {
        let (contact, deviation) = (&self.contact, self.deviation);
        let unit = contact.load_over_modulus() / (PI * deviation);
        self.each_within(grid, iy, NEAR_REACH * deviation, |ix, distance| {
            let (hertz, _) = pair(contact.contact_radius, contact.asperity.radius, distance);
            let place = distance / deviation * (NODES as f64 / NEAR_REACH);
            let node = (place as usize).min(NODES - 1);
            let share = place - node as f64;
            let cloud = profile[node] * (1.0 - share) + profile[node + 1] * share;
            row[ix] += hertz - unit * cloud;
        });
    }
}

/// Displacement of all clouds over the modulus, m, by one convolution.
fn clouds_displacement(grid: &Grid, clouds: &[Cloud]) -> Vec<f64> {
    let mut pressure = vec![0.0; grid.len()];
    pressure
        .par_chunks_mut(grid.nx)
        .enumerate()
        .for_each(|(iy, row)| {
            for cloud in clouds {
                let s = cloud.deviation;
                let top = cloud.contact.load_over_modulus() / (2.0 * PI * s * s);
                cloud.each_within(grid, iy, CLOUD_REACH * s, |ix, distance| {
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

/// `sqrt(pi/2) exp(-x) I_0(x)`, x = t^2/4, over t = distance/deviation from 0 to the near reach:
/// the displacement of a Gaussian cloud in units of load/(pi E* deviation).
fn profile() -> Vec<f64> {
    // The mean over a full turn of a smooth periodic function: the trapezoid rule is exact to
    // rounding from some sixty nodes on.
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
    use super::super::newton::pushed_by;
    use super::*;
    use crate::theory::icha::lattice::Lattice;

    /// The split field against the sum over contacts, images by the lattice's table: a contact
    /// below a pixel, one of ten, and one of 40 across the edge of the cell.
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
        // A plane so high that nothing is clipped.
        let field = gap_field(&grid, &flat, 1.0, &contacts);
        let mut worst: f64 = 0.0;
        for (i, gap) in field.gap.iter().enumerate() {
            if field.in_contact[i] {
                continue;
            }
            let at = [(i % 256) as f64 * grid.dx(), (i / 256) as f64 * grid.dy()];
            let sum: f64 = contacts.iter().map(|c| pushed_by(c, at, &lattice).0).sum();
            worst = worst.max((gap - 1.0 - sum).abs());
        }
        // The sum takes images for point loads, the field does not: a^2 load/(5 R E* A) everywhere and
        // half of that again where an image is nearest, R = 1.5 its distance: 7e-4 of the deepest.
        assert!(worst < 1e-3 * deepest, "{:e}", worst / deepest);
        let area = field.in_contact.iter().filter(|c| **c).count() as f64 * grid.pixel_area();
        let circles: f64 = contacts.iter().map(Contact::area).sum();
        assert!((area / circles - 1.0).abs() < 0.02);
    }
}
