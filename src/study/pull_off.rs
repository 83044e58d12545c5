//! Pull-off: the greatest tension that a contact carries.
//!
//! Where the load is prescribed it lies between the last step that holds and the first that does not,
//! and is narrowed down by loads between the two, each solved from the last one that held. Where a
//! position is prescribed it is the greatest tension that the path passes.

use super::between::{Between, Place, Search};
use super::observer::WalkEnd;
use super::row::{State, StepRow};
use super::setup::Setup;
use super::walker::Carried;
use crate::backend::BackendError;
use crate::scene::{Control, LoadingScene};

/// Loads tried for one pull-off at most. Halving gains a thousand in ten, and the least tolerance is 1e-6.
const MOST_TRIALS: usize = 60;

/// A contact that separated under a prescribed load, with the tensions that bracket its pull-off, N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PullOff {
    /// The last step that held.
    pub step: usize,
    /// The greatest tension that held; 0 where only compression did.
    pub lower: f64,
    /// The least tension that did not.
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
    pub fn at_end(loading: &LoadingScene, end: &WalkEnd) -> Tension {
        let under_tension = end.rows.iter().filter(|row| row.force < 0.0);
        let greatest = under_tension.min_by(|a, b| a.force.total_cmp(&b.force));
        let held = greatest.map_or(0.0, |row| -row.force);
        if let Some(pull_off) = end.pull_off.filter(|pull_off| pull_off.lower >= held) {
            return Tension::LetGo(pull_off);
        }
        let Some(row) = greatest else {
            return Tension::None;
        };
        let (step, force) = (row.step, held);
        let recedes = row.state == State::Separated || recede(&end.rows[step - 1..]);
        match is_load(loading) || !recedes {
            true => Tension::Holds { step, force },
            false => Tension::Passed { step, force },
        }
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

/// Whether the surfaces part on the way through these steps.
fn recede(rows: &[StepRow]) -> bool {
    rows.windows(2)
        .any(|pair| pair[1].state == State::Separated || pair[1].mean_gap > pair[0].mean_gap)
}

fn is_load(loading: &LoadingScene) -> bool {
    matches!(loading.control, Control::Pressure | Control::Force)
}

/// Whether a step may end in pull-off, so that the state before it is needed.
pub(super) fn may_let_go(setup: &Setup, value: f64) -> bool {
    is_load(&setup.scene.loading) && setup.law.is_adhesive() && value < 0.0
}

/// Whether any step of a path may end with the surfaces separated by its tension, under an adhesive law.
pub(super) fn is_tensile(loading: &LoadingScene) -> bool {
    is_load(loading) && (loading.until_apart || loading.path.iter().any(|value| *value < 0.0))
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
    // Separation under a falling tension is delayed: the tension before is the greatest carried.
    let mut upper = if between.to < between.from { 1.0 } else { 0.0 };
    for _ in 0..MOST_TRIALS {
        let (held, parted) = (between.value(lower.share), between.value(upper));
        let wide = held - parted > loading.pull_off_tolerance * -parted;
        if loading.pull_off_tolerance == 0.0 || !wide {
            break;
        }
        // From compression first to no load: pull-off may be far below the prescribed tension.
        let share = match held > 0.0 {
            true => between.from / (between.from - between.to),
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
