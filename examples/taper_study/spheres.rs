//! Spheres in Maugis' units on a free boundary, against Maugis 1992.

use std::f64::consts::PI;

use tabor::study::{State, StepRow};
use tabor::theory::maugis_dugdale::{FOLD_LAMBDA, MaugisDugdale};

use crate::run::{Failure, percent, solve};
use crate::{Part, TAPERS, Taper};

/// E* where K = 4E*/3 is 1.
const MODULUS: f64 = 0.75;
/// Step of the load around pull-off, over pull-off.
const STEP: f64 = 0.0025;

const LEGEND: &str = "Spheres on a free boundary: pull-off off by %, force on the way out off by % of 2 pi w R at most, \
jump-in at (-ranges; its closed form is 1, and 1 + W/(2 h0) with the reach of the law), hysteresis over the closed form, transforms";

#[derive(Clone, Copy)]
struct Sphere {
    lambda: f64,
    points: usize,
}

pub fn part() -> Part {
    let spheres = [
        (0.5, 64),
        (1.0, 64),
        (2.0, 48),
        (2.0, 64),
        (2.0, 96),
        (3.0, 64),
        (4.0, 64),
    ];
    let rows = spheres.map(|(lambda, points)| {
        let sphere = Sphere { lambda, points };
        let chi = PI * lambda * lambda * sphere.side() / points as f64 / 3.0;
        let jobs = TAPERS.map(|taper| -> crate::Job { Box::new(move || sphere.cell(taper)) });
        (
            format!("lambda {lambda}, {points} points"),
            chi,
            jobs.into(),
        )
    });
    Part {
        name: "sphere",
        legend: LEGEND,
        rows: rows.into(),
    }
}

impl Sphere {
    fn theory(&self) -> MaugisDugdale {
        MaugisDugdale::new(self.lambda).expect("a lambda of the list")
    }

    /// Side of the grid: the cohesive zone at zero load with a margin.
    fn side(&self) -> f64 {
        let zero = self.theory().states_at_force(0.0).ok();
        2.3 * zero
            .and_then(|states| states.last().map(|s| s.cohesive_radius))
            .unwrap_or(1.0)
    }

    fn scene(&self, taper: f64, control: &str, path: &[f64]) -> String {
        format!(
            "[grid]\npoints = {}\nsize = {:e}\nboundary = \"free\"\n[solid]\ncontact_modulus = {MODULUS}\n\
             [[surface]]\nkind = \"sphere\"\nradius = 1.0\n\
             [adhesion]\nlaw = \"maugis-dugdale\"\nwork_of_adhesion = {:e}\nrange = {:e}\ntaper = {taper:e}\n\
             [loading]\ncontrol = \"{control}\"\npath = {path:?}\n",
            self.points,
            self.side(),
            1.0 / PI,
            self.theory().range(),
        )
    }

    fn cell(&self, taper: Taper) -> Result<String, Failure> {
        let theory = self.theory();
        let range = theory.range();
        let taper = taper.length(
            theory.tension(),
            self.side() / self.points as f64,
            MODULUS,
            range,
        );
        let apart = |row: &StepRow| row.state == State::Separated;
        let pull_off = -theory.pull_off()?.force;
        let near = (0..80).map(|i| 0.965 + STEP * f64::from(i));
        let shares = [0.0, 0.6, 0.9].into_iter().chain(near);
        let path: Vec<f64> = shares.map(|share| -share * pull_off).collect();
        let pulled = solve(&self.scene(taper, "force", &path), None, apart)?;
        let held = pulled.rows.iter().filter(|row| !apart(row));
        let held = held.map(|row| -row.force).fold(0.0, f64::max);

        // In past the jump, further to compression, and out until it separates.
        let step = 0.02 * range;
        let first = -(range + 0.5 * taper) - 1.5 * step;
        let zero = theory.states_at_force(0.0)?;
        let deepest = zero.last().ok_or("no state without load")?.approach + 0.3;
        let least = if self.lambda > FOLD_LAMBDA {
            theory.grip()?.approach
        } else {
            theory.state(1e-6)?.approach
        };
        let mut path: Vec<f64> = (0..40).map(|i| first + step * f64::from(i)).collect();
        path.retain(|approach| *approach < -0.7 * range);
        let ways = |from: f64, to: f64, count: u32| {
            (1..=count).map(move |i| from + (to - from) * f64::from(i) / f64::from(count))
        };
        path.extend(ways(path[path.len() - 1], deepest, 8));
        let turn = path.len();
        path.extend(ways(deepest, least + 0.1, 12));
        path.extend((1..60).map(|i| least + 0.1 - 0.02 * f64::from(i)));
        let looped = solve(&self.scene(taper, "approach", &path), None, |row| {
            row.step > turn && apart(row)
        })?;
        let meets = looped.rows.iter().find(|row| row.state == State::Contact);
        let meets = meets.map_or(f64::NAN, |row| path[row.step - 1]);
        let mut error = 0.0_f64;
        for row in looped.rows.iter().skip(turn) {
            let at = path[row.step - 1];
            if at > least + 0.05 {
                let states = theory.states_at_approach(at)?;
                let there = states.last().ok_or("no state on the way out")?;
                error = error.max(0.5 * (row.force - there.force).abs());
            }
        }
        let area = |rows: &[StepRow]| -> f64 {
            rows.windows(2)
                .map(|pair| {
                    let way = path[pair[1].step - 1] - path[pair[0].step - 1];
                    0.5 * (pair[0].force + pair[1].force) * way
                })
                .sum()
        };
        let lost = area(&looped.rows);
        // Between jump-in and the fold there is no force on loading.
        let closed: f64 = {
            let count = 400;
            let ways: Vec<_> = (0..=count)
                .map(|i| least + (-range - least) * f64::from(i) / f64::from(count))
                .filter_map(|at| Some((at, theory.states_at_approach(at).ok()?.last()?.force)))
                .collect();
            ways.windows(2)
                .map(|pair| -0.5 * (pair[0].1 + pair[1].1) * (pair[1].0 - pair[0].0))
                .sum()
        };
        let hysteresis = if self.lambda > FOLD_LAMBDA && -range > least {
            format!("{:.2}", lost / closed)
        } else {
            "-".to_owned()
        };
        Ok(format!(
            "{} {:.1} {:.2} ({:.2}) {hysteresis} {:.0}",
            percent(held / pull_off - 1.0 + 0.5 * STEP),
            100.0 * error,
            -meets / range,
            1.0 + 0.5 * taper / range,
            pulled.transforms + looped.transforms
        ))
    }
}
