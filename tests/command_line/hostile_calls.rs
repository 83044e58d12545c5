//! `fit`, `compare` and `accuracy` with curves and scenes that no author means: an answer or a refusal, never a
//! panic, never a result that is not a number, never a long silence.
//!
//! `TABOR_MUTATIONS=100000 cargo test --release --test command_line hostile_calls` tries more than the usual few. The cases
//! are the same in every run, more of them begin with the fewer. Those in this process take no time to start: of
//! them more are tried.

#[path = "../../fuzz/calls.rs"]
mod calls;

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use cpu_time::ProcessTime;

use crate::shared::binary::{command, errors, status, without_adapter};
use crate::shared::random::Random;
use crate::shared::trials::tests;

/// A call that takes longer has said that it is at work.
const SILENCE: Duration = Duration::from_secs(10);

/// Cases of a usual run, unless the environment asks for others.
fn cases(usual: u64) -> u64 {
    std::env::var("TABOR_MUTATIONS").map_or(usual, |text| {
        text.parse().expect("TABOR_MUTATIONS is a number of cases")
    })
}

/// A positive number about a usual one; of any magnitude in a tenth of the cases.
fn about(random: &mut Random, usual: f64) -> f64 {
    let (decades, from) = match random.share() {
        share if share < 0.1 => (35.0, 1.0),
        share if share < 0.4 => (4.0, usual),
        _ => (0.5, usual),
    };
    from * 10f64.powf(decades * (2.0 * random.share() - 1.0))
}

/// Calls tabor in a folder and judges the call. Returns whether it answered.
fn call(name: &str, folder: &Path, arguments: &[&str]) -> bool {
    let clock = Instant::now();
    let mut command = command(folder, arguments);
    let output = without_adapter(&mut command).output().expect("it runs");
    let said = errors(&output);
    let context = format!("{name}: {arguments:?}: {said}");
    assert!([0, 2, 3].contains(&status(&output)), "{context}");
    assert!(!said.contains("panicked"), "{context}");
    let spoke = said.contains("at work") || said.contains("note:");
    assert!(clock.elapsed() < SILENCE || spoke, "silent: {context}");
    let mut texts = vec![String::from_utf8_lossy(&output.stdout).into_owned()];
    if status(&output) == 0 {
        texts.push(said);
        for entry in fs::read_dir(folder.join("out")).into_iter().flatten() {
            let path = entry.expect("an entry").path();
            let kind = path.extension().and_then(|kind| kind.to_str());
            if kind.is_some_and(|kind| ["csv", "json"].contains(&kind)) {
                texts.push(fs::read_to_string(&path).expect("text"));
            }
        }
    }
    for text in &texts {
        let number = |word: &str| ["nan", "inf", "-inf"].contains(&word.to_lowercase().as_str());
        let words = text.split(|letter: char| !letter.is_alphanumeric() && letter != '-');
        let wrong: Vec<&str> = words.filter(|word| number(word)).collect();
        assert!(wrong.is_empty(), "{context}\n{text}");
    }
    status(&output) == 0
}

/// A force curve: contact with or without adhesion, noise, a line, or any numbers.
fn curve(random: &mut Random) -> String {
    let rows = random.one_of(&[3, 8, 30, 80]);
    let (length, force) = (about(random, 1e-7), about(random, 1e-8));
    let shape = random.one_of(&[0, 0, 1, 2, 3, 4]);
    let noise = random.one_of(&[0.0, 0.01, 0.3]);
    let mut text = String::from("approach,force\n");
    for i in 0..rows {
        let x = 2.0 * i as f64 / rows as f64 - 1.0;
        let mut y = match shape {
            0 => x.max(0.0).powf(1.5) - f64::from(u8::from(x > 0.0)) * 0.3,
            1 => x.max(0.0).powf(1.5),
            2 => -x,
            3 => 2.0 * random.share() - 1.0,
            _ => about(random, 1.0),
        };
        y += noise * (2.0 * random.share() - 1.0);
        text += &format!("{:e},{:e}\n", length * x, force * y);
    }
    text
}

fn no_hostile_curve_is_trouble() {
    let mut answered = 0;
    for case in 0..cases(24) {
        let mut random = Random(case);
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join("curve.csv"), curve(&mut random)).expect("written");
        let radius = format!("{:e}", about(&mut random, 1e-6));
        let mut arguments = vec!["fit", "curve.csv", "--radius", &radius, "--out", "out"];
        if random.share() < 0.3 {
            arguments.push("--baseline");
        }
        answered += u64::from(call(&format!("case {case}"), folder.path(), &arguments));
    }
    println!("{answered} of {} curves fitted", cases(24));
    assert!(answered > 0);
}

/// Bytes of a curve, and of what is asked of it, of which some are spoiled.
fn spoiled(random: &mut Random) -> Vec<u8> {
    let text = curve(random);
    let mut bytes = vec![
        (256.0 * random.share()) as u8,
        (256.0 * random.share()) as u8,
    ];
    bytes.extend(text.bytes());
    if random.share() < 0.3 {
        for _ in 0..1 + (4.0 * random.share()) as usize {
            let place = (bytes.len() as f64 * random.share()) as usize;
            bytes[place] = random.one_of(b"0123456789eE+-.,;\t \n\"nai\0\xff");
        }
    }
    bytes
}

/// Runs cases in this process, each within the time that a call may be silent. What the processor spends counts:
/// a machine with other work to do makes no call slow.
fn in_process(name: &str, usual: u64, each: &dyn Fn(u64) -> bool) {
    let (mut answered, mut slowest) = (0, Duration::ZERO);
    for case in 0..cases(usual) {
        let clock = ProcessTime::now();
        answered += u64::from(each(case));
        let spent = clock.elapsed();
        slowest = slowest.max(spent);
        assert!(spent < SILENCE, "{name}, case {case} is silent");
    }
    println!(
        "{name}: {answered} of {} answered, the slowest took {slowest:?}",
        cases(usual)
    );
    assert!(answered > 0);
}

fn no_hostile_curve_is_trouble_in_this_process() {
    let folder = tempfile::tempdir().expect("a folder");
    in_process("fit", 100, &|case| {
        calls::curve(&spoiled(&mut Random(1 << 32 | case)), folder.path())
    });
}

fn no_hostile_scene_is_trouble_to_compare_in_this_process() {
    let folder = tempfile::tempdir().expect("a folder");
    in_process("compare", 12, &|case| {
        let text = scene(&mut Random(1 << 32 | case));
        calls::compare(text.as_bytes(), folder.path())
    });
}

/// A rough surface that sticks, with numbers about usual ones and far off them.
fn scene(random: &mut Random) -> String {
    let points = random.one_of(&[4, 8, 15, 16, 32]);
    let size = about(random, 1e-5);
    let wave = |share: f64| size * share;
    let shortest = wave(random.one_of(&[0.5, 0.25, 0.13]));
    let (modulus, pressure) = (about(random, 1e8), about(random, 1e6));
    let law = random.one_of(&["maugis-dugdale", "exponential", "lennard-jones"]);
    let control = random.one_of(&["pressure", "pressure", "mean-gap", "force"]);
    format!(
        "[grid]\npoints = {points}\nsize = {size:e}\n[solid]\ncontact_modulus = {modulus:e}\n[[surface]]\nkind = \"self-affine\"\nhurst = {}\nrms_slope = {:e}\nlongest = {size:e}\nrolloff = {:e}\nshortest = {shortest:e}\n[adhesion]\nlaw = \"{law}\"\nwork_of_adhesion = {:e}\nrange = {:e}\n[loading]\ncontrol = \"{control}\"\npath = [{pressure:e}, {:e}]\n[solver]\nmax_iterations = 300\nbackend = \"cpu\"\n",
        random.one_of(&[0.1, 0.8, 1.0]),
        about(random, 0.1),
        wave(0.5),
        about(random, 0.05),
        about(random, 1e-9),
        about(random, 1e6) * random.one_of(&[1.0, -1.0]),
    )
}

fn try_scenes(usual: u64, of: &[&str]) {
    let mut answered = 0;
    for case in 0..cases(usual) {
        let folder = tempfile::tempdir().expect("a folder");
        let text = scene(&mut Random(case));
        fs::write(folder.path().join("scene.toml"), &text).expect("written");
        let arguments = [&of[..1], &["scene.toml", "--out", "out"], &of[1..]].concat();
        let name = format!("case {case}\n{text}");
        answered += u64::from(call(&name, folder.path(), &arguments));
    }
    println!("{}: {answered} of {} answered", of[0], cases(usual));
    assert!(answered > 0);
}

fn no_hostile_scene_is_trouble_to_compare() {
    try_scenes(12, &["compare"]);
}

/// The words that the fuzz target takes are those of a shell, a line each.
fn words_of_a_call_of_theory_are_lines() {
    assert!(calls::theory(
        b"hertz\n--radius\n1 um\n--contact_modulus\n1 GPa"
    ));
    assert!(!calls::theory(b"hertz\n--radius\n1 Pa"));
    assert!(!calls::theory(b"\xff"));
}

fn no_hostile_scene_is_trouble_to_accuracy() {
    try_scenes(8, &["accuracy", "--budget", "1 s"]);
}

tests![
    no_hostile_curve_is_trouble,
    no_hostile_curve_is_trouble_in_this_process,
    no_hostile_scene_is_trouble_to_compare,
    no_hostile_scene_is_trouble_to_compare_in_this_process,
    no_hostile_scene_is_trouble_to_accuracy,
    words_of_a_call_of_theory_are_lines,
];
