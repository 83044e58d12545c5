//! `tabor surface` from outside: the table, the scene in it, the pictures.

use std::fs;
use std::path::Path;

use crate::shared::binary::{errors, tabor};
use crate::shared::trials::tests;

/// Standard output of a call that ends well.
fn report(folder: &Path, arguments: &[&str]) -> String {
    let output = tabor(folder, arguments);
    assert!(
        output.status.success(),
        "{arguments:?}: {}",
        errors(&output)
    );
    String::from_utf8(output.stdout).expect("UTF-8")
}

/// The value of a quantity in the table.
fn quantity(report: &str, name: &str) -> f64 {
    let row = report
        .lines()
        .map(|line| line.split_whitespace().collect::<Vec<_>>())
        .find(|words| words.get(1) == Some(&name))
        .unwrap_or_else(|| panic!("no {name} in {report}"));
    row[2].parse().expect("a number")
}

/// The value of a key in the first `[[surface]]`.
fn key(report: &str, name: &str) -> f64 {
    let table: toml::Table = report.parse().expect("TOML");
    let part = &table["surface"].as_array().expect("an array")[0];
    part[name].as_float().expect("a number")
}

fn close(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found / expected - 1.0).abs() < tolerance,
        "{found:e}, {expected:e}"
    );
}

/// Solid and load, which a surface does not have.
const REST: &str =
    "[solid]\ncontact_modulus = 1e9\n[loading]\ncontrol = \"pressure\"\npath = [1e6]\n";

fn self_affine(points: usize, size: f64, hurst: f64, waves: [f64; 3], seed: u32) -> String {
    let [longest, rolloff, shortest] = waves.map(|waves| size / waves);
    format!(
        "[grid]\npoints = {points}\nsize = {size:e}\n[[surface]]\nkind = \"self-affine\"\nhurst = {hurst}\n\
         rms_slope = 0.1\nlongest = {longest:e}\nrolloff = {rolloff:e}\nshortest = {shortest:e}\nseed = {seed}\n{REST}"
    )
}

fn the_statistics_of_an_egg_box_are_exact() {
    let folder = tempfile::tempdir().unwrap();
    let scene = format!(
        "[grid]\npoints = [64, 32]\nsize = [\"4 um\", \"2 um\"]\n[[surface]]\nkind = \"wavy\"\namplitude = \"1 nm\"\n\
         wavelength = [\"1 um\", \"1 um\"]\n{REST}"
    );
    fs::write(folder.path().join("box.toml"), scene).unwrap();
    let report = report(folder.path(), &["surface", "box.toml"]);
    // A cos qx cos qy: <h^2> = A^2/4, <|grad h|^2> = q^2 A^2/2, lap h = -2 q^2 h; six digits are printed.
    let wavenumber = 2.0 * std::f64::consts::PI / 1e-6;
    let q = wavenumber * 1e-9;
    close(quantity(&report, "rms_height"), 0.5e-9, 1e-5);
    close(quantity(&report, "rms_slope"), q / 2_f64.sqrt(), 1e-5);
    close(quantity(&report, "rms_curvature"), q * wavenumber, 1e-5);
    close(quantity(&report, "m0"), 0.25e-18, 1e-5);
    close(quantity(&report, "m2"), q * q / 4.0, 1e-5);
    close(
        quantity(&report, "m4"),
        0.375 * (q * wavenumber).powi(2),
        1e-5,
    );
    close(quantity(&report, "nayak"), 1.5, 1e-5);
    close(quantity(&report, "highest"), 1e-9, 1e-5);
    assert_eq!(quantity(&report, "points_y"), 32.0);
    // Two rings at most have any power: no power law.
    assert!(report.contains("# no self-affine fit: "), "{report}");
    assert!(!folder.path().join("box_surface/scene.toml").exists());
    assert!(folder.path().join("box_surface/heights.png").exists());
}

fn a_scene_s_own_parameters_come_back_and_make_a_scene() {
    let folder = tempfile::tempdir().unwrap();
    // Tolerances are those of src/surface/fit_tests.rs, for the same reasons.
    for (hurst, waves, seed) in [
        (0.3, [1.0, 4.0, 50.0], 1),
        (0.6, [1.0, 6.0, 50.0], 2),
        (0.8, [2.0, 8.0, 50.0], 3),
    ] {
        fs::write(
            folder.path().join("a.toml"),
            self_affine(128, 2e-6, hurst, waves, seed),
        )
        .unwrap();
        let first = report(folder.path(), &["surface", "a.toml", "--out", "a"]);
        assert!((key(&first, "hurst") - hurst).abs() < 0.02, "{first}");
        close(key(&first, "rolloff"), 2e-6 / waves[1], 0.06);
        close(key(&first, "shortest"), 2e-6 / waves[2], 0.01);
        // The band begins between two rings, 12 % apart and more at the first modes.
        close(key(&first, "longest"), 2e-6 / waves[0], 0.2);
        close(
            key(&first, "rms_height"),
            quantity(&first, "rms_height"),
            0.03,
        );
        // What is printed is the beginning of a scene; the scene in the folder is a whole one.
        fs::write(folder.path().join("b.toml"), format!("{first}{REST}")).unwrap();
        for scene in ["b.toml", "a/scene.toml"] {
            let output = tabor(folder.path(), &["check", scene]);
            assert!(output.status.success(), "{scene}: {}", errors(&output));
            assert!(
                !errors(&output).contains("longer than the grid"),
                "{}",
                errors(&output)
            );
        }
        let second = report(folder.path(), &["surface", "b.toml", "--out", "b"]);
        close(
            quantity(&second, "rms_slope"),
            quantity(&first, "rms_slope"),
            0.05,
        );
        fs::remove_dir_all(folder.path().join("b")).unwrap();
        fs::remove_dir_all(folder.path().join("a")).unwrap();
    }
}

fn a_measured_patch_leads_to_a_scene() {
    let folder = tempfile::tempdir().unwrap();
    let map = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/scenes/ground.txt");
    let map = map.to_str().expect("UTF-8");
    let found = report(
        folder.path(),
        &["surface", map, "--detrend", "plane", "--out", "out"],
    );
    close(quantity(&found, "size_x"), 1e-5, 1e-12);
    assert!(quantity(&found, "mean_height").abs() < 1e-15);
    let length = quantity(&found, "correlation_length");
    assert!(1e-7 < length && length < 5e-6, "{length:e}");
    let out = folder.path().join("out");
    for name in ["heights.png", "psd.png"] {
        let picture = image::open(out.join(name)).expect(name);
        assert!(picture.width() > 200 && picture.height() > 200, "{name}");
    }
    // The table of the folder is the printed one.
    let table = fs::read_to_string(out.join("psd.csv")).unwrap();
    let mut rows = table.lines();
    assert_eq!(
        rows.next(),
        Some("wavenumber [1/m],density [m^4],modes,fit [m^4]")
    );
    let rows: Vec<&str> = rows.collect();
    assert!(rows.len() > 20);
    for row in rows {
        let fields: Vec<&str> = row.split(',').collect();
        let number: f64 = fields[0].parse().unwrap();
        assert!(found.contains(&format!("{number:.5e}")), "{row}");
        assert!(fields[1].parse::<f64>().unwrap() >= 0.0);
    }
    let check = tabor(folder.path(), &["check", "out/scene.toml"]);
    assert!(check.status.success(), "{}", errors(&check));
    // Of a patch the mean slope of all is what a tilt adds.
    let tilted = report(folder.path(), &["surface", map, "--out", "tilted"]);
    assert!(quantity(&tilted, "rms_slope") > quantity(&found, "rms_slope"));
}

fn a_flat_surface_has_statistics_and_no_fit() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("flat.txt"), "5 5 5\n5 5 5\n").unwrap();
    let report = report(
        folder.path(),
        &[
            "surface",
            "flat.txt",
            "--size",
            "3 um, 2 um",
            "--unit",
            "nm",
        ],
    );
    assert_eq!(quantity(&report, "mean_height"), 5e-9);
    // The mean of six numbers is one of them but for its last bit.
    assert!(quantity(&report, "rms_height") < 5e-24);
    assert!(report.contains("nayak                -"), "{report}");
    assert!(
        report.contains("# no self-affine fit: the surface is flat"),
        "{report}"
    );
    let few = "1 2 1\n4 1 0\n";
    fs::write(folder.path().join("few.txt"), few).unwrap();
    let text = self::report(folder.path(), &["surface", "few.txt", "--size", "1 um"]);
    assert!(text.contains("rings of the spectrum are too few"), "{text}");
}

fn folders_of_others_are_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.txt"), "1 2\n4 1\n").unwrap();
    fs::create_dir(folder.path().join("thesis")).unwrap();
    fs::write(folder.path().join("thesis/heights.png"), "mine").unwrap();
    let call = ["surface", "a.txt", "--size", "1 um", "--out"];
    let output = tabor(folder.path(), &[&call[..], &["thesis"]].concat());
    assert_eq!(output.status.code(), Some(2), "{}", errors(&output));
    assert!(errors(&output).contains("holds files that tabor did not write"));
    assert_eq!(
        fs::read(folder.path().join("thesis/heights.png")).unwrap(),
        b"mine"
    );
    // Its own it replaces.
    for _ in 0..2 {
        let output = tabor(folder.path(), &[&call[..], &["mine"]].concat());
        assert!(output.status.success(), "{}", errors(&output));
    }
    let output = tabor(folder.path(), &[&call[..], &["a.txt/inside"]].concat());
    assert_eq!(output.status.code(), Some(2), "{}", errors(&output));
    #[cfg(target_os = "linux")]
    {
        // Nobody makes a folder there.
        let output = tabor(folder.path(), &[&call[..], &["/proc/tabor"]].concat());
        assert_eq!(output.status.code(), Some(1), "{}", errors(&output));
    }
}

tests![
    the_statistics_of_an_egg_box_are_exact,
    a_scene_s_own_parameters_come_back_and_make_a_scene,
    a_measured_patch_leads_to_a_scene,
    a_flat_surface_has_statistics_and_no_fit,
    folders_of_others_are_left_alone,
];
