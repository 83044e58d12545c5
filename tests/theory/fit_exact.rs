//! `tabor fit` on curves of its own model without noise.

use std::f64::consts::PI;
use std::path::Path;

use tabor::fit::model::{IndenterModel, Parameters};
use tabor::fit::{ForceCurve, Freedom, Model, Sample, fit_curve};

const RADIUS: f64 = 1e-6;
const MODULUS: f64 = 1e6;
const WORK: f64 = 0.05;

/// From the approach on at which the open disc lets go, where the force has infinite slope: a descent that crossed it ended with
/// a work of adhesion 1 % too high, and the curve was said to be no curve of the model.
#[test]
fn curves_without_noise_are_found_again() {
    let truth = Parameters {
        contact_modulus: MODULUS,
        work_of_adhesion: WORK,
        maugis_parameter: 0.0,
        approach_offset: 0.0,
        force_offset: 0.0,
        baseline_slope: 0.0,
    };
    let force_unit = PI * WORK * RADIUS;
    let unit = (force_unit * force_unit / (16.0 / 9.0 * MODULUS * MODULUS * RADIUS)).cbrt();
    let sphere = IndenterModel::new(Model::MaugisDugdale, RADIUS);
    for (lambda, points) in [
        (0.1, 301),
        (0.3, 301),
        (0.6, 301),
        (0.765, 301),
        (0.765, 777),
    ] {
        let truth = Parameters {
            maugis_parameter: lambda,
            ..truth
        };
        // Stable open discs have radii from 8 lambda/(3 pi) on.
        let radius = 8.0 / (3.0 * PI) * lambda;
        let first = -2.0 / (PI * lambda) - 0.5 * radius * radius;
        let step = (4.0 - first) / f64::from(points - 1);
        let approaches: Vec<f64> = (0..points)
            .map(|at| unit * (first + step * f64::from(at)))
            .collect();
        let forces = sphere.forces(&truth, &approaches).expect("forces");
        let samples = approaches.iter().zip(forces);
        let samples = samples.map(|(&approach, force)| Sample { approach, force });
        let curve = ForceCurve {
            samples: samples.collect(),
            ..ForceCurve::default()
        };
        let freedom = Freedom {
            approach_offset: true,
            force_offset: false,
            baseline_slope: false,
            range: None,
        };
        let found = fit_curve(&curve, Path::new("made.csv"), RADIUS, freedom).expect("a fit");
        let name = format!("lambda {lambda}, {points} points");
        assert!(found.describes_curve, "{name}");
        let best = &found.fits[found.chosen];
        assert!(best.converged, "{name}");
        let work = best.parameters.work_of_adhesion;
        // The table of the model is interpolated to 1e-7 of the pull-off.
        assert!((work - WORK).abs() < 1e-5 * WORK, "{name}: {work}");
    }
}
