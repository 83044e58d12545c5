//! Each model with arguments that no author means: an answer or a refusal, never a panic, never a result
//! that is no number, never a long silence.
//!
//! `TABOR_MUTATIONS=100000 cargo test --release --lib hostile` tries more than the usual few. The cases
//! are the same in every run, more of them begin with the fewer.

use std::cell::Cell;
use std::time::Duration;

use proptest::prelude::*;

use super::super::busy::{Clock, cases};
use super::catalogue::{MODELS, Model};
use super::parameters::{Allowed, Kind, Need, Parameter};
use super::text;

/// Cases of a usual run.
const CASES: u32 = 4000;
/// Processor time for one.
const MOST_TIME: Duration = Duration::from_secs(10);
/// Share of the calls that take a second which are tried.
const SOLVED: f64 = 0.02;
/// More parameters than any model has.
const MOST_PARAMETERS: usize = 20;

/// Numbers at the ends of what is allowed, and past them.
const EDGES: &[&str] = &[
    "1e-30",
    "1e30",
    "-1e30",
    "-1e-30",
    "1e-15",
    "1e15",
    "0",
    "-0.0",
    "1",
    "0.5",
    "0.999999999999",
    "1e-9",
    "89.999999",
    "-29.99",
];
const REFUSED: &[&str] = &[
    "1e308",
    "1e-308",
    "-1e308",
    "5e-324",
    "1e999",
    "nan",
    "inf",
    "1e31",
    "1e-31",
    "",
    "18446744073709551615",
];

/// What is said for one parameter.
#[derive(Clone, Debug)]
struct Pick {
    /// Decides whether it is given.
    given: f64,
    /// Decides which number it is.
    kind: f64,
    /// Which of a list, and whether a number is negative.
    which: usize,
    /// Decimal logarithm near those of surfaces, and one of any number.
    near: f64,
    far: f64,
    share: f64,
}

fn pick() -> impl Strategy<Value = Pick> {
    let share = || 0.0..1.0_f64;
    (
        share(),
        share(),
        any::<usize>(),
        -12.0..12.0_f64,
        -30.0..30.0_f64,
        share(),
    )
        .prop_map(|(given, kind, which, near, far, share)| Pick {
            given,
            kind,
            which,
            near,
            far,
            share,
        })
}

/// A value of the kind that a parameter takes, or nearly.
fn value(kind: Kind, pick: &Pick) -> String {
    let one_of = |list: &[&str]| list[pick.which % list.len()].to_owned();
    let allowed = match kind {
        Kind::Word(words) if pick.kind < 0.98 => return one_of(words),
        Kind::Word(_) => return "soft".to_owned(),
        Kind::Count if pick.kind < 0.98 => return format!("{}", 2 + pick.which % 8),
        Kind::Count => return one_of(REFUSED),
        Kind::Quantity(_, allowed) => allowed,
    };
    let magnitude = match pick.kind {
        kind if kind < 0.5 => 10.0_f64.powf(pick.near),
        kind if kind < 0.75 => 10.0_f64.powf(pick.far),
        kind if kind < 0.97 => return one_of(EDGES),
        _ => return one_of(REFUSED),
    };
    let number = match allowed {
        Allowed::Any if pick.which.is_multiple_of(2) => -magnitude,
        Allowed::NotPositive => -magnitude,
        Allowed::Inside(low, high) => {
            let inside = low + pick.share * (high - low);
            // An angle is written in degrees.
            if high > 1.0 {
                inside.to_degrees()
            } else {
                inside
            }
        }
        Allowed::Share | Allowed::BelowOne => pick.share,
        _ => magnitude,
    };
    format!("{number:?}")
}

fn is_given(parameter: &Parameter, pick: &Pick, given: &[&str]) -> bool {
    match parameter.need {
        Need::Required => pick.given < 0.99,
        Need::Default(_) | Need::Chosen(_) => pick.given < 0.4,
        Need::Either(other) => {
            !given.contains(&other) && (pick.given < 0.5 || parameter.name > other)
        }
        Need::With(other) => given.contains(&other) || pick.given < 0.4,
    }
}

fn words(model: &Model, picks: &[Pick]) -> Vec<String> {
    let mut words = vec![model.name.to_owned()];
    let mut given: Vec<&str> = Vec::new();
    for (parameter, pick) in model.parameters().zip(picks) {
        if is_given(parameter, pick, &given) {
            given.push(parameter.name);
            words.push(format!(
                "--{}={}",
                parameter.name,
                value(parameter.kind, pick)
            ));
        }
    }
    // Many rows of a model take time that has nothing to do with the numbers.
    if !given.contains(&"points") && model.parameters().any(|p| p.name == "points") {
        words.push("--points=5".to_owned());
    }
    words
}

/// Whether a call is a sphere under Lennard-Jones within its range, which takes a second to solve and, at a
/// Tabor number of 5, a hundred.
fn is_solved(call: &[String], most: f64) -> bool {
    let number = |name: &str| {
        let of = |word: &String| word.strip_prefix(name)?.strip_prefix('=')?.parse().ok();
        call.iter().find_map(of).unwrap_or(f64::NAN)
    };
    let [radius, modulus, work, range] = [
        "--radius",
        "--contact_modulus",
        "--work_of_adhesion",
        "--range",
    ]
    .map(number);
    let tabor = (radius * (work / modulus).powi(2) / range.powi(3)).cbrt();
    call[0] == "lennard-jones-sphere" && (0.009..most).contains(&tabor)
}

/// Whether a text has a word that stands for what is no number.
fn is_no_number(text: &str) -> bool {
    let words = text.split(|c: char| !c.is_alphanumeric());
    words.into_iter().any(|word| word == "NaN" || word == "inf")
}

#[test]
fn no_hostile_argument_of_a_theory_is_trouble() {
    let (cases, mut runner) = cases(CASES);
    let [answered, refused, empty] = [const { Cell::new(0_u32) }; 3];
    let slowest = Cell::new(Duration::ZERO);
    let strategy = (
        0..MODELS.len(),
        prop::collection::vec(pick(), MOST_PARAMETERS..=MOST_PARAMETERS),
    );
    let result = runner.run(&strategy, |(model, picks)| {
        let call = words(&MODELS[model], &picks);
        if is_solved(&call, 5.1) && !(is_solved(&call, 1.0) && picks[0].share < SOLVED) {
            return Ok(());
        }
        let clock = Clock::start();
        match text(&call) {
            Ok(table) => {
                prop_assert!(!is_no_number(&table), "{call:?}:\n{table}");
                let rows = table.lines().filter(|line| !line.starts_with('#')).skip(1);
                let cells = rows.flat_map(|row| row.split(','));
                empty.set(empty.get() + u32::from(cells.clone().any(str::is_empty)));
                for cell in cells {
                    let number = cell.parse::<f64>().unwrap_or(0.0);
                    prop_assert!(number.is_finite(), "{call:?}:\n{table}");
                }
                answered.set(answered.get() + 1);
            }
            Err(failure) => {
                let status = failure.status();
                prop_assert!(status == 2 || status == 3, "{call:?}: {failure}");
                refused.set(refused.get() + 1);
            }
        }
        let time = clock.elapsed();
        prop_assert!(time < MOST_TIME, "{call:?}: {time:?}");
        slowest.set(slowest.get().max(time));
        Ok(())
    });
    let [answered, refused, empty] = [answered, refused, empty].map(Cell::into_inner);
    println!(
        "{answered} answered, {empty} of them with an empty cell; {refused} refused; the slowest took {:?}",
        slowest.get()
    );
    if let Err(error) = result {
        panic!("{error}");
    }
    // Both ends are reached often, or the test shows nothing.
    assert!(answered > cases / 10 && refused > cases / 10);
}

/// What trials found: a table read past its end, and sums that never came to one.
#[test]
fn what_was_found_is_answered() {
    for call in [
        "persson --hurst 0.8 --rms_slope 0.1 --rolloff 1e-6 --shortest 1e-8 --contact_modulus 1e9 --to 1e30",
        "gw --radius 1e-5 --density 1e12 --rms_height 1e-30 --contact_modulus 1e9 --to 1e30",
        "gw-m --radius 1e-5 --density 1e12 --rms_height 1e-9 --contact_modulus 1e9 --work_of_adhesion 0.1 --from 1e30",
    ] {
        let call: Vec<String> = call.split(' ').map(str::to_owned).collect();
        let clock = Clock::start();
        match text(&call) {
            Ok(table) => assert!(!is_no_number(&table), "{call:?}:\n{table}"),
            Err(failure) => assert_eq!(failure.status(), 2, "{call:?}: {failure}"),
        }
        assert!(clock.elapsed() < MOST_TIME, "{call:?}");
    }
    let call = [
        "jkr",
        "--radius",
        "1e31",
        "--contact_modulus",
        "1e9",
        "--work_of_adhesion",
        "0.1",
    ];
    let message = text(&call.map(str::to_owned))
        .expect_err("out of range")
        .to_string();
    assert_eq!(
        message,
        "--radius \"1e31\" is out of range: it must be 0 or between 1e-30 and 1e30 in SI units; check the powers of ten"
    );
}
