//! Errors of radius and spring constant, carried into work of adhesion and modulus.

use super::choice::FitResult;

/// Relative standard deviations of what a force curve is evaluated with.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Calibration {
    /// Of the radius.
    pub radius_error: f64,
    /// Of the spring constant.
    pub spring_error: f64,
}

impl Calibration {
    /// Of radius and spring constant.
    pub fn new(radius_error: f64, spring_error: f64) -> Self {
        Calibration {
            radius_error,
            spring_error,
        }
    }

    /// Whether anything is uncertain.
    pub fn is_uncertain(&self) -> bool {
        self.radius_error > 0.0 || self.spring_error > 0.0
    }

    /// Relative standard deviations of work of adhesion and contact modulus that follow.
    ///
    /// Force and approach scale as `w R` and as the square of the contact radius over `R`: for the same curve, w is
    /// proportional to k/R and E* to k/sqrt(R), for Hertz, DMT and JKR exactly.
    pub fn relative_errors(&self) -> [f64; 2] {
        [
            self.spring_error.hypot(self.radius_error),
            self.spring_error.hypot(0.5 * self.radius_error),
        ]
    }

    /// Adds the errors to the uncertainties of a result and of all its models; a number that the curve does not determine
    /// stays so.
    pub fn widen(&self, result: &mut FitResult) {
        let best = result.best().parameters;
        let [work, modulus] = match result.measured.indenter.radius() {
            Some(_) => self.relative_errors(),
            // Both are proportional to the spring constant for cones too.
            None => [self.spring_error; 2],
        };
        let with = |deviation: Option<f64>, error: f64| Some(deviation?.hypot(error));
        result.work_uncertainty = with(result.work_uncertainty, work * best.work_of_adhesion);
        result.modulus_uncertainty =
            with(result.modulus_uncertainty, modulus * best.contact_modulus);
        let radius = result.measured.indenter.radius().unwrap_or(f64::NAN);
        for fit in &mut result.fits {
            let (numbers, stated) = (fit.parameters, &mut fit.uncertainties);
            stated.contact_modulus =
                with(stated.contact_modulus, modulus * numbers.contact_modulus);
            stated.work_of_adhesion =
                with(stated.work_of_adhesion, work * numbers.work_of_adhesion);
            // The tension goes with w, and the range, of the same curve, stays.
            stated.peak_tension = with(stated.peak_tension, work * numbers.peak_tension(radius));
        }
        if let Some(solid) = &mut result.relaxation {
            for (value, deviation) in [&mut solid.relaxed_modulus, &mut solid.instantaneous_modulus]
            {
                *deviation = deviation.hypot(modulus * *value);
            }
        }
        if let Some(found) = &mut result.inversion {
            found.work_uncertainty = found.work_uncertainty.hypot(work * found.work_of_adhesion);
            found.modulus_uncertainty = found
                .modulus_uncertainty
                .hypot(modulus * found.contact_modulus);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::fit::{ForceCurve, Freedom, Relaxation, Sample, fit_curve};
    use crate::theory::jkr;
    use crate::theory::tabor_map::Sphere;

    /// A JKR sphere of another radius or spring constant has the same curve if w and E* follow the errors.
    #[test]
    fn another_radius_or_spring_gives_the_same_jkr_curve() {
        let (radius, work, modulus) = (1e-6, 0.05, 1e7);
        let share: f64 = 1.01;
        let at = |radius: f64, work: f64, modulus: f64, force: f64| {
            let sphere = Sphere::new(radius, modulus, work).unwrap();
            jkr::approach(&sphere, jkr::contact_radius(&sphere, force).unwrap())
        };
        let force = 2e-7;
        let here = at(radius, work, modulus, force);
        let wider = at(radius * share, work / share, modulus / share.sqrt(), force);
        approx::assert_relative_eq!(here, wider, max_relative = 1e-12);
        let stiffer = at(radius, work * share, modulus * share, force * share);
        approx::assert_relative_eq!(here, stiffer, max_relative = 1e-12);
        let [work_error, modulus_error] = Calibration::new(0.03, 0.04).relative_errors();
        approx::assert_relative_eq!(work_error, 0.05, max_relative = 1e-12);
        approx::assert_relative_eq!(modulus_error, 0.0427200187, max_relative = 1e-8);
    }

    /// The moduli of a solid that relaxes are as uncertain as the calibration, its time is not; what is not known stays so.
    #[test]
    fn a_solid_that_relaxes_has_the_errors_of_its_moduli() {
        let samples = (0..20).map(|i| {
            let approach = 1e-7 * (f64::from(i) / 19.0 - 0.3);
            Sample {
                approach,
                force: 4.0 / 3.0 * 1e6 * 1e-3 * approach.max(0.0).powf(1.5),
            }
        });
        let curve = ForceCurve {
            samples: samples.collect(),
            ..ForceCurve::default()
        };
        let mut result = fit_curve(&curve, Path::new("made"), 1e-6, Freedom::default()).unwrap();
        result.relaxation = Some(Relaxation {
            relaxed_modulus: (1e6, 3e4),
            instantaneous_modulus: (f64::NAN, f64::NAN),
            time: (0.1, 0.01),
            noise: 0.0,
            points: 0,
        });
        let calibration = Calibration::new(0.05, 0.1);
        calibration.widen(&mut result);
        let [_, modulus] = calibration.relative_errors();
        let solid = result.relaxation.unwrap();
        let relaxed = (1e6, 3e4_f64.hypot(modulus * 1e6));
        assert_eq!(solid.relaxed_modulus, relaxed);
        assert!(solid.instantaneous_modulus.1.is_nan());
        assert_eq!(solid.time, (0.1, 0.01));
    }
}
