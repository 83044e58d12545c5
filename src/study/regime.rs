//! The law of a scene, its regime between DMT and JKR, and its resolution by the grid.

use crate::law::Law;
use crate::scene::{AdhesionScene, Range, Scene, Treatment};
use crate::surface::{Outline, Top};

/// Width of the automatic taper over `sigma0 dx/E*`, the opening of a pixel under the peak tension.
///
/// The least at which the pull-off of a straight edge along the grid is within 1 % of the closed form; table of
/// `docs/solver.md`.
pub const AUTO_TAPER: f64 = 6.0;

/// The law of a scene on pixels of side `pixel` (m), with what `auto` stands for where the map's
/// largest factor on the tension is `strongest`.
pub fn resolve_law(
    adhesion: &AdhesionScene,
    pixel: f64,
    contact_modulus: f64,
    strongest: f64,
) -> Law {
    let work = adhesion.work_of_adhesion;
    let resolved = (strongest * work * pixel / contact_modulus).sqrt();
    let range = match adhesion.range {
        Range::Length(range) => range,
        Range::Auto => {
            let is_sharp = adhesion.taper == Some(0.0) && adhesion.treatment == Treatment::Full;
            adhesion.law.shortest_range(is_sharp) * resolved
        }
    };
    // Attraction that does not deform the contact cannot pin its edge.
    let auto = match adhesion.treatment {
        Treatment::Full => AUTO_TAPER * strongest * (work / range) * pixel / contact_modulus,
        Treatment::Dmt => 0.0,
    };
    let taper = adhesion.taper.unwrap_or(auto).min(2.0 * range);
    adhesion.law.law(work, range, taper)
}

/// The law of a scene in SI units on a grid whose longer pixel side is `pixel` (m), where the map's
/// largest factor on the tension is `strongest`; the hard wall without adhesion.
pub(super) fn law_of(scene: &Scene, pixel: f64, strongest: f64) -> Law {
    match &scene.adhesion {
        Some(adhesion) => resolve_law(adhesion, pixel, scene.solid.contact_modulus, strongest),
        None => Law::HardWall,
    }
}

/// The regime of a scene's adhesion between DMT and JKR, and its resolution by the grid.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Regime {
    /// Radius of the sphere or of the crests of waves, else 2 over the rms curvature, m; infinite for a flat surface and a cone.
    pub radius: f64,
    /// Tabor number with `eps = 1.0264 w / peak tension`; `None` where no curvature is meant: of flat surfaces, of
    /// flat pillars and punches, and of cones.
    pub tabor: Option<f64>,
    /// chi, grid spacing over the length of the cohesive zone: `sigma0 dx / (E* h0)`, for Lennard-Jones `w dx / (E* eps^2)`.
    pub chi: f64,
    /// Pixels across the cohesive zone of a crack, `(pi/4) E* w / sigma_max^2` over the pixel.
    pub zone_pixels: f64,
}

impl Regime {
    /// The regime in words.
    pub fn name(&self) -> &'static str {
        match self.tabor.unwrap_or(f64::INFINITY) {
            mu if mu < 0.24 => "DMT: the attraction hardly deforms the stiff solid",
            mu if mu < 5.0 => "between DMT and JKR: the full field or Maugis' theory",
            _ => "JKR: the short-ranged attraction acts like a crack at the contact edge",
        }
    }

    /// The regime of a law on a surface; `None` of one that does not attract.
    pub(super) fn new(law: Law, modulus: f64, outline: &Outline) -> Option<Regime> {
        let pixel = outline.grid.longer_pixel();
        let strongest = outline.map.map_or(1.0, |map| map.largest);
        law.is_adhesive().then(|| {
            let radius = match outline.top {
                Top::Sphere(radius) | Top::Crests(radius) | Top::Ridges { radius, .. } => radius,
                Top::Cone { .. } => f64::INFINITY,
                Top::Unknown => 2.0 / outline.moments.rms_curvature(),
            };
            // A map is judged where it attracts most.
            let work = strongest * law.work_of_adhesion();
            let peak = strongest * law.peak_tension();
            let distance = 1.0264 * work / peak;
            Regime {
                radius,
                tabor: (radius.is_finite() && !outline.has_flats).then(|| {
                    (radius * work * work / (modulus * modulus * distance.powi(3))).cbrt()
                }),
                chi: work * pixel / (modulus * law.range() * law.range()),
                zone_pixels: std::f64::consts::FRAC_PI_4 * modulus * work / (peak * peak) / pixel,
            }
        })
    }
}
