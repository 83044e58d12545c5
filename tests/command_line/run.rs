//! The binary from outside: exit status, messages, files written.

use std::fs;
use std::path::{Path, PathBuf};

use tabor::units::format_si;
use tempfile::TempDir;

use crate::shared::binary::{self, errors, number, status, summary, table, tabor};
use crate::shared::trials::tests;

const HEAD: &str = "step,time,approach,mean_gap,force,mean_pressure,contact_area_fraction,attractive_area_fraction,elastic_energy,adhesive_energy,iterations,residual,converged,seconds,contact_area_fraction_corrected,state";

/// A folder with a scene in it, and the scene.
fn scene(text: &str) -> (TempDir, PathBuf) {
    let folder = binary::scene(text);
    let path = folder.path().join("scene.toml");
    (folder, path)
}

const ROUGH: &str = r#"
title = "Small rough surface"
[grid]
points = [64, 48]
size = ["2 um", "1.5 um"]
[solid]
contact_modulus = "50 MPa"
[[surface]]
kind = "self-affine"
hurst = 0.8
rms_slope = 0.1
longest = "2 um"
rolloff = "1 um"
shortest = "0.25 um"
[adhesion]
law = "maugis-dugdale"
work_of_adhesion = "10 mJ/m^2"
range = "10 nm"
[loading]
control = "pressure"
path = ["0.2 MPa", "1 MPa", 0, "-5 MPa", "0.2 MPa"]
[output]
images = ["pressure", "gap", "displacement", "heights"]
fields = ["pressure", "gap"]
steps = [2, 4]
"#;

fn rows(folder: &Path) -> Vec<Vec<String>> {
    let text = fs::read_to_string(folder.join("curve.csv")).expect("there is a curve");
    let mut lines = text.lines();
    // Behind these columns come those of effects: of an adhesive scene without others its attraction.
    let effects = lines.next().and_then(|head| head.strip_prefix(HEAD));
    assert!(["", ",attractive_force"].map(Some).contains(&effects));
    lines
        .map(|line| line.split(',').map(str::to_owned).collect())
        .collect()
}

fn column(name: &str) -> usize {
    HEAD.split(',')
        .position(|other| other == name)
        .expect("a column")
}

fn a_run_writes_what_the_contract_says() {
    let (folder, _) = scene(ROUGH);
    let output = tabor(folder.path(), &["run", "scene.toml"]);
    assert_eq!(status(&output), 0, "{}", errors(&output));
    assert!(output.stdout.is_empty(), "standard output stays clean");
    let results = folder.path().join("scene");
    let rows = rows(&results);
    assert_eq!(rows.len(), 5);
    for (index, row) in rows.iter().enumerate() {
        assert_eq!(row.len(), 17);
        assert_eq!(row[0], (index + 1).to_string());
        assert_eq!(row[column("time")], "");
        assert_eq!(row[column("converged")], "true");
        let residual: f64 = row[column("residual")].parse().expect("a number");
        assert!(residual <= 1e-6, "row {index}");
    }
    let number = |row: usize, name: &str| -> f64 {
        rows[row][column(name)]
            .parse()
            .unwrap_or_else(|_| panic!("row {row}, {name}"))
    };
    // Asked loads stand as asked, force is pressure times the nominal area.
    assert_eq!(number(0, "mean_pressure"), 0.2e6);
    assert!((number(0, "force") / (0.2e6 * 2e-6 * 1.5e-6) - 1.0).abs() < 1e-12);
    assert_eq!(rows[0][column("state")], "contact");
    // Tension beyond pull-off: separated, converged, nothing carried; then brought back.
    assert_eq!(rows[3][column("state")], "separated");
    assert_eq!(number(3, "force"), 0.0);
    assert_eq!(rows[3][column("approach")], "");
    assert_eq!(rows[3][column("mean_gap")], "");
    assert_eq!(rows[4][column("state")], "contact");
    assert_eq!(number(4, "mean_pressure"), 0.2e6);
    // More load, more contact; both shares within the nominal area.
    assert!(number(1, "contact_area_fraction") > number(0, "contact_area_fraction"));
    assert!(number(1, "contact_area_fraction") + number(1, "attractive_area_fraction") <= 1.0);
    assert!(number(1, "adhesive_energy") < 0.0 && number(1, "elastic_energy") > 0.0);

    let summary = summary(&results);
    for key in [
        "version",
        "scene",
        "effects",
        "backend",
        "adapter",
        "precision",
        "seconds",
        "transforms",
        "peak_memory_bytes",
        "largest_contact_area_fraction",
        "pull_off_force",
        "pull_off_step",
        "pull_off_lower",
        "pull_off_upper",
        "jump_in_steps",
        "jump_off_steps",
        "hysteresis_energy",
        "hysteresis_uncertainty",
        "warnings",
    ] {
        assert!(summary.get(key).is_some(), "no {key}");
    }
    assert_eq!(summary["backend"], "cpu");
    assert_eq!(summary["precision"], "double");
    assert_eq!(summary["effects"]["on"], serde_json::json!(["adhesion"]));
    assert_eq!(summary["jump_off_steps"], serde_json::json!([4]));
    assert_eq!(summary["jump_in_steps"], serde_json::json!([5]));
    assert_eq!(
        summary["largest_contact_area_fraction"].as_f64(),
        Some(number(1, "contact_area_fraction"))
    );

    // Step 2 has its pictures and fields; step 4 is separated, and that is said.
    for field in ["pressure", "gap", "displacement", "heights"] {
        let picture = results.join(format!("images/step_0002_{field}.png"));
        assert!(image::open(&picture).expect("a picture").width() > 64);
        assert!(
            !results
                .join(format!("images/step_0004_{field}.png"))
                .exists()
        );
    }
    assert!(errors(&output).contains("step 4 is separated"));
    let bytes = fs::read(results.join("fields/step_0002_pressure.npy")).expect("a field");
    let file = npyz::NpyFile::new(&bytes[..]).expect("an npy file");
    assert_eq!(file.shape(), [48, 64]);
    let values: Vec<f64> = file.into_vec().expect("doubles");
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    // The mean of the field meets the asked load to the residual.
    assert!((mean / 1e6 - 1.0).abs() < 1e-5, "{mean}");
}

fn without_seconds(folder: &Path) -> Vec<Vec<String>> {
    let mut rows = rows(folder);
    for row in &mut rows {
        row[column("seconds")].clear();
    }
    rows
}

/// A scene with the lengths that the summary states in place of "auto" is the same contact.
fn lengths_that_the_grid_sets_are_in_the_summary() {
    let (folder, _) = scene(ROUGH);
    let run = |out: &str, lengths: [String; 2]| {
        let mut arguments = vec!["run", "scene.toml", "--out", out, "--quiet"];
        for set in &lengths {
            arguments.extend(["--set", set]);
        }
        assert_eq!(status(&tabor(folder.path(), &arguments)), 0);
        folder.path().join(out)
    };
    let keys = ["range", "taper"];
    let auto = run("auto", keys.map(|key| format!("adhesion.{key}=auto")));
    let stated = &summary(&auto)["scene"]["adhesion"];
    let lengths = keys.map(|key| stated[key].as_f64().expect("a length"));
    assert!(lengths.iter().all(|&length| length > 0.0), "{lengths:?}");
    let set = |place: usize| format!("adhesion.{}={:e}", keys[place], lengths[place]);
    let again = run("again", [set(0), set(1)]);
    assert_eq!(without_seconds(&auto), without_seconds(&again));
}

fn the_same_scene_gives_the_same_bits() {
    let (folder, _) = scene(ROUGH);
    for (out, threads) in [("one", "1"), ("two", "2"), ("again", "2")] {
        let arguments = [
            "run",
            "scene.toml",
            "--out",
            out,
            "--threads",
            threads,
            "--quiet",
        ];
        assert_eq!(status(&tabor(folder.path(), &arguments)), 0);
    }
    let at = |name: &str| folder.path().join(name);
    assert_eq!(without_seconds(&at("two")), without_seconds(&at("again")));
    assert_eq!(without_seconds(&at("one")), without_seconds(&at("two")));
    let field = "fields/step_0002_pressure.npy";
    assert_eq!(
        fs::read(at("two").join(field)).expect("a field"),
        fs::read(at("again").join(field)).expect("a field")
    );
}

fn folders_that_are_not_this_scenes_are_left_alone() {
    let (folder, path) = scene(ROUGH);
    let foreign = folder.path().join("foreign");
    fs::create_dir(&foreign).expect("a folder");
    fs::write(foreign.join("thesis.txt"), "mine").expect("a file");
    let output = tabor(folder.path(), &["run", "scene.toml", "--out", "foreign"]);
    assert_eq!(status(&output), 2);
    assert!(errors(&output).contains("foreign"), "{}", errors(&output));
    assert_eq!(
        fs::read(foreign.join("thesis.txt")).expect("still there"),
        b"mine"
    );
    assert_eq!(fs::read_dir(&foreign).expect("a folder").count(), 1);

    // Of the same scene: its own files are replaced, others stay.
    assert_eq!(status(&tabor(folder.path(), &["run", "scene.toml"])), 0);
    fs::write(folder.path().join("scene/notes.txt"), "mine").expect("a file");
    assert_eq!(status(&tabor(folder.path(), &["run", "scene.toml"])), 0);
    assert!(folder.path().join("scene/notes.txt").exists());
    // Of another scene: refused.
    fs::write(&path, ROUGH.replace("0.8", "0.7")).expect("the scene is changed");
    let output = tabor(folder.path(), &["run", "scene.toml"]);
    assert_eq!(status(&output), 2);
}

fn a_file_in_the_way_and_an_unwritable_place() {
    let (folder, _) = scene(ROUGH);
    let output = tabor(folder.path(), &["run", "scene.toml", "--out", "scene.toml"]);
    assert_eq!(status(&output), 2, "{}", errors(&output));
    let output = tabor(
        folder.path(),
        &["run", "scene.toml", "--out", "/proc/nowhere"],
    );
    assert_eq!(status(&output), 1, "{}", errors(&output));
    assert!(errors(&output).contains("/proc/nowhere"));
}

fn a_step_that_does_not_converge_is_written_and_ends_the_run() {
    let (folder, _) = scene(ROUGH);
    let arguments = [
        "run",
        "scene.toml",
        "--set",
        "solver.max_iterations=3",
        "--set",
        "solver.tolerance=1e-9",
    ];
    let output = tabor(folder.path(), &arguments);
    assert_eq!(status(&output), 3);
    let message = errors(&output);
    assert!(
        message.contains("step 1 did not converge") && message.contains("max_iterations"),
        "{message}"
    );
    let rows = rows(&folder.path().join("scene"));
    assert_eq!(rows.len(), 1);
    assert_eq!(rows[0][column("converged")], "false");
    let residual: f64 = rows[0][column("residual")].parse().expect("a number");
    assert!(residual > 1e-9 && residual.is_finite());
    assert!(folder.path().join("scene/summary.json").exists());
}

fn mistakes_are_named_all_at_once_with_their_lines() {
    let (folder, _) = scene(
        "[grid]\npoints = 64\nsize = \"2 kg\"\n[solid]\ncontact_modulu = 1e9\n[[surface]]\nkind = \"sphere\"\nradius = -1.0\n[loading]\ncontrol = \"pressure\"\npath = [1e3]\n",
    );
    for command in ["run", "check"] {
        let output = tabor(folder.path(), &[command, "scene.toml"]);
        assert_eq!(status(&output), 2);
        assert!(output.stdout.is_empty());
        let message = errors(&output);
        for part in [
            "scene.toml:3",
            "size",
            "scene.toml:5",
            "contact_modulus",
            "scene.toml:8",
            "radius",
        ] {
            assert!(message.contains(part), "{part} is missing in:\n{message}");
        }
    }
    assert!(
        !folder.path().join("scene").exists(),
        "nothing is written for a bad scene"
    );
}

fn what_this_version_lacks_is_refused_by_name() {
    let (folder, _) = scene(ROUGH);
    let output = tabor(
        folder.path(),
        &["check", "scene.toml", "--set", "plastic={ hardness = 1 }"],
    );
    assert_eq!(status(&output), 2, "{}", errors(&output));
    assert!(
        errors(&output).contains("not in this version"),
        "{}",
        errors(&output)
    );
    assert_eq!(status(&tabor(folder.path(), &["run"])), 2);
    assert_eq!(status(&tabor(folder.path(), &["run", "missing.toml"])), 2);
}

fn check_lists_effects_regime_and_resolution() {
    let (folder, _) = scene(ROUGH);
    let output = tabor(folder.path(), &["check", "scene.toml"]);
    assert_eq!(status(&output), 0, "{}", errors(&output));
    let text = String::from_utf8(output.stdout).expect("text");
    for part in [
        "effect on     adhesion",
        "Tabor number",
        "chi = ",
        "pixels across the shortest",
        "MiB",
        // The two of an iteration, and six on a coarsest grid of a quarter of the points each way, two sweeps of the levels.
        "cost          2.4 Fourier transforms an iteration near a solution",
    ] {
        assert!(text.contains(part), "{part} is missing in:\n{text}");
    }
    // Kernels, fields and effects that are off are for those who ask.
    let internals = [
        "effect off    spring",
        "effect off    free boundary",
        "fields ",
        "kernels ",
    ];
    for part in internals {
        assert!(!text.contains(part), "{part} is in:\n{text}");
    }
    let output = tabor(folder.path(), &["check", "scene.toml", "--verbose"]);
    let text = String::from_utf8(output.stdout).expect("text");
    for part in internals {
        assert!(text.contains(part), "{part} is missing in:\n{text}");
    }
    // Ten times the pixel: the grid no longer resolves the cohesive zone, and that is said.
    let coarse = [
        "check",
        "scene.toml",
        "--set",
        "grid.points=[16, 12]",
        "--set",
        "adhesion.range=\"0.5 nm\"",
    ];
    let output = tabor(folder.path(), &coarse);
    assert_eq!(status(&output), 0);
    let message = errors(&output);
    assert!(
        message.contains("chi") && message.contains("range = \"auto\""),
        "{message}"
    );
    assert!(message.contains("shortest wave"), "{message}");
}

fn overrides_reach_the_scene() {
    let (folder, _) = scene(ROUGH);
    let arguments = [
        "run",
        "scene.toml",
        "--set",
        "loading.path=[1e5]",
        "--set",
        "output.steps=last",
        "--set",
        "title=Changed",
    ];
    assert_eq!(status(&tabor(folder.path(), &arguments)), 0);
    assert_eq!(rows(&folder.path().join("scene")).len(), 1);
    let output = tabor(
        folder.path(),
        &["check", "scene.toml", "--set", "surface.3.hurst=0.4"],
    );
    assert_eq!(status(&output), 2);
    assert!(errors(&output).contains("--set"), "{}", errors(&output));
}

fn single_precision_has_its_floor_and_its_fields() {
    let (folder, path) = scene(ROUGH);
    for tolerance in ["1e-5", "9.9e-5"] {
        let set = format!("solver.tolerance={tolerance}");
        let call = [
            "run",
            "scene.toml",
            "--precision",
            "single",
            "--set",
            set.as_str(),
        ];
        let output = tabor(folder.path(), &call);
        assert_eq!(status(&output), 2);
        let message = errors(&output);
        assert!(
            message.contains("solver.tolerance") && message.contains("1e-4"),
            "{message}"
        );
        assert!(!folder.path().join("scene").exists());
    }
    for precision in ["double", "single"] {
        let call = [
            "run",
            "scene.toml",
            "--backend",
            "cpu",
            "--precision",
            precision,
            "--out",
            precision,
        ];
        let output = tabor(folder.path(), &call);
        assert_eq!(status(&output), 0, "{}", errors(&output));
    }
    let single = folder.path().join("single");
    let summary = summary(&single);
    assert_eq!(summary["precision"], "single");
    assert_eq!(summary["backend"], "cpu");
    assert_eq!(summary["scene"]["solver"]["tolerance"], 1e-4);
    let bytes = fs::read(single.join("fields/step_0002_gap.npy")).expect("a field");
    let file = npyz::NpyFile::new(&bytes[..]).expect("an npy file");
    assert!(file.into_vec::<f32>().is_ok(), "fields are float32");
    // The same physics: states alike, and areas and gaps within what the looser tolerance leaves.
    let (one, two) = (rows(&single), rows(&folder.path().join("double")));
    assert_eq!(one.len(), two.len());
    for (one, two) in one.iter().zip(&two) {
        assert_eq!(one[column("state")], two[column("state")]);
        assert_eq!(one[column("converged")], "true");
        assert_eq!(one[column("force")], two[column("force")]);
        for (name, bound) in [("mean_gap", 1e-3), ("contact_area_fraction", 2e-2)] {
            let (Ok(a), Ok(b)) = (
                one[column(name)].parse::<f64>(),
                two[column(name)].parse::<f64>(),
            ) else {
                assert_eq!(one[column(name)], two[column(name)]);
                continue;
            };
            assert!((a - b).abs() <= bound * b.abs(), "{name}: {a} and {b}");
        }
    }

    // The scene may say it too, and the call beats the scene.
    let text = format!("{ROUGH}\n[solver]\nprecision = \"single\"\n");
    fs::write(&path, text).expect("the scene is changed");
    let output = tabor(folder.path(), &["check", "scene.toml"]);
    assert_eq!(status(&output), 0, "{}", errors(&output));
    let call = [
        "run",
        "scene.toml",
        "--precision",
        "double",
        "--out",
        "double",
    ];
    assert_eq!(status(&tabor(folder.path(), &call)), 0);
}

/// What a call says that is refused at once; it is ended where it is not.
fn refused_at_once(folder: &Path, arguments: &[&str]) -> String {
    let mut child = binary::command(folder, arguments)
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .expect("the binary runs");
    let clock = std::time::Instant::now();
    while child.try_wait().expect("a child").is_none() {
        if clock.elapsed().as_secs() > 20 {
            child.kill().expect("ended");
            panic!("{arguments:?} is not refused");
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let output = child.wait_with_output().expect("an end");
    assert_eq!(status(&output), 2, "{arguments:?}: {}", errors(&output));
    errors(&output)
}

/// Devices never end and pipes wait for a writer: each place where a file is named says so.
#[cfg(unix)]
fn what_is_no_regular_file_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    let made = std::process::Command::new("mkfifo")
        .arg(path("pipe.txt"))
        .status()
        .expect("mkfifo runs");
    assert!(made.success());
    let _socket = std::os::unix::net::UnixListener::bind(path("socket.txt")).expect("a socket");
    fs::create_dir(path("folder.txt")).expect("a folder");
    for name in [
        "/dev/zero",
        "/dev/null",
        "pipe.txt",
        "socket.txt",
        "folder.txt",
    ] {
        for command in ["check", "run", "compare", "accuracy"] {
            let message = refused_at_once(folder.path(), &[command, name]);
            assert!(
                message.contains("it is not a regular file (but a folder, a pipe or a device); save the scene to a file and name that"),
                "{command} {name}: {message}"
            );
        }
        let message = refused_at_once(folder.path(), &["fit", name, "--radius", "1 um"]);
        // A folder may hold curves; this one has none.
        let expected = match name {
            "folder.txt" => "no curve in this folder; their names end in .csv",
            _ => {
                "is not a regular file (but a folder, a pipe or a device); save the curve to a file and name that"
            }
        };
        assert!(message.contains(expected), "{name}: {message}");
        let message = refused_at_once(folder.path(), &["surface", name, "--size", "1 um"]);
        assert!(
            message.contains("this is not a regular file; copy the heights into one")
                || message.contains("this is a folder; path must name one height file"),
            "{name}: {message}"
        );
    }
    // Too long for a scene, in name only: its bytes are never written.
    let long = fs::File::create(path("long.toml")).expect("created");
    long.set_len(1 << 40).expect("sparse");
    let message = refused_at_once(folder.path(), &["check", "long.toml"]);
    assert!(
        message.contains("1099511627776 bytes are too many for a scene"),
        "{message}"
    );
}

fn of_very_many_mistakes_the_first_and_their_number_are_said() {
    let folder = tempfile::tempdir().expect("a folder");
    let keys: String = (0..200_000).map(|i| format!("key{i} = {i}\n")).collect();
    fs::write(folder.path().join("scene.toml"), keys).expect("a scene");
    let message = refused_at_once(folder.path(), &["check", "scene.toml"]);
    let lines: Vec<&str> = message.lines().collect();
    assert_eq!(lines.len(), 21, "{} lines", lines.len());
    assert!(
        lines[19].contains("scene.toml:20: key19: unknown key"),
        "{}",
        lines[19]
    );
    // Beside the keys [grid], [solid], [[surface]] and [loading] are missing.
    assert_eq!(lines[20], "error: scene.toml: 199984 more mistakes");
}

/// At no load the attraction of this surface is below what single precision tells from nothing: its row is
/// converged at the rounding, and the run says at what residual, in its messages and in its summary. In mixed
/// precision there is nothing to say.
fn steps_that_rounding_ends_are_warned_of() {
    let (folder, _) = scene(
        r#"
        [grid]
        points = 16
        size = 1.0
        [solid]
        contact_modulus = 1.0
        [[surface]]
        kind = "self-affine"
        hurst = 0.8
        rms_height = 0.01
        longest = 1.0
        rolloff = 0.5
        shortest = 0.125
        seed = 1
        [adhesion]
        law = "exponential"
        work_of_adhesion = 4.8e-10
        range = 1e-4
        [loading]
        control = "pressure"
        path = [3e-3, 0]
        "#,
    );
    let warning = "rounding in single precision ends 1 of 2 steps, the first of them step 2";
    for precision in ["single", "mixed"] {
        let call = ["run", "scene.toml", "--backend", "cpu", "--quiet"];
        let call = [&call[..], &["--precision", precision, "--out", precision]].concat();
        let output = tabor(folder.path(), &call);
        assert_eq!(status(&output), 0, "{}", errors(&output));
        let summary = summary(&folder.path().join(precision)).to_string();
        for said in [errors(&output), summary] {
            assert_eq!(said.contains(warning), precision == "single", "{said}");
            let remedy = said.contains("\"mixed\\\" or") || said.contains("\"mixed\" or");
            assert_eq!(remedy, precision == "single", "{said}");
        }
    }
}

/// Under a load the pull-off of the README's scene lies between its steps of -30 and -60 kPa, and is narrowed down
/// to a per cent; a path that does not let go has none, and says what held.
fn pull_off_under_a_load() {
    let rough = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/scenes/rough.toml");
    let folder = tempfile::tempdir().expect("a folder");
    let run = |out: &str, set: &[&str]| {
        let call = [
            "run",
            rough,
            "--quiet",
            "--out",
            out,
            "--set",
            "grid.points=128",
        ];
        let output = tabor(folder.path(), &[&call[..], set].concat());
        assert_eq!(status(&output), 0, "{}", errors(&output));
        (summary(&folder.path().join(out)), errors(&output))
    };
    let (found, said) = run("whole", &[]);
    let number = |key: &str| found[key].as_f64().unwrap_or_else(|| panic!("no {key}"));
    let [force, lower, upper] = ["pull_off_force", "pull_off_lower", "pull_off_upper"].map(number);
    assert_eq!(force, lower);
    assert!(upper - lower <= 0.01 * upper, "{lower} {upper}");
    // 20 um squared: between 12 and 24 uN, neither of them.
    assert!(lower > 12.01e-6 && upper < 23.99e-6, "{lower} {upper}");
    assert_eq!(found["pull_off_step"], 9);
    // What 128 points do to its summits has nothing to do with the path.
    let mut of_path = said.lines().filter(|line| !line.contains("a stiff summit"));
    assert!(!of_path.any(|line| line.contains("pull-off")), "{said}");
    let page = fs::read_to_string(folder.path().join("whole/report.html")).expect("a report");
    assert!(
        page.contains("<dt>Pull-off</dt>"),
        "no pull-off on the page"
    );

    let path = "loading.path=[\"4 MPa\", 0, \"-30 kPa\"]";
    let (found, said) = run("holds", &["--set", path, "--set", "output.steps=last"]);
    for key in [
        "pull_off_force",
        "pull_off_step",
        "pull_off_lower",
        "pull_off_upper",
    ] {
        assert!(found[key].is_null(), "{key}: {}", found[key]);
    }
    let words = "the contact held 12 \u{b5}N in step 3, the greatest tension of the path: its pull-off is beyond";
    let ascii = words.replace('\u{b5}', "u");
    assert!(said.contains(words) || said.contains(&ascii), "{said}");
    let warnings = found["warnings"].to_string();
    assert!(warnings.contains("its pull-off is beyond"), "{warnings}");
}

/// A stiff sphere that jumps into contact, is pressed, and jumps off; the loop closes.
/// A path that turns back while the tension still grows shows a part of the pull-off, and says so.
fn a_path_that_turns_back_at_its_greatest_tension_says_so() {
    let said = |path: &str| {
        let whole = "path = [\"-1.6 um\", \"-0.3 um\", \"0.5 um\", \"-0.5 um\", \"-1.6 um\"]";
        let (folder, _) = scene(&LOOP.replace(whole, path));
        let output = tabor(folder.path(), &["run", "scene.toml"]);
        assert_eq!(status(&output), 0, "{}", errors(&output));
        errors(&output)
    };
    let words = "the path turns back at its greatest tension, ";
    let turned = said("path = [\"-1.6 um\", \"-0.3 um\", \"-1.6 um\"]");
    assert!(
        turned.contains(words) && turned.contains(" in step 2, "),
        "{turned}"
    );
    let pressed = said("path = [\"-1.6 um\", \"0.5 um\", \"-0.3 um\", \"-0.5 um\", \"-1.6 um\"]");
    assert!(!pressed.contains(words), "{pressed}");
}

/// A rough surface, whose solid and loading are lines of their tables.
fn rough_under(solid: &str, treatment: &str, loading: &str) -> String {
    format!(
        "[grid]\npoints = 64\nsize = \"10 um\"\n[solid]\ncontact_modulus = \"100 MPa\"\n{solid}\n\
         [[surface]]\nkind = \"self-affine\"\nhurst = 0.8\nrms_slope = 0.1\nlongest = \"10 um\"\nrolloff = \"5 um\"\nshortest = \"1 um\"\nseed = 3\n\
         [adhesion]\nlaw = \"maugis-dugdale\"\nwork_of_adhesion = \"50 mJ/m^2\"\nrange = \"20 nm\"\n{treatment}\n\
         [loading]\ncontrol = \"pressure\"\n{loading}\n[output]\nimages = []\n"
    )
}

/// Rounding of the zero load between compression and tension loses no pull-off, and rounding of the ends of a bracket is no cause for a warning.
fn rounding_hides_no_pull_off_and_widens_no_bracket() {
    for (name, solid, treatment, loading) in [
        // 500 kPa less 580 kPa times 500/580 is 5.8e-11 Pa.
        ("rounded", "", "", "path = [\"500 kPa\", \"-80 kPa\"]"),
        // Halvings of a ramp whose bounds end 1 % apart.
        (
            "wide",
            "hardness = \"5 MPa\"",
            "",
            "start = \"0 Pa\"\n[[loading.ramp]]\nto = \"0.4 MPa\"\nsteps = 5\n[[loading.ramp]]\nto = \"-0.1 MPa\"\nsteps = 6\n[[loading.ramp]]\nto = \"0.4 MPa\"\nsteps = 5\n[[loading.ramp]]\nto = \"-0.2 MPa\"\nsteps = 6",
        ),
    ] {
        let (folder, _) = scene(&rough_under(solid, treatment, loading));
        let (said, _) = last_words(folder.path(), name, &[]);
        let output = tabor(folder.path(), &["run", "scene.toml", "--out", "again"]);
        let warned = errors(&output);
        assert!(said.contains("the pull-off force is "), "{name}: {said}");
        assert!(!warned.contains("is known no better"), "{name}: {warned}");
        let found = summary(&folder.path().join(name));
        let [lower, upper] = ["pull_off_lower", "pull_off_upper"]
            .map(|key| found[key].as_f64().unwrap_or_else(|| panic!("no {key}")));
        assert!(
            lower > 0.0 && upper - lower <= 0.01 * upper * (1.0 + 1e-9),
            "{name}: {lower} {upper}"
        );
    }
    // A load that the search meets to 1e-12 of the greatest counts as zero too.
    let (folder, _) = scene(&rough_under(
        "",
        "treatment = \"dmt\"",
        "path = [\"0.5 MPa\", \"0.1 MPa\", \"0 Pa\"]",
    ));
    let (said, _) = last_words(folder.path(), "dmt", &[]);
    assert!(said.contains("the surfaces stick at zero load"), "{said}");
}

/// What attracts without contact at the end of a path is warned of as a contact is.
fn an_attraction_that_holds_is_warned_of() {
    let (folder, _) = scene(
        &LOOP
            .replace(
                "path = [\"-1.6 um\", \"-0.3 um\", \"0.5 um\", \"-0.5 um\", \"-1.6 um\"]",
                "path = [\"-1.6 um\", \"-0.24 um\"]",
            )
            .replace(
                "range = \"250 nm\"",
                "range = \"250 nm\"\ntreatment = \"dmt\"",
            ),
    );
    let output = tabor(folder.path(), &["run", "scene.toml"]);
    let said = errors(&output);
    assert_eq!(status(&output), 0, "{said}");
    assert!(
        said.contains("the attraction held ") && said.contains(" in step 2, the greatest tension"),
        "{said}"
    );
}

const LOOP: &str = r#"
[grid]
points = 48
size = "60 um"
boundary = "free"
[solid]
contact_modulus = "1 MPa"
[[surface]]
kind = "sphere"
radius = "100 um"
[adhesion]
law = "maugis-dugdale"
work_of_adhesion = "50 mJ/m^2"
range = "250 nm"
[loading]
control = "approach"
path = ["-1.6 um", "-0.3 um", "0.5 um", "-0.5 um", "-1.6 um"]
[output]
images = []
"#;

/// The last line on standard error, and the first paragraph of the report.
fn last_words(folder: &Path, out: &str, arguments: &[&str]) -> (String, String) {
    let call = [&["run", "scene.toml", "--out", out], arguments].concat();
    let output = tabor(folder, &call);
    assert_eq!(status(&output), 0, "{}", errors(&output));
    let page = fs::read_to_string(folder.join(out).join("report.html")).expect("a page");
    let (_, behind) = page.split_once("<p").expect("a paragraph");
    let (first, _) = behind.split_once("</p>").expect("its end");
    let (_, first) = first.split_once('>').expect("its text");
    let last = errors(&output)
        .lines()
        .last()
        .unwrap_or_default()
        .to_owned();
    (last, first.to_owned())
}

fn the_last_words_and_the_first_line_of_the_report_state_the_result() {
    let (folder, _) = scene(LOOP);
    let (said, shown) = last_words(folder.path(), "out", &[]);
    let summary = summary(&folder.path().join("out"));
    let number = |key: &str| summary[key].as_f64().unwrap_or_else(|| panic!("no {key}"));
    let share = 100.0 * number("largest_contact_area_fraction");
    for part in [
        format!("The largest contact area is {share:.3} % of the nominal area (step 3)"),
        format!(
            "the pull-off force is {} (step {})",
            format_si(number("pull_off_force"), "N"),
            summary["pull_off_step"]
        ),
        "the surfaces jump into contact in step 2 and out of contact in step 5".to_owned(),
        format!(
            // Its steps are long: what it loses is bounded.
            "and the loop loses at most {}.",
            format_si(
                number("hysteresis_energy") + number("hysteresis_uncertainty"),
                "J"
            )
        ),
    ] {
        assert!(said.contains(&part), "{part} is missing in {said}");
        assert!(shown.contains(&part), "{part} is missing in {shown}");
    }
    assert!(said.starts_with(&shown), "{said}\n{shown}");
    let rest = &said[shown.len()..];
    assert!(
        rest.starts_with(" Solved in ") && rest.ends_with(" s; the report is out/report.html"),
        "{rest}"
    );

    // Taken off to zero load it sticks.
    let stuck = [
        "--set",
        "loading.control=force",
        "--set",
        "loading.path=[1e-5, 0]",
    ];
    let (said, shown) = last_words(folder.path(), "stuck", &stuck);
    let rows = rows(&folder.path().join("stuck"));
    let left: f64 = rows[1][column("contact_area_fraction")]
        .parse()
        .expect("a number");
    let part = format!(
        "and the surfaces stick at zero load, {:.3} % of the area in contact.",
        100.0 * left
    );
    assert!(
        left > 0.0 && said.contains(&part),
        "{part} is missing in {said}"
    );
    assert!(shown.contains(&part), "{shown}");
}

/// Forces and states of the rows of a run of the sphere with a loading.
fn pulled(loading: &str, extra: &[&str]) -> (Vec<(f64, String)>, serde_json::Value) {
    let start = LOOP.find("[loading]").expect("a table");
    let text = format!(
        "{}[loading]\n{loading}\n[output]\nimages = []\n",
        &LOOP[..start]
    );
    let (folder, _) = scene(&text);
    let call = [&["run", "scene.toml", "--out", "out"], extra].concat();
    let output = tabor(folder.path(), &call);
    assert_eq!(status(&output), 0, "{}", errors(&output));
    let out = folder.path().join("out");
    let found = rows(&out).into_iter().map(|row| {
        let force = row[column("force")].parse().expect("a number");
        (force, row[column("state")].clone())
    });
    (found.collect(), summary(&out))
}

/// One pull-off, whatever is prescribed: between two tensions under a force, the greatest tension under an
/// approach. Steps aim at 5 % of it, so the sampled maximum, where the curve is level, is within a per cent.
fn until_apart_pulls_in_finer_steps_until_the_surfaces_separate() {
    let (held, summary) = pulled(
        "control = \"force\"\npath = [1e-5, 0]\nuntil = \"apart\"",
        &[],
    );
    let lower = summary["pull_off_lower"].as_f64().expect("a pull-off");
    let upper = summary["pull_off_upper"].as_f64().expect("a pull-off");
    assert!(
        lower <= upper && upper <= 1.0101 * lower,
        "{lower:e} {upper:e}"
    );
    assert!(held.len() > 10, "{held:?}");
    assert_eq!(summary["scene"]["loading"]["until"], "apart");

    let moved = [
        (
            "control = \"approach\"\npath = [\"0.3 um\", \"0.2 um\"]\nuntil = \"apart\"",
            0.01,
        ),
        // A soft spring snaps off the branch before the maximum under an approach, at that of a force.
        (
            "control = \"approach\"\nspring = \"0.1 N/m\"\npath = [\"100 um\", \"50 um\"]\nuntil = \"apart\"",
            0.06,
        ),
    ];
    for (loading, tolerance) in moved {
        let (rows, summary) = pulled(loading, &[]);
        let pull_off = summary["pull_off_force"].as_f64().expect("a pull-off");
        assert!(
            (pull_off / lower - 1.0).abs() < 0.01 + tolerance,
            "{loading}: {pull_off:e} {lower:e}"
        );
        let states: Vec<&str> = rows.iter().map(|(_, state)| state.as_str()).collect();
        assert!(rows.len() < 150, "{loading}: {} steps", rows.len());
        assert_eq!(
            states.iter().position(|state| *state == "separated"),
            Some(rows.len() - 1),
            "{states:?}"
        );
        assert_eq!(rows[rows.len() - 1].0, 0.0);
        // Up to the greatest tension no step changes the force by more than twice its aim. Behind it the
        // branch falls ever more steeply to its end, and a step follows the slope of the one before.
        let contact = rows.iter().take_while(|(_, state)| state == "contact");
        let forces: Vec<f64> = contact.map(|(force, _)| *force).collect();
        for pair in forces.windows(2).filter(|pair| pair[0] < 0.0) {
            let aim = if pair[1] < pair[0] { 0.05 } else { 0.15 };
            assert!(
                (pair[1] - pair[0]).abs() < 2.0 * aim * pull_off,
                "{loading}: {pair:?}"
            );
        }
    }

    // Without adhesion the first load that is not above zero ends it; its last step is the one with pictures.
    let extra = [
        "--set",
        "adhesion.work_of_adhesion=1e-9",
        "--set",
        "output.images=[\"gap\"]",
    ];
    let (rows, _) = pulled(
        "control = \"force\"\npath = [1e-5, 5e-6]\nuntil = \"apart\"",
        &extra,
    );
    assert_eq!(
        rows.last().map(|(_, state)| state.as_str()),
        Some("separated")
    );

    // A hold alone has no speed to go on at.
    let (folder, _) = scene(&LOOP.replace(
        "path = [\"-1.6 um\", \"-0.3 um\", \"0.5 um\", \"-0.5 um\", \"-1.6 um\"]",
        "start = 0\nuntil = \"apart\"\n[[loading.ramp]]\nhold = 1\nsteps = 2",
    ));
    let output = tabor(folder.path(), &["check", "scene.toml"]);
    assert_eq!(status(&output), 2);
    assert!(
        errors(&output).contains("pulls on at the speed of the last"),
        "{}",
        errors(&output)
    );
}

/// On a periodic grid a spring that is rigid beside the contact costs iterations and changes nothing.
fn a_spring_that_gives_nothing_is_warned_of() {
    let said = |spring: &str, boundary: &str| {
        let (folder, _) = scene(LOOP);
        let set = [
            format!("loading.spring={spring}"),
            format!("grid.boundary={boundary}"),
        ];
        let output = tabor(
            folder.path(),
            &["check", "scene.toml", "--set", &set[0], "--set", &set[1]],
        );
        assert_eq!(status(&output), 0, "{}", errors(&output));
        errors(&output)
    };
    let warning = "times as stiff as a punch as wide as the grid: it gives nothing";
    assert!(said("1e9", "periodic").contains(warning));
    assert!(!said("1", "periodic").contains(warning));
    assert!(!said("1e9", "free").contains(warning));
}

fn implausible_quantities_are_warned_of_with_the_likely_slip() {
    let said_of = |text: &str, set: &[&str]| {
        let (folder, _) = scene(text);
        let set = set.iter().flat_map(|set| ["--set", set]);
        let call: Vec<&str> = ["check", "scene.toml"].into_iter().chain(set).collect();
        let output = tabor(folder.path(), &call);
        assert_eq!(status(&output), 0, "{}", errors(&output));
        errors(&output)
    };
    let said = |set: &[&str]| said_of(LOOP, set);
    assert!(!said(&[]).contains("was it meant"));
    for (set, warning) in [
        (
            &["adhesion.work_of_adhesion=50"][..],
            "a work of adhesion of 50 J/m^2 is more than solids have: was it meant in mJ/m^2?",
        ),
        (
            &["solid.contact_modulus=\"50 mPa\""],
            "a contact modulus of 50 mPa is less than solids have: was it meant in MPa or GPa?",
        ),
        (
            &["grid.size=60", "surface.0.radius=100"],
            "a map 60 m wide is no surface that touches: was the size meant in um or nm?",
        ),
        (
            &["loading.spring=0.2", "surface.0.radius=1.5", "grid.size=1"],
            "a radius of 1.5 m at the tip of a cantilever: was it meant in um or nm?",
        ),
        (
            &[
                "loading={ control = \"pressure\", path = [\"1 mPa\", 0, \"-2 mPa\"] }",
                "grid.boundary=periodic",
                "output.steps=all",
            ],
            "the greatest mean pressure of the path is 2 mPa: was it meant in MPa?",
        ),
        (
            &["conductance={ conductivity = 45e6, counter_conductivity = 1 }"],
            "a conductivity of 4.5e7 W/(m K) is more than solids have for heat: was it meant in S/m?",
        ),
        (
            &["surface.0.radius=1e-7"],
            "degrees, is steeper than surfaces are: were the heights meant in another unit than the size?",
        ),
    ] {
        let told = said(set);
        assert!(told.contains(warning), "{warning} is missing in {told}");
    }
    let (before, adhesion) = LOOP.split_once("[adhesion]").expect("adhesion");
    let (_, behind) = adhesion.split_once("[loading]").expect("a path");
    let damp = format!("{before}[capillary]\nhumidity = 0.9\n[loading]{behind}");
    assert!(!said_of(&damp, &[]).contains("was it meant"));
    // The range of a meniscus is no key.
    let told = said_of(&damp, &["capillary.contact_angle=89.9"]);
    assert!(
        told.contains("of the cohesive zone") && !told.contains("range = \"auto\""),
        "{told}"
    );
    for (set, warning) in [
        (
            "capillary={ humidity = 0.9, temperature = 25, surface_tension = 0.05, molar_volume = 4e-5 }",
            "a temperature of 25 K at which a liquid condenses: was it meant in degrees Celsius?",
        ),
        (
            "capillary.surface_tension=72",
            "a surface tension of 72 N/m is more than liquids have: was it meant in mN/m?",
        ),
        (
            "capillary.molar_volume=18",
            "a molar volume of 18 m^3/mol is more than liquids have: was it meant in cm^3/mol?",
        ),
    ] {
        let told = said_of(&damp, &[set]);
        assert_eq!(told.matches("was it meant").count(), 1, "{told}");
        assert!(told.contains(warning), "{warning} is missing in {told}");
    }
}

/// A punch with flat pillars has no curvature, so no Tabor number; what a model of it leaves out is said.
fn a_tabor_number_is_given_only_where_a_curvature_is_meant() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let check = |name: &str| {
        let output = tabor(root, &["check", &format!("examples/scenes/{name}.toml")]);
        assert_eq!(status(&output), 0, "{}", errors(&output));
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    let punch = check("patterned_punch");
    assert!(!punch.contains("Tabor number "), "{punch}");
    assert!(
        punch.contains("no curvature, and no Tabor number"),
        "{punch}"
    );
    assert!(
        punch.contains("pillars are rigid, as the whole counter-face is"),
        "{punch}"
    );
    let sphere = check("sphere_pull_off");
    assert!(
        sphere.contains("Tabor number 2.4") && !sphere.contains("pillars"),
        "{sphere}"
    );
}

/// Nothing is said of the contact where there is no solution.
fn a_step_beyond_closure_is_called_what_it_is() {
    let (folder, _) = scene(
        "grid = { points = 16, size = 1.0 }\nsolid = { contact_modulus = 1.0 }\nsurface = [{ kind = \"wavy\", amplitude = 0.01, wavelength = 1.0 }]\nloading = { control = \"approach\", path = [0.02] }\n",
    );
    let output = tabor(folder.path(), &["run", "scene.toml", "--out", "out"]);
    let said = errors(&output);
    assert_eq!(status(&output), 3, "{said}");
    assert!(said.contains("No step has a solution."), "{said}");
    assert!(said.contains("inf  no solution"), "{said}");
    let report = fs::read_to_string(folder.path().join("out/report.html")).expect("a report");
    for text in [&said, &report] {
        assert!(!text.contains("do not touch") && !text.contains("separated"));
    }
}

/// A flat has no height by which the first step behind the path could go. Steps that `[output]` names and that the path does not come to are
/// said to have nothing.
fn a_flat_is_pulled_apart_and_steps_beyond_its_end_are_told() {
    let (folder, _) = scene(
        "[grid]\npoints = 16\nsize = 1e-6\nboundary = \"free\"\n[solid]\ncontact_modulus = 1e6\n[[surface]]\nkind = \"flat\"\n[loading]\ncontrol = \"approach\"\npath = [1e-9]\nuntil = \"apart\"\n[output]\nsteps = [1, 900, 400]\n",
    );
    let output = tabor(folder.path(), &["run", "scene.toml", "--out", "out"]);
    assert_eq!(status(&output), 0, "{}", errors(&output));
    let rows = rows(&folder.path().join("out"));
    assert!((3..100).contains(&rows.len()), "{} steps", rows.len());
    let last = &rows[rows.len() - 1];
    assert_eq!(last[column("state")], "separated");
    let told = format!(
        "the path ended with step {}, and output.steps names others beyond it, step 400 and on",
        rows.len()
    );
    let warnings = summary(&folder.path().join("out"))["warnings"].to_string();
    assert!(
        errors(&output).contains(&told) && warnings.contains(&told),
        "{}",
        errors(&output)
    );
}

/// Loading and unloading are one curve, whose force is not the slope of the energies: nothing that a loop encloses is a loss.
fn a_loop_of_the_dmt_treatment_has_no_hysteresis() {
    let (folder, _) = scene(LOOP);
    let (said, page) = last_words(
        folder.path(),
        "out",
        &["--set", "adhesion.treatment=\"dmt\""],
    );
    let summary = summary(&folder.path().join("out"));
    assert!(summary["hysteresis_energy"].is_null(), "{summary}");
    assert!(summary["hysteresis_uncertainty"].is_null(), "{summary}");
    assert!(!said.contains("loses") && !page.contains("loses"), "{said}");
}

/// The contact meets its tolerance, and the conjugate gradients on it have as many iterations and do not.
fn a_conductance_that_is_not_found_is_not_told_as_a_contact() {
    let (folder, _) = scene(
        "[grid]\npoints = 64\nsize = 2e-6\n[solid]\ncontact_modulus = 1e9\n[[surface]]\nkind = \"self-affine\"\nhurst = 0.8\nrms_slope = 0.1\nlongest = 2e-6\nrolloff = 1e-6\nshortest = 1e-7\n[conductance]\nconductivity = 400.0\ncounter_conductivity = 50.0\n[loading]\ncontrol = \"pressure\"\npath = [80e6]\n[output]\nimages = []\n",
    );
    let run = |out: &str, extra: &[&str]| {
        let call = [&["run", "scene.toml", "--quiet", "--out", out], extra].concat();
        let output = tabor(folder.path(), &call);
        let row = table(&folder.path().join(out).join("curve.csv")).swap_remove(0);
        (status(&output), errors(&output), row)
    };
    let (done, said, found) = run("found", &[]);
    assert_eq!(done, 0, "{said}");
    let most = format!("solver.max_iterations={}", found["iterations"]);
    let (done, said, lost) = run("lost", &["--set", &most]);
    assert_eq!(done, 3, "{said}");
    assert!(
        said.contains("the contact is solved, and its [conductance] or [leakage] is not"),
        "{said}"
    );
    assert_eq!(lost["converged"], "false");
    assert!(number(&lost, "residual").is_some_and(|residual| residual <= 1e-6));
}

tests![
    a_flat_is_pulled_apart_and_steps_beyond_its_end_are_told,
    a_loop_of_the_dmt_treatment_has_no_hysteresis,
    a_conductance_that_is_not_found_is_not_told_as_a_contact,
    a_path_that_turns_back_at_its_greatest_tension_says_so,
    rounding_hides_no_pull_off_and_widens_no_bracket,
    an_attraction_that_holds_is_warned_of,
    a_step_beyond_closure_is_called_what_it_is,
    a_tabor_number_is_given_only_where_a_curvature_is_meant,
    a_spring_that_gives_nothing_is_warned_of,
    implausible_quantities_are_warned_of_with_the_likely_slip,
    until_apart_pulls_in_finer_steps_until_the_surfaces_separate,
    the_last_words_and_the_first_line_of_the_report_state_the_result,
    a_run_writes_what_the_contract_says,
    lengths_that_the_grid_sets_are_in_the_summary,
    the_same_scene_gives_the_same_bits,
    folders_that_are_not_this_scenes_are_left_alone,
    a_file_in_the_way_and_an_unwritable_place,
    a_step_that_does_not_converge_is_written_and_ends_the_run,
    mistakes_are_named_all_at_once_with_their_lines,
    what_this_version_lacks_is_refused_by_name,
    check_lists_effects_regime_and_resolution,
    overrides_reach_the_scene,
    single_precision_has_its_floor_and_its_fields,
    #[cfg(unix)]
    what_is_no_regular_file_is_refused,
    of_very_many_mistakes_the_first_and_their_number_are_said,
    steps_that_rounding_ends_are_warned_of,
    pull_off_under_a_load,
];
