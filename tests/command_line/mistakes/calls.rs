//! Bad calls: of the binary, as a user types them, and of the library for what no scene can say
//! because the scene's own reader refuses it before.

use std::fs;
use std::path::Path;
use std::process::{Output, Stdio};

use tabor::backend::gpu::{adapters, quietly};
use tabor::grid::Grid;
use tabor::output::{Load, Picture, write_picture};
use tabor::scene::{
    AdhesionMap, Boundary, Control, Detrend, FieldName, Fill, GridScene, GridValues,
    HeightFileScene, Roughness, Scene, SelfAffineScene, SurfacePart,
};
use tabor::surface::{Surface, fit::fit};
use tabor::theory::roots::root;

use super::Reached;
use crate::shared::binary;

/// A small scene that is right.
pub const GOOD: &str = r#"[grid]
points = 16
size = "1 um"
[solid]
contact_modulus = "1 GPa"
[[surface]]
kind = "sphere"
radius = "1 um"
[loading]
control = "pressure"
path = ["1 MPa", "2 MPa"]
"#;

/// Runs the binary in a folder, with variables of the environment.
pub fn tabor(folder: &Path, arguments: &[&str], environment: &[(&str, &str)]) -> Output {
    binary::command(folder, arguments)
        .env_remove("TABOR_MEMORY")
        .envs(environment.iter().copied())
        .output()
        .expect("the binary runs")
}

/// The one line on standard error, which must hold `expected`; nothing on standard output.
pub fn one_line(output: &Output, status: i32, expected: &str) -> String {
    let message = binary::errors(output);
    assert_eq!(output.status.code(), Some(status), "{message}");
    assert!(output.stdout.is_empty(), "standard output stays clean");
    let lines: Vec<&str> = message
        .lines()
        .filter(|line| line.starts_with("error: "))
        .collect();
    assert!(
        lines.len() == 1 && lines[0].contains(expected),
        "{message}\nand not {expected}"
    );
    lines[0].to_owned()
}

struct BadCall {
    arguments: &'static [&'static str],
    environment: &'static [(&'static str, &'static str)],
    status: i32,
    variant: &'static str,
    expected: &'static str,
}

#[rustfmt::skip] // one call a line
const CALLS: &[BadCall] = &[
    call(&["check", "absent.toml"], "SceneError::Unreadable", "absent.toml: cannot be read: "),
    call(&["run", "."], "SceneError::Unreadable", ".: cannot be read: "),
    call(&["check", "latin.toml"], "SceneError::Unreadable", "latin.toml: cannot be read: it is not UTF-8 text"),
    call(&["check", "broken.toml"], "SceneError::Syntax", "broken.toml:3: not valid TOML: "),
    call(&["check", "good.toml", "--set", "grid.points=[64"], "SceneError::Syntax", "from --set: grid.points: not valid TOML: "),
    call(&["check", "good.toml", "--set", "grid..points=1"], "SceneError::Override", "not a key; write it with dots between the names"),
    call(&["check", "good.toml", "--set", "adhesion.range=1"], "SceneError::Override", "the scene has no [adhesion]; add the table to the file first"),
    call(&["check", "good.toml", "--set", "surface.1.radius=1"], "SceneError::Override", "there is no surface.1: surface has one entry, surface.0"),
    call(&["check", "good.toml", "--set", "surface.first.radius=1"], "SceneError::Override", "a number from 0 must follow it"),
    call(&["check", "good.toml", "--set", "grid.size=1,5 um"], "UnitError::DecimalComma", "\"1,5 um\" has a decimal comma; write a point, as in \"25 um\""),
    call(&["check", "good.toml", "--set", "grid.size='1e999 um'"], "UnitError::NotFinite", "\"1e999 um\" is too large; give a length in m"),
    call(&["check", "good.toml", "--set", "grid.size=wide"], "UnitError::NoNumber", "\"wide\" does not begin with a number; give a length in m"),
    call(&["check", "good.toml", "--set", "grid.size='3'"], "UnitError::NoUnit", "\"3\" has no unit; give a length in m"),
    call(&["check", "good.toml", "--set", "grid.size=3 kg"], "UnitError::UnknownUnit", "\"kg\" is not a unit that is known here; give a length in m"),
    call(&["check", "good.toml", "--set", "loading.path.1=3 um"], "UnitError::WrongUnit", "\"um\" is a length in m; give a pressure in Pa"),
    call(&["fit", "curve.txt", "--spring-error", "10"], "UnitError::NoShare", "\"10\" must be a share, such as 0.1 or 10%"),
    call(&["check", "good.toml", "--set", "grid.points=9223372036854775807"], "SceneError::OutOfRange", "9223372036854775807 is out of range; it must be a whole number from 1 to 262144"),
    call(&["check", "good.toml", "--set", "grid.size=1e300"], "SceneError::OutOfRange", "grid.size: 1e300 is out of range; it must be 0 or between 1e-30 and 1e30 in SI units; check the powers of ten"),
    call(&["check", "good.toml", "--set", "surface.0.radius=1e-300"], "SceneError::OutOfRange", "surface.0.radius: 1e-300 is out of range; it must be 0 or between 1e-30 and 1e30"),
    call(&["check", "good.toml", "--set", "loading.path.0='1e35 Pa'"], "SceneError::OutOfRange", "loading.path.0: \"1e35 Pa\" is out of range; it must be 0 or between"),
    call(&["check", "good.toml", "--set", "adhesion={law='exponential', range=1e-25, peak_tension=1e-20}"], "SceneError::Conflict", "makes the third number of the law 1e-45; check the powers of ten"),
    call(&["check", "good.toml", "--set", "solid.young_modulus=1 GPa"], "SceneError::Conflict", "solid.young_modulus: contact_modulus is given too"),
    call(&["check", "good.toml", "--set", "grid.pionts=3"], "SceneError::UnknownKey", "grid.pionts: unknown key in [grid]; did you mean `points`?"),
    call(&["check", "good.toml", "--set", "plastic={}"], "SceneError::NotInThisVersion", "plastic: plasticity is not in this version"),
    call(&["check", "good.toml", "--set", "grid.points=262144"], "SurfaceError::Points", "[grid] points = [262144, 262144] is not possible: both must be at least 1 and their product at most 17179869184"),
    call(&["run", "good.toml", "--set", "grid.points=262144"], "SurfaceError::Points", "[grid] points = [262144, 262144] is not possible"),
    call(&["check", "short_waves.toml"], "PartError::WavesTooShort", "wavelength = 1e-7 m along x is shorter than two pixels of 6.25e-8 m; take more points"),
    call(&["check", "empty_band.toml"], "PartError::BandEmpty", "no wave of the grid lies between longest = 1.3e-7 m and shortest = 1.285e-7 m; widen the band"),
    call(&["check", "long_band.toml"], "PartError::BandTooLong", "waves across the grid, more than can be summed; take at least 3.052e-11 m"),
    call(&["check", "unheld_band.toml"], "PartError::BandNotHeld", "the grid resolves no wave of the band: pixels of 6.25e-8 x 6.25e-8 m against longest = 1e-7 m; take more points"),
    call(&["check", "sizeless.toml"], "SurfaceError::SizeMissing", "[grid] size is missing, and no height file of this scene carries it; write size = \"10 um\""),
    call(&["run", "good.toml", "--out", "good.toml"], "OutputError::Refused", "good.toml"),
    call(&["run", "good.toml", "--out", "foreign"], "OutputError::Refused", "foreign"),
    call(&["compare", "good.toml"], "CompareError::Unsuited", "[[surface]] 1 is a sphere: the models of compare need a nominally flat rough surface"),
    call(&["accuracy", "good.toml", "--set", "grid.points=8"], "AccuracyError::TooCoarse", "grid.points: 8 x 8 points leave no coarser grid to compare with; take at least 16 a side"),
    call(&["accuracy", "good.toml", "--set", "grid.points=8"], "Failure::Accuracy", "grid.points: 8 x 8 points"),
    call(&["accuracy", "good.toml", "--out", "hasty", "--budget", "1 us"], "AccuracyError::NoReference", "no reference was solved: would take about "),
    call(&["accuracy", "good.toml", "--out", "good.toml"], "AccuracyError::Output", "good.toml/accuracy.csv: its folder is a file; name a folder with --out"),
    call(&["accuracy", "map.toml", "--set", "grid.boundary=free", "--set", "loading.control=force", "--set", "loading.path=[1e-6]"], "AccuracyError::OneGrid", "a height file on a free boundary belongs to one grid; accuracy needs the same surface on several: give the surface as shapes"),
    call(&["accuracy", "good.toml", "--set", "adhesion={law='exponential', work_of_adhesion=0.05, range='1 nm', map='w.npy'}"], "AccuracyError::OneGrid", "adhesion.map from a file belongs to one grid"),
    call(&["accuracy", "sizeless.toml"], "Failure::Surface", "sizeless.toml: [grid] size is missing"),
    call(&["sweep", "absent.toml"], "SweepError::Unreadable", "absent.toml: cannot be read: "),
    call(&["sweep", "good.toml"], "SweepError::Syntax", "good.toml: not a study: it is a scene, which `tabor run` solves"),
    call(&["run", "study.toml"], "SceneError::Conflict", "study.toml: this is a study of many runs, which `tabor sweep` solves"),
    call(&["sweep", "no_axis.toml"], "SweepError::NoAxis", "no_axis.toml: there is no [[axis]]; add one with a key of the scene"),
    call(&["sweep", "empty_axis.toml"], "SweepError::Axis", "empty_axis.toml: axis 1 (surface.0.radius): has no values"),
    call(&["sweep", "study.toml", "--set", "surface.0.radius=1e-6"], "SweepError::Twice", "study.toml: surface.0.radius is the key of an axis, and given once more with --set"),
    call(&["sweep", "study.toml", "--set", "surface.0.radius.unit=1"], "SweepError::Replaced", "study.toml: surface.0.radius.unit has no effect: surface.0.radius, the key of an axis, replaces all that it lies in"),
    call(&["sweep", "unknown_key.toml"], "SweepError::Scene", "unknown_key.toml: surface.0.radios=1: unknown key in a sphere [[surface]]; did you mean `radius`?"),
    call(&["sweep", "no_plot.toml"], "SweepError::Plot", "no_plot.toml: plot.y: pull is not a quantity of a run; these are: largest_contact_area_fraction, "),
    call(&["sweep", "no_case.toml"], "SweepError::Folders", "no_case.toml: folders: there is no case 3; the study has 2"),
    call(&["sweep", "too_many.toml"], "SweepError::TooMany", "too_many.toml: 4000000 cases are more than 1000000; take fewer values, or several studies"),
    call(&["sweep", "study.toml", "--out", "foreign"], "SweepError::Output", "foreign: holds files that tabor sweep did not write"),
    call(&["sweep", "study.toml", "--out", "good.toml"], "Failure::Sweep", "good.toml: is a file; name a folder"),
    BadCall { status: 3, ..call(&["sweep", "study.toml", "--quiet", "--out", "hard", "--set", "solver.max_iterations=1", "--set", "solver.tolerance=1e-12"], "Failure::FailedCases", "2 of 2 cases did not end well; hard/runs.csv has the reasons") },
    call(&["theory", "hertz", "--contact_modulus", "1 GPa", "--radius", "3 Pa"], "Failure::Usage", "--radius: \"Pa\" is a pressure in Pa; give a length in m"),
    call(&["theory", "herz"], "Failure::Usage", "there is no model \"herz\"; did you mean hertz?"),
    call(&["theory", "maugis-dugdale", "--radius", "1e-6", "--contact_modulus", "1e6", "--work_of_adhesion", "0.05", "--range", "1e-25"], "Failure::Theory", "is out of range: it must be between 1e-6 and 1e6"),
    call(&["theory", "maugis-dugdale", "--radius", "1e-6", "--contact_modulus", "1e6", "--work_of_adhesion", "0.05", "--range", "1e-25"], "TheoryError::OutOfRange", "is out of range: it must be between 1e-6 and 1e6"),
    BadCall { environment: &[("TABOR_MEMORY", "1000000000")], ..call(&["run", "good.toml", "--set", "grid.points=8192"], "Failure::Memory", "grid.points: 8192 x 8192 points need ") },
    BadCall { environment: &[("TABOR_MEMORY", "1000000000")], ..call(&["run", "good.toml", "--set", "grid.points=8192"], "MemoryError::Grid", " of memory and there are ") },
    BadCall { environment: &[("TABOR_MEMORY", "much")], ..call(&["run", "good.toml"], "MemoryError::Limit", "TABOR_MEMORY=\"much\" is no number of bytes; write for example TABOR_MEMORY=8000000000, or unset it") },
    BadCall { environment: &[("TABOR_MEMORY", "1000000")], ..call(&["surface", "good.toml", "--set", "grid.points=512"], "MemoryError::Map", "good.toml: 512 x 512 points need ") },
    BadCall { environment: &[("TABOR_MEMORY", "100")], ..call(&["check", "map.toml"], "MemoryError::File", "map.txt: ") },
    BadCall { status: 3, ..call(&["run", "good.toml", "--quiet", "--out", "three", "--set", "solver.max_iterations=1", "--set", "solver.tolerance=1e-12"], "Failure::NotConverged", "step 1 did not converge: residual ") },
    BadCall { status: 2, ..call(&["check", "good.toml", "--set", "grid.points=0"], "Failure::Scene", "good.toml, from --set: grid.points: 0 is out of range") },
    BadCall { status: 2, ..call(&["check", "sizeless.toml"], "Failure::Surface", "sizeless.toml: [grid] size is missing") },
    BadCall { status: 2, ..call(&["run", "good.toml", "--out", "foreign"], "Failure::Output", "foreign") },
    BadCall { environment: &[("OMPI_COMM_WORLD_SIZE", "4")], ..call(&["run", "good.toml"], "Failure::Launched", "a launcher has started 4 processes, and this build of tabor is without the feature `mpi`") },
    BadCall { environment: &[("PMIX_RANK", "0"), ("SLURM_STEP_NUM_TASKS", "4")], ..call(&["run", "good.toml"], "Failure::Launched", "a launcher has started 4 processes, and this build of tabor is without the feature `mpi`") },
];

const fn call(
    arguments: &'static [&'static str],
    variant: &'static str,
    expected: &'static str,
) -> BadCall {
    BadCall {
        arguments,
        environment: &[],
        status: 2,
        variant,
        expected,
    }
}

/// Calls that only a system with its files in the usual places can make fail.
#[rustfmt::skip] // one call a line
const ON_LINUX: &[BadCall] = &[
    BadCall { status: 1, ..call(&["run", "good.toml", "--out", "/proc/nowhere"], "OutputError::Write", "cannot create the folder /proc/nowhere") },
    BadCall { status: 1, ..call(&["man", "/proc/nowhere"], "OutputError::Write", "cannot create the folder /proc/nowhere") },
    BadCall { status: 4, environment: NO_DRIVER, ..call(&["run", "good.toml", "--backend", "gpu", "--out", "gpu"], "GpuError::NoAdapter", "no graphics adapter found") },
    BadCall { status: 4, environment: NO_DRIVER, ..call(&["run", "good.toml", "--backend", "gpu", "--out", "gpu"], "Failure::Device", "the GPU cannot be used: ") },
    BadCall { status: 4, environment: NO_DRIVER, ..call(&["run", "good.toml", "--backend", "gpu", "--out", "gpu"], "DeviceError::Unusable", "; --backend cpu does without") },
];

const NO_DRIVER: &[(&str, &str)] = &[
    ("VK_DRIVER_FILES", "/nonexistent"),
    ("VK_ICD_FILENAMES", "/nonexistent"),
];

/// A folder with the scenes of the calls.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let part = |part: &str| GOOD.replace("kind = \"sphere\"\nradius = \"1 um\"", part);
    let band = |longest: &str, shortest: &str| {
        part(&format!(
            "kind = \"self-affine\"\nhurst = 0.8\nrms_slope = 0.1\nlongest = \"{longest}\"\nrolloff = \"{longest}\"\nshortest = \"{shortest}\""
        ))
    };
    let map = "kind = \"file\"\npath = \"map.txt\"";
    for (name, text) in [
        ("good.toml", GOOD.to_owned()),
        ("broken.toml", GOOD.replace("size = ", "size")),
        (
            "short_waves.toml",
            part("kind = \"wavy\"\namplitude = 1e-9\nwavelength = \"100 nm\""),
        ),
        ("empty_band.toml", band("130 nm", "128.5 nm")),
        ("long_band.toml", band("1 um", "1 pm")),
        ("unheld_band.toml", band("100 nm", "50 nm")),
        ("map.toml", part(map).replace("points = 16\n", "")),
        (
            "sizeless.toml",
            part(map).replace("points = 16\nsize = \"1 um\"\n", ""),
        ),
        ("study.toml", study("", "radius", "[1e-6, 2e-6]")),
        ("no_axis.toml", "scene = \"good.toml\"\n".to_owned()),
        ("empty_axis.toml", study("", "radius", "[]")),
        ("unknown_key.toml", study("", "radios", "[1]")),
        (
            "no_plot.toml",
            study("plot.y = \"pull\"\n", "radius", "[1e-6]"),
        ),
        (
            "no_case.toml",
            study("folders = [3]\n", "radius", "[1e-6, 2e-6]"),
        ),
        (
            "too_many.toml",
            study("", "radius", &format!("[{}]", "1e-6, ".repeat(2000)))
                + &format!(
                    "[[axis]]\nkey = \"grid.points\"\nvalues = [{}]\n",
                    "16, ".repeat(2000)
                ),
        ),
        ("map.txt", "1 2 3\n4 5 6\n".repeat(20)),
    ] {
        fs::write(folder.path().join(name), text).expect("a file");
    }
    fs::write(folder.path().join("latin.toml"), b"title = \"\xB5m\"").expect("a file");
    fs::create_dir(folder.path().join("foreign")).expect("a folder");
    fs::write(folder.path().join("foreign/thesis.txt"), "mine").expect("a file");
    folder
}

/// A study of `good.toml` over a key of its sphere.
fn study(more: &str, key: &str, values: &str) -> String {
    format!("scene = \"good.toml\"\n{more}[[axis]]\nkey = \"surface.0.{key}\"\nvalues = {values}\n")
}

/// Makes every call and returns what was reached.
pub fn reached() -> Vec<Reached> {
    let folder = folder();
    let on_linux: &[BadCall] = if cfg!(target_os = "linux") {
        ON_LINUX
    } else {
        &[]
    };
    let mut reached: Vec<Reached> = CALLS
        .iter()
        .chain(on_linux)
        .map(|bad| {
            let output = tabor(folder.path(), bad.arguments, bad.environment);
            Reached {
                variant: bad.variant.to_owned(),
                message: one_line(&output, bad.status, bad.expected),
            }
        })
        .collect();
    assert!(
        !folder.path().join("good").exists(),
        "nothing is written for a bad call"
    );
    if cfg!(target_os = "linux") {
        reached.push(full_disk(folder.path()));
        reached.push(interrupted(folder.path()));
        reached.push(interrupted_study(folder.path()));
        reached.push(interrupted_sweep(folder.path()));
        reached.extend(no_such_adapter(folder.path()));
        reached.extend(past_the_adapter(folder.path()));
    }
    reached.extend(library());
    reached
}

/// Standard output on a full disk: exit status 1.
fn full_disk(folder: &Path) -> Reached {
    let full = fs::OpenOptions::new()
        .write(true)
        .open("/dev/full")
        .expect("a full device");
    let output = binary::command(folder, &["check", "good.toml"])
        .stdout(full)
        .output()
        .expect("the binary runs");
    Reached {
        variant: "Failure::Print".to_owned(),
        message: one_line(&output, 1, "cannot print: "),
    }
}

/// Ctrl-C amid a command that would take hours, once it has written `begun`: how it ends.
fn end_of_interrupted(folder: &Path, call: &[&str], begun: &str) -> Output {
    let run = binary::command(folder, call)
        .args(["--set", "grid.points=512"])
        .args([
            "--set",
            "solver.tolerance=1e-30",
            "--set",
            "solver.max_iterations=1000000",
        ])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the binary runs");
    // The file is there once the command watches for the signal.
    while !folder.join(begun).exists() {
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    assert!(binary::signal(&run, "-INT"));
    run.wait_with_output().expect("the command ends")
}

/// Ctrl-C amid a run: exit status 130, and what was finished is kept.
fn interrupted(folder: &Path) -> Reached {
    let law = "adhesion={ law='exponential', work_of_adhesion=0.05, range='1 nm' }";
    let call = ["run", "good.toml", "--out", "long", "--set", law];
    let output = end_of_interrupted(folder, &call, "long/curve.csv");
    Reached {
        variant: "Failure::Interrupted".to_owned(),
        message: one_line(&output, 130, "interrupted after 0 of 2 steps"),
    }
}

/// Ctrl-C amid the reference of a study: exit status 130, and its table is there, without rows.
fn interrupted_study(folder: &Path) -> Reached {
    let call = ["accuracy", "good.toml", "--out", "study"];
    let output = end_of_interrupted(folder, &call, "study/accuracy.csv");
    Reached {
        variant: "Failure::InterruptedStudy".to_owned(),
        message: one_line(&output, 130, " settings, which are kept in study"),
    }
}

/// Ctrl-C amid the cases of a study: exit status 130, and its file of cases is there.
fn interrupted_sweep(folder: &Path) -> Reached {
    let call = ["sweep", "study.toml", "--out", "swept"];
    let output = end_of_interrupted(folder, &call, "swept/cases.jsonl");
    Reached {
        variant: "Failure::InterruptedSweep".to_owned(),
        message: one_line(
            &output,
            130,
            "interrupted after 0 of 2 cases, which are kept in swept; the same command continues with the others",
        ),
    }
}

/// An adapter asked for by a name that none has; where there is no adapter at all it is that which is said.
fn no_such_adapter(folder: &Path) -> Vec<Reached> {
    let output = tabor(
        folder,
        &["run", "good.toml", "--backend", "gpu", "--out", "named"],
        &[("WGPU_ADAPTER_NAME", "no such one")],
    );
    let variant = if no_adapters() {
        "GpuError::NoAdapter"
    } else {
        "GpuError::NoSuchAdapter"
    };
    vec![Reached {
        variant: variant.to_owned(),
        message: one_line(&output, 4, "no graphics adapter"),
    }]
}

/// Whether drivers offer none, without what they print when asked.
fn no_adapters() -> bool {
    quietly(adapters).expect("drivers answer").is_empty()
}

/// Grids that an adapter does not take: odd ones, and one past the limits of an adapter that binds little.
fn past_the_adapter(folder: &Path) -> Vec<Reached> {
    if no_adapters() {
        return Vec::new();
    }
    [
        (
            "DeviceError::Limits",
            "grid.points=[64, 64]",
            "64 x 64 points are past the limits of ",
        ),
        (
            "DeviceError::Points",
            "grid.points=[16, 11]",
            "16 x 11 points have no transform on the GPU",
        ),
    ]
    .into_iter()
    .map(|(variant, set, expected)| {
        let call = [
            "run",
            "good.toml",
            "--backend",
            "gpu",
            "--out",
            "far",
            "--set",
            set,
        ];
        Reached {
            variant: variant.to_owned(),
            message: one_line(
                &tabor(folder, &call, &[("TABOR_TEST_GPU", "binding=1024")]),
                2,
                expected,
            ),
        }
    })
    .collect()
}

/// What only a program can ask of the library.
#[rustfmt::skip] // one call a line
fn library() -> Vec<Reached> {
    let reached = |variant: &str, message: String, expected: &str| {
        assert!(message.contains(expected), "{message}\nand not {expected}");
        Reached { variant: variant.to_owned(), message }
    };
    let grid = |points, size| GridScene { points, size, boundary: Boundary::Periodic };
    let surface = |grid: &GridScene, parts: &[SurfacePart]| {
        Surface::from_parts(grid, parts).expect_err("a wrong surface").to_string()
    };
    let small = grid(Some([8, 8]), Some([1.0, 1.0]));
    let of_part = |part: SurfacePart| surface(&small, &[part]);
    let rough = |change: &dyn Fn(&mut SelfAffineScene)| {
        let mut scene = SelfAffineScene { hurst: 0.8, roughness: Roughness::RmsSlope(0.1), longest: 1.0, rolloff: 1.0, shortest: 0.3, seed: 1 };
        change(&mut scene);
        of_part(SurfacePart::SelfAffine(scene))
    };
    let file = |scale: f64| {
        SurfacePart::File(HeightFileScene { path: "map.txt".into(), unit: 1.0, scale, detrend: Detrend::None, fill: Fill::None, black: None, white: None, preparation: tabor::scene::Preparation::default() })
    };
    let values = [f64::NAN; 64];
    let picture = Picture { title: None, field: FieldName::Gap, step: None, load: Some(Load::new(Control::Force, 1.0)), grid: Grid::new([8, 8], [1.0, 1.0]), values: &values };
    let nowhere = std::env::temp_dir().join("tabor_never_written.png");
    vec![
        reached("SurfaceError::Empty", surface(&small, &[]), "the scene has no [[surface]]; for a flat one write kind = \"flat\""),
        reached("SurfaceError::PointsMissing", surface(&grid(None, Some([1.0, 1.0])), &[SurfacePart::Flat]), "[grid] points is missing"),
        reached("SurfaceError::Size", surface(&grid(Some([8, 8]), Some([1.0, f64::NAN])), &[SurfacePart::Flat]), "must be two lengths between 1e-30 and 1e30 m; check the unit"),
        reached("SurfaceError::Part", of_part(SurfacePart::Cone { half_angle: 2.0, centre: None }), "[[surface]] 1: half_angle = "),
        reached("PartError::HalfAngle", of_part(SurfacePart::Cone { half_angle: 2.0, centre: None }), "degrees must lie between 0 and 90"),
        reached("PartError::NotPositive", of_part(SurfacePart::Sphere { radius: -1.0, centre: None }), "radius = -1 must be a positive, finite number"),
        reached("PartError::NotFinite", of_part(SurfacePart::Sphere { radius: 1.0, centre: Some([f64::NAN, 0.0]) }), "centre x = NaN must be a finite number"),
        reached("PartError::WavesDoNotClose", of_part(SurfacePart::Wavy { amplitude: 1.0, wavelength: [0.4, f64::INFINITY] }), "does not divide the periodic size 1e0 m: 2.500000 waves; the nearest that does is 3"),
        reached("PartError::Hurst", rough(&|scene| scene.hurst = 1.5), "hurst = 1.5 must lie between 0 and 1"),
        reached("PartError::BandOrder", rough(&|scene| scene.rolloff = 2.0), "needed is longest >= rolloff >= shortest"),
        reached("PartError::ArrayPoints", of_part(SurfacePart::from_heights([0.0; 9], [3, 3])), "an array of 9 numbers for 3 x 3 points (x, y), where the grid has 8 x 8, which are 64"),
        reached("PartError::ArrayNotFinite", of_part(SurfacePart::from_heights([f64::NAN; 64], [8, 8])), "the height at row 1, column 1 (counted from 1) is NaN"),
        reached("PartError::ArrayExtreme", of_part(SurfacePart::from_heights([1e-40; 64], [8, 8])), "the largest height is 1e-40 m"),
        reached("MapError::Array", factors([1.0; 9], [3, 3]), "[adhesion] map array: an array of 9 numbers for 3 x 3 points"),
        reached("PartError::File", of_part(file(1.0)), "[[surface]] 1: map.txt: there is no such file"),
        reached("FileError::Factor", of_part(file(0.0)), "scale = 0e0 must be between 1e-30 and 1e30, or minus that; check the powers of ten"),
        reached("FileError::TooLong", long_text(), "bytes are too many to read; save the heights as .npy"),
        reached("BandFitError::Flat", fit_band([4, 4], 0.0), "the surface is flat"),
        reached("BandFitError::LineScan", fit_band([64, 1], 1.0), "a line scan has waves along one axis"),
        reached("BandFitError::TooFewRings", fit_band([4, 4], 1.0), "rings of the spectrum are too few"),
        reached("OutputError::NotFinite", write_picture(&nowhere, &picture).expect_err("no picture").to_string(), "cannot draw the gap: 64 of 64 points are not finite numbers"),
        reached("TheoryError::NoSolution", root("a zero", |x| x * x + 1.0, -1.0, 1.0, 1e-12).expect_err("no zero").to_string(), "a zero does not exist for these values"),
    ]
}

/// Why an array of factors on the adhesion does not suit a grid of 8 x 8 points.
fn factors(values: [f64; 9], points: [usize; 2]) -> String {
    let contact = tabor::Contact::from_parts([SurfacePart::Flat], [8, 8], [1e-6, 1e-6])
        .contact_modulus(1e9)
        .law(tabor::MaugisDugdale::new(0.05, 1e-9))
        .adhesion_map(AdhesionMap::Factors(GridValues::new(values, points)));
    let scene = contact
        .scene([tabor::Control::MeanPressure(1e6)])
        .expect("the map is looked at with the surface");
    Surface::build(&scene).expect_err("a wrong map").to_string()
}

/// Why a map of a few points has no self-affine fit.
fn fit_band(points: [usize; 2], last: f64) -> String {
    let mut heights = vec![0.0; points[0] * points[1]];
    heights[4] = last;
    let grid = Grid::new(points, [1.0; 2]);
    fit(&grid, &heights, Boundary::Periodic)
        .expect_err("no fit")
        .to_string()
}

/// A text file longer than any that is taken: a hole of 4 GiB, which takes no room on the disk.
fn long_text() -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let file = fs::File::create(folder.path().join("long.txt")).expect("a file");
    file.set_len((1 << 32) + 1).expect("a hole");
    let scene = super::files::scene("long.txt", "");
    let scene = Scene::parse(&scene, "s.toml", folder.path(), &[]).expect("a right scene");
    Surface::build(&scene).expect_err("too long").to_string()
}
