//! The resolved scene for `summary.json`: the keys of a scene file with SI values.

use std::path::Path;

use serde::{Serialize, Serializer};
use serde_json::{Map, Value, json};

use super::loading::APART;
use super::words::Word;
use super::*;

impl Scene {
    /// The resolved scene: every default filled in, every value in SI units (angles in degrees, as
    /// in a scene).
    ///
    /// Keys are those of the scene file, so that it can be written as TOML and read again; the
    /// result is the same scene except for the last bit of an angle given in rad. Absent effects
    /// and automatic choices (such as a centre) are absent; invalid bytes of a path that is not
    /// UTF-8 are replaced. Arrays of heights and factors, which a file cannot hold, are given by
    /// their points and checksum.
    pub fn resolved_json(&self) -> Value {
        let adhesion = self.adhesion.as_ref().filter(|_| self.capillary.is_none());
        let mut scene = Map::new();
        let mut add = |key: &str, table: Option<Value>| {
            if let Some(table) = table {
                scene.insert(key.into(), table);
            }
        };
        add("title", self.title.as_ref().map(|title| json!(title)));
        add("grid", Some(json!(self.grid)));
        add("solid", Some(self.solid.resolved()));
        add("surface", Some(json!(self.surfaces)));
        add(
            "capillary",
            self.capillary.as_ref().map(|liquid| json!(liquid)),
        );
        add("adhesion", adhesion.map(AdhesionScene::resolved));
        for (name, table) in self.tables.resolved() {
            add(name, Some(table));
        }
        add("loading", Some(self.loading.resolved()));
        add("solver", Some(json!(self.solver)));
        add("output", Some(json!(self.output)));
        Value::Object(scene)
    }

    /// What identifies a scene wherever it is read from: as resolved, with the names of files in place of their paths, which
    /// depend on the folder of the call. What the files hold is to be compared beside it.
    pub(crate) fn identity(&self) -> Value {
        let mut scene = self.resolved_json();
        let name_alone = |value: &mut Value| {
            let name = value.as_str().map(Path::new).and_then(Path::file_name);
            if let Some(name) = name.map(|name| name.to_string_lossy().into_owned()) {
                *value = name.into();
            }
        };
        if let Some(map) = scene.pointer_mut("/adhesion/map") {
            name_alone(map);
        }
        for part in scene["surface"].as_array_mut().into_iter().flatten() {
            if let Some(path) = part.get_mut("path") {
                name_alone(path);
            }
        }
        scene
    }
}

/// Adds a key if it has a value.
fn with(mut table: Value, key: &str, value: Option<impl Serialize>) -> Value {
    if let Some(value) = value {
        table[key] = json!(value);
    }
    table
}

/// A choice by its word.
pub(super) fn word<S: Serializer>(value: &impl Word, to: S) -> Result<S::Ok, S::Error> {
    to.serialize_str(value.word())
}

/// A path; bytes that are not UTF-8 are replaced.
pub(super) fn path<S: Serializer>(path: &Path, to: S) -> Result<S::Ok, S::Error> {
    to.serialize_str(&path.to_string_lossy())
}

/// Wavelengths: JSON has no infinity, so the scene's word is used.
pub(super) fn wavelengths<S: Serializer>(lengths: &[f64; 2], to: S) -> Result<S::Ok, S::Error> {
    let lengths = lengths.map(|length| {
        if length.is_infinite() {
            json!("inf")
        } else {
            json!(length)
        }
    });
    lengths.serialize(to)
}

/// An angle in degrees; the round number if the conversion gives the same radians.
pub(super) fn degrees<S: Serializer>(radians: &f64, to: S) -> Result<S::Ok, S::Error> {
    let degrees = radians.to_degrees();
    let round = (degrees * 1e9).round() / 1e9;
    let stays = round.to_radians() == *radians;
    to.serialize_f64(if stays { round } else { degrees })
}

impl SolidScene {
    fn resolved(&self) -> Value {
        let table = json!({ "contact_modulus": self.contact_modulus });
        let table = with(table, "poisson_ratio", self.poisson_ratio);
        let table = with(table, "thickness", self.layer.map(|layer| layer.thickness));
        let table = with(table, "base", self.layer.map(|layer| layer.base.name()));
        let table = with(table, "hardness", self.hardness);
        let branches = Some(&self.relaxation).filter(|branches| !branches.is_empty());
        with(table, "relaxation", branches)
    }
}

impl SurfacePart {
    /// The word after `kind =` in a scene.
    pub fn kind(&self) -> &'static str {
        match self {
            SurfacePart::SelfAffine(_) => "self-affine",
            SurfacePart::Sphere { .. } => "sphere",
            SurfacePart::Cone { .. } => "cone",
            SurfacePart::Wavy { .. } => "wavy",
            SurfacePart::Flat => "flat",
            SurfacePart::File(_) => "file",
            SurfacePart::Heights(_) => "array",
        }
    }
}

impl AdhesionScene {
    fn resolved(&self) -> Value {
        let table = json!({
            "law": self.law,
            "work_of_adhesion": self.work_of_adhesion,
            "range": self.range,
        });
        let taper = self.taper.map_or(Range::Auto, Range::Length);
        let has_taper = self.law == LawName::MaugisDugdale;
        let table = with(table, "taper", has_taper.then_some(taper));
        let table = with(table, "treatment", Some(self.treatment));
        let table = with(table, "map", self.map.as_ref());
        with(table, "rate", self.rate)
    }
}

impl LoadingScene {
    fn resolved(&self) -> Value {
        let control = self.control.name();
        let table = match &self.durations {
            None => json!({ "control": control, "path": self.path }),
            // One ramp a step reproduces the times to the last bit.
            Some(durations) => {
                let ramps: Vec<Value> = self
                    .path
                    .iter()
                    .zip(durations)
                    .skip(1)
                    .map(|(to, duration)| json!({ "to": to, "steps": 1, "duration": duration }))
                    .collect();
                json!({ "control": control, "start": self.path.first(), "ramp": ramps })
            }
        };
        let table = with(table, "spring", self.spring);
        let table = with(table, "until", self.until_apart.then_some(APART));
        let is_searched = self.control.is_load() || self.spring.is_some();
        with(
            table,
            "pull_off_tolerance",
            is_searched.then_some(self.pull_off_tolerance),
        )
    }
}
