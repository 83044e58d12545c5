//! Sums over the modes of a band at a cost that does not grow with the band.
//!
//! Long waves are summed one by one. Short waves lie densely and are replaced by an integral over
//! the plane of wavevectors. The relative error is about 1e-5: the number of lattice points in a
//! circle of radius r differs from its area by about r^0.63 (Huxley 2003), which is 5e-5 of the
//! modes where the integral starts and less of any sum over all modes.

use std::f64::consts::PI;

use super::self_affine::{BandSums, sums_within as sum_modes};
use super::spectrum::SelfAffineSpectrum;

/// Waves across the longer side up to which modes are summed one by one.
const SUMMED: f64 = 1024.0;
/// Quadrature points of the integral, evenly spaced in the logarithm of the wave number.
const STEPS: usize = 4096;

/// Whether all modes of the band are summed one by one.
pub(super) fn is_exact(spectrum: &SelfAffineSpectrum, size: [f64; 2]) -> bool {
    spectrum.short <= 2.0 * seam(size)
}

/// Wave number at which the integral takes over from the sum, 1/m.
fn seam(size: [f64; 2]) -> f64 {
    2.0 * PI * SUMMED / size[0].max(size[1])
}

/// Sums over the modes of the band with `|k| <= most[0]` and `|l| <= most[1]`.
pub(super) fn sums_within(
    spectrum: &SelfAffineSpectrum,
    size: [f64; 2],
    most: [i64; 2],
) -> BandSums {
    if is_exact(spectrum, size) {
        return sum_modes(spectrum, size, most);
    }
    let seam = seam(size).max(spectrum.long);
    let long = SelfAffineSpectrum {
        short: seam,
        ..*spectrum
    };
    let mut sums = if spectrum.long < seam {
        sum_modes(&long, size, most)
    } else {
        BandSums::default()
    };
    // The included modes fill a rectangle that ends half a step beyond the last mode each way.
    let step = size.map(|side| 2.0 * PI / side);
    let ends: [f64; 2] = std::array::from_fn(|axis| (most[axis] as f64 + 0.5) * step[axis]);
    let last = spectrum.short.min(ends[0].hypot(ends[1]));
    if last <= seam {
        return sums;
    }
    let modes_per_area = 1.0 / (step[0] * step[1]);
    let width = (last / seam).ln() / STEPS as f64;
    let mut modes = 0.0;
    for index in 0..STEPS {
        let wavenumber = seam * ((index as f64 + 0.5) * width).exp();
        let ring = share_within(wavenumber, ends) * 2.0 * PI * wavenumber * wavenumber * width;
        // A mode represents its cell in the plane of wavevectors: |H|^2 = C times the cell's area.
        let power = ring * spectrum.density(wavenumber);
        let square = wavenumber * wavenumber;
        modes += ring * modes_per_area;
        sums.height += power;
        sums.slope += square * power;
        sums.curvature += square * square * power;
    }
    sums.modes += modes.round() as u64;
    sums
}

/// Share of the circle of radius `radius` that lies in the rectangle `|x| < ends[0], |y| < ends[1]`.
fn share_within(radius: f64, ends: [f64; 2]) -> f64 {
    // In one quadrant, the angles beyond the sides.
    let beyond = |end: f64| (end / radius).min(1.0).acos();
    (1.0 - (beyond(ends[0]) + beyond(ends[1])) * 2.0 / PI).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn a_circle_in_a_rectangle() {
        assert_eq!(share_within(1.0, [2.0, 1.0]), 1.0);
        assert_eq!(share_within(3.0, [2.0, 1.0]), 0.0);
        // The circle crosses the side x = 1/2 at 30 degrees from each of the four corners.
        let at = share_within(1.0, [0.5, 2.0]);
        assert_relative_eq!(at, 1.0 / 3.0, max_relative = 1e-14);
    }

    /// Against the sum over every mode, for the whole band and for a band cut by a grid. With 2500
    /// waves most of the slope and nearly all of the curvature come from the integral. The margin
    /// is twice the lattice error given above.
    #[test]
    fn the_integral_approximates_the_sum() {
        let spectrum = SelfAffineSpectrum {
            hurst: 0.7,
            long: 1.0,
            rolloff: 5.0,
            short: 2500.0,
            plateau: 1.0,
        };
        let size = [2.0 * PI, 2.0 * PI];
        assert!(!is_exact(&spectrum, size));
        for most in [[i64::MAX; 2], [1800, 1500], [300, 2400]] {
            let found = sums_within(&spectrum, size, most);
            let expected = sum_modes(&spectrum, size, most);
            let close = |a: f64, b: f64| assert_relative_eq!(a, b, max_relative = 1e-4);
            close(found.modes as f64, expected.modes as f64);
            close(found.height, expected.height);
            close(found.slope, expected.slope);
            close(found.curvature, expected.curvature);
        }
        // The integral starts on the spectrum's plateau; the cell is not square.
        let flat = SelfAffineSpectrum {
            rolloff: 2000.0,
            ..spectrum
        };
        let size = [2.0 * PI, PI];
        let found = sums_within(&flat, size, [i64::MAX; 2]);
        let expected = sum_modes(&flat, size, [i64::MAX; 2]);
        assert_relative_eq!(found.slope, expected.slope, max_relative = 1e-4);
    }
}
