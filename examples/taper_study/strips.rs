//! Johnson's adhesive wave, with its crests along, across and oblique to the grid.

use std::f64::consts::{PI, TAU};

use tabor::study::State;
use tabor::theory::cohesive_wave::CohesiveWave;
use tabor::theory::westergaard::adhesive_extrema;

use crate::run::{Failure, percent, solve};
use crate::{Part, TAPERS, Taper};

const AMPLITUDE: f64 = 0.01;
/// Step of the load around an extremum, relative to it.
const STEP: f64 = 0.0025;

/// Points of a cell that holds an oblique wave.
const SQUARE: [usize; 2] = [128, 128];

const LEGEND: &str = "Waves of Johnson's alpha on a periodic cell under pressure: pull-off and the snap into full contact \
off by %, contact areas on loading and unloading apart by pixels of a wave's length, transforms";

/// A wave with the wavevector `waves` over the cell of `points`; its length is 1.
#[derive(Clone, Copy)]
struct Strip {
    points: [usize; 2],
    waves: [f64; 2],
    adhesion: f64,
    chi: f64,
}

pub fn part() -> Part {
    let mut rows = Vec::new();
    let few = [0.1, 0.25, 0.65].as_slice();
    let many = [0.05, 0.1, 0.25, 0.5, 0.65, 0.8, 1.3].as_slice();
    let waves = [
        ("along y, alpha 0.3", [512, 2], [1.0, 0.0], 0.3, many),
        ("along y, alpha 0.1", [512, 2], [1.0, 0.0], 0.1, few),
        ("along x, alpha 0.3", [2, 300], [0.0, 1.0], 0.3, few),
        ("at 45 degrees, alpha 0.3", SQUARE, [1.0, 1.0], 0.3, few),
        ("at 27 degrees, alpha 0.1", SQUARE, [2.0, 1.0], 0.1, few),
    ];
    for (name, points, waves, adhesion, chis) in waves {
        for &chi in chis {
            let strip = Strip {
                points,
                waves,
                adhesion,
                chi,
            };
            let jobs = TAPERS.map(|taper| -> crate::Job { Box::new(move || strip.cell(taper)) });
            rows.push((name.to_owned(), chi, jobs.into()));
        }
    }
    Part {
        name: "strip",
        legend: LEGEND,
        rows,
    }
}

impl Strip {
    /// Side of a pixel in wavelengths.
    fn pixel(&self) -> f64 {
        let [x, y] = [0, 1].map(|axis| self.waves[axis] / self.points[axis] as f64);
        x.hypot(y)
    }

    fn work(&self) -> f64 {
        0.5 * (self.adhesion * PI * AMPLITUDE).powi(2)
    }

    fn range(&self) -> f64 {
        (self.work() * self.pixel() / self.chi).sqrt()
    }

    fn scene(&self, taper: Taper, path: &[f64]) -> String {
        let (work, range, pixel) = (self.work(), self.range(), self.pixel());
        let [nx, ny] = self.points;
        format!(
            "[grid]\npoints = [{nx}, {ny}]\nsize = [{:e}, {:e}]\n[solid]\ncontact_modulus = 1.0\n\
             [[surface]]\nkind = \"wavy\"\namplitude = {AMPLITUDE}\nwavelength = {:e}\n\
             [adhesion]\nlaw = \"maugis-dugdale\"\nwork_of_adhesion = {work:e}\nrange = {range:e}\ntaper = {:e}\n\
             [loading]\ncontrol = \"pressure\"\npath = {path:?}\n",
            nx as f64 * pixel,
            ny as f64 * pixel,
            // Replaced by the heights below; a wave that fits any cell.
            nx as f64 * pixel,
            taper.length(work / range, pixel, 1.0, range),
        )
    }

    fn heights(&self) -> Vec<f64> {
        let [nx, ny] = self.points;
        let phase = |axis: usize, i: usize| self.waves[axis] * i as f64 / self.points[axis] as f64;
        (0..ny)
            .flat_map(|y| (0..nx).map(move |x| (x, y)))
            .map(|(x, y)| AMPLITUDE * (TAU * (phase(0, x) + phase(1, y))).cos())
            .collect()
    }

    fn cell(&self, taper: Taper) -> Result<String, Failure> {
        let heights = self.heights();
        let full = PI * AMPLITUDE;
        let theory = CohesiveWave::new(self.adhesion, self.range() / AMPLITUDE)?;
        let off = theory.pull_off()?.mean_pressure * full;
        // A long range closes the wave without a snap.
        let closing = theory
            .closing()
            .ok()
            .map(|state| state.mean_pressure * full);
        let most = adhesive_extrema(self.adhesion)?.closing_pressure * full;
        let path = |start: &[f64], turn: f64| -> Vec<f64> {
            let near = (0..140).map(|i| 0.965 + STEP * f64::from(i));
            let way = [0.7, 0.9].into_iter().chain(near).map(|share| share * turn);
            start.iter().copied().chain(way).collect()
        };
        // Up, down and into tension; then from zero load until it closes.
        let up = [0.0, 0.25, 0.5, 0.75, 0.5, 0.25, 0.0].map(|share| share * most);
        let unloading = solve(&self.scene(taper, &path(&up, off)), Some(&heights), |row| {
            row.state == State::Separated
        })?;
        let mut transforms = unloading.transforms;
        let mut snap = "-".to_owned();
        if let Some(closing) = closing {
            let scene = self.scene(taper, &path(&[0.0], closing));
            let loading = solve(&scene, Some(&heights), |row| {
                row.contact_area_fraction == 1.0
            })?;
            let open = loading
                .rows
                .iter()
                .filter(|row| row.contact_area_fraction < 1.0);
            let open = open.map(|row| row.mean_pressure).fold(0.0, f64::max);
            snap = percent(open / closing - 1.0 + 0.5 * STEP);
            transforms += loading.transforms;
        }
        let held = unloading
            .rows
            .iter()
            .filter(|row| row.state == State::Contact)
            .map(|row| -row.mean_pressure)
            .fold(0.0, f64::max);
        let apart = (0..3)
            .map(|i| {
                let [up, down] = [i, 6 - i].map(|step| unloading.rows[step].contact_area_fraction);
                (up - down).abs() / self.pixel()
            })
            .fold(0.0, f64::max);
        Ok(format!(
            "{} {snap} {apart:.0} {transforms:.0}",
            percent(held / -off - 1.0 + 0.5 * STEP),
        ))
    }
}
