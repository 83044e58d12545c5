//! The plan of a run, made before its heights: law, regime, warnings, cost, memory.

use super::cost::Cost;
use super::hooks::{Effects, Hooks};
use super::memory::Memory;
use super::plausible;
use super::regime::{Regime, law_of};
use crate::backend::{BackendError, dry_run::Place};
use crate::law::Law;
use crate::scene::{Scene, SurfacePart};
use crate::surface::Outline;

/// Pixels that the shortest wave of a surface should have.
pub(crate) const PIXELS_A_WAVE: f64 = 8.0;

/// Advice that a height file takes by another key.
const MORE_POINTS: &str = "take more points";
const MORE_OF_FILE: &str = "take more points (resample of the height file)";

/// A planned scene, without any array of the size of its grid.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The scene.
    pub scene: Scene,
    /// Outline of its surface, known before it is built.
    pub outline: Outline,
    /// The law in SI units; the hard wall without adhesion.
    pub law: Law,
    /// Regime and resolution of the adhesion, where there is any.
    pub regime: Option<Regime>,
    /// Warnings.
    pub warnings: Vec<String>,
    /// The effects that the scene asks for.
    pub(super) effects: Effects,
}

impl Plan {
    /// Puts a scene and the outline of its surface together, with those of a list of effects that the
    /// scene asks for.
    pub(crate) fn with_effects(all: &[&'static dyn Hooks], scene: Scene, outline: Outline) -> Plan {
        let pixel = outline.grid.longer_pixel();
        let strongest = outline.map.map_or(1.0, |map| map.largest);
        let law = law_of(&scene, pixel, strongest);
        let regime = Regime::new(law, scene.solid.contact_modulus, &outline);
        let mut plan = Plan {
            warnings: outline.warnings.clone(),
            effects: Effects::on(all, &scene),
            scene,
            outline,
            law,
            regime,
        };
        let of_effects = plan
            .effects
            .iter()
            .flat_map(|effect| effect.warnings(&plan));
        let of_effects: Vec<String> = of_effects.collect();
        plan.warnings.extend(of_effects);
        plan.warn_of_waves();
        plan.warnings.extend(plausible::warnings(&plan));
        let is_file = |part: &SurfacePart| matches!(part, SurfacePart::File(_));
        if plan.scene.surfaces.iter().any(is_file) {
            for warning in &mut plan.warnings {
                *warning = warning.replace(MORE_POINTS, MORE_OF_FILE);
            }
        }
        plan
    }

    /// Where it runs, as far as is known without a look at the machine.
    pub fn place(&self) -> Place {
        Place::for_scene(&self.scene, &self.outline.grid)
    }

    /// Fields, tables and passes of its solver in a place.
    ///
    /// # Errors
    /// As [`Cost::for_setup`].
    pub fn cost(&self, place: Place) -> Result<Cost, BackendError> {
        Cost::with_effects(&self.effects, &self.scene, self.outline.grid, place)
    }

    /// The memory that a run of it takes in a place.
    ///
    /// # Errors
    /// As [`Cost::for_setup`].
    pub fn memory(&self, place: Place) -> Result<Memory, BackendError> {
        let cost = self.cost(place)?;
        Ok(Memory::new(&self.scene, self.outline.grid, &cost))
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

    /// Pixels across the shortest wave that the scene names: along the longer pixel side where waves run in all directions.
    pub fn pixels_a_wave(&self) -> Option<f64> {
        let grid = self.outline.grid;
        self.scene
            .surfaces
            .iter()
            .filter_map(|part| match part {
                SurfacePart::SelfAffine(rough) => Some(rough.shortest / grid.longer_pixel()),
                SurfacePart::Wavy { wavelength, .. } => {
                    let [x, y] = wavelength;
                    Some((x / grid.dx()).min(y / grid.dy())).filter(|pixels| pixels.is_finite())
                }
                _ => None,
            })
            .reduce(f64::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A wave runs across one side of the pixels, and has as many as lie along it.
    #[test]
    fn waves_have_the_pixels_of_their_own_axis() {
        let pixels = |points: [usize; 2], wavelength: &str| {
            let text = format!(
                "[grid]\npoints = {points:?}\nsize = 1.0\n[solid]\ncontact_modulus = 1.0\n[[surface]]\nkind = \"wavy\"\namplitude = 0.02\nwavelength = {wavelength}\n[loading]\ncontrol = \"pressure\"\npath = [0.01]\n"
            );
            let scene = Scene::parse(&text, "wave.toml", ".".as_ref(), &[]);
            let scene = scene.unwrap_or_else(|errors| panic!("{errors}"));
            let plan = Plan::for_scene(scene).expect("a surface");
            (plan.pixels_a_wave(), plan.warnings.len())
        };
        assert_eq!(pixels([64, 4], "0.5"), (Some(32.0), 0));
        assert_eq!(pixels([64, 4], "[0.5, \"inf\"]"), (Some(32.0), 0));
        assert_eq!(pixels([4, 64], "[\"inf\", 0.5]"), (Some(32.0), 0));
        assert_eq!(pixels([64, 4], "[0.5, 1.0]"), (Some(4.0), 1));
    }
}
