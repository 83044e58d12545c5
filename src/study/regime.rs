//! The law of a scene, and where it stands between DMT and JKR and on its grid.

use crate::law::{Exponential, Law, LennardJones, MaugisDugdale};
use crate::scene::{AdhesionScene, LawName, Range, Scene, Treatment};
use crate::surface::Outline;

/// Width of the automatic taper over `sigma0 dx/E*`, what a pixel of the peak tension opens.
///
/// The least at which a straight edge along the grid comes off within 1 % of the closed form; the table of
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
    let range = match (adhesion.range, adhesion.law) {
        (Range::Length(range), _) => range,
        // The shortest ranges at which pull-off is still within some per cent of JKR's.
        (Range::Auto, LawName::MaugisDugdale) => 2f64.sqrt() * resolved,
        (Range::Auto, LawName::Exponential) => resolved,
        (Range::Auto, LawName::LennardJones) => 1.25 * resolved,
    };
    match adhesion.law {
        LawName::MaugisDugdale => {
            let peak_tension = work / range;
            // Summed over a gap that does not feel it, the attraction traps nothing.
            let auto = match adhesion.treatment {
                Treatment::Full => AUTO_TAPER * strongest * peak_tension * pixel / contact_modulus,
                Treatment::Dmt => 0.0,
            };
            Law::MaugisDugdale(MaugisDugdale {
                peak_tension,
                range,
                taper: adhesion.taper.unwrap_or(auto).min(2.0 * range),
            })
        }
        LawName::LennardJones => Law::LennardJones(LennardJones {
            work_of_adhesion: work,
            range,
        }),
        LawName::Exponential => Law::Exponential(Exponential {
            work_of_adhesion: work,
            range,
        }),
    }
}

/// The law of a scene in SI units on a grid whose longer pixel side is `pixel` (m), where the map's
/// largest factor on the tension is `strongest`; the hard wall without adhesion.
pub(super) fn law_of(scene: &Scene, pixel: f64, strongest: f64) -> Law {
    match &scene.adhesion {
        Some(adhesion) => resolve_law(adhesion, pixel, scene.solid.contact_modulus, strongest),
        None => Law::HardWall,
    }
}

/// Where a scene's adhesion stands between DMT and JKR, and on its grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Regime {
    /// Radius of the sphere, else 2 over the rms curvature, m; infinite for a flat surface.
    pub radius: f64,
    /// Tabor number with `eps = 1.0264 w / peak tension`.
    pub tabor: f64,
    /// Pixel over cohesive zone: `sigma0 dx / (E* h0)`, for Lennard-Jones `w dx / (E* eps^2)`.
    pub chi: f64,
    /// Pixels across the cohesive zone of a crack, `(pi/4) E* w / sigma_max^2` over the pixel.
    pub zone_pixels: f64,
}

impl Regime {
    /// The regime in words.
    pub fn name(&self) -> &'static str {
        match self.tabor {
            mu if mu < 0.24 => "DMT: soft and long-ranged, the attraction hardly deforms the solid",
            mu if mu < 5.0 => "between DMT and JKR: the full field or Maugis' theory",
            _ => "JKR: sharp and short-ranged, a crack at the edge of the contact",
        }
    }

    /// The regime of a law on a surface; `None` of one that does not attract.
    pub(super) fn new(law: Law, modulus: f64, outline: &Outline) -> Option<Regime> {
        let pixel = outline.grid.dx().max(outline.grid.dy());
        let strongest = outline.map.map_or(1.0, |map| map.largest);
        law.is_adhesive().then(|| {
            let curvature = outline.moments.rms_curvature();
            let radius = outline.sphere_radius.unwrap_or(2.0 / curvature);
            // A map is judged where it attracts most.
            let work = strongest * law.work_of_adhesion();
            let peak = strongest * law.peak_tension();
            let distance = 1.0264 * work / peak;
            Regime {
                radius,
                tabor: (radius * work * work / (modulus * modulus * distance.powi(3))).cbrt(),
                chi: work * pixel / (modulus * law.range() * law.range()),
                zone_pixels: std::f64::consts::FRAC_PI_4 * modulus * work / (peak * peak) / pixel,
            }
        })
    }
}
