//! `[adhesion]`: a cohesive law acts across the gap.

use super::attracted_pixels::{self, LEAST_TABOR};
use crate::law::Law;
use crate::scene::{Boundary, Range, Scene, Treatment};
use crate::study::{Column, Evaluation, Hooks, Plan, Regime, Setup};
use crate::surface::Top;
use crate::units::format_si;

/// Values of chi (grid spacing over the length of the cohesive zone) above which the pixels influence the
/// contact edge: for the sharp Maugis-Dugdale law, for the tapered one, and for Lennard-Jones. Up to its value
/// the tapered law gives the pull-off of an edge along the grid to 3 % (table of `docs/solver.md`); between 1/3,
/// where the width of the taper reaches twice the range, and 0.65 the error oscillates.
const SHARP_LIMIT: f64 = 0.02;
const TAPERED_LIMIT: f64 = 0.65;
const CORE_LIMIT: f64 = 0.64;
/// Rounding of chi: the automatic ranges of Lennard-Jones and of a law that ends sharply lie at their limits.
const ROUNDING: f64 = 1e-9;
/// Values above which the error of pull-off is 10 % or more: for the sharp law, and for every other.
const SHARP_LOST: f64 = 0.1;
const LOST: f64 = 1.3;

/// Radius of a contact at pull-off in Maugis' unit `(pi w R^2/K)^(1/3)`: JKR's `1.5^(1/3)`.
const PULL_OFF_RADIUS: f64 = 1.145;
/// Its width in pixels below which the pixels of its edge change pull-off by 5 % and 10 %, measured at Tabor number 1.
const FEW_PIXELS: f64 = 10.0;
const LOST_PIXELS: f64 = 6.0;
/// Rms heights over the range between which surfaces that are no sphere part as a whole, at a tension near the peak of the law, so
/// that a taper lowers pull-off: by up to 8 % where it is 0.6 of the range, by up to 25 % at 1.8 (table of `docs/solver.md`).
const PARTS_AS_A_WHOLE: std::ops::RangeInclusive<f64> = 0.1..=1.5;
/// The largest of them at which the sharp law is within 5 % (`tests/physics/taper.rs`), as no edge is trapped.
const NO_EDGE: f64 = 0.6;
/// Taper over the range from which on it does.
const LEAST_TAPER: f64 = 0.2;
/// Rms heights over the range of rough surfaces up to which a wide taper lowers pull-off too, and the taper over the range from which
/// on: at 1.8 by up to 15 %, at 2 by up to 38 %.
const STILL_SMOOTH: f64 = 3.0;
const WIDE_TAPER: f64 = 1.5;

/// The adhesion of the examples of other effects.
pub(super) const EXAMPLE: (&str, &str) = (
    "adhesion",
    "{ law = \"exponential\", work_of_adhesion = 1e-4, range = 0.02 }",
);

/// Largest work of adhesion, J/m^2: clean metals have a few.
const WORK: f64 = 10.0;

/// Sum of the net tension over the points under tension, N: at zero load the pressure of the others balances it.
pub(super) const ATTRACTION: Column = Column::new("attractive_force", "N", 5);

/// A law between the surfaces.
pub(super) struct Adhesion;

impl Hooks for Adhesion {
    fn name(&self) -> &'static str {
        "adhesion"
    }

    fn purpose(&self) -> &'static str {
        "the surfaces attract across the gap by a cohesive law"
    }

    fn is_on(&self, scene: &Scene) -> bool {
        scene.adhesion.is_some() && scene.capillary.is_none()
    }

    fn remove_from(&self, scene: &mut Scene) {
        scene.adhesion = None;
    }

    fn example(&self) -> &'static [(&'static str, &'static str)] {
        &[EXAMPLE]
    }

    fn matters(&self, plan: &Plan) -> String {
        let moments = &plan.outline.moments;
        // |q| h^2 summed over waves is at most the product of the two root mean squares.
        let flattening =
            0.25 * plan.scene.solid.contact_modulus * moments.rms_slope() * moments.rms_height();
        format!(
            "matters where the work of adhesion is not far below the energy that flattens the roughness (at most E* rms slope rms height/4): here it is {:.2e} of it",
            plan.law.work_of_adhesion() / flattening
        )
    }

    fn warnings(&self, plan: &Plan) -> Vec<String> {
        let work = plan.law.work_of_adhesion();
        let strong = (work > WORK).then(|| {
            format!(
                "a work of adhesion of {} is more than solids have: was it meant in mJ/m^2?",
                format_si(work, "J/m^2")
            )
        });
        strong.into_iter().chain(warnings_of_pixels(plan)).collect()
    }

    fn columns(&self) -> &'static [Column] {
        &[ATTRACTION]
    }

    fn values(&self, setup: &Setup, evaluation: Option<&Evaluation>) -> Vec<(Column, f64)> {
        vec![attraction(setup, evaluation)]
    }
}

/// The attractive force of a solved state.
pub(super) fn attraction(setup: &Setup, evaluation: Option<&Evaluation>) -> (Column, f64) {
    let share = &setup.problem.share;
    let tension = evaluation.map_or(0.0, |evaluation| {
        share.surface_sum_by(&evaluation.pressure, |p| (-p).max(0.0))
    });
    (ATTRACTION, tension * setup.surface.grid.pixel_area())
}

/// Warnings by chi, with the errors that were measured on spheres and on straight edges.
pub(super) fn warnings_of_pixels(plan: &Plan) -> Vec<String> {
    let mut warnings = Vec::new();
    let (Some(regime), Some(adhesion)) = (plan.regime, &plan.scene.adhesion) else {
        return warnings;
    };
    if adhesion.range == Range::Auto {
        warnings.push(format!(
            "range = \"auto\" stands for {}: the shortest that this grid resolves at this work of adhesion",
            format_si(plan.law.range(), "m")
        ));
    }
    warnings.extend(attracted_pixels::warning(plan, regime));
    if adhesion.treatment == Treatment::Dmt || is_plate(plan) {
        return warnings;
    }
    let chi = regime.chi;
    let measured = format!(
        "a pixel is {chi:.2} of the cohesive zone (chi = w dx/(E* range^2)), {:.2} pixels across it",
        regime.zone_pixels
    );
    let remedy = if plan.scene.capillary.is_some() {
        // The range is the height of the meniscus.
        "take more points"
    } else {
        "take more points or a longer range (range = \"auto\" finds the shortest that the grid resolves)"
    };
    let beyond = "10 % cannot be reached on this grid";
    let has_edge = smoothness(plan).is_none_or(|roughness| roughness > NO_EDGE);
    let text = match plan.law {
        Law::MaugisDugdale(law) if law.taper == 0.0 && !has_edge => None,
        Law::MaugisDugdale(law) if law.taper == 0.0 && chi > SHARP_LOST => Some(format!(
            "{beyond}: {measured}: the sharp law traps the contact edge, pull-off comes out about 14 % too high at 0.16 and 44 % at 0.65; leave taper at \"auto\", or {remedy}"
        )),
        Law::MaugisDugdale(law) if law.taper == 0.0 && chi > SHARP_LIMIT * (1.0 + ROUNDING) => {
            Some(format!(
                "{measured}: beyond {SHARP_LIMIT} the sharp law traps the contact edge, pull-off {} too high; leave taper at \"auto\", or {remedy}",
                if chi >= 0.04 {
                    "3 to 10 %"
                } else {
                    "about 2 %"
                }
            ))
        }
        Law::MaugisDugdale(law) if law.taper > 0.0 && chi > LOST => Some(format!(
            "{beyond}: {measured}: beyond {LOST} the taper no longer frees the contact edge, pull-off is about 30 % too high at 2.6 where the contact is wide, and 50 to 90 % where it is 10 pixels; at 1.3 it is 11 % where the edge lies straight along the grid; {remedy}"
        )),
        Law::MaugisDugdale(law) if law.taper > 0.0 && chi > TAPERED_LIMIT => Some(format!(
            "{measured}: beyond {TAPERED_LIMIT} expect pull-off within 2 % where the contact is wide and round, within 7 % where it is 10 pixels, and 5 to 11 % too high where its edge lies straight along the grid, the energy of a loop up to 50 % low; {remedy}"
        )),
        Law::Exponential(_) if chi > LOST => Some(format!(
            "{beyond}: {measured}: beyond {LOST} the contact edge is trapped between pixels, pull-off is about 40 % too high at 2.6 and 160 % at 5; {remedy}"
        )),
        Law::LennardJones(_) if chi > LOST => Some(format!(
            "{beyond}: {measured}: beyond {LOST} the contact edge is trapped between pixels, pull-off is about 40 % too high at 2.5; {remedy}"
        )),
        Law::LennardJones(_) if chi > CORE_LIMIT * (1.0 + ROUNDING) => Some(format!(
            "{measured}: beyond {CORE_LIMIT} the contact edge is trapped between pixels and pull-off comes out too high, by more than 4 %; {remedy}"
        )),
        _ => None,
    };
    warnings.extend(text);
    warnings.extend(warning_of_small_contact(plan, regime));
    warnings.extend(warning_of_taper(plan, regime));
    warnings
}

/// Whether an endless flat attracts everywhere alike: it parts at once, without an edge.
fn is_plate(plan: &Plan) -> bool {
    let grid = &plan.scene.grid;
    let map = plan
        .scene
        .adhesion
        .as_ref()
        .and_then(|law| law.map.as_ref());
    grid.boundary == Boundary::Periodic && map.is_none() && plan.outline.moments.rms_height() == 0.0
}

/// The rms height over the range, of surfaces that are no sphere and no cone: these peel, however much of them is on the grid.
fn roughness(plan: &Plan) -> Option<f64> {
    let roughness = plan.outline.moments.rms_height() / plan.law.range();
    let peels = matches!(plan.outline.top, Top::Sphere(_) | Top::Cone { .. });
    (!peels).then_some(roughness)
}

/// The same of surfaces that part as a whole.
fn smoothness(plan: &Plan) -> Option<f64> {
    roughness(plan).filter(|roughness| PARTS_AS_A_WHOLE.contains(roughness))
}

/// The warning for a taper that lowers pull-off.
fn warning_of_taper(plan: &Plan, regime: Regime) -> Option<String> {
    let (range, taper) = (plan.law.range(), plan.law.taper());
    // Flats and walls have edges, whatever their height, and no curvature.
    let still_smooth = roughness(plan).filter(|roughness| {
        (*PARTS_AS_A_WHOLE.end()..=STILL_SMOOTH).contains(roughness) && regime.tabor.is_some()
    });
    if let Some(roughness) = still_smooth
        && taper >= WIDE_TAPER * range
    {
        return Some(format!(
            "with an rms height of {roughness:.2} of the range the taper of {} makes pull-off too low: by up to 15 % where it is 1.8 of the range and up to 38 % at 2 (here {:.2}); take more points",
            format_si(taper, "m"),
            taper / range,
        ));
    }
    let roughness = smoothness(plan).filter(|_| taper >= LEAST_TAPER * range)?;
    Some(format!(
        "an rms height of {roughness:.2} of the range lets the surfaces part as a whole, and the taper of {} makes pull-off too low: by up to 8 % where it is 0.6 of the range and up to 25 % at 1.8 (here {:.2}); {}",
        format_si(taper, "m"),
        taper / range,
        if roughness > NO_EDGE || plan.scene.capillary.is_some() {
            "take more points"
        } else {
            "take taper = 0, which is within 5 % here"
        }
    ))
}

/// The warning for a sphere whose contact is only a few pixels wide at pull-off, whatever its cohesive zone.
fn warning_of_small_contact(plan: &Plan, regime: Regime) -> Option<String> {
    let radius = plan.outline.top.sphere_radius()?;
    let pixel = plan.outline.grid.longer_pixel();
    let stiffness = 4.0 / 3.0 * plan.scene.solid.contact_modulus;
    // Maugis' unit of radius, in which a contact parts at 1.14 (JKR) to 0 (DMT).
    let unit =
        (std::f64::consts::PI * plan.law.work_of_adhesion() * radius * radius / stiffness).cbrt();
    let pixels = 2.0 * PULL_OFF_RADIUS * unit / pixel;
    if pixels >= FEW_PIXELS || regime.tabor.is_some_and(|tabor| tabor < LEAST_TABOR) {
        return None;
    }
    let strength = if pixels < LOST_PIXELS {
        "10 % cannot be reached on this grid: "
    } else {
        ""
    };
    Some(format!(
        "{strength}the contact at pull-off is about {pixels:.1} pixels wide: pull-off is about 5 % off at 10 pixels and 12 % at 5; take more points"
    ))
}
