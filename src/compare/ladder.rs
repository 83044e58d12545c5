//! Models that know the attraction under a repulsive pressure, asked for a net one.

use super::State;

/// Factor between two repulsive pressures of a ladder.
const RUNG: f64 = 1.15;
/// The same for its light end, where a weak attraction has its pull-off at the first few summits.
const LIGHT_RUNG: f64 = 1.5;
/// Rungs that a ladder may have: enough for loads up to 1e100 times the modulus.
const MOST_RUNGS: usize = 2000;
/// First rung and the end of the light ones, in E* times the rms slope.
const FIRST: f64 = 1e-6;
const LIGHT: f64 = 2e-3;

/// Rungs between the two beside a dip of the net pressure, and the share of the greatest tension from
/// which a dip may turn out the deepest.
const CLOSER: i32 = 9;
const MAY_BE: f64 = 0.5;

/// Repulsive pressures, in units of `unit`, from the first summit to what leaves `largest` net under
/// an attraction of at most `tension` (Pa).
pub(super) fn rungs(unit: f64, largest: f64, tension: f64) -> Vec<f64> {
    // Tension is the law's scale, real attractions are a fraction of it, and beyond rms slope times
    // modulus hardly a gap is left.
    let net = largest.max(0.0);
    let last = (net + tension).min(net + unit).max(2.0 * LIGHT * unit);
    let mut rungs = vec![FIRST * unit];
    let mut at = FIRST * unit;
    while at < last && rungs.len() < MOST_RUNGS {
        at *= if at < LIGHT * unit { LIGHT_RUNG } else { RUNG };
        rungs.push(at);
    }
    rungs
}

/// States under rising repulsive pressures.
#[derive(Default)]
pub(super) struct Ladder {
    states: Vec<State>,
    /// Repulsive pressure of each, Pa, rising.
    repulsive: Vec<f64>,
}

impl Ladder {
    /// Adds the state under a repulsive pressure, Pa, in its place.
    pub fn add(&mut self, repulsive: f64, area: f64, mean_gap: f64, attraction: f64) {
        let state = State {
            mean_pressure: repulsive - attraction,
            contact_area_fraction: Some(area),
            mean_gap: Some(mean_gap),
            adhesive_pressure: Some(attraction),
        };
        let place = self.repulsive.partition_point(|at| *at < repulsive);
        self.repulsive.insert(place, repulsive);
        self.states.insert(place, state);
    }

    /// Whether the net pressure stays above `net` (Pa) under every repulsive pressure above the last,
    /// whatever the gaps there: what does not touch now pulls by `peak` (Pa) at most, and what touches
    /// goes on to touch.
    pub fn stays_above(&self, net: f64, peak: f64) -> bool {
        let (Some(repulsive), Some(state)) = (self.repulsive.last(), self.states.last()) else {
            return false;
        };
        let open = 1.0 - state.contact_area_fraction.unwrap_or(0.0);
        repulsive - peak * open > net
    }

    /// Repulsive pressures between the rungs beside each dip of the net pressure that may hold the
    /// greatest tension, `CLOSER` to a dip.
    pub fn closer(&self) -> Vec<f64> {
        let net = |i: usize| self.states[i].mean_pressure;
        let deepest = self
            .states
            .get(self.lowest())
            .map_or(0.0, |state| state.mean_pressure);
        let last = self.states.len().saturating_sub(1);
        let mut closer = Vec::new();
        for i in 0..self.states.len() {
            let (before, after) = (i.saturating_sub(1), (i + 1).min(last));
            if net(i) < 0.0 && net(i) < MAY_BE * deepest && net(i) <= net(before).min(net(after)) {
                let (low, high) = (self.repulsive[before], self.repulsive[after]);
                let rung = (high / low).powf(1.0 / (CLOSER + 1) as f64);
                closer.extend((1..=CLOSER).map(|k| low * rung.powi(k)));
            }
        }
        closer
    }

    fn lowest(&self) -> usize {
        let by_pressure = |i: &usize, j: &usize| {
            let at = |i: usize| self.states[i].mean_pressure;
            at(*i).total_cmp(&at(*j))
        };
        (0..self.states.len()).min_by(by_pressure).unwrap_or(0)
    }

    /// The state of greatest tension, if there is any tension.
    pub fn pull_off(&self) -> Option<State> {
        self.states
            .get(self.lowest())
            .copied()
            .filter(|state| state.mean_pressure < 0.0)
    }

    /// The state at a net pressure on the closer side of pull-off, by straight lines between rungs.
    pub fn at(&self, net: f64) -> Option<State> {
        // Of several, the one under the largest repulsive pressure.
        self.states[self.lowest()..]
            .windows(2)
            .rev()
            .find_map(|pair| {
                let (low, high) = (pair[0].mean_pressure, pair[1].mean_pressure);
                if !(low <= net && net <= high) {
                    return None;
                }
                let share = (net - low) / (high - low);
                let between = |of: fn(&State) -> Option<f64>| {
                    let (one, other) = (of(&pair[0])?, of(&pair[1])?);
                    Some(one + share * (other - one))
                };
                Some(State {
                    mean_pressure: net,
                    contact_area_fraction: between(|state| state.contact_area_fraction),
                    mean_gap: between(|state| state.mean_gap),
                    adhesive_pressure: between(|state| state.adhesive_pressure),
                })
            })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ladder_is_read_on_the_closer_side_of_its_greatest_tension() {
        let mut ladder = Ladder::default();
        for (repulsive, attraction) in [(1.0, 2.0), (2.0, 5.0), (4.0, 6.0), (8.0, 6.0)] {
            ladder.add(repulsive, 0.01 * repulsive, 10.0 - repulsive, attraction);
        }
        let pull_off = ladder.pull_off().expect("a tension");
        assert_eq!(pull_off.mean_pressure, -3.0);
        let state = ladder.at(-1.0).expect("between the last three");
        assert_eq!(state.mean_pressure, -1.0);
        assert!((state.contact_area_fraction.unwrap() - (0.04 + 0.25 * 0.04)).abs() < 1e-15);
        assert_eq!(ladder.at(3.0), None);
        // Nine rungs between those beside the one dip; above 8 an attraction of 9 may yet hold, one of 7
        // not where 8 % touch.
        let closer = ladder.closer();
        assert_eq!(closer.len(), 9);
        assert!(closer[0] > 1.0 && closer[8] < 4.0);
        assert!(!ladder.stays_above(0.0, 9.0) && ladder.stays_above(0.0, 7.0));
        let rungs = rungs(1.0, 0.1, 0.0);
        assert!(rungs[0] == FIRST && rungs.last().is_some_and(|last| *last >= 0.1));
    }

    /// Without roughness or with a load beyond all measure a ladder has its most rungs, and not more.
    #[test]
    fn a_ladder_ends() {
        for (unit, largest) in [
            (0.0, 1.0),
            (1e-300, 1e300),
            (1.0, 1e20),
            (1.0, f64::INFINITY),
        ] {
            assert!(rungs(unit, largest, f64::INFINITY).len() <= MOST_RUNGS);
        }
    }
}
