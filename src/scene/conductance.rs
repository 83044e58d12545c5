//! `[conductance]`: the thermal or electrical conductance of the contact.

use super::ConductanceScene;
use super::allowed::Allowed;
use super::keys;
use super::mistake::SceneError;
use super::reader::Reader;
use crate::units::Dimension;

/// Reads `[conductance]`: `Some(None)` if the scene has none, `None` after a mistake. `layered` is
/// true if the solid is a layer.
pub(super) fn read(scene: &Reader, layered: bool) -> Option<Option<ConductanceScene>> {
    if !scene.has("conductance") {
        return Some(None);
    }
    let conductance = scene.table("conductance", &keys::CONDUCTANCE)?;
    if layered {
        // The analogy of conductance and stiffness holds for a half-space, not for a layer.
        scene.report(
            "conductance",
            SceneError::NotInThisVersion {
                what: "the conductance of a layer".to_string(),
                instead: "leave the thickness out, or [conductance]".to_string(),
            },
        );
    }
    conductance.require(&["conductivity", "counter_conductivity"]);
    let [conductivity, counter_conductivity] = ["conductivity", "counter_conductivity"]
        .map(|key| conductance.quantity(key, Dimension::Conductivity, Allowed::POSITIVE));
    Some(Some(ConductanceScene {
        conductivity: conductivity?,
        counter_conductivity: counter_conductivity?,
    }))
}

impl ConductanceScene {
    /// Harmonic mean of the two conductivities, W/(m K): resistances in series.
    pub fn combined(&self) -> f64 {
        2.0 / (1.0 / self.conductivity + 1.0 / self.counter_conductivity)
    }
}
