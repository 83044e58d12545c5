//! Whether rows of extension and retraction are mixed, as in a table that was sorted by approach.
//!
//! Where they differ by adhesion or drag, forces jump between two branches, which no contact and no noise does. A stable sort lets them
//! alternate, which the correlation of the residuals shows; others mix them at random, and the correlation is that of noise.

use super::measured::Measured;

/// Neighbours that are looked at together.
const WINDOW: usize = 12;
/// Fewest of them on each branch, and fewest crossings from one to the other: rows mixed at random have 5.5 in the mean, a jump of the tip one.
const LEAST_ON_BRANCH: usize = 3;
const LEAST_CROSSINGS: usize = 5;
/// Share of the range of the forces, without their trend, that the gap between the branches exceeds.
const GAP_SHARE: f64 = 0.5;
/// Noises that the gap exceeds. Twelve normal numbers lie within some four, and within ten but for once in a million.
const GAP_NOISES: f64 = 10.0;
/// Steps of forces of limited digits that it exceeds.
const GAP_STEPS: f64 = 20.0;
/// Magnitude below which a quarter of normal numbers of deviation 1 lie.
const LOWER_QUARTILE: f64 = 0.318_639_363_964_375_1;

/// The gap between two branches, N, where the forces of a segment jump from one to the other and back.
pub(super) fn gap_of_branches(measured: &Measured) -> Option<f64> {
    let least = (GAP_NOISES * noise(measured)).max(GAP_STEPS * step(measured));
    let segments = measured.segments.iter();
    let gaps = segments.flat_map(|segment| {
        let samples = &measured.samples[segment.points.clone()];
        samples.windows(WINDOW).filter_map(|window| {
            let forces: Vec<f64> = window.iter().map(|sample| sample.force).collect();
            gap(&without_trend(&forces)).filter(|gap| *gap > least)
        })
    });
    gaps.reduce(f64::max)
}

/// The gap between two groups of numbers that follow each other in turn.
fn gap(forces: &[f64]) -> Option<f64> {
    let mut sorted = forces.to_vec();
    sorted.sort_by(f64::total_cmp);
    let range = sorted[sorted.len() - 1] - sorted[0];
    let between = LEAST_ON_BRANCH..=sorted.len() - LEAST_ON_BRANCH;
    let (gap, middle) = between
        .map(|at| {
            let (below, above) = (sorted[at - 1], sorted[at]);
            (above - below, 0.5 * (above + below))
        })
        .max_by(|a, b| a.0.total_cmp(&b.0))?;
    let crossings = forces
        .windows(2)
        .filter(|pair| (pair[0] > middle) != (pair[1] > middle));
    (gap > GAP_SHARE * range && crossings.count() >= LEAST_CROSSINGS).then_some(gap)
}

/// Numbers less the straight line through them.
fn without_trend(forces: &[f64]) -> Vec<f64> {
    let middle = 0.5 * (forces.len() - 1) as f64;
    let mean = forces.iter().sum::<f64>() / forces.len() as f64;
    let (mut products, mut squares) = (0.0, 0.0);
    for (at, force) in forces.iter().enumerate() {
        let place = at as f64 - middle;
        products += place * (force - mean);
        squares += place * place;
    }
    let slope = products / squares;
    let each = forces.iter().enumerate();
    each.map(|(at, force)| force - mean - slope * (at as f64 - middle))
        .collect()
}

/// Standard deviation of the noise, N, from the lower quartile of the second differences: three quarters of the curve may be mixed.
fn noise(measured: &Measured) -> f64 {
    let mut seconds: Vec<f64> = measured
        .samples
        .windows(3)
        .map(|three| (three[0].force - 2.0 * three[1].force + three[2].force).abs())
        .collect();
    seconds.sort_by(f64::total_cmp);
    let quartile = seconds.get(seconds.len() / 4).copied().unwrap_or(0.0);
    quartile / (LOWER_QUARTILE * 6.0_f64.sqrt())
}

/// The least difference of neighbours beyond rounding in the last bits, N.
fn step(measured: &Measured) -> f64 {
    let rounding = 1e-12 * measured.force_span;
    let steps = measured.samples.windows(2);
    let steps = steps.map(|pair| (pair[1].force - pair[0].force).abs());
    let least = steps.filter(|step| *step > rounding).reduce(f64::min);
    least.unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use crate::fit::model::{IndenterModel, Parameters};
    use crate::fit::test_noise::normal;
    use crate::fit::{FitResult, ForceCurve, Freedom, Model, Sample, fit_curve};

    const RADIUS: f64 = 1e-5;

    /// Extension and retraction of a JKR sphere, with noise of 0.1 % of the pull-off, as a share of it at each point; and more noise in contact.
    fn rows(noise: f64, in_contact: f64) -> Vec<Sample> {
        let truth = Parameters {
            contact_modulus: 1e6,
            work_of_adhesion: 0.05,
            ..Parameters::default()
        };
        let tip = IndenterModel::new(Model::Jkr, RADIUS);
        let (force_unit, unit) = tip.indenter.units(1e6, 0.05);
        let fold = tip.fold(1.0).unwrap() * unit;
        let mut normal = normal(1);
        let rows = (0..200).map(|i| {
            let approach = 2e-6 * (1.0 - (f64::from(i) - 99.5).abs() / 50.0);
            let is_held = approach > if i < 100 { 0.0 } else { fold };
            let noise = 1.5 * force_unit * normal() * if is_held { in_contact } else { noise };
            let force = if is_held {
                tip.forces(&truth, &[approach]).unwrap()[0]
            } else {
                0.0
            };
            Sample {
                approach,
                force: force + noise,
            }
        });
        rows.collect()
    }

    fn fitted(samples: Vec<Sample>) -> FitResult {
        let curve = ForceCurve {
            samples,
            ..ForceCurve::default()
        };
        let freedom = Freedom {
            approach_offset: true,
            force_offset: false,
            baseline_slope: false,
            range: None,
        };
        fit_curve(&curve, Path::new("made"), RADIUS, freedom).unwrap()
    }

    fn is_said(result: &FitResult) -> bool {
        let mut warnings = result.warnings.iter();
        warnings.any(|warning| warning.contains("seem to be mixed"))
    }

    /// Sorted by approach, where rows of the same approach come in any order: JKR had w = 35 +- 10 mJ/m^2 for 50, and described the curve.
    #[test]
    fn rows_that_are_mixed_at_random_are_no_curve() {
        let mut samples = rows(1e-3, 1e-3);
        samples.sort_by(|a, b| a.approach.total_cmp(&b.approach));
        let mut normal = normal(5);
        for at in (0..samples.len()).step_by(2) {
            if normal() > 0.0 {
                samples.swap(at, at + 1);
            }
        }
        let result = fitted(samples);
        assert!(
            !result.describes_curve && is_said(&result),
            "{:?}",
            result.warnings
        );
    }

    /// The curve itself, and with noise in contact eight times that of the free tip.
    #[test]
    fn a_curve_in_order_is_not_mixed() {
        for in_contact in [1e-3, 8e-3] {
            let result = fitted(rows(1e-3, in_contact));
            assert!(
                result.describes_curve && !is_said(&result),
                "{:?}",
                result.warnings
            );
            let work = result.best().parameters.work_of_adhesion;
            assert!(
                (work - 0.05).abs() < 3.0 * result.work_uncertainty.unwrap() + 1e-3,
                "{work}"
            );
        }
    }

    /// Forces of two values, as of a converter whose noise is below its last bit, are one branch.
    #[test]
    fn the_last_bit_is_no_branch() {
        let mut normal = normal(2);
        let samples = (0..200).map(|i| {
            let force = if i < 150 { 0.0 } else { f64::from(i - 150) };
            Sample {
                approach: f64::from(i),
                force: (force + 0.4 * normal()).round(),
            }
        });
        let freedom = Freedom {
            approach_offset: true,
            force_offset: false,
            baseline_slope: false,
            range: None,
        };
        let measured = crate::fit::Measured::new(samples.collect(), RADIUS, freedom);
        assert_eq!(super::gap_of_branches(&measured), None);
    }
}
