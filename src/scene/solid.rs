//! `[solid]`: the contact modulus, and a layer in place of the half-space.

use super::allowed::{Allowed, in_range};
use super::keys;
use super::reader::Reader;
use super::{Boundary, RelaxationScene, SolidScene};
use crate::elastic::{Base, Layer};
use crate::units::Dimension;

/// Poisson ratios of a stable isotropic solid.
const POISSON: Allowed = Allowed::new(
    |ratio| ratio > -1.0 && ratio <= 0.5,
    "above -1 and at most 0.5",
);

/// Reads `[solid]`.
pub(super) fn read(scene: &Reader, boundary: Option<Boundary>) -> Option<SolidScene> {
    scene.require_as("solid", "[solid] with contact_modulus = \"1.33 TPa\"");
    let solid = scene.table("solid", &keys::SOLID)?;
    let modulus = |key: &str| solid.quantity(key, Dimension::Pressure, Allowed::POSITIVE);
    let poisson = |key| solid.quantity(key, Dimension::Dimensionless, POISSON);
    let [direct, young, counter] = [
        modulus("contact_modulus"),
        modulus("young_modulus"),
        modulus("counter_young_modulus"),
    ];
    let [ratio, counter_ratio] = [poisson("poisson_ratio"), poisson("counter_poisson_ratio")];
    let layer = read_layer(&solid, ratio, boundary);
    let hardness = solid.optional("hardness", modulus);
    let relaxation = read_relaxation(&solid, layer.flatten());
    let has_counter = solid.has("counter_young_modulus") || solid.has("counter_poisson_ratio");

    if solid.has("contact_modulus") {
        if solid.has("young_modulus") {
            solid.conflict(
                "young_modulus",
                "contact_modulus is given too; give one of the two",
            );
        }
        for key in ["counter_young_modulus", "counter_poisson_ratio"] {
            if solid.has(key) {
                solid.conflict(
                    key,
                    "contact_modulus already includes the counter-face; give young_modulus with poisson_ratio instead of it, or leave the counter-face out",
                );
            }
        }
        return Some(SolidScene {
            contact_modulus: direct?,
            poisson_ratio: ratio,
            layer: layer?,
            hardness: hardness?,
            relaxation: relaxation?,
        });
    }
    if !solid.has("young_modulus") {
        if has_counter || solid.has("poisson_ratio") {
            solid.require_as(
                "young_modulus",
                "young_modulus = \"70 GPa\"` beside the rest, or instead of it `contact_modulus = \"80 GPa\"",
            );
        } else {
            solid.require(&["contact_modulus"]);
        }
    } else {
        solid.require(&["poisson_ratio"]);
    }
    if has_counter {
        solid.require(&["counter_young_modulus", "counter_poisson_ratio"]);
    }
    let mut compliance = plane_compliance(young?, ratio?);
    if has_counter {
        compliance += plane_compliance(counter?, counter_ratio?);
    }
    let contact_modulus = 1.0 / compliance;
    if !in_range(contact_modulus) {
        solid.conflict(
            "young_modulus",
            format!("makes the contact modulus {contact_modulus:e} Pa; check the powers of ten"),
        );
        return None;
    }
    Some(SolidScene {
        contact_modulus,
        poisson_ratio: ratio,
        layer: layer?,
        hardness: hardness?,
        relaxation: relaxation?,
    })
}

/// Reads the layer: `Some(None)` if the scene has none, `None` after a mistake.
fn read_layer(
    solid: &Reader,
    poisson_ratio: Option<f64>,
    boundary: Option<Boundary>,
) -> Option<Option<Layer>> {
    let thickness = solid.quantity("thickness", Dimension::Length, Allowed::POSITIVE);
    let base = solid.word_or("base", Base::Bonded);
    if !solid.has("thickness") {
        if solid.has("base") {
            solid.require(&["thickness"]);
            return None;
        }
        return Some(None);
    }
    // Beside young_modulus it is required in any case.
    if !solid.has("young_modulus") {
        solid.require(&["poisson_ratio"]);
    }
    if let Some(key) = ["counter_young_modulus", "counter_poisson_ratio"]
        .into_iter()
        .find(|key| solid.has(key))
    {
        solid.conflict(
            key,
            "the counter-face of a layer is rigid; leave the counter-face's elasticity out, or the thickness",
        );
    }
    if boundary == Some(Boundary::Free) {
        solid.conflict(
            "thickness",
            "a layer needs boundary = \"periodic\"; take a cell several times as wide as the contact, or leave the thickness out",
        );
        return None;
    }
    Some(Some(Layer {
        thickness: thickness?,
        poisson_ratio: poisson_ratio?,
        base: base?,
    }))
}

/// Reads the Maxwell branches; empty if the scene has none, `None` after a mistake.
fn read_relaxation(solid: &Reader, layer: Option<Layer>) -> Option<Vec<RelaxationScene>> {
    if !solid.has("relaxation") {
        return Some(Vec::new());
    }
    let tables = solid.tables("relaxation", |_| &keys::RELAXATION)?;
    if solid.is_empty_list("relaxation") {
        solid.conflict(
            "relaxation",
            "is empty; give at least one branch with `modulus` and `time`, or leave it out",
        );
        return None;
    }
    if layer.is_some_and(|layer| layer.uniform_compliance() > 0.0) {
        solid.not_in_this_version(
            "relaxation",
            "relaxation of a compressible layer",
            "take poisson_ratio = 0.5, or leave the thickness out",
        );
    }
    let branches: Vec<Option<RelaxationScene>> = tables
        .iter()
        .map(|branch| {
            branch.require(&["modulus", "time"]);
            let modulus = branch.quantity("modulus", Dimension::Pressure, Allowed::POSITIVE);
            let time = branch.quantity("time", Dimension::Time, Allowed::POSITIVE);
            Some(RelaxationScene {
                modulus: modulus?,
                time: time?,
            })
        })
        .collect();
    branches.into_iter().collect()
}

/// A body's share of `1/E*`: `(1 - nu^2)/E`, 1/Pa.
pub(super) fn plane_compliance(young_modulus: f64, poisson_ratio: f64) -> f64 {
    (1.0 - poisson_ratio * poisson_ratio) / young_modulus
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn compliances_of_plane_strain_add_up() {
        // Steel on glass: 1/E* = 0.91/210 GPa + 0.9375/64 GPa = 1/(52.6821 GPa).
        let compliance = plane_compliance(210e9, 0.3) + plane_compliance(64e9, 0.25);
        assert!((1.0 / compliance / 52.6821e9 - 1.0).abs() < 1e-5);
    }
}
