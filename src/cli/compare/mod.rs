//! `tabor compare`: one rough surface through several models.

mod asperities;
mod draw;
mod field;
mod ladder;
mod spectrum;
mod table;

use std::path::PathBuf;
use std::time::Instant;

use super::machine::Machine;
use super::{CompareArguments, Failure, read_scene};
use crate::law::Law;
use crate::scene::{Boundary, Scene, SurfacePart};
use crate::study::Setup;
use crate::surface::Surface;
use crate::theory::TheoryError;
use crate::theory::tabor_map::FORCE_DMT_LIMIT;
use table::Table;

/// What a model says at one net mean pressure; `None` where it has no such quantity. SI.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct State {
    mean_pressure: f64,
    contact_area_fraction: Option<f64>,
    mean_gap: Option<f64>,
    adhesive_pressure: Option<f64>,
}

/// A scene and its surface, and the loads that models are asked.
struct Comparison {
    setup: Setup,
    /// Distinct net mean pressures, Pa, rising.
    loads: Vec<f64>,
    /// Work of adhesion over range of the law, Pa; 0 without adhesion.
    tension: f64,
}

impl Comparison {
    /// Net mean pressures of a model between its pull-off and its reach.
    fn carried(&self, pull_off: f64) -> impl Iterator<Item = f64> {
        let loads = self.loads.iter().copied();
        loads.filter(move |load| *load > -pull_off)
    }

    /// Why the force approach of DMT is out of its range here, if it is.
    fn beyond_dmt(&self) -> Option<&'static str> {
        let tabor = self.setup.regime?.tabor;
        (tabor > FORCE_DMT_LIMIT).then_some("Tabor number above 0.237")
    }
}

/// Compares and writes `compare.csv` and `compare.png`.
pub(super) fn compare(arguments: &CompareArguments) -> Result<(), Failure> {
    let scene = read_scene(&arguments.scene, &arguments.set)?;
    refuse(&scene)?;
    let surface = Surface::build(&scene).map_err(|error| Failure::Surface {
        path: arguments.scene.clone(),
        error,
    })?;
    let setup = Setup::new(scene, surface);
    if setup.statistics.moments.rms_slope() == 0.0 {
        return Err(Failure::Usage(
            "the surface is flat: there is no roughness to compare models of".to_owned(),
        ));
    }
    for warning in &setup.warnings {
        eprintln!("warning: {warning}");
    }
    let machine = Machine::of(&setup)?;
    if let Some(remark) = &machine.remark {
        eprintln!("note: {remark}");
    }
    let folder = match &arguments.out {
        Some(folder) => folder.clone(),
        None => {
            let stem = arguments.scene.file_stem().unwrap_or_default();
            PathBuf::from(format!("{}_compare", stem.to_string_lossy()))
        }
    };
    let mut table = Table::create(&folder)?;
    let mut comparison = Comparison {
        loads: Vec::new(),
        tension: match setup.law.range() {
            range if range > 0.0 => setup.law.work_of_adhesion() / range,
            _ => 0.0,
        },
        setup,
    };
    table.begin("full field");
    field::full(&mut comparison, &machine, &mut table)?;
    if comparison.setup.law == Law::HardWall {
        eprintln!("note: no [adhesion]: DMT is the full field itself, and BAM has no law");
    } else {
        table.begin("DMT");
        field::dmt(&comparison, &machine, &mut table)?;
    }
    let models: [(&'static str, Model); 4] = [
        ("ICHA", asperities::icha),
        ("Persson", spectrum::persson),
        ("GW-M", asperities::gw_m),
        ("BAM", spectrum::bam),
    ];
    for (name, model) in models {
        table.begin(name);
        let clock = Instant::now();
        match model(&comparison, &mut table) {
            Ok(()) => {}
            Err(Left::Out(reason)) => eprintln!("note: {name} is left out: {reason}"),
            Err(Left::Theory(error)) => eprintln!(
                "note: {name} ends here, after {:.1} s: {error}",
                clock.elapsed().as_secs_f64()
            ),
            Err(Left::Output(error)) => return Err(error.into()),
        }
    }
    table.print();
    draw::figure(&comparison, table.rows())
        .write(&folder.join("compare.png"))
        .map_err(Failure::from)
}

type Model = fn(&Comparison, &mut Table) -> Result<(), Left>;

/// Why a model has no more rows.
#[derive(Debug, thiserror::Error)]
enum Left {
    #[error("{0}")]
    Out(String),
    #[error(transparent)]
    Theory(#[from] TheoryError),
    #[error(transparent)]
    Output(#[from] crate::output::OutputError),
}

/// Refuses scenes of which the models say nothing.
fn refuse(scene: &Scene) -> Result<(), Failure> {
    let mistake = |text: &str| Err(Failure::Usage(text.to_owned()));
    for (index, part) in scene.surfaces.iter().enumerate() {
        let shape = match part {
            SurfacePart::Sphere { .. } => "sphere",
            SurfacePart::Cone { .. } => "cone",
            _ => continue,
        };
        return Err(Failure::Usage(format!(
            "[[surface]] {} is a {shape}: compare is of nominally flat rough surfaces, whose models ask for the statistics of many summits; one {shape} is compared with `tabor theory` (hertz, jkr, maugis-dugdale, dmt-f, ...)",
            index + 1
        )));
    }
    if scene.grid.boundary == Boundary::Free {
        return mistake(
            "[grid] boundary = \"free\" is one isolated contact: the models of compare are of a nominal area without end; take boundary = \"periodic\"",
        );
    }
    if scene.loading.spring.is_some() {
        return mistake(
            "[loading] spring: compare asks each model for its state under a mean pressure; leave the spring out",
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
            return Err(Failure::Usage(format!(
                "{what}: the models of compare know an elastic half-space of one adhesion; leave it out"
            )));
        }
    }
    Ok(())
}
