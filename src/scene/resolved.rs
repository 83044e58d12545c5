//! The resolved scene for `summary.json`: the keys of a scene file with SI values.

use serde_json::{Map, Value, json};

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
        let mut scene = Map::new();
        if let Some(title) = &self.title {
            scene.insert("title".into(), json!(title));
        }
        scene.insert("grid".into(), self.grid.resolved());
        scene.insert("solid".into(), self.solid.resolved());
        let surfaces: Vec<Value> = self.surfaces.iter().map(SurfacePart::resolved).collect();
        scene.insert("surface".into(), json!(surfaces));
        if let Some(capillary) = &self.capillary {
            scene.insert("capillary".into(), capillary.resolved());
        } else if let Some(adhesion) = &self.adhesion {
            scene.insert("adhesion".into(), adhesion.resolved());
        }
        for (name, table) in self.tables.resolved() {
            scene.insert(name.into(), table);
        }
        scene.insert("loading".into(), self.loading.resolved());
        scene.insert("solver".into(), self.solver.resolved());
        scene.insert("output".into(), self.output.resolved());
        Value::Object(scene)
    }
}

/// Identifies an array; no file holds it.
fn array(values: &GridValues) -> Value {
    json!({ "points": values.points(), "checksum": values.checksum() })
}

/// Adds a key if it has a value.
fn with(mut table: Value, key: &str, value: Option<Value>) -> Value {
    if let (Some(table), Some(value)) = (table.as_object_mut(), value) {
        table.insert(key.into(), value);
    }
    table
}

impl GridScene {
    fn resolved(&self) -> Value {
        let table = json!({ "boundary": self.boundary.name() });
        let table = with(table, "points", self.points.map(|points| json!(points)));
        with(table, "size", self.size.map(|size| json!(size)))
    }
}

impl SolidScene {
    fn resolved(&self) -> Value {
        let table = json!({ "contact_modulus": self.contact_modulus });
        let table = with(
            table,
            "poisson_ratio",
            self.poisson_ratio.map(|ratio| json!(ratio)),
        );
        let thickness = self.layer.map(|layer| json!(layer.thickness));
        let table = with(table, "thickness", thickness);
        let base = self.layer.map(|layer| json!(layer.base.name()));
        let table = with(table, "base", base);
        let table = with(
            table,
            "hardness",
            self.hardness.map(|hardness| json!(hardness)),
        );
        let branches: Vec<Value> = self
            .relaxation
            .iter()
            .map(|branch| json!({ "modulus": branch.modulus, "time": branch.time }))
            .collect();
        let relaxation = (!branches.is_empty()).then(|| json!(branches));
        with(table, "relaxation", relaxation)
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

    fn resolved(&self) -> Value {
        let kind = self.kind();
        match self {
            SurfacePart::SelfAffine(part) => {
                let table = json!({ "kind": kind, "hurst": part.hurst });
                let table = match part.roughness {
                    Roughness::RmsHeight(height) => with(table, "rms_height", Some(json!(height))),
                    Roughness::RmsSlope(slope) => with(table, "rms_slope", Some(json!(slope))),
                };
                let table = with(table, "longest", Some(json!(part.longest)));
                let table = with(table, "rolloff", Some(json!(part.rolloff)));
                let table = with(table, "shortest", Some(json!(part.shortest)));
                with(table, "seed", Some(json!(part.seed)))
            }
            SurfacePart::Sphere { radius, centre } => {
                let table = json!({ "kind": kind, "radius": radius });
                with(table, "centre", centre.map(|centre| json!(centre)))
            }
            SurfacePart::Cone { half_angle, centre } => {
                let table = json!({ "kind": kind, "half_angle": degrees(*half_angle) });
                with(table, "centre", centre.map(|centre| json!(centre)))
            }
            SurfacePart::Wavy {
                amplitude,
                wavelength,
            } => {
                // JSON has no infinity, so the scene's word is used.
                let wavelength = wavelength.map(|length| {
                    if length.is_infinite() {
                        json!("inf")
                    } else {
                        json!(length)
                    }
                });
                json!({ "kind": kind, "amplitude": amplitude, "wavelength": wavelength })
            }
            SurfacePart::Flat => json!({ "kind": kind }),
            SurfacePart::Heights(heights) => with(array(heights), "kind", Some(json!(kind))),
            SurfacePart::File(part) => {
                let table = json!({
                    "kind": kind,
                    "path": part.path.to_string_lossy(),
                    "unit": part.unit,
                    "scale": part.scale,
                    "detrend": part.detrend.name(),
                    "fill": part.fill.name(),
                });
                let table = with(table, "black", part.black.map(|height| json!(height)));
                with(table, "white", part.white.map(|height| json!(height)))
            }
        }
    }
}

/// An angle in degrees; the round number if the conversion gives the same radians.
fn degrees(radians: f64) -> f64 {
    let degrees = radians.to_degrees();
    let round = (degrees * 1e9).round() / 1e9;
    if round.to_radians() == radians {
        round
    } else {
        degrees
    }
}

impl AdhesionScene {
    fn resolved(&self) -> Value {
        let range = match self.range {
            Range::Length(length) => json!(length),
            Range::Auto => json!("auto"),
        };
        let table = json!({
            "law": self.law.name(),
            "work_of_adhesion": self.work_of_adhesion,
            "range": range,
        });
        let taper = match self.taper {
            Some(length) => json!(length),
            None => json!("auto"),
        };
        let has_taper = self.law == LawName::MaugisDugdale;
        let table = with(table, "taper", has_taper.then_some(taper));
        let table = with(table, "treatment", Some(json!(self.treatment.name())));
        let map = self.map.as_ref().map(|map| match map {
            AdhesionMap::File(path) => json!(path.to_string_lossy()),
            AdhesionMap::Factors(factors) => array(factors),
            AdhesionMap::Pattern {
                kind,
                period,
                low,
                high,
            } => json!({ "pattern": kind.name(), "period": period, "low": low, "high": high }),
        });
        let table = with(table, "map", map);
        let rate = self.rate.map(
            |rate| json!({ "reference_speed": rate.reference_speed, "exponent": rate.exponent }),
        );
        with(table, "rate", rate)
    }
}

impl CapillaryScene {
    fn resolved(&self) -> Value {
        json!({
            "humidity": self.humidity,
            "surface_tension": self.surface_tension,
            "molar_volume": self.molar_volume,
            "temperature": self.temperature,
            "contact_angle": degrees(self.contact_angle),
        })
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
        let table = with(
            table,
            "spring",
            self.spring.map(|stiffness| json!(stiffness)),
        );
        let is_load = matches!(self.control, Control::Pressure | Control::Force);
        let tolerance = is_load.then(|| json!(self.pull_off_tolerance));
        with(table, "pull_off_tolerance", tolerance)
    }
}

impl SolverScene {
    fn resolved(&self) -> Value {
        json!({
            "tolerance": self.tolerance,
            "max_iterations": self.max_iterations,
            "precision": self.precision.name(),
            "backend": self.backend.name(),
        })
    }
}

impl OutputScene {
    fn resolved(&self) -> Value {
        let names = |fields: &[FieldName]| -> Vec<&'static str> {
            fields.iter().map(|field| field.name()).collect()
        };
        let steps = match &self.steps {
            StepChoice::Last => json!("last"),
            StepChoice::All => json!("all"),
            StepChoice::List(steps) => json!(steps),
        };
        json!({
            "images": names(&self.images),
            "fields": names(&self.fields),
            "steps": steps,
        })
    }
}
