//! Equilibrium of a given set of asperities: Newton's method on those in contact, which may leave
//! and enter. The sum over the neighbours can exceed the diagonal, so that single passes over them
//! would not settle.

use nalgebra::DVector;

use super::gmres;
use super::lattice::Lattice;
use super::near::Field;
use super::pair::pair;
use super::set::Set;
use super::{Asperity, Contact};
use crate::theory::TheoryError;

const MAX_ROUNDS: usize = 60;
/// Rounds after which steps are halved, should the contacts that enter and leave alternate.
const PATIENCE: usize = 30;
/// Misfit over the largest indentation at which circles that cover each other may be handed back to
/// be merged: two such contacts are in balance for no share of the load, or for any.
const NEAR: f64 = 0.05;
/// Load over the load asked at which a start was too far off.
const ASTRAY: f64 = 4.0;
/// Misfit of the total load over the load asked, in misfits of an indentation over the largest one.
const LOAD_TOLERANCE: f64 = 10.0;
/// Residual of the system of what a lowered plane does; it moves little, and the next round makes good
/// for it.
const LOWERED_TOLERANCE: f64 = 3e-2;

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
    /// The same at which overlapping circles are handed back to be merged.
    pub merging: f64,
    /// Residual of a Newton system over its right side; the next round makes good for it.
    pub linear: f64,
    /// Rounds after which circles that cover each other are handed back to be merged, as they are.
    pub rounds_before_merging: usize,
    /// Which contacts are handed back.
    pub merges: Merges,
}

/// Contacts that are to become one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Merges {
    /// Whose circles overlap.
    Overlapping,
    /// Of which one reaches over the other's summit.
    Covering,
}

impl Care {
    /// The same for contacts that cover each other.
    pub fn of_covering(self) -> Care {
        Care {
            merges: Merges::Covering,
            ..self
        }
    }

    /// To the last digit.
    pub const FULL: Care = Care {
        tolerance: 1e-11,
        merging: 1e-11,
        linear: 1e-4,
        rounds_before_merging: 7,
        merges: Merges::Overlapping,
    };
    /// At a load that is asked for.
    pub const FINAL: Care = Care {
        tolerance: 1e-6,
        merging: 2e-2,
        linear: 3e-2,
        rounds_before_merging: 4,
        merges: Merges::Overlapping,
    };
    /// On the way to a load, where more merging and pressing follows.
    pub const PASSING: Care = Care {
        tolerance: 1e-2,
        merging: 2e-2,
        linear: 3e-2,
        rounds_before_merging: 3,
        merges: Merges::Overlapping,
    };
}

/// A plane and how deep each asperity is indented.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Equilibrium {
    /// Height of the plane, m, over that of which the displacement has no mean where the cell repeats.
    pub plane: f64,
    /// Hertz indentation of each asperity, m; 0 out of contact.
    pub indentations: Vec<f64>,
    /// How much each of them grows as the plane goes down by 1; a guess.
    pub lowered: Vec<f64>,
}

impl Equilibrium {
    /// A guess for a plane that nothing has moved yet.
    pub fn undeformed(asperities: &[Asperity], plane: f64) -> Self {
        let half = |asperity: &Asperity| 0.5 * (asperity.height - plane).max(0.0);
        Equilibrium {
            plane,
            indentations: asperities.iter().map(half).collect(),
            lowered: vec![0.0; asperities.len()],
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

/// An equilibrium, or one near enough to merge the circles that overlap.
pub(super) struct Settled {
    /// The state.
    pub state: Equilibrium,
    /// Asperities that are to become one, two and two.
    pub meeting: Vec<[usize; 2]>,
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

/// Brings a start to equilibrium, or so near to it that what overlaps can be merged. Where circles
/// cover each other's summits, so that it cannot settle, it may be handed back as it is: such circles
/// are to be merged.
pub(super) fn settle(
    set: &Set,
    lattice: &Lattice,
    hold: Hold,
    start: Equilibrium,
    care: Care,
) -> Result<Settled, TheoryError> {
    let failed = TheoryError::NotConverged {
        what: "the set of asperities",
    };
    let asperities = &set.asperities;
    let mut state = start;
    for round in 0..MAX_ROUNDS {
        let contacts = state.contacts(asperities);
        let load: f64 = contacts.iter().map(Contact::load_over_modulus).sum();
        if matches!(hold, Hold::Load(asked) if load > ASTRAY * asked) {
            return Err(failed);
        }
        // No lower summit can touch: nowhere is the surface lifted by more.
        let floor = state.plane + load * lattice.least;
        let rows: Vec<usize> = (0..asperities.len())
            .filter(|&i| asperities[i].height > floor || state.indentations[i] > 0.0)
            .collect();
        let field = Field::new(&contacts, &rows, lattice, &set.stencils);
        let pushed = field.displacement(|_| true);
        let misfits: Vec<f64> = rows
            .iter()
            .zip(&pushed)
            .map(|(&i, pushed)| {
                state.indentations[i] + pushed - (asperities[i].height - state.plane)
            })
            .collect();
        let deepest = state
            .indentations
            .iter()
            .fold(0.0_f64, |most, &d| most.max(d));
        let worst = rows
            .iter()
            .zip(&misfits)
            .filter(|(i, misfit)| state.indentations[**i] > 0.0 || **misfit < 0.0)
            .fold(0.0_f64, |most, (_, misfit)| most.max(misfit.abs()));
        let off = match hold {
            Hold::Plane => 0.0,
            Hold::Load(asked) => (load / asked - 1.0).abs() / LOAD_TOLERANCE,
        };
        let settles = |tolerance: f64| worst <= tolerance * deepest && off <= tolerance;
        let meeting = match care.merges {
            Merges::Overlapping => &field.overlapping,
            Merges::Covering => &field.covering,
        };
        let impatient = round >= care.rounds_before_merging;
        if settles(care.tolerance)
            || !meeting.is_empty() && round > 0 && settles(care.merging)
            || !field.covering.is_empty() && impatient && worst <= NEAR * deepest
        {
            return Ok(Settled {
                meeting: meeting.clone(),
                state,
            });
        }
        let active: Vec<usize> = (0..rows.len())
            .filter(|&row| state.indentations[rows[row]] > misfits[row])
            .collect();
        let mut stays = vec![false; asperities.len()];
        active.iter().for_each(|&row| stays[rows[row]] = true);
        // Those that leave take their displacement with them at once.
        let leaves = |i: usize| !stays[i];
        let mut right =
            DVector::from_iterator(active.len(), active.iter().map(|&row| -misfits[row]));
        if (0..asperities.len()).any(|i| leaves(i) && state.indentations[i] > 0.0) {
            let freed = field.displacement(leaves);
            for (value, &row) in right.iter_mut().zip(&active) {
                *value += freed[row];
            }
        }
        let slopes = field.slopes(&active, &contacts);
        let apply = |x: &DVector<f64>| {
            let mut sums = x.clone();
            slopes.add(x.as_slice(), sums.as_mut_slice());
            sums
        };
        let own = gmres::solve(apply, &right, care.linear).ok_or(failed.clone())?;
        let (steps, moved) = match hold {
            Hold::Plane => (own, 0.0),
            Hold::Load(asked) => {
                let guess = DVector::from_iterator(
                    active.len(),
                    active.iter().map(|&row| state.lowered[rows[row]]),
                );
                let right = DVector::from_element(active.len(), 1.0) - apply(&guess);
                let bound = LOWERED_TOLERANCE * (active.len() as f64).sqrt() / right.norm();
                let lowered = if bound < 1.0 {
                    guess + gmres::solve(apply, &right, bound).ok_or(failed.clone())?
                } else {
                    guess
                };
                for (&row, &lowered) in active.iter().zip(lowered.iter()) {
                    state.lowered[rows[row]] = lowered;
                }
                let stiffness = DVector::from_column_slice(&slopes.stiffness);
                let held: f64 = active
                    .iter()
                    .map(|&row| contacts[rows[row]].load_over_modulus())
                    .sum();
                let moved = (stiffness.dot(&own) - (asked - held)) / stiffness.dot(&lowered);
                if !moved.is_finite() {
                    return Err(failed);
                }
                (own - lowered * moved, moved)
            }
        };
        let share = if round < PATIENCE { 1.0 } else { 0.5 };
        let mut next = vec![0.0; asperities.len()];
        for (&row, step) in active.iter().zip(steps.iter()) {
            let i = rows[row];
            next[i] = (state.indentations[i] + share * step).max(0.0);
        }
        state.plane += share * moved;
        state.indentations = next;
    }
    Err(failed)
}
