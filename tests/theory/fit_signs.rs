//! Whether force and approach have the signs that they must have.

use std::path::Path;

use tabor::fit::{FitError, FitRequest, FitResult, ForceCurve, Indenter, Sample};

use crate::test_noise::normal;

const RADIUS: f64 = 5e-6;
const POINTS: u32 = 240;

/// Loading of a sphere without adhesion from six depths before first touch, with noise of 1 % of the greatest force; `more` is the force at
/// a share of the whole approach, from that of the sphere over its greatest.
fn sphere(more: impl Fn(f64, f64) -> f64) -> ForceCurve {
    let mut normal = normal(1);
    let samples = (0..POINTS).map(|i| {
        let share = f64::from(i) / f64::from(POINTS - 1);
        let approach = 0.5e-6 * (7.0 * share - 6.0);
        let hertz = (7.0 * share - 6.0).max(0.0).powf(1.5);
        Sample {
            approach,
            force: 5e-8 * (more(share, hertz) + 0.01 * normal()),
        }
    });
    ForceCurve {
        samples: samples.collect(),
        ..ForceCurve::default()
    }
}

fn fitted(curve: &ForceCurve, baseline: bool, relaxation: bool) -> Result<FitResult, FitError> {
    let mut request = FitRequest::default();
    (request.baseline, request.relaxation) = (baseline, relaxation);
    request.fit(curve, Path::new("made"), Indenter::from(RADIUS))
}

/// Checks that a curve is fitted, and described by no model.
fn has_right_signs(what: &str, curve: &ForceCurve, baseline: bool, relaxation: bool) {
    let found = fitted(curve, baseline, relaxation).unwrap_or_else(|e| panic!("{what}: {e}"));
    assert!(!found.describes_curve, "{what}");
    assert_eq!(found.relaxation.is_some(), relaxation, "{what}");
}

/// Checks that a curve is refused where its approach is reversed.
fn is_refused_reversed(what: &str, curve: &ForceCurve) {
    let turned = |sample: &Sample| Sample {
        approach: -sample.approach,
        ..*sample
    };
    let turned = ForceCurve {
        samples: curve.samples.iter().map(turned).collect(),
        ..curve.clone()
    };
    let found = fitted(&turned, false, false);
    let is_refused = matches!(found, Err(FitError::WrongWay { .. }));
    assert!(is_refused, "{what}, reversed: {found:?}");
}

/// No model describes these curves, nor their reversals, one of which was a little better each time: a tilted baseline, a detector at its
/// limit, a surface that gives way. The sign was said to be wrong.
#[test]
fn a_curve_that_no_model_describes_keeps_its_signs() {
    let tilted = sphere(|share, hertz| hertz + 0.3 * share);
    has_right_signs("tilt", &tilted, true, false);
    let limited = sphere(|_, hertz| hertz.min(0.5));
    let gives_way = sphere(|share, hertz| if share > 0.95 { 0.5 * hertz } else { hertz });
    for (what, curve) in [("limit", limited), ("pop-in", gives_way)] {
        has_right_signs(what, &curve, false, false);
        is_refused_reversed(what, &curve);
    }
}

/// A standard linear solid of 20 and 60 kPa and 0.15 s, whose approach slows down to a twentieth: its force falls before the loading ends.
#[test]
fn a_loading_that_slows_down_has_the_right_sign() {
    let mut normal = normal(2);
    let count = 300;
    let (mut faded, mut before) = (0.0, 0.0);
    let (mut times, mut samples) = (Vec::new(), Vec::new());
    for i in 0..count {
        let time = f64::from(i) / f64::from(count - 1);
        let place = (1.0 - (-3.0 * time).exp()) / (1.0 - (-3.0_f64).exp());
        let approach = 1e-6 * (3.0 * place - 1.0);
        let power = approach.max(0.0).powf(1.5);
        let step = 1.0 / f64::from(count - 1) / 0.15;
        faded = faded * (-step).exp() + (power - before) * (1.0 - (-step).exp()) / step;
        before = power;
        let force = 4.0 / 3.0 * RADIUS.sqrt() * (2e4 * power + 6e4 * faded);
        times.push(time);
        samples.push(Sample {
            approach,
            force: force + 4e-10 * normal(),
        });
    }
    let curve = ForceCurve {
        samples,
        times,
        ..ForceCurve::default()
    };
    has_right_signs("slowing", &curve, false, true);
    is_refused_reversed("slowing", &curve);
}
