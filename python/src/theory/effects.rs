//! Laws of attraction, and the functions of effects, by the names that Python calls them by.

use tabor::theory::capillary::Meniscus;
use tabor::theory::viscoelastic::Solid;
use tabor::theory::{Law, TheoryError, conductance, friction, rate};

use super::functions::sphere;
use super::{Evaluate, Words};

/// The functions of laws and effects by name, with the number of their results.
pub const FUNCTIONS: &[(&str, usize, Evaluate)] = &[
    // Laws of (work of adhesion, range, gap).
    ("laws.energy", 1, |words, x| {
        let [work, _, gap] = law(words, x)?;
        Ok(vec![work * words.law.energy(gap)])
    }),
    ("laws.traction", 1, |words, x| {
        let [work, range, gap] = law(words, x)?;
        Ok(vec![work / range * words.law.traction(gap)])
    }),
    ("laws.slope", 1, |words, x| {
        let [work, range, gap] = law(words, x)?;
        Ok(vec![work / (range * range) * words.law.slope(gap)])
    }),
    ("laws.peak_tension", 1, |words, x| {
        let [work, range, _] = law(words, &[x[0], x[1], 0.0])?;
        Ok(vec![work / range * words.law.peak_tension()])
    }),
    ("rate.power_law", 1, |_, x| {
        Ok(vec![rate::power_law(x[0], x[1], x[2], x[3])?])
    }),
    ("rate.pull_off", 1, |_, x| {
        let scales = sphere(x)?.maugis_scales()?;
        let unit = positive("reference_speed", x[4])? * scales.approach / scales.radius;
        Ok(vec![
            -scales.force * rate::reduced_pull_off(x[3] / unit, x[5])?,
        ])
    }),
    ("rate.logarithmic_law", 1, |_, x| {
        Ok(vec![rate::logarithmic_law(x[0], x[1], x[2], x[3])?])
    }),
    ("viscoelastic.relaxation", 1, |_, x| {
        let solid = Solid::new(x[0], x[1], x[2])?;
        Ok(vec![solid.relaxation(later(x[3])?)])
    }),
    ("viscoelastic.creep", 1, |_, x| {
        let solid = Solid::new(x[0], x[1], x[2])?;
        Ok(vec![solid.creep(later(x[3])?)])
    }),
    ("viscoelastic.pressure", 1, |_, x| {
        let solid = Solid::new(x[0], x[1], x[2])?;
        Ok(vec![solid.sphere_pressure(x[3], x[4], x[5], x[6])?])
    }),
    ("viscoelastic.contact_radius", 1, |_, x| {
        let solid = Solid::new(x[0], x[1], x[2])?;
        Ok(vec![solid.sphere_contact_radius(x[3], x[4], x[5])?])
    }),
    ("friction.jkr_force", 1, |_, x| {
        Ok(vec![friction::jkr_force(&sphere(x)?, x[3], x[4])?])
    }),
    ("conductance.combined", 1, |_, x| {
        Ok(vec![conductance::combined_conductivity(x[0], x[1])?])
    }),
    ("conductance.from_stiffness", 1, |_, x| {
        Ok(vec![conductance::from_stiffness(x[0], x[1], x[2])?])
    }),
    ("conductance.circle", 1, |_, x| {
        Ok(vec![conductance::circle(x[0], x[1])?])
    }),
    ("capillary.meniscus", 4, |_, x| {
        let meniscus = Meniscus::new(x[0], x[1], x[2], x[3], x[4])?;
        Ok(vec![
            meniscus.work_of_adhesion(),
            meniscus.range(),
            meniscus.peak_tension(),
            meniscus.kelvin_radius(),
        ])
    }),
    ("capillary.rigid_force", 1, |_, x| {
        let meniscus = Meniscus::new(x[0], x[1], x[2], x[3], x[4])?;
        Ok(vec![-meniscus.rigid_force(x[5], x[6])?])
    }),
];

/// Work of adhesion, range, and the gap in ranges.
fn law(words: &Words, x: &[f64]) -> Result<[f64; 3], TheoryError> {
    let (work, range) = (
        positive("work_of_adhesion", x[0])?,
        positive("range", x[1])?,
    );
    let gap = x[2] / range;
    if words.law == Law::LennardJones && gap <= -1.0 {
        return Err(TheoryError::OutOfRange {
            name: "gap",
            value: x[2],
            allowed: "above minus the range",
        });
    }
    Ok([work, range, gap])
}

/// A time from 0 on.
fn later(time: f64) -> Result<f64, TheoryError> {
    if time >= 0.0 {
        return Ok(time);
    }
    Err(TheoryError::OutOfRange {
        name: "time",
        value: time,
        allowed: "zero or more",
    })
}

/// A value above 0.
pub(super) fn positive(name: &'static str, value: f64) -> Result<f64, TheoryError> {
    if value > 0.0 {
        return Ok(value);
    }
    Err(TheoryError::OutOfRange {
        name,
        value,
        allowed: "positive",
    })
}
