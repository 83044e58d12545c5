//! The treatment of DMT where the net load dips more than once: a summit that stands out holds a little
//! by itself, the rest of the surface much more once it comes near.

use std::fs;
use std::path::Path;

use tabor::backend::cpu;
use tabor::kernel::Scalars;
use tabor::scene::Scene;
use tabor::study::{FinishedStep, Observer, PointState, Setup, State, StepRow, walk};
use tabor::surface::Surface;

use crate::shared::binary::{errors, tabor};
use crate::shared::trials::tests;

/// Largest tension of the laws by their work and range, Pa; that of Lennard-Jones is 1.03 times it.
const PEAK: f64 = 50e6;
const LAWS: [&str; 3] = ["exponential", "lennard-jones", "maugis-dugdale"];

/// A gentle wave of 0.3 nm with one spike of 6 nm, in nm on 32 x 32 points of 100 nm.
fn spiked() -> String {
    let rows = (0..32).map(|y| {
        let row = (0..32).map(|x| {
            let turn = |i: i32| 2.0 * std::f64::consts::PI * f64::from(i) / 32.0;
            let wave = 0.15 * (turn(2 * x).cos() + turn(2 * y).cos());
            let away = f64::from((x - 16).pow(2) + (y - 16).pow(2));
            format!("{:.6}", wave + 6.0 * (-away / 4.0).exp())
        });
        row.collect::<Vec<_>>().join(" ")
    });
    rows.collect::<Vec<_>>().join("\n")
}

fn scene(law: &str, adhesion: bool, path: &[f64]) -> String {
    let adhesion = if adhesion {
        format!(
            "[adhesion]\nlaw = \"{law}\"\nwork_of_adhesion = \"50 mJ/m^2\"\nrange = \"1 nm\"\ntreatment = \"dmt\"\n"
        )
    } else {
        String::new()
    };
    format!(
        "[grid]\nsize = \"3.2 um\"\n[solid]\ncontact_modulus = \"2 GPa\"\n[[surface]]\nkind = \"file\"\npath = \"map.txt\"\nunit = \"nm\"\n{adhesion}[loading]\ncontrol = \"pressure\"\npath = {path:?}\n"
    )
}

/// Rows with the mean of each step's field, Pa; a gap of the hard wall is summed by `law`.
#[derive(Default)]
struct Watch(Vec<(StepRow, f64, Vec<f64>)>);

impl Observer for Watch {
    type Error = std::convert::Infallible;

    fn step(&mut self, step: FinishedStep) -> Result<(), Self::Error> {
        let (mean, gaps) = step.evaluation.map_or((0.0, Vec::new()), |fields| {
            let open = fields.gap.iter().zip(&fields.points);
            let open = open.filter(|(_, point)| **point != PointState::Contact);
            let mean = fields.pressure.iter().sum::<f64>() / fields.pressure.len() as f64;
            (mean, open.map(|(gap, _)| *gap).collect())
        });
        self.0.push((step.row.clone(), mean, gaps));
        Ok(())
    }

    fn iteration(&mut self, _: usize, _: &Scalars) -> bool {
        true
    }
}

fn walked(folder: &Path, text: &str) -> (Setup, Vec<(StepRow, f64, Vec<f64>)>) {
    let scene = Scene::parse(text, "dmt.toml", folder, &[]).unwrap_or_else(|e| panic!("{e}"));
    let surface = Surface::build(&scene).expect("a surface");
    let setup = Setup::new(scene, surface);
    let cpu = || cpu::double(None);
    let mut watch = Watch::default();
    walk(&setup, &cpu, &mut watch).expect("a run");
    (setup, watch.0)
}

/// Net pressure of the hard wall under 160 repulsive pressures from 100 Pa to 1 GPa, with the place of
/// each: 10.6 % apart, none skipped.
fn ladder(folder: &Path, law: &str) -> Vec<(f64, f64)> {
    rungs(folder, law, [100.0, 1e9], 160)
}

/// The same under `count` repulsive pressures between two, evenly in their logarithms.
fn rungs(folder: &Path, law: &str, [low, high]: [f64; 2], count: i32) -> Vec<(f64, f64)> {
    let path: Vec<f64> = (0..count)
        .map(|i| low * (high / low).powf(f64::from(i) / f64::from(count - 1)))
        .collect();
    let (law, _) = walked(folder, &scene(law, true, &[1e6]));
    let (_, rows) = walked(folder, &scene("", false, &path));
    let net = rows.iter().zip(&path).map(|((row, _, gaps), repulsive)| {
        let pull = attraction(&law, row, gaps);
        (*repulsive, repulsive - pull)
    });
    net.collect()
}

/// Mean attraction of the law across the open gaps of a field and where the staircase of pixels closes them, Pa.
fn attraction(setup: &Setup, row: &StepRow, gaps: &[f64]) -> f64 {
    let open = gaps.iter().map(|gap| setup.law.traction(*gap)).sum::<f64>() / 1024.0;
    let corrected = row.contact_area_fraction_corrected.unwrap_or(0.0);
    open + setup.law.traction(0.0) * (row.contact_area_fraction - corrected)
}

/// Factor between the repulsive pressures at which `compare` looks into a dip: two of its rungs, of a factor of
/// 1.15, cut into ten.
const CLOSER: f64 = 1.0284;
/// Share of E* times the rms slope from which its rungs are no longer than that.
const LIGHT: f64 = 2e-3;
/// Steps of the dip that `compare` is judged by: 0.05 % apart.
const STEPS: i32 = 401;

fn pull_off_is_the_greatest_of_all_dips() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("map.txt"), spiked()).expect("written");
    for law in LAWS {
        let ladder = ladder(folder.path(), law);
        let least = ladder.iter().map(|(_, net)| *net).fold(0.0, f64::min);
        // What makes this surface hard: the first dip is not the deepest, and presses in between.
        let first = ladder
            .windows(2)
            .position(|pair| pair[1].1 > pair[0].1)
            .expect("a dip");
        println!(
            "{law}: first dip {:.3e} Pa, deepest {least:.3e} Pa",
            ladder[first].1
        );
        assert!(ladder[first].1 > 0.5 * least);
        let text = scene(law, true, &[1e6, 1e7]);
        fs::write(folder.path().join("dmt.toml"), text).expect("written");
        let output = tabor(folder.path(), &["compare", "dmt.toml", "--out", law]);
        assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
        let table =
            fs::read_to_string(folder.path().join(law).join("compare.csv")).expect("a table");
        let row = table
            .lines()
            .find(|line| line.starts_with("DMT"))
            .expect("DMT");
        let cells: Vec<&str> = row.split(',').collect();
        let found: f64 = cells[5].parse().expect("a pull-off");
        println!("{law}: found {found:.4e}");
        // Between the rungs beside the deepest one, in steps of 0.05 % of the repulsive pressure. Over such a
        // step repulsion and attraction change by that share of themselves, and what a point loses that comes
        // into contact is seen on one side of it.
        let deepest = (1..ladder.len() - 1)
            .min_by(|a, b| ladder[*a].1.total_cmp(&ladder[*b].1))
            .expect("rungs");
        let ends = [ladder[deepest - 1].0, ladder[deepest + 1].0];
        let dip = rungs(folder.path(), law, ends, STEPS);
        let &(place, least) = dip
            .iter()
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .expect("a dip");
        // One of the places of `compare` is no farther from the bottom than half of those between them.
        let (setup, _) = walked(folder.path(), &scene(law, true, &[1e6]));
        let unit = 2e9 * setup.statistics.moments.rms_slope();
        assert!(place > LIGHT * unit, "{place} {unit}");
        let near = |at: f64| (at / place).ln().abs() <= 0.5 * CLOSER.ln();
        let shallowest = dip.iter().filter(|(at, _)| near(*at));
        let shallowest = shallowest.map(|(_, net)| *net).fold(least, f64::max);
        let step = 5e-4 * (2.0 * place - least);
        println!("{law}: at {place:.3e} Pa, between {shallowest:.4e} and {least:.4e}");
        assert!(
            found <= -least + step && found >= -shallowest - step,
            "{law}: {found} {shallowest} {least}"
        );
    }
}

fn a_load_is_met_on_the_closest_branch() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("map.txt"), spiked()).expect("written");
    for law in LAWS {
        let ladder = ladder(folder.path(), law);
        let least = ladder.iter().map(|(_, net)| *net).fold(0.0, f64::min);
        let asked: Vec<f64> = [-0.02, 0.0, 0.05, -0.5, -0.9, -0.98, -1.05]
            .iter()
            .map(|share| -share * least)
            .map(|net: f64| net)
            .collect();
        let (setup, rows) = walked(folder.path(), &scene(law, true, &asked));
        for ((row, mean, gaps), asked) in rows.iter().zip(&asked) {
            // The largest repulsive pressure of the ladder that is not yet above the load.
            let place = ladder.iter().rposition(|(_, net)| net <= asked);
            println!(
                "{law}: asked {asked:.3e}: {:?} force {:.6e} of {mean:.6e}, {} iterations",
                row.state, row.mean_pressure, row.iterations
            );
            assert!(row.converged);
            let Some(place) = place else {
                assert_eq!(row.contact_area_fraction, 0.0, "{law} {asked}");
                assert_eq!(row.mean_pressure, 0.0);
                continue;
            };
            // The row states the sum of the field. The search meets the load to a thousandth, and to 1e-9 of the
            // law's peak, which is 0.05 Pa.
            let scale = mean.abs().max(asked.abs());
            assert!(
                (row.mean_pressure - mean).abs() <= 1e-3 * scale + 1e-9 * PEAK,
                "{law} {asked}: {mean}"
            );
            let (_, below) = walked(folder.path(), &scene("", false, &[ladder[place].0]));
            // No balance under a larger repulsive pressure is missed.
            let area = row.contact_area_fraction;
            let least = below[0].0.contact_area_fraction;
            assert!(area >= least, "{law} {asked}: {area} {least}");
            // And it is one: the hard wall has its area and its sum under the repulsive pressures about its own, between
            // which a point may come into contact. A rung of the ladder is no bound on the area from above, for
            // between two there may be a balance that the ladder does not show.
            let repulsive = mean + attraction(&setup, row, gaps);
            let path = [1.0 - BESIDE, 1.0 + BESIDE].map(|share| share * repulsive);
            let (_, walls) = walked(folder.path(), &scene("", false, &path));
            let nets = [0, 1].map(|i| path[i] - attraction(&setup, &walls[i].0, &walls[i].2));
            let areas = [0, 1].map(|i| walls[i].0.contact_area_fraction);
            let off = |found: f64, ends: [f64; 2]| {
                (ends[0].min(ends[1]) - found).max(found - ends[0].max(ends[1]))
            };
            let what = format!("{law} {asked}: {mean} of {nets:?}, {area} of {areas:?}");
            let allowed = BESIDE * (2.0 * repulsive - mean);
            assert!(off(*mean, nets) <= allowed, "{what}");
            assert!(off(area, areas) * 1024.0 < 0.5, "{what}");
        }
    }
}

/// Share of a repulsive pressure by which it is left to see both sides of a point's contact. A solve to 1e-6 of the
/// pressures knows the load at which a point comes into contact no better than some times that, and points that
/// come by four or eight do so some thousandths apart.
const BESIDE: f64 = 1e-4;

/// Nearly flat surfaces under Lennard-Jones hold more tension just out of contact than at first touch: each point
/// pulls most at a gap of its own. Without contact nothing is deformed, so the closed form is the mean of the law over
/// the undeformed gap.
fn a_tension_is_held_across_a_gap() {
    let folder = tempfile::tempdir().expect("a folder");
    let wave = |i: i32| (2.0 * std::f64::consts::PI * f64::from(i) / 32.0).cos();
    let rows = (0..32).map(|y| {
        let row = (0..32).map(|x| format!("{:.9}", 0.02 * (wave(2 * x) + wave(2 * y))));
        row.collect::<Vec<_>>().join(" ")
    });
    let text = rows.collect::<Vec<_>>().join("\n");
    fs::write(folder.path().join("map.txt"), text).expect("written");
    // w/range (8/3) ((1 + g)^-3 - (1 + g)^-9) over gaps in nm, range 1 nm.
    let pull = |clearance: f64| {
        let sum: f64 = (0..32)
            .flat_map(|y| (0..32).map(move |x| (x, y)))
            .map(|(x, y)| 0.04 - 0.02 * (wave(2 * x) + wave(2 * y)) + clearance)
            .map(|gap| (1.0 + gap).powi(-3) - (1.0 + gap).powi(-9))
            .sum();
        50e6 * 8.0 / 3.0 * sum / 1024.0
    };
    let touch = pull(0.0);
    let (best, most) = (0..2000)
        .map(|i| 1e-3 * f64::from(i))
        .map(|clearance| (clearance, pull(clearance)))
        .max_by(|a, b| a.1.total_cmp(&b.1))
        .expect("a greatest");
    assert!(best > 0.0 && most > 1.2 * touch, "{best} {touch} {most}");
    let asked: Vec<f64> = [0.1, 0.5, 0.9, 0.999]
        .iter()
        .map(|share| -(touch + share * (most - touch)))
        .chain([-1.01 * most, -0.5 * (touch + most), -0.5 * touch])
        .collect();
    let (_, rows) = walked(folder.path(), &scene("lennard-jones", true, &asked));
    for ((row, mean, gaps), asked) in rows.iter().zip(&asked) {
        println!(
            "asked {asked:.4e} of {most:.4e}: {:?}, {mean:.6e}",
            row.state
        );
        assert!(row.converged, "{row:?}");
        if -asked > most {
            assert_eq!((row.state, row.mean_gap), (State::Separated, None));
            continue;
        }
        assert!((mean / asked - 1.0).abs() < 1e-6, "{mean} {asked}");
        if -asked < touch {
            assert_eq!(row.state, State::Contact);
            continue;
        }
        assert_eq!(row.state, State::Attracted);
        let clearance = 1e9 * gaps.iter().copied().fold(f64::INFINITY, f64::min);
        assert!(clearance > 0.0 && clearance < best, "{clearance} {best}");
        assert!((pull(clearance) / -asked - 1.0).abs() < 1e-6);
    }
    // So `compare` finds, which asks for the greatest of all.
    let text = scene("lennard-jones", true, &[1e6]);
    fs::write(folder.path().join("dmt.toml"), text).expect("written");
    let output = tabor(folder.path(), &["compare", "dmt.toml", "--out", "flat"]);
    assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    let table = fs::read_to_string(folder.path().join("flat/compare.csv")).expect("a table");
    let row = table.lines().find(|line| line.starts_with("DMT"));
    let cells: Vec<&str> = row.expect("DMT").split(',').collect();
    let found: f64 = cells[5].parse().expect("a pull-off");
    // Its clearances are a twenty-eighth apart, of which half changes the crest by less than a thousandth.
    assert!((found / most - 1.0).abs() < 1e-3, "{found} {most}");
}
tests![
    pull_off_is_the_greatest_of_all_dips,
    a_load_is_met_on_the_closest_branch,
    a_tension_is_held_across_a_gap,
];
