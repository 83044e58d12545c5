//! `tabor plot`: several runs in one picture, with its vectors and its data.

use std::fs;
use std::path::{Path, PathBuf};

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

/// What a call reads, and the rows of any run, are never replaced by its outputs: refused before anything is written.
fn outputs_do_not_overwrite_what_is_read() {
    let place = tempfile::tempdir().expect("a folder");
    let path = place.path();
    let text = fs::read_to_string("examples/force_curve.csv").expect("a curve");
    let rows = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    let curve = rows.fold("approach,force\n".to_owned(), |curve, row| {
        let (approach, force) = row.split_once(',').expect("two columns, nm and nN");
        curve + &format!("{}e-9,{}e-9\n", approach.trim(), force.trim())
    });
    fs::create_dir_all(path.join("run/state")).expect("a folder");
    for name in ["run/curve.csv", "measured.csv", "fit.csv"] {
        fs::write(path.join(name), &curve).expect("written");
    }
    // The scene of a height map in grey, whose name is that of a picture of the comparison.
    let grey = image::GrayImage::from_fn(16, 16, |x, y| image::Luma([(x * y % 7) as u8 * 9]));
    for name in ["accuracy.png", "heights.png"] {
        grey.save(path.join(name)).expect("a picture");
    }
    let scene = r#"
grid = { size = "1 um" }
solid = { contact_modulus = "1 GPa" }
surface = [{ kind = "file", path = "accuracy.png", black = 0.0, white = "5 nm" }]
loading = { control = "pressure", path = ["1 MPa"] }
"#;
    fs::write(path.join("scene.toml"), scene).expect("written");
    #[cfg(unix)]
    std::os::unix::fs::symlink("measured.csv", path.join("linked.csv")).expect("a link");
    let by = ["--x", "approach", "--y", "force"];
    let plot =
        |files: [&'static str; 2]| [&["plot", files[0], "--out", files[1]], &by[..]].concat();
    let mut calls = vec![
        (
            plot(["run", "run/curve.png"]),
            "run/curve.csv: is read here",
        ),
        (
            plot(["./run/curve.csv", "run/../run/curve"]),
            "curve.csv: is read here",
        ),
        (
            plot(["measured.csv", "measured.png"]),
            "measured.csv: is read here",
        ),
        // Of a run that is not drawn, and of no run.
        (
            plot(["measured.csv", "run/curve.svg"]),
            "not an earlier table of this kind",
        ),
        (
            vec!["fit", "fit.csv", "--radius", "10 um", "--out", "."],
            "./fit.csv: is read here",
        ),
        (
            vec!["fit", "measured.csv", "--radius", "10 um", "--out", "."],
            "not an earlier table of this kind",
        ),
        (
            vec!["accuracy", "scene.toml", "--out", "."],
            "./accuracy.png: is read here",
        ),
        (
            vec![
                "surface",
                "heights.png",
                "--size",
                "1 um",
                "--black",
                "0",
                "--white",
                "1 nm",
                "--out",
                ".",
            ],
            ".: holds heights.png, which is read here",
        ),
        (
            vec!["surface", "scene.toml", "--out", "."],
            ".: holds ./accuracy.png",
        ),
    ];
    if cfg!(unix) {
        calls.push((
            plot(["measured.csv", "linked.png"]),
            "linked.csv: is read here",
        ));
        calls.push((
            plot(["linked.csv", "measured.png"]),
            "measured.csv: is read here",
        ));
    }
    let names = || {
        let mut found: Vec<_> = walk(path);
        found.sort();
        found
    };
    let before = names();
    for (call, expected) in calls {
        let output = tabor(path, &call);
        let said = errors(&output);
        assert_eq!(output.status.code(), Some(2), "{call:?}: {said}");
        assert!(said.contains(expected), "{call:?}: {said}");
        assert!(said.contains("with --out"), "{call:?}: {said}");
        assert_eq!(names(), before, "{call:?}");
    }
    // Its own outputs are replaced as ever.
    for _ in 0..2 {
        for call in [
            plot(["run", "drawn.png"]),
            vec!["fit", "measured.csv", "--radius", "10 um"],
        ] {
            let output = tabor(path, &call);
            assert_eq!(
                output.status.code(),
                Some(0),
                "{call:?}: {}",
                errors(&output)
            );
        }
    }
    // The picture's data can be drawn too, elsewhere.
    let output = tabor(path, &plot(["drawn.csv", "drawn.png"]));
    assert_eq!(output.status.code(), Some(2), "{}", errors(&output));
}

/// Column heads with units are read like those of force curves, and drawn in SI units; a plot without points is refused.
fn units_of_heads_count_and_an_empty_picture_is_refused() {
    let place = tempfile::tempdir().expect("a folder");
    let path = place.path();
    let curve =
        "# of an instrument\napproach [nm],force (uN),remark,nothing,t [s]\n1,2,a,,0\n3,5,b,,1\n";
    fs::write(path.join("curve.csv"), curve).expect("written");
    for x in ["approach", "approach [nm]"] {
        let output = tabor(path, &["plot", "curve.csv", "--x", x, "--y", "force"]);
        assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
        let drawn = table(&path.join("plot.csv"));
        for (row, [approach, force]) in drawn.iter().zip([[1e-9, 2e-6], [3e-9, 5e-6]]) {
            let near = |name, value: f64| {
                let found = number(row, name).expect("a number");
                assert!((found / value - 1.0).abs() < 1e-12, "{name}: {found}");
            };
            near("approach", approach);
            near("force", force);
        }
        let svg = fs::read_to_string(path.join("plot.svg")).expect("a picture");
        assert!(svg.contains("nm") && svg.contains("µN"), "{svg}");
        fs::remove_file(path.join("plot.png")).expect("a picture");
    }
    for y in ["remark", "nothing"] {
        let output = tabor(path, &["plot", "curve.csv", "--x", "t", "--y", y]);
        let said = errors(&output);
        assert_eq!(output.status.code(), Some(2), "{said}");
        let expected = format!("no row has a number both in t and in {y}");
        assert!(said.contains(&expected), "{said}");
        assert!(said.contains("approach, force, t"), "{said}");
        assert!(!path.join("plot.png").exists());
    }
}

/// The conductance of a current, which has a resistance too, is in S; that for heat in W/K.
fn a_conductance_has_the_unit_of_what_is_conducted() {
    let place = tempfile::tempdir().expect("a folder");
    let path = place.path();
    for (head, row, unit) in [
        ("approach,conductance", "1,2", ">W/K<"),
        ("approach,conductance,resistance", "1,2,0.5", ">S<"),
    ] {
        fs::write(path.join("curve.csv"), format!("{head}\n{row}\n")).expect("written");
        let call = ["plot", "curve.csv", "--x", "approach", "--y", "conductance"];
        let output = tabor(path, &call);
        assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
        let svg = fs::read_to_string(path.join("plot.svg")).expect("a picture");
        assert!(svg.contains(unit), "{svg}");
    }
    // Both in one picture have no common axis.
    fs::write(path.join("heat.csv"), "approach,conductance\n1,2\n").expect("written");
    let call = [
        "plot",
        "heat.csv",
        "curve.csv",
        "--x",
        "approach",
        "--y",
        "conductance",
    ];
    let output = tabor(path, &call);
    assert_eq!(output.status.code(), Some(2), "{}", errors(&output));
    let words = "conductance is in W/K in heat.csv and in S in curve.csv; draw them apart";
    assert!(errors(&output).contains(words), "{}", errors(&output));
}

/// A step that did not converge is told and not drawn: it would stretch the axis to 900 N.
fn steps_that_did_not_converge_are_left_out() {
    let place = tempfile::tempdir().expect("a folder");
    let path = place.path();
    let curve = "approach,force,converged\n0,1,true\n1,2,true\n2,900,false\n";
    fs::write(path.join("curve.csv"), curve).expect("written");
    let call = ["plot", "curve.csv", "--x", "approach", "--y", "force"];
    let output = tabor(path, &call);
    assert_eq!(output.status.code(), Some(0));
    let said = errors(&output);
    assert!(said.contains("row 3 did not converge"), "{said}");
    let svg = fs::read_to_string(path.join("plot.svg")).expect("a picture");
    assert!(!svg.contains(">800<"), "{svg}");
    assert_eq!(table(&path.join("plot.csv")).len(), 3);
}

/// Every file of a folder, with what is in it.
fn walk(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let entries = fs::read_dir(folder).expect("a folder");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    paths
        .flat_map(|path| {
            if path.is_dir() {
                walk(&path)
            } else {
                let bytes = fs::read(&path).expect("a file");
                vec![(path, bytes)]
            }
        })
        .collect()
}

tests![
    two_runs_make_one_picture,
    outputs_do_not_overwrite_what_is_read,
    units_of_heads_count_and_an_empty_picture_is_refused,
    a_conductance_has_the_unit_of_what_is_conducted,
    steps_that_did_not_converge_are_left_out,
];
