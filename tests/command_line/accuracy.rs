//! `tabor accuracy` from outside: its files, what it names, its budget, and an interrupt; and what it
//! says of a range that the grid has to stretch, and of cohesive zones near a pixel.

#[path = "../../examples/accuracy_study/tables.rs"]
mod tables;

use std::collections::HashMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::shared::binary::{self, errors, number, scene, signal, table, tabor, without_adapter};
use crate::shared::device::device;
use crate::shared::trials::tests;

/// The columns that other programs rely on, in their order.
const COLUMNS: &str = "points,backend,precision,tolerance,steps,treatment,taper,seconds,error_area,error_force,error_pressure,error_pull_off,reference_uncertainty,pareto";

/// A hard sphere pressed on in three steps: Hertz.
const HERTZ: &str = r#"
[grid]
points = 64
size = "40 um"
boundary = "free"
[solid]
contact_modulus = "1 MPa"
[[surface]]
kind = "sphere"
radius = "100 um"
[loading]
control = "approach"
path = ["0.2 um", "0.4 um", "0.6 um"]
"#;

/// A rough surface that sticks, pressed on and pulled off.
const ROUGH: &str = r#"
[grid]
points = 128
size = "2 um"
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
path = ["0.2 MPa", "1 MPa", "0.2 MPa"]
"#;

fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = binary::command(folder, &["accuracy", "scene.toml", "--out", "out"]);
    command
        .args(arguments)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    command
}

/// The rows of `accuracy.csv` by column.
fn rows(folder: &Path) -> Vec<HashMap<String, String>> {
    let path = folder.join("out/accuracy.csv");
    let text = fs::read_to_string(&path).expect("there is a table");
    assert!(text.starts_with(COLUMNS), "{text:.200}");
    table(&path)
}

/// Leaves a graphics processor out: a software driver takes 8 s to compile its shaders for a grid.
const CPU: &str = "solver.backend=\"cpu\"";

/// Its rows have the errors of the processor's, on a grid of 16 points: 1e-4 of the residual leaves the field right to 1e-3.
fn a_graphics_processor_has_rows_of_its_own() {
    device();
    let folder = scene(HERTZ);
    let output = command(
        folder.path(),
        &["--budget", "60 s", "--set", "grid.points=16"],
    )
    .output()
    .expect("it runs");
    assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    let rows = rows(folder.path());
    let errors_on = |backend: &str| {
        let own = rows.iter().filter(|row| {
            row["backend"] == backend && row["points"] == "16" && row["varied"] == "precision"
        });
        own.map(|row| number(row, "error_force").expect("judged"))
            .collect::<Vec<f64>>()
    };
    let (own, others) = (errors_on("gpu"), errors_on("cpu"));
    assert!(own.len() >= 2 && !others.is_empty(), "{rows:?}");
    let worst = own.iter().map(|error| (error - others[0]).abs());
    assert!(worst.fold(0.0, f64::max) < 1e-3, "{own:?}, {others:?}");
}

fn a_sphere_is_judged_by_its_closed_form() {
    let folder = scene(HERTZ);
    let output = command(folder.path(), &["--budget", "60 s", "--set", CPU])
        .output()
        .expect("it runs");
    let text = errors(&output);
    assert_eq!(output.status.code(), Some(0), "{text}");
    assert!(output.stdout.is_empty(), "standard output stays clean");
    assert!(text.contains("the closed form of Hertz"), "{text}");
    let picture = image::open(folder.path().join("out/accuracy.png")).expect("a picture");
    assert!(picture.width() > 400 && picture.height() > 300);
    let rows = rows(folder.path());

    // The scene's own way on 16, 32 and 64 points. Force and pressure are of second order on smooth
    // contacts, so that each halving of the pixel takes more than half of the error, whatever the
    // place of the pixels at the edge of the contact.
    let own: Vec<_> = rows.iter().filter(|row| row["varied"] == "grid").collect();
    let points: Vec<&str> = own.iter().map(|row| row["points"].as_str()).collect();
    assert_eq!(points, ["16", "32", "64"]);
    for name in ["error_force", "error_pressure"] {
        let errors: Vec<f64> = own
            .iter()
            .map(|row| number(row, name).expect("judged"))
            .collect();
        assert!(
            errors.windows(2).all(|e| e[1] < 0.5 * e[0]),
            "{name}: {errors:?}"
        );
        // A contact radius of 12 pixels on the finest grid.
        assert!(errors[2] < 0.01, "{name}: {errors:?}");
    }
    // Nothing pulls, and a closed form is sure of itself.
    assert!(own.iter().all(|row| row["error_pull_off"].is_empty()));
    assert!(
        rows.iter()
            .all(|row| number(row, "reference_uncertainty") == Some(0.0))
    );

    // What is varied is there, and single precision is as good as its floor: 1e-4 of the residual
    // leaves the field right to 1e-3.
    for varied in ["tolerance", "precision", "steps"] {
        assert!(rows.iter().any(|row| row["varied"] == varied), "{varied}");
    }
    // Nothing relaxes: there is no time to be wrong about.
    for row in &rows {
        assert!(row["varied"] != "time tolerance", "{row:?}");
        assert!(row["time_tolerance"].is_empty() && row["error_in_time"].is_empty());
    }
    let single = rows.iter().filter(|row| row["precision"] == "single");
    for row in single {
        assert!(
            number(row, "change").is_some_and(|change| change < 1e-3),
            "{row:?}"
        );
    }

    // No row beats one on the front. Seconds are printed to a millionth: of equal ones either may be the faster.
    let place = |row: &HashMap<String, String>| {
        let error = number(row, "error_largest").expect("judged");
        (number(row, "seconds").expect("timed"), error)
    };
    let front: Vec<_> = rows.iter().filter(|row| row["pareto"] == "true").collect();
    assert!(!front.is_empty());
    for chosen in &front {
        let (seconds, error) = place(chosen);
        let beats = |row: &&HashMap<String, String>| {
            let (other, least) = place(row);
            other < seconds && least <= error
        };
        assert!(!rows.iter().any(|row| beats(&row)), "{chosen:?}");
    }
    // What is named for 10 % of all errors is the cheapest row that has it.
    let cheapest = rows
        .iter()
        .filter(|row| place(row).1 <= 0.1)
        .min_by(|a, b| place(a).0.total_cmp(&place(b).0))
        .expect("10 % is reached");
    let named = text
        .split("cheapest for 10 %:")
        .nth(1)
        .expect("it is named");
    let named = named
        .lines()
        .find(|line| line.contains("all of them"))
        .expect("for all");
    let is_there = |word: &str| named.contains(word);
    let side = &cheapest["points"];
    assert!(
        is_there(&format!("{side} x {side}, ")) && is_there(&cheapest["precision"]),
        "{named}"
    );
    assert!(cheapest["pareto"] == "true");
}

/// A scene that names the processor has no settings on another one, and no driver is begun for them.
fn the_processor_alone_where_the_scene_says_so() {
    let folder = scene(HERTZ);
    let set = ["grid.points=16", "solver.backend=cpu"].map(|set| ["--set", set]);
    let output = command(
        folder.path(),
        &[&["--budget", "5 s"], set.as_flattened()].concat(),
    )
    .output()
    .expect("it runs");
    let text = errors(&output);
    assert_eq!(output.status.code(), Some(0), "{text}");
    let rows = rows(folder.path());
    assert!(!rows.is_empty() && rows.iter().all(|row| row["backend"] == "cpu"));
    assert!(!text.contains("gpu"), "{text}");
}

fn what_there_is_no_time_for_is_left_out_and_listed() {
    let folder = scene(ROUGH);
    // The reference of 512 points is one of 1024, in twice the steps, and a coarser one takes an eighth of its time at most.
    // Which of them there is time for depends on the machine and on what else it does: half the time where there was enough for the
    // finer, and twice the time where there was not enough for the coarsest, meet between the two.
    let mut budget: f64 = 6.0;
    for _ in 0..TRIES {
        // A study in the folder of the one before would not begin.
        let _ = fs::remove_dir_all(folder.path().join("out"));
        let budget_text = budget.to_string();
        let clock = Instant::now();
        let arguments = ["--budget", budget_text.as_str(), "--set", "grid.points=512"];
        let output = command(folder.path(), &arguments)
            .output()
            .expect("it runs");
        let took = clock.elapsed();
        let text = errors(&output);
        assert_eq!(output.status.code(), Some(0), "{text}");
        // Runs end with the iteration in which the time does; the rest is for heights and pictures.
        assert!(
            took < Duration::from_secs_f64(budget + REST),
            "{took:?} of {budget} s"
        );
        let list = text
            .split("left out, ")
            .nth(1)
            .expect("a list of what was left out");
        assert!(
            list.contains("would take about") || list.contains("not done after"),
            "{list}"
        );
        if !list.contains("512 x 512: every setting") {
            budget /= 2.0;
            continue;
        }
        // 512 points are halved three times; the coarsest of them has a reference twice as fine.
        let rows = rows(folder.path());
        if !rows.iter().any(|row| row["points"] == "64") {
            budget *= 2.0;
            continue;
        }
        assert!(
            rows.iter()
                .all(|row| number(row, "reference_uncertainty").is_some())
        );
        return;
    }
    panic!("no time is too short for the finer reference and long enough for the coarsest");
}

/// Times that are tried.
const TRIES: usize = 8;
/// Seconds that the heights and pictures of a study may take on a machine that does other work.
const REST: f64 = 20.0;

fn a_rough_surface_is_judged_by_finer_grids_and_an_interrupt_keeps_the_rows() {
    let folder = scene(ROUGH);
    let child = command(folder.path(), &["--budget", "10 min"])
        .spawn()
        .expect("it starts");
    let table = folder.path().join("out/accuracy.csv");
    let lines = || fs::read_to_string(&table).map_or(0, |text| text.lines().count());
    let clock = Instant::now();
    // Five rows are after the reference, so that they are judged.
    while lines() < 6 && clock.elapsed() < Duration::from_secs(300) {
        std::thread::sleep(Duration::from_millis(20));
    }
    assert!(
        signal(&child, "-INT"),
        "the study was over before its interrupt"
    );
    let output = child.wait_with_output().expect("it ends");
    let text = errors(&output);
    assert_eq!(output.status.code(), Some(130), "{text}");
    assert!(
        text.contains("interrupted after") && text.contains("are kept in out"),
        "{text}"
    );
    let rows = rows(folder.path());
    assert!(rows.len() >= 5);
    for row in &rows {
        assert!(number(row, "error_area").is_some(), "{row:?}");
        assert!(
            number(row, "reference_uncertainty").is_some_and(f64::is_finite),
            "{row:?}"
        );
        // Pressed on only: no pull-off to be wrong about.
        assert!(row["error_pull_off"].is_empty());
    }
}

/// A force held on a solid of two relaxation times: in equal steps, as the scene has them, and in those
/// that `steps = "auto"` finds for several errors in time.
fn the_error_of_adaptive_time_steps_is_shown_beside_that_of_equal_ones() {
    let folder = scene(
        r#"
[grid]
points = 32
size = "40 um"
boundary = "free"
[solid]
contact_modulus = "1 MPa"
[[solid.relaxation]]
modulus = "5 MPa"
time = "20 ms"
[[solid.relaxation]]
modulus = "4 MPa"
time = "1 s"
[[surface]]
kind = "sphere"
radius = "100 um"
[loading]
control = "force"
start = "50 uN"
[[loading.ramp]]
hold = "40 s"
steps = 40
"#,
    );
    let mut study = command(folder.path(), &["--budget", "60 s"]);
    let output = without_adapter(&mut study).output().expect("it runs");
    let text = errors(&output);
    assert_eq!(output.status.code(), Some(0), "{text}");
    let picture = image::open(folder.path().join("out/accuracy.png")).expect("a picture");
    assert!(picture.height() > 600, "three errors, and that in time");
    let rows = rows(folder.path());
    let get = |row: &HashMap<String, String>, name: &str| number(row, name).expect("a number");
    for points in ["16", "32"] {
        let on_grid: Vec<_> = rows.iter().filter(|row| row["points"] == points).collect();
        // The reference itself is walked, and in more than twice as many steps as all others.
        let most = |is_judged: bool| {
            let rows = on_grid
                .iter()
                .filter(|row| row["error_in_time"].is_empty() != is_judged);
            let plain = rows.filter(|row| {
                ["grid", "steps", "time tolerance"].contains(&row["varied"].as_str())
            });
            plain.map(|row| get(row, "steps")).fold(0.0, f64::max)
        };
        assert!(most(false) > 2.0 * most(true), "{points}");

        let mut auto: Vec<_> = on_grid
            .iter()
            .filter(|row| row["varied"] == "time tolerance")
            .map(|row| {
                ["time_tolerance", "steps", "error_in_time", "transforms"]
                    .map(|name| get(row, name))
            })
            .collect();
        auto.sort_by(|a, b| b[0].total_cmp(&a[0]));
        let asked: Vec<f64> = auto.iter().map(|row| row[0]).collect();
        assert_eq!(asked, [1e-1, 1e-2, 1e-3]);
        // What is asked is kept, and a tenth of it costs more and errs less.
        assert!(auto.iter().all(|row| row[2] < row[0]), "{auto:?}");
        let falls = |pair: &[[f64; 4]]| pair[1][2] < 0.5 * pair[0][2] && pair[1][3] > pair[0][3];
        assert!(auto.windows(2).all(falls), "{auto:?}");

        // Of second order, an error falls with the square of the steps: at one number of steps, equal
        // ones of 0.5 to 2 s err at least twice as much, since much of the answer comes within 20 ms.
        let equal: Vec<_> = on_grid
            .iter()
            .filter(|row| {
                ["grid", "steps"].contains(&row["varied"].as_str())
                    && !row["error_in_time"].is_empty()
            })
            .map(|row| ["steps", "error_in_time"].map(|name| get(row, name)))
            .collect();
        assert_eq!(equal.len(), 3, "the scene's own, half and twice: {equal:?}");
        let square = |steps: f64, error: f64| steps * steps * error;
        for [steps, error] in equal {
            assert!(
                2.0 * square(auto[2][1], auto[2][2]) < square(steps, error),
                "{points}: {steps} {error:e} {auto:?}"
            );
        }
    }
    // With a word for each on the screen.
    let shown = text.split("of which in time").nth(1).expect("a table");
    for words in [
        "half the steps",
        "auto steps to 1e-1",
        "auto steps to 1e-2",
        "auto steps to 1e-3",
    ] {
        assert!(shown.contains(words), "{text}");
    }
}

/// `range = "auto"` is judged by the limit that it stands for, JKR on a sphere, and beside a range
/// that is given it is one of the settings, with its error.
fn a_range_that_the_grid_stretches_has_its_error_shown() {
    // Tabor number 5: on 32 points the range of 100 nm is far below the pixel's.
    let sphere = r#"
[grid]
points = 32
size = "40 um"
boundary = "free"
[solid]
contact_modulus = "1 MPa"
[[surface]]
kind = "sphere"
radius = "100 um"
[adhesion]
law = "maugis-dugdale"
work_of_adhesion = "50 mJ/m^2"
range = "100 nm"
[loading]
control = "approach"
start = "0.3 um"
[[loading.ramp]]
to = "-1.5 um"
steps = 36
"#;
    for (range, reference) in [("\"100 nm\"", "Maugis"), ("\"auto\"", "JKR")] {
        let folder = scene(sphere);
        let set = format!("adhesion.range={range}");
        let mut study = command(folder.path(), &["--budget", "30 s", "--set", &set]);
        let output = without_adapter(&mut study).output().expect("it runs");
        let text = errors(&output);
        assert_eq!(output.status.code(), Some(0), "{text}");
        assert!(
            text.contains(&format!("the closed form of {reference}")),
            "{text}"
        );
        let rows = rows(folder.path());
        let varied = if reference == "Maugis" {
            "range"
        } else {
            "grid"
        };
        let stretched: Vec<_> = rows.iter().filter(|row| row["varied"] == varied).collect();
        assert_eq!(stretched.len(), 2, "{text}");
        for row in &stretched {
            // sqrt(2 w dx/E*) with pixels of 2.5 and 1.25 um.
            let pixel = 40e-6 / number(row, "points").expect("points");
            let expected = (2.0 * 50e-3 * pixel / 1e6_f64).sqrt();
            assert!((number(row, "range").expect("a range") / expected - 1.0).abs() < 1e-9);
            assert!(number(row, "error_pull_off").is_some_and(|error| error > 0.0));
        }
    }
}

/// A sphere of a Tabor number whose pixel is `chi` of its cohesive zone, in units in which every scale of
/// Maugis is 1 (K = 1, R = 1, w = 1/pi), pressed on and pulled off.
fn soft_sphere(tabor: f64, chi: f64) -> String {
    use std::f64::consts::PI;
    // For a law of constant tension, lambda is 1.157 of Tabor's number.
    let lambda = 1.157_011_6 * tabor;
    let pixel = 3.0 * chi / (PI * lambda * lambda);
    // Contact and zone are 2 wide at most; no less than what holds them on 32 points.
    let points = (4.8 / pixel / 2.0).ceil().max(16.0) as usize * 2;
    format!(
        r#"
[grid]
points = {points}
size = {size}
boundary = "free"
[solid]
contact_modulus = 0.75
[[surface]]
kind = "sphere"
radius = 1.0
[adhesion]
law = "maugis-dugdale"
work_of_adhesion = {work}
range = {range}
[loading]
control = "approach"
start = 0.0
[[loading.ramp]]
to = -1.2
steps = 48
"#,
        size = points as f64 * pixel,
        work = 1.0 / PI,
        range = 2.0 / (PI * lambda),
    )
}

/// Tabor numbers at which a cohesive zone near a pixel spoils a sharp law without a word elsewhere.
///
/// With the taper pull-off is right to 3 % at chi 0.65 (2.1 % was measured at most, on periodic spheres; 1 %
/// is left for the free boundary and the steps). At 1.3 the contact itself is 10 to 25 pixels wide, whose
/// edge counts too: 10 %, and that is warned of. What the taper does not mend at 2.6 is warned of as such.
fn soft_spheres_are_right_or_warned_of() {
    for (tabor, chi) in [
        (2.0, 0.64),
        (2.0, 1.29),
        (3.0, 1.29),
        (2.0, 2.6),
        (3.0, 2.6),
    ] {
        let folder = scene(&soft_sphere(tabor, chi));
        // On these points alone: fewer would be coarser still.
        let mut study = command(folder.path(), &["--budget", "60 s"]);
        let output = without_adapter(&mut study).output().expect("it runs");
        assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
        assert!(errors(&output).contains("the closed form of Maugis"));
        let warned = |taper: &str| -> Option<String> {
            let output = binary::tabor(folder.path(), &["check", "scene.toml", "--set", taper]);
            let text = errors(&output);
            text.lines()
                .find(|line| line.contains("(chi = "))
                .map(str::to_owned)
        };
        let rows = rows(folder.path());
        let finest = rows
            .iter()
            .filter_map(|row| number(row, "points"))
            .fold(0.0, f64::max);
        let pull_off = |varied: &str, is_sharp: bool| {
            let found = rows.iter().find(|row| {
                number(row, "points") == Some(finest)
                    && row["varied"] == varied
                    && (number(row, "taper") == Some(0.0)) == is_sharp
            });
            number(found.expect("it was run"), "error_pull_off").expect("judged")
        };
        let (tapered, sharp) = (pull_off("grid", false), pull_off("taper", true));
        println!(
            "Tabor {tabor}, chi {chi}: {finest} points, tapered {tapered:.3}, sharp {sharp:.3}"
        );
        // Every other code's law: far off, and said to be.
        assert!(sharp > 0.1, "{sharp}");
        let message = warned("adhesion.taper=0").expect("the sharp law is warned of");
        assert!(message.contains("10 % cannot be reached"), "{message}");
        let share = format!("a pixel is {chi:.2} of the cohesive zone");
        assert!(message.contains(&share), "{message}");
        let message = warned("adhesion.taper=\"auto\"");
        if chi <= 0.65 {
            assert!(tapered < 0.03, "Tabor {tabor}, chi {chi}: {tapered}");
            continue;
        }
        let message = message.expect("past its limit the taper is warned of");
        assert!(message.contains(&share), "{message}");
        if chi <= 1.3 {
            assert!(message.contains("beyond 0.65"), "{message}");
            assert!(tapered < 0.1, "Tabor {tabor}, chi {chi}: {tapered}");
        } else {
            assert!(message.contains("10 % cannot be reached"), "{message}");
            assert!(message.contains("beyond 1.3"), "{message}");
            assert!(tapered > 0.1, "a needless warning: {tapered}");
        }
    }
}

/// A zone of three pixels does not help a contact that is five pixels wide itself, and that is said too.
fn a_contact_of_few_pixels_is_warned_of() {
    for (chi, strength) in [
        (0.6, "10 % cannot be reached"),
        (0.33, "the contact at pull-off"),
    ] {
        let folder = scene(&soft_sphere(1.0, chi));
        let output = tabor(folder.path(), &["check", "scene.toml"]);
        let text = errors(&output);
        let line = text.lines().find(|line| line.contains("pixels wide"));
        assert!(line.is_some_and(|line| line.contains(strength)), "{text}");
    }
}

/// The tables of the page are those of the committed measurements.
fn the_page_shows_what_was_measured() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = fs::read_to_string(root.join("docs/accuracy.md")).expect("there is a page");
    for name in tables::STUDIES {
        let path = root.join(format!("docs/accuracy_{}.csv", name));
        let table = fs::read_to_string(path).expect("it was measured");
        let shown = tables::tables(&table).expect("the table is whole");
        assert!(
            page.contains(&shown),
            "{}: run the example accuracy_study",
            name
        );
        let picture = root.join(format!("docs/pictures/accuracy_{}.png", name));
        let bytes = fs::metadata(picture).expect("there is a picture").len();
        assert!((1_000..150_000).contains(&bytes), "{}: {bytes} bytes", name);
    }
}

tests![
    a_graphics_processor_has_rows_of_its_own,
    a_sphere_is_judged_by_its_closed_form,
    the_processor_alone_where_the_scene_says_so,
    what_there_is_no_time_for_is_left_out_and_listed,
    a_rough_surface_is_judged_by_finer_grids_and_an_interrupt_keeps_the_rows,
    the_error_of_adaptive_time_steps_is_shown_beside_that_of_equal_ones,
    a_range_that_the_grid_stretches_has_its_error_shown,
    soft_spheres_are_right_or_warned_of,
    a_contact_of_few_pixels_is_warned_of,
    the_page_shows_what_was_measured,
];
