//! What each step of a path prescribes: the values of the scene, and with `until = "apart"` further ones that
//! pull until the surfaces separate.
//!
//! A further step is as long as the changes of contact and tension in the steps before allow, so steps become
//! finer towards pull-off. It follows from the rows alone: a resumed run takes the same steps.

use super::row::{State, StepRow};
use super::setup::Setup;
use crate::scene::{Control, LoadingScene};

/// Change of the contact area that a further step aims at, relative to the area.
const AREA_CHANGE: f64 = 0.05;
/// Change of the force under a prescribed position that it aims at, relative to the greatest tension.
const FORCE_CHANGE: f64 = 0.05;
/// Points of the grid by which the contact may always change.
const LEAST_POINTS: f64 = 2.0;
/// Share of the greatest compression of the path below which a tension is not followed more closely.
const LEAST_TENSION: f64 = 0.2;
/// A further step is at most and at least so many times as long as the one before it.
const LONGER: f64 = 1.5;
const SHORTER: f64 = 0.1;
/// Share of a first length, where the path does not move.
const FIRST: f64 = 0.01;
/// Most further steps.
const MOST: usize = 2000;

/// What a step prescribes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Planned {
    /// The value, in the unit of the control.
    pub value: f64,
    /// How long the step takes, s; 0 where the path has no durations.
    pub duration: f64,
}

impl Planned {
    /// The step after these rows; `None` where the path ends.
    pub fn after(setup: &Setup, rows: &[StepRow]) -> Option<Planned> {
        let loading = &setup.scene.loading;
        if let Some(&value) = loading.path.get(rows.len()) {
            let durations = loading.durations.as_ref();
            let duration = durations.and_then(|durations| durations.get(rows.len()));
            return Some(Planned {
                value,
                duration: duration.copied().unwrap_or(0.0),
            });
        }
        loading
            .until_apart
            .then(|| Planned::behind(setup, loading, rows))?
    }

    /// The step behind a path, of which and of the steps behind it these are the rows, whatever the path of the setup
    /// is; `None` where the surfaces are apart.
    pub fn behind(setup: &Setup, loading: &LoadingScene, rows: &[StepRow]) -> Option<Planned> {
        let together = |row: &StepRow| row.converged && row.state != State::Separated;
        let most = loading.path.len() + MOST;
        if rows.len() >= most || !rows.last().is_some_and(together) {
            return None;
        }
        pulled(setup, loading, rows)
    }

    /// What a step (from 1) among these rows prescribed.
    pub fn of_step(setup: &Setup, rows: &[StepRow], step: usize) -> Option<f64> {
        let before = rows.get(..step.checked_sub(1)?)?;
        Planned::after(setup, before).map(|planned| planned.value)
    }
}

/// The step after rows beyond the path.
fn pulled(setup: &Setup, loading: &LoadingScene, rows: &[StepRow]) -> Option<Planned> {
    let outwards = match loading.control {
        Control::MeanGap => 1.0,
        _ => -1.0,
    };
    let (first, seconds) = last_move(loading).unwrap_or((first_length(setup, loading), 0.0));
    let mut before = loading.path.iter().rev().nth(1).copied();
    let mut value = *loading.path.last()?;
    let mut length = first;
    let mut greatest = Greatest::default();
    let mut seen = 0;
    for done in loading.path.len()..=rows.len() {
        let moved = before.map_or(0.0, |before| (value - before).abs());
        rows[seen..done].iter().for_each(|row| greatest.add(row));
        seen = done;
        let allowed = allowed(setup, &rows[..done], greatest, moved);
        length = if done == loading.path.len() {
            allowed.min(first)
        } else {
            allowed.clamp(SHORTER * length, LONGER * length)
        };
        before = Some(value);
        value += outwards * length;
    }
    Some(Planned {
        value,
        duration: seconds * length / first,
    })
}

/// How far the path moved in the last step that did, and the seconds that it took.
fn last_move(loading: &LoadingScene) -> Option<(f64, f64)> {
    let durations = loading.durations.as_ref();
    let steps = loading.path.windows(2).enumerate().rev();
    let mut moves = steps.map(|(index, pair)| {
        let seconds = durations.map_or(0.0, |durations| durations[index + 1]);
        ((pair[1] - pair[0]).abs(), seconds)
    });
    moves.find(|(length, seconds)| *length > 0.0 && (durations.is_none() || *seconds > 0.0))
}

/// The first length of a path that does not move.
fn first_length(setup: &Setup, loading: &LoadingScene) -> f64 {
    let law = &setup.law;
    let load = loading.path.last().map_or(0.0, |load| FIRST * load.abs());
    let pressure = FIRST * law.peak_tension();
    match loading.control {
        Control::Pressure => load.max(FIRST * pressure),
        Control::Force => load.max(FIRST * pressure * setup.surface.grid.area()),
        _ if law.is_adhesive() => FIRST * law.range(),
        // Flats have no height.
        _ => match FIRST * setup.statistics.moments.rms_height() {
            0.0 => load,
            height => height,
        },
    }
}

/// The greatest forces of a path so far, N.
#[derive(Clone, Copy, Debug, Default)]
struct Greatest {
    tension: f64,
    compression: f64,
}

impl Greatest {
    fn add(&mut self, row: &StepRow) {
        self.tension = self.tension.max(-row.force);
        self.compression = self.compression.max(row.force);
    }
}

/// How far the next step after these rows may move, as the last one did by `moved`.
fn allowed(setup: &Setup, rows: &[StepRow], greatest: Greatest, moved: f64) -> f64 {
    let [.., before, row] = rows else {
        return f64::INFINITY;
    };
    let area = |row: &StepRow| match row.state {
        State::Contact => row.contact_area_fraction,
        _ => row.attractive_area_fraction,
    };
    let least = LEAST_POINTS / setup.surface.grid.len() as f64;
    let by_area = (AREA_CHANGE * area(row)).max(least) / (area(row) - area(before)).abs();
    let by_force = match setup.scene.loading.control {
        Control::Pressure | Control::Force => f64::INFINITY,
        // The area alone is followed on the way to tension.
        _ if row.force > 0.0 => f64::INFINITY,
        Control::Approach | Control::MeanGap => {
            FORCE_CHANGE * greatest.tension.max(LEAST_TENSION * greatest.compression)
                / (row.force - before.force).abs()
        }
    };
    let change = by_area.min(by_force);
    if change.is_nan() || moved == 0.0 {
        f64::INFINITY
    } else {
        moved * change
    }
}

/// As in `3 of 5 steps`; of a path that goes on until the surfaces part, as in `40 steps`.
pub(crate) fn count_of_steps(finished: usize, steps: usize) -> String {
    match finished < steps {
        true => format!("{finished} of {steps} steps"),
        false if finished == 1 => "1 step".to_owned(),
        false => format!("{finished} steps"),
    }
}
