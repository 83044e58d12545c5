//! Rough surfaces by their spectrum.

use std::f64::consts::PI;

use super::catalogue::{Model, Table, numbers};
use super::parameters::{
    Allowed, CONTACT_MODULUS, Kind, LAW, Need, POINTS, Parameter, RANGE, WORK_OF_ADHESION,
};
use super::values::Values;
use crate::cli::Failure;
use crate::theory::bam::BearingArea;
use crate::theory::pastewka_robbins::{Edge, stickiness_ratio};
use crate::theory::persson::Persson;
use crate::theory::persson_gap::{Adhesion, RoughContact};
use crate::theory::{Spectrum, TheoryError};
use crate::units::Dimension;

const RMS_HEIGHT: Parameter = Parameter::positive(
    "rms_height",
    Dimension::Length,
    "standard deviation of the heights",
);
const RMS_SLOPE: Parameter = Parameter::positive(
    "rms_slope",
    Dimension::Dimensionless,
    "root of the mean square gradient",
);

pub(super) const PERSSON: Model = Model {
    name: "persson",
    about: "area, mean gap, stiffness and attraction of a self-affine surface, by repulsive pressure",
    source: "Persson 2001, 2008; Yang & Persson 2008; Afferrante et al. 2018; Persson & Scaraggi 2014",
    parameters: &[&[
        Parameter {
            name: "hurst",
            kind: Kind::Quantity(Dimension::Dimensionless, Allowed::Inside(0.0, 1.0)),
            need: Need::Required,
            meaning: "Hurst exponent",
        },
        RMS_HEIGHT.needed(Need::Either("rms_slope")),
        RMS_SLOPE.needed(Need::Either("rms_height")),
        Parameter::positive("longest", Dimension::Length, "longest wavelength")
            .needed(Need::Chosen("that of the roll-off")),
        Parameter::positive("rolloff", Dimension::Length, "wavelength of the roll-off"),
        Parameter::positive("shortest", Dimension::Length, "shortest wavelength"),
        CONTACT_MODULUS,
        Parameter {
            name: "gamma",
            kind: Kind::Quantity(Dimension::Dimensionless, Allowed::Share),
            need: Need::Default("0.5"),
            meaning: "energy of partial contact against that of the full contact's waves",
        },
        WORK_OF_ADHESION.needed(Need::With("range")),
        RANGE.needed(Need::With("work_of_adhesion")),
        LAW,
        Parameter::from(
            Dimension::Pressure,
            Allowed::Positive,
            "0.001 of contact modulus times rms slope",
            "repulsive pressure of the first row; rows are even in its logarithm",
        ),
        Parameter::to(
            Dimension::Pressure,
            Allowed::Positive,
            "contact modulus times rms slope",
            "repulsive pressure of the last row",
        ),
        POINTS.or("31"),
    ]],
    columns: "mean_pressure [Pa], contact_area_fraction, mean_gap [m], stiffness [Pa/m], adhesive_pressure [Pa], repulsive_pressure [Pa]",
    example: "--hurst 0.8 --rms_height \"0.52 nm\" --longest \"25 um\" --rolloff \"6.3 um\" --shortest \"0.2 um\" --contact_modulus \"1.33 TPa\" --work_of_adhesion \"0.2 J/m^2\" --range \"1 nm\" --points 5",
    table: persson_table,
};

/// The spectrum of a surface as a scene would name it, by wavelengths.
fn spectrum(values: &Values) -> Result<Spectrum, Failure> {
    let (rolloff, shortest) = (values.number("rolloff"), values.number("shortest"));
    let longest = values.given("longest").unwrap_or(rolloff);
    let mut problems = Vec::new();
    if longest < rolloff {
        problems.push("--longest is shorter than --rolloff".to_owned());
    }
    if rolloff <= shortest {
        problems.push("--shortest is not shorter than --rolloff".to_owned());
    }
    if !problems.is_empty() {
        return Err(super::usage(&problems));
    }
    let wavenumbers = [longest, rolloff, shortest].map(|wavelength| 2.0 * PI / wavelength);
    let of_height = |height: f64| Spectrum::new(wavenumbers, values.number("hurst"), height);
    Ok(match values.given("rms_height") {
        Some(height) => of_height(height)?,
        None => of_height(values.number("rms_slope") / of_height(1.0)?.rms_slope())?,
    })
}

fn persson_table(values: &Values) -> Result<Table, Failure> {
    let spectrum = spectrum(values)?;
    let modulus = values.number("contact_modulus");
    let contact = RoughContact::new(Persson::new(values.number("gamma"))?, spectrum, modulus)?;
    let adhesion = values
        .given("work_of_adhesion")
        .map(|work_of_adhesion| Adhesion {
            law: values.law(),
            work_of_adhesion,
            range: values.number("range"),
        });
    let unit = modulus * spectrum.rms_slope();
    let places = values.places_by_factor(1e-3 * unit, unit)?;
    let mut table = Table::over(&places, |pressure| {
        let attraction = adhesion
            .as_ref()
            .map_or(Ok(0.0), |adhesion| contact.attraction(adhesion, pressure))?;
        numbers([
            pressure - attraction,
            contact.area_fraction(pressure)?,
            contact.mean_gap(pressure)?,
            contact.stiffness(pressure)?,
            attraction,
            pressure,
        ])
    })?;
    table.note("rms_height", spectrum.rms_height(), "m");
    table.note("rms_slope", spectrum.rms_slope(), "");
    table.note("rms_curvature", spectrum.rms_curvature(), "1/m");
    if let Some(adhesion) = &adhesion {
        match contact.pull_off(adhesion) {
            Ok(found) => table.note("pull_off_pressure", -found.tension, "Pa"),
            Err(TheoryError::NoSolution { .. }) => table.notes.push(
                "pull_off_pressure: none, repulsion exceeds attraction from 1e-5 of contact modulus times rms slope on"
                    .to_owned(),
            ),
            Err(error) => return Err(error.into()),
        }
    }
    Ok(table)
}

pub(super) const BAM: Model = Model {
    name: "bam",
    about: "bearing-area model of a self-affine surface with constant tension within the range",
    source: "Ciavarella 2018",
    parameters: &[&[
        RMS_HEIGHT,
        Parameter::positive(
            "rolloff",
            Dimension::Length,
            "longest wavelength of the self-affine part",
        ),
        CONTACT_MODULUS,
        WORK_OF_ADHESION,
        RANGE,
        Parameter::from(
            Dimension::Length,
            Allowed::NotNegative,
            "0",
            "mean gap of the first row",
        ),
        Parameter::to(
            Dimension::Length,
            Allowed::NotNegative,
            "4 rms heights and a range",
            "mean gap of the last row",
        ),
        POINTS,
    ]],
    columns: "mean_gap [m], mean_pressure [Pa]",
    example: "--rms_height \"0.52 nm\" --rolloff \"6.3 um\" --contact_modulus \"1.33 TPa\" --work_of_adhesion \"0.2 J/m^2\" --range \"1 nm\"",
    table: bam_table,
};

fn bam_table(values: &Values) -> Result<Table, Failure> {
    let (height, range) = (values.number("rms_height"), values.number("range"));
    let tension = values.number("work_of_adhesion") / range;
    let slope = 2.0 * PI / values.number("rolloff") * height;
    let stiffness = slope * values.number("contact_modulus") / tension;
    let model = BearingArea::new(height / range, stiffness)?;
    let places = values.places(0.0, 4.0 * height + range)?;
    let mut table = Table::over(&places, |gap| {
        let pressure = tension * model.pressure(gap / height);
        numbers([gap, pressure])
    })?;
    match model.pull_off() {
        Ok((gap, pull_off)) => {
            table.note("pull_off_pressure", -tension * pull_off, "Pa");
            table.note("pull_off_mean_gap", height * gap, "m");
        }
        Err(TheoryError::NoSolution { .. }) => table
            .notes
            .push("pull_off_pressure: none, repulsion exceeds attraction at every gap".to_owned()),
        Err(error) => return Err(error.into()),
    }
    Ok(table)
}

pub(super) const PASTEWKA_ROBBINS: Model = Model {
    name: "pastewka-robbins",
    about: "whether a rough surface sticks, by the range of the attraction: repulsion over attraction, below 1 it does",
    source: "Pastewka & Robbins 2014, doi:10.1073/pnas.1320846111",
    parameters: &[&[
        RMS_SLOPE,
        Parameter::positive(
            "rms_curvature",
            Dimension::PerLength,
            "root of the mean square Laplacian",
        ),
        CONTACT_MODULUS,
        WORK_OF_ADHESION,
        Parameter::positive(
            "area_coefficient",
            Dimension::Dimensionless,
            "contact area over load/(E* rms slope)",
        )
        .or("2"),
        Parameter::from(
            Dimension::Length,
            Allowed::Positive,
            "0.1 of rms slope^2/rms curvature",
            "range of the first row; rows are even in its logarithm",
        ),
        Parameter::to(
            Dimension::Length,
            Allowed::Positive,
            "100 of it",
            "range of the last row",
        ),
        POINTS.or("31"),
    ]],
    columns: "range [m], stickiness_ratio, sticky",
    example: "--rms_slope 0.00115 --rms_curvature \"9e3 1/m\" --contact_modulus \"1.33 TPa\" --work_of_adhesion \"0.2 J/m^2\"",
    table: pastewka_robbins_table,
};

fn pastewka_robbins_table(values: &Values) -> Result<Table, Failure> {
    let (rms_slope, rms_curvature) = (values.number("rms_slope"), values.number("rms_curvature"));
    let length = rms_slope * rms_slope / rms_curvature;
    let places = values.places_by_factor(0.1 * length, 100.0 * length)?;
    Table::over(&places, |range| {
        let ratio = stickiness_ratio(&Edge {
            rms_slope,
            rms_curvature,
            work_of_adhesion: values.number("work_of_adhesion"),
            contact_modulus: values.number("contact_modulus"),
            range,
            area_coefficient: values.number("area_coefficient"),
        })?;
        let sticky = if ratio < 1.0 { "yes" } else { "no" };
        Ok(vec![range.into(), ratio.into(), sticky.into()])
    })
}
