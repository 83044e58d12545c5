//! `[wear]`: the volume that sliding removes.

use super::WearScene;
use super::allowed::Allowed;
use super::keys;
use super::reader::Reader;
use crate::units::Dimension;

/// Reads `[wear]`: `Some(None)` if the scene has none, `None` after a mistake.
pub(super) fn read(scene: &Reader) -> Option<Option<WearScene>> {
    if !scene.has("wear") {
        return Some(None);
    }
    let wear = scene.table("wear", &keys::WEAR)?;
    wear.require(&["specific_wear_rate"]);
    let specific_wear_rate = wear.quantity(
        "specific_wear_rate",
        Dimension::SpecificWear,
        Allowed::POSITIVE,
    )?;
    Some(Some(WearScene { specific_wear_rate }))
}
