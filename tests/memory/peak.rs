//! The memory that `tabor check` announces is what a run takes, by precision, boundary and effect,
//! and a run that cannot have it is refused with a grid that fits.

use std::fs;
use std::path::Path;
use std::process::Output;

use tabor::backend::dry_run::Place;
use tabor::scene::{Precision, Scene};
use tabor::solver::good_size;
use tabor::study::{Memory, Plan};

use crate::shared::binary::{self, errors, summary};
use crate::shared::trials::tests;

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
    let mut command = binary::command(folder, arguments);
    command.env_remove("TABOR_MEMORY");
    // One test at a time: on all cores.
    command.env_remove("RAYON_NUM_THREADS");
    if let Some(bytes) = memory {
        command.env("TABOR_MEMORY", bytes.to_string());
    }
    command.output().expect("the binary runs")
}

fn plan(text: &str) -> Plan {
    let scene = Scene::parse(text, "scene.toml", Path::new("."), &[])
        .unwrap_or_else(|errors| panic!("{errors}"));
    Plan::for_scene(scene).unwrap_or_else(|error| panic!("{error}"))
}

/// Peak of the process against the count. It must not be above the count by more than the
/// allocator's own slack (a twentieth), and not below half of it, or grids would be refused in vain.
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
        // Two iterations do not converge; all memory has been taken by then.
        let peak = peak_of(folder.path(), &text, &name, 3);
        let plan = plan(&text);
        let counted = plan.memory(plan.place()).expect("a count").machine as f64;
        let share = share_of(peak, counted, &name);
        assert!((0.5..1.05).contains(&share), "{share} of the count: {name}");
    }
}

/// The largest resident set of a run of a scene, bytes, which ends with a status.
#[cfg(target_os = "linux")]
fn peak_of(folder: &Path, text: &str, name: &str, status: i32) -> f64 {
    fs::write(folder.join("scene.toml"), text).expect("a scene");
    let _ = fs::remove_dir_all(folder.join("scene"));
    let output = tabor(folder, &["run", "scene.toml", "--quiet"], None);
    let message = errors(&output);
    assert_eq!(output.status.code(), Some(status), "{name}: {message}");
    let summary = summary(&folder.join("scene"));
    summary["peak_memory_bytes"].as_f64().expect("a peak")
}

/// The peak of a run over what is stated, both in bytes; it is printed with the name of the run.
#[cfg(target_os = "linux")]
fn share_of(peak: f64, stated: f64, name: &str) -> f64 {
    let share = peak / stated;
    println!(
        "{share:.3} of {:.0} MiB: {name}",
        stated / f64::from(1 << 20)
    );
    share
}

/// Boundary, points, precision, law, loading, and whether the path has a step that is searched for a jump.
#[cfg(target_os = "linux")]
const WHOLE_PATHS: [(&str, usize, &str, &str, &str, bool); 8] = [
    ("periodic", 768, "double", "", LOADS, false),
    ("periodic", 768, "single", "", LOADS, false),
    ("periodic", 768, "mixed", "", LOADS, false),
    ("periodic", 768, "double", MAUGIS, GAPS, true),
    ("periodic", 768, "mixed", EXPONENTIAL, GAPS, true),
    ("periodic", 768, "single", LENNARD_JONES, GAPS, true),
    ("free", 512, "double", MAUGIS, LOADS, false),
    ("free", 512, "mixed", LENNARD_JONES, LOADS, false),
];
#[cfg(target_os = "linux")]
const MAUGIS: &str = "law = \"maugis-dugdale\"\nrange = \"20 nm\"";
#[cfg(target_os = "linux")]
const EXPONENTIAL: &str = "law = \"exponential\"\nrange = \"15 nm\"";
#[cfg(target_os = "linux")]
const LENNARD_JONES: &str = "law = \"lennard-jones\"\nrange = \"20 nm\"";
#[cfg(target_os = "linux")]
const LOADS: &str = "control = \"force\"\npath = [\"50 uN\", \"100 uN\"]";
#[cfg(target_os = "linux")]
const GAPS: &str =
    "control = \"mean-gap\"\npath = [\"150 nm\", \"60 nm\", \"40 nm\", \"60 nm\", \"150 nm\"]";

/// Paths that converge, through evaluations, pictures, checkpoints and the search for a jump: their peak is what
/// `tabor check` says, to a tenth.
#[cfg(target_os = "linux")]
fn a_whole_path_takes_what_is_stated_to_a_tenth() {
    let folder = tempfile::tempdir().expect("a folder");
    for (boundary, points, precision, law, loading, searches) in WHOLE_PATHS {
        // Corrections of mixed precision begin below what single precision reaches.
        let tolerance = if precision == "mixed" { 1e-5 } else { 1e-3 };
        let name = format!("{boundary}, {points} points, {precision} precision, {law}");
        let adhesion = if law.is_empty() {
            String::new()
        } else {
            format!("[adhesion]\n{law}\nwork_of_adhesion = \"30 mJ/m^2\"\n")
        };
        let text = format!(
            "[grid]\npoints = {points}\nsize = \"10 um\"\nboundary = \"{boundary}\"\n\
             [solid]\ncontact_modulus = \"100 MPa\"\n\
             [[surface]]\nkind = \"self-affine\"\nhurst = 0.8\nrms_slope = 0.1\nlongest = \"10 um\"\nrolloff = \"5 um\"\nshortest = \"{} nm\"\n\
             {adhesion}[loading]\n{loading}\n\
             [solver]\nbackend = \"cpu\"\nprecision = \"{precision}\"\ntolerance = {tolerance}\n",
            80_000.0 / points as f64
        );
        let peak = peak_of(folder.path(), &text, &name, 0);
        let plan = plan(&text);
        let memory = plan.memory(plan.place()).expect("a count");
        let stated = if searches {
            memory.machine
        } else {
            memory.without_search
        };
        let share = share_of(peak, stated as f64, &name);
        assert!(
            (share - 1.0).abs() <= 0.1,
            "{share} of what is stated: {name}"
        );
    }
}

/// A step whose load is lost in its tolerance is solved on to a smaller one, in the memory of any other.
#[cfg(target_os = "linux")]
fn a_step_that_is_solved_on_takes_what_is_stated_to_a_tenth() {
    let folder = tempfile::tempdir().expect("a folder");
    let (points, tolerance) = (1024, 0.1);
    let text = format!(
        "[grid]\npoints = {points}\nsize = \"100 um\"\n[solid]\ncontact_modulus = \"25 MPa\"\n\
         [[surface]]\nkind = \"self-affine\"\nhurst = 0.8\nrms_slope = 1\nlongest = \"100 um\"\nrolloff = \"20 um\"\nshortest = \"0.2 um\"\n\
         [adhesion]\nlaw = \"exponential\"\nwork_of_adhesion = \"50 mJ/m^2\"\nrange = \"2.07 nm\"\n\
         [loading]\ncontrol = \"pressure\"\npath = [\"250 kPa\"]\n\
         [solver]\nbackend = \"cpu\"\nprecision = \"double\"\ntolerance = {tolerance}\n[output]\nimages = []\n"
    );
    let name = "solved on";
    let peak = peak_of(folder.path(), &text, name, 0);
    let rows = binary::table(&folder.path().join("scene/curve.csv"));
    let residual = binary::number(&rows[0], "residual").expect("a residual");
    assert!(
        residual < 0.1 * tolerance,
        "it was not solved on: {residual}"
    );
    let plan = plan(&text);
    let stated = plan.memory(plan.place()).expect("a count").machine as f64;
    let share = share_of(peak, stated, name);
    assert!((share - 1.0).abs() <= 0.1, "{share} of what is stated");
}

/// A viscoelastic path that converges, of three branches, whose state a checkpoint holds after each step: no more than is
/// stated, but for the allocator's slack.
#[cfg(target_os = "linux")]
fn a_viscoelastic_path_takes_no_more_than_is_stated() {
    let folder = tempfile::tempdir().expect("a folder");
    let branches: String = ["1.0", "2.0", "3.0"]
        .iter()
        .map(|time| format!("[[solid.relaxation]]\nmodulus = \"50 MPa\"\ntime = {time}\n"))
        .collect();
    for (boundary, points, precision) in [
        ("periodic", 768, "double"),
        ("free", 512, "double"),
        ("free", 512, "single"),
    ] {
        let text = format!(
            "[grid]\npoints = {points}\nsize = \"10 um\"\nboundary = \"{boundary}\"\n\
             [solid]\ncontact_modulus = \"100 MPa\"\n{branches}\
             [[surface]]\nkind = \"sphere\"\nradius = \"50 um\"\n\
             [loading]\ncontrol = \"force\"\nstart = \"10 uN\"\n[[loading.ramp]]\nto = \"20 uN\"\nsteps = 2\nduration = 1.0\n\
             [solver]\nbackend = \"cpu\"\nprecision = \"{precision}\"\ntolerance = 1e-3\n[output]\nimages = []\n"
        );
        let name = format!("{boundary}, {points} points, {precision} precision");
        let peak = peak_of(folder.path(), &text, &name, 0);
        let plan = plan(&text);
        let stated = plan.memory(plan.place()).expect("a count").machine as f64;
        let share = share_of(peak, stated, &name);
        assert!((0.5..1.05).contains(&share), "{share} of the count: {name}");
    }
}

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
        let plan = plan(&set);
        let memory = plan.memory(plan.place()).expect("a count");
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
    let needs = |(precision, place): (Precision, Place)| {
        let mut scene = plan(&text).scene;
        scene.solver.precision = precision;
        let plan = Plan::for_scene(scene).unwrap_or_else(|error| panic!("{error}"));
        let memory: Memory = plan.memory(place).expect("a count");
        (memory.machine, memory.adapter)
    };
    let [double, single, gpu] = [
        (Precision::Double, Place::Double),
        (Precision::Single, Place::Single),
        (Precision::Auto, Place::Gpu),
    ]
    .map(needs);
    // By default a GPU has the processor keep the state in double precision.
    assert!(
        single.0 < double.0 && gpu.0 < double.0,
        "{gpu:?} {double:?}"
    );
    assert!(double.1 == 0 && single.1 == 0 && gpu.1 > 0);
}

/// The limit of the process counts as well, before anything fails to be allocated.
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

/// What a call with little memory says; it is refused with exit status 2.
fn refused(folder: &Path, arguments: &[&str]) -> String {
    let output = tabor(folder, arguments, Some(100_000_000));
    let message = errors(&output);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
    message
}

/// A small file may be a large image: what its header claims is counted before a pixel is unpacked.
fn a_small_file_of_a_large_map_is_refused() {
    const SIDE: u32 = 3000;
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    let black = vec![0_u8; (SIDE * SIDE) as usize];
    image::GrayImage::from_raw(SIDE, SIDE, black.clone())
        .expect("all pixels")
        .save(path("map.png"))
        .expect("an image");
    let file = fs::File::create(path("map.tif")).expect("a file");
    tiff::encoder::TiffEncoder::new(file)
        .expect("a header")
        .with_compression(tiff::encoder::Compression::Deflate(
            tiff::encoder::DeflateLevel::Fast,
        ))
        .write_image::<tiff::encoder::colortype::Gray8>(SIDE, SIDE, &black)
        .expect("an image");
    let header =
        format!("{{'descr': '|u1', 'fortran_order': False, 'shape': ({SIDE}, {SIDE}), }}\n");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.bytes());
    fs::write(path("map.npy"), [bytes, black].concat()).expect("an array");
    for name in ["map.png", "map.tif", "map.npy"] {
        let length = fs::metadata(path(name)).expect("a file").len();
        assert!(
            name == "map.npy" || length < 200_000,
            "{name}: {length} bytes"
        );
        let expected = format!("{name}: {SIDE} x {SIDE} points need ");
        let ends: &[&str] = match name {
            "map.npy" => &[],
            _ => &["--black", "0", "--white", "1 um"],
        };
        let call = [&["surface", name, "--size", "10 um"], ends].concat();
        let message = refused(folder.path(), &call);
        assert!(message.contains(&expected), "{message}");
        assert!(
            message.contains(" GiB of memory and there are 0.09 GiB; take a coarser map"),
            "{message}"
        );
        let keys = match name {
            "map.npy" => "",
            _ => "black = 0\nwhite = 1e-6\n",
        };
        let scene = format!(
            "[grid]\nsize = \"10 um\"\n[solid]\ncontact_modulus = \"1 GPa\"\n[[surface]]\nkind = \"file\"\npath = \"{name}\"\n{keys}[loading]\ncontrol = \"pressure\"\npath = [\"1 MPa\"]\n"
        );
        fs::write(path("scene.toml"), scene).expect("a scene");
        for command in ["surface", "check", "run", "compare", "accuracy"] {
            let message = refused(folder.path(), &[command, "scene.toml"]);
            assert!(message.contains(&expected), "{command}: {message}");
        }
    }
    // A scene says its points itself.
    let text = ROUGH.replace("BOUNDARY", "free").replace("768", "2000");
    fs::write(path("scene.toml"), text).expect("a scene");
    let message = refused(folder.path(), &["surface", "scene.toml"]);
    assert!(
        message.contains("scene.toml: 2000 x 2000 points need 0.2"),
        "{message}"
    );
}

/// Waves along the long side of pixels 1 to 1e8: the rings of the spectrum are counted by what is in them.
/// 16 kB of heights took 4.7 GB, which is not to be had here.
#[cfg(target_os = "linux")]
fn long_pixels_take_no_more_memory_than_square_ones() {
    let folder = tempfile::tempdir().expect("a folder");
    let wave = |k: usize, ix: usize| {
        (std::f64::consts::TAU * (k * ix) as f64 / 100.0 + (k * k) as f64).cos()
    };
    let row: Vec<String> = (0..100)
        .map(|ix| {
            (1..18)
                .map(|k| wave(k, ix) / k as f64)
                .sum::<f64>()
                .to_string()
        })
        .collect();
    fs::write(
        folder.path().join("map.txt"),
        format!("{}\n", row.join(" ")).repeat(20),
    )
    .expect("a map");
    for boundary in ["periodic", "free"] {
        let limited = format!(
            "ulimit -v 2000000; exec \"$0\" surface map.txt --size \"1e8, 1\" --boundary {boundary} --out {boundary}"
        );
        let output = std::process::Command::new("sh")
            .args(["-c", &limited, env!("CARGO_BIN_EXE_tabor")])
            .current_dir(folder.path())
            .env_remove("TABOR_MEMORY")
            .output()
            .expect("a shell runs");
        assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    }
}

tests![
    #[cfg(target_os = "linux")]
    a_run_takes_what_was_counted,
    #[cfg(target_os = "linux")]
    a_whole_path_takes_what_is_stated_to_a_tenth,
    #[cfg(target_os = "linux")]
    a_step_that_is_solved_on_takes_what_is_stated_to_a_tenth,
    #[cfg(target_os = "linux")]
    a_viscoelastic_path_takes_no_more_than_is_stated,
    what_does_not_fit_is_refused_with_the_largest_grid_that_does,
    #[cfg(target_os = "linux")]
    a_limited_address_space_is_no_abort,
    the_host_keeps_the_history,
    a_small_file_of_a_large_map_is_refused,
    #[cfg(target_os = "linux")]
    long_pixels_take_no_more_memory_than_square_ones,
];
