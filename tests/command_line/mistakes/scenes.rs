//! Scenes from outside: what is refused, in which words and at which line, and what is read.

use std::path::{Path, PathBuf};

use proptest::prelude::*;
use tabor::scene::*;

use crate::shared::trials::tests;

/// A scene that is right, without blank lines so that lines are easy to count.
const GOOD: &str = r#"title = "good"
[grid]
points = 64
size = "1 um"
[solid]
contact_modulus = "1 GPa"
[[surface]]
kind = "sphere"
radius = "1 um"
[adhesion]
law = "maugis-dugdale"
work_of_adhesion = "50 mJ/m^2"
range = "1 nm"
[loading]
control = "pressure"
path = ["1 MPa", "2 MPa"]
[solver]
tolerance = 1e-6
[output]
images = []
"#;

/// `text` with one passage replaced, which must be there once.
fn edited(text: &str, from: &str, to: &str) -> String {
    assert_eq!(text.matches(from).count(), 1, "{from:?} is not there once");
    text.replace(from, to)
}

fn with_surface(part: &str) -> String {
    edited(GOOD, "kind = \"sphere\"\nradius = \"1 um\"", part)
}

fn with_loading(loading: &str) -> String {
    edited(
        GOOD,
        "control = \"pressure\"\npath = [\"1 MPa\", \"2 MPa\"]",
        loading,
    )
}

fn self_affine() -> String {
    with_surface(
        r#"kind = "self-affine"
hurst = 0.8
rms_height = "1 nm"
longest = "1 um"
rolloff = "500 nm"
shortest = "40 nm""#,
    )
}

/// A solid that flows.
fn soft() -> String {
    edited(
        GOOD,
        "contact_modulus = \"1 GPa\"",
        "contact_modulus = \"1 GPa\"\nhardness = \"10 MPa\"",
    )
}

fn cone() -> String {
    with_surface("kind = \"cone\"\nhalf_angle = \"70 deg\"")
}

fn wavy() -> String {
    with_surface("kind = \"wavy\"\namplitude = \"1 nm\"\nwavelength = \"1 um\"")
}

fn height_file() -> String {
    with_surface("kind = \"file\"\npath = \"h.npy\"")
}

fn ramps() -> String {
    with_loading(
        r#"control = "pressure"
start = "1 MPa"
[[loading.ramp]]
to = "2 MPa"
steps = 4"#,
    )
}

/// A solid that relaxes under a ramp that finds its steps by itself.
fn creeping() -> String {
    let relaxes = edited(
        &ramps(),
        "contact_modulus = \"1 GPa\"",
        "contact_modulus = \"1 GPa\"\n[[solid.relaxation]]\nmodulus = 1e9\ntime = 1",
    );
    edited(
        &edited(
            &relaxes,
            "start = \"1 MPa\"",
            "start = \"1 MPa\"\ntime_tolerance = 1e-3",
        ),
        "steps = 4",
        "duration = 1\nsteps = \"auto\"",
    )
}

fn spring() -> String {
    with_loading("control = \"approach\"\npath = [\"1 nm\"]\nspring = \"1 N/m\"")
}

fn young() -> String {
    edited(
        GOOD,
        "contact_modulus = \"1 GPa\"",
        "young_modulus = \"1 GPa\"\npoisson_ratio = 0.3",
    )
}

fn parse(text: &str) -> Result<Scene, SceneErrors> {
    parse_set(text, &[])
}

fn parse_set(text: &str, set: &[(&str, &str)]) -> Result<Scene, SceneErrors> {
    let set: Vec<(String, String)> = set
        .iter()
        .map(|(key, value)| (key.to_string(), value.to_string()))
        .collect();
    Scene::parse(text, "s.toml", Path::new("/scenes"), &set)
}

fn accepted(text: &str) -> Scene {
    parse(text).unwrap_or_else(|errors| panic!("{text}\n{errors}"))
}

/// The messages of a scene that must be refused.
fn refused(text: &str, set: &[(&str, &str)]) -> Vec<String> {
    match parse_set(text, set) {
        Ok(scene) => panic!("accepted with {set:?}:\n{text}\n{scene:#?}"),
        Err(errors) => errors.to_string().lines().map(str::to_string).collect(),
    }
}

/// A right scene and edits of it (from, to), each with the one message that must follow: how it
/// begins (file, line, key, what is wrong) and a part of what it says would be right.
pub struct Edits {
    base: String,
    cases: &'static [(&'static str, &'static str, &'static str, &'static str)],
}

/// Every table of this file.
fn tables() -> Vec<Edits> {
    let mut tables = Vec::new();
    mistakes_in_grid(&mut tables);
    mistakes_in_solid(&mut tables);
    mistakes_in_surface(&mut tables);
    mistakes_in_adhesion(&mut tables);
    mistakes_in_capillary(&mut tables);
    mistakes_in_loading(&mut tables);
    mistakes_in_solver_and_output(&mut tables);
    mistakes_in_the_scene_itself(&mut tables);
    tables
}

/// How many bad scenes there are.
pub fn count() -> usize {
    tables().iter().map(|edits| edits.cases.len()).sum()
}

/// Checks every edit and returns the mistakes that they reach.
pub fn reached() -> Vec<Mistake> {
    let mut reached = Vec::new();
    let mut unexpected = Vec::new();
    for Edits { base, cases } in tables() {
        accepted(&base);
        for (from, to, beginning, remedy) in cases {
            let text = edited(&base, from, to);
            let messages = refused(&text, &[]);
            assert_eq!(messages.len(), 1, "{to:?} gave {messages:#?}");
            if !messages[0].starts_with(beginning) || !messages[0].contains(remedy) {
                unexpected.push(format!(
                    "{to:?} gave\n  {}\nand not\n  {beginning} ... {remedy}",
                    messages[0]
                ));
            }
            let errors = parse(&text).expect_err("it was refused before");
            reached.extend(errors.0);
        }
    }
    assert!(unexpected.is_empty(), "{}", unexpected.join("\n"));
    reached
}

#[rustfmt::skip] // one case a line
fn mistakes_in_grid(tables: &mut Vec<Edits>) {
    tables.push(Edits { base: GOOD.to_string(), cases: &[
        ("points = 64\n", "", "s.toml:2: grid.points: missing", "add for example `points = 1024`"),
        ("size = \"1 um\"\n", "", "s.toml:2: grid.size: missing", r#"`size = "25 um"`"#),
        ("points = 64", "points = 0", "s.toml:3: grid.points: 0 is out of range", "a whole number from 1 to 262144"),
        ("points = 64", "points = 262145", "s.toml:3: grid.points: 262145 is out of range", "from 1 to 262144"),
        ("points = 64", "points = -4", "s.toml:3: grid.points: -4 is out of range", "from 1 to 262144"),
        ("points = 64", "points = 64.0", "s.toml:3: grid.points: the number 64.0 where a whole number is expected", "write for example `points = 1024`"),
        ("points = 64", r#"points = "many""#, r#"s.toml:3: grid.points: the text "many" where a whole number is expected"#, "`points = 1024`"),
        ("points = 64", "points = [64, 64, 64]", "s.toml:3: grid.points: a list of 3 where a list of two values, x and y is expected", "`points = 1024`"),
        ("points = 64", "points = [64,\n 0]", "s.toml:4: grid.points.1: 0 is out of range", "from 1 to 262144"),
        (r#"size = "1 um""#, "size = 0", "s.toml:4: grid.size: 0 is out of range", "must be finite and above 0"),
        (r#"size = "1 um""#, r#"size = "-1 um""#, r#"s.toml:4: grid.size: "-1 um" is out of range"#, "must be finite and above 0"),
        (r#"size = "1 um""#, "size = nan", "s.toml:4: grid.size: nan is out of range", "must be finite and above 0"),
        (r#"size = "1 um""#, "size = inf", "s.toml:4: grid.size: inf is out of range", "must be finite and above 0"),
        (r#"size = "1 um""#, "size = true", "s.toml:4: grid.size: the truth value true where a length in m is expected", r#"`size = "25 um"`"#),
        (r#"size = "1 um""#, "size = 1979-05-27", "s.toml:4: grid.size: the date 1979-05-27 where a length in m is expected", r#"`size = "25 um"`"#),
        (r#"size = "1 um""#, r#"size = "1""#, r#"s.toml:4: grid.size: "1" has no unit"#, r#"give a length in m, such as "25 um""#),
        (r#"size = "1 um""#, r#"size = "1 uN""#, r#"s.toml:4: grid.size: "uN" is a force in N"#, "give a length in m"),
        (r#"size = "1 um""#, r#"size = ["1 um", "1 mile"]"#, r#"s.toml:4: grid.size.1: "mile" is not a unit"#, "give a length in m"),
        (r#"size = "1 um""#, "size = \"1 um\"\nboundary = \"open\"", r#"s.toml:5: grid.boundary: "open" is not one of "periodic", "free""#, "\"free\""),
        (r#"size = "1 um""#, "size = \"1 um\"\nboundary = \"Free\"", r#"s.toml:5: grid.boundary: "Free" is not one of "periodic", "free""#, r#"did you mean "free"?"#),
        (r#"size = "1 um""#, r#"sise = "1 um""#, "s.toml:4: grid.sise: unknown key in [grid]", "did you mean `size`? It takes points, size, boundary"),
        (r#"size = "1 um""#, "size = \"1 um\"\nseed = 1", "s.toml:5: grid.seed: unknown key in [grid]", "a key of this name belongs in a self-affine [[surface]]"),
        ("[grid]\npoints = 64\nsize = \"1 um\"", "grid = 3", "s.toml:2: grid: the number 3 where a table is expected", "[grid]"),
        ("[grid]\npoints = 64\nsize = \"1 um\"\n", "", "s.toml: grid: missing", r#"[grid] with points = 1024 and size = "25 um""#),
    ]});
}

#[rustfmt::skip] // one case a line
fn mistakes_in_solid(tables: &mut Vec<Edits>) {
    tables.push(Edits { base: GOOD.to_string(), cases: &[
        ("[solid]\ncontact_modulus = \"1 GPa\"\n", "", "s.toml: solid: missing", r#"[solid] with contact_modulus = "1.33 TPa""#),
        ("contact_modulus = \"1 GPa\"\n", "", "s.toml:5: solid.contact_modulus: missing", r#"`contact_modulus = "1.33 TPa"`"#),
        (r#"contact_modulus = "1 GPa""#, "contact_modulus = 0.0", "s.toml:6: solid.contact_modulus: 0.0 is out of range", "finite and above 0"),
        (r#"contact_modulus = "1 GPa""#, "contact_modulus = \"1 GPa\"\ncounter_young_modulus = \"2 GPa\"", "s.toml:7: solid.counter_young_modulus: contact_modulus already includes", "give young_modulus with poisson_ratio instead"),
        (r#"contact_modulus = "1 GPa""#, "young_modulus = 1e9\npoisson_ratio = 0.51", "s.toml:7: solid.poisson_ratio: 0.51 is out of range", "above -1 and at most 0.5"),
        (r#"contact_modulus = "1 GPa""#, "young_modulus = 1e9\npoisson_ratio = -1", "s.toml:7: solid.poisson_ratio: -1 is out of range", "above -1 and at most 0.5"),
        (r#"contact_modulus = "1 GPa""#, "young_modulus = 1e9\npoisson_ratio = \"0.3\"", r#"s.toml:7: solid.poisson_ratio: the text "0.3" where a number without a unit is expected"#, "`poisson_ratio = 0.3`"),
        (r#"contact_modulus = "1 GPa""#, "young_modulus = 1e9\npoisson_ratio = 0.3\ncounter_young_modulus = 1e9", "s.toml:5: solid.counter_poisson_ratio: missing", "`counter_poisson_ratio = 0.3`"),
        (r#"contact_modulus = "1 GPa""#, "young_modulus = 1e9\npoisson_ratio = 0.3\ncounter_poisson_ratio = 0.3", "s.toml:5: solid.counter_young_modulus: missing", r#"`counter_young_modulus = "210 GPa"`"#),
        (r#"contact_modulus = "1 GPa""#, "contact_modulus = \"1 GPa\"\nthickness = \"5 um\"", "s.toml:5: solid.poisson_ratio: missing", "`poisson_ratio = 0.3`"),
        (r#"contact_modulus = "1 GPa""#, "contact_modulus = \"1 GPa\"\npoisson_ratio = 0.3\nbase = \"bonded\"", "s.toml:5: solid.thickness: missing", "`thickness = \"5 um\"`"),
        (r#"contact_modulus = "1 GPa""#, "contact_modulus = \"1 GPa\"\npoisson_ratio = 0.3\nthickness = 0", "s.toml:8: solid.thickness: 0 is out of range", "finite and above 0"),
        (r#"contact_modulus = "1 GPa""#, "contact_modulus = \"1 GPa\"\npoisson_ratio = 0.3\nthickness = 1\nbase = \"glued\"", "s.toml:9: solid.base", "\"frictionless\""),
        (r#"contact_modulus = "1 GPa""#, "young_modulus = 1e9\npoisson_ratio = 0.3\ncounter_young_modulus = 1e9\ncounter_poisson_ratio = 0.3\nthickness = 1", "s.toml:8: solid.counter_young_modulus: the counter-face of a layer is rigid", "leave the counter-face's elasticity out"),
        (r#"contact_modulus = "1 GPa""#, "contact_modulus = \"1 GPa\"\nhardness = 0", "s.toml:7: solid.hardness: 0 is out of range", "finite and above 0"),
        (r#"contact_modulus = "1 GPa""#, "contact_modulus = \"1 GPa\"\nhardness = \"2 MPa\"", "s.toml:7: solid.hardness: the path has a mean pressure of 2 MPa, which no contact of this hardness can carry", "stay below it"),
        (r#"contact_modulus = "1 GPa""#, "contact_modulus = \"1 GPa\"\n[[solid.relaxation]]\nmodulus = \"1 MPa\"\ntime = \"10 ms\"", "s.toml:19: loading.path: a viscoelastic solid needs durations", "duration = \"1 s\""),
        (r#"contact_modulus = "1 GPa""#, "contact_modulus = \"1 GPa\"\nrelaxation = []", "s.toml:7: solid.relaxation: is empty", "at least one branch"),
        (r#"contact_modulus = "1 GPa""#, "contact_modulus = \"1 GPa\"\nrelaxation = 3", "s.toml:7: solid.relaxation: the number 3 where an array of tables is expected", "[[solid.relaxation]]"),
        (r#"contact_modulus = "1 GPa""#, r#"contact_modulus = "1 GN""#, r#"s.toml:6: solid.contact_modulus: "GN" is a force in N"#, r#"give a pressure in Pa, such as "1.5 GPa""#),
        ("contact_modulus", "contact_modulous", "s.toml:6: solid.contact_modulous: unknown key in [solid]", "did you mean `contact_modulus`?"),
    ]});
    tables.push(Edits { base: soft(), cases: &[
        (r#"law = "maugis-dugdale""#, r#"law = "lennard-jones""#, "s.toml:7: solid.hardness: a hardness with the Lennard-Jones law is not in this version", "leave the hardness out"),
        (r#"range = "1 nm""#, "range = \"1 nm\"\ntreatment = \"dmt\"", "s.toml:7: solid.hardness: a hardness with treatment = \"dmt\" is not in this version", "take treatment = \"full\""),
        ("[solver]", "[solver]\nprecision = \"mixed\"", "s.toml:7: solid.hardness: a hardness in mixed precision is not in this version", "take precision = \"single\""),
        ("control = \"pressure\"\npath = [\"1 MPa\", \"2 MPa\"]", "control = \"mean-gap\"\npath = [\"1 nm\"]", "s.toml:7: solid.hardness: control = \"mean-gap\" does not determine the plastic depth", "take control = \"approach\""),
        ("control = \"pressure\"\npath = [\"1 MPa\", \"2 MPa\"]", "control = \"force\"\npath = [1e-3]", "s.toml:7: solid.hardness: the path has a mean pressure of 1 GPa", "stay below it"),
    ]});
    tables.push(Edits { base: young(), cases: &[
        (r#"young_modulus = "1 GPa""#, "contact_modulus = \"1 GPa\"\nyoung_modulus = \"2 GPa\"", "s.toml:7: solid.young_modulus: contact_modulus is given too", "give one of the two"),
        ("poisson_ratio = 0.3\n", "", "s.toml:5: solid.poisson_ratio: missing", "`poisson_ratio = 0.3`"),
        ("young_modulus = \"1 GPa\"\n", "", "s.toml:5: solid.young_modulus: missing", r#"or instead of it `contact_modulus = "80 GPa"`"#),
    ]});
}

#[rustfmt::skip] // one case a line
fn mistakes_in_surface(tables: &mut Vec<Edits>) {
    tables.push(Edits { base: height_file(), cases: &[
        ("[[surface]]\nkind = \"file\"\npath = \"h.npy\"\n", "", "s.toml: surface: missing", r#"[[surface]] with kind = "sphere""#),
        ("kind = \"file\"\npath = \"h.npy\"", "seed = 1", "s.toml:7: surface.0.kind: missing", r#"`kind = "sphere"`"#),
        ("kind = \"file\"\npath = \"h.npy\"", "kind = \"flat\"\nradius = 1", "s.toml:9: surface.0.radius: unknown key in a flat [[surface]]", "belongs in a sphere [[surface]]"),
        ("path = \"h.npy\"\n", "", "s.toml:7: surface.0.path: missing", r#"`path = "heights.npy"`"#),
        (r#"path = "h.npy""#, r#"path = """#, "s.toml:9: surface.0.path: is empty", "name a file, relative to the scene file"),
        (r#"path = "h.npy""#, "path = 7", "s.toml:9: surface.0.path: the number 7 where a text in quotes is expected", r#"`path = "heights.npy"`"#),
        (r#"path = "h.npy""#, "path = \"h.npy\"\nunit = \"nN\"", r#"s.toml:10: surface.0.unit: "nN" is a force in N"#, "give a length in m"),
        (r#"path = "h.npy""#, "path = \"h.npy\"\nunit = \"0 nm\"", r#"s.toml:10: surface.0.unit: "0 nm" is out of range"#, "finite and above 0"),
        (r#"path = "h.npy""#, "path = \"h.npy\"\nscale = 0", "s.toml:10: surface.0.scale: 0 is out of range", "finite and not 0"),
        (r#"path = "h.npy""#, "path = \"h.npy\"\ndetrend = \"linear\"", r#"s.toml:10: surface.0.detrend: "linear" is not one of "none", "mean", "plane", "quadratic", "lines""#, r#"did you mean "lines"?"#),
        (r#"path = "h.npy""#, "path = \"h.npy\"\nfill = \"interpolated\"", r#"s.toml:10: surface.0.fill: "interpolated" is not one of"#, r#"did you mean "interpolate"?"#),
        (r#"path = "h.npy""#, "path = \"h.npy\"\nblack = 0", "s.toml:10: surface.0.black: is given without white", "a grey image needs the heights of both"),
        (r#"path = "h.npy""#, "path = \"h.npy\"\nwhite = 1e-6", "s.toml:10: surface.0.white: is given without black", "a grey image needs the heights of both"),
        (r#"path = "h.npy""#, "path = \"h.npy\"\nblack = 0.0\nwhite = \"1 Pa\"", r#"s.toml:11: surface.0.white: "Pa" is a pressure in Pa"#, "give a length in m"),
    ]});
    tables.push(Edits { base: GOOD.to_string(), cases: &[
        ("[[surface]]", "[surface]", "s.toml:7: surface: a table where an array of tables is expected", "`[[surface]]`"),
        (r#"kind = "sphere""#, r#"kind = "spere""#, r#"s.toml:8: surface.0.kind: "spere" is not one of "self-affine", "sphere", "cone", "wavy", "flat", "file""#, r#"did you mean "sphere"?"#),
        ("radius = \"1 um\"\n", "", "s.toml:7: surface.0.radius: missing", r#"`radius = "1 um"`"#),
        (r#"radius = "1 um""#, r#"radius = "0 um""#, r#"s.toml:9: surface.0.radius: "0 um" is out of range"#, "finite and above 0"),
        (r#"radius = "1 um""#, "radius = \"1 um\"\ncentre = \"1 um\"", r#"s.toml:10: surface.0.centre: the text "1 um" where a list of two values, x and y is expected"#, r#"`centre = ["1 um", "1 um"]`"#),
        (r#"radius = "1 um""#, "radius = \"1 um\"\ncentre = [1e-6, nan]", "s.toml:10: surface.0.centre.1: nan is out of range", "must be finite"),
        (r#"radius = "1 um""#, "radius = \"1 um\"\nhurst = 0.5", "s.toml:10: surface.0.hurst: unknown key in a sphere [[surface]]", "a key of this name belongs in a self-affine [[surface]]"),
        (r#"radius = "1 um""#, "radius = \"1 um\"\n[[surface]]\nkind = \"sphere\"\nradius = \"1 Pa\"", r#"s.toml:12: surface.1.radius: "Pa" is a pressure in Pa"#, "give a length in m"),
    ]});
    tables.push(Edits { base: cone(), cases: &[
        ("half_angle = \"70 deg\"\n", "", "s.toml:7: surface.0.half_angle: missing", r#"`half_angle = "70 deg"`"#),
        (r#"half_angle = "70 deg""#, "half_angle = 90", "s.toml:9: surface.0.half_angle: 90 is out of range", "above 0 and below 90 degrees"),
        (r#"half_angle = "70 deg""#, "half_angle = 0", "s.toml:9: surface.0.half_angle: 0 is out of range", "above 0 and below 90 degrees"),
        (r#"half_angle = "70 deg""#, r#"half_angle = "1.6 rad""#, r#"s.toml:9: surface.0.half_angle: "1.6 rad" is out of range"#, "above 0 and below 90 degrees"),
        (r#"half_angle = "70 deg""#, r#"half_angle = "70""#, r#"s.toml:9: surface.0.half_angle: "70" has no unit"#, "give an angle in deg or rad"),
    ]});
    tables.push(Edits { base: wavy(), cases: &[
        ("amplitude = \"1 nm\"\n", "", "s.toml:7: surface.0.amplitude: missing", r#"`amplitude = "1 nm"`"#),
        (r#"amplitude = "1 nm""#, r#"amplitude = "-1 nm""#, r#"s.toml:9: surface.0.amplitude: "-1 nm" is out of range"#, "finite and above 0"),
        (r#"wavelength = "1 um""#, r#"wavelength = "300 nm""#, "s.toml:10: surface.0.wavelength: 300 nm along x does not divide the periodic size 1 µm", "the nearest that does is 333.3 nm"),
        (r#"wavelength = "1 um""#, r#"wavelength = ["inf", "2 um"]"#, "s.toml:10: surface.0.wavelength: 2 µm along y does not divide the periodic size 1 µm", "the nearest that does is 1 µm"),
        (r#"wavelength = "1 um""#, r#"wavelength = "inf""#, "s.toml:10: surface.0.wavelength: is infinite along both axes", r#"take kind = "flat""#),
        (r#"wavelength = "1 um""#, "wavelength = 0", "s.toml:10: surface.0.wavelength: 0 is out of range", r#"above 0, or "inf""#),
        (r#"wavelength = "1 um""#, r#"wavelength = "none""#, r#"s.toml:10: surface.0.wavelength: "none" does not begin with a number"#, "give a length in m"),
    ]});
    tables.push(Edits { base: self_affine(), cases: &[
        ("hurst = 0.8", "hurst = 1.2", "s.toml:9: surface.0.hurst: 1.2 is out of range", "above 0 and below 1"),
        ("hurst = 0.8", "hurst = 0", "s.toml:9: surface.0.hurst: 0 is out of range", "above 0 and below 1"),
        ("hurst = 0.8", "hurst = 1", "s.toml:9: surface.0.hurst: 1 is out of range", "above 0 and below 1"),
        ("hurst = 0.8", "hurts = 0.8", "s.toml:9: surface.0.hurts: unknown key in a self-affine [[surface]]", "did you mean `hurst`?"),
        ("rms_height = \"1 nm\"\n", "", "s.toml:7: surface.0.rms_height: missing", r#"`rms_height = "0.52 nm"` or `rms_slope = 0.1`"#),
        (r#"rms_height = "1 nm""#, "rms_height = \"1 nm\"\nrms_slope = 0.1", "s.toml:11: surface.0.rms_slope: rms_height is given too", "give one of the two"),
        (r#"rms_height = "1 nm""#, r#"rms_slope = "0.1""#, r#"s.toml:10: surface.0.rms_slope: the text "0.1" where a number without a unit is expected"#, "`rms_slope = 0.1`"),
        (r#"rolloff = "500 nm""#, r#"rolloff = "2 um""#, "s.toml:12: surface.0.rolloff: 2 µm is longer than longest = 1 µm", "shortest < rolloff <= longest"),
        (r#"shortest = "40 nm""#, r#"shortest = "500 nm""#, "s.toml:13: surface.0.shortest: 500 nm is not shorter than rolloff = 500 nm", "shortest < rolloff <= longest"),
        ("rolloff = \"500 nm\"\n", "", "s.toml:7: surface.0.rolloff: missing", r#"`rolloff = "6.25 um"`"#),
        (r#"shortest = "40 nm""#, "shortest = \"40 nm\"\nseed = -1", "s.toml:14: surface.0.seed: -1 is out of range", "a whole number of at least 0"),
        (r#"shortest = "40 nm""#, "shortest = \"40 nm\"\nseed = 1.5", "s.toml:14: surface.0.seed: the number 1.5 where a whole number is expected", "`seed = 1`"),
    ]});
}

#[rustfmt::skip] // one case a line
fn mistakes_in_adhesion(tables: &mut Vec<Edits>) {
    tables.push(Edits { base: GOOD.to_string(), cases: &[
        ("law = \"maugis-dugdale\"\n", "", "s.toml:10: adhesion.law: missing", r#"`law = "maugis-dugdale"`"#),
        (r#"law = "maugis-dugdale""#, r#"law = "lennard jones""#, r#"s.toml:11: adhesion.law: "lennard jones" is not one of "maugis-dugdale", "lennard-jones", "exponential""#, r#"did you mean "lennard-jones"?"#),
        ("range = \"1 nm\"\n", "", "s.toml:10: adhesion.range: missing", r#"`range = "1 nm"` or `peak_tension = "50 MPa"`"#),
        ("work_of_adhesion = \"50 mJ/m^2\"\n", "", "s.toml:10: adhesion.work_of_adhesion: missing", r#"`work_of_adhesion = "50 mJ/m^2"`"#),
        (r#"range = "1 nm""#, "range = \"1 nm\"\npeak_tension = \"50 MPa\"", "s.toml:14: adhesion.peak_tension: work_of_adhesion, range and peak_tension are all given", "give exactly two"),
        (r#"range = "1 nm""#, "range = \"auto\"\npeak_tension = \"50 MPa\"", r#"s.toml:14: adhesion.peak_tension: range = "auto" follows from the grid"#, "leave peak_tension out"),
        ("work_of_adhesion = \"50 mJ/m^2\"\nrange = \"1 nm\"", r#"range = "auto""#, "s.toml:10: adhesion.work_of_adhesion: missing", r#"`work_of_adhesion = "50 mJ/m^2"`"#),
        (r#"range = "1 nm""#, r#"range = "Auto""#, r#"s.toml:13: adhesion.range: "Auto" does not begin with a number"#, "give a length in m"),
        (r#"range = "1 nm""#, "range = 0", "s.toml:13: adhesion.range: 0 is out of range", "finite and above 0"),
        (r#"work_of_adhesion = "50 mJ/m^2""#, "work_of_adhesion = 0", "s.toml:12: adhesion.work_of_adhesion: 0 is out of range", "finite and above 0"),
        (r#"work_of_adhesion = "50 mJ/m^2""#, r#"work_of_adhesion = "50 mJ""#, r#"s.toml:12: adhesion.work_of_adhesion: "mJ" is an energy in J"#, "an energy per area in J/m^2 or N/m"),
        (r#"range = "1 nm""#, "range = \"1 nm\"\ntaper = \"-1 nm\"", r#"s.toml:14: adhesion.taper: "-1 nm" is out of range"#, "finite and at least 0"),
        (r#"range = "1 nm""#, "range = \"1 nm\"\ntaper = \"3 nm\"", "s.toml:14: adhesion.taper: 3 nm is more than twice the range of 1 nm", r#"or "auto""#),
        ("law = \"maugis-dugdale\"\nwork_of_adhesion = \"50 mJ/m^2\"\nrange = \"1 nm\"", "law = \"lennard-jones\"\nwork_of_adhesion = \"50 mJ/m^2\"\nrange = \"1 nm\"\ntaper = \"auto\"", r#"s.toml:14: adhesion.taper: law = "lennard-jones" has no taper"#, r#"take law = "maugis-dugdale""#),
        ("law = \"maugis-dugdale\"\nwork_of_adhesion = \"50 mJ/m^2\"\nrange = \"1 nm\"", "law = \"exponential\"\nwork_of_adhesion = \"50 mJ/m^2\"\nrange = \"1 nm\"\ntaper = 0", r#"s.toml:14: adhesion.taper: law = "exponential" has no taper"#, "leave it out"),
        (r#"range = "1 nm""#, "range = \"1 nm\"\ntreatment = \"jkr\"", r#"s.toml:14: adhesion.treatment: "jkr" is not one of "full", "dmt""#, "\"dmt\""),
        (r#"range = "1 nm""#, "range = \"1 nm\"\nrate = { exponent = 0.5 }", "s.toml:14: adhesion.rate.reference_speed: missing", "`reference_speed = \"1 um/s\"`"),
        (r#"range = "1 nm""#, "range = \"1 nm\"\nrate = { reference_speed = \"1 um\", exponent = 0.5 }", "s.toml:14: adhesion.rate.reference_speed: \"um\" is a length in m", "give a speed in m/s"),
        (r#"range = "1 nm""#, "range = \"1 nm\"\nrate = { reference_speed = 1e-6, exponent = 3 }", "s.toml:14: adhesion.rate.exponent: 3 is out of range", "an exponent from 0.05 to 2"),
        (r#"range = "1 nm""#, "range = \"1 nm\"\nrate = { reference_speed = 1e-6, exponent = 0.5 }", "s.toml:17: loading.path: rate-dependent adhesion needs durations", "duration = \"1 s\""),
        (r#"range = "1 nm""#, "range = \"1 nm\"\ntreatment = \"dmt\"\nrate = { reference_speed = 1e-6, exponent = 0.5 }", "s.toml:15: adhesion.rate: a rate with treatment = \"dmt\" is not in this version", "take treatment = \"full\""),
        ("law = \"maugis-dugdale\"", "law = \"lennard-jones\"\nrate = { reference_speed = 1e-6, exponent = 0.5 }", "s.toml:12: adhesion.rate: multiplies the tension of a receding edge", "take another law"),
        (r#"range = "1 nm""#, "range = \"1 nm\"\nmap = \"\"", "s.toml:14: adhesion.map: is empty", "name a file"),
        (r#"range = "1 nm""#, "range = \"1 nm\"\nmap = 3", "s.toml:14: adhesion.map: the number 3 where a text in quotes is expected", "`map = \"w.npy\"`"),
        (r#"range = "1 nm""#, "range = \"1 nm\"\nmap = { pattern = \"checker\", period = \"0.3 um\", low = 0, high = 1 }", "s.toml:14: adhesion.map.period: does not divide the size", "a whole fraction"),
        (r#"range = "1 nm""#, "range = \"1 nm\"\nmap = { pattern = \"checker\", period = \"1 um\", low = 0, high = 0 }", "s.toml:14: adhesion.map.high: is 0 like low", "a factor above 0"),
        (r#"range = "1 nm""#, "range = \"1 nm\"\nmap = { pattern = \"dots\", period = \"1 um\", low = 0, high = 1 }", "s.toml:14: adhesion.map.pattern: \"dots\" is not one of \"checker\", \"stripe\"", "\"stripe\""),
        (r#"range = "1 nm""#, "range = \"1 nm\"\nmap = { pattern = \"stripe\", period = \"1 um\", low = -1, high = 1 }", "s.toml:14: adhesion.map.low: -1 is out of range", "at least 0"),
        (r#"range = "1 nm""#, "range = \"1 nm\"\nmap = { pattern = \"stripe\", period = \"1 um\", low = 0.5 }", "s.toml:14: adhesion.map.high: missing", "`high = 1`"),
        (r#"range = "1 nm""#, "range = \"1 nm\"\nenabled = false", "s.toml:14: adhesion.enabled: unknown key in [adhesion]", "; it takes law, work_of_adhesion, range, peak_tension, taper, treatment"),
    ]});
}

#[rustfmt::skip] // one case a line
fn mistakes_in_loading(tables: &mut Vec<Edits>) {
    tables.push(Edits { base: GOOD.to_string(), cases: &[
        ("[loading]\ncontrol = \"pressure\"\npath = [\"1 MPa\", \"2 MPa\"]\n", "", "s.toml: loading: missing", r#"[loading] with control = "pressure""#),
        ("control = \"pressure\"\n", "", "s.toml:14: loading.control: missing", r#"`control = "pressure"`"#),
        (r#"control = "pressure""#, r#"control = "gap""#, r#"s.toml:15: loading.control: "gap" is not one of "pressure", "force", "approach", "mean-gap""#, "\"mean-gap\""),
        (r#"path = ["1 MPa", "2 MPa"]"#, "", "s.toml:14: loading.path: missing", "or `start` with `[[loading.ramp]]`"),
        (r#"path = ["1 MPa", "2 MPa"]"#, "path = []", "s.toml:16: loading.path: is empty", "give at least one value"),
        (r#"path = ["1 MPa", "2 MPa"]"#, r#"path = "1 MPa""#, r#"s.toml:16: loading.path: the text "1 MPa" where a list of values is expected"#, r#"`path = ["1 MPa", "10 MPa"]`"#),
        (r#"path = ["1 MPa", "2 MPa"]"#, "path = [\"1 MPa\",\n  \"2 nN\"]", r#"s.toml:17: loading.path.1: "nN" is a force in N"#, "give a pressure in Pa"),
        (r#"path = ["1 MPa", "2 MPa"]"#, "path = [1e6, inf]", "s.toml:16: loading.path.1: inf is out of range", "must be finite"),
        (r#"path = ["1 MPa", "2 MPa"]"#, "path = [1e6, [2e6]]", "s.toml:16: loading.path.1: a list of 1 where a pressure in Pa is expected", r#"`path = ["1 MPa", "10 MPa"]`"#),
        ("control = \"pressure\"\npath = [\"1 MPa\", \"2 MPa\"]", "control = \"force\"\npath = [\"1 MPa\"]", r#"s.toml:16: loading.path.0: "MPa" is a pressure in Pa"#, r#"give a force in N, such as "20 nN""#),
        ("control = \"pressure\"\npath = [\"1 MPa\", \"2 MPa\"]", "control = \"mean-gap\"\npath = [\"-1 nm\"]", r#"s.toml:16: loading.path.0: "-1 nm" is out of range"#, "finite and at least 0"),
        (r#"size = "1 um""#, "size = \"1 um\"\nboundary = \"free\"", "s.toml:16: loading.control: a free boundary has no nominal area", r#"take "force" or "approach""#),
        (r#"path = ["1 MPa", "2 MPa"]"#, "path = [1e6]\nspring = \"1 N/m\"", "s.toml:17: loading.spring: a spring needs a prescribed far end", r#"take control = "approach""#),
        (r#"path = ["1 MPa", "2 MPa"]"#, "path = [1e6]\nstart = 1e6", "s.toml:16: loading.path: is given together with start or [[loading.ramp]]", "give either the path or the ramps"),
        (r#"path = ["1 MPa", "2 MPa"]"#, "start = 1e6", "s.toml:14: loading.ramp: missing", "`[[loading.ramp]]` with `to` and `steps`"),
        (r#"path = ["1 MPa", "2 MPa"]"#, "start = 1e6\nramp = []", "s.toml:17: loading.ramp: is empty", "give at least one ramp"),
    ]});
    tables.push(Edits { base: spring(), cases: &[
        ("path = [\"1 nm\"]\nspring = \"1 N/m\"", r#"path = ["1 MPa"]"#, r#"s.toml:16: loading.path.0: "MPa" is a pressure in Pa"#, "give a length in m"),
        (r#"spring = "1 N/m""#, "pull_off_tolerance = 0.01", "s.toml:17: loading.pull_off_tolerance: applies to a prescribed load and to a spring", "leave the tolerance out"),
        (r#"spring = "1 N/m""#, "spring = 0", "s.toml:17: loading.spring: 0 is out of range", "finite and above 0"),
        (r#"spring = "1 N/m""#, r#"spring = "1 N""#, r#"s.toml:17: loading.spring: "N" is a force in N"#, "a force per length in N/m"),
    ]});
    tables.push(Edits { base: creeping(), cases: &[
        ("duration = 1\n", "", "s.toml:23: loading.ramp.0.steps: \"auto\" needs the duration of the ramp", "give duration = \"1 s\""),
        ("time_tolerance = 1e-3", "time_tolerance = 0", "s.toml:20: loading.time_tolerance: 0 is out of range", "from 1e-6 to 0.1"),
        ("time_tolerance = 1e-3", "time_tolerance = \"1 s\"", "s.toml:20: loading.time_tolerance: the text \"1 s\" where a number without a unit is expected", "`time_tolerance = 1e-3`"),
        ("time = 1", "time = 1e-20\n[[solid.relaxation]]\nmodulus = 1e30\ntime = 1e10", "s.toml:24: loading.ramp: the ramps add up to more than 1000000 steps", "1000000"),
    ]});
    tables.push(Edits { base: ramps(), cases: &[
        ("start = \"1 MPa\"\n", "", "s.toml:14: loading.start: missing", r#"`start = "1 MPa"`"#),
        ("to = \"2 MPa\"\n", "", "s.toml:17: loading.ramp.0.to: missing", r#"`to = "10 MPa"`"#),
        ("steps = 4\n", "", "s.toml:17: loading.ramp.0.steps: missing", "`steps = 10`"),
        ("steps = 4", "steps = 0", "s.toml:19: loading.ramp.0.steps: 0 is out of range", "a whole number from 1 to 1000000"),
        ("steps = 4", "steps = 9000000000000000000", "s.toml:19: loading.ramp.0.steps: 9000000000000000000 is out of range", "a whole number from 1 to 1000000"),
        ("steps = 4", "steps = 1000000", "s.toml:17: loading.ramp: the ramps add up to more than 1000000 steps", "1000000"),
        ("steps = 4", "steps = 4\nduration = \"-1 s\"", "s.toml:20: loading.ramp.0.duration: \"-1 s\" is out of range", "finite and at least 0"),
        ("steps = 4", "steps = 4\nduration = \"1 m\"", "s.toml:20: loading.ramp.0.duration: \"m\" is a length in m", "s"),
        ("steps = 4", "steps = 4\nhold = \"1 s\"", "s.toml:18: loading.ramp.0.to: hold = \"1 s\" keeps the load", "leave this out"),
        (r#"to = "2 MPa""#, "hold = \"1 s\"\nduration = 1", "s.toml:19: loading.ramp.0.duration: hold = \"1 s\" keeps the load", "leave this out"),
        ("steps = 4", "steps = 4\nduration = 1\n[[loading.ramp]]\nto = 1\nsteps = 1", "s.toml:21: loading.ramp.1.duration: missing", "`duration = \"1 s\"`"),
        ("steps = 4", "steps = \"auto\"\nduration = 1", "s.toml:19: loading.ramp.0.steps: \"auto\" follows the relaxation times of the solid", "or [[solid.relaxation]]"),
        ("steps = 4", "steps = \"atuo\"", "s.toml:19: loading.ramp.0.steps", "did you mean"),
        ("[[loading.ramp]]", "time_tolerance = 1e-3\n[[loading.ramp]]", "s.toml:17: loading.time_tolerance: applies to ramps with steps = \"auto\", and there is none", "leave the tolerance out"),
        ("[[loading.ramp]]", "pull_off_tolerance = 0.7\n[[loading.ramp]]", "s.toml:17: loading.pull_off_tolerance: 0.7 is out of range", "0 for none, or from 1e-6 to 0.5"),
        ("steps = 4", "steps = 4\nstep = 3", "s.toml:20: loading.ramp.0.step: unknown key in [[loading.ramp]]", "did you mean `steps`?"),
    ]});
}

#[rustfmt::skip] // one case a line
fn mistakes_in_solver_and_output(tables: &mut Vec<Edits>) {
    tables.push(Edits { base: GOOD.to_string(), cases: &[
        ("tolerance = 1e-6", "tolerance = 0", "s.toml:18: solver.tolerance: 0 is out of range", "above 0 and at most 0.1"),
        ("tolerance = 1e-6", "tolerance = 0.2", "s.toml:18: solver.tolerance: 0.2 is out of range", "above 0 and at most 0.1"),
        ("tolerance = 1e-6", r#"tolerance = "1e-6""#, r#"s.toml:18: solver.tolerance: the text "1e-6" where a number without a unit is expected"#, "`tolerance = 1e-6`"),
        ("tolerance = 1e-6", "max_iterations = 0", "s.toml:18: solver.max_iterations: 0 is out of range", "a whole number of at least 1"),
        ("tolerance = 1e-6", "tolerance = 1e-6\nprecision = \"single\"", "s.toml:18: solver.tolerance: 1e-6 is out of range", "at least 1e-4"),
        ("tolerance = 1e-6", r#"precision = "f64""#, r#"s.toml:18: solver.precision: "f64" is not one of "auto", "single", "mixed", "double""#, "\"double\""),
        ("tolerance = 1e-6", r#"backend = "cuda""#, r#"s.toml:18: solver.backend: "cuda" is not one of "auto", "cpu", "gpu""#, "\"gpu\""),
        ("tolerance = 1e-6", "pressure_tolerance = 1e-6", "s.toml:18: solver.pressure_tolerance: unknown key in [solver]", "; it takes tolerance, max_iterations"),
        ("images = []", r#"images = "pressure""#, r#"s.toml:20: output.images: the text "pressure" where a list of names is expected"#, r#"`images = ["pressure"]`"#),
        ("images = []", r#"images = ["presure"]"#, r#"s.toml:20: output.images.0: "presure" is not one of "pressure", "gap", "displacement", "heights""#, r#"did you mean "pressure"?"#),
        ("images = []", r#"fields = ["gap", 3]"#, "s.toml:20: output.fields.1: the number 3 where a word in quotes is expected", r#"`fields = ["gap"]`"#),
        ("images = []", r#"fields = ["gap", "gap"]"#, r#"s.toml:20: output.fields: names "gap" twice"#, "once is enough"),
        ("images = []", r#"steps = "first""#, r#"s.toml:20: output.steps: "first" is not one of "last", "all""#, "\"all\""),
        ("images = []", "steps = 2", r#"s.toml:20: output.steps: the number 2 where "last", "all" or a list of step numbers is expected"#, "`steps = [1, 5]`"),
        ("images = []", "steps = [1, 3]", "s.toml:20: output.steps.1: 3 is out of range", "a step of the path, 1 to 2"),
        ("images = []", "steps = [0]", "s.toml:20: output.steps.0: 0 is out of range", "a whole number of at least 1"),
        ("images = []", r#"steps = ["1"]"#, r#"s.toml:20: output.steps.0: the text "1" where a whole number is expected"#, "steps = "),
    ]});
}

fn damp() -> String {
    let start = GOOD.find("[adhesion]").expect("a table");
    let end = GOOD.find("[loading]").expect("a table");
    format!(
        "{}[capillary]\nhumidity = 0.5\n{}",
        &GOOD[..start],
        &GOOD[end..]
    )
}

#[rustfmt::skip] // one case a line
fn mistakes_in_capillary(tables: &mut Vec<Edits>) {
    tables.push(Edits { base: damp(), cases: &[
        ("humidity = 0.5\n", "", "s.toml:10: capillary.humidity: missing", "`humidity = 0.5`"),
        ("humidity = 0.5", "humidity = 1", "s.toml:11: capillary.humidity: 1 is out of range", "from 0 to below 1"),
        ("humidity = 0.5", "humidity = -0.1", "s.toml:11: capillary.humidity: -0.1 is out of range", "from 0 to below 1"),
        ("humidity = 0.5", "humidity = 50", "s.toml:11: capillary.humidity: 50 is out of range", "a relative humidity"),
        ("humidity = 0.5", "humidity = 0.5\ncontact_angle = 90", "s.toml:12: capillary.contact_angle: 90 is out of range", "only a wetting liquid attracts"),
        ("humidity = 0.5", "humidity = 0.5\ntemperature = \"25 C\"", "s.toml:12: capillary.temperature:", "K"),
        ("humidity = 0.5", "humidity = 0.5\ntemperature = 700", "s.toml:12: capillary.temperature: 700 K is above the critical point of water", "give surface_tension and molar_volume"),
        ("humidity = 0.5", "humidity = 0.5\ntemperature = 25", "s.toml:12: capillary.temperature: 25 K is below 248.15 K", "was it meant in Celsius"),
        ("humidity = 0.5", "humidity = 0.5\nmolar_volume = 0", "s.toml:12: capillary.molar_volume: 0 is out of range", "finite and above 0"),
        ("humidity = 0.5", "humidity = 0.5\nsurface_tension = \"72 mPa\"", "s.toml:12: capillary.surface_tension:", "N/m"),
        ("humidity = 0.5", "humidity = 0.5\nsurface_tension = 1e20\nmolar_volume = 1e20", "s.toml:11: capillary.humidity: makes a meniscus", "check the powers of ten"),
        ("humidity = 0.5", "humidty = 0.5", "s.toml:11: capillary.humidty: unknown key in [capillary]", "did you mean `humidity`?"),
    ]});
}

fn dry_air_is_a_scene_without_attraction() {
    let dry = accepted(&edited(&damp(), "humidity = 0.5", "humidity = 0"));
    assert!(dry.adhesion.is_none() && dry.capillary.is_some());
}

#[rustfmt::skip] // one case a line
fn mistakes_in_the_scene_itself(tables: &mut Vec<Edits>) {
    tables.push(Edits { base: GOOD.to_string(), cases: &[
        (r#"title = "good""#, "title = 3", "s.toml:1: title: the number 3 where a text in quotes is expected", r#"title = "Sphere on a flat""#),
        (r#"title = "good""#, r#"titel = "good""#, "s.toml:1: titel: unknown key in the scene itself", "did you mean `title`?"),
        ("[solver]", "[solvr]", "s.toml:17: solvr: unknown key in the scene itself", "did you mean `solver`?"),
        (r#"title = "good""#, r#""tit\nle" = 1"#, r#"s.toml:1: "tit\nle": unknown key in the scene itself"#, "did you mean `title`?"),
        ("images = []", "images = []\n[capillary]\nhumidity = 0.5", "s.toml:21: capillary: [adhesion] is given too", "give one of the two"),
        ("images = []", "images = []\n[friction]", "s.toml:21: friction.shear_strength: missing", "`shear_strength = \"10 MPa\"`"),
        ("images = []", "images = []\n[friction]\nshear_strength = 0", "s.toml:22: friction.shear_strength: 0 is out of range", "finite and above 0"),
        ("images = []", "images = []\n[friction]\nshear_strength = \"3 N\"", "s.toml:22: friction.shear_strength: \"N\" is a force in N", "give a pressure in Pa"),
        ("images = []", "images = []\n[plastic]", "s.toml:21: plastic: plasticity is not in this version", "take it out"),
        ("images = []", "images = []\n[conductance]\nconductivity = 1", "s.toml:21: conductance.counter_conductivity: missing", "`counter_conductivity = \"1.4 W/(m K)\"`"),
        ("images = []", "images = []\n[conductance]\nconductivity = 0\ncounter_conductivity = 1", "s.toml:22: conductance.conductivity: 0 is out of range", "finite and above 0"),
        ("images = []", "images = []\n[conductance]\nconductivity = 1\ncounter_conductivity = \"3 W\"", "s.toml:23: conductance.counter_conductivity: \"W\" is not a unit", "give a conductivity in W/(m K) or S/m, such as \"400 W/(m K)\""),
        ("images = []", "images = []\n[wear]", "s.toml:21: wear.specific_wear_rate: missing", "`specific_wear_rate = \"1e-6 mm^3/(N m)\"`"),
        ("images = []", "images = []\n[wear]\nspecific_wear_rate = -1e-15", "s.toml:22: wear.specific_wear_rate: -1e-15 is out of range", "finite and above 0"),
        ("images = []", "images = []\n[wear]\nspecific_wear_rate = \"1 m^3\"", "s.toml:22: wear.specific_wear_rate: \"m^3\" is not a unit", "give a specific wear rate in m^3/(N m) or 1/Pa, such as \"1e-6 mm^3/(N m)\""),
        (r#"contact_modulus = "1 GPa""#, "contact_modulus = \"1 GPa\"\npoisson_ratio = 0.3\nthickness = 1\n[conductance]\nconductivity = 1\ncounter_conductivity = 2", "s.toml:9: conductance: the conductance of a layer is not in this version", "leave the thickness out, or [conductance]"),
        ("points = 64", "points = 64\npoints = 65", "s.toml:4: not valid TOML: duplicate key", "duplicate key"),
        ("points = 64", "points = ", "s.toml:3: not valid TOML:", "expected"),
        ("[solid]", "[solid", "s.toml:5: not valid TOML:", "expected `]`"),
    ]});
}

fn all_mistakes_come_at_once_in_the_order_of_lines() {
    let text = r#"titel = "bad"
[grid]
points = 0
size = "1 nN"
[solid]
contact_modulus = -1
[[surface]]
kind = "sphere"
radius = "1 um"
[[surface]]
kind = "self-affine"
hurst = 2
rms_height = "1 nm"
rms_slope = 0.1
longest = "1 um"
rolloff = "2 um"
shortest = "3 um"
[adhesion]
law = "jkr"
range = "1 nm"
[loading]
control = "force"
path = ["1 nN", "2 MPa", nan]
[solver]
tolerance = 0
backend = "cuda"
[output]
steps = [4]
"#;
    let expected = [
        "s.toml:1: titel: unknown key",
        "s.toml:3: grid.points: 0 is out of range",
        "s.toml:4: grid.size: \"nN\" is a force",
        "s.toml:6: solid.contact_modulus: -1 is out of range",
        "s.toml:12: surface.1.hurst: 2 is out of range",
        "s.toml:14: surface.1.rms_slope: rms_height is given too",
        "s.toml:16: surface.1.rolloff: 2 µm is longer than longest = 1 µm",
        "s.toml:17: surface.1.shortest: 3 µm is not shorter than rolloff = 2 µm",
        "s.toml:18: adhesion.work_of_adhesion: missing",
        "s.toml:19: adhesion.law: \"jkr\" is not one of",
        "s.toml:23: loading.path.1: \"MPa\" is a pressure",
        "s.toml:23: loading.path.2: nan is out of range",
        "s.toml:25: solver.tolerance: 0 is out of range",
        "s.toml:26: solver.backend: \"cuda\" is not one of",
    ];
    let messages = refused(text, &[]);
    assert_eq!(messages.len(), expected.len(), "{messages:#?}");
    for (message, beginning) in messages.iter().zip(expected) {
        assert!(message.starts_with(beginning), "{message}\n{beginning}");
    }
}

fn an_empty_scene_names_every_table_it_needs() {
    let messages = refused("", &[]).join("\n");
    for table in ["grid", "solid", "surface", "loading"] {
        assert!(
            messages.contains(&format!("s.toml: {table}: missing; add for example `[")),
            "{table}: {messages}"
        );
    }
}

fn mistakes_are_typed() {
    let errors = parse(&edited(GOOD, "points = 64", "points = 0")).expect_err("no points");
    assert_eq!(
        errors.0,
        [Mistake {
            file: "s.toml".into(),
            line: Some(3),
            key: "grid.points".into(),
            from_set: false,
            error: SceneError::OutOfRange {
                found: "0".into(),
                allowed: "a whole number from 1 to 262144".into(),
            },
        }]
    );
}

fn overrides_change_what_they_name() {
    let set = |key, value| parse_set(GOOD, &[(key, value)]).expect("a right override");
    assert_eq!(set("grid.points", "128").grid.points, Some([128, 128]));
    assert_eq!(set("grid.points", "[8, 4]").grid.points, Some([8, 4]));
    assert_eq!(set("grid.size", "2 um").grid.size, Some([2e-6, 2e-6]));
    assert_eq!(set("grid.size", "\"2 um\"").grid.size, Some([2e-6, 2e-6]));
    assert_eq!(
        set("adhesion.law", "exponential")
            .adhesion
            .map(|found| found.law),
        Some(LawName::Exponential)
    );
    assert_eq!(
        set("surface.0.radius", "2e-6").surfaces,
        [SurfacePart::Sphere {
            radius: 2e-6,
            centre: None
        }]
    );
    assert_eq!(set("loading.path.1", "3 MPa").loading.path, [1e6, 3e6]);
    assert_eq!(
        set("title", "two words").title.as_deref(),
        Some("two words")
    );
    // Tables that every scene has need not be written.
    let bare = GOOD.replace("[solver]\ntolerance = 1e-6\n", "");
    let scene = parse_set(&bare, &[("solver.tolerance", "1e-8")]).expect("a solver");
    assert_eq!(scene.solver.tolerance, 1e-8);
    // Single precision has a default of its own; on the GPU `auto` goes by the tolerance.
    let single = ("solver.precision", "single");
    let scene = parse_set(&bare, &[single]).expect("a solver");
    assert_eq!(scene.solver.tolerance, Precision::SINGLE_FLOOR);
    assert!(scene.is_single());
    let at_the_floor = ("solver.tolerance", "1e-4");
    let set = [single, at_the_floor];
    assert_eq!(parse_set(&bare, &set).expect("at the floor"), scene);
    let gpu = ("solver.backend", "gpu");
    let scene = parse_set(&bare, &[gpu]).expect("a solver");
    assert_eq!(scene.solver.tolerance, 1e-6);
    assert_eq!(scene.arithmetic_on_gpu(), Precision::Mixed);
    // On the processor it goes by the points, the tolerance, and what the corrections of mixed precision can do.
    let few = 256 * 256 - 1;
    assert_eq!(scene.arithmetic_on_processor(few), Precision::Double);
    assert_eq!(scene.arithmetic_on_processor(few + 1), Precision::Mixed);
    let set = [("solver.tolerance", "1e-11")];
    let tight = parse_set(&bare, &set).expect("a solver");
    assert_eq!(tight.arithmetic_on_processor(few + 1), Precision::Double);
    let hardness = ("solid.hardness", "1e12");
    let scene = parse_set(&bare, &[gpu, hardness]).expect("a solver");
    assert_eq!(scene.arithmetic_on_gpu(), Precision::Double);
    assert_eq!(scene.arithmetic_on_processor(few + 1), Precision::Double);
    let scene = parse_set(&bare, &[gpu, at_the_floor]).expect("a solver");
    assert!(scene.is_single());
    let scene = parse_set(&bare, &[("solver.precision", "mixed")]).expect("a solver");
    assert_eq!(
        (scene.solver.tolerance, scene.arithmetic_on_processor(1)),
        (1e-6, Precision::Mixed)
    );
    // An effect may be set as a whole.
    let hard = hard();
    let law = "{ law = 'exponential', work_of_adhesion = 0.1, range = '1 nm' }";
    let scene = parse_set(&hard, &[("adhesion", law)]).expect("an effect");
    assert_eq!(
        scene.adhesion.map(|found| found.range),
        Some(Range::Length(1e-9))
    );
    // The last one counts.
    let twice = [("grid.points", "8"), ("grid.points", "16")];
    let scene = parse_set(GOOD, &twice).expect("two overrides");
    assert_eq!(scene.grid.points, Some([16, 16]));
}

/// [`GOOD`] without adhesion.
fn hard() -> String {
    edited(
        GOOD,
        "[adhesion]\nlaw = \"maugis-dugdale\"\nwork_of_adhesion = \"50 mJ/m^2\"\nrange = \"1 nm\"\n",
        "",
    )
}

fn overrides_that_are_wrong_say_where_they_came_from() {
    let hard = hard();
    for (text, key, value, message) in [
        (
            GOOD,
            "grid.points",
            "0",
            "s.toml, from an override: grid.points: 0 is out of range; it must be a whole number from 1 to 262144",
        ),
        (
            GOOD,
            "surface.0.radius",
            "2 MPa",
            "s.toml, from an override: surface.0.radius: \"MPa\" is a pressure in Pa; give a length in m",
        ),
        (
            GOOD,
            "surface.0.hurst",
            "0.4",
            "s.toml, from an override: surface.0.hurst: unknown key in a sphere [[surface]]",
        ),
        (
            GOOD,
            "surface.1.radius",
            "0.4",
            "s.toml, from an override: surface.1.radius: there is no surface.1: surface has one entry, surface.0",
        ),
        (
            GOOD,
            "loading.path.2",
            "0.4",
            "s.toml, from an override: loading.path.2: there is no loading.path.2: loading.path has 2 entries, numbered 0 to 1",
        ),
        (
            GOOD,
            "surface.first.radius",
            "1",
            "surface is a list, so a number from 0 must follow it, as in surface.0, and not first",
        ),
        (
            GOOD,
            "surface.-1.radius",
            "1",
            "surface is a list, so a number from 0 must follow it, as in surface.0, and not -1",
        ),
        (
            GOOD,
            "grid.points.0.x",
            "1",
            "grid.points is a single value, so 0 cannot follow it",
        ),
        (
            GOOD,
            "grid.points.0",
            "1",
            "grid.points is a single value, so 0 cannot follow it",
        ),
        (
            GOOD,
            "loading.ramps.steps",
            "1",
            "s.toml, from an override: loading.ramps.steps: loading has no table ramps in this scene",
        ),
        (
            hard.as_str(),
            "adhesion.range",
            "1 nm",
            "s.toml, from an override: adhesion.range: the scene has no [adhesion]; add the table to the file first, or override all of it with 'adhesion={ ... }'",
        ),
        (
            GOOD,
            "adhesive.range",
            "1 nm",
            "the scene has no [adhesive]; add the table to the file first",
        ),
        (
            GOOD,
            "grid..points",
            "1",
            "s.toml, from an override: grid..points: not a key; write it with dots between the names, such as surface.0.hurst=0.4",
        ),
        (
            GOOD,
            "",
            "1",
            "s.toml, from an override: not a key; write it",
        ),
        (
            GOOD,
            "grid.points",
            "[64, 64",
            "s.toml, from an override: grid.points: not valid TOML: unclosed array",
        ),
        (
            GOOD,
            "grid.points",
            "",
            "s.toml, from an override: grid.points: the text \"\" where a whole number is expected",
        ),
        (
            GOOD,
            "grid",
            "1",
            "s.toml, from an override: grid: the number 1 where a table is expected",
        ),
        (
            GOOD,
            "solid.hardness",
            "1 GN",
            "s.toml, from an override: solid.hardness: \"GN\" is a force in N",
        ),
        (
            GOOD,
            "solid.young_modulus",
            "1 GPa",
            "s.toml, from an override: solid.young_modulus: contact_modulus is given too",
        ),
    ] {
        let messages = refused(text, &[(key, value)]);
        assert!(
            messages.len() == 1 && messages[0].contains(message),
            "{key}={value} gave {messages:#?} and not {message}"
        );
    }
}

fn the_scene_of_the_manual_is_read() {
    let text = r#"
title = "Self-affine surface with Maugis-Dugdale adhesion"

[grid]
points   = 1024          # or [1024, 512]: x, y
size     = "25 um"       # or ["25 um", "12.5 um"]: x, y
boundary = "periodic"    # or "free"

[solid]
contact_modulus = "1.33 TPa"
# thickness = "5 um"
# hardness  = "10 GPa"

[[surface]]
kind = "self-affine"
hurst = 0.8
rms_height = "0.52 nm"
longest = "25 um"
rolloff = "6.25 um"
shortest = "195 nm"
seed = 1

[adhesion]
law = "maugis-dugdale"
work_of_adhesion = "0.2 J/m^2"
range = "1 nm"
# taper = "auto"
treatment = "full"

[loading]
control = "pressure"
path = ["1 MPa", "10 MPa", "100 MPa", "10 MPa", "1 MPa"]

[solver]
tolerance = 1e-6
max_iterations = 5000
precision = "auto"
backend = "auto"

[output]
images = ["pressure"]
fields = []
steps  = "last"
"#;
    let scene = accepted(text);
    let rough = SelfAffineScene {
        hurst: 0.8,
        roughness: Roughness::RmsHeight(0.52e-9),
        longest: 25e-6,
        rolloff: 6.25e-6,
        shortest: 195e-9,
        seed: 1,
    };
    let mut expected = Scene::new(
        GridScene {
            points: Some([1024, 1024]),
            size: Some([25e-6, 25e-6]),
            boundary: Boundary::Periodic,
        },
        SolidScene::new(1.33e12),
        vec![SurfacePart::SelfAffine(rough)],
        LoadingScene::new(Control::Pressure, [1e6, 1e7, 1e8, 1e7, 1e6]),
    );
    expected.title = Some("Self-affine surface with Maugis-Dugdale adhesion".into());
    let mut law = AdhesionScene::new(LawName::MaugisDugdale, 0.2, Range::Length(1e-9));
    law.taper = None;
    law.treatment = Treatment::Full;
    law.map = None;
    law.rate = None;
    expected.adhesion = Some(law);
    expected.solid.poisson_ratio = None;
    expected.solid.layer = None;
    expected.solid.hardness = None;
    expected.solid.relaxation = Vec::new();
    expected.capillary = None;
    expected.tables = EffectTables::default();
    expected.loading.durations = None;
    expected.loading.spring = None;
    expected.loading.pull_off_tolerance = 0.01;
    expected.solver = SolverScene::default();
    expected.output = OutputScene::default();
    expected.folder = PathBuf::from("/scenes");
    assert_eq!(scene, expected);

    // What the manual shows for boundary, seed, taper, treatment, solver and output is the default.
    let (head, _) = text.split_once("[solver]").expect("a solver");
    let bare = head
        .replace("boundary =", "# ")
        .replace("seed =", "# ")
        .replace("treatment =", "# ");
    assert_eq!(accepted(&bare), expected);
}

fn the_contact_modulus_follows_from_young_and_poisson() {
    let one = accepted(&young()).solid;
    assert_eq!(one.poisson_ratio, Some(0.3));
    assert!((one.contact_modulus * 0.91e-9 - 1.0).abs() < 1e-15);
    let two = accepted(&edited(
        &young(),
        "poisson_ratio = 0.3",
        "poisson_ratio = 0.3\ncounter_young_modulus = \"3 GPa\"\ncounter_poisson_ratio = 0.5",
    ));
    // 1/E* = 0.91/1 GPa + 0.75/3 GPa = 1.16/GPa
    assert!((two.solid.contact_modulus * 1.16e-9 - 1.0).abs() < 1e-15);
    let both = edited(GOOD, "\"1 GPa\"", "\"1 GPa\"\npoisson_ratio = 0.3");
    assert_eq!(accepted(&both).solid.poisson_ratio, Some(0.3));
}

fn adhesion(text: &str) -> AdhesionScene {
    let with = edited(
        GOOD,
        "law = \"maugis-dugdale\"\nwork_of_adhesion = \"50 mJ/m^2\"\nrange = \"1 nm\"",
        text,
    );
    accepted(&with).adhesion.expect("adhesion is on")
}

fn two_numbers_of_a_law_give_the_third() {
    let close = |one: f64, other: f64| (one / other - 1.0).abs() < 1e-14;
    let lennard_jones = 16.0 / (9.0 * 3f64.sqrt());
    for (law, shape) in [
        ("maugis-dugdale", 1.0),
        ("exponential", 1.0),
        ("lennard-jones", lennard_jones),
    ] {
        let head = format!("law = \"{law}\"\n");
        let found = adhesion(&format!(
            "{head}work_of_adhesion = 0.05\npeak_tension = \"100 MPa\""
        ));
        let Range::Length(range) = found.range else {
            panic!("{law}: no range");
        };
        assert!(close(range, 0.05 * shape / 1e8), "{law}: {range}");
        let back = adhesion(&format!("{head}range = {range}\npeak_tension = 1e8"));
        assert!(close(back.work_of_adhesion, 0.05), "{law}");
    }
    let auto = adhesion("law = \"exponential\"\nwork_of_adhesion = 0.05\nrange = \"auto\"");
    assert_eq!(auto.range, Range::Auto);
}

fn tapers_and_treatments_are_read() {
    let head = "law = \"maugis-dugdale\"\nwork_of_adhesion = 0.05\nrange = \"1 nm\"\n";
    let taper = |text: &str| adhesion(&format!("{head}{text}")).taper;
    assert_eq!(taper(""), None);
    assert_eq!(taper("taper = \"auto\""), None);
    assert_eq!(taper("taper = 0"), Some(0.0));
    assert_eq!(taper("taper = \"2 nm\""), Some(2e-9));
    for law in LawName::ALL {
        let text = format!(
            "law = \"{}\"\nwork_of_adhesion = \"50 mN/m\"\nrange = \"1 nm\"\ntreatment = \"dmt\"",
            law.name()
        );
        assert_eq!(adhesion(&text).treatment, Treatment::Dmt);
    }
    assert_eq!(accepted(&hard()).adhesion, None);
}

fn every_kind_of_surface_is_read() {
    let first = |text: &str| accepted(text).surfaces.remove(0);
    assert_eq!(
        first(&with_surface(
            "kind = \"sphere\"\nradius = 1e-6\ncentre = [0, \"-1 nm\"]"
        )),
        SurfacePart::Sphere {
            radius: 1e-6,
            centre: Some([0.0, -1e-9])
        }
    );
    assert_eq!(
        first(&cone()),
        SurfacePart::Cone {
            half_angle: 70f64.to_radians(),
            centre: None
        }
    );
    let cone_at = |angle: &str| match first(&edited(&cone(), "\"70 deg\"", angle)) {
        SurfacePart::Cone { half_angle, .. } => half_angle,
        other => panic!("{other:?}"),
    };
    assert_eq!(cone_at("30"), 30f64.to_radians());
    assert_eq!(cone_at("\"0.5 rad\""), 0.5);
    let wavelength = |text: &str| match first(&edited(&wavy(), "th = \"1 um\"", text)) {
        SurfacePart::Wavy { wavelength, .. } => wavelength,
        other => panic!("{other:?}"),
    };
    assert_eq!(wavelength("th = \"500 nm\""), [500e-9, f64::INFINITY]);
    assert_eq!(wavelength("th = [\"1 um\", 2e-7]"), [1e-6, 2e-7]);
    assert_eq!(
        wavelength("th = [\"inf\", \"1 um\"]"),
        [f64::INFINITY, 1e-6]
    );
    assert_eq!(wavelength("th = [inf, 1e-6]"), [f64::INFINITY, 1e-6]);
    assert_eq!(first(&with_surface("kind = \"flat\"")), SurfacePart::Flat);
    let slope = edited(
        &self_affine(),
        "rms_height = \"1 nm\"",
        "rms_slope = 0.1\nseed = 7",
    );
    match first(&slope) {
        SurfacePart::SelfAffine(part) => {
            assert_eq!(part.roughness, Roughness::RmsSlope(0.1));
            assert_eq!(part.seed, 7);
        }
        other => panic!("{other:?}"),
    }
    // The band may begin at the roll-off.
    accepted(&edited(&self_affine(), "\"500 nm\"", "\"1 um\""));
    let sum = accepted(&edited(
        GOOD,
        "[adhesion]",
        "[[surface]]\nkind = \"flat\"\n[adhesion]",
    ));
    assert_eq!(sum.surfaces.len(), 2);
}

fn a_height_file_may_carry_the_grid() {
    let without_grid = height_file().replace("[grid]\npoints = 64\nsize = \"1 um\"\n", "");
    let scene = accepted(&without_grid);
    assert_eq!(scene.grid.points, None);
    assert_eq!(scene.grid.size, None);
    assert_eq!(
        scene.surfaces,
        [SurfacePart::File(HeightFileScene {
            preparation: tabor::scene::Preparation::default(),
            path: PathBuf::from("/scenes/h.npy"),
            unit: 1.0,
            scale: 1.0,
            black: None,
            white: None,
            detrend: Detrend::None,
            fill: Fill::None,
        })]
    );
    assert_eq!(
        accepted(&height_file().replace("points = 64\n", ""))
            .grid
            .points,
        None
    );
    let all = edited(
        &height_file(),
        "path = \"h.npy\"",
        "path = \"/data/h.npy\"\nunit = \"nm\"\nscale = -2\ndetrend = \"quadratic\"\nfill = \"interpolate\"",
    );
    assert_eq!(
        accepted(&all).surfaces,
        [SurfacePart::File(HeightFileScene {
            preparation: tabor::scene::Preparation::default(),
            path: PathBuf::from("/data/h.npy"),
            unit: 1e-9,
            scale: -2.0,
            black: None,
            white: None,
            detrend: Detrend::Quadratic,
            fill: Fill::Interpolate,
        })]
    );
}

fn free_boundaries_take_any_wavelength_and_force_or_approach() {
    let free = |text: &str| {
        edited(
            text,
            "size = \"1 um\"",
            "size = \"1 um\"\nboundary = \"free\"",
        )
    };
    let odd = edited(&wavy(), "th = \"1 um\"", "th = \"300 nm\"");
    for control in [
        "control = \"force\"\npath = [\"-1 nN\"]",
        "control = \"approach\"\npath = [-1e-9]",
    ] {
        let text = edited(
            &free(&odd),
            "control = \"pressure\"\npath = [\"1 MPa\", \"2 MPa\"]",
            control,
        );
        assert_eq!(accepted(&text).grid.boundary, Boundary::Free);
        assert_eq!(accepted(&text).loading.path, [-1e-9]);
    }
}

fn ramps_end_where_they_say() {
    assert_eq!(
        accepted(&ramps()).loading.path,
        [1e6, 1.25e6, 1.5e6, 1.75e6, 2e6]
    );
    let back = edited(
        &ramps(),
        "steps = 4",
        "steps = 2\n[[loading.ramp]]\nto = 0\nsteps = 1",
    );
    assert_eq!(accepted(&back).loading.path, [1e6, 1.5e6, 2e6, 0.0]);
    assert_eq!(accepted(&spring()).loading.spring, Some(1.0));
}

fn a_mean_gap_below_zero_is_for_lennard_jones() {
    let gap = with_loading("control = \"mean-gap\"\npath = [\"0 nm\", \"-0.5 nm\"]");
    let lennard_jones = edited(&gap, "maugis-dugdale", "lennard-jones");
    assert_eq!(accepted(&lennard_jones).loading.path, [0.0, -0.5e-9]);
    for text in [
        gap.clone(),
        edited(
            &lennard_jones,
            "range = \"1 nm\"",
            "range = \"1 nm\"\ntreatment = \"dmt\"",
        ),
    ] {
        let messages = refused(&text, &[]);
        assert!(
            messages[0].contains("loading.path.1: \"-0.5 nm\" is out of range"),
            "{messages:?}"
        );
    }
    let beyond = refused(&edited(&lennard_jones, "-0.5 nm", "-1 nm"), &[]);
    assert!(
        beyond[0].contains("a mean gap must stay above -1 nm"),
        "{beyond:?}"
    );
}

fn outputs_are_read() {
    let output = |text: &str| accepted(&edited(GOOD, "images = []", text)).output;
    let found =
        output("images = [\"gap\", \"heights\"]\nfields = [\"displacement\"]\nsteps = [2, 1]");
    assert_eq!(found.images, [FieldName::Gap, FieldName::Heights]);
    assert_eq!(found.fields, [FieldName::Displacement]);
    assert_eq!(found.steps, StepChoice::List(vec![2, 1]));
    assert_eq!(output("steps = \"all\"").steps, StepChoice::All);
    assert_eq!(output("steps = \"last\""), OutputScene::default());
}

fn inline_tables_and_dotted_keys_do_as_well() {
    let scene = accepted(
        r#"grid = { points = 64, size = "1 um" }
solid.contact_modulus = "1 GPa"
surface = [{ kind = "sphere", radius = "1 um" }, { kind = "flat" }]
loading.control = "approach"
loading.start = 0
loading.ramp = [{ to = "1 nm", steps = 1 }]
"#,
    );
    assert_eq!(scene.surfaces.len(), 2);
    assert_eq!(scene.loading.path, [0.0, 1e-9]);
    let messages = refused("solid.contact_modulus = 0", &[]).join("\n");
    assert!(
        messages.contains("s.toml:1: solid.contact_modulus: 0 is out of range"),
        "{messages}"
    );
    let messages = refused("surface = []", &[]).join("\n");
    assert!(
        messages.contains("s.toml:1: surface: is empty; add for example [[surface]]"),
        "{messages}"
    );
}

fn a_resolved_scene_is_the_same_scene() {
    let every_part = edited(
        GOOD,
        "[adhesion]",
        "centre = [1e-7, 2e-7]\n[[surface]]\nkind = \"cone\"\nhalf_angle = 30\n[[surface]]\nkind = \"flat\"\n[[surface]]\nkind = \"wavy\"\namplitude = 1e-9\nwavelength = [\"inf\", 1e-6]\n[adhesion]",
    );
    for text in [
        GOOD.to_string(),
        every_part,
        hard(),
        young(),
        self_affine(),
        wavy(),
        height_file().replace("[grid]\npoints = 64\nsize = \"1 um\"\n", ""),
        ramps(),
        spring(),
        edited(
            GOOD,
            "range = \"1 nm\"",
            "range = \"auto\"\ntaper = \"0.1 nm\"",
        ),
        edited(GOOD, "maugis-dugdale", "lennard-jones"),
        edited(GOOD, "images = []", "images = [\"gap\"]\nsteps = [1]"),
    ] {
        let scene = accepted(&text);
        let resolved = toml::to_string(&scene.resolved_json()).expect("a scene as TOML");
        assert_eq!(accepted(&resolved), scene, "{resolved}");
    }
    let json = accepted(&edited(&cone(), "70 deg", "30 deg")).resolved_json();
    assert_eq!(json["surface"][0]["half_angle"], 30.0);
    assert_eq!(json["grid"]["points"], serde_json::json!([64, 64]));
    assert_eq!(json["adhesion"]["taper"], "auto");
    assert!(accepted(&hard()).resolved_json().get("adhesion").is_none());
}

fn files_are_read_and_their_folder_is_kept() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, height_file()).expect("a file");
    let scene = Scene::read(&path, &[]).expect("a right scene");
    assert_eq!(scene.folder, folder.path());
    let SurfacePart::File(part) = &scene.surfaces[0] else {
        panic!("{scene:?}");
    };
    assert_eq!(part.path, folder.path().join("h.npy"));

    let missing = Scene::read(&folder.path().join("no.toml"), &[]).expect_err("no file");
    let text = missing.to_string();
    assert!(text.contains("no.toml: cannot be read: "), "{text}");
    assert!(Scene::read(folder.path(), &[]).is_err());
    std::fs::write(&path, [0xff, 0xfe, 0x00]).expect("a file");
    let text = Scene::read(&path, &[]).expect_err("no text").to_string();
    assert!(
        text.contains("cannot be read: it is not UTF-8 text"),
        "{text}"
    );
}

fn windows_line_ends_and_marks_are_harmless() {
    let text = format!("\u{feff}{}", GOOD.replace('\n', "\r\n"));
    assert_eq!(accepted(&text), accepted(GOOD));
    let messages = refused(&edited(&text, "points = 64", "points = 0"), &[]);
    assert!(
        messages[0].starts_with("s.toml:3: grid.points"),
        "{messages:?}"
    );
}

fn deep_and_long_text_is_refused_in_short() {
    for text in [
        "a.".repeat(100_000) + "a = 1",
        format!("a = {}", "[".repeat(100_000)),
        format!("a = {}", "{a=".repeat(100_000)),
        format!("[{}a]", "a.".repeat(100_000)),
        format!("title = 1\n{} = 1", "k".repeat(100_000)),
        edited(GOOD, "maugis-dugdale", &"x".repeat(100_000)),
    ] {
        let messages = refused(&text, &[]);
        assert!(messages.iter().all(|message| message.len() < 1000));
    }
    let key = "a.".repeat(100_000) + "a";
    assert!(refused(GOOD, &[(&key, "1")])[0].len() < 1000);
    let value = "[".repeat(100_000);
    assert!(refused(GOOD, &[("grid.points", &value)])[0].len() < 1000);
}

fn powers_of_ten_that_run_out_are_refused() {
    for (from, to, beginning) in [
        (
            "work_of_adhesion = \"50 mJ/m^2\"",
            "peak_tension = 1e-25",
            "s.toml:12: adhesion.peak_tension: makes the third number of the law 1",
        ),
        (
            "range = \"1 nm\"",
            "peak_tension = 1e30",
            "s.toml:13: adhesion.peak_tension: makes the third number of the law 5",
        ),
        (
            "contact_modulus = \"1 GPa\"",
            "young_modulus = 1e30\npoisson_ratio = 0.3",
            "s.toml:6: solid.young_modulus: makes the contact modulus 1.0989",
        ),
        (
            "path = [\"1 MPa\", \"2 MPa\"]",
            "start = 0\nramp = [{ to = -1e308, steps = 2 }]",
            "s.toml:17: loading.ramp.0.to: -1e308 is out of range; it must be 0 or between 1e-30 and 1e30",
        ),
    ] {
        let messages = refused(&edited(GOOD, from, to), &[]);
        assert!(
            messages.len() == 1 && messages[0].starts_with(beginning),
            "{messages:#?}"
        );
    }
}

/// Fragments that scenes are made of, to be thrown together.
fn fragment() -> impl Strategy<Value = String> {
    prop_oneof![
        prop::sample::select(vec![
            "[grid]",
            "[[surface]]",
            "[adhesion]",
            "[loading]",
            "[[loading.ramp]]",
            "[solver]",
            "[output]",
            "points",
            "size",
            "kind",
            "path",
            "steps",
            "range",
            "to",
            "start",
            "wavelength",
            "= ",
            "\n",
            "\"",
            "[",
            "]",
            "{",
            "}",
            ",",
            "\"1 um\"",
            "\"inf\"",
            "nan",
            "-inf",
            "1e308",
            "9223372036854775807",
            "-9223372036854775808",
            "\"auto\"",
            "0",
            "true",
            "1979-05-27",
            "\"self-affine\"",
            "\"wavy\"",
            "\"file\"",
            ".",
            "#",
            "µ",
        ])
        .prop_map(str::to_string),
        ".{0,8}",
    ]
}

proptest! {
    fn no_text_makes_the_reader_panic(
        from in 0usize..400,
        to in 0usize..400,
        pieces in prop::collection::vec(fragment(), 0..6),
        base in 0usize..6,
        key in "[a-z0-9.]{0,24}",
        value in fragment(),
    ) {
        let bases = [GOOD.to_string(), self_affine(), wavy(), height_file(), ramps(), spring()];
        let letters: Vec<char> = bases[base].chars().collect();
        let from = from.min(letters.len());
        let to = to.clamp(from, (from + 40).min(letters.len()).max(from));
        let text: String = letters[..from].iter().collect::<String>()
            + &pieces.concat()
            + &letters[to..].iter().collect::<String>();
        if let Err(errors) = parse(&text) {
            prop_assert!(!errors.0.is_empty());
            prop_assert_eq!(errors.to_string().lines().count(), errors.0.len());
        }
        let keys = ["grid.points", "surface.0.kind", "loading.path.0", "adhesion", &key];
        for key in keys {
            if let Err(errors) = parse_set(&bases[base], &[(key, &value)]) {
                prop_assert!(!errors.0.is_empty());
            }
        }
    }
}

tests![
    dry_air_is_a_scene_without_attraction,
    all_mistakes_come_at_once_in_the_order_of_lines,
    an_empty_scene_names_every_table_it_needs,
    mistakes_are_typed,
    overrides_change_what_they_name,
    overrides_that_are_wrong_say_where_they_came_from,
    the_scene_of_the_manual_is_read,
    the_contact_modulus_follows_from_young_and_poisson,
    two_numbers_of_a_law_give_the_third,
    tapers_and_treatments_are_read,
    every_kind_of_surface_is_read,
    a_height_file_may_carry_the_grid,
    free_boundaries_take_any_wavelength_and_force_or_approach,
    ramps_end_where_they_say,
    a_mean_gap_below_zero_is_for_lennard_jones,
    outputs_are_read,
    inline_tables_and_dotted_keys_do_as_well,
    a_resolved_scene_is_the_same_scene,
    files_are_read_and_their_folder_is_kept,
    windows_line_ends_and_marks_are_harmless,
    deep_and_long_text_is_refused_in_short,
    powers_of_ten_that_run_out_are_refused,
    no_text_makes_the_reader_panic,
];
