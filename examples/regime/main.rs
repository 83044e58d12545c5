//! Trains the advice of `tabor fit --advise` and `tabor theory advise` on full fields.
//!
//! `cargo run --release --example regime solve` solves the fields of 300 spheres (smooth and rough, of three laws, Tabor
//! numbers 0.05 to 4) and `regime solve 1000 1036 1 FILE` those of other contacts, (500 560: those that are only judged), into `target/regime_fields.csv`: a quarter of an
//! hour on one core. `regime tabulate [FROM TO]` adds 100 contacts in closed form, measures each with noise and through springs,
//! fits the curves and writes `examples/regime/curves.csv`, a row a curve; as long again. `regime compare` tells how far the closed
//! form of stiff spheres lies from full fields. `regime train` trains both classifiers on that table, writes
//! `src/fit/advice/for_*.json` and `docs/pictures/advise.png`, and prints the tables of `docs/advise.md`.

mod closed;
mod measured;
mod problems;
mod random;
mod study;
mod table;
mod training;

use std::collections::BTreeMap;
use std::error::Error;
use std::f64::consts::TAU;
use std::fs;
use std::io::Write;
use std::path::Path;
use std::time::Instant;

use rayon::prelude::*;
use tabor::fit::advice::features::{CURVE_FEATURES, features};
use tabor::fit::{ForceCurve, Freedom, Model, fit_curve};

use measured::measure;
use problems::{ANEW, Closed, EVEN, FIELDS, Outside, PROBLEMS, Point, Problem};
use table::Row;
use training::{Design, Trained, rounded};

/// The first number of those outside the set.
const OUTSIDE_FROM: usize = 1000;
const OUTSIDE: usize = 36;
/// The fields, kept for the next table; not committed.
const CACHE: &str = "target/regime_fields.csv";
const TABLE: &str = "examples/regime/curves.csv";

fn problem(number: usize) -> Problem {
    let Some(outside) = number.checked_sub(OUTSIDE_FROM) else {
        return Problem::drawn(number);
    };
    // Smooth contacts, so that nothing but the new physics differs.
    let mut problem = Problem::drawn(outside * EVEN / OUTSIDE);
    let step = (outside / 3) as f64;
    problem.number = number;
    problem.rms_height = 0.0;
    problem.outside = Some(match outside % 3 {
        0 => Outside::Cone(60.0 + 2.0 * step),
        1 => Outside::Layer(0.3 + 0.1 * step),
        _ => Outside::Plastic(0.06 + 0.02 * step),
    });
    if outside % 3 == 2 {
        // A hardness needs a law without a repulsion of its own.
        problem.law = "maugis-dugdale";
    }
    problem
}

fn solve(from: usize, to: usize, step: usize, file: &str) -> Result<(), Box<dyn Error>> {
    let mut file = fs::File::create(file)?;
    for number in (from..to).step_by(step) {
        let problem = problem(number);
        let clock = Instant::now();
        let found = problem.solve();
        let shown = found.as_ref().map(Option::is_some);
        eprintln!(
            "{problem:?} {:.1} s {shown:?}",
            clock.elapsed().as_secs_f64()
        );
        if let Ok(Some(curve)) = found {
            for (approach, force) in curve {
                writeln!(file, "{number},{approach:.6e},{force:.6e}")?;
            }
        }
    }
    Ok(())
}

fn fields(text: &str) -> Result<BTreeMap<usize, Vec<Point>>, Box<dyn Error>> {
    let mut fields: BTreeMap<usize, Vec<Point>> = BTreeMap::new();
    for line in text.lines() {
        let cells: Vec<&str> = line.split(',').collect();
        let [number, approach, force] = cells[..] else {
            return Err(line.into());
        };
        let point = (approach.parse()?, force.parse()?);
        fields.entry(number.parse()?).or_default().push(point);
    }
    Ok(fields)
}

fn row(number: usize, field: &[Point], copy: usize) -> Option<Row> {
    let problem = problem(number);
    let measurement = measure(&problem, field, copy);
    let curve = ForceCurve {
        samples: measurement.samples,
        ..ForceCurve::default()
    };
    let freedom = Freedom {
        approach_offset: true,
        force_offset: measurement.baseline,
        baseline_slope: false,
        range: None,
    };
    let result = fit_curve(&curve, Path::new("curve"), 1.0, freedom).ok()?;
    let features = features(&result)?;
    let error = |model: Model| {
        let found = result.fit_of(model).map(|fit| fit.parameters);
        let found = found.unwrap_or_default();
        [
            found.work_of_adhesion / problem.work() - 1.0,
            found.contact_modulus / problem.modulus() - 1.0,
        ]
    };
    let [_, hertz] = error(Model::Hertz);
    let [dmt, jkr, general] = [Model::Dmt, Model::Jkr, Model::MaugisDugdale].map(error);
    let kind = match problem.outside {
        None => match problem.closed {
            None if number >= ANEW => "anew",
            None => "sphere",
            Some(Closed::Stiff) => "stiff",
            Some(Closed::Dmt | Closed::Jkr) => "limit",
        },
        Some(Outside::Cone(_)) => "cone",
        Some(Outside::Layer(_)) => "layer",
        Some(Outside::Plastic(_)) => "plastic",
    };
    let chosen = if result.describes_curve {
        result.best().model.name()
    } else {
        "none"
    };
    Some(Row {
        problem: number,
        kind: kind.to_owned(),
        law: problem.law.to_owned(),
        tabor: match problem.closed {
            Some(Closed::Dmt) => 0.0,
            Some(Closed::Jkr) => f64::INFINITY,
            _ => problem.tabor,
        },
        rms_height: problem.rms_height,
        load: problem.load,
        noise: measurement.noise,
        spring: measurement.spring,
        features: features.to_vec(),
        errors: [
            hertz, dmt[0], dmt[1], jkr[0], jkr[1], general[0], general[1],
        ],
        chosen: chosen.to_owned(),
    })
}

/// Measures and fits the fields of the problems from one number to another; other rows of the table stay.
fn tabulate(from: usize, to: usize) -> Result<(), Box<dyn Error>> {
    let mut fields = fields(&fs::read_to_string(CACHE)?)?;
    for number in FIELDS..PROBLEMS {
        let problem = problem(number);
        if let Some(closed) = problem.closed {
            fields.insert(number, closed::curve(&problem, closed)?);
        }
    }
    fields.retain(|number, _| (from..to).contains(number));
    let kept = fs::read_to_string(TABLE).unwrap_or_default();
    let mut table = if kept.is_empty() {
        Vec::new()
    } else {
        table::read(&kept)?
    };
    table.retain(|row| !(from..to).contains(&row.problem));
    let jobs: Vec<(usize, usize)> = fields
        .keys()
        .flat_map(|number| {
            let copies: &[usize] = if *number < OUTSIDE_FROM {
                &[0, 1, 2, 3, 4]
            } else {
                &[0, 2]
            };
            copies.iter().map(|copy| (*number, *copy))
        })
        .collect();
    let rows: Vec<Option<Row>> = jobs
        .par_iter()
        .map(|(number, copy)| row(*number, &fields[number], *copy))
        .collect();
    let failed = rows.iter().filter(|row| row.is_none()).count();
    eprintln!(
        "{} curves, {failed} without a fit; {} features",
        rows.len(),
        CURVE_FEATURES.len()
    );
    table.extend(rows.into_iter().flatten());
    table.sort_by_key(|row| row.problem);
    let lines: String = table.iter().map(Row::line).collect();
    fs::write(TABLE, table::head() + &lines)?;
    Ok(())
}

/// Trains on the table; the docs' tables go to standard output.
fn train() -> Result<(), Box<dyn Error>> {
    let table = table::read(&fs::read_to_string(TABLE)?)?;
    let mut trained = Vec::new();
    for (design, file) in [
        (Design::for_curves(), "src/fit/advice/for_curves.json"),
        (Design::for_numbers(), "src/fit/advice/for_numbers.json"),
    ] {
        let rows = table
            .iter()
            .filter(|row| row.is_of_sphere() && !row.is_held_out());
        let Trained { classifier, loss } = design.train(&design.cases(rows));
        let classifier = rounded(&classifier)?;
        println!(
            "{file}: penalty {}, temperature {:.2}, log loss {loss:.3} in cross-validation",
            classifier.penalty, classifier.temperature
        );
        fs::write(file, serde_json::to_string(&classifier)? + "\n")?;
        trained.push(classifier);
    }
    println!("{}", study::report(&table, &trained[0], &trained[1]));
    study::draw(&table, &trained[0], &trained[1])
}

/// How far the closed form of stiff spheres lies from full fields of that law.
fn compare() -> Result<(), Box<dyn Error>> {
    println!("number,tabor,load,greatest_difference_over_load,greatest_difference_over_2_pi_w_R");
    for (number, field) in fields(&fs::read_to_string(CACHE)?)? {
        let problem = problem(number);
        let smooth = problem.rms_height == 0.0 && problem.outside.is_none();
        if problem.law != "maugis-dugdale" || problem.tabor > 0.12 || !smooth {
            continue;
        }
        let approaches: Vec<f64> = field.iter().map(|(approach, _)| *approach).collect();
        let closed = closed::maugis(&problem, &approaches)?;
        let differences = field.iter().zip(&closed);
        let differences = differences.map(|((_, force), closed)| (force - closed).abs() / TAU);
        let greatest = differences.fold(0.0, f64::max);
        println!(
            "{number},{:.3},{:.1},{:.4},{greatest:.4}",
            problem.tabor,
            problem.load,
            greatest / problem.load
        );
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let parse = |i: usize| arguments.get(i).and_then(|text| text.parse::<usize>().ok());
    match arguments.first().map(String::as_str) {
        Some("solve") => solve(
            parse(1).unwrap_or(0),
            parse(2).unwrap_or(FIELDS),
            parse(3).unwrap_or(1),
            arguments.get(4).map_or(CACHE, String::as_str),
        ),
        Some("train") => train(),
        Some("compare") => compare(),
        _ => tabulate(parse(1).unwrap_or(0), parse(2).unwrap_or(usize::MAX)),
    }
}
