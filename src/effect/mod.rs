//! Effects: what a scene may ask for beyond hard, frictionless, elastic contact of a periodic cell.
//!
//! Each is one file, which implements the hooks of `study`, and one entry in the list here. An effect
//! that the scene does not name has no field and no pass. Its cost is the difference of the scene planned
//! with and without it.

mod adhesion;
mod adhesion_map;
mod attracted_pixels;
mod capillary;
mod conductance;
mod dmt;
mod edge;
mod free_boundary;
mod friction;
mod hardness;
mod layer;
mod leakage;
mod planning;
mod rate;
mod relaxation;
mod spring;
mod wear;

pub use relaxation::branch_coefficients;

use std::fmt;

use crate::backend::BackendError;
use crate::grid::Grid;
use crate::scene::Scene;
use crate::study::{Cost, Hooks, Plan};

/// Every effect of this version, in the order in which they are called and shown. A new one stands last.
const LIST: [&dyn Hooks; 14] = [
    &adhesion::Adhesion,
    &dmt::Dmt,
    &adhesion_map::AdhesionMap,
    &rate::Rate,
    &capillary::Capillary,
    &layer::LayerEffect,
    &hardness::Hardness,
    &relaxation::Relaxation,
    &free_boundary::FreeBoundary,
    &spring::Spring,
    &friction::Friction,
    &conductance::Conductance,
    &wear::Wear,
    &leakage::Leakage,
];

/// An effect of this version.
#[derive(Clone, Copy)]
pub struct Effect(&'static dyn Hooks);

/// The fields, passes and bytes that an effect adds to a scene and removes from it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct EffectCost {
    /// Fields that it adds.
    pub fields_added: Vec<&'static str>,
    /// Fields that it removes.
    pub fields_spared: Vec<&'static str>,
    /// Passes of an iteration that it adds.
    pub passes_added: Vec<&'static str>,
    /// Passes that it removes.
    pub passes_spared: Vec<&'static str>,
    /// Bytes that it adds; negative if it removes more.
    pub bytes: i128,
}

impl Effect {
    /// Every effect of this version.
    pub const ALL: [Effect; LIST.len()] = {
        let mut all = [Effect(LIST[0]); LIST.len()];
        let mut i = 0;
        while i < LIST.len() {
            all[i] = Effect(LIST[i]);
            i += 1;
        }
        all
    };

    /// The effect of a name, if there is one.
    pub fn from_name(name: &str) -> Option<Effect> {
        Effect::ALL.into_iter().find(|effect| effect.name() == name)
    }

    /// Its name in summaries.
    pub fn name(self) -> &'static str {
        self.0.name()
    }

    /// What it does, in a line.
    pub fn purpose(self) -> &'static str {
        self.0.purpose()
    }

    /// Whether a scene asks for it.
    pub fn is_on(self, scene: &Scene) -> bool {
        self.0.is_on(scene)
    }

    /// When it matters, with the number of a scene that asks for it.
    pub fn matters(self, plan: &Plan) -> String {
        self.0.matters(plan)
    }

    /// The scene without it.
    pub fn removed_from(self, scene: &Scene) -> Scene {
        let mut scene = scene.clone();
        self.0.remove_from(&mut scene);
        scene
    }

    /// Keys and values that ask for it, as `--set` takes them, in a scene whose grid has the size 1 and
    /// whose contact modulus is 1.
    pub fn example(self) -> &'static [(&'static str, &'static str)] {
        self.0.example()
    }

    /// Names of its columns of `curve.csv`.
    pub fn columns(self) -> impl Iterator<Item = &'static str> {
        self.0.columns().iter().map(|column| column.name)
    }

    /// The unit of a column of any effect in a table whose columns `is_there` knows; `None` where no effect has it.
    #[cfg(feature = "cli")]
    pub(crate) fn unit_of_column(
        name: &str,
        is_there: impl Fn(&str) -> bool,
    ) -> Option<&'static str> {
        // Beside a resistance the conductance is that of a current.
        let electrical = is_there(conductance::RESISTANCE.name).then_some(&conductance::ELECTRICAL);
        let columns = Effect::ALL.iter().flat_map(|effect| effect.0.columns());
        electrical
            .into_iter()
            .chain(columns)
            .find(|column| column.name == name)
            .map(|column| column.unit)
    }

    /// What it costs in a scene that asks for it, of which `with` is the cost on `grid`.
    ///
    /// # Errors
    /// As [`Cost::for_scene`].
    pub fn cost(self, scene: &Scene, with: &Cost, grid: Grid) -> Result<EffectCost, BackendError> {
        let without = Cost::for_scene(&self.removed_from(scene), grid, with.place)?;
        let names = |cost: &Cost| {
            cost.fields
                .iter()
                .chain(&cost.history)
                .map(|field| field.name)
                .collect::<Vec<_>>()
        };
        let bytes = |cost: &Cost| (cost.bytes() + cost.history_bytes()) as i128;
        Ok(EffectCost {
            fields_added: difference(&names(with), &names(&without)),
            fields_spared: difference(&names(&without), &names(with)),
            passes_added: difference(&with.passes, &without.passes),
            passes_spared: difference(&without.passes, &with.passes),
            bytes: bytes(with) - bytes(&without),
        })
    }
}

impl PartialEq for Effect {
    fn eq(&self, other: &Effect) -> bool {
        self.name() == other.name()
    }
}

impl Eq for Effect {}

impl fmt::Debug for Effect {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.debug_tuple("Effect").field(&self.name()).finish()
    }
}

/// What is in `left` more often than in `right`.
fn difference(left: &[&'static str], right: &[&'static str]) -> Vec<&'static str> {
    let mut rest = right.to_vec();
    left.iter()
        .copied()
        .filter(|name| match rest.iter().position(|other| other == name) {
            Some(place) => {
                rest.swap_remove(place);
                false
            }
            None => true,
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    #[test]
    fn differences_count() {
        assert_eq!(difference(&["a", "b", "a"], &["a", "c"]), ["b", "a"]);
        assert!(difference(&["a"], &["a", "a"]).is_empty());
    }

    #[test]
    fn names_and_columns_are_told_apart() {
        for (i, effect) in LIST.iter().enumerate() {
            assert!(LIST[..i].iter().all(|other| other.name() != effect.name()));
        }
        // The places of the columns are 0, 1, 2, ... in the order in which versions added them.
        let columns = LIST.iter().flat_map(|effect| effect.columns());
        let mut places: Vec<usize> = columns.map(|column| column.place).collect();
        places.sort_unstable();
        assert!(places.iter().copied().eq(0..places.len()), "{places:?}");
    }

    /// However far a profile goes across, the cell is as long and as wide as the profile.
    #[test]
    fn what_matters_along_a_profile() {
        let words = |name: &str, across: &str| {
            let text = format!(
                "[grid]\npoints = [32, 1]\nsize = [1.0, {across}]\n[solid]\ncontact_modulus = 1.0\npoisson_ratio = 0.3\nthickness = 0.2\n[[surface]]\nkind = \"wavy\"\namplitude = 0.02\nwavelength = [1.0, \"inf\"]\n[adhesion]\nlaw = \"exponential\"\nwork_of_adhesion = 1e-4\nrange = 0.02\nrate = {{ reference_speed = 0.05, exponent = 0.5 }}\n[loading]\ncontrol = \"approach\"\nstart = 0.0\n[[loading.ramp]]\nto = 0.01\nsteps = 1\nduration = 1\n"
            );
            let scene = Scene::parse(&text, "profile.toml", Path::new("."), &[]);
            let scene = scene.unwrap_or_else(|errors| panic!("{errors}"));
            let plan = Plan::for_scene(scene).expect("a surface");
            Effect::from_name(name).expect("an effect").matters(&plan)
        };
        for name in ["layer", "rate"] {
            let narrow = words(name, "0.03");
            assert_eq!(narrow, words(name, "1.0"));
            assert_eq!(narrow, words(name, "7.0"));
        }
    }

    /// The example of each effect asks for it, and without it the scene does not.
    #[test]
    fn an_example_asks_for_its_effect() {
        let text = "[grid]\npoints = 32\nsize = 1.0\n[solid]\ncontact_modulus = 1.0\n[[surface]]\nkind = \"wavy\"\namplitude = 0.02\nwavelength = 0.5\n[loading]\ncontrol = \"approach\"\nstart = 0.0\n[[loading.ramp]]\nto = 0.01\nsteps = 1\nduration = 1\n";
        for effect in Effect::ALL {
            let settings = effect.example().iter();
            let settings: Vec<(String, String)> = settings
                .map(|(key, value)| ((*key).to_owned(), (*value).to_owned()))
                .collect();
            let read = |settings| Scene::parse(text, "effect.toml", Path::new("."), settings);
            let without = read(&[]).unwrap_or_else(|errors| panic!("{errors}"));
            assert!(!effect.is_on(&without), "{effect:?}");
            let with = read(&settings).unwrap_or_else(|errors| panic!("{errors}"));
            assert!(effect.is_on(&with), "{effect:?}");
            assert!(!effect.is_on(&effect.removed_from(&with)), "{effect:?}");
            assert_eq!(Effect::from_name(effect.name()), Some(effect));
        }
        assert_eq!(Effect::from_name("levitation"), None);
    }
}
