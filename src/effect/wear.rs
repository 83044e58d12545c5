//! `[wear]`: a volume that grows with the length of sliding and with the load on the spots in contact,
//! whatever their area (Archard 1953, doi:10.1063/1.1721448).

use crate::backend::Share;
use crate::scene::{Scene, WearScene};
use crate::study::{Column, Evaluation, Hooks, Plan, Setup};
use crate::units::format_si;

/// Volume worn off for each length of sliding, m^3/m.
const RATE: Column = Column::new("wear_rate", "m^3/m", 3);

/// Wear by sliding.
pub(super) struct Wear;

impl Hooks for Wear {
    fn name(&self) -> &'static str {
        "wear"
    }

    fn purpose(&self) -> &'static str {
        "the volume that a length of sliding takes off, in a column of its own; it changes nothing else"
    }

    fn is_on(&self, scene: &Scene) -> bool {
        scene.tables.wear.is_some()
    }

    fn remove_from(&self, scene: &mut Scene) {
        scene.tables.wear = None;
    }

    fn example(&self) -> &'static [(&'static str, &'static str)] {
        &[("wear", "{ specific_wear_rate = 0.1 }")]
    }

    fn matters(&self, plan: &Plan) -> String {
        let scene = &plan.scene;
        let moments = &plan.outline.moments;
        let specific = scene
            .tables
            .wear
            .map_or(0.0, |wear| wear.specific_wear_rate);
        let flattening = 0.5 * scene.solid.contact_modulus * moments.rms_slope();
        format!(
            "holds while little is worn, for the heights stay: here a spot under the pressure that flattens the roughness (E* rms slope/2) loses {} a metre of sliding, beside an rms height of {}",
            format_si(specific * flattening, "m"),
            format_si(moments.rms_height(), "m")
        )
    }

    fn columns(&self) -> &'static [Column] {
        &[RATE]
    }

    fn values(&self, setup: &Setup, evaluation: Option<&Evaluation>) -> Vec<(Column, f64)> {
        let pixel_area = setup.surface.grid.pixel_area();
        let wear = setup.scene.tables.wear;
        let share = &setup.problem.share;
        let rate = wear.map(|wear| (RATE, rate(wear, evaluation, share, pixel_area)));
        rate.into_iter().collect()
    }
}

/// Volume worn off for each length of sliding, m^3/m, where a point of the grid has `pixel_area`, m^2.
///
/// The load is the repulsive one, not the net one: attraction presses the spots together beyond the external
/// load. Net pressures above 0 are those of points in contact; all others are tensions.
fn rate(wear: WearScene, evaluation: Option<&Evaluation>, share: &Share, pixel_area: f64) -> f64 {
    let pressing = evaluation.map_or(0.0, |evaluation| {
        share.surface_sum_by(&evaluation.pressure, |p| p.max(0.0))
    });
    wear.specific_wear_rate * (pressing * pixel_area)
}
