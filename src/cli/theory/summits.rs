//! Rough surfaces as summits of one radius and Gaussian heights.

use std::f64::consts::PI;

use super::catalogue::{Model, Table, numbers};
use super::parameters::{Allowed, CONTACT_MODULUS, DIRECTION, POINTS, Parameter, WORK_OF_ADHESION};
use super::values::Values;
use crate::cli::Failure;
use crate::theory::gw::Summits;
use crate::theory::{Sphere, fuller_tabor, gw_m};
use crate::units::Dimension;

const SUMMIT_RADIUS: Parameter =
    Parameter::positive("radius", Dimension::Length, "radius of a summit");
const DENSITY: Parameter =
    Parameter::positive("density", Dimension::PerArea, "summits per nominal area");
const RMS_HEIGHT: Parameter = Parameter::positive(
    "rms_height",
    Dimension::Length,
    "standard deviation of the heights of the summits",
);
const FROM: Parameter = Parameter::from(
    Dimension::Length,
    Allowed::Any,
    "0",
    "separation of flat and mean summit in the first row",
);
const TO: Parameter = Parameter::to(
    Dimension::Length,
    Allowed::Any,
    "4 rms heights",
    "separation in the last row",
);

const EXAMPLE: &str =
    "--radius \"10 um\" --density \"1 1/um^2\" --rms_height \"1 nm\" --contact_modulus \"100 GPa\"";
const EXAMPLE_ADHESIVE: &str = "--radius \"10 um\" --density \"1 1/um^2\" --rms_height \"1 nm\" --contact_modulus \"100 GPa\" --work_of_adhesion \"0.2 J/m^2\"";

/// The summits, and the separations of the rows in standard deviations.
fn summits(values: &Values) -> Result<(Summits, Vec<f64>), Failure> {
    // Greenwood & Williamson's have no work of adhesion.
    let work = values.given("work_of_adhesion").unwrap_or(0.0);
    let summit = Sphere::new(
        values.number("radius"),
        values.number("contact_modulus"),
        work,
    )?;
    let height = values.number("rms_height");
    let summits = Summits::new(summit, values.number("density"), height)?;
    // The integrals of the theory end there.
    let deepest = -30.0 * height;
    let places = values.places_within(0.0, 4.0 * height, (deepest, f64::INFINITY), "m")?;
    Ok((summits, places))
}

pub(super) const GW: Model = Model {
    name: "gw",
    about: "rough surface as independent Hertz summits, no adhesion",
    source: "Greenwood & Williamson 1966, doi:10.1098/rspa.1966.0242",
    parameters: &[&[
        SUMMIT_RADIUS,
        DENSITY,
        RMS_HEIGHT,
        CONTACT_MODULUS,
        FROM,
        TO,
        POINTS,
    ]],
    columns: "separation [m], mean_pressure [Pa], contact_area_fraction, contact_density [1/m^2]",
    example: EXAMPLE,
    table: |values| {
        let (summits, places) = summits(values)?;
        let mut table = Table::over(&places, |separation| {
            let reduced = separation / summits.rms_height();
            numbers([
                separation,
                summits.pressure(reduced)?,
                summits.contact_area_fraction(reduced),
                summits.contact_density(reduced),
            ])
        })?;
        warn_of_overlap(&mut table, &summits, &places);
        Ok(table)
    },
};

/// Says so where the contacts of independent summits cover more than there is.
fn warn_of_overlap(table: &mut Table, summits: &Summits, places: &[f64]) {
    let closest = places.iter().copied().fold(f64::INFINITY, f64::min);
    if summits.contact_area_fraction(closest / summits.rms_height()) > 1.0 {
        table.notes.push(
            "warning: contact_area_fraction exceeds 1, since summits do not know of each other here; the model is meant for a few per cent"
                .to_owned(),
        );
    }
}

pub(super) const GW_M: Model = Model {
    name: "gw-m",
    about: "as gw, where each summit in contact pulls with 2 pi w R",
    source: "Maugis 1996",
    parameters: &[&[
        SUMMIT_RADIUS,
        DENSITY,
        RMS_HEIGHT,
        CONTACT_MODULUS,
        WORK_OF_ADHESION,
        FROM,
        TO,
        POINTS,
    ]],
    columns: GW.columns,
    example: EXAMPLE_ADHESIVE,
    table: |values| {
        let (summits, places) = summits(values)?;
        let mut table = Table::over(&places, |separation| {
            let reduced = separation / summits.rms_height();
            numbers([
                separation,
                gw_m::pressure(&summits, reduced)?,
                summits.contact_area_fraction(reduced),
                summits.contact_density(reduced),
            ])
        })?;
        warn_of_overlap(&mut table, &summits, &places);
        table.note("adhesion_parameter", summits.adhesion_parameter()?, "");
        table.note("pull_off_pressure", -gw_m::pull_off(&summits)?, "Pa");
        Ok(table)
    },
};

pub(super) const FULLER_TABOR: Model = Model {
    name: "fuller-tabor",
    about: "rough surface as independent JKR summits",
    source: "Fuller & Tabor 1975, doi:10.1098/rspa.1975.0138",
    parameters: &[&[
        SUMMIT_RADIUS,
        DENSITY,
        RMS_HEIGHT,
        CONTACT_MODULUS,
        WORK_OF_ADHESION,
        DIRECTION,
        FROM,
        TO,
        POINTS,
    ]],
    columns: "separation [m], mean_pressure [Pa]",
    example: EXAMPLE_ADHESIVE,
    table: fuller_tabor_table,
};

fn fuller_tabor_table(values: &Values) -> Result<Table, Failure> {
    let (summits, places) = summits(values)?;
    let theta = summits.adhesion_parameter()?;
    let summit = summits.summit();
    let unit = summits.density() * PI * summit.work_of_adhesion() * summit.radius();
    let path = if values.together() {
        fuller_tabor::Path::Loading
    } else {
        fuller_tabor::Path::Unloading
    };
    let mut table = Table::over(&places, |separation| {
        let reduced = separation / summits.rms_height();
        let pressure = fuller_tabor::reduced_pressure(theta, reduced, path)?;
        numbers([separation, (unit * pressure)])
    })?;
    table.note("adhesion_parameter", theta, "");
    let (_, pull_off) = fuller_tabor::reduced_pull_off(theta)?;
    table.note("pull_off_pressure", -1.5 * unit * pull_off, "Pa");
    Ok(table)
}
