//! `measured.toml`: a scene of the measured map itself, prepared as the call says.

use std::path::{Component, Path, PathBuf};

use serde_json::{Value, json};

use super::SurfaceArguments;
use crate::cli::Failure;
use crate::scene::{HeightFileScene, Scene, SurfacePart};
use crate::surface::Surface;

/// Name of the scene.
pub(super) const NAME: &str = "measured.toml";

/// Stand-ins for what the call does not set: contact modulus in Pa, work of adhesion in J/m^2.
const CONTACT_MODULUS: f64 = 1e9;
const WORK_OF_ADHESION: f64 = 0.05;
/// Mean pressure of the first step over modulus and rms slope: without adhesion the contact is then twice this share of
/// the nominal area.
const PRESSURE: f64 = 0.05;

/// The scene of a map that `part` reads, of this rms slope, in the folder `out`, with keys of the call: pressed to some
/// contact, then pulled until the surfaces separate.
pub(super) fn measured_scene(
    arguments: &SurfaceArguments,
    part: &HeightFileScene,
    surface: &Surface,
    slope: f64,
    out: &Path,
) -> Result<String, Failure> {
    let set = &arguments.set;
    let mut file = json!(SurfacePart::File(HeightFileScene {
        path: path_from(out, &part.path),
        ..part.clone()
    }));
    // A unit that the file states stands, and any other would be warned of.
    if let Some(file) = file
        .as_object_mut()
        .filter(|_| arguments.file.unit.is_none())
    {
        file.remove("unit");
    }
    let mut scene = json!({
        "grid": { "boundary": "periodic" },
        "surface": [file],
        "solid": { "contact_modulus": CONTACT_MODULUS },
        "adhesion": {
            "law": "maugis-dugdale",
            "work_of_adhesion": WORK_OF_ADHESION,
            "range": "auto",
        },
        "loading": { "control": "pressure", "path": [0.0], "until": "apart" },
        "output": { "images": ["pressure"] },
    });
    if let Some(size) = arguments.size {
        scene["grid"]["size"] = json!(size);
    }
    let is_set = |key: &str| {
        let holds = |name: &str| name == key || key.starts_with(&format!("{name}."));
        set.iter().any(|(name, _)| holds(name.trim()))
    };
    // What the call says in other keys takes the place of a stand-in.
    let third = if is_set("adhesion.range") {
        "work_of_adhesion"
    } else {
        "range"
    };
    for (key, table, stand_in) in [
        ("solid.young_modulus", "/solid", "contact_modulus"),
        ("adhesion.peak_tension", "/adhesion", third),
        ("capillary", "", "adhesion"),
    ] {
        let table = scene.pointer_mut(table).and_then(Value::as_object_mut);
        if let Some(table) = table.filter(|_| is_set(key)) {
            table.remove(stand_in);
        }
    }
    // Every mistake of the call with its key, and the modulus that the load follows.
    let read = Scene::parse(&text(&scene)?, NAME, out, set)?;
    let load = PRESSURE * read.solid.contact_modulus * slope;
    scene["loading"]["path"] = json!([two_digits(load), 0.0]);
    for (key, value) in set {
        put(&mut scene, key, parsed(value));
    }
    let stands_in =
        |(pointer, key): &(&str, &str)| scene.pointer(pointer).is_some() && !is_set(key);
    let stand_ins: Vec<&str> = [
        ("/solid/contact_modulus", "solid.contact_modulus"),
        ("/adhesion/work_of_adhesion", "adhesion.work_of_adhesion"),
    ]
    .into_iter()
    .filter(stands_in)
    .map(|(_, key)| key)
    .collect();
    let mut head = format!(
        "# The measured map {}, {} x {} points, on a periodic cell: pressed, then pulled until the surfaces separate.\n",
        one_line(&part.path),
        surface.grid.nx,
        surface.grid.ny,
    );
    if !stand_ins.is_empty() {
        head += &format!(
            "# Stand-ins: {}. Put yours in their place, here or with --set.\n",
            stand_ins.join(", ")
        );
    }
    Ok(head + &text(&scene)?)
}

/// A scene as TOML.
fn text(scene: &Value) -> Result<String, Failure> {
    toml::to_string(scene)
        .map_err(|error| Failure::Usage(format!("the scene of the map cannot be written: {error}")))
}

/// A value as `--set` takes it: TOML, or else a bare word.
fn parsed(text: &str) -> Value {
    let table = format!("value = {text}").parse::<toml::Table>().ok();
    let value = table.and_then(|mut table| table.remove("value"));
    let value = value.and_then(|value| serde_json::to_value(value).ok());
    value.unwrap_or_else(|| json!(text))
}

/// Puts a value under a key such as `surface.0.detrend`, which the reader of scenes has accepted.
fn put(scene: &mut Value, key: &str, value: Value) {
    let mut at = scene;
    for name in key.split('.').map(str::trim) {
        at = match name.parse::<usize>() {
            Ok(index) if at.is_array() => &mut at[index],
            _ => &mut at[name],
        };
    }
    *at = value;
}

/// The path of a file for a scene in the folder `out`.
fn path_from(out: &Path, file: &Path) -> PathBuf {
    let inside = |path: &Path| {
        let mut parts = path.components();
        parts.all(|part| matches!(part, Component::Normal(_) | Component::CurDir))
    };
    if !inside(out) || file.is_absolute() {
        return std::path::absolute(file).unwrap_or_else(|_| file.to_owned());
    }
    let steps = out
        .components()
        .filter(|part| matches!(part, Component::Normal(_)));
    let up: PathBuf = steps.map(|_| "..").collect();
    up.join(file)
}

/// A name for a comment.
fn one_line(path: &Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str());
    let visible = |c: char| if c.is_control() { ' ' } else { c };
    name.to_string_lossy().chars().map(visible).collect()
}

/// The nearest number of two digits.
fn two_digits(value: f64) -> f64 {
    // The digits of a finite number are a number.
    format!("{value:.1e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_in_a_folder_finds_the_file_again() {
        let path = |out: &str, file: &str| path_from(Path::new(out), Path::new(file));
        assert_eq!(path("out", "map.npy"), Path::new("../map.npy"));
        assert_eq!(path("./a/b", "maps/x.spm"), Path::new("../../maps/x.spm"));
        assert!(path("../out", "map.npy").is_absolute());
        assert_eq!(path("out", "/maps/x.spm"), Path::new("/maps/x.spm"));
    }

    #[test]
    fn values_are_put_under_their_keys() {
        let mut scene = json!({ "surface": [{ "kind": "file" }], "solid": {} });
        put(&mut scene, "surface.0.scale", parsed("2.5"));
        put(&mut scene, "solid.contact_modulus", parsed("2 GPa"));
        put(&mut scene, "capillary", parsed("{ humidity = 0.5 }"));
        assert_eq!(scene["surface"][0]["scale"], 2.5);
        assert_eq!(scene["solid"]["contact_modulus"], "2 GPa");
        assert_eq!(scene["capillary"]["humidity"], 0.5);
    }
}
