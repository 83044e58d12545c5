//! The models of the spectrum: Persson's theory and the bearing-area model.

use std::f64::consts::PI;

use super::table::Table;
use super::{Comparison, State, Stopped};
use crate::law::Law;
use crate::scene::{Boundary, SurfacePart};
use crate::study::Setup;
use crate::surface::fit::fit;
use crate::surface::spectrum::SpectralMoments;
use crate::theory::bam::BearingArea;
use crate::theory::persson::Persson;
use crate::theory::persson_gap::{Adhesion, RoughContact};
use crate::theory::roots::root;
use crate::theory::{Law as Reduced, Spectrum, TheoryError};
use crate::units::format_si;

/// Energy factor of Persson's theory.
const GAMMA: f64 = 0.5;
/// Largest factor between the longest wave of a cell and that of the spectrum that stands for it, as a logarithm.
const WIDENED: f64 = 1.5;
/// Hurst exponents around 0.8 for which the constants of BAM are valid.
const BAM_HURST: [f64; 2] = [0.65, 0.95];

/// A spectrum, and how it is approximate.
struct Found {
    spectrum: Spectrum,
    /// Wave number of the roll-off that the scene names, 1/m.
    rolloff: f64,
    limit: Option<&'static str>,
    /// What is wrong with its slope.
    slope: Option<&'static str>,
}

/// The scene's own spectrum if the surface is one self-affine part; else the self-affine spectrum fitted to the map's
/// (`tabor surface` prints the same one); where the map is not self-affine, a spectrum from the longest wave of the cell with the
/// map's rms height, slope and curvature.
fn spectrum_of(comparison: &Comparison) -> Result<Found, Stopped> {
    let setup = &comparison.setup;
    let moments = setup.statistics.moments;
    let grid = setup.surface.grid;
    let shaped = |part: &&SurfacePart| !matches!(part, SurfacePart::Flat);
    let mut parts = setup.scene.surfaces.iter().filter(shaped);
    if let (Some(SurfacePart::SelfAffine(rough)), None) = (parts.next(), parts.next()) {
        let longest = rough.longest.min(grid.lx.max(grid.ly));
        let rolloff = rough.rolloff.min(longest);
        let wavenumbers = [longest, rolloff, rough.shortest].map(|length| 2.0 * PI / length);
        if let Ok(own) = Spectrum::new(wavenumbers, rough.hurst, moments.rms_height()) {
            let widened = widened(&own, &moments);
            let other = "spectrum of another rms slope than the map's";
            return Ok(Found {
                spectrum: widened.unwrap_or(own),
                rolloff: own.rolloff_wavenumber(),
                limit: None,
                slope: widened.is_none().then_some(other),
            });
        }
    }
    if let Some(found) = fitted(setup) {
        return Ok(found);
    }
    let smallest = 2.0 * PI / grid.lx.max(grid.ly);
    match matched(&moments, smallest) {
        Some(spectrum) => Ok(Found {
            spectrum,
            rolloff: spectrum.rolloff_wavenumber(),
            limit: Some("self-affine spectrum matched to the map"),
            slope: None,
        }),
        None => Err(Stopped::Out(
            "no self-affine spectrum has the surface's rms height, slope and curvature".to_owned(),
        )),
    }
}

/// The self-affine spectrum fitted to the map, with the map's rms height and slope; none for a surface that is not self-affine.
fn fitted(setup: &Setup) -> Option<Found> {
    let moments = setup.statistics.moments;
    let grid = &setup.surface.grid;
    let fit = fit(grid, &setup.surface.heights, Boundary::Periodic).ok()?;
    if !fit.is_close() || !fit.hurst_inside {
        return None;
    }
    let own = fit.spectrum;
    let wavenumbers = [own.long, own.rolloff, own.short];
    let own = Spectrum::new(wavenumbers, own.hurst, moments.rms_height()).ok()?;
    Some(Found {
        spectrum: widened(&own, &moments)?,
        rolloff: own.rolloff_wavenumber(),
        limit: Some("self-affine spectrum fitted to the map"),
        slope: None,
    })
}

/// A spectrum whose long waves begin where it has the rms height and the slope of these moments. The few longest waves of a cell stand for
/// all those around them, of which some are longer: an integral from the longest wave on with the same height is up to 30 %
/// steeper.
fn widened(own: &Spectrum, moments: &SpectralMoments) -> Option<Spectrum> {
    let slope = moments.rms_slope();
    let build = |log: f64| {
        let factor = log.exp();
        let wavenumbers = [
            factor * own.smallest_wavenumber(),
            factor * own.rolloff_wavenumber(),
            own.largest_wavenumber(),
        ];
        Spectrum::new(wavenumbers, own.hurst_exponent(), moments.rms_height())
    };
    let miss = |log: f64| build(log).map_or(f64::NAN, |s| (s.rms_slope() / slope).ln());
    // The band keeps half of its decades.
    let shortest = (own.largest_wavenumber() / own.rolloff_wavenumber()).ln();
    let log = root(
        "a longest wave",
        miss,
        -WIDENED,
        WIDENED.min(0.5 * shortest),
        1e-10,
    )
    .ok()?;
    build(log).ok()
}

/// The self-affine spectrum without roll-off from `smallest` (1/m) with these moments.
fn matched(moments: &SpectralMoments, smallest: f64) -> Option<Spectrum> {
    let slope = moments.rms_slope();
    // For each Hurst exponent the largest wave number follows from the slope, and the exponent from
    // the curvature.
    let with_slope = |hurst: f64| -> Option<Spectrum> {
        let build = |log: f64| {
            let wavenumbers = [smallest, smallest, smallest * log.exp()];
            Spectrum::new(wavenumbers, hurst, moments.rms_height())
        };
        let miss = |log: f64| build(log).map_or(f64::NAN, |s| (s.rms_slope() / slope).ln());
        let log = root("a largest wave number", miss, 1e-3, 16.0, 1e-10).ok()?;
        build(log).ok()
    };
    let miss = |hurst: f64| {
        with_slope(hurst).map_or(f64::NAN, |s| {
            (s.rms_curvature() / moments.rms_curvature()).ln()
        })
    };
    // Some exponents have no band with this slope: bracket the root from the middle outwards.
    let places: Vec<f64> = (1..100).map(|i| 0.01 * f64::from(i)).collect();
    let pair = places
        .windows(2)
        .find(|pair| miss(pair[0]) * miss(pair[1]) <= 0.0)?;
    let hurst = root("a Hurst exponent", miss, pair[0], pair[1], 1e-10).ok()?;
    with_slope(hurst)
}

/// Persson's theory; attraction over its distribution of gaps.
pub(super) fn persson(comparison: &Comparison, table: &mut Table) -> Result<(), Stopped> {
    let setup = &comparison.setup;
    let found = spectrum_of(comparison)?;
    let modulus = setup.scene.solid.contact_modulus;
    let contact = RoughContact::new(Persson::new(GAMMA)?, found.spectrum, modulus)?;
    let adhesion = match setup.law {
        Law::LennardJones(_) => Some(Reduced::LennardJones),
        Law::Exponential(_) => Some(Reduced::Exponential),
        Law::MaugisDugdale(_) => Some(Reduced::Dugdale),
        _ => None,
    }
    .map(|law| Adhesion {
        law,
        work_of_adhesion: setup.law.work_of_adhesion(),
        range: setup.law.range(),
    });
    let state = |repulsive: f64, net: f64| -> Result<State, TheoryError> {
        Ok(State {
            mean_pressure: net,
            contact_area_fraction: Some(contact.area_fraction(repulsive)?),
            mean_gap: Some(contact.mean_gap(repulsive)?),
            adhesive_pressure: Some(repulsive - net),
        })
    };
    let approximate = found.limit.or(found.slope);
    let limit = approximate.or(comparison.beyond_dmt());
    let Some(adhesion) = adhesion else {
        for load in comparison.carried(0.0) {
            table.add(state(load, load)?, Some(0.0), approximate)?;
        }
        return Ok(());
    };
    // Without a tension the attraction is so small that the theory finds none at any load within its range.
    let pull_off = contact.turning_point(&adhesion)?;
    if pull_off.tension > 0.0 {
        let at = state(pull_off.pressure, -pull_off.tension)?;
        table.add(at, Some(pull_off.tension), limit)?;
    }
    let tension = pull_off.tension;
    for load in comparison.carried(tension) {
        let repulsive = contact.repulsive_pressure(&adhesion, &pull_off, load)?;
        table.add(state(repulsive, load)?, Some(tension), limit)?;
    }
    Ok(())
}

/// The bearing-area model, with the Dugdale law of the same work of adhesion and peak tension.
pub(super) fn bam(comparison: &Comparison, table: &mut Table) -> Result<(), Stopped> {
    let setup = &comparison.setup;
    if !setup.law.is_adhesive() {
        return Err(Stopped::Out("without [adhesion] it has no law".to_owned()));
    }
    let found = spectrum_of(comparison)?;
    let peak = setup.law.peak_tension();
    let rms_height = setup.statistics.moments.rms_height();
    let range = setup.law.work_of_adhesion() / peak;
    let stiffness = found.rolloff * rms_height * setup.scene.solid.contact_modulus / peak;
    let model = BearingArea::new(rms_height / range, stiffness)?;
    let hurst = found.spectrum.hurst_exponent();
    let unusual = !(BAM_HURST[0]..=BAM_HURST[1]).contains(&hurst);
    let limit = unusual
        .then_some("Hurst exponent far from 0.8")
        .or(found.limit);
    let state = |gap: f64, net: f64| State {
        mean_pressure: net,
        contact_area_fraction: None,
        mean_gap: Some(gap * rms_height),
        adhesive_pressure: Some(model.attraction(gap) * peak),
    };
    let tension = match model.pull_off() {
        Ok((gap, tension)) => {
            let tension = tension * peak;
            table.add(state(gap, -tension), Some(tension), limit)?;
            tension
        }
        Err(_) => 0.0,
    };
    for load in comparison.carried(tension) {
        // At full closure the model carries only a finite load.
        let Ok(gap) = model.mean_gap(load / peak) else {
            let most = format_si(peak * model.pressure(0.0), "Pa");
            let load = format_si(load, "Pa");
            return Err(Stopped::End(format!(
                "at a mean gap of 0 it carries {most}, and not {load}"
            )));
        };
        table.add(state(gap, load), Some(tension), limit)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Moments of a cell's own waves: the sum over its wave vectors of the spectrum that the heights are drawn from.
    fn moments_of_cell(own: &Spectrum) -> SpectralMoments {
        let [first, last] = [own.smallest_wavenumber(), own.largest_wavenumber()];
        let most = (last / first).round() as i32;
        let (mut m0, mut m2, mut m4) = (0.0, 0.0, 0.0);
        for x in -most..=most {
            for y in -most..=most {
                let wavenumber = first * f64::from(x * x + y * y).sqrt();
                if (first * (1.0 - 1e-9)..=last * (1.0 + 1e-9)).contains(&wavenumber) {
                    let power = own.density(wavenumber) * first * first;
                    m0 += power;
                    m2 += power * wavenumber.powi(2) / 2.0;
                    m4 += power * wavenumber.powi(4) * 3.0 / 8.0;
                }
            }
        }
        SpectralMoments { m0, m2, m4 }
    }

    /// The waves of a cell from its side to a sixteenth of it, without roll-off and with one at half of the side. With the cell's own longest wave the
    /// integral is 27 % and 4.4 % too steep at the same height.
    #[test]
    fn the_spectrum_of_a_cell_has_its_height_and_slope() {
        for (rolloff, too_steep) in [(1.0, 0.27), (2.0, 0.044)] {
            let own = Spectrum::new([1.0, rolloff, 16.0], 0.8, 0.3).unwrap();
            let moments = moments_of_cell(&own);
            let naive = Spectrum::new([1.0, rolloff, 16.0], 0.8, moments.rms_height()).unwrap();
            let excess = naive.rms_slope() / moments.rms_slope() - 1.0;
            assert!((excess - too_steep).abs() < 0.02, "{excess}");
            let found = widened(&own, &moments).expect("a spectrum");
            assert!((found.rms_slope() / moments.rms_slope() - 1.0).abs() < 1e-8);
            assert!((found.rms_height() / moments.rms_height() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn a_spectrum_is_recovered_from_its_moments() {
        let known = Spectrum::new([2.0, 2.0, 60.0], 0.7, 0.3).unwrap();
        let (m0, m2, m4) = known.profile_moments();
        let found = matched(&SpectralMoments { m0, m2, m4 }, 2.0).expect("a spectrum");
        assert!((found.hurst_exponent() - 0.7).abs() < 1e-6);
        assert!((found.largest_wavenumber() / 60.0 - 1.0).abs() < 1e-6);
        // A single wave has a Nayak parameter below that of any band.
        let wave = SpectralMoments {
            m0: 1.0,
            m2: 2.0,
            m4: 6.0,
        };
        assert!(matched(&wave, 2.0).is_none());
    }
}
