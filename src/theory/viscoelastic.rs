//! Standard linear solid: creep of one wave, and a sphere under a step of load (Lee & Radok 1960).
//!
//! The contact modulus relaxes as `E*(t) = E_inf + E_1 exp(-t/tau)` at constant Poisson's ratio.

use super::error::{TheoryError, not_negative, positive};
use super::quadrature::integrate;
use crate::effect::branch_coefficients;

/// Relaxation times after which nothing is left of a stress.
const FORGOTTEN: f64 = 50.0;

/// A standard linear solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solid {
    relaxed_modulus: f64,
    branch_modulus: f64,
    relaxation_time: f64,
}

/// Time integration of a branch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[doc(hidden)]
pub enum Scheme {
    /// First order in the step.
    BackwardEuler,
    /// Exact for a displacement that is linear within the step; second order. Taylor, Pister &
    /// Goudreau 1970, Simo & Hughes 1998.
    Exponential,
}

impl Scheme {
    /// `(alpha, beta)` of the branch update `m' = alpha m + beta (u' - u)`, for `ratio` = step over
    /// relaxation time.
    #[doc(hidden)]
    pub fn coefficients(self, ratio: f64) -> (f64, f64) {
        match self {
            Scheme::BackwardEuler => (1.0 / (1.0 + ratio), 1.0 / (1.0 + ratio)),
            Scheme::Exponential => branch_coefficients(ratio),
        }
    }
}

impl Solid {
    /// A solid of `relaxed_modulus` E_inf and `branch_modulus` E_1 (Pa) with the `relaxation_time`
    /// tau (s).
    pub fn new(
        relaxed_modulus: f64,
        branch_modulus: f64,
        relaxation_time: f64,
    ) -> Result<Self, TheoryError> {
        Ok(Solid {
            relaxed_modulus: positive("relaxed_modulus", relaxed_modulus)?,
            branch_modulus: not_negative("branch_modulus", branch_modulus)?,
            relaxation_time: positive("relaxation_time", relaxation_time)?,
        })
    }

    /// Instantaneous modulus, `E_0 = E_inf + E_1`, Pa.
    pub fn instantaneous_modulus(&self) -> f64 {
        self.relaxed_modulus + self.branch_modulus
    }

    /// Creep time `tau E_0/E_inf`, s; longer than the relaxation time.
    pub fn creep_time(&self) -> f64 {
        self.relaxation_time * self.instantaneous_modulus() / self.relaxed_modulus
    }

    /// Relaxation modulus at `time` (s, zero or more) after a step of strain, Pa.
    pub fn relaxation(&self, time: f64) -> f64 {
        self.relaxed_modulus + self.branch_modulus * (-time / self.relaxation_time).exp()
    }

    /// Creep compliance at `time` (s, zero or more) after a step of stress, 1/Pa:
    /// `1/E_inf - (1/E_inf - 1/E_0) exp(-t E_inf/(tau E_0))`.
    pub fn creep(&self, time: f64) -> f64 {
        let (late, early) = (
            1.0 / self.relaxed_modulus,
            1.0 / self.instantaneous_modulus(),
        );
        late - (late - early) * (-time / self.creep_time()).exp()
    }

    /// Displacement of the wave `wavenumber` (1/m) after `steps` of `time_step` (s) under a
    /// constant `pressure` (Pa) from time 0 on, by time stepping, m.
    ///
    /// The branch starts with the strain of the instantaneous response. The exact value is `2
    /// pressure creep(t)/wavenumber`.
    #[doc(hidden)]
    pub fn stepped_creep(
        &self,
        wavenumber: f64,
        pressure: f64,
        time_step: f64,
        steps: usize,
        scheme: Scheme,
    ) -> Result<f64, TheoryError> {
        let half = 0.5 * positive("wavenumber", wavenumber)?;
        let ratio = positive("time_step", time_step)? / self.relaxation_time;
        let (alpha, beta) = scheme.coefficients(ratio);
        let effective = self.relaxed_modulus + self.branch_modulus * beta;
        let mut displacement = pressure / (half * self.instantaneous_modulus());
        let mut branch = displacement;
        for _ in 0..steps {
            let history = self.branch_modulus * (alpha * branch - beta * displacement);
            let next = (pressure / half - history) / effective;
            branch = alpha * branch + beta * (next - displacement);
            displacement = next;
        }
        Ok(displacement)
    }

    /// Contact radius of a sphere of `radius` (m) at `time` (s) after a step to `force` (N), m:
    /// `a^3 = (3 R F/4) J(t)`. Lee & Radok 1960; valid because the contact grows.
    pub fn sphere_contact_radius(
        &self,
        radius: f64,
        force: f64,
        time: f64,
    ) -> Result<f64, TheoryError> {
        let product = positive("radius", radius)? * not_negative("force", force)?;
        Ok((0.75 * product * self.creep(not_negative("time", time)?)).cbrt())
    }

    /// Pressure on that sphere at distance `r` (m) from the axis, Pa.
    ///
    /// The hereditary integral of `(2/(pi R)) sqrt(a(s)^2 - r^2)` with the relaxation modulus.
    pub fn sphere_pressure(
        &self,
        radius: f64,
        force: f64,
        time: f64,
        r: f64,
    ) -> Result<f64, TheoryError> {
        let now = self.sphere_contact_radius(radius, force, time)?;
        let r = not_negative("r", r)?;
        if r >= now {
            return Ok(0.0);
        }
        let first = self.sphere_contact_radius(radius, force, 0.0)?;
        let shape = |a: f64| ((a - r) * (a + r)).max(0.0).sqrt();
        // Integrated by parts: the instantaneous modulus times the current shape, less the relaxed
        // part. There was no pressure at r before the contact reached it.
        let reached = if r <= first {
            0.0
        } else {
            let share = 4.0 * r.powi(3) / (3.0 * radius * force) * self.relaxed_modulus;
            let early = 1.0 - self.relaxed_modulus / self.instantaneous_modulus();
            -self.creep_time() * ((1.0 - share) / early).ln()
        };
        let rate = self.branch_modulus / self.relaxation_time;
        // What was before is forgotten; over a longer time the integral would miss what is not.
        let span = (time - reached).clamp(0.0, FORGOTTEN * self.relaxation_time);
        // s = time - span + x^2 removes the square root at the moment of first contact.
        let lost = |x: f64| {
            let ago = span - x * x;
            let a = (0.75 * radius * force * self.creep(time - ago)).cbrt();
            2.0 * x * rate * (-ago / self.relaxation_time).exp() * shape(a)
        };
        let end = span.sqrt();
        let scale = self.instantaneous_modulus() * shape(now);
        let relaxed = integrate(lost, 0.0, end, 1e-11, 1e-13 * scale)?;
        Ok(2.0 / (std::f64::consts::PI * radius) * (scale - relaxed))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn creep_and_relaxation_invert_each_other() {
        let solid = Solid::new(1.0, 9.0, 0.1).unwrap();
        // int_0^t J(t-s) dE(s) + J(t) E(0) = 1 for all t > 0.
        let t = 0.3;
        let rate = |s: f64| -solid.branch_modulus / 0.1 * (-s / 0.1).exp();
        let rest = integrate(|s| solid.creep(t - s) * rate(s), 0.0, t, 1e-12, 0.0).unwrap();
        assert!((solid.creep(t) * solid.relaxation(0.0) + rest - 1.0).abs() < 1e-12);
    }

    /// After ten thousand creep times the pressure is that of Hertz with the relaxed modulus.
    #[test]
    fn the_pressure_of_a_sphere_relaxes_for_good() {
        let (radius, force, relaxed) = (2.0, 0.3, 1.0);
        let solid = Solid::new(relaxed, 9.0, 0.1).unwrap();
        let a = (0.75 * radius * force / relaxed).cbrt();
        for r in [0.0, 0.5 * a, 0.9 * a] {
            let hertz = 2.0 * relaxed / (std::f64::consts::PI * radius) * (a * a - r * r).sqrt();
            let found = solid.sphere_pressure(radius, force, 1e4, r).unwrap();
            assert!((found / hertz - 1.0).abs() < 1e-9, "{found} {hertz}");
        }
    }
}
