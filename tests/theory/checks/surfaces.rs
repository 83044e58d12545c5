//! Checks of one surface whose phases are fixed: its waves, its full field, its asperities.

use super::inputs::{Answer, Inputs};
use serde_json::json;
use std::f64::consts::PI;
use tabor::backend::cpu;
use tabor::grid::Grid;
use tabor::law::{Law, LennardJones};
use tabor::scene::{Boundary, Roughness, Scene, SelfAffineScene};
use tabor::study::{FinishedStep, Observer, Setup, walk};
use tabor::surface::self_affine;
use tabor::surface::spectrum::SelfAffineSpectrum;
use tabor::surface::statistics::Statistics;
use tabor::surface::{Surface, self_affine::scaled_spectrum};
use tabor::theory::icha::{Icha, MergeRule};

const MODULUS: f64 = 1.33e12;
const RMS_HEIGHT: f64 = 0.52e-9;
const SIDE: f64 = 2.0 * PI / 2.5e5;
const LAW: Law = Law::LennardJones(LennardJones {
    work_of_adhesion: 0.2,
    range: 1e-9,
});

pub fn evaluate(function: &str, inputs: &Inputs) -> Option<Answer> {
    let compute: fn(&Inputs) -> Answer = match function {
        "phase_generator" => |i| {
            let [seed, k, l] = i.numbers(["seed", "k", "l"]);
            let fraction = self_affine::phase_fraction(seed as u64, k as i64, l as i64);
            Ok(json!(fraction))
        },
        "surface_deterministic" => deterministic,
        "psd_discrete_moments" => discrete_moments,
        "bem_det_surface" => full_field,
        "icha_det_surface" => asperities,
        _ => return None,
    };
    Some(compute(inputs))
}

fn deterministic(inputs: &Inputs) -> Answer {
    let [long, rolloff, short, hurst] = inputs.numbers(["qL", "q0", "q1", "H"]);
    let [rms_height, points, seed] = inputs.numbers(["C0_hrms", "n", "seed"]);
    let spectrum = SelfAffineSpectrum {
        hurst,
        long,
        rolloff,
        short,
        plateau: 1.0,
    };
    let grid = Grid::new([points as usize; 2], [2.0 * PI / long; 2]);
    let heights = self_affine::heights(&spectrum.with_rms_height(rms_height), &grid, seed as u64);
    // The file counts x first, an array here y.
    let at = |i: usize, j: usize| heights[j * grid.nx + i];
    let statistics = Statistics::from_heights(&grid, &heights, Boundary::Periodic);
    Ok(json!({
        "h00": at(0, 0),
        "h01": at(0, 1),
        "h10": at(1, 0),
        "h_10_20": at(10, 20),
        "rms": statistics.moments.rms_height(),
        "max": statistics.highest,
        "min": statistics.lowest,
    }))
}

fn discrete_moments(inputs: &Inputs) -> Answer {
    let [hurst, ratio] = inputs.numbers(["H", "N"]);
    let scene = SelfAffineScene {
        hurst,
        roughness: Roughness::RmsHeight(RMS_HEIGHT),
        longest: SIDE,
        rolloff: SIDE / 4.0,
        shortest: SIDE / (4.0 * ratio),
        seed: 1,
    };
    let (scaled, sums) = scaled_spectrum(&scene, [SIDE; 2])?;
    let continuous = scaled.with_rms_height(RMS_HEIGHT);
    let before = self_affine::band_sums(&continuous, [SIDE; 2]);
    Ok(json!({
        "sum_m0_before_rescale": before.height,
        "hrms_slope_after_rescale": sums.slope.sqrt(),
        "hrms_laplacian_after_rescale": sums.curvature.sqrt(),
    }))
}

/// The study's surface under mean pressures in units of `E* h'_rms`.
fn study(inputs: &Inputs, reduced: &[f64]) -> Result<Setup, Box<dyn std::error::Error>> {
    let [hurst, ratio, points, seed] = inputs.numbers(["H", "N", "n", "seed"]);
    let text = format!(
        "[grid]\npoints = {points}\nsize = {SIDE:e}\n\
         [solid]\ncontact_modulus = {MODULUS:e}\n\
         [[surface]]\nkind = \"self-affine\"\nhurst = {hurst}\nrms_height = {RMS_HEIGHT:e}\n\
         longest = {SIDE:e}\nrolloff = {:e}\nshortest = {:e}\nseed = {seed}\n\
         [loading]\ncontrol = \"pressure\"\npath = [1.0]\n\
         [solver]\ntolerance = 1e-8\n",
        SIDE / 4.0,
        SIDE / (4.0 * ratio)
    );
    let mut scene = Scene::parse(&text, "study", std::path::Path::new("."), &[])?;
    let surface = Surface::build(&scene)?;
    let slope = surface.statistics(Boundary::Periodic).moments.rms_slope();
    scene.loading.path = reduced.iter().map(|x| x * MODULUS * slope).collect();
    Ok(Setup::new(scene, surface))
}

/// Keeps the attraction summed outside the contact, and the largest pressure, of the last step.
#[derive(Default)]
struct Sums {
    attraction: f64,
    largest: f64,
}

impl Observer for Sums {
    type Error = std::convert::Infallible;

    fn step(&mut self, step: FinishedStep) -> Result<(), Self::Error> {
        if let Some(fields) = step.evaluation {
            let open = fields.gap.iter().filter(|gap| **gap > 0.0);
            let sum: f64 = open.map(|gap| LAW.traction(*gap)).sum();
            self.attraction = sum / fields.gap.len() as f64;
            self.largest = fields.pressure.iter().copied().fold(0.0, f64::max);
        }
        Ok(())
    }

    fn iteration(&mut self, _: usize, _: &tabor::kernel::Scalars) -> bool {
        true
    }
}

fn full_field(inputs: &Inputs) -> Answer {
    let setup = study(inputs, &[inputs.number("x")])?;
    let unit = MODULUS * setup.statistics.moments.rms_slope();
    let cpu = || cpu::double(None);
    let mut sums = Sums::default();
    let end = walk(&setup, &cpu, &mut sums)?;
    let row = &end.rows[0];
    Ok(json!({
        "A": row.contact_area_fraction,
        "A_corr": row.contact_area_fraction_corrected,
        "ubar_over_h": row.mean_gap.map(|gap| gap / RMS_HEIGHT),
        "pad_over_Ehp": sums.attraction / unit,
        "pmax_over_Ehp": sums.largest / unit,
    }))
}

fn asperities(inputs: &Inputs) -> Answer {
    let setup = study(inputs, &[0.02])?;
    let slope = setup.statistics.moments.rms_slope();
    let rule = match inputs.text("rule") {
        "vol" => MergeRule::Volume,
        "load" => MergeRule::Load,
        other => return Err(format!("no merge rule is called {other}").into()),
    };
    let surface = Icha::new(setup.surface.grid, &setup.surface.heights)?;
    let mut answer = serde_json::Map::new();
    answer.insert("n_asperities".into(), json!(surface.summits().len()));
    let mut loading = surface.loading(rule);
    let mut pull_off: f64 = 0.0;
    // Loads of the file, and a dozen more around the greatest tension.
    let mut loads: Vec<f64> = (0..16).map(|i| 0.005 * 1.17_f64.powi(i)).collect();
    loads.extend([0.005, 0.02, 0.05]);
    loads.sort_by(f64::total_cmp);
    loads.dedup();
    for load in loads {
        let pressed = loading.press(load * slope)?;
        let gap = pressed.gap(&surface);
        let attraction = gap.mean_outside(|u| LAW.traction(u)) / (MODULUS * slope);
        pull_off = pull_off.max(attraction - load);
        let area = pressed.contact_area_fraction();
        answer.insert(format!("kappa_at_{load}"), json!(area / load));
        answer.insert(format!("pad_at_{load}"), json!(attraction));
    }
    answer.insert("pull_off_over_Ehp".into(), json!(pull_off));
    Ok(answer.into())
}
