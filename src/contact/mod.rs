//! A contact for people with arrays: heights in, gap and pressure out, everything in SI units.
//!
//! A [`Contact`] holds what touches what; [`Contact::solve`] solves one load, [`Contact::path`] one load after
//! another, each from the state of the one before. Both give [`Solution`]s, whose fields are arrays of shape
//! `[ny, nx]`, row-major: point (ix, iy) is element `iy * nx + ix`, as NumPy and ndarray store `[ny, nx]`.

mod builder;
mod control;
mod error;
mod path;
mod phrases;
mod solution;

pub use builder::Contact;
pub use control::{Control, Load};
pub use error::{ContactError, ContactMistake, ContactMistakes};
pub use path::Path;
pub use solution::Solution;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Boundary;

    /// Hertz' sphere under a force: also where tabor is built without anything but its core.
    #[test]
    fn a_sphere_comes_as_close_as_hertz_says() {
        let (n, size, radius, modulus) = (64, 1e-6, 5e-6, 1e9);
        let place = |index: usize| (index as f64 / n as f64 - 0.5) * size;
        let heights: Vec<f64> = (0..n * n)
            .map(|point| -(place(point % n).powi(2) + place(point / n).powi(2)) / (2.0 * radius))
            .collect();
        let (contact_radius, stiffness) = (0.25e-6, 4.0 / 3.0 * modulus);
        let force = stiffness * f64::powi(contact_radius, 3) / radius;
        let solution = Contact::new(heights, [n, n], [size, size])
            .contact_modulus(modulus)
            .boundary(Boundary::Free)
            .solve(Control::Force(force))
            .expect("a solution");
        let hertz = contact_radius * contact_radius / radius;
        let approach = solution.approach.expect("in contact");
        // A radius of 16 pixels: README has 1e-4 of the force for 26.
        assert!(
            (approach / hertz - 1.0).abs() < 2e-3,
            "{approach:e} {hertz:e}"
        );
    }

    #[cfg(not(feature = "gpu"))]
    #[test]
    fn graphics_processors_are_refused_where_none_is_built_in() {
        let contact = Contact::new([0.0; 16], [4, 4], [1e-6, 1e-6]).contact_modulus(1e9);
        let error = contact
            .device(crate::device::Device::gpu())
            .solve(Control::MeanPressure(1e6))
            .expect_err("no GPU");
        let expected = "without the feature `gpu`); Device::cpu() does without";
        assert!(error.to_string().contains(expected), "{error}");
    }
}
