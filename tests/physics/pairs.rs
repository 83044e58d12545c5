//! Any two effects together: they work, and each changes what the other does alone, or the scene is
//! refused with the reason.

use std::path::Path;

use tabor::effect::Effect;
use tabor::scene::Scene;
use tabor::study::StepRow;

use crate::bench::solve_table;
use crate::shared::trials::tests;

/// A scene of bumps on a small grid, pressed on and drawn back, with some effects.
fn scene(effects: &[Effect]) -> String {
    let on = |effect| effects.contains(&effect);
    let mut solid = String::new();
    if on(Effect::Layer) {
        solid += "poisson_ratio = 0.3\nthickness = 0.2\n";
    }
    if on(Effect::Relaxation) {
        solid += "[[solid.relaxation]]\nmodulus = 1.0\ntime = 1.0\n";
    }
    if on(Effect::Hardness) {
        solid = format!("hardness = 0.05\n{solid}");
    }
    let mut tables = String::new();
    if [
        Effect::Adhesion,
        Effect::Dmt,
        Effect::AdhesionMap,
        Effect::Rate,
    ]
    .map(on)
    .contains(&true)
    {
        tables += "[adhesion]\nlaw = \"exponential\"\nwork_of_adhesion = 1e-4\nrange = 0.02\n";
    }
    if on(Effect::Dmt) {
        tables += "treatment = \"dmt\"\n";
    }
    if on(Effect::AdhesionMap) {
        tables += "map = { pattern = \"checker\", period = 0.5, low = 0.2, high = 1.5 }\n";
    }
    if on(Effect::Rate) {
        tables += "rate = { reference_speed = 0.05, exponent = 0.5 }\n";
    }
    if on(Effect::Capillary) {
        // A liquid of these units: a meniscus 0.02 high.
        tables += "[capillary]\nhumidity = 0.5\nsurface_tension = 1e-4\nmolar_volume = 171742\ntemperature = 298\n";
    }
    if on(Effect::Friction) {
        tables += "[friction]\nshear_strength = 0.1\n";
    }
    if on(Effect::Conductance) {
        tables += "[conductance]\nconductivity = 1.0\ncounter_conductivity = 3.0\n";
    }
    if on(Effect::Wear) {
        tables += "[wear]\nspecific_wear_rate = 0.1\n";
    }
    let boundary = match on(Effect::FreeBoundary) {
        true => "boundary = \"free\"\n",
        false => "",
    };
    let spring = match on(Effect::Spring) {
        true => "spring = 1.0\n",
        false => "",
    };
    format!(
        "[grid]\npoints = 32\nsize = 1.0\n{boundary}[solid]\ncontact_modulus = 1.0\n{solid}[[surface]]\nkind = \"wavy\"\namplitude = 0.02\nwavelength = 0.5\n{tables}[loading]\ncontrol = \"approach\"\n{spring}start = 0.005\n[[loading.ramp]]\nto = 0.012\nsteps = 2\nduration = 1\n[[loading.ramp]]\nto = 0.004\nsteps = 2\nduration = 1\n[solver]\ntolerance = 1e-8\n"
    )
}

/// Why a pair cannot be, as the scene's message says it.
fn refusal(pair: [Effect; 2]) -> Option<&'static str> {
    use Effect::{
        Adhesion, AdhesionMap, Capillary, Conductance, Dmt, FreeBoundary, Hardness, Layer, Rate,
        Relaxation, Spring,
    };
    match pair {
        [Adhesion | Dmt | AdhesionMap | Rate, Capillary] => Some("the liquid is the adhesion"),
        [Layer, Relaxation] => Some("relaxation of a compressible layer"),
        [Layer, FreeBoundary] => Some("a layer needs boundary = \"periodic\""),
        [Dmt, Hardness] => Some("a hardness with treatment = \"dmt\""),
        [Dmt, Relaxation] => Some("on a solid that relaxes"),
        [Layer, Conductance] => Some("the conductance of a layer"),
        [Dmt, Rate] => Some("a rate with treatment = \"dmt\""),
        [Dmt, Spring] => Some("a spring with treatment = \"dmt\""),
        _ => None,
    }
}

fn any_two_effects() {
    // Both forces of each step, what it conducts and what it wears; without the effects the others are 0.
    let forces = |effects: &[Effect]| -> Vec<f64> {
        let solved = solve_table(&scene(effects));
        let both = |row: &StepRow| {
            let others = [row.friction_force, row.conductance, row.wear_rate];
            [Some(row.force), others[0], others[1], others[2]].map(|value| value.unwrap_or(0.0))
        };
        solved.rows().flat_map(both).collect()
    };
    let alone: Vec<Vec<f64>> = Effect::ALL
        .iter()
        .map(|effect| forces(&[*effect]))
        .collect();
    let mut pairs = 0;
    for (i, one) in Effect::ALL.into_iter().enumerate() {
        for (j, other) in Effect::ALL.into_iter().enumerate().skip(i + 1) {
            let what = format!("{} with {}", one.name(), other.name());
            if let Some(reason) = refusal([one, other]) {
                let text = scene(&[one, other]);
                let errors = Scene::parse(&text, "pair.toml", Path::new("."), &[])
                    .expect_err(&what)
                    .to_string();
                assert!(errors.contains(reason), "{what}: {errors}");
                continue;
            }
            let both = forces(&[one, other]);
            pairs += 1;
            // A treatment or a map of the adhesion has it on; alone they are the pair.
            let same = |effect: Effect, other: Effect| {
                effect == Effect::Adhesion
                    && matches!(other, Effect::Dmt | Effect::AdhesionMap | Effect::Rate)
            };
            let differs = |a: &[f64]| {
                a.iter()
                    .zip(&both)
                    .any(|(a, b)| (a - b).abs() > 1e-6 * b.abs())
            };
            assert!(differs(&alone[i]), "{what}: {} does nothing", other.name());
            assert!(
                differs(&alone[j]) || same(one, other),
                "{what}: {} does nothing",
                one.name()
            );
        }
    }
    // Of 78 pairs 11 are refused.
    assert_eq!(pairs, 67);
}

tests![any_two_effects,];
