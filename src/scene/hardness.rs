//! `hardness` of `[solid]`, the largest pressure that the solid bears, and what it can be combined
//! with.

use super::keys;
use super::reader::Reader;
use super::{
    AdhesionScene, Control, GridScene, LawName, LoadingScene, Precision, SolidScene, SolverScene,
    Treatment,
};
use crate::units::format_si;

/// Refuses mixed precision: its corrections have no hardness limit.
pub(super) fn check_precision(scene: &Reader, solid: &SolidScene, solver: Option<&SolverScene>) {
    let mixed = solver.is_some_and(|solver| solver.precision == Precision::Mixed);
    if solid.hardness.is_none() || !mixed {
        return;
    }
    if let Some(solid) = scene.table_again("solid", &keys::SOLID) {
        solid.not_in_this_version(
            "hardness",
            "a hardness in mixed precision",
            "take precision = \"single\", or \"double\", with backend = \"cpu\" where the adapter has none",
        );
    }
}

/// Notes what cannot be combined with a hardness. The tables have been read before.
pub(super) fn check(
    scene: &Reader,
    solid: &SolidScene,
    adhesion: Option<&AdhesionScene>,
    loading: Option<&LoadingScene>,
    grid: Option<&GridScene>,
) {
    let Some(hardness) = solid.hardness else {
        return;
    };
    let Some(solid) = scene.table_again("solid", &keys::SOLID) else {
        return;
    };
    match adhesion {
        Some(adhesion) if adhesion.treatment == Treatment::Dmt => {
            // The search for the net load tries larger loads, which would indent the solid.
            solid.not_in_this_version(
                "hardness",
                "a hardness with treatment = \"dmt\"",
                "take treatment = \"full\", or leave the hardness out",
            );
        }
        Some(adhesion) if adhesion.law == LawName::LennardJones => {
            // Its repulsion has no contact at which the pressure could saturate.
            solid.not_in_this_version(
                "hardness",
                "a hardness with the Lennard-Jones law",
                "take law = \"maugis-dugdale\" or \"exponential\", or leave the hardness out",
            );
        }
        _ => {}
    }
    let Some(loading) = loading else {
        return;
    };
    let area = grid
        .and_then(|grid| grid.size)
        .map(|[width, height]| width * height);
    let pressures: Vec<f64> = match (loading.control, area) {
        (Control::MeanGap, _) => {
            solid.conflict(
                "hardness",
                "control = \"mean-gap\" does not determine the plastic depth where the gap is closed; take control = \"approach\", or leave the hardness out",
            );
            return;
        }
        (Control::Pressure, _) => loading.path.clone(),
        (Control::Force, Some(area)) => loading.path.iter().map(|force| force / area).collect(),
        _ => return,
    };
    let largest = pressures.into_iter().fold(0.0, f64::max);
    if largest >= hardness {
        solid.conflict(
            "hardness",
            format!(
                "the path has a mean pressure of {}, which no contact of this hardness can carry; stay below it",
                format_si(largest, "Pa")
            ),
        );
    }
}
