//! Baselines that are tilted.

use std::path::Path;

use tabor::fit::{FitError, ForceCurve, Freedom, Model, Sample, fit_curve};
use tabor::theory::jkr;
use tabor::theory::tabor_map::Sphere;

use crate::test_noise::normal;

const ALL_FREE: Freedom = Freedom {
    approach_offset: true,
    force_offset: true,
    baseline_slope: true,
    range: None,
};

/// A straight line without contact, exact or with noise, is refused. The exact one had w = 1e-18 J/m^2.
#[test]
fn a_line_is_no_contact() {
    for noise in [0.0, 1e-8] {
        let mut normal = normal(5);
        let samples = (0..60).map(|i| {
            let approach = 2e-6 - 2.3e-6 * f64::from(i) / 59.0;
            Sample {
                approach,
                force: 1e-6 + 0.3 * approach + noise * normal(),
            }
        });
        let curve = ForceCurve {
            samples: samples.collect(),
            ..ForceCurve::default()
        };
        let found = fit_curve(&curve, Path::new("line"), 10e-6, ALL_FREE);
        let refused = matches!(
            found,
            Err(FitError::NoCompression { .. }
                | FitError::NoBaseline { .. }
                | FitError::NoContact { .. })
        );
        assert!(refused, "{noise}: {found:?}");
    }
}

/// Light that interferes tilts the deflection by 3 nm for each um of the piezo, which in contact moves some ten times as far as the
/// probe, so that the approach, position less deflection, is 3 % too short. The modulus came out 4.6 % too high, with an uncertainty of
/// 1.6 %.
#[test]
fn a_tilt_of_the_deflection_is_not_in_the_approach() {
    let (spring, tilt, offset) = (0.5, 1.5e-3, 1e-6);
    let (radius, modulus, work) = (5e-6, 2e6, 0.02);
    let sphere = Sphere::new(radius, modulus, work).unwrap();
    let pull_off = jkr::pull_off_force(&sphere).abs();
    let mut normal = normal(3);
    let contact = (0..200).map(|i| pull_off * (0.5 - 1.49 * f64::from(i) / 199.0));
    let states = contact.map(|force| {
        let approach = jkr::approach(&sphere, jkr::contact_radius(&sphere, force).unwrap());
        (approach + force / spring, force)
    });
    let free = (0..200).map(|i| (-2.2e-6 - 5e-9 * f64::from(i), 0.0));
    let samples: Vec<Sample> = states
        .chain(free)
        .map(|(position, force)| {
            let force = force + offset + tilt * position + 1e-3 * pull_off * normal();
            Sample {
                approach: position - force / spring,
                force,
            }
        })
        .collect();
    let mut curve = ForceCurve {
        samples: samples.clone(),
        spring: Some(spring),
        has_positions: true,
        ..ForceCurve::default()
    };
    let found = |curve: &ForceCurve| {
        let result = fit_curve(curve, Path::new("tilted"), radius, ALL_FREE).unwrap();
        let jkr = result.fit_of(Model::Jkr).unwrap().parameters;
        (result, jkr)
    };
    let (result, jkr) = found(&curve);
    approx::assert_relative_eq!(jkr.contact_modulus, modulus, max_relative = 5e-3);
    approx::assert_relative_eq!(jkr.work_of_adhesion, work, max_relative = 5e-3);
    // The offset of the deflection is one of the approach, which stays where it was measured at first touch.
    let expected = -offset / spring;
    assert!((jkr.approach_offset - expected).abs() < 1e-9, "{jkr:?}");
    approx::assert_relative_eq!(
        result.baseline_slope.unwrap().value,
        tilt,
        max_relative = 0.02
    );
    assert_eq!(result.best().model, Model::Jkr);
    assert_eq!(result.as_measured, samples);
    // Approaches that were found by another program are left as they are.
    curve.has_positions = false;
    assert!(found(&curve).1.contact_modulus > 1.04 * modulus);
}

/// A sphere of 5 um on a cantilever that is pulled off by even steps of its base.
struct Pulled {
    sphere: Sphere,
    spring: f64,
    greatest: f64,
    /// Of the force, as the deflection has it.
    noise: f64,
    points: u32,
}

const RADIUS: f64 = 5e-6;

impl Pulled {
    /// The curve on a baseline with an offset and this slope by position.
    fn curve(&self, tilt: f64, seed: u64) -> ForceCurve {
        let (sphere, spring) = (&self.sphere, self.spring);
        let pull_off = jkr::pull_off_force(sphere);
        let position = |force: f64| {
            let contact = jkr::contact_radius(sphere, force).unwrap();
            jkr::approach(sphere, contact) + force / spring
        };
        let (deep, leaves) = (position(self.greatest), position(pull_off));
        let far = leaves - 2e-6;
        let mut normal = normal(seed);
        let samples = (0..self.points).map(|i| {
            let base = deep + (far - deep) * f64::from(i) / f64::from(self.points - 1);
            let (mut low, mut high) = (pull_off, self.greatest);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if position(middle) < base {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            let contact = if base > leaves { low } else { 0.0 };
            let force = contact + 1e-8 + tilt * base + self.noise * normal();
            Sample {
                approach: base - force / spring,
                force,
            }
        });
        ForceCurve {
            samples: samples.collect(),
            spring: Some(spring),
            has_positions: true,
            ..ForceCurve::default()
        }
    }
}

/// Contact modulus and slope of the baseline less the true ones, over their stated deviations, of a sphere whose contact is up to 50 times
/// stiffer than the spring, with a noise of 0.2 nm in its deflection.
fn errors_on_a_soft_spring(work: f64, tilt: f64, seed: u64) -> [f64; 2] {
    let modulus = 5e6;
    let pulled = Pulled {
        sphere: Sphere::new(RADIUS, modulus, work).unwrap(),
        spring: 0.14,
        greatest: 4.7e-7,
        noise: 3e-11,
        points: 120,
    };
    let curve = pulled.curve(tilt, seed);
    let result = fit_curve(&curve, Path::new("soft"), RADIUS, ALL_FREE).unwrap();
    let slope = result.baseline_slope.unwrap();
    let error = result.best().parameters.contact_modulus - modulus;
    // It is 1 % of the modulus, and no vague number.
    assert!(result.modulus_uncertainty.unwrap() < 0.02 * modulus);
    [
        error / result.modulus_uncertainty.unwrap(),
        (slope.value - tilt) / slope.uncertainty,
    ]
}

/// With a noise of 20 nm in the deflection, at positions that are known. By approaches, which have that noise too, DMT was found, with a modulus 16 % low,
/// two and a half stated deviations.
#[test]
fn a_noisy_deflection_leaves_the_modulus_in_its_deviation() {
    let (modulus, freedom) = (
        2e6,
        Freedom {
            baseline_slope: false,
            ..ALL_FREE
        },
    );
    let pulled = Pulled {
        sphere: Sphere::new(RADIUS, modulus, 0.03).unwrap(),
        spring: 0.5,
        greatest: 1e-6,
        noise: 1e-8,
        points: 400,
    };
    let mut squares = 0.0;
    for seed in 0..6 {
        let result = fit_curve(
            &pulled.curve(0.0, seed),
            Path::new("noisy"),
            RADIUS,
            freedom,
        )
        .unwrap();
        let error = result.best().parameters.contact_modulus - modulus;
        let deviation = result.modulus_uncertainty.unwrap();
        assert!(deviation < 0.2 * modulus, "{deviation:e}");
        squares += (error / deviation).powi(2);
    }
    // The sum of 6 squares of normal numbers is below 22.5 in 999 cases of 1000.
    assert!(squares < 22.5, "{squares}");
}

/// The deflection has the same noise everywhere, which the stiff contact makes one of the approach: it is the free points that tell the slope. The
/// modulus was up to 8 of its stated deviations too low.
#[test]
fn a_stiff_contact_on_a_soft_spring_keeps_its_modulus() {
    let seeds = 2_u64;
    for (work, tilt) in [(1e-6, -2e-3), (0.01, 2e-3)] {
        let errors = (0..seeds).map(|seed| errors_on_a_soft_spring(work, tilt, seed));
        let squares = errors.fold([0.0; 2], |sum, [modulus, slope]| {
            [sum[0] + modulus * modulus, sum[1] + slope * slope]
        });
        // The sum of 2 squares of normal numbers is below 13.8 in 999 cases of 1000.
        assert!(squares.iter().all(|square| *square < 13.8), "{squares:?}");
    }
}

/// A force of long range, which falls in a straight line as far as the curve goes, deflects the cantilever and is in no approach: the slope is one
/// of the force, and not taken out of the approach.
#[test]
fn a_force_of_long_range_stays_in_the_approach() {
    let (radius, modulus, work, spring, slope) = (5e-6, 5e6, 0.01, 0.14, 0.02);
    let sphere = Sphere::new(radius, modulus, work).unwrap();
    let pull_off = jkr::pull_off_force(&sphere);
    let contact = (0..100).map(|i| {
        let force = pull_off * (1.0 - f64::from(i) / 99.0) + 4.7e-7 * f64::from(i) / 99.0;
        let approach = jkr::approach(&sphere, jkr::contact_radius(&sphere, force).unwrap());
        (approach, force)
    });
    let free = (0..100).map(|i| (-2.2e-6 + 2e-8 * f64::from(i), 0.0));
    let mut normal = normal(11);
    let samples = free.chain(contact).map(|(approach, contact)| {
        let force = contact + slope * approach;
        let noise = 3e-11 * normal();
        Sample {
            approach: approach - noise / spring,
            force: force + noise,
        }
    });
    let curve = ForceCurve {
        samples: samples.collect(),
        spring: Some(spring),
        has_positions: true,
        ..ForceCurve::default()
    };
    let result = fit_curve(&curve, Path::new("long"), radius, ALL_FREE).unwrap();
    let within = |found: f64, truth: f64, deviation: f64| {
        assert!(
            (found - truth).abs() < 3.3 * deviation,
            "{found:e} +- {deviation:e}, {truth:e}"
        );
    };
    let found = result.best().parameters;
    within(
        found.contact_modulus,
        modulus,
        result.modulus_uncertainty.unwrap(),
    );
    within(
        found.work_of_adhesion,
        work,
        result.work_uncertainty.unwrap(),
    );
    let found = result.baseline_slope.unwrap();
    within(found.value, slope, found.uncertainty);
    assert!(found.uncertainty < 0.01 * slope);
}

/// With some noise, a slope of the force and a false adhesion fit such a curve a little better than the true tilt of its deflection. The
/// modulus was 7 % low, eleven of its stated deviations.
#[test]
fn a_tilt_of_the_deflection_is_no_force_of_long_range() {
    let (radius, modulus, spring, tilt) = (2e-6, 20e6, 1.0, -4e-3);
    let stiffness = 4.0 / 3.0 * modulus * f64::sqrt(radius);
    for seed in 0..2 {
        let mut normal = normal(seed);
        let samples = (0..400).map(|i| {
            let base = 6e-7 - 2.6e-6 * f64::from(i) / 399.0;
            // Newton's method comes down to the depth at which the spring is balanced.
            let mut depth = base.max(0.0);
            for _ in 0..40 {
                let force = stiffness * depth.powf(1.5);
                let slope = 1.5 * stiffness * depth.sqrt();
                depth -= (depth + force / spring - base.max(0.0)) / (1.0 + slope / spring);
                depth = depth.max(0.0);
            }
            let force = stiffness * depth.powf(1.5) + tilt * base + 3e-10 * normal();
            Sample {
                approach: base - force / spring,
                force,
            }
        });
        let curve = ForceCurve {
            samples: samples.collect(),
            spring: Some(spring),
            has_positions: true,
            ..ForceCurve::default()
        };
        let result = fit_curve(&curve, Path::new("tilted"), radius, ALL_FREE).unwrap();
        let error = result.best().parameters.contact_modulus - modulus;
        let deviation = result.modulus_uncertainty.unwrap();
        assert!(
            error.abs() < 3.3 * deviation,
            "{seed}: {error:e} +- {deviation:e}"
        );
        assert!(deviation < 0.03 * modulus, "{seed}: {deviation:e}");
    }
}
