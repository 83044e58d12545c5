//! Whether loading and unloading disagree in compression, as they do on viscoelastic and plastic solids.

use super::curve_file::Sample;
use super::measured::Measured;
use crate::units::format_si;

/// Share of the greatest compression above which points are compared: adhesion lets them agree there.
const LEAST_FORCE: f64 = 0.2;
/// Fewest points of each direction.
const LEAST_POINTS: usize = 5;
/// Standard errors that the mean difference must exceed, and share of the mean force.
const BEYOND_NOISE: f64 = 5.0;
const LEAST_SHARE: f64 = 0.02;

/// A warning where the force of loading exceeds that of unloading at the same approach by more than noise; `zero` is the
/// baseline.
pub(super) fn warning(measured: &Measured, zero: f64) -> Option<String> {
    let (_, greatest) = measured.extremes();
    let least = zero + LEAST_FORCE * (greatest.force - zero);
    // The last loading with the unloading that follows it.
    let at = measured
        .segments
        .iter()
        .rposition(|segment| !segment.loading)?;
    let [loading, unloading] = [at.checked_sub(1)?, at].map(|at| &measured.segments[at]);
    if !loading.loading {
        return None;
    }
    let pressed = |points: std::ops::Range<usize>| -> Vec<Sample> {
        let samples = &measured.samples[points];
        samples
            .iter()
            .copied()
            .filter(|sample| sample.force > least)
            .collect()
    };
    let (up, mut down) = (
        pressed(loading.points.clone()),
        pressed(unloading.points.clone()),
    );
    if up.len() < LEAST_POINTS || down.len() < LEAST_POINTS {
        return None;
    }
    down.sort_by(|a, b| a.approach.total_cmp(&b.approach));
    let differences: Vec<(f64, f64)> = up
        .iter()
        .filter_map(|sample| {
            Some((
                sample.force - interpolated(&down, sample.approach)?,
                sample.force - zero,
            ))
        })
        .collect();
    if differences.len() < LEAST_POINTS {
        return None;
    }
    let count = differences.len() as f64;
    let difference = differences
        .iter()
        .map(|(difference, _)| difference)
        .sum::<f64>()
        / count;
    let force = differences.iter().map(|(_, force)| force).sum::<f64>() / count;
    let error = (noise(&up).hypot(noise(&down))) / count.sqrt();
    (difference > BEYOND_NOISE * error && difference > LEAST_SHARE * force).then(|| {
        format!(
            "loading takes {:.0} % more force than unloading at the same approach in compression ({} in the mean, {:.0} times what noise allows): the solid is viscoelastic or plastic, or the instrument drifts; E* lies between its moduli; fit a relaxation time beside",
            100.0 * difference / force,
            format_si(difference, "N"),
            difference / error,
        )
    })
}

/// Force at an approach, on the line between its neighbours in sorted points.
fn interpolated(sorted: &[Sample], approach: f64) -> Option<f64> {
    let after = sorted.partition_point(|sample| sample.approach < approach);
    let [before, after] = [sorted.get(after.checked_sub(1)?)?, sorted.get(after)?];
    let width = after.approach - before.approach;
    let share = if width > 0.0 {
        (approach - before.approach) / width
    } else {
        0.5
    };
    Some(before.force + share * (after.force - before.force))
}

/// Standard deviation of the noise, from the second differences of neighbours, which a smooth curve hardly has.
fn noise(samples: &[Sample]) -> f64 {
    let seconds = samples.windows(3).map(|three| {
        let second = three[0].force - 2.0 * three[1].force + three[2].force;
        second * second / 6.0
    });
    let count = samples.len().saturating_sub(2).max(1) as f64;
    (seconds.sum::<f64>() / count).sqrt()
}
