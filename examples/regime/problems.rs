//! The contacts: spheres, smooth and rough, drawn over law, Tabor number, roughness and load; and their full fields.

use std::error::Error;
use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;
use std::path::Path;

use tabor::backend::cpu;
use tabor::scene::Scene;
use tabor::study::{Setup, walk};
use tabor::surface::Surface;

use super::random::Random;

/// Steps of each direction.
const STEPS: usize = 64;
/// Peak tension of the Lennard-Jones law over work by range.
const LENNARD_JONES_PEAK: f64 = 1.026_400_478_6;

/// A contact in units of radius, work of adhesion and range, which are 1; without a law of a modulus of 1 in place of
/// the work.
#[derive(Clone, Debug)]
pub struct Problem {
    /// Its number, from 0.
    pub number: usize,
    /// Name of the law in a scene, or `none`.
    pub law: &'static str,
    /// Tabor number of the Lennard-Jones law with the same work and peak tension; 0 without a law.
    pub tabor: f64,
    /// Rms height over the range.
    pub rms_height: f64,
    /// Greatest load over `2 pi w R` that a smooth sphere would reach.
    pub load: f64,
    /// Changes to the scene, for contacts outside the set that the advice is trained on.
    pub outside: Option<Outside>,
    /// Its curve in closed form, in place of a full field.
    pub closed: Option<Closed>,
}

/// Contacts in closed form.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Closed {
    /// A stiff sphere with the law of Maugis and Dugdale.
    Stiff,
    /// DMT itself: no attraction before contact.
    Dmt,
    /// JKR itself.
    Jkr,
}

/// Contacts that no model of the advice is made for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outside {
    /// A cone of this half-angle in degrees.
    Cone(f64),
    /// A layer of this thickness on a rigid base.
    Layer(f64),
    /// A plastic solid of this hardness over its modulus.
    Plastic(f64),
}

/// A point of a curve: approach and force.
pub type Point = (f64, f64);

/// Problems spread evenly over all Tabor numbers; those after them are stiff tips on soft cantilevers.
pub const EVEN: usize = 240;
/// Full fields in all; stiff spheres in closed form follow.
pub const FIELDS: usize = 300;
/// Before this number stiff spheres; then by turns DMT and JKR themselves.
pub const STIFF: usize = 360;
/// Problems in all of which some are trained on.
pub const PROBLEMS: usize = 400;
/// The first of those that are only judged, drawn as the first [`EVEN`] and solved after all else was chosen.
pub const ANEW: usize = 500;

impl Problem {
    /// The problem of a number below [`PROBLEMS`], or from [`ANEW`] on.
    pub fn drawn(number: usize) -> Self {
        let mut random = Random(1000 + number as u64);
        if (STIFF..ANEW).contains(&number) {
            let (law, closed) = if number.is_multiple_of(2) {
                ("dmt", Closed::Dmt)
            } else {
                ("jkr", Closed::Jkr)
            };
            return Problem {
                number,
                law,
                // Without a range there is no Tabor number; any modulus will do.
                tabor: 1.0,
                rms_height: 0.0,
                load: random.between(1.0, 25.0),
                outside: None,
                closed: Some(closed),
            };
        }
        if (FIELDS..STIFF).contains(&number) {
            return Problem {
                number,
                law: "maugis-dugdale",
                tabor: random.between(0.01, 0.06),
                rms_height: 0.0,
                load: random.between(3.0, 100.0),
                outside: None,
                closed: Some(Closed::Stiff),
            };
        }
        if (EVEN..FIELDS).contains(&number) {
            return Problem {
                number,
                law: ["lennard-jones", "exponential", "maugis-dugdale"][number % 3],
                tabor: random.between(0.05, 0.6),
                rms_height: if random.share() < 0.6 {
                    0.0
                } else {
                    random.between(0.03, 0.3)
                },
                load: random.between(3.0, 25.0),
                outside: None,
                closed: None,
            };
        }
        let count = EVEN;
        let law = match number % 10 {
            9 => "none",
            other => ["lennard-jones", "exponential", "maugis-dugdale"][other % 3],
        };
        // Strata, so that the numbers are spread evenly.
        let share = ((number * 89) % count) as f64 / count as f64;
        let tabor = if law == "none" {
            0.0
        } else {
            0.05 * (80.0_f64).powf(share + random.share() / count as f64)
        };
        let rms_height = if random.share() < 0.45 {
            0.0
        } else {
            random.between(0.03, 2.0)
        };
        let most = if tabor > 1.0 { 8.0 } else { 25.0 };
        Problem {
            number,
            law,
            tabor,
            rms_height,
            load: random.between(1.0, most),
            outside: None,
            closed: None,
        }
    }

    /// Least and greatest spring constants of cantilevers that it is measured with, over that of the tip at pull-off.
    pub fn springs(&self) -> (f64, f64) {
        let soft = match self.closed {
            None => (EVEN..FIELDS).contains(&self.number),
            // Half of them.
            Some(closed) => closed == Closed::Stiff && self.number % 4 < 2,
        };
        if soft { (0.01, 0.1) } else { (0.02, 10.0) }
    }

    /// Contact modulus: the work and range are 1.
    pub fn modulus(&self) -> f64 {
        if self.law == "none" {
            return 1.0;
        }
        let peak = if self.law == "lennard-jones" {
            LENNARD_JONES_PEAK
        } else {
            1.0
        };
        (peak / LENNARD_JONES_PEAK / self.tabor).powf(1.5)
    }

    /// Its work of adhesion.
    pub fn work(&self) -> f64 {
        if self.law == "none" { 0.0 } else { 1.0 }
    }

    /// Loading and unloading of the full field under a prescribed approach; `None` if a step did not converge.
    pub fn solve(&self) -> Result<Option<Vec<Point>>, Box<dyn Error>> {
        let stiffness = 4.0 / 3.0 * self.modulus();
        let radius = ((self.load + self.work()) * TAU / stiffness).cbrt();
        let unit = (PI / stiffness).powf(2.0 / 3.0) * self.work();
        // The tail of the attraction beyond the contact.
        let tail = if self.law == "none" { 1.0 } else { 2.8 };
        let side = 2.0 * (1.1 * radius + tail).max(if self.law == "none" { 0.0 } else { 4.5 });
        let points = if self.tabor > 1.8 { 160 } else { 128 };
        let deep = radius * radius + 2.0 * self.rms_height;
        let start = -(3.0 * self.work() + 1.6 * unit + 0.15 * deep);
        // Closer together where the surfaces touch or nearly so.
        let near = -1.2 * unit - 1.5 * self.work() - 0.02 * deep;
        let place = |step: usize| {
            let share = step as f64 / STEPS as f64;
            if share < 0.2 {
                start + (near - start) * share / 0.2
            } else {
                near + (deep - near) * ((share - 0.2) / 0.8).powf(1.3)
            }
        };
        let path: Vec<f64> = (0..=STEPS).chain((0..STEPS).rev()).map(place).collect();
        // A layer is periodic; the cell is wide beside its thickness.
        let boundary = if matches!(self.outside, Some(Outside::Layer(_))) {
            "periodic"
        } else {
            "free"
        };
        let mut text = format!(
            "[grid]\npoints = {points}\nsize = {side:e}\nboundary = \"{boundary}\"\n[solid]\ncontact_modulus = {:e}\n",
            self.modulus()
        );
        match self.outside {
            Some(Outside::Layer(thickness)) => {
                write!(text, "poisson_ratio = 0.4\nthickness = {thickness:e}\n")?;
            }
            Some(Outside::Plastic(share)) => {
                writeln!(text, "hardness = {:e}", share * self.modulus())?;
            }
            _ => {}
        }
        if let Some(Outside::Cone(angle)) = self.outside {
            write!(text, "[[surface]]\nkind = \"cone\"\nhalf_angle = {angle}\n")?;
        } else {
            text += "[[surface]]\nkind = \"sphere\"\nradius = 1.0\n";
        }
        if self.rms_height > 0.0 {
            let pixel = side / points as f64;
            let mut random = Random(5000 + self.number as u64);
            let rolloff = (radius * random.between(0.4, 2.0)).clamp(24.0 * pixel, 0.5 * side);
            write!(
                text,
                "[[surface]]\nkind = \"self-affine\"\nhurst = 0.8\nrms_height = {:e}\nlongest = {:e}\nrolloff = {rolloff:e}\nshortest = {:e}\nseed = {}\n",
                self.rms_height,
                side,
                8.0 * pixel,
                self.number + 1,
            )?;
        }
        if self.law != "none" {
            write!(
                text,
                "[adhesion]\nlaw = \"{}\"\nwork_of_adhesion = 1.0\nrange = 1.0\n",
                self.law
            )?;
        }
        write!(
            text,
            "[loading]\ncontrol = \"approach\"\npath = {path:?}\n[solver]\ntolerance = 1e-5\n"
        )?;
        let scene = Scene::parse(&text, "regime.toml", Path::new("."), &[])
            .map_err(|errors| errors.to_string())?;
        let surface = Surface::build(&scene)?;
        let setup = Setup::new(scene, surface);
        let cpu = || cpu::double(None);
        let end = walk(&setup, &cpu, &mut ())?;
        let converged = end.rows.iter().all(|row| row.converged);
        let curve = path.iter().zip(&end.rows);
        let curve = curve.map(|(approach, row)| (*approach, row.force));
        Ok(converged.then(|| curve.collect()))
    }
}
