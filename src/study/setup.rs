//! From a scene and its surface to the problem that is solved: law, regime, warnings.

use crate::law::{Exponential, Law, LennardJones, MaugisDugdale};
use crate::scene::{AdhesionScene, Boundary, LawName, Range, Scene, Treatment};
use crate::solver::Problem;
use crate::surface::{Surface, statistics::Statistics};
use crate::units::format_si;

/// Pixels that the shortest wave of a surface should have.
const PIXELS_A_WAVE: f64 = 8.0;

/// Everything that the steps of a path share.
#[derive(Clone, Debug)]
pub struct Setup {
    /// The scene.
    pub scene: Scene,
    /// Its surface.
    pub surface: Surface,
    /// Statistics of the surface.
    pub statistics: Statistics,
    /// The law in SI units; the hard wall without adhesion.
    pub law: Law,
    /// The reduced problem; without the law where the attraction is summed afterwards.
    pub problem: Problem,
    /// Whether attraction is summed over the gap of the solution without it.
    pub dmt: bool,
    /// Regime and resolution of the adhesion, where there is any.
    pub regime: Option<Regime>,
    /// What the user should know.
    pub warnings: Vec<String>,
    /// Real two-dimensional transforms that the statistics took.
    pub transforms: f64,
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
}

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
                Treatment::Full => 2.0 * strongest * peak_tension * pixel / contact_modulus,
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

/// The largest factor of a map; 1 without one.
fn strongest(map: Option<&[f64]>) -> f64 {
    map.map_or(1.0, |map| map.iter().copied().fold(0.0, f64::max))
}

impl Setup {
    /// Puts a scene and its surface together.
    pub fn new(scene: Scene, surface: Surface) -> Self {
        let grid = surface.grid;
        let statistics = Statistics::of(&grid, &surface.heights, scene.grid.boundary);
        let modulus = scene.solid.contact_modulus;
        let pixel = grid.dx().max(grid.dy());
        let strongest = strongest(surface.adhesion_map.as_deref());
        let law = match &scene.adhesion {
            Some(adhesion) => resolve_law(adhesion, pixel, modulus, strongest),
            None => Law::HardWall,
        };
        let dmt = scene
            .adhesion
            .as_ref()
            .is_some_and(|adhesion| adhesion.treatment == Treatment::Dmt);
        let curvature = statistics.moments.rms_curvature();
        let regime = law.is_adhesive().then(|| {
            let radius = surface.sphere_radius.unwrap_or(2.0 / curvature);
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
        });
        let transforms = match scene.grid.boundary {
            Boundary::Periodic => 1.0,
            Boundary::Free => 0.0,
        };
        let problem = Problem::new(
            grid,
            scene.grid.boundary,
            modulus,
            &surface.heights,
            statistics.moments.rms_slope(),
            if dmt { Law::HardWall } else { law },
        );
        let problem = match &surface.adhesion_map {
            Some(factor) if !dmt => problem.patterned(factor.clone()),
            _ => problem,
        };
        let problem = match scene.solid.layer {
            Some(layer) => problem.on_layer(layer),
            None => problem,
        };
        let mut setup = Setup {
            warnings: surface.warnings.clone(),
            scene,
            surface,
            statistics,
            law,
            problem,
            dmt,
            regime,
            transforms,
        };
        setup.warn_of_dry_air();
        setup.warn_of_pixels();
        setup.warn_of_waves();
        setup
    }

    /// The law that is solved for, SI; the hard wall where the attraction is summed afterwards.
    pub fn solved_law(&self) -> Law {
        if self.dmt { Law::HardWall } else { self.law }
    }

    /// Factor on the law's tension at a grid point.
    #[inline]
    pub fn law_factor(&self, point: usize) -> f64 {
        match &self.surface.adhesion_map {
            Some(map) => map[point],
            None => 1.0,
        }
    }

    /// The largest factor on the law's tension.
    pub fn largest_law_factor(&self) -> f64 {
        strongest(self.surface.adhesion_map.as_deref())
    }

    /// Warns by chi, with the errors that were measured on spheres.
    fn warn_of_pixels(&mut self) {
        let (Some(regime), Some(adhesion)) = (self.regime, &self.scene.adhesion) else {
            return;
        };
        if adhesion.range == Range::Auto {
            self.warnings.push(format!(
                "range = \"auto\" stands for {}: the shortest that this grid resolves at this work of adhesion",
                format_si(self.law.range(), "m")
            ));
        }
        if self.dmt {
            return;
        }
        let chi = regime.chi;
        let measured = format!(
            "a pixel is {chi:.2} of the cohesive zone (chi = w dx/(E* range^2)), {:.2} pixels across it",
            regime.zone_pixels
        );
        let remedy = "take more points or a longer range (range = \"auto\" finds the shortest that the grid resolves)";
        let text = match self.law {
            Law::MaugisDugdale(law) if law.taper == 0.0 && chi > 0.02 => Some(format!(
                "{measured}: the sharp law traps the contact edge, pull-off {} too high; leave taper at \"auto\", or {remedy}",
                if chi > 0.1 {
                    "10 % or more"
                } else if chi >= 0.04 {
                    "3 to 10 %"
                } else {
                    "about 2 %"
                }
            )),
            Law::MaugisDugdale(law) if law.taper > 0.0 && chi > 1.3 => Some(format!(
                "{measured}: beyond 1.3 the taper no longer frees the contact edge, pull-off is about 30 % too high at 2.6 and 160 % at 5; {remedy}"
            )),
            Law::MaugisDugdale(law) if law.taper > 0.0 && chi > 0.65 => Some(format!(
                "{measured}: expect pull-off within 2 %, the energy of a loop up to 40 % low; {remedy}"
            )),
            Law::Exponential(_) if chi > 1.3 => Some(format!(
                "{measured}: beyond 1.3 the contact edge is trapped between pixels, pull-off is about 40 % too high at 2.6 and 160 % at 5; {remedy}"
            )),
            Law::LennardJones(_) if chi > 0.64 => Some(format!(
                "{measured}: beyond 0.64 the contact edge is trapped between pixels and pull-off comes out too high, by more than 4 %; {remedy}"
            )),
            _ => None,
        };
        self.warnings.extend(text);
    }

    fn warn_of_dry_air(&mut self) {
        if let Some(capillary) = &self.scene.capillary
            && !capillary.bridges()
        {
            self.warnings.push(format!(
                "capillary.humidity {} is below {:.3}, where the Kelvin radius is {}: no liquid bridges the gap, and nothing attracts",
                capillary.humidity,
                capillary.least_humidity(),
                format_si(crate::law::LEAST_KELVIN_RADIUS, "m"),
            ));
        }
    }

    fn warn_of_waves(&mut self) {
        if let Some(pixels) = self.pixels_a_wave()
            && pixels < PIXELS_A_WAVE * (1.0 - 1e-9)
        {
            self.warnings.push(format!(
                "the shortest wave of the surface has {pixels:.1} pixels; below {PIXELS_A_WAVE} the contact area is several per cent off: take more points"
            ));
        }
    }

    /// Pixels across the shortest wave that the scene names, along the longer pixel side.
    pub fn pixels_a_wave(&self) -> Option<f64> {
        use crate::scene::SurfacePart;
        let pixel = self.surface.grid.dx().max(self.surface.grid.dy());
        self.scene
            .surfaces
            .iter()
            .filter_map(|part| match part {
                SurfacePart::SelfAffine(rough) => Some(rough.shortest),
                SurfacePart::Wavy { wavelength, .. } => {
                    Some(wavelength[0].min(wavelength[1])).filter(|length| length.is_finite())
                }
                _ => None,
            })
            .map(|length| length / pixel)
            .reduce(f64::min)
    }
}
