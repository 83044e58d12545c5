//! Fits a self-affine spectrum to a height map: Hurst exponent, roll-off, cut-off, plateau.
//!
//! Rings of the radial spectrum are compared with [`SelfAffineSpectrum`] by the likelihood of a
//! random surface, whose periodogram scatters about its density like a sum of squares: `ln C + P/C`
//! for each independent mode (Whittle 1953, doi:10.1007/BF02590998). The weight of a ring is
//! limited to that of a few hundred modes, so that the shortest waves do not dominate the fit.

use thiserror::Error;

use super::self_affine::{BandSums, band_sums};
use super::spectrum::SelfAffineSpectrum;
use super::statistics::{SpectrumRing, fine_spectrum, first_wavenumber, radial_spectrum};
use crate::grid::Grid;
use crate::scene::Boundary;

/// Minimum number of rings to fit four numbers.
const FEWEST_RINGS: usize = 6;
/// Largest weight of a ring, in independent modes.
const MOST_WEIGHT: f64 = 100.0;
/// From this number of modes on a ring's scatter cannot be mistaken for the cut-off.
const STEADY_MODES: usize = 16;
/// The spectrum is cut off where it falls by this factor more than the steepest power law within
/// [`END_RINGS`].
const END_FACTOR: f64 = 5.0;
/// Waves on either side of the cut-off that locate it: a window smears it over two.
const END_WAVES: f64 = 4.0;
/// Rings from this share of the cut-off's wave number on give the density of a full ring.
const LEVEL_FROM: f64 = 0.75;
/// Rounds after which the cut-off no longer moves.
const END_ROUNDS: usize = 5;
/// A fall by this factor cannot be scatter, however few the modes.
const NO_SCATTER: f64 = 1e6;
/// Steepest power law of a self-affine surface: 2 (1 + hurst) at a Hurst exponent of 1.
const STEEPEST: f64 = 4.0;
/// Number of rings over which the cut-off may be spread: a window smears it over two modes.
const END_RINGS: usize = 3;
/// Rings of the longest waves below this share of the densest ring lie outside the band.
const BEFORE_BAND: f64 = 1e-3;
/// Shortest wave number compared on a windowed map, in units of the first: the window distorts
/// longer waves.
const WINDOWED_FROM: f64 = 1.5;
/// Factor off the spectrum from which on a fit says nothing of a surface: rings of few modes scatter less.
const OTHERWISE: f64 = 10.0;
/// Range of Hurst exponents tried.
const HURST: [f64; 2] = [0.01, 0.99];
/// Number of roll-offs tried before the best is refined.
const ROLLOFFS: usize = 120;
/// A roll-off counts as resolved if it exceeds the smallest wave number by this factor.
const ROLLOFF_SEEN: f64 = 1.2;

/// The self-affine spectrum fitted to a height map.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SelfAffineFit {
    /// The spectrum.
    pub spectrum: SelfAffineSpectrum,
    /// Its sums over the modes of a cell of the map's size, from which rms height and slope follow.
    pub sums: BandSums,
    /// Whether a roll-off is resolved; if not, `rolloff` is the smallest wave number.
    pub rolloff_seen: bool,
    /// Whether a cut-off is resolved; if not, `short` is the largest wave number of the grid.
    pub cutoff_seen: bool,
    /// Whether the Hurst exponent lies inside the range tried.
    pub hurst_inside: bool,
    /// Root mean square of `log10` of the ratio of ring density to fitted density, over rings with
    /// power.
    pub scatter: f64,
}

impl SelfAffineFit {
    /// Root mean square factor between the densities of the rings and that of the fit.
    pub fn factor(&self) -> f64 {
        10_f64.powf(self.scatter)
    }

    /// Whether the surface is self-affine as far as its spectrum shows: the fit lies within a factor of 10 of the rings.
    pub fn is_close(&self) -> bool {
        self.factor() <= OTHERWISE
    }
}

/// Why a map has no self-affine fit.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum BandFitError {
    /// A map without roughness.
    #[error("the surface is flat")]
    Flat,
    /// A line scan.
    #[error(
        "a line scan has waves along one axis, and the fit is of a surface that has them in all directions; take a map"
    )]
    LineScan,
    /// Too few waves to fit a power law.
    #[error(
        "{rings} rings of the spectrum are too few, {FEWEST_RINGS} are needed; take a map of more points"
    )]
    TooFewRings {
        /// Number of rings with power.
        rings: usize,
    },
}

/// Fits a self-affine spectrum to the map.
///
/// # Errors
/// A map that is flat, is a line scan, or has too few waves.
pub fn fit(
    grid: &Grid,
    heights: &[f64],
    boundary: Boundary,
) -> Result<SelfAffineFit, BandFitError> {
    let (least, greatest) = heights
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |ends, h| {
            (ends.0.min(*h), ends.1.max(*h))
        });
    // Rounding of a constant map is not roughness.
    if greatest - least <= 1e-12 * greatest.abs().max(least.abs()) {
        return Err(BandFitError::Flat);
    }
    if grid.nx == 1 || grid.ny == 1 {
        return Err(BandFitError::LineScan);
    }
    let first = first_wavenumber(grid);
    // Rings beyond the two-pixel wave along the coarser axis are incomplete.
    let held = largest_held(grid);
    let mut rings = radial_spectrum(grid, heights, boundary);
    rings.retain(|ring| ring.wavenumber <= held * (1.0 + 1e-9));
    let densest = rings.iter().map(|ring| ring.density).fold(0.0, f64::max);
    if boundary == Boundary::Free {
        rings.retain(|ring| ring.wavenumber > WINDOWED_FROM * first);
    }
    let before = rings
        .iter()
        .take_while(|ring| ring.density < BEFORE_BAND * densest)
        .count();
    let long = match before {
        0 => first,
        // Between the last ring before the band and the first one in it.
        _ if before < rings.len() => {
            (rings[before - 1].wavenumber * rings[before].wavenumber).sqrt()
        }
        _ => first,
    };
    rings.drain(..before.min(rings.len()));
    let end = cutoff_ring(&rings);
    let compared = &rings[..end.unwrap_or(rings.len())];
    // If all waves run along one axis, some rings have no power.
    let held_power = |ring: &&SpectrumRing| ring.density > 0.0;
    let filled = compared.iter().filter(held_power).count();
    if filled < FEWEST_RINGS {
        return Err(BandFitError::TooFewRings { rings: filled });
    }
    let mut spectrum = fit_rolloff(compared, long, held);
    let rolloff_seen = spectrum.rolloff > ROLLOFF_SEEN * compared[0].wavenumber;
    if !rolloff_seen {
        // No plateau is resolved: the power law extends to the longest wave.
        spectrum.plateau = spectrum.density(long.max(spectrum.rolloff))
            * (long.max(spectrum.rolloff) / long).powf(2.0 * (spectrum.hurst + 1.0));
        spectrum.rolloff = long;
    }
    if let Some(end) = end {
        // Over the rings of the cut-off the first is full and the last is empty.
        let full = rings[end].wavenumber;
        let last = rings[(end + END_RINGS).min(rings.len() - 1)].wavenumber;
        let fine = fine_spectrum(grid, heights, boundary);
        let refined = refined_cutoff(&spectrum, &fine, first, (full * last).sqrt());
        // A band of a few waves has too few full rings to refine by.
        spectrum.short = refined.clamp(full, last).min(held);
    }
    let squares: f64 = compared
        .iter()
        .filter(held_power)
        .map(|ring| {
            (ring.density / spectrum.density(ring.wavenumber))
                .log10()
                .powi(2)
        })
        .sum();
    Ok(SelfAffineFit {
        spectrum,
        sums: band_sums(&spectrum, [grid.lx, grid.ly]),
        rolloff_seen,
        cutoff_seen: end.is_some(),
        hurst_inside: HURST[0] + 1e-3 < spectrum.hurst && spectrum.hurst < HURST[1] - 1e-3,
        scatter: (squares / filled as f64).sqrt(),
    })
}

/// Largest wave number that the grid holds in every direction, 1/m.
fn largest_held(grid: &Grid) -> f64 {
    let along =
        |points: usize, size: f64| 2.0 * std::f64::consts::PI / size * ((points - 1) / 2) as f64;
    along(grid.nx, grid.lx).min(along(grid.ny, grid.ly))
}

/// Number of rings before the cut-off, if there is one.
fn cutoff_ring(rings: &[SpectrumRing]) -> Option<usize> {
    (0..rings.len().saturating_sub(1)).find(|&index| {
        let here = &rings[index];
        let later = &rings[(index + END_RINGS).min(rings.len() - 1)];
        let power_law = (later.wavenumber / here.wavenumber).powf(-STEEPEST);
        // Rings beyond the cut-off stay low.
        let later = &rings[(index + END_RINGS).min(rings.len() - 1)..];
        let falls = |factor: f64| {
            let level = here.density * power_law / factor;
            later.iter().all(|ring| ring.density < level)
        };
        falls(END_FACTOR) && (here.modes >= STEADY_MODES || falls(NO_SCATTER))
    })
}

/// Wave number of the cut-off, near `guess`: the power of the rings there equals that of so many
/// full ones.
///
/// A full ring is as dense as those shortly below it, which may lie a little above or below the
/// fit.
fn refined_cutoff(
    spectrum: &SelfAffineSpectrum,
    fine: &[SpectrumRing],
    first: f64,
    mut guess: f64,
) -> f64 {
    let number = |ring: &SpectrumRing| (ring.wavenumber / first).round();
    let share = |ring: &SpectrumRing| ring.density / spectrum.density(ring.wavenumber);
    for _ in 0..END_ROUNDS {
        let end = guess / first;
        let start = (end - END_WAVES).floor();
        let from = (LEVEL_FROM * end).min(start - END_WAVES);
        let below = fine
            .iter()
            .filter(|ring| (from..start).contains(&number(ring)));
        let (sum, count) = below.fold((0.0, 0.0), |(sum, count), ring| {
            (sum + share(ring), count + 1.0)
        });
        let level = if count > 0.0 { sum / count } else { 1.0 };
        let filled: f64 = fine
            .iter()
            .filter(|ring| (start..=end + END_WAVES).contains(&number(ring)))
            .map(|ring| share(ring) / level)
            .sum();
        // A ring extends half a wave number to either side.
        guess = (start - 0.5 + filled) * first;
    }
    guess
}

/// The most likely spectrum from `long` to `short` for the rings.
fn fit_rolloff(rings: &[SpectrumRing], long: f64, short: f64) -> SelfAffineSpectrum {
    let [near, far] = [rings[0].wavenumber, rings[rings.len() - 1].wavenumber];
    // A few rings must lie beyond the roll-off, or the exponent is undetermined.
    let far = far.min(rings[rings.len() - 3].wavenumber);
    let at = |rolloff: f64| {
        let of = |hurst: f64| profiled(rings, hurst, rolloff, [long, short]);
        let hurst = golden_section(HURST, |hurst| of(hurst).0);
        of(hurst)
    };
    let place = |step: usize| near * (far / near).powf(step as f64 / ROLLOFFS as f64);
    let best = (0..=ROLLOFFS)
        .min_by(|a, b| at(place(*a)).0.total_cmp(&at(place(*b)).0))
        .unwrap_or(0);
    let around = [
        place(best.saturating_sub(1)),
        place((best + 1).min(ROLLOFFS)),
    ];
    let logarithm = golden_section(around.map(f64::ln), |logarithm| at(logarithm.exp()).0);
    at(logarithm.exp()).1
}

/// Negative log-likelihood at a Hurst exponent and a roll-off, with the best plateau.
fn profiled(
    rings: &[SpectrumRing],
    hurst: f64,
    rolloff: f64,
    [long, short]: [f64; 2],
) -> (f64, SelfAffineSpectrum) {
    let mut spectrum = SelfAffineSpectrum {
        hurst,
        long,
        rolloff,
        short,
        plateau: 1.0,
    };
    let weight = |ring: &SpectrumRing| (ring.modes as f64 / 2.0).min(MOST_WEIGHT);
    let (mut ratios, mut weights, mut logarithms) = (0.0, 0.0, 0.0);
    for ring in rings {
        let shape = spectrum.density(ring.wavenumber);
        ratios += weight(ring) * ring.density / shape;
        weights += weight(ring);
        logarithms += weight(ring) * shape.ln();
    }
    spectrum.plateau = ratios / weights;
    // At the best plateau the sum of P/C equals the sum of the weights.
    (weights * spectrum.plateau.ln() + logarithms, spectrum)
}

/// Minimum of a unimodal function between two ends, by golden_section-section search.
fn golden_section([mut low, mut high]: [f64; 2], function: impl Fn(f64) -> f64) -> f64 {
    const STEPS: usize = 40;
    let ratio = (5.0_f64.sqrt() - 1.0) / 2.0;
    let mut inner = [high - ratio * (high - low), low + ratio * (high - low)];
    let mut values = inner.map(&function);
    for _ in 0..STEPS {
        if values[0] < values[1] {
            high = inner[1];
            inner = [high - ratio * (high - low), inner[0]];
            values = [function(inner[0]), values[0]];
        } else {
            low = inner[0];
            inner = [inner[1], low + ratio * (high - low)];
            values = [values[1], function(inner[1])];
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
#[path = "fit_tests.rs"]
mod tests;
