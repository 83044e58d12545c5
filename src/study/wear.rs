//! What sliding wears off: a volume that grows with the length of sliding and with the load on the
//! spots in contact, whatever their area (Archard 1953, doi:10.1063/1.1721448).

use super::evaluation::Evaluation;
use crate::scene::WearScene;

/// Volume worn off for each length of sliding, m^3/m, where a point of the grid has `pixel_area`, m^2.
///
/// The load is what presses, not the net one: attraction presses the spots together beyond what is
/// put on from outside. A net pressure above 0 is that of a point in contact, all others pull.
pub(super) fn rate(wear: WearScene, evaluation: Option<&Evaluation>, pixel_area: f64) -> f64 {
    let pressing = evaluation.map_or(0.0, |evaluation| {
        let pressures = evaluation.pressure.iter().filter(|p| **p > 0.0);
        pressures.fold(0.0, |sum, p| sum + p)
    });
    wear.specific_wear_rate * (pressing * pixel_area)
}
