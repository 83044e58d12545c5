//! Values at the ends of what a scene may say: a run ends, and a row that counts as converged holds
//! numbers.

use std::fs;

use crate::shared::binary::{errors, tabor};
use crate::shared::trials::tests;

const SCENE: &str = r#"[grid]
points = 16
size = "10 um"
[solid]
contact_modulus = "50 MPa"
[[surface]]
kind = "sphere"
radius = "1 um"
[loading]
control = "force"
path = ["10 uN", "20 uN"]
[solver]
max_iterations = 300
"#;

fn a_converged_row_holds_numbers() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("scene.toml"), SCENE).expect("a scene");
    let (mut converged, mut failed) = (0, 0);
    for set in [
        "grid.size=1e30",
        "grid.size=1e-30",
        "grid.points=[1, 1]",
        "grid.points=[1, 64]",
        "grid.points=[2, 3]",
        "solid.contact_modulus=1e30",
        "solid.contact_modulus=1e-30",
        "surface.0.radius=1e30",
        "surface.0.radius=1e-30",
        "surface.0={ kind = 'flat' }",
        "surface.0={ kind = 'cone', half_angle = 1e-30 }",
        "surface.0={ kind = 'cone', half_angle = 89.99999999 }",
        "surface.0={ kind = 'wavy', amplitude = 1e30, wavelength = '10 um' }",
        "surface.0={ kind = 'wavy', amplitude = 1e-30, wavelength = '10 um' }",
        "loading.path=[1e30]",
        "loading.path=[1e-30, -1e-30, 0, -0.0]",
        "loading.path=[-1e30]",
        "loading={ control = 'approach', path = [1e30] }",
        "loading={ control = 'approach', path = [-1e30] }",
        "loading={ control = 'mean-gap', path = [1e30, 1e-30] }",
        "adhesion={ law = 'exponential', work_of_adhesion = 1e30, range = 1e-30 }",
        "adhesion={ law = 'exponential', work_of_adhesion = 1e-30, range = 1e30 }",
        "adhesion={ law = 'maugis-dugdale', work_of_adhesion = 1e30, range = 1e30 }",
        "adhesion={ law = 'maugis-dugdale', work_of_adhesion = 1e-30, range = 1e-30 }",
        "adhesion={ law = 'lennard-jones', work_of_adhesion = 1e30, range = 1e-30 }",
        "adhesion={ law = 'lennard-jones', work_of_adhesion = 1e-30, range = 1e30 }",
    ] {
        for precision in ["double", "single"] {
            let _ = fs::remove_dir_all(folder.path().join("scene"));
            let run = ["run", "scene.toml", "--quiet", "--backend", "cpu"];
            let call = [&run[..], &["--precision", precision, "--set", set]].concat();
            let output = tabor(folder.path(), &call);
            let message = errors(&output);
            let status = output.status.code();
            assert!(
                matches!(status, Some(0 | 2 | 3)) && !message.contains("panicked"),
                "{set}, {precision}: {status:?} {message}"
            );
            let curve =
                fs::read_to_string(folder.path().join("scene/curve.csv")).unwrap_or_default();
            for row in curve.lines().skip(1) {
                if row.contains(",true,") {
                    converged += 1;
                    assert!(
                        !row.contains("NaN") && !row.contains("inf"),
                        "{set}, {precision}: {row}"
                    );
                } else {
                    failed += 1;
                }
            }
            let rows_end = curve
                .lines()
                .last()
                .is_none_or(|row| row.contains(",true,"));
            assert_eq!(rows_end, status != Some(3), "{set}, {precision}: {message}");
        }
    }
    println!("{converged} rows converged, {failed} did not");
    assert!(converged > 20);
}

tests![a_converged_row_holds_numbers,];
