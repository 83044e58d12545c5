//! Scenes on the graphics processor through the binary, against the processor in double precision;
//! and what a run says where the adapter lacks something or fails.

use std::collections::HashMap;
use std::fs;
use std::path::Path;
use std::process::Output;

use crate::shared::binary::{
    command, errors, scene, summary, table, tabor, with_drivers, without_adapter,
};
use crate::shared::device::{device, device_with_double, relative_difference};
use crate::shared::trials::{ignore, tests};

const SPHERE: &str = r#"
[grid]
points = 32
size = "2 um"
[solid]
contact_modulus = "10 GPa"
[[surface]]
kind = "sphere"
radius = "5 um"
[adhesion]
law = "maugis-dugdale"
work_of_adhesion = "50 mJ/m^2"
range = "3 nm"
[loading]
control = "force"
path = ["3 uN", "6 uN", "3 uN"]
[output]
fields = ["gap", "pressure"]
"#;

const ROUGH: &str = r#"
[grid]
points = 64
size = "2 um"
[solid]
contact_modulus = "1 GPa"
[[surface]]
kind = "self-affine"
hurst = 0.8
rms_slope = 0.1
longest = "2 um"
rolloff = "1 um"
shortest = "0.25 um"
[loading]
control = "pressure"
path = ["2 MPa", "10 MPa", "2 MPa"]
[output]
fields = ["gap", "pressure"]
"#;

fn run(folder: &Path, out: &str, arguments: &[&str], drivers: Option<&str>) -> Output {
    run_tested(folder, out, arguments, drivers, "")
}

/// The same with something asked of the adapter for the test's sake.
fn run_tested(
    folder: &Path,
    out: &str,
    arguments: &[&str],
    drivers: Option<&str>,
    tested: &str,
) -> Output {
    let mut command = command(folder, &["run", "scene.toml", "--out", out]);
    command.env("TABOR_TEST_GPU", tested).args(arguments);
    if let Some(drivers) = drivers {
        with_drivers(&mut command, drivers);
    }
    command.output().expect("the binary runs")
}

/// Rows of the curve, by name.
fn rows(folder: &Path) -> Vec<HashMap<String, String>> {
    table(&folder.join("curve.csv"))
}

fn field(folder: &Path, name: &str) -> npyz::NpyFile<std::io::Cursor<Vec<u8>>> {
    let path = folder.join(format!("fields/step_0003_{name}.npy"));
    let bytes = fs::read(path).expect("a field");
    npyz::NpyFile::new(std::io::Cursor::new(bytes)).expect("an npy file")
}

/// Runs a scene on both, to a tolerance that asks for this precision, or in double. The stopping measure is relative
/// to the pressures, so gaps agree to the tolerance and pressures, which weigh short waves, to ten
/// times that (both come out better); at 1e-4 a few points at the rim may be closed in one and open in
/// the other.
fn compare(text: &str, precision: &str, tolerance: f64) {
    let device = device();
    let folder = scene(text);
    let set = format!("solver.tolerance={tolerance:e}");
    let asked = match precision {
        "double" if !text.contains("hardness") => "double",
        // Chosen by the tolerance, and by whether the solid flows.
        _ => "auto",
    };
    let calls: [(&str, &[&str]); 2] = [
        (
            "gpu",
            &["--backend", "gpu", "--precision", asked, "--set", &set],
        ),
        ("cpu", &["--backend", "cpu", "--precision", "double"]),
    ];
    for (out, call) in calls {
        let output = run(folder.path(), out, call, None);
        assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
        assert!(output.stdout.is_empty());
        // That software stands in for a graphics processor is said.
        let stands_in = out == "gpu" && device.description().software();
        assert_eq!(
            errors(&output).contains("software on the processor"),
            stands_in
        );
    }
    let (gpu, cpu) = (folder.path().join("gpu"), folder.path().join("cpu"));
    let said = summary(&gpu);
    assert_eq!(said["backend"], "gpu");
    assert_eq!(said["precision"], precision);
    assert!(
        said["adapter"]
            .as_str()
            .is_some_and(|name| !name.is_empty())
    );
    assert!(summary(&cpu)["adapter"].is_null());
    let (one, two) = (rows(&gpu), rows(&cpu));
    assert_eq!(one.len(), two.len());
    // The processor's own default is 1e-6.
    let loosest = tolerance.max(1e-6);
    for (step, (one, two)) in one.iter().zip(&two).enumerate() {
        assert_eq!(one["state"], two["state"], "step {step}");
        assert_eq!(one["converged"], "true");
        for (name, bound) in [
            ("mean_gap", 2.0),
            ("approach", 5.0),
            ("elastic_energy", 10.0),
            ("contact_area_fraction", 100.0),
        ] {
            let bound = bound * loosest;
            let number = |text: &str| -> f64 { text.parse().expect("a number") };
            let (a, b) = (number(&one[name]), number(&two[name]));
            println!("step {step}: {name} {:.1e}", (a - b).abs() / b.abs());
            assert!((a - b).abs() <= bound * b.abs(), "{name}: {a} and {b}");
        }
    }
    for (name, bound) in [("gap", 2.0), ("pressure", 20.0)] {
        let ours: Vec<f64> = match precision {
            "single" => {
                let single: Vec<f32> = field(&gpu, name).into_vec().expect("float32");
                single.into_iter().map(f64::from).collect()
            }
            _ => field(&gpu, name).into_vec().expect("float64"),
        };
        let double: Vec<f64> = field(&cpu, name).into_vec().expect("float64");
        let error = relative_difference(&ours, &double);
        println!("{name} {error:.1e}");
        assert!(error <= bound * loosest, "{name}: {error:e}");
    }
}

fn an_adhesive_sphere_agrees_with_the_processor() {
    compare(SPHERE, "mixed", 1e-9);
}

fn an_adhesive_sphere_in_double_precision_agrees_with_the_processor() {
    device_with_double();
    compare(SPHERE, "double", 1e-9);
}

fn a_solid_that_flows_is_solved_in_double_precision() {
    let flows = "contact_modulus = \"1 GPa\"\nhardness = \"60 MPa\"";
    let text = ROUGH.replace("contact_modulus = \"1 GPa\"", flows);
    device_with_double();
    compare(&text, "double", 1e-9);
}

fn a_rough_surface_agrees_with_the_processor() {
    compare(ROUGH, "single", 1e-4);
}

/// Steps of many ranges, which taken rigidly drive points deep into the core of the law: single and mixed
/// precision ended there after no iteration, at a residual of 1.
fn steps_into_the_lennard_jones_core_agree_with_the_processor() {
    let text = |points: usize, shortest: f64, work: f64, range: f64, path: &str| {
        format!(
            r#"
[grid]
points = {points}
size = 1.0
[solid]
contact_modulus = 1.0
[[surface]]
kind = "self-affine"
hurst = 0.8
rms_height = 0.01
longest = 1.0
rolloff = 0.5
shortest = {shortest}
seed = 5
[adhesion]
law = "lennard-jones"
work_of_adhesion = {work:e}
range = {range:e}
[loading]
control = "approach"
path = {path}
[output]
fields = ["gap", "pressure"]
"#
        )
    };
    let mixed = text(32, 0.125, 1.6e-6, 1e-3, "[-1e-3, 0.02, 0.018]");
    compare(&mixed, "mixed", 1e-9);
    let single = text(16, 0.25, 5.12e-5, 4e-3, "[-4e-3, 0.018, 0.016]");
    compare(&single, "single", 1e-4);
}

fn without_an_adapter_gpu_fails_and_auto_does_not() {
    let folder = scene(ROUGH);
    let nowhere = Some("/nonexistent");
    let gpu = run(folder.path(), "gpu", &["--backend", "gpu"], nowhere);
    // Drivers that are not Vulkan's do not listen.
    if gpu.status.success() {
        ignore("there is an adapter that Vulkan's drivers do not bring");
    }
    assert_eq!(gpu.status.code(), Some(4), "{}", errors(&gpu));
    let message = errors(&gpu);
    assert!(message.contains("no graphics adapter"), "{message}");
    assert!(!folder.path().join("gpu").exists(), "nothing is written");
    for call in [&["--backend", "auto"][..], &["--precision", "single"]] {
        let auto = run(folder.path(), "auto", call, nowhere);
        assert_eq!(auto.status.code(), Some(0), "{}", errors(&auto));
        assert_eq!(summary(&folder.path().join("auto"))["backend"], "cpu");
        assert!(!errors(&auto).contains("note:"), "{}", errors(&auto));
    }
    let devices = without_adapter(&mut command(folder.path(), &["devices"]))
        .output()
        .expect("the binary runs");
    assert_eq!(devices.status.code(), Some(0));
    let text = String::from_utf8_lossy(&devices.stdout);
    assert!(text.contains("none found"), "{text}");
}

fn sizes_without_a_transform_are_refused_with_the_nearest() {
    let folder = scene(ROUGH);
    for (points, parts) in [
        ("66", &["64 or 70"][..]),
        ("[64, 63]", &["64 along x", "60 or 64 along y"]),
    ] {
        let set = format!("grid.points={points}");
        let call = [
            "--backend",
            "gpu",
            "--set",
            &set,
            "--set",
            "surface.0.shortest=0.3e-6",
        ];
        let output = run(folder.path(), "gpu", &call, None);
        assert_eq!(output.status.code(), Some(2), "{}", errors(&output));
        for part in parts {
            let message = errors(&output);
            assert!(message.contains(part), "{part} is missing in {message}");
        }
        assert!(!folder.path().join("gpu").exists());
    }
}

fn devices_names_the_adapter() {
    let device = device();
    let output = tabor(Path::new("."), &["devices"]);
    assert_eq!(output.status.code(), Some(0));
    let text = String::from_utf8_lossy(&output.stdout);
    for part in [device.description().name.as_str(), "largest", "auto  "] {
        assert!(text.contains(part), "{part} is missing in:\n{text}");
    }
}

/// With the adapter's double precision taken away: refused where it is asked for, left where the choice is
/// free, and corrected by the processor in mixed.
fn without_double_precision_it_is_refused_with_what_does_as_well() {
    device();
    let folder = scene(ROUGH);
    let call = ["--backend", "gpu", "--precision", "double"];
    let output = run_tested(folder.path(), "gpu", &call, None, "nodouble");
    let message = errors(&output);
    assert_eq!(output.status.code(), Some(4), "{message}");
    assert!(message.contains("has no double precision"), "{message}");
    assert!(message.contains("\"mixed\" reaches"), "{message}");
    assert!(!folder.path().join("gpu").exists());
    let call = ["--precision", "double"];
    let output = run_tested(folder.path(), "auto", &call, None, "software,nodouble");
    let message = errors(&output);
    assert_eq!(output.status.code(), Some(0), "{message}");
    assert!(message.contains("it has no double precision"), "{message}");
    assert_eq!(summary(&folder.path().join("auto"))["backend"], "cpu");
    let call = ["--backend", "gpu", "--precision", "mixed"];
    let output = run_tested(folder.path(), "mixed", &call, None, "nodouble");
    assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    assert_eq!(summary(&folder.path().join("mixed"))["precision"], "mixed");
}

/// Where the choice is free, double precision goes to an adapter that has it.
fn double_precision_goes_to_an_adapter_that_has_it() {
    device_with_double();
    let folder = scene(ROUGH);
    let call = ["--precision", "double"];
    let output = run_tested(folder.path(), "auto", &call, None, "software");
    let message = errors(&output);
    assert_eq!(output.status.code(), Some(0), "{message}");
    assert!(message.contains("in double precision"), "{message}");
    let said = summary(&folder.path().join("auto"));
    assert_eq!(
        (&said["backend"], &said["precision"]),
        (&"gpu".into(), &"double".into())
    );
    // A field of 64 x 64 doubles takes 32 KiB.
    let output = run_tested(
        folder.path(),
        "gpu",
        &["--backend", "gpu", "--precision", "double"],
        None,
        "binding=2048",
    );
    let message = errors(&output);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(
        message.contains("takes up to 32 x 32 here in double precision"),
        "{message}"
    );
}

/// A field of 64 x 64 points takes 16 KiB. One that binds 1 KiB holds it in sixteen slabs, but not the
/// sums of their sixteen workgroups; 32 x 32 fit.
fn a_grid_past_the_limits_is_refused_with_the_largest_and_auto_stays() {
    device();
    let folder = scene(ROUGH);
    let gpu = ["--backend", "gpu"];
    let output = run_tested(folder.path(), "gpu", &gpu, None, "binding=1024");
    let message = errors(&output);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(message.contains("takes up to 32 x 32 here"), "{message}");
    assert!(!folder.path().join("gpu").exists());
    let output = run_tested(folder.path(), "auto", &[], None, "software,binding=1024");
    let message = errors(&output);
    assert_eq!(output.status.code(), Some(0), "{message}");
    assert!(message.contains("on the processor, not on"), "{message}");
    assert!(message.contains("takes up to 32 x 32 here"), "{message}");
    let said = summary(&folder.path().join("auto"));
    assert_eq!(
        (&said["backend"], &said["precision"]),
        (&"cpu".into(), &"double".into())
    );
}

/// The device is given up amid the second step: what is solved is kept. Where the scene leaves the
/// choice the processor continues, to the same curve.
fn a_lost_device_keeps_what_is_solved_and_auto_goes_on() {
    keeps_what_is_solved("lost", "error: the device failed");
}

/// The same where numbers on the device are none.
fn a_number_that_is_none_keeps_what_is_solved_and_auto_goes_on() {
    keeps_what_is_solved("nan", "are no longer finite");
}

/// After so many dispatches as `fault` counts, the device fails with these words.
fn keeps_what_is_solved(fault: &str, words: &str) {
    device();
    let folder = scene(SPHERE);
    let whole = run(folder.path(), "cpu", &["--backend", "cpu"], None);
    assert_eq!(whole.status.code(), Some(0), "{}", errors(&whole));
    let all = rows(&folder.path().join("cpu"));
    // Amid the path, after its first step.
    let lost = [400, 800, 1600].into_iter().find(|dispatches| {
        let lost = format!("{fault}={dispatches}");
        let output = run_tested(folder.path(), "gpu", &["--backend", "gpu"], None, &lost);
        let message = errors(&output);
        assert_eq!(output.status.code(), Some(4), "{message}");
        assert!(message.contains(words), "{message}");
        assert!(!message.contains("panicked"), "{message}");
        let kept = rows(&folder.path().join("gpu"));
        assert!(kept.len() < all.len());
        !kept.is_empty() && message.contains("kept in")
    });
    let lost = lost.expect("a loss amid the path");
    let tested = format!("software,{fault}={lost}");
    let output = run_tested(folder.path(), "auto", &[], None, &tested);
    let message = errors(&output);
    assert_eq!(output.status.code(), Some(0), "{message}");
    assert!(message.contains("the processor continues"), "{message}");
    assert!(!message.contains("panicked"), "{message}");
    let said = summary(&folder.path().join("auto"));
    assert_eq!(said["backend"], "cpu");
    let warnings = said["warnings"].to_string();
    assert!(warnings.contains("were solved on gpu"), "{warnings}");
    let found = rows(&folder.path().join("auto"));
    assert_eq!(found.len(), all.len());
    for (found, all) in found.iter().zip(&all) {
        assert_eq!(found["state"], all["state"]);
        let number = |row: &std::collections::HashMap<String, String>| -> f64 {
            row["approach"].parse().expect("a number")
        };
        // Both to a residual of 1e-6.
        assert!((number(found) - number(all)).abs() <= 1e-5 * number(all).abs());
    }
}

/// Sixteen kilobytes of the fields, then no more.
fn a_device_out_of_memory_says_so_and_auto_goes_on() {
    device();
    let folder = scene(ROUGH);
    let gpu = ["--backend", "gpu"];
    let output = run_tested(folder.path(), "gpu", &gpu, None, "memory=40000");
    let message = errors(&output);
    assert_eq!(output.status.code(), Some(4), "{message}");
    assert!(message.contains("out of memory on "), "{message}");
    assert!(message.contains("no room for `"), "{message}");
    assert!(message.contains("--backend cpu"), "{message}");
    assert!(!message.contains("panicked"), "{message}");
    let output = run_tested(folder.path(), "auto", &[], None, "software,memory=40000");
    let message = errors(&output);
    assert_eq!(output.status.code(), Some(0), "{message}");
    assert!(message.contains("the processor continues"), "{message}");
    let said = summary(&folder.path().join("auto"));
    assert_eq!(said["backend"], "cpu");
    // Also where no step was finished before.
    let warnings = said["warnings"].to_string();
    assert!(warnings.contains("out of memory on "), "{warnings}");
}

/// A buffer of 4 KiB holds a fourth of a field of 64 x 64; the coarse grid of the wall stays whole.
fn a_run_in_slabs_gives_the_same_bytes() {
    device();
    let folder = scene(ROUGH);
    let call = ["--backend", "gpu", "--set", "solver.tolerance=1e-4"];
    for (out, tested) in [("one", ""), ("four", "slab=4096")] {
        let output = run_tested(folder.path(), out, &call, None, tested);
        assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    }
    for name in ["gap", "pressure"] {
        let bytes = |out: &str| {
            let path = folder
                .path()
                .join(format!("{out}/fields/step_0003_{name}.npy"));
            fs::read(path).expect("a field")
        };
        assert!(bytes("one") == bytes("four"), "{name}");
    }
}

/// Where the driver undoes compensated sums, plain ones do for a tolerance of single precision: their
/// error over 64 x 64 points, added in halves, is below 1e-6.
fn plain_sums_are_said_and_reach_the_tolerance() {
    device();
    let folder = scene(ROUGH);
    let call = ["--backend", "gpu", "--set", "solver.tolerance=1e-4"];
    let output = run_tested(folder.path(), "gpu", &call, None, "plain-sums");
    let message = errors(&output);
    assert_eq!(output.status.code(), Some(0), "{message}");
    assert!(
        message.contains("adds in plain single precision"),
        "{message}"
    );
    let found = rows(&folder.path().join("gpu"));
    assert_eq!(found.len(), 3);
    for row in &found {
        assert_eq!(row["converged"], "true");
        assert!(row["residual"].parse::<f64>().expect("a number") <= 1e-4);
    }
}

tests![
    an_adhesive_sphere_agrees_with_the_processor,
    an_adhesive_sphere_in_double_precision_agrees_with_the_processor,
    a_solid_that_flows_is_solved_in_double_precision,
    a_rough_surface_agrees_with_the_processor,
    steps_into_the_lennard_jones_core_agree_with_the_processor,
    without_an_adapter_gpu_fails_and_auto_does_not,
    sizes_without_a_transform_are_refused_with_the_nearest,
    devices_names_the_adapter,
    without_double_precision_it_is_refused_with_what_does_as_well,
    double_precision_goes_to_an_adapter_that_has_it,
    a_grid_past_the_limits_is_refused_with_the_largest_and_auto_stays,
    a_lost_device_keeps_what_is_solved_and_auto_goes_on,
    a_number_that_is_none_keeps_what_is_solved_and_auto_goes_on,
    a_device_out_of_memory_says_so_and_auto_goes_on,
    a_run_in_slabs_gives_the_same_bytes,
    plain_sums_are_said_and_reach_the_tolerance,
];
