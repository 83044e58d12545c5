//! `[capillary]`: a liquid that condenses between the surfaces.

use std::f64::consts::FRAC_PI_2;

use super::allowed::{Allowed, in_range};
use super::keys;
use super::reader::Reader;
use super::{AdhesionScene, CapillaryScene, LawName};
use crate::law::water::{self, CRITICAL_TEMPERATURE, LEAST_TEMPERATURE};
use crate::law::{LEAST_KELVIN_RADIUS, Meniscus, least_humidity};
use crate::units::Dimension;

/// Surface tension (N/m) and molar volume (m^3/mol) of water at [`ROOM`].
///
/// Source: IAPWS R1-76(2014); IAPWS-95 density 997.05 kg/m^3.
const WATER: (f64, f64) = (0.07199, 1.8069e-5);
/// Temperature where the scene gives none, K.
pub(super) const ROOM: f64 = 298.15;

/// Surface tension (N/m) and molar volume (m^3/mol) of water at a temperature, K; above its critical point they mean nothing.
pub(super) fn water_at(temperature: f64) -> (f64, f64) {
    let change = |of: fn(f64) -> f64| of(temperature) / of(ROOM);
    (
        WATER.0 * change(water::surface_tension),
        WATER.1 * change(water::molar_volume),
    )
}

const HUMIDITY: Allowed = Allowed::new(
    |humidity| (0.0..1.0).contains(&humidity),
    "a relative humidity from 0 to below 1",
);
const ANGLE: Allowed = Allowed::new(
    |angle| (0.0..FRAC_PI_2).contains(&angle),
    "from 0 to below 90 degrees: only a wetting liquid attracts",
);

/// Reads `[capillary]`: `Some(None)` if the scene has none, `None` after a mistake.
pub(super) fn read(scene: &Reader) -> Option<Option<CapillaryScene>> {
    if !scene.has("capillary") {
        return Some(None);
    }
    let capillary = scene.table("capillary", &keys::CAPILLARY)?;
    if scene.has("adhesion") {
        scene.conflict("capillary", "[adhesion] is given too; give one of the two");
    }
    capillary.require(&["humidity"]);
    let humidity = capillary.quantity("humidity", Dimension::Dimensionless, HUMIDITY);
    let or = |key: &str, default: f64, dimension, allowed| {
        capillary.or(key, default, |key| {
            capillary.quantity(key, dimension, allowed)
        })
    };
    let temperature = or(
        "temperature",
        ROOM,
        Dimension::Temperature,
        Allowed::POSITIVE,
    );
    let contact_angle = or("contact_angle", 0.0, Dimension::Angle, ANGLE);
    let is_water = !(capillary.has("surface_tension") && capillary.has("molar_volume"));
    if let Some(temperature) = temperature.filter(|at| is_water && *at >= CRITICAL_TEMPERATURE) {
        capillary.conflict(
            "temperature",
            format!(
                "{temperature} K is above the critical point of water, {CRITICAL_TEMPERATURE} K: give surface_tension and molar_volume of the liquid"
            ),
        );
        return None;
    }
    if let Some(temperature) = temperature.filter(|at| is_water && *at < LEAST_TEMPERATURE) {
        capillary.conflict(
            "temperature",
            format!(
                "{temperature} K is below {LEAST_TEMPERATURE} K, down to which supercooled water is known: was it meant in Celsius (25 degrees are 298.15 K)? Else give surface_tension and molar_volume of the liquid"
            ),
        );
        return None;
    }
    let water = water_at(temperature.unwrap_or(ROOM));
    let positive = Allowed::POSITIVE;
    let surface_tension = or(
        "surface_tension",
        water.0,
        Dimension::ForcePerLength,
        positive,
    );
    let molar_volume = or("molar_volume", water.1, Dimension::MolarVolume, positive);
    let found = CapillaryScene {
        humidity: humidity?,
        surface_tension: surface_tension?,
        molar_volume: molar_volume?,
        temperature: temperature?,
        contact_angle: contact_angle?,
    };
    let meniscus = found.meniscus();
    let numbers = [meniscus.range(), meniscus.peak_tension()];
    if found.bridges() && !numbers.iter().all(|&number| in_range(number)) {
        capillary.conflict(
            "humidity",
            format!(
                "makes a meniscus of {:e} m under a suction of {:e} Pa; check the powers of ten",
                numbers[0], numbers[1]
            ),
        );
        return None;
    }
    Some(Some(found))
}

impl CapillaryScene {
    /// The meniscus at this humidity; meaningless unless it [bridges](CapillaryScene::bridges) the
    /// gap.
    #[doc(hidden)]
    pub fn meniscus(&self) -> Meniscus {
        Meniscus::at_humidity(
            self.surface_tension,
            self.molar_volume,
            self.temperature,
            self.humidity,
            self.contact_angle,
        )
    }

    /// Humidity below which no liquid bridges the gap.
    pub(crate) fn least_humidity(&self) -> f64 {
        least_humidity(self.surface_tension, self.molar_volume, self.temperature)
    }

    /// Whether the air is damp enough for a liquid to bridge the gap.
    #[doc(hidden)]
    pub fn bridges(&self) -> bool {
        self.humidity > 0.0 && self.meniscus().bridges()
    }

    /// Whether the contact angle leaves a meniscus that is as high as a molecule.
    pub(crate) fn is_flat(&self) -> bool {
        self.bridges() && self.meniscus().range() < LEAST_KELVIN_RADIUS
    }

    /// The equivalent cohesive law; `None` if the air is too dry for a liquid.
    pub fn adhesion(&self) -> Option<AdhesionScene> {
        let meniscus = self.meniscus();
        self.bridges().then(|| {
            let (work, range) = (meniscus.work_of_adhesion(), meniscus.range());
            AdhesionScene::new(LawName::MaugisDugdale, work, range)
        })
    }
}
