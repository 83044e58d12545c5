//! `tabor fit` with curves as instruments write them: piezo position and deflection in volts, a baseline that is not
//! level, errors of spring and radius, folders of curves.

use std::fs;
use std::path::Path;

use serde_json::Value;
use tabor::theory::jkr;
use tabor::theory::tabor_map::Sphere;
use tabor::units::format_si;

use crate::shared::binary::{self, errors, status, tabor};
use crate::shared::random::Random;
use crate::shared::trials::tests;

const RADIUS: f64 = 5e-6;
const WORK: f64 = 0.04;
const MODULUS: f64 = 2e6;
/// Cantilever: N/m, and m/V.
const SPRING: f64 = 0.3;
const SENSITIVITY: f64 = 60e-9;

/// Approach and force of a JKR sphere that is pressed and pulled off, with noise of 1 % of the pull-off force.
fn curve(seed: u64) -> Vec<[f64; 2]> {
    curve_with_noise(seed, 0.01)
}

/// The same with noise of that share.
fn curve_with_noise(seed: u64, share: f64) -> Vec<[f64; 2]> {
    let sphere = Sphere::new(RADIUS, MODULUS, WORK).expect("a sphere");
    let (nearest, count) = (600e-9, 200);
    let step = |i: usize| -nearest / 2.0 + 1.5 * nearest * i as f64 / count as f64;
    // The approach at which a sphere held by its approach lets go.
    let mut grip = 0.0;
    while jkr::contact_radius_at_approach(&sphere, grip - 1e-9).is_ok() {
        grip -= 1e-9;
    }
    let force = |approach: f64, from: f64| {
        let radius = (approach >= from).then(|| jkr::contact_radius_at_approach(&sphere, approach));
        radius.map_or(0.0, |radius| {
            jkr::force(&sphere, radius.expect("in contact"))
        })
    };
    let noise = share * jkr::pull_off_force(&sphere).abs();
    let mut random = Random(seed);
    let mut disturbed =
        |approach: f64, from: f64| [approach, force(approach, from) + noise * random.normal()];
    let mut points: Vec<[f64; 2]> = (0..count).map(|i| disturbed(step(i), 0.0)).collect();
    points.extend((0..count).rev().map(|i| disturbed(step(i), grip)));
    points
}

/// The same on the cantilever, which lets go at the greatest tension: the noise is that of its deflection, of 2 nm, at positions of its base that are
/// known.
fn on_a_cantilever(seed: u64) -> Vec<[f64; 2]> {
    let (exact, noisy) = (curve_with_noise(seed, 0.0), curve_with_noise(seed, 6e-4));
    let tension = |at: &usize| -exact[*at][1];
    let pulled_off = (0..exact.len()).max_by(|a, b| tension(a).total_cmp(&tension(b)));
    let holds = |at: &usize| Some(*at) <= pulled_off || exact[*at][1] == 0.0;
    let rows = (0..exact.len()).filter(holds).map(|at| {
        let [approach, force] = exact[at];
        let measured = noisy[at][1];
        [approach - (measured - force) / SPRING, measured]
    });
    rows.collect()
}

fn table(head: &str, rows: &[[f64; 2]], line: impl Fn([f64; 2]) -> String) -> String {
    let lines: String = rows.iter().map(|row| line(*row) + "\n").collect();
    format!("{head}{lines}")
}

/// What `tabor fit` says of a file with these options.
fn fit(folder: &Path, text: &str, options: &[&str]) -> Value {
    fs::write(folder.join("curve.txt"), text).expect("written");
    let call = [
        &["fit", "curve.txt", "--radius", "5 um", "--out", "out"],
        options,
    ]
    .concat();
    let output = tabor(folder, &call);
    assert_eq!(status(&output), 0, "{options:?}: {}", errors(&output));
    let found = fs::read(folder.join("out/fit.json")).expect("a result");
    serde_json::from_slice(&found).expect("JSON")
}

/// Value and uncertainty of a quantity.
fn quantity(found: &Value, name: &str) -> [f64; 2] {
    ["value", "uncertainty"].map(|key| {
        found[name][key]
            .as_f64()
            .unwrap_or_else(|| panic!("{name}: {found}"))
    })
}

fn positions_and_deflections_are_read_in_every_form() {
    let folder = tempfile::tempdir().expect("a folder");
    let volts = |force: f64| force / SPRING / SENSITIVITY;
    let position = |[approach, force]: [f64; 2]| approach + force / SPRING;
    let rows = on_a_cantilever(1);
    // The piezo's height falls as the surfaces come closer.
    let raw = table("Time;Height (um);Defl [mV]\n", &rows, |row| {
        format!("0;{:e};{:e}", -1e6 * position(row), 1e3 * volts(row[1]))
    });
    let spring = ["--spring", "0.3 N/m"];
    let sensitivity = ["--sensitivity", "60 nm/V"];
    let columns = ["--columns", "position=-height,deflection=defl"];
    let by_name = [&columns[..], &spring, &sensitivity].concat();
    let bare = table("# volts and metres\n", &rows, |row| {
        format!("{:e}  {:e}", volts(row[1]), position(row))
    });
    let by_number = [
        &["--columns", "position=2,deflection=1"][..],
        &spring,
        &sensitivity,
    ]
    .concat();
    let forces = table("z [nm]\tforce [nN]\n", &rows, |row| {
        format!("{:e}\t{:e}", 1e9 * position(row), 1e9 * row[1])
    });
    let with_force = [&["--columns", "position=z"][..], &spring].concat();
    let first = fit(folder.path(), &raw, &by_name);
    for (text, options) in [(bare, by_number), (forces, with_force)] {
        let found = fit(folder.path(), &text, &options);
        assert_eq!(found["model"], first["model"], "{options:?}");
        for name in ["work_of_adhesion", "contact_modulus", "approach_offset"] {
            let (here, there) = (quantity(&found, name), quantity(&first, name));
            // The same numbers but for their last digits; the search ends within a hundredth of the uncertainty.
            assert!(
                (here[0] - there[0]).abs() < 0.01 * there[1],
                "{name}: {here:?} {there:?}"
            );
        }
    }
    // Three deviations contain what the curve was made of.
    for (name, truth) in [("work_of_adhesion", WORK), ("contact_modulus", MODULUS)] {
        let [value, deviation] = quantity(&first, name);
        assert!(
            (value - truth).abs() < 3.0 * deviation,
            "{name}: {value:e} {deviation:e}"
        );
    }
}

fn options_that_cannot_be_meant_are_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = table("approach,force\n", &curve(1), |[x, f]| {
        format!("{x:e},{f:e}")
    });
    fs::write(folder.path().join("curve.csv"), text).expect("written");
    let told = |options: &[&str]| {
        let output = tabor(folder.path(), &[&["fit"], options].concat());
        (status(&output), errors(&output))
    };
    let plain = ["curve.csv", "--radius", "5 um"];
    let sensitivity = [&plain[..], &["--sensitivity", "60 nm/V"]].concat();
    let numbers = ["--pull-off", "2 uN", "--stiffness", "30 N/m"];
    let (unused, doubt) = (
        "warning: the sensitivity changes nothing: the curve has no deflection in volts",
        "warning: a radius of 5 m is more than probes have: was it meant in um or nm?",
    );
    for (options, line) in [
        (&sensitivity[..], unused),
        (&["curve.csv", "--radius", "5"], doubt),
        (&[&numbers[..], &["--radius", "5"]].concat(), doubt),
    ] {
        let (status, said) = told(options);
        assert!(status == 0 && said.contains(line), "{options:?}: {said}");
    }
    let (_, said) = told(&plain);
    assert!(
        !said.contains("sensitivity") && !said.contains("radius"),
        "{said}"
    );
    for (number, name) in [("-2 uN", "--pull-off"), ("-30 N/m", "--stiffness")] {
        let options = [
            "--radius",
            "5 um",
            "--pull-off",
            "2 uN",
            "--stiffness",
            "30 N/m",
        ];
        let options = options.map(|word| if word == &number[1..] { number } else { word });
        let (status, said) = told(&options);
        let line = format!("invalid value '{number}' for '{name}");
        assert!(status == 2 && said.contains(&line), "{options:?}: {said}");
        assert!(said.contains("must be greater than zero"), "{said}");
    }
}

fn errors_of_spring_and_radius_are_carried_into_the_result() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = table("approach,force\n", &curve(2), |[x, f]| {
        format!("{x:e},{f:e}")
    });
    let plain = fit(folder.path(), &text, &[]);
    let wide = fit(
        folder.path(),
        &text,
        &["--spring-error", "8%", "--radius-error", "0.06"],
    );
    // w goes with k/R, E* with k/sqrt(R).
    for (name, error) in [
        ("work_of_adhesion", 0.1),
        ("contact_modulus", 0.08_f64.hypot(0.03)),
    ] {
        let (before, after) = (quantity(&plain, name), quantity(&wide, name));
        assert_eq!(before[0], after[0]);
        let expected = before[1].hypot(error * before[0]);
        assert!(
            (after[1] / expected - 1.0).abs() < 1e-9,
            "{name}: {after:?} {expected:e}"
        );
    }
    for wrong in ["-1%", "150%", "ten"] {
        let call = [
            "fit",
            "curve.txt",
            "--radius",
            "5 um",
            "--spring-error",
            wrong,
        ];
        let output = tabor(folder.path(), &call);
        assert_eq!(status(&output), 2, "{wrong}");
    }
}

/// The table's row of the chosen model, the headline and `fit.json` state the same numbers, for a curve with noise and
/// errors of spring and radius.
fn one_headline_states_one_uncertainty() {
    let folder = tempfile::tempdir().expect("a folder");
    let rows = curve(3);
    let text = table("approach,force\n", &rows, |[x, f]| {
        // More noise, so that the models are not told apart and the uncertainty is that of all of them.
        format!("{x:e},{:e}", f + 1.5e-8 * (x * 7.3e10).sin())
    });
    fs::write(folder.path().join("curve.csv"), text).expect("written");
    let call = [
        "fit",
        "curve.csv",
        "--radius",
        "5 um",
        "--out",
        "out",
        "--spring-error",
        "10%",
    ];
    let output = tabor(folder.path(), &call);
    let said = errors(&output);
    assert_eq!(status(&output), 0, "{said}");
    let found = fs::read(folder.path().join("out/fit.json")).expect("a result");
    let found: Value = serde_json::from_slice(&found).expect("JSON");
    let chosen: Vec<&str> = said.lines().filter(|line| line.starts_with('>')).collect();
    let [row] = chosen[..] else {
        panic!("one chosen model: {said}");
    };
    let headlines = said
        .lines()
        .filter(|line| line.contains("w = ") && line.contains("E* = "));
    let headlines: Vec<&str> = headlines
        .filter(|line| !line.starts_with("warning"))
        .collect();
    let [headline] = headlines[..] else {
        panic!("one headline: {said}");
    };
    let model = found["model"].as_str().expect("a model");
    let entry = found["models"].as_array().expect("models").iter();
    let entry = entry
        .clone()
        .find(|entry| entry["model"] == model)
        .expect("the model");
    for (name, unit) in [("work_of_adhesion", "J/m^2"), ("contact_modulus", "Pa")] {
        let [value, deviation] = quantity(&found, name);
        assert!(
            row.contains(&format!("{value:.4e} +- {deviation:.1e}")),
            "{name}: {row}"
        );
        let stated = format!(
            "{} +- {}",
            format_si(value, unit),
            format_si(deviation, unit)
        );
        assert!(headline.contains(&stated), "{stated}: {headline}");
        assert_eq!(quantity(entry, name), [value, deviation]);
    }
}

/// A force that no contact has.
fn a_curve_that_no_model_describes_is_said_so() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = table("approach,force\n", &curve(4), |[x, f]| {
        format!("{x:e},{:e}", f + 3e-7 * (x * 5e7).sin())
    });
    fs::write(folder.path().join("curve.csv"), text).expect("written");
    let output = tabor(folder.path(), &["fit", "curve.csv", "--radius", "5 um"]);
    let said = errors(&output);
    assert_eq!(status(&output), 0, "{said}");
    assert!(
        said.contains("none of these models describes the curve; "),
        "{said}"
    );
    let found = fs::read_to_string(folder.path().join("curve/fit.json")).expect("a result");
    assert!(found.contains("\"describes_curve\": false"), "{found}");
}

fn both_approaches_are_columns() {
    let folder = tempfile::tempdir().expect("a folder");
    let rows = on_a_cantilever(5);
    let slope = 0.02;
    let text = table("position,deflection\n", &rows, |[x, f]| {
        let force = f + slope * x;
        format!("{:e},{:e}", x + force / SPRING, force / SPRING)
    });
    let options = ["--spring", "0.3 N/m", "--baseline-slope"];
    fit(folder.path(), &text, &options);
    let written = binary::table(&folder.path().join("out/fit.csv"));
    assert_eq!(written.len(), rows.len());
    let noise = 6e-4 * 1.5 * std::f64::consts::PI * WORK * RADIUS;
    for (row, [approach, force]) in written.iter().zip(rows) {
        let value = |name: &str| binary::number(row, name).expect("a number");
        let force = force + slope * approach;
        // Rounding of the numbers in the file, of the size of the largest.
        assert!((value("approach") - approach).abs() < 1e-20);
        assert!((value("position") - approach - force / SPRING).abs() < 1e-20);
        assert!((value("force") - force).abs() < 1e-20);
        assert!(
            (value("model_force") - force).abs() < 6.0 * noise,
            "{row:?}"
        );
        assert!(["loading", "unloading"].contains(&row["segment"].as_str()));
    }
    // Without a spring there is no base.
    let plain = table("approach,force\n", &curve(5), |[x, f]| {
        format!("{x:e},{f:e}")
    });
    fit(folder.path(), &plain, &[]);
    let written = binary::table(&folder.path().join("out/fit.csv"));
    assert!(
        written
            .iter()
            .all(|row| binary::number(row, "position").is_none())
    );
}

fn a_baseline_with_a_slope_is_levelled() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut missed = 0;
    for seed in 0..4 {
        let (slope, offset) = (2e-2 * (1.0 + seed as f64), 3e-8);
        let text = table("approach,force\n", &curve(10 + seed), |[x, f]| {
            format!("{x:e},{:e}", f + offset + slope * x)
        });
        let found = fit(folder.path(), &text, &["--baseline-slope"]);
        for (name, truth) in [
            ("work_of_adhesion", WORK),
            ("contact_modulus", MODULUS),
            ("baseline_slope", slope),
            ("force_offset", offset),
        ] {
            let [value, deviation] = quantity(&found, name);
            let away = (value - truth).abs() / deviation;
            missed += usize::from(away > 2.0);
            assert!(
                away < 4.0,
                "{seed}, {name}: {value:e} +- {deviation:e}, is {truth:e}"
            );
        }
    }
    // One of twenty in the mean; five of sixteen happen once in a thousand.
    assert!(missed < 5, "{missed} of 16 beyond two deviations");
}

fn a_folder_of_curves_gives_a_table_a_histogram_and_the_failures() {
    let folder = tempfile::tempdir().expect("a folder");
    let curves = folder.path().join("map");
    fs::create_dir(&curves).expect("made");
    for seed in 0..6 {
        let text = table("approach,force\n", &curve(20 + seed), |[x, f]| {
            format!("{x:e},{f:e}")
        });
        // A curve may have the name of the table.
        let name = match seed {
            0 => "fits.csv".to_owned(),
            _ => format!("point_{seed}.csv"),
        };
        fs::write(curves.join(name), text).expect("written");
    }
    fs::write(curves.join("broken.csv"), "approach,force\n1,much\n").expect("written");
    fs::write(curves.join("notes.md"), "no curve").expect("written");
    let call = ["fit", "map", "--radius", "5 um"];
    let output = tabor(folder.path(), &call);
    let said = errors(&output);
    assert_eq!(status(&output), 0, "{said}");
    assert!(
        said.contains("6 of 7 curves fitted") && said.contains("work of adhesion: median"),
        "{said}"
    );
    assert!(said.contains("broken.csv, line 2"), "{said}");
    let out = folder.path().join("map_fits");
    let table = fs::read_to_string(out.join("fits.csv")).expect("a table");
    let rows: Vec<Vec<&str>> = table
        .lines()
        .map(|line| line.split(',').collect())
        .collect();
    assert_eq!(rows.len(), 8, "{table}");
    assert!(
        rows[1][0] == "broken.csv" && table.contains("is not a number"),
        "{table}"
    );
    for row in &rows[2..] {
        let work: f64 = row[2].parse().expect("a number");
        let deviation: f64 = row[3].parse().expect("a number");
        assert!((work - WORK).abs() < 4.0 * deviation, "{row:?}");
        for end in ["json", "png"] {
            assert!(out.join(format!("{}.{end}", row[0])).is_file());
        }
        // The data of the picture are those of the curve: a fit of them gives the same.
        let own = out.join(format!("{}.fit.csv", row[0]));
        let own = fs::read_to_string(own).expect("the data of the picture");
        let head = "approach,position,force,model_force,segment,interacting";
        assert_eq!(own.lines().next(), Some(head));
        let again = fit(folder.path(), &own, &[]);
        let [found, _] = quantity(&again, "work_of_adhesion");
        assert!((found - work).abs() < 1e-6 * work, "{found} {work}");
    }
    assert!(fs::metadata(out.join("fits.png")).expect("a picture").len() > 1000);
    // The same table again, byte by byte, and a folder of others is left alone.
    assert_eq!(status(&tabor(folder.path(), &call)), 0);
    assert_eq!(
        fs::read_to_string(out.join("fits.csv")).expect("a table"),
        table
    );
    fs::write(out.join("fits.csv"), "mine\n").expect("written");
    assert_eq!(status(&tabor(folder.path(), &call)), 2);
    fs::write(out.join("fits.csv"), table).expect("written");
    let empty = tabor(
        folder.path(),
        &["fit", "map_fits", "--radius", "5 um", "--out", "x"],
    );
    assert_eq!(status(&empty), 2);
    assert!(
        errors(&empty).contains("no curve in this folder"),
        "{}",
        errors(&empty)
    );
}

/// The advice on a curve, as `fit.json` has it and as it is said.
fn advised(rows: &[[f64; 2]], options: &[&str]) -> (Value, String) {
    let folder = tempfile::tempdir().expect("a folder");
    let text = table("approach,force\n", rows, |[x, f]| format!("{x:e},{f:e}"));
    fs::write(folder.path().join("curve.csv"), text).expect("written");
    let call = ["fit", "curve.csv", "--radius", "5 um", "--advise"];
    let output = tabor(folder.path(), &[&call[..], options].concat());
    let said = errors(&output);
    assert_eq!(status(&output), 0, "{said}");
    let text = fs::read_to_string(folder.path().join("curve/fit.json")).expect("a result");
    let found: Value = serde_json::from_str(&text).expect("JSON");
    (found["advice"].clone(), said)
}

/// Hertz less a pull-off force while in contact, in and out to a load of `load` pull-off forces, with noise.
fn hertz_less(pull_off: f64, load: f64, noise: f64) -> Vec<[f64; 2]> {
    let stiffness = 4.0 / 3.0 * MODULUS * RADIUS.sqrt();
    let greatest = 2.0 * std::f64::consts::PI * WORK * RADIUS * load;
    let deepest = (greatest / stiffness).powf(2.0 / 3.0);
    let mut random = Random(9);
    let places = (-60_i32..=140).chain((-60..140).rev());
    places
        .map(|i| deepest * f64::from(i) / 140.0)
        .map(|approach| {
            let contact = if approach > 0.0 {
                stiffness * approach.powf(1.5) - pull_off
            } else {
                0.0
            };
            [approach, contact + noise * random.normal()]
        })
        .collect()
}

/// JKR's own curve, DMT's, one without adhesion: each gets its model, and the probabilities add up.
fn advice_names_the_model_of_its_own_curves() {
    let pull_off = 2.0 * std::f64::consts::PI * WORK * RADIUS;
    for (rows, expected, says) in [
        (curve(1), "jkr", "advice: JKR, with "),
        (
            hertz_less(pull_off, 5.0, 0.02 * pull_off),
            "dmt",
            "advice: DMT, with ",
        ),
        (
            hertz_less(0.0, 5.0, 0.05 * pull_off),
            "hertz",
            "advice: Hertz, with ",
        ),
    ] {
        let (advice, said) = advised(&rows, &[]);
        assert_eq!(advice["model"], expected, "{advice:#} {said}");
        assert!(
            said.contains(says) && said.contains("advice: what weighs most: "),
            "{said}"
        );
        let shares = advice["probabilities"].as_object().expect("a table");
        let sum: f64 = shares
            .values()
            .map(|share| share.as_f64().expect("a number"))
            .sum();
        assert!((sum - 1.0).abs() < 1e-12 && shares.len() == 5, "{advice:#}");
        assert_eq!(advice["outside"], false, "{advice:#}");
    }
}

/// A spring and a wave are no contact of spheres.
fn advice_says_none_of_these() {
    let wave: Vec<[f64; 2]> = curve(4)
        .into_iter()
        .map(|[x, f]| [x, f + 3e-7 * (x * 5e7).sin()])
        .collect();
    let spring: Vec<[f64; 2]> = hertz_less(0.0, 5.0, 0.0)
        .into_iter()
        .map(|[x, _]| [x, 10.0 * x.max(0.0) + 1e-9 * (x * 1e12).sin()])
        .collect();
    for rows in [wave, spring] {
        let (advice, said) = advised(&rows, &[]);
        assert_eq!(advice["model"], "none", "{advice:#}");
        assert!(said.contains("advice: none of these"), "{said}");
    }
}

/// What the advice cannot be asked of is refused; without the option there is none.
fn advice_is_for_curves_of_spheres() {
    for options in [
        &["--cone", "20 deg", "--advise", "curve.csv"][..],
        &[
            "--radius",
            "5 um",
            "--range",
            "1 nm",
            "--advise",
            "curve.csv",
        ],
        &[
            "--radius",
            "5 um",
            "--pull-off",
            "1 uN",
            "--stiffness",
            "1 N/m",
            "--advise",
        ],
    ] {
        let output = tabor(Path::new("."), &[&["fit"], options].concat());
        assert_eq!(status(&output), 2, "{options:?}");
        assert!(errors(&output).contains("--advise"), "{}", errors(&output));
    }
    let folder = tempfile::tempdir().expect("a folder");
    let text = table("approach,force\n", &curve(1), |[x, f]| {
        format!("{x:e},{f:e}")
    });
    assert!(fit(folder.path(), &text, &[])["advice"].is_null());
}

tests![
    advice_names_the_model_of_its_own_curves,
    advice_says_none_of_these,
    advice_is_for_curves_of_spheres,
    one_headline_states_one_uncertainty,
    a_curve_that_no_model_describes_is_said_so,
    both_approaches_are_columns,
    positions_and_deflections_are_read_in_every_form,
    options_that_cannot_be_meant_are_told,
    errors_of_spring_and_radius_are_carried_into_the_result,
    a_baseline_with_a_slope_is_levelled,
    a_folder_of_curves_gives_a_table_a_histogram_and_the_failures,
];
