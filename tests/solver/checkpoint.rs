//! A checkpoint is enough: a path that is cut after any step, put through the file of its state and
//! resumed on a fresh backend, gives the same rows to the bit. For every control, law,
//! treatment and boundary, in double and single precision, and on the graphics processor.

use std::borrow::Cow;
use std::path::Path;

use tabor::backend::{Backend, Shape, cpu, gpu::GpuBackend};
use tabor::kernel::Scalars;
use tabor::output::SavedState;
use tabor::scene::Scene;
use tabor::study::{
    Checkpoint, Earlier, FinishedStep, Observer, Search, Setup, StepRow, WalkEnd, walk, walk_on,
};
use tabor::surface::Surface;

use crate::shared::device::device;
use crate::shared::trials::{is_long, tests};

const ROUGH: &str = "[[surface]]\nkind = \"self-affine\"\nhurst = 0.8\nrms_slope = 0.1\nlongest = \"2 um\"\nrolloff = \"1 um\"\nshortest = \"0.25 um\"\n";
const SPHERE: &str = "[[surface]]\nkind = \"sphere\"\nradius = \"5 um\"\n";

/// Laws by name, each with the table of its adhesion.
fn adhesion(law: &str, treatment: &str) -> String {
    format!(
        "[adhesion]\nlaw = \"{law}\"\nwork_of_adhesion = \"10 mJ/m^2\"\nrange = \"10 nm\"\ntreatment = \"{treatment}\"\n"
    )
}

fn scene(boundary: &str, surface: &str, adhesion: &str, loading: &str, single: bool) -> Scene {
    let tolerance = if single { "precision = \"single\"" } else { "" };
    let text = format!(
        "[grid]\npoints = 32\nsize = \"2 um\"\nboundary = \"{boundary}\"\n[solid]\ncontact_modulus = \"50 MPa\"\n{surface}{adhesion}[loading]\n{loading}\n[solver]\n{tolerance}\n"
    );
    Scene::parse(&text, "scene.toml", Path::new("."), &[]).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// Paths that press, turn, part (where a load can) and come back.
const LOADINGS: [(&str, &str); 5] = [
    (
        "periodic",
        "control = \"pressure\"\npath = [2e5, 1e6, 2e5, 0, -5e6, 2e5, 1e6]",
    ),
    (
        "periodic",
        "control = \"mean-gap\"\npath = [\"90 nm\", \"50 nm\", \"30 nm\", \"60 nm\", \"90 nm\"]",
    ),
    (
        "periodic",
        "control = \"approach\"\npath = [\"-20 nm\", \"10 nm\", \"30 nm\", \"-20 nm\"]",
    ),
    (
        "free",
        "control = \"force\"\npath = [1e-7, 1e-6, 0, -1e-4, 1e-7]",
    ),
    (
        "free",
        "control = \"approach\"\npath = [\"-15 nm\", \"-5 nm\", \"20 nm\", \"-10 nm\", \"-15 nm\"]",
    ),
];

type Make<'a> = &'a dyn Fn() -> Box<dyn Backend + Send>;

/// Keeps the checkpoint of each step, as its file gives it back.
#[derive(Default)]
struct Cutter {
    single: bool,
    states: Vec<Checkpoint>,
}

impl Observer for Cutter {
    type Error = std::convert::Infallible;

    fn step(&mut self, _: FinishedStep) -> Result<(), Self::Error> {
        Ok(())
    }

    fn iteration(&mut self, _: usize, _: &Scalars) -> bool {
        true
    }

    fn wants_checkpoint(&self) -> bool {
        true
    }

    fn checkpoint(&mut self, step: usize, state: &Checkpoint) -> Result<(), Self::Error> {
        let place = tempfile::tempdir().expect("a temporary folder");
        let path = place.path().join("state.bin");
        let saved = SavedState {
            scene: String::new(),
            solver: serde_json::Value::Null,
            machine: String::new(),
            finished: step,
            curve: 0,
            warnings: Vec::new(),
            single: self.single,
            checkpoint: Cow::Borrowed(state),
        };
        saved.write(&path).expect("it is written");
        let read = SavedState::read(&path)
            .expect("it is read")
            .expect("it is there");
        self.states.push(read.checkpoint.into_owned());
        Ok(())
    }
}

/// Rows without their seconds, bit by bit.
fn bits(rows: &[StepRow]) -> Vec<String> {
    let plain = |row: &StepRow| {
        let mut row = row.clone();
        row.seconds = 0.0;
        row
    };
    // Debug prints numbers so that they read back to the same bits.
    rows.iter().map(|row| format!("{:?}", plain(row))).collect()
}

fn expect_same(one: &WalkEnd, other: &WalkEnd, what: &str) {
    assert_eq!(bits(&one.rows), bits(&other.rows), "{what}");
    assert_eq!(one.jump_in_steps, other.jump_in_steps, "{what}");
    assert_eq!(one.jump_off_steps, other.jump_off_steps, "{what}");
    assert_eq!(one.pull_off, other.pull_off, "{what}");
    assert_eq!(one.transforms, other.transforms, "{what}");
    assert_eq!(
        one.hysteresis_energy.map(f64::to_bits),
        other.hysteresis_energy.map(f64::to_bits),
        "{what}"
    );
}

/// Every so many steps of a path are cuts, from the first one on.
#[derive(Clone, Copy)]
struct Cuts {
    first: usize,
    stride: usize,
}

impl Cuts {
    const ALL: Cuts = Cuts {
        first: 0,
        stride: 1,
    };
}

/// Walks a scene whole and from each of its cuts; returns the steps that parted or jumped.
fn cut(scene: Scene, make: Make, single: bool, cuts: Cuts, what: &str) -> usize {
    // What such a solid remembers is known in double precision.
    let remembers = scene.solid.remembers();
    let surface = Surface::build(&scene).expect("a surface");
    let setup = Setup::new(scene, surface);
    let mut cutter = Cutter {
        single: single && !remembers,
        ..Cutter::default()
    };
    let whole = walk(&setup, make, &mut ()).expect("it is solved");
    let kept = walk_on(&setup, make, &mut cutter, Earlier::default()).expect("it is solved");
    expect_same(&whole, &kept, what);
    let converged = whole.rows.iter().filter(|row| row.converged).count();
    assert_eq!(cutter.states.len(), converged, "{what}");
    assert!(converged > 2, "{what}: only {converged} steps converge");
    let states = cutter.states.into_iter().enumerate();
    for (index, state) in states.skip(cuts.first).step_by(cuts.stride) {
        let earlier = Earlier {
            rows: whole.rows[..=index].to_vec(),
            checkpoint: state,
        };
        let on = walk_on(&setup, make, &mut (), earlier).expect("it is solved");
        expect_same(
            &whole,
            &on,
            &format!("{what}, cut after step {}", index + 1),
        );
    }
    let parted = whole
        .rows
        .iter()
        .filter(|row| row.approach.is_none())
        .count();
    parted + whole.jump_in_steps.len() + whole.jump_off_steps.len()
}

/// All combinations that a scene may ask for; returns how many. Each is cut at every so many of its steps, the
/// next at the steps after those, so that a path is cut at each of its steps under one law or another;
/// `TABOR_LONG=1` cuts every path at each.
fn all(make: Make, single: bool, few: bool, stride: usize) -> usize {
    let stride = if is_long() { 1 } else { stride };
    let cuts = |count: usize| Cuts {
        first: count % stride,
        stride,
    };
    let laws = [
        String::new(),
        adhesion("maugis-dugdale", "full"),
        adhesion("exponential", "full"),
        adhesion("lennard-jones", "full"),
        adhesion("maugis-dugdale", "dmt"),
        adhesion("exponential", "dmt"),
        adhesion("lennard-jones", "dmt"),
    ];
    let (mut events, mut count) = (0, 0);
    for (index, (boundary, loading)) in LOADINGS.into_iter().enumerate() {
        for (other, law) in laws.iter().enumerate() {
            // A backend takes long to make on a slow device: each loading with one law.
            if few && other != index {
                continue;
            }
            let surface = if boundary == "free" { SPHERE } else { ROUGH };
            let what = format!("{loading} {law}");
            let scene = scene(boundary, surface, law, loading, single);
            events += cut(scene, make, single, cuts(count), &what);
            count += 1;
        }
    }
    // A spring, which holds the mean displacement, on both boundaries.
    let spring = "control = \"approach\"\nspring = \"2 N/m\"\npath = [\"-15 nm\", \"5 nm\", \"30 nm\", \"-15 nm\"]";
    for (boundary, surface) in [("free", SPHERE), ("periodic", ROUGH)] {
        let law = adhesion("maugis-dugdale", "full");
        let scene = scene(boundary, surface, &law, spring, single);
        events += cut(
            scene,
            make,
            single,
            cuts(count),
            &format!("spring, {boundary}"),
        );
        count += 1;
    }
    // A solid with a hardness, whose plastic depth is in the checkpoint; mixed precision does not know it.
    let corrects = make().in_double(Shape::whole(4, 4)).is_some();
    for (index, (boundary, loading)) in LOADINGS.into_iter().enumerate() {
        if corrects || loading.contains("mean-gap") || (few && index != 0) {
            continue;
        }
        let surface = if boundary == "free" { SPHERE } else { ROUGH };
        for law in [String::new(), adhesion("maugis-dugdale", "full")] {
            let mut scene = scene(boundary, surface, &law, loading, single);
            scene.solid.hardness = Some(3e6);
            events += cut(
                scene,
                make,
                single,
                cuts(count),
                &format!("hardness, {loading} {law}"),
            );
            count += 1;
        }
    }
    assert!(
        events > if few { 1 } else { 5 },
        "the paths part and jump, {events} times"
    );
    count
}

fn resume_in_double_precision() {
    let make = || cpu::double(None);
    assert_eq!(all(&make, false, false, 2), 45);
}

fn resume_in_single_precision() {
    let make = || cpu::single(None);
    assert_eq!(all(&make, true, false, 3), 45);
}

/// The state is kept in double precision, and iterations in single start from it.
fn resume_in_mixed_precision() {
    let make = mixed();
    assert_eq!(all(&make, false, false, 3), 37);
}

fn mixed() -> impl Fn() -> Box<dyn Backend + Send> {
    || cpu::mixed(None)
}

fn resume_on_the_graphics_processor() {
    let device = device();
    let make = || -> Box<dyn Backend + Send> { Box::new(GpuBackend::on(device)) };
    assert_eq!(all(&make, true, true, 4), 9);
}

/// The cold start on coarser grids, which small grids do without.
fn resume_with_a_coarse_start() {
    let loading = "control = \"pressure\"\npath = [2e5, 1e6, 0, 2e5]";
    let mut scene = scene("periodic", ROUGH, "", loading, false);
    scene.grid.points = Some([128, 128]);
    let make = || cpu::double(None);
    cut(scene, &make, false, Cuts::ALL, "coarse start");
}

/// A number of a step.
type Of = fn(&StepRow) -> f64;
/// The same with its name.
type Column = (&'static str, Of);

/// What a scene is overridden with to walk its ramps of twenty steps and more in half as many.
fn half_as_many_steps(text: &str) -> Vec<(String, String)> {
    let loading = text.split("\n[output]").next().unwrap_or(text);
    let steps = loading.lines().filter_map(|line| {
        let count = line.strip_prefix("steps = ")?;
        Some(count.split_whitespace().next()?.parse::<usize>().ok())
    });
    let mut set: Vec<_> = steps
        .enumerate()
        .filter_map(|(ramp, count)| Some((ramp, count.filter(|count| *count >= 20)?)))
        .map(|(ramp, count)| {
            (
                format!("loading.ramp.{ramp}.steps"),
                (count / 2).to_string(),
            )
        })
        .collect();
    if !set.is_empty() {
        // Its pictures are of steps that there may no longer be.
        set.push(("output.steps".to_owned(), "\"last\"".to_owned()));
    }
    set
}

/// Every shipped scene, and with them every effect: mixed precision walks the path that double does.
/// Both stop at a residual of 1e-9, so what they find differs by some 1e-9 of the largest on the path
/// where a state is stable; near a jump the softest mode may be a thousand times as soft.
/// Long ramps are walked in half their steps, with `TABOR_LONG=1` in all.
fn mixed_precision_walks_the_path_of_double() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/scenes");
    let double = || cpu::double(None);
    let mixed = mixed();
    let (mut compared, mut failures) = (0, Vec::new());
    let mut paths: Vec<_> = std::fs::read_dir(folder)
        .expect("the scenes are there")
        .flatten()
        .map(|entry| entry.path())
        .filter(|path| {
            path.extension()
                .is_some_and(|extension| extension == "toml")
        })
        .collect();
    paths.sort();
    for path in paths {
        let text = std::fs::read_to_string(&path).expect("a scene");
        let mut set = vec![("solver.tolerance".to_owned(), "1e-9".to_owned())];
        if !text.contains("kind = \"file\"") {
            set.push(("grid.points".to_owned(), "48".to_owned()));
        }
        if !is_long() {
            set.extend(half_as_many_steps(&text));
        }
        let scene = Scene::read(&path, &set).unwrap_or_else(|errors| panic!("{errors}"));
        if scene.solid.hardness.is_some() {
            // Refused in mixed precision.
            continue;
        }
        // Speed and law agree to 2e-3, so where in that a step ends is a matter of rounding.
        let rated = scene.adhesion.as_ref().is_some_and(|a| a.rate.is_some());
        let allowed = if rated { 2e-3 } else { 1e-6 };
        let surface = Surface::build(&scene).expect("a surface");
        let setup = Setup::new(scene, surface);
        let one = walk(&setup, &mixed, &mut ()).expect("it is solved");
        let other = walk(&setup, &double, &mut ()).expect("it is solved");
        let name = path.display();
        // Beyond this pixels trap the edge of a contact, and there are many answers.
        let freed = setup
            .regime
            .as_ref()
            .is_none_or(|regime| regime.chi <= 0.65);
        assert_eq!(one.rows.len(), other.rows.len(), "{name}");
        let largest = |of: Of| {
            let sizes = other.rows.iter().map(|row| of(row).abs());
            sizes.fold(f64::MIN_POSITIVE, f64::max)
        };
        let columns: [Column; 4] = [
            ("force", |row| row.force),
            ("mean gap", |row| row.mean_gap.unwrap_or(0.0)),
            ("elastic energy", |row| row.elastic_energy),
            ("contact", |row| row.contact_area_fraction),
        ];
        let mut worst = [0.0f64; 4];
        for (one, other) in one.rows.iter().zip(&other.rows) {
            if one.converged != other.converged || (freed && one.state != other.state) {
                failures.push(format!("{name}: {one:?} and in double {other:?}"));
            }
            for ((_, of), worst) in columns.iter().zip(&mut worst) {
                *worst = worst.max((of(one) - of(other)).abs() / largest(*of));
            }
        }
        let iterations = |end: &WalkEnd| end.rows.iter().map(|row| row.iterations).sum::<usize>();
        println!(
            "{name}: {}, iterations {} ({} in double)",
            worst.map(|error| format!("{error:.1e}")).join(" "),
            iterations(&one),
            iterations(&other)
        );
        for ((column, _), worst) in columns.iter().zip(worst) {
            if freed && worst > allowed {
                failures.push(format!("{name}: {column} off by {worst:e}"));
            }
        }
        compared += usize::from(freed);
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    assert!(
        compared >= 8,
        "only {compared} scenes have one answer on this grid"
    );
}

/// An edge that costs more at speed, found from the state before each step; and what its contact
/// conducts.
fn resume_with_rate_dependent_adhesion() {
    let law = format!(
        "{}rate = {{ reference_speed = \"1 um/s\", exponent = 0.5 }}\n[conductance]\nconductivity = 1\ncounter_conductivity = 2\n",
        adhesion("maugis-dugdale", "full")
    );
    let loading = "control = \"approach\"\nstart = \"20 nm\"\n[[loading.ramp]]\nto = \"-20 nm\"\nsteps = 5\nduration = 0.1\n[[loading.ramp]]\nto = \"10 nm\"\nsteps = 2\nduration = 1";
    let make = || cpu::double(None);
    let scene = scene("free", SPHERE, &law, loading, false);
    cut(scene, &make, false, Cuts::ALL, "rate");
}

/// A solid that relaxes, over steps that grow with the time from each kink of the path.
fn resume_with_automatic_time_steps() {
    let relaxes = "[[solid.relaxation]]\nmodulus = \"200 MPa\"\ntime = 1\n[[solid.relaxation]]\nmodulus = \"50 MPa\"\ntime = 0.05\n";
    let loading = "control = \"force\"\nstart = 1e-7\ntime_tolerance = 0.03\n[[loading.ramp]]\nto = 1e-6\nsteps = \"auto\"\nduration = 0.5\n[[loading.ramp]]\nhold = 5\nsteps = \"auto\"";
    let make = || cpu::double(None);
    let scene = scene("free", &format!("{relaxes}{SPHERE}"), "", loading, false);
    let durations = scene.loading.durations.clone().expect("it is timed");
    let longest = durations.iter().copied().fold(0.0, f64::max);
    assert!(longest > 8.0 * durations[1], "they grow: {durations:?}");
    cut(scene, &make, false, Cuts::ALL, "growing steps");
}

/// Ends a path in its n-th search between two steps, with the rows and the state of the steps before it.
#[derive(Default)]
struct Stopper {
    at: usize,
    searches: usize,
    rows: Vec<StepRow>,
    state: Checkpoint,
}

impl Observer for Stopper {
    type Error = std::convert::Infallible;

    fn step(&mut self, step: FinishedStep) -> Result<(), Self::Error> {
        self.rows.push(step.row.clone());
        Ok(())
    }

    fn iteration(&mut self, _: usize, _: &Scalars) -> bool {
        self.searches < self.at
    }

    fn search(&mut self, _: usize, _: Search) {
        self.searches += 1;
    }

    fn wants_checkpoint(&self) -> bool {
        true
    }

    fn checkpoint(&mut self, _: usize, state: &Checkpoint) -> Result<(), Self::Error> {
        self.state = state.clone();
        Ok(())
    }
}

/// A path ended amid what is looked for between two of its steps, pull-off or a jump, goes on from the step
/// before and ends the same, whatever the solid remembers.
fn resume_after_an_end_between_two_steps() {
    let make = || cpu::double(None);
    let law = adhesion("maugis-dugdale", "full");
    let rated = format!("{law}rate = {{ reference_speed = \"1 um/s\", exponent = 0.5 }}\n");
    let relaxing = "[[solid.relaxation]]\nmodulus = \"50 MPa\"\ntime = 1.0\n";
    let hard = "[solid]\ncontact_modulus = \"50 MPa\"\nhardness = \"20 MPa\"\n";
    let pulled = "control = \"force\"\npath = [1e-6, 0, -1e-4, 1e-7, -5e-5]";
    let timed = "control = \"force\"\nstart = 1e-6\n[[loading.ramp]]\nto = -1e-4\nsteps = 4\nduration = 1\n[[loading.ramp]]\nto = 1e-7\nsteps = 1\nduration = 2\n";
    let held = "control = \"approach\"\npath = [\"-20 nm\", \"10 nm\", \"-15 nm\", \"-40 nm\", \"-60 nm\"]";
    for (name, solid, law, loading) in [
        ("elastic", "", law.as_str(), pulled),
        ("held", "", law.as_str(), held),
        ("hard", hard, law.as_str(), pulled),
        ("relaxing", relaxing, law.as_str(), timed),
        ("rated", "", rated.as_str(), timed),
    ] {
        let surface = match solid.starts_with("[solid]") {
            true => SPHERE.to_owned(),
            false => format!("{solid}{SPHERE}"),
        };
        let text = format!(
            "[grid]\npoints = 32\nsize = \"2 um\"\nboundary = \"free\"\n{}{surface}{law}[loading]\n{loading}\n",
            match solid.starts_with("[solid]") {
                true => solid,
                false => "[solid]\ncontact_modulus = \"50 MPa\"\n",
            }
        );
        let scene = Scene::parse(&text, "scene.toml", Path::new("."), &[])
            .unwrap_or_else(|e| panic!("{e}\n{text}"));
        let surface = Surface::build(&scene).expect("a surface");
        let setup = Setup::new(scene, surface);
        let mut count = Stopper {
            at: usize::MAX,
            ..Stopper::default()
        };
        let whole = walk(&setup, &make, &mut count).expect("it is solved");
        assert!(
            !whole.interrupted && count.searches > 0,
            "{name}: nothing is looked for"
        );
        for at in (1..=count.searches).step_by(3) {
            let mut stopper = Stopper {
                at,
                ..Stopper::default()
            };
            let cut = walk(&setup, &make, &mut stopper).expect("it is solved");
            assert!(cut.interrupted, "{name}: search {at}");
            assert!(cut.rows.len() < whole.rows.len(), "{name}: search {at}");
            let earlier = Earlier {
                rows: stopper.rows,
                checkpoint: stopper.state,
            };
            let on = walk_on(&setup, &make, &mut (), earlier).expect("it is solved");
            expect_same(&whole, &on, &format!("{name}, ended in search {at}"));
        }
        println!("{name}: {} searches, {:?}", count.searches, whole.pull_off);
    }
}

tests![
    resume_in_double_precision,
    resume_in_single_precision,
    resume_in_mixed_precision,
    resume_on_the_graphics_processor,
    resume_with_a_coarse_start,
    mixed_precision_walks_the_path_of_double,
    resume_with_rate_dependent_adhesion,
    resume_with_automatic_time_steps,
    resume_after_an_end_between_two_steps,
];
