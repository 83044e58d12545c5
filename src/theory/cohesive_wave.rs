//! The line wave with a cohesive zone of constant tension: Johnson's adhesive wave at a finite range.
//!
//! The undeformed gap is `D (1 - cos(2 pi x/wavelength))`; a tension acts outside the contact up to a gap
//! of the range. Pressures are in `p* = pi E* D/wavelength`, gaps in D, half widths as
//! `s = sin(pi x/wavelength)`. In s the periodic problem is that of one parabola in plane strain, whose
//! tractions are weighed by `1/sqrt(1 - s^2)` (the pair of points at x and -x has the kernel of two points
//! on a line), so contact and zone follow as in Baney & Hui 1997. With the range -> 0 at a fixed work of
//! adhesion it is [`westergaard::adhesive_mean_pressure`](super::westergaard::adhesive_mean_pressure).

use super::error::{TheoryError, positive, within};
use super::quadrature::gauss_legendre;
use super::roots::{minimum, root};
use super::westergaard::adhesive_extrema;
use std::f64::consts::PI;

/// Nodes of each integral: 1e-9 of the opening.
const NODES: usize = 40;

/// A wave of given adhesion and range.
#[derive(Clone, Debug)]
pub struct CohesiveWave {
    adhesion: f64,
    tension: f64,
    range: f64,
    nodes: Vec<(f64, f64)>,
}

/// An equilibrium of the wave.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct WaveState {
    /// `sin(pi a/wavelength)`, with a the half width of the contact.
    pub contact: f64,
    /// The same of the zone's outer edge; 1 where the tension acts everywhere.
    pub zone: f64,
    /// Mean pressure in p*.
    pub mean_pressure: f64,
}

impl CohesiveWave {
    /// A wave of Johnson's `adhesion` (see [`super::westergaard::adhesion_parameter`]), whose tension acts up to `range`,
    /// in D.
    ///
    /// # Errors
    /// Numbers that are not positive, and an adhesion above [`super::westergaard::CRITICAL_ADHESION`].
    pub fn new(adhesion: f64, range: f64) -> Result<CohesiveWave, TheoryError> {
        let adhesion = positive("adhesion", adhesion)?;
        within(
            "adhesion",
            adhesion,
            adhesion <= super::westergaard::CRITICAL_ADHESION,
            "no more than closes the wave without load",
        )?;
        let range = positive("range", range)?;
        let (nodes, weights) = gauss_legendre(NODES);
        Ok(CohesiveWave {
            adhesion,
            // w = adhesion^2 pi^2 D^2 E*/(2 wavelength), over the range and p*.
            tension: 0.5 * PI * adhesion * adhesion / range,
            range,
            // On 0 to 1.
            nodes: nodes
                .into_iter()
                .zip(weights)
                .map(|(x, weight)| (0.5 * (x + 1.0), 0.5 * weight))
                .collect(),
        })
    }

    /// The equilibrium with `contact = sin(pi a/wavelength)`, between 0 and 1.
    ///
    /// # Errors
    /// A contact that is not between 0 and 1.
    pub fn state(&self, contact: f64) -> Result<WaveState, TheoryError> {
        within(
            "contact",
            contact,
            contact > 0.0 && contact < 1.0,
            "between 0 and 1",
        )?;
        // The zone by its depth in s^2: from zero to everything that is open.
        let open = 1.0 - contact * contact;
        let excess = |share: f64| self.opening(contact, share * open.sqrt()) - self.range;
        let share = if excess(1.0 - 1e-12) <= 0.0 {
            1.0
        } else {
            root("the cohesive zone", excess, 1e-12, 1.0 - 1e-12, 1e-15)?
        };
        Ok(WaveState {
            contact,
            zone: (contact * contact + share * share * open).sqrt(),
            mean_pressure: contact * contact - 2.0 / PI * self.tension * share.asin(),
        })
    }

    /// Gap at the outer edge of a zone from `s = contact` to `s^2 = contact^2 + depth^2`, in D:
    /// that of Westergaard's wave plus the opening by the tension.
    fn opening(&self, contact: f64, depth: f64) -> f64 {
        let open = 1.0 - contact * contact;
        let edge = (contact * contact + depth * depth).sqrt();
        let hard = 2.0 * (edge * depth - contact * contact * (depth / contact).asinh());
        // Slope over s: (2/pi) tension r I, r^2 = s^2 - contact^2, with the principal value I = 2
        // int_0^depth dv/((r^2 - v^2) sqrt(open - v^2)); the pole is subtracted and integrated in
        // closed form.
        let opened = self.nodes.iter().map(|&(t, weight)| {
            // Nodes are dense at the end of the zone, where the slope is a logarithm.
            let r = depth * (1.0 - t.powi(3));
            let at = (open - r * r).sqrt();
            let regular = self.nodes.iter().map(|&(x, weight)| {
                let there = (open - (x * depth).powi(2)).sqrt();
                -depth * weight / (there * at * (there + at))
            });
            let pole = ((depth + r) / (depth - r)).ln() / (2.0 * r * at);
            let value = 2.0 * (regular.sum::<f64>() + pole);
            3.0 * depth * t * t * weight * r * r * value / contact.hypot(r)
        });
        hard + 2.0 / PI * self.tension * opened.sum::<f64>()
    }

    /// The state of greatest tension, at which the wave separates under load control.
    ///
    /// # Errors
    /// The search fails.
    pub fn pull_off(&self) -> Result<WaveState, TheoryError> {
        // A finite range lets the contact shrink further than Johnson's before it separates.
        let sharp = adhesive_extrema(self.adhesion)?.pull_off_angle.sin();
        let (contact, _) = minimum(|contact| self.pressure(contact), 1e-6, 1.05 * sharp);
        self.state(contact)
    }

    /// The state of greatest pressure before the snap into full contact.
    ///
    /// # Errors
    /// A range so long that the wave closes without a snap.
    pub fn closing(&self) -> Result<WaveState, TheoryError> {
        let sharp = adhesive_extrema(self.adhesion)?.pull_off_angle.sin();
        let (contact, _) = minimum(|contact| -self.pressure(contact), sharp, 1.0 - 1e-9);
        let state = self.state(contact)?;
        if state.zone < 1.0 {
            return Ok(state);
        }
        Err(TheoryError::NoSolution {
            what: "a snap into full contact",
        })
    }

    fn pressure(&self, contact: f64) -> f64 {
        self.state(contact)
            .map_or(f64::NAN, |state| state.mean_pressure)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_short_range_is_johnsons_wave() {
        for adhesion in [0.03, 0.1, 0.3, 0.5] {
            let sharp = adhesive_extrema(adhesion).unwrap();
            let wave = CohesiveWave::new(adhesion, 1e-4).unwrap();
            let (off, closing) = (wave.pull_off().unwrap(), wave.closing().unwrap());
            assert!((off.mean_pressure + sharp.pull_off).abs() < 1e-3 * sharp.pull_off);
            assert!((closing.mean_pressure - sharp.closing_pressure).abs() < 1e-3);
        }
    }

    /// Westergaard's pressure less the tension, which acts everywhere.
    #[test]
    fn a_long_range_only_adds_its_tension() {
        let state = CohesiveWave::new(0.3, 10.0).unwrap().state(0.4).unwrap();
        let tension = 0.5 * PI * 0.09 / 10.0;
        assert_eq!(state.zone, 1.0);
        assert!(CohesiveWave::new(0.3, 10.0).unwrap().closing().is_err());
        assert!((state.mean_pressure - (0.16 - tension)).abs() < 1e-15);
    }
}
