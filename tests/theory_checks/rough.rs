//! Checks of rough surfaces.

use crate::inputs::{Answer, Inputs};
use serde_json::json;
use tabor::theory::Spectrum;

pub fn evaluate(function: &str, inputs: &Inputs) -> Option<Answer> {
    let compute: fn(&Inputs) -> Answer = match function {
        "psd_moments" => |i| {
            let [smallest, rolloff, largest, hurst, rms] =
                i.numbers(["qL", "q0", "q1", "H", "hrms"]);
            let spectrum = Spectrum::new([smallest, rolloff, largest], hurst, rms)?;
            let (_, m2, m4) = spectrum.profile_moments();
            Ok(json!({
                "m2": m2,
                "m4": m4,
                "hrms": spectrum.rms_height(),
                "hp": spectrum.rms_slope(),
                "hpp": spectrum.rms_curvature(),
                "nayak": spectrum.nayak_parameter(),
                "Dsum": spectrum.summit_density(),
                "Rbar": spectrum.typical_radius(),
                "C0": spectrum.plateau(),
            }))
        },
        _ => return None,
    };
    Some(compute(inputs))
}
