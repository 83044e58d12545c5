//! Surfaces whose rms height is near the range, which part as a whole, compared with the sharp law on a grid four times as fine.

use std::sync::{Arc, OnceLock};

use tabor::study::{State, WalkEnd};

use crate::run::{Failure, percent, solve};
use crate::{Part, TAPERS, Taper};

const SIZE: f64 = 2e-6;
const MODULUS: f64 = 5e9;
const RANGE: f64 = 1.5e-9;
/// Points a side, and those of the reference.
const POINTS: [usize; 2] = [48, 192];
/// Pixels in the shortest wave.
const SHORTEST: f64 = 10.0;
/// Factor from one tension to the next.
const STEP: f64 = 1.01;

const LEGEND: &str = "Rough surfaces of 48 x 48 points, 10 of them in the shortest wave, pulled off: pull-off off by % (steps of 1 %); against \
the sharp law (a width of 0) with four times the points";

pub fn part() -> Part {
    let mut rows = Vec::new();
    for chi in [0.1, 0.3] {
        for roughness in [0.15, 0.33, 0.6, 1.0] {
            let reference = Arc::new(OnceLock::new());
            let jobs = TAPERS.map(|taper| -> crate::Job {
                let reference = Arc::clone(&reference);
                Box::new(move || {
                    let sharp = Taper {
                        width: 0.0,
                        ..taper
                    };
                    let [points, fine] = POINTS;
                    let reference = reference.get_or_init(|| {
                        pull_off(fine, chi, roughness, sharp).map_err(|error| error.to_string())
                    });
                    let reference = reference.as_ref().map_err(Clone::clone)?;
                    let found = pull_off(points, chi, roughness, taper)?;
                    Ok(percent(found / reference - 1.0))
                })
            });
            rows.push((format!("rms height {roughness} h0"), chi, jobs.into()));
        }
    }
    Part {
        name: "smooth",
        legend: LEGEND,
        rows,
    }
}

/// The greatest tension that is held, Pa, with a work of adhesion for this chi on the coarse grid.
fn pull_off(points: usize, chi: f64, roughness: f64, taper: Taper) -> Result<f64, Failure> {
    let pixel = SIZE / POINTS[0] as f64;
    let work = chi * MODULUS * RANGE * RANGE / pixel;
    let peak = work / RANGE;
    let length = taper.length(peak, pixel, MODULUS, RANGE);
    let mut path = vec![2.0 * peak, 0.0];
    let mut tension = 0.1 * peak;
    while tension < peak {
        path.push(-tension);
        tension *= STEP;
    }
    let text = format!(
        "[grid]\npoints = {points}\nsize = {SIZE:e}\n[solid]\ncontact_modulus = {MODULUS:e}\n\
         [[surface]]\nkind = \"self-affine\"\nhurst = 0.7\nrms_height = {:e}\nlongest = {SIZE:e}\nrolloff = {:e}\nshortest = {:e}\nseed = 3\n\
         [adhesion]\nlaw = \"maugis-dugdale\"\nwork_of_adhesion = {work:e}\nrange = {RANGE:e}\ntaper = {length:e}\n\
         [loading]\ncontrol = \"pressure\"\npath = {path:?}\n",
        roughness * RANGE,
        0.5 * SIZE,
        SHORTEST * pixel,
    );
    let end: WalkEnd = solve(&text, None, |row| row.state == State::Separated)?;
    let held = end.rows.iter().filter(|row| row.state != State::Separated);
    let greatest = held.map(|row| -row.mean_pressure).fold(0.0, f64::max);
    Ok(greatest * 0.5 * (1.0 + STEP))
}
