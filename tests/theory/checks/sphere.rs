//! Checks of one sphere, and of the laws and units.

use super::inputs::{Answer, Inputs};
use serde_json::json;
use tabor::theory::capillary::Meniscus;
use tabor::theory::dmt::{self, Method};
use tabor::theory::lennard_jones_sphere::LennardJonesSphere;
use tabor::theory::maugis_dugdale::{self, MaugisDugdale};
use tabor::theory::tabor_map::{self, Sphere};
use tabor::theory::viscoelastic::Solid;
use tabor::theory::{Law, bradley, conductance, cone_punch, derjaguin, friction, hertz, jkr, rate};

pub fn evaluate(function: &str, inputs: &Inputs) -> Option<Answer> {
    let compute: fn(&Inputs) -> Answer = match function {
        "Estar" => |i| {
            let [e1, nu1, e2, nu2] = i.numbers(["E1", "nu1", "E2", "nu2"]);
            Ok(json!(tabor_map::contact_modulus((e1, nu1), (e2, nu2))?))
        },
        "tabor_mu" => |i| {
            let mu = tabor_map::tabor_parameter(&sphere(i)?, i.number("z0"))?;
            Ok(json!(mu))
        },
        "maugis_lambda" => |i| {
            let lambda = tabor_map::maugis_parameter(&sphere(i)?, i.number("sigma0"))?;
            Ok(json!(lambda))
        },
        "lambda_over_mu_matched_LJ" => |_| Ok(json!(tabor_map::LAMBDA_PER_MU_MATCHED)),
        "maugis_scales" => |i| {
            let scales = sphere(i)?.maugis_scales()?;
            Ok(json!({
                "a_star": scales.radius,
                "F_star": scales.force,
                "delta_star": scales.approach,
            }))
        },
        "law_lj" => |i| law(Law::LennardJones, i),
        "law_cubic" => |i| law(Law::Cubic, i),
        "law_exponential" => |i| law(Law::Exponential, i),
        "law_lj_special" => |_| {
            let law = Law::LennardJones;
            Ok(json!({
                "u_peak_over_eps": law.peak_gap(),
                "sigma_peak_eps_over_w": law.traction(law.peak_gap()),
                "slope0_eps2_over_w": law.slope(0.0),
                "u_steepest_over_eps": law.steepest().0,
                "min_slope_eps2_over_w": law.steepest().1,
                "energy_fraction_beyond_peak": -law.energy(law.peak_gap()),
            }))
        },
        "hertz" => |i| {
            let sphere = sphere(i)?;
            let a = hertz::contact_radius(&sphere, i.number("F"))?;
            Ok(json!({
                "a": a,
                "delta": hertz::approach(&sphere, a),
                "p0": hertz::pressure(&sphere, a, 0.0),
                "stiffness": hertz::stiffness(&sphere, a),
            }))
        },
        "hertz_gap" => |i| {
            let (sphere, a, r) = (Sphere::new(1.0, 1.0, 0.0)?, 0.01, i.number("r_over_a"));
            Ok(json!({
                "gap_R_over_a2": hertz::gap(&sphere, a, r * a) / (a * a),
                "uz_R_over_a2": hertz::displacement(&sphere, a, r * a) / (a * a),
            }))
        },
        "bradley_lj" => |i| {
            let gap = i.number("gap_over_eps");
            let force = bradley::force(
                &Sphere::new(2.0, 1.0, 3.0)?,
                Law::LennardJones,
                0.1,
                0.1 * gap,
            )?;
            Ok(json!(-force / (2.0 * std::f64::consts::PI * 6.0)))
        },
        "dmtf_lj" => |i| attraction(Method::Force, Law::LennardJones, i),
        "dmtf_cubic" => |i| attraction(Method::Force, Law::Cubic, i),
        "dmtt_cubic" => |i| attraction(Method::Thermodynamic, Law::Cubic, i),
        "idmtt_lj" => |i| attraction(Method::Thermodynamic, Law::LennardJones, i),
        "dmt_energy_lj" => |i| {
            let gain = dmt::energy_gain(Law::LennardJones, i.number("a_over_sqrtReps"))?;
            Ok(json!(gain))
        },
        "dmtf_validity" => |_| {
            Ok(json!({
                "i0": dmt::POINT_CONTACT_INTEGRAL,
                "mu_c": tabor_map::FORCE_DMT_LIMIT,
            }))
        },
        "dmtf_asymptotes" => |_| {
            Ok(json!({
                "large_coef": dmt::force_method_large_radius(),
                "small_coef": dmt::force_method_small_radius(),
            }))
        },
        "fig2_models" => |i| {
            let [approach, mu] = i.numbers(["delta_over_eps", "mu"]);
            let force = |method, law| dmt::force(method, law, approach, mu);
            Ok(json!({
                "derjaguin": derjaguin::reduced_force(approach, mu)?,
                "dmtt_cubic": force(Method::Thermodynamic, Law::Cubic)?,
                "idmtt": force(Method::Thermodynamic, Law::LennardJones)?,
                "dmtm": force(Method::Constant, Law::LennardJones)?,
                "dmtf": force(Method::Force, Law::LennardJones)?,
            }))
        },
        "fig2_jkr" => |i| {
            let [approach, mu] = i.numbers(["delta_over_eps", "mu"]);
            let approach = tabor_map::maugis_from_lj_approach(approach, mu);
            let radius = jkr::reduced_radius_at_approach(approach)?;
            Ok(json!(0.5 * jkr::reduced_force(radius)))
        },
        "fig2_numeric_lj" => |i| {
            let [approach, mu] = i.numbers(["delta_over_eps", "mu"]);
            let sphere = LennardJonesSphere::new(mu, approach.max(0.0))?;
            Ok(json!(sphere.at_approach(approach)?.force))
        },
        "pulloff_lj_sphere" => |i| {
            let sphere = LennardJonesSphere::new(i.number("mu"), 0.0)?;
            Ok(json!(sphere.pull_off()?.force))
        },
        "jkr_reduced" => |i| {
            let a = i.number("A");
            Ok(json!({
                "F_bar": jkr::reduced_force(a),
                "delta_bar": jkr::reduced_approach(a),
                "S_bar": jkr::reduced_stiffness(a),
            }))
        },
        "jkr_special" => |_| {
            let (pull, grip) = (jkr::pull_off(), jkr::grip());
            Ok(json!({
                "A_pull": pull,
                "F_pull": jkr::reduced_force(pull),
                "d_pull": jkr::reduced_approach(pull),
                "A_grip": grip,
                "F_grip": jkr::reduced_force(grip),
                "d_grip": jkr::reduced_approach(grip),
                "A_zero_load": jkr::zero_load(),
                "d_zero_load": jkr::reduced_approach(jkr::zero_load()),
                "A_zero_approach": jkr::zero_approach(),
                "F_zero_approach": jkr::reduced_force(jkr::zero_approach()),
            }))
        },
        "jkr_SI" => |i| {
            let sphere = sphere(i)?;
            let a = jkr::contact_radius(&sphere, i.number("F"))?;
            Ok(json!({
                "a": a,
                "delta": jkr::approach(&sphere, a),
                "stiffness": jkr::stiffness(&sphere, a),
                "stiffness_frozen": hertz::stiffness(&sphere, a),
                "p_centre": jkr::pressure(&sphere, a, 0.0),
                "p_0p9a": jkr::pressure(&sphere, a, 0.9 * a),
                "gap_1p5a": jkr::gap(&sphere, a, 1.5 * a),
                "F_pull": jkr::pull_off_force(&sphere),
            }))
        },
        "jkr_inversion" => |i| {
            let [r, pull, force, slope] = i.numbers(["R", "F_pull_abs", "F", "S"]);
            let sphere = jkr::from_measurement(r, pull, force, slope)?;
            Ok(json!({ "w": sphere.work_of_adhesion(), "Es": sphere.contact_modulus() }))
        },
        "md_state" => |i| {
            let state = maugis(i)?.state(i.number("A"))?;
            Ok(json!({
                "m": state.ratio(),
                "F_bar": state.force,
                "delta_bar": state.approach,
            }))
        },
        "md_pulloff" => |i| Ok(json!({ "F_bar": maugis(i)?.pull_off()?.force })),
        "md_pulloff_location" => |i| {
            let state = maugis(i)?.pull_off()?;
            Ok(json!({
                "A": state.contact_radius,
                "m": state.ratio(),
                "delta_bar": state.approach,
            }))
        },
        "md_pulloff_grips" => |i| Ok(json!({ "delta_bar": maugis(i)?.grip()?.approach })),
        "md_zero_load_radius" => |i| {
            let states = maugis(i)?.states_at_force(0.0)?;
            Ok(json!(states.last().map(|state| state.contact_radius)))
        },
        "md_fold_lambda" => |_| Ok(json!(maugis_dugdale::FOLD_LAMBDA)),
        "carpick_fit" => |i| {
            let fit = maugis_dugdale::carpick_fit(i.number("lam"))?;
            Ok(json!({
                "alpha": fit.alpha,
                "a0_bar": fit.zero_load_radius,
                "F_bar": fit.pull_off_force,
            }))
        },
        "gamma_rate" => |i| {
            let [work, speed, reference, exponent] = i.numbers(["w", "v", "vstar", "n"]);
            Ok(json!(rate::power_law(work, speed, reference, exponent)?))
        },
        "gamma_log" => |i| {
            let [work, slope, speed, reference] = i.numbers(["W0", "alpha", "v", "v0"]);
            Ok(json!(rate::logarithmic_law(work, slope, speed, reference)?))
        },
        "rate_jkr_pulloff" => |i| {
            let [speed, exponent] = i.numbers(["V_bar", "n"]);
            Ok(json!(rate::reduced_pull_off(speed, exponent)?))
        },
        "capillary" => |i| {
            let [tension, volume, temperature, humidity] = i.numbers(["gamma", "Vm", "T", "RH"]);
            let angle = i.number("theta_deg").to_radians();
            let meniscus = Meniscus::new(tension, volume, temperature, humidity, angle)?;
            let [radius, gap] = i.numbers(["R", "D"]);
            Ok(json!({
                "r_kelvin": meniscus.kelvin_radius(),
                "sigma0": meniscus.peak_tension(),
                "h0": meniscus.range(),
                "w_cap": meniscus.work_of_adhesion(),
                "F_contact": meniscus.rigid_force(radius, 0.0)?,
                "F_gap": meniscus.rigid_force(radius, gap)?,
            }))
        },
        "friction_jkr" => |i| {
            let [strength, force] = i.numbers(["tau", "F"]);
            Ok(json!(friction::jkr_force(&sphere(i)?, strength, force)?))
        },
        "constriction_circle" => |i| {
            let [radius, first, second, modulus] = i.numbers(["a", "k1", "k2", "Es"]);
            let conductivity = conductance::combined_conductivity(first, second)?;
            let stiffness = cone_punch::punch_force(radius, modulus, 1.0)?;
            Ok(json!({
                "C": conductance::circle(conductivity, radius)?,
                "C_from_stiffness": conductance::from_stiffness(conductivity, modulus, stiffness)?,
            }))
        },
        "lee_radok" => |i| {
            let [relaxed, branch, time] = i.numbers(["Einf", "E1", "tau"]);
            let [radius, force, t] = i.numbers(["R", "F", "t"]);
            let solid = Solid::new(relaxed, branch, time)?;
            Ok(json!(solid.sphere_contact_radius(radius, force, t)?))
        },
        "cone" => |i| {
            let cone = cone_punch::Cone::new(i.number("b_deg").to_radians(), i.number("Es"))?;
            let a = i.number("a");
            Ok(json!({ "F": cone.force(a), "delta": cone.approach(a) }))
        },
        _ => return None,
    };
    Some(compute(inputs))
}

/// The sphere of inputs `R`, `Es` and, if it sticks, `w`.
fn sphere(inputs: &Inputs) -> Result<Sphere, tabor::theory::TheoryError> {
    let [radius, modulus, work] = inputs.numbers(["R", "Es", "w"]);
    Sphere::new(radius, modulus, if work.is_nan() { 0.0 } else { work })
}

fn maugis(inputs: &Inputs) -> Result<MaugisDugdale, tabor::theory::TheoryError> {
    MaugisDugdale::new(inputs.number("lam"))
}

fn attraction(method: Method, law: Law, inputs: &Inputs) -> Answer {
    let radius = inputs.number("a_over_sqrtReps");
    Ok(json!(dmt::attraction(method, law, radius)?))
}

fn law(law: Law, inputs: &Inputs) -> Answer {
    let gap = inputs.number("u_over_range");
    Ok(json!({
        "phi_over_w": law.energy(gap),
        "sigma_range_over_w": law.traction(gap),
        "dsigma_range2_over_w": law.slope(gap),
    }))
}
