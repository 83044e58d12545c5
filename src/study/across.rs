//! Attraction across a gap without contact.

use super::setup::Setup;

/// Gaps without contact at which the attraction is looked at, their factor, and the first of them in ranges
/// of the law: up to some fifteen ranges, where an attraction is a thousandth of its peak.
const CLEARANCES: i32 = 24;
const CLEARANCE_RUNG: f64 = 1.5;
const CLOSEST: f64 = 1e-3;
/// Halvings of a clearance between two of these, to rounding.
const CLEARANCE_HALVINGS: usize = 60;

/// Mean attraction across a gap without contact, Pa: the undeformed surfaces at `clearance` (m) from
/// first touch.
pub fn attraction_across(setup: &Setup, clearance: f64) -> f64 {
    let heights = setup.surface.heights.as_slice();
    let share = &setup.problem.share;
    let highest = share.greatest_of(heights);
    let width = setup.surface.grid.nx;
    let [sum] = share.sums(heights.len() / width, |row, [sum]| {
        let line = heights.iter().enumerate().skip(row * width).take(width);
        for (i, height) in line {
            let gap = highest - height + clearance;
            *sum += setup.law_factor(i) * setup.law.traction(gap);
        }
    });
    sum / setup.surface.grid.len() as f64
}

/// The clearance (m) at which surfaces without contact attract most, and that mean attraction, Pa.
///
/// At a wall the attraction falls with the gap, so this is first touch. Lennard-Jones attracts most at a finite
/// gap: nearly flat surfaces carry the greatest tension just out of contact.
pub fn greatest_across(setup: &Setup) -> (f64, f64) {
    let tension = |clearance: f64| attraction_across(setup, clearance);
    let mut best = (0.0, tension(0.0));
    if setup.law.has_wall() {
        return best;
    }
    let range = setup.law.range();
    let mut look = |clearance: f64| {
        let pull = tension(clearance);
        if pull > best.1 {
            best = (clearance, pull);
        }
        best
    };
    for i in 0..=CLEARANCES {
        look(CLOSEST * CLEARANCE_RUNG.powi(i) * range);
    }
    let (place, _) = look(0.0);
    let ends = [place / CLEARANCE_RUNG, place * CLEARANCE_RUNG];
    for i in 0..=CLEARANCES {
        look(ends[0] + (ends[1] - ends[0]) * f64::from(i) / f64::from(CLEARANCES));
    }
    best
}

/// The clearance (m) at which the surfaces hold a mean tension (Pa) without contact: the nearest one, where the
/// attraction grows with the gap, so that a load held there stays. `None` where first touch holds more, or
/// nothing holds as much.
pub(crate) fn held_across(setup: &Setup, tension: f64) -> Option<f64> {
    let (place, most) = greatest_across(setup);
    if tension > most || tension <= attraction_across(setup, 0.0) {
        return None;
    }
    let (mut near, mut far) = (0.0, place);
    for _ in 0..CLEARANCE_HALVINGS {
        let middle = 0.5 * (near + far);
        if attraction_across(setup, middle) < tension {
            near = middle;
        } else {
            far = middle;
        }
    }
    Some(far)
}
