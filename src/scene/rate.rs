//! `rate` in `[adhesion]`: a work of adhesion that grows with the speed of a receding edge.

use super::allowed::Allowed;
use super::keys;
use super::reader::Reader;
use super::{LawName, RateScene, Treatment};
use crate::units::Dimension;

/// Range of exponents, wider than what has been measured.
const EXPONENT: Allowed = Allowed::new(
    |exponent| (0.05..=2.0).contains(&exponent),
    "an exponent from 0.05 to 2",
);

/// Reads the rate: `Some(None)` if there is none, `None` after a mistake.
pub(super) fn read(
    adhesion: &Reader,
    law: Option<LawName>,
    treatment: Option<Treatment>,
) -> Option<Option<RateScene>> {
    if !adhesion.has("rate") {
        return Some(None);
    }
    let rate = adhesion.table("rate", &keys::RATE)?;
    if law == Some(LawName::LennardJones) {
        adhesion.conflict(
            "rate",
            "multiplies the tension of a receding edge, and with law = \"lennard-jones\" also the repulsion; take another law",
        );
        return None;
    }
    if treatment == Some(Treatment::Dmt) {
        // The searches for the net load and for the speed would have to be combined.
        adhesion.not_in_this_version(
            "rate",
            "a rate with treatment = \"dmt\"",
            "take treatment = \"full\", or leave the rate out",
        );
        return None;
    }
    rate.require(&["reference_speed", "exponent"]);
    let reference_speed = rate.quantity("reference_speed", Dimension::Speed, Allowed::POSITIVE);
    let exponent = rate.quantity("exponent", Dimension::Dimensionless, EXPONENT);
    Some(Some(RateScene {
        reference_speed: reference_speed?,
        exponent: exponent?,
    }))
}

impl RateScene {
    /// Factor on the work of adhesion of an edge that recedes at `speed` (m/s); 1 at rest.
    ///
    /// Gent & Schultz 1972, doi:10.1080/00218467208072219; Maugis & Barquins 1978.
    pub fn factor(&self, speed: f64) -> f64 {
        1.0 + (speed.max(0.0) / self.reference_speed).powf(self.exponent)
    }
}
