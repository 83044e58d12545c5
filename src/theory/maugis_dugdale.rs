//! Sphere with a cohesive zone of constant tension: Maugis 1992, for any lambda, reduced.
//!
//! Maugis units (see [`super::tabor_map`]); the tension acts up to the gap `2/(pi lambda)`. Small
//! lambda is DMT with a constant attraction of `2 pi w R`, large lambda is JKR. Before first
//! contact there is a cohesive disc without contact, the *open* branch.

use super::error::{TheoryError, between, not_negative, positive, within};
use super::hertz::reduced_gap;
use super::roots::{minimum, positive_root, root};
use std::f64::consts::{FRAC_PI_2, PI};

/// Lambda above which the contact branch has a fold, so that the sphere jumps off from contact
/// under a prescribed approach: `(9 pi/(16 (pi - 1)))^(1/3)`, the 0.938 of Johnson & Greenwood
/// 1997. Below it the contact shrinks to a point first, and the jump is from the open branch.
pub const FOLD_LAMBDA: f64 = 0.937_947_457_210_712_3;

/// Steps of Newton's method for a cohesive zone near a known one; a handful suffices, and bracketing follows.
const NEWTON_STEPS: usize = 12;

/// An equilibrium of the sphere, reduced.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct State {
    /// Contact radius A; 0 out of contact.
    pub contact_radius: f64,
    /// Outer radius of the cohesive zone.
    pub cohesive_radius: f64,
    /// Force, positive in compression.
    pub force: f64,
    /// Approach, positive closer.
    pub approach: f64,
    /// Gap on the axis; 0 in contact.
    pub central_gap: f64,
}

impl State {
    /// `m = c/a`; infinite out of contact.
    pub fn ratio(&self) -> f64 {
        self.cohesive_radius / self.contact_radius
    }

    /// `t = sqrt(m^2 - 1)`.
    pub(crate) fn zone(&self) -> f64 {
        (self.ratio().powi(2) - 1.0).max(0.0).sqrt()
    }
}

/// Maugis-Dugdale sphere of a given lambda.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaugisDugdale {
    lambda: f64,
}

impl MaugisDugdale {
    /// A sphere with Maugis parameter `lambda` (see [`super::tabor_map::maugis_parameter`]).
    pub fn new(lambda: f64) -> Result<Self, TheoryError> {
        between!(lambda in 1e-6..=1e6, "between 1e-6 and 1e6")?;
        Ok(MaugisDugdale { lambda })
    }

    /// The Maugis parameter.
    pub fn lambda(&self) -> f64 {
        self.lambda
    }

    /// Gap up to which the tension acts, `2/(pi lambda)`.
    pub fn range(&self) -> f64 {
        2.0 / (PI * self.lambda)
    }

    /// Tension in units of `K a*/R`: `lambda/2`.
    pub fn tension(&self) -> f64 {
        0.5 * self.lambda
    }

    /// The equilibrium with contact radius `contact_radius > 0`.
    ///
    /// Maugis 1992 eq. 6.6 to 6.8, in `t = sqrt(m^2 - 1)`, which avoids cancellation as the zone
    /// shrinks; its left side increases with t, so there is one root.
    pub fn state(&self, contact_radius: f64) -> Result<State, TheoryError> {
        let a = positive("contact_radius", contact_radius)?;
        let guess = 1.0 / (self.lambda * a);
        let t = positive_root("the cohesive zone", |t| self.opened(a, t), guess)?;
        Ok(self.state_with_zone(a, t))
    }

    /// The same from the root `t` at a contact radius close by, by Newton's method; also returns the root.
    pub(crate) fn state_near(&self, a: f64, t_near: f64) -> Result<(State, f64), TheoryError> {
        let mut t = t_near;
        for _ in 0..NEWTON_STEPS {
            let step = self.opened(a, t) / self.opened_slope(a, t);
            // From the convex side a step may go beyond zero.
            let next = (t - step).max(0.1 * t);
            if (next - t).abs() <= 2.0 * f64::EPSILON * t {
                return Ok((self.state_with_zone(a, next), next));
            }
            t = next;
        }
        let guess = 1.0 / (self.lambda * a);
        let t = positive_root("the cohesive zone", |t| self.opened(a, t), guess)?;
        Ok((self.state_with_zone(a, t), t))
    }

    /// Opening at the edge of the cohesive zone over the range, less 1.
    fn opened(&self, a: f64, t: f64) -> f64 {
        let lambda = self.lambda;
        let first = 0.5 * PI * lambda * a * a * reduced_gap(t);
        first + 4.0 / 3.0 * lambda * lambda * a * punch_gap(t) - 1.0
    }

    /// Derivative of [`Self::opened`] by t.
    fn opened_slope(&self, a: f64, t: f64) -> f64 {
        let lambda = self.lambda;
        let (m, angle) = (t.hypot(1.0), t.atan());
        let gap = 2.0 * t * (t / (m * m) + angle) / PI;
        // atan t + t/m^2 - t/m, whose last two terms are t (1 - m)/m^2.
        let punch = angle - t * t * t / (m * m * (m + 1.0));
        0.5 * PI * lambda * a * a * gap + 4.0 / 3.0 * lambda * lambda * a * punch
    }

    fn state_with_zone(&self, a: f64, t: f64) -> State {
        let lambda = self.lambda;
        let ratio = t.hypot(1.0);
        State {
            contact_radius: a,
            cohesive_radius: ratio * a,
            force: a.powi(3) - lambda * a * a * (t + ratio * ratio * t.atan()),
            approach: a * a - 4.0 / 3.0 * lambda * a * t,
            central_gap: 0.0,
        }
    }

    /// Cohesive radius at which the open disc just touches, the limit of zero contact radius.
    #[doc(hidden)]
    pub fn touching_radius(&self) -> f64 {
        // lambda (pi/4) c^2 + (4/3) lambda^2 (pi/2 - 1) c = 1, solved without cancellation.
        let square = 0.25 * PI * self.lambda;
        let half = 2.0 / 3.0 * self.lambda * self.lambda * (FRAC_PI_2 - 1.0);
        1.0 / (half + (half * half + square).sqrt())
    }

    /// The open disc of radius `cohesive_radius`, from zero to [`Self::touching_radius`].
    #[doc(hidden)]
    pub fn open_state(&self, cohesive_radius: f64) -> Result<State, TheoryError> {
        let c = not_negative("cohesive_radius", cohesive_radius)?;
        within(
            "cohesive_radius",
            c,
            c <= self.touching_radius() * (1.0 + 1e-12),
            "no more than the radius at which the disc touches",
        )?;
        let approach = 0.5 * c * c - 8.0 / (3.0 * PI) * self.lambda * c - self.range();
        Ok(State {
            contact_radius: 0.0,
            cohesive_radius: c,
            force: -FRAC_PI_2 * self.lambda * c * c,
            approach,
            central_gap: -approach - 4.0 / 3.0 * self.lambda * c,
        })
    }

    /// The touching equilibrium of the greatest tension: pull-off under load control.
    pub fn pull_off(&self) -> Result<State, TheoryError> {
        self.least(|state| state.force)
    }

    /// The equilibrium of least approach, at which the sphere jumps off under a prescribed approach
    /// (fixed grips).
    ///
    /// Above [`FOLD_LAMBDA`] it is in contact; below it is an open disc of radius `8 lambda/(3
    /// pi)`.
    #[doc(hidden)]
    pub fn grip(&self) -> Result<State, TheoryError> {
        if self.lambda > FOLD_LAMBDA {
            self.least(|state| state.approach)
        } else {
            self.open_state(8.0 / (3.0 * PI) * self.lambda)
        }
    }

    fn least(&self, of: impl Fn(&State) -> f64) -> Result<State, TheoryError> {
        // Each radius tried is near one tried before.
        let mut zone = self.state(1.0)?.zone();
        let at = |radius: f64| match self.state_near(radius, zone) {
            Ok((state, near)) => {
                zone = near;
                of(&state)
            }
            Err(_) => f64::INFINITY,
        };
        // Both minima lie at or inside the JKR radii, which are below 1.15.
        let (radius, _) = minimum(at, 1e-9, 2.0);
        self.state(radius)
    }

    /// Touching equilibria under `force`, the smaller contact radius first; the last is stable
    /// under load control. Empty beyond pull-off.
    pub fn states_at_force(&self, force: f64) -> Result<Vec<State>, TheoryError> {
        let turn = self.pull_off()?;
        self.states_where(|state| state.force - force, turn, force.max(0.0).cbrt())
    }

    /// Touching equilibria at `approach`, the smaller contact radius first; the last is stable
    /// under a prescribed approach.
    pub fn states_at_approach(&self, approach: f64) -> Result<Vec<State>, TheoryError> {
        let turn = if self.lambda > FOLD_LAMBDA {
            self.grip()?
        } else {
            self.state(1e-9)?
        };
        let reach = approach.max(0.0).sqrt();
        self.states_where(|state| state.approach - approach, turn, reach)
    }

    /// Open discs at `approach`, the smaller first; one at or above the radius of the fold, `8
    /// lambda/(3 pi)`, is stable under a prescribed approach.
    #[doc(hidden)]
    pub fn open_states_at_approach(&self, approach: f64) -> Result<Vec<State>, TheoryError> {
        let centre = 8.0 / (3.0 * PI) * self.lambda;
        let square = centre * centre + 2.0 * (self.range() + approach);
        if square < 0.0 {
            return Ok(Vec::new());
        }
        let largest = self.touching_radius();
        let mut radii = vec![centre - square.sqrt(), centre + square.sqrt()];
        radii.dedup();
        radii
            .into_iter()
            .filter(|c| (0.0..=largest).contains(c))
            .map(|c| self.open_state(c))
            .collect()
    }

    /// The state to which an approaching sphere jumps as it first feels the attraction, at an
    /// approach of minus the range: the open disc if there is one, else a contact.
    pub fn jump_in(&self) -> Result<State, TheoryError> {
        let approach = -self.range();
        let open = 16.0 / (3.0 * PI) * self.lambda;
        if open <= self.touching_radius() {
            return self.open_state(open);
        }
        let touching = self.states_at_approach(approach)?;
        touching
            .last()
            .copied()
            .ok_or(TheoryError::NoSolution { what: "a contact" })
    }

    /// Touching states at which `excess` vanishes, which decreases up to `turn` and then increases.
    fn states_where(
        &self,
        excess: impl Fn(&State) -> f64,
        turn: State,
        reach: f64,
    ) -> Result<Vec<State>, TheoryError> {
        let at = |radius: f64| self.state(radius).map_or(f64::NAN, |state| excess(&state));
        let least = excess(&turn);
        if least > 0.0 {
            return Ok(Vec::new());
        }
        let mut states = Vec::new();
        if at(1e-9) > 0.0 {
            let radius = root("the inner state", at, 1e-9, turn.contact_radius, 1e-14)?;
            states.push(self.state(radius)?);
        }
        let above = 4.0 + 2.0 * reach;
        let radius = root("the outer state", at, turn.contact_radius, above, 1e-14)?;
        states.push(self.state(radius)?);
        Ok(states)
    }

    /// Net pressure at `r` in a touching or open state, in units of `K a*/R`; negative in tension.
    ///
    /// The Hertz pressure less `(2 sigma0/pi) atan sqrt((c^2-a^2)/(a^2-r^2))`; minus the tension
    /// in the cohesive zone; 0 outside.
    pub fn pressure(&self, state: &State, r: f64) -> f64 {
        let (a, c) = (state.contact_radius, state.cohesive_radius);
        let inside = (a - r) * (a + r);
        if inside > 0.0 {
            let zone = (c - a) * (c + a);
            1.5 / PI * inside.sqrt() - 2.0 / PI * self.tension() * (zone / inside).sqrt().atan()
        } else if r.abs() <= c {
            -self.tension()
        } else {
            0.0
        }
    }
}

/// `t atan t - m + 1` with `m = sqrt(1 + t^2)`: the opening by the cohesive zone.
fn punch_gap(t: f64) -> f64 {
    if t < 0.05 {
        // t atan t = t^2 - t^4/3 + ..., m - 1 = t^2/2 - t^4/8 + ...
        let s = t * t;
        s * (0.5 + s * (-5.0 / 24.0 + s * (11.0 / 80.0 + s * (-93.0 / 896.0 + s * 193.0 / 2304.0))))
    } else {
        t * t.atan() - t * t / (t.hypot(1.0) + 1.0)
    }
}

/// Fit of the Maugis-Dugdale curves to 2 % by Carpick, Ogletree & Salmeron 1999.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct CarpickFit {
    /// Transition parameter, 0 for DMT and 1 for JKR.
    pub alpha: f64,
    /// Reduced contact radius at zero load.
    pub zero_load_radius: f64,
    /// Reduced pull-off force (negative).
    pub pull_off_force: f64,
}

/// The fit's parameters at `lambda > 0`.
pub fn carpick_fit(lambda: f64) -> Result<CarpickFit, TheoryError> {
    let lambda = positive("lambda", lambda)?;
    let step = |weight: f64, power: f64| {
        let x = weight * lambda.powf(power);
        (x - 1.0) / (x + 1.0)
    };
    Ok(CarpickFit {
        alpha: (1.0 - (-lambda / 0.924).exp()) / 1.02,
        zero_load_radius: 1.54 + 0.279 * step(2.28, 1.3),
        pull_off_force: -1.75 + 0.25 * step(4.04, 1.4),
    })
}

impl CarpickFit {
    /// Reduced contact radius under a reduced `force` at or above the pull-off force.
    pub fn contact_radius(&self, force: f64) -> Result<f64, TheoryError> {
        let rest = within(
            "force",
            1.0 - force / self.pull_off_force,
            force >= self.pull_off_force && force.is_finite(),
            "no less than the pull-off force",
        )?;
        let ratio = (self.alpha + rest.sqrt()) / (1.0 + self.alpha);
        Ok(self.zero_load_radius * (ratio * ratio).cbrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::theory::jkr;

    #[test]
    fn limits_are_dmt_and_jkr() {
        let stiff = MaugisDugdale::new(1e-4).unwrap().state(0.7).unwrap();
        assert!((stiff.force - (0.7_f64.powi(3) - 2.0)).abs() < 1e-3);
        let soft = MaugisDugdale::new(1e3).unwrap().state(1.3).unwrap();
        assert!((soft.force - jkr::reduced_force(1.3)).abs() < 1e-4);
        assert!((soft.approach - jkr::reduced_approach(1.3)).abs() < 1e-4);
    }

    #[test]
    fn a_state_is_the_same_from_its_neighbour() {
        for lambda in [0.01, 0.3, 2.0, 20.0] {
            let sphere = MaugisDugdale::new(lambda).unwrap();
            let mut zone = sphere.state(1e-6).unwrap().zone();
            for i in 0..200 {
                let radius = 1e-6 + 5.0 * (f64::from(i) / 199.0).powi(2);
                let state;
                (state, zone) = sphere.state_near(radius, zone).unwrap();
                let known = sphere.state(radius).unwrap();
                assert!((state.force - known.force).abs() < 1e-12 * (1.0 + known.force.abs()));
                assert!((state.approach - known.approach).abs() < 1e-12 * (1.0 + known.approach));
            }
        }
    }

    #[test]
    fn open_and_touching_branches_meet() {
        for lambda in [0.05, 0.7, 3.0] {
            let sphere = MaugisDugdale::new(lambda).unwrap();
            let open = sphere.open_state(sphere.touching_radius()).unwrap();
            let touching = sphere.state(1e-7).unwrap();
            assert!((open.force - touching.force).abs() < 1e-6);
            assert!((open.approach - touching.approach).abs() < 1e-6);
            assert!(open.central_gap.abs() < 1e-12);
        }
    }

    #[test]
    fn series_of_the_punch_gap_meets_its_formula() {
        assert!((punch_gap(0.049_999_999_9) / punch_gap(0.050_000_000_1) - 1.0).abs() < 1e-8);
        assert!(
            (punch_gap(0.01) / (0.01 * 0.01_f64.atan() - 1.0001_f64.sqrt() + 1.0) - 1.0).abs()
                < 1e-9
        );
        assert!((FOLD_LAMBDA - (9.0 * PI / (16.0 * (PI - 1.0))).cbrt()).abs() < 1e-15);
    }
}
