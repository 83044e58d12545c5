//! The tip that made a curve: sphere, cone or pyramid.
//!
//! # Source
//! Cone without adhesion: Sneddon 1965, doi:10.1016/0020-7225(65)90019-4, eq. 6.4. Cone with adhesion of zero range:
//! Maugis & Barquins 1981, doi:10.1051/jphyslet:0198100420509500. Pyramid: Bilodeau 1992, doi:10.1115/1.2893754; with
//! adhesion as the cone that is as stiff.

use std::f64::consts::{FRAC_PI_2, PI};

use super::model::Model;
use crate::theory::TheoryError;
use crate::theory::tabor_map::Sphere;
use crate::units::format_si;

/// Force of a four-sided pyramid over E* times the tangent of its half angle and the square of the approach (Bilodeau:
/// 1.4906/2, where a cone has 2/pi).
const PYRAMID: f64 = 0.7453;

/// Radius above which a probe is taken for one whose unit was forgotten, m.
const LARGEST_PROBE: f64 = 1.0;

/// A rigid tip.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Indenter {
    /// A sphere, or a paraboloid of this radius of curvature.
    Sphere {
        /// R, m.
        radius: f64,
    },
    /// A cone.
    Cone {
        /// Angle between axis and flank, rad.
        half_angle: f64,
    },
    /// A regular pyramid of four sides.
    Pyramid {
        /// Angle between axis and face, rad.
        half_angle: f64,
    },
}

impl From<f64> for Indenter {
    /// A sphere of this radius (m).
    fn from(radius: f64) -> Self {
        Indenter::Sphere { radius }
    }
}

impl Indenter {
    /// Its name in `fit.json`.
    pub fn name(self) -> &'static str {
        match self {
            Indenter::Sphere { .. } => "sphere",
            Indenter::Cone { .. } => "cone",
            Indenter::Pyramid { .. } => "pyramid",
        }
    }

    /// Radius of a sphere, m.
    pub fn radius(self) -> Option<f64> {
        match self {
            Indenter::Sphere { radius } => Some(radius),
            Indenter::Cone { .. } | Indenter::Pyramid { .. } => None,
        }
    }

    /// Half angle of a cone or pyramid, rad.
    pub fn half_angle(self) -> Option<f64> {
        match self {
            Indenter::Sphere { .. } => None,
            Indenter::Cone { half_angle } | Indenter::Pyramid { half_angle } => Some(half_angle),
        }
    }

    /// Models that are known for it.
    pub fn models(self) -> &'static [Model] {
        match self {
            Indenter::Sphere { .. } => &Model::ALL,
            Indenter::Cone { .. } | Indenter::Pyramid { .. } => &[Model::Hertz, Model::Jkr],
        }
    }

    /// What a radius that probes do not have may have been meant as.
    pub fn doubt(self) -> Option<String> {
        let radius = self.radius().filter(|radius| *radius > LARGEST_PROBE)?;
        Some(format!(
            "a radius of {} is more than probes have: was it meant in um or nm?",
            format_si(radius, "m")
        ))
    }

    /// Refuses radii and angles that no tip has.
    pub(super) fn check(self) -> Result<(), TheoryError> {
        match self {
            Indenter::Sphere { radius } => Sphere::new(radius, 1.0, 0.0).map(|_| ()),
            Indenter::Cone { half_angle } | Indenter::Pyramid { half_angle } => {
                crate::theory::cone_punch::Cone::new(FRAC_PI_2 - half_angle, 1.0).map(|_| ())
            }
        }
    }

    /// Slope of the flank of the cone that is as stiff, from the surface; the square root of the radius of a sphere.
    fn shape(self) -> f64 {
        match self {
            Indenter::Sphere { radius } => radius.sqrt(),
            Indenter::Cone { half_angle } => half_angle.tan().recip(),
            Indenter::Pyramid { half_angle } => (PYRAMID * FRAC_PI_2 * half_angle.tan()).recip(),
        }
    }

    /// Power of the approach that the force without adhesion is proportional to.
    pub(super) fn power(self) -> f64 {
        match self {
            Indenter::Sphere { .. } => 1.5,
            Indenter::Cone { .. } | Indenter::Pyramid { .. } => 2.0,
        }
    }

    /// Force without adhesion over E* and that power of the approach.
    pub(super) fn stiffness(self) -> f64 {
        match self {
            Indenter::Sphere { .. } => 4.0 / 3.0 * self.shape(),
            Indenter::Cone { .. } | Indenter::Pyramid { .. } => 2.0 / PI / self.shape(),
        }
    }

    /// Units of force, N, and approach, m, in which the models are reduced: those of Maugis for a sphere, `w^2/(E* t^3)` and
    /// `w/(E* t)` for a cone whose flank has the slope t.
    pub(super) fn units(self, contact_modulus: f64, work_of_adhesion: f64) -> (f64, f64) {
        if let Indenter::Sphere { radius } = self {
            let force = PI * work_of_adhesion * radius;
            let contact = (force * radius / (4.0 * contact_modulus / 3.0)).cbrt();
            return (force, contact * contact / radius);
        }
        let slope = self.shape();
        let approach = work_of_adhesion / (contact_modulus * slope);
        (work_of_adhesion * approach / (slope * slope), approach)
    }

    /// Work of adhesion, J/m^2, and contact modulus, Pa, that make these units.
    pub(super) fn work_and_modulus(self, force: f64, approach: f64) -> (f64, f64) {
        if let Indenter::Sphere { radius } = self {
            let work = force / (PI * radius);
            return (work, 0.75 * PI * work * (radius / approach.powi(3)).sqrt());
        }
        let slope = self.shape();
        let work = force * slope * slope / approach;
        (work, work / (approach * slope))
    }

    /// A work of adhesion, J/m^2, whose pull-off force is about `tension` (N).
    pub(super) fn work_of(self, tension: f64, contact_modulus: f64) -> f64 {
        match self {
            Indenter::Sphere { radius } => tension / (1.75 * PI * radius),
            Indenter::Cone { .. } | Indenter::Pyramid { .. } => {
                let cube = self.shape().powi(3);
                (tension * PI * contact_modulus * cube / 54.0).sqrt()
            }
        }
    }

    /// Approach, in its unit, over which a contact in tension becomes one under load, relative to a sphere.
    pub(super) fn depth_unit(self) -> f64 {
        match self {
            Indenter::Sphere { .. } => 1.0,
            Indenter::Cone { .. } | Indenter::Pyramid { .. } => 3.0,
        }
    }
}

/// A cone with adhesion of zero range, in the units of [`Indenter::units`] and `w/(E* t^2)` for the contact radius A:
/// `delta = (pi/2) A - sqrt(2 pi A)`, `F = (pi/2) A^2 - sqrt(8 pi A^3)`.
pub(super) mod adhesive_cone {
    use std::f64::consts::{FRAC_PI_2, PI};

    /// Least approach, where a cone that is held by its position jumps off.
    pub const GRIP: f64 = -1.0;
    /// Approach and force of the greatest tension.
    pub const PULL_OFF: (f64, f64) = (3.0, -54.0 / PI);
    /// Contact radius without load.
    const ZERO_LOAD: f64 = 32.0 / PI;

    /// Force at an approach, on the stable branch; below the least that of the least.
    pub fn force(approach: f64) -> f64 {
        let root = (2.0 * PI).sqrt() * (1.0 + (approach.max(GRIP) - GRIP).sqrt()) / PI;
        let radius = root * root;
        FRAC_PI_2 * radius * radius - (8.0 * PI).sqrt() * radius * root
    }

    /// An approach at which the force is at least `force`.
    pub fn approach_beyond(force: f64) -> f64 {
        // The slope of the force by the radius is 8 without load, and its curvature there 0.98 at least.
        let radius = ZERO_LOAD + 1.02 * force.max(0.0).sqrt();
        FRAC_PI_2 * radius - (2.0 * PI * radius).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;

    const CONE: Indenter = Indenter::Cone { half_angle: 1.2 };

    /// Sneddon's 2/pi E* tan(alpha) delta^2 and Bilodeau's 0.7453, computed by hand for 35 degrees and 2 MPa at 100 nm.
    #[test]
    fn cones_and_pyramids_without_adhesion() {
        let half_angle = 35_f64.to_radians();
        let force = |tip: Indenter| tip.stiffness() * 2e6 * 100e-9_f64.powf(tip.power());
        assert_relative_eq!(
            force(Indenter::Cone { half_angle }),
            8.915_319e-9,
            max_relative = 1e-5
        );
        let pyramid = Indenter::Pyramid { half_angle };
        assert_relative_eq!(force(pyramid), 1.043_729e-8, max_relative = 1e-5);
        assert_relative_eq!(
            force(Indenter::from(1e-6)),
            8.432_74e-8,
            max_relative = 1e-5
        );
    }

    /// The reduced cone is Griffith's balance: at each approach the energy of elastic deformation and adhesion,
    /// `U(delta, a) - w pi a^2`, is stationary in the contact radius, and the force is its slope by the approach. The
    /// energy is integrated from Sneddon's punches, apart from the closed form.
    #[test]
    fn the_adhesive_cone_balances_energy() {
        // Elastic energy of the cone pressed to the radius a, then withdrawn as a flat punch by s = pi a/2 - delta (t = E* = w = 1).
        let energy = |delta: f64, a: f64| {
            let withdrawn = FRAC_PI_2 * a - delta;
            let pressed = PI * PI * a.powi(3) / 12.0;
            pressed - FRAC_PI_2 * a * a * withdrawn + a * withdrawn * withdrawn - PI * a * a
        };
        for delta in [-0.9_f64, 0.0, 1.0, 8.0, 40.0] {
            let root = (2.0 * PI).sqrt() * (1.0 + (1.0 + delta).sqrt()) / PI;
            let (a, h) = (root * root, 1e-4);
            let slope = (energy(delta, a + h) - energy(delta, a - h)) / (2.0 * h);
            assert!(slope.abs() < 1e-6 * a * a, "{delta}: {slope}");
            let force = (energy(delta + h, a) - energy(delta - h, a)) / (2.0 * h);
            assert_relative_eq!(
                adhesive_cone::force(delta),
                force,
                max_relative = 1e-7,
                epsilon = 1e-6
            );
        }
        // Maugis & Barquins: -54 w^2/(pi E* tan^3 b) under load control, and no tension is greater.
        let (place, least) = adhesive_cone::PULL_OFF;
        assert_relative_eq!(adhesive_cone::force(place), least, max_relative = 1e-12);
        assert!(
            adhesive_cone::force(place + 0.01) > least
                && adhesive_cone::force(place - 0.01) > least
        );
        for force in [0.0, 1.0, 300.0, 1e6] {
            assert!(adhesive_cone::force(adhesive_cone::approach_beyond(force)) >= force);
        }
    }

    #[test]
    fn units_come_back() {
        for tip in [
            CONE,
            Indenter::Pyramid { half_angle: 0.3 },
            Indenter::from(2e-6),
        ] {
            let (force, approach) = tip.units(3e6, 0.04);
            let (work, modulus) = tip.work_and_modulus(force, approach);
            assert_relative_eq!(work, 0.04, max_relative = 1e-12);
            assert_relative_eq!(modulus, 3e6, max_relative = 1e-12);
        }
        // Pull-off of a cone in SI, as Maugis & Barquins write it.
        let slope = 1.2_f64.tan().recip();
        let (force, _) = CONE.units(3e6, 0.04);
        let expected = 54.0 * 0.04 * 0.04 / (PI * 3e6 * slope.powi(3));
        assert_relative_eq!(
            -adhesive_cone::PULL_OFF.1 * force,
            expected,
            max_relative = 1e-12
        );
        let work = CONE.work_of(expected, 3e6);
        assert_relative_eq!(work, 0.04, max_relative = 1e-12);
    }

    #[test]
    fn tips_that_do_not_exist_are_refused() {
        for half_angle in [0.0, -0.2, 1.6, f64::NAN] {
            assert!(
                Indenter::Cone { half_angle }.check().is_err(),
                "{half_angle}"
            );
            assert!(
                Indenter::Pyramid { half_angle }.check().is_err(),
                "{half_angle}"
            );
        }
        assert!(Indenter::from(0.0).check().is_err());
        assert!(CONE.check().is_ok());
    }
}
