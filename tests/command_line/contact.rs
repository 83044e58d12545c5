//! Arrays in, arrays out: the same numbers as the command line's to the last bit, in the shape that is
//! promised, and mistakes that are told in the words of Rust.

use std::fs;
use std::path::Path;
use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::shared::trials::tests;
use tabor::scene::{
    AdhesionScene, Axis, CapillaryScene, PatternKind, RelaxationScene, Scene, SolidScene,
    StepChoice,
};
use tabor::{
    AdhesionMap, Base, Boundary, Contact, ContactError, Control, Device, Exponential, Grid,
    GridValues, Layer, LennardJones, Load, MaugisDugdale, Precision, Ramp, Range, Roughness,
    RunOptions, SelfAffine, Solution, State, StepRow, SurfacePart, Treatment,
};

const POINTS: [usize; 2] = [32, 24];
const SIZE: [f64; 2] = [2e-6, 1.5e-6];

fn rough() -> SelfAffine {
    SelfAffine {
        hurst: 0.8,
        roughness: Roughness::RmsSlope(0.1),
        longest: 2e-6,
        rolloff: 1e-6,
        shortest: 0.25e-6,
        seed: 1,
    }
}

/// The same surface in a scene.
const ROUGH: &str = "[grid]\npoints = [32, 24]\nsize = [2e-6, 1.5e-6]\n[[surface]]\nkind = \"self-affine\"\nhurst = 0.8\nrms_slope = 0.1\nlongest = 2e-6\nrolloff = 1e-6\nshortest = 0.25e-6\n";

fn contact() -> Contact {
    let heights = rough().heights(Grid::new(POINTS, SIZE)).expect("heights");
    Contact::new(heights, POINTS, SIZE).contact_modulus(50e6)
}

fn sphere() -> Contact {
    Contact::from_parts([SurfacePart::sphere(5e-6)], [32, 32], [2e-6, 2e-6]).contact_modulus(50e6)
}

const SPHERE: &str =
    "[grid]\npoints = 32\nsize = 2e-6\nBOUNDARY\n[[surface]]\nkind = \"sphere\"\nradius = 5e-6\n";

fn pressures(values: &[f64]) -> Vec<Load> {
    loads(values, Control::MeanPressure)
}

fn loads(values: &[f64], control: impl Fn(f64) -> Control) -> Vec<Load> {
    let controls = values.iter().map(|&value| control(value));
    controls.map(Load::from).collect()
}

/// A contact in Rust, its loads, and the scene that says the same.
struct Case {
    name: &'static str,
    contact: Contact,
    loads: Vec<Load>,
    scene: String,
}

fn case(name: &'static str, contact: Contact, loads: Vec<Load>, scene: String) -> Case {
    Case {
        name,
        contact,
        loads,
        scene,
    }
}

/// Every law, control, boundary and effect.
fn cases() -> Vec<Case> {
    let solid = "[solid]\ncontact_modulus = 50e6\n";
    let free = SPHERE.replace("BOUNDARY", "boundary = \"free\"");
    let periodic = SPHERE.replace("BOUNDARY", "");
    let sharp = "[adhesion]\nlaw = \"maugis-dugdale\"\nwork_of_adhesion = 0.01\nrange = 10e-9\n";
    let law = MaugisDugdale::new(0.01, 10e-9);
    let branch = RelaxationScene {
        modulus: 100e6,
        time: 0.1,
    };
    let relaxing = contact().relaxation([branch]);
    let ramps = [
        Ramp::to(1e6, 2).during(0.05),
        Ramp::hold(0.3, 1).auto_steps(),
    ];
    let creep = relaxing
        .ramps(Control::MeanPressure(1e5), &ramps, Some(0.01))
        .expect("ramps");
    let factors: Vec<f64> = (0..POINTS[0] * POINTS[1])
        .map(|point| if point % 8 < 4 { 1.0 } else { 0.5 })
        .collect();
    let layer = Layer {
        thickness: 1e-6,
        poisson_ratio: 0.4,
        base: Base::Bonded,
    };
    vec![
        case(
            "hard wall",
            contact(),
            pressures(&[1e5, 2e6, 5e5]),
            format!("{ROUGH}{solid}[loading]\ncontrol = \"pressure\"\npath = [1e5, 2e6, 5e5]\n"),
        ),
        case(
            "pulled apart and pressed again",
            contact().law(law),
            pressures(&[1e6, 3e6, 0.0, -5e6, 2e5]),
            format!(
                "{ROUGH}{solid}{sharp}[loading]\ncontrol = \"pressure\"\npath = [1e6, 3e6, 0.0, -5e6, 2e5]\n"
            ),
        ),
        case(
            "one isolated sphere",
            sphere().law(law.taper(0.0)).boundary(Boundary::Free),
            loads(&[1e-7, 3e-7, 0.0], Control::Force),
            format!(
                "{free}{solid}{sharp}taper = 0.0\n[loading]\ncontrol = \"force\"\npath = [1e-7, 3e-7, 0.0]\n"
            ),
        ),
        case(
            "exponential, a spring",
            sphere().law(Exponential::new(0.01, 20e-9)).spring(5.0),
            loads(&[0.0, 30e-9, 60e-9], Control::Approach),
            format!(
                "{periodic}{solid}[adhesion]\nlaw = \"exponential\"\nwork_of_adhesion = 0.01\nrange = 20e-9\n[loading]\ncontrol = \"approach\"\npath = [0.0, 30e-9, 60e-9]\nspring = 5.0\n"
            ),
        ),
        case(
            "Lennard-Jones, a mean gap, the shortest range",
            contact().law(LennardJones::new(0.01, Range::Auto)),
            loads(&[60e-9, 30e-9, 50e-9], Control::MeanGap),
            format!(
                "{ROUGH}{solid}[adhesion]\nlaw = \"lennard-jones\"\nwork_of_adhesion = 0.01\nrange = \"auto\"\n[loading]\ncontrol = \"mean-gap\"\npath = [60e-9, 30e-9, 50e-9]\n"
            ),
        ),
        case(
            "hardness, friction, wear, a counter-face",
            contact()
                .solid(SolidScene::from_young_moduli([90e6, 0.3], [200e6, 0.25]))
                .hardness(8e6)
                .friction(1e6)
                .wear(1e-15)
                .law(law),
            pressures(&[1e6, 4e6, 1e6]),
            format!(
                "{ROUGH}[solid]\nyoung_modulus = 90e6\npoisson_ratio = 0.3\ncounter_young_modulus = 200e6\ncounter_poisson_ratio = 0.25\nhardness = 8e6\n{sharp}[friction]\nshear_strength = 1e6\n[wear]\nspecific_wear_rate = 1e-15\n[loading]\ncontrol = \"pressure\"\npath = [1e6, 4e6, 1e6]\n"
            ),
        ),
        case(
            "a layer, a pattern, DMT",
            contact()
                .layer(layer)
                .law(law)
                .treatment(Treatment::Dmt)
                .adhesion_map(AdhesionMap::Pattern {
                    kind: PatternKind::Stripe,
                    period: 0.5e-6,
                    low: 0.5,
                    high: 1.0,
                }),
            pressures(&[1e6, 2e6]),
            format!(
                "{ROUGH}{solid}thickness = 1e-6\npoisson_ratio = 0.4\n{sharp}treatment = \"dmt\"\nmap = {{ pattern = \"stripe\", period = 0.5e-6, low = 0.5, high = 1.0 }}\n[loading]\ncontrol = \"pressure\"\npath = [1e6, 2e6]\n"
            ),
        ),
        case(
            "leakage along y",
            contact().leakage(1e-3, Axis::Y),
            pressures(&[1e6, 2e6]),
            format!(
                "{ROUGH}{solid}[leakage]\nviscosity = \"1 mPa s\"\naxis = \"y\"\n[loading]\ncontrol = \"pressure\"\npath = [1e6, 2e6]\n"
            ),
        ),
        case(
            "a map of factors, conductance, single precision",
            contact()
                .law(law)
                .adhesion_map(AdhesionMap::Factors(GridValues::new(factors, POINTS)))
                .conductance(400.0, 50.0)
                .precision(Precision::Single),
            pressures(&[1e6, 2e6]),
            format!(
                "{ROUGH}{solid}{sharp}map = \"factors.txt\"\n[conductance]\nconductivity = 400.0\ncounter_conductivity = 50.0\n[loading]\ncontrol = \"pressure\"\npath = [1e6, 2e6]\n[solver]\nprecision = \"single\"\n"
            ),
        ),
        case(
            "creep in steps of its own",
            relaxing,
            creep,
            format!(
                "{ROUGH}{solid}[[solid.relaxation]]\nmodulus = 100e6\ntime = 0.1\n[loading]\ncontrol = \"pressure\"\nstart = 1e5\ntime_tolerance = 0.01\n[[loading.ramp]]\nto = 1e6\nsteps = 2\nduration = 0.05\n[[loading.ramp]]\nhold = 0.3\nsteps = \"auto\"\n"
            ),
        ),
        case(
            "an edge that costs more at speed",
            sphere().law(law).rate(1e-6, 0.5),
            [20e-9, 40e-9, 10e-9]
                .map(|d| Control::Approach(d).after(0.05))
                .into(),
            format!(
                "{periodic}{solid}{sharp}rate = {{ reference_speed = 1e-6, exponent = 0.5 }}\n[loading]\ncontrol = \"approach\"\nstart = 20e-9\n[[loading.ramp]]\nto = 40e-9\nsteps = 1\nduration = 0.05\n[[loading.ramp]]\nto = 10e-9\nsteps = 1\nduration = 0.05\n"
            ),
        ),
        case(
            "damp air",
            sphere().capillary(CapillaryScene::water(0.6)),
            pressures(&[1e5, 1e6]),
            format!(
                "{periodic}{solid}[capillary]\nhumidity = 0.6\n[loading]\ncontrol = \"pressure\"\npath = [1e5, 1e6]\n"
            ),
        ),
    ]
}

/// Runs a scene by the command line with every field of every step.
fn command_line(folder: &Path, scene: &str) {
    let text: String = (0..POINTS[1])
        .map(|_| "1 1 1 1 0.5 0.5 0.5 0.5 ".repeat(POINTS[0] / 8) + "\n")
        .collect();
    fs::write(folder.join("factors.txt"), text).expect("factors");
    let output = "[output]\nimages = []\nfields = [\"gap\", \"pressure\", \"displacement\", \"heights\"]\nsteps = \"all\"\n";
    fs::write(folder.join("scene.toml"), format!("{scene}{output}")).expect("a scene");
    let done = Command::new(env!("CARGO_BIN_EXE_tabor"))
        .current_dir(folder)
        .args([
            "run",
            "scene.toml",
            "--out",
            "run",
            "--backend",
            "cpu",
            "--quiet",
        ])
        .output()
        .expect("the binary runs");
    let said = String::from_utf8_lossy(&done.stderr).into_owned();
    assert!(done.status.success(), "{said}\n{scene}");
}

/// Rows of a curve, cell by cell, without the seconds.
fn rows(folder: &Path) -> Vec<Vec<String>> {
    let text = fs::read_to_string(folder.join("curve.csv")).expect("a curve");
    let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let head = lines.next().expect("a head");
    let seconds = head.iter().position(|name| *name == "seconds");
    lines
        .map(|cells| {
            let cells = cells.iter().enumerate();
            cells
                .filter(|(column, _)| Some(*column) != seconds)
                .map(|(_, cell)| (*cell).to_owned())
                .collect()
        })
        .collect()
}

/// Bits of a field that a run has written; none where the step has none.
fn field(folder: &Path, step: usize, name: &str, single: bool) -> Option<Vec<u64>> {
    let path = folder.join(format!("fields/step_{step:04}_{name}.npy"));
    let bytes = fs::read(path).ok()?;
    let file = npyz::NpyFile::new(&bytes[..]).expect("an array");
    assert_eq!(file.shape().len(), 2);
    Some(if single {
        let values: Vec<f32> = file.into_vec().expect("numbers");
        values
            .iter()
            .map(|value| f64::from(*value).to_bits())
            .collect()
    } else {
        let values: Vec<f64> = file.into_vec().expect("numbers");
        values.iter().map(|value| value.to_bits()).collect()
    })
}

fn contacts_in_rust_and_scenes_on_the_command_line_give_the_same_bits() {
    for case in cases() {
        let Case {
            name,
            contact,
            loads,
            scene,
        } = case;
        let place = tempfile::tempdir().expect("a folder");
        command_line(place.path(), &scene);
        let written = place.path().join("run");
        let contact = contact.device(Device::cpu());
        let single = name.contains("single");
        let solutions: Vec<Solution> = contact
            .path(loads.clone())
            .collect::<Result<_, _>>()
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(solutions.len(), rows(&written).len(), "{name}");
        for (index, solution) in solutions.iter().enumerate() {
            assert!(solution.converged, "{name}");
            for (field_name, values) in [
                ("gap", &solution.gap[..]),
                ("pressure", &solution.pressure),
                ("displacement", &solution.displacement),
                ("heights", &solution.heights),
            ] {
                let Some(expected) = field(&written, index + 1, field_name, single) else {
                    assert_eq!(solution.state, State::Separated, "{name}: step {index}");
                    continue;
                };
                let bits: Vec<u64> = values
                    .iter()
                    .map(|&value| {
                        if single {
                            f64::from(value as f32)
                        } else {
                            value
                        }
                    })
                    .map(f64::to_bits)
                    .collect();
                assert!(
                    bits == expected,
                    "{name}: {field_name} of step {}",
                    index + 1
                );
            }
        }
        // The same path as one run of the library into a folder, row by row.
        let folder = place.path().join("library");
        let built = contact.scene(loads).expect("a scene");
        let end = tabor::run(built, &folder, &mut ()).expect("a run");
        assert_eq!(rows(&folder), rows(&written), "{name}");
        let without_seconds = |mut row: StepRow| {
            row.seconds = 0.0;
            row
        };
        for (row, solution) in end.rows.into_iter().zip(solutions) {
            assert_eq!(
                without_seconds(row),
                without_seconds(solution.row),
                "{name}"
            );
        }
    }
}

fn scenes_from_files_are_contacts_too() {
    let Case { scene, contact, .. } = cases().swap_remove(1);
    let scene = Scene::parse(&scene, "scene.toml", Path::new("."), &[]).expect("a scene");
    let read = Contact::from_scene(scene);
    let one: Vec<Solution> = read.path(read.loads()).map(Result::unwrap).collect();
    let loads = pressures(&[1e6, 3e6, 0.0, -5e6, 2e5]);
    let other: Vec<Solution> = contact.path(loads).map(Result::unwrap).collect();
    assert_eq!(one.len(), 5);
    for (one, other) in one.iter().zip(&other) {
        assert_eq!(one.pressure, other.pressure);
        assert_eq!(one.approach, other.approach);
    }
}

fn arrays_have_the_shape_and_order_that_are_promised() {
    // Highest at (ix, iy) = (3, 10) of 16 x 12 points.
    let (points, size) = ([16, 12], [1.6e-6, 1.2e-6]);
    let heights: Vec<f64> = (0..16 * 12)
        .map(|point| {
            let (x, y) = ((point % 16) as f64 - 3.0, (point / 16) as f64 - 10.0);
            -1e-9 * (x * x + y * y)
        })
        .collect();
    let solution = Contact::new(&heights, points, size)
        .contact_modulus(1e9)
        .boundary(Boundary::Free)
        .solve(Control::Force(1e-7))
        .expect("a solution");
    assert_eq!(solution.points, points);
    assert_eq!(solution.size, size);
    assert_eq!(*solution.heights, heights);
    for values in [&solution.gap, &solution.pressure, &solution.displacement] {
        assert_eq!(values.len(), 16 * 12);
    }
    let largest = |values: &[f64]| {
        let places = values.iter().enumerate();
        places.max_by(|a, b| a.1.total_cmp(b.1)).map(|(at, _)| at)
    };
    assert_eq!(largest(&solution.pressure), Some(10 * 16 + 3));
    // The pixels bear the force, to some times the tolerance of 1e-6.
    let sum: f64 = solution.pressure.iter().sum::<f64>() * 1e-7 * 1e-7;
    assert!((sum / solution.force - 1.0).abs() < 1e-5, "{sum:e}");
    // u = gap + heights - (what the bodies came together by, from the highest point).
    let approach = solution.approach.expect("in contact");
    for (point, height) in heights.iter().enumerate() {
        let together = solution.gap[point] + height + approach;
        let difference = (solution.displacement[point] - together).abs();
        assert!(difference < 1e-12 * 1e-7, "{difference:e}");
    }
}

fn paths_are_solved_as_they_are_asked_for() {
    let mut asked = 0;
    let mut path = contact().path([1e5, 5e5, 1e6, 2e6].into_iter().map(|p| {
        asked += 1;
        Control::MeanPressure(p)
    }));
    let first = path.next().expect("a load").expect("a solution");
    let second = path.next().expect("a load").expect("a solution");
    drop(path);
    assert_eq!(asked, 2);
    assert!(second.contact_area_fraction > first.contact_area_fraction);
    // From the state before it takes fewer iterations than afresh, at most.
    let afresh = contact()
        .solve(Control::MeanPressure(5e5))
        .expect("a solution");
    assert!(second.iterations <= afresh.iterations);
    // A path ends behind a load that does not converge.
    let hasty = contact().max_iterations(1).tolerance(1e-12);
    let ended: Vec<bool> = hasty
        .path([1e5, 5e5].map(Control::MeanPressure))
        .map(|solution| solution.expect("a solution").converged)
        .collect();
    assert_eq!(ended, [false]);
    assert!(contact().path([Control::Force(0.0); 0]).next().is_none());
}

fn a_path_has_the_loads_it_is_given_and_their_pull_off() {
    let adhesive = contact().law(MaugisDugdale::new(0.05, 20e-9));
    // A scene that pulls on behind its path, and names a step of it: both are for a run.
    let mut scene = adhesive
        .scene([1e6, 0.0].map(Control::MeanPressure))
        .expect("a scene");
    scene.loading.until_apart = true;
    scene.output.steps = StepChoice::List(vec![2]);
    let pulled: Vec<Solution> = Contact::from_scene(scene.clone())
        .path([1e6, 0.0].map(Control::MeanPressure))
        .until_apart()
        .map(Result::unwrap)
        .collect();
    let (last, held) = pulled.split_last().expect("steps");
    assert!(held.len() > 2 && held.iter().all(|step| step.state != State::Separated));
    assert_eq!(last.state, State::Separated);
    let loads = [1e6, 0.0, -1e9].map(Control::MeanPressure);
    let solved: Vec<Solution> = Contact::from_scene(scene)
        .path(loads)
        .map(Result::unwrap)
        .collect();
    assert_eq!(solved.len(), 3);
    assert_eq!(solved[0].mean_pressure, 1e6);
    assert_eq!(solved[2].state, State::Separated);
    assert_eq!(solved[1].pull_off, None);
    let [held, parted] = solved[2].pull_off.expect("it let go");
    assert!(held > 0.0 && parted > held && parted - held <= 0.01 * parted);
    // A tension between 0 and the bracket holds, one beyond does not.
    let area = SIZE[0] * SIZE[1];
    let holds = |tension: f64| {
        let path = [1e6, 0.0, -tension / area].map(Control::MeanPressure);
        let last = adhesive.path(path).last().expect("a load");
        last.expect("a solution").state != State::Separated
    };
    assert!(holds(0.97 * held) && !holds(1.03 * parted));
}

/// What a whole path does not show is known behind its last load, and said once.
fn a_path_that_has_ended_says_what_it_does_not_show() {
    let adhesive = contact().law(MaugisDugdale::new(0.05, 20e-9));
    let loads = |last: f64| [1e6, 0.0, last].map(Control::MeanPressure);
    let pulled = adhesive.path(loads(-1e9)).last().expect("a load");
    let [held, _] = pulled.expect("a solution").pull_off.expect("it let go");
    let mut path = adhesive.path(loads(-0.5 * held / (SIZE[0] * SIZE[1])));
    let said = |warnings: Vec<String>| {
        let beyond = |words: &&String| words.contains("its pull-off is beyond");
        warnings.iter().filter(beyond).count()
    };
    for _ in 0..3 {
        assert!(path.next().expect("a load").expect("a solution").converged);
        assert_eq!(said(path.warnings()), 0);
    }
    for _ in 0..2 {
        assert!(path.next().is_none());
        assert_eq!(said(path.warnings()), 1, "{:?}", path.warnings());
    }
}

/// A scene that names a step of its own path, or goes on behind it, says nothing of a single load or of other ramps.
fn one_load_of_a_scene_takes_nothing_of_its_path() {
    let law = MaugisDugdale::new(0.05, 20e-9);
    let mut scene = contact()
        .law(law)
        .scene([1e6, 2e6, 0.0].map(Control::MeanPressure))
        .expect("a scene");
    scene.output.steps = StepChoice::List(vec![3]);
    let own = contact().law(law).solve(Control::MeanPressure(1e6));
    let read = Contact::from_scene(scene.clone()).solve(Control::MeanPressure(1e6));
    let [own, read] = [own, read].map(|solved| solved.expect("a solution"));
    assert_eq!(read.pressure, own.pressure);
    scene.loading.until_apart = true;
    let hold = [Ramp::hold(1.0, 2)];
    let loads = Contact::from_scene(scene).ramps(Control::MeanPressure(1e6), &hold, None);
    assert_eq!(loads.expect("loads").len(), 3);
}

fn a_watcher_ends_a_solve() {
    let heard = Arc::new(AtomicUsize::new(0));
    let count = Arc::clone(&heard);
    let watched = contact().watch(move |_, residual| {
        assert!(residual >= 0.0);
        count.fetch_add(1, Ordering::Relaxed) < 2
    });
    let ended = watched.tolerance(1e-12).solve(Control::MeanPressure(1e6));
    assert!(
        matches!(ended, Err(ContactError::Interrupted)),
        "{:?}",
        ended.map(|solution| solution.iterations)
    );
    assert_eq!(heard.load(Ordering::Relaxed), 3);
}

fn parted_surfaces_leave_whole_arrays() {
    let parted = contact()
        .law(MaugisDugdale::new(0.01, 10e-9))
        .solve(Control::MeanPressure(-5e7))
        .expect("a solution");
    assert_eq!(parted.state, State::Separated);
    assert_eq!((parted.approach, parted.force), (None, 0.0));
    let count = POINTS[0] * POINTS[1];
    assert_eq!(parted.gap, vec![f64::INFINITY; count]);
    assert_eq!(parted.pressure, vec![0.0; count]);
    assert_eq!(parted.displacement, vec![0.0; count]);
}

fn threads_change_no_bit() {
    let solve = |threads| {
        let contact = contact().law(Exponential::new(0.01, 20e-9));
        contact.threads(threads).solve(Control::MeanPressure(1e6))
    };
    let (one, three) = (solve(1).expect("one"), solve(3).expect("three"));
    assert_eq!(one.gap, three.gap);
    assert_eq!(one.pressure, three.pressure);
}

fn runs_of_the_library_are_resumed_refused_and_quiet_about_pictures() {
    let place = tempfile::tempdir().expect("a folder");
    let folder = place.path().join("run");
    let scene = || {
        contact()
            .scene(pressures(&[1e5, 1e6, 2e6]))
            .expect("a scene")
    };
    struct Ends(usize);
    impl tabor::RunObserver for Ends {
        fn iteration(&mut self, step: usize, _: usize, _: f64) -> bool {
            step < self.0
        }
    }
    let cut = tabor::run(scene(), &folder, &mut Ends(2)).expect("an end");
    let interrupted = tabor::RunStatus::Interrupted {
        finished: 1,
        steps: 3,
    };
    assert_eq!(cut.status, interrupted);
    let again = |options: RunOptions| tabor::run_with(scene(), &folder, &options, &mut ());
    let refused = again(RunOptions::new().overwrite(false)).expect_err("a run is there");
    assert!(
        refused.to_string().contains("holds a run of this scene"),
        "{refused}"
    );
    let resumed = again(RunOptions::new().resume(true)).expect("an end");
    assert_eq!(resumed.status, tabor::RunStatus::Finished);
    assert!(folder.join("report.html").exists());
    let plain = place.path().join("plain");
    let options = RunOptions::new().images(false).device(Device::cpu());
    tabor::run_with(scene(), &plain, &options, &mut ()).expect("an end");
    assert!(!plain.join("report.html").exists() && !plain.join("images").exists());
    assert_eq!(rows(&plain), rows(&folder));
    assert!(plain.join("summary.json").exists());
}

/// The error of a contact, in words.
fn refused(contact: Contact, loads: impl IntoIterator<Item = impl Into<Load>>) -> String {
    let mut path = contact.path(loads);
    let error = path.find_map(Result::err);
    error.expect("a mistake").to_string()
}

#[rustfmt::skip] // one mistake a line
fn mistakes_name_the_method_and_no_line_of_a_scene() {
    let pressure = || [Control::MeanPressure(1e6)];
    let force = || [Control::Force(1e-7)];
    let law = || MaugisDugdale::new(0.01, 10e-9);
    let layer = |poisson_ratio| Layer { thickness: 1e-6, poisson_ratio, base: Base::Bonded };
    let branch = RelaxationScene { modulus: 1e8, time: 0.1 };
    let pattern = |low, high, period| AdhesionMap::Pattern { kind: PatternKind::Checker, period, low, high };
    let bare = |heights: &[f64], points| Contact::new(heights, points, SIZE);
    let part = |part| Contact::from_parts([part], POINTS, SIZE).contact_modulus(1e6);
    let affine = |change: &dyn Fn(&mut SelfAffine)| { let mut rough = rough(); change(&mut rough); part(SurfacePart::from(rough)) };
    let mistakes = [
        (refused(bare(&[0.0; 4], [2, 2]), pressure()), "Contact::contact_modulus, contact_modulus: missing; add for example `Contact::contact_modulus(100e6)`"),
        (refused(contact().contact_modulus(-1.0), pressure()), "Contact::contact_modulus, contact_modulus: -1.0 is out of range"),
        (refused(contact().contact_modulus(f64::NAN), pressure()), "Contact::contact_modulus, contact_modulus: nan is out of range"),
        (refused(bare(&[0.0; 4], [2, 3]).contact_modulus(1e6), pressure()), "part 1: an array of 4 numbers for 2 x 3 points"),
        (refused(bare(&[f64::INFINITY; 4], [2, 2]).contact_modulus(1e6), pressure()), "part 1: the height at row 1, column 1 (counted from 1) is inf"),
        (refused(bare(&[], [0, 2]).contact_modulus(1e6), pressure()), "Contact::new, 0: 0 is out of range; it must be a whole number from 1 to 262144"),
        (refused(Contact::new([0.0; 4], [2, 2], [1e-6, 0.0]).contact_modulus(1e6), pressure()), "Contact::new, 1: 0.0 is out of range"),
        (refused(contact().boundary(Boundary::Free), pressure()), "Contact::path, control: a free boundary has no nominal area to average over; take Control::Force or Control::Approach, or Boundary::Periodic"),
        (refused(contact().layer(layer(0.4)).boundary(Boundary::Free), force()), "Contact::layer, thickness: a layer needs Boundary::Periodic; take a cell several times as wide as the contact, or leave Contact::layer out"),
        (refused(contact().layer(layer(0.4)).conductance(1.0, 1.0), pressure()), "Contact::conductance, conductance: the conductance of a layer is not in this version; leave Contact::layer out, or Contact::conductance"),
        (refused(contact().layer(layer(0.4)).relaxation([branch]), pressure()), "take a Poisson ratio of 0.5, or leave Contact::layer out"),
        (refused(contact().relaxation([branch]), pressure()), "Contact::path, path: a viscoelastic solid needs durations; give each load but the first its time, as in Control::MeanPressure(1e6).after(1.0)"),
        (refused(contact().relaxation([branch]).law(law()).treatment(Treatment::Dmt), [Control::MeanPressure(1e6).after(0.0)]), "Contact::treatment, treatment: Treatment::Dmt on a viscoelastic solid is not in this version; take Treatment::Full, or leave Contact::relaxation out"),
        (refused(contact().hardness(1e5), pressure()), "Contact::hardness, hardness: the path has a mean pressure of 1 MPa, which no contact of this hardness can carry; stay below it"),
        (refused(contact().hardness(1e8), [Control::MeanGap(1e-8)]), "take Control::Approach, or leave Contact::hardness out"),
        (refused(contact().hardness(1e8).law(LennardJones::new(0.01, 1e-8)), pressure()), "take MaugisDugdale or Exponential, or leave Contact::hardness out"),
        (refused(contact().hardness(1e8).law(law()).treatment(Treatment::Dmt), pressure()), "a hardness with Treatment::Dmt is not in this version; take Treatment::Full"),
        (refused(contact().hardness(1e8).precision(Precision::Mixed), pressure()), "take Precision::Single, or Precision::Double, with Device::cpu() where the adapter has none"),
        (refused(contact().precision(Precision::Single).tolerance(1e-9), pressure()), "for Precision::Single; Precision::Mixed and Precision::Double go below"),
        (refused(contact().tolerance(0.5), pressure()), "Contact::tolerance, tolerance: 0.5 is out of range; it must be above 0 and at most 0.1"),
        (refused(contact().max_iterations(0), pressure()), "Contact::max_iterations, max_iterations: 0 is out of range"),
        (refused(contact().spring(1.0), pressure()), "Contact::spring, spring: a spring needs a prescribed far end; take Control::Approach, or leave Contact::spring out"),
        (refused(contact().spring(1.0).law(law()).treatment(Treatment::Dmt), [Control::Approach(0.0)]), "a spring with Treatment::Dmt is not in this version; take Treatment::Full, or leave Contact::spring out"),
        (refused(contact().pull_off_tolerance(0.7), pressure()), "Contact::pull_off_tolerance, pull_off_tolerance: 0.7 is out of range"),
        (refused(contact().law(law().taper(1e-6)), pressure()), "Contact::law, taper: 1 µm is more than twice the range of 10 nm; take at most that, or no taper of your own"),
        (refused(contact().law(MaugisDugdale::new(-1.0, 1e-9)), pressure()), "Contact::law, work_of_adhesion: -1.0 is out of range"),
        (refused(contact().law(law()).capillary(CapillaryScene::water(0.5)), pressure()), "Contact::capillary, capillary: the liquid is the attraction, and Contact::law is given too"),
        (refused(contact().capillary(CapillaryScene::water(1.5)), pressure()), "Contact::capillary, humidity: 1.5 is out of range"),
        (refused(contact().treatment(Treatment::Dmt), pressure()), "Contact::treatment, treatment: is of a law, and there is none; give Contact::law, or leave this out"),
        (refused(contact().law(LennardJones::new(0.01, 1e-8)).rate(1e-6, 0.5), pressure()), "Contact::rate, rate: multiplies the tension of a receding edge, and with LennardJones also the repulsion; take another law"),
        (refused(contact().law(law()).treatment(Treatment::Dmt).rate(1e-6, 0.5), pressure()), "a rate with Treatment::Dmt is not in this version; take Treatment::Full, or leave Contact::rate out"),
        (refused(contact().law(law()).rate(1e-6, 0.5), pressure()), "rate-dependent adhesion needs durations; give each load but the first its time"),
        (refused(contact().law(law()).adhesion_map(pattern(0.0, 0.0, 0.5e-6)), pressure()), "Contact::adhesion_map, high: is 0 like low, so nothing attracts; leave Contact::law out, or give a factor above 0"),
        (refused(contact().law(law()).adhesion_map(pattern(0.5, 1.0, 0.3e-6)), pressure()), "Contact::adhesion_map, period: does not divide the size of the periodic cell"),
        (refused(contact().law(LennardJones::new(0.01, 1e-8)).adhesion_map(pattern(0.0, 1.0, 0.5e-6)), pressure()), "must be above 0: with LennardJones the factor also multiplies the repulsion"),
        (refused(contact().law(law()).adhesion_map(AdhesionMap::Factors(GridValues::new([1.0], [1, 1]))), pressure()), "map of adhesion array: an array of 1 numbers for 1 x 1 points"),
        (refused(contact().law(law()).adhesion_map(AdhesionMap::Factors(GridValues::new(vec![-1.0; 32 * 24], POINTS))), pressure()), "it must be finite and at least 0"),
        (refused(contact().law(LennardJones::new(0.01, 1e-8)).adhesion_map(AdhesionMap::Factors(GridValues::new(vec![0.0; 32 * 24], POINTS))), pressure()), "it must be above 0: with LennardJones the factor also multiplies the repulsion"),
        (refused(contact().law(LennardJones::new(0.01, 1e-8)), [Control::MeanGap(-2e-8)]), "a mean gap must stay above -10 nm"),
        (refused(contact(), [Control::MeanGap(-1e-9)]), "Contact::path, 0: -1e-9 is out of range"),
        (refused(contact(), [Control::MeanPressure(1e6), Control::Force(1e-6)]), "the loads of a path prescribe one quantity, and this one another than the first; begin another path"),
        (refused(contact(), [Control::MeanPressure(1e6).after(-1.0)]), "Contact::path, duration: -1 is out of range; it must be a time in seconds, at least 0"),
        (refused(contact(), [Control::MeanPressure(1e6).after(1.0), Load::from(Control::MeanPressure(2e6))]), "Contact::path, duration: some loads have a time and others none; give each but the first its time, or none"),
        (refused(contact(), [Load::from(Control::MeanPressure(1e6)), Control::MeanPressure(2e6).after(1.0), Load::from(Control::MeanPressure(3e6))]), "some loads have a time and others none"),
        (refused(contact(), [Control::MeanPressure(f64::NAN)]), "Contact::path, 0: nan is out of range"),
        (refused(contact().friction(0.0), pressure()), "Contact::friction, shear_strength: 0.0 is out of range"),
        (refused(contact().wear(-1.0), pressure()), "Contact::wear, specific_wear_rate: -1.0 is out of range"),
        (refused(contact().leakage(-1e-3, Axis::X), pressure()), "Contact::leakage, viscosity: -0.001 is out of range"),
        (refused(affine(&|rough| rough.hurst = 2.0), pressure()), "Contact::from_parts, hurst: 2.0 is out of range"),
        (refused(affine(&|rough| rough.shortest = 1.0), pressure()), "wavelengths must be ordered shortest < rolloff <= longest"),
        (refused(part(SurfacePart::Wavy { amplitude: 1e-9, wavelength: [0.3e-6, f64::INFINITY] }), pressure()), "does not divide the periodic size 2 µm; the nearest that does is"),
        (refused(part(SurfacePart::Wavy { amplitude: 1e-9, wavelength: [f64::INFINITY; 2] }), pressure()), "give a finite one, or take SurfacePart::Flat"),
        (refused(part(tabor::scene::HeightFileScene::new("nowhere.npy").into()), pressure()), "there is no such file; a relative path is taken from the current folder"),
    ];
    let unexpected: Vec<String> = mistakes
        .iter()
        .filter(|(message, expected)| !message.contains(expected))
        .map(|(message, expected)| format!("{message}\nand not {expected}"))
        .collect();
    assert!(unexpected.is_empty(), "{}", unexpected.join("\n"));
    for (message, _) in &mistakes {
        for toml in [" = \"", "[[", "[adhesion]", "[solid]", "[loading]", "[grid]", "[solver]", "--"] {
            assert!(!message.contains(toml), "{message}\nspeaks of {toml}");
        }
    }
}

fn all_mistakes_are_told_at_once_and_typed() {
    let wrong = contact()
        .contact_modulus(-1.0)
        .friction(-1.0)
        .tolerance(2.0);
    let Err(ContactError::Mistakes(mistakes)) = wrong.solve(Control::MeanPressure(1e6)) else {
        panic!("no mistakes");
    };
    let mut keys: Vec<&str> = mistakes.0.iter().map(|one| one.key.as_str()).collect();
    keys.sort_unstable();
    assert_eq!(
        keys,
        [
            "friction.shear_strength",
            "solid.contact_modulus",
            "solver.tolerance"
        ]
    );
    assert_eq!(mistakes.to_string().lines().count(), 3);
}

fn laws_by_their_tension_are_those_of_scenes() {
    for (law, name) in [
        (
            AdhesionScene::from(MaugisDugdale::from_peak_tension(0.01, 1e6)),
            "maugis-dugdale",
        ),
        (
            LennardJones::from_peak_tension(0.01, 1e6).into(),
            "lennard-jones",
        ),
        (
            Exponential::from_peak_tension(0.01, 1e6).into(),
            "exponential",
        ),
    ] {
        let text = format!(
            "{ROUGH}[solid]\ncontact_modulus = 1e6\n[adhesion]\nlaw = \"{name}\"\nwork_of_adhesion = 0.01\npeak_tension = 1e6\n[loading]\ncontrol = \"pressure\"\npath = [1.0]\n"
        );
        let scene = Scene::parse(&text, "scene.toml", Path::new("."), &[]).expect("a scene");
        assert_eq!(scene.adhesion, Some(law));
    }
}

/// A graphics processor is asked for and may not be there: then the way out is named.
fn devices_are_chosen_or_refused_in_words() {
    match contact()
        .device(Device::gpu())
        .solve(Control::MeanPressure(1e6))
    {
        Ok(solution) => assert!(solution.converged),
        Err(ContactError::Device(error)) => {
            assert!(
                error.to_string().ends_with("Device::cpu() does without"),
                "{error}"
            );
        }
        Err(other) => panic!("{other}"),
    }
    let odd = Contact::new([0.0; 33], [11, 3], [1e-6, 1e-6]).contact_modulus(1e9);
    let odd = odd.device(Device::gpu());
    let error = odd
        .solve(Control::MeanPressure(1e6))
        .expect_err("no transform");
    let said = error.to_string();
    assert!(said.contains("have no transform on the GPU"), "{said}");
    assert!(said.ends_with("or Device::cpu()"), "{said}");
}

tests![
    contacts_in_rust_and_scenes_on_the_command_line_give_the_same_bits,
    scenes_from_files_are_contacts_too,
    arrays_have_the_shape_and_order_that_are_promised,
    paths_are_solved_as_they_are_asked_for,
    a_path_has_the_loads_it_is_given_and_their_pull_off,
    a_path_that_has_ended_says_what_it_does_not_show,
    one_load_of_a_scene_takes_nothing_of_its_path,
    a_watcher_ends_a_solve,
    parted_surfaces_leave_whole_arrays,
    threads_change_no_bit,
    runs_of_the_library_are_resumed_refused_and_quiet_about_pictures,
    mistakes_name_the_method_and_no_line_of_a_scene,
    all_mistakes_are_told_at_once_and_typed,
    laws_by_their_tension_are_those_of_scenes,
    devices_are_chosen_or_refused_in_words,
];
