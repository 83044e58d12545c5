//! Pull-off: the greatest tension that a contact carries.
//!
//! Where the load is prescribed it lies between the last step that holds and the first that does not,
//! and is narrowed down by loads between the two, each solved from the last one that held. Where a
//! position is prescribed it is the greatest tension that the path passes; a contact that jumps off a spring
//! ([`find_on_spring`]) carries more between two steps.

use super::between::{Between, Place, Search};
use super::hysteresis::span;
use super::jumps::Ends;
use super::observer::WalkEnd;
use super::row::{State, StepRow};
use super::setup::Setup;
use super::walker::Carried;
use crate::backend::BackendError;
use crate::scene::{Control, LoadingScene};

/// Positions that differ by less than this share of a path's span are one: rounding in single precision leaves as much.
const STILL: f64 = 1e-6;

/// Share of a tension that a curve shows.
const SHOWN: f64 = 0.01;

/// Loads tried for one pull-off at most. Halving gains a thousand in ten, and the least tolerance is 1e-6.
const MOST_TRIALS: usize = 60;

/// A contact that separated under a prescribed load or jumped off a spring, with the tensions that bracket its pull-off, N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PullOff {
    /// The last step that held.
    pub step: usize,
    /// The greatest tension that held; 0 where only compression did.
    pub lower: f64,
    /// The least tension that did not, or that a spring could not pass.
    pub upper: f64,
}

impl PullOff {
    /// The greater of two pull-offs of a path.
    pub(super) fn greater(self, other: Option<PullOff>) -> PullOff {
        match other {
            Some(other) if other.lower >= self.lower => other,
            _ => self,
        }
    }
}

/// Pull-off from the tensions of a path; forces in N, tension positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tension {
    /// No step is under tension.
    None,
    /// The greatest tension of the steps held, and nothing shows that a greater one would not.
    Holds {
        /// The step of the greatest tension.
        step: usize,
        /// That tension.
        force: f64,
    },
    /// A prescribed position has passed the greatest tension.
    Passed {
        /// The step of the greatest tension.
        step: usize,
        /// That tension.
        force: f64,
    },
    /// A prescribed load made the contact let go.
    LetGo(PullOff),
}

impl Tension {
    /// Of the end of a path.
    ///
    /// Under a prescribed position pull-off is the greatest tension from which the surfaces part further. One at which the path ends or
    /// turns back has only held, and so has a greater one on the way in: the steps out passed over pull-off. What surfaces apart still attract each other by, the tail of
    /// a law without an end, is no pull-off.
    pub fn at_end(loading: &LoadingScene, end: &WalkEnd) -> Tension {
        let solved = end.rows.iter().take_while(|row| row.converged).count();
        let rows = &end.rows[..solved];
        let ways = (!loading.control.is_load()).then(|| ways(rows, loading.control));
        let greatest = |way: Option<Way>| {
            let under_tension = rows
                .iter()
                .enumerate()
                .filter(|(_, row)| row.force < 0.0 && row.state != State::Separated);
            let of_way = under_tension.filter(|&(index, _)| match (&ways, way) {
                (Some(ways), Some(way)) => ways[index] == way,
                _ => true,
            });
            of_way
                .map(|(_, row)| (row.step, -row.force))
                .min_by(|a, b| b.1.total_cmp(&a.1))
        };
        let of_all = greatest(None);
        let held = of_all.map_or(0.0, |(_, force)| force);
        if let Some(pull_off) = end.pull_off.filter(|pull_off| pull_off.lower >= held) {
            return Tension::LetGo(pull_off);
        }
        let Some((step, force)) = of_all else {
            return Tension::None;
        };
        if ways.is_some()
            && let Some((step, force)) = greatest(Some(Way::Out))
            && greatest(Some(Way::Held)).is_none_or(|(_, held)| held <= force)
            && held <= (1.0 + SHOWN) * force
        {
            return Tension::Passed { step, force };
        }
        Tension::Holds { step, force }
    }

    /// Whether nothing before this tension of a prescribed position was pressed further: the surfaces may carry more further in.
    pub(crate) fn is_cut_off(self, loading: &LoadingScene, rows: &[StepRow]) -> bool {
        let Tension::Passed { step, .. } = self else {
            return false;
        };
        let places = rows.iter().map(|row| row.place(loading.control));
        let places: Vec<f64> = places.take(step).flatten().collect();
        let still = STILL * span(&places);
        let here = places.last().copied().unwrap_or_default();
        places.iter().all(|place| *place <= here + still)
    }

    /// The pull-off force, if the path shows it.
    pub fn pull_off(self) -> Option<f64> {
        match self {
            Tension::Passed { force, .. } => Some(force),
            Tension::LetGo(found) => Some(found.lower).filter(|force| *force > 0.0),
            Tension::None | Tension::Holds { .. } => None,
        }
    }

    /// The step of that force.
    pub fn step(self) -> Option<usize> {
        self.pull_off()?;
        match self {
            Tension::Passed { step, .. } | Tension::LetGo(PullOff { step, .. }) => Some(step),
            Tension::None | Tension::Holds { .. } => None,
        }
    }

    /// The tensions between which a prescribed load made the contact let go.
    pub fn bounds(self) -> Option<[f64; 2]> {
        match self {
            Tension::LetGo(PullOff { lower, upper, .. }) => Some([lower, upper]),
            _ => None,
        }
    }
}

/// How a path under a prescribed position goes on from a step.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Way {
    /// The surfaces part further, or have parted.
    Out,
    /// They have parted up to here, and go no further.
    Held,
    /// They come together.
    In,
}

/// How a path goes on from each of its steps.
fn ways(rows: &[StepRow], control: Control) -> Vec<Way> {
    let places: Vec<Option<f64>> = rows.iter().map(|row| row.place(control)).collect();
    let known: Vec<f64> = places.iter().copied().flatten().collect();
    let still = STILL * span(&known);
    // Whether a step has the surfaces further apart than another; `None` where both are at one place.
    let is_apart = |from: usize, to: usize| match (places[from], places[to]) {
        _ if rows[to].state == State::Separated => Some(true),
        (Some(here), Some(there)) if (there - here).abs() > still => Some(there < here),
        _ => None,
    };
    (0..rows.len())
        .map(|index| {
            let next = (index + 1..rows.len()).find_map(|to| is_apart(index, to));
            if rows[index].state == State::Separated || next == Some(true) {
                return Way::Out;
            }
            let before = (0..index).rev().find_map(|from| is_apart(index, from));
            match before.or(next.map(|next| !next)) {
                Some(true) => Way::In,
                Some(false) | None => Way::Held,
            }
        })
        .collect()
}

/// Whether a step may end in pull-off, so that the state before it is needed.
pub(super) fn may_let_go(setup: &Setup, value: f64) -> bool {
    setup.scene.loading.control.is_load() && setup.law.is_adhesive() && value < 0.0
}

/// Whether any step of a path may end with the surfaces separated by its tension, under an adhesive law.
pub(super) fn is_tensile(loading: &LoadingScene) -> bool {
    loading.control.is_load()
        && (loading.until_apart || loading.path.iter().any(|value| *value < 0.0))
}

/// Narrows down the pull-off of a step that let go, from the state that the step `step` left; `None`
/// where the watch ended it.
pub(super) fn find(
    between: &mut Between,
    step: usize,
    held: Carried,
) -> Result<Option<PullOff>, BackendError> {
    let setup = between.means.setup;
    let loading = &setup.scene.loading;
    let unit = match loading.control {
        Control::Pressure => setup.surface.grid.area(),
        _ => 1.0,
    };
    let mut lower = Place {
        share: 0.0,
        carried: held,
    };
    // Where there is no load; rounding may leave some, of either sign.
    let unloaded = between.from / (between.from - between.to);
    // Separation under a falling tension is delayed: the tension before is the greatest carried.
    let mut upper = if between.to < between.from { 1.0 } else { 0.0 };
    for _ in 0..MOST_TRIALS {
        let (held, parted) = (between.value(lower.share), between.value(upper));
        let wide = held - parted > loading.pull_off_tolerance * -parted;
        if loading.pull_off_tolerance == 0.0 || !wide {
            break;
        }
        // From compression first to no load: pull-off may be far below the prescribed tension.
        let share = match held > 0.0 && lower.share < unloaded {
            true => unloaded,
            false => 0.5 * (lower.share + upper),
        };
        if share <= lower.share || share >= upper {
            break;
        }
        between.tell(Search::PullOff { held, parted });
        let tried = between.solve(&lower, share)?;
        if between.interrupted {
            return Ok(None);
        }
        if !tried.row.converged {
            break;
        }
        if tried.holds() {
            lower = Place {
                share,
                carried: tried.carried,
            };
        } else {
            upper = share;
        }
    }
    let tension = |share: f64| (-between.value(share) * unit).max(0.0);
    Ok(Some(PullOff {
        step,
        lower: tension(lower.share),
        upper: tension(upper),
    }))
}

/// Narrows down the pull-off of a step that jumped off a spring (N/m), between the states next to the jump; `None` where that is
/// no tension, and where the watch ended it.
///
/// Over a way of the far end the tension grows by what the spring stretches, if the contact gives way by nothing, and by less otherwise.
pub(super) fn find_on_spring(
    between: &mut Between,
    step: usize,
    spring: f64,
    ends: Ends,
) -> Result<Option<PullOff>, BackendError> {
    let tolerance = between.means.setup.scene.loading.pull_off_tolerance;
    let Ends {
        before: mut held,
        mut behind,
    } = ends;
    let tension = |row: &StepRow| -row.force;
    let stretched =
        |between: &Between, from: f64, to: f64| spring * (between.value(from) - between.value(to));
    let mut lower = tension(&held.1);
    if tolerance == 0.0 || lower <= 0.0 || between.to >= between.from {
        return Ok(None);
    }
    let mut more = stretched(between, held.0.share, behind.0);
    for _ in 0..MOST_TRIALS {
        if more <= tolerance * tension(&held.1) {
            break;
        }
        let share = 0.5 * (held.0.share + behind.0);
        let tried = between.solve(&held.0, share)?;
        if between.interrupted {
            return Ok(None);
        }
        if !tried.row.converged {
            break;
        }
        let apart = |row: &StepRow| Some((tried.row.approach? - row.approach?).abs());
        match apart(&held.1) < apart(&behind.1) {
            true => {
                lower = lower.max(tension(&tried.row));
                let place = Place {
                    share,
                    carried: tried.carried,
                };
                held = (place, tried.row);
            }
            false => behind = (share, tried.row),
        }
        more = stretched(between, held.0.share, behind.0);
    }
    Ok(Some(PullOff {
        step,
        lower,
        upper: lower.max(tension(&held.1) + more),
    }))
}
