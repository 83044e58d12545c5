//! `[capillary]`: a liquid that condenses between the surfaces pulls them together. The scene turns it
//! into the cohesive law of its meniscus.

use std::ops::RangeInclusive;

use super::adhesion::{ATTRACTION, attraction, warnings_of_pixels};
use crate::law::LEAST_KELVIN_RADIUS;
use crate::scene::{Boundary, CapillaryScene, Scene};
use crate::study::{Column, Evaluation, Hooks, Plan, Setup};
use crate::units::format_si;

/// Temperatures at which a liquid condenses from air, K.
const TEMPERATURES: RangeInclusive<f64> = 200.0..=700.0;

/// Largest surface tension, N/m: molten metals have 2.
const SURFACE_TENSION: f64 = 5.0;
/// Largest molar volume of a liquid, m^3/mol: silicone oils have some 0.03.
const MOLAR_VOLUME: f64 = 0.1;
/// Height of a meniscus over the rms height from which on it fills the gap of surfaces that touch: six are from the highest peak to
/// the lowest valley of most rough surfaces.
const FLOODED: f64 = 6.0;
/// Side of a map, m, from which on a scene may be in reduced units.
const REDUCED: f64 = 0.01;

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
        let height = capillary.map_or(0.0, |liquid| liquid.meniscus().range());
        format!(
            "matters where much of the gap is narrower than the meniscus: here it is {} high, {:.3} of the rms height",
            format_si(height, "m"),
            height / plan.outline.moments.rms_height()
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
        let liquid = plan.scene.capillary.as_ref();
        let flat = liquid.filter(|liquid| liquid.is_flat()).map(|liquid| {
            format!(
                "the meniscus is {} high, less than a molecule of the liquid, for its contact angle of {:.4} degrees: no liquid bridges such a gap",
                format_si(liquid.meniscus().range(), "m"),
                liquid.contact_angle.to_degrees()
            )
        });
        let rms_height = plan.outline.moments.rms_height();
        let floods = |liquid: &&CapillaryScene| {
            plan.scene.grid.boundary == Boundary::Periodic
                && liquid.bridges()
                && liquid.meniscus().range() > FLOODED * rms_height
        };
        let flooded = liquid.filter(floods).map(|liquid| {
            format!(
                "the meniscus, {} high, fills the gap of the whole cell, whose rms height is {}: what is found is its suction times the area of the cell",
                format_si(liquid.meniscus().range(), "m"),
                format_si(rms_height, "m")
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
        let grid = plan.outline.grid;
        let liquid = plan.scene.capillary.as_ref();
        let liquid = liquid.filter(|_| grid.lx.max(grid.ly) < REDUCED);
        let tense = liquid
            .map(|liquid| liquid.surface_tension)
            .filter(|tension| *tension > SURFACE_TENSION);
        let tense = tense.map(|tension| {
            format!(
                "a surface tension of {} is more than liquids have: was it meant in mN/m?",
                format_si(tension, "N/m")
            )
        });
        let large = liquid
            .map(|liquid| liquid.molar_volume)
            .filter(|volume| *volume > MOLAR_VOLUME);
        let large = large.map(|volume| {
            format!(
                "a molar volume of {volume} m^3/mol is more than liquids have: was it meant in cm^3/mol?"
            )
        });
        dry.into_iter()
            .chain(flat)
            .chain(flooded)
            .chain(odd)
            .chain(tense)
            .chain(large)
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
