//! A contact that reaches the edge of a free grid is warned of where the surface goes on behind it, and only there.

use crate::shared::binary::{errors, scene, status, summary, tabor};
use crate::shared::trials::tests;

/// A sphere whose contact under the load is 3.9 um wide by Hertz, without what pulls.
const SPHERE: &str = r#"
grid = { points = 16, size = "3 um", boundary = "free" }
solid = { contact_modulus = "1 MPa" }
surface = [{ kind = "sphere", radius = "10 um" }]
adhesion = { law = "maugis-dugdale", work_of_adhesion = "10 mJ/m^2", range = "100 nm" }
loading = { control = "force", path = ["0.1 uN", "1 uN", "0.9 uN"] }
"#;
const CONTACT: &str = "the contact reaches the edge of the free grid";
const ATTRACTION: &str = "the attraction reaches the edge of the free grid";

/// What `check` and `run` say with these settings; the summary has the warnings of the run.
fn said(set: &[&str]) -> [String; 2] {
    let folder = scene(SPHERE);
    let set = set.iter().flat_map(|set| ["--set", set]);
    let set: Vec<&str> = ["scene.toml"].into_iter().chain(set).collect();
    let checked = tabor(folder.path(), &[&["check"], &set[..]].concat());
    let options = ["--out", "out", "--backend", "cpu", "--quiet"];
    let run = tabor(folder.path(), &[&["run"], &set[..], &options].concat());
    for output in [&checked, &run] {
        assert_eq!(status(output), 0, "{set:?}: {}", errors(output));
    }
    let (told, kept) = (errors(&run), summary(&folder.path().join("out")));
    for words in [CONTACT, ATTRACTION] {
        let warnings = kept["warnings"].to_string();
        assert_eq!(told.matches(words).count(), warnings.matches(words).count());
    }
    [errors(&checked), told]
}

fn a_sphere_that_outgrows_the_grid_is_warned_of_once() {
    let [checked, run] = said(&[]);
    // With DMT's attraction, 2 pi w R, as a load: a^3 = 3 R F/(4 E*).
    let force = 1e-6 + 2.0 * std::f64::consts::PI * 0.01 * 1e-5;
    let width = 2e6 * (0.75 * 1e-5 * force / 1e6_f64).cbrt();
    let expected = format!("will be at least {width:.3}");
    assert!(checked.contains(&expected), "{expected}: {checked}");
    assert!(checked.contains("larger grid.size"), "{checked}");
    assert_eq!(run.matches(CONTACT).count(), 1, "{run}");
    assert!(run.contains("step 1: the contact"), "{run}");
    // By approach: a^2 = R delta is 3.16 um wide.
    let [checked, run] = said(&["loading.control=approach", "loading.path=[2.5e-7]"]);
    assert!(checked.contains("will be at least 3.162"), "{checked}");
    assert!(run.contains("step 1: the contact"), "{run}");
}

/// The attraction of a stiff sphere reaches further than its contact: gaps at the edge, 112 nm, are within the range.
fn attraction_at_the_edge_is_named_as_such() {
    let [checked, run] = said(&[
        "solid.contact_modulus=1e9",
        "adhesion.range=1.5e-7",
        "loading.path=[1e-7, 2e-7]",
    ]);
    assert!(!checked.contains("free grid"), "{checked}");
    assert!(run.contains("step 1: the attraction"), "{run}");
    assert_eq!(run.matches(ATTRACTION).count(), 1, "{run}");
    assert!(!run.contains(CONTACT), "{run}");
}

/// A wide grid, a flat punch, a rough patch and a periodic cell.
fn what_is_meant_to_touch_at_its_edge_is_not_warned_of() {
    let rough = "surface=[{kind=\"self-affine\", hurst=0.8, rms_height=1e-8, longest=3e-6, rolloff=3e-6, shortest=1e-6, seed=1}]";
    let flat = "surface=[{kind=\"flat\"}]";
    let hard = "loading.path=[1e-4]";
    for set in [
        &["grid.size=8e-6"][..],
        &[flat],
        &[rough, hard],
        &["grid.boundary=periodic"],
    ] {
        for text in said(set) {
            assert!(!text.contains("free grid"), "{set:?}: {text}");
        }
    }
}

tests![
    a_sphere_that_outgrows_the_grid_is_warned_of_once,
    attraction_at_the_edge_is_named_as_such,
    what_is_meant_to_touch_at_its_edge_is_not_warned_of,
];
