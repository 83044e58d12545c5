//! Surface tension and molar volume of liquid water.

/// Critical temperature of water, K, above which there is no liquid.
pub const CRITICAL_TEMPERATURE: f64 = 647.096;

/// Least temperature, K, to which the surface tension of supercooled water is known (IAPWS R1-76(2014)): 25 K below freezing. The
/// density by SR1-86 is within 1e-4 of measured ones there, and wrong further down.
pub const LEAST_TEMPERATURE: f64 = 248.15;

/// Molar mass of water, kg/mol.
const MOLAR_MASS: f64 = 18.015_268e-3;
/// Critical density of water, kg/m^3.
const CRITICAL_DENSITY: f64 = 322.0;

/// Surface tension of water against its vapour, N/m, at a temperature (K) below the critical one.
///
/// # Source
/// IAPWS R1-76(2014), eq. 1: from the triple point, and down to 248 K supercooled.
pub fn surface_tension(temperature: f64) -> f64 {
    let below = 1.0 - temperature / CRITICAL_TEMPERATURE;
    0.2358 * below.powf(1.256) * (1.0 - 0.625 * below)
}

/// Molar volume of the liquid at its vapour pressure, m^3/mol, at a temperature (K) below the critical one.
///
/// # Source
/// IAPWS SR1-86(1992), eq. 2: from the triple point.
pub fn molar_volume(temperature: f64) -> f64 {
    let below = 1.0 - temperature / CRITICAL_TEMPERATURE;
    let term = |factor: f64, power: f64| factor * below.powf(power / 3.0);
    let density = 1.0
        + term(1.992_740_64, 1.0)
        + term(1.099_653_42, 2.0)
        + term(-0.510_839_303, 5.0)
        + term(-1.754_934_79, 16.0)
        + term(-45.517_035_2, 43.0)
        + term(-674_694.45, 110.0);
    MOLAR_MASS / (CRITICAL_DENSITY * density)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The tables of both releases.
    #[test]
    fn values_of_the_releases() {
        for (celsius, millinewtons) in [
            (0.01, 75.65),
            (20.0, 72.74),
            (25.0, 71.97),
            (60.0, 66.24),
            (100.0, 58.91),
            (200.0, 37.67),
            (370.0, 0.39),
        ] {
            let tension = 1e3 * surface_tension(celsius + 273.15);
            assert!(
                (tension - millinewtons).abs() < 0.006,
                "{celsius}: {tension}"
            );
        }
        for (kelvin, density) in [(273.16, 999.789), (373.1243, 958.365)] {
            let found = MOLAR_MASS / molar_volume(kelvin);
            assert!((found / density - 1.0).abs() < 2e-5, "{kelvin}: {found}");
        }
    }
}
