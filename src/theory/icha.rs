//! Hertz asperities that push each other down, and how overlapping ones become one: Afferrante,
//! Carbone & Demelio 2012, with the sums corrected.
//!
//! Only the step of a given set of asperities on an infinite half-space. Detection on a height
//! map and the sequence of merges along a load curve are not here.

use super::error::{TheoryError, finite, positive};
use super::hertz::displacement_of;
use nalgebra::{DMatrix, DVector};
use std::f64::consts::PI;

const MAX_ROUNDS: usize = 200;

/// A paraboloid of the rough surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Asperity {
    /// Place of its summit, m.
    pub position: [f64; 2],
    /// Height of its summit, m.
    pub height: f64,
    /// Radius of curvature, m.
    pub radius: f64,
}

/// An asperity and its contact; the radius is 0 without contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// The asperity.
    pub asperity: Asperity,
    /// Contact radius, m.
    pub contact_radius: f64,
}

impl Contact {
    /// Its Hertz indentation `a^2/R`, m.
    pub fn indentation(&self) -> f64 {
        self.contact_radius * self.contact_radius / self.asperity.radius
    }

    /// Its load over the contact modulus, m^2: `(4/3) a^3/R`.
    pub fn load_over_modulus(&self) -> f64 {
        4.0 / 3.0 * self.contact_radius * self.indentation()
    }

    /// Its area, m^2.
    pub fn area(&self) -> f64 {
        PI * self.contact_radius * self.contact_radius
    }

    /// Volume of the cap cut off at the contact, `pi a^4/(4 R)`, m^3.
    fn volume(&self) -> f64 {
        0.25 * PI * self.contact_radius.powi(4) / self.asperity.radius
    }

    fn displacement_at(&self, position: [f64; 2]) -> f64 {
        displacement_of(
            self.asperity.radius,
            self.contact_radius,
            distance(self.asperity.position, position),
        )
    }
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Contacts of all asperities with a plane at height `plane` (m), each pressed down by the others:
/// `delta_i + sum_j U(r_ij; a_j, R_j) = z_i - plane` where in contact.
///
/// Newton's method on the asperities in contact, which may leave and enter; the sum over the
/// neighbours can exceed the diagonal, so that single passes over them would not settle.
pub fn contacts(asperities: &[Asperity], plane: f64) -> Result<Vec<Contact>, TheoryError> {
    finite("plane", plane)?;
    for asperity in asperities {
        positive("radius", asperity.radius)?;
        finite("height", asperity.height)?;
        finite("position", asperity.position[0] + asperity.position[1])?;
    }
    let overlap: Vec<f64> = asperities.iter().map(|a| a.height - plane).collect();
    let largest = overlap.iter().fold(0.0_f64, |most, &o| most.max(o));
    let mut indentations: Vec<f64> = overlap.iter().map(|o| 0.5 * o.max(0.0)).collect();
    let with = |indentations: &[f64]| -> Vec<Contact> {
        asperities
            .iter()
            .zip(indentations)
            .map(|(asperity, delta)| Contact {
                asperity: *asperity,
                contact_radius: (asperity.radius * delta).sqrt(),
            })
            .collect()
    };
    for _ in 0..MAX_ROUNDS {
        let contacts = with(&indentations);
        let misses: Vec<f64> = (0..contacts.len())
            .map(|i| {
                let pressed: f64 = contacts
                    .iter()
                    .enumerate()
                    .filter(|(j, other)| *j != i && other.contact_radius > 0.0)
                    .map(|(_, other)| other.displacement_at(asperities[i].position))
                    .sum();
                indentations[i] + pressed - overlap[i]
            })
            .collect();
        let tolerance = 1e-12 * largest;
        let settled = (0..contacts.len())
            .all(|i| misses[i].abs() <= tolerance || indentations[i] == 0.0 && misses[i] > 0.0);
        if settled {
            return Ok(contacts);
        }
        let active: Vec<usize> = (0..contacts.len())
            .filter(|&i| indentations[i] > misses[i])
            .collect();
        // dU/d delta = (2/pi) asin(min(1, a/r)).
        let slopes = DMatrix::from_fn(active.len(), active.len(), |row, column| {
            let (i, j) = (active[row], active[column]);
            if i == j {
                1.0
            } else {
                let r = distance(asperities[i].position, asperities[j].position);
                2.0 / PI * (contacts[j].contact_radius / r).min(1.0).asin()
            }
        });
        // Those that leave take their displacement with them at once.
        let mut right = DVector::from_iterator(active.len(), active.iter().map(|&i| -misses[i]));
        for (row, &i) in active.iter().enumerate() {
            for j in (0..contacts.len()).filter(|j| !active.contains(j)) {
                if contacts[j].contact_radius > 0.0 {
                    right[row] += contacts[j].displacement_at(asperities[i].position);
                }
            }
        }
        let steps = slopes.lu().solve(&right).ok_or(TheoryError::NotConverged {
            what: "the set of asperities",
        })?;
        let mut next = vec![0.0; contacts.len()];
        for (row, &i) in active.iter().enumerate() {
            next[i] = (indentations[i] + steps[row]).max(0.0);
        }
        indentations = next;
    }
    Err(TheoryError::NotConverged {
        what: "the set of asperities",
    })
}

/// What is kept as overlapping contacts become one, besides their area.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MergeRule {
    /// The volume of their caps.
    Volume,
    /// Their load.
    Load,
}

/// One contact in place of several: their area, and their cap volume or load, at the centroid of
/// the caps; `others` (m) is the displacement there by contacts that are not merged.
///
/// The sources fix area and centroid only; of the two rules the volume is nearer to full fields.
pub fn merged(
    cluster: &[Contact],
    plane: f64,
    others: impl Fn([f64; 2]) -> f64,
    rule: MergeRule,
) -> Result<Contact, TheoryError> {
    let square: f64 = cluster.iter().map(|c| c.contact_radius.powi(2)).sum();
    let power = match rule {
        MergeRule::Volume => 4,
        MergeRule::Load => 3,
    };
    let kept: f64 = cluster
        .iter()
        .map(|c| c.contact_radius.powi(power) / c.asperity.radius)
        .sum();
    let contact_radius = positive("contact radius of the cluster", square.sqrt())?;
    let radius = contact_radius.powi(power) / kept;
    let volume: f64 = cluster.iter().map(Contact::volume).sum();
    let centroid = [0, 1].map(|axis| {
        let sum: f64 = cluster
            .iter()
            .map(|c| c.volume() * c.asperity.position[axis])
            .sum();
        sum / volume
    });
    Ok(Contact {
        asperity: Asperity {
            position: centroid,
            height: plane + contact_radius * contact_radius / radius + others(centroid),
            radius,
        },
        contact_radius,
    })
}

/// Clusters of contacts whose circles overlap, as lists of places in `contacts`, those of a
/// single contact left out.
pub fn clusters(contacts: &[Contact]) -> Vec<Vec<usize>> {
    let mut seen = vec![false; contacts.len()];
    let mut clusters = Vec::new();
    for first in 0..contacts.len() {
        if seen[first] || contacts[first].contact_radius == 0.0 {
            continue;
        }
        seen[first] = true;
        let mut cluster = vec![first];
        let mut next = 0;
        while let Some(&i) = cluster.get(next) {
            next += 1;
            for (j, other) in contacts.iter().enumerate() {
                let reach = contacts[i].contact_radius + other.contact_radius;
                let apart = distance(contacts[i].asperity.position, other.asperity.position);
                if !seen[j] && other.contact_radius > 0.0 && apart < reach {
                    seen[j] = true;
                    cluster.push(j);
                }
            }
        }
        if cluster.len() > 1 {
            clusters.push(cluster);
        }
    }
    clusters
}

/// Contacts with a plane, merged until no two circles overlap. Summits inside a merged circle
/// that carried nothing are dropped.
pub fn merged_contacts(
    asperities: &[Asperity],
    plane: f64,
    rule: MergeRule,
) -> Result<Vec<Contact>, TheoryError> {
    let mut asperities = asperities.to_vec();
    loop {
        let contacts = contacts(&asperities, plane)?;
        let clusters = clusters(&contacts);
        if clusters.is_empty() {
            return Ok(contacts);
        }
        let mut gone = vec![false; contacts.len()];
        let mut fresh = Vec::new();
        for cluster in &clusters {
            let members: Vec<Contact> = cluster.iter().map(|&i| contacts[i]).collect();
            let others = |position: [f64; 2]| -> f64 {
                contacts
                    .iter()
                    .enumerate()
                    .filter(|(j, other)| !cluster.contains(j) && other.contact_radius > 0.0)
                    .map(|(_, other)| other.displacement_at(position))
                    .sum()
            };
            let one = merged(&members, plane, others, rule)?;
            for (i, contact) in contacts.iter().enumerate() {
                let inside =
                    distance(contact.asperity.position, one.asperity.position) < one.contact_radius;
                if cluster.contains(&i) || contact.contact_radius == 0.0 && inside {
                    gone[i] = true;
                }
            }
            fresh.push(one.asperity);
        }
        let kept = asperities.iter().zip(&gone).filter(|(_, gone)| !**gone);
        asperities = kept.map(|(asperity, _)| *asperity).chain(fresh).collect();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_low_neighbour_is_pushed_out_of_contact() {
        let high = Asperity {
            position: [0.0, 0.0],
            height: 0.0,
            radius: 1.0,
        };
        let low = Asperity {
            position: [0.2, 0.0],
            height: -0.018,
            radius: 1.0,
        };
        let both = contacts(&[high, low], -0.02).unwrap();
        assert!((both[0].indentation() - 0.02).abs() < 1e-14);
        assert_eq!(both[1].contact_radius, 0.0);
        assert!(
            contacts(
                &[Asperity {
                    radius: 0.0,
                    ..high
                }],
                0.0
            )
            .is_err()
        );
    }

    #[test]
    fn merging_keeps_area_and_load_if_told_so() {
        let at = |x: f64, radius: f64| Asperity {
            position: [x, 0.0],
            height: 0.0,
            radius,
        };
        let before = contacts(&[at(0.0, 1.0), at(0.15, 2.0)], -0.02).unwrap();
        let one = merged(&before, -0.02, |_| 0.0, MergeRule::Load).unwrap();
        let sum = |of: fn(&Contact) -> f64| before.iter().map(of).sum::<f64>();
        assert!((one.area() / sum(Contact::area) - 1.0).abs() < 1e-13);
        let load = sum(Contact::load_over_modulus);
        assert!((one.load_over_modulus() / load - 1.0).abs() < 1e-13);
    }
}
