//! Equilibrium of a given set of asperities: Newton's method on those in contact, which may leave
//! and enter. The sum over the neighbours can exceed the diagonal, so that single passes over them
//! would not settle.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::gmres;
use super::lattice::Lattice;
use super::pair::pair;
use super::{Asperity, Contact};
use crate::theory::TheoryError;

const MAX_ROUNDS: usize = 40;
/// Rounds after which steps are halved, should the contacts that enter and leave alternate.
const PATIENCE: usize = 20;
/// Most slope of one asperity's displacement by another's indentation. Two circles that cover each
/// other's summits press on the same place, and slopes of 1 would leave open which of them carries
/// how much; less than 1 lets the lower one leave.
const STEEPEST: f64 = 0.9;
/// Misfit over the largest indentation at which circles that cover each other may be handed back to
/// be merged: two such contacts are in balance for no share of the load, or for any.
const NEAR: f64 = 0.05;
/// Load over the load asked at which a start was too far off.
const ASTRAY: f64 = 4.0;
/// Misfit of the total load over the load asked, in misfits of an indentation over the largest one.
const LOAD_TOLERANCE: f64 = 10.0;
/// Residual of a Newton system over its right side; the next round makes good for it.
const LINEAR_TOLERANCE: f64 = 1e-4;

/// What is held while the asperities settle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Hold {
    /// The plane stays where the start has it.
    Plane,
    /// The sum of all loads over the modulus, m^2; the plane moves.
    Load(f64),
}

/// How well a set of asperities is to be settled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Care {
    /// Misfit of an indentation over the largest one.
    pub tolerance: f64,
    /// Rounds after which circles that cover each other are handed back to be merged, as they are.
    pub rounds_before_merging: usize,
}

impl Care {
    /// To the last digit.
    pub const FULL: Care = Care {
        tolerance: 1e-11,
        rounds_before_merging: 7,
    };
    /// At a load that is asked for.
    pub const FINAL: Care = Care {
        tolerance: 1e-7,
        rounds_before_merging: 4,
    };
    /// On the way to a load, where more merging and pressing follows.
    pub const PASSING: Care = Care {
        tolerance: 1e-3,
        rounds_before_merging: 3,
    };
}

/// A plane and how deep each asperity is indented.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Equilibrium {
    /// Height of the plane, m, over that of which the displacement has no mean where the cell repeats.
    pub plane: f64,
    /// Hertz indentation of each asperity, m; 0 out of contact.
    pub indentations: Vec<f64>,
}

impl Equilibrium {
    /// A guess for a plane that nothing has moved yet.
    pub fn undeformed(asperities: &[Asperity], plane: f64) -> Self {
        let half = |asperity: &Asperity| 0.5 * (asperity.height - plane).max(0.0);
        Equilibrium {
            plane,
            indentations: asperities.iter().map(half).collect(),
        }
    }

    /// Every asperity with its contact, if any.
    pub fn contacts(&self, asperities: &[Asperity]) -> Vec<Contact> {
        let contact = |(asperity, delta): (&Asperity, &f64)| Contact {
            asperity: *asperity,
            contact_radius: (asperity.radius * delta).sqrt(),
        };
        asperities
            .iter()
            .zip(&self.indentations)
            .map(contact)
            .collect()
    }
}

/// An asperity that may be in contact: its misfit, and how it feels each contact if it is.
struct Row {
    index: usize,
    /// Indentation and displacement by the others less the overlap, m.
    misfit: f64,
    /// Slope of that displacement by each contact's indentation; `None` out of contact.
    slopes: Option<Vec<f64>>,
}

/// Displacement at `position` by one contact, its images included, and its slope.
pub(super) fn pushed_by(contact: &Contact, position: [f64; 2], lattice: &Lattice) -> (f64, f64) {
    let offset = lattice.offset(contact.asperity.position, position);
    let distance = offset[0].hypot(offset[1]);
    let (u, slope) = pair(contact.contact_radius, contact.asperity.radius, distance);
    if !lattice.is_periodic() {
        return (u, slope);
    }
    let rest = lattice.rest(offset);
    (
        u + rest * contact.load_over_modulus(),
        slope + rest * 2.0 * contact.contact_radius,
    )
}

/// Whether some circle reaches over another one's summit.
fn any_covered(contacts: &[Contact], touching: &[usize], lattice: &Lattice) -> bool {
    touching.iter().enumerate().any(|(place, &i)| {
        touching[..place].iter().any(|&j| {
            let (one, other) = (&contacts[i], &contacts[j]);
            let [x, y] = lattice.offset(one.asperity.position, other.asperity.position);
            let reach = one.contact_radius.max(other.contact_radius);
            x * x + y * y < reach * reach
        })
    })
}

/// Brings a start to equilibrium. Where circles cover each other's summits, so that it cannot
/// settle, it may be handed back as it is: such circles are to be merged.
pub(super) fn settle(
    asperities: &[Asperity],
    lattice: &Lattice,
    hold: Hold,
    start: Equilibrium,
    care: Care,
) -> Result<Equilibrium, TheoryError> {
    let failed = TheoryError::NotConverged {
        what: "the set of asperities",
    };
    let own_images = lattice.rest([0.0, 0.0]);
    let mut state = start;
    for round in 0..MAX_ROUNDS {
        let contacts = state.contacts(asperities);
        let touching: Vec<usize> = (0..contacts.len())
            .filter(|&i| contacts[i].contact_radius > 0.0)
            .collect();
        let load: f64 = touching
            .iter()
            .map(|&i| contacts[i].load_over_modulus())
            .sum();
        // No lower summit can touch: nowhere is the surface lifted by more.
        let floor = state.plane + load * lattice.least;
        let rows: Vec<Row> = (0..asperities.len())
            .into_par_iter()
            .filter(|&i| asperities[i].height > floor || state.indentations[i] > 0.0)
            .map(|i| {
                let mut pushed = 0.0;
                let mut slopes = Vec::with_capacity(touching.len());
                for &j in &touching {
                    let contact = &contacts[j];
                    let (u, slope) = if i == j {
                        let load = contact.load_over_modulus();
                        (own_images * load, own_images * 2.0 * contact.contact_radius)
                    } else {
                        pushed_by(contact, asperities[i].position, lattice)
                    };
                    pushed += u;
                    slopes.push(slope.min(STEEPEST));
                }
                let overlap = asperities[i].height - state.plane;
                let misfit = state.indentations[i] + pushed - overlap;
                Row {
                    index: i,
                    misfit,
                    slopes: (state.indentations[i] > misfit).then_some(slopes),
                }
            })
            .collect();
        let deepest = state
            .indentations
            .iter()
            .fold(0.0_f64, |most, &d| most.max(d));
        let tolerance = care.tolerance * deepest;
        let settled = rows.iter().all(|row| {
            row.misfit.abs() <= tolerance
                || state.indentations[row.index] == 0.0 && row.misfit > 0.0
        });
        let load_met = match hold {
            Hold::Plane => true,
            Hold::Load(asked) => (load - asked).abs() <= LOAD_TOLERANCE * care.tolerance * asked,
        };
        if settled && load_met {
            return Ok(state);
        }
        if matches!(hold, Hold::Load(asked) if load > ASTRAY * asked) {
            return Err(failed);
        }
        let near = rows.iter().all(|row| {
            row.misfit.abs() <= NEAR * deepest
                || state.indentations[row.index] == 0.0 && row.misfit > 0.0
        });
        let patient = round < care.rounds_before_merging;
        if !patient && near && any_covered(&contacts, &touching, lattice) {
            return Ok(state);
        }
        let active: Vec<&Row> = rows.iter().filter(|row| row.slopes.is_some()).collect();
        let is_active = |i: usize| active.binary_search_by_key(&i, |row| row.index).ok();
        // Those that leave take their displacement with them at once.
        let leaving: Vec<usize> = touching
            .iter()
            .copied()
            .filter(|&i| is_active(i).is_none())
            .collect();
        let right = DVector::from_iterator(
            active.len(),
            active.iter().map(|row| {
                let position = asperities[row.index].position;
                let freed: f64 = leaving
                    .iter()
                    .map(|&j| pushed_by(&contacts[j], position, lattice).0)
                    .sum();
                freed - row.misfit
            }),
        );
        // One column an active row, so that a product walks along memory.
        let place: Vec<Option<usize>> = touching.iter().map(|&j| is_active(j)).collect();
        let slopes = DMatrix::from_iterator(
            touching.len(),
            active.len(),
            active
                .iter()
                .flat_map(|row| row.slopes.iter().flatten().copied()),
        );
        let apply = |x: &DVector<f64>| {
            let felt = DVector::from_iterator(
                touching.len(),
                place.iter().map(|place| place.map_or(0.0, |row| x[row])),
            );
            x + slopes.tr_mul(&felt)
        };
        let own = gmres::solve(apply, &right, LINEAR_TOLERANCE).ok_or(failed.clone())?;
        let (steps, moved) = match hold {
            Hold::Plane => (own, 0.0),
            Hold::Load(asked) => {
                let ones = DVector::from_element(active.len(), 1.0);
                let lifted = gmres::solve(apply, &ones, LINEAR_TOLERANCE).ok_or(failed.clone())?;
                let stiffness = DVector::from_iterator(
                    active.len(),
                    active
                        .iter()
                        .map(|row| 2.0 * contacts[row.index].contact_radius),
                );
                let stays: f64 = active
                    .iter()
                    .map(|row| contacts[row.index].load_over_modulus())
                    .sum();
                let moved = (stiffness.dot(&own) - (asked - stays)) / stiffness.dot(&lifted);
                if !moved.is_finite() {
                    return Err(failed);
                }
                (own - lifted * moved, moved)
            }
        };
        let share = if round < PATIENCE { 1.0 } else { 0.5 };
        let mut next = vec![0.0; asperities.len()];
        for (row, step) in active.iter().zip(steps.iter()) {
            next[row.index] = (state.indentations[row.index] + share * step).max(0.0);
        }
        state = Equilibrium {
            plane: state.plane + share * moved,
            indentations: next,
        };
    }
    Err(failed)
}
