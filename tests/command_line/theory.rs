//! `tabor theory` from outside: tables, values, the list, messages.

use std::f64::consts::PI;
use std::io::Read;
use std::path::Path;
use std::process::{Output, Stdio};
use std::time::Instant;

use serde_json::Value;

use crate::shared::binary::{command, tabor};
use crate::shared::trials::tests;

/// Seconds after which a call says that it is at work.
const SILENCE: f64 = 5.0;

/// Every model with its columns.
const MODELS: [(&str, &str); 22] = [
    (
        "hertz",
        "approach,force,contact_radius,peak_pressure,stiffness",
    ),
    ("cone", "approach,force,contact_radius,contact_pressure"),
    ("flat-punch", "approach,force,contact_pressure"),
    ("bradley", "approach,force,gap"),
    ("derjaguin", "approach,force,contact_radius,attraction"),
    ("dmt-t", "approach,force,contact_radius,attraction"),
    ("idmt-t", "approach,force,contact_radius,attraction"),
    ("dmt-f", "approach,force,contact_radius,attraction"),
    ("dmt-m", "approach,force,contact_radius,attraction"),
    ("jkr", "approach,force,contact_radius,state"),
    (
        "maugis-dugdale",
        "approach,force,contact_radius,cohesive_radius,state",
    ),
    (
        "lennard-jones-sphere",
        "approach,force,contact_radius,central_gap,state",
    ),
    (
        "tabor-map",
        "law,tabor_parameter,maugis_parameter,peak_tension,pull_off_force,advice",
    ),
    ("advise", "model,probability"),
    (
        "westergaard",
        "mean_pressure,contact_area_fraction,mean_gap,peak_pressure",
    ),
    ("wavy-adhesive", "contact_area_fraction,mean_pressure"),
    (
        "gw",
        "separation,mean_pressure,contact_area_fraction,contact_density",
    ),
    (
        "gw-m",
        "separation,mean_pressure,contact_area_fraction,contact_density",
    ),
    ("fuller-tabor", "separation,mean_pressure"),
    (
        "persson",
        "mean_pressure,contact_area_fraction,mean_gap,stiffness,adhesive_pressure,repulsive_pressure",
    ),
    ("bam", "mean_gap,mean_pressure"),
    ("pastewka-robbins", "range,stickiness_ratio,sticky"),
];

fn theory(arguments: &[&str]) -> Output {
    tabor(Path::new("."), &[&["theory"], arguments].concat())
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("text")
}

/// A table as it was printed.
struct Table {
    comments: Vec<String>,
    head: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    fn from_example(model: &str, call: &str) -> Self {
        let words = shell_words(call);
        let arguments: Vec<&str> = std::iter::once(model)
            .chain(words.iter().map(String::as_str))
            .collect();
        let clock = Instant::now();
        let output = theory(&arguments);
        assert!(output.status.success(), "{model}: {}", text(&output.stderr));
        // A call says no more than that it is at work: one line at 5 s, and one each time that has doubled.
        let said = text(&output.stderr);
        let at_work = |line: &str| line.starts_with("note: at work for ");
        assert!(said.lines().all(at_work), "{said}");
        let doublings = (clock.elapsed().as_secs_f64() / SILENCE).log2();
        let most = (doublings.floor() + 1.0).max(0.0) as usize;
        assert!(said.lines().count() <= most, "{model}: {said}");
        let all = text(&output.stdout);
        let is_comment = |line: &&str| line.starts_with('#');
        let comments = all.lines().take_while(is_comment).map(str::to_owned);
        let mut lines = all.lines().skip_while(is_comment);
        let split = |line: &str| line.split(',').map(str::to_owned).collect::<Vec<_>>();
        Table {
            comments: comments.collect(),
            head: split(lines.next().expect("a head")),
            rows: lines.map(split).collect(),
        }
    }

    fn place(&self, column: &str) -> usize {
        self.head
            .iter()
            .position(|name| name == column)
            .unwrap_or_else(|| panic!("no column {column} in {:?}", self.head))
    }

    fn column(&self, column: &str) -> Vec<f64> {
        let place = self.place(column);
        let number = |row: &Vec<String>| row[place].parse().expect("a number");
        self.rows.iter().map(number).collect()
    }

    fn words(&self, column: &str) -> Vec<&str> {
        let place = self.place(column);
        self.rows.iter().map(|row| row[place].as_str()).collect()
    }

    /// Number of a comment such as `# pull_off_force = -1e-9 N`.
    fn note(&self, name: &str) -> f64 {
        let head = format!("# {name} = ");
        let line = self
            .comments
            .iter()
            .find_map(|line| line.strip_prefix(&head));
        let line = line.unwrap_or_else(|| panic!("no {name} in {:?}", self.comments));
        line.split(' ')
            .next()
            .and_then(|number| number.parse().ok())
            .expect("a number")
    }
}

/// Splits at spaces outside double quotes.
fn shell_words(text: &str) -> Vec<String> {
    let outside = |(index, part): (usize, &str)| -> Vec<String> {
        if index % 2 == 0 {
            part.split_whitespace().map(str::to_owned).collect()
        } else {
            vec![part.to_owned()]
        }
    };
    text.split('"').enumerate().flat_map(outside).collect()
}

fn close(found: f64, expected: f64, relative: f64) {
    assert!(
        (found - expected).abs() <= relative * expected.abs(),
        "{found:e} is not {expected:e}"
    );
}

/// The reference values, by key.
fn reference(key: &str) -> Value {
    let file: Value = serde_json::from_str(include_str!("../reference/theory_checks.json"))
        .expect("the reference is JSON");
    file["checks"][key]["expected"].clone()
}

fn expected(key: &str) -> f64 {
    reference(key).as_f64().expect("a number")
}

fn expected_at(key: &str, name: &str) -> f64 {
    reference(key)[name].as_f64().expect("a number")
}

fn every_model_is_listed_and_its_example_tabulates() {
    let output = theory(&[]);
    assert!(output.status.success());
    let list = text(&output.stdout);
    let listed: Vec<&str> = list
        .lines()
        .skip(3)
        .filter(|line| !line.starts_with(' '))
        .filter_map(|line| line.split_once(": ").map(|(name, _)| name))
        .collect();
    assert_eq!(listed, MODELS.map(|(name, _)| name));
    for (name, columns) in MODELS {
        let help = theory(&[name, "--help"]);
        assert!(help.status.success(), "{name}");
        let help = text(&help.stdout);
        let call = format!("  tabor theory {name} ");
        let example = help.lines().find_map(|line| line.strip_prefix(&call));
        let table = Table::from_example(name, example.unwrap_or_else(|| panic!("{name}: {help}")));
        assert_eq!(table.head.join(","), columns, "{name}");
        assert!(table.rows.len() >= 2, "{name}");
        for row in &table.rows {
            assert_eq!(row.len(), table.head.len(), "{name}");
        }
        // One that never has anything is no column.
        for (place, column) in table.head.iter().enumerate() {
            let filled = table.rows.iter().any(|row| !row[place].is_empty());
            assert!(filled, "{name}: {column}");
        }
        for part in ["# model: ", "# source: ", "# parameter: ", "# columns: "] {
            let here = table.comments.iter().any(|line| line.starts_with(part));
            assert!(here, "{name}: {part}");
        }
    }
}

fn numbers_read_back_as_they_are() {
    let table = Table::from_example(
        "hertz",
        "--radius \"1 mm\" --contact_modulus 1e9 --from 0 --to \"25 nm\" --points 3",
    );
    assert_eq!(table.words("approach"), ["0.0", "1.25e-8", "2.5e-8"]);
    assert_eq!(table.words("force")[0], "0.0");
    let equals = Table::from_example(
        "hertz",
        "--radius=1mm --contact-modulus=1GPa --from=0 --to=25nm --points=3",
    );
    assert_eq!(equals.rows, table.rows);
}

fn hard_contacts_have_the_reference_values() {
    let approach = expected_at("hertz", "delta");
    let call =
        format!("--radius \"1 mm\" --contact_modulus \"1 GPa\" --to {approach:e} --points 2");
    let table = Table::from_example("hertz", &call);
    close(table.column("force")[1], 1e-3, 1e-12);
    close(
        table.column("contact_radius")[1],
        expected_at("hertz", "a"),
        1e-12,
    );
    close(
        table.column("peak_pressure")[1],
        expected_at("hertz", "p0"),
        1e-12,
    );
    close(
        table.column("stiffness")[1],
        expected_at("hertz", "stiffness"),
        1e-12,
    );

    // The half angle is from the axis, the reference's from the surface.
    let approach = expected_at("cone", "delta");
    let call = format!("--half_angle 85 --contact_modulus \"1 GPa\" --to {approach:e} --points 2");
    let cone = Table::from_example("cone", &call);
    close(cone.column("force")[1], expected_at("cone", "F"), 1e-11);
    close(cone.column("contact_radius")[1], 1e-6, 1e-11);

    let punch = Table::from_example(
        "flat-punch",
        "--radius \"2 um\" --contact_modulus \"1 GPa\" --to \"3 nm\" --points 2",
    );
    close(punch.column("force")[1], 2.0 * 1e9 * 2e-6 * 3e-9, 1e-14);
}

/// R = 1, E* = 1, range = 1 and the work of adhesion that makes the Tabor parameter 0.2, so that
/// the table is in the units of the reference; its force unit is `2 pi w R`.
fn reduced_sphere() -> (String, f64) {
    let work = 0.2_f64.powf(1.5);
    let call = format!("--radius 1 --contact_modulus 1 --work_of_adhesion {work:e}");
    (call, 2.0 * PI * work)
}

fn stiff_spheres_have_the_reference_values() {
    let (call, unit) = reduced_sphere();
    for (index, approach) in [0.5, 1.0, 2.0].into_iter().enumerate() {
        for (model, name) in [
            ("derjaguin", "derjaguin"),
            ("dmt-t", "dmtt_cubic"),
            ("idmt-t", "idmtt"),
            ("dmt-m", "dmtm"),
            ("dmt-f", "dmtf"),
        ] {
            let range = if ["derjaguin", "dmt-m"].contains(&model) {
                ""
            } else {
                "--range 1"
            };
            let table =
                Table::from_example(model, &format!("{call} {range} --to {approach} --points 2"));
            let key = format!("fig2_models#{}", index + 1);
            close(
                table.column("force")[1] / unit,
                expected_at(&key, name),
                1e-8,
            );
        }
    }
    // The attraction keeps its digits where the load is 1e18 times as large: by quadrature (SciPy), and constants.
    for (model, range, expected) in [
        ("derjaguin", "", 0.5),
        ("dmt-m", "", 1.0),
        ("dmt-t", "--range 1", 0.500_000_002_379_01),
        ("idmt-t", "--range 1", 0.500_000_002_933_18),
        ("dmt-f", "--range 1", 7_433.756_074_757_6),
    ] {
        let table = Table::from_example(model, &format!("{call} {range} --to 1e12 --points 2"));
        close(table.column("attraction")[1] / unit, expected, 1e-9);
    }
    let rigid = "--radius 1 --work_of_adhesion 1 --range 1 --from -0.5 --points 2";
    let bradley = Table::from_example("bradley", rigid).column("force");
    close(bradley[0], -2.0 * PI * expected("bradley_lj#2"), 1e-12);
    close(bradley[1], -2.0 * PI * expected("bradley_lj#1"), 1e-12);
    // Past its limit the force method says so.
    let soft = Table::from_example(
        "dmt-f",
        "--radius 1 --contact_modulus 1 --work_of_adhesion 1 --range 1",
    );
    assert!(
        soft.comments
            .iter()
            .any(|line| line.contains("the model holds up to"))
    );
}

fn jkr_lets_go_where_it_should() {
    let call = "--radius \"1 mm\" --contact_modulus \"1 MPa\" --work_of_adhesion \"50 mJ/m^2\"";
    let unit = PI * 0.05 * 1e-3;
    let table = Table::from_example("jkr", &format!("{call} --points 2001"));
    close(table.note("pull_off_force"), -1.5 * unit, 1e-13);
    let least = table.column("force").into_iter().fold(0.0, f64::min);
    // The minimum is flat: a row beside it is 1e-6 away.
    close(least, -1.5 * unit, 1e-5);
    // The first row is the grip limit.
    let scale = expected_at("maugis_scales", "delta_star");
    close(
        table.column("approach")[0],
        scale * expected_at("jkr_special", "d_grip"),
        1e-12,
    );
    close(
        table.column("force")[0],
        unit * expected_at("jkr_special", "F_grip"),
        1e-12,
    );

    let at = expected_at("jkr_SI#1", "delta");
    let held = Table::from_example(
        "jkr",
        &format!("{call} --from=-1e-6 --to {at:e} --points 2"),
    );
    close(held.column("force")[1], 2e-4, 1e-11);
    close(
        held.column("contact_radius")[1],
        expected_at("jkr_SI#1", "a"),
        1e-11,
    );
    // Coming together nothing is felt before touch.
    let together = Table::from_example(
        "jkr",
        &format!("{call} --direction together --from -1e-6 --to 0 --points 2"),
    );
    assert_eq!(together.words("state"), ["separated", "contact"]);
    close(together.column("force")[1], -4.0 / 3.0 * unit, 1e-12);
    // The seventh of these twelve rows is at 0, and not at -5e-23.
    let rows = "--direction together --from \"-0.6 um\" --to \"0.5 um\" --points 12";
    let rows = Table::from_example("jkr", &format!("{call} {rows}"));
    assert_eq!(
        (rows.column("approach")[6], rows.words("state")[6]),
        (0.0, "contact")
    );
}

fn maugis_dugdale_has_the_reference_pull_off() {
    // With R = K = 1 and pi w = 1 the Maugis units are 1, and lambda is twice the tension.
    let work = 1.0 / PI;
    for (index, lambda) in [0.1, 0.3, 0.5, 2.0, 3.0].into_iter().enumerate() {
        let call = format!(
            "--radius 1 --contact_modulus 0.75 --work_of_adhesion {work:e} --peak_tension {:e} --points 1001",
            0.5 * lambda
        );
        let table = Table::from_example("maugis-dugdale", &call);
        let key = format!("md_pulloff#{}", index + 1);
        close(table.note("maugis_parameter"), lambda, 1e-12);
        close(
            table.note("pull_off_force"),
            expected_at(&key, "F_bar"),
            1e-9,
        );
        let least = table.column("force").into_iter().fold(0.0, f64::min);
        close(least, expected_at(&key, "F_bar"), 1e-3);
        // Together, the first contact comes later than the last one going apart.
        let together =
            Table::from_example("maugis-dugdale", &format!("{call} --direction together"));
        let touches = |table: &Table| {
            table
                .words("state")
                .iter()
                .filter(|w| **w == "contact")
                .count()
        };
        assert!(touches(&together) <= touches(&table), "{lambda}");
    }
    // Below the fold a held sphere comes off an open disc; above it off a contact.
    let first = |tension: f64| {
        let call = format!(
            "--radius 1 --contact_modulus 0.75 --work_of_adhesion {work:e} --peak_tension {tension:e}"
        );
        let table = Table::from_example("maugis-dugdale", &call);
        (
            table.words("state")[0].to_owned(),
            table.column("approach")[0],
            table.column("force")[0],
        )
    };
    let (state, approach, force) = first(0.25);
    assert_eq!(state, "attracted");
    // jo_delta_bar and jo_F_over_2piwR of tests/reference/md_special_points.csv.
    close(approach, -1.36330281908, 1e-9);
    close(force, -2.0 * 0.0707355302631, 1e-8);
    let (state, approach, force) = first(1.0);
    assert_eq!(state, "contact");
    close(approach, -0.938636589498, 1e-9);
    close(force, -2.0 * 0.420082974643, 1e-5);
}

fn lennard_jones_spheres_have_the_reference_values() {
    let (call, unit) = reduced_sphere();
    let table = Table::from_example(
        "lennard-jones-sphere",
        &format!("{call} --range 1 --from -1 --to 1 --points 3"),
    );
    close(
        table.column("force")[0] / unit,
        expected("fig2_numeric_lj#2"),
        2e-5,
    );
    close(
        table.column("force")[2] / unit,
        expected("fig2_numeric_lj#1"),
        2e-5,
    );
    assert_eq!(table.words("state")[0], "attracted");
    assert_eq!(table.words("state")[2], "contact");
    // A Tabor parameter of 2: between the folds the way there decides.
    let work = 2.0_f64.powf(1.5);
    let call = format!(
        "--radius 1 --contact_modulus 1 --work_of_adhesion {work:e} --range 1 --from -3 --to -1.6580750978 --points 2"
    );
    let apart = Table::from_example("lennard-jones-sphere", &call);
    let together = Table::from_example(
        "lennard-jones-sphere",
        &format!("{call} --direction together"),
    );
    // pull_F_over_2piwR of tests/reference/lj_special_points.csv.
    close(
        apart.note("pull_off_force") / (2.0 * PI * work),
        -0.791797651507,
        1e-6,
    );
    close(
        apart.column("force")[1] / (2.0 * PI * work),
        -0.791797651507,
        1e-6,
    );
    assert!(apart.column("force")[0] < 2.0 * together.column("force")[0]);
}

fn the_map_of_theories_has_the_reference_values() {
    let at = |modulus: &str| {
        let call = format!(
            "--radius \"10 um\" --work_of_adhesion \"50 mJ/m^2\" --range \"0.3 nm\" --contact_modulus \"{modulus}\""
        );
        Table::from_example("tabor-map", &call)
    };
    let stiff = at("100 GPa");
    assert_eq!(stiff.words("law")[0], "lennard-jones");
    close(
        stiff.column("tabor_parameter")[0],
        expected("tabor_mu#1"),
        1e-12,
    );
    assert!(stiff.words("advice")[0].starts_with("between"));
    let soft = at("1 MPa");
    close(
        soft.column("tabor_parameter")[0],
        expected("tabor_mu#2"),
        1e-12,
    );
    assert_eq!(soft.words("advice")[0], "JKR: jkr");
    close(
        soft.column("pull_off_force")[0],
        -1.5 * PI * 0.05 * 1e-5,
        1e-6,
    );
    let lambda = Table::from_example(
        "tabor-map",
        "--radius \"1 um\" --work_of_adhesion \"50 mJ/m^2\" --range \"1 nm\" --contact_modulus \"1 GPa\"",
    );
    close(
        lambda.column("maugis_parameter")[3],
        expected("maugis_lambda"),
        1e-12,
    );
}

/// Probabilities where the numbers lie within what was trained on: JKR for a soft sphere, none of them for a rough one.
/// Beyond, none of these and no probabilities.
fn advice_follows_tabor_number_and_roughness() {
    let at = |modulus: &str, rms: &str| {
        let call = format!(
            "--radius \"1 um\" --work_of_adhesion \"50 mJ/m^2\" --range \"1 nm\" --contact_modulus \"{modulus}\" --rms_height \"{rms}\""
        );
        let table = Table::from_example("advise", &call);
        let advice = table.comments.iter().find(|line| line.contains("advice: "));
        (advice.expect("advice").clone(), table)
    };
    let (soft, table) = at("0.4 GPa", "0");
    assert!(soft.starts_with("# advice: JKR, with "), "{soft}");
    assert_eq!(
        table.words("model"),
        ["hertz", "dmt", "jkr", "maugis-dugdale", "none"]
    );
    close(table.column("probability").iter().sum(), 1.0, 1e-12);
    // (R w^2/(E*^2 range^3))^(1/3).
    close(
        table.note("tabor_parameter"),
        (1e-6 * 0.05_f64.powi(2) / (0.16e18 * 1e-27)).cbrt(),
        1e-12,
    );
    let (rough, _) = at("0.4 GPa", "1.5 nm");
    assert!(
        rough.starts_with("# advice: none of these, with "),
        "{rough}"
    );
    let (beyond, table) = at("1 kPa", "0");
    assert!(
        beyond.starts_with("# advice: none of these: ") && beyond.contains("Tabor number is "),
        "{beyond}"
    );
    assert!(
        table
            .words("probability")
            .iter()
            .all(|cell| cell.is_empty())
    );
}

fn waves_have_the_reference_values() {
    // p* is pi E* amplitude/wavelength, here 1.
    let modulus = 1.0 / PI;
    let pressure = expected_at("westergaard#1", "pbar_over_pstar");
    let wave = format!("--amplitude 1 --wavelength 1 --contact_modulus {modulus:e}");
    let table = Table::from_example(
        "westergaard",
        &format!("{wave} --to {pressure:e} --points 2"),
    );
    close(table.column("contact_area_fraction")[1], 0.2, 1e-12);
    close(
        table.column("peak_pressure")[1],
        expected_at("westergaard#1", "p_centre_over_pstar"),
        1e-12,
    );
    // alpha = 0.2 = sqrt(2 w/(pi^2 E*)).
    let work = 0.04 * PI * PI * modulus / 2.0;
    let call = format!("{wave} --work_of_adhesion {work:e} --from 0.2 --to 0.6 --points 2");
    let table = Table::from_example("wavy-adhesive", &call);
    close(
        table.column("mean_pressure")[0],
        expected("wavy_adhesive#1"),
        1e-10,
    );
    close(
        table.column("mean_pressure")[1],
        expected("wavy_adhesive#2"),
        1e-10,
    );
    let extreme = |name| expected_at("wavy_adhesive_extrema", name);
    close(-table.note("pull_off_pressure"), extreme("pull_off"), 1e-8);
    close(table.note("closing_pressure"), extreme("jump_full"), 1e-8);
}

/// Of Hertz a^2 is R times the approach: at four radii it is two of them, and at a quarter half of one.
fn a_contact_wider_than_its_sphere_is_warned_of() {
    let warning = |call: &str| {
        let table = Table::from_example("hertz", call);
        let mut comments = table.comments.into_iter();
        comments.find(|line| line.contains("warning"))
    };
    let wide = warning("--radius \"1 um\" --contact_modulus \"1 GPa\" --to \"4 um\" --points 3");
    assert!(wide.is_some_and(|line| line.contains("grows to 2.00 radii")));
    let small = warning("--radius \"1 um\" --contact_modulus \"1 GPa\" --to \"250 nm\" --points 3");
    assert_eq!(small, None);
}

fn summits_have_the_reference_values() {
    let call = "--radius \"10 um\" --density \"1 1/um^2\" --rms_height \"1 nm\" --contact_modulus \"100 GPa\" --from \"1 nm\" --points 2";
    let table = Table::from_example("gw", call);
    close(
        table.column("mean_pressure")[0],
        expected_at("gw", "p"),
        1e-10,
    );
    close(
        table.column("contact_area_fraction")[0],
        expected_at("gw", "area_fraction"),
        1e-10,
    );

    // pi n R sigma F_1(0) is 0.0125 here, and with a hundred times the summits 1.25.
    let warns = |density: &str| {
        let call = format!(
            "--radius \"10 um\" --density \"{density}\" --rms_height \"1 nm\" --contact_modulus \"100 GPa\" --points 2"
        );
        let table = Table::from_example("gw", &call);
        let warning = |line: &String| line.contains("contact_area_fraction exceeds 1");
        (
            table.column("contact_area_fraction")[0],
            table.comments.iter().any(warning),
        )
    };
    let (few, many) = (warns("1 1/um^2"), warns("100 1/um^2"));
    close(many.0, 100.0 * few.0, 1e-12);
    assert!(many.0 > 1.0 && many.1 && !few.1);

    // One summit per area, with R, sigma and E* of 1: theta is 1/w.
    let at = |theta: f64| {
        let work = 1.0 / theta;
        format!(
            "--radius 1 --density 1 --rms_height 1 --contact_modulus 1 --work_of_adhesion {work:e} --from 1 --points 2"
        )
    };
    for (index, theta) in [1.0, 5.0, 10.0, 20.0].into_iter().enumerate() {
        let table = Table::from_example("gw-m", &at(theta));
        let pull_off = expected(&format!("gwm_pulloff#{}", index + 1));
        close(
            table.note("pull_off_pressure"),
            -pull_off * 2.0 * PI / theta,
            1e-8,
        );
    }
    let unit = PI / 2.0;
    let apart = Table::from_example("fuller-tabor", &at(2.0));
    let together =
        Table::from_example("fuller-tabor", &format!("{} --direction together", at(2.0)));
    close(
        apart.column("mean_pressure")[0] / unit,
        expected_at("fuller_tabor_force", "unload"),
        1e-7,
    );
    close(
        together.column("mean_pressure")[0] / unit,
        expected_at("fuller_tabor_force", "load"),
        1e-7,
    );
    close(
        apart.note("pull_off_pressure") / (-1.5 * unit),
        expected("fuller_tabor_pulloff#2"),
        1e-6,
    );
}

fn spectra_have_the_reference_values() {
    // H = 0.8, N = 32 of the study, by wavelengths.
    let [longest, rolloff, shortest] = [2.5e5, 1e6, 32e6].map(|q: f64| 2.0 * PI / q);
    let modulus = 1.33e12;
    let surface = format!(
        "--hurst 0.8 --longest {longest:e} --rolloff {rolloff:e} --shortest {shortest:e} --contact_modulus {modulus:e}"
    );
    let hard = Table::from_example(
        "persson",
        &format!("{surface} --rms_height \"0.52 nm\" --points 2"),
    );
    let unit = modulus * hard.note("rms_slope");
    let pressure = 0.02 * unit;
    let rows = format!("--from {pressure:e} --to {:e} --points 2", 50.0 * pressure);
    let loaded = Table::from_example(
        "persson",
        &format!("{surface} --rms_height \"0.52 nm\" {rows}"),
    );
    let state = |name| expected_at("study_persson_point", name);
    close(loaded.column("contact_area_fraction")[0], state("A"), 1e-7);
    close(
        loaded.column("contact_area_fraction")[1],
        expected_at("persson_area#4", "A_corrected"),
        1e-7,
    );
    close(
        loaded.column("mean_gap")[0],
        0.52e-9 * state("ubar_over_h"),
        1e-6,
    );
    assert_eq!(loaded.column("adhesive_pressure"), [0.0, 0.0]);
    assert_eq!(
        loaded.column("mean_pressure"),
        loaded.column("repulsive_pressure")
    );
    let adhesive = Table::from_example(
        "persson",
        &format!(
            "{surface} --rms_height \"0.52 nm\" --work_of_adhesion 0.2 --range \"1 nm\" {rows}"
        ),
    );
    close(
        adhesive.column("adhesive_pressure")[0],
        unit * state("p_ad_over_Ehp"),
        2e-3,
    );
    // The pull-off of the study in E* h'_rms, by a sum over magnifications: 0.3 %.
    close(adhesive.note("pull_off_pressure"), -0.037247 * unit, 3e-3);
    // The same surface by its slope.
    let slope = hard.note("rms_slope");
    let sloped = Table::from_example(
        "persson",
        &format!("{surface} --rms_slope {slope:e} --points 2"),
    );
    close(sloped.note("rms_height"), 0.52e-9, 1e-12);

    // h/h0 = 0.52 and q0 h E*/sigma0 = 3.458 with sigma0 = 1.
    let modulus = 3.458 / (2.0 * PI * 0.52);
    let bam = Table::from_example(
        "bam",
        &format!(
            "--rms_height 0.52 --rolloff 1 --contact_modulus {modulus:e} --work_of_adhesion 1 --range 1"
        ),
    );
    close(
        bam.note("pull_off_pressure"),
        -expected("bam_pulloff"),
        1e-8,
    );

    let sticks = Table::from_example(
        "pastewka-robbins",
        "--rms_slope 0.00115155 --rms_curvature \"8967.86 1/m\" --contact_modulus \"1.33 TPa\" --work_of_adhesion \"0.2 J/m^2\" --from \"0.5 nm\" --to \"1 nm\" --points 2",
    );
    close(
        sticks.column("stickiness_ratio")[1],
        expected("pr_ratio"),
        1e-9,
    );
    assert_eq!(sticks.words("sticky"), ["yes", "no"]);
}

/// A rough and stiff surface that does not stick has a table as well: its pull-off is 0, or "none".
fn surfaces_without_pull_off_have_their_tables() {
    let rough = "--radius \"10 um\" --density \"0.01 1/um^2\" --rms_height \"1 um\" --contact_modulus \"100 GPa\" --points 3";
    let hard = Table::from_example("gw", rough).column("mean_pressure");
    for model in ["gw-m", "fuller-tabor"] {
        let call = format!("{rough} --work_of_adhesion \"50 mJ/m^2\"");
        let table = Table::from_example(model, &call);
        assert_eq!(table.note("pull_off_pressure"), 0.0, "{model}");
        close(table.column("mean_pressure")[0], hard[0], 1e-3);
    }
    let bam = Table::from_example(
        "bam",
        "--rms_height \"100 nm\" --rolloff \"10 um\" --contact_modulus \"1 GPa\" --work_of_adhesion 0.05 --range \"1 nm\" --points 3",
    );
    let none = |line: &String| line.starts_with("# pull_off_pressure: none");
    assert!(bam.comments.iter().any(none), "{:?}", bam.comments);
    // (3/8) q0 h E* less the tension times the normal distribution from 0 to 0.01.
    close(bam.column("mean_pressure")[0], 23_362_477.1, 1e-8);
}

const SPHERE: &str = "--radius 1e-6 --contact_modulus 1e9";

fn bad_calls_say_what_is_wrong() {
    let maugis = format!("maugis-dugdale {SPHERE} --work_of_adhesion 0.05");
    let persson = "persson --hurst 0.8 --rolloff 1e-6 --shortest 1e-7 --contact_modulus 1e9";
    let cases: Vec<(String, &[&str])> = vec![
        ("jrk".into(), &["there is no model \"jrk\"; did you mean jkr?"]),
        ("maugis".into(), &["there is no model \"maugis\"; did you mean maugis-dugdale?"]),
        ("boussinesq".into(), &["there is no model \"boussinesq\"; tabor theory lists the models"]),
        ("--radius 1e-6 jkr".into(), &["\"--radius\" stands where a model's name is due"]),
        (format!("hertz {SPHERE} --too 1"), &["hertz has no parameter \"--too\"; did you mean --to?", "It takes --radius, --contact_modulus, --from, --to, --points"]),
        ("hertz --radius 1 --modulus 1e9".into(), &["hertz has no parameter \"--modulus\"; it takes --radius", "hertz needs --contact_modulus, E* of the pair, such as --contact_modulus \"1.5 GPa\""]),
        ("hertz".into(), &["hertz needs --radius", "hertz needs --contact_modulus"]),
        ("hertz --radius -1 --contact_modulus 0".into(), &["--radius \"-1\" is out of range: it must be more than zero", "--contact_modulus \"0\" is out of range"]),
        ("hertz --radius \"1 GPa\" --contact_modulus \"1 um\"".into(), &["--radius: \"GPa\" is a pressure in Pa; give a length in m", "--contact_modulus: \"um\" is a length in m"]),
        ("hertz --radius 1 um --contact_modulus 1e9".into(), &["\"um\" stands where a parameter is due", "a value with a space in it needs quotes"]),
        ("hertz --radius wide --contact_modulus 1e9".into(), &["\"wide\" does not begin with a number"]),
        ("hertz --radius inf --contact_modulus 1e9".into(), &["--radius \"inf\" is not finite"]),
        (format!("hertz {SPHERE} --points 1"), &["--points 1 is out of range: it must be a whole number between 2 and 100000"]),
        (format!("hertz {SPHERE} --points 2.5"), &["a whole number"]),
        (format!("hertz {SPHERE} --from 1e-9 --to 1e-9"), &["--from and --to are the same"]),
        (format!("hertz {SPHERE} --to 0"), &["--from and --to are the same"]),
        (format!("hertz {SPHERE} --from -1e-9"), &["--from \"-1e-9\" is out of range: it must be zero or more"]),
        (format!("hertz {SPHERE} --radius 2"), &["--radius is given twice"]),
        (format!("hertz {SPHERE} --to"), &["--to needs a value, such as \"25 um\""]),
        (format!("hertz {SPHERE} --to="), &["--to is empty; give a length in m"]),
        ("cone --half_angle 95 --contact_modulus 1".into(), &["--half_angle \"95\" is out of range: it must be between 0 and 90 deg", "cone needs --to"]),
        (format!("jkr {SPHERE} --work_of_adhesion 0"), &["--work_of_adhesion \"0\" is out of range"]),
        (format!("jkr {SPHERE} --work_of_adhesion 1 --direction appart"), &["--direction \"appart\" is not one of apart, together; did you mean apart?"]),
        (format!("dmt-f {SPHERE} --work_of_adhesion 1 --range 1e-9 --law dugdale"), &["--law \"dugdale\" is not one of"]),
        (maugis.clone(), &["maugis-dugdale needs --range or --peak_tension"]),
        (format!("{maugis} --range 1e-9 --peak_tension 1e6"), &["--range and --peak_tension are both given; give one of the two"]),
        ("lennard-jones-sphere --radius 1e-6 --contact_modulus 1e6 --work_of_adhesion 0.05 --range 1e-9".into(), &["tabor_parameter", "between 0.01 and 5"]),
        ("westergaard --amplitude 1e-8 --wavelength 1e-6 --contact_modulus 1e9 --to \"1 GPa\"".into(), &["--to 1 GPa is out of range: it must be between 0 Pa and 31.42 MPa here"]),
        (persson.into(), &["persson needs --rms_height or --rms_slope"]),
        (format!("{persson} --rms_slope 0.1 --range 1e-9"), &["--range needs --work_of_adhesion beside it"]),
        (format!("{persson} --rms_slope 0.1 --hurst 1.5"), &["--hurst is given twice", "--hurst \"1.5\" is out of range: it must be between 0 and 1"]),
        ("persson --hurst 0.8 --rolloff 1e-6 --shortest 2e-6 --longest 1e-7 --contact_modulus 1e9 --rms_slope 1".into(), &["--longest is shorter than --rolloff", "--shortest is not shorter than --rolloff"]),
        ("gw --radius 1e-6 --density \"1 um\" --rms_height 1e-9 --contact_modulus 1e9".into(), &["give a count per area in 1/m^2"]),
        ("gw --radius 1e-6 --density 1e12 --rms_height 1e-9 --contact_modulus 1e9 --from -1e-7".into(), &["--from -100 nm is out of range: it must be no less than -30 nm here"]),
    ];
    for (call, messages) in cases {
        let words = shell_words(&call);
        let arguments: Vec<&str> = words.iter().map(String::as_str).collect();
        let output = theory(&arguments);
        let errors = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{call}: {errors}");
        assert!(output.stdout.is_empty(), "{call}");
        for message in messages {
            assert!(
                errors.contains(message),
                "{call}: no {message:?} in\n{errors}"
            );
        }
        assert!(
            errors.lines().all(|line| line.starts_with("error: ")),
            "{errors}"
        );
        // One mistake, one line.
        assert!(
            errors.lines().count() <= messages.len(),
            "{call}:\n{errors}"
        );
    }
}

fn help_is_there_on_both_levels() {
    let general = theory(&["--help"]);
    assert!(general.status.success());
    assert!(text(&general.stdout).contains("tabor theory jkr --radius"));
    let of_model = theory(&["jkr", "--radius", "1e-6", "--help"]);
    assert!(of_model.status.success());
    assert!(text(&of_model.stdout).contains("--work_of_adhesion"));
}

fn a_closed_pipe_is_no_failure() {
    let sphere = ["theory", "hertz", "--radius", "1", "--contact_modulus", "1"];
    let mut child = command(Path::new("."), &sphere)
        // More than a pipe holds.
        .args(["--points", "100000"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the binary runs");
    drop(child.stdout.take());
    let mut errors = String::new();
    let mut stderr = child.stderr.take().expect("a pipe");
    stderr.read_to_string(&mut errors).expect("text");
    assert!(child.wait().expect("it ends").success(), "{errors}");
    assert!(errors.is_empty(), "{errors}");
}

tests![
    every_model_is_listed_and_its_example_tabulates,
    numbers_read_back_as_they_are,
    hard_contacts_have_the_reference_values,
    stiff_spheres_have_the_reference_values,
    jkr_lets_go_where_it_should,
    maugis_dugdale_has_the_reference_pull_off,
    lennard_jones_spheres_have_the_reference_values,
    the_map_of_theories_has_the_reference_values,
    advice_follows_tabor_number_and_roughness,
    waves_have_the_reference_values,
    a_contact_wider_than_its_sphere_is_warned_of,
    summits_have_the_reference_values,
    spectra_have_the_reference_values,
    surfaces_without_pull_off_have_their_tables,
    bad_calls_say_what_is_wrong,
    help_is_there_on_both_levels,
    a_closed_pipe_is_no_failure,
];
