//! `[solid]`: one way or another to the contact modulus.

use super::keys;
use super::reader::{Allowed, Reader, is_sane};
use super::types::SolidScene;
use crate::units::Dimension;

/// Poisson ratios of a stable isotropic solid.
const POISSON: Allowed = Allowed::new(
    |ratio| ratio > -1.0 && ratio <= 0.5,
    "above -1 and at most 0.5",
);

/// Reads `[solid]`.
pub(super) fn read(scene: &Reader) -> Option<SolidScene> {
    scene.require_as("solid", "[solid] with contact_modulus = \"1.33 TPa\"");
    let solid = scene.table("solid", &keys::SOLID)?;
    let modulus = |key| solid.quantity(key, Dimension::Pressure, Allowed::POSITIVE);
    let poisson = |key| solid.quantity(key, Dimension::Dimensionless, POISSON);
    let [direct, young, counter] = [
        modulus("contact_modulus"),
        modulus("young_modulus"),
        modulus("counter_young_modulus"),
    ];
    let [ratio, counter_ratio] = [poisson("poisson_ratio"), poisson("counter_poisson_ratio")];
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
                    "contact_modulus already holds the counter-face's share; give young_modulus with poisson_ratio instead of it, or leave the counter-face out",
                );
            }
        }
        return Some(SolidScene {
            contact_modulus: direct?,
            poisson_ratio: ratio,
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
    if !is_sane(contact_modulus) {
        solid.conflict(
            "young_modulus",
            format!("makes the contact modulus {contact_modulus:e} Pa; check the powers of ten"),
        );
        return None;
    }
    Some(SolidScene {
        contact_modulus,
        poisson_ratio: ratio,
    })
}

/// A body's share of `1/E*`: `(1 - nu^2)/E`, 1/Pa.
fn plane_compliance(young_modulus: f64, poisson_ratio: f64) -> f64 {
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
