//! `tabor fit` on files of instruments, tips other than spheres, and solids that relax.

use std::fs;
use std::path::Path;

use serde_json::Value;
use tabor::fit::{CurveColumns, ForceCurve};

use crate::shared::binary::{errors, status, tabor};
use crate::shared::random::Random;
use crate::shared::trials::tests;

fn sample(name: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/files")
        .join(name)
}

/// What `tabor fit` finds in a file, and what it says.
fn fit(folder: &Path, file: &str, options: &[&str]) -> (Value, String) {
    let call = [&["fit", file, "--out", "out"], options].concat();
    let output = tabor(folder, &call);
    let said = errors(&output);
    assert_eq!(status(&output), 0, "{options:?}: {said}");
    let found = fs::read(folder.join("out/fit.json")).expect("a result");
    (serde_json::from_slice(&found).expect("JSON"), said)
}

fn quantity(found: &Value) -> [f64; 2] {
    ["value", "uncertainty"].map(|key| found[key].as_f64().unwrap_or_else(|| panic!("{found}")))
}

/// Times, heights and forces as afmformats reads them; heights fall as the probe comes closer.
fn jpk_curves_are_read_as_another_program_reads_them() {
    let table = fs::read_to_string(sample("curves.csv")).expect("a table");
    let rows: Vec<Vec<&str>> = table
        .lines()
        .skip(1)
        .map(|line| line.split(',').collect())
        .collect();
    let mut compared = 0;
    for (name, spring) in [
        ("jpk_alone.jpk-force", None),
        ("jpk_shared.jpk-force", Some(0.05)),
    ] {
        let mut columns = CurveColumns::default();
        columns.spring = spring;
        let curve = ForceCurve::read_columns(&sample(name), &columns).expect("a curve");
        let stiffness = curve.spring.expect("a spring constant");
        for row in rows.iter().filter(|row| row[0] == name) {
            let [time, height, force] =
                [1, 2, 3].map(|at| row[at].parse::<f64>().expect("a number"));
            let at = curve
                .times
                .iter()
                .position(|found| (found - time).abs() < 1e-9);
            let found = curve.samples[at.unwrap_or_else(|| panic!("{name}: no point at {time}"))];
            // Rounding of sums of a few terms.
            assert!(
                (found.force - force).abs() < 1e-12 * force.abs(),
                "{name}: {found:?}"
            );
            let expected = -height - force / stiffness;
            assert!(
                (found.approach - expected).abs() < 1e-18,
                "{name}: {found:?}"
            );
            compared += 1;
        }
    }
    assert_eq!(compared, 8);
    // The second file has no spring constant.
    let folder = tempfile::tempdir().expect("a folder");
    let path = sample("jpk_shared.jpk-force");
    let call = ["fit", path.to_str().expect("text"), "--radius", "5 um"];
    let output = tabor(folder.path(), &call);
    assert_eq!(status(&output), 2);
    assert!(
        errors(&output).contains("(--spring)"),
        "{}",
        errors(&output)
    );
    let refused = tabor(
        folder.path(),
        &[&call[..], &["--columns", "force=2"]].concat(),
    );
    assert!(
        errors(&refused).contains("leave --columns out"),
        "{}",
        errors(&refused)
    );
}

/// A paraboloid of 50 nm in 100 MPa, put together by `tests/files/cut_curves.py` with the digits that the file has.
fn a_nanoscope_curve_gives_the_modulus_it_was_made_of() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = sample("nanoscope_force.spm");
    let (found, _) = fit(
        folder.path(),
        path.to_str().expect("text"),
        &["--radius", "50 nm"],
    );
    assert_eq!(found["model"], "hertz");
    let [value, deviation] = quantity(&found["contact_modulus"]);
    assert!(
        (value - 100e6).abs() < 4.0 * deviation && deviation < 1e6,
        "{value:e} +- {deviation:e}"
    );
    assert_eq!(found["points"], 256);
    // Where the ramp has brought the undeformed surfaces together.
    let [touch, _] = quantity(&found["approach_offset"]);
    assert!((touch - 180e-9).abs() < 1e-9, "{touch:e}");
}

/// A folder takes files of instruments beside text, and lists what it cannot read.
fn a_folder_takes_files_of_instruments() {
    let folder = tempfile::tempdir().expect("a folder");
    let curves = folder.path().join("curves");
    fs::create_dir(&curves).expect("made");
    for name in ["nanoscope_force.spm", "jpk_shared.jpk-force"] {
        fs::copy(sample(name), curves.join(name)).expect("copied");
    }
    // An image is no curve.
    fs::copy(sample("bruker_5.spm"), curves.join("image.spm")).expect("copied");
    let call = ["fit", "curves", "--cone", "20 deg", "--out", "out"];
    let output = tabor(folder.path(), &call);
    let said = errors(&output);
    assert_eq!(status(&output), 0, "{said}");
    assert!(said.contains("1 of 3 curves fitted"), "{said}");
    assert!(
        said.contains("image.spm") && said.contains("(--spring)"),
        "{said}"
    );
    assert!(folder.path().join("out/nanoscope_force.spm.json").is_file());
}

/// Force by approach of a cone with adhesion in parametric form, Maugis & Barquins 1981.
fn cone_state(radius: f64, [modulus, work, slope]: [f64; 3]) -> [f64; 2] {
    use std::f64::consts::{FRAC_PI_2, PI};
    let approach = FRAC_PI_2 * radius * slope - (2.0 * PI * radius * work / modulus).sqrt();
    let force = FRAC_PI_2 * modulus * radius * radius * slope
        - (8.0 * PI * modulus * work * radius.powi(3)).sqrt();
    [approach, force]
}

fn cones_and_pyramids_give_back_work_of_adhesion_and_modulus() {
    let folder = tempfile::tempdir().expect("a folder");
    let (modulus, work, angle) = (5e6, 0.02, 35_f64.to_radians());
    // A pyramid is the cone that Bilodeau's 0.7453 makes as stiff.
    let slopes = [
        1.0 / angle.tan(),
        1.0 / (0.7453 * std::f64::consts::FRAC_PI_2 * angle.tan()),
    ];
    for (option, slope) in ["--cone", "--pyramid"].into_iter().zip(slopes) {
        let unit = work / (modulus * slope * slope);
        let numbers = [modulus, work, slope];
        let noise = 0.01 * 54.0 / std::f64::consts::PI * work * unit / slope;
        let mut random = Random(7);
        let mut rows = String::from("approach,force\n");
        let grip = cone_state(2.0 / std::f64::consts::PI * unit, numbers)[0];
        let free = |i: usize| grip * (3.0 - 0.02 * i as f64);
        for i in 0..60 {
            rows += &format!("{:e},{:e}\n", free(i), noise * random.normal());
        }
        // Pulled from 16 units of radius down to the grip.
        for i in (0..200).rev() {
            let radius = unit * (2.0 / std::f64::consts::PI + 16.0 * (i as f64 / 199.0).powi(2));
            let [approach, force] = cone_state(radius, numbers);
            rows += &format!("{approach:e},{:e}\n", force + noise * random.normal());
        }
        for i in (0..60).rev() {
            rows += &format!("{:e},{:e}\n", free(i), noise * random.normal());
        }
        fs::write(folder.path().join("tip.csv"), rows).expect("written");
        let (found, said) = fit(folder.path(), "tip.csv", &[option, "35 deg"]);
        assert_eq!(found["model"], "jkr", "{said}");
        assert_eq!(found["indenter"], option.trim_start_matches('-'));
        assert!((found["half_angle"].as_f64().expect("an angle") - 35.0).abs() < 1e-9);
        assert_eq!(found["radius"], Value::Null);
        for (name, truth) in [("contact_modulus", modulus), ("work_of_adhesion", work)] {
            let [value, deviation] = quantity(&found[name]);
            assert!(
                (value - truth).abs() < 4.0 * deviation && deviation < 0.1 * truth,
                "{option} {name}: {value:e} +- {deviation:e}"
            );
        }
    }
    // Without adhesion: Sneddon.
    let mut rows = String::from("approach [nm],force [nN]\n");
    let mut random = Random(9);
    for i in -40..60_i32 {
        let depth = f64::from(i.max(0)) * 10.0;
        let force = std::f64::consts::FRAC_2_PI * modulus * angle.tan() * (depth * 1e-9).powi(2);
        rows += &format!("{},{}\n", 10 * i, 1e9 * force + 2.0 * random.normal());
    }
    fs::write(folder.path().join("bare.csv"), rows).expect("written");
    let (found, _) = fit(folder.path(), "bare.csv", &["--cone", "35"]);
    assert_eq!(found["model"], "hertz");
    let [value, deviation] = quantity(&found["contact_modulus"]);
    assert!(
        (value - modulus).abs() < 4.0 * deviation && deviation < 0.1 * modulus,
        "{value:e} +- {deviation:e}"
    );
    for wrong in [
        &["--cone", "95 deg"][..],
        &["--cone", "35", "--radius", "1 um"],
        &[],
    ] {
        let output = tabor(folder.path(), &[&["fit", "bare.csv"], wrong].concat());
        assert_eq!(status(&output), 2, "{wrong:?}");
    }
}

/// Force of a sphere that is pressed at a constant speed into a standard linear solid, by the integral of Lee & Radok with the
/// power of the approach known at every moment: 2000 steps of Simpson's rule.
fn pressed(time: f64, [relaxed, rest, relaxation]: [f64; 3], speed: f64, radius: f64) -> f64 {
    let steps = 2000;
    let step = time / steps as f64;
    let rate = |at: f64| 1.5 * speed.powf(1.5) * at.sqrt();
    let modulus = |age: f64| relaxed + rest * (-age / relaxation).exp();
    let sum: f64 = (0..=steps)
        .map(|i| {
            let at = i as f64 * step;
            let weight = if i == 0 || i == steps {
                1.0
            } else {
                2.0 + 2.0 * f64::from(i as u32 % 2)
            };
            weight * modulus(time - at) * rate(at)
        })
        .sum();
    4.0 / 3.0 * radius.sqrt() * sum * step / 3.0
}

fn a_relaxation_time_is_found_beside() {
    let folder = tempfile::tempdir().expect("a folder");
    let (solid, speed, radius) = ([20e3, 40e3, 0.15], 2e-6, 5e-6);
    let noise = 2e-11;
    let mut random = Random(3);
    let mut rows = String::from("time [ms],approach [nm],force [nN]\n");
    // Before touch, in, and out along the curve of the relaxed solid, which asks for less force.
    for i in 0..400 {
        let time = (f64::from(i) - 100.0) * 2e-3;
        let approach = speed * time;
        let force = if time > 0.0 {
            pressed(time, solid, speed, radius)
        } else {
            0.0
        };
        rows += &format!(
            "{},{},{}\n",
            2 * i,
            1e9 * approach,
            1e9 * (force + noise * random.normal())
        );
    }
    for i in (0..399).rev() {
        let approach = speed * (f64::from(i) - 100.0) * 2e-3;
        let force = 4.0 / 3.0 * radius.sqrt() * solid[0] * approach.max(0.0).powf(1.5);
        rows += &format!(
            "{},{},{}\n",
            1600 - 2 * i,
            1e9 * approach,
            1e9 * (force + noise * random.normal())
        );
    }
    fs::write(folder.path().join("slow.csv"), &rows).expect("written");
    let (found, said) = fit(folder.path(), "slow.csv", &["--radius", "5 um"]);
    assert!(
        said.contains("more force than unloading")
            && said.contains("--relaxation fits a relaxation time beside"),
        "{said}"
    );
    assert_eq!(found["relaxation"], Value::Null);
    let (found, said) = fit(
        folder.path(),
        "slow.csv",
        &["--radius", "5 um", "--relaxation"],
    );
    assert!(
        said.contains("standard linear solid, on loading: "),
        "{said}"
    );
    let found = &found["relaxation"];
    for (name, truth) in [
        ("relaxed_modulus", solid[0]),
        ("instantaneous_modulus", solid[0] + solid[1]),
        ("time", solid[2]),
    ] {
        let [value, deviation] = quantity(&found[name]);
        assert!(
            (value - truth).abs() < 4.0 * deviation && deviation < 0.3 * truth,
            "{name}: {value:e} +- {deviation:e}, is {truth:e}"
        );
    }
    // An elastic curve of the same noise says nothing of it.
    let elastic: String = (0..800)
        .map(|i: i32| {
            let place = if i < 400 { i } else { 799 - i };
            let approach = speed * (f64::from(place) - 100.0) * 2e-3;
            let force = 4.0 / 3.0 * radius.sqrt() * 40e3 * approach.max(0.0).powf(1.5);
            format!(
                "{},{}\n",
                1e9 * approach,
                1e9 * (force + noise * random.normal())
            )
        })
        .collect();
    fs::write(
        folder.path().join("fast.csv"),
        format!("approach [nm],force [nN]\n{elastic}"),
    )
    .expect("written");
    let (_, said) = fit(folder.path(), "fast.csv", &["--radius", "5 um"]);
    assert!(!said.contains("more force than unloading"), "{said}");
}

/// The solver's own viscoelastic solid, pressed at a constant speed.
fn the_relaxation_of_a_solved_sphere_comes_back() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = "[grid]\npoints = 48\nsize = \"6 um\"\nboundary = \"free\"\n[solid]\ncontact_modulus = \"1 MPa\"\n\
        [[solid.relaxation]]\nmodulus = \"2 MPa\"\ntime = \"100 ms\"\n[[surface]]\nkind = \"sphere\"\nradius = \"10 um\"\n\
        [loading]\ncontrol = \"approach\"\nstart = \"0 nm\"\n[[loading.ramp]]\nto = \"400 nm\"\nsteps = 60\nduration = \"300 ms\"\n\
        [output]\nimages = []\n";
    fs::write(folder.path().join("creep.toml"), scene).expect("written");
    let output = tabor(folder.path(), &["run", "creep.toml", "--quiet"]);
    assert_eq!(status(&output), 0, "{}", errors(&output));
    let options = ["--radius", "10 um", "--contact-at-zero", "--relaxation"];
    let (found, _) = fit(folder.path(), "creep/curve.csv", &options);
    // The pixels are what is left: on 48 points the moduli come out 0.3 % high and the time 0.7 % low, on 96 points by
    // 0.1 % and 0.15 %.
    for (name, truth, share) in [
        ("relaxed_modulus", 1e6, 0.005),
        ("instantaneous_modulus", 3e6, 0.005),
        ("time", 0.1, 0.01),
    ] {
        let [value, _] = quantity(&found["relaxation"][name]);
        assert!((value / truth - 1.0).abs() < share, "{name}: {value:e}");
    }
}

tests![
    jpk_curves_are_read_as_another_program_reads_them,
    a_nanoscope_curve_gives_the_modulus_it_was_made_of,
    a_folder_takes_files_of_instruments,
    cones_and_pyramids_give_back_work_of_adhesion_and_modulus,
    a_relaxation_time_is_found_beside,
    the_relaxation_of_a_solved_sphere_comes_back,
];
