//! Scenes on the graphics processor through the binary, against the processor in double precision.

mod gpu_shared;

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use gpu_shared::{device, relative_difference};
use serde_json::Value;
use tempfile::TempDir;

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

/// A folder with a scene in it.
fn scene(text: &str) -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::write(folder.path().join("scene.toml"), text).expect("the scene is written");
    folder
}

fn run(folder: &Path, out: &str, arguments: &[&str], drivers: Option<&str>) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_tabor"));
    command
        .current_dir(folder)
        .args(["run", "scene.toml", "--out", out])
        .args(arguments);
    if let Some(drivers) = drivers {
        command
            .env("VK_DRIVER_FILES", drivers)
            .env("VK_ICD_FILENAMES", drivers);
    }
    command.output().expect("the binary runs")
}

fn errors(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn summary(folder: &Path) -> Value {
    let bytes = fs::read(folder.join("summary.json")).expect("a summary");
    serde_json::from_slice(&bytes).expect("JSON")
}

/// Rows of the curve, by name.
fn rows(folder: &Path) -> Vec<std::collections::HashMap<String, String>> {
    let text = fs::read_to_string(folder.join("curve.csv")).expect("a curve");
    let mut lines = text.lines();
    let head: Vec<&str> = lines.next().expect("a head").split(',').collect();
    lines
        .map(|line| {
            head.iter()
                .zip(line.split(','))
                .map(|(name, value)| ((*name).to_owned(), value.to_owned()))
                .collect()
        })
        .collect()
}

fn field(folder: &Path, name: &str) -> npyz::NpyFile<std::io::Cursor<Vec<u8>>> {
    let path = folder.join(format!("fields/step_0003_{name}.npy"));
    let bytes = fs::read(path).expect("a field");
    npyz::NpyFile::new(std::io::Cursor::new(bytes)).expect("an npy file")
}

/// Runs a scene on both. The stopping measure is relative to the pressures, so at 1e-4 gaps agree
/// to as much and pressures, which weigh short waves, to ten times that (both come out better);
/// a few points at the rim may be closed in one and open in the other.
fn compare(text: &str) {
    let Some(device) = device() else { return };
    let folder = scene(text);
    let calls: [(&str, &[&str]); 2] = [
        ("gpu", &["--backend", "gpu"]),
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
    assert_eq!(said["precision"], "single");
    assert!(
        said["adapter"]
            .as_str()
            .is_some_and(|name| !name.is_empty())
    );
    assert!(summary(&cpu)["adapter"].is_null());
    let (one, two) = (rows(&gpu), rows(&cpu));
    assert_eq!(one.len(), two.len());
    for (step, (one, two)) in one.iter().zip(&two).enumerate() {
        assert_eq!(one["state"], two["state"], "step {step}");
        assert_eq!(one["converged"], "true");
        for (name, bound) in [
            ("mean_gap", 2e-4),
            ("approach", 5e-4),
            ("elastic_energy", 1e-3),
            ("contact_area_fraction", 1e-2),
        ] {
            let number = |text: &str| -> f64 { text.parse().expect("a number") };
            let (a, b) = (number(&one[name]), number(&two[name]));
            println!("step {step}: {name} {:.1e}", (a - b).abs() / b.abs());
            assert!((a - b).abs() <= bound * b.abs(), "{name}: {a} and {b}");
        }
    }
    for (name, bound) in [("gap", 2e-4), ("pressure", 2e-3)] {
        let single: Vec<f32> = field(&gpu, name).into_vec().expect("float32");
        let single: Vec<f64> = single.into_iter().map(f64::from).collect();
        let double: Vec<f64> = field(&cpu, name).into_vec().expect("float64");
        let error = relative_difference(&single, &double);
        println!("{name} {error:.1e}");
        assert!(error <= bound, "{name}: {error:e}");
    }
}

#[test]
fn an_adhesive_sphere_agrees_with_the_processor() {
    compare(SPHERE);
}

#[test]
fn a_rough_surface_agrees_with_the_processor() {
    compare(ROUGH);
}

#[test]
fn without_an_adapter_gpu_fails_and_auto_does_not() {
    let folder = scene(ROUGH);
    let nowhere = Some("/nonexistent");
    let gpu = run(folder.path(), "gpu", &["--backend", "gpu"], nowhere);
    // Drivers that are not Vulkan's do not listen.
    if gpu.status.success() {
        eprintln!("skipped: there is an adapter without Vulkan");
        return;
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
    let devices = Command::new(env!("CARGO_BIN_EXE_tabor"))
        .arg("devices")
        .env("VK_DRIVER_FILES", "/nonexistent")
        .env("VK_ICD_FILENAMES", "/nonexistent")
        .output()
        .expect("the binary runs");
    assert_eq!(devices.status.code(), Some(0));
    let text = String::from_utf8_lossy(&devices.stdout);
    assert!(text.contains("none found"), "{text}");
}

#[test]
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

#[test]
fn devices_names_the_adapter() {
    let Some(device) = device() else { return };
    let output = Command::new(env!("CARGO_BIN_EXE_tabor"))
        .arg("devices")
        .output()
        .expect("the binary runs");
    assert_eq!(output.status.code(), Some(0));
    let text = String::from_utf8_lossy(&output.stdout);
    for part in [device.description().name.as_str(), "largest", "auto  "] {
        assert!(text.contains(part), "{part} is missing in:\n{text}");
    }
}
