//! Starting points of the search for a model's numbers.

use nalgebra::{Matrix3, Vector3};

use super::curve_file::Sample;
use super::measured::Measured;
use super::model::{IndenterModel, Parameters};

/// Starting parameters: from pull-off and indentation, and from Hertz.
pub(super) fn starts(measured: &Measured, tip: &IndenterModel, lambda: f64) -> Vec<Parameters> {
    let model = tip.model;
    let baseline = measured.baseline();
    let (least, greatest) = measured.extremes();
    let mut starts = Vec::new();
    let hertz = hertz_start(measured, baseline, greatest);
    if model.adheres()
        && let Some(start) = pull_off_start(tip, lambda, baseline, (least, greatest))
    {
        starts.push(start);
    }
    let tension = (baseline - least.force).max(1e-3 * (greatest.force - baseline));
    starts.push(Parameters {
        work_of_adhesion: if model.adheres() {
            let indenter = measured.indenter;
            indenter.work_of(tension, hertz.contact_modulus)
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

/// Candidates for the displacement from pull-off to the deepest point, as shares of the measured
/// approach.
const SHARES: [f64; 10] = [1.0, 0.7, 0.5, 0.35, 0.25, 0.18, 0.12, 0.08, 0.05, 0.03];
/// The same displacement in Maugis units, from a contact deformed by tension alone to one under
/// heavy load.
const DEPTHS: [f64; 7] = [0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0];

/// Parameters over the whole range of scales: for each displacement from pull-off to the deepest
/// point, as a share of the curve and in Maugis units, force scale and baseline follow by linear
/// least squares.
///
/// On a lightly loaded curve neither the greatest nor the least force determines the scale of the
/// approach, and the sum of squares has more than one minimum.
pub(super) fn scale_grid(measured: &Measured, tip: &IndenterModel, lambda: f64) -> Vec<Parameters> {
    let Ok((pull_off, _)) = tip.pull_off(lambda) else {
        return Vec::new();
    };
    let deepest = measured
        .approaches
        .iter()
        .copied()
        .fold(f64::NEG_INFINITY, f64::max);
    let mut grid = Vec::with_capacity(SHARES.len() * DEPTHS.len());
    for depth in DEPTHS.map(|depth| depth * tip.indenter.depth_unit()) {
        let Ok(reduced) = tip.reduced(lambda, pull_off + depth) else {
            continue;
        };
        for share in SHARES {
            let unit = share * measured.approach_span / depth;
            let approach_offset = if measured.freedom.approach_offset {
                deepest - (pull_off + depth) * unit
            } else {
                0.0
            };
            // Beyond pull-off most points are free, unless the curve ends before the jump.
            for free_beyond in [true, false] {
                let force = |approach: f64| {
                    let place = (approach - approach_offset) / unit;
                    if free_beyond && place < pull_off {
                        Some(0.0)
                    } else {
                        reduced.at(place).ok()
                    }
                };
                let Some((force_unit, force_offset, baseline_slope)) =
                    linear_scale(measured, force)
                else {
                    continue;
                };
                let (work_of_adhesion, contact_modulus) =
                    tip.indenter.work_and_modulus(force_unit, unit);
                if contact_modulus.is_finite() && contact_modulus > 0.0 {
                    grid.push(Parameters {
                        contact_modulus,
                        work_of_adhesion,
                        maugis_parameter: lambda,
                        approach_offset,
                        force_offset,
                        baseline_slope,
                    });
                }
            }
        }
    }
    grid
}

/// Measured approaches on each side of the fold to which it is moved.
const BESIDE: usize = 2;
/// Distance at which it is placed before them, as a share of their distance to the one before.
const BEFORE: f64 = 0.01;
/// Distance of approaches that are the same, as a share of the whole approach.
const SAME: f64 = 1e-9;

/// The same numbers with the fold just before the measured approaches that are next to it.
///
/// The force rises from the fold with infinite slope, so that the sum of squares has a ridge where the fold passes a
/// point, and a minimum of its own for nearly every interval that the fold may lie in. No descent crosses the ridge. As the
/// force of the point goes with the root of its distance, a descent from a shorter distance stays before the point.
pub(super) fn beside_the_fold(
    measured: &Measured,
    tip: &IndenterModel,
    here: &Parameters,
) -> Vec<Parameters> {
    let Some(fold) = tip.fold(here.maugis_parameter) else {
        return Vec::new();
    };
    let (_, unit) = tip
        .indenter
        .units(here.contact_modulus, here.work_of_adhesion);
    let fold = fold * unit;
    let place = here.approach_offset + fold;
    let mut sorted = measured.approaches.clone();
    sorted.sort_by(f64::total_cmp);
    // Loading and unloading may have the same approaches but for rounding.
    sorted.dedup_by(|next, last| *next - *last < SAME * measured.approach_span);
    let next = sorted.partition_point(|approach| *approach < place);
    let beside = next.saturating_sub(BESIDE + 1)..(next + BESIDE).min(sorted.len());
    let pairs = sorted[beside].windows(2);
    pairs
        .map(|pair| {
            let moved = pair[1] - BEFORE * (pair[1] - pair[0]) - here.approach_offset;
            if measured.freedom.approach_offset {
                Parameters {
                    approach_offset: here.approach_offset + moved - fold,
                    ..*here
                }
            } else {
                // The unit of approach goes with the power 2/3 of w for a sphere, with w for a cone.
                let power = tip.indenter.radius().map_or(1.0, |_| 1.5);
                let share = (moved / fold).max(0.1);
                Parameters {
                    work_of_adhesion: here.work_of_adhesion * share.powf(power),
                    ..*here
                }
            }
        })
        .collect()
}

/// Force unit, baseline and its slope that bring reduced forces closest to the measured ones; `None` if that
/// unit is not positive.
fn linear_scale(
    measured: &Measured,
    reduced: impl Fn(f64) -> Option<f64>,
) -> Option<(f64, f64, f64)> {
    let mut normal = Matrix3::zeros();
    let mut right = Vector3::zeros();
    let place = |approach: f64| (approach - measured.middle) / measured.approach_span;
    for sample in &measured.samples {
        let row = Vector3::new(reduced(sample.approach)?, 1.0, place(sample.approach));
        normal += row * row.transpose();
        right += row * sample.force;
    }
    let (unit, offset, slope) = if measured.freedom.baseline_slope {
        let solution = normal.lu().solve(&right)?;
        let slope = solution[2] / measured.approach_span;
        (solution[0], solution[1] - slope * measured.middle, slope)
    } else if measured.freedom.force_offset {
        let both = normal.fixed_view::<2, 2>(0, 0).into_owned();
        let solution = both.lu().solve(&right.fixed_rows::<2>(0).into_owned())?;
        (solution[0], solution[1], 0.0)
    } else {
        (right[0] / normal[(0, 0)], 0.0, 0.0)
    };
    (unit.is_finite() && unit > 0.0).then_some((unit, offset, slope))
}

/// A straight line through the approach against the force to the inverse of its power.
fn hertz_start(measured: &Measured, baseline: f64, greatest: Sample) -> Parameters {
    let least = 0.05 * (greatest.force - baseline);
    let power = measured.indenter.power();
    let pressed = measured
        .samples
        .iter()
        .filter(|sample| sample.force - baseline > least)
        .map(|sample| ((sample.force - baseline).powf(1.0 / power), sample.approach));
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
        slope = 0.5 * measured.approach_span / (greatest.force - baseline).powf(1.0 / power);
    }
    Parameters {
        contact_modulus: slope.powf(-power) / measured.indenter.stiffness(),
        work_of_adhesion: 0.0,
        maugis_parameter: 1.0,
        approach_offset: (y - slope * x) / n.max(1.0),
        force_offset: baseline,
        baseline_slope: 0.0,
    }
}

/// Pull-off gives w; the displacement from there to the greatest force gives the modulus.
fn pull_off_start(
    tip: &IndenterModel,
    lambda: f64,
    baseline: f64,
    (least, greatest): (Sample, Sample),
) -> Option<Parameters> {
    let (place, force) = tip.pull_off(lambda).ok()?;
    let tension = baseline - least.force;
    let unit = tension / -force;
    let segment = greatest.approach - least.approach;
    if unit <= 0.0 || segment <= 0.0 {
        return None;
    }
    let deepest = tip
        .approach_at(lambda, (greatest.force - baseline) / unit)
        .ok()?;
    let approach_unit = segment / (deepest - place);
    let (work_of_adhesion, contact_modulus) = tip.indenter.work_and_modulus(unit, approach_unit);
    contact_modulus.is_finite().then_some(Parameters {
        contact_modulus,
        work_of_adhesion,
        maugis_parameter: lambda,
        approach_offset: least.approach - place * approach_unit,
        force_offset: baseline,
        baseline_slope: 0.0,
    })
}
