//! What a run that ended warns of.

use crate::device::SelectedDevice;
use crate::scene::{LoadingScene, Precision, StepChoice};
use crate::study::{Planned, PullOff, Setup, State, StepRow, Tension, WalkEnd};
use crate::units::format_si;

/// Forces that differ by this share of the greatest are one.
const ROUNDING: f64 = 1e-9;

/// Warnings of a path that ended: steps that rounding ended, and a pull-off that is not known.
pub(crate) fn warnings_at_end(
    setup: &Setup,
    device: &SelectedDevice,
    end: &WalkEnd,
) -> Vec<String> {
    let is_whole = Planned::after(setup, &end.rows).is_none()
        && end.rows.last().is_some_and(|row| row.converged);
    let pull_off = is_whole
        .then(|| {
            let loading = &setup.scene.loading;
            pull_off(loading, end).or_else(|| passed_over(setup, end))
        })
        .flatten();
    rounding(setup, device, &end.rows)
        .into_iter()
        .chain(pull_off)
        .chain(hysteresis(end, setup.scene.solver.tolerance))
        .collect()
}

/// A warning of steps whose fields and pictures the scene asks for, and to which a path that pulls until the surfaces are apart did not
/// come.
pub(super) fn unreached_steps(setup: &Setup, rows: &[StepRow]) -> Option<String> {
    let output = &setup.scene.output;
    let StepChoice::List(list) = &output.steps else {
        return None;
    };
    let asked = !(output.images.is_empty() && output.fields.is_empty());
    let is_whole =
        Planned::after(setup, rows).is_none() && rows.last().is_some_and(|row| row.converged);
    let beyond = list.iter().filter(|step| **step > rows.len()).min()?;
    (asked && is_whole).then(|| {
        format!(
            "the path ended with step {}, and output.steps names others beyond it, step {beyond} and on: they have no fields and pictures",
            rows.len()
        )
    })
}

/// A warning if rounding ended steps above the tolerance.
fn rounding(setup: &Setup, device: &SelectedDevice, rows: &[StepRow]) -> Option<String> {
    let asked = setup.scene.solver.tolerance;
    let loading = &setup.scene.loading;
    let is_pressed = |row: &StepRow| {
        loading.control.is_load()
            && loading
                .path
                .get(row.step - 1)
                .is_some_and(|load| *load > 0.0)
    };
    let short: Vec<&StepRow> = rows
        .iter()
        // Where nothing bears and nothing is asked to, nothing is left to be resolved.
        .filter(|row| row.converged && (row.state != State::Separated || is_pressed(row)))
        .filter(|row| row.residual.is_finite() && row.residual > asked)
        .collect();
    let first = short.first()?.step;
    let most = short.iter().map(|row| row.residual).fold(0.0, f64::max);
    let precision = device.precision();
    let remedy = match precision {
        Precision::Single => "; precision = \"mixed\" or \"double\" continues from there",
        _ => "",
    };
    Some(format!(
        "rounding in {} precision ends {} of {} steps, the first of them step {first}, at a residual of \
         up to {most:.1e}, asked {asked:.1e}{remedy}",
        precision.name(),
        short.len(),
        rows.len(),
    ))
}

/// A warning if the steps of a loop that jumps are too long to tell what it loses. Energies are known to the solver's tolerance.
fn hysteresis(end: &WalkEnd, tolerance: f64) -> Option<String> {
    let energy = end.hysteresis_energy?;
    let Some(uncertainty) = end.hysteresis_uncertainty else {
        let stored = end.rows.iter();
        let stored = stored.map(|row| row.elastic_energy.abs().max(row.adhesive_energy.abs()));
        let known_to = tolerance * stored.fold(0.0, f64::max);
        return (energy < -known_to).then(|| {
            format!(
                "hysteresis_energy, {}, is less than nothing: the steps of the loop are too long; take more of them",
                format_si(energy, "J")
            )
        });
    };
    let jumps = !(end.jump_in_steps.is_empty() && end.jump_off_steps.is_empty());
    (jumps && energy <= uncertainty).then(|| {
        format!(
            "hysteresis_energy, {}, is known to {} only: the steps of the loop are long against its jumps; take more of them",
            format_si(energy, "J"),
            format_si(uncertainty, "J")
        )
    })
}

/// The greatest force of a path, N.
pub(super) fn greatest_force(rows: &[StepRow]) -> f64 {
    rows.iter().map(|row| row.force.abs()).fold(0.0, f64::max)
}

/// Whether the loads that pull-off lies between, on a path whose greatest force is `greatest`, are further apart than asked.
pub(super) fn is_loose(loading: &LoadingScene, [lower, upper]: [f64; 2], greatest: f64) -> bool {
    loading.pull_off_tolerance > 0.0
        && upper > ROUNDING * greatest
        && upper - lower > (loading.pull_off_tolerance + ROUNDING) * upper
}

/// Whether a step is further apart than the step `held` was, under a lesser tension.
fn lets_go_later(loading: &LoadingScene, rows: &[StepRow], held: usize) -> bool {
    let (before, later) = rows.split_at(held);
    let tense = &before[held - 1];
    let places = |row: &StepRow| {
        row.prescribed_place(loading)
            .zip(tense.prescribed_place(loading))
    };
    let is_further = |row: &StepRow| {
        places(row).is_some_and(|(there, here)| there < here) && row.force > tense.force
    };
    let mut later = later.iter();
    later.any(|row| row.state == State::Separated || is_further(row))
}

/// A warning of surfaces that attract, are pressed together in one step and apart in the next under a prescribed position, on a path
/// without any tension.
fn passed_over(setup: &Setup, end: &WalkEnd) -> Option<String> {
    let loading = &setup.scene.loading;
    let is_known = Tension::at_end(loading, end) != Tension::None;
    if loading.control.is_load() || !setup.law.is_adhesive() || is_known {
        return None;
    }
    let mut pairs = end.rows.windows(2);
    let [pressed, apart] = pairs.find_map(|pair| match pair {
        [pressed, apart] if pressed.state == State::Contact && apart.state == State::Separated => {
            Some([pressed.step, apart.step])
        }
        _ => None,
    })?;
    Some(format!(
        "the surfaces are pressed together in step {pressed} and apart in step {apart}: the path passed over their pull-off; take shorter steps between the two"
    ))
}

/// Growth of the tension in the last step before a contact lets go, over the tension, from which on it is said.
const STEEP: f64 = 0.05;

/// By how much, N, the tension grew in a step behind which the contact let go at once, as on a soft spring, where that is much of it: its greatest lies between
/// the two.
fn let_go_while_rising(rows: &[StepRow], step: usize) -> Option<f64> {
    let [before, at, after] = rows.get(step.checked_sub(2)?..=step)? else {
        return None;
    };
    let (grown, tension) = (before.force - at.force, -at.force);
    (grown > STEEP * tension && -after.force < 0.5 * tension).then_some(grown)
}

/// A warning if the pull-off of a finished path is not known to the tolerance.
fn pull_off(loading: &LoadingScene, end: &WalkEnd) -> Option<String> {
    let newtons = |force: f64| format_si(force, "N");
    let greatest = greatest_force(&end.rows);
    let tension = Tension::at_end(loading, end);
    if let Tension::Passed { step, force } = tension
        && !tension.is_cut_off(loading, &end.rows)
        && let Some(grown) = let_go_while_rising(&end.rows, step)
    {
        return Some(format!(
            "the tension grew by {} to {} in step {step}, and the contact let go in the next: its pull-off may be far greater; take shorter steps there",
            newtons(grown),
            newtons(force)
        ));
    }
    match tension {
        Tension::Passed { step, force } if tension.is_cut_off(loading, &end.rows) => Some(format!(
            "the path turns back at its greatest tension, {} in step {step}, or begins there: the surfaces were not pressed beyond it, and pull-off may be greater; press further",
            newtons(force)
        )),
        Tension::Holds { step, force } if end.rows[step - 1].state != State::Separated => {
            let what = match end.rows[step - 1].state {
                State::Contact => "the contact",
                _ => "the attraction",
            };
            if lets_go_later(loading, &end.rows, step) {
                return Some(format!(
                    "{what} held {} in step {step}, the greatest tension of the path, and let go later at a lesser one: its pull-off is not known; pull on from step {step}, or take shorter steps",
                    newtons(force)
                ));
            }
            Some(format!(
                "{what} held {} in step {step}, the greatest tension of the path: its pull-off is beyond; extend the path until it lets go",
                newtons(force)
            ))
        }
        Tension::LetGo(PullOff { lower, upper, .. })
            if is_loose(loading, [lower, upper], greatest) =>
        {
            Some(format!(
                "pull-off lies between {} and {}, and is known no better: a load between them did not converge; allow more max_iterations",
                newtons(lower),
                newtons(upper)
            ))
        }
        _ if loading.until_apart
            && end
                .rows
                .last()
                .is_some_and(|row| row.state != State::Separated) =>
        {
            Some(format!(
                "the surfaces still hold together after {} steps; let the path go on from nearer to its pull-off",
                end.rows.len()
            ))
        }
        _ => None,
    }
}
