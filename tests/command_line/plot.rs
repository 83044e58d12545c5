//! `tabor plot`: several runs in one picture, with its vectors and its data.

use std::fs;

use crate::shared::binary::{errors, number, table, tabor};
use crate::shared::trials::tests;

/// Two runs in one picture, whose data are those of their curves.
fn two_runs_make_one_picture() {
    let place = tempfile::tempdir().expect("a folder");
    let path = place.path();
    assert_eq!(tabor(path, &["new", "seal"]).status.code(), Some(0));
    for (out, modulus) in [("soft", "10 MPa"), ("hard", "30 MPa")] {
        let modulus = format!("solid.young_modulus={modulus}");
        let call = [
            "run",
            "seal/scene.toml",
            "--out",
            out,
            "--quiet",
            "--set",
            &modulus,
            "--set",
            "grid.points=32",
            "--set",
            "surface.0.shortest=20 um",
        ];
        let output = tabor(path, &call);
        assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
        // Every picture of a curve has its vectors beside it.
        let svg = fs::read_to_string(path.join(out).join("curve.svg")).expect("a picture");
        assert!(
            svg.contains("mm\"") && svg.contains("contact area"),
            "{svg}"
        );
    }
    let output = tabor(path, &["plot", "soft", "hard"]);
    assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    let svg = fs::read_to_string(path.join("plot.svg")).expect("a picture");
    for word in [">soft<", ">hard<", ">force against approach<"] {
        assert!(svg.contains(word), "{word}: {svg}");
    }
    assert!(
        image::open(path.join("plot.png"))
            .expect("a picture")
            .width()
            > 500
    );
    let drawn = table(&path.join("plot.csv"));
    let curves = ["soft", "hard"].map(|out| table(&path.join(out).join("curve.csv")));
    assert_eq!(drawn.len(), curves[0].len() + curves[1].len());
    for (row, step) in drawn.iter().zip(curves.iter().flatten()) {
        for name in ["approach", "force", "contact_area_fraction"] {
            assert_eq!(number(row, name), number(step, name), "{name}");
        }
    }
    let call = [
        "plot",
        "soft",
        "hard",
        "--x",
        "mean_pressure",
        "--y",
        "iterations",
        "--out",
        "more",
    ];
    assert_eq!(tabor(path, &call).status.code(), Some(0));
    assert_eq!(table(&path.join("more.csv"))[0].len(), 4);
    for (call, expected) in [
        (&["plot", "absent"][..], "absent: cannot be read"),
        (
            &["plot", "soft", "--x", "forse", "--y", "force"],
            "there is no column forse; there are step, ",
        ),
        (&["plot", "soft", "--x", "force"], "--y"),
    ] {
        let output = tabor(path, call);
        assert_eq!(output.status.code(), Some(2), "{call:?}");
        assert!(errors(&output).contains(expected), "{}", errors(&output));
    }
}

tests![two_runs_make_one_picture,];
