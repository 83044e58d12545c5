//! The elastic sphere with a Lennard-Jones law, whose equilibria are solved for numerically.

use std::f64::consts::PI;

use super::catalogue::{Model, Table};
use super::dmt::LAST_APPROACH;
use super::parameters::{ADHESIVE_SPHERE, Allowed, DIRECTION, POINTS, Parameter, RANGE};
use super::soft::{ATTRACTED, CONTACT, row, sphere};
use super::values::Values;
use crate::cli::Failure;
use crate::theory::lennard_jones_sphere::LennardJonesSphere;
use crate::theory::tabor_map::{LJ_PER_MAUGIS_APPROACH, tabor_parameter};

pub(super) const LENNARD_JONES_SPHERE: Model = Model {
    name: "lennard-jones-sphere",
    about: "elastic sphere with Lennard-Jones attraction and repulsion, solved numerically; Tabor parameter 0.01 to 5, slow beyond 2",
    source: "Muller, Yushchenko & Derjaguin 1980; Greenwood 1997; Feng 2001",
    parameters: &[
        ADHESIVE_SPHERE,
        &[
            RANGE,
            DIRECTION,
            Parameter::from_approach(Allowed::Any, "minus 4 ranges and 2 Tabor parameters more"),
            Parameter::to_approach(
                Allowed::Any,
                "4 (pi^2 w^2 R/K^2)^(1/3), K = 4 E*/3, but no more than 20 ranges",
            ),
            POINTS.or("61"),
        ],
    ],
    columns: "approach [m], force [N], contact_radius [m], central_gap [m], state",
    example: "--radius \"1 um\" --contact_modulus \"50 GPa\" --work_of_adhesion \"50 mJ/m^2\" --range \"0.3 nm\" --points 21",
    table: lennard_jones_table,
};

fn lennard_jones_table(values: &Values) -> Result<Table, Failure> {
    let sphere = sphere(values)?;
    let range = values.number("range");
    let mu = tabor_parameter(&sphere, range)?;
    let far = -(4.0 + 2.0 * mu);
    let last = (LAST_APPROACH * LJ_PER_MAUGIS_APPROACH * mu).min(20.0);
    let places = values.places_within(
        far * range,
        last * range,
        (f64::NEG_INFINITY, 20.0 * range),
        "m",
    )?;
    let deepest = places
        .iter()
        .fold(0.0_f64, |most, place| most.max(place / range));
    let model = LennardJonesSphere::new(mu, deepest)?;
    let curve = model.curve_to(deepest)?;
    let unit = 2.0 * PI * sphere.work_of_adhesion() * sphere.radius();
    let radius_unit = (sphere.radius() * range).sqrt();
    let mut table = Table::over(&places, |place| {
        let state = model.on_curve(&curve, place / range, values.together())?;
        let centre = model.gap(&state, 0.0);
        let (radius, word) = if centre < 0.0 {
            (model.radius_of_gap(&state, 0.0)?, CONTACT)
        } else {
            (0.0, ATTRACTED)
        };
        let numbers = [unit * state.force, radius_unit * radius, range * centre];
        Ok(row(place, numbers, word))
    })?;
    table.note("tabor_parameter", mu, "");
    let pull_off = model.pull_off()?;
    table.note("pull_off_force", unit * pull_off.force, "N");
    table.note("pull_off_approach", range * pull_off.approach, "m");
    Ok(table)
}
