//! Liquid bridge between a sphere and a flat, and the equivalent Dugdale law. Israelachvili 2011,
//! for a small meniscus at the humidity of the vapour.

use super::error::{TheoryError, between, not_negative, positive, within};
use std::f64::consts::{FRAC_PI_2, PI};

pub use crate::law::{GAS_CONSTANT, LEAST_KELVIN_RADIUS};

/// A liquid in its vapour between two surfaces of one contact angle, with checked parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meniscus(crate::law::Meniscus);

impl Meniscus {
    /// A liquid of `surface_tension` (N/m) and `molar_volume` (m^3/mol) at `temperature` (K) and
    /// `relative_humidity` (0 to 1), with `contact_angle` (radian, below pi/2).
    ///
    /// Refused below the humidity at which the Kelvin radius is [`LEAST_KELVIN_RADIUS`].
    pub fn new(
        surface_tension: f64,
        molar_volume: f64,
        temperature: f64,
        relative_humidity: f64,
        contact_angle: f64,
    ) -> Result<Self, TheoryError> {
        let meniscus = crate::law::Meniscus::at_humidity(
            positive("surface_tension", surface_tension)?,
            positive("molar_volume", molar_volume)?,
            positive("temperature", temperature)?,
            within(
                "relative_humidity",
                relative_humidity,
                relative_humidity > 0.0 && relative_humidity < 1.0,
                "between 0 and 1",
            )?,
            between!(contact_angle in 0.0..FRAC_PI_2, "between 0 and pi/2")?,
        );
        within(
            "relative_humidity",
            relative_humidity,
            meniscus.bridges(),
            "high enough for a Kelvin radius of 0.3 nm",
        )?;
        Ok(Meniscus(meniscus))
    }

    /// Kelvin radius `-gamma V/(R T log RH)`, m.
    pub fn kelvin_radius(&self) -> f64 {
        self.0.kelvin_radius
    }

    /// Suction in the liquid, the Dugdale tension `gamma/r_K`, Pa.
    pub fn peak_tension(&self) -> f64 {
        self.0.peak_tension()
    }

    /// Height of the meniscus, the Dugdale range `2 r_K cos(theta)`, m.
    pub fn range(&self) -> f64 {
        self.0.range()
    }

    /// Work of adhesion `2 gamma cos(theta)`, J/m^2.
    pub fn work_of_adhesion(&self) -> f64 {
        self.0.work_of_adhesion()
    }

    /// Attraction of a rigid sphere of `radius` (m) at a least `gap` (m), N, positive:
    /// `4 pi R gamma cos(theta) (1 - gap/range)`, 0 beyond the range.
    /// A soft sphere has between three quarters and all of it, by its Tabor parameter.
    pub fn rigid_force(&self, radius: f64, gap: f64) -> Result<f64, TheoryError> {
        let fade = (1.0 - not_negative("gap", gap)? / self.range()).max(0.0);
        Ok(2.0 * PI * positive("radius", radius)? * self.work_of_adhesion() * fade)
    }
}
