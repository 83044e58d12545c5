//! What is known of a run before its heights are made: law, regime, warnings, cost, memory.

use super::cost::Cost;
use super::memory::Memory;
use super::setup::resolve_law;
use crate::backend::{BackendError, dry_run::Place};
use crate::law::{LEAST_KELVIN_RADIUS, Law};
use crate::scene::{Range, Scene, SurfacePart, Treatment};
use crate::surface::{Outline, SurfaceError};
use crate::units::format_si;

/// Pixels that the shortest wave of a surface should have.
const PIXELS_A_WAVE: f64 = 8.0;

/// Values of chi beyond which the contact edge feels the pixels: of the sharp Maugis-Dugdale law, of the
/// tapered one, and of Lennard-Jones. Up to its own the tapered law lets an edge along the grid go within 3 %
/// (the table of `docs/solver.md`); between 1/3, where its width reaches twice the range, and 0.65 the error swings.
const SHARP_LIMIT: f64 = 0.02;
const TAPERED_LIMIT: f64 = 0.65;
const CORE_LIMIT: f64 = 0.64;
/// Values beyond which pull-off is off by 10 % and more: of the sharp law, and of every other.
const SHARP_LOST: f64 = 0.1;
const LOST: f64 = 1.3;

/// Radius of a contact that lets go, in Maugis' unit `(pi w R^2/K)^(1/3)`: JKR's `1.5^(1/3)`.
const PULL_OFF_RADIUS: f64 = 1.145;
/// Its width in pixels below which the pixels of its edge are 5 % and 10 % of pull-off, measured at Tabor number 1.
const FEW_PIXELS: f64 = 10.0;
const LOST_PIXELS: f64 = 6.0;
/// Tabor number below which a contact closes to a point before it lets go, so that it has no width.
const LEAST_TABOR: f64 = 0.8;

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

/// A scene that has been looked at, with nothing of the size of its grid in memory.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The scene.
    pub scene: Scene,
    /// What is known of its surface.
    pub outline: Outline,
    /// The law in SI units; the hard wall without adhesion.
    pub law: Law,
    /// Whether attraction is summed over the gap of the solution without it.
    pub dmt: bool,
    /// Regime and resolution of the adhesion, where there is any.
    pub regime: Option<Regime>,
    /// What the user should know.
    pub warnings: Vec<String>,
}

impl Plan {
    /// Looks at a scene. Only a height file makes it build heights.
    ///
    /// # Errors
    /// A surface that cannot be built.
    pub fn of(scene: Scene) -> Result<Plan, SurfaceError> {
        let outline = Outline::of(&scene)?;
        Ok(Plan::new(scene, outline))
    }

    /// Puts a scene and the outline of its surface together.
    pub fn new(scene: Scene, outline: Outline) -> Plan {
        let modulus = scene.solid.contact_modulus;
        let pixel = outline.grid.dx().max(outline.grid.dy());
        let strongest = outline.map.map_or(1.0, |map| map.largest);
        let law = match &scene.adhesion {
            Some(adhesion) => resolve_law(adhesion, pixel, modulus, strongest),
            None => Law::HardWall,
        };
        let dmt = scene
            .adhesion
            .as_ref()
            .is_some_and(|adhesion| adhesion.treatment == Treatment::Dmt);
        let regime = law.is_adhesive().then(|| {
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
        });
        let mut plan = Plan {
            warnings: outline.warnings.clone(),
            scene,
            outline,
            law,
            dmt,
            regime,
        };
        plan.warn_of_dry_air();
        plan.warn_of_pixels();
        plan.warn_of_waves();
        plan
    }

    /// What its solver holds and does in a place.
    ///
    /// # Errors
    /// As [`Cost::of_scene`].
    pub fn cost(&self, place: Place) -> Result<Cost, BackendError> {
        Cost::of_scene(&self.scene, self.outline.grid, place)
    }

    /// The memory that a run of it takes in a place.
    ///
    /// # Errors
    /// As [`Cost::of_scene`].
    pub fn memory(&self, place: Place) -> Result<Memory, BackendError> {
        let cost = self.cost(place)?;
        Ok(Memory::of(&self.scene, self.outline.grid, &cost))
    }

    /// Warns by chi, with the errors that were measured on spheres and on straight edges.
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
        let beyond = "10 % cannot be reached on this grid";
        let text = match self.law {
            Law::MaugisDugdale(law) if law.taper == 0.0 && chi > SHARP_LOST => Some(format!(
                "{beyond}: {measured}: the sharp law traps the contact edge, pull-off comes out about 14 % too high at 0.16 and 44 % at 0.65; leave taper at \"auto\", or {remedy}"
            )),
            Law::MaugisDugdale(law) if law.taper == 0.0 && chi > SHARP_LIMIT => Some(format!(
                "{measured}: beyond {SHARP_LIMIT} the sharp law traps the contact edge, pull-off {} too high; leave taper at \"auto\", or {remedy}",
                if chi >= 0.04 {
                    "3 to 10 %"
                } else {
                    "about 2 %"
                }
            )),
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
            Law::LennardJones(_) if chi > CORE_LIMIT => Some(format!(
                "{measured}: beyond {CORE_LIMIT} the contact edge is trapped between pixels and pull-off comes out too high, by more than 4 %; {remedy}"
            )),
            _ => None,
        };
        self.warnings.extend(text);
        self.warn_of_small_contact(regime);
    }

    /// Warns of a sphere whose contact is only a few pixels wide when it lets go, whatever its zone.
    fn warn_of_small_contact(&mut self, regime: Regime) {
        let Some(radius) = self.outline.sphere_radius else {
            return;
        };
        let pixel = self.outline.grid.dx().max(self.outline.grid.dy());
        let stiffness = 4.0 / 3.0 * self.scene.solid.contact_modulus;
        // Maugis' unit of radius, in which a contact parts at 1.14 (JKR) to 0 (DMT).
        let unit = (std::f64::consts::PI * self.law.work_of_adhesion() * radius * radius
            / stiffness)
            .cbrt();
        let pixels = 2.0 * PULL_OFF_RADIUS * unit / pixel;
        if pixels >= FEW_PIXELS || regime.tabor < LEAST_TABOR {
            return;
        }
        let strength = match pixels < LOST_PIXELS {
            true => "10 % cannot be reached on this grid: ",
            false => "",
        };
        self.warnings.push(format!(
            "{strength}the contact at pull-off is about {pixels:.1} pixels wide: pull-off is about 5 % off at 10 pixels and 12 % at 5; take more points"
        ));
    }

    fn warn_of_dry_air(&mut self) {
        if let Some(capillary) = &self.scene.capillary
            && !capillary.bridges()
        {
            self.warnings.push(format!(
                "capillary.humidity {} is below {:.3}, where the Kelvin radius is {}: no liquid bridges the gap, and nothing attracts",
                capillary.humidity,
                capillary.least_humidity(),
                format_si(LEAST_KELVIN_RADIUS, "m"),
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
        let pixel = self.outline.grid.dx().max(self.outline.grid.dy());
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
