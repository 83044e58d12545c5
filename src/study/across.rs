//! Attraction across a gap without contact.

use super::setup::Setup;

/// Mean attraction across a gap without contact, Pa: the undeformed surfaces at `clearance` (m) from
/// first touch.
pub fn attraction_across(setup: &Setup, clearance: f64) -> f64 {
    let heights = &setup.surface.heights;
    let highest = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let sum = heights.iter().enumerate().fold(0.0, |sum, (i, height)| {
        sum + setup.law_factor(i) * setup.law.traction(highest - height + clearance)
    });
    sum / heights.len() as f64
}
