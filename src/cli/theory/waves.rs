//! A line wave on a half-space.

use super::catalogue::{Model, Table, numbers};
use super::parameters::{
    Allowed, CONTACT_MODULUS, Kind, Need, POINTS, Parameter, WORK_OF_ADHESION,
};
use super::values::Values;
use crate::cli::Failure;
use crate::theory::westergaard;
use crate::units::Dimension;

const AMPLITUDE: Parameter = Parameter::positive(
    "amplitude",
    Dimension::Length,
    "half the height from trough to crest",
);
const WAVELENGTH: Parameter =
    Parameter::positive("wavelength", Dimension::Length, "distance of the crests");

pub(super) const WESTERGAARD: Model = Model {
    name: "westergaard",
    about: "line wave pressed flat, no adhesion",
    source: "Westergaard 1939",
    parameters: &[&[
        AMPLITUDE,
        WAVELENGTH,
        CONTACT_MODULUS,
        Parameter::from(
            Dimension::Pressure,
            Allowed::NotNegative,
            "0",
            "mean pressure of the first row",
        ),
        Parameter::to(
            Dimension::Pressure,
            Allowed::NotNegative,
            "that of full contact",
            "mean pressure of the last row",
        ),
        POINTS,
    ]],
    columns: "mean_pressure [Pa], contact_area_fraction, mean_gap [m], peak_pressure [Pa]",
    example: "--amplitude \"10 nm\" --wavelength \"1 um\" --contact_modulus \"1 GPa\"",
    table: westergaard_table,
};

fn full_contact(values: &Values) -> Result<f64, Failure> {
    Ok(westergaard::full_contact_pressure(
        values.number("contact_modulus"),
        values.number("amplitude"),
        values.number("wavelength"),
    )?)
}

fn westergaard_table(values: &Values) -> Result<Table, Failure> {
    let full = full_contact(values)?;
    let places = values.places_within(0.0, full, (0.0, full), "Pa")?;
    let mut table = Table::over(&places, |pressure| {
        let reduced = pressure / full;
        let half_width = westergaard::half_width(reduced)?;
        numbers([
            pressure,
            2.0 * half_width,
            values.number("amplitude") * westergaard::mean_gap(reduced)?,
            full * westergaard::pressure(half_width, 0.0)?,
        ])
    })?;
    table.note("full_contact_pressure", full, "Pa");
    Ok(table)
}

pub(super) const WAVY_ADHESIVE: Model = Model {
    name: "wavy-adhesive",
    about: "line wave with attraction of no range, all equilibria from no to nearly full contact",
    source: "Johnson 1995",
    parameters: &[&[
        AMPLITUDE,
        WAVELENGTH,
        CONTACT_MODULUS,
        WORK_OF_ADHESION,
        share("from", "0", "contact area fraction of the first row"),
        share("to", "0.99", "contact area fraction of the last row"),
        POINTS,
    ]],
    columns: "contact_area_fraction, mean_pressure [Pa]",
    example: "--amplitude \"10 nm\" --wavelength \"1 um\" --contact_modulus \"10 MPa\" --work_of_adhesion \"0.2 mJ/m^2\"",
    table: adhesive_table,
};

const fn share(name: &'static str, chosen: &'static str, meaning: &'static str) -> Parameter {
    Parameter {
        name,
        kind: Kind::Quantity(Dimension::Dimensionless, Allowed::BelowOne),
        need: Need::Default(chosen),
        meaning,
    }
}

fn adhesive_table(values: &Values) -> Result<Table, Failure> {
    let full = full_contact(values)?;
    let adhesion = westergaard::adhesion_parameter(
        values.number("contact_modulus"),
        values.number("amplitude"),
        values.number("wavelength"),
        values.number("work_of_adhesion"),
    )?;
    let places = values.places(0.0, 0.99)?;
    let mut table = Table::over(&places, |share| {
        let pressure = westergaard::adhesive_mean_pressure(0.5 * share, adhesion)?;
        numbers([share, full * pressure])
    })?;
    table.note("full_contact_pressure", full, "Pa");
    table.note("adhesion_parameter", adhesion, "");
    // A strong attraction leaves no extrema: contact is complete at once.
    if let Ok(extrema) = westergaard::adhesive_extrema(adhesion) {
        table.note("pull_off_pressure", -full * extrema.pull_off, "Pa");
        table.note("closing_pressure", full * extrema.closing_pressure, "Pa");
    }
    Ok(table)
}
