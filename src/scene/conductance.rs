//! `[conductance]`: what the contact conducts from one body to the other.

use super::SolidScene;
use super::mistake::SceneError;
use super::reader::Reader;

/// Notes a solid that a conductance cannot stand with. The tables have been read before.
pub(super) fn check(scene: &Reader, solid: &SolidScene) {
    if scene.has("conductance") && solid.layer.is_some() {
        // The current below a layer spreads by another law than the displacement does.
        scene.report(
            "conductance",
            SceneError::NotInThisVersion {
                what: "the conductance of a layer".to_string(),
                instead: "leave the thickness out, or [conductance]".to_string(),
            },
        );
    }
}
