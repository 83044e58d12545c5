//! Akaike's criterion of a fit, and what the transitions of a curve count for in it.

use super::curve_file::Sample;
use super::measured::Measured;
use super::model::Model;
use super::segments::Segment;

/// Free numbers that a transition counts for in Akaike's criterion, whose place is chosen among all points, where Hertz has none (Ninomiya 2015,
/// doi:10.1007/s10463-014-0481-x).
const TRANSITION: usize = 3;
/// Free numbers that each segment of a curve with a level baseline counts for in adhesive models. Hertz has transitions there too, but gains
/// nothing by them, while a step of `2 pi w R` at the best place gains 0.8 of the criterion in each segment of a curve without adhesion.
const LEVEL_TRANSITION: usize = 1;

/// Akaike's criterion of a sum of squares over those of the force range. The noise is a fitted number too.
pub(super) fn aic(sum: f64, points: usize, free: usize) -> f64 {
    points as f64 * (sum / points as f64).ln() + 2.0 * (free + 1) as f64
}

/// The same where no contact is: of a baseline alone, which is level but for the freedom of its slope.
pub(super) fn aic_of_baseline(measured: &Measured) -> f64 {
    let points = measured.samples.len();
    let has_offset = measured.freedom.force_offset;
    let has_slope = measured.freedom.baseline_slope;
    let samples = || measured.samples.iter();
    let level = if has_offset {
        samples().map(|sample| sample.force).sum::<f64>() / points as f64
    } else {
        0.0
    };
    let place = |sample: &Sample| sample.approach - measured.middle;
    let slope = if has_slope {
        let products = samples().map(|sample| place(sample) * (sample.force - level));
        products.sum::<f64>() / samples().map(|sample| place(sample).powi(2)).sum::<f64>()
    } else {
        0.0
    };
    let over_span = |sample: &Sample| {
        ((sample.force - level - slope * place(sample)) / measured.force_span).powi(2)
    };
    let free = usize::from(has_offset) + usize::from(has_slope);
    aic(samples().map(over_span).sum(), points, free)
}

/// Free numbers that the transitions of a curve count for; `interacting` says for each point whether the tip is not free.
pub(super) fn transitions(measured: &Measured, model: Model, interacting: &[bool]) -> usize {
    if !model.adheres() {
        return 0;
    }
    if !measured.freedom.baseline_slope {
        // Each segment may have one, so that adhesive models count the same.
        return LEVEL_TRANSITION * measured.segments.len();
    }
    let has_transition = |segment: &&Segment| {
        let mut points = segment.points.clone();
        points.any(|i| interacting.get(i) == Some(&false))
    };
    TRANSITION * measured.segments.iter().filter(has_transition).count()
}
