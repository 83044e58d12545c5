//! Equilibrium of a given set of asperities by Newton's method with an active set of contacts. The
//! sum over the neighbours can exceed the diagonal, so fixed-point iteration would not converge.

use nalgebra::DVector;

use super::displacements::Field;
use super::gmres;
use super::lattice::Lattice;
use super::pair::pair;
use super::set::Set;
use super::{Asperity, Contact};
use crate::theory::TheoryError;

const MAX_ROUNDS: usize = 60;
/// Iterations after which steps are halved, in case contacts enter and leave alternately.
const HALVING_AFTER: usize = 30;
/// Misfit over the largest indentation at which circles that cover each other may be returned for
/// merging: such a pair has no unique equilibrium.
const NEAR: f64 = 0.05;
/// Load over the requested load at which a start is too far off.
const TOO_FAR: f64 = 4.0;
/// Tolerance of the total load over the requested load, in tolerances of an indentation over the
/// largest one.
const LOAD_TOLERANCE: f64 = 10.0;
/// Tolerance of the linear system for the response to the plane; the plane moves little, and the
/// next iteration corrects the error.
const LOWERED_TOLERANCE: f64 = 3e-2;

/// The prescribed quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Prescribed {
    /// The plane stays where it is.
    Plane,
    /// The sum of all loads over the modulus, m^2, is prescribed; the plane moves.
    Load(f64),
}

/// Tolerances of the solve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tolerances {
    /// Tolerance of an indentation over the largest one.
    pub tolerance: f64,
    /// The same at which overlapping circles are returned for merging.
    pub merging: f64,
    /// Relative residual of a Newton system; the next iteration corrects the error.
    pub linear: f64,
    /// Iterations after which circles that cover each other are returned for merging without
    /// convergence.
    pub rounds_before_merging: usize,
    /// Which contacts are returned for merging.
    pub merges: Merges,
}

/// Criterion for merging contacts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Merges {
    /// Their circles overlap.
    Overlapping,
    /// One circle covers the other's summit.
    Covering,
}

impl Tolerances {
    /// The same tolerances, merging only contacts that cover each other.
    pub fn merging_covered(self) -> Tolerances {
        Tolerances {
            merges: Merges::Covering,
            ..self
        }
    }

    /// Full precision.
    pub const FULL: Tolerances = Tolerances {
        tolerance: 1e-11,
        merging: 1e-11,
        linear: 1e-4,
        rounds_before_merging: 7,
        merges: Merges::Overlapping,
    };
    /// At a requested load.
    pub const FINAL: Tolerances = Tolerances {
        tolerance: 1e-6,
        merging: 2e-2,
        linear: 3e-2,
        rounds_before_merging: 4,
        merges: Merges::Overlapping,
    };
    /// On the way to a load, before further merging.
    pub const PASSING: Tolerances = Tolerances {
        tolerance: 1e-2,
        merging: 2e-2,
        linear: 3e-2,
        rounds_before_merging: 3,
        merges: Merges::Overlapping,
    };
}

/// The plane and the indentation of each asperity.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Equilibrium {
    /// Height of the plane, m; in a periodic cell above the plane of zero mean displacement.
    pub plane: f64,
    /// Hertz indentation of each asperity, m; 0 out of contact.
    pub indentations: Vec<f64>,
    /// Estimated increase of each indentation as the plane goes down by 1.
    pub lowered: Vec<f64>,
}

impl Equilibrium {
    /// A start for a plane that has not moved yet.
    pub fn undeformed(asperities: &[Asperity], plane: f64) -> Self {
        let half = |asperity: &Asperity| 0.5 * (asperity.height - plane).max(0.0);
        Equilibrium {
            plane,
            indentations: asperities.iter().map(half).collect(),
            lowered: vec![0.0; asperities.len()],
        }
    }

    /// All asperities with their contacts.
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

/// An equilibrium, or a state close enough to merge the overlapping circles.
pub(super) struct Solution {
    /// The state.
    pub state: Equilibrium,
    /// Pairs of asperities to be merged.
    pub meeting: Vec<[usize; 2]>,
}

/// Displacement at `position` by one contact with its images, and its derivative.
pub(super) fn displacement_by(
    contact: &Contact,
    position: [f64; 2],
    lattice: &Lattice,
) -> (f64, f64) {
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

/// Iterates from a start to equilibrium, or close enough to merge overlapping circles. If circles
/// cover each other's summits the iteration cannot converge, and the state may be returned as it
/// is, for those circles to be merged.
pub(super) fn solve_equilibrium(
    set: &Set,
    lattice: &Lattice,
    hold: Prescribed,
    start: Equilibrium,
    care: Tolerances,
) -> Result<Solution, TheoryError> {
    let failed = TheoryError::NotConverged {
        what: "the set of asperities",
    };
    let asperities = &set.asperities;
    let mut state = start;
    for round in 0..MAX_ROUNDS {
        let contacts = state.contacts(asperities);
        let load: f64 = contacts.iter().map(Contact::load_over_modulus).sum();
        if matches!(hold, Prescribed::Load(asked) if load > TOO_FAR * asked) {
            return Err(failed);
        }
        // No lower summit can touch: nowhere is the surface displaced by more.
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
            Prescribed::Plane => 0.0,
            Prescribed::Load(asked) => (load / asked - 1.0).abs() / LOAD_TOLERANCE,
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
            return Ok(Solution {
                meeting: meeting.clone(),
                state,
            });
        }
        let active: Vec<usize> = (0..rows.len())
            .filter(|&row| state.indentations[rows[row]] > misfits[row])
            .collect();
        let mut stays = vec![false; asperities.len()];
        active.iter().for_each(|&row| stays[rows[row]] = true);
        // The displacement of contacts that leave is removed at once.
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
            Prescribed::Plane => (own, 0.0),
            Prescribed::Load(asked) => {
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
        let share = if round < HALVING_AFTER { 1.0 } else { 0.5 };
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
