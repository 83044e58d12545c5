//! The warning of stiff bodies that attract over a few pixels where they touch, however wide the cohesive zone of a crack is.

use std::f64::consts::PI;

use crate::grid::Grid;
use crate::law::Law;
use crate::study::{Plan, Regime};
use crate::surface::Top;
use crate::surface::shapes::ApexPosition;
use crate::units::format_si;

/// Tabor number below which a contact shrinks to a point before pull-off, so that it has no width.
pub(super) const LEAST_TABOR: f64 = 0.8;

/// What few pixels across the attracted part change pull-off by, as measured (`docs/solver.md`).
#[derive(Clone, Copy)]
struct Limits {
    /// Fewer pixels are warned of,
    few: f64,
    /// and fewer cannot bring pull-off within 10 %.
    lost: f64,
    /// The errors.
    errors: &'static str,
}

/// Of a sphere, at five places between the pixels and Tabor numbers of 0.03 to 0.7: of a law that ends suddenly, and of one that fades.
const SPHERE: [Limits; 2] = [
    Limits {
        few: 10.0,
        lost: 8.0,
        errors: "5 % off at 10 pixels, 10 % at 8, 20 % at 5 and several times too high below 2",
    },
    Limits {
        few: 6.0,
        lost: 5.0,
        errors: "6 % off at 6 pixels, 13 % at 4 and several times too high below 2",
    },
];
/// Of round crests, which lie on points of the grid.
const CRESTS: [Limits; 2] = [
    SPHERE[0],
    Limits {
        few: 4.0,
        lost: 2.5,
        errors: "7 % off at 3 pixels and 16 % at 2",
    },
];
/// Of straight crests, whose pixels come and go in whole lines.
const RIDGES: [Limits; 2] = [
    Limits {
        few: 20.0,
        lost: 10.0,
        errors: "5 % off at 20 pixels, 10 % at 10 and 25 % at 4",
    },
    Limits {
        few: 3.0,
        lost: 2.0,
        errors: "4 % off at 3 pixels and 10 % at 2",
    },
];
/// Of cones whose apex lies between points: of a law that ends suddenly, of one that fades, and of one without a wall,
const BETWEEN: [Limits; 3] = [
    Limits {
        few: 60.0,
        lost: 30.0,
        errors: "11 % too high at 30 pixels, 20 % at 15, 45 % at 7 and twice as high at 3",
    },
    Limits {
        few: 30.0,
        lost: 15.0,
        errors: "10 % too high at 15 pixels, 15 % at 10, 22 % at 7 and 60 % at 3",
    },
    Limits {
        few: 7.0,
        lost: 4.5,
        errors: "3 % too high at 7 pixels, 7 % at 5 and 22 % at 3",
    },
];
/// and of those whose apex lies on one.
const ON_A_POINT: [Limits; 3] = [
    Limits {
        few: 10.0,
        lost: 8.0,
        errors: "4 % off at 10 pixels, 10 % at 8 and 20 % at 6",
    },
    Limits {
        few: 2.0,
        lost: 1.0,
        errors: "3 % off at 2 pixels",
    },
    Limits {
        few: 10.0,
        lost: 7.0,
        errors: "4 % too low at 10 pixels, 9 % at 7, 14 % at 5 and 20 % at 3",
    },
];
/// Of the summits of a rough surface.
const SUMMITS: Limits = Limits {
    few: 5.0,
    lost: 2.0,
    errors: "14 % off at 5 pixels, 49 % at 4, 53 % at 3, and 2 to 8 times too high at 1",
};

/// Width of the disc about the highest point over that of a summit of the mean curvature, below which that point stands out, as a particle on
/// a map does: of 720 Gaussian surfaces none had less than 0.43.
const STANDS_OUT: f64 = 0.4;

/// Distance in pixels of an apex from a point up to which pull-off is that of one on it, within 2 %.
const NEAR_A_POINT: f64 = 0.05;
/// Opening of the flanks of a cone by its attraction, `w tan(half_angle) / E*`, over the range from which on the disc is wider than that
/// of the rigid cone.
const SOFT_CONE: f64 = 0.05;

impl Limits {
    /// The warning of so many pixels across what is attracted.
    fn warning(&self, pixels: f64, attracted: &str, remedy: &str) -> Option<String> {
        if pixels >= self.few {
            return None;
        }
        let beyond = match pixels < self.lost {
            true => "10 % cannot be reached on this grid: ",
            false => "",
        };
        Some(format!(
            "{beyond}{attracted}: pull-off is up to {}; {remedy}",
            self.errors
        ))
    }
}

/// The warning of a plan whose surfaces touch in a few attracted pixels.
pub(super) fn warning(plan: &Plan, regime: Regime) -> Option<String> {
    let (top, grid, range) = (plan.outline.top, plan.outline.grid, plan.law.range());
    if let Top::Cone { half_angle, centre } = top {
        return warning_of_cone(plan, half_angle, centre);
    }
    if let (Top::Unknown, Some(tabor)) = (top, regime.tabor)
        && let Some(warning) = warning_of_particle(plan, regime.radius, tabor)
    {
        return Some(warning);
    }
    regime.tabor.filter(|tabor| *tabor < LEAST_TABOR)?;
    // Waves lower than the range attract everywhere: twice the amplitude, of the rms height.
    let depth = plan.outline.moments.rms_height();
    let [pixel, depth] = match top {
        Top::Ridges { axis: 0, .. } => [grid.dx(), 8_f64.sqrt() * depth],
        Top::Ridges { .. } => [grid.dy(), 8_f64.sqrt() * depth],
        Top::Crests(_) => [grid.longer_pixel(), 4.0 * depth],
        _ => [grid.longer_pixel(), f64::INFINITY],
    };
    if depth <= range {
        return None;
    }
    let pixels = 2.0 * (2.0 * regime.radius * range).sqrt() / pixel;
    let fades = usize::from(!matches!(plan.law, Law::MaugisDugdale(_)));
    let (what, part, limits) = match top {
        Top::Ridges { .. } => ("crest", "strip", &RIDGES[fades]),
        Top::Crests(_) => ("crest", "disc", &CRESTS[fades]),
        Top::Sphere(_) => ("sphere", "disc", &SPHERE[fades]),
        _ => ("summit", "disc", &SUMMITS),
    };
    let attracted = format!(
        "a stiff {what} is attracted over a {part} about {pixels:.1} pixels wide where it touches (2 sqrt(2 R range))"
    );
    limits.warning(pixels, &attracted, "take more points")
}

/// The same of a highest point that is far sharper than summits of the mean curvature, of which `radius` and `tabor` are.
fn warning_of_particle(plan: &Plan, radius: f64, tabor: f64) -> Option<String> {
    let (pixel, range) = (plan.outline.grid.longer_pixel(), plan.law.range());
    let highest = &plan.outline.highest;
    let points = highest.iter().filter(|depth| **depth < range).count();
    if points == 0 || points == highest.len() {
        return None;
    }
    let pixels = (4.0 * points as f64 / PI).sqrt();
    let of_mean = 2.0 * (2.0 * radius * range).sqrt() / pixel;
    let own_radius = (pixels * pixel).powi(2) / (8.0 * range);
    let own_tabor = tabor * (own_radius / radius).cbrt();
    if pixels >= STANDS_OUT * of_mean || own_tabor >= LEAST_TABOR {
        return None;
    }
    let attracted = format!(
        "the highest point stands out, as a particle does: where it touches, {points} points are attracted, a disc about {pixels:.1} pixels wide, {of_mean:.1} at a summit of the mean curvature"
    );
    SUMMITS.warning(
        pixels,
        &attracted,
        "take more points, or leave the particle out",
    )
}

/// The same of a cone, whose highest point on the grid lies below its apex where that is between the points.
fn warning_of_cone(plan: &Plan, half_angle: f64, centre: Option<[f64; 2]>) -> Option<String> {
    let (grid, range) = (plan.outline.grid, plan.law.range());
    let slope = half_angle.tan();
    let opening = plan.law.work_of_adhesion() * slope / plan.scene.solid.contact_modulus;
    if opening > SOFT_CONE * range {
        return None;
    }
    let pixels = 2.0 * range * slope / grid.longer_pixel();
    let law = match plan.law {
        Law::MaugisDugdale(_) => 0,
        law if law.has_wall() => 1,
        _ => 2,
    };
    let place = ApexPosition {
        centre,
        boundary: plan.scene.grid.boundary,
        first_row: 0,
    };
    let nearest = nearest_point(place, &grid);
    let (limits, lies, remedy) = match nearest {
        None => (&ON_A_POINT[law], "", "take more points".to_owned()),
        Some([x, y]) => (
            &BETWEEN[law],
            ", with its apex between points of the grid",
            format!(
                "put it on one, as by centre = [\"{}\", \"{}\"], or take more points",
                format_si(x, "m"),
                format_si(y, "m")
            ),
        ),
    };
    let attracted = format!(
        "a stiff cone{lies} is attracted over a disc about {pixels:.1} pixels wide where it touches (2 range tan(half_angle))"
    );
    limits.warning(pixels, &attracted, &remedy)
}

/// The point of the grid nearest to an apex, m; `None` where that is on it.
fn nearest_point(place: ApexPosition, grid: &Grid) -> Option<[f64; 2]> {
    let [x, y] = place.centre_on(grid);
    let axes = [(x, grid.dx()), (y, grid.dy())];
    let is_on =
        |(at, pixel): &(f64, f64)| (at / pixel - (at / pixel).round()).abs() <= NEAR_A_POINT;
    let nearest = axes.map(|(at, pixel)| (at / pixel).round() * pixel);
    (!axes.iter().all(is_on)).then_some(nearest)
}
