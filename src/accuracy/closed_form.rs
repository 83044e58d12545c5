//! Closed-form solutions at each step of a scene's path, for scenes that have one.

use std::f64::consts::PI;

use super::errors::Errors;
use super::measure::{Point, most_compressed_step};
use super::reference::Reference;
use crate::grid::Grid;
use crate::scene::{Boundary, Control, LawName, Range, Scene, SurfacePart};
use crate::theory::maugis_dugdale::{FOLD_LAMBDA, MaugisDugdale};
use crate::theory::tabor_map::{MaugisScales, maugis_parameter};
use crate::theory::{Sphere, TheoryError, hertz, jkr, westergaard};

/// Samples along a side of a cell over which a closed-form pressure is averaged.
const SAMPLES: usize = 64;

/// The closed-form reference of a scene whose grid and centres are given, if there is one: a sphere
/// on a free boundary (Hertz, Maugis, and JKR for `range = "auto"`), and a line wave under a load
/// without adhesion (Westergaard).
pub fn closed_form(scene: &Scene, cells: [usize; 2]) -> Option<Reference> {
    let solid = &scene.solid;
    let plain = solid.layer.is_none()
        && solid.hardness.is_none()
        && solid.relaxation.is_empty()
        && scene.loading.spring.is_none();
    let varies = scene
        .adhesion
        .as_ref()
        .is_some_and(|law| law.map.is_some() || law.rate.is_some());
    let mut shaped = scene
        .surfaces
        .iter()
        .filter(|part| !matches!(part, SurfacePart::Flat));
    let (part, None) = (shaped.next()?, shaped.next()) else {
        return None;
    };
    if !plain || varies {
        return None;
    }
    let size = scene.grid.size?;
    let found = match part {
        SurfacePart::Sphere { radius, centre } if scene.grid.boundary == Boundary::Free => {
            sphere(scene, *radius, (*centre)?, size, cells)
        }
        SurfacePart::Wavy {
            amplitude,
            wavelength,
        } if scene.grid.boundary == Boundary::Periodic && scene.adhesion.is_none() => {
            wave(scene, *amplitude, *wavelength, size, cells)
        }
        _ => return None,
    };
    // Outside its range of validity a theory is no reference; the solution on finer grids is used
    // instead.
    found.ok().flatten()
}

fn reference(
    words: &str,
    steps: Vec<Option<Point>>,
    pull_off: Option<f64>,
    profile: Option<Vec<f64>>,
) -> Reference {
    let known = |quantity: bool| quantity.then_some(0.0);
    Reference {
        uncertainty: Errors {
            area: Some(0.0),
            force: Some(0.0),
            pressure: known(profile.is_some()),
            pull_off: known(pull_off.is_some()),
        },
        steps,
        pull_off,
        profile,
        orders: [None; 4],
        words: format!("the closed form of {words}"),
        points: None,
    }
}

/// An equilibrium of a sphere, SI.
#[derive(Clone, Copy, Debug)]
struct Held {
    contact_radius: f64,
    cohesive_radius: f64,
    force: f64,
    approach: f64,
}

/// A theory of the sphere, with the branches of equilibria that a path follows.
enum Theory {
    Hertz(Sphere),
    Jkr(Sphere),
    Maugis(MaugisDugdale, MaugisScales),
}

fn sphere(
    scene: &Scene,
    radius: f64,
    centre: [f64; 2],
    size: [f64; 2],
    cells: [usize; 2],
) -> Result<Option<Reference>, TheoryError> {
    let modulus = scene.solid.contact_modulus;
    let (words, theory) = match &scene.adhesion {
        None => ("Hertz", Theory::Hertz(Sphere::new(radius, modulus, 0.0)?)),
        Some(law) => {
            let sphere = Sphere::new(radius, modulus, law.work_of_adhesion)?;
            match (law.range, law.law, law.taper) {
                (Range::Auto, ..) => ("JKR", Theory::Jkr(sphere)),
                (Range::Length(range), LawName::MaugisDugdale, None | Some(0.0)) => {
                    let lambda = maugis_parameter(&sphere, law.work_of_adhesion / range)?;
                    let maugis = MaugisDugdale::new(lambda)?;
                    ("Maugis", Theory::Maugis(maugis, sphere.maugis_scales()?))
                }
                // No closed form for other laws or for a given taper.
                _ => return Ok(None),
            }
        }
    };
    let by_force = match scene.loading.control {
        Control::Approach => false,
        Control::Force => true,
        Control::Pressure | Control::MeanGap => return Ok(None),
    };
    let area = size[0] * size[1];
    let most_compressed_step = most_compressed_step(scene);
    let mut branch = Branch::Separated;
    let mut steps = Vec::with_capacity(scene.loading.path.len());
    let mut profile = None;
    let mut touched = false;
    let mut passed = false;
    let greatest = theory.pull_off()?;
    for (step, value) in scene.loading.path.iter().copied().enumerate() {
        let (next, held) = theory.follow(branch, value, by_force)?;
        touched |= branch == Branch::Touching;
        branch = next;
        // A path reaches pull-off only from contact and beyond the approach of the greatest
        // tension.
        if let Some(greatest) = &greatest {
            let beyond = if by_force {
                value < greatest.force
            } else {
                value < greatest.approach
            };
            passed |= touched && beyond;
        }
        let point = match held {
            Some(held) => Point {
                area: PI * held.contact_radius * held.contact_radius / area,
                answer: Some(if by_force { held.approach } else { held.force }),
            },
            None => Point {
                area: 0.0,
                answer: (!by_force).then_some(0.0),
            },
        };
        steps.push(Some(point));
        if step == most_compressed_step
            && let Some(held) = held
        {
            let grid = Grid::new(cells, size);
            profile = Some(averaged(&grid, |x, y| {
                let r = (x - centre[0]).hypot(y - centre[1]);
                if r < held.cohesive_radius {
                    theory.pressure(&held, r)
                } else {
                    0.0
                }
            }));
        }
    }
    let pull_off = greatest.filter(|_| passed).map(|held| -held.force);
    Ok(Some(reference(words, steps, pull_off, profile)))
}

/// The branch of equilibria of the sphere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Branch {
    Separated,
    /// Attracted without contact.
    Open,
    Touching,
}

impl Theory {
    /// The state of greatest tension; `None` without adhesion.
    fn pull_off(&self) -> Result<Option<Held>, TheoryError> {
        Ok(match self {
            Theory::Hertz(_) => None,
            Theory::Jkr(sphere) => {
                let scales = sphere.maugis_scales()?;
                Some(jkr_at(sphere, scales.radius * jkr::pull_off()))
            }
            Theory::Maugis(theory, scales) => Some(scaled(&theory.pull_off()?, scales)),
        })
    }

    /// Follows a path to its next value: a touching sphere stays in contact as long as that state
    /// exists. Under a force it touches wherever a contact carries the force, since the solver begins
    /// where the surfaces touch.
    fn follow(
        &self,
        from: Branch,
        value: f64,
        by_force: bool,
    ) -> Result<(Branch, Option<Held>), TheoryError> {
        let touching = self.touching(value, by_force)?;
        let separated = Ok((Branch::Separated, None));
        let (theory, scales) = match self {
            Theory::Hertz(_) | Theory::Jkr(_) => {
                // Without a range there is no attraction before contact.
                let meets = by_force || from == Branch::Touching || value >= 0.0;
                return match touching.filter(|_| meets) {
                    Some(held) => Ok((Branch::Touching, Some(held))),
                    None => separated,
                };
            }
            Theory::Maugis(theory, scales) => (theory, scales),
        };
        if by_force {
            return match touching {
                Some(held) => Ok((Branch::Touching, Some(held))),
                None => separated,
            };
        }
        let approach = value / scales.approach;
        if from == Branch::Separated && approach < -theory.range() {
            return separated;
        }
        let fold = 8.0 / (3.0 * PI) * theory.lambda();
        let open = theory
            .open_states_at_approach(approach)?
            .into_iter()
            .rev()
            .find(|state| state.cohesive_radius >= fold * (1.0 - 1e-12))
            .map(|state| (Branch::Open, Some(scaled(&state, scales))));
        let touching = touching.map(|held| (Branch::Touching, Some(held)));
        let found = match from {
            Branch::Touching => touching.or(open),
            Branch::Open | Branch::Separated => open.or(touching),
        };
        found.map_or(separated, Ok)
    }

    /// The stable touching state at an approach or under a force.
    fn touching(&self, value: f64, by_force: bool) -> Result<Option<Held>, TheoryError> {
        Ok(match self {
            Theory::Hertz(sphere) => {
                if value <= 0.0 {
                    return Ok(None);
                }
                let radius = if by_force {
                    hertz::contact_radius(sphere, value)?
                } else {
                    hertz::contact_radius_at_approach(sphere, value)?
                };
                Some(Held {
                    contact_radius: radius,
                    cohesive_radius: radius,
                    force: hertz::force(sphere, radius),
                    approach: hertz::approach(sphere, radius),
                })
            }
            Theory::Jkr(sphere) => {
                // Beyond the fold no state exists.
                let radius = if by_force {
                    jkr::contact_radius(sphere, value)
                } else {
                    jkr::contact_radius_at_approach(sphere, value)
                };
                radius.ok().map(|radius| jkr_at(sphere, radius))
            }
            Theory::Maugis(theory, scales) => {
                let states = if by_force {
                    theory.states_at_force(value / scales.force)?
                } else {
                    theory.states_at_approach(value / scales.approach)?
                };
                // Below the lambda of the fold the contact shrinks to a point first.
                let least = if theory.lambda() > FOLD_LAMBDA || by_force {
                    0.0
                } else {
                    1e-8
                };
                let last = states.last().filter(|state| state.contact_radius > least);
                last.map(|state| scaled(state, scales))
            }
        })
    }

    /// Net pressure, Pa.
    fn pressure(&self, held: &Held, r: f64) -> f64 {
        match self {
            Theory::Hertz(sphere) => hertz::pressure(sphere, held.contact_radius, r),
            Theory::Jkr(sphere) => jkr::pressure(sphere, held.contact_radius, r),
            Theory::Maugis(theory, scales) => {
                let state = crate::theory::maugis_dugdale::State {
                    contact_radius: held.contact_radius / scales.radius,
                    cohesive_radius: held.cohesive_radius / scales.radius,
                    force: 0.0,
                    approach: 0.0,
                    central_gap: 0.0,
                };
                let unit = scales.force / (scales.radius * scales.radius);
                unit * theory.pressure(&state, r / scales.radius)
            }
        }
    }
}

fn jkr_at(sphere: &Sphere, radius: f64) -> Held {
    Held {
        contact_radius: radius,
        cohesive_radius: radius,
        force: jkr::force(sphere, radius),
        approach: jkr::approach(sphere, radius),
    }
}

fn scaled(state: &crate::theory::maugis_dugdale::State, scales: &MaugisScales) -> Held {
    Held {
        contact_radius: state.contact_radius * scales.radius,
        cohesive_radius: state.cohesive_radius * scales.radius,
        force: state.force * scales.force,
        approach: state.approach * scales.approach,
    }
}

/// Means of `pressure(x, y)` over the cells of a grid, shape `[ny, nx]`.
fn averaged(grid: &Grid, pressure: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    let offset = |sample: usize, pixel: f64| ((sample as f64 + 0.5) / SAMPLES as f64 - 0.5) * pixel;
    let mut means = Vec::with_capacity(grid.len());
    for iy in 0..grid.ny {
        for ix in 0..grid.nx {
            let mut sum = 0.0;
            for sy in 0..SAMPLES {
                let y = iy as f64 * grid.dy() + offset(sy, grid.dy());
                for sx in 0..SAMPLES {
                    let here = pressure(ix as f64 * grid.dx() + offset(sx, grid.dx()), y);
                    // The pressure is singular at a crack tip; count it as 0 there.
                    sum += if here.is_finite() { here } else { 0.0 };
                }
            }
            means.push(sum / (SAMPLES * SAMPLES) as f64);
        }
    }
    means
}

fn wave(
    scene: &Scene,
    amplitude: f64,
    wavelength: [f64; 2],
    size: [f64; 2],
    cells: [usize; 2],
) -> Result<Option<Reference>, TheoryError> {
    let (length, across) = match wavelength.map(f64::is_finite) {
        [true, false] => (wavelength[0], 0),
        [false, true] => (wavelength[1], 1),
        _ => return Ok(None),
    };
    let by_pressure = match scene.loading.control {
        Control::Pressure => 1.0,
        Control::Force => 1.0 / (size[0] * size[1]),
        Control::Approach | Control::MeanGap => return Ok(None),
    };
    let unit =
        westergaard::full_contact_pressure(scene.solid.contact_modulus, amplitude.abs(), length)?;
    // A negative amplitude shifts the crests by half a wave.
    let shift = if amplitude < 0.0 { 0.5 } else { 0.0 };
    let most_compressed_step = most_compressed_step(scene);
    let mut profile = None;
    let mut steps = Vec::new();
    for (step, value) in scene.loading.path.iter().enumerate() {
        let mean = value * by_pressure / unit;
        if mean <= 0.0 {
            steps.push(Some(Point {
                area: 0.0,
                answer: None,
            }));
            continue;
        }
        let (held, beyond) = (mean.min(1.0), (mean - 1.0).max(0.0));
        let half_width = westergaard::half_width(held)?;
        steps.push(Some(Point {
            area: 2.0 * half_width,
            answer: Some(amplitude.abs() * westergaard::mean_gap(held)?),
        }));
        if step == most_compressed_step {
            let grid = Grid::new(cells, size);
            profile = Some(averaged(&grid, |x, y| {
                let place = [x, y][across] / length + shift;
                let from_crest = place - place.round();
                let pressure = westergaard::pressure(half_width, from_crest);
                unit * (pressure.unwrap_or(0.0) + beyond)
            }));
        }
    }
    Ok(Some(reference("Westergaard", steps, None, profile)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Contact area over nominal area of a sphere of R, K and pi w of 1 on a cell of side 8 under these forces.
    fn areas(range: &str, path: &str) -> Vec<f64> {
        let text = format!(
            r#"
            [grid]
            points = 16
            size = 8.0
            boundary = "free"
            [solid]
            contact_modulus = 0.75
            [[surface]]
            kind = "sphere"
            radius = 1.0
            centre = [4.0, 4.0]
            [adhesion]
            law = "maugis-dugdale"
            work_of_adhesion = 0.3183098861837907
            range = {range}
            [loading]
            control = "force"
            path = {path}
            "#
        );
        let parsed = Scene::parse(&text, "test.toml", std::path::Path::new("."), &[]);
        let scene = parsed.unwrap_or_else(|errors| panic!("{errors}"));
        let found = closed_form(&scene, [16, 16]).expect("a closed form");
        let areas = found.steps.iter().map(|step| step.expect("known").area);
        areas.collect()
    }

    /// The radius without load is 1.51738353 at lambda = 0.5, where pull-off is at -1.718, and that of JKR 6^(1/3).
    #[test]
    fn a_contact_that_carries_the_force_is_found_from_separation_too() {
        let path = "[0.0, -1.0, -3.0, -1.0]";
        for (range, radius) in [
            ("1.2732395447351628", 1.517_383_53),
            ("\"auto\"", 6_f64.cbrt()),
        ] {
            let areas = areas(range, path);
            let expected = PI * radius * radius / 64.0;
            assert!((areas[0] / expected - 1.0).abs() < 1e-7, "{areas:?}");
            assert!(areas[1] > 0.0 && areas[2] == 0.0 && areas[3] == areas[1]);
        }
    }
}
