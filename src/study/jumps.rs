//! Jumps: steps in which a branch of equilibria ends, so that the surfaces move to another.
//!
//! Along a branch of equilibria the force is the slope of the energy. So forces and energies at the ends
//! of a step give the slope of the force there, and so does the step before. Where the two agree the step
//! is part of one smooth curve. Where they do not, and energy is missing, the step is halved, and then its
//! worse half: the apparent loss of a smooth curve falls with the third power of its length, that of a jump
//! stays.

use super::between::{Between, Place, Search};
use super::evaluation::{Evaluation, PointState};
use super::hysteresis::Hysteresis;
use super::row::{State, StepRow};
use super::setup::Setup;
use super::walker::Carried;
use crate::backend::{BackendError, Share};
use crate::scene::Control;

/// Losses below this share of w times the area that changed state are ignored: contact edges move from pixel
/// to pixel, which makes the force uneven by as much.
const LEAST_SHARE: f64 = 0.01;
/// A step in which the surfaces come together or part is examined, whatever it loses, if the force changes by more than this share of
/// itself.
const FALLS: f64 = 0.1;
/// A curve has a kink where its slopes on the two sides differ by more than this share of the steeper.
const KINK: f64 = 0.3;
/// A half with less than this share of the whole's loss is smooth: it falls to a quarter, or to a third beside
/// the end of a branch.
const SHRINKS: f64 = 0.45;
/// Such halvings in a row that end the search.
const SHRINKING: usize = 3;
/// A half with more than this share of the whole's loss contains a jump: half of a smooth curve has an
/// eighth.
const KEEPS: f64 = 0.3;
/// Halvings in a row that must keep the loss.
const KEEPING: usize = 2;
/// One halving suffices if the half keeps this share of the loss, and the loss is so many times its
/// uncertainty.
const SURE: [f64; 2] = [0.7, 2.0];
/// Tolerance of the states in a step, of which no row is kept: a loss that counts is a hundredth of the work of the points that
/// changed, and an energy is right to the square of the residual.
const SEARCHED_TO: f64 = 1e-4;
/// Halvings of a step at most.
const MOST_HALVINGS: usize = 8;

/// Which way a step jumped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Jump {
    /// More area adheres after it.
    In,
    /// Less area adheres after it.
    Off,
}

/// Whether a step jumped, judged from its two ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Verdict {
    /// It follows a branch.
    Follows,
    /// It jumped.
    Jumped(Jump),
    /// It jumped that way if its loss stays when it is halved; losses below `least` (J) do not count.
    Perhaps { way: Jump, least: f64 },
}

/// Watches the steps of a path for jumps.
pub struct Jumps {
    /// Work of adhesion, J/m^2; `None` where nothing can jump.
    work: Option<f64>,
    pixel_area: f64,
    prescribed: Prescribed,
    /// The solver's tolerance: the relative error of the energies.
    tolerance: f64,
    /// Factors on the law's tension.
    law_factor: Option<Vec<f64>>,
    /// The points that this process holds.
    share: Share,
    before: Option<Before>,
}

struct Before {
    row: StepRow,
    points: Option<Vec<PointState>>,
    /// Slope of force over approach at its end, where the step before it follows a branch.
    slope: Option<f64>,
}

impl Jumps {
    /// A watch for the steps of a setup. Without adhesion nothing jumps, and some effects hide jumps.
    pub fn new(setup: &Setup) -> Self {
        let adhesive = setup.law.is_adhesive() && !setup.effects.hide_jumps();
        Jumps {
            work: adhesive.then(|| setup.law.work_of_adhesion()),
            pixel_area: setup.surface.grid.pixel_area(),
            prescribed: Prescribed::for_setup(setup),
            tolerance: setup.scene.solver.tolerance,
            law_factor: setup.surface.adhesion_map.clone(),
            share: setup.problem.share.clone(),
            before: None,
        }
    }

    /// Takes the steps that another process did: their rows, the points after the last one, and whether
    /// that one jumped.
    pub fn resume(&mut self, rows: &[StepRow], points: Option<Vec<PointState>>, jumped: bool) {
        if let (Some(_), [.., row]) = (self.work, rows) {
            let slope = match rows {
                [.., before, row] if !jumped => Piece::between(self.prescribed, before, row)
                    .and_then(|piece| piece.slope_after()),
                _ => None,
            };
            self.before = Some(Before {
                row: row.clone(),
                points,
                slope,
            });
        }
    }

    /// Whether steps are watched, so that the state before each is needed.
    pub fn watches(&self) -> bool {
        self.work.is_some()
    }

    /// States of the points in the last step, where it had fields.
    pub fn points(&self) -> Option<&[PointState]> {
        self.before.as_ref()?.points.as_deref()
    }

    /// Classifies a converged step before it is taken.
    pub(super) fn judge(&self, row: &StepRow, evaluation: Option<&Evaluation>) -> Verdict {
        let (Some(work), Some(before)) = (self.work, &self.before) else {
            return Verdict::Follows;
        };
        let adhering = |row: &StepRow| row.contact_area_fraction + row.attractive_area_fraction;
        let way = if adhering(row) > adhering(&before.row)
            || (adhering(row) == adhering(&before.row)
                && row.contact_area_fraction > before.row.contact_area_fraction)
        {
            Jump::In
        } else {
            Jump::Off
        };
        let points = evaluation.map(|evaluation| &evaluation.points);
        match (&before.points, points) {
            (Some(old), Some(new)) => {
                // Points that changed, each by how strongly it adheres.
                let strength =
                    |point: usize| self.law_factor.as_ref().map_or(1.0, |map| map[point]);
                let width = self.share.surface()[0];
                let rows = old.len() / width;
                let [changed] = self.share.sums(rows, |row, [changed]| {
                    for point in row * width..(row + 1) * width {
                        if old[point] != new[point] {
                            *changed += strength(point);
                        }
                    }
                });
                let energies =
                    [&before.row, row].map(|row| row.elastic_energy - row.adhesive_energy);
                let least = (LEAST_SHARE * work * changed * self.pixel_area)
                    .max(self.tolerance * (energies[0] + energies[1]));
                // A force that is level and then falls may lose nothing by the straight line between two long steps.
                let greatest = before.row.force.abs().max(row.force.abs());
                let falls = |piece: Piece| {
                    before.row.state != row.state && piece.change.abs() > FALLS * greatest
                };
                let examined = |piece: Piece| {
                    falls(piece) || piece.lost.abs() > least && piece.bends(before.slope)
                };
                match Piece::between(self.prescribed, &before.row, row) {
                    Some(piece) if changed > 0.0 && examined(piece) => {
                        Verdict::Perhaps { way, least }
                    }
                    _ => Verdict::Follows,
                }
            }
            // Under a prescribed load the parted surfaces have no position, so no energy either:
            // parting and meeting are jumps wherever something adhered.
            (Some(_), None) if before.row.state != State::Separated => Verdict::Jumped(Jump::Off),
            (None, Some(_)) if row.state != State::Separated => Verdict::Jumped(Jump::In),
            _ => Verdict::Follows,
        }
    }

    /// Takes a step with what was found of it.
    pub(super) fn take(&mut self, row: &StepRow, evaluation: Option<&Evaluation>, jumped: bool) {
        if self.work.is_none() {
            return;
        }
        let before = self.before.take().filter(|_| !jumped);
        self.before = Some(Before {
            slope: before
                .and_then(|before| Piece::between(self.prescribed, &before.row, row))
                .and_then(|piece| piece.slope_after()),
            row: row.clone(),
            points: evaluation.map(|evaluation| evaluation.points.clone()),
        });
    }

    /// What a path that returns to its start loses, with its rows and the numbers of those that jumped.
    pub(super) fn hysteresis(
        &self,
        path: &[f64],
        rows: &[StepRow],
        jumped: &[usize],
    ) -> Option<Hysteresis> {
        Hysteresis::of_loop(self.prescribed, path, rows, |row| {
            jumped.contains(&row.step)
        })
    }
}

/// The quantity that a path prescribes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Prescribed {
    /// What is prescribed.
    pub(super) control: Control,
    /// Spring between the prescribed approach and the body, N/m.
    pub(super) spring: Option<f64>,
}

impl Prescribed {
    fn for_setup(setup: &Setup) -> Prescribed {
        Prescribed {
            control: setup.scene.loading.control,
            spring: setup.spring(),
        }
    }
}

/// A piece of a path between two solved states.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    /// Change of approach, m.
    moved: f64,
    /// Change of force, N.
    change: f64,
    /// Work done less what is stored and what the solid dissipates, J, where the force follows the
    /// straight line.
    pub(super) lost: f64,
    /// Error of the work if the piece jumps at one of its ends, J: it falls with the length of the piece,
    /// whether force or position is prescribed.
    pub(super) doubt: f64,
}

impl Piece {
    /// The piece between two rows; `None` where one has no position.
    pub(super) fn between(
        prescribed: Prescribed,
        before: &StepRow,
        row: &StepRow,
    ) -> Option<Piece> {
        let moved = row.approach? - before.approach?;
        let change = row.force - before.force;
        Some(Piece {
            moved,
            change,
            lost: dissipation(before, row)?,
            doubt: match (prescribed.control, prescribed.spring) {
                // The compliance below the gap moves in a jump too, on its own straight line.
                (Control::MeanGap, _) => change * (row.mean_gap? - before.mean_gap?),
                // And so does a spring.
                (_, Some(spring)) => moved * change.abs().min((change + spring * moved).abs()),
                (_, None) => change * moved,
            }
            .abs(),
        })
    }

    fn size(&self) -> f64 {
        self.lost.abs() + self.doubt
    }

    /// Slope of the force over the approach at the beginning of the piece, if it is a parabola: the missing
    /// energy is the area between it and the straight line.
    fn slope_before(&self) -> Option<f64> {
        let slope = (self.change - 6.0 * self.lost / self.moved) / self.moved;
        slope.is_finite().then_some(slope)
    }

    /// The same where it ends.
    fn slope_after(&self) -> Option<f64> {
        let slope = (self.change + 6.0 * self.lost / self.moved) / self.moved;
        slope.is_finite().then_some(slope)
    }

    /// Whether the slope differs from that at the end of the piece before.
    fn bends(&self, slope: Option<f64>) -> bool {
        match (slope, self.slope_before()) {
            (Some(slope), Some(own)) => {
                let steepest = own
                    .abs()
                    .max(slope.abs())
                    .max((self.change / self.moved).abs());
                (own - slope).abs() > KINK * steepest
            }
            // A parabola that starts level loses up to a sixth of the uncertainty.
            (None, Some(_)) => self.lost.abs() > self.doubt / 6.0,
            (_, None) => false,
        }
    }
}

/// A stretch of a step.
struct Stretch {
    /// Where it begins, with its row.
    start: (Place, StepRow),
    /// At which share of the step it ends, with its row.
    end: (f64, StepRow),
    whole: Piece,
}

/// Which half of a stretch a search follows.
#[derive(Clone, Copy, PartialEq)]
enum Followed {
    /// The one in which separated surfaces meet or part, since compression alone may weigh more than that jump. Where
    /// the other weighs more, it is searched first: attraction may set in smoothly before the surfaces jump.
    Parting,
    /// The one that weighs more.
    Heavier,
}

/// The states next to a jump that a search came to.
pub(super) struct Ends {
    /// The last before it.
    pub before: (Place, StepRow),
    /// The share of the step at which the first behind it is, with its row.
    pub behind: (f64, StepRow),
}

/// What a search for a jump found.
pub(super) enum Confirmed {
    /// The step jumped; with the states next to it, where both have a position.
    Jumped(Option<Box<Ends>>),
    /// It did not.
    Smooth,
    /// A load of the search did not converge; whether the step jumped as far as the loads before it show.
    Guessed(bool),
    /// The watch ended the search.
    Interrupted,
}

/// Whether a step between two rows jumped, found by halving it from the state before it. Losses below
/// `least` (J) do not count.
pub(super) fn confirm(
    between: &mut Between,
    before: &StepRow,
    state: Carried,
    row: &StepRow,
    least: f64,
) -> Result<Confirmed, BackendError> {
    let prescribed = Prescribed::for_setup(between.means.setup);
    let Some(whole) = Piece::between(prescribed, before, row) else {
        return Ok(Confirmed::Jumped(None));
    };
    between.tell(Search::Jump);
    let tolerance = &mut between.means.tolerance;
    *tolerance = tolerance.max(SEARCHED_TO);
    let start = Place {
        share: 0.0,
        carried: state,
    };
    let stretch = Stretch {
        start: (start, before.clone()),
        end: (1.0, row.clone()),
        whole,
    };
    follow(between, stretch, least, Followed::Parting)
}

/// The search in a stretch.
fn follow(
    between: &mut Between,
    stretch: Stretch,
    least: f64,
    followed: Followed,
) -> Result<Confirmed, BackendError> {
    let prescribed = Prescribed::for_setup(between.means.setup);
    let Stretch {
        mut start,
        mut end,
        mut whole,
    } = stretch;
    let (mut keeping, mut shrinking) = (0, 0);
    for _ in 0..MOST_HALVINGS {
        let share = 0.5 * (start.0.share + end.0);
        let tried = between.solve(&start.0, share)?;
        if between.interrupted {
            return Ok(Confirmed::Interrupted);
        }
        if !tried.row.converged {
            // Where the surfaces came together or parted, they may well have jumped.
            return Ok(Confirmed::Guessed(
                keeping > 0 || start.1.state != end.1.state,
            ));
        }
        let pieces = Piece::between(prescribed, &start.1, &tried.row)
            .zip(Piece::between(prescribed, &tried.row, &end.1));
        let Some((first, second)) = pieces else {
            // Separated between the two places.
            return Ok(Confirmed::Jumped(None));
        };
        let parts = |a: &StepRow, b: &StepRow| {
            followed == Followed::Parting
                && (a.state == State::Separated) != (b.state == State::Separated)
        };
        let parting = [parts(&start.1, &tried.row), parts(&tried.row, &end.1)];
        let is_first = match parting {
            [true, false] => true,
            [false, true] => false,
            _ => first.size() > second.size(),
        };
        let (half, other) = match is_first {
            true => (first, second),
            false => (second, first),
        };
        let bends = second.bends(first.slope_after());
        let middle = Place {
            share,
            carried: tried.carried,
        };
        let beside = if is_first {
            let ended = std::mem::replace(&mut end, (share, tried.row.clone()));
            Stretch {
                start: (middle, tried.row),
                end: ended,
                whole: other,
            }
        } else {
            let began = std::mem::replace(&mut start, (middle, tried.row.clone()));
            Stretch {
                start: began,
                end: (share, tried.row),
                whole: other,
            }
        };
        if bends && other.size() > half.size().max(least) {
            let found = follow(between, beside, least, Followed::Heavier)?;
            if !matches!(found, Confirmed::Smooth) {
                return Ok(found);
            }
        }
        if half.size() <= least {
            return Ok(Confirmed::Smooth);
        }
        // Of a jump the force keeps its change, whatever the losses of the halves are.
        // Nor does what compression leaves behind say that none is there.
        let shrinks = parting[0] == parting[1]
            && half.size() < SHRINKS * whole.size()
            && half.doubt < SHRINKS * whole.doubt;
        shrinking = match shrinks {
            true => shrinking + 1,
            false => 0,
        };
        if shrinking > 0 && !bends || shrinking == SHRINKING {
            return Ok(Confirmed::Smooth);
        }
        keeping = match half.lost > least.max(half.doubt) && half.lost > KEEPS * whole.lost {
            true if half.lost > (SURE[0] * whole.lost).max(SURE[1] * half.doubt) => KEEPING,
            true => keeping + 1,
            false => 0,
        };
        if keeping == KEEPING {
            break;
        }
        whole = half;
    }
    Ok(match keeping {
        0 => Confirmed::Smooth,
        _ => Confirmed::Jumped(Some(Box::new(Ends {
            before: start,
            behind: end,
        }))),
    })
}

/// Work done on the surfaces in a step less what they store and what the solid dissipates, J.
pub fn dissipation(before: &StepRow, row: &StepRow) -> Option<f64> {
    let moved = row.approach? - before.approach?;
    let work = 0.5 * (before.force + row.force) * moved;
    let stored =
        row.elastic_energy + row.adhesive_energy - before.elastic_energy - before.adhesive_energy;
    // The dissipation of the solid is no jump's.
    let dissipated = row.dissipated_energy() - before.dissipated_energy();
    Some(work - stored - dissipated)
}
