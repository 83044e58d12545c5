//! `tabor fit` of solids that relax.

use std::path::Path;

use tabor::fit::{FitError, FitRequest, FitResult, ForceCurve, Indenter, Sample};

use crate::shared::random::Random;

const RADIUS: f64 = 10e-6;

/// Relaxed modulus and that which relaxes, Pa, and relaxation time, s.
type Solid = [f64; 3];

/// A sphere that follows `approaches` at `times` on a standard linear solid, with noise of a share of the greatest force.
/// The integral of Lee & Radok, with the power of the approach linear in time between points.
fn pressed(solid: Solid, times: &[f64], approaches: &[f64], noise: f64, seed: u64) -> ForceCurve {
    let [relaxed, rest, time] = solid;
    let power = |approach: f64| approach.max(0.0).powf(1.5);
    let (mut before, mut faded) = ((times[0], power(approaches[0])), 0.0);
    let mut forces = Vec::new();
    for (at, approach) in times.iter().zip(approaches) {
        let now = power(*approach);
        let step = (at - before.0) / time;
        let fade = (-step).exp();
        let mean = if step > 0.0 { (1.0 - fade) / step } else { 1.0 };
        faded = faded * fade + (now - before.1) * mean;
        before = (*at, now);
        forces.push(4.0 / 3.0 * RADIUS.sqrt() * (relaxed * now + rest * faded));
    }
    let noise = noise * forces.iter().copied().fold(0.0, f64::max);
    let mut random = Random(seed);
    let samples = approaches
        .iter()
        .zip(forces)
        .map(|(approach, force)| Sample {
            approach: *approach,
            force: force + noise * random.normal(),
        });
    ForceCurve {
        samples: samples.collect(),
        times: times.to_vec(),
        ..ForceCurve::default()
    }
}

/// Times and approaches of a ramp from as far before touch as it goes behind it, and of a hold.
fn ramp_and_hold(points: usize, held: usize, duration: f64, depth: f64) -> (Vec<f64>, Vec<f64>) {
    let step = duration / (points - 1) as f64;
    let times = (0..points + held).map(|i| step * i as f64).collect();
    let place = |i: usize| depth * (2.0 * i.min(points - 1) as f64 / (points - 1) as f64 - 1.0);
    (times, (0..points + held).map(place).collect())
}

fn fit(curve: &ForceCurve, relaxation: bool, baseline: bool) -> Result<FitResult, FitError> {
    let mut request = FitRequest::default();
    (request.relaxation, request.baseline) = (relaxation, baseline);
    request.fit(curve, Path::new("made.csv"), Indenter::from(RADIUS))
}

/// The force falls while the approach is held; its sign is right all the same, and a wrong one is found.
#[test]
fn a_hold_does_not_decide_the_sign() {
    for (points, held) in [(201, 200), (201, 50), (101, 900)] {
        let (times, approaches) = ramp_and_hold(points, held, 0.2, 1e-6);
        let curve = pressed([1e6, 2e6, 0.05], &times, &approaches, 0.003, 3);
        let result = fit(&curve, false, false).expect("signs that are right");
        assert!(!result.describes_curve, "{points} {held}");
        for (approach, force) in [(-1.0, 1.0), (1.0, -1.0)] {
            let turned = |sample: &Sample| Sample {
                approach: approach * sample.approach,
                force: force * sample.force,
            };
            let turned = ForceCurve {
                samples: curve.samples.iter().map(turned).collect(),
                ..curve.clone()
            };
            let error = fit(&turned, false, false).expect_err("a wrong sign");
            assert!(
                matches!(
                    error,
                    FitError::WrongWay { .. } | FitError::NoCompression { .. }
                ),
                "{points} {held} {approach} {force}: {error}"
            );
        }
    }
}

fn relaxation(curve: &ForceCurve, baseline: bool) -> [(f64, f64); 3] {
    let result = fit(curve, true, baseline).expect("a fit");
    let solid = result.relaxation.expect("asked for");
    [
        solid.relaxed_modulus,
        solid.instantaneous_modulus,
        solid.time,
    ]
}

/// Where most of the modulus relaxes the elastic fit takes the bend of the curve for adhesion, and touches far off.
#[test]
fn the_first_touch_is_found_where_the_elastic_fit_misses_it() {
    let solid = [1e6, 2e6, 0.05];
    let truths = [1e6, 3e6, 0.05];
    for (seed, baseline) in [(3, true), (4, false)] {
        let (times, approaches) = ramp_and_hold(601, 200, 0.3, 1e-6);
        let curve = pressed(solid, &times, &approaches, 0.003, seed);
        let found = relaxation(&curve, baseline);
        for ((value, deviation), truth) in found.into_iter().zip(truths) {
            assert!(
                (value - truth).abs() < 3.5 * deviation && deviation < 0.3 * truth,
                "{seed}: {value:e} +- {deviation:e}, is {truth:e}"
            );
        }
    }
}

/// A loading shorter than the relaxation time, of a solid that relaxes little, hardly knows the time: what is stated holds the truth, and
/// what is not known is not stated.
#[test]
fn what_a_short_loading_does_not_know_is_not_stated() {
    let truths = [1e6, 1.3e6, 0.05];
    let (mut stated, mut missed) = (0, 0);
    for seed in 0..12 {
        let (times, approaches) = ramp_and_hold(401, 0, 0.05, 1e-6);
        let curve = pressed([1e6, 0.3e6, 0.05], &times, &approaches, 0.003, 20 + seed);
        for ((value, deviation), truth) in relaxation(&curve, false).into_iter().zip(truths) {
            assert_eq!(value.is_nan(), deviation.is_nan());
            stated += usize::from(value.is_finite());
            missed += usize::from((value - truth).abs() > 3.0 * deviation);
        }
    }
    println!("{stated} of 36 stated, {missed} missed");
    assert!(missed <= 1, "{missed} of {stated} missed");
}

/// The approach has the noise of a deflection that was measured by position, which is not that of its power: the modulus at once was 11 % low, and all
/// three numbers were up to four of their stated deviations off.
#[test]
fn the_noise_of_a_deflection_is_not_in_the_moduli() {
    let (solid, spring, noise) = ([5e3, 10e3, 0.1], 0.07, 1e-9);
    let (times, approaches) = ramp_and_hold(300, 0, 1.0, 6.5e-7);
    let exact = pressed(solid, &times, &approaches, 0.0, 1);
    let truth = [5e3, 15e3, 0.1];
    let mut squares = [0.0; 3];
    let seeds = 6;
    for seed in 0..seeds {
        let mut random = Random(100 + seed);
        let samples = exact.samples.iter().map(|sample| {
            let deflection = noise * random.normal();
            Sample {
                approach: sample.approach - deflection,
                force: sample.force + spring * deflection,
            }
        });
        let curve = ForceCurve {
            samples: samples.collect(),
            spring: Some(spring),
            has_positions: true,
            ..exact.clone()
        };
        let found = relaxation(&curve, true);
        for (square, ((value, deviation), truth)) in squares.iter_mut().zip(found.iter().zip(truth))
        {
            *square += ((value - truth) / deviation).powi(2);
        }
    }
    // The sum of 6 squares of normal numbers is below 22.5 in 999 cases of 1000.
    assert!(squares.iter().all(|square| *square < 22.5), "{squares:?}");
}
