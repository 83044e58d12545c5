//! Merges overlapping contacts.

use std::collections::BTreeMap;

use super::lattice::Lattice;
use super::newton::{Equilibrium, Prescribed, Tolerances, displacement_by, solve_equilibrium};
use super::set::{Set, retain_unmarked};
use super::{Asperity, Contact, check};
use crate::theory::TheoryError;
use crate::theory::error::positive;

/// Logarithm of the ratio of loads below which asperities that do not converge are abandoned.
const LEAST_STEP: f64 = 5e-4;
/// Most solves per asperity: each merger removes one, and between two mergers a load is approached
/// by bisection down to the least step.
const MOST_SETTLES: usize = 100;

/// What is conserved when overlapping contacts merge, besides their area.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum MergeRule {
    /// The volume of their caps.
    Volume,
    /// The volume that they displace under their circles, including their interaction.
    DisplacedVolume,
    /// Their load.
    Load,
}

/// One contact in place of several, with their area and their cap volume, displaced volume or load,
/// at the centroid of the caps; `others` (m) is the displacement there by contacts that are not
/// merged.
///
/// The sources define area and centroid only; `docs/dmt_study.md` compares the conserved volumes.
pub(super) fn merged(
    cluster: &[Contact],
    plane: f64,
    others: impl Fn([f64; 2]) -> f64,
    rule: MergeRule,
) -> Result<Contact, TheoryError> {
    let square: f64 = cluster.iter().map(|c| c.contact_radius.powi(2)).sum();
    let power = match rule {
        MergeRule::Volume | MergeRule::DisplacedVolume => 4,
        MergeRule::Load => 3,
    };
    let kept: f64 = cluster
        .iter()
        .map(|c| c.contact_radius.powi(power) / c.asperity.radius)
        .sum();
    let lift = if rule == MergeRule::DisplacedVolume {
        lift(cluster)
    } else {
        0.0
    };
    let contact_radius = positive("contact radius of the cluster", square.sqrt())?;
    let radius = contact_radius.powi(power) / (kept + lift);
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

/// Interaction of the members, as `a^4/R`, m^3: under its circle a contact displaces `3/4 pi
/// a^4/R`, and each of the others U more over its area.
fn lift(cluster: &[Contact]) -> f64 {
    let mut sum = 0.0;
    for (i, one) in cluster.iter().enumerate() {
        for (j, other) in cluster.iter().enumerate() {
            if i != j {
                let pushed = displacement_by(other, one.asperity.position, &Lattice::infinite()).0;
                sum += 4.0 / 3.0 * one.contact_radius.powi(2) * pushed;
            }
        }
    }
    sum
}

/// Connected components of `count` elements joined in pairs, without single elements.
fn connected(count: usize, pairs: &[[usize; 2]]) -> Vec<Vec<usize>> {
    fn root(parents: &mut [usize], mut i: usize) -> usize {
        // A parent is never above its child, so the way to the root falls.
        while parents[i] != i {
            parents[i] = parents[parents[i]];
            i = parents[i];
        }
        i
    }
    let mut parents: Vec<usize> = (0..count).collect();
    for &[i, j] in pairs {
        let (one, other) = (root(&mut parents, i), root(&mut parents, j));
        parents[one.max(other)] = one.min(other);
    }
    let mut members: Vec<usize> = pairs.iter().flatten().copied().collect();
    members.sort_unstable();
    members.dedup();
    let mut parts: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for member in members {
        parts
            .entry(root(&mut parents, member))
            .or_default()
            .push(member);
    }
    parts.into_values().collect()
}

/// Contacts with a plane, merged until no two circles overlap. Summits without load inside a merged
/// circle are removed.
pub fn merged_contacts(
    asperities: &[Asperity],
    plane: f64,
    rule: MergeRule,
) -> Result<Vec<Contact>, TheoryError> {
    check(asperities, plane)?;
    let lattice = Lattice::infinite();
    let set = Set::new(asperities.to_vec(), &lattice);
    let start = Equilibrium::undeformed(asperities, plane);
    let (set, settled) = solve_with_merging(
        set,
        &lattice,
        Prescribed::Plane,
        start,
        rule,
        Tolerances::FULL,
    )?;
    Ok(settled.contacts(&set.asperities))
}

/// Solves and merges alternately until no two circles overlap; also returns the remaining
/// asperities.
pub(super) fn solve_with_merging(
    mut set: Set,
    lattice: &Lattice,
    hold: Prescribed,
    mut state: Equilibrium,
    rule: MergeRule,
    care: Tolerances,
) -> Result<(Set, Equilibrium), TheoryError> {
    let mut held = hold;
    for _ in 0..MOST_SETTLES * (set.asperities.len() + 1) {
        let settled = match solve_equilibrium(&set, lattice, held, state.clone(), care) {
            Ok(settled) => settled,
            Err(failed) => {
                held = nearer(held, &state, &set).ok_or(failed)?;
                continue;
            }
        };
        state = settled.state;
        if settled.meeting.is_empty() {
            if held == hold {
                return Ok((set, state));
            }
            held = hold;
            continue;
        }
        held = hold;
        let contacts = state.contacts(&set.asperities);
        let mut gone = vec![false; contacts.len()];
        let mut fresh = Vec::new();
        for cluster in connected(contacts.len(), &settled.meeting) {
            let one = merged_cluster(&contacts, &cluster, state.plane, lattice, rule)?;
            let centre = one.asperity.position;
            let square = one.contact_radius * one.contact_radius;
            for (i, contact) in contacts.iter().enumerate() {
                if contact.contact_radius == 0.0 {
                    let [x, y] = lattice.offset(centre, contact.asperity.position);
                    gone[i] |= x * x + y * y < square;
                }
            }
            cluster.iter().for_each(|&i| gone[i] = true);
            let lowered: f64 = cluster.iter().map(|&i| state.lowered[i]).sum();
            fresh.push((one, lowered / cluster.len() as f64));
        }
        set.remove_marked(&gone);
        retain_unmarked(&mut state.indentations, &gone);
        retain_unmarked(&mut state.lowered, &gone);
        for (one, lowered) in fresh {
            state.indentations.push(one.indentation());
            state.lowered.push(lowered);
            set.push(one.asperity, lattice);
        }
    }
    Err(TheoryError::NotConverged {
        what: "the merging of asperities",
    })
}

/// A load between the one that was too far and the one that the asperities carry now: many
/// simultaneous mergers reduce the load by a quarter. `None` if the two are equal.
fn nearer(held: Prescribed, state: &Equilibrium, set: &Set) -> Option<Prescribed> {
    let Prescribed::Load(asked) = held else {
        return None;
    };
    let contacts = state.contacts(&set.asperities);
    let carried: f64 = contacts.iter().map(Contact::load_over_modulus).sum();
    let far = (asked / carried).ln().abs();
    (far > LEAST_STEP && far.is_finite()).then(|| Prescribed::Load((asked * carried).sqrt()))
}

/// The contact that replaces the cluster `members`, in equilibrium with all others.
fn merged_cluster(
    contacts: &[Contact],
    members: &[usize],
    plane: f64,
    lattice: &Lattice,
    rule: MergeRule,
) -> Result<Contact, TheoryError> {
    // Positions relative to one member, also if the cluster crosses the edge of the cell.
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
            .map(|(_, other)| displacement_by(other, position, lattice).0)
            .sum()
    };
    let mut one = merged(&together, plane, others, rule)?;
    one.asperity.height += lattice.rest([0.0, 0.0]) * one.load_over_modulus();
    one.asperity.position = lattice.wrapped(one.asperity.position);
    Ok(one)
}
