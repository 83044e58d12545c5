//! `[conductance]`: the thermal or electrical conductance of the contact.

use super::SolidScene;
use super::reader::Reader;

/// Refuses `[conductance]` of a layer. The tables have been read before.
pub(super) fn check(scene: &Reader, solid: &SolidScene) {
    if scene.has("conductance") && solid.layer.is_some() {
        // The analogy of conductance and stiffness holds for a half-space, not for a layer.
        scene.not_in_this_version(
            "conductance",
            "the conductance of a layer",
            "leave the thickness out, or [conductance]",
        );
    }
}
