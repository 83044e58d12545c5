//! How overlapping contacts become one.

use super::lattice::Lattice;
use super::newton::{Care, Equilibrium, Hold, pushed_by, settle};
use super::{Asperity, Contact, check};
use crate::theory::TheoryError;
use crate::theory::error::positive;

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
    clusters_within(contacts, &Lattice::infinite())
}

pub(super) fn clusters_within(contacts: &[Contact], lattice: &Lattice) -> Vec<Vec<usize>> {
    let mut open: Vec<usize> = (0..contacts.len())
        .filter(|&i| contacts[i].contact_radius > 0.0)
        .collect();
    let mut clusters = Vec::new();
    while let Some(first) = open.first().copied() {
        open.remove(0);
        let mut cluster = vec![first];
        let mut next = 0;
        while let Some(&i) = cluster.get(next) {
            next += 1;
            let here = &contacts[i];
            open.retain(|&j| {
                let other = &contacts[j];
                let reach = here.contact_radius + other.contact_radius;
                let offset = lattice.offset(here.asperity.position, other.asperity.position);
                let overlaps = offset[0] * offset[0] + offset[1] * offset[1] < reach * reach;
                if overlaps {
                    cluster.push(j);
                }
                !overlaps
            });
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
    check(asperities, plane)?;
    let start = Equilibrium::undeformed(asperities, plane);
    let (asperities, settled) = settle_merged(
        asperities.to_vec(),
        &Lattice::infinite(),
        Hold::Plane,
        start,
        rule,
        Care::FULL,
    )?;
    Ok(settled.contacts(&asperities))
}

/// Settles and merges in turn until no two circles overlap; also says which asperities are left.
pub(super) fn settle_merged(
    mut asperities: Vec<Asperity>,
    lattice: &Lattice,
    hold: Hold,
    mut state: Equilibrium,
    rule: MergeRule,
    care: Care,
) -> Result<(Vec<Asperity>, Equilibrium), TheoryError> {
    loop {
        state = settle(&asperities, lattice, hold, state, care)?;
        let contacts = state.contacts(&asperities);
        let clusters = clusters_within(&contacts, lattice);
        if clusters.is_empty() {
            return Ok((asperities, state));
        }
        let mut gone = vec![false; contacts.len()];
        let mut fresh = Vec::new();
        for cluster in &clusters {
            let one = merged_cluster(&contacts, cluster, state.plane, lattice, rule)?;
            let centre = one.asperity.position;
            let square = one.contact_radius * one.contact_radius;
            for (i, contact) in contacts.iter().enumerate() {
                if contact.contact_radius == 0.0 {
                    let [x, y] = lattice.offset(centre, contact.asperity.position);
                    gone[i] |= x * x + y * y < square;
                }
            }
            cluster.iter().for_each(|&i| gone[i] = true);
            fresh.push(one);
        }
        let kept = contacts.iter().zip(&gone).filter(|(_, gone)| !**gone);
        let contacts: Vec<Contact> = kept.map(|(contact, _)| *contact).chain(fresh).collect();
        asperities = contacts.iter().map(|contact| contact.asperity).collect();
        state.indentations = contacts.iter().map(Contact::indentation).collect();
    }
}

/// The contact in place of the cluster at places `members`, in balance with all others.
fn merged_cluster(
    contacts: &[Contact],
    members: &[usize],
    plane: f64,
    lattice: &Lattice,
    rule: MergeRule,
) -> Result<Contact, TheoryError> {
    // Side by side, also where the cluster reaches over the edge of the cell.
    let first = contacts[members[0]].asperity.position;
    let together: Vec<Contact> = members
        .iter()
        .map(|&i| {
            let offset = lattice.offset(first, contacts[i].asperity.position);
            let position = [first[0] + offset[0], first[1] + offset[1]];
            Contact {
                asperity: Asperity {
                    position,
                    ..contacts[i].asperity
                },
                ..contacts[i]
            }
        })
        .collect();
    let others = |position: [f64; 2]| -> f64 {
        contacts
            .iter()
            .enumerate()
            .filter(|(j, other)| other.contact_radius > 0.0 && !members.contains(j))
            .map(|(_, other)| pushed_by(other, position, lattice).0)
            .sum()
    };
    let mut one = merged(&together, plane, others, rule)?;
    one.asperity.height += lattice.rest([0.0, 0.0]) * one.load_over_modulus();
    one.asperity.position = lattice.wrapped(one.asperity.position);
    Ok(one)
}
