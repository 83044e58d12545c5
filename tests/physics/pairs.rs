//! Any two effects together: they work, and each changes what the other does alone, or the scene is
//! refused with the reason. Each effect says for itself what asks for it.

use std::path::Path;

use tabor::effect::Effect;
use tabor::scene::{Scene, SceneErrors};
use tabor::study::{Setup, StepRow, walk};
use tabor::surface::Surface;

use crate::bench::cpu;
use crate::shared::trials::tests;

/// Bumps on a small grid, pressed on and drawn back.
const SCENE: &str = "[grid]\npoints = 32\nsize = 1.0\n[solid]\ncontact_modulus = 1.0\n[[surface]]\nkind = \"wavy\"\namplitude = 0.02\nwavelength = 0.5\n[loading]\ncontrol = \"approach\"\nstart = 0.005\n[[loading.ramp]]\nto = 0.012\nsteps = 2\nduration = 1\n[[loading.ramp]]\nto = 0.004\nsteps = 2\nduration = 1\n[solver]\ntolerance = 1e-8\n";

/// That scene with some effects.
fn scene(effects: &[Effect]) -> Result<Scene, SceneErrors> {
    let mut settings: Vec<(String, String)> = Vec::new();
    for (key, value) in effects.iter().flat_map(|effect| effect.example()) {
        let setting = ((*key).to_owned(), (*value).to_owned());
        // What two of them vary is set once, or the second would take back what the first has set in it.
        if !settings.contains(&setting) {
            settings.push(setting);
        }
    }
    Scene::parse(SCENE, "pair.toml", Path::new("."), &settings)
}

fn solve(effects: &[Effect]) -> Vec<StepRow> {
    let scene = scene(effects).unwrap_or_else(|errors| panic!("{effects:?}: {errors}"));
    assert!(
        effects.iter().all(|effect| effect.is_on(&scene)),
        "{effects:?}"
    );
    let surface = Surface::build(&scene).unwrap_or_else(|error| panic!("{error}"));
    let setup = Setup::new(scene, surface);
    let end = walk(&setup, &cpu, &mut ());
    let rows = end.unwrap_or_else(|error| panic!("{error}")).rows;
    assert!(
        rows.len() == 5 && rows.iter().all(|row| row.converged),
        "{effects:?}: a step did not converge"
    );
    rows
}

/// Why a pair cannot be, as the scene's message says it.
fn refusal(pair: [Effect; 2]) -> Option<&'static str> {
    match pair.map(Effect::name) {
        [
            "adhesion" | "dmt treatment" | "adhesion map" | "rate",
            "capillary",
        ] => Some("[adhesion] is given too"),
        ["layer", "relaxation"] => Some("relaxation of a compressible layer"),
        ["layer", "free boundary"] => Some("a layer needs boundary = \"periodic\""),
        ["dmt treatment", "hardness"] => Some("a hardness with treatment = \"dmt\""),
        ["dmt treatment", "relaxation"] => Some("on a viscoelastic solid"),
        ["layer", "conductance"] => Some("the conductance of a layer"),
        ["dmt treatment", "rate"] => Some("a rate with treatment = \"dmt\""),
        ["dmt treatment", "spring"] => Some("a spring with treatment = \"dmt\""),
        _ => None,
    }
}

fn any_two_effects() {
    // The force of each step and the columns of effects that change nothing else; without the effects the
    // others are 0. Plastic energy is left out: a hardness must show in the rest.
    let forces = |effects: &[Effect]| -> Vec<f64> {
        let columns: Vec<_> = (Effect::ALL.iter())
            .flat_map(|effect| effect.columns())
            .filter(|column| *column != "plastic_energy")
            .collect();
        let values = |row: &StepRow| -> Vec<f64> {
            let others = columns
                .iter()
                .map(|column| row.column(column).unwrap_or(0.0));
            [row.force].into_iter().chain(others).collect()
        };
        solve(effects).iter().flat_map(values).collect()
    };
    let alone: Vec<Vec<f64>> = Effect::ALL
        .iter()
        .map(|effect| forces(&[*effect]))
        .collect();
    let (mut pairs, mut refused) = (0, 0);
    for (i, one) in Effect::ALL.into_iter().enumerate() {
        for (j, other) in Effect::ALL.into_iter().enumerate().skip(i + 1) {
            let what = format!("{} with {}", one.name(), other.name());
            pairs += 1;
            if let Some(reason) = refusal([one, other]) {
                let errors = scene(&[one, other]).expect_err(&what).to_string();
                assert!(errors.contains(reason), "{what}: {errors}");
                refused += 1;
                continue;
            }
            let both = forces(&[one, other]);
            // A treatment or a map of the adhesion has it on; alone they are the pair.
            let same = ["dmt treatment", "adhesion map", "rate"].contains(&other.name())
                && one.name() == "adhesion";
            let differs = |a: &[f64]| {
                a.iter()
                    .zip(&both)
                    .any(|(a, b)| (a - b).abs() > 1e-6 * b.abs())
            };
            assert!(differs(&alone[i]), "{what}: {} does nothing", other.name());
            assert!(
                differs(&alone[j]) || same,
                "{what}: {} does nothing",
                one.name()
            );
        }
    }
    // Of the 91 pairs of 14 effects 11 are refused; a further effect brings one pair with each.
    assert_eq!(pairs, Effect::ALL.len() * (Effect::ALL.len() - 1) / 2);
    assert!(pairs >= 91, "{pairs}");
    assert_eq!(refused, 11);
}

tests![any_two_effects,];
