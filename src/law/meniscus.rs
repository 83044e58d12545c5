//! The liquid that condenses between two surfaces, as a Maugis-Dugdale law.

/// Gas constant, J/(mol K).
pub const GAS_CONSTANT: f64 = 8.314_462_618_153_24;

/// Least Kelvin radius at which a meniscus is still a liquid surface, m.
pub const LEAST_KELVIN_RADIUS: f64 = 0.3e-9;

/// A liquid in its vapour between two surfaces of one contact angle, SI.
///
/// The suction `gamma/r_K` acts wherever the gap is below the meniscus' height
/// `2 r_K cos(theta)`; their product `2 gamma cos(theta)` is the work of adhesion. Callers see to
/// it that the numbers make sense.
///
/// # Source
/// Israelachvili 2011, sec. 17.11; Kelvin's radius at the vapour's humidity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meniscus {
    /// Surface tension gamma, N/m.
    pub surface_tension: f64,
    /// Contact angle theta on both surfaces, rad, below pi/2.
    pub contact_angle: f64,
    /// Kelvin radius r_K, m.
    pub kelvin_radius: f64,
}

impl Meniscus {
    /// The meniscus at a relative humidity between 0 and 1 (both excluded).
    ///
    /// `molar_volume` in m^3/mol, `temperature` in K.
    pub fn at_humidity(
        surface_tension: f64,
        molar_volume: f64,
        temperature: f64,
        relative_humidity: f64,
        contact_angle: f64,
    ) -> Meniscus {
        let length = surface_tension * molar_volume / (GAS_CONSTANT * temperature);
        Meniscus {
            surface_tension,
            contact_angle,
            kelvin_radius: -length / relative_humidity.ln(),
        }
    }

    /// Whether it is wide enough to be a liquid surface; below, nothing bridges the gap.
    pub fn bridges(&self) -> bool {
        self.kelvin_radius >= LEAST_KELVIN_RADIUS
    }

    /// Suction in the liquid, the law's tension, Pa.
    pub fn peak_tension(&self) -> f64 {
        self.surface_tension / self.kelvin_radius
    }

    /// Height of the meniscus, the law's range, m.
    pub fn range(&self) -> f64 {
        2.0 * self.kelvin_radius * self.contact_angle.cos()
    }

    /// Work of adhesion, J/m^2.
    pub fn work_of_adhesion(&self) -> f64 {
        2.0 * self.surface_tension * self.contact_angle.cos()
    }
}

/// Humidity at which the Kelvin radius is [`LEAST_KELVIN_RADIUS`]; 0.17 for water at 298 K.
pub fn least_humidity(surface_tension: f64, molar_volume: f64, temperature: f64) -> f64 {
    (-surface_tension * molar_volume / (GAS_CONSTANT * temperature * LEAST_KELVIN_RADIUS)).exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Water at half humidity, computed apart.
    #[test]
    fn water_at_half_humidity() {
        let meniscus = Meniscus::at_humidity(0.0728, 1.8e-5, 298.15, 0.5, 20f64.to_radians());
        assert!((meniscus.kelvin_radius / 7.62622167e-10 - 1.0).abs() < 1e-8);
        assert!((meniscus.peak_tension() / 95460115.3 - 1.0).abs() < 1e-8);
        assert!((meniscus.range() / 1.43326085e-9 - 1.0).abs() < 1e-8);
        let product = meniscus.peak_tension() * meniscus.range();
        assert!((product / meniscus.work_of_adhesion() - 1.0).abs() < 1e-14);
    }

    #[test]
    fn the_least_humidity_is_where_it_no_longer_bridges() {
        let least = least_humidity(0.0728, 1.8e-5, 298.15);
        assert!((least - 0.17).abs() < 0.005, "{least}");
        let at = |humidity| Meniscus::at_humidity(0.0728, 1.8e-5, 298.15, humidity, 0.0).bridges();
        assert!(at(least * 1.001) && !at(least * 0.999));
    }
}
