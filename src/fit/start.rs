//! Where the search for a model's numbers begins.

use std::f64::consts::PI;

use super::curve_file::Sample;
use super::measured::Measured;
use super::model::{Model, Parameters, SphereModel, units};

/// Parameters to start from: by the pull-off and the indentation, and by Hertz.
pub(super) fn starts(measured: &Measured, model: Model, lambda: f64) -> Vec<Parameters> {
    let baseline = measured.baseline();
    let (least, greatest) = measured.extremes();
    let mut starts = Vec::new();
    let hertz = hertz_start(measured, baseline, greatest);
    let sphere = SphereModel::new(model, measured.radius);
    if model.adheres()
        && let Some(start) = pull_off_start(&sphere, lambda, baseline, (least, greatest))
    {
        starts.push(start);
    }
    let tension = (baseline - least.force).max(1e-3 * (greatest.force - baseline));
    starts.push(Parameters {
        work_of_adhesion: if model.adheres() {
            tension / (1.75 * PI * measured.radius)
        } else {
            0.0
        },
        maugis_parameter: lambda,
        ..hertz
    });
    if !measured.freedom.approach_offset {
        for start in &mut starts {
            start.approach_offset = 0.0;
        }
    }
    starts
}

/// A straight line through the approach over the force to the power 2/3.
fn hertz_start(measured: &Measured, baseline: f64, greatest: Sample) -> Parameters {
    let least = 0.05 * (greatest.force - baseline);
    let pressed = measured
        .samples
        .iter()
        .filter(|sample| sample.force - baseline > least)
        .map(|sample| ((sample.force - baseline).powf(2.0 / 3.0), sample.approach));
    let (mut n, mut x, mut y, mut xx, mut xy) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for (force, approach) in pressed {
        n += 1.0;
        x += force;
        y += approach;
        xx += force * force;
        xy += force * approach;
    }
    let spread = n * xx - x * x;
    let mut slope = (n * xy - x * y) / spread;
    if !slope.is_finite() || slope <= 0.0 {
        slope = 0.5 * measured.approach_span / (greatest.force - baseline).powf(2.0 / 3.0);
    }
    Parameters {
        contact_modulus: 0.75 * slope.powf(-1.5) / measured.radius.sqrt(),
        work_of_adhesion: 0.0,
        maugis_parameter: 1.0,
        approach_offset: (y - slope * x) / n.max(1.0),
        force_offset: baseline,
    }
}

/// Pull-off gives w; the way from there to the greatest force gives the modulus.
fn pull_off_start(
    sphere: &SphereModel,
    lambda: f64,
    baseline: f64,
    (least, greatest): (Sample, Sample),
) -> Option<Parameters> {
    let (place, force) = sphere.pull_off(lambda).ok()?;
    let tension = baseline - least.force;
    let unit = tension / -force;
    let way = greatest.approach - least.approach;
    if unit <= 0.0 || way <= 0.0 {
        return None;
    }
    let deepest = sphere
        .approach_at(lambda, (greatest.force - baseline) / unit)
        .ok()?;
    let approach_unit = way / (deepest - place);
    let work_of_adhesion = unit / (PI * sphere.radius);
    // The unit of approach is (pi^2 w^2 R/K^2)^(1/3).
    let contact_modulus =
        0.75 * PI * work_of_adhesion * (sphere.radius / approach_unit.powi(3)).sqrt();
    debug_assert!(
        (units(sphere.radius, contact_modulus, work_of_adhesion).1 / approach_unit - 1.0).abs()
            < 1e-6
    );
    contact_modulus.is_finite().then_some(Parameters {
        contact_modulus,
        work_of_adhesion,
        maugis_parameter: lambda,
        approach_offset: least.approach - place * approach_unit,
        force_offset: baseline,
    })
}
