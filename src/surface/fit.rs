//! The self-affine spectrum that a height map has: Hurst exponent, roll-off, cut-off, plateau.
//!
//! Rings of the radial spectrum are compared with [`SelfAffineSpectrum`] in the likelihood of a random
//! surface, whose periodogram scatters about its density like a sum of squares: `ln C + P/C` for each
//! independent mode (Whittle 1953, doi:10.1007/BF02590998). Rings of very many modes count no more than
//! those of a few hundred, so that the shortest waves do not outvote all others.

use thiserror::Error;

use super::self_affine::{BandSums, band_sums};
use super::spectrum::SelfAffineSpectrum;
use super::statistics::{SpectrumRing, fine_spectrum, first_wavenumber, radial_spectrum};
use crate::grid::Grid;
use crate::scene::Boundary;

/// Fewest rings from which four numbers are found.
const FEWEST_RINGS: usize = 6;
/// Largest weight of a ring, independent modes.
const MOST_WEIGHT: f64 = 100.0;
/// Modes from which on a ring's scatter cannot pass for the end of the spectrum.
const STEADY_MODES: usize = 16;
/// A spectrum ends where it falls by this factor more than the steepest power law, within [`END_RINGS`].
const END_FACTOR: f64 = 5.0;
/// Waves to both sides of the end that tell where it is: a window smears it over two.
const END_WAVES: f64 = 4.0;
/// Share of the waves up to the end from which on rings tell how dense a filled one is.
const LEVEL_FROM: f64 = 0.75;
/// Rounds after which the end stands still.
const END_ROUNDS: usize = 5;
/// A fall by this factor is no scatter of however few modes.
const NO_SCATTER: f64 = 1e6;
/// Steepest power law of a self-affine surface: 2 (1 + hurst) at a Hurst exponent of 1.
const STEEPEST: f64 = 4.0;
/// Rings within which a spectrum ends: a window smears its end over two modes.
const END_RINGS: usize = 3;
/// Share of the densest ring below which rings of the longest waves lie before the band.
const BEFORE_BAND: f64 = 1e-3;
/// Shortest wave number of a windowed map that is compared, in first ones: the window bends those below.
const WINDOWED_FROM: f64 = 1.5;
/// Hurst exponents tried.
const HURST: [f64; 2] = [0.01, 0.99];
/// Places of the roll-off tried, before the best of them is refined.
const ROLLOFFS: usize = 120;
/// Ratio of the roll-off to the smallest wave number from which on it counts as seen.
const ROLLOFF_SEEN: f64 = 1.2;

/// What a map's spectrum looks like as that of a self-affine surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelfAffineFit {
    /// The spectrum.
    pub spectrum: SelfAffineSpectrum,
    /// Its sums over the modes of a cell of the map's size, from which rms height and slope follow.
    pub sums: BandSums,
    /// Whether the spectrum bends; if not, `rolloff` is the smallest wave number.
    pub rolloff_seen: bool,
    /// Whether the spectrum ends before the pixels do; if not, `short` is the largest wave number held.
    pub cutoff_seen: bool,
    /// Whether the Hurst exponent lies inside the range tried.
    pub hurst_inside: bool,
    /// Root mean square of `log10` of the rings' densities over the fit's, of rings that have any.
    pub scatter: f64,
}

/// Why a map has no self-affine fit.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum BandFitError {
    /// A map without roughness.
    #[error("the surface is flat")]
    Flat,
    /// Too few waves to tell a power law.
    #[error(
        "{rings} rings of the spectrum are too few, {FEWEST_RINGS} are needed; take a map of more points"
    )]
    TooFewRings {
        /// Rings with any power that there are.
        rings: usize,
    },
}

/// Fits a self-affine spectrum to the map.
///
/// # Errors
/// A map that is flat or has too few waves.
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
    // Rounding of a constant is no roughness.
    if greatest - least <= 1e-12 * greatest.abs().max(least.abs()) {
        return Err(BandFitError::Flat);
    }
    let first = first_wavenumber(grid);
    // Beyond the wave of two pixels along the coarser axis rings are cut by the corners of the plane.
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
    let end = end_of_band(&rings);
    let compared = &rings[..end.unwrap_or(rings.len())];
    // Waves along one axis alone leave rings without any power.
    let held_power = |ring: &&SpectrumRing| ring.density > 0.0;
    let filled = compared.iter().filter(held_power).count();
    if filled < FEWEST_RINGS {
        return Err(BandFitError::TooFewRings { rings: filled });
    }
    let mut spectrum = bend(compared, long, held);
    let rolloff_seen = spectrum.rolloff > ROLLOFF_SEEN * compared[0].wavenumber;
    if !rolloff_seen {
        // No plateau is seen: the same power law down to the longest wave.
        spectrum.plateau = spectrum.density(long.max(spectrum.rolloff))
            * (long.max(spectrum.rolloff) / long).powf(2.0 * (spectrum.hurst + 1.0));
        spectrum.rolloff = long;
    }
    if let Some(end) = end {
        // Of the rings within which it falls the first is full and the last is empty.
        let last = rings[(end + END_RINGS).min(rings.len() - 1)].wavenumber;
        let guess = (rings[end].wavenumber * last).sqrt();
        let fine = fine_spectrum(grid, heights, boundary);
        spectrum.short = end_about(&spectrum, &fine, first, guess).min(held);
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

/// Number of rings before the spectrum ends, where it does.
fn end_of_band(rings: &[SpectrumRing]) -> Option<usize> {
    (0..rings.len().saturating_sub(1)).find(|&index| {
        let here = &rings[index];
        let later = &rings[(index + END_RINGS).min(rings.len() - 1)];
        let power_law = (later.wavenumber / here.wavenumber).powf(-STEEPEST);
        // What is past its end stays low.
        let later = &rings[(index + END_RINGS).min(rings.len() - 1)..];
        let falls = |factor: f64| {
            let level = here.density * power_law / factor;
            later.iter().all(|ring| ring.density < level)
        };
        falls(END_FACTOR) && (here.modes >= STEADY_MODES || falls(NO_SCATTER))
    })
}

/// Where the spectrum ends, about `guess`: the rings there add up to as many as are filled.
///
/// Filled is a ring as dense as those shortly below, which the fit may leave a little above or below.
fn end_about(
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
        // A ring reaches half a wave number to both sides.
        guess = (start - 0.5 + filled) * first;
    }
    guess
}

/// The most likely spectrum from `long` to `short` for the rings.
fn bend(rings: &[SpectrumRing], long: f64, short: f64) -> SelfAffineSpectrum {
    let [near, far] = [rings[0].wavenumber, rings[rings.len() - 1].wavenumber];
    // At least a few rings lie beyond the roll-off, or it has no exponent.
    let far = far.min(rings[rings.len() - 3].wavenumber);
    let at = |rolloff: f64| {
        let of = |hurst: f64| profiled(rings, hurst, rolloff, [long, short]);
        let hurst = golden(HURST, |hurst| of(hurst).0);
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
    let logarithm = golden(around.map(f64::ln), |logarithm| at(logarithm.exp()).0);
    at(logarithm.exp()).1
}

/// The measure to be made small at a Hurst exponent and a roll-off, with the best plateau.
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
    // The sum of P/C is the sum of the weights at the best plateau, whatever the rest.
    (weights * spectrum.plateau.ln() + logarithms, spectrum)
}

/// Where a function with one minimum between two ends has it, by golden section.
fn golden([mut low, mut high]: [f64; 2], function: impl Fn(f64) -> f64) -> f64 {
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
