//! `[conductance]`: the thermal or electrical conductance of the contact.

use super::SolidScene;
use super::document::Value;
use super::reader::Reader;
use super::words::words;
use crate::units::{Dimension, parse_quantity};

words! {
    /// What a contact conducts.
    #[derive(Default)]
    Conduction {
        /// Heat, with conductivities in W/(m K).
        #[default]
        Thermal = "thermal",
        /// A current, with conductivities in S/m.
        Electrical = "electrical",
    }
}

impl Conduction {
    /// Reads `kind`, or takes it from the units of the conductivities, which must agree.
    pub(super) fn read(table: &Reader, keys: &[&str]) -> Option<Conduction> {
        let named = table.optional("kind", |key| table.word(key))?;
        let by_unit = keys.iter().filter_map(|key| {
            let Value::Text(text) = &table.node(key)?.value else {
                return None;
            };
            // A text that is a mistake, which is noted already, says nothing.
            parse_quantity(text, Dimension::Conductivity).ok()?;
            let is_electrical = text.replace(' ', "").ends_with("S/m");
            let kind = if is_electrical {
                Conduction::Electrical
            } else {
                Conduction::Thermal
            };
            Some((*key, kind))
        });
        let mut found = named;
        for (key, kind) in by_unit {
            if *found.get_or_insert(kind) != kind {
                let what = match named {
                    Some(Conduction::Thermal) => {
                        "kind = \"thermal\" takes conductivities in W/(m K), and this one is in S/m; give kind = \"electrical\", or leave kind out"
                    }
                    Some(Conduction::Electrical) => {
                        "kind = \"electrical\" takes conductivities in S/m, and this one is in W/(m K); give kind = \"thermal\", or leave kind out"
                    }
                    None => {
                        "heat and a current are not conducted together; give both conductivities in W/(m K), or both in S/m"
                    }
                };
                table.conflict(key, what);
                return None;
            }
        }
        Some(found.unwrap_or_default())
    }
}

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
