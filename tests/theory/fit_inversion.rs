//! Work of adhesion and modulus from pull-off and stiffness.

use std::path::Path;

use tabor::fit::{
    Calibration, FitResult, ForceCurve, Freedom, Inversion, Model, Sample, fit_curve,
};
use tabor::theory::jkr;
use tabor::theory::tabor_map::Sphere;

use crate::test_noise::normal;

const RADIUS: f64 = 10e-6;
const SPAN: f64 = 3e-6;

/// Unloading of a JKR sphere to pull-off and beyond, with deterministic noise of a share of the pull-off.
fn unloaded(sphere: &Sphere, noise: f64, seed: u64) -> Vec<Sample> {
    let most = jkr::pull_off_force(sphere).abs();
    let scale = most * noise;
    // Let go at pull-off: the rest down to the fold is no matter here.
    let least = jkr::contact_radius(sphere, -(1.0 - 1e-9) * most);
    let fold = jkr::approach(sphere, least.unwrap());
    let mut normal = normal(seed);
    let at = |i: u32| 0.5 * SPAN - SPAN * f64::from(i) / 299.0;
    (0..300)
        .map(|i| {
            let approach = at(i);
            let force = if approach < fold {
                0.0
            } else {
                let contact = jkr::contact_radius_at_approach(sphere, approach).unwrap();
                jkr::force(sphere, contact)
            };
            Sample {
                approach,
                force: force + scale * normal(),
            }
        })
        .collect()
}

fn free() -> Freedom {
    Freedom {
        approach_offset: true,
        force_offset: false,
        baseline_slope: false,
        range: None,
    }
}

fn fitted(samples: Vec<Sample>) -> FitResult {
    let curve = ForceCurve {
        samples,
        ..ForceCurve::default()
    };
    fit_curve(&curve, Path::new("made"), RADIUS, free()).unwrap()
}

/// A straight line through the loads took 0.985 of the modulus, and the least of all points 1.03 of the work.
#[test]
fn jkr_curves_give_their_numbers_back() {
    let sphere = Sphere::new(RADIUS, 5e6, 0.05).unwrap();
    let found = fitted(unloaded(&sphere, 1e-5, 1)).inversion.unwrap();
    // A parabola has 0.2 % of the slope wrong, which is to the power 3/2 in the modulus.
    assert!(
        (found.contact_modulus / 5e6 - 1.0).abs() < 4e-3,
        "{found:?}"
    );
    assert!(
        (found.work_of_adhesion / 0.05 - 1.0).abs() < 2e-3,
        "{found:?}"
    );
    let (mut work, mut modulus) = (0.0, 0.0);
    let count = 6;
    for seed in 0..count {
        let found = fitted(unloaded(&sphere, 0.02, 7 + seed)).inversion.unwrap();
        work += (found.work_of_adhesion - 0.05) / found.work_uncertainty;
        modulus += (found.contact_modulus - 5e6) / found.modulus_uncertainty;
    }
    // Sums of standard normal numbers: three deviations.
    let most = 3.0 * (count as f64).sqrt();
    assert!(
        work.abs() < most && modulus.abs() < most,
        "{work} {modulus}"
    );
}

/// A sphere without adhesion has no pull-off, and touches where the model does. Its noise gave w = 0.7 +- 0.2 mJ/m^2.
#[test]
fn noise_is_no_pull_off() {
    let tiny = Sphere::new(RADIUS, 5e6, 1e-9).unwrap();
    // A noise of 50 nN: the adhesion is nothing.
    let result = fitted(unloaded(&tiny, 1e6, 1));
    assert_eq!(result.best().model, Model::Hertz);
    assert_eq!(result.inversion, None);
    let touch = result.best().parameters.approach_offset;
    for (at, sample) in result.measured.samples.iter().enumerate() {
        assert_eq!(result.best().interacting[at], sample.approach >= touch);
    }
}

/// The same curve on a tilted baseline has the same uncertainties wherever approach 0 lies: that of w was 40 times as large at
/// 0.1 mm.
#[test]
fn a_shifted_curve_has_the_same_uncertainties() {
    let sphere = Sphere::new(RADIUS, 5e6, 0.05).unwrap();
    let [near, far] = [0.0, 1e-4].map(|shift| {
        let mut samples = unloaded(&sphere, 0.01, 5);
        for sample in &mut samples {
            sample.force += 0.3 * sample.approach + 1e-7;
            sample.approach += shift;
        }
        let curve = ForceCurve {
            samples,
            ..ForceCurve::default()
        };
        let freedom = Freedom {
            force_offset: true,
            baseline_slope: true,
            ..free()
        };
        let result = fit_curve(&curve, Path::new("shifted"), RADIUS, freedom).unwrap();
        let deviation = result.baseline_slope.unwrap().uncertainty;
        (result.inversion.unwrap(), deviation)
    });
    let same = |of: fn(&Inversion) -> f64| {
        approx::assert_relative_eq!(of(&near.0), of(&far.0), max_relative = 1e-3);
    };
    same(|found| found.work_uncertainty);
    same(|found| found.modulus_uncertainty);
    // E* goes with the stiffness to the power 3/2, about, at a fixed pull-off.
    let tilt = near.1 / near.0.stiffness * near.0.contact_modulus;
    assert!(near.0.modulus_uncertainty > tilt, "{near:?}");
}

#[test]
fn errors_of_the_calibration_are_added() {
    let sphere = Sphere::new(RADIUS, 5e6, 0.05).unwrap();
    let mut result = fitted(unloaded(&sphere, 0.005, 3));
    let before = result.inversion.unwrap();
    let fits = result.fits.clone();
    let calibration = Calibration::new(0.05, 0.1);
    calibration.widen(&mut result);
    let after = result.inversion.unwrap();
    let [work, modulus] = calibration.relative_errors();
    for (with, own, error) in [
        (
            after.work_uncertainty,
            before.work_uncertainty,
            work * before.work_of_adhesion,
        ),
        (
            after.modulus_uncertainty,
            before.modulus_uncertainty,
            modulus * before.contact_modulus,
        ),
    ] {
        approx::assert_relative_eq!(with, own.hypot(error), max_relative = 1e-12);
        assert!(with > 2.0 * own);
    }
    // And of all models.
    for (fit, before) in result.fits.iter().zip(&fits) {
        let (numbers, own) = (fit.parameters, before.uncertainties);
        for (with, own, error) in [
            (
                fit.uncertainties.contact_modulus,
                own.contact_modulus,
                modulus * numbers.contact_modulus,
            ),
            (
                fit.uncertainties.work_of_adhesion,
                own.work_of_adhesion,
                work * numbers.work_of_adhesion,
            ),
            (
                fit.uncertainties.peak_tension,
                own.peak_tension,
                work * fit.peak_tension(RADIUS).unwrap_or(f64::NAN),
            ),
        ] {
            assert_eq!(with, own.map(|own| own.hypot(error)));
        }
    }
}
