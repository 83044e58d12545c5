//! `[loading]`: the path, written out step by step.

use super::keys;
use super::mistake::SceneError;
use super::reader::{Allowed, Reader};
use super::types::{AdhesionScene, Boundary, Control, LawName, LoadingScene, Range, Treatment};
use crate::units::{self, Dimension};

/// Most steps of a path, so that a slip of the finger cannot fill the memory.
const MOST_STEPS: usize = 1_000_000;

/// A path with the time that each step takes, where it says.
struct TimedPath {
    path: Vec<f64>,
    durations: Option<Vec<f64>>,
}

/// Reads `[loading]`; `boundary`, `adhesion` and whether the solid relaxes are there to check
/// against, if they could be read.
pub(super) fn read(
    scene: &Reader,
    boundary: Option<Boundary>,
    adhesion: Option<&AdhesionScene>,
    relaxes: bool,
) -> Option<LoadingScene> {
    scene.require_as(
        "loading",
        "[loading] with control = \"pressure\" and path = [\"1 MPa\"]",
    );
    let loading = scene.table("loading", &keys::LOADING)?;
    loading.require(&["control"]);
    let control = loading.choice("control", Control::ALL, Control::name);
    if boundary == Some(Boundary::Free)
        && matches!(control, Some(Control::Pressure | Control::MeanGap))
    {
        loading.conflict(
            "control",
            "a free boundary has no nominal area to average over; take \"force\" or \"approach\", or boundary = \"periodic\"",
        );
    }
    let spring = if loading.has("spring") {
        if control.is_some_and(|control| control != Control::Approach) {
            loading.conflict(
                "spring",
                "a spring is held at its far end; take control = \"approach\", or leave the spring out",
            );
        }
        if adhesion.is_some_and(|adhesion| adhesion.treatment == Treatment::Dmt) {
            // The spring would have to balance a load that the solver does not see.
            loading.report(
                "spring",
                SceneError::NotInThisVersion {
                    what: "a spring with treatment = \"dmt\"".to_string(),
                    instead: "take treatment = \"full\", or leave the spring out".to_string(),
                },
            );
        }
        loading
            .quantity("spring", Dimension::ForcePerLength, Allowed::POSITIVE)
            .map(Some)
    } else {
        Some(None)
    };
    let timed = path(&loading, control, adhesion);
    if let Some(timed) = &timed
        && relaxes
        && timed.durations.is_none()
    {
        loading.conflict(
            if loading.has("path") { "path" } else { "ramp" },
            "a solid that relaxes must know how long the load takes; give start and [[loading.ramp]] with duration = \"1 s\" (or hold = \"1 s\")",
        );
        return None;
    }
    let timed = timed?;
    if adhesion.is_some_and(|adhesion| adhesion.rate.is_some())
        && timed
            .durations
            .as_ref()
            .is_none_or(|durations| durations[1..].contains(&0.0))
    {
        loading.conflict(
            if loading.has("path") { "path" } else { "ramp" },
            "an edge that recedes at a rate must know how long the load takes; give start and [[loading.ramp]] with a duration above 0, such as duration = \"1 s\"",
        );
        return None;
    }
    Some(LoadingScene {
        control: control?,
        path: timed.path,
        durations: timed.durations,
        spring: spring?,
    })
}

/// The value of a path, in the unit and within the limits of its control.
struct PathValue {
    dimension: Dimension,
    allowed: Allowed,
}

impl PathValue {
    fn of(control: Control, adhesion: Option<&AdhesionScene>) -> Self {
        let dimension = match control {
            Control::Pressure => Dimension::Pressure,
            Control::Force => Dimension::Force,
            Control::Approach | Control::MeanGap => Dimension::Length,
        };
        // The Lennard-Jones gap is measured from its zero-force distance and may be negative.
        let overlaps = adhesion.is_some_and(|adhesion| {
            adhesion.law == LawName::LennardJones && adhesion.treatment == Treatment::Full
        });
        let allowed = if control == Control::MeanGap && !overlaps {
            Allowed::NOT_NEGATIVE
        } else {
            Allowed::FINITE
        };
        PathValue { dimension, allowed }
    }
}

fn path(
    loading: &Reader,
    control: Option<Control>,
    adhesion: Option<&AdhesionScene>,
) -> Option<TimedPath> {
    let value = control.map(|control| PathValue::of(control, adhesion));
    let has_ramps = loading.has("start") || loading.has("ramp");
    if loading.has("path") && has_ramps {
        loading.conflict(
            "path",
            "stands beside start and [[loading.ramp]]; give either the path or the ramps",
        );
        return None;
    }
    let timed = if has_ramps {
        ramps(loading, value.as_ref())?
    } else {
        loading.require_as(
            "path",
            "path = [\"1 MPa\", \"10 MPa\"]` or `start` with `[[loading.ramp]]",
        );
        let list = loading.list("path", "a list of values")?;
        if list.is_empty() {
            loading.conflict("path", "is empty; give at least one value");
            return None;
        }
        if list.len() > MOST_STEPS {
            loading.conflict("path", format!("is longer than {MOST_STEPS} steps"));
            return None;
        }
        // Without a control the unit of the values is unknown; that mistake has been noted.
        let value = value?;
        let values: Vec<Option<f64>> = list
            .iter()
            .map(|(name, node)| {
                loading.quantity_in(node, "path", name, value.dimension, value.allowed)
            })
            .collect();
        TimedPath {
            path: values.into_iter().collect::<Option<Vec<f64>>>()?,
            durations: None,
        }
    };
    check_least_gap(loading, control, adhesion, &timed.path)?;
    Some(timed)
}

/// One `[[loading.ramp]]`.
struct Ramp {
    /// Where it goes; `None` holds the load.
    to: Option<f64>,
    steps: usize,
    /// How long it takes, s.
    duration: Option<f64>,
}

/// Reads a ramp, without its place among the others.
fn ramp(ramp: &Reader, value: Option<&PathValue>) -> Option<Ramp> {
    let holds = ramp.has("hold");
    if !holds {
        ramp.require(&["to"]);
    }
    for key in ["to", "duration"] {
        if holds && ramp.has(key) {
            ramp.conflict(
                key,
                "hold = \"1 s\" keeps the load for that long; leave this out, or give to and duration in its place",
            );
            return None;
        }
    }
    ramp.require(&["steps"]);
    let steps = ramp
        .whole_number("steps", 1, MOST_STEPS as i64)
        .and_then(|steps| usize::try_from(steps).ok());
    let to = value.and_then(|value| ramp.quantity("to", value.dimension, value.allowed));
    let key = if holds { "hold" } else { "duration" };
    let duration = ramp.quantity(key, Dimension::Time, Allowed::NOT_NEGATIVE);
    if (ramp.has(key) && duration.is_none()) || (!holds && to.is_none()) {
        return None;
    }
    Some(Ramp {
        to,
        steps: steps?,
        duration,
    })
}

/// Steps from `start` over every ramp.
fn ramps(loading: &Reader, value: Option<&PathValue>) -> Option<TimedPath> {
    loading.require_as("start", "start = \"1 MPa\"");
    loading.require_as("ramp", "[[loading.ramp]]` with `to` and `steps");
    let start = value.and_then(|value| loading.quantity("start", value.dimension, value.allowed));
    let readers = loading.tables("ramp", |_| &keys::RAMP)?;
    if loading.is_empty_list("ramp") {
        loading.conflict(
            "ramp",
            "is empty; give at least one ramp with `to` and `steps`",
        );
        return None;
    }
    let ramps: Vec<Option<Ramp>> = readers.iter().map(|reader| ramp(reader, value)).collect();
    let steps = |ramp: &Option<Ramp>| ramp.as_ref().map_or(0, |ramp| ramp.steps);
    if ramps.iter().map(steps).sum::<usize>() >= MOST_STEPS {
        loading.conflict(
            "ramp",
            format!("the ramps add up to more than {MOST_STEPS} steps"),
        );
        return None;
    }
    let takes_time = |ramp: &Reader| ramp.has("hold") || ramp.has("duration");
    if readers.iter().any(takes_time) {
        for reader in readers.iter().filter(|ramp| !takes_time(ramp)) {
            reader.require_as("duration", "duration = \"1 s\"");
        }
    }
    let mut path = vec![start?];
    let mut durations = vec![0.0];
    let mut timed = true;
    let mut from = start?;
    for ramp in ramps {
        let ramp = ramp?;
        let (to, steps) = (ramp.to.unwrap_or(from), ramp.steps);
        path.extend((1..steps).map(|step| {
            let share = step as f64 / steps as f64;
            from + (to - from) * share
        }));
        path.push(to);
        timed &= ramp.duration.is_some();
        let duration = ramp.duration.unwrap_or(0.0) / steps as f64;
        durations.resize(path.len(), duration);
        from = to;
    }
    Some(TimedPath {
        path,
        durations: timed.then_some(durations),
    })
}

/// A Lennard-Jones surface repels without limit at a gap of minus its range.
fn check_least_gap(
    loading: &Reader,
    control: Option<Control>,
    adhesion: Option<&AdhesionScene>,
    path: &[f64],
) -> Option<()> {
    if let Some(Control::MeanGap) = control
        && let Some(AdhesionScene {
            range: Range::Length(range),
            ..
        }) = adhesion
        && path.iter().any(|gap| *gap <= -range)
    {
        loading.conflict(
            "control",
            format!(
                "a mean gap must stay above {}, where the law repels without limit",
                units::format_si(-range, "m")
            ),
        );
        return None;
    }
    Some(())
}
