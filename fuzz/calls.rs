//! What is asked of `fit`, `theory` and `compare` with any bytes: an answer of numbers or a refusal, never a panic.
//!
//! The fuzz targets feed it, and `tests/command_line/hostile_calls.rs` feeds it random curves.

use std::fs;
use std::path::Path;

use tabor::backend::cpu;
use tabor::compare::{check_scene, compare as compare_models};
use tabor::fit::{ForceCurve, Freedom, fit_curve, report};
use tabor::scene::{Scene, SurfacePart};
use tabor::study::{Plan, Setup};
use tabor::surface::Surface;

/// Points and steps up to which models are compared for each of many inputs.
const FEW_POINTS: usize = 1 << 10;
const FEW_STEPS: usize = 4;
/// Waves of a spectrum up to which a surface is built: beyond, summing them takes seconds by itself.
const FEW_WAVES: f64 = 64.0;
/// Iterations that a step may take.
const ITERATIONS: usize = 300;

/// Whether a text has a word that stands for NaN or an infinity.
fn is_not_finite(text: &str) -> bool {
    let mut words = text.split(|letter: char| !letter.is_alphanumeric());
    words.any(|word| word == "NaN" || word == "inf")
}

/// Reads bytes as a force curve and fits it. The first says the radius, the second what is fitted, and the rest
/// is the file, written to a scratch file in `folder`. Returns whether it was fitted.
pub fn curve(bytes: &[u8], folder: &Path) -> bool {
    let [radius, options, file @ ..] = bytes else {
        return false;
    };
    let bit = |place: u8| options >> place & 1 == 1;
    // 1e-30 to 1e30 m, most of them usual.
    let power = f64::from(i16::from(*radius) - 128);
    let radius = 10_f64.powf(if bit(3) {
        power / 4.3
    } else {
        power / 40.0 - 6.0
    });
    let freedom = Freedom {
        approach_offset: bit(0),
        force_offset: bit(1),
        baseline_slope: false,
        range: bit(2).then_some(1e-9),
    };
    let path = folder.join(format!("curve-{}.csv", std::process::id()));
    fs::write(&path, file).expect("a scratch file");
    let fitted =
        ForceCurve::read(&path).and_then(|curve| fit_curve(&curve, &path, radius, freedom));
    fs::remove_file(&path).expect("the scratch file");
    match fitted {
        Ok(result) => {
            for fit in &result.fits {
                let found = fit.parameters;
                for number in [
                    found.contact_modulus,
                    found.work_of_adhesion,
                    found.maugis_parameter,
                    found.approach_offset,
                    found.force_offset,
                    fit.sum_of_squares,
                    fit.aic,
                ] {
                    assert!(number.is_finite(), "{fit:?}");
                }
            }
            let stated = [result.work_uncertainty, result.modulus_uncertainty];
            assert!(
                stated.into_iter().flatten().all(f64::is_finite),
                "{stated:?}"
            );
            let said = format!("{} {:?}", report(&result, &path), result.warnings);
            assert!(!is_not_finite(&said), "{said}");
            true
        }
        Err(error) => {
            assert!(!error.to_string().is_empty());
            false
        }
    }
}

/// Takes bytes as the words of a call of `tabor theory`, one a line. Returns whether it printed a table.
pub fn theory(bytes: &[u8]) -> bool {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return false;
    };
    let words: Vec<String> = text.lines().map(str::to_owned).collect();
    // These take a second, or as long as rows are asked for.
    let slow = |word: &String| word == "lennard-jones-sphere" || word.starts_with("--points");
    if words.iter().any(slow) {
        return false;
    }
    match tabor::theory_table(&words) {
        Ok(table) => {
            let help = words.iter().any(|word| word == "--help" || word == "-h");
            assert!(
                help || words.is_empty() || !is_not_finite(&table),
                "{table}"
            );
            true
        }
        Err(message) => {
            assert!(!message.is_empty());
            false
        }
    }
}

/// Takes bytes as a scene whose paths begin in `folder` and compares the models on it where it is small.
/// Returns whether they were.
pub fn compare(bytes: &[u8], folder: &Path) -> bool {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return false;
    };
    let Ok(mut scene) = Scene::parse(text, "scene.toml", folder, &[]) else {
        return false;
    };
    let Ok(plan) = Plan::for_scene(scene.clone()) else {
        return false;
    };
    let grid = plan.outline.grid;
    let few_waves = scene.surfaces.iter().all(|part| match part {
        SurfacePart::SelfAffine(rough) => grid.lx.max(grid.ly) / rough.shortest < FEW_WAVES,
        _ => true,
    });
    let few = grid.len() <= FEW_POINTS && scene.loading.path.len() <= FEW_STEPS;
    if !few || !few_waves || check_scene(&scene).is_err() {
        return false;
    }
    scene.solver.max_iterations = scene.solver.max_iterations.min(ITERATIONS);
    let Ok(surface) = Surface::build(&scene) else {
        return false;
    };
    let cpu = || cpu::double(None);
    let out = folder.join(format!("compared-{}", std::process::id()));
    let compared = compare_models(Setup::new(scene, surface), &cpu, &out);
    let table = fs::read_to_string(out.join("compare.csv")).unwrap_or_default();
    assert!(!is_not_finite(&table), "{table}");
    let _ = fs::remove_dir_all(&out);
    compared.is_ok()
}
