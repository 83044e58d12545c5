//! `[capillary]`: a liquid that condenses between the surfaces pulls them together. The scene turns it
//! into the cohesive law of its meniscus.

use std::ops::RangeInclusive;

use super::adhesion::{ATTRACTION, attraction, warnings_of_pixels};
use crate::law::LEAST_KELVIN_RADIUS;
use crate::scene::Scene;
use crate::study::{Column, Evaluation, Hooks, Plan, Setup};
use crate::units::format_si;

/// Temperatures at which a liquid condenses from air, K.
const TEMPERATURES: RangeInclusive<f64> = 200.0..=700.0;

/// A liquid bridge in each narrow gap.
pub(super) struct Capillary;

impl Hooks for Capillary {
    fn name(&self) -> &'static str {
        "capillary"
    }

    fn purpose(&self) -> &'static str {
        "liquid from damp air bridges narrow gaps: a constant suction up to the height of its meniscus"
    }

    fn is_on(&self, scene: &Scene) -> bool {
        scene.capillary.is_some()
    }

    fn remove_from(&self, scene: &mut Scene) {
        scene.capillary = None;
        scene.adhesion = None;
    }

    fn example(&self) -> &'static [(&'static str, &'static str)] {
        // A meniscus 0.02 high.
        &[(
            "capillary",
            "{ humidity = 0.5, surface_tension = 1e-4, molar_volume = 171742, temperature = 298 }",
        )]
    }

    fn matters(&self, plan: &Plan) -> String {
        let capillary = plan.scene.capillary.as_ref();
        let radius = capillary.map_or(0.0, |liquid| liquid.meniscus().kelvin_radius);
        format!(
            "matters where much of the gap is narrower than the meniscus, twice the Kelvin radius: here that radius is {}, {:.3} of the rms height",
            format_si(radius, "m"),
            radius / plan.outline.moments.rms_height()
        )
    }

    fn warnings(&self, plan: &Plan) -> Vec<String> {
        let dry = plan
            .scene
            .capillary
            .as_ref()
            .filter(|liquid| !liquid.bridges());
        let dry = dry.map(|liquid| {
            format!(
                "capillary.humidity {} is below {:.3}, where the Kelvin radius is {}: no liquid bridges the gap, and nothing attracts",
                liquid.humidity,
                liquid.least_humidity(),
                format_si(LEAST_KELVIN_RADIUS, "m"),
            )
        });
        let odd = plan
            .scene
            .capillary
            .as_ref()
            .map(|liquid| liquid.temperature)
            .filter(|temperature| !TEMPERATURES.contains(temperature));
        let odd = odd.map(|temperature| {
            format!(
                "a temperature of {} at which a liquid condenses: was it meant in degrees Celsius? Add 273.15",
                format_si(temperature, "K")
            )
        });
        dry.into_iter()
            .chain(odd)
            .chain(warnings_of_pixels(plan))
            .collect()
    }

    // The column is declared by `adhesion`, in whose place this effect is.
    fn columns_of(&self, _: &Scene) -> Vec<Column> {
        vec![ATTRACTION]
    }

    fn values(&self, setup: &Setup, evaluation: Option<&Evaluation>) -> Vec<(Column, f64)> {
        vec![attraction(setup, evaluation)]
    }
}
