//! A setting: grid, precision, tolerance, taper, steps and model.

use super::steps::{PathVariant, Steps};
use crate::grid::Grid;
use crate::law::Law;
use crate::scene::{
    AdhesionMap, AdhesionScene, BackendName, LawName, Precision, Range, Scene, Treatment,
};
use crate::study::resolve_law;

/// How the adhesion is modelled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Model {
    /// The scene's own law, in equilibrium with the contact; the hard wall without adhesion.
    Full,
    /// The shortest range that the grid resolves, at the same work of adhesion.
    AutoRange,
    /// DMT: attraction summed over the gap of the solution without adhesion.
    Dmt,
    /// No adhesion.
    NoAdhesion,
}

/// The taper of Maugis-Dugdale.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Taper {
    /// The scene's own taper.
    AsGiven,
    /// No taper.
    Sharp,
    /// Half the `auto` taper: closer to the range, but with more trapping of the edge by pixels.
    Half,
}

/// What a setting changes of the scene's own setting on the same grid; determines the colour in the
/// picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Varied {
    /// Nothing.
    Nothing,
    /// The tolerance.
    Tolerance,
    /// Precision or backend.
    Precision,
    /// The taper.
    Taper,
    /// The number of steps.
    Steps,
    /// The time tolerance of `steps = "auto"`.
    TimeTolerance,
    /// The range of the law.
    Range,
    /// The treatment of the attraction.
    Dmt,
    /// Adhesion is left out.
    NoAdhesion,
}

impl Varied {
    /// Its name in tables and legends.
    pub fn name(self) -> &'static str {
        match self {
            Varied::Nothing => "grid",
            Varied::Tolerance => "tolerance",
            Varied::Precision => "precision",
            Varied::Taper => "taper",
            Varied::Steps => "steps",
            Varied::TimeTolerance => "time tolerance",
            Varied::Range => "range",
            Varied::Dmt => "dmt",
            Varied::NoAdhesion => "no adhesion",
        }
    }
}

/// A setting.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// Points along x and y.
    pub points: [usize; 2],
    /// Backend.
    pub backend: BackendName,
    /// Precision.
    pub precision: Precision,
    /// Tolerance of the residual.
    pub tolerance: f64,
    /// Steps of the path.
    pub steps: Steps,
    /// Model of the adhesion.
    pub model: Model,
    /// Taper of the Maugis-Dugdale law.
    pub taper: Taper,
}

impl Setting {
    /// The scene's own setting in double precision on a grid.
    pub fn own(scene: &Scene, points: [usize; 2]) -> Setting {
        Setting {
            points,
            backend: BackendName::Cpu,
            precision: Precision::Double,
            tolerance: scene.solver.tolerance,
            steps: Steps::AsGiven,
            model: Model::Full,
            taper: Taper::AsGiven,
        }
    }

    /// What differs from [`Setting::own`] on the same grid.
    pub fn varied(&self, scene: &Scene) -> Varied {
        let elsewhere = self.backend != BackendName::Cpu || self.precision != Precision::Double;
        match (self.model, self.taper, self.steps) {
            (Model::NoAdhesion, ..) => Varied::NoAdhesion,
            (Model::Dmt, ..) => Varied::Dmt,
            (Model::AutoRange, ..) => Varied::Range,
            (_, Taper::Sharp | Taper::Half, _) => Varied::Taper,
            (.., Steps::Auto(_)) => Varied::TimeTolerance,
            (.., Steps::Halved | Steps::Doubled | Steps::Equal | Steps::Finest) => Varied::Steps,
            _ if elsewhere => Varied::Precision,
            _ if self.tolerance != scene.solver.tolerance => Varied::Tolerance,
            _ => Varied::Nothing,
        }
    }

    /// The scene and the path of this setting, without heights.
    pub fn apply(&self, scene: &Scene) -> (Scene, PathVariant) {
        let walk = self.steps.path(scene);
        let mut changed = scene.clone();
        changed.grid.points = Some(self.points);
        changed.solver.backend = self.backend;
        changed.solver.precision = self.precision;
        changed.solver.tolerance = self.tolerance;
        changed.loading = walk.loading.clone();
        changed.adhesion = match self.model {
            Model::NoAdhesion => None,
            _ => scene.adhesion.clone().map(|law| self.law(law, &changed)),
        };
        if changed.adhesion.is_none() {
            // The liquid is a law.
            changed.capillary = None;
        }
        (changed, walk)
    }

    fn law(&self, law: AdhesionScene, scene: &Scene) -> AdhesionScene {
        let range = match self.model {
            Model::AutoRange => Range::Auto,
            _ => law.range,
        };
        let taper = match (self.taper, range) {
            (Taper::AsGiven, Range::Auto) => None,
            (Taper::AsGiven, Range::Length(_)) => law.taper,
            (Taper::Sharp, _) => Some(0.0),
            (Taper::Half, Range::Length(_)) => {
                let pixel = scene.grid.size.map_or(0.0, |size| {
                    let grid = Grid::new(self.points, size);
                    grid.longer_pixel()
                });
                let auto = AdhesionScene {
                    taper: None,
                    ..law.clone()
                };
                let strongest = strongest(&auto);
                match resolve_law(&auto, pixel, scene.solid.contact_modulus, strongest) {
                    Law::MaugisDugdale(law) => Some(0.5 * law.taper),
                    _ => None,
                }
            }
            (Taper::Half, Range::Auto) => None,
        };
        AdhesionScene {
            range,
            taper,
            treatment: match self.model {
                Model::Dmt => Treatment::Dmt,
                _ => Treatment::Full,
            },
            ..law
        }
    }

    /// The value of the column `treatment`.
    pub fn treatment(&self, scene: &Scene) -> &'static str {
        match (self.model, &scene.adhesion) {
            (Model::NoAdhesion, _) | (_, None) => "none",
            (Model::Dmt, _) => Treatment::Dmt.name(),
            _ => Treatment::Full.name(),
        }
    }

    /// As in `256 x 256, double, 1e-6, sharp`.
    pub fn words(&self, scene: &Scene) -> String {
        let mut words = format!("{} x {}", self.points[0], self.points[1]);
        if self.backend != BackendName::Cpu {
            words.push_str(&format!(", {}", self.backend.name()));
        }
        words.push_str(&format!(
            ", {}, {:e}",
            self.precision.name(),
            self.tolerance
        ));
        words.push_str(&self.steps.words());
        words.push_str(match self.taper {
            Taper::AsGiven => "",
            Taper::Sharp => ", no taper",
            Taper::Half => ", half the taper",
        });
        words.push_str(match self.model {
            Model::Full => "",
            Model::AutoRange => ", range auto",
            Model::Dmt => ", dmt",
            Model::NoAdhesion if scene.adhesion.is_some() => ", no adhesion",
            Model::NoAdhesion => "",
        });
        words
    }
}

/// The largest factor on the tension that the pattern of a study has; 1 without one.
pub(super) fn strongest(adhesion: &AdhesionScene) -> f64 {
    match &adhesion.map {
        Some(AdhesionMap::Pattern { low, high, .. }) => low.max(*high),
        _ => 1.0,
    }
}

/// Relative difference up to which two ranges are equal.
const SAME_RANGE: f64 = 1e-9;

/// Whether `range = "auto"` is longer than the scene's range on this grid.
fn is_longer(scene: &Scene, adhesion: &AdhesionScene, points: [usize; 2]) -> bool {
    let (Range::Length(given), Some(size)) = (adhesion.range, scene.grid.size) else {
        return false;
    };
    let grid = Grid::new(points, size);
    let auto = AdhesionScene {
        range: Range::Auto,
        taper: None,
        ..adhesion.clone()
    };
    let pixel = grid.longer_pixel();
    let modulus = scene.solid.contact_modulus;
    let asked = resolve_law(&auto, pixel, modulus, strongest(adhesion)).range();
    asked > given * (1.0 + SAME_RANGE)
}

/// Tolerances tried in addition to the scene's own.
const TOLERANCES: [f64; 3] = [1e-2, 1e-4, 1e-8];

/// Every other setting on a grid; `arithmetics` are the available backends and precisions.
pub fn others(
    scene: &Scene,
    points: [usize; 2],
    arithmetics: &[(BackendName, Precision)],
) -> Vec<Setting> {
    let own = Setting::own(scene, points);
    let mut found: Vec<Setting> = TOLERANCES
        .iter()
        .filter(|tolerance| **tolerance != own.tolerance)
        .map(|tolerance| Setting {
            tolerance: *tolerance,
            ..own
        })
        .collect();
    for (backend, precision) in arithmetics {
        if (*backend, *precision) == (own.backend, own.precision) {
            continue;
        }
        let tolerance = match precision {
            Precision::Single => own.tolerance.max(Precision::SINGLE_FLOOR),
            _ => own.tolerance,
        };
        found.push(Setting {
            backend: *backend,
            precision: *precision,
            tolerance,
            ..own
        });
    }
    let steps = Steps::others(scene).into_iter();
    found.extend(steps.map(|steps| Setting { steps, ..own }));
    let Some(adhesion) = &scene.adhesion else {
        return found;
    };
    let tapers: &[Taper] = match (adhesion.law, adhesion.range, adhesion.taper) {
        (LawName::MaugisDugdale, Range::Length(_), None) => &[Taper::Sharp, Taper::Half],
        (LawName::MaugisDugdale, _, None) => &[Taper::Sharp],
        _ => &[],
    };
    found.extend(tapers.iter().map(|taper| Setting {
        taper: *taper,
        ..own
    }));
    let mut models = vec![Model::NoAdhesion];
    // What a scene cannot combine with the DMT treatment.
    let excludes_dmt = !scene.solid.relaxation.is_empty()
        || scene.solid.hardness.is_some()
        || scene.loading.spring.is_some()
        || adhesion.rate.is_some();
    if !excludes_dmt {
        models.push(Model::Dmt);
    }
    if is_longer(scene, adhesion, points) {
        models.push(Model::AutoRange);
    }
    found.extend(models.into_iter().map(|model| Setting { model, ..own }));
    found
}

#[cfg(test)]
mod tests {
    use super::super::closed_form::closed_form;
    use super::*;

    /// A sphere in the range of Maugis' theory, with lines more in each of its tables.
    fn sphere(solid: &str, adhesion: &str, loading: &str) -> Scene {
        let text = format!(
            r#"
            [grid]
            points = 16
            size = 1.0
            boundary = "free"
            [solid]
            contact_modulus = 1.0
            {solid}
            [[surface]]
            kind = "sphere"
            radius = 1.0
            centre = [0.5, 0.5]
            [adhesion]
            law = "maugis-dugdale"
            work_of_adhesion = 0.01
            range = 0.1
            {adhesion}
            [loading]
            control = "approach"
            start = 0.0
            {loading}
            [[loading.ramp]]
            to = 0.1
            steps = 2
            duration = 1
            "#
        );
        let parsed = Scene::parse(&text, "test.toml", std::path::Path::new("."), &[]);
        parsed.unwrap_or_else(|errors| panic!("{errors}"))
    }

    /// Maugis' sphere neither yields, nor hangs on a spring, nor depends on a speed; a scene with any of these takes no
    /// treatment of DMT.
    #[test]
    fn effects_have_neither_closed_form_nor_dmt() {
        let sums = |scene: &Scene| {
            let others = others(scene, [16, 16], &[]);
            others.iter().any(|setting| setting.model == Model::Dmt)
        };
        let plain = sphere("", "", "");
        assert!(closed_form(&plain, [16, 16]).is_some() && sums(&plain));
        let rate = "rate = { reference_speed = 1.0, exponent = 0.5 }";
        for scene in [
            sphere("hardness = 10.0", "", ""),
            sphere("", rate, ""),
            sphere("", "", "spring = 0.5"),
        ] {
            assert!(closed_form(&scene, [16, 16]).is_none() && !sums(&scene));
        }
    }

    /// The automatic taper grows with the largest factor of a map; half of it was an eighth for a factor of 4.
    #[test]
    fn half_the_taper_is_half_of_that_on_a_map() {
        let map = "map = { pattern = \"checker\", period = 0.5, low = 1, high = 4 }";
        let scene = sphere("", map, "");
        let taper = |taper: Taper| {
            let own = Setting::own(&scene, [16, 16]);
            let adhesion = Setting { taper, ..own }.apply(&scene).0.adhesion;
            match resolve_law(&adhesion.expect("a law"), 1.0 / 16.0, 1.0, 4.0) {
                Law::MaugisDugdale(law) => law.taper,
                _ => f64::NAN,
            }
        };
        // 6 times 4 times 0.1 over 16.
        assert!((taper(Taper::AsGiven) - 0.15).abs() < 1e-15);
        assert!((taper(Taper::Half) - 0.075).abs() < 1e-15);
    }
}
