//! Checks of the elastic bodies and of waves on them.

use super::inputs::{Answer, Inputs};
use serde_json::json;
use tabor::theory::viscoelastic::{Scheme, Solid};
use tabor::theory::{kernel_eigenvalue, layer, love, westergaard};

pub fn evaluate(function: &str, inputs: &Inputs) -> Option<Answer> {
    let compute: fn(&Inputs) -> Answer = match function {
        "love" => |i| {
            let [x, y, a, b] = i.numbers(["x", "y", "a", "b"]);
            Ok(json!(love::rectangle(x, y, (a, b))?))
        },
        "disc_load" => |i| Ok(json!(love::disc(i.number("r_over_c"), 1.0)?)),
        "kernel_eig" => |i| {
            let [k, l, n] = i.numbers(["k", "l", "n"]);
            let value = kernel_eigenvalue::eigenvalue(k as i64, l as i64, n as usize)?;
            Ok(json!({
                "spectral": value.spectral,
                "pixel_centre": value.pixel_centre,
                "pixel_mean": value.pixel_mean,
            }))
        },
        "layer_M" => |i| {
            let [k, nu] = i.numbers(["k", "nu"]);
            Ok(json!({ "bonded": layer::bonded(k, nu)?, "slip": layer::sliding(k)? }))
        },
        "sls_creep_step" => |i| {
            let [relaxed, branch, time] = i.numbers(["Einf", "E1", "tau"]);
            let [step, steps, q, p] = i.numbers(["dt", "steps", "q", "p"]);
            let scheme = match i.text("scheme") {
                "backward_euler" => Scheme::BackwardEuler,
                "exponential" => Scheme::Exponential,
                other => return Err(format!("no scheme {other}").into()),
            };
            let solid = Solid::new(relaxed, branch, time)?;
            Ok(json!({
                "u_numeric": solid.stepped_creep(q, p, step, steps as usize, scheme)?,
                "u_exact": 2.0 * p / q * solid.creep(step * steps),
            }))
        },
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
