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
}

impl Ladder {
    /// Adds the state under a repulsive pressure, Pa.
    pub fn add(&mut self, repulsive: f64, area: f64, mean_gap: f64, attraction: f64) {
        self.states.push(State {
            mean_pressure: repulsive - attraction,
            contact_area_fraction: Some(area),
            mean_gap: Some(mean_gap),
            adhesive_pressure: Some(attraction),
        });
    }

    /// The net pressure of the last state, Pa.
    pub fn last(&self) -> f64 {
        self.states
            .last()
            .map_or(f64::NEG_INFINITY, |state| state.mean_pressure)
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
        self.states[self.lowest()..].windows(2).find_map(|pair| {
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
