//! A scene that was put together in Rust, checked by the rules of scene files.
//!
//! Its resolved form is the tree that a file would give, so it goes through the same readers: there is no
//! second list of what may stand with what.

use std::path::Path;

use serde_json::{Value as Json, json};

use super::document::{Entry, Location, Node, Table, Value};
use super::mistake::SceneErrors;
use super::reader::Log;
use super::{AdhesionMap, Control, LoadingScene, Scene, SurfacePart, read_tables};

/// What mistakes call a scene that no file holds.
const NAME: &str = "scene";

/// A ramp of a loading path: to a value or held, over some time, in some steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ramp {
    to: Option<f64>,
    duration: Option<f64>,
    steps: Option<usize>,
}

impl Ramp {
    /// A ramp to a value, in the unit of the control, in equal steps.
    pub fn to(value: f64, steps: usize) -> Self {
        Ramp {
            to: Some(value),
            duration: None,
            steps: Some(steps),
        }
    }

    /// A load held for some time, s, in equal steps.
    pub fn hold(duration: f64, steps: usize) -> Self {
        Ramp {
            to: None,
            duration: Some(duration),
            steps: Some(steps),
        }
    }

    /// Sets how long the ramp takes, s.
    pub fn during(self, duration: f64) -> Self {
        Ramp {
            duration: Some(duration),
            ..self
        }
    }

    /// Leaves the steps to the time tolerance of the path, on a viscoelastic solid: short after each kink,
    /// longer after.
    pub fn auto_steps(self) -> Self {
        Ramp {
            steps: None,
            ..self
        }
    }

    fn table(&self) -> Json {
        let steps = self.steps.map_or(json!("auto"), |steps| json!(steps));
        let mut table = json!({ "steps": steps });
        if let Some(value) = self.to {
            table["to"] = json!(value);
        }
        if let Some(duration) = self.duration {
            table[if self.to.is_some() {
                "duration"
            } else {
                "hold"
            }] = json!(duration);
        }
        table
    }
}

impl Scene {
    /// Checks a scene that was put together or changed in Rust by the rules of scene files.
    ///
    /// # Errors
    /// Every mistake, with its key. The surface itself is checked where it is built.
    pub fn check(&self) -> Result<(), SceneErrors> {
        self.checked_as(self.tree()).map(drop)
    }

    /// The loading path of ramps from a value (in the unit of the control), checked with the rest of the
    /// scene. `time_tolerance` is the error in time of ramps that [find their steps](Ramp::auto_steps), 1e-3
    /// by default.
    ///
    /// # Errors
    /// As [`Scene::check`].
    pub(crate) fn loading_of_ramps(
        &self,
        control: Control,
        start: f64,
        ramps: &[Ramp],
        time_tolerance: Option<f64>,
    ) -> Result<LoadingScene, SceneErrors> {
        let mut tree = self.tree();
        let loading = &mut tree["loading"];
        loading["control"] = json!(control.name());
        loading["start"] = json!(start);
        loading["ramp"] = Json::Array(ramps.iter().map(Ramp::table).collect());
        if let Some(tolerance) = time_tolerance {
            loading["time_tolerance"] = json!(tolerance);
        }
        if let Some(table) = loading.as_object_mut() {
            table.remove("path");
            if !control.is_load() && !table.contains_key("spring") {
                table.remove("pull_off_tolerance");
            }
        }
        Ok(self.checked_as(tree)?.loading)
    }

    /// The tree that a file of this scene would give; arrays, which no file holds, are checked where the
    /// surface is built.
    fn tree(&self) -> Json {
        let mut tree = self.resolved_json();
        for (table, part) in tree["surface"]
            .as_array_mut()
            .into_iter()
            .flatten()
            .zip(&self.surfaces)
        {
            if matches!(part, SurfacePart::Heights(_)) {
                *table = json!({ "kind": "flat" });
            }
        }
        // A single load with a time, of which ramps know only from the second on: it stands for a hold.
        if let ([value], Some(_)) = (&self.loading.path[..], &self.loading.durations) {
            tree["loading"]["ramp"] = json!([{ "to": value, "steps": 1, "duration": 1.0 }]);
        }
        let is_array =
            |adhesion: &super::AdhesionScene| matches!(adhesion.map, Some(AdhesionMap::Factors(_)));
        if self.adhesion.as_ref().is_some_and(is_array)
            && let Some(adhesion) = tree["adhesion"].as_object_mut()
        {
            adhesion.remove("map");
        }
        tree
    }

    fn checked_as(&self, tree: Json) -> Result<Scene, SceneErrors> {
        let log = Log::new(NAME);
        let root = match node(tree).value {
            Value::Table(root) => root,
            _ => Table::default(),
        };
        match read_tables(&root, Path::new(""), &log) {
            Some(scene) if log.is_empty() => Ok(scene),
            _ => Err(log.into_errors()),
        }
    }
}

/// JSON as a tree of a scene, nowhere in a file.
fn node(json: Json) -> Node {
    let value = match json {
        // JSON has no NaN and no infinity.
        Json::Null => Value::Float(f64::NAN),
        Json::Bool(truth) => Value::Boolean(truth),
        Json::String(text) => Value::Text(text),
        Json::Array(list) => Value::List(list.into_iter().map(node).collect()),
        Json::Object(table) => Value::Table(Table {
            entries: table
                .into_iter()
                .map(|(name, value)| Entry {
                    name,
                    place: Location::Nowhere,
                    node: node(value),
                })
                .collect(),
        }),
        Json::Number(number) => match (number.as_i64(), number.is_u64()) {
            (Some(whole), _) => Value::Integer(whole),
            // Beyond what a scene file can say, and within what a count may be.
            (None, true) => Value::Integer(i64::MAX),
            (None, false) => Value::Float(number.as_f64().unwrap_or(f64::NAN)),
        },
    };
    Node {
        value,
        place: Location::Nowhere,
    }
}
