//! The scene on the report: a table, and the equivalent scene file.

use maud::{Markup, html};
use serde_json::{Value, json};

use super::facts;
use crate::scene::{Conduction, Control, EffectTables};
use crate::study::Setup;
use crate::units::format_si;

/// Most values of a list that are shown in full.
const SHOWN_VALUES: usize = 16;
/// Longest scene file that is put on a page, bytes.
const LONGEST_FILE: usize = 200_000;

/// The scene as a table of its keys, and as a file.
pub(super) fn html(setup: &Setup) -> Markup {
    let scene = setup.scene.resolved_json();
    let mut shown = scene.clone();
    if let Some(grid) = shown.get_mut("grid").and_then(Value::as_object_mut) {
        // Of a height file whose scene gives none.
        let [lx, ly] = [setup.surface.grid.lx, setup.surface.grid.ly];
        grid.entry("size").or_insert(json!([lx, ly]));
    }
    if let (Some(durations), Some(loading)) = (
        &setup.scene.loading.durations,
        shown.get_mut("loading").and_then(Value::as_object_mut),
    ) {
        // The resolved scene has one ramp a step; the report shows the path and the duration of its
        // steps instead.
        loading.remove("start");
        loading.remove("ramp");
        loading.insert("path".into(), json!(setup.scene.loading.path));
        loading.insert("durations".into(), json!(durations));
    }
    if let Some(bodies) = setup.scene.tables.conductance
        && bodies.kind == Conduction::Electrical
        && let Some(table) = shown["conductance"].as_object_mut()
    {
        for value in table.values_mut() {
            if let Some(number) = value.as_f64() {
                *value = json!(format_si(number, "S/m"));
            }
        }
    }
    for (key, length) in [("range", setup.law.range()), ("taper", setup.law.taper())] {
        match shown.pointer_mut(&format!("/adhesion/{key}")) {
            Some(value) if value == "auto" => {
                *value = json!(format!("auto, {}", format_si(length, "m")));
            }
            _ => {}
        }
    }
    let path_unit = match setup.scene.loading.control {
        Control::Pressure => "Pa",
        Control::Force => "N",
        Control::Approach | Control::MeanGap => "m",
    };
    let mut rows = Vec::new();
    if let Value::Object(tables) = &shown {
        for (name, table) in tables {
            // The solver has its own table, and the title its own line.
            if name != "title" && name != "solver" {
                add_rows(&mut rows, name, table, path_unit);
            }
        }
    }
    let file = toml::to_string(&scene).ok();
    let file = file.filter(|file| file.len() <= LONGEST_FILE);
    html! {
        (facts(&rows))
        @if let Some(file) = file {
            details {
                summary { "As a scene file, defaults filled in, SI units" }
                pre { (file) }
            }
        }
    }
}

/// Adds a line for each value below `key`.
fn add_rows(rows: &mut Vec<(String, String)>, key: &str, value: &Value, path_unit: &str) {
    match value {
        Value::Object(table) => {
            for (name, value) in table {
                add_rows(rows, &format!("{key} {name}"), value, path_unit);
            }
        }
        Value::Array(values) if values.iter().any(Value::is_object) => {
            for (index, value) in values.iter().enumerate() {
                let key = match values.len() {
                    1 => key.to_owned(),
                    _ => format!("{key} {}", index + 1),
                };
                add_rows(rows, &key, value, path_unit);
            }
        }
        value => {
            let leaf = key.rsplit(' ').next().unwrap_or(key);
            rows.push((key.to_owned(), words(leaf, value, path_unit)));
        }
    }
}

/// A value for people to read.
fn words(key: &str, value: &Value, path_unit: &str) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Number(number) => match (number.as_f64(), unit(key, path_unit)) {
            (Some(angle), Some("°")) => format!("{angle}°"),
            (Some(value), Some(unit)) => format_si(value, unit),
            _ => number.to_string(),
        },
        Value::Array(values) => {
            let shown = |values: &[Value]| -> Vec<String> {
                values.iter().map(|v| words(key, v, path_unit)).collect()
            };
            match values.len() {
                0 => "none".to_owned(),
                2 if matches!(key, "points" | "size" | "wavelength") => shown(values).join(" × "),
                count if count > SHOWN_VALUES => format!(
                    "{count} values: {}, ..., {}",
                    shown(&values[..4]).join(", "),
                    shown(&values[count - 1..]).join("")
                ),
                _ => shown(values).join(", "),
            }
        }
        other => other.to_string(),
    }
}

/// The SI unit of a key; `None` for pure numbers and unknown keys.
fn unit<'u>(key: &str, path_unit: &'u str) -> Option<&'u str> {
    Some(match key {
        "size" | "radius" | "centre" | "amplitude" | "wavelength" | "rms_height" | "longest"
        | "rolloff" | "shortest" | "range" | "taper" | "thickness" | "period" | "black"
        | "white" => "m",
        "contact_modulus" | "peak_tension" | "hardness" | "modulus" => "Pa",
        "work_of_adhesion" => "J/m^2",
        "surface_tension" | "spring" => "N/m",
        "molar_volume" => "m^3/mol",
        "time" | "hold" | "duration" | "durations" => "s",
        "temperature" => "K",
        "reference_speed" => "m/s",
        "half_angle" | "contact_angle" => "°",
        "path" => path_unit,
        _ => return EffectTables::unit(key),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_written_as_people_do() {
        let cases = [
            ("size", json!([25e-6, 12.5e-6]), "25 µm × 12.5 µm"),
            ("points", json!([512, 256]), "512 × 256"),
            ("wavelength", json!([1e-6, "inf"]), "1 µm × inf"),
            ("contact_modulus", json!(1.33e12), "1.33 TPa"),
            ("path", json!([1e-9, -2e-9]), "1 nm, -2 nm"),
            ("hurst", json!(0.8), "0.8"),
            ("images", json!([]), "none"),
            ("half_angle", json!(70.5), "70.5°"),
        ];
        for (key, value, text) in cases {
            assert_eq!(words(key, &value, "m"), text);
        }
        let long: Vec<f64> = (0..40).map(f64::from).collect();
        assert_eq!(
            words("path", &json!(long), "N"),
            "40 values: 0 N, 1 N, 2 N, 3 N, ..., 39 N"
        );
    }
}
