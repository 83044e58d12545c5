//! Stiff adhesive spheres: the rigid one, and Hertz with an attraction that does not deform.

use std::f64::consts::PI;

use super::catalogue::{Model, Table, numbers};
use super::parameters::{
    ADHESIVE_SPHERE, Allowed, LAW, POINTS, Parameter, RADIUS, RANGE, WORK_OF_ADHESION,
};
use super::soft::sphere;
use super::values::Values;
use crate::cli::Failure;
use crate::theory::dmt::{self, Method};
use crate::theory::tabor_map::{FORCE_DMT_LIMIT, tabor_parameter};
use crate::theory::{Law, Sphere, bradley, derjaguin, hertz};
use crate::units::Dimension;

const APPROACH_FORCE: &str = "approach [m], force [N], contact_radius [m], attraction [N]";

const FROM_FAR: Parameter = Parameter::from(
    Dimension::Length,
    Allowed::Any,
    "minus 5 ranges",
    "approach of the first row; before contact the sphere is rigid",
);
const FROM_CONTACT: Parameter = Parameter::from_approach(Allowed::NotNegative, "0");
const TO: Parameter = Parameter::to_approach(Allowed::Any, LAST_APPROACH_WORDS);
const TO_CONTACT: Parameter = Parameter::to_approach(Allowed::NotNegative, LAST_APPROACH_WORDS);

/// The default of the last approach, in Maugis' unit of it.
pub(super) const LAST_APPROACH: f64 = 4.0;
/// That in words.
pub(super) const LAST_APPROACH_WORDS: &str = "4 (pi^2 w^2 R/K^2)^(1/3), K = 4 E*/3";

pub(super) const BRADLEY: Model = Model {
    name: "bradley",
    about: "rigid sphere at a gap from a rigid flat; approach is minus the gap",
    source: "Bradley 1932, in the approximation of Derjaguin 1934",
    parameters: &[&[
        RADIUS,
        WORK_OF_ADHESION,
        RANGE,
        LAW,
        Parameter::from_approach(Allowed::NotPositive, "minus 10 ranges"),
        Parameter::to_approach(Allowed::NotPositive, "0"),
        POINTS,
    ]],
    columns: "approach [m], force [N], gap [m]",
    example: "--radius \"1 um\" --work_of_adhesion \"50 mJ/m^2\" --range \"0.3 nm\"",
    table: bradley_table,
};

fn bradley_table(values: &Values) -> Result<Table, Failure> {
    let range = values.number("range");
    // A rigid sphere: the modulus does not enter.
    let sphere = Sphere::new(
        values.number("radius"),
        1.0,
        values.number("work_of_adhesion"),
    )?;
    let places = values.places(-10.0 * range, 0.0)?;
    let mut table = Table::over(&places, |approach| {
        let gap = -approach;
        let force = bradley::force(&sphere, values.law(), range, gap)?;
        numbers([approach, force, gap])
    })?;
    let most = 2.0 * PI * sphere.work_of_adhesion() * sphere.radius();
    table.note("pull_off_force", -most, "N");
    Ok(table)
}

pub(super) const DERJAGUIN: Model = Model {
    name: "derjaguin",
    about: "Hertz contact that gains the energy of its area only: attraction pi w R",
    source: "Derjaguin 1934",
    parameters: &[ADHESIVE_SPHERE, &[FROM_CONTACT, TO_CONTACT, POINTS]],
    columns: APPROACH_FORCE,
    example: "--radius \"1 um\" --contact_modulus \"100 GPa\" --work_of_adhesion \"50 mJ/m^2\"",
    table: |values| constant(values, &derjaguin::force),
};

pub(super) const DMT_M: Model = Model {
    name: "dmt-m",
    about: "Hertz contact with the constant attraction 2 pi w R",
    source: "Maugis 1992",
    parameters: DERJAGUIN.parameters,
    columns: APPROACH_FORCE,
    example: DERJAGUIN.example,
    table: |values| {
        constant(values, &|sphere, radius| {
            let attraction = 2.0 * PI * sphere.work_of_adhesion() * sphere.radius();
            hertz::force(sphere, radius) - attraction
        })
    },
};

/// Models in contact only, with `force` at a contact radius.
fn constant(values: &Values, force: &dyn Fn(&Sphere, f64) -> f64) -> Result<Table, Failure> {
    let sphere = sphere(values)?;
    let last = LAST_APPROACH * sphere.maugis_scales()?.approach;
    let places = values.places(0.0, last)?;
    // The difference of the two forces, without the digits that it loses under a load.
    let attraction = -force(&sphere, 0.0);
    let mut table = Table::over(&places, |approach| {
        let radius = hertz::contact_radius_at_approach(&sphere, approach)?;
        numbers([approach, force(&sphere, radius), radius, attraction])
    })?;
    table.note("pull_off_force", -attraction, "N");
    Ok(table)
}

const WITH_RANGE: &[&[Parameter]] = &[ADHESIVE_SPHERE, &[RANGE, FROM_FAR, TO, POINTS]];
const STIFF: &str = "--radius \"1 um\" --contact_modulus \"100 GPa\" --work_of_adhesion \"50 mJ/m^2\" --range \"0.3 nm\"";

pub(super) const DMT_T: Model = Model {
    name: "dmt-t",
    about: "Hertz contact, attraction from the energy of the frozen profile, cubic law",
    source: "Derjaguin, Muller & Toporov 1975",
    parameters: WITH_RANGE,
    columns: APPROACH_FORCE,
    example: STIFF,
    table: |values| ranged(values, Method::Thermodynamic, Law::Cubic),
};

pub(super) const IDMT_T: Model = Model {
    name: "idmt-t",
    about: "as dmt-t, with the Lennard-Jones law",
    source: "Muller, Yushchenko & Derjaguin 1983",
    parameters: WITH_RANGE,
    columns: APPROACH_FORCE,
    example: STIFF,
    table: |values| ranged(values, Method::Thermodynamic, Law::LennardJones),
};

pub(super) const DMT_F: Model = Model {
    name: "dmt-f",
    about: "Hertz contact, attraction summed over the gap outside it",
    source: "Muller, Yushchenko & Derjaguin 1983",
    parameters: &[ADHESIVE_SPHERE, &[RANGE, LAW, FROM_FAR, TO, POINTS]],
    columns: APPROACH_FORCE,
    example: STIFF,
    table: |values| ranged(values, Method::Force, values.law()),
};

/// Models with a range of attraction, before and in contact.
fn ranged(values: &Values, method: Method, law: Law) -> Result<Table, Failure> {
    let sphere = sphere(values)?;
    let range = values.number("range");
    let unit = 2.0 * PI * sphere.work_of_adhesion() * sphere.radius();
    let mu = tabor_parameter(&sphere, range)?;
    let last = LAST_APPROACH * sphere.maugis_scales()?.approach;
    let places = values.places(-5.0 * range, last)?;
    let mut table = Table::over(&places, |approach| {
        let reduced = approach / range;
        // Not the difference of two forces, which loses its digits under a load.
        let attraction = if reduced < 0.0 {
            -dmt::force(method, law, reduced, mu)?
        } else {
            dmt::attraction(method, law, reduced.sqrt())?
        };
        let force = dmt::hertz_force(reduced.max(0.0), mu)? - attraction;
        let radius = (sphere.radius() * approach.max(0.0)).sqrt();
        numbers([approach, unit * force, radius, unit * attraction])
    })?;
    table.note("tabor_parameter", mu, "");
    let (_, pull_off) = dmt::pull_off(method, law, mu)?;
    table.note("pull_off_force", unit * pull_off, "N");
    if method == Method::Force && mu > FORCE_DMT_LIMIT {
        table.notes.push(format!(
            "warning: the model holds up to a Tabor parameter of {FORCE_DMT_LIMIT:.3}; beyond it the pull-off is too strong"
        ));
    }
    Ok(table)
}
