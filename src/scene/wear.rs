//! `[wear]`: what sliding takes off the spots in contact.

use super::WearScene;
use super::allowed::Allowed;
use super::keys;
use super::reader::Reader;
use crate::units::Dimension;

/// Reads `[wear]`: `Some(None)` where the scene has none.
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
