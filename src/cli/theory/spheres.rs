//! Single hard contacts without adhesion: sphere, cone, flat punch.

use std::f64::consts::{FRAC_PI_2, PI};

use super::catalogue::{Model, Table, numbers};
use super::parameters::{Allowed, CONTACT_MODULUS, Kind, Need, POINTS, Parameter, RADIUS};
use super::values::Values;
use crate::cli::Failure;
use crate::theory::cone_punch::{Cone, punch_force};
use crate::theory::{Sphere, hertz};
use crate::units::Dimension;

/// First approach of a contact that touches from 0 on, and its last.
const FROM: Parameter = Parameter::from_approach(Allowed::NotNegative, "0");
const TO: Parameter = Parameter::to_approach(Allowed::NotNegative, "1 % of the radius");

pub(super) const HERTZ: Model = Model {
    name: "hertz",
    about: "sphere on an elastic half-space, no adhesion",
    source: "Hertz 1882; Johnson 1985",
    parameters: &[&[RADIUS, CONTACT_MODULUS, FROM, TO, POINTS]],
    columns: "approach [m], force [N], contact_radius [m], peak_pressure [Pa], stiffness [N/m]",
    example: "--radius \"1 mm\" --contact_modulus \"1 GPa\" --to \"100 nm\"",
    table: hertz_table,
};

fn hertz_table(values: &Values) -> Result<Table, Failure> {
    let sphere = Sphere::new(
        values.number("radius"),
        values.number("contact_modulus"),
        0.0,
    )?;
    let places = values.places(0.0, 0.01 * sphere.radius())?;
    Table::over(&places, |approach| {
        let radius = hertz::contact_radius_at_approach(&sphere, approach)?;
        numbers([
            approach,
            hertz::force(&sphere, radius),
            radius,
            hertz::pressure(&sphere, radius, 0.0),
            hertz::stiffness(&sphere, radius),
        ])
    })
}

pub(super) const CONE: Model = Model {
    name: "cone",
    about: "cone on an elastic half-space, no adhesion",
    source: "Sneddon 1965",
    parameters: &[&[
        Parameter {
            name: "half_angle",
            kind: Kind::Quantity(Dimension::Angle, Allowed::Inside(0.0, FRAC_PI_2)),
            need: Need::Required,
            meaning: "angle between axis and flank",
        },
        CONTACT_MODULUS,
        FROM,
        Parameter::to(
            Dimension::Length,
            Allowed::NotNegative,
            "",
            "approach of the last row; a cone has no length of its own",
        )
        .needed(Need::Required),
        POINTS,
    ]],
    columns: "approach [m], force [N], contact_radius [m], contact_pressure [Pa]",
    example: "--half_angle \"85 deg\" --contact_modulus \"1 GPa\" --to \"200 nm\"",
    table: cone_table,
};

fn cone_table(values: &Values) -> Result<Table, Failure> {
    let slope = FRAC_PI_2 - values.number("half_angle");
    let cone = Cone::new(slope, values.number("contact_modulus"))?;
    let places = values.places(0.0, f64::NAN)?;
    Table::over(&places, |approach| {
        let radius = approach / cone.approach(1.0);
        let force = cone.force(radius);
        numbers([approach, force, radius, cone.mean_pressure()])
    })
}

pub(super) const FLAT_PUNCH: Model = Model {
    name: "flat-punch",
    about: "rigid flat circular punch on an elastic half-space, no adhesion",
    source: "Sneddon 1965",
    parameters: &[&[
        Parameter::positive("radius", Dimension::Length, "radius of the punch"),
        CONTACT_MODULUS,
        FROM,
        TO,
        POINTS,
    ]],
    columns: "approach [m], force [N], contact_pressure [Pa]",
    example: "--radius \"1 um\" --contact_modulus \"1 GPa\"",
    table: punch_table,
};

fn punch_table(values: &Values) -> Result<Table, Failure> {
    let (radius, modulus) = (values.number("radius"), values.number("contact_modulus"));
    let places = values.places(0.0, 0.01 * radius)?;
    Table::over(&places, |approach| {
        let force = punch_force(radius, modulus, approach)?;
        numbers([approach, force, (force / (PI * radius * radius))])
    })
}
