//! States of a model under given repulsive pressures, interpolated to a given net pressure.

use super::State;

/// Ratio of successive repulsive pressures.
const LOAD_RATIO: f64 = 1.15;
/// The same for light loads, where a weak attraction has its pull-off at the first few summits.
const LIGHT_LOAD_RATIO: f64 = 1.5;
/// Most repulsive pressures: enough for loads up to 1e100 times the modulus.
const MOST_LOADS: usize = 2000;
/// First repulsive pressure and end of the light ones, in E* times the rms slope.
const FIRST: f64 = 1e-6;
const LIGHT: f64 = 2e-3;

/// Repulsive pressures added around each minimum of the net pressure, and the share of the greatest
/// tension from which a minimum is refined.
const CLOSER: i32 = 9;
const MAY_BE: f64 = 0.5;

/// Relative difference of two loads that are one: ten times the default tolerance of a residual.
const SAME_LOAD: f64 = 1e-5;

/// The loads of a path, rising, each once. A state that a position comes back to has the same load but for the tolerance.
pub(super) fn distinct_loads(mut loads: Vec<f64>) -> Vec<f64> {
    loads.sort_by(f64::total_cmp);
    loads.dedup_by(|next, load| (*next - *load).abs() <= SAME_LOAD * load.abs());
    loads
}

/// Repulsive pressures, in units of `unit`, from the first summit to the pressure that leaves a net
/// `largest` under an attraction of at most `tension` (Pa).
pub(super) fn scan_loads(unit: f64, largest: f64, tension: f64) -> Vec<f64> {
    // The law's peak tension is an upper bound: real attractions are a fraction of it, and beyond
    // rms slope times modulus hardly any gap is left.
    let net = largest.max(0.0);
    let last = (net + tension).min(net + unit).max(2.0 * LIGHT * unit);
    let mut loads = vec![FIRST * unit];
    let mut at = FIRST * unit;
    while at < last && loads.len() < MOST_LOADS {
        at *= if at < LIGHT * unit {
            LIGHT_LOAD_RATIO
        } else {
            LOAD_RATIO
        };
        loads.push(at);
    }
    loads
}

/// States under increasing repulsive pressures.
#[derive(Default)]
pub(super) struct LoadScan {
    states: Vec<State>,
    /// Repulsive pressure of each, Pa, increasing.
    repulsive: Vec<f64>,
}

impl LoadScan {
    /// Inserts the state under a repulsive pressure, Pa, in order.
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

    /// Whether the net pressure exceeds `net` (Pa) under every repulsive pressure above the last:
    /// points out of contact pull by at most `peak` (Pa), and points in contact stay in contact.
    pub fn stays_above(&self, net: f64, peak: f64) -> bool {
        let (Some(repulsive), Some(state)) = (self.repulsive.last(), self.states.last()) else {
            return false;
        };
        let open = 1.0 - state.contact_area_fraction.unwrap_or(0.0);
        repulsive - peak * open > net
    }

    /// Additional repulsive pressures around each minimum of the net pressure that may contain the
    /// greatest tension, `CLOSER` for each.
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

    /// The state at a net pressure on the compressive side of pull-off, by linear interpolation.
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
    fn scans_are_read_on_the_compressive_side() {
        let mut scan = LoadScan::default();
        for (repulsive, attraction) in [(1.0, 2.0), (2.0, 5.0), (4.0, 6.0), (8.0, 6.0)] {
            scan.add(repulsive, 0.01 * repulsive, 10.0 - repulsive, attraction);
        }
        let pull_off = scan.pull_off().expect("a tension");
        assert_eq!(pull_off.mean_pressure, -3.0);
        let state = scan.at(-1.0).expect("between the last three");
        assert_eq!(state.mean_pressure, -1.0);
        assert!((state.contact_area_fraction.unwrap() - (0.04 + 0.25 * 0.04)).abs() < 1e-15);
        assert_eq!(scan.at(3.0), None);
        // Nine additional loads around the one minimum; above a load of 8 an attraction of 9 could
        // still balance it, one of 7 could not where 8 % touch.
        let closer = scan.closer();
        assert_eq!(closer.len(), 9);
        assert!(closer[0] > 1.0 && closer[8] < 4.0);
        assert!(!scan.stays_above(0.0, 9.0) && scan.stays_above(0.0, 7.0));
        let loads = scan_loads(1.0, 0.1, 0.0);
        assert!(loads[0] == FIRST && loads.last().is_some_and(|last| *last >= 0.1));
    }

    /// An approach that comes back to -5.2 MPa met it to 2.5e-8, and each model was solved for both.
    #[test]
    fn a_load_that_is_met_twice_counts_once() {
        let met = vec![-5.167_663_644e6, 7.11e6, -5.167_663_517e6, 0.0, 0.0, 7.12e6];
        let distinct = [-5.167_663_644e6, 0.0, 7.11e6, 7.12e6];
        assert_eq!(distinct_loads(met), distinct);
    }

    /// Without roughness or with an unlimited load the scan has its largest number of loads, and no
    /// more.
    #[test]
    fn scans_are_finite() {
        for (unit, largest) in [
            (0.0, 1.0),
            (1e-300, 1e300),
            (1.0, 1e20),
            (1.0, f64::INFINITY),
        ] {
            assert!(scan_loads(unit, largest, f64::INFINITY).len() <= MOST_LOADS);
        }
    }
}
