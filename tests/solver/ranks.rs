//! A contact over several ranks, each with a slab of its rows: the results are those of one process in every bit. Ranks
//! are threads here; over MPI they exchange the same bytes.

use std::fs;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;
use std::thread;

use tabor::backend::cpu::{self, with_threads};
use tabor::backend::ranks::{Ranks, ThreadRanks};
use tabor::backend::{Backend, BackendError};
use tabor::effect::Effect;
use tabor::kernel::Scalars;
use tabor::run::{run_on_ranks, run_with};
use tabor::scene::Scene;
use tabor::solver::{ContactSolver, Hold, Load, Start};
use tabor::study::{FinishedStep, Observer, Setup, StepRow, WalkEnd, WalkError, walk};
use tabor::surface::Surface;
use tabor::{Device, RunEnd, RunError, RunObserver, RunOptions, RunStatus};

use crate::shared::trials::{is_long, tests};

const ROUGH: &str = "[[surface]]\nkind = \"self-affine\"\nhurst = 0.8\nrms_slope = 0.1\nlongest = \"2 um\"\nrolloff = \"1 um\"\nshortest = \"0.25 um\"\n";
const SPHERE: &str = "[[surface]]\nkind = \"sphere\"\nradius = \"5 um\"\n";

/// Grids of one number to a point whose rows are whole blocks, that are halved thrice, once and never, and whose rows
/// are a prime.
const GRIDS: [[usize; 2]; 4] = [[64, 64], [40, 24], [36, 100], [61, 47]];

fn scene(grid: [usize; 2], boundary: &str, below: &str, surface: &str) -> Scene {
    let [nx, ny] = grid;
    let height = 2.0 * ny as f64 / nx as f64;
    let text = format!(
        "[grid]\npoints = [{nx}, {ny}]\nsize = [\"2 um\", \"{height} um\"]\nboundary = \"{boundary}\"\n[solid]\ncontact_modulus = \"50 MPa\"\n{surface}{below}\n"
    );
    Scene::parse(&text, "scene.toml", Path::new("."), &[]).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn adhesion(law: &str) -> String {
    format!("[adhesion]\nlaw = \"{law}\"\nwork_of_adhesion = \"10 mJ/m^2\"\nrange = \"10 nm\"\n")
}

/// Everything that a path finds, bit by bit: the rows without their seconds, and the fields of every step, of the rows that
/// this process holds.
#[derive(Default)]
struct Found {
    rows: Vec<String>,
    fields: Vec<Vec<u64>>,
    /// The points of these.
    held: Range<usize>,
}

impl Observer for Found {
    type Error = std::convert::Infallible;

    fn step(&mut self, step: FinishedStep) -> Result<(), Self::Error> {
        let mut row = step.row.clone();
        row.seconds = 0.0;
        // Debug prints numbers so that they read back to the same bits.
        self.rows.push(format!("{row:?}"));
        if let Some(evaluation) = step.evaluation {
            let bits = |values: Vec<f64>| values.into_iter().map(f64::to_bits).collect();
            self.fields.push(bits(evaluation.gap.into()));
            self.fields.push(bits(evaluation.pressure.into()));
        }
        Ok(())
    }

    fn iteration(&mut self, _: usize, _: &Scalars) -> bool {
        true
    }
}

/// The number of the fields.
#[derive(Clone, Copy, Debug)]
enum Number {
    Double,
    Single,
    Mixed,
}

impl Number {
    fn backend(self, ranks: Option<Arc<dyn Ranks>>) -> Box<dyn Backend + Send> {
        match self {
            Number::Double => cpu::double(ranks),
            Number::Single => cpu::single(ranks),
            Number::Mixed => cpu::mixed(ranks),
        }
    }
}

fn walked(
    scene: &Scene,
    number: Number,
    ranks: Option<Arc<dyn Ranks>>,
) -> Result<(WalkEnd, Found), WalkError<std::convert::Infallible>> {
    let surface = Surface::on_ranks(scene, ranks.clone()).expect("a surface");
    let setup = Setup::on_ranks(scene.clone(), surface, ranks.clone());
    let rows = setup.problem.share.surface_rows();
    let mut found = Found {
        held: rows.start * setup.surface.grid.nx..rows.end * setup.surface.grid.nx,
        ..Found::default()
    };
    let end = walk(&setup, &|| number.backend(ranks.clone()), &mut found)?;
    Ok((end, found))
}

/// Walks a path on one process and on so many ranks, and expects the same bits on every rank. Returns the bytes that all
/// ranks have sent in each walk.
fn same_bits(scene: &Scene, number: Number, counts: &[usize], what: &str) -> Vec<usize> {
    let (end, found) = walked(scene, number, None).expect("one process");
    assert!(end.rows.iter().all(|row| row.converged), "{what}");
    assert!(!found.fields.is_empty(), "{what}: no fields");
    let sent = counts.iter().map(|&count| {
        let ranks: Vec<_> = ThreadRanks::new(count).into_iter().map(Arc::new).collect();
        thread::scope(|scope| {
            for rank in &ranks {
                let (end, found) = (&end, &found);
                scope.spawn(move || {
                    let ranks: Arc<dyn Ranks> = rank.clone();
                    let walk = || walked(scene, number, Some(ranks));
                    let (here, own) = with_threads(Some(1), walk)
                        .expect("a thread")
                        .expect("all ranks");
                    let place = format!("{what}, {number:?}, rank {} of {count}", rank.rank());
                    assert_eq!(found.rows, own.rows, "{place}");
                    let fields = found.fields.iter().map(|field| &field[own.held.clone()]);
                    assert!(fields.eq(own.fields.iter()), "{place}: fields");
                    assert_eq!(end.transforms, here.transforms, "{place}");
                });
            }
        });
        ranks.iter().map(|rank| rank.sent()).sum()
    });
    sent.collect()
}

/// Counts of ranks: fewer than blocks of eight rows, as many as do not divide them, and more.
fn counts() -> &'static [usize] {
    if is_long() {
        &[1, 2, 3, 4, 5, 9]
    } else {
        &[2, 4]
    }
}

const PRESSURE: &str = "[loading]\ncontrol = \"pressure\"\npath = [1e6, 2e5]\n";
const MEAN_GAP: &str = "[loading]\ncontrol = \"mean-gap\"\npath = [\"60 nm\", \"40 nm\"]\n";

fn periodic_laws_and_controls() {
    let laws = ["", "maugis-dugdale", "exponential", "lennard-jones"];
    for (place, law) in laws.into_iter().enumerate() {
        for (other, loading) in [PRESSURE, MEAN_GAP].into_iter().enumerate() {
            let adhesion = if law.is_empty() {
                String::new()
            } else {
                adhesion(law)
            };
            // Each grid meets every law over the two controls of two laws; all meet all if asked for.
            let few = [
                (place + other) % GRIDS.len(),
                (place + 2 * other + 1) % GRIDS.len(),
            ];
            for (at, grid) in GRIDS.into_iter().enumerate() {
                if is_long() || few.contains(&at) {
                    let scene = scene(grid, "periodic", &format!("{adhesion}{loading}"), ROUGH);
                    let what = format!("{grid:?}, {law} {loading}");
                    same_bits(&scene, Number::Double, counts(), &what);
                }
            }
        }
    }
}

fn free_spheres() {
    let loading = "[loading]\ncontrol = \"approach\"\npath = [\"20 nm\", \"5 nm\"]\n";
    for law in ["maugis-dugdale", "lennard-jones"] {
        let below = format!("{}{loading}", adhesion(law));
        let scene = scene([24, 20], "free", &below, SPHERE);
        same_bits(&scene, Number::Double, counts(), law);
    }
}

/// Layers whose softest wave is the longest, and one of which it is not, and free boundaries with coarser levels and without:
/// on ranks that transform unlike numbers of columns, and on more than there are groups of eight columns.
fn stiffness_by_columns() {
    let adhesion = adhesion("maugis-dugdale");
    for (layer, grid) in [
        (
            "thickness = \"5 um\"\nbase = \"bonded\"\npoisson_ratio = 0.3\n",
            [64, 64],
        ),
        (
            "thickness = \"0.2 um\"\nbase = \"bonded\"\npoisson_ratio = 0.5\n",
            [36, 100],
        ),
        (
            "thickness = \"0.1 um\"\nbase = \"frictionless\"\npoisson_ratio = 0.3\n",
            [61, 47],
        ),
    ] {
        let (below, surface) = (format!("{adhesion}{MEAN_GAP}"), format!("{layer}{ROUGH}"));
        let scene = scene(grid, "periodic", &below, &surface);
        same_bits(&scene, Number::Double, &[3, 7], layer);
    }
    let loading = "[loading]\ncontrol = \"approach\"\npath = [\"20 nm\", \"5 nm\"]\n";
    for grid in [[24, 20], [13, 9], [20, 33]] {
        for number in [Number::Double, Number::Mixed] {
            let scene = scene(grid, "free", &format!("{adhesion}{loading}"), SPHERE);
            same_bits(&scene, number, &[3, 9], &format!("free, {grid:?}"));
        }
    }
}

/// What sums over the host's own arrays, and what changes the solid: each as on one process.
fn effects() {
    let maugis = adhesion("maugis-dugdale");
    let hardness = |scene: &mut Scene| scene.solid.hardness = Some(3e6);
    for (what, below, change) in [
        (
            "hardness",
            PRESSURE.to_owned(),
            Some(&hardness as &dyn Fn(&mut Scene)),
        ),
        (
            "adhesive, hardness",
            format!("{maugis}{PRESSURE}"),
            Some(&hardness as _),
        ),
        (
            "dmt",
            format!("{maugis}treatment = \"dmt\"\n{PRESSURE}"),
            None,
        ),
        (
            "position",
            format!("{maugis}[loading]\ncontrol = \"approach\"\npath = [\"-10 nm\", \"5 nm\"]\n"),
            None,
        ),
    ] {
        let mut scene = scene([40, 24], "periodic", &below, ROUGH);
        if let Some(change) = change {
            change(&mut scene);
        }
        same_bits(&scene, Number::Double, counts(), what);
    }
}

/// Every effect of this version, as its own example asks for it: what it carries, measures and sums is that of one
/// process.
fn every_effect() {
    let text = "[grid]\npoints = [40, 24]\nsize = [1.0, 1.0]\n[solid]\ncontact_modulus = 1.0\n[[surface]]\nkind = \"self-affine\"\nhurst = 0.8\nrms_height = 0.005\nlongest = 0.6\nrolloff = 0.4\nshortest = 0.1\n[loading]\ncontrol = \"approach\"\nstart = 0.0\n[[loading.ramp]]\nto = 0.006\nsteps = 2\nduration = 1\n[[loading.ramp]]\nto = 0.003\nsteps = 1\nduration = 1\n";
    for effect in Effect::ALL {
        let settings = effect.example().iter();
        let settings: Vec<(String, String)> = settings
            .map(|(key, value)| ((*key).to_owned(), (*value).to_owned()))
            .collect();
        let scene = Scene::parse(text, "effect.toml", Path::new("."), &settings)
            .unwrap_or_else(|errors| panic!("{errors}"));
        assert!(effect.is_on(&scene), "{effect:?}");
        same_bits(&scene, Number::Double, counts(), effect.name());
    }
}

/// The flow around a free sphere, of which some ranks hold rows of the pad alone, and through a rough gap of prime sides.
fn leakage() {
    let pressed = "[loading]\ncontrol = \"force\"\npath = [\"2 uN\"]\n";
    for axis in ["x", "y"] {
        let fluid = format!("[leakage]\nviscosity = 1.0\naxis = \"{axis}\"\n");
        let around = scene([40, 24], "free", &format!("{fluid}{pressed}"), SPHERE);
        let through = scene([61, 47], "periodic", &format!("{fluid}{PRESSURE}"), ROUGH);
        for scene in [around, through] {
            let (end, _) = walked(&scene, Number::Double, None).expect("one process");
            let flows = |row: &StepRow| row.column("flow_conductance") > Some(0.0);
            assert!(end.rows.iter().all(flows), "{axis}");
            same_bits(&scene, Number::Double, counts(), "leakage");
        }
    }
}

/// Fields of 32 bits alone, and beside a state of 64.
fn single_and_mixed_precision() {
    for number in [Number::Single, Number::Mixed] {
        for law in ["maugis-dugdale", "lennard-jones"] {
            let solver = match number {
                Number::Single => "[solver]\nprecision = \"single\"\n",
                _ => "",
            };
            let below = format!("{}{PRESSURE}{solver}", adhesion(law));
            let scene = scene([64, 64], "periodic", &below, ROUGH);
            same_bits(&scene, number, &[3], law);
        }
    }
}

fn a_coarse_start() {
    let scene = scene([128, 128], "periodic", PRESSURE, ROUGH);
    same_bits(&scene, Number::Double, &[4], "coarse start");
}

/// What an iteration sends: the half spectrum there and back in its convolution, eight columns at a time. Beside it go
/// two convolutions of the coarsest grid, a 64th of the points, the two rows beside each slab for some eight passes, and
/// the sums of the blocks: on this small grid less than a fifth of the first, and on a larger one less, since only the
/// first two grow like the points.
fn bytes_of_an_iteration() {
    const COUNT: usize = 4;
    const ITERATIONS: usize = 5;
    let points = 256;
    let scene = scene([points, points], "periodic", PRESSURE, ROUGH);
    let ranks: Vec<_> = ThreadRanks::new(COUNT).into_iter().map(Arc::new).collect();
    let sent: usize = thread::scope(|scope| {
        let solves = ranks.iter().map(|rank| {
            let scene = scene.clone();
            scope.spawn(move || {
                let ranks: Arc<dyn Ranks> = rank.clone();
                let surface = Surface::on_ranks(&scene, Some(ranks.clone()));
                let setup = Setup::on_ranks(scene, surface.expect("a surface"), Some(ranks));
                let problem = &setup.problem;
                let load = Load {
                    hold: Hold::Pressure(0.05),
                    zero_stiffness: 0.0,
                    zero_compliance: ContactSolver::pressure_compliance(problem, 0.05),
                };
                let mut backend = cpu::double(Some(rank.clone()));
                let mut solver = ContactSolver::new(&mut *backend, problem);
                solver
                    .begin(&load, &Start::Cold, 1e-12, false)
                    .expect("all ranks");
                let before = rank.sent();
                for _ in 0..ITERATIONS {
                    let scalars = solver.iterate().expect("all ranks");
                    assert!(scalars.accepted);
                }
                rank.sent() - before
            })
        });
        let solves: Vec<_> = solves.collect();
        solves
            .into_iter()
            .map(|solve| solve.join().expect("it iterates"))
            .sum()
    });
    let columns = (points / 2 + 1).next_multiple_of(8);
    // All but the share that a rank has already.
    let spectrum = 2 * size_of::<f64>() * columns * points * (COUNT - 1) / COUNT;
    let least = 2 * spectrum * ITERATIONS;
    assert!(sent >= least && sent < least + least / 5, "{sent} {least}");
}

/// More ranks than blocks of rows: some hold none, and take part all the same.
fn more_ranks_than_blocks() {
    let scene = scene([40, 24], "periodic", PRESSURE, ROUGH);
    same_bits(&scene, Number::Double, &[5, 11], "many ranks");
}

/// A rank that ends before the others is missed by them, in words that name it, and nobody waits for ever.
fn a_rank_that_ends() {
    let scene = scene([40, 24], "periodic", PRESSURE, ROUGH);
    let is_missed = |error: String| assert!(error.contains("has ended before it"), "{error}");
    // One that never begins.
    let mut ranks = ThreadRanks::new(3);
    drop(ranks.pop());
    thread::scope(|scope| {
        for rank in ranks {
            let scene = &scene;
            scope.spawn(
                move || match Surface::on_ranks(scene, Some(Arc::new(rank))) {
                    Ok(_) => panic!("a rank is missing"),
                    Err(error) => is_missed(error.to_string()),
                },
            );
        }
    });
    // One that ends before the path.
    thread::scope(|scope| {
        for rank in ThreadRanks::new(3) {
            let scene = &scene;
            scope.spawn(move || {
                let ends = rank.rank() == 2;
                let ranks: Option<Arc<dyn Ranks>> = Some(Arc::new(rank));
                let surface = Surface::on_ranks(scene, ranks.clone()).expect("all ranks");
                let setup = Setup::on_ranks(scene.clone(), surface, ranks.clone());
                if ends {
                    return;
                }
                let backend = || Number::Double.backend(ranks.clone());
                match walk(&setup, &backend, &mut Found::default()) {
                    Ok(_) => panic!("a rank is missing"),
                    // The others may have ended for the same reason before.
                    Err(WalkError::Backend(error)) => {
                        assert!(matches!(error, BackendError::Device(_)));
                        is_missed(error.to_string());
                    }
                    Err(WalkError::Observer(never)) => match never {},
                }
            });
        }
    });
}

/// A run in a folder over so many ranks; the ends of all.
fn run_over(
    scene: &Scene,
    folder: &Path,
    options: &RunOptions,
    count: usize,
    last: usize,
) -> Vec<Result<RunEnd, RunError>> {
    thread::scope(|scope| {
        let runs = ThreadRanks::new(count).into_iter().map(|rank| {
            scope.spawn(move || {
                let mut observer = EndsAfter(last);
                run_on_ranks(
                    scene.clone(),
                    folder,
                    options,
                    Arc::new(rank),
                    &mut observer,
                )
            })
        });
        let runs: Vec<_> = runs.collect();
        runs.into_iter()
            .map(|run| run.join().expect("it does not panic"))
            .collect()
    })
}

/// Ends a run after an iteration of so many.
struct EndsAfter(usize);

impl RunObserver for EndsAfter {
    fn iteration(&mut self, _: usize, _: usize, _: f64) -> bool {
        self.0 = self.0.saturating_sub(1);
        self.0 > 0
    }
}

/// Files of a run by name, the curve without its seconds; those that tell seconds or are drawn aside.
fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let curve = fs::read_to_string(folder.join("curve.csv")).expect("a curve");
    let mut lines = curve.lines();
    let head: Vec<&str> = lines.next().expect("a head").split(',').collect();
    let seconds = head
        .iter()
        .position(|name| *name == "seconds")
        .expect("a column of seconds");
    let mut found = Vec::new();
    for line in lines {
        let mut cells: Vec<&str> = line.split(',').collect();
        cells[seconds] = "";
        found.push(("curve.csv".to_owned(), cells.join(",").into_bytes()));
    }
    for below in ["fields", "state"] {
        let mut entries: Vec<_> = fs::read_dir(folder.join(below))
            .expect("a folder")
            .map(|entry| entry.expect("an entry").path())
            .filter(|path| path.is_file() && path.extension().is_some_and(|kind| kind != "lock"))
            .collect();
        entries.sort();
        for path in entries {
            let bytes = fs::read(&path).expect("a file");
            found.push((
                path.display()
                    .to_string()
                    .replace(&folder.display().to_string(), ""),
                bytes,
            ));
        }
    }
    found
}

/// The folder of a run over three ranks is that of a run without any: curve, fields and state. A run that the first
/// rank's observer ends, or that ends in its second step, is resumed on another number of ranks to the same files.
fn the_folder_of_a_run() {
    let loading = "[loading]\ncontrol = \"pressure\"\npath = [2e5, 1e6, 5e5, 2e5]\n[output]\nfields = [\"gap\", \"pressure\"]\nimages = []\nsteps = \"all\"\n";
    let below = format!("{}{loading}", adhesion("maugis-dugdale"));
    let scene = scene([40, 24], "periodic", &below, ROUGH);
    let place = tempfile::tempdir().expect("a temporary folder");
    let at = |name: &str| place.path().join(name);
    let options = RunOptions::new()
        .threads(1)
        .images(false)
        .device(Device::cpu());
    run_with(scene.clone(), &at("one"), &options, &mut ()).expect("it is solved");
    let one = files(&at("one"));
    assert!(one.len() > 4 + 8, "{} files", one.len());

    let ends = run_over(&scene, &at("three"), &options, 3, usize::MAX);
    let rows = |end: &RunEnd| end.rows.len();
    for end in &ends {
        let end = end.as_ref().expect("all ranks");
        assert_eq!((rows(end), end.status), (4, RunStatus::Finished));
    }
    assert_eq!(files(&at("three")), one);

    // Somewhere in the second step.
    let first = ends[0].as_ref().map_or(0, |end| end.rows[0].iterations);
    let ended = run_over(&scene, &at("cut"), &options, 4, first + 3);
    for end in &ended {
        let end = end.as_ref().expect("all ranks");
        assert_eq!(rows(end), 1);
        assert!(matches!(
            end.status,
            RunStatus::Interrupted { finished: 1, .. }
        ));
    }
    let resumed = options.clone().resume(true);
    for end in run_over(&scene, &at("cut"), &resumed, 2, usize::MAX) {
        assert_eq!(rows(&end.expect("all ranks")), 4);
    }
    assert_eq!(files(&at("cut")), one);
}

/// A path that ends in separated surfaces, without fields: those of the step before are written, of all ranks, and drawn
/// too.
fn fields_of_the_last_step_in_contact() {
    let loading = "[loading]\ncontrol = \"pressure\"\npath = [2e5, 0.0, -1e9]\n[output]\nfields = [\"gap\"]\nimages = [\"gap\"]\n";
    let below = format!("{}{loading}", adhesion("maugis-dugdale"));
    let scene = scene([40, 24], "periodic", &below, ROUGH);
    let place = tempfile::tempdir().expect("a temporary folder");
    let at = |name: &str| place.path().join(name);
    let options = RunOptions::new().threads(1).device(Device::cpu());
    run_with(scene.clone(), &at("one"), &options, &mut ()).expect("it is solved");
    for end in run_over(&scene, &at("three"), &options, 3, usize::MAX) {
        let end = end.expect("all ranks");
        assert_eq!((end.rows.len(), end.status), (3, RunStatus::Finished));
    }
    assert_eq!(files(&at("three")), files(&at("one")));
    let drawn = |name: &str| {
        fs::read(at(name).join("images/step_0002_gap.png")).expect("a picture of step 2")
    };
    assert!(drawn("three") == drawn("one"));
}

/// What one rank cannot do is told once, and ends the others: a folder that is no folder, a graphics processor, which
/// no rank takes, and a grid that no memory holds.
fn what_a_rank_refuses() {
    let scene = scene([40, 24], "periodic", PRESSURE, ROUGH);
    let place = tempfile::tempdir().expect("a temporary folder");
    let file = place.path().join("file");
    fs::write(&file, "no folder").expect("a file");
    let options = RunOptions::new().threads(1).device(Device::cpu());
    let ends = run_over(&scene, &file, &options, 3, usize::MAX);
    assert!(matches!(ends[0], Err(RunError::Output(_))));
    for end in &ends[1..] {
        assert!(matches!(end, Err(RunError::Rank(error)) if error.rank == 0));
    }
    let ends = run_over(
        &scene,
        &place.path().join("run"),
        &options.clone().device(Device::gpu()),
        2,
        usize::MAX,
    );
    let Err(error @ RunError::Device(_)) = &ends[0] else {
        panic!("a graphics processor is refused");
    };
    assert!(error.to_string().contains("over 2 ranks"), "{error}");
    assert!(matches!(&ends[1], Err(RunError::Rank(error)) if error.rank == 0));
    // Some terabytes for all.
    let mut huge = scene;
    huge.grid.points = Some([1 << 15, 1 << 15]);
    let ends = run_over(&huge, &place.path().join("run"), &options, 64, usize::MAX);
    let Err(error @ RunError::Memory(_)) = &ends[0] else {
        panic!("no memory holds it");
    };
    assert!(
        error
            .to_string()
            .contains("on each of 64 ranks, 64 of them on this machine"),
        "{error}"
    );
}

tests![
    the_folder_of_a_run,
    fields_of_the_last_step_in_contact,
    what_a_rank_refuses,
    periodic_laws_and_controls,
    free_spheres,
    stiffness_by_columns,
    effects,
    every_effect,
    leakage,
    single_and_mixed_precision,
    a_coarse_start,
    bytes_of_an_iteration,
    more_ranks_than_blocks,
    a_rank_that_ends,
];
