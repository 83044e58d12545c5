//! Effects: what a scene may ask for beyond hard, frictionless, elastic contact of a periodic cell.
//!
//! An effect that the scene does not name is not there: it holds no field and makes no pass. What
//! one costs is found by planning the scene with and without it.

use crate::backend::BackendError;
use crate::grid::Grid;
use crate::scene::{Boundary, Control, RateScene, Scene, Treatment};
use crate::study::{Cost, Plan};
use crate::units::format_si;

/// An effect of this version.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// `[adhesion]`: a cohesive law acts across the gap.
    Adhesion,
    /// `treatment = "dmt"`: attraction is summed over the gap of the solution without it.
    Dmt,
    /// `map`: the tension differs from point to point.
    AdhesionMap,
    /// `rate`: a receding edge costs more the faster it recedes.
    Rate,
    /// `[capillary]`: a liquid that condenses between the surfaces pulls them together.
    Capillary,
    /// `thickness`: an elastic layer on a rigid base in place of the half-space.
    Layer,
    /// `hardness`: the pressure saturates, and what flows then stays.
    Hardness,
    /// `[[solid.relaxation]]`: the stress of a displacement fades in time.
    Relaxation,
    /// `boundary = "free"`: one isolated contact on an unbounded half-space.
    FreeBoundary,
    /// `[friction]`: what it takes to slide the area in contact.
    Friction,
    /// `[conductance]`: what flows through the area in contact.
    Conductance,
    /// `[wear]`: what sliding takes off.
    Wear,
    /// `spring`: the approach acts through a cantilever.
    Spring,
}

/// What an effect adds to a scene's cost and what it takes away.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct EffectCost {
    /// Fields that are there because of it.
    pub fields_added: Vec<&'static str>,
    /// Fields that are not there because of it.
    pub fields_spared: Vec<&'static str>,
    /// Passes of an iteration that are there because of it.
    pub passes_added: Vec<&'static str>,
    /// Passes that are not there because of it.
    pub passes_spared: Vec<&'static str>,
    /// Bytes more, or less.
    pub bytes: i128,
}

impl Effect {
    /// Every effect of this version.
    pub const ALL: [Effect; 13] = [
        Effect::Adhesion,
        Effect::Dmt,
        Effect::AdhesionMap,
        Effect::Rate,
        Effect::Capillary,
        Effect::Layer,
        Effect::Hardness,
        Effect::Relaxation,
        Effect::FreeBoundary,
        Effect::Spring,
        Effect::Friction,
        Effect::Conductance,
        Effect::Wear,
    ];

    /// Its name in summaries.
    pub fn name(self) -> &'static str {
        match self {
            Effect::Adhesion => "adhesion",
            Effect::Dmt => "dmt treatment",
            Effect::AdhesionMap => "adhesion map",
            Effect::Rate => "rate",
            Effect::Capillary => "capillary",
            Effect::Layer => "layer",
            Effect::Hardness => "hardness",
            Effect::Relaxation => "relaxation",
            Effect::FreeBoundary => "free boundary",
            Effect::Spring => "spring",
            Effect::Friction => "friction",
            Effect::Conductance => "conductance",
            Effect::Wear => "wear",
        }
    }

    /// What it does, in a line.
    pub fn purpose(self) -> &'static str {
        match self {
            Effect::Adhesion => "the surfaces attract across the gap by a cohesive law",
            Effect::Dmt => {
                "attraction is summed over the gap of the contact without it, which it does not deform"
            }
            Effect::AdhesionMap => "a factor of its own multiplies the tension at each point",
            Effect::Rate => {
                "the work of adhesion grows with the speed at which the contact recedes, found in several solves a step"
            }
            Effect::Capillary => {
                "liquid from damp air bridges narrow gaps: a constant suction up to the height of its meniscus"
            }
            Effect::Layer => {
                "the solid is a layer on a rigid base, stiffer than the half-space to waves longer than its thickness"
            }
            Effect::Hardness => {
                "the pressure saturates at the hardness; what flows there lowers the heights for good"
            }
            Effect::Relaxation => {
                "the solid is viscoelastic: stiff to what is fast, soft to what is slow, and it dissipates"
            }
            Effect::FreeBoundary => {
                "one isolated contact on an unbounded half-space, on twice the points each way"
            }
            Effect::Friction => {
                "a shear strength times the area in contact, in a column of its own; it changes nothing else"
            }
            Effect::Conductance => {
                "what the area in contact conducts, in a column of its own, by conjugate gradients after each step"
            }
            Effect::Wear => {
                "the volume that a length of sliding takes off, in a column of its own; it changes nothing else"
            }
            Effect::Spring => {
                "the approach is prescribed at the far end of a spring, so contacts snap in and off"
            }
        }
    }

    /// Whether a scene asks for it.
    pub fn is_on(self, scene: &Scene) -> bool {
        match self {
            Effect::Adhesion => scene.adhesion.is_some() && scene.capillary.is_none(),
            Effect::Dmt => scene
                .adhesion
                .as_ref()
                .is_some_and(|adhesion| adhesion.treatment == Treatment::Dmt),
            Effect::AdhesionMap => scene
                .adhesion
                .as_ref()
                .is_some_and(|adhesion| adhesion.map.is_some()),
            Effect::Rate => rate_of(scene).is_some(),
            Effect::Capillary => scene.capillary.is_some(),
            Effect::Layer => scene.solid.layer.is_some(),
            Effect::Hardness => scene.solid.hardness.is_some(),
            Effect::Relaxation => !scene.solid.relaxation.is_empty(),
            Effect::FreeBoundary => scene.grid.boundary == Boundary::Free,
            Effect::Spring => scene.loading.spring.is_some(),
            Effect::Friction => scene.friction.is_some(),
            Effect::Conductance => scene.conductance.is_some(),
            Effect::Wear => scene.wear.is_some(),
        }
    }

    /// When it matters, with the number of a scene that asks for it.
    pub fn matters(self, plan: &Plan) -> String {
        let scene = &plan.scene;
        let moments = &plan.outline.moments;
        let grid = plan.outline.grid;
        let tabor = plan.regime.map_or(0.0, |regime| regime.tabor);
        match self {
            Effect::Adhesion => {
                // |q| h^2 summed over waves is at most the product of the two root mean squares.
                let flattening = 0.25
                    * scene.solid.contact_modulus
                    * moments.rms_slope()
                    * moments.rms_height();
                format!(
                    "matters where the work of adhesion is not far below the energy that flattens the roughness (at most E* rms slope rms height/4): here it is {:.2e} of it",
                    plan.law.work_of_adhesion() / flattening
                )
            }
            Effect::Dmt => {
                format!("holds at Tabor numbers well below 1: here {tabor:.3}")
            }
            Effect::AdhesionMap => {
                let (mean, deviation) =
                    plan.outline.map.map_or((1.0, 0.0), |map| (map.mean, map.deviation));
                format!(
                    "matters where it varies over lengths of the contacts: here the factor is {mean:.3} on average, give or take {deviation:.3}"
                )
            }
            Effect::Rate => {
                let path: f64 = scene.loading.durations.iter().flatten().sum();
                let reference = rate_of(scene).map_or(0.0, |rate| rate.reference_speed);
                format!(
                    "matters where contacts recede at speeds not far below the reference: half the cell within the path's {} would be {:.2e} of it; one speed stands for the whole edge",
                    format_si(path, "s"),
                    0.5 * grid.lx.min(grid.ly) / path / reference
                )
            }
            Effect::Capillary => {
                let capillary = scene.capillary.as_ref();
                let radius = capillary.map_or(0.0, |liquid| liquid.meniscus().kelvin_radius);
                format!(
                    "matters where much of the gap is narrower than the meniscus, twice the Kelvin radius: here that radius is {}, {:.3} of the rms height",
                    format_si(radius, "m"),
                    radius / moments.rms_height()
                )
            }
            Effect::Layer => {
                let longest = grid.lx.max(grid.ly);
                let stiffer = scene.solid.layer.map_or(1.0, |layer| {
                    1.0 / layer.compliance(2.0 * std::f64::consts::PI / longest)
                });
                format!(
                    "matters where contacts are as wide as it is thick: here the longest wave of the cell meets {stiffer:.3} times the half-space's stiffness"
                )
            }
            Effect::Hardness => {
                let hardness = scene.solid.hardness.unwrap_or(f64::INFINITY);
                let flattening = 0.5 * scene.solid.contact_modulus * moments.rms_slope();
                let largest = scene.loading.path.iter().copied().fold(0.0, f64::max);
                let mean = match scene.loading.control {
                    Control::Pressure => Some(largest),
                    Control::Force => Some(largest / grid.area()),
                    Control::Approach | Control::MeanGap => None,
                };
                let path = mean.map_or(String::new(), |mean| {
                    format!(", and the largest mean pressure of the path {:.2e}", mean / hardness)
                });
                format!(
                    "matters where pressures reach it: here what flattens the roughness (E* rms slope/2) is {:.2e} of it{path}",
                    flattening / hardness
                )
            }
            Effect::Relaxation => {
                let path: f64 = scene.loading.durations.iter().flatten().sum();
                let deborah: Vec<String> = scene
                    .solid
                    .relaxation
                    .iter()
                    .map(|branch| format!("{:.2e}", branch.time / path))
                    .collect();
                format!(
                    "matters where a branch relaxes neither much faster nor much slower than the load: here their times are {} of the path's {} (Deborah numbers)",
                    deborah.join(", "),
                    format_si(path, "s")
                )
            }
            Effect::FreeBoundary => {
                "matters where the contact is more than about a fifth of the cell: its images would press on it".to_owned()
            }
            Effect::Friction => {
                let strength = scene.friction.map_or(0.0, |friction| friction.shear_strength);
                format!(
                    "holds while sliding does not peel the contact: a shear strength well below the contact modulus, here {:.2e} of it",
                    strength / scene.solid.contact_modulus
                )
            }
            Effect::Conductance => {
                let combined = scene.conductance.map_or(0.0, |bodies| bodies.combined());
                format!(
                    "matters where spots are few: closed everywhere they resist no more than the bodies do; here a spot as wide as a pixel conducts {}",
                    format_si(combined * grid.pixel_area().sqrt(), "W/K")
                )
            }
            Effect::Wear => {
                let specific = scene.wear.map_or(0.0, |wear| wear.specific_wear_rate);
                let flattening = 0.5 * scene.solid.contact_modulus * moments.rms_slope();
                format!(
                    "holds while little is worn, for the heights stay: here a spot under the pressure that flattens the roughness (E* rms slope/2) loses {} a metre of sliding, beside an rms height of {}",
                    format_si(specific * flattening, "m"),
                    format_si(moments.rms_height(), "m")
                )
            }
            Effect::Spring => {
                let stiffness = scene.loading.spring.unwrap_or(0.0);
                let contact = 2.0 * scene.solid.contact_modulus * grid.area().sqrt();
                format!(
                    "snaps where the spring is softer than the attraction's gradient: here it has {:.2e} of the stiffness of a punch as wide as the grid",
                    stiffness / contact
                )
            }
        }
    }

    /// The scene without it.
    pub fn taken_from(self, scene: &Scene) -> Scene {
        let mut scene = scene.clone();
        match self {
            Effect::Adhesion => scene.adhesion = None,
            Effect::Dmt => {
                if let Some(adhesion) = &mut scene.adhesion {
                    adhesion.treatment = Treatment::Full;
                }
            }
            Effect::AdhesionMap => {
                if let Some(adhesion) = &mut scene.adhesion {
                    adhesion.map = None;
                }
            }
            Effect::Rate => {
                if let Some(adhesion) = &mut scene.adhesion {
                    adhesion.rate = None;
                }
            }
            Effect::Capillary => {
                scene.capillary = None;
                scene.adhesion = None;
            }
            Effect::Layer => scene.solid.layer = None,
            Effect::Hardness => scene.solid.hardness = None,
            Effect::Relaxation => scene.solid.relaxation.clear(),
            Effect::FreeBoundary => scene.grid.boundary = Boundary::Periodic,
            Effect::Spring => scene.loading.spring = None,
            Effect::Friction => scene.friction = None,
            Effect::Conductance => scene.conductance = None,
            Effect::Wear => scene.wear = None,
        }
        scene
    }

    /// What it costs in a scene that asks for it, of which `with` is the cost on `grid`.
    ///
    /// # Errors
    /// As [`Cost::of_scene`].
    pub fn cost(self, scene: &Scene, with: &Cost, grid: Grid) -> Result<EffectCost, BackendError> {
        let without = Cost::of_scene(&self.taken_from(scene), grid, with.place)?;
        let names = |cost: &Cost| {
            cost.fields
                .iter()
                .chain(&cost.history)
                .map(|field| field.name)
                .collect::<Vec<_>>()
        };
        let bytes = |cost: &Cost| (cost.bytes() + cost.history_bytes()) as i128;
        Ok(EffectCost {
            fields_added: difference(&names(with), &names(&without)),
            fields_spared: difference(&names(&without), &names(with)),
            passes_added: difference(&with.passes, &without.passes),
            passes_spared: difference(&without.passes, &with.passes),
            bytes: bytes(with) - bytes(&without),
        })
    }
}

/// The rate of a scene's adhesion.
fn rate_of(scene: &Scene) -> Option<RateScene> {
    scene.adhesion.as_ref().and_then(|adhesion| adhesion.rate)
}

/// What is in `left` more often than in `right`.
fn difference(left: &[&'static str], right: &[&'static str]) -> Vec<&'static str> {
    let mut rest = right.to_vec();
    left.iter()
        .copied()
        .filter(|name| match rest.iter().position(|other| other == name) {
            Some(place) => {
                rest.swap_remove(place);
                false
            }
            None => true,
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_count() {
        assert_eq!(difference(&["a", "b", "a"], &["a", "c"]), ["b", "a"]);
        assert!(difference(&["a"], &["a", "a"]).is_empty());
    }
}
