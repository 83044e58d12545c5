//! Soft adhesive spheres, whose attraction deforms them: equilibria with hysteresis.
//!
//! At each approach the state is the one that a sphere held there has come to, going apart from
//! a deep contact or coming together from far away.

use std::f64::consts::PI;

use super::catalogue::{Cell, Model, Table};
use super::dmt::{LAST_APPROACH, LAST_APPROACH_WORDS};
use super::parameters::{ADHESIVE_SPHERE, Allowed, DIRECTION, Need, POINTS, Parameter, RANGE};
use super::values::Values;
use crate::cli::Failure;
use crate::theory::maugis_dugdale::{MaugisDugdale, State};
use crate::theory::tabor_map::maugis_parameter;
use crate::theory::{Sphere, TheoryError, jkr};
use crate::units::Dimension;

const SEPARATED: &str = "separated";
/// No contact, attraction.
pub(super) const ATTRACTED: &str = "attracted";
/// In contact.
pub(super) const CONTACT: &str = "contact";

const TO: Parameter = Parameter::to_approach(Allowed::Any, LAST_APPROACH_WORDS);

/// The sphere of the three parameters that all of them have.
pub(super) fn sphere(values: &Values) -> Result<Sphere, Failure> {
    Ok(Sphere::new(
        values.number("radius"),
        values.number("contact_modulus"),
        values.number("work_of_adhesion"),
    )?)
}

pub(super) const JKR: Model = Model {
    name: "jkr",
    about: "soft sphere, attraction of no range",
    source: "Johnson, Kendall & Roberts 1971, doi:10.1098/rspa.1971.0141",
    parameters: &[
        ADHESIVE_SPHERE,
        &[
            DIRECTION,
            Parameter::from_approach(Allowed::Any, "where a held approach lets go"),
            TO,
            POINTS,
        ],
    ],
    columns: "approach [m], force [N], contact_radius [m], state",
    example: "--radius \"1 um\" --contact_modulus \"1 MPa\" --work_of_adhesion \"50 mJ/m^2\"",
    table: jkr_table,
};

fn jkr_table(values: &Values) -> Result<Table, Failure> {
    let sphere = sphere(values)?;
    let scales = sphere.maugis_scales()?;
    let grip = scales.approach * jkr::reduced_approach(jkr::grip());
    let places = values.places(grip, LAST_APPROACH * scales.approach)?;
    // Coming together the surfaces jump in as they touch.
    let first = if values.together() { 0.0 } else { grip };
    let mut table = Table::over(&places, |approach| {
        if approach < first {
            return Ok(row(approach, [0.0; 2], SEPARATED));
        }
        let radius = scales.radius
            * jkr::reduced_radius_at_approach(
                (approach / scales.approach).max(jkr::reduced_approach(jkr::grip())),
            )?;
        Ok(row(
            approach,
            [jkr::force(&sphere, radius), radius],
            CONTACT,
        ))
    })?;
    table.note("pull_off_force", jkr::pull_off_force(&sphere), "N");
    let at = scales.approach * jkr::reduced_approach(jkr::pull_off());
    table.note("pull_off_approach", at, "m");
    Ok(table)
}

/// An approach, numbers, the state.
pub(super) fn row<const N: usize>(
    approach: f64,
    numbers: [f64; N],
    state: &'static str,
) -> Vec<Cell> {
    std::iter::once(approach)
        .chain(numbers)
        .map(Cell::Number)
        .chain([Cell::Word(state)])
        .collect()
}

pub(super) const MAUGIS_DUGDALE: Model = Model {
    name: "maugis-dugdale",
    about: "sphere with a cohesive zone of constant tension, from DMT to JKR",
    source: "Maugis 1992, doi:10.1016/0021-9797(92)90285-T",
    parameters: &[
        ADHESIVE_SPHERE,
        &[
            RANGE.needed(Need::Either("peak_tension")),
            Parameter::positive(
                "peak_tension",
                Dimension::Pressure,
                "tension of the cohesive zone, w/range",
            )
            .needed(Need::Either("range")),
            DIRECTION,
            Parameter::from_approach(Allowed::Any, "where the attraction is first or last felt"),
            TO,
            POINTS,
        ],
    ],
    columns: "approach [m], force [N], contact_radius [m], cohesive_radius [m], state",
    example: "--radius \"1 um\" --contact_modulus \"1 MPa\" --work_of_adhesion \"50 mJ/m^2\" --range \"50 nm\"",
    table: maugis_table,
};

fn maugis_table(values: &Values) -> Result<Table, Failure> {
    let sphere = sphere(values)?;
    let scales = sphere.maugis_scales()?;
    let tension = values
        .given("peak_tension")
        .unwrap_or_else(|| sphere.work_of_adhesion() / values.number("range"));
    let lambda = maugis_parameter(&sphere, tension)?;
    let model = MaugisDugdale::new(lambda)?;
    let grip = model.grip()?;
    let felt = scales.approach * grip.approach.min(-model.range());
    let places = values.places(felt, LAST_APPROACH * scales.approach)?;
    let mut table = Table::over(&places, |approach| {
        let reduced = approach / scales.approach;
        // At the fold itself rounding decides whether there is a state.
        let state = if !values.together() && (reduced / grip.approach - 1.0).abs() < 1e-12 {
            Some(grip)
        } else {
            maugis_state(&model, reduced, values.together())?
        };
        let Some(state) = state else {
            return Ok(row(approach, [0.0; 3], SEPARATED));
        };
        let numbers = [
            scales.force * state.force,
            scales.radius * state.contact_radius,
            scales.radius * state.cohesive_radius,
        ];
        let touches = state.contact_radius > 0.0;
        Ok(row(
            approach,
            numbers,
            if touches { CONTACT } else { ATTRACTED },
        ))
    })?;
    table.note("maugis_parameter", lambda, "");
    let pull_off = model.pull_off()?;
    table.note("pull_off_force", scales.force * pull_off.force, "N");
    table.note(
        "pull_off_approach",
        scales.approach * pull_off.approach,
        "m",
    );
    Ok(table)
}

/// The state that a sphere has come to at a reduced approach; none where nothing attracts.
///
/// A larger touching state outlives the open disc going apart; coming together the disc grows
/// until it is unstable or touches.
fn maugis_state(
    model: &MaugisDugdale,
    approach: f64,
    together: bool,
) -> Result<Option<State>, TheoryError> {
    if together && approach < -model.range() {
        return Ok(None);
    }
    let touching = model.states_at_approach(approach)?.last().copied();
    // Below this radius of the disc the approach falls as it grows, which no held sphere does.
    let stable = 8.0 / (3.0 * PI) * model.lambda();
    let open = model
        .open_states_at_approach(approach)?
        .into_iter()
        .rfind(|state| state.cohesive_radius >= stable * (1.0 - 1e-12));
    Ok(if together {
        open.or(touching)
    } else {
        touching.or(open)
    })
}
