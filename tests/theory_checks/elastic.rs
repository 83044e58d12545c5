//! Checks of the elastic bodies and of waves on them.

use crate::inputs::{Answer, Inputs};
use serde_json::json;
use tabor::theory::{love, westergaard};

pub fn evaluate(function: &str, inputs: &Inputs) -> Option<Answer> {
    let compute: fn(&Inputs) -> Answer = match function {
        "love" => |i| {
            let [x, y, a, b] = i.numbers(["x", "y", "a", "b"]);
            Ok(json!(love::rectangle(x, y, (a, b))?))
        },
        "disc_load" => |i| Ok(json!(love::disc(i.number("r_over_c"), 1.0)?)),
        "westergaard" => |i| {
            let a = i.number("a_over_lam");
            Ok(json!({
                "pbar_over_pstar": westergaard::mean_pressure(a)?,
                "p_centre_over_pstar": westergaard::pressure(a, 0.0)?,
            }))
        },
        "wavy_adhesive" => |i| {
            let [a, alpha] = i.numbers(["a_over_lam", "alpha"]);
            Ok(json!(westergaard::adhesive_mean_pressure(a, alpha)?))
        },
        "wavy_adhesive_extrema" => |i| {
            let extrema = westergaard::adhesive_extrema(i.number("alpha"))?;
            Ok(json!({
                "pull_off": extrema.pull_off,
                "psi_pull": extrema.pull_off_angle,
                "jump_full": extrema.closing_pressure,
                "psi_jump": extrema.closing_angle,
            }))
        },
        "wavy_alpha_critical" => |_| Ok(json!(westergaard::CRITICAL_ADHESION)),
        "jgh_low" => |i| {
            Ok(json!(westergaard::egg_box_area_low(
                i.number("pbar_over_pstar")
            )?))
        },
        "jgh_high" => |i| {
            Ok(json!(westergaard::egg_box_area_high(
                i.number("pbar_over_pstar")
            )?))
        },
        _ => return None,
    };
    Some(compute(inputs))
}
