//! `[loading]`: the path, step by step.

use super::allowed::Allowed;
use super::document::Value;
use super::keys;
use super::reader::Reader;
use super::time_steps::{Cutter, DEFAULT_TOLERANCE, Leg};
use super::{
    AdhesionScene, Boundary, Control, LawName, LoadingScene, Range, SolidScene, Treatment,
};
use crate::units::{self, Dimension};

impl Control {
    /// Whether a load is prescribed, which the surfaces may fail to carry, and not a position.
    pub(crate) fn is_load(self) -> bool {
        matches!(self, Control::Pressure | Control::Force)
    }
}

/// Most steps of a path, so that a typing error cannot exhaust memory.
pub(super) const MOST_STEPS: usize = 1_000_000;

/// The word for automatic `steps` of a ramp.
const AUTO: &str = "auto";

/// Accepted time tolerances: below, the solver's tolerance or the pixels dominate; above, the steps
/// no longer follow the path.
const TIME_TOLERANCE: Allowed = Allowed::new(
    |tolerance| (1e-6..=0.1).contains(&tolerance),
    "from 1e-6 to 0.1",
);

/// The word for a path that pulls on until the surfaces separate.
pub(super) const APART: &str = "apart";

/// Default of `pull_off_tolerance`.
pub(super) const PULL_OFF_TOLERANCE: f64 = 0.01;

/// Accepted pull-off tolerances: below, the solver's tolerance dominates.
const PULL_OFF_TOLERANCES: Allowed = Allowed::new(
    |tolerance| tolerance == 0.0 || (1e-6..=0.5).contains(&tolerance),
    "0 for none, or from 1e-6 to 0.5",
);

/// A path with the duration of each step, if given.
struct TimedPath {
    path: Vec<f64>,
    durations: Option<Vec<f64>>,
}

/// Reads `[loading]`, and checks it against `boundary`, `adhesion` and `solid` as far as these
/// could be read.
pub(super) fn read(
    scene: &Reader,
    boundary: Option<Boundary>,
    adhesion: Option<&AdhesionScene>,
    solid: Option<&SolidScene>,
) -> Option<LoadingScene> {
    scene.require_as(
        "loading",
        "[loading] with control = \"pressure\" and path = [\"1 MPa\"]",
    );
    let loading = scene.table("loading", &keys::LOADING)?;
    loading.require(&["control"]);
    let control = loading.word("control");
    if boundary == Some(Boundary::Free)
        && matches!(control, Some(Control::Pressure | Control::MeanGap))
    {
        loading.conflict(
            "control",
            "a free boundary has no nominal area to average over; take \"force\" or \"approach\", or boundary = \"periodic\"",
        );
    }
    let spring = loading.optional("spring", |key| {
        if control.is_some_and(|control| control != Control::Approach) {
            loading.conflict(
                key,
                "a spring needs a prescribed far end; take control = \"approach\", or leave the spring out",
            );
        }
        if adhesion.is_some_and(|adhesion| adhesion.treatment == Treatment::Dmt) {
            // The spring would have to balance a load that the solver does not know.
            loading.not_in_this_version(
                key,
                "a spring with treatment = \"dmt\"",
                "take treatment = \"full\", or leave the spring out",
            );
        }
        loading.quantity(key, Dimension::ForcePerLength, Allowed::POSITIVE)
    });
    let pull_off_tolerance = loading.or("pull_off_tolerance", PULL_OFF_TOLERANCE, |key| {
        let is_position = matches!(control, Some(Control::Approach | Control::MeanGap));
        if is_position && spring.flatten().is_none() {
            loading.conflict(
                key,
                "applies to a prescribed load and to a spring; take control = \"pressure\" or \"force\", or leave the tolerance out",
            );
        }
        loading.quantity(key, Dimension::Dimensionless, PULL_OFF_TOLERANCES)
    });
    let until = loading.optional("until", |key| {
        loading.choice(key, &[APART], |word| word).map(drop)
    });
    let relaxes = solid.is_some_and(|solid| !solid.relaxation.is_empty());
    let timed = path(&loading, control, adhesion, solid);
    if let Some(timed) = &timed
        && relaxes
        && timed.durations.is_none()
    {
        loading.conflict(
            if loading.has("path") { "path" } else { "ramp" },
            "a viscoelastic solid needs durations; give start and [[loading.ramp]] with duration = \"1 s\" (or hold = \"1 s\")",
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
            "rate-dependent adhesion needs durations; give start and [[loading.ramp]] with a duration above 0, such as duration = \"1 s\"",
        );
        return None;
    }
    if loading.has("until")
        && let Some(durations) = &timed.durations
        && !(timed.path.windows(2).zip(&durations[1..]))
            .any(|(pair, duration)| pair[0] != pair[1] && *duration > 0.0)
    {
        loading.conflict(
            "until",
            "pulls on at the speed of the last [[loading.ramp]] that moves, and none does; give one with a duration above 0",
        );
        return None;
    }
    Some(LoadingScene {
        control: control?,
        path: timed.path,
        durations: timed.durations,
        spring: spring?,
        pull_off_tolerance: pull_off_tolerance?,
        until_apart: until?.is_some(),
    })
}

/// Reads values of a path, in the unit and within the limits of its control.
struct PathValue {
    dimension: Dimension,
    allowed: Allowed,
}

impl PathValue {
    fn for_control(control: Control, adhesion: Option<&AdhesionScene>) -> Self {
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
    solid: Option<&SolidScene>,
) -> Option<TimedPath> {
    let value = control.map(|control| PathValue::for_control(control, adhesion));
    let has_ramps = loading.has("start") || loading.has("ramp");
    if loading.has("path") && has_ramps {
        loading.conflict(
            "path",
            "is given together with start or [[loading.ramp]]; give either the path or the ramps",
        );
        return None;
    }
    let timed = if has_ramps {
        ramps(loading, value.as_ref(), control, adhesion.is_some(), solid)?
    } else {
        no_auto_ramp(loading, &[])?;
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
        // Without a control the unit is unknown; that mistake has been noted.
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
    /// Target value; `None` holds the load.
    to: Option<f64>,
    /// Number of steps; `None` means `auto`.
    steps: Option<usize>,
    /// Duration, s.
    duration: Option<f64>,
}

/// Reads a ramp by itself.
fn ramp(ramp: &Reader, value: Option<&PathValue>, solid: Option<&SolidScene>) -> Option<Ramp> {
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
    let steps = if ramp.is_text("steps", AUTO) {
        may_be_auto(ramp, solid).map(|()| None)
    } else {
        whole_steps(ramp).map(Some)
    };
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

/// Whether a ramp has `steps = "auto"`.
fn is_auto(ramp: &Reader) -> bool {
    ramp.is_text("steps", AUTO)
}

/// The number of steps of a ramp that gives one.
fn whole_steps(ramp: &Reader) -> Option<usize> {
    if let Some(node) = ramp.node("steps")
        && matches!(node.value, Value::Text(_))
    {
        ramp.choice_in(node, "steps", "steps", &[AUTO], |word| word);
        return None;
    }
    let steps = ramp.whole_number("steps", 1, MOST_STEPS as i64)?;
    usize::try_from(steps).ok()
}

/// Notes what a ramp lacks for `steps = "auto"`.
fn may_be_auto(ramp: &Reader, solid: Option<&SolidScene>) -> Option<()> {
    if solid.is_some_and(|solid| solid.relaxation.is_empty()) {
        ramp.conflict(
            "steps",
            "\"auto\" follows the relaxation times of the solid, which has none; give a number of steps, or [[solid.relaxation]]",
        );
        return None;
    }
    if !ramp.has("hold") && !ramp.has("duration") {
        ramp.conflict(
            "steps",
            "\"auto\" needs the duration of the ramp; give duration = \"1 s\", or a number of steps",
        );
        return None;
    }
    Some(())
}

/// Notes a time tolerance that no ramp uses.
fn no_auto_ramp(loading: &Reader, ramps: &[Reader]) -> Option<()> {
    if loading.has("time_tolerance") && !ramps.iter().any(is_auto) {
        loading.conflict(
            "time_tolerance",
            "applies to ramps with steps = \"auto\", and there is none; take \"auto\", or leave the tolerance out",
        );
        return None;
    }
    Some(())
}

/// Steps from `start` over every ramp.
fn ramps(
    loading: &Reader,
    value: Option<&PathValue>,
    control: Option<Control>,
    attracts: bool,
    solid: Option<&SolidScene>,
) -> Option<TimedPath> {
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
    let ramps: Vec<Option<Ramp>> = readers
        .iter()
        .map(|reader| ramp(reader, value, solid))
        .collect();
    let steps = |ramp: &Option<Ramp>| ramp.as_ref().and_then(|ramp| ramp.steps).unwrap_or(0);
    let too_many = || {
        loading.conflict(
            "ramp",
            format!("the ramps add up to more than {MOST_STEPS} steps"),
        );
    };
    if ramps.iter().map(steps).sum::<usize>() >= MOST_STEPS {
        too_many();
        return None;
    }
    no_auto_ramp(loading, &readers)?;
    let tolerance = loading.or("time_tolerance", DEFAULT_TOLERANCE, |key| {
        loading.quantity(key, Dimension::Dimensionless, TIME_TOLERANCE)
    })?;
    let takes_time = |ramp: &Reader| ramp.has("hold") || ramp.has("duration");
    if readers.iter().any(takes_time) {
        for reader in readers.iter().filter(|ramp| !takes_time(ramp)) {
            reader.require_as("duration", "duration = \"1 s\"");
        }
    }
    let ramps = ramps.into_iter().collect::<Option<Vec<Ramp>>>()?;
    let start = start?;
    let mut path = vec![start];
    let mut durations = vec![0.0];
    let mut timed = true;
    let mut from = start;
    let mut cutter = if readers.iter().any(is_auto) {
        Some(Cutter::new(
            solid?,
            control?,
            attracts || loading.has("spring"),
            start,
            &legs(start, &ramps),
            tolerance,
        ))
    } else {
        None
    };
    for (ramp, leg) in ramps.iter().zip(legs(start, &ramps)) {
        let to = leg.to;
        let Some(steps) = ramp.steps else {
            let room = MOST_STEPS.saturating_sub(path.len());
            let Some(shares) = cutter.as_mut()?.cut(&leg, room) else {
                too_many();
                return None;
            };
            for (value, duration) in leg.steps(from, shares) {
                path.push(value);
                durations.push(duration);
            }
            from = to;
            continue;
        };
        if let Some(cutter) = &mut cutter {
            cutter.go(&leg);
        }
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

/// Ramps as target and duration; a ramp without a duration takes no time.
fn legs(start: f64, ramps: &[Ramp]) -> Vec<Leg> {
    let mut from = start;
    let leg = |ramp: &Ramp| {
        from = ramp.to.unwrap_or(from);
        Leg {
            to: from,
            duration: ramp.duration.unwrap_or(0.0),
        }
    };
    ramps.iter().map(leg).collect()
}

/// A Lennard-Jones law diverges at a gap of minus its range.
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
                "a mean gap must stay above {}, where the repulsion diverges",
                units::format_si(-range, "m")
            ),
        );
        return None;
    }
    Some(())
}
