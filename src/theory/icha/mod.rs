//! Interacting Hertz asperities with merging of overlapping contacts (ICHA): Afferrante, Carbone &
//! Demelio 2012, Afferrante et al. 2018, with the sums corrected.
//!
//! For a few asperities on an infinite half-space: [`contacts`] and [`merged_contacts`]. For a
//! whole periodic height map: [`Icha`], which finds the summits, increases the load, merges, and
//! gives the gap field over which a law's traction can be summed.

mod displacements;
mod gap;
mod gmres;
mod lattice;
mod loading;
mod merge;
mod mesh;
mod newton;
mod pair;
mod set;
mod summits;

pub use gap::GapField;
pub use loading::{Icha, Loading, Pressed};
pub use merge::MergeRule;
#[doc(hidden)]
pub use merge::merged_contacts;

use super::error::{TheoryError, finite, positive};
use lattice::Lattice;
use newton::{Equilibrium, Prescribed, Tolerances, solve_equilibrium};
use set::Set;
use std::f64::consts::PI;

/// A paraboloid that represents a summit of the rough surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Asperity {
    /// Position of its summit, m.
    pub position: [f64; 2],
    /// Height of its summit, m.
    pub height: f64,
    /// Radius of curvature, m.
    pub radius: f64,
}

/// An asperity and its contact; the radius is 0 without contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// The asperity.
    pub asperity: Asperity,
    /// Contact radius, m.
    pub contact_radius: f64,
}

impl Contact {
    /// Its Hertz indentation `a^2/R`, m.
    pub fn indentation(&self) -> f64 {
        self.contact_radius * self.contact_radius / self.asperity.radius
    }

    /// Its load over the contact modulus, m^2: `(4/3) a^3/R`.
    pub fn load_over_modulus(&self) -> f64 {
        4.0 / 3.0 * self.contact_radius * self.indentation()
    }

    /// Its area, m^2.
    pub fn area(&self) -> f64 {
        PI * self.contact_radius * self.contact_radius
    }

    /// Volume of its cap, cut off at the contact, `pi a^4/(4 R)`, m^3.
    fn volume(&self) -> f64 {
        0.25 * PI * self.contact_radius.powi(4) / self.asperity.radius
    }
}

/// Contacts of all asperities with a plane at height `plane` (m), each displaced by the others:
/// `delta_i + sum_j U(r_ij; a_j, R_j) = z_i - plane` in contact.
#[doc(hidden)]
pub fn contacts(asperities: &[Asperity], plane: f64) -> Result<Vec<Contact>, TheoryError> {
    check(asperities, plane)?;
    let lattice = Lattice::infinite();
    let set = Set::new(asperities.to_vec(), &lattice);
    let start = Equilibrium::undeformed(asperities, plane);
    let settled = solve_equilibrium(&set, &lattice, Prescribed::Plane, start, Tolerances::FULL)?;
    Ok(settled.state.contacts(asperities))
}

fn check(asperities: &[Asperity], plane: f64) -> Result<(), TheoryError> {
    finite("plane", plane)?;
    for asperity in asperities {
        positive("radius", asperity.radius)?;
        finite("height", asperity.height)?;
        finite("position", asperity.position[0] + asperity.position[1])?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::merge::merged;
    use super::*;

    fn at(x: f64, height: f64, radius: f64) -> Asperity {
        Asperity {
            position: [x, 0.0],
            height,
            radius,
        }
    }

    #[test]
    fn a_low_neighbour_is_pushed_out_of_contact() {
        let (high, low) = (at(0.0, 0.0, 1.0), at(0.2, -0.018, 1.0));
        let both = contacts(&[high, low], -0.02).unwrap();
        assert!((both[0].indentation() - 0.02).abs() < 1e-12);
        assert_eq!(both[1].contact_radius, 0.0);
        assert!(contacts(&[at(0.0, 0.0, 0.0)], 0.0).is_err());
    }

    #[test]
    fn merging_keeps_area_and_load_if_told_so() {
        let before = contacts(&[at(0.0, 0.0, 1.0), at(0.15, 0.0, 2.0)], -0.02).unwrap();
        let one = merged(&before, -0.02, |_| 0.0, MergeRule::Load).unwrap();
        let sum = |of: fn(&Contact) -> f64| before.iter().map(of).sum::<f64>();
        assert!((one.area() / sum(Contact::area) - 1.0).abs() < 1e-13);
        let load = sum(Contact::load_over_modulus);
        assert!((one.load_over_modulus() / load - 1.0).abs() < 1e-13);
    }

    #[test]
    fn merging_keeps_the_displaced_volume_if_told_so() {
        // Twins with touching circles: U = 0.2180 a^2/R of one at the other's summit (asin 1/2 =
        // pi/6).
        let (a, radius) = (0.1, 1.0);
        let at = |x| Contact {
            asperity: at(x, 0.0, radius),
            contact_radius: a,
        };
        let one = merged(
            &[at(0.0), at(0.2)],
            0.0,
            |_| 0.0,
            MergeRule::DisplacedVolume,
        )
        .unwrap();
        let felt = (3f64.sqrt() - PI / 3.0) / PI;
        // The conserved volume is 3/4 pi a^4/R and pi a^2 U of each; the load follows.
        let twins = 2.0 * PI * a.powi(4) / radius * (0.75 + felt);
        let displaced = 0.75 * PI * one.contact_radius.powi(4) / one.asperity.radius;
        assert!((displaced / twins - 1.0).abs() < 1e-13);
        assert!((one.area() / (2.0 * PI * a * a) - 1.0).abs() < 1e-13);
        let load = one.load_over_modulus() / (2.0 * at(0.0).load_over_modulus());
        assert!((load - 0.5f64.sqrt() * (1.0 + 4.0 / 3.0 * felt)).abs() < 1e-13);
    }
}
