//! Shipped scenes, spoiled at random: reading them and planning the run gives a scene or messages
//! whose lines are in the file; it never panics, never hangs, and never takes memory to speak of.
//!
//! The same of what a fuzzer found to reach something new (fuzz/README.md).
//!
//! `TABOR_MUTATIONS=20000 cargo test --release --test memory scene_mutations` tries more than the usual few.

#[path = "../../fuzz/reading.rs"]
mod reading;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use proptest::prelude::*;
use proptest::test_runner::{Config, TestRng, TestRunner};
use stats_alloc::Region;
use tabor::backend::long_field::MAPPED;
use tabor::scene::{Scene, SurfacePart};
use tabor::study::{Plan, Setup};
use tabor::surface::Surface;

use crate::ALLOCATOR;
use crate::shared::trials::tests;

/// Cases of a usual run.
const CASES: u32 = 1500;
/// Bytes that reading and planning may ask for in all: a path of a million steps takes most of them.
const MOST_BYTES: usize = 400 << 20;
/// Time for the same, on a machine that is busy with other things.
const MOST_TIME: Duration = Duration::from_secs(10);
/// Bytes of a run up to which its heights are built too.
const SMALL: u64 = 128 << 20;
/// Waves of a spectrum up to which they are built: beyond, summing them takes seconds by itself.
const FEW_WAVES: f64 = 1000.0;

/// Values that no author means, and those that one might.
const AWKWARD: &[&str] = &[
    "nan",
    "-nan",
    "inf",
    "-inf",
    "1e308",
    "-1e308",
    "1e-320",
    "0",
    "-0.0",
    "-1",
    "1",
    "2",
    "3",
    "7",
    "64",
    "1023",
    "16384",
    "65536",
    "65537",
    "1000000",
    "9223372036854775807",
    "-9223372036854775808",
    "99999999999999999999",
    "0x7fff",
    "1_000",
    "true",
    "false",
    "1979-05-27T07:32:00Z",
    "\"\"",
    "\" \"",
    "\"inf\"",
    "\"nan m\"",
    "\"1e999 um\"",
    "\"1 um\"",
    "\"-1 um\"",
    "\"1,5 um\"",
    "\"1 MPa\"",
    "\"1 N/m\"",
    "\"1 µm\"",
    "\"1 ym\"",
    "\"auto\"",
    "\"last\"",
    "\"file\"",
    "\"sphere\"",
    "\"self-affine\"",
    "\"free\"",
    "\"periodic\"",
    "\"force\"",
    "\"mean-gap\"",
    "\"approach\"",
    "\"dmt\"",
    "\"lennard-jones\"",
    "\"single\"",
    "\"gpu\"",
    "\"ground.txt\"",
    "\"rough.toml\"",
    "\".\"",
    "\"/dev/zero\"",
    "\"\\u0000\"",
    "\"日本語\"",
    "'''\n'''",
    "[]",
    "[[]]",
    "{}",
    "[1, 2]",
    "[1, 2, 3]",
    "[\"1 um\", \"2 um\"]",
    "[4096, 1]",
    "[1, 65536]",
    "{ a = 1 }",
    "[nan]",
    "[1e-9, \"1 um\"]",
    "[[1], [2]]",
    "=",
    "",
];

/// Lines that belong somewhere, put anywhere.
const LINES: &[&str] = &[
    "[grid]",
    "[solid]",
    "[[surface]]",
    "[surface]",
    "[adhesion]",
    "[loading]",
    "[[loading.ramp]]",
    "[solver]",
    "[output]",
    "[friction]",
    "points = 8",
    "size = 1e-6",
    "kind = \"flat\"",
    "spring = 1.0",
    "hold = \"1 s\"",
    "to = 0",
    "start = 0",
    "steps = 3",
    "path = [0]",
    "range = \"auto\"",
    "peak_tension = 1e6",
    "treatment = \"dmt\"",
    "taper = 0",
    "young_modulus = 1e9",
    "poisson_ratio = 0.5",
    "thickness = 1e-6",
    "seed = -1",
    "precision = \"single\"",
    "\u{feff}",
    "\u{0}",
    "= = =",
    "#",
];

/// One way to spoil a text.
#[derive(Clone, Debug)]
enum Change {
    Delete(usize),
    Duplicate(usize),
    Swap(usize, usize),
    /// Another value behind the equals sign of a line.
    Value(usize, usize),
    Insert(usize, usize),
    /// A line of another scene.
    Borrow(usize, usize, usize),
    Truncate(usize),
    /// A byte anywhere, text or not.
    Byte(usize, u8),
}

fn change() -> impl Strategy<Value = Change> {
    let place = any::<usize>;
    prop_oneof![
        1 => place().prop_map(Change::Delete),
        1 => place().prop_map(Change::Duplicate),
        1 => (place(), place()).prop_map(|(one, other)| Change::Swap(one, other)),
        // Most texts that are still TOML come from here.
        12 => (place(), place()).prop_map(|(line, value)| Change::Value(line, value)),
        1 => (place(), place()).prop_map(|(line, text)| Change::Insert(line, text)),
        1 => (place(), place(), place()).prop_map(|(to, scene, line)| Change::Borrow(to, scene, line)),
        1 => place().prop_map(Change::Truncate),
        1 => (place(), any::<u8>()).prop_map(|(at, byte)| Change::Byte(at, byte)),
    ]
}

fn apply(change: &Change, text: &mut Vec<u8>, scenes: &[(PathBuf, String)]) {
    let mut lines: Vec<Vec<u8>> = text
        .split(|byte| *byte == b'\n')
        .map(<[u8]>::to_vec)
        .collect();
    let count = lines.len();
    match change {
        Change::Delete(line) => drop(lines.remove(line % count)),
        Change::Duplicate(line) => lines.insert(line % count, lines[line % count].clone()),
        Change::Swap(one, other) => lines.swap(one % count, other % count),
        Change::Value(line, value) => {
            let line = &mut lines[line % count];
            if let Some(at) = line.iter().position(|byte| *byte == b'=') {
                line.truncate(at + 1);
                line.push(b' ');
                line.extend(AWKWARD[value % AWKWARD.len()].bytes());
            }
        }
        Change::Insert(line, text) => {
            lines.insert(line % count, LINES[text % LINES.len()].into());
        }
        Change::Borrow(to, scene, line) => {
            let other: Vec<&str> = scenes[scene % scenes.len()].1.lines().collect();
            lines.insert(to % count, other[line % other.len()].into());
        }
        Change::Truncate(at) => {
            text.truncate(at % (text.len() + 1));
            return;
        }
        Change::Byte(at, byte) => {
            if !text.is_empty() {
                let at = at % text.len();
                text[at] = *byte;
            }
            return;
        }
    }
    *text = lines.join(&b'\n');
}

fn shipped() -> Vec<(PathBuf, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/scenes");
    let mut scenes: Vec<(PathBuf, String)> = fs::read_dir(&folder)
        .expect("the scenes are there")
        .flatten()
        .map(|entry| entry.path())
        .filter(|path| {
            path.extension()
                .is_some_and(|extension| extension == "toml")
        })
        .map(|path| {
            let text = fs::read_to_string(&path).expect("a scene");
            (path, text)
        })
        .collect();
    scenes.sort();
    assert!(scenes.len() >= 7);
    scenes
}

/// Whether its heights are small enough to be built in each of many cases.
fn is_small(plan: &Plan) -> bool {
    let grid = plan.outline.grid;
    let few_waves = plan.scene.surfaces.iter().all(|part| match part {
        SurfacePart::SelfAffine(rough) => grid.lx.max(grid.ly) / rough.shortest < FEW_WAVES,
        _ => true,
    });
    let memory = plan.memory(plan.place()).expect("a count");
    few_waves && memory.machine < SMALL
}

/// What became of a spoiled scene.
#[derive(Debug, PartialEq)]
enum End {
    Refused,
    NoSurface,
    Planned,
    Built,
}

fn read_and_plan(bytes: &[u8], path: &Path) -> Result<End, TestCaseError> {
    let Ok(text) = std::str::from_utf8(bytes) else {
        // Scene::read says so before anything else; tests/command_line/mistakes has the message.
        return Ok(End::Refused);
    };
    let folder = path.parent().expect("a folder");
    let scene = match Scene::parse(text, "scene.toml", folder, &[]) {
        Ok(scene) => scene,
        Err(errors) => {
            let lines = text.split('\n').count();
            prop_assert!(!errors.0.is_empty());
            for mistake in &errors.0 {
                let line = mistake.line.unwrap_or(1);
                prop_assert!((1..=lines).contains(&line), "{mistake} of {lines} lines");
                let message = mistake.to_string();
                prop_assert!(message.len() < 1000 && !message.contains('\n'), "{message}");
            }
            return Ok(End::Refused);
        }
    };
    let Ok(plan) = Plan::for_scene(scene.clone()) else {
        return Ok(End::NoSurface);
    };
    if !is_small(&plan) {
        return Ok(End::Planned);
    }
    match Surface::build(&scene) {
        Ok(surface) => drop(Setup::new(scene, surface)),
        // Heights past the range of numbers are known once they are there.
        Err(error) => prop_assert!(error.to_string().contains("not finite"), "{error}"),
    }
    Ok(End::Built)
}

fn no_spoiled_scene_is_trouble() {
    let cases = std::env::var("TABOR_MUTATIONS").map_or(CASES, |text| {
        text.parse().expect("TABOR_MUTATIONS is a number of cases")
    });
    let scenes = shipped();
    let config = Config {
        cases,
        failure_persistence: None,
        ..Config::default()
    };
    // The same changes each time; more of them begin with the fewer.
    let numbers = TestRng::deterministic_rng(config.rng_algorithm);
    let mut runner = TestRunner::new_with_rng(config, numbers);
    let ends = std::cell::RefCell::new([0_u32; 4]);
    let strategy = (any::<usize>(), prop::collection::vec(change(), 1..4));
    let result = runner.run(&strategy, |(scene, changes)| {
        let (path, text) = &scenes[scene % scenes.len()];
        let mut bytes = text.clone().into_bytes();
        for change in &changes {
            apply(change, &mut bytes, &scenes);
        }
        let mapped = MAPPED.load(Ordering::Relaxed);
        let region = Region::new(ALLOCATOR);
        let clock = Instant::now();
        let end = read_and_plan(&bytes, path)?;
        let (time, change) = (clock.elapsed(), region.change());
        prop_assert!(
            time < MOST_TIME,
            "{time:?}:\n{}",
            String::from_utf8_lossy(&bytes)
        );
        if end != End::Built {
            let asked = change.bytes_allocated + MAPPED.load(Ordering::Relaxed) - mapped;
            prop_assert!(
                asked < MOST_BYTES,
                "{asked} bytes:\n{}",
                String::from_utf8_lossy(&bytes)
            );
        }
        ends.borrow_mut()[end as usize] += 1;
        Ok(())
    });
    let [refused, no_surface, planned, built] = ends.into_inner();
    println!("{refused} refused, {no_surface} without a surface, {planned} planned, {built} built");
    if let Err(error) = result {
        panic!("{error}");
    }
    // Every end is reached, or the test shows nothing. Few changes leave a scene that is read and has no surface.
    assert!(refused > 0 && planned > 0 && built > 0);
    let from_a_file = |(_, text): &&(PathBuf, String)| text.contains("\"ground.txt\"");
    let (path, text) = scenes
        .iter()
        .find(from_a_file)
        .expect("a scene with a file");
    let missing = text.replace("\"ground.txt\"", "\"missing.txt\"");
    let end = read_and_plan(missing.as_bytes(), path).expect("it is no trouble");
    assert_eq!(end, End::NoSurface);
}

fn the_corpus_of_the_fuzzer() {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let files = package.join("tests/files");
    let scratch = tempfile::tempdir().expect("a folder");
    type Reading = fn(&[u8], &Path);
    let targets: [(&str, Reading, &Path); 2] = [
        ("scene", reading::scene, &files),
        ("heights", reading::heights, scratch.path()),
    ];
    for (target, read, folder) in targets {
        let corpus = fs::read_dir(package.join("fuzz/corpus").join(target));
        let mut count = 0;
        for entry in corpus.expect("a corpus").flatten() {
            let bytes = fs::read(entry.path()).expect("an input");
            println!("{}", entry.path().display());
            let clock = Instant::now();
            read(&bytes, folder);
            assert!(clock.elapsed() < MOST_TIME, "{:?}", clock.elapsed());
            count += 1;
        }
        assert!(count > 100, "{target}: {count} inputs");
    }
}

tests![no_spoiled_scene_is_trouble, the_corpus_of_the_fuzzer,];
