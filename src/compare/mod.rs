//! One rough surface through several models, with the seconds that each takes.
//!
//! [`compare`] computes contact area, mean gap, attraction and pull-off under the same loads by the
//! full field, the field without adhesion with the attraction added afterwards (DMT), interacting
//! asperities, Persson's theory, independent summits (GW-M) and the bearing-area model;
//! `docs/compare.md` describes each and its range.

mod asperities;
#[cfg(feature = "images")]
mod draw;
mod field;
mod load_scan;
mod retraction;
mod spectrum;
mod table;

pub use table::Row;

use std::path::Path;

use crate::backend::BackendError;
use crate::clock::Clock;
use crate::law::Law;
use crate::output::OutputError;
use crate::scene::{AdhesionScene, Boundary, Scene, SurfacePart, Treatment};
use crate::solver::MakeBackend;
use crate::study::Setup;
use crate::theory::TheoryError;
use crate::theory::tabor_map::FORCE_DMT_LIMIT;
use table::Table;

/// Results of a model at one net mean pressure; `None` if the model has no such quantity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct State {
    /// Mean pressure, Pa, negative in tension.
    pub mean_pressure: f64,
    /// Contact area over nominal area.
    pub contact_area_fraction: Option<f64>,
    /// Mean gap, m.
    pub mean_gap: Option<f64>,
    /// Mean tension of the attraction, Pa.
    pub adhesive_pressure: Option<f64>,
}

/// Results of a comparison.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Compared {
    /// The rows of `compare.csv`, model by model.
    pub rows: Vec<Row>,
    /// Models left out or ended early, with reasons.
    pub notes: Vec<String>,
}

/// Why a comparison is impossible.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CompareError {
    /// A scene outside the models: the part and the remedy.
    #[error("{0}")]
    Unsuited(String),
    /// A file that cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// A device that failed.
    #[error(transparent)]
    Backend(#[from] BackendError),
}

/// A scene with its surface, and the loads for the models.
struct Comparison {
    setup: Setup,
    /// Distinct net mean pressures, Pa, rising.
    loads: Vec<f64>,
    /// Work of adhesion over range of the law, Pa; 0 without adhesion.
    tension: f64,
    /// The same with the DMT treatment, whose law, without the automatic taper, is that of models that sum the attraction over
    /// a gap.
    treated: Setup,
}

impl Comparison {
    /// Net mean pressures that a model carries: above its pull-off and within its range.
    fn carried(&self, pull_off: f64) -> impl Iterator<Item = f64> {
        let loads = self.loads.iter().copied();
        loads.filter(move |load| *load > -pull_off)
    }

    /// Why the DMT force approach is out of its range here, if it is.
    fn beyond_dmt(&self) -> Option<&'static str> {
        let tabor = self.setup.regime?.tabor?;
        (tabor > FORCE_DMT_LIMIT).then_some("Tabor number above 0.237")
    }
}

/// Compares and writes `compare.csv`, row by row, and with the feature `images` `compare.png` into `folder`.
///
/// # Errors
/// A scene that does not suit ([`check_scene`]), a flat surface, files that cannot be written, a device
/// that fails. A model without results is not an error: a note gives the reason.
pub fn compare(
    mut setup: Setup,
    make_backend: MakeBackend,
    folder: &Path,
) -> Result<Compared, CompareError> {
    check_scene(&setup.scene)?;
    // The steps of the path itself are compared.
    setup.scene.loading.until_apart = false;
    if setup.statistics.moments.rms_slope() == 0.0 {
        return Err(CompareError::Unsuited(
            "the surface is flat: there is no roughness to compare models of".to_owned(),
        ));
    }
    let mut table = Table::create(folder)?;
    let mut notes = Vec::new();
    let mut comparison = Comparison {
        loads: Vec::new(),
        tension: match setup.law.range() {
            range if range > 0.0 => setup.law.work_of_adhesion() / range,
            _ => 0.0,
        },
        treated: treated(&setup),
        setup,
    };
    table.begin("full field");
    field::full(&mut comparison, make_backend, &mut table)?;
    if comparison.setup.law == Law::HardWall {
        notes.push("no [adhesion]: DMT is the full field itself".to_owned());
    } else {
        table.begin("DMT");
        field::dmt(&comparison, make_backend, &mut table)?;
    }
    let models: [(&'static str, Model); 4] = [
        ("ICHA", asperities::icha),
        ("Persson", spectrum::persson),
        ("GW-M", asperities::gw_m),
        ("BAM", spectrum::bam),
    ];
    for (name, model) in models {
        table.begin(name);
        let clock = Clock::start();
        match model(&comparison, &mut table) {
            Ok(()) => {}
            Err(Stopped::Out(reason)) => notes.push(format!("{name} is left out: {reason}")),
            Err(Stopped::End(reason)) => notes.push(format!("{name} ends here: {reason}")),
            Err(Stopped::Theory(error)) => notes.push(format!(
                "{name} ends here, after {:.1} s: {error}",
                clock.seconds()
            )),
            Err(Stopped::Output(error)) => return Err(error.into()),
        }
    }
    let (rows, more) = table.into_rows()?;
    notes.extend(more);
    #[cfg(feature = "images")]
    draw::figure(&comparison, &rows).write(&folder.join("compare.png"))?;
    Ok(Compared { rows, notes })
}

/// A scene with the DMT treatment. Its automatic taper is 0: no edge is solved for that it would free.
fn treated(setup: &Setup) -> Setup {
    let adhesion = setup.scene.adhesion.clone();
    let scene = Scene {
        adhesion: adhesion.map(|adhesion| AdhesionScene {
            treatment: Treatment::Dmt,
            ..adhesion
        }),
        ..setup.scene.clone()
    };
    Setup::new(scene, setup.surface.clone())
}

type Model = fn(&Comparison, &mut Table) -> Result<(), Stopped>;

/// Why a model has no further rows.
#[derive(Debug, thiserror::Error)]
enum Stopped {
    #[error("{0}")]
    Out(String),
    #[error("{0}")]
    End(String),
    #[error(transparent)]
    Theory(#[from] TheoryError),
    #[error(transparent)]
    Output(#[from] OutputError),
}

/// Refuses scenes outside the models.
///
/// # Errors
/// Spheres and cones, a free boundary, a spring, and solids or adhesion that only the full field
/// can model.
pub fn check_scene(scene: &Scene) -> Result<(), CompareError> {
    let mistake = |text: &str| Err(CompareError::Unsuited(text.to_owned()));
    for (index, part) in scene.surfaces.iter().enumerate() {
        let shape = match part {
            SurfacePart::Sphere { .. } => "sphere",
            SurfacePart::Cone { .. } => "cone",
            _ => continue,
        };
        return Err(CompareError::Unsuited(format!(
            "[[surface]] {} is a {shape}: the models of compare need a nominally flat rough surface with many summits; compare one {shape} with `tabor theory` (hertz, jkr, maugis-dugdale, dmt-f, ...)",
            index + 1
        )));
    }
    if scene.grid.boundary == Boundary::Free {
        return mistake(
            "[grid] boundary = \"free\" is one isolated contact: the models of compare assume an infinite nominal area; take boundary = \"periodic\"",
        );
    }
    if scene.loading.spring.is_some() {
        return mistake(
            "[loading] spring: compare prescribes the mean pressure of every model; leave the spring out",
        );
    }
    let mapped = scene.adhesion.as_ref().is_some_and(|law| law.map.is_some());
    let rated = scene
        .adhesion
        .as_ref()
        .is_some_and(|law| law.rate.is_some());
    for (named, what) in [
        (scene.solid.layer.is_some(), "[solid] thickness"),
        (scene.solid.hardness.is_some(), "[solid] hardness"),
        (!scene.solid.relaxation.is_empty(), "[[solid.relaxation]]"),
        (mapped, "[adhesion] map"),
        (rated, "[adhesion] rate"),
    ] {
        if named {
            return Err(CompareError::Unsuited(format!(
                "{what}: the models of compare assume an elastic half-space with uniform adhesion; leave it out"
            )));
        }
    }
    Ok(())
}
