//! Which model suits the force curve of a sphere whose numbers are known, by a classifier trained on full fields.

use std::f64::consts::PI;

use super::catalogue::{Cell, Model, Table};
use super::parameters::{ADHESIVE_SPHERE, Allowed, Kind, LAW, Need, Parameter, RANGE};
use super::soft::sphere;
use super::values::Values;
use crate::cli::Failure;
use crate::fit::advice::advise_numbers;
use crate::fit::advice::numbers::Numbers;
use crate::theory::Law;
use crate::theory::tabor_map::tabor_parameter;
use crate::units::Dimension;

/// Noise and load that are assumed, over `2 pi w R`.
const NOISE: f64 = 0.01;
const LOAD: f64 = 5.0;

pub(super) const ADVISE: Model = Model {
    name: "advise",
    about: "which model gives w and E* of a sphere's force curve within 15 %, with probabilities learned from full fields",
    source: "docs/advise.md",
    parameters: &[
        ADHESIVE_SPHERE,
        &[
            RANGE,
            LAW,
            Parameter {
                name: "rms_height",
                kind: Kind::Quantity(Dimension::Length, Allowed::NotNegative),
                need: Need::Default("0"),
                meaning: "root mean square height of the roughness",
            },
            Parameter {
                name: "noise",
                kind: Kind::Quantity(Dimension::Force, Allowed::Positive),
                need: Need::Chosen("1 % of 2 pi w R"),
                meaning: "standard deviation of the measured force",
            },
            Parameter {
                name: "load",
                kind: Kind::Quantity(Dimension::Force, Allowed::Positive),
                need: Need::Chosen("5 times 2 pi w R"),
                meaning: "greatest force of the curve",
            },
        ],
    ],
    columns: "model, probability",
    example: "--radius \"1 um\" --contact_modulus \"1 GPa\" --work_of_adhesion \"50 mJ/m^2\" --range \"1 nm\" --rms_height \"0.2 nm\"",
    table: advise_table,
};

fn advise_table(values: &Values) -> Result<Table, Failure> {
    let sphere = sphere(values)?;
    let range = values.number("range");
    // The Lennard-Jones law of the same work and peak tension.
    let matched = range * Law::LennardJones.peak_tension() / values.law().peak_tension();
    let force = 2.0 * PI * sphere.work_of_adhesion() * sphere.radius();
    let numbers = Numbers {
        tabor: tabor_parameter(&sphere, matched)?,
        rms_height: values.number("rms_height") / range,
        noise: values.given("noise").map_or(NOISE, |noise| noise / force),
        load: values.given("load").map_or(LOAD, |load| load / force),
    };
    let advice = advise_numbers(&numbers);
    let mut table = Table::default();
    table.note("tabor_parameter", numbers.tabor, "");
    table.note("rms height over the range", numbers.rms_height, "");
    table.note("noise over 2 pi w R", numbers.noise, "");
    table.note("load over 2 pi w R", numbers.load, "");
    let sentences = advice.sentences();
    table.notes.extend(
        sentences
            .into_iter()
            .map(|sentence| format!("advice: {sentence}")),
    );
    for (model, probability) in &advice.probabilities {
        let name = model.map_or("none", crate::fit::Model::name);
        // Outside of what it has seen the classifier has no probabilities.
        let known = if advice.is_outside() {
            f64::NAN
        } else {
            *probability
        };
        table.rows.push(vec![Cell::Word(name), known.into()]);
    }
    Ok(table)
}
