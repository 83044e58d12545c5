//! Self-affine roughness: a sum of waves of exact amplitude whose phases come from a seed.
//!
//! The phase of a wave depends only on the seed and its index, so the surface is the same on every
//! grid, in every order of evaluation and on every machine.

use std::f64::consts::PI;

use num_complex::Complex;
use rayon::prelude::*;

use super::band_estimate;
use super::error::PartError;
use super::spectrum::SelfAffineSpectrum;
use super::{across, fourier};
use crate::backend::Share;
use crate::backend::long_field::LongField;
use crate::grid::Grid;
use crate::scene::{Roughness, SelfAffineScene};

/// Relative margin within which a mode at the end of the band is included.
const BAND_MARGIN: f64 = 1e-9;

/// Most waves along one axis in a band, `size / shortest`; a longer band takes minutes to sum.
pub const MOST_WAVES: f64 = 32768.0;

/// The finaliser of the splitmix64 generator: a bijection of 64-bit words that mixes them well.
///
/// # Source
/// Steele, Lea & Flood 2014, doi:10.1145/2660193.2660195.
pub fn mix(word: u64) -> u64 {
    let z = word.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

/// Phase of mode (k, l) as a fraction of 2 pi, in `[0, 1)`, for the half plane `k > 0, or k = 0 and l > 0`.
///
/// The other half plane has the negative phases. k counts waves along x, l along y.
pub fn phase_fraction(seed: u64, k: i64, l: i64) -> f64 {
    let index = ((k as u64 & 0xFFFF_FFFF) << 32) | (l as u64 & 0xFFFF_FFFF);
    (mix(mix(seed) ^ index) >> 11) as f64 / (1_u64 << 53) as f64
}

/// Mean squares of a surface with every mode of a band: sums over `|H|^2`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BandSums {
    /// Number of modes, both half planes.
    pub modes: u64,
    /// Sum of `|H|^2`, the mean square height, m^2.
    pub height: f64,
    /// Sum of `q^2 |H|^2`, the mean square slope.
    pub slope: f64,
    /// Sum of `q^4 |H|^2`, the mean square Laplacian, 1/m^2.
    pub curvature: f64,
}

impl BandSums {
    /// The sums of a spectrum scaled by `factor`.
    fn times(self, factor: f64) -> BandSums {
        BandSums {
            modes: self.modes,
            height: self.height * factor,
            slope: self.slope * factor,
            curvature: self.curvature * factor,
        }
    }

    /// The sum of both.
    fn plus(self, other: BandSums) -> BandSums {
        BandSums {
            modes: self.modes + other.modes,
            height: self.height + other.height,
            slope: self.slope + other.slope,
            curvature: self.curvature + other.curvature,
        }
    }
}

/// Sums over all modes of the band in a cell of `size` (m), whether or not a grid resolves them.
///
/// Costs one power per mode of a quarter plane (15 s on two cores at [`MOST_WAVES`], 0.2 s at a
/// tenth of it); independent of grid, seed and number of threads.
pub fn band_sums(spectrum: &SelfAffineSpectrum, size: [f64; 2]) -> BandSums {
    sums_within(spectrum, size, [i64::MAX; 2])
}

/// Sums over the modes of the band with `|k| <= most[0]` and `|l| <= most[1]`.
pub(super) fn sums_within(
    spectrum: &SelfAffineSpectrum,
    size: [f64; 2],
    most: [i64; 2],
) -> BandSums {
    let band = Band::new(spectrum, size);
    // Columns are summed separately and added in order, so that the sum does not depend on threads.
    let columns: Vec<BandSums> = (0..=band.last_k().min(most[0]))
        .into_par_iter()
        .map(|k| {
            let mut sums = BandSums::default();
            for l in 0..=band.last_l().min(most[1]) {
                let Some(wavenumber) = band.wavenumber(k, l) else {
                    continue;
                };
                // Mirror images in the other quarters of the plane.
                let images = if k == 0 || l == 0 { 2 } else { 4 };
                let power = f64::from(images) * band.power(spectrum, wavenumber);
                let square = wavenumber * wavenumber;
                sums.modes += images as u64;
                sums.height += power;
                sums.slope += square * power;
                sums.curvature += square * square * power;
            }
            sums
        })
        .collect();
    columns
        .into_iter()
        .fold(BandSums::default(), BandSums::plus)
}

/// The modes of a cell that lie in the band.
struct Band {
    /// Wave numbers of the first mode along x and y, 1/m.
    step: [f64; 2],
    /// Ends of the band with their margin, 1/m.
    ends: [f64; 2],
}

impl Band {
    fn new(spectrum: &SelfAffineSpectrum, size: [f64; 2]) -> Self {
        Band {
            step: [2.0 * PI / size[0], 2.0 * PI / size[1]],
            ends: [
                spectrum.long * (1.0 - BAND_MARGIN),
                spectrum.short * (1.0 + BAND_MARGIN),
            ],
        }
    }

    /// Largest k in the band.
    fn last_k(&self) -> i64 {
        (self.ends[1] / self.step[0]) as i64
    }

    /// Largest l in the band.
    fn last_l(&self) -> i64 {
        (self.ends[1] / self.step[1]) as i64
    }

    /// Wave number of mode (k, l), if it lies in the band; the mean plane is never included.
    fn wavenumber(&self, k: i64, l: i64) -> Option<f64> {
        if k == 0 && l == 0 {
            return None;
        }
        let wavenumber = (self.step[0] * k as f64).hypot(self.step[1] * l as f64);
        (self.ends[0] <= wavenumber && wavenumber <= self.ends[1]).then_some(wavenumber)
    }

    /// `|H|^2` of a mode, m^2: C times the mode's area in the plane of wavevectors.
    fn power(&self, spectrum: &SelfAffineSpectrum, wavenumber: f64) -> f64 {
        self.step[0] * self.step[1] * spectrum.density(wavenumber)
    }
}

/// Heights with every mode of the band that the grid resolves, shape `[ny, nx]`, m.
///
/// The amplitude of a mode is exactly `2 pi sqrt(C(q) / (lx ly))`. Modes with `|k| >= nx/2` or
/// `|l| >= ny/2` are left out; the others do not change with the grid.
pub fn heights(spectrum: &SelfAffineSpectrum, grid: &Grid, seed: u64) -> Vec<f64> {
    let (stored, fill) = coefficients(spectrum, grid, seed);
    let mut columns = LongField::zeros(stored * grid.ny);
    let lines = columns.par_chunks_mut(grid.ny).enumerate();
    lines.for_each(|(k, column)| fill(k, column));
    fourier::synthesise(grid, columns)
}

/// How many columns of the spectrum the band has, and what sets the coefficients of one, which are zeros.
fn coefficients(
    spectrum: &SelfAffineSpectrum,
    grid: &Grid,
    seed: u64,
) -> (usize, impl Fn(usize, &mut [Complex<f64>]) + Sync) {
    let band = Band::new(spectrum, [grid.lx, grid.ly]);
    let most = most_held(grid);
    let last_k = band.last_k().min(most[0]);
    let last_l = band.last_l().min(most[1]);
    let ny = grid.ny as i64;
    let fill = move |k: usize, column: &mut [Complex<f64>]| {
        let k = k as i64;
        // In the column k = 0 one half is free; the other mirrors it.
        let first_l = if k == 0 { 1 } else { -last_l };
        for l in first_l..=last_l {
            let Some(wavenumber) = band.wavenumber(k, l) else {
                continue;
            };
            let amplitude = band.power(spectrum, wavenumber).sqrt();
            let phase = 2.0 * PI * phase_fraction(seed, k, l);
            let coefficient = Complex::from_polar(amplitude, phase);
            column[l.rem_euclid(ny) as usize] = coefficient;
            if k == 0 {
                column[(-l).rem_euclid(ny) as usize] = coefficient.conj();
            }
        }
    };
    (last_k as usize + 1, fill)
}

/// Largest |k| and |l| that the grid resolves: below half its points.
fn most_held(grid: &Grid) -> [i64; 2] {
    [(grid.nx as i64 - 1) / 2, (grid.ny as i64 - 1) / 2]
}

/// Properties of a self-affine part on a grid, without its heights.
pub(super) struct Survey {
    /// The spectrum, scaled to the asked rms height or slope.
    spectrum: SelfAffineSpectrum,
    /// Sums over the modes that the grid resolves.
    pub(super) held: BandSums,
    /// Whether the sums are exact, mode by mode.
    pub(super) exact: bool,
}

/// Heights of the held rows of a scene's self-affine part on the grid, with warnings.
///
/// # Errors
/// Values out of range, a band without modes in this cell, one with too many modes to sum, and one
/// of which the grid resolves nothing.
pub(super) fn build(
    scene: &SelfAffineScene,
    grid: &Grid,
    share: &Share,
    warnings: &mut Vec<String>,
) -> Result<Vec<f64>, PartError> {
    let found = look(scene, grid, warnings, &sums_within)?;
    if share.is_whole() {
        return Ok(heights(&found.spectrum, grid, scene.seed));
    }
    let (stored, fill) = coefficients(&found.spectrum, grid, scene.seed);
    // Without a rank that has ended nothing is solved, which the next exchange tells.
    let heights = across::synthesise(grid, share, stored, fill);
    Ok(heights.unwrap_or_else(|_| vec![f64::NAN; share.surface_len()]))
}

/// The same without the heights; in a band with very many waves the short ones are integrated,
/// which takes negligible time.
///
/// # Errors
/// As [`build`].
pub(super) fn survey(
    scene: &SelfAffineScene,
    grid: &Grid,
    warnings: &mut Vec<String>,
) -> Result<Survey, PartError> {
    let mut found = look(scene, grid, warnings, &band_estimate::sums_within)?;
    found.exact = band_estimate::is_exact(&found.spectrum, [grid.lx, grid.ly]);
    Ok(found)
}

/// A sum over the modes of a band with `|k| <= most[0]` and `|l| <= most[1]`.
type Sum = dyn Fn(&SelfAffineSpectrum, [f64; 2], [i64; 2]) -> BandSums;

fn look(
    scene: &SelfAffineScene,
    grid: &Grid,
    warnings: &mut Vec<String>,
    sum: &Sum,
) -> Result<Survey, PartError> {
    let size = [grid.lx, grid.ly];
    let (spectrum, all) = scaled_by(scene, size, sum)?;
    let band = Band::new(&spectrum, size);
    let most = most_held(grid);
    let held = if band.last_k() <= most[0] && band.last_l() <= most[1] {
        all
    } else {
        sum(&spectrum, size, most)
    };
    if held.modes == 0 {
        return Err(PartError::BandNotHeld {
            longest: scene.longest,
            dx: grid.dx(),
            dy: grid.dy(),
        });
    }
    warn(scene, grid, [held, all], warnings);
    Ok(Survey {
        spectrum,
        held,
        exact: true,
    })
}

/// Warns of waves that the cell or the grid cannot represent; `held` are the resolved modes of
/// `all`.
fn warn(
    scene: &SelfAffineScene,
    grid: &Grid,
    [held, all]: [BandSums; 2],
    warnings: &mut Vec<String>,
) {
    let longest_held = grid.lx.max(grid.ly);
    if scene.longest > longest_held * (1.0 + BAND_MARGIN) {
        warnings.push(format!(
            "longest = {:e} m is longer than the grid, so the longest wave is {:e} m; the amplitude is \
             that of the waves that fit",
            scene.longest, longest_held
        ));
    }
    if held.modes < all.modes {
        let missing = (1.0 - (held.slope / all.slope).sqrt()) * 100.0;
        let too_few = |length: f64| 2 * (length / scene.shortest * (1.0 + BAND_MARGIN)) as usize;
        let [x, y] = [grid.lx, grid.ly].map(too_few);
        // An axis with points enough for its waves needs no more, as where a strip has none across.
        let points = match [grid.nx > x, grid.ny > y] {
            [true, false] => format!("{y} points along y"),
            [false, true] => format!("{x} points along x"),
            _ => format!("{x} x {y} points"),
        };
        warnings.push(format!(
            "the grid is too coarse for {} of the {} waves down to shortest = {:e} m: the rms slope is \
             {:.4e} in place of {:.4e} ({missing:.2} % missing); take more than {points}",
            all.modes - held.modes,
            all.modes,
            scene.shortest,
            held.slope.sqrt(),
            all.slope.sqrt(),
        ));
    }
}

/// The spectrum of a scene's self-affine part in a cell of `size` (m), with the plateau for which
/// the sum over all modes of the band has the given rms height or slope, and those sums.
///
/// # Errors
/// Values out of range, a band without modes in this cell, and one with too many to sum.
pub fn scaled_spectrum(
    scene: &SelfAffineScene,
    size: [f64; 2],
) -> Result<(SelfAffineSpectrum, BandSums), PartError> {
    scaled_by(scene, size, &sums_within)
}

fn scaled_by(
    scene: &SelfAffineScene,
    size: [f64; 2],
    sum: &Sum,
) -> Result<(SelfAffineSpectrum, BandSums), PartError> {
    check(scene)?;
    let waves = size[0].max(size[1]) / scene.shortest;
    if waves > MOST_WAVES {
        return Err(PartError::BandTooLong {
            shortest: scene.shortest,
            waves,
            least: size[0].max(size[1]) / MOST_WAVES,
        });
    }
    // Summed with a plateau that keeps the sums near 1, whatever the lengths.
    let mut spectrum = SelfAffineSpectrum {
        hurst: scene.hurst,
        long: 2.0 * PI / scene.longest,
        rolloff: 2.0 * PI / scene.rolloff,
        short: 2.0 * PI / scene.shortest,
        plateau: size[0] * size[1],
    };
    let sums = sum(&spectrum, size, [i64::MAX; 2]);
    if sums.modes == 0 {
        return Err(PartError::BandEmpty {
            longest: scene.longest,
            shortest: scene.shortest,
        });
    }
    let factor = match scene.roughness {
        Roughness::RmsHeight(rms_height) => rms_height * rms_height / sums.height,
        Roughness::RmsSlope(rms_slope) => rms_slope * rms_slope / sums.slope,
    };
    spectrum.plateau *= factor;
    Ok((spectrum, sums.times(factor)))
}

/// Refuses values outside the model.
fn check(scene: &SelfAffineScene) -> Result<(), PartError> {
    let (name, amplitude) = match scene.roughness {
        Roughness::RmsHeight(value) => ("rms_height", value),
        Roughness::RmsSlope(value) => ("rms_slope", value),
    };
    for (name, value) in [
        ("longest", scene.longest),
        ("rolloff", scene.rolloff),
        ("shortest", scene.shortest),
        (name, amplitude),
    ] {
        if !(value.is_finite() && value > 0.0) {
            return Err(PartError::NotPositive { name, value });
        }
    }
    if !(0.0..=1.0).contains(&scene.hurst) {
        return Err(PartError::Hurst { value: scene.hurst });
    }
    if !(scene.longest >= scene.rolloff && scene.rolloff >= scene.shortest) {
        return Err(PartError::BandOrder {
            longest: scene.longest,
            rolloff: scene.rolloff,
            shortest: scene.shortest,
        });
    }
    Ok(())
}

#[cfg(test)]
#[path = "self_affine_tests.rs"]
mod tests;
