//! The full field, and the field without adhesion with the attraction added afterwards (DMT).

use super::load_scan::{LoadScan, distinct_loads, scan_loads};
use super::retraction::Retraction;
use super::table::Table;
use super::{CompareError, Comparison, State};
use crate::kernel::Scalars;
use crate::law::Law;
use crate::output::OutputError;
use crate::scene::{AdhesionScene, Control, Scene, Treatment};
use crate::solver::MakeBackend;
use crate::study::{
    Evaluation, FinishedStep, Observer, PointState, Setup, WalkError, greatest_across, walk,
};

/// The retraction goes on while the tension is above this share of the greatest one.
const OVER: f64 = 0.3;

/// Mean gap at which a closed contact begins its retraction, as a share of the whole way. Its tension is greatest just as it begins
/// to open: at a thousandth of the way a soft solid has lost a third of it.
const CLOSED: f64 = 1e-9;

/// Observes the state of each step and may end the path.
struct Watch<F: FnMut(State, &Evaluation, bool) -> Result<bool, OutputError>>(F);

/// Why an observed path ended.
enum End {
    Enough,
    Output(OutputError),
}

impl<F: FnMut(State, &Evaluation, bool) -> Result<bool, OutputError>> Observer for Watch<F> {
    type Error = End;

    fn step(&mut self, step: FinishedStep) -> Result<(), End> {
        let Some(fields) = step.evaluation else {
            return Ok(());
        };
        let state = State {
            mean_pressure: step.row.mean_pressure,
            contact_area_fraction: Some(
                step.row
                    .contact_area_fraction_corrected
                    .unwrap_or(step.row.contact_area_fraction),
            ),
            mean_gap: step.row.mean_gap,
            adhesive_pressure: Some(tension(&fields)),
        };
        match (self.0)(state, &fields, step.row.converged) {
            Ok(true) => Ok(()),
            Ok(false) => Err(End::Enough),
            Err(error) => Err(End::Output(error)),
        }
    }

    fn iteration(&mut self, _: usize, _: &Scalars) -> bool {
        true
    }
}

/// Mean tension over the cell, Pa.
fn tension(fields: &Evaluation) -> f64 {
    let sum: f64 = fields.pressure.iter().map(|p| (-p).max(0.0)).sum();
    sum / fields.pressure.len() as f64
}

/// Follows another path over the same surface.
fn follow_path<F: FnMut(State, &Evaluation, bool) -> Result<bool, OutputError>>(
    comparison: &Comparison,
    make_backend: MakeBackend,
    control: Control,
    path: Vec<f64>,
    adhesion: Option<AdhesionScene>,
    watch: F,
) -> Result<(), CompareError> {
    if path.is_empty() {
        return Ok(());
    }
    let mut scene: Scene = comparison.setup.scene.clone();
    scene.loading.control = control;
    scene.loading.path = path;
    scene.adhesion = adhesion;
    follow(comparison, make_backend, scene, watch)
}

/// Follows the path of another scene over the same surface.
fn follow<F: FnMut(State, &Evaluation, bool) -> Result<bool, OutputError>>(
    comparison: &Comparison,
    make_backend: MakeBackend,
    scene: Scene,
    watch: F,
) -> Result<(), CompareError> {
    let setup = Setup::new(scene, comparison.setup.surface.clone());
    match walk(&setup, make_backend, &mut Watch(watch)) {
        Ok(_) | Err(WalkError::Observer(End::Enough)) => Ok(()),
        Err(WalkError::Backend(error)) => Err(error.into()),
        Err(WalkError::Observer(End::Output(error))) => Err(error.into()),
    }
}

fn unconverged(converged: bool) -> Option<&'static str> {
    (!converged).then_some("not converged")
}

/// The scene itself: pull-off by retraction from its largest load, then its path step by step,
/// which also gives the loads for the other models.
pub(super) fn full(
    comparison: &mut Comparison,
    make_backend: MakeBackend,
    table: &mut Table,
) -> Result<(), CompareError> {
    let scene = comparison.setup.scene.clone();
    let full = scene.adhesion.clone().map(|adhesion| AdhesionScene {
        treatment: Treatment::Full,
        ..adhesion
    });
    let mut pull_off = full.is_none().then_some(0.0);
    if full.is_some() {
        let best = pull_off_by_retraction(comparison, make_backend, full.clone())?;
        pull_off = best.map(|state| -state.mean_pressure);
        if let Some(state) = best {
            table.add(state, pull_off, None)?;
        }
    }
    let mut loads = Vec::new();
    let path = scene.loading.path.clone();
    let control = scene.loading.control;
    let keep = |state: State, _: &Evaluation, converged: bool| {
        loads.push(state.mean_pressure);
        table.add(state, pull_off, unconverged(converged))?;
        Ok(true)
    };
    follow_path(comparison, make_backend, control, path, full, keep)?;
    comparison.loads = distinct_loads(loads);
    Ok(())
}

/// The state of greatest tension on retraction from the closest step of the scene's path.
fn pull_off_by_retraction(
    comparison: &Comparison,
    make_backend: MakeBackend,
    adhesion: Option<AdhesionScene>,
) -> Result<Option<State>, CompareError> {
    let loading = &comparison.setup.scene.loading;
    let closest = match loading.control {
        Control::MeanGap => loading.path.iter().copied().reduce(f64::min),
        _ => loading.path.iter().copied().reduce(f64::max),
    };
    let Some(closest) = closest else {
        return Ok(None);
    };
    let mut nearest = None;
    let see = |state: State, _: &Evaluation, _: bool| {
        nearest = state.mean_gap;
        Ok(true)
    };
    follow_path(
        comparison,
        make_backend,
        loading.control,
        vec![closest],
        adhesion.clone(),
        see,
    )?;
    let Some(nearest) = nearest else {
        return Ok(None);
    };
    // Beyond the highest summit by a few ranges no attraction is left.
    let statistics = comparison.setup.statistics;
    let far = statistics.highest - statistics.mean + 3.0 * comparison.setup.law.range();
    let first = nearest.max(CLOSED * far);
    let mut scene = comparison.setup.scene.clone();
    scene.loading.control = Control::MeanGap;
    scene.loading.path = vec![first];
    scene.loading.until_apart = true;
    scene.adhesion = adhesion;
    let mut retraction: Option<Retraction> = None;
    let mut best: Option<State> = None;
    loop {
        let mut states = Vec::new();
        let see = |state: State, _: &Evaluation, converged: bool| {
            if let Some(gap) = state.mean_gap.filter(|_| converged) {
                states.push((gap, -state.mean_pressure));
            }
            let least = best.map_or(0.0, |best| best.mean_pressure);
            // An earlier retraction, in longer steps, found the greatest farther away.
            let leads_there = best
                .and_then(|best| state.mean_gap.zip(best.mean_gap))
                .is_some_and(|(gap, greatest)| gap < greatest);
            if converged && state.mean_pressure < least {
                best = Some(state);
            }
            // The tension may fall and rise again: once a few high summits are all that is left, nothing balances what
            // they attract. It is past its greatest where all of the attraction is below that.
            let attraction = state.adhesive_pressure.unwrap_or(0.0);
            let attracts = state.mean_gap.is_some_and(|gap| gap < far);
            Ok(match least < 0.0 {
                true => leads_there || state.mean_pressure <= OVER * least || attraction >= -least,
                false => attracts,
            })
        };
        follow(comparison, make_backend, scene.clone(), see)?;
        let retraction = retraction.get_or_insert_with(|| Retraction::along(&states, far));
        if !retraction.refine(&states) {
            return Ok(best);
        }
        // Always from the closest step: the contact depends on its path.
        scene.loading.path = retraction.gaps().to_vec();
        scene.loading.until_apart = false;
    }
}

/// The DMT treatment: a scan of contacts without adhesion for pull-off, then each load separately.
///
/// The net pressure is not monotone in the repulsive pressure: a single high summit detaches before
/// the rest of the surface comes near. So the scan continues until no attraction can exceed the
/// repulsion, includes states without contact, and is refined around every minimum.
pub(super) fn dmt(
    comparison: &Comparison,
    make_backend: MakeBackend,
    table: &mut Table,
) -> Result<(), CompareError> {
    let setup = &comparison.treated;
    let adhesion = setup.scene.adhesion.clone();
    let law: Law = setup.law;
    let peak = law.peak_tension();
    let unit = setup.scene.solid.contact_modulus * setup.statistics.moments.rms_slope();
    let mut scan = LoadScan::default();
    let mut scan_states = |path: Vec<f64>, to_the_end: bool| {
        let add = |state: State, fields: &Evaluation, _: bool| {
            let open = fields.gap.iter().zip(&fields.points);
            let open = open.filter(|(_, point)| **point != PointState::Contact);
            let across =
                open.map(|(gap, _)| law.traction(*gap)).sum::<f64>() / fields.gap.len() as f64;
            // As the treatment has it where the staircase of pixels closes the gap.
            let corrected = fields.contact_corrected.unwrap_or(fields.contact);
            let attraction = across + law.traction(0.0) * (fields.contact - corrected);
            let area = state.contact_area_fraction.unwrap_or(f64::NAN);
            let gap = state.mean_gap.unwrap_or(f64::NAN);
            scan.add(state.mean_pressure, area, gap, attraction);
            Ok(to_the_end || !scan.stays_above(0.0, peak))
        };
        follow_path(comparison, make_backend, Control::Pressure, path, None, add)?;
        Ok::<_, CompareError>(scan.closer())
    };
    let closer = scan_states(scan_loads(unit, 0.0, peak), false)?;
    scan_states(closer, true)?;
    let limit = comparison.beyond_dmt();
    let pulls = |state: &State| state.mean_pressure < 0.0;
    let pull_off = [scan.pull_off(), Some(separated_pull_off(setup))]
        .into_iter()
        .flatten()
        .filter(pulls)
        .min_by(|a, b| a.mean_pressure.total_cmp(&b.mean_pressure));
    let tension = pull_off.map_or(0.0, |state| -state.mean_pressure);
    if let Some(state) = pull_off {
        table.add(state, Some(tension), limit)?;
    }
    let loads: Vec<f64> = comparison.carried(tension).collect();
    let keep = |state: State, _: &Evaluation, converged: bool| {
        table.add(state, Some(tension), unconverged(converged).or(limit))?;
        Ok(true)
    };
    follow_path(
        comparison,
        make_backend,
        Control::Pressure,
        loads,
        adhesion,
        keep,
    )
}

/// The state of greatest tension without contact: the undeformed surfaces at their best clearance.
pub(super) fn separated_pull_off(setup: &Setup) -> State {
    let (clearance, tension) = greatest_across(setup);
    let statistics = setup.statistics;
    State {
        mean_pressure: -tension,
        contact_area_fraction: Some(0.0),
        mean_gap: Some(statistics.highest - statistics.mean + clearance),
        adhesive_pressure: Some(tension),
    }
}
