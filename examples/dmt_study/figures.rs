//! Pictures of the study's table, and the differences of each model from the full field.

use std::error::Error;
use std::f64::consts::PI;
use std::fmt::Write as _;
use std::path::Path;

use tabor::output::plot::{Axis, Figure, Panel, PlotPoint, Series};
use tabor::theory::dmt::{self, Method};
use tabor::theory::lennard_jones_sphere::LennardJonesSphere;
use tabor::theory::{Law, bradley, derjaguin, jkr};

use crate::rows::{self, RANGE, Row, WORK};

/// Tabor number of the sphere in the right-hand figure.
const TABOR: f64 = 0.2;
const MODELS: [&str; 5] = ["field", "icha", "icha-displaced", "persson", "gw-m"];

/// Rows of one model on one surface, by increasing load.
pub fn of<'a>(table: &'a [Row], model: &str, hurst: f64, ratio: usize, seed: u64) -> Vec<&'a Row> {
    let is = |row: &&Row| {
        row.model == model
            && row.case.hurst == hurst
            && row.case.ratio == ratio
            && row.case.seed == seed
    };
    table.iter().filter(is).collect()
}

fn axis(name: &str, unit: &str, logarithmic: bool) -> Axis {
    Axis {
        name: name.into(),
        unit: unit.into(),
        logarithmic,
    }
}

fn point(x: f64, y: f64) -> PlotPoint {
    PlotPoint::new(x, y)
}

/// The mean over seeds of a number of a model's rows; `None` without rows.
fn over_seeds(
    table: &[Row],
    model: &str,
    hurst: f64,
    ratio: usize,
    of_rows: impl Fn(&[&Row]) -> f64,
) -> Option<f64> {
    let seeds: Vec<u64> = if matches!(model, "field" | "icha" | "icha-displaced") {
        vec![1, 2, 3]
    } else {
        vec![0]
    };
    let found: Vec<f64> = seeds
        .iter()
        .map(|seed| of(table, model, hurst, ratio, *seed))
        .filter(|rows| !rows.is_empty())
        .map(|rows| of_rows(&rows))
        .collect();
    (!found.is_empty()).then(|| found.iter().sum::<f64>() / found.len() as f64)
}

/// Each model relative to the full field: area without adhesion (least and greatest ratio over the
/// loads up to 0.05 E* h'), and pull-off, means over seeds.
pub fn misses(table: &[Row]) -> String {
    let mut text = String::from(
        "| H | N | field pull-off eps/w | ICHA | ICHA displaced | Persson | GW-M | ICHA area | ICHA displaced area | Persson area | GW-M area |\n|---|---|---|---|---|---|---|---|---|---|---|\n",
    );
    for hurst in [0.8, 0.6, 0.4] {
        for ratio in [16, 32, 64] {
            let slope = match rows::Sample::slope(hurst, ratio) {
                Ok(slope) => slope,
                Err(_) => continue,
            };
            let scale = rows::MODULUS * slope * RANGE / WORK;
            let pull = |model: &str| over_seeds(table, model, hurst, ratio, rows::pull_off);
            let Some(judge) = pull("field") else { continue };
            let _ = write!(text, "| {hurst} | {ratio} | {:.4} |", judge * scale);
            for model in &MODELS[1..] {
                let _ = match pull(model) {
                    Some(found) => write!(text, " {:+.1} % |", 100.0 * (found / judge - 1.0)),
                    None => write!(text, " - |"),
                };
            }
            for model in &MODELS[1..] {
                let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
                for (index, load) in rows::loads().iter().enumerate() {
                    let area = |model: &str| {
                        over_seeds(table, model, hurst, ratio, |rows| {
                            rows.get(index).map_or(f64::NAN, |row| row.area)
                        })
                    };
                    if *load <= 0.05
                        && let (Some(found), Some(judge)) = (area(model), area("field"))
                    {
                        least = least.min(found / judge - 1.0);
                        most = most.max(found / judge - 1.0);
                    }
                }
                let _ = if least <= most {
                    write!(text, " {:+.0} to {:+.0} % |", 100.0 * least, 100.0 * most)
                } else {
                    write!(text, " - |")
                };
            }
            text.push('\n');
        }
    }
    text
}

/// Draws all pictures into `folder`.
pub fn draw(table: &[Row], folder: &Path) -> Result<(), Box<dyn Error>> {
    area_load(table).write(&folder.join("dmt_study_area.png"))?;
    pull_off(table)?.write(&folder.join("dmt_study_pull_off.png"))?;
    spheres()?.write(&folder.join("dmt_study_spheres.png"))?;
    Ok(())
}

/// Area against net load, first seed: H = 0.8 with the largest available N, and H = 0.4.
fn area_load(table: &[Row]) -> Figure {
    let largest = table.iter().map(|row| row.case.ratio).max().unwrap_or(16);
    let mut panels = Vec::new();
    let mut shown = vec![(0.8, 16), (0.8, largest), (0.4, largest)];
    shown.dedup();
    for (hurst, ratio) in shown {
        for adhesive in [false, true] {
            let curve = |(name, model): (usize, &&str)| Series {
                name,
                points: of(table, model, hurst, ratio, u64::from(name < 3))
                    .iter()
                    .map(|row| {
                        let attraction = if adhesive { row.attraction } else { 0.0 };
                        PlotPoint {
                            x: row.repulsive - attraction,
                            y: row.area,
                            hollow: row.model == "gw-m" && row.area > 0.05,
                        }
                    })
                    .collect(),
                line: true,
                marks: true,
            };
            let adhesion = if adhesive { "0.2 J/m²" } else { "no adhesion" };
            panels.push(Panel {
                title: format!("contact area, H = {hurst}, N = {ratio}, {adhesion}"),
                x: axis("net mean pressure / (E* h')", "", false),
                y: axis("contact area", "", false),
                series: MODELS.iter().enumerate().map(curve).collect(),
            });
        }
    }
    Figure {
        title: "Contact area against load".into(),
        note: "seed 1; hollow: GW-M beyond 5 % contact, where its summits would meet".into(),
        names: MODELS.map(str::to_owned).to_vec(),
        panels,
        ..Figure::default()
    }
}

/// Pull-off against the Fuller-Tabor parameter.
fn pull_off(table: &[Row]) -> Result<Figure, Box<dyn Error>> {
    let mut series = Vec::new();
    for (name, model) in MODELS.iter().enumerate() {
        for hurst in [0.8, 0.6, 0.4] {
            let mut points = Vec::new();
            for ratio in [16, 32, 64] {
                let spectrum = rows::spectrum(hurst, ratio)?;
                let theta = rows::summits(&spectrum, WORK)?.adhesion_parameter()?;
                let slope = rows::Sample::slope(hurst, ratio)?;
                let scale = rows::MODULUS * slope * RANGE / WORK;
                if let Some(tension) = over_seeds(table, model, hurst, ratio, rows::pull_off) {
                    points.push(point(theta, tension * scale));
                }
            }
            series.push(Series {
                name,
                points,
                line: true,
                marks: true,
            });
        }
    }
    Ok(Figure {
        title: "Pull-off against the Fuller-Tabor parameter".into(),
        note: "means over seeds; a line a Hurst exponent".into(),
        names: MODELS.map(str::to_owned).to_vec(),
        panels: vec![Panel {
            title: "pull-off pressure, in w/range".into(),
            x: axis("E* h^(3/2) / (w sqrt R)", "", true),
            y: axis("pull-off", "", true),
            series,
        }],
        columns: 1,
        ..Figure::default()
    })
}

/// The two figures of a sphere: attraction against contact radius, and force against approach at
/// Tabor number 0.2.
fn spheres() -> Result<Figure, Box<dyn Error>> {
    let names = [
        "Derjaguin",
        "DMT-T",
        "IDMT-T",
        "DMT-M",
        "DMT-F",
        "JKR",
        "Bradley",
        "self-consistent",
    ];
    let series = |name: usize, points: Vec<PlotPoint>| Series {
        name,
        points,
        line: true,
        marks: false,
    };
    // The law matters if a method sums it over the gap; DMT-T is defined for the cubic law.
    let methods = [
        (1, Method::Thermodynamic, Law::Cubic),
        (2, Method::Thermodynamic, Law::LennardJones),
        (3, Method::Constant, Law::LennardJones),
        (4, Method::Force, Law::LennardJones),
    ];
    let mut attraction = vec![Vec::new(); names.len()];
    for i in 0..=60 {
        let radius = 0.05 * f64::from(i);
        attraction[0].push(point(radius, 0.5));
        for (name, method, law) in methods {
            attraction[name].push(point(radius, dmt::attraction(method, law, radius)?));
        }
    }
    let mut force = vec![Vec::new(); names.len()];
    for i in 0..=50 {
        let approach = 0.05 * f64::from(i);
        force[0].push(point(approach, derjaguin::reduced_force(approach, TABOR)?));
        for (name, method, law) in methods {
            force[name].push(point(approach, dmt::force(method, law, approach, TABOR)?));
        }
    }
    for i in 0..=100 {
        let radius = jkr::grip() + 0.03 * f64::from(i);
        // Maugis' unit of approach is (9 pi^2/16)^(1/3) mu ranges, his unit of force half of 2 pi w
        // R.
        let approach = (9.0 * PI * PI / 16.0).cbrt() * TABOR * jkr::reduced_approach(radius);
        if approach <= 2.5 {
            force[5].push(point(approach, 0.5 * jkr::reduced_force(radius)));
        }
    }
    for i in 0..=60 {
        let gap = 3.0 - 0.05 * f64::from(i);
        force[6].push(point(-gap, bradley::reduced_force(Law::LennardJones, gap)));
    }
    let whole = LennardJonesSphere::new(TABOR, 2.5)?;
    let states = whole.curve(|states| states.last().is_some_and(|last| last.approach >= 2.5))?;
    let shown = states
        .iter()
        .filter(|state| (-3.0..=2.5).contains(&state.approach));
    force[7].extend(shown.map(|state| point(state.approach, state.force)));
    let curves = |all: Vec<Vec<PlotPoint>>| {
        let numbered = all.into_iter().enumerate();
        numbered
            .map(|(name, points)| series(name, points))
            .collect()
    };
    Ok(Figure {
        title: "One sphere: what the DMT theories attract with".into(),
        note: "forces in 2 pi w R; right: Tabor number 0.2, Bradley before contact".into(),
        names: names.map(str::to_owned).to_vec(),
        panels: vec![
            Panel {
                title: "attraction".into(),
                x: axis("contact radius / sqrt(R range)", "", false),
                y: axis("attraction", "", false),
                series: curves(attraction),
            },
            Panel {
                title: "net force".into(),
                x: axis("approach / range", "", false),
                y: axis("force", "", false),
                series: curves(force),
            },
        ],
        ..Figure::default()
    })
}
