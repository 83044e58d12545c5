//! `[friction]`: a shear strength of the area in contact.

use super::FrictionScene;
use super::allowed::Allowed;
use super::keys;
use super::reader::Reader;
use crate::units::Dimension;

/// Reads `[friction]`: `Some(None)` if the scene has none, `None` after a mistake.
pub(super) fn read(scene: &Reader) -> Option<Option<FrictionScene>> {
    if !scene.has("friction") {
        return Some(None);
    }
    let friction = scene.table("friction", &keys::FRICTION)?;
    friction.require(&["shear_strength"]);
    let shear_strength =
        friction.quantity("shear_strength", Dimension::Pressure, Allowed::POSITIVE)?;
    Some(Some(FrictionScene { shear_strength }))
}
