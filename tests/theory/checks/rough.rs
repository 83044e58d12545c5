//! Checks of rough surfaces.

use super::inputs::{Answer, Inputs};
use serde_json::json;
use tabor::theory::bam::BearingArea;
use tabor::theory::fuller_tabor::{self, Path};
use tabor::theory::icha::{self, Asperity, Contact, MergeRule};
use tabor::theory::pastewka_robbins::{self, Edge};
use tabor::theory::persson::{self, Persson};
use tabor::theory::persson_gap::{Adhesion, RoughContact};
use tabor::theory::{Law, Spectrum, Sphere, TheoryError, gw, gw_m, tabor_map};

/// The study's material and roughness (SI).
const MODULUS: f64 = 1.33e12;
const RMS_HEIGHT: f64 = 0.52e-9;
const SMALLEST_WAVENUMBER: f64 = 2.5e5;
const ADHESION: Adhesion = Adhesion {
    law: Law::LennardJones,
    work_of_adhesion: 0.2,
    range: 1e-9,
};

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
        "gauss_F_integrals" => |i| {
            let t = i.number("t");
            Ok(json!({
                "F0": gw::tail_zero(t),
                "F1": gw::tail_one(t),
                "F32": gw::tail_three_halves(t)?,
            }))
        },
        "gw" => |i| {
            let [t, density, radius, sigma, modulus] = i.numbers(["t", "n", "R", "sigma", "Es"]);
            let summits = gw::Summits::new(Sphere::new(radius, modulus, 0.0)?, density, sigma)?;
            Ok(json!({
                "p": summits.pressure(t)?,
                "area_fraction": summits.contact_area_fraction(t),
            }))
        },
        "gwm_pulloff" => |i| Ok(json!(gw_m::reduced_pull_off(i.number("theta"))?.1)),
        "fuller_tabor_pulloff" => {
            |i| Ok(json!(fuller_tabor::reduced_pull_off(i.number("theta"))?.1))
        }
        "fuller_tabor_force" => |i| {
            let [separation, theta] = i.numbers(["h_over_sigma", "theta"]);
            let force = |path| fuller_tabor::reduced_pressure(theta, separation, path);
            Ok(json!({ "unload": force(Path::Unloading)?, "load": force(Path::Loading)? }))
        },
        "bam_pulloff" => |i| {
            let [height, stiffness] = i.numbers(["hrms_over_h0", "q0_hrms_Es_over_sigma0"]);
            Ok(json!(BearingArea::new(height, stiffness)?.pull_off()?.1))
        },
        "pr_ratio" => |i| {
            let [slope, curvature, work, modulus, range, coefficient] =
                i.numbers(["hp", "hpp", "w", "Es", "dr", "kappa"]);
            Ok(json!(pastewka_robbins::stickiness_ratio(&Edge {
                rms_slope: slope,
                rms_curvature: curvature,
                work_of_adhesion: work,
                contact_modulus: modulus,
                range,
                area_coefficient: coefficient,
            })?))
        },
        "persson_area" => |i| {
            let [pressure, gamma] = i.numbers(["P", "gamma"]);
            Ok(json!({
                "A_original": persson::original_area_fraction(pressure)?,
                "A_corrected": Persson::new(gamma)?.area_fraction(pressure)?,
            }))
        },
        "persson_I" => |i| {
            let [x0, gamma] = i.numbers(["x0", "gamma"]);
            Ok(json!(Persson::new(gamma)?.gap_integral(x0)?))
        },
        "persson_ubar" => |i| {
            let (contact, pressure) = unit_contact(i)?;
            Ok(json!(contact.mean_gap(pressure)?))
        },
        "persson_stiffness" => |i| {
            let (contact, pressure) = unit_contact(i)?;
            Ok(json!(contact.stiffness(pressure)?))
        },
        "icha_two" => |i| {
            let contacts = icha::contacts(&asperities(i), i.number("d"))?;
            let sum = |of: fn(&Contact) -> f64| contacts.iter().map(of).sum::<f64>();
            let indentations: Vec<f64> = contacts.iter().map(Contact::indentation).collect();
            Ok(json!({
                "delta": indentations,
                "load": sum(Contact::load_over_modulus),
                "area": sum(Contact::area),
            }))
        },
        "icha_merge" => |i| {
            let merged = icha::merged_contacts(&asperities(i), i.number("d"), MergeRule::Volume)?;
            let [one] = merged[..] else {
                return Err("not one contact".into());
            };
            Ok(json!({
                "a": one.contact_radius,
                "x": one.asperity.position[0],
                "z": one.asperity.height,
                "R": one.asperity.radius,
                "load": one.load_over_modulus(),
                "area": one.area(),
            }))
        },
        "study_persson_point" => |i| {
            let contact = study(i)?;
            let slope = contact.spectrum().rms_slope();
            let pressure = i.number("P") * MODULUS * slope;
            Ok(json!({
                "p_ad_over_Ehp": contact.attraction(&ADHESION, pressure)? / (MODULUS * slope),
                "A": contact.area_fraction(pressure)?,
                "ubar_over_h": contact.mean_gap(pressure)? / RMS_HEIGHT,
            }))
        },
        "study_persson_S" => study_persson,
        "study_gwm_area" => |i| {
            let spectrum = *study(i)?.spectrum();
            let summits = study_summits(&spectrum, i.number("w"))?;
            let pressure = i.number("P") * MODULUS * spectrum.rms_slope();
            let separation = gw_m::separation(&summits, pressure)?;
            Ok(json!(summits.contact_area_fraction(separation)))
        },
        _ => return None,
    };
    Some(compute(inputs))
}

/// Asperities of the rows (x, y, z, R) of `xyzR`.
fn asperities(inputs: &Inputs) -> Vec<Asperity> {
    let row = |row: &Vec<f64>| Asperity {
        position: [row[0], row[1]],
        height: row[2],
        radius: row[3],
    };
    inputs.rows("xyzR").iter().map(row).collect()
}

/// The spectrum of inputs `H` and `N`, four roll-off waves wide.
fn spectrum(inputs: &Inputs, smallest: f64, rms_height: f64) -> Result<Spectrum, TheoryError> {
    let [hurst, ratio] = inputs.numbers(["H", "N"]);
    let rolloff = 4.0 * smallest;
    Spectrum::new([smallest, rolloff, ratio * rolloff], hurst, rms_height)
}

/// A contact with all units 1, and the pressure `P E* h'_rms`.
fn unit_contact(inputs: &Inputs) -> Result<(RoughContact, f64), TheoryError> {
    let [gamma, pressure] = inputs.numbers(["gamma", "P"]);
    let spectrum = spectrum(inputs, 1.0, 1.0)?;
    let contact = RoughContact::new(Persson::new(gamma)?, spectrum, 1.0)?;
    Ok((contact, pressure * spectrum.rms_slope()))
}

fn study(inputs: &Inputs) -> Result<RoughContact, TheoryError> {
    let spectrum = spectrum(inputs, SMALLEST_WAVENUMBER, RMS_HEIGHT)?;
    RoughContact::new(Persson::new(0.5)?, spectrum, MODULUS)
}

/// The study's choice of summits: heights of the whole surface, radius `2/h''_rms`.
fn study_summits(spectrum: &Spectrum, work_of_adhesion: f64) -> Result<gw::Summits, TheoryError> {
    let summit = Sphere::new(spectrum.typical_radius(), MODULUS, work_of_adhesion)?;
    gw::Summits::new(summit, spectrum.summit_density(), spectrum.rms_height())
}

fn study_persson(inputs: &Inputs) -> Answer {
    let contact = study(inputs)?;
    let slope = contact.spectrum().rms_slope();
    let unit = MODULUS * slope;
    let tension = ADHESION.work_of_adhesion / ADHESION.range;
    let summits = study_summits(contact.spectrum(), ADHESION.work_of_adhesion)?;
    let pull_off = contact.pull_off(&ADHESION)?;
    let mut adhesive = serde_json::Map::new();
    for asked in inputs.asked("A_with_adhesion_at_F") {
        let net = asked.parse::<f64>()? * unit;
        let pressure = contact.repulsive_pressure(&ADHESION, &pull_off, net)?;
        adhesive.insert(asked, json!(contact.area_fraction(pressure)?));
    }
    let mut hard = serde_json::Map::new();
    for asked in inputs.asked("A_without_adhesion_at_F") {
        let pressure = asked.parse::<f64>()? * unit;
        hard.insert(asked, json!(contact.area_fraction(pressure)?));
    }
    Ok(json!({
        "theta_FT": summits.adhesion_parameter()?,
        "mu_Rbar": tabor_map::tabor_parameter(summits.summit(), ADHESION.range)?,
        "pull_off_over_Ehp": pull_off.tension / unit,
        "pull_off_eps_over_w": pull_off.tension / tension,
        "x_rep_at_pull": pull_off.pressure / unit,
        "ubar_over_h_at_pull": contact.mean_gap(pull_off.pressure)? / RMS_HEIGHT,
        "A_at_pull": contact.area_fraction(pull_off.pressure)?,
        "gwm_pull_off_eps_over_w": gw_m::pull_off(&summits)? / tension,
        "A_with_adhesion_at_F": adhesive,
        "A_without_adhesion_at_F": hard,
    }))
}
