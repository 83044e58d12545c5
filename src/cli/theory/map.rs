//! Which theory of a sphere holds.

use std::f64::consts::PI;

use super::catalogue::{Model, Table};
use super::parameters::{ADHESIVE_SPHERE, RANGE};
use super::soft::sphere;
use super::values::Values;
use crate::cli::Failure;
use crate::theory::Law;
use crate::theory::maugis_dugdale::MaugisDugdale;
use crate::theory::tabor_map::{LAMBDA_PER_MU_MATCHED, Regime, maugis_parameter, regime};

pub(super) const TABOR_MAP: Model = Model {
    name: "tabor-map",
    about: "Tabor and Maugis parameters of a sphere, Maugis' pull-off and the theory that holds, a row for each law",
    source: "Tabor 1977; Maugis 1992; Johnson & Greenwood 1997, doi:10.1006/jcis.1997.4984",
    parameters: &[ADHESIVE_SPHERE, &[RANGE]],
    columns: "law, tabor_parameter, maugis_parameter, peak_tension [Pa], pull_off_force [N], advice",
    example: "--radius \"1 um\" --contact_modulus \"100 GPa\" --work_of_adhesion \"50 mJ/m^2\" --range \"0.3 nm\"",
    table: map_table,
};

/// The laws are brought together by their work of adhesion and peak tension, so that the Tabor
/// parameter is that of the Lennard-Jones law with the same two, and the pull-off force that of
/// Maugis' theory at its lambda.
fn map_table(values: &Values) -> Result<Table, Failure> {
    let sphere = sphere(values)?;
    let mut table = Table::default();
    let laws = [
        ("lennard-jones", Law::LennardJones),
        ("cubic", Law::Cubic),
        ("exponential", Law::Exponential),
        ("maugis-dugdale", Law::Dugdale),
    ];
    for (name, law) in laws {
        let tension = law.peak_tension() * sphere.work_of_adhesion() / values.number("range");
        let lambda = maugis_parameter(&sphere, tension)?;
        let mu = lambda / LAMBDA_PER_MU_MATCHED;
        let pull_off = MaugisDugdale::new(lambda)?.pull_off()?.force;
        table.rows.push(vec![
            name.into(),
            mu.into(),
            lambda.into(),
            tension.into(),
            (pull_off * PI * sphere.work_of_adhesion() * sphere.radius()).into(),
            advice(regime(mu)?).into(),
        ]);
    }
    table.notes.push(
        "pull_off_force is that of Maugis' theory at the peak tension; that of the law itself is up to 6 % more where it has no end (lennard-jones, cubic, exponential), which lennard-jones-sphere and the full field give"
            .to_owned(),
    );
    Ok(table)
}

/// Words without a comma, since they stand in a table.
fn advice(regime: Regime) -> &'static str {
    match regime {
        Regime::ForceDmt => "DMT force approach: dmt-f",
        Regime::Intermediate => "between DMT and JKR: maugis-dugdale or the full field",
        Regime::Jkr => "JKR: jkr",
    }
}
