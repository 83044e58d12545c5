//! What a curve and its fits say in dimensionless numbers.

use std::f64::consts::PI;

use super::super::choice::{DECISIVE_AIC, FitResult};
use super::super::curve_file::Sample;
use super::super::estimate::ModelFit;
use super::super::measured::Measured;
use super::super::model::Model;

/// Names of the features, in the order of [`features`].
pub const CURVE_FEATURES: [&str; 21] = [
    "tension over load",
    "noise over tension",
    "misfit of Hertz over that of Maugis-Dugdale",
    "misfit of DMT over that of Maugis-Dugdale",
    "misfit of JKR over that of Maugis-Dugdale",
    "misfit of Maugis-Dugdale over the noise",
    "misfit of Maugis-Dugdale over the tension",
    "correlation of its residuals",
    "fitted lambda",
    "uncertainty of lambda",
    "w of JKR over w of DMT",
    "w of Maugis-Dugdale over w of JKR",
    "E* of JKR over E* of DMT",
    "E* of Maugis-Dugdale over E* of JKR",
    "2 pi w R of Maugis-Dugdale over the tension",
    "tension on loading over that on unloading",
    "attraction out of contact",
    "residual at light load",
    "residual at heavy load",
    "loading less unloading in compression",
    "AIC of JKR less that of DMT",
];

/// Those of them that are no logarithms.
const NO_LOGARITHMS: [usize; 6] = [7, 9, 15, 17, 18, 19];
/// The evidence for one limit against the other, which has either sign.
const EVIDENCE: usize = 20;

/// A feature as its name says it: of a logarithm the ratio itself.
pub(super) fn plain(at: usize, value: f64) -> f64 {
    if NO_LOGARITHMS.contains(&at) {
        value
    } else if at == EVIDENCE {
        DECISIVE_AIC * value.sinh()
    } else {
        value.exp()
    }
}

/// Ends of the fitted lambda: beyond, curves hardly change.
const LAMBDAS: (f64, f64) = (0.03, 6.0);
/// Logarithms and shares are cut here, so that one bad fit does not decide.
const MOST: f64 = 4.0;
/// Noise over tension of the most quiet curves in training.
const LEAST_NOISE: f64 = 0.002;
/// Points of the running median that takes the noise out of a greatest tension.
const MEDIAN: usize = 5;

/// The features of a curve of a sphere; `None` for one that the curve has nothing of, such as loading and unloading
/// compared where only one was measured. The outer `None` is a curve without fits of all models of a sphere.
///
/// Ratios are taken as natural logarithms, evidence as an inverse hyperbolic sine. None depends on the units, nor on the ratio of radius and range, of which a
/// force curve knows nothing.
pub fn features(result: &FitResult) -> Option<[Option<f64>; CURVE_FEATURES.len()]> {
    let measured = &result.measured;
    let radius = measured.indenter.radius()?;
    let fit = |model| result.fit_of(model);
    let (hertz, dmt) = (fit(Model::Hertz)?, fit(Model::Dmt)?);
    let (jkr, general) = (fit(Model::Jkr)?, fit(Model::MaugisDugdale)?);
    let zero = general.parameters.force_offset;
    let noise = noise(&measured.samples).max(1e-6 * measured.force_span);
    let load = measured.extremes().1.force - zero;
    let tension_of = |loading: bool| greatest_tension(measured, loading, zero);
    let (inwards, outwards) = (tension_of(true), tension_of(false));
    let tension = inwards.into_iter().chain(outwards).fold(noise, f64::max);
    // A curve with less noise than any in training counts as one with as little.
    let noise = noise.max(LEAST_NOISE * tension);
    let misfit = |fit: &ModelFit| (fit.sum_of_squares / measured.samples.len() as f64).sqrt();
    let least = misfit(general).max(0.1 * noise);
    let lambda = general.parameters.maugis_parameter;
    let lambda_known = general.uncertainties.maugis_parameter;
    let (work, modulus) = (
        |fit: &ModelFit| fit.parameters.work_of_adhesion,
        |fit: &ModelFit| fit.parameters.contact_modulus,
    );
    // Approach by which the tension stretches the solid.
    let stretch = (tension / modulus(hertz)).powf(2.0 / 3.0) / radius.cbrt();
    let residuals = Residuals::new(measured, general, zero);
    Some([
        log(tension, load.max(noise)),
        log(noise, tension),
        log(misfit(hertz), least),
        log(misfit(dmt), least),
        log(misfit(jkr), least),
        log(least, noise),
        log(least, tension),
        Some(general.autocorrelation),
        log(lambda.clamp(LAMBDAS.0, LAMBDAS.1), 1.0),
        Some(lambda_known.map_or(1.0, |known| (known / lambda).min(1.0))),
        log(work(jkr), work(dmt)),
        log(work(general), work(jkr)),
        log(modulus(jkr), modulus(dmt)),
        log(modulus(general), modulus(jkr)),
        log(2.0 * PI * radius * work(general), tension),
        inwards
            .zip(outwards)
            .map(|(inwards, outwards)| (inwards / outwards.max(noise)).clamp(-MOST, MOST)),
        log(
            residuals.out_of_contact.max(0.01 * tension * stretch),
            tension * stretch,
        ),
        cut(residuals.light / tension),
        cut(residuals.heavy / tension),
        residuals
            .difference
            .and_then(|difference| cut(difference / tension)),
        cut(((jkr.aic - dmt.aic) / DECISIVE_AIC).asinh()),
    ])
}

/// Logarithm of a ratio, cut; a ratio that is no positive number is the least.
fn log(value: f64, of: f64) -> Option<f64> {
    let ratio = value / of;
    cut(if ratio > 0.0 { ratio.ln() } else { -MOST })
}

fn cut(value: f64) -> Option<f64> {
    value.is_finite().then(|| value.clamp(-MOST, MOST))
}

/// Standard deviation of the noise, from the median of the second differences, which jumps do not reach.
fn noise(samples: &[Sample]) -> f64 {
    /// Median of the magnitude of a normal number of deviation 1.
    const MEDIAN_MAGNITUDE: f64 = 0.674_489_750_196_081_7;
    let mut seconds: Vec<f64> = samples
        .windows(3)
        .map(|three| (three[0].force - 2.0 * three[1].force + three[2].force).abs())
        .collect();
    seconds.sort_by(f64::total_cmp);
    let median = seconds.get(seconds.len() / 2).copied().unwrap_or(0.0);
    median / (MEDIAN_MAGNITUDE * 6.0_f64.sqrt())
}

/// Greatest tension of one direction, from running medians; `None` if the curve lacks that direction.
fn greatest_tension(measured: &Measured, loading: bool, zero: f64) -> Option<f64> {
    let segments = measured.segments.iter();
    let medians = segments
        .filter(|segment| segment.loading == loading && segment.points.len() >= MEDIAN)
        .flat_map(|segment| {
            measured.samples[segment.points.clone()]
                .windows(MEDIAN)
                .map(|window| {
                    let mut forces: Vec<f64> = window.iter().map(|sample| sample.force).collect();
                    forces.sort_by(f64::total_cmp);
                    forces[MEDIAN / 2]
                })
        });
    medians.reduce(f64::min).map(|least| zero - least)
}

/// Where the curve deviates from Maugis-Dugdale, N.
struct Residuals {
    /// Integral of the attraction where the model is free, of one direction on average, N m.
    out_of_contact: f64,
    /// Mean below a third of the greatest load.
    light: f64,
    /// Mean above two thirds.
    heavy: f64,
    /// Mean of loading less mean of unloading, in compression.
    difference: Option<f64>,
}

impl Residuals {
    fn new(measured: &Measured, fit: &ModelFit, zero: f64) -> Self {
        let samples = &measured.samples;
        let load = measured.extremes().1.force - zero;
        let mean = |wanted: &dyn Fn(usize) -> bool| {
            let (sum, count) = (0..samples.len())
                .filter(|at| fit.interacting[*at] && wanted(*at))
                .fold((0.0, 0), |(sum, count), at| {
                    (sum + samples[at].force - fit.fitted[at], count + 1)
                });
            (count > 0).then(|| sum / f64::from(count))
        };
        let share = |at: usize| (fit.fitted[at] - zero) / load;
        let mut is_loading = vec![false; samples.len()];
        let mut out_of_contact = 0.0;
        for segment in &measured.segments {
            is_loading[segment.points.clone()].fill(segment.loading);
            let points = segment.points.clone();
            for at in points.skip(1) {
                if !fit.interacting[at] && !fit.interacting[at - 1] {
                    let width = (samples[at].approach - samples[at - 1].approach).abs();
                    let force = 0.5 * (samples[at].force + samples[at - 1].force);
                    out_of_contact += width * (zero - force);
                }
            }
        }
        let [loading, unloading] =
            [true, false].map(|loading| mean(&|at| share(at) > 0.0 && is_loading[at] == loading));
        Residuals {
            out_of_contact: out_of_contact / measured.segments.len() as f64,
            light: mean(&|at| (0.0..1.0 / 3.0).contains(&share(at))).unwrap_or(0.0),
            heavy: mean(&|at| share(at) > 2.0 / 3.0).unwrap_or(0.0),
            difference: loading.zip(unloading).map(|(one, other)| one - other),
        }
    }
}
