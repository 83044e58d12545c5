//! The memory that `tabor check` announces is what a run takes, by precision, boundary and effect,
//! and a run that cannot have it is refused with a grid that fits.

mod shared;

use std::fs;
use std::path::Path;
use std::process::Output;

use shared::{errors, summary};
use tabor::backend::tally::Place;
use tabor::scene::Scene;
use tabor::solver::good_size;
use tabor::study::{Memory, Plan};

const ROUGH: &str = r#"[grid]
points = 768
size = "10 um"
boundary = "BOUNDARY"
[solid]
contact_modulus = "50 MPa"
[[surface]]
kind = "self-affine"
hurst = 0.8
rms_slope = 0.1
longest = "10 um"
rolloff = "5 um"
shortest = "0.2 um"
[loading]
control = "force"
path = ["10 uN", "20 uN"]
[solver]
max_iterations = 2
[output]
fields = ["pressure"]
"#;

const ADHESION: &str =
    "[adhesion]\nlaw = \"exponential\"\nwork_of_adhesion = \"10 mJ/m^2\"\nrange = \"10 nm\"\n";

fn tabor(folder: &Path, arguments: &[&str], memory: Option<u64>) -> Output {
    let mut command = shared::command(folder, arguments);
    command.env_remove("TABOR_MEMORY");
    if let Some(bytes) = memory {
        command.env("TABOR_MEMORY", bytes.to_string());
    }
    command.output().expect("the binary runs")
}

fn plan(text: &str) -> Plan {
    let scene = Scene::parse(text, "scene.toml", Path::new("."), &[])
        .unwrap_or_else(|errors| panic!("{errors}"));
    Plan::of(scene).unwrap_or_else(|error| panic!("{error}"))
}

/// Peak of the process against the count. It must not be above the count by more than the
/// allocator's own slack (a twentieth), and not below half of it, or grids would be refused in vain.
#[test]
#[cfg(target_os = "linux")]
fn a_run_takes_what_was_counted() {
    let folder = tempfile::tempdir().expect("a folder");
    let dmt = format!("{ADHESION}treatment = \"dmt\"\n");
    let single = "precision = \"single\"\n";
    let mixed = "precision = \"mixed\"\n";
    // The first step ends unconverged, as all do here, and relaxes nevertheless.
    let relaxing = "[[solid.relaxation]]\nmodulus = \"50 MPa\"\ntime = 1.0\n[[solid.relaxation]]\nmodulus = \"20 MPa\"\ntime = 10.0\n";
    for (boundary, adhesion, solver) in [
        ("periodic", relaxing, ""),
        ("free", relaxing, single),
        ("periodic", "", ""),
        ("periodic", "", single),
        ("periodic", ADHESION, ""),
        ("periodic", ADHESION, single),
        ("periodic", ADHESION, mixed),
        ("periodic", dmt.as_str(), ""),
        ("free", "", ""),
        ("free", ADHESION, single),
        ("free", "", mixed),
    ] {
        let path = match adhesion == relaxing {
            true => {
                "start = \"10 uN\"\n[[loading.ramp]]\nto = \"20 uN\"\nsteps = 1\nduration = 1.0"
            }
            false => "path = [\"10 uN\", \"20 uN\"]",
        };
        let text = ROUGH
            .replace("BOUNDARY", boundary)
            .replace("[loading]", &format!("{adhesion}[loading]"))
            .replace("path = [\"10 uN\", \"20 uN\"]", path)
            .replace(
                "max_iterations = 2\n",
                &format!("max_iterations = 2\n{solver}"),
            );
        let name = format!("{boundary} {adhesion} {solver}");
        fs::write(folder.path().join("scene.toml"), &text).expect("a scene");
        let _ = fs::remove_dir_all(folder.path().join("scene"));
        // Two iterations do not converge; all memory has been taken by then.
        let output = tabor(folder.path(), &["run", "scene.toml", "--quiet"], None);
        let message = errors(&output);
        assert_eq!(output.status.code(), Some(3), "{name}: {message}");
        let summary = summary(&folder.path().join("scene"));
        let peak = summary["peak_memory_bytes"].as_f64().expect("a peak");
        let plan = plan(&text);
        let counted = plan
            .memory(Place::of(&plan.scene))
            .expect("a count")
            .machine as f64;
        let share = peak / counted;
        println!(
            "{share:.3} of {:.0} MiB: {name}",
            counted / f64::from(1 << 20)
        );
        assert!((0.5..1.05).contains(&share), "{share} of the count: {name}");
    }
}

#[test]
fn what_does_not_fit_is_refused_with_the_largest_grid_that_does() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = ROUGH.replace("BOUNDARY", "periodic");
    fs::write(folder.path().join("scene.toml"), &text).expect("a scene");
    let available = 400 << 20;
    let set = [
        "--set",
        "grid.points=[3000, 1500]",
        "--set",
        "grid.size=[2e-5, 1e-5]",
    ];
    let call = |command: &'static str| [&[command, "scene.toml"][..], &set].concat();
    let output = tabor(folder.path(), &call("run"), Some(available));
    let message = errors(&output);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(!folder.path().join("scene").exists(), "nothing is written");
    assert!(
        message.contains("3000 x 1500 points need ") && message.contains("there are 0.39 GiB"),
        "{message}"
    );
    let (_, rest) = message.split_once("take at most ").expect("a remedy");
    let points: Vec<usize> = rest
        .split([' ', ',', '\n'])
        .filter_map(|word| word.parse().ok())
        .take(2)
        .collect();
    assert!(
        points[0].abs_diff(2 * points[1]) <= 4,
        "the same shape: {message}"
    );
    // That grid fits, and the next that transforms as well does not.
    let fits = |nx: usize| {
        let ny = nx.div_ceil(8) * 4;
        let set = text.replace("points = 768", &format!("points = [{nx}, {ny}]"));
        let set = set.replace("size = \"10 um\"", "size = [\"20 um\", \"10 um\"]");
        let memory = plan(&set).memory(Place::Double).expect("a count");
        memory.machine <= available
    };
    let next = (points[0] + 4..)
        .step_by(4)
        .find(|&size| good_size(size) == size)
        .expect("there is always one more");
    assert!(fits(points[0]) && !fits(next), "{message} and not {next}");
    // A check answers, and warns of the same; single precision takes less.
    let output = tabor(folder.path(), &call("check"), Some(available));
    let warning = errors(&output);
    assert_eq!(output.status.code(), Some(0), "{warning}");
    assert!(
        warning.contains("warning: grid.points: 3000 x 1500 points need "),
        "{warning}"
    );
    let needs = |place: Place| {
        let plan = plan(&text);
        let memory: Memory = plan.memory(place).expect("a count");
        (memory.machine, memory.adapter)
    };
    let [double, single, gpu] = [Place::Double, Place::Single, Place::Gpu].map(needs);
    // By default a GPU has the processor keep the state in double precision.
    assert!(
        single.0 < double.0 && gpu.0 < double.0,
        "{gpu:?} {double:?}"
    );
    assert!(double.1 == 0 && single.1 == 0 && gpu.1 > 0);
}

/// The limit of the process counts as well, before anything fails to be allocated.
#[test]
#[cfg(target_os = "linux")]
fn a_limited_address_space_is_no_abort() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = ROUGH.replace("BOUNDARY", "periodic");
    fs::write(folder.path().join("scene.toml"), &text).expect("a scene");
    // Of the 167 MiB that are counted, with the program's own.
    let limited = "ulimit -v 150000; exec \"$0\" run scene.toml --quiet";
    let output = std::process::Command::new("sh")
        .args(["-c", limited, env!("CARGO_BIN_EXE_tabor")])
        .current_dir(folder.path())
        .env_remove("TABOR_MEMORY")
        .output()
        .expect("a shell runs");
    let message = errors(&output);
    assert_eq!(output.status.code(), Some(2), "{message}");
    // How much is left, and whether any grid fits, depends on the number of threads.
    assert!(message.contains("768 x 768 points need "), "{message}");
}

/// What a relaxing solid remembers is the host's, also where an adapter solves.
#[test]
fn the_host_keeps_the_history() {
    let elastic = ROUGH.replace("BOUNDARY", "periodic").replace(
        "path = [\"10 uN\", \"20 uN\"]",
        "start = \"10 uN\"\n[[loading.ramp]]\nto = \"20 uN\"\nsteps = 1\nduration = 1.0",
    );
    let branch = "[[solid.relaxation]]\nmodulus = \"50 MPa\"\ntime = 1.0\n[[surface]]";
    let relaxing = elastic.replace("[[surface]]", branch);
    let memory = |text: &str| plan(text).memory(Place::Gpu).expect("a count");
    let (elastic, relaxing) = (memory(&elastic), memory(&relaxing));
    assert_eq!(relaxing.adapter, elastic.adapter);
    // At least the displacement and the branch's spring, in double precision.
    assert!(relaxing.machine >= elastic.machine + 2 * 8 * 768 * 768);
}
