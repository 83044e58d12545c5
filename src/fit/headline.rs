//! The result of a fit in a line.

use super::choice::{FitResult, holds, range_words};
use crate::units::format_si;

/// The chosen model with work of adhesion, modulus and their uncertainties, or that no model describes the curve.
pub fn headline(result: &FitResult) -> String {
    let best = result.best();
    let quantity = |name: &str, value: f64, deviation: Option<f64>, unit: &str| {
        let value = format_si(value, unit);
        let deviation = deviation.map(|deviation| format!(" +- {}", format_si(deviation, unit)));
        format!("{name} = {value}{}", deviation.unwrap_or_default())
    };
    let numbers = &best.parameters;
    let mut parts = Vec::new();
    if best.model.adheres() {
        let deviation = result.work_uncertainty;
        parts.push(quantity("w", numbers.work_of_adhesion, deviation, "J/m^2"));
    }
    let deviation = result.modulus_uncertainty;
    parts.push(quantity("E*", numbers.contact_modulus, deviation, "Pa"));
    if let Some(mu) = result.tabor_parameter {
        let spread = result.tabor_uncertainty;
        let spread = spread.map(|spread| format!(" +- {spread:.2}"));
        let model = best.model;
        let beside = if holds(model, mu, 0.0) {
            String::new()
        } else {
            let range = range_words(model);
            format!(" ({} holds {range}, within two deviations)", model.title())
        };
        parts.push(format!(
            "Tabor number {mu:.3}{}{beside}",
            spread.unwrap_or_default()
        ));
    }
    let title = best.model.title();
    let parts = parts.join(", ");
    if result.describes_curve {
        format!("{title}: {parts}")
    } else {
        format!("none of these models describes the curve; {title} comes nearest: {parts}")
    }
}
