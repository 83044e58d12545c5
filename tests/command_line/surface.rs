//! `tabor surface` from outside: the table, the scene in it, the pictures.

use std::fs;
use std::path::Path;

use crate::shared::binary::{errors, scene, status, tabor};
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
    // The scene resolves its shortest wave and has the rms height of the map.
    let check = tabor(folder.path(), &["check", "out/scene.toml"]);
    assert!(check.status.success(), "{}", errors(&check));
    assert_eq!(errors(&check), "");
    let like = report(
        folder.path(),
        &["surface", "out/scene.toml", "--out", "like"],
    );
    close(
        quantity(&like, "rms_height"),
        quantity(&found, "rms_height"),
        0.02,
    );
    let few = [
        "run",
        "out/scene.toml",
        "--out",
        "run",
        "--set",
        "loading.path=[1e6]",
        "--set",
        "output.images=[]",
    ];
    let run = tabor(folder.path(), &few);
    assert!(run.status.success(), "{}", errors(&run));
    assert!(!errors(&run).contains("warning"), "{}", errors(&run));
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

fn keys_of_a_measured_scene_take_the_place_of_its_stand_ins() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.txt"), "1 2 3\n4 1 2\n0 1 3\n").unwrap();
    let (modulus, work) = ("solid.contact_modulus", "adhesion.work_of_adhesion");
    for (set, left) in [
        (&["solid.contact_modulus=1e9"][..], &[work][..]),
        (
            &["solid.young_modulus=1e9", "solid.poisson_ratio=0.3"],
            &[work],
        ),
        (&["solid={ contact_modulus = 1e9 }"], &[work]),
        (
            &["adhesion={ law = 'exponential', work_of_adhesion = 0.02, range = 1e-9 }"],
            &[modulus],
        ),
        (&["adhesion.peak_tension=1e6"], &[modulus, work]),
        (
            &["adhesion.peak_tension=1e6", "adhesion.range=1e-9"],
            &[modulus],
        ),
        (&["capillary={ humidity = 0.5 }"], &[modulus]),
    ] {
        let call = [
            "surface", "a.txt", "--unit", "nm", "--size", "1 um", "--out", "out",
        ];
        let set_words = set.iter().flat_map(|set| ["--set", set]);
        let output = tabor(
            folder.path(),
            &call.into_iter().chain(set_words).collect::<Vec<_>>(),
        );
        assert!(output.status.success(), "{set:?}: {}", errors(&output));
        let scene = fs::read_to_string(folder.path().join("out/measured.toml")).unwrap();
        let stand_ins = format!("# Stand-ins: {}. Put", left.join(", "));
        assert!(scene.contains(&stand_ins), "{set:?}: {scene}");
        let check = tabor(folder.path(), &["check", "out/measured.toml"]);
        assert!(check.status.success(), "{set:?}: {}", errors(&check));
    }
}

fn keys_that_change_the_map_are_told_to_be_of_the_scene_alone() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.txt"), "1 2 3\n4 1 2\n0 1 3\n").unwrap();
    let told = |set: &str| {
        let call = [
            "surface", "a.txt", "--unit", "nm", "--size", "1 um", "--out", "out",
        ];
        let output = tabor(folder.path(), &[&call[..], &["--set", set]].concat());
        assert!(output.status.success(), "{}", errors(&output));
        errors(&output)
    };
    for key in ["grid.size", "surface.0.scale"] {
        let warning = format!("warning: --set {key} is for measured.toml alone");
        let said = told(&format!("{key}=2"));
        assert!(said.contains(&warning), "{said}");
    }
    assert!(!told("solid.contact_modulus=1e9").contains("--set"));
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

/// A file of so many rows and columns.
fn matrix(
    folder: &Path,
    name: &str,
    [rows, columns]: [usize; 2],
    value: impl Fn(usize, usize) -> f64,
) {
    let line = |y| {
        (0..columns)
            .map(|x| format!("{:e}", value(y, x)))
            .collect::<Vec<_>>()
            .join(" ")
    };
    let text: Vec<String> = (0..rows).map(line).collect();
    fs::write(folder.join(name), text.join("\n") + "\n").expect("it is written");
}

/// Heights that `surface` has written.
fn written(folder: &Path) -> (Vec<u64>, Vec<f64>) {
    let bytes = fs::read(folder.join("heights.npy")).expect("heights");
    let file = npyz::NpyFile::new(&bytes[..]).expect("an npy file");
    (file.shape().to_vec(), file.into_vec().expect("doubles"))
}

fn a_line_scan_is_refused_or_taken_as_a_profile() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path();
    let height = |at: usize| 1e-8 * (at as f64 / 40.0 * std::f64::consts::TAU).cos();
    matrix(folder, "scan.txt", [40, 2], |y, x| {
        if x == 0 { 1e-7 * y as f64 } else { height(y) }
    });
    matrix(folder, "long.txt", [3, 3000], |_, x| height(x % 40));
    for (file, points) in [("scan.txt", "2 x 40"), ("long.txt", "3000 x 3")] {
        let output = tabor(folder, &["surface", file, "--size", "1 um"]);
        assert_eq!(output.status.code(), Some(2));
        let said = errors(&output);
        assert!(
            said.contains(&format!(
                "{points} points (x, y) are a line scan and no map; give --profile"
            )),
            "{said}"
        );
    }
    // Places and heights: the file has its size.
    let found = report(
        folder,
        &["surface", "scan.txt", "--profile", "--boundary", "periodic"],
    );
    close(quantity(&found, "size_x"), 4e-6, 1e-6);
    assert_eq!(
        [quantity(&found, "points_x"), quantity(&found, "points_y")],
        [40.0, 1.0]
    );
    close(quantity(&found, "rms_height"), 1e-8 / 2_f64.sqrt(), 1e-5);
    // Its moments are those of the profile that it is.
    let square = (std::f64::consts::TAU / 4e-6).powi(2);
    close(quantity(&found, "m2"), 0.5 * square * 1e-16, 1e-5);
    close(quantity(&found, "m4"), 0.5 * square * square * 1e-16, 1e-5);
    close(quantity(&found, "nayak"), 1.0, 1e-5);
    // Places may have a unit of their own, and few digits: 1/3 um, rounded by up to 1 % of a step.
    let lines: String = (0..40)
        .map(|at| format!("{:.2} {:e}\n", at as f64 / 3.0, height(at)))
        .collect();
    fs::write(
        folder.join("rounded.txt"),
        format!("# Lateral units: um\n{lines}"),
    )
    .unwrap();
    let found = report(
        folder,
        &[
            "surface",
            "rounded.txt",
            "--profile",
            "--boundary",
            "periodic",
        ],
    );
    close(quantity(&found, "size_x"), 40e-6 / 3.0, 1e-3);
    close(quantity(&found, "rms_height"), 1e-8 / 2_f64.sqrt(), 1e-5);
    // On terraces few heights differ from their neighbours.
    let terraces = |at: usize| if at == 84 { 500 } else { at / 64 % 2 };
    let lines: Vec<String> = (0..256)
        .map(|at| terraces(at).to_string() + if at % 16 == 15 { "\n" } else { " " })
        .collect();
    fs::write(folder.join("terraces.txt"), lines.concat()).unwrap();
    let output = tabor(
        folder,
        &[
            "surface",
            "terraces.txt",
            "--size",
            "1 um",
            "--unit",
            "nm",
            "--outliers",
            "6",
        ],
    );
    let part = "most of the 256 points equal the median of their neighbours";
    assert!(errors(&output).contains(part), "{}", errors(&output));
    // In a scene the key is named, and the profile repeats across.
    let scene = |keys: &str| {
        format!(
            "[grid]\npoints = [40, 8]\n[[surface]]\nkind = \"file\"\npath = \"scan.txt\"\n{keys}{REST}"
        )
    };
    fs::write(folder.join("a.toml"), scene("")).unwrap();
    let output = tabor(folder, &["check", "a.toml"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        errors(&output).contains("write profile = true"),
        "{}",
        errors(&output)
    );
    // A grid of the same points says that such a strip is meant.
    let strip = scene("").replace("[40, 8]", "[2, 40]");
    let strip = strip.replace(
        "points = [2, 40]\n",
        "points = [2, 40]\nsize = [\"0.2 um\", \"4 um\"]\n",
    );
    fs::write(folder.join("strip.toml"), strip).unwrap();
    let output = tabor(folder, &["check", "strip.toml"]);
    assert!(output.status.success(), "{}", errors(&output));
    fs::write(folder.join("b.toml"), scene("profile = true\n")).unwrap();
    let found = report(folder, &["surface", "b.toml"]);
    assert_eq!(
        [quantity(&found, "points_x"), quantity(&found, "points_y")],
        [40.0, 8.0]
    );
    // <h^2> of a cosine, and no slope across.
    close(quantity(&found, "rms_height"), 1e-8 / 2_f64.sqrt(), 1e-5);
    let slope = 1e-8 * std::f64::consts::TAU / 4e-6 / 2_f64.sqrt();
    close(quantity(&found, "rms_slope"), slope, 1e-5);
    // Across it goes as far as the grid.
    for (size, is_right) in [("4 um", true), ("3 um", false)] {
        let keys = format!("points = [40, 8]\nsize = [\"{size}\", \"0.8 um\"]");
        let scene = scene("profile = true\n").replace("points = [40, 8]", &keys);
        fs::write(folder.join("c.toml"), scene).unwrap();
        let output = tabor(folder, &["check", "c.toml"]);
        assert_eq!(output.status.success(), is_right, "{}", errors(&output));
    }
}

fn heights_in_another_unit_than_the_size_are_told() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path();
    // Heights in nm.
    fs::write(folder.join("map.txt"), "1 4 2\n3 1 5\n2 6 1\n").unwrap();
    for (unit, is_told) in [("m", true), ("nm", false)] {
        let output = tabor(
            folder,
            &["surface", "map.txt", "--size", "4 um", "--unit", unit],
        );
        assert!(output.status.success(), "{}", errors(&output));
        let told =
            errors(&output).contains("were the heights meant in another unit than the size?");
        assert_eq!(told, is_told, "{}", errors(&output));
    }
    let refused = tabor(folder, &["surface", "map.txt", "--unit", "foo"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(
        errors(&refused).contains("is not a unit that is known here"),
        "{}",
        errors(&refused)
    );
}

fn a_tilted_map_is_told() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path();
    let rough = |y: usize, x: usize| ((y * 31 + x * 17) % 13) as f64 * 1e-9;
    matrix(folder, "tilted.txt", [20, 20], |y, x| {
        rough(y, x) + 1e-9 * x as f64
    });
    matrix(folder, "wavy.txt", [20, 20], |_, x| {
        (x as f64 / 20.0 * std::f64::consts::TAU).sin() * 1e-9
    });
    let said = |arguments: &[&str]| {
        let output = tabor(folder, arguments);
        assert!(output.status.success(), "{}", errors(&output));
        errors(&output)
    };
    let call = ["surface", "tilted.txt", "--size", "1 um"];
    let told = said(&call);
    assert!(
        told.contains("the map is tilted: a plane is 8")
            && told.contains("; --detrend plane takes it off"),
        "{told}"
    );
    assert!(!said(&[&call[..], &["--detrend", "plane"]].concat()).contains("tilted"));
    // A wave over the whole map follows a plane too, but its edges meet.
    let wavy = [
        "surface",
        "wavy.txt",
        "--size",
        "1 um",
        "--boundary",
        "periodic",
    ];
    assert_eq!(said(&wavy), "");
    let scene = format!(
        "[grid]\nsize = \"1 um\"\n[[surface]]\nkind = \"file\"\npath = \"tilted.txt\"\n{REST}"
    );
    fs::write(folder.join("a.toml"), scene).unwrap();
    assert!(said(&["check", "a.toml"]).contains("; detrend = \"plane\" takes it off"));
}

fn maps_are_cropped_cleaned_closed_and_resampled() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path();
    let tau = std::f64::consts::TAU;
    let wave = move |y: f64, x: f64| 1e-8 * ((tau * (x + 2.0 * y)).cos() + (tau * x).sin());
    let height = move |y: usize, x: usize| wave(y as f64 / 24.0, x as f64 / 32.0);
    matrix(folder, "map.txt", [24, 32], height);
    let call = ["surface", "map.txt", "--size", "4 um, 3 um", "--out", "out"];
    let out = folder.join("out");
    // The part, with its part of the size.
    let sized = "# Width: 4 um\n# Height: 3 um\n".to_owned();
    let text = sized + &fs::read_to_string(folder.join("map.txt")).unwrap();
    fs::write(folder.join("sized.txt"), text).unwrap();
    let found = report(
        folder,
        &[
            "surface",
            "sized.txt",
            "--crop",
            "4, 2, 8, 12",
            "--out",
            "sized",
        ],
    );
    close(quantity(&found, "size_x"), 1e-6, 1e-9);
    close(quantity(&found, "size_y"), 1.5e-6, 1e-9);
    let (shape, values) = written(&folder.join("sized"));
    assert_eq!(shape, [12, 8]);
    for (index, value) in values.iter().enumerate() {
        let expected = height(2 + index / 8, 4 + index % 8);
        assert!(
            (value - expected).abs() < 1e-15,
            "{index}: {value} {expected}"
        );
    }
    // Waves go on between the points of a periodic map.
    let periodic = [
        &call[..],
        &["--boundary", "periodic", "--resample", "64, 36"],
    ]
    .concat();
    report(folder, &periodic);
    let (shape, values) = written(&out);
    assert_eq!(shape, [36, 64]);
    for (index, value) in values.iter().enumerate() {
        let expected = wave((index / 64) as f64 / 36.0, (index % 64) as f64 / 64.0);
        assert!(
            (value - expected).abs() < 1e-20,
            "{index}: {value} {expected}"
        );
    }
    // Of a patch cubics do, to the third power of the waves' points: 16 of them leave 1e-3 or less inside.
    report(folder, &[&call[..], &["--resample", "64, 48"]].concat());
    let (_, values) = written(&out);
    for (index, value) in values.iter().enumerate() {
        let (y, x) = (index / 64, index % 64);
        if (8..40).contains(&y) && (8..56).contains(&x) {
            let expected = wave(
                (y as f64 + 0.5) / 48.0 - 0.5 / 24.0,
                (x as f64 + 0.5) / 64.0 - 0.5 / 32.0,
            );
            assert!(
                (value - expected).abs() < 2e-10,
                "{index}: {value} {expected}"
            );
        }
    }
    // Mirror images close a map and double it; a window brings its edges to the mean.
    let found = report(
        folder,
        &[&call[..4], &["--out", "out", "--edges", "mirror"]].concat(),
    );
    close(quantity(&found, "size_y"), 3e-6, 1e-9);
    assert_eq!(
        [quantity(&found, "points_x"), quantity(&found, "points_y")],
        [64.0, 48.0]
    );
    let found = report(folder, &[&call[..], &["--edges", "window"]].concat());
    assert!(written(&out).1[0].abs() < 0.1 * height(0, 0).abs());
    // The heights that are left are said not to be those of the map: (27/32)^(1/2) a side of many random waves.
    assert!(
        found.contains("leaves some 84 % of the map's own rms height"),
        "{found}"
    );
    // Edges that were made to meet are those of a periodic map: the scene that is written is periodic.
    let closed = [&call[..], &["--edges", "window", "--resample", "64, 48"]].concat();
    report(folder, &closed);
    let (_, free) = written(&out);
    report(folder, &[&closed[..], &["--boundary", "periodic"]].concat());
    assert_eq!(free, written(&out).1);
    // A spike goes, with a word about it.
    matrix(folder, "spiked.txt", [24, 32], |y, x| {
        height(y, x) + if [y, x] == [5, 9] { 1e-6 } else { 0.0 }
    });
    let output = tabor(
        folder,
        &[
            "surface",
            "spiked.txt",
            "--size",
            "4 um, 3 um",
            "--outliers",
            "20",
            "--out",
            "spiked",
        ],
    );
    assert!(
        errors(&output).contains("1 of 768 points stand out"),
        "{}",
        errors(&output)
    );
    let (_, values) = written(&folder.join("spiked"));
    assert!(
        (values[5 * 32 + 9] - height(5, 9)).abs() < 2e-9,
        "{}",
        values[5 * 32 + 9]
    );
    // Line by line.
    matrix(folder, "lines.txt", [24, 32], |y, x| {
        height(0, x) + 1e-7 * ((y * 7) % 5) as f64
    });
    let found = report(
        folder,
        &[
            "surface",
            "lines.txt",
            "--size",
            "1 um",
            "--detrend",
            "lines",
            "--out",
            "lines",
        ],
    );
    close(quantity(&found, "rms_height"), 1e-8, 1e-4);
    let output = tabor(folder, &[&call[..], &["--crop", "30, 0, 8, 8"]].concat());
    assert_eq!(output.status.code(), Some(2));
    assert!(
        errors(&output).contains("is not within the 32 x 24 points"),
        "{}",
        errors(&output)
    );
    for crop in ["0, 0, 0, 4", "0, 0, 4, 0", "32, 24, 0, 0"] {
        let output = tabor(folder, &[&call[..], &["--crop", crop]].concat());
        assert_eq!(output.status.code(), Some(2));
        let said = errors(&output);
        let words = "a part has at least one point along x and along y";
        assert!(said.contains("--crop") && said.contains(words), "{said}");
    }

    // The same in a scene, which then takes more points than its file.
    let scene = format!(
        "[grid]\npoints = 64\nsize = \"4 um\"\n[[surface]]\nkind = \"file\"\npath = \"map.txt\"\ncrop = [0, 0, 32, 24]\n\
         outliers = 20\nedges = \"window\"\nresample = [64, 64]\n{REST}"
    );
    fs::write(folder.join("a.toml"), &scene).unwrap();
    let found = report(folder, &["surface", "a.toml"]);
    assert_eq!(quantity(&found, "points_y"), 64.0);
    // Advice to take more points names the key of the file.
    let adhesive = format!(
        "{scene}[adhesion]\nlaw = \"maugis-dugdale\"\nwork_of_adhesion = 0.1\nrange = \"1 nm\"\n"
    );
    fs::write(folder.join("c.toml"), adhesive).unwrap();
    let output = tabor(folder, &["check", "c.toml"]);
    assert!(
        errors(&output).contains("take more points (resample of the height file)"),
        "{}",
        errors(&output)
    );
    fs::write(
        folder.join("b.toml"),
        scene.replace("resample = [64, 64]\n", ""),
    )
    .unwrap();
    let output = tabor(folder, &["check", "b.toml"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        errors(&output).contains("or give the file resample = [nx, ny]"),
        "{}",
        errors(&output)
    );
}

fn height_parameters_distribution_and_scales_of_a_sine() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path();
    let tau = std::f64::consts::TAU;
    matrix(folder, "sine.txt", [4, 256], |_, x| {
        1e-8 * ((x as f64 + 0.5) / 128.0 * tau).sin()
    });
    let call = [
        "surface",
        "sine.txt",
        "--size",
        "4 um, 1 um",
        "--boundary",
        "periodic",
        "--out",
        "out",
    ];
    let found = report(folder, &call);
    // Sa = 2 A/pi, Sq = A/sqrt 2, Sz = 2 A, Ssk = 0, Sku = 3/2; sums over 128 points a wave.
    close(quantity(&found, "Sa"), 2e-8 / std::f64::consts::PI, 1e-3);
    close(quantity(&found, "Sq"), 1e-8 / 2_f64.sqrt(), 1e-5);
    close(quantity(&found, "Sz"), 2e-8, 1e-3);
    close(quantity(&found, "Sku"), 1.5, 1e-5);
    assert!(quantity(&found, "Ssk").abs() < 1e-9);
    // Wavelengths between which the spectrum is that of the surface: the map and four pixels.
    close(quantity(&found, "psd_longest"), 4e-6, 1e-5);
    close(quantity(&found, "psd_shortest"), 1e-6, 1e-5);
    let columns = |name: &str, head: &str| -> Vec<Vec<f64>> {
        let text = fs::read_to_string(folder.join("out").join(name)).expect(name);
        let mut lines = text.lines();
        assert_eq!(lines.next(), Some(head), "{name}");
        let cells = |line: &str| {
            line.split(',')
                .map(|cell| cell.parse().expect("a number"))
                .collect()
        };
        lines.map(cells).collect()
    };
    let classes = columns("distribution.csv", "height [m],density [1/m]");
    let width = classes[1][0] - classes[0][0];
    close(
        classes.iter().map(|class| class[1] * width).sum(),
        1.0,
        1e-9,
    );
    let scales = columns("scales.csv", "distance [m],slope,curvature [1/m]");
    let distance = 4e-6 / 256.0 * 8.0;
    let at = scales
        .iter()
        .find(|row| (row[0] / distance - 1.0).abs() < 1e-9)
        .expect("8 points");
    let half = (tau / 2e-6 * distance / 2.0).sin();
    close(at[1], 2e-8 * half / distance / 2_f64.sqrt(), 1e-9);
    let correlation = columns("autocorrelation.csv", "distance [m],autocorrelation");
    close(correlation[0][1], 1.0, 1e-12);
    for name in ["psd.svg", "statistics.svg"] {
        let text = fs::read_to_string(folder.join("out").join(name)).expect(name);
        assert!(
            text.starts_with("<svg xmlns=")
                && text.contains("<circle")
                && !text.contains("stroke=\"\""),
            "{name}"
        );
    }
    assert!(
        image::open(folder.join("out/statistics.png"))
            .expect("a picture")
            .width()
            > 600
    );
}

/// Twice the waves of one seed are one surface of twice the height, not two surfaces.
fn parts_of_one_seed_add_by_their_roots_and_are_warned_of() {
    let part = |seed: &str| {
        format!(
            "[[surface]]\nkind = \"self-affine\"\nhurst = 0.8\nrms_height = \"20 nm\"\nlongest = \"5 um\"\nrolloff = \"5 um\"\nshortest = \"1 um\"\n{seed}"
        )
    };
    for (seed, height, is_warned) in [
        ("", "rms height 40 nm", true),
        ("seed = 2\n", "rms height 28.28 nm", false),
    ] {
        let folder = scene(&format!(
            "[grid]\npoints = 64\nsize = \"10 um\"\n[solid]\ncontact_modulus = \"1 GPa\"\n{}{}[loading]\ncontrol = \"pressure\"\npath = [\"1 MPa\"]\n",
            part(""),
            part(seed)
        ));
        let checked = tabor(folder.path(), &["check", "scene.toml"]);
        assert_eq!(status(&checked), 0, "{}", errors(&checked));
        let text = String::from_utf8_lossy(&checked.stdout);
        assert!(text.contains(height), "{height} is missing in {text}");
        let words = "[[surface]] 2 has the seed of [[surface]] 1";
        let measured = tabor(folder.path(), &["surface", "scene.toml", "--out", "out"]);
        for output in [&checked, &measured] {
            assert_eq!(
                errors(output).contains(words),
                is_warned,
                "{}",
                errors(output)
            );
        }
        if is_warned {
            let text = String::from_utf8_lossy(&measured.stdout);
            assert!(text.contains("rms_height = 4e-8"), "{text}");
        }
    }
}

/// A map of 12 x 8 points that does not say its size, on a square.
fn a_size_that_stretches_a_map_is_warned_of() {
    let folder = tempfile::tempdir().expect("a folder");
    let row = "0 1 2 1 0 1 2 1 0 1 2 1\n";
    fs::write(folder.path().join("map.txt"), row.repeat(8)).expect("the map is written");
    let said = |size: &str| {
        let call = ["surface", "map.txt", "--unit", "nm", "--size", size];
        let output = tabor(folder.path(), &call);
        assert_eq!(status(&output), 0, "{}", errors(&output));
        errors(&output)
    };
    let words = "makes the pixels of its 12 x 8 points 1 µm x 1.5 µm; if they are square, the size is 12 µm x 8 µm";
    let stretched = said("12 um");
    assert!(stretched.contains(words), "{stretched}");
    let square = said("12 um, 8 um");
    assert!(!square.contains("pixels of its"), "{square}");
}

/// A sphere has a spectrum, and that is no power law by many powers of ten: it was within 5e22 %.
fn a_sphere_is_not_self_affine() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path();
    let scene = format!(
        "[grid]\npoints = 128\nsize = \"20 um\"\nboundary = \"free\"\n[[surface]]\nkind = \"sphere\"\nradius = \"50 um\"\n{}",
        REST.replace("pressure", "force")
    );
    fs::write(folder.join("sphere.toml"), scene).unwrap();
    let found = report(folder, &["surface", "sphere.toml"]);
    assert!(
        found.contains("# the surface is not self-affine: "),
        "{found}"
    );
    assert!(!found.contains("lies within"), "{found}");
}

tests![
    a_sphere_is_not_self_affine,
    parts_of_one_seed_add_by_their_roots_and_are_warned_of,
    a_size_that_stretches_a_map_is_warned_of,
    height_parameters_distribution_and_scales_of_a_sine,
    a_line_scan_is_refused_or_taken_as_a_profile,
    heights_in_another_unit_than_the_size_are_told,
    a_tilted_map_is_told,
    maps_are_cropped_cleaned_closed_and_resampled,
    the_statistics_of_an_egg_box_are_exact,
    a_scene_s_own_parameters_come_back_and_make_a_scene,
    a_measured_patch_leads_to_a_scene,
    a_flat_surface_has_statistics_and_no_fit,
    keys_of_a_measured_scene_take_the_place_of_its_stand_ins,
    keys_that_change_the_map_are_told_to_be_of_the_scene_alone,
    folders_of_others_are_left_alone,
];
