//! The report as a browser shows it, the picture of the curves, and the progress on a terminal.
//!
//! The browser is Chromium; where there is none these tests are ignored, unless
//! `TABOR_REQUIRE_BROWSER=1` makes that a failure.

use std::fs;
use std::io::Read;
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::{Arc, Mutex};

use tabor::units::format_si;
use tempfile::TempDir;

use crate::shared::binary::{self, errors, status, tabor};
use crate::shared::run_folder::ROUGH;
use crate::shared::trials::{expect_ignored, ignore, tests};

/// A browser; without one the test that asks is ignored.
fn browser() -> &'static str {
    let found = ["chromium", "chromium-browser", "google-chrome"]
        .into_iter()
        .find(|name| {
            Command::new(name)
                .arg("--version")
                .stdout(Stdio::null())
                .stderr(Stdio::null())
                .status()
                .is_ok_and(|status| status.success())
        });
    found.unwrap_or_else(|| {
        let required = std::env::var("TABOR_REQUIRE_BROWSER").is_ok_and(|value| value == "1");
        assert!(
            !required,
            "TABOR_REQUIRE_BROWSER=1 and there is no chromium"
        );
        ignore("no chromium");
    })
}

/// What a script saw on the page, what the browser complained of, and whom it asked for something.
struct Seen {
    facts: serde_json::Value,
    console: String,
    requests: Vec<String>,
}

/// Where a browser calls by itself, whatever page it shows.
const BROWSERS_OWN: [&str; 3] = [".google.com", ".googleapis.com", ".gvt1.com"];

/// Opens `page` in a window of this width and asks the page about itself.
///
/// Only here a script runs on the page: a frame around it, the page itself unchanged in it, is
/// measured from outside. Every request that leaves the machine's files goes to a proxy, which notes
/// the host and answers none.
fn look(browser: &str, page: &Path, width: usize) -> Seen {
    let proxy = TcpListener::bind("127.0.0.1:0").expect("a port");
    let address = proxy.local_addr().expect("an address");
    let requests = Arc::new(Mutex::new(Vec::new()));
    let noted = Arc::clone(&requests);
    // It ends with the test.
    std::thread::spawn(move || {
        for mut stream in proxy.incoming().flatten() {
            let mut first = [0u8; 256];
            let length = stream.read(&mut first).unwrap_or(0);
            let text = String::from_utf8_lossy(&first[..length]).into_owned();
            // As in "GET http://host:80/path" or "CONNECT host:443".
            let target = text.split_whitespace().nth(1).unwrap_or_default();
            let target = target.split_once("://").map_or(target, |(_, rest)| rest);
            let host = target.split(['/', ':']).next().unwrap_or_default();
            if !BROWSERS_OWN.iter().any(|own| host.ends_with(own)) {
                noted.lock().expect("no panic holds it").push(text);
            }
        }
    });
    let place = tempfile::tempdir().expect("a temporary folder");
    // Measured in a frame, for a window has a least width of its own.
    let html = format!(
        r#"<!DOCTYPE html><html><head><meta charset="utf-8"></head><body style="margin:0">
<iframe id="page" src="file://{}" style="border:0;width:{width}px;height:2000px"></iframe>
<pre id="facts">not measured</pre>
<script>
addEventListener('load', () => setTimeout(() => {{
  const inside = document.getElementById('page').contentDocument;
  const root = inside.documentElement;
  const facts = {{
    images: [...inside.images].map(i => [i.complete, i.naturalWidth, i.naturalHeight, i.alt]),
    curves: [...inside.querySelectorAll('svg')].map(s => {{ const b = s.getBoundingClientRect();
      return [b.width, b.height, s.querySelectorAll('polyline').length, s.querySelectorAll('circle').length]; }}),
    width: root.clientWidth, needed: root.scrollWidth, height: root.scrollHeight,
    sticking_out: [...inside.querySelectorAll('svg text')].filter(t => {{
      const a = t.getBoundingClientRect(), b = t.ownerSVGElement.getBoundingClientRect();
      return a.left < b.left - 1 || a.right > b.right + 1; }}).map(t => t.textContent),
    title: inside.title, heading: inside.querySelector('h1').textContent,
    sections: [...inside.querySelectorAll('h2')].map(h => h.textContent),
    text: inside.body.innerText,
    outside: [...inside.querySelectorAll('[src],[href]')].map(e => e.src || e.href)
      .filter(u => !u.startsWith('data:')),
    scripts: inside.scripts.length,
    loaded: document.getElementById('page').contentWindow.performance.getEntriesByType('resource')
      .map(e => e.name).filter(u => !u.startsWith('data:')),
  }};
  document.getElementById('facts').textContent = JSON.stringify(facts);
}}, 100));
</script></body></html>"#,
        page.display()
    );
    let frame = place.path().join("frame.html");
    fs::write(&frame, html).expect("the frame is written");
    let output = Command::new(browser)
        .args(arguments(&place.path().join("profile"), width))
        .arg("--allow-file-access-from-files")
        .arg(format!("--proxy-server={address}"))
        .args([
            "--enable-logging=stderr",
            "--virtual-time-budget=5000",
            "--dump-dom",
        ])
        .arg(format!("file://{}", frame.display()))
        .output()
        .expect("the browser runs");
    let dom = String::from_utf8_lossy(&output.stdout);
    let console: String = String::from_utf8_lossy(&output.stderr)
        .lines()
        .filter(|line| line.contains("CONSOLE"))
        .map(|line| format!("{line}\n"))
        .collect();
    let start = dom.find("<pre id=\"facts\">").expect("the facts") + "<pre id=\"facts\">".len();
    let end = dom[start..].find("</pre>").expect("their end") + start;
    let text = dom[start..end]
        .replace("&lt;", "<")
        .replace("&gt;", ">")
        .replace("&amp;", "&");
    let facts =
        serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text}\n{console}"));
    Seen {
        facts,
        console,
        requests: requests.lock().expect("no panic holds it").clone(),
    }
}

/// Fails where the page complains, runs something, or asks anyone for anything.
fn expect_alone(seen: &Seen) {
    assert_eq!(seen.console, "", "the console is clean");
    assert_eq!(seen.requests, Vec::<String>::new());
    assert_eq!(seen.facts["loaded"], serde_json::json!([]));
    assert_eq!(seen.facts["outside"], serde_json::json!([]));
    assert_eq!(seen.facts["scripts"], 0);
}

fn arguments(profile: &Path, width: usize) -> Vec<String> {
    [
        "--headless",
        "--no-sandbox",
        "--disable-gpu",
        "--disable-quic",
        "--no-first-run",
        "--disable-background-networking",
        "--disable-component-update",
        "--disable-sync",
        "--hide-scrollbars",
    ]
    .map(str::to_owned)
    .into_iter()
    .chain([
        format!("--user-data-dir={}", profile.display()),
        format!("--window-size={},2000", width.max(500)),
    ])
    .collect()
}

/// A run of a scene; its folder.
fn run(text: &str, extra: &[&str], expected: i32) -> (TempDir, PathBuf) {
    let folder = binary::scene(text);
    let call = [&["run", "scene.toml", "--out", "out"], extra].concat();
    let output = tabor(folder.path(), &call);
    assert_eq!(status(&output), expected, "{}", errors(&output));
    let path = folder.path().join("out");
    (folder, path)
}

fn a_browser_shows_the_whole_page_on_any_width_without_a_network() {
    let browser = browser();
    let (_folder, out) = run(ROUGH, &[], 0);
    // 7 steps in contact, two pictures each; step 6 is separated.
    let pictures = fs::read_dir(out.join("images")).expect("pictures").count();
    assert_eq!(pictures, 14);
    for width in [400, 1200] {
        let seen = look(browser, &out.join("report.html"), width);
        let facts = &seen.facts;
        expect_alone(&seen);
        let images = facts["images"].as_array().expect("a list");
        assert_eq!(images.len(), pictures);
        for image in images {
            assert_eq!(image[0], true, "{image}");
            assert!(
                image[1].as_u64() > Some(64) && image[2].as_u64() > Some(64),
                "{image}"
            );
            assert!(
                image[3].as_str().is_some_and(|alt| alt.contains("step ")),
                "{image}"
            );
        }
        let curves = facts["curves"].as_array().expect("a list");
        assert_eq!(curves.len(), 3);
        for curve in curves {
            assert!(
                curve[0].as_f64() > Some(300.0) && curve[1].as_f64() > Some(200.0),
                "{curve}"
            );
            // Seven points that carry their load; two of the legend.
            assert_eq!(curve[3], 9, "{curve}");
        }
        assert_eq!(
            facts["sticking_out"],
            serde_json::json!([]),
            "texts of the curves have room"
        );
        assert_eq!(facts["width"], width);
        assert!(
            facts["needed"].as_u64() <= Some(width as u64),
            "the page is {} wide",
            facts["needed"]
        );
        // A title of the scene is text, whatever is in it.
        assert_eq!(facts["title"], "Rough & <small>");
        assert_eq!(facts["heading"], "Rough & <small>");
        let sections = [
            "Curves",
            "Snapshots",
            "Effects",
            "Scene",
            "Solution",
            "Steps",
        ];
        assert_eq!(facts["sections"], serde_json::json!(sections));
        let text = facts["text"].as_str().expect("text");
        for part in [
            "Finished: 8 steps",
            "step 6 is separated",
            "50 MPa",
            "2 µm × 1.5 µm",
            "Jumps out of contact",
        ] {
            assert!(text.contains(part), "{part} is missing in\n{text}");
        }
    }
}

fn runs_that_ended_early_and_runs_of_one_step_have_a_page() {
    let browser = browser();
    let failed = [
        "--set",
        "solver.max_iterations=2",
        "--set",
        "solver.tolerance=1e-9",
    ];
    let (_folder, out) = run(ROUGH, &failed, 3);
    let seen = look(browser, &out.join("report.html"), 400);
    expect_alone(&seen);
    let text = seen.facts["text"].as_str().expect("text").to_owned();
    assert!(text.contains("step 1 of 8 did not converge"), "{text}");
    // Nothing converged, so there is no curve, but the fields as they stood are shown.
    assert_eq!(seen.facts["curves"], serde_json::json!([]));
    assert_eq!(seen.facts["images"].as_array().map(Vec::len), Some(2));

    let one = ["--set", "loading.path=[1e6]", "--set", "output.steps=last"];
    let (_folder, out) = run(ROUGH, &one, 0);
    let seen = look(browser, &out.join("report.html"), 400);
    expect_alone(&seen);
    assert_eq!(seen.facts["curves"].as_array().map(Vec::len), Some(3));
    assert!(seen.facts["needed"].as_u64() <= Some(400));
}

fn a_page_that_asks_or_complains_would_be_seen() {
    let browser = browser();
    let place = tempfile::tempdir().expect("a temporary folder");
    let page = place.path().join("page.html");
    let html =
        "<h1>x</h1><img src=\"http://pictures.invalid/x.png\"><script>console.error('no')</script>";
    fs::write(&page, html).expect("it is written");
    let seen = look(browser, &page, 400);
    assert!(
        seen.requests.iter().any(|r| r.contains("pictures.invalid")),
        "{:?}",
        seen.requests
    );
    assert!(seen.console.contains("no"));
    assert_eq!(seen.facts["scripts"], 1);
    assert_eq!(seen.facts["outside"].as_array().map(Vec::len), Some(1));
    assert_eq!(seen.facts["images"][0][1], 0, "it has not loaded");
}

/// Share of the pixels of a picture that are darker than a grey.
fn darker(image: &image::GrayImage, than: u8) -> f64 {
    let dark = image.pixels().filter(|pixel| pixel.0[0] < than).count();
    dark as f64 / (image.width() * image.height()) as f64
}

fn a_screenshot_in_the_light_and_in_the_dark_is_as_asked() {
    let browser = browser();
    let (_folder, out) = run(ROUGH, &[], 0);
    for (scheme, dark) in [("1", false), ("0", true)] {
        let place = tempfile::tempdir().expect("a temporary folder");
        let shot = place.path().join("shot.png");
        let done = Command::new(browser)
            .args(arguments(&place.path().join("profile"), 900))
            .arg(format!("--blink-settings=preferredColorScheme={scheme}"))
            .arg(format!("--screenshot={}", shot.display()))
            .arg(format!("file://{}", out.join("report.html").display()))
            .output()
            .expect("the browser runs");
        assert!(shot.exists(), "{}", String::from_utf8_lossy(&done.stderr));
        let image = image::open(&shot).expect("a picture").to_luma8();
        let share = darker(&image, 64);
        // The pictures of fields are dark in part and on white in part, in either scheme.
        assert!(
            if dark { share > 0.4 } else { share < 0.3 },
            "{share} is dark"
        );
        // Something is drawn: neither all one grey.
        assert!(share > 0.005 && share < 0.99, "{share}");
    }
}

fn the_picture_of_the_curves_has_both_directions() {
    let (_folder, out) = run(ROUGH, &[], 0);
    let image = image::open(out.join("curve.png"))
        .expect("a picture")
        .to_rgb8();
    assert!(image.width() <= 2048 && image.height() <= 2048);
    let near = |wanted: [i32; 3]| {
        image
            .pixels()
            .filter(|pixel| (0..3).all(|c| (i32::from(pixel.0[c]) - wanted[c]).abs() < 24))
            .count()
    };
    // Dark blue for loading, orange for unloading, each for more than its legend (some 200 pixels).
    assert!(near([24, 66, 140]) > 1000 && near([216, 118, 24]) > 1000);
}

/// A terminal, made by `script` of util-linux.
#[cfg(target_os = "linux")]
fn a_terminal_shows_progress_and_the_table_at_the_end() {
    let there = Command::new("script").arg("--version").output();
    if !there.is_ok_and(|output| output.status.success()) {
        ignore("no script(1)");
    }
    let folder = binary::scene(&ROUGH.replace("[64, 48]", "[256, 192]"));
    let typed = |extra: &str| {
        let call = format!("{} run scene.toml --out out {extra}", binary::BINARY);
        let output = Command::new("script")
            .args(["-qec", &call, "/dev/null"])
            .env("TERM", "xterm")
            .current_dir(folder.path())
            .stdin(Stdio::null())
            .output()
            .expect("script runs");
        assert!(output.status.success());
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    let shown = typed("");
    for part in [
        "step 1/8",
        "iteration ",
        "residual ",
        "approach",
        "separated",
    ] {
        assert!(shown.contains(part), "{part} is missing in\n{shown}");
    }
    let quiet = typed("--quiet");
    assert!(
        !quiet.contains("step 1/8") && !quiet.contains("approach"),
        "{quiet}"
    );
    assert!(quiet.contains("step 6 is separated"), "warnings stay");
    // Not a terminal: no progress, but the table.
    let output = tabor(folder.path(), &["run", "scene.toml", "--out", "out"]);
    let said = errors(&output);
    assert!(
        !said.contains("step 1/8") && !said.contains('\u{1b}'),
        "{said}"
    );
    let table: Vec<&str> = said
        .lines()
        .skip_while(|line| !line.contains("approach"))
        .collect();
    // The heads, a row a step, and the result.
    assert_eq!(table.len(), 10, "{said}");
    assert!(
        table[6].contains("separated") && table[8].contains("contact"),
        "{said}"
    );
    assert!(output.stdout.is_empty());
}

/// A sphere that is pressed and taken off, with every effect that only adds columns.
const EFFECTS: &str = r#"
[grid]
points = 32
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
range = "500 nm"
[friction]
shear_strength = "10 kPa"
[wear]
specific_wear_rate = "1e-6 mm^3/(N m)"
[conductance]
conductivity = "59.6 MS/m"
counter_conductivity = "45 MS/m"
[loading]
control = "approach"
path = ["-1.6 um", "2 um", "-0.3 um", "-1.6 um"]
[output]
images = []
"#;

fn results_of_effects_have_a_card_a_curve_and_a_column() {
    let (_folder, out) = run(EFFECTS, &[], 0);
    let page = fs::read_to_string(out.join("report.html")).expect("a page");
    let rows = binary::table(&out.join("curve.csv"));
    for (name, column, unit) in [
        ("attractive force", "attractive_force", "N"),
        ("friction force", "friction_force", "N"),
        ("conductance", "conductance", "S"),
        ("resistance", "resistance", "ohm"),
        ("wear rate", "wear_rate", "m^3/m"),
    ] {
        let mut card = name.to_owned();
        card[..1].make_ascii_uppercase();
        let value = format_si(binary::number(&rows[1], column).expect("a value"), unit);
        // The attraction at zero load has a card of its own.
        let end = match column {
            "attractive_force" => "<",
            _ => "; ",
        };
        for part in [
            format!("<dt>{card}</dt><dd>{value}<small>at the largest contact, step 2{end}"),
            format!("{name} against force"),
            format!(">{name}</th>"),
            format!("<td class=\"number\">{value}</td>"),
        ] {
            assert!(page.contains(&part), "{part} is missing in {page}");
        }
    }
    // The resistance is the inverse of the conductance; a row without contact has no value.
    let [conductance, resistance] =
        ["conductance", "resistance"].map(|name| binary::number(&rows[1], name).expect("a number"));
    assert!((conductance * resistance - 1.0).abs() < 1e-12);
    assert_eq!(binary::number(&rows[0], "resistance"), None);
    // The work of the loop ends at what it loses.
    let summary = binary::summary(&out);
    let [lost, uncertainty] = ["hysteresis_energy", "hysteresis_uncertainty"]
        .map(|name| summary[name].as_f64().expect("a loop"));
    let at_most = format_si(lost + uncertainty, "J");
    let lost = format_si(lost, "J");
    for part in [
        "work done against approach",
        &format!("<dt>Hysteresis</dt><dd>at most {at_most}<"),
        &format!("<td class=\"number\">{lost}</td><td>separated"),
    ] {
        assert!(page.contains(part), "{part} is missing in {page}");
    }
    // What still touches without load, and with what force it attracts: on the straight line between steps 2 and 3,
    // where the force changes its sign.
    assert!(page.contains("<dt>Left at zero load</dt>"), "{page}");
    let [force, attraction] = ["force", "attractive_force"]
        .map(|name| [1, 2].map(|row: usize| binary::number(&rows[row], name).expect("a number")));
    let share = force[0] / (force[0] - force[1]);
    let left = attraction[0] + (attraction[1] - attraction[0]) * share;
    let card = format!(
        "<dt>Attraction left at zero load</dt><dd>{}<",
        format_si(left, "N")
    );
    assert!(page.contains(&card), "{card} is missing in {page}");
    // It is no less than the net tension, and nothing once the surfaces are apart.
    assert!(attraction[1] >= -force[1] && force[1] < 0.0);
    assert_eq!(binary::number(&rows[3], "attractive_force"), Some(0.0));
    // Effects that are off are not there.
    assert!(page.contains("<th scope=\"row\">wear</th>"));
    for off in ["dmt treatment", "hardness", "viscoelasticity"] {
        assert!(
            !page.contains(&format!("<th scope=\"row\">{off}</th>")),
            "{off}"
        );
    }

    // 6 sigma0 dx/E*, with the tension of 100 kPa and pixels of 1.875 um, are 1.125 um, and twice the range is the most.
    let taper = "<th scope=\"row\">adhesion taper</th><td>auto, 1 µm<";
    assert!(page.contains(taper), "{page}");

    // Without adhesion nothing attracts, and nothing is said of it.
    let plain = EFFECTS
        .split("[adhesion]")
        .next()
        .expect("its beginning")
        .to_owned()
        + "[loading]\ncontrol = \"approach\"\npath = [\"2 um\", \"0 um\"]\n[output]\nimages = []\n";
    let (_folder, out) = run(&plain, &[], 0);
    let page = fs::read_to_string(out.join("report.html")).expect("a page");
    assert!(!page.contains("ttracti"), "{page}");
    assert!(!binary::table(&out.join("curve.csv"))[0].contains_key("attractive_force"));

    // Heat has no resistance in ohm, and a plastic solid has lost energy at the end.
    let thermal = EFFECTS
        .replace("59.6 MS/m", "400 W/(m K)")
        .replace("\"45 MS/m\"", "16")
        .replace("contact_modulus", "hardness = \"100 kPa\"\ncontact_modulus");
    let (_folder, out) = run(&thermal, &[], 0);
    let rows = binary::table(&out.join("curve.csv"));
    assert!(!rows[0].contains_key("resistance"));
    let page = fs::read_to_string(out.join("report.html")).expect("a page");
    let value = |row: usize, column: &str| binary::number(&rows[row], column).expect("a value");
    let heat = format_si(value(1, "conductance"), "W/K");
    let energy = format_si(value(3, "plastic_energy"), "J");
    for part in [
        format!("<dt>Conductance</dt><dd>{heat}<"),
        format!("<dt>Plastic energy</dt><dd>{energy}<small>lost up to step 4"),
    ] {
        assert!(page.contains(&part), "{part} is missing in {page}");
    }
    let mixed = EFFECTS.replace("45 MS/m", "16 W/(m K)");
    let folder = binary::scene(&mixed);
    let output = tabor(folder.path(), &["check", "scene.toml"]);
    assert_eq!(status(&output), 2);
    assert!(errors(&output).contains("give both conductivities in W/(m K), or both in S/m"));
    let named = EFFECTS.replace("[conductance]", "[conductance]\nkind = \"thermal\"");
    let folder = binary::scene(&named);
    let output = tabor(folder.path(), &["check", "scene.toml"]);
    assert_eq!(status(&output), 2);
    assert!(errors(&output).contains("and this one is in S/m; give kind = \"electrical\""));
}

/// A machine without programs has no browser.
fn a_test_without_a_browser_is_ignored_with_its_reason() {
    let test = "report_page::runs_that_ended_early_and_runs_of_one_step_have_a_page";
    expect_ignored(test, &[("PATH", "")], "no chromium");
}

tests![
    a_browser_shows_the_whole_page_on_any_width_without_a_network,
    runs_that_ended_early_and_runs_of_one_step_have_a_page,
    a_page_that_asks_or_complains_would_be_seen,
    a_screenshot_in_the_light_and_in_the_dark_is_as_asked,
    the_picture_of_the_curves_has_both_directions,
    results_of_effects_have_a_card_a_curve_and_a_column,
    #[cfg(target_os = "linux")]
    a_terminal_shows_progress_and_the_table_at_the_end,
    a_test_without_a_browser_is_ignored_with_its_reason,
];
