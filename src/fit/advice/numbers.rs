//! The dimensionless numbers of a problem whose contact is known.

/// Names of the features, in the order of [`Numbers::features`].
pub const NUMBER_FEATURES: [&str; 4] = [
    "Tabor number",
    "rms height over the range",
    "noise over 2 pi w R",
    "load over 2 pi w R",
];

/// Rms height over the range from which roughness matters.
const ROUGH: f64 = 0.1;

/// A feature as its name says it.
pub(super) fn plain(at: usize, value: f64) -> f64 {
    if at == 1 {
        ROUGH * value.exp_m1()
    } else {
        value.exp()
    }
}

/// A sphere, its roughness and the instrument.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Numbers {
    /// Tabor number of the Lennard-Jones law with the same work and peak tension.
    pub tabor: f64,
    /// Rms height of the roughness over the range of the attraction.
    pub rms_height: f64,
    /// Standard deviation of the force over `2 pi w R`.
    pub noise: f64,
    /// Greatest load over `2 pi w R`.
    pub load: f64,
}

impl Numbers {
    /// Features of the classifier: logarithms, that of the roughness from a tenth of the range on.
    pub fn features(&self) -> [f64; NUMBER_FEATURES.len()] {
        [
            self.tabor.ln(),
            (self.rms_height / ROUGH).ln_1p(),
            self.noise.ln(),
            self.load.ln(),
        ]
    }
}
