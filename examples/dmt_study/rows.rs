//! One surface of the study through each model, and the table of all results.
//!
//! Reduced units: pressures in `E* h'` with the surface's own rms slope, gaps in rms heights.

use std::error::Error;
use std::f64::consts::PI;
use std::fmt::Write as _;
use std::path::Path;

use tabor::backend::cpu;
use tabor::kernel::Scalars;
use tabor::law::{Law, LennardJones};
use tabor::scene::{Roughness, Scene, SelfAffineScene};
use tabor::study::{FinishedStep, Observer, Setup, walk};
use tabor::surface::{Surface, self_affine::scaled_spectrum};
use tabor::theory::gw::Summits;
use tabor::theory::icha::{Icha, MergeRule};
use tabor::theory::persson::Persson;
use tabor::theory::persson_gap::{Adhesion, RoughContact};
use tabor::theory::{Spectrum, Sphere, gw_m};

/// Contact modulus, Pa.
pub const MODULUS: f64 = 1.33e12;
/// Work of adhesion, J/m^2.
pub const WORK: f64 = 0.2;
/// Range of the Lennard-Jones law, m.
pub const RANGE: f64 = 1e-9;
/// Root mean square height, m.
pub const RMS_HEIGHT: f64 = 0.52e-9;
/// Smallest wave number, 1/m; the roll-off is at four times it.
pub const SMALLEST: f64 = 2.5e5;
/// Energy factor of Persson's theory.
pub const GAMMA: f64 = 0.5;

/// Repulsive pressures: 15 from 0.004 to 0.1, evenly in their logarithm, in E* h'.
pub fn loads() -> Vec<f64> {
    (0..15)
        .map(|i| 0.004 * 25f64.powf(f64::from(i) / 14.0))
        .collect()
}

/// A surface of the study.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Case {
    /// Hurst exponent H.
    pub hurst: f64,
    /// Largest wave number over that of the roll-off, N.
    pub ratio: usize,
    /// Seed of the phases.
    pub seed: u64,
}

/// Results of a model under one repulsive pressure.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The surface.
    pub case: Case,
    /// `field`, `icha`, `icha-displaced`, `persson` or `gw-m`; the last two do not depend on the
    /// seed, which is 0.
    pub model: String,
    /// Repulsive mean pressure, in E* h'.
    pub repulsive: f64,
    /// Contact area over nominal area; of the field with the pixel staircase taken off.
    pub area: f64,
    /// Mean gap, in rms heights.
    pub gap: f64,
    /// Attraction over the gaps outside the contact, in E* h'.
    pub attraction: f64,
}

/// A surface and its scales.
pub struct Sample {
    setup: Setup,
    /// E* h', Pa.
    pub unit: f64,
}

impl Sample {
    /// Root mean square slope of the surfaces of all seeds: sums over their waves do not depend on
    /// phases.
    pub fn slope(hurst: f64, ratio: usize) -> Result<f64, Box<dyn Error>> {
        let side = 2.0 * PI / SMALLEST;
        let scene = SelfAffineScene {
            hurst,
            roughness: Roughness::RmsHeight(RMS_HEIGHT),
            longest: side,
            rolloff: side / 4.0,
            shortest: side / (4 * ratio) as f64,
            seed: 1,
        };
        let (_, sums) = scaled_spectrum(&scene, [side; 2])?;
        Ok(sums.slope.sqrt())
    }

    /// Builds the surface with eight points across its shortest wave.
    pub fn new(case: Case) -> Result<Sample, Box<dyn Error>> {
        Sample::in_box(case, 1)
    }

    /// The same waves in a box wider by `times`.
    pub fn in_box(case: Case, times: usize) -> Result<Sample, Box<dyn Error>> {
        let side = 2.0 * PI / SMALLEST;
        let width = times as f64 * side;
        let text = format!(
            "[grid]\npoints = {}\nsize = {width:e}\n[solid]\ncontact_modulus = {MODULUS:e}\n\
             [[surface]]\nkind = \"self-affine\"\nhurst = {}\nrms_height = {RMS_HEIGHT:e}\n\
             longest = {side:e}\nrolloff = {:e}\nshortest = {:e}\nseed = {}\n\
             [loading]\ncontrol = \"pressure\"\npath = [1.0]\n",
            32 * case.ratio * times,
            case.hurst,
            side / 4.0,
            side / (4 * case.ratio) as f64,
            case.seed,
        );
        let mut scene = Scene::parse(&text, "dmt_study", Path::new("."), &[])?;
        let surface = Surface::build(&scene)?;
        let slope = surface.statistics(scene.grid.boundary).moments.rms_slope();
        scene.loading.path = loads().iter().map(|load| load * MODULUS * slope).collect();
        Ok(Sample {
            setup: Setup::new(scene, surface),
            unit: MODULUS * slope,
        })
    }
}

/// The law, SI.
pub fn law() -> Law {
    Law::LennardJones(LennardJones {
        work_of_adhesion: WORK,
        range: RANGE,
    })
}

/// Sums the attraction outside the contact of each step.
struct Attraction(Vec<f64>);

impl Observer for Attraction {
    type Error = std::convert::Infallible;

    fn step(&mut self, step: FinishedStep) -> Result<(), Self::Error> {
        let law = law();
        self.0.push(step.evaluation.map_or(f64::NAN, |fields| {
            let open = fields.gap.iter().filter(|gap| **gap > 0.0);
            open.map(|gap| law.traction(*gap)).sum::<f64>() / fields.gap.len() as f64
        }));
        Ok(())
    }

    fn iteration(&mut self, _: usize, _: &Scalars) -> bool {
        true
    }
}

/// The full field without adhesion, its attraction summed over its gaps.
pub fn field_rows(case: Case, sample: &Sample) -> Result<Vec<Row>, Box<dyn Error>> {
    let cpu = || cpu::double(None);
    let mut sums = Attraction(Vec::new());
    let end = walk(&sample.setup, &cpu, &mut sums)?;
    let rows = end.rows.iter().zip(sums.0).map(|(row, attraction)| Row {
        case,
        model: "field".into(),
        repulsive: row.mean_pressure / sample.unit,
        area: row.contact_area_fraction_corrected.unwrap_or(f64::NAN),
        gap: row.mean_gap.unwrap_or(f64::NAN) / RMS_HEIGHT,
        attraction: attraction / sample.unit,
    });
    Ok(rows.collect())
}

/// What interacting asperities conserve as they merge, with the model's name in the table.
pub const ICHA: [(&str, MergeRule); 2] = [
    ("icha", MergeRule::Volume),
    ("icha-displaced", MergeRule::DisplacedVolume),
];

/// Interacting asperities on the same heights, up to the first load that they cannot carry.
pub fn icha_rows(case: Case, sample: &Sample) -> Result<Vec<Row>, Box<dyn Error>> {
    let surface = Icha::new(sample.setup.surface.grid, &sample.setup.surface.heights)?;
    let law = law();
    let mut rows = Vec::new();
    for (model, rule) in ICHA {
        let mut loading = surface.loading(rule);
        for load in loads() {
            let pressed = match loading.press(load * sample.unit / MODULUS) {
                Ok(pressed) => pressed,
                Err(error) => {
                    eprintln!("{case:?}: {model} ends at {load:.4}: {error}");
                    break;
                }
            };
            let gap = pressed.gap(&surface);
            rows.push(Row {
                case,
                model: model.into(),
                repulsive: load,
                area: pressed.contact_area_fraction(),
                gap: gap.mean() / RMS_HEIGHT,
                attraction: gap.mean_outside(|gap| law.traction(gap)) / sample.unit,
            });
        }
    }
    Ok(rows)
}

/// The spectrum of a surface of the study, without finite-size effects.
pub fn spectrum(hurst: f64, ratio: usize) -> Result<Spectrum, Box<dyn Error>> {
    let rolloff = 4.0 * SMALLEST;
    let wavenumbers = [SMALLEST, rolloff, ratio as f64 * rolloff];
    Ok(Spectrum::new(wavenumbers, hurst, RMS_HEIGHT)?)
}

/// The study's summits: radius 2/h'', heights of the whole surface.
pub fn summits(spectrum: &Spectrum, work: f64) -> Result<Summits, Box<dyn Error>> {
    let summit = Sphere::new(spectrum.typical_radius(), MODULUS, work)?;
    let density = spectrum.summit_density();
    Ok(Summits::new(summit, density, spectrum.rms_height())?)
}

/// Persson's contact of the study.
pub fn persson(hurst: f64, ratio: usize) -> Result<RoughContact, Box<dyn Error>> {
    persson_from(SMALLEST, hurst, ratio)
}

/// The same with another smallest wave number, 1/m.
pub fn persson_from(
    smallest: f64,
    hurst: f64,
    ratio: usize,
) -> Result<RoughContact, Box<dyn Error>> {
    let rolloff = 4.0 * SMALLEST;
    let wavenumbers = [smallest, rolloff, ratio as f64 * rolloff];
    let spectrum = Spectrum::new(wavenumbers, hurst, RMS_HEIGHT)?;
    Ok(RoughContact::new(Persson::new(GAMMA)?, spectrum, MODULUS)?)
}

/// The study's adhesion, for Persson's theory.
pub const ADHESION: Adhesion = Adhesion {
    law: tabor::theory::Law::LennardJones,
    work_of_adhesion: WORK,
    range: RANGE,
};

/// Persson's theory and GW-M, which depend on the spectrum only.
pub fn theory_rows(hurst: f64, ratio: usize) -> Result<Vec<Row>, Box<dyn Error>> {
    let case = Case {
        hurst,
        ratio,
        seed: 0,
    };
    let contact = persson(hurst, ratio)?;
    let spectrum = *contact.spectrum();
    let unit = MODULUS * spectrum.rms_slope();
    let hard = summits(&spectrum, 0.0)?;
    let adhesive = summits(&spectrum, WORK)?;
    let mut rows = Vec::new();
    for load in loads() {
        rows.push(Row {
            case,
            model: "persson".into(),
            repulsive: load,
            area: contact.area_fraction(load * unit)?,
            gap: contact.mean_gap(load * unit)? / RMS_HEIGHT,
            attraction: contact.attraction(&ADHESION, load * unit)? / unit,
        });
    }
    for load in loads() {
        let separation = gw_m::separation(&hard, load * unit)?;
        let attraction = load * unit - gw_m::pressure(&adhesive, separation)?;
        rows.push(Row {
            case,
            model: "gw-m".into(),
            repulsive: load,
            area: hard.contact_area_fraction(separation),
            gap: separation + spectrum.mean_summit_height() / RMS_HEIGHT,
            attraction: attraction / unit,
        });
    }
    Ok(rows)
}

/// The greatest net tension of a model's rows, in E* h': the maximum of the parabola in the
/// logarithm of the load through the largest sample and its neighbours.
pub fn pull_off(rows: &[&Row]) -> f64 {
    let tension = |i: usize| rows[i].attraction - rows[i].repulsive;
    let Some(best) = (0..rows.len()).max_by(|&i, &j| tension(i).total_cmp(&tension(j))) else {
        return f64::NAN;
    };
    if best == 0 || best + 1 == rows.len() {
        return tension(best);
    }
    let (left, middle, right) = (tension(best - 1), tension(best), tension(best + 1));
    let bend = left - 2.0 * middle + right;
    middle - (right - left).powi(2) / (8.0 * bend)
}

/// First line of the table.
pub const HEADER: &str =
    "hurst,ratio,seed,model,repulsive_pressure,contact_area_fraction,mean_gap,adhesive_pressure";

/// Lines of a table, without its head.
pub fn lines(rows: &[Row]) -> String {
    let mut text = String::new();
    for row in rows {
        let Case { hurst, ratio, seed } = row.case;
        let _ = writeln!(
            text,
            "{hurst},{ratio},{seed},{},{:.6e},{:.6e},{:.6e},{:.6e}",
            row.model, row.repulsive, row.area, row.gap, row.attraction
        );
    }
    text
}

/// Rows of a table; lines that begin with # are comments.
pub fn read(text: &str) -> Result<Vec<Row>, Box<dyn Error>> {
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    if lines.next() != Some(HEADER) {
        return Err("the table does not begin with its head".into());
    }
    lines
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            let [hurst, ratio, seed, model, repulsive, area, gap, attraction] = cells[..] else {
                return Err(format!("not a row of the table: {line}").into());
            };
            Ok(Row {
                case: Case {
                    hurst: hurst.parse()?,
                    ratio: ratio.parse()?,
                    seed: seed.parse()?,
                },
                model: model.to_owned(),
                repulsive: repulsive.parse()?,
                area: area.parse()?,
                gap: gap.parse()?,
                attraction: attraction.parse()?,
            })
        })
        .collect()
}
