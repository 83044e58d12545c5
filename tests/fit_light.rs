//! `tabor fit` on curves that were hardly pressed.

use std::f64::consts::{PI, TAU};
use std::path::Path;

use tabor::fit::model::{Parameters, SphereModel};
use tabor::fit::{ForceCurve, Freedom, Model, Sample, fit_curve};

const FREE: Freedom = Freedom {
    approach_offset: true,
    force_offset: false,
    range: None,
};

struct Random(u64);

impl Random {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (TAU * self.uniform()).cos()
    }
}

const RADIUS: f64 = 1e-6;
const MODULUS: f64 = 1e7;
const WORK: f64 = 0.05;

fn made(model: Model, ratio: f64, both: bool, tail: f64, points: usize, seed: u64) -> Vec<Sample> {
    let truth = Parameters {
        contact_modulus: MODULUS,
        work_of_adhesion: WORK,
        maugis_parameter: 1.0,
        approach_offset: if std::env::var("ZERO").is_ok() {
            0.0
        } else {
            3e-9
        },
        force_offset: 0.0,
    };
    let force_unit = PI * WORK * RADIUS;
    let unit = (force_unit * force_unit / (16.0 / 9.0 * MODULUS * MODULUS * RADIUS)).cbrt();
    let (pull_off, last) = match model {
        Model::Dmt => (2.0, 0.0),
        _ => (1.5, -3.0 / 6.0_f64.powf(2.0 / 3.0)),
    };
    let sphere = SphereModel::new(model, RADIUS);
    let force = |reduced: f64| {
        sphere
            .forces(&truth, &[truth.approach_offset + unit * reduced])
            .unwrap()[0]
            / force_unit
    };
    let (mut low, mut high) = (last, 10.0);
    while high - low > 1e-12 {
        let mid = 0.5 * (low + high);
        if force(mid) < ratio * pull_off {
            low = mid
        } else {
            high = mid
        }
    }
    let deepest = if std::env::var("HERTZ").is_ok() {
        (ratio * pull_off).powf(2.0 / 3.0)
    } else {
        high
    };
    if seed == 1000 {
        print!("[net/pull-off {:.3}] ", force(deepest) / pull_off);
    }
    let far = last - tail * (deepest - last);
    let mut random = Random(seed);
    if std::env::var("LOAD").is_ok() {
        let at_force = |wanted: f64| {
            let (mut low, mut high) = (
                if model == Model::Dmt {
                    0.0
                } else {
                    -0.75f64.powf(1.0 / 3.0) * 0.9086 / 0.9086 * 0.0 - 3.0 / 6.0_f64.powf(2.0 / 3.0)
                },
                10.0,
            );
            if model != Model::Dmt {
                low = tabor::theory::jkr::reduced_approach(1.5f64.cbrt());
            }
            while high - low > 1e-12 {
                let mid = 0.5 * (low + high);
                if force(mid) < wanted {
                    low = mid
                } else {
                    high = mid
                }
            }
            high
        };
        let top = ratio * pull_off;
        let up = (0..if both { points } else { 0 }).map(|i| top * i as f64 / (points - 1) as f64);
        let down =
            (0..points).map(|i| top - (top + pull_off * 0.999) * i as f64 / (points - 1) as f64);
        return up
            .chain(down)
            .map(|f| Sample {
                approach: truth.approach_offset + unit * at_force(f),
                force: force_unit * (f + 0.01 * pull_off * random.normal()),
            })
            .collect();
    }
    let place = |i: usize| far + (deepest - far) * i as f64 / (points - 1) as f64;
    let there = (0..if both { points } else { 0 }).map(|i| (place(i), 0.0));
    there
        .chain((0..points).rev().map(|i| (place(i), last)))
        .map(|(reduced, last)| Sample {
            approach: truth.approach_offset + unit * reduced,
            force: force_unit
                * (if reduced < last { 0.0 } else { force(reduced) }
                    + 0.01 * pull_off * random.normal()),
        })
        .collect()
}

#[test]
fn lightly_pressed() {
    let seeds: u64 = std::env::var("SEEDS").map_or(20, |s| s.parse().unwrap());
    let points: usize = std::env::var("POINTS").map_or(60, |s| s.parse().unwrap());
    let tails: Vec<f64> = std::env::var("TAILS").map_or(vec![0.5, 0.0], |s| {
        s.split(',').map(|x| x.parse().unwrap()).collect()
    });
    let verbose = std::env::var("VERBOSE").is_ok();
    for model in [Model::Jkr, Model::Dmt] {
        for both in [true, false] {
            for tail in &tails {
                for ratio in std::env::var("RATIOS")
                    .map_or("0.4,0.6,0.8,1,1.2,1.4".to_owned(), |s| s)
                    .split(",")
                    .map(|x| x.parse::<f64>().unwrap())
                {
                    let mut errors = 0;
                    let mut none = 0;
                    let mut z: [Vec<f64>; 2] = Default::default();
                    let mut dev: [Vec<f64>; 2] = Default::default();
                    let mut chosen = std::collections::BTreeMap::new();
                    for seed in 0..seeds {
                        let curve = ForceCurve {
                            samples: made(model, ratio, both, *tail, points, 1000 + seed),
                            ..ForceCurve::default()
                        };
                        match fit_curve(
                            &curve,
                            Path::new("x.csv"),
                            RADIUS,
                            Freedom {
                                force_offset: std::env::var("BASE").is_ok(),
                                approach_offset: std::env::var("ZERO").is_err(),
                                ..FREE
                            },
                        ) {
                            Err(error) => {
                                if errors == 0 && verbose {
                                    println!("{error}");
                                }
                                errors += 1
                            }
                            Ok(result) => {
                                let best = result.best();
                                if verbose {
                                    for f in &result.fits {
                                        println!(
                                            "   {} w {:.4} {:?} E {:.3e} {:?} lam {:.2} off {:.3e} aic {:.2} conv {} sum {:.4e} ac {:.2}",
                                            f.model.name(),
                                            f.parameters.work_of_adhesion,
                                            f.uncertainties.work_of_adhesion,
                                            f.parameters.contact_modulus,
                                            f.uncertainties.contact_modulus,
                                            f.parameters.maugis_parameter,
                                            f.parameters.approach_offset,
                                            f.aic,
                                            f.converged,
                                            f.sum_of_squares,
                                            f.autocorrelation
                                        );
                                    }
                                    println!(
                                        "  -> {} w {:?} E {:?} {:?}",
                                        best.model.name(),
                                        result.work_uncertainty,
                                        result.modulus_uncertainty,
                                        result.warnings
                                    );
                                }
                                *chosen.entry(best.model.name()).or_insert(0) += 1;
                                let Some(w) = result.work_uncertainty else {
                                    none += 1;
                                    continue;
                                };
                                let Some(e) = result.modulus_uncertainty else {
                                    none += 1;
                                    continue;
                                };
                                z[0].push((best.parameters.work_of_adhesion - WORK) / w);
                                dev[0].push(w / WORK);
                                z[1].push((best.parameters.contact_modulus - MODULUS) / e);
                                dev[1].push(e / MODULUS);
                            }
                        }
                    }
                    let med = |v: &Vec<f64>| {
                        let mut v = v.clone();
                        v.sort_by(f64::total_cmp);
                        if v.is_empty() {
                            f64::NAN
                        } else {
                            v[v.len() / 2]
                        }
                    };
                    let worst = |v: &Vec<f64>| v.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
                    let beyond = |v: &Vec<f64>| v.iter().filter(|x| !(x.abs() <= 3.0)).count();
                    println!(
                        "{:15} both {both} tail {tail} ratio {ratio}: errors {errors} none {none}; w beyond3 {} worst {:.1} dev {:.3}; E beyond3 {} worst {:.1} dev {:.3}; {chosen:?}",
                        model.name(),
                        beyond(&z[0]),
                        worst(&z[0]),
                        med(&dev[0]),
                        beyond(&z[1]),
                        worst(&z[1]),
                        med(&dev[1])
                    );
                }
            }
        }
    }
}
