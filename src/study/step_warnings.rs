//! Warnings of what a step shows: contact at a cut edge, pressures that do not add up to the load, a contact too wide for the
//! theory, a jump that is a guess.

use std::f64::consts::PI;

use super::cut_edges::edge_warning;
use super::observer::FinishedStep;
use super::setup::Setup;
use super::step::misses;
use crate::scene::Control;
use crate::units::format_si;

/// Radius of contact over that of a sphere up to which nothing is said: there a sphere is 7 % further from the plane at its
/// apex than the paraboloid of small slopes.
const WIDE: f64 = 0.5;

/// The warnings of a step, except those that were `said` of another one.
pub fn step_warnings(setup: &Setup, step: &FinishedStep, said: &[String]) -> Vec<String> {
    let others = [
        missed_value(setup, step),
        wide_contact(setup, step),
        guessed_jump(setup, step),
    ];
    let unsaid = |[_, words]: &[String; 2]| !said.iter().any(|text| text.ends_with(words));
    let effects = setup.effects.iter();
    let of_effects = effects.filter_map(|effect| effect.warning_of_step(setup, step.row));
    let others = others.into_iter().flatten().chain(of_effects);
    let others = others.filter(unsaid);
    let edge = edge_warning(step, said).map(str::to_owned);
    edge.into_iter()
        .chain(others.map(|[here, words]| here + &words))
        .map(|warning| format!("step {}: {warning}", step.row.step))
        .collect()
}

/// That the pressures miss the prescribed value: by how much here, and the words for any step.
fn missed_value(setup: &Setup, step: &FinishedStep) -> Option<[String; 2]> {
    let evaluation = step.evaluation.as_ref()?;
    // A step that has not converged says so by its residual.
    if !step.row.converged || !(misses(setup, evaluation) || misses_its_own(setup, step)) {
        return None;
    }
    let (what, unit) = match setup.scene.loading.control {
        Control::Pressure => ("mean pressure", "Pa"),
        Control::Force => ("force", "N"),
        Control::Approach | Control::MeanGap => ("approach", "m"),
    };
    let missed = format_si(evaluation.missed.abs(), unit);
    Some(match setup.sums_attraction() {
        true => [
            format!("the net load misses the prescribed {what} by {missed}"),
            "; what a point attracts by ends as it comes into contact, and the net load of the treatment jumps past the prescribed one: more points make these jumps smaller".to_owned(),
        ],
        false => [
            format!("the pressures do not balance the prescribed {what}, by {missed}"),
            "; each point is within the tolerance of the pressures, which are far larger than their mean: take a smaller solver.tolerance, and pixels that resolve the range of the law".to_owned(),
        ],
    })
}

/// Largest deviation of a load, over itself, that is not said: beside far larger ones on its path it is within the tolerance.
const MISSED_OF_ITSELF: f64 = 0.1;

/// Whether the pressures miss a load by much of itself, whose column repeats what is prescribed.
fn misses_its_own(setup: &Setup, step: &FinishedStep) -> bool {
    let load = match setup.scene.loading.control {
        Control::Pressure => step.row.mean_pressure,
        Control::Force => step.row.force,
        Control::Approach | Control::MeanGap => return false,
    };
    let missed = step.evaluation.as_ref().map_or(0.0, |found| found.missed);
    // Of the treatment that sums attraction the row has what the field carries.
    !setup.sums_attraction() && load != 0.0 && missed.abs() > MISSED_OF_ITSELF * load.abs()
}

/// That a sphere's contact is wide for a half-space: how wide here, and the words for any step.
fn wide_contact(setup: &Setup, step: &FinishedStep) -> Option<[String; 2]> {
    let sphere = setup.surface.top.sphere_radius()?;
    let area = step.row.contact_area_fraction * setup.surface.grid.area();
    let share = (area / PI).sqrt() / sphere;
    (share > WIDE).then(|| {
        [
            format!("the radius of contact is {share:.2} of that of the sphere"),
            "; a half-space stands for a sphere where the contact is far narrower than the sphere"
                .to_owned(),
        ]
    })
}

/// That a search did not tell whether the step jumped: what is taken for the answer, and the words for any step.
fn guessed_jump(setup: &Setup, step: &FinishedStep) -> Option<[String; 2]> {
    let listed = match step.jump {
        Some(_) => "it is not known to have jumped, and is listed as a jump",
        None => "it may have jumped, and is not listed as a jump",
    };
    step.jump_is_guessed.then(|| {
        [
            listed.to_owned(),
            format!(
                "; a load between it and the step before did not converge in solver.max_iterations = {}: allow more, or take more steps there",
                setup.scene.solver.max_iterations
            ),
        ]
    })
}
