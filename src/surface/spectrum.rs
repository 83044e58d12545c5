//! The self-affine power spectrum and its moments in closed form.

use std::f64::consts::PI;

/// Isotropic power spectral density of self-affine roughness with a roll-off and a cut-off.
///
/// `C(q) = plateau` from `long` to `rolloff`, then `plateau (q/rolloff)^(-2 hurst - 2)` up to
/// `short`, else 0; normalised so that `<h^2>` is the integral of C over the plane of wavevectors.
/// All wave numbers in 1/m with `0 < long <= rolloff <= short`; C in m^4.
///
/// # Source
/// Persson, Albohr, Tartaglino, Volokitin & Tosatti 2005, doi:10.1088/0953-8984/17/1/R01; moments as
/// in Nayak 1971, doi:10.1115/1.3451608.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelfAffineSpectrum {
    /// Hurst exponent H, between 0 and 1.
    pub hurst: f64,
    /// Smallest wave number of the band, 1/m.
    pub long: f64,
    /// Wave number at which the plateau ends, 1/m.
    pub rolloff: f64,
    /// Largest wave number of the band, 1/m.
    pub short: f64,
    /// C on the plateau, m^4.
    pub plateau: f64,
}

impl SelfAffineSpectrum {
    /// The same spectrum with the plateau that gives the continuous spectrum the given `rms_height`
    /// (m).
    ///
    /// A periodic surface has a sum in place of the integral and differs a little (1 % at four
    /// modes up to the roll-off); see [`crate::surface::self_affine::band_sums`].
    pub fn with_rms_height(mut self, rms_height: f64) -> Self {
        self.plateau = 1.0;
        self.plateau = rms_height * rms_height / self.moment(0);
        self
    }

    /// C at wave number `wavenumber` (1/m), m^4, without the limits of the band.
    ///
    /// The caller applies the limits: a mode of a periodic cell lies in the band or not, and
    /// rounding must not remove it.
    pub fn density(&self, wavenumber: f64) -> f64 {
        if wavenumber <= self.rolloff {
            self.plateau
        } else {
            self.plateau * (wavenumber / self.rolloff).powf(-2.0 * (self.hurst + 1.0))
        }
    }

    /// Moment `I_k`: the integral of `q^k C(q)` over the plane of wavevectors, m^(2-k).
    ///
    /// `I_0 = rms_height^2`, `I_2 = rms_slope^2`, `I_4 = rms_curvature^2`.
    pub fn moment(&self, power: u32) -> f64 {
        let power = f64::from(power);
        let rising = power + 2.0;
        let plateau = (self.rolloff.powf(rising) - self.long.powf(rising)) / rising;
        // q0^(2H+2) (q1^s - q0^s) / s with s = k - 2H, which is a logarithm at s = 0.
        let exponent = power - 2.0 * self.hurst;
        let octaves = (self.short / self.rolloff).ln();
        let span = if exponent == 0.0 {
            octaves
        } else {
            (exponent * octaves).exp_m1() / exponent
        };
        let falling = self.rolloff.powf(rising) * span;
        2.0 * PI * self.plateau * (plateau + falling)
    }

    /// The profile moments m0, m2, m4 of the continuous spectrum.
    pub fn moments(&self) -> SpectralMoments {
        SpectralMoments::from_isotropic([self.moment(0), self.moment(2), self.moment(4)])
    }
}

/// Spectral moments of a profile through an isotropic Gaussian surface.
///
/// # Source
/// Longuet-Higgins 1957, doi:10.1098/rsta.1957.0002; Nayak 1971, doi:10.1115/1.3451608; McCool 1986,
/// doi:10.1016/0043-1648(86)90045-1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpectralMoments {
    /// Mean square height, m^2.
    pub m0: f64,
    /// Mean square slope of a profile, half that of the surface.
    pub m2: f64,
    /// Mean square curvature of a profile, 3/8 of the mean square Laplacian of the surface, 1/m^2.
    pub m4: f64,
}

impl SpectralMoments {
    /// From the mean squares over the surface of height, gradient and Laplacian.
    pub fn from_isotropic(mean_squares: [f64; 3]) -> Self {
        SpectralMoments {
            m0: mean_squares[0],
            m2: mean_squares[1] / 2.0,
            m4: mean_squares[2] * 3.0 / 8.0,
        }
    }

    /// Root mean square height, m.
    pub fn rms_height(&self) -> f64 {
        self.m0.sqrt()
    }

    /// Root mean square of the gradient of the surface.
    pub fn rms_slope(&self) -> f64 {
        (2.0 * self.m2).sqrt()
    }

    /// Root mean square of the Laplacian of the surface, 1/m.
    pub fn rms_curvature(&self) -> f64 {
        (self.m4 * 8.0 / 3.0).sqrt()
    }

    /// Nayak parameter `m0 m4 / m2^2`, at least 1.5 on an isotropic Gaussian surface.
    ///
    /// `None` on a surface without slope.
    pub fn nayak(&self) -> Option<f64> {
        defined(self.m0 * (self.m4 / self.m2) / self.m2)
    }

    /// Summits per area, `m4 / (6 sqrt(3) pi m2)`, 1/m^2; `None` on a surface without slope.
    pub fn summit_density(&self) -> Option<f64> {
        defined(self.m4 / self.m2 / (6.0 * 3.0_f64.sqrt() * PI))
    }

    /// Mean height of the summits above the mean plane, `4 sqrt(m0 / (pi nayak))`, m.
    pub fn mean_summit_height(&self) -> Option<f64> {
        self.nayak()
            .and_then(|nayak| defined(4.0 * (self.m0 / (PI * nayak)).sqrt()))
    }

    /// Mean curvature of the summits, `(8/3) sqrt(m4 / pi)`, 1/m.
    pub fn mean_summit_curvature(&self) -> f64 {
        8.0 / 3.0 * (self.m4 / PI).sqrt()
    }

    /// Radius of the mean curvature of the summits, m; `None` on a surface without curvature.
    pub fn mean_summit_radius(&self) -> Option<f64> {
        defined(self.mean_summit_curvature().recip())
    }

    /// Radius of the rms curvature, `2 / rms_curvature`, m, 1.84 times that of the summits; `None` on a surface without curvature.
    pub fn mean_radius(&self) -> Option<f64> {
        defined(2.0 / self.rms_curvature())
    }
}

/// A finite number, else `None`.
fn defined(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn spectrum(hurst: f64, magnification: f64) -> SelfAffineSpectrum {
        SelfAffineSpectrum {
            hurst,
            long: 2.5e5,
            rolloff: 1e6,
            short: magnification * 1e6,
            plateau: 1.0,
        }
        .with_rms_height(0.52e-9)
    }

    #[test]
    #[rustfmt::skip]
    fn moments_of_the_continuous_spectrum() {
        // hurst, q1/q0, plateau, slope, curvature, nayak, summit density, mean radius
        for row in [
            [0.8, 16.0, 3.9614796920171346e-32, 0.0011515550701814627, 8967.86434137505, 18.549711478226058, 1393182944924.3884, 0.0002230185386249206],
            [0.8, 32.0, 3.9434763785895e-32, 0.0013856483957014733, 20562.31902676323, 46.51895596517308, 5058684712107.416, 9.726529373446966e-05],
            [0.4, 64.0, 2.571004079165278e-32, 0.004438341049061998, 174362.9137913595, 31.777775898895975, 35454095217495.84, 1.1470329076934189e-05],
        ] {
            let spectrum = spectrum(row[0], row[1]);
            let moments = spectrum.moments();
            let close = |found: f64, expected: f64| assert_relative_eq!(found, expected, max_relative = 1e-11);
            close(moments.rms_height(), 0.52e-9);
            close(spectrum.plateau, row[2]);
            close(moments.rms_slope(), row[3]);
            close(moments.rms_curvature(), row[4]);
            close(moments.nayak().unwrap(), row[5]);
            close(moments.summit_density().unwrap(), row[6]);
            close(moments.mean_radius().unwrap(), row[7]);
            // 8/3 sqrt(m4/pi) over sqrt(2/3 m4) of the rms curvature and 2.
            let ratio = moments.mean_radius().unwrap() / moments.mean_summit_radius().unwrap();
            close(ratio, 16.0 / 3.0 / PI.sqrt() * (3.0_f64 / 8.0).sqrt());
        }
        assert_relative_eq!(spectrum(0.8, 16.0).moments().m2, 6.630395398303169e-07, max_relative = 1e-11);
        assert_relative_eq!(spectrum(0.8, 16.0).moments().m4, 30158471.566989817, max_relative = 1e-11);
    }

    #[test]
    fn the_moment_at_twice_the_hurst_exponent_is_a_logarithm() {
        let at = |hurst: f64| SelfAffineSpectrum {
            hurst,
            long: 1.0,
            rolloff: 2.0,
            short: 20.0,
            plateau: 1.0,
        };
        // k = 2 = 2H at H = 1: 2 pi ((2^4 - 1)/4 + 2^4 ln 10).
        let expected = 2.0 * PI * (15.0 / 4.0 + 16.0 * 10.0_f64.ln());
        assert_relative_eq!(at(1.0).moment(2), expected, max_relative = 1e-14);
        // Continuous from both sides: no cancellation near the special case.
        for hurst in [1.0 - 1e-13, 1.0 + 1e-13] {
            assert_relative_eq!(at(hurst).moment(2), expected, max_relative = 1e-11);
        }
    }

    #[test]
    fn a_flat_surface_has_no_nayak_parameter() {
        let moments = SpectralMoments::from_isotropic([0.0; 3]);
        assert_eq!(moments.nayak(), None);
        assert_eq!(moments.summit_density(), None);
        assert_eq!(moments.mean_summit_height(), None);
        assert_eq!(moments.mean_radius(), None);
    }
}
