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
        let ways = (!loading.control.is_load()).then(|| ways(rows, loading));
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
        let places = rows.iter().map(|row| row.prescribed_place(loading));
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
fn ways(rows: &[StepRow], loading: &LoadingScene) -> Vec<Way> {
    let places: Vec<Option<f64>> = rows
        .iter()
        .map(|row| row.prescribed_place(loading))
        .collect();
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

/// A state before the jump of a step.
#[derive(Clone, Copy)]
struct Known {
    /// Where the far end is, as a share of the step.
    share: f64,
    /// The tension, N.
    tension: f64,
}

impl Known {
    /// How fast the tension grows from here to a later state, N over the whole step.
    fn slope_to(self, later: Known) -> f64 {
        (later.tension - self.tension) / (later.share - self.share)
    }
}

/// A piece of a step between two neighbours of which one has the greatest known tension, or between that one and the jump.
#[derive(Clone, Copy)]
struct Neighbours {
    /// The shares at its ends.
    ends: [f64; 2],
    /// The most that the tension may be between them, N.
    most: f64,
}

/// The pieces before and behind the greatest known tension (at `greatest`), where the spring stretches by `stretch`, N, over the whole step,
/// and the contact jumps at `jump`.
///
/// Over a way of the far end the tension grows by what the spring stretches, if the contact gives way by nothing, and by less
/// otherwise. Between two states it lies below the straight lines through their neighbours and them, as it bends one way.
fn beside_greatest(
    known: &[Known],
    greatest: usize,
    stretch: f64,
    jump: f64,
) -> [Option<Neighbours>; 2] {
    let at = known[greatest];
    let line =
        |from: Known, slope: f64, share: f64| from.tension + slope * (share - from.share).abs();
    let two_before = greatest.checked_sub(2).map(|index| known[index]);
    let before = greatest.checked_sub(1).map(|index| known[index]);
    let behind = known.get(greatest + 1).copied();
    let rising = before.map(|before| {
        let by_spring = line(before, stretch, at.share);
        let by_earlier = two_before.map(|two| line(before, two.slope_to(before), at.share));
        let by_later = behind.map(|behind| line(at, -at.slope_to(behind), before.share));
        let bounds = [Some(by_spring), by_earlier, by_later]
            .into_iter()
            .flatten();
        Neighbours {
            ends: [before.share, at.share],
            most: bounds.fold(f64::INFINITY, f64::min),
        }
    });
    let end = behind.map_or(jump, |behind| behind.share);
    let by_spring = line(at, stretch, end);
    // The last way before a jump may be steep.
    let by_earlier = before.filter(|_| behind.is_some());
    let by_earlier = by_earlier.map(|before| line(at, before.slope_to(at), end));
    let falling = Neighbours {
        ends: [at.share, end],
        most: by_earlier.map_or(by_spring, |most| most.min(by_spring)),
    };
    [rising, Some(falling)]
}

/// Narrows down the pull-off of a step that jumped off a spring (N/m), from the state before the step, its row and the states next to the
/// jump: the greatest tension before the jump, whether the tension still grows there or already falls. `None` if the start of the step has
/// the greatest tension, if no state is under tension, or if the watch ended the search.
pub(super) fn find_on_spring(
    between: &mut Between,
    (first, row): (Carried, &StepRow),
    spring: f64,
    ends: Ends,
) -> Result<Option<PullOff>, BackendError> {
    let tolerance = between.means.setup.scene.loading.pull_off_tolerance;
    let Ends {
        before: (mut held, last),
        mut behind,
    } = ends;
    let stretch = spring * (between.from - between.to);
    if tolerance == 0.0 || stretch <= 0.0 {
        return Ok(None);
    }
    let known = |share: f64, row: &StepRow| Known {
        share,
        tension: -row.force,
    };
    let mut states = vec![known(0.0, row)];
    if held.share > 0.0 {
        states.push(known(held.share, &last));
    }
    // The last state from which all later ones are reached.
    let mut early = Place {
        share: 0.0,
        carried: first,
    };
    let mut last = last.approach;
    for _ in 0..MOST_TRIALS {
        let Some((greatest, _, Some([from, to]))) =
            open_piece(&states, stretch, behind.0, tolerance)
        else {
            break;
        };
        let share = 0.5 * (from + to);
        let start = if from >= held.share { &held } else { &early };
        let tried = between.solve(start, share)?;
        if between.interrupted {
            return Ok(None);
        }
        let distance = |to: Option<f64>| Some((tried.row.approach? - to?).abs());
        if !tried.row.converged {
            break;
        }
        if distance(last) >= distance(behind.1.approach) {
            if share < held.share {
                break;
            }
            behind = (share, tried.row);
            continue;
        }
        let place = states.partition_point(|state| state.share < share);
        let state = known(share, &tried.row);
        let is_before =
            state.share < states[greatest].share && state.tension <= states[greatest].tension;
        states.insert(place, state);
        let carried = tried.carried;
        if share > held.share {
            last = tried.row.approach;
            held = Place { share, carried };
        } else if is_before && share > early.share {
            early = Place { share, carried };
        }
    }
    let found = open_piece(&states, stretch, behind.0, tolerance);
    Ok(found.map(|(greatest, upper, _)| PullOff {
        step: row.step,
        lower: states[greatest].tension,
        upper,
    }))
}

/// The index of the greatest known tension, an upper bound of the tension, and the piece to be halved next if the two differ by more than
/// the tolerance. `None` if the first of several states has the greatest tension, or if no state is under tension.
fn open_piece(
    states: &[Known],
    stretch: f64,
    jump: f64,
    tolerance: f64,
) -> Option<(usize, f64, Option<[f64; 2]>)> {
    let tensions = states.iter().map(|state| state.tension);
    let (greatest, lower) = tensions.enumerate().max_by(|a, b| a.1.total_cmp(&b.1))?;
    if lower <= 0.0 || (greatest == 0 && states.len() > 1) {
        return None;
    }
    let pieces = beside_greatest(states, greatest, stretch, jump);
    let pieces = pieces.into_iter().flatten();
    let widest = pieces.max_by(|a, b| a.most.total_cmp(&b.most))?;
    let upper = lower.max(widest.most);
    let is_open = upper - lower > tolerance * upper;
    Some((greatest, upper, is_open.then_some(widest.ends)))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TOLERANCE: f64 = 1e-3;

    /// States at these shares of a step, of a tension that has its maximum 1 at 0.6.
    fn states(shares: &[f64]) -> Vec<Known> {
        let tension = |share: &f64| 1.0 - (share - 0.6).powi(2);
        let known = |share: &f64| Known {
            share: *share,
            tension: tension(share),
        };
        shares.iter().map(known).collect()
    }

    /// The spring adds at most 1.5 over the step, which is more than the tension ever grows by; the contact jumps at 0.9.
    fn searched(shares: &[f64]) -> Option<(usize, f64, Option<[f64; 2]>)> {
        open_piece(&states(shares), 1.5, 0.9, TOLERANCE)
    }

    /// Halving the pieces that are asked for comes to the maximum in a few trials, and the bound never excludes it.
    #[test]
    fn halving_brackets_a_maximum_that_was_passed() {
        let mut shares = vec![0.0, 0.8];
        for trial in 0.. {
            let (greatest, upper, open) = searched(&shares).expect("it rises first");
            let lower = states(&shares)[greatest].tension;
            assert!(lower <= 1.0 && upper >= 1.0, "{shares:?}: {lower} {upper}");
            let Some([from, to]) = open else {
                assert!(upper - lower <= TOLERANCE * upper);
                break;
            };
            assert!(trial < 12, "{shares:?}");
            shares.push(0.5 * (from + to));
            shares.sort_by(f64::total_cmp);
        }
    }

    /// Before a jump the tension may still grow, by what the spring stretches.
    #[test]
    fn the_way_to_the_jump_counts_with_the_whole_spring() {
        let states = &states(&[0.4, 0.45, 0.5]);
        let (greatest, upper, open) = open_piece(states, 1.5, 0.52, TOLERANCE).expect("it rises");
        assert_eq!((greatest, open), (2, Some([0.5, 0.52])));
        assert!(
            (upper - (states[2].tension + 1.5 * 0.02)).abs() < 1e-12,
            "{upper}"
        );
    }

    /// If the start of a step has the greatest tension, the maximum may lie before the step.
    #[test]
    fn a_tension_that_falls_during_the_whole_step_has_no_bracket() {
        assert!(searched(&[0.7, 0.8]).is_none());
        let compressed = Known {
            share: 0.0,
            tension: -1.0,
        };
        assert!(open_piece(&[compressed], 1.5, 0.9, TOLERANCE).is_none());
    }
}
