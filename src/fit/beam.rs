//! Forces of a tip on a cantilever whose base is moved: the error of a measured deflection is in the force and in the approach.
//!
//! A model's force at the measured approach would be off by `e (1 + k/s)` for an error `e`, where the contact has the stiffness `k` and the
//! spring `s`: stiff contacts would outweigh the free points, which tell the slope of the baseline. At the position of the base, which
//! is known, the model has the errors of the deflection everywhere.

/// Most rounds of a search for a state, and the step that is the last, as a share of the range of the approach: Newton's method squares it.
const ROUNDS: usize = 60;
const SETTLED: f64 = 1e-6;
/// Least stiffness of spring and contact, over that of the spring, by which a step is taken. Below it the spring holds hardly any
/// state or none, and the tip moves as the forces push it, to the next one.
const LEAST_STIFFNESS: f64 = 0.1;

/// The base of the cantilever at each point of a curve.
#[derive(Clone, Debug)]
pub(super) struct Beam {
    /// Spring constant, N/m.
    pub(super) spring: f64,
    /// Position of the base at each point, m.
    pub(super) positions: Vec<f64>,
    /// What the slope of the baseline is.
    pub(super) slope: SlopeOf,
}

/// What makes the slope of a baseline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum SlopeOf {
    /// A part of the deflection that follows the position, and no force. Where the base is at `touch` (m), the approach is as measured.
    Deflection { touch: f64 },
    /// A force of long range, of which the slope `taken` (N/m) is no longer in the forces of the curve.
    Force { taken: f64 },
}

impl Beam {
    /// Where the slope of the baseline acts on a point, m: its position, or its approach.
    pub(super) fn place(&self, at: usize, approach: f64) -> f64 {
        match self.slope {
            SlopeOf::Deflection { .. } => self.positions[at],
            SlopeOf::Force { .. } => approach,
        }
    }

    /// The same of some of the points.
    pub(super) fn of_points(&self, points: &[usize]) -> Self {
        Beam {
            positions: points.iter().map(|at| self.positions[*at]).collect(),
            ..self.clone()
        }
    }

    /// Force at each point, N, in the state next to the measured approach, of a tip whose `contact` has a force (N) and a stiffness (N/m) at an approach, and whose
    /// baseline has this offset (N) and slope (N/m); `span` is the range of the approach, m.
    pub(super) fn forces(
        &self,
        contact: impl Fn(f64) -> (f64, f64),
        (offset, slope): (f64, f64),
        approaches: &[f64],
        span: f64,
    ) -> Vec<f64> {
        let (constant, by_approach) = match self.slope {
            SlopeOf::Deflection { touch } => (offset + slope * touch, 0.0),
            SlopeOf::Force { taken } => (offset, slope + taken),
        };
        let bends = |approach: f64| {
            let (force, stiffness) = contact(approach);
            (
                constant + by_approach * approach + force,
                by_approach + stiffness,
            )
        };
        let each = approaches.iter().zip(&self.positions);
        each.map(|(measured, position)| {
            let bent = self.balance(bends, *measured, *position, span);
            match self.slope {
                SlopeOf::Deflection { touch } => bent + slope * (position - touch),
                SlopeOf::Force { taken } => bent - taken * measured,
            }
        })
        .collect()
    }

    /// The force at which the spring is balanced, N, next to the measured approach.
    fn balance(
        &self,
        bends: impl Fn(f64) -> (f64, f64),
        measured: f64,
        position: f64,
        span: f64,
    ) -> f64 {
        let mut approach = measured;
        let mut force = f64::NAN;
        for _ in 0..ROUNDS {
            let (here, stiffness) = bends(approach);
            let excess = approach + here / self.spring - position;
            let in_series = 1.0 + stiffness / self.spring;
            let change = if in_series >= LEAST_STIFFNESS {
                excess / in_series
            } else {
                excess
            };
            approach -= change;
            force = here - stiffness * change;
            if change.is_nan() || change.abs() <= SETTLED * span {
                break;
            }
        }
        force
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A contact of a constant stiffness, on a baseline with offset and slope: each state has its force in closed form.
    #[test]
    fn springs_in_series_share_the_way() {
        let (spring, stiffness) = (0.1, 5.0);
        let contact = |approach: f64| {
            let touches = if approach > 0.0 { stiffness } else { 0.0 };
            (touches * approach, touches)
        };
        let positions = vec![-1e-6, 0.0, 1e-6];
        let approaches = [-1e-6, 0.0, 1e-7];
        let in_series = spring * stiffness / (spring + stiffness);
        let beam = |slope: SlopeOf| Beam {
            spring,
            positions: positions.clone(),
            slope,
        };
        let of_deflection = beam(SlopeOf::Deflection { touch: 0.0 });
        let found = of_deflection.forces(contact, (0.0, 0.02), &approaches, 1e-6);
        let expected = [-2e-8, 0.0, in_series * 1e-6 + 2e-8];
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-16, "{found:e} {expected:e}");
        }
        // A force of 0.02 N/m is one more spring, at the contact.
        let of_force = beam(SlopeOf::Force { taken: 0.0 });
        let found = of_force.forces(contact, (0.0, 0.02), &approaches, 1e-6);
        let with = |stiffness: f64| spring * stiffness / (spring + stiffness);
        let expected = [-1e-6 * with(0.02), 0.0, 1e-6 * with(stiffness + 0.02)];
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-16, "{found:e} {expected:e}");
        }
    }
}
