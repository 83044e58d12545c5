//! `tabor compare` from outside: its table, its picture, and what it refuses.

use std::f64::consts::{LN_2, PI};
use std::fs;
use std::path::Path;

use crate::shared::binary::{errors, tabor};
use crate::shared::trials::tests;

const HEAD: &str = "model,mean_pressure,contact_area_fraction,mean_gap,adhesive_pressure,pull_off_pressure,seconds,within_range,limit,branch";

const SMOOTH: &str = r#"
title = "Smooth stiff surface"
[grid]
points = 64
size = "24 um"
[solid]
contact_modulus = "1.33 TPa"
[[surface]]
kind = "self-affine"
hurst = 0.8
rms_height = "0.52 nm"
longest = "24 um"
rolloff = "6 um"
shortest = "3 um"
[adhesion]
law = "lennard-jones"
work_of_adhesion = "0.2 J/m^2"
range = "1 nm"
[loading]
control = "pressure"
path = ["10 MPa", "30 MPa", "60 MPa", "30 MPa"]
"#;

/// Stiff summits with a weak attraction.
const STIFF: &str = r#"
    [grid]
    points = 64
    size = "1 um"
    [solid]
    contact_modulus = "200 GPa"
    [[surface]]
    kind = "self-affine"
    hurst = 0.8
    rms_slope = 0.5
    longest = "1 um"
    rolloff = "0.5 um"
    shortest = "0.1 um"
    seed = 3
    [adhesion]
    law = "exponential"
    work_of_adhesion = "0.1 mJ/m^2"
    range = "0.5 nm"
    [loading]
    control = "pressure"
    path = ["10 Pa", "10 MPa"]
"#;

fn rows(path: &Path) -> Vec<Vec<String>> {
    let text = fs::read_to_string(path).expect("there is a table");
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some(HEAD));
    lines
        .map(|line| line.split(',').map(str::to_owned).collect())
        .collect()
}

fn number(row: &[String], column: &str) -> Option<f64> {
    let index = HEAD
        .split(',')
        .position(|name| name == column)
        .expect("a column");
    row[index].parse().ok()
}

fn of<'a>(rows: &'a [Vec<String>], model: &str) -> Vec<&'a Vec<String>> {
    rows.iter().filter(|row| row[0] == model).collect()
}

fn every_model_answers_at_every_load() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("smooth.toml"), SMOOTH).expect("written");
    let output = tabor(folder.path(), &["compare", "smooth.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    assert!(output.stdout.is_empty(), "standard output stays clean");
    let results = folder.path().join("smooth_compare");
    let rows = rows(&results.join("compare.csv"));
    let loads = [10e6, 30e6, 60e6];
    for model in ["full field", "DMT", "ICHA", "Persson", "GW-M", "BAM"] {
        let found = of(&rows, model);
        let pull_off = number(found[0], "pull_off_pressure").expect("a pull-off");
        // First the state of greatest tension, then the loads; the path goes back at its end.
        assert!(pull_off > 0.0, "{model}");
        assert!((number(found[0], "mean_pressure").unwrap() / -pull_off - 1.0).abs() < 1e-6);
        let asked = if model == "full field" { 4 } else { 3 };
        assert_eq!(found.len(), 1 + asked, "{model}");
        for (row, load) in found[1..].iter().zip(loads) {
            assert_eq!(row.len(), 10);
            assert!((number(row, "mean_pressure").unwrap() / load - 1.0).abs() < 1e-9);
            assert_eq!(number(row, "pull_off_pressure"), Some(pull_off));
            // GW-M pressed below its mean plane has none, and says that it is out of range.
            let gap = number(row, "mean_gap");
            assert!(gap.is_some_and(|gap| gap > 0.0) || model == "GW-M" && row[7] == "false");
            assert!(number(row, "adhesive_pressure").unwrap() > 0.0);
            assert!(number(row, "seconds").unwrap() >= 0.0);
            assert_eq!(row[7] == "true", row[8].is_empty());
        }
    }
    // The path of the field goes up and back; models answer each load once.
    let branches = |model: &str| -> Vec<String> {
        of(&rows, model).iter().map(|row| row[9].clone()).collect()
    };
    let up = ["pull-off", "loading", "loading", "loading"];
    assert_eq!(branches("full field"), [&up[..], &["unloading"]].concat());
    assert_eq!(branches("ICHA"), up);
    // The models know the same surface: areas at 30 MPa within a factor of two of the treatment of
    // DMT, whose own kind they are (4 summit spacings a side make no better statistics).
    let area = |model: &str| number(of(&rows, model)[2], "contact_area_fraction");
    let judge = area("DMT").expect("an area");
    for model in ["ICHA", "Persson"] {
        let found = area(model).expect("an area") / judge;
        assert!((0.5..2.0).contains(&found), "{model}: {found}");
    }
    assert_eq!(area("BAM"), None);
    let picture = image::open(results.join("compare.png")).expect("a picture");
    assert!(picture.width() > 600 && picture.height() > 600);
    for model in ["full field", "ICHA"] {
        assert!(
            errors(&output).lines().any(|line| line.starts_with(model)),
            "{model}"
        );
    }
    // A second comparison takes the place of the first.
    let again = tabor(
        folder.path(),
        &["compare", "smooth.toml", "--set", "loading.path=[3e7]"],
    );
    assert_eq!(again.status.code(), Some(0), "{}", errors(&again));
}

fn without_adhesion_and_from_a_file_the_models_that_can_answer_do() {
    let folder = tempfile::tempdir().expect("a folder");
    let waves = (0..32).map(|y| {
        let row = (0..32).map(|x| {
            let at = |k: f64, l: f64, phase: f64| {
                (2.0 * std::f64::consts::PI * (k * f64::from(x) + l * f64::from(y)) / 32.0 + phase)
                    .cos()
            };
            let height = at(1.0, 1.0, 0.3) + 0.5 * at(2.0, -1.0, 1.0) + 0.2 * at(3.0, 4.0, 2.0);
            format!("{:.6}", height)
        });
        row.collect::<Vec<_>>().join(" ")
    });
    let map: Vec<String> = waves.collect();
    fs::write(folder.path().join("map.txt"), map.join("\n")).expect("written");
    let scene = "[grid]\nsize = \"10 um\"\n[solid]\ncontact_modulus = \"1 GPa\"\n[[surface]]\nkind = \"file\"\npath = \"map.txt\"\nunit = \"nm\"\n[loading]\ncontrol = \"mean-gap\"\npath = [\"1 nm\", \"0.7 nm\"]\n";
    fs::write(folder.path().join("map.toml"), scene).expect("written");
    let output = tabor(folder.path(), &["compare", "map.toml", "--out", "here"]);
    assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    let rows = rows(&folder.path().join("here/compare.csv"));
    assert!(of(&rows, "DMT").is_empty() && of(&rows, "BAM").is_empty());
    assert!(
        errors(&output).contains("no [adhesion]"),
        "{}",
        errors(&output)
    );
    let full = of(&rows, "full field");
    assert_eq!(full.len(), 2);
    // The loads that the field needed at those gaps are what the models are asked.
    for model in ["ICHA", "GW-M"] {
        let found = of(&rows, model);
        assert_eq!(found.len(), 2, "{model}: {}", errors(&output));
        let asked = number(full[1], "mean_pressure").unwrap();
        assert!((number(found[1], "mean_pressure").unwrap() / asked - 1.0).abs() < 1e-9);
        assert_eq!(number(found[0], "pull_off_pressure"), Some(0.0));
    }
}

/// The heights of a self-affine scene, read from the file that its run wrote, have the spectrum that was fitted to them; one of their moments
/// alone knows of no roll-off, and its gap is 6 % narrower.
fn a_height_file_has_the_spectrum_of_its_scene() {
    let folder = tempfile::tempdir().expect("a folder");
    let (before, after) = SMOOTH.split_once("[adhesion]").expect("adhesion");
    let after = after.split_once("[loading]").expect("a path").1;
    let rough = format!("{before}[loading]{after}[output]\nfields = [\"heights\"]\nsteps = [1]\n")
        .replace("points = 64", "points = 128")
        .replace("shortest = \"3 um\"", "shortest = \"0.75 um\"");
    let (before, after) = rough.split_once("kind = ").expect("a surface");
    let after = after.split_once("[loading]").expect("a path").1;
    let file = format!(
        "{before}kind = \"file\"\npath = \"run/fields/step_0001_heights.npy\"\nunit = \"m\"\n[loading]{after}"
    );
    fs::write(folder.path().join("rough.toml"), &rough).expect("written");
    fs::write(folder.path().join("file.toml"), file).expect("written");
    for arguments in [
        &["run", "rough.toml", "--out", "run"][..],
        &["compare", "rough.toml", "--out", "own"],
        &["compare", "file.toml", "--out", "fitted"],
    ] {
        let output = tabor(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    }
    let [own, fitted] =
        ["own", "fitted"].map(|name| rows(&folder.path().join(name).join("compare.csv")));
    let [own, fitted] = [of(&own, "Persson"), of(&fitted, "Persson")];
    assert!(!own.is_empty() && own.len() == fitted.len());
    for (own, fitted) in own.into_iter().zip(fitted) {
        // The area hangs on the slope, which both take from the map; the gap on the fitted roll-off and Hurst exponent, whose errors
        // of some per cent move it by a few parts in ten thousand.
        for (column, within) in [("contact_area_fraction", 1e-6), ("mean_gap", 0.01)] {
            let [own, fitted] = [own, fitted].map(|row| number(row, column).expect("a number"));
            assert!(
                (fitted / own - 1.0).abs() < within,
                "{column}: {fitted}, {own}"
            );
        }
        assert_eq!(fitted[8], "self-affine spectrum fitted to the map");
    }
}

fn shapes_that_are_not_rough_are_refused_with_the_way_out() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("scene.toml");
    let refused = |scene: &str, words: &str| {
        fs::write(&path, scene).expect("written");
        let output = tabor(folder.path(), &["compare", "scene.toml"]);
        assert_eq!(output.status.code(), Some(2), "{}", errors(&output));
        assert!(errors(&output).contains(words), "{}", errors(&output));
        assert!(!folder.path().join("scene_compare").exists());
    };
    let head = "[grid]\npoints = 32\nsize = 1e-5\n[solid]\ncontact_modulus = 1e9\n";
    let load = "[loading]\ncontrol = \"pressure\"\npath = [1e6]\n";
    let sphere = "[[surface]]\nkind = \"sphere\"\nradius = 1e-4\n";
    refused(&format!("{head}{sphere}{load}"), "is a sphere");
    refused(
        &format!("{head}[[surface]]\nkind = \"flat\"\n{load}"),
        "flat",
    );
    let free = SMOOTH.replace("size = \"24 um\"", "size = \"24 um\"\nboundary = \"free\"");
    let free = free
        .replace("control = \"pressure\"", "control = \"force\"")
        .replace("MPa", "mN");
    refused(&free, "periodic");
}

/// The tension of a rough surface falls as it is drawn off, and rises again once a few high summits are all that is left: the
/// greatest is there, and beyond it nothing holds. The contact depends on its path, also where gaps are finer.
fn the_greatest_tension_is_found_behind_a_lesser_one_and_on_the_way_out() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = "[grid]\npoints = 64\nsize = \"20 um\"\n[solid]\ncontact_modulus = \"100 MPa\"\n[[surface]]\nkind = \"self-affine\"\n\
                 hurst = 0.8\nrms_slope = 0.12\nlongest = \"20 um\"\nrolloff = \"5 um\"\nshortest = \"2 um\"\n\
                 [adhesion]\nlaw = \"maugis-dugdale\"\nwork_of_adhesion = \"50 mJ/m^2\"\nrange = \"60 nm\"\n\
                 [loading]\ncontrol = \"pressure\"\npath = [\"2 MPa\"]\n";
    fs::write(folder.path().join("summits.toml"), scene).expect("written");
    let pull_off = |sets: &[&str]| {
        let compare = ["compare", "summits.toml", "--out", "compared"];
        let words: Vec<&str> = compare.iter().chain(sets).copied().collect();
        let output = tabor(folder.path(), &words);
        assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
        let rows = rows(&folder.path().join("compared/compare.csv"));
        number(of(&rows, "full field")[0], "pull_off_pressure").expect("a pull-off")
    };
    // Pulled at a load each holds 6155 to 6208 Pa and 15.69 to 15.79 kPa (`tabor run`, until = "apart"), and the gaps are a per cent apart.
    let few = pull_off(&[]);
    assert!((few / 6180.0 - 1.0).abs() < 0.02, "{few}");
    let kept = pull_off(&["--set", "adhesion.range=8 nm", "--set", "surface.0.seed=6"]);
    assert!((kept / 15.74e3 - 1.0).abs() < 0.03, "{kept}");
}

/// Almost closed surfaces let go spot by spot, so that the tension falls suddenly with each: gaps 16 times finer around the
/// greatest of 32 miss by 9 % what a load, raised until the surfaces part, finds to 0.1 %.
fn the_greatest_tension_before_a_sudden_fall_is_found() {
    let scene = "[grid]\npoints = 64\nsize = \"10 um\"\n[solid]\ncontact_modulus = \"25 MPa\"\n[[surface]]\nkind = \"self-affine\"\n\
                 hurst = 0.8\nrms_slope = 0.06\nlongest = \"10 um\"\nrolloff = \"5 um\"\nshortest = \"1.25 um\"\nseed = 57\n\
                 [adhesion]\nlaw = \"maugis-dugdale\"\nwork_of_adhesion = \"50 mJ/m^2\"\nrange = \"60 nm\"\n\
                 [loading]\ncontrol = \"pressure\"\npath = [\"0.4 MPa\"]\n";
    let [found, held] = pull_offs_of_full_field_and_run(scene, 10e-6);
    // 1 % of the gaps, and what the search by loads leaves.
    assert!((found / held - 1.0).abs() < 0.012, "{found} and {held}");
}

/// Stiff summits pull most where their last points in contact have just become points that attract. A finer retraction ended where all of the
/// attraction was still less than the greatest tension of the one before, 12 % below what loads find.
fn the_greatest_tension_of_stiff_summits_is_found_though_their_attraction_grows() {
    let scene = "[grid]\npoints = 64\nsize = \"2 um\"\n[solid]\ncontact_modulus = \"10 GPa\"\n[[surface]]\nkind = \"self-affine\"\n\
                 hurst = 0.8\nrms_slope = 0.1\nlongest = \"2 um\"\nrolloff = \"2 um\"\nshortest = \"0.25 um\"\nseed = 4\n\
                 [adhesion]\nlaw = \"maugis-dugdale\"\nwork_of_adhesion = \"20 mJ/m^2\"\nrange = \"3 nm\"\n\
                 [loading]\ncontrol = \"pressure\"\npath = [\"10 MPa\"]\n";
    let [found, held] = pull_offs_of_full_field_and_run(scene, 2e-6);
    // 1 % of the gaps, and what the search by loads leaves.
    assert!((found / held - 1.0).abs() < 0.012, "{found} and {held}");
}

/// A soft solid closes, and carries its peak tension of 500 kPa less the largest tension that flattening takes, 8 kPa here, until
/// it begins to open. Retraction from a thousandth of the way found 359 kPa.
fn a_closed_contact_holds_its_greatest_tension_as_it_begins_to_open() {
    let scene = "[grid]\npoints = 64\nsize = \"20 um\"\n[solid]\ncontact_modulus = \"0.1 MPa\"\n[[surface]]\nkind = \"self-affine\"\n\
                 hurst = 0.8\nrms_height = \"50 nm\"\nlongest = \"20 um\"\nrolloff = \"10 um\"\nshortest = \"2.5 um\"\n\
                 [adhesion]\nlaw = \"maugis-dugdale\"\nwork_of_adhesion = \"50 mJ/m^2\"\nrange = \"100 nm\"\n\
                 [loading]\ncontrol = \"pressure\"\npath = [\"1 MPa\"]\n";
    let [found, held] = pull_offs_of_full_field_and_run(scene, 20e-6);
    assert!((found / held - 1.0).abs() < 0.012, "{found} and {held}");
    // The search by loads is to 1e-3, and the flattening is of the map.
    assert!((held / 492e3 - 1.0).abs() < 0.005, "{held}");
}

/// Pull-off of a scene by `tabor compare`, and by loads that `tabor run` raises until the surfaces part, Pa, on a cell of this
/// side.
fn pull_offs_of_full_field_and_run(scene: &str, side: f64) -> [f64; 2] {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("scene.toml"), scene).expect("written");
    let calls = [
        &["compare", "scene.toml", "--out", "compared"][..],
        &[
            "run",
            "scene.toml",
            "--out",
            "pulled",
            "--set",
            "loading.until=apart",
            "--set",
            "loading.pull_off_tolerance=1e-3",
        ],
    ];
    for call in calls {
        let output = tabor(folder.path(), call);
        assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    }
    let rows = rows(&folder.path().join("compared/compare.csv"));
    let found = number(of(&rows, "full field")[0], "pull_off_pressure").expect("a pull-off");
    let summary = fs::read_to_string(folder.path().join("pulled/summary.json")).expect("a summary");
    let summary: serde_json::Value = serde_json::from_str(&summary).expect("JSON");
    let force = summary["pull_off_force"].as_f64().expect("a pull-off");
    [found, force / side.powi(2)]
}

/// Pull-off by the DMT treatment and by ICHA is of the law that the loads of DMT have: the sharp one, whatever taper the full field takes.
fn summed_attraction_has_no_automatic_taper() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = SMOOTH.replace(
        "law = \"lennard-jones\"\nwork_of_adhesion = \"0.2 J/m^2\"\nrange = \"1 nm\"",
        "law = \"maugis-dugdale\"\nwork_of_adhesion = \"50 mJ/m^2\"\nrange = \"1 nm\"",
    );
    assert_ne!(text, SMOOTH);
    fs::write(folder.path().join("sharp.toml"), text).expect("written");
    let found = |out: &str, set: &[&str]| {
        let call = [&["compare", "sharp.toml", "--out", out][..], set].concat();
        let output = tabor(folder.path(), &call);
        assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
        let rows = rows(&folder.path().join(out).join("compare.csv"));
        ["DMT", "ICHA"].map(|model| {
            let columns = ["mean_pressure", "adhesive_pressure"];
            columns.map(|name| number(of(&rows, model)[0], name).expect("a number"))
        })
    };
    let own = found("own", &[]);
    assert_eq!(own, found("sharp", &["--set", "adhesion.taper=0"]));
    // Of a sharp law a whole number of points attracts, each by its peak, and in contact, of DMT's field, the part of a pixel
    // that the staircase closes for each edge.
    let staircase = (PI - 1.0 + LN_2) / 24.0;
    for ([_, attraction], most_edges) in own.into_iter().zip([300, 0]) {
        let points = attraction / (50e-3 / 1e-9) * 64.0 * 64.0;
        let is_whole = |open: f64| (open - open.round()).abs() < 1e-6;
        let mut edges = 0..=most_edges;
        let found = edges.find(|edges| is_whole(points - staircase * f64::from(*edges)));
        println!("{points} points, with {found:?} edges");
        assert!(found.is_some(), "{points}");
    }
}

/// BAM's gap closes at (3/8) q0 h E* less its tension times the normal distribution from 0 to its range: 271.6 - 96.4 MPa. Of
/// the waves between 16.5 and 23 um a cell of 24 um has those of one length, steeper than any spectrum between the two.
fn models_say_where_they_end_and_whose_slope_they_have() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("smooth.toml"), SMOOTH).expect("written");
    let set = ["--set", "loading.path=[3e7, 3e8]"];
    let output = tabor(
        folder.path(),
        &[&["compare", "smooth.toml"][..], &set[..]].concat(),
    );
    assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    let end = "BAM ends here: at a mean gap of 0 it carries 175.2 MPa, and not 300 MPa";
    assert!(errors(&output).contains(end), "{}", errors(&output));
    let results = folder.path().join("smooth_compare/compare.csv");
    assert_eq!(of(&rows(&results), "BAM").len(), 2);
    let limit = |model: &str| of(&rows(&results), model)[0][8].clone();
    assert_eq!(limit("Persson"), "Tabor number above 0.237");

    let waves = SMOOTH
        .replace("longest = \"24 um\"", "longest = \"23 um\"")
        .replace("rolloff = \"6 um\"", "rolloff = \"23 um\"")
        .replace("shortest = \"3 um\"", "shortest = \"16.5 um\"");
    fs::write(folder.path().join("smooth.toml"), waves).expect("written");
    let output = tabor(folder.path(), &["compare", "smooth.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    assert_eq!(
        limit("Persson"),
        "spectrum of another rms slope than the map's"
    );
    assert_eq!(limit("BAM"), "");

    // Waves of 12 um and more: at 30 MPa ICHA finds 26 % in contact where the field has 61 % (DMT).
    let smooth = SMOOTH
        .replace("rolloff = \"6 um\"", "rolloff = \"24 um\"")
        .replace("shortest = \"3 um\"", "shortest = \"12 um\"");
    fs::write(folder.path().join("smooth.toml"), smooth).expect("written");
    let output = tabor(
        folder.path(),
        &["compare", "smooth.toml", "--set", "loading.path=[3e7]"],
    );
    assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    let rows = rows(&results);
    let icha = of(&rows, "ICHA")[1];
    assert!(number(icha, "contact_area_fraction").is_some_and(|area| area < 0.3));
    assert_eq!(icha[8], "load above that of 30 % contact");
}

/// Where asperities crowd, the circles of the model leave out 4 % of the surface on which it overlaps at 1 MPa and 22 % at 5 MPa. As an attraction at gap 0
/// these points added 40 to 60 % and more to that of an exponential law. Without them ICHA is as near to the summed attraction of the full field (DMT) as with a
/// Lennard-Jones law, 10 % at light loads (`docs/dmt_study.md`), and the gaps of the crowded state are marked.
fn crowded_asperities_do_not_attract_where_they_overlap() {
    let folder = tempfile::tempdir().expect("a folder");
    let crowded = r#"
        [grid]
        points = 64
        size = "10 um"
        [solid]
        contact_modulus = "1 GPa"
        [[surface]]
        kind = "self-affine"
        hurst = 0.8
        rms_slope = 0.05
        longest = "10 um"
        rolloff = "4 um"
        shortest = "0.8 um"
        [adhesion]
        law = "exponential"
        work_of_adhesion = "5 mJ/m^2"
        range = "5 nm"
        [loading]
        control = "pressure"
        path = ["1 MPa", "5 MPa"]
    "#;
    fs::write(folder.path().join("crowded.toml"), crowded).expect("written");
    let output = tabor(folder.path(), &["compare", "crowded.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    let rows = rows(&folder.path().join("crowded_compare/compare.csv"));
    let [dmt, icha] = ["DMT", "ICHA"].map(|model| of(&rows, model));
    let [of_field, of_model] = [dmt[1], icha[1]].map(|row| number(row, "adhesive_pressure"));
    let ratio = of_model.expect("a pressure") / of_field.expect("a pressure");
    assert!((ratio - 1.0).abs() < 0.1, "{ratio}");
    assert_eq!(icha[1][8], "");
    assert_eq!(icha[2][8], "overlap outside the contacts on more than 10 %");
}

/// Stiff summits whose attraction of 69 Pa is a millionth of what presses the first of them: they pull most where they begin to
/// touch, which ICHA's least load had passed. The undeformed surfaces are the same in both models.
fn stiff_summits_pull_most_where_they_begin_to_touch() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("stiff.toml"), STIFF).expect("written");
    let output = tabor(folder.path(), &["compare", "stiff.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    let rows = rows(&folder.path().join("stiff_compare/compare.csv"));
    let [icha, dmt] = ["ICHA", "DMT"].map(|model| {
        let of_model = of(&rows, model);
        assert_eq!(of_model.len(), 3, "{model}: pull-off and two loads");
        number(of_model[0], "pull_off_pressure").expect("a pull-off")
    });
    assert!(icha > 60.0 && icha < 80.0, "{icha}");
    // The same sum, in another order.
    assert!((icha / dmt - 1.0).abs() < 1e-12, "{icha} and {dmt}");
}

tests![
    stiff_summits_pull_most_where_they_begin_to_touch,
    models_say_where_they_end_and_whose_slope_they_have,
    summed_attraction_has_no_automatic_taper,
    the_greatest_tension_is_found_behind_a_lesser_one_and_on_the_way_out,
    the_greatest_tension_before_a_sudden_fall_is_found,
    the_greatest_tension_of_stiff_summits_is_found_though_their_attraction_grows,
    a_closed_contact_holds_its_greatest_tension_as_it_begins_to_open,
    every_model_answers_at_every_load,
    without_adhesion_and_from_a_file_the_models_that_can_answer_do,
    a_height_file_has_the_spectrum_of_its_scene,
    crowded_asperities_do_not_attract_where_they_overlap,
    shapes_that_are_not_rough_are_refused_with_the_way_out,
];
