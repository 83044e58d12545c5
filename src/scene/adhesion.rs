//! Reads `[adhesion]`: a law from two of its three parameters.

use std::path::Path;

use super::allowed::{Allowed, in_range};
use super::document::Value;
use super::keys;
use super::rate;
use super::reader::Reader;
use super::{
    AdhesionMap, AdhesionScene, Boundary, GridScene, LawName, PatternKind, Range, Treatment,
};
use crate::units::{self, Dimension, format_si};

/// Reads `[adhesion]`: `Some(None)` if the scene has none, `None` after a mistake. Paths are
/// relative to `folder`; `relaxes` is true for a viscoelastic solid.
pub(super) fn read(
    scene: &Reader,
    grid: Option<&GridScene>,
    folder: &Path,
    relaxes: bool,
) -> Option<Option<AdhesionScene>> {
    if !scene.has("adhesion") {
        return Some(None);
    }
    let adhesion = scene.table("adhesion", &keys::ADHESION)?;
    adhesion.require(&["law"]);
    let law = adhesion.word("law");
    let numbers = numbers(&adhesion, law);
    let taper = taper(&adhesion, law, numbers.as_ref().map(|(_, range)| *range));
    let treatment = adhesion.word_or("treatment", Treatment::Full);
    if relaxes && treatment == Some(Treatment::Dmt) {
        // The search for the net load tries loads that a viscoelastic solid would have to remember.
        adhesion.not_in_this_version(
            "treatment",
            "treatment = \"dmt\" on a viscoelastic solid",
            "take treatment = \"full\", or leave [[solid.relaxation]] out",
        );
    }
    let map = map(&adhesion, law, grid, folder);
    let rate = rate::read(&adhesion, law, treatment);
    let (work_of_adhesion, range) = numbers?;
    Some(Some(AdhesionScene {
        law: law?,
        work_of_adhesion,
        range,
        taper: taper?,
        treatment: treatment?,
        map: map?,
        rate: rate?,
    }))
}

/// Relative difference up to which a period divides a size.
const DIVIDES: f64 = 1e-9;

/// Reads the map: `Some(None)` without one, `None` after a mistake.
fn map(
    adhesion: &Reader,
    law: Option<LawName>,
    grid: Option<&GridScene>,
    folder: &Path,
) -> Option<Option<AdhesionMap>> {
    let Some(node) = adhesion.node("map") else {
        return Some(None);
    };
    if let Value::Text(path) = &node.value {
        if path.is_empty() {
            adhesion.conflict("map", "is empty; name a file, relative to the scene file");
            return None;
        }
        return Some(Some(AdhesionMap::File(folder.join(path))));
    }
    if !matches!(node.value, Value::Table(_)) {
        // A map is a text or a table; for anything else the text's own error is reported.
        adhesion.text("map");
        return None;
    }
    let pattern = adhesion.table("map", &keys::PATTERN)?;
    pattern.require(&["pattern", "period", "low", "high"]);
    let kind = pattern.word("pattern");
    let period = pattern.quantity("period", Dimension::Length, Allowed::POSITIVE);
    let factors = ["low", "high"]
        .map(|key| pattern.quantity(key, Dimension::Dimensionless, Allowed::NOT_NEGATIVE));
    if let (Some(period), Some(kind), Some(grid)) = (period, kind, grid)
        && let Some(size) = grid.size
        && grid.boundary == Boundary::Periodic
    {
        let sides = match kind {
            PatternKind::Checker => &size[..],
            PatternKind::Stripe => &size[..1],
        };
        let odd = sides.iter().zip(["x", "y"]).find(|(side, _)| {
            let periods = *side / period;
            periods.round() < 1.0 || (periods - periods.round()).abs() > DIVIDES * periods
        });
        if let Some((side, axis)) = odd {
            let periods = (side / period).round().max(1.0);
            pattern.conflict(
                "period",
                format!(
                    "does not divide the size of the periodic cell, {} along {axis}; take a whole fraction of it: {periods} periods are {:.9e} m each",
                    format_si(*side, "m"),
                    side / periods
                ),
            );
            return None;
        }
    }
    let [low, high] = [factors[0]?, factors[1]?];
    if low == 0.0 && high == 0.0 {
        pattern.conflict(
            "high",
            "is 0 like low, so nothing attracts; leave [adhesion] out, or give a factor above 0",
        );
        return None;
    }
    if law == Some(LawName::LennardJones) && low.min(high) == 0.0 {
        pattern.conflict(
            if low == 0.0 { "low" } else { "high" },
            "must be above 0: with law = \"lennard-jones\" the factor also multiplies the repulsion; take another law, or a small factor",
        );
        return None;
    }
    Some(Some(AdhesionMap::Pattern {
        kind: kind?,
        period: period?,
        low,
        high,
    }))
}

/// Work of adhesion and range from exactly two of the three parameters.
fn numbers(adhesion: &Reader, law: Option<LawName>) -> Option<(f64, Range)> {
    let work = adhesion.quantity(
        "work_of_adhesion",
        Dimension::EnergyPerArea,
        Allowed::POSITIVE,
    );
    let auto = adhesion.is_text("range", "auto");
    let range = if auto {
        Some(Range::Auto)
    } else {
        let length = adhesion.quantity("range", Dimension::Length, Allowed::POSITIVE);
        length.map(Range::Length)
    };
    let peak = adhesion.quantity("peak_tension", Dimension::Pressure, Allowed::POSITIVE);
    let given = ["work_of_adhesion", "range", "peak_tension"].map(|key| adhesion.has(key));
    match given {
        [_, true, true] if auto => {
            adhesion.conflict(
                "peak_tension",
                "range = \"auto\" follows from the grid and work_of_adhesion; leave peak_tension out, or give a range in m",
            );
            None
        }
        [false, ..] if auto => {
            adhesion.require(&["work_of_adhesion"]);
            None
        }
        [true, true, true] => {
            adhesion.conflict(
                "peak_tension",
                "work_of_adhesion, range and peak_tension are all given; give exactly two, the third follows",
            );
            None
        }
        [true, true, false] => Some((work?, range?)),
        [true, false, true] => {
            let range = work? * law?.shape() / peak?;
            is_normal(adhesion, range).then_some((work?, Range::Length(range)))
        }
        [false, true, true] => match range? {
            Range::Length(length) => {
                let work = peak? * length / law?.shape();
                is_normal(adhesion, work).then_some((work, Range::Length(length)))
            }
            Range::Auto => None,
        },
        [true, false, false] => {
            adhesion.require_as("range", "range = \"1 nm\"` or `peak_tension = \"50 MPa\"");
            None
        }
        [false, _, _] => {
            adhesion.require(&["work_of_adhesion"]);
            if given == [false; 3] {
                adhesion.require_as("range", "range = \"1 nm\"` or `peak_tension = \"50 MPa\"");
            }
            None
        }
    }
}

/// Notes a derived parameter outside the supported magnitudes.
fn is_normal(adhesion: &Reader, derived: f64) -> bool {
    let normal = derived > 0.0 && in_range(derived);
    if !normal {
        adhesion.conflict(
            "peak_tension",
            format!("makes the third number of the law {derived:e}; check the powers of ten"),
        );
    }
    normal
}

/// The taper: `Some(None)` is `auto`, also for the laws without one.
fn taper(adhesion: &Reader, law: Option<LawName>, range: Option<Range>) -> Option<Option<f64>> {
    if !adhesion.has("taper") {
        return Some(None);
    }
    if let Some(law) = law
        && law != LawName::MaugisDugdale
    {
        adhesion.conflict(
            "taper",
            format!(
                "law = \"{}\" has no taper; leave it out, or take law = \"maugis-dugdale\"",
                law.name()
            ),
        );
        return None;
    }
    if adhesion.is_text("taper", "auto") {
        return Some(None);
    }
    let taper = adhesion.quantity("taper", Dimension::Length, Allowed::NOT_NEGATIVE)?;
    // The tension falls over the taper, centred on the range: a taper of more than twice the range
    // would start inside the contact.
    if let Some(Range::Length(range)) = range
        && taper > 2.0 * range
    {
        adhesion.conflict(
            "taper",
            format!(
                "{} is more than twice the range of {}; take at most that, or \"auto\"",
                units::format_si(taper, "m"),
                units::format_si(range, "m")
            ),
        );
        return None;
    }
    Some(Some(taper))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shape_of_lennard_jones_is_the_largest_traction() {
        // In units of w/range at the gap u = 1/s - 1; the step limits the maximum to about 1e-9.
        let traction = |s: f64| 8.0 / 3.0 * (s.powi(3) - s.powi(9));
        let largest = (0..=100_000)
            .map(|step| traction(f64::from(step) * 1e-5))
            .fold(0.0, f64::max);
        let shape = LawName::LennardJones.shape();
        assert!((largest / shape - 1.0).abs() < 2e-9, "{largest} {shape}");
    }
}
