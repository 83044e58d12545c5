//! The mean gaps at which pull-off is searched on retraction: at first those at which contact and tension change little from
//! one to the next, then no longer than `WIDEST`, and finer around every maximum of the tension that may be the greatest
//! and is not yet known to `RESOLVED`.
//!
//! A contact of few spots lets go spot by spot, and its tension falls suddenly with each: just before the next fall it is
//! higher than at any gap that was tried, by up to its last rise. That rise is what a maximum is uncertain by. Steps
//! have to be small on the whole way, since one that passes the end of a branch ends in a contact that holds less. The
//! last summits are so few pixels that their change is small in any step, which is why a length bounds it as well.

/// Longest step, as a share of the whole way.
const WIDEST: f64 = 1.0 / 32.0;
/// Parts into which the gaps on either side of a maximum are divided.
const FINER: usize = 16;
/// Times that gaps become finer at most.
const ROUNDS: usize = 3;
/// Maxima that are looked at more closely in a round, the highest first.
const PEAKS: usize = 3;
/// Least share of the greatest tension from which a maximum may turn out to be the greatest.
const MAY_BE: f64 = 0.9;
/// Share of the greatest tension up to which a maximum is known.
const RESOLVED: f64 = 0.01;
/// Room for rounding where a step is as long as it may be.
const ROOM: f64 = 1e-9;

/// Mean gap, m, and mean tension, Pa, of a state.
pub(super) type Held = (f64, f64);

/// The gaps of a retraction, and how often they have become finer.
pub(super) struct Retraction {
    gaps: Vec<f64>,
    rounds: usize,
}

impl Retraction {
    /// The gaps of a first retraction, from these states, and on to the farthest, m.
    pub fn along(states: &[Held], farthest: f64) -> Retraction {
        let mut gaps: Vec<f64> = states.iter().map(|state| state.0).collect();
        if gaps.last().is_some_and(|last| *last < farthest) {
            gaps.push(farthest);
        }
        Retraction { gaps, rounds: 0 }
    }

    /// The mean gaps, growing.
    pub fn gaps(&self) -> &[f64] {
        &self.gaps
    }

    /// Adds gaps, from a retraction over the present ones; false where pull-off is known.
    pub fn refine(&mut self, states: &[Held]) -> bool {
        let (Some(closest), Some(farthest)) = (self.gaps.first(), self.gaps.last()) else {
            return false;
        };
        if self.rounds == ROUNDS {
            return false;
        }
        let is_first = self.rounds == 0;
        let widest = match is_first {
            true => WIDEST * (farthest - closest),
            false => f64::INFINITY,
        };
        let places = self.unknown_maxima(states, is_first);
        let mut finer = Vec::with_capacity(2 * self.gaps.len() + 2 * PEAKS * FINER);
        for (i, pair) in self.gaps.windows(2).enumerate() {
            let length = pair[1] - pair[0];
            let parts = match places.contains(&i) || places.contains(&(i + 1)) {
                true => FINER,
                false => (length / widest - ROOM).ceil().max(1.0) as usize,
            };
            let part = length / parts as f64;
            finer.extend((0..parts).map(|k| pair[0] + part * k as f64));
        }
        finer.extend(self.gaps.last());
        let grows = finer.len() > self.gaps.len();
        self.gaps = finer;
        self.rounds += 1;
        grows
    }

    /// Places among the gaps of the maxima that are not known yet, and of the greatest where it `always` counts.
    fn unknown_maxima(&self, states: &[Held], always: bool) -> Vec<usize> {
        let tension = |i: usize| states.get(i).map_or(0.0, |state| state.1.max(0.0));
        let before = |i: usize| i.checked_sub(1).map_or(tension(i), tension);
        let greatest = (0..states.len()).map(tension).fold(0.0, f64::max);
        let mut peaks: Vec<usize> = (0..states.len())
            .filter(|&i| tension(i) > tension(i + 1) && tension(i) >= MAY_BE * greatest)
            .filter(|&i| {
                tension(i) - before(i) > RESOLVED * greatest || (always && tension(i) == greatest)
            })
            .collect();
        peaks.sort_by(|&i, &j| tension(j).total_cmp(&tension(i)));
        peaks.truncate(PEAKS);
        peaks.iter().map(|&i| self.place(states[i].0)).collect()
    }

    /// The place of a mean gap among those prescribed, which it is but for rounding.
    fn place(&self, gap: f64) -> usize {
        let above = self.gaps.partition_point(|other| *other < gap);
        let off = |place: usize| self.gaps.get(place).map(|other| (other - gap).abs());
        match above.checked_sub(1) {
            Some(below) if above == self.gaps.len() || off(below) < off(above) => below,
            _ => above,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Greatest tension of a curve between gaps of 1 and 2, and the retractions that it took, of which the first has these gaps.
    fn search(first: &[f64], curve: impl Fn(f64) -> f64) -> (f64, usize) {
        let over =
            |gaps: &[f64]| -> Vec<Held> { gaps.iter().map(|&gap| (gap, curve(gap))).collect() };
        let mut states = over(first);
        let mut retraction = Retraction::along(&states, 2.0);
        let mut most = 0.0_f64;
        for walks in 1.. {
            most = states.iter().fold(most, |most, state| most.max(state.1));
            if !retraction.refine(&states) {
                return (most, walks);
            }
            let gaps = retraction.gaps();
            assert!(gaps.windows(2).all(|pair| pair[0] < pair[1]));
            assert!(
                gaps.windows(2)
                    .all(|pair| pair[1] - pair[0] <= WIDEST * (1.0 + ROOM))
            );
            assert_eq!((gaps[0], gaps[gaps.len() - 1]), (1.0, 2.0));
            // A solved mean gap is the prescribed one but for rounding.
            states = over(gaps);
            states.iter_mut().for_each(|state| state.0 *= 1.0 - 1e-15);
        }
        unreachable!("the rounds are bounded")
    }

    /// Gaps 1/32 apart.
    fn even() -> Vec<f64> {
        (0..=32).map(|i| 1.0 + f64::from(i) / 32.0).collect()
    }

    /// A spot that lets go at a gap of 1.49: its tension rises to 1 there, and a smaller one remains. Gaps 1/32 apart
    /// end 0.21 below it, those of one round 0.017, and of two 0.002.
    #[test]
    fn a_tension_that_falls_suddenly_is_known_to_a_hundredth() {
        let curve = |gap: f64| match gap < 1.49 {
            true => 1.0 - 10.0 * (1.49 - gap),
            false => 0.3 - 0.1 * (gap - 1.49),
        };
        let (most, walks) = search(&even(), curve);
        assert!((0.99..=1.0).contains(&most), "{most}");
        assert_eq!(walks, 3);
    }

    /// Beside a smooth maximum the tension hardly rises.
    #[test]
    fn a_smooth_maximum_is_known_after_one_round() {
        let (most, walks) = search(&even(), |gap| 1.0 - 4.0 * (gap - 1.613).powi(2));
        assert!((1.0 - 1e-5..=1.0).contains(&most), "{most}");
        assert_eq!(walks, 2);
    }

    /// Two teeth, of which the first gaps find the smaller one higher: 0.9 at 1.71875 beside 0.87 at 1.28125.
    #[test]
    fn a_lesser_maximum_of_the_first_gaps_may_be_the_greatest() {
        let tooth = |gap: f64, end: f64, top: f64| match gap <= end && gap > end - 0.09 {
            true => top - 4.0 * (end - gap),
            false => 0.0,
        };
        let curve = |gap: f64| tooth(gap, 1.3124, 1.0).max(tooth(gap, 1.71876, 0.9));
        let (most, _) = search(&even(), curve);
        assert!((0.99..=1.0).contains(&most), "{most}");
    }

    /// The last summit holds only between two gaps of the first retraction.
    #[test]
    fn a_maximum_within_a_long_step_is_found() {
        let curve = |gap: f64| match (1.5..1.59).contains(&gap) {
            true => 10.0 * (gap - 1.5) + 0.1,
            false => -0.1,
        };
        let (most, _) = search(&[1.0, 1.1, 1.7], curve);
        assert!((0.99..=1.0).contains(&most), "{most}");
    }

    #[test]
    fn surfaces_that_do_not_attract_need_one_retraction() {
        assert_eq!(search(&even(), |gap| gap - 3.0), (0.0, 1));
    }
}
