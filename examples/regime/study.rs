//! The tables and the picture of `docs/advise.md`.

use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;

use tabor::fit::advice::classifier::Classifier;
use tabor::fit::advice::numbers::Numbers;
use tabor::output::plot::{Axis, DISTINCT, Figure, Panel, PlotPoint, Series};
use tabor::theory::tabor_map::{Regime, regime};

use super::table::{CLASSES, Row, SEEN};
use super::training::{Case, Design, Score, answers, likeliest, score};

/// Tabor numbers at which thresholds of the baseline are tried, evenly in the logarithm.
const TRIED: usize = 40;
const TABORS: (f64, f64) = (0.05, 4.0);

/// The class that a rule names for a row.
type Rule = Box<dyn Fn(&Row) -> usize>;

/// Probabilities of a rule that names one class.
fn certain(class: usize) -> Vec<f64> {
    (0..CLASSES.len())
        .map(|at| if at == class { 1.0 } else { 0.0 })
        .collect()
}

/// Hertz where noise hides the adhesion, else by two thresholds on the true Tabor number.
fn by_thresholds(row: &Row, [low, high]: [f64; 2]) -> usize {
    if row.law == "none" || row.noise * SEEN > 1.0 {
        0
    } else if row.tabor < low {
        1
    } else if row.tabor < high {
        3
    } else {
        2
    }
}

/// The baselines: a name, and the answer to each row.
fn baselines(train: &[&Row]) -> Vec<(String, Rule)> {
    let at = |step: usize| TABORS.0 * (TABORS.1 / TABORS.0).powf(step as f64 / (TRIED - 1) as f64);
    let right = |thresholds: [f64; 2]| {
        train
            .iter()
            .filter(|row| by_thresholds(row, thresholds) == row.suits())
            .count()
    };
    let pairs = (0..TRIED).flat_map(|low| (low..TRIED).map(move |high| [at(low), at(high)]));
    let best = pairs.max_by_key(|pair| right(*pair)).unwrap_or([0.24, 5.0]);
    let book = |row: &Row| match regime(row.tabor.max(1e-3)) {
        Ok(Regime::ForceDmt) => 1,
        Ok(Regime::Jkr) => 2,
        _ => 3,
    };
    vec![
        ("the likeliest class".to_owned(), Box::new(|_: &Row| 4)),
        (
            "true Tabor number, thresholds 0.24 and 5".to_owned(),
            Box::new(move |row: &Row| {
                if by_thresholds(row, [1.0; 2]) == 0 {
                    0
                } else {
                    book(row)
                }
            }),
        ),
        (
            format!(
                "true Tabor number, best thresholds ({:.2} and {:.2})",
                best[0], best[1]
            ),
            Box::new(move |row: &Row| by_thresholds(row, best)),
        ),
        (
            "choice of `tabor fit` (fitted Tabor number, residuals)".to_owned(),
            Box::new(|row: &Row| {
                CLASSES
                    .iter()
                    .position(|name| *name == row.chosen)
                    .unwrap_or(4)
            }),
        ),
    ]
}

/// What is written for one row of the comparison.
fn compared(name: &str, score: &Score, probable: bool) -> String {
    if probable {
        format!(
            "| {name} | {:.0} % | {:.2} | {:.3} |\n",
            100.0 * score.accuracy,
            score.log_loss,
            score.calibration_error
        )
    } else {
        format!("| {name} | {:.0} % | | |\n", 100.0 * score.accuracy)
    }
}

/// The tables, on the curves held out.
pub fn report(table: &[Row], curves: &Classifier, numbers: &Classifier) -> String {
    let rows_of = |kinds: &[&str], held_out: bool| -> Vec<&Row> {
        let wanted =
            |row: &&Row| kinds.contains(&row.kind.as_str()) && row.is_held_out() == held_out;
        table.iter().filter(wanted).collect()
    };
    let train = rows_of(&["sphere", "stiff", "limit"], false);
    let held = rows_of(&["sphere"], true);
    let others = [
        ("fields solved anew", rows_of(&["anew"], true)),
        ("stiff spheres", rows_of(&["stiff"], true)),
        ("DMT and JKR themselves", rows_of(&["limit"], true)),
    ];
    let mut text = format!(
        "{} curves in training, {} of full fields held out\n\n",
        train.len(),
        held.len(),
    );
    text += "| class | in training | held out | fields solved anew | stiff spheres held out | DMT and JKR themselves, held out |\n|---|---|---|---|---|---|\n";
    for (class, name) in CLASSES.iter().enumerate() {
        let count = |rows: &[&Row]| rows.iter().filter(|row| row.suits() == class).count();
        let _ = write!(text, "| {name} | {} | {} |", count(&train), count(&held));
        for (_, rows) in &others {
            let _ = write!(text, " {} |", count(rows));
        }
        text += "\n";
    }
    text += "\n| on curves of full fields held out | right | log loss | calibration error |\n|---|---|---|---|\n";
    let attracted: Vec<&Row> = held
        .iter()
        .copied()
        .filter(|row| row.law != "none")
        .collect();
    let design = Design::for_curves();
    let cases = design.cases(held.iter().copied());
    let curve_score = score(&answers(curves, &cases));
    text += &compared("`tabor fit --advise`", &curve_score, true);
    for (name, rows) in &others {
        let own = score(&answers(curves, &design.cases(rows.iter().copied())));
        text += &compared(&format!("the same, {name}"), &own, true);
    }
    let known = Design::for_numbers().cases(held.iter().copied());
    let number_score = score(&answers(numbers, &known));
    for (name, rule) in baselines(&train) {
        let judged: Vec<(usize, Vec<f64>)> = held
            .iter()
            .map(|row| (row.suits(), certain(rule(row))))
            .collect();
        text += &compared(&name, &score(&judged), false);
    }
    text += "| of these with attraction: | | | |\n";
    let fits = design.cases(attracted.iter().copied());
    text += &compared(
        "`tabor fit --advise`",
        &score(&answers(curves, &fits)),
        true,
    );
    text += &compared("`tabor theory advise`", &number_score, true);
    let anew = Design::for_numbers().cases(others[0].1.iter().copied());
    let anew = score(&answers(numbers, &anew));
    text += &compared("`tabor theory advise`, fields solved anew", &anew, true);
    for (name, rule) in baselines(&train) {
        let judged: Vec<(usize, Vec<f64>)> = attracted
            .iter()
            .map(|row| (row.suits(), certain(rule(row))))
            .collect();
        text += &compared(&name, &score(&judged), false);
    }
    for (name, score) in [
        ("`tabor fit --advise`", &curve_score),
        ("`tabor theory advise`", &number_score),
    ] {
        let _ = write!(
            text,
            "\n{name}\n\n| suits \\ advised | {} |\n",
            CLASSES.join(" | ")
        );
        text += &"|---".repeat(CLASSES.len() + 1);
        text += "|\n";
        for (class, row) in CLASSES.iter().zip(&score.confusion) {
            let cells: Vec<String> = row.iter().map(usize::to_string).collect();
            let _ = writeln!(text, "| {class} | {} |", cells.join(" | "));
        }
        text += "\n| stated | curves | right |\n|---|---|---|\n";
        for (count, stated, right) in &score.reliability {
            let _ = writeln!(
                text,
                "| {:.0} % | {count} | {:.0} % |",
                100.0 * stated,
                100.0 * right
            );
        }
    }
    text + "\n" + &outside(table, curves, &cases)
}

/// How often curves of other contacts are told to be none of these.
fn outside(table: &[Row], curves: &Classifier, held: &[Case]) -> String {
    let is_outside = |case: &Case| curves.distance(&case.features) > 1.0;
    let mut text = String::from("| curves | | outside | none of these |\n|---|---|---|---|\n");
    let mut line = |name: &str, cases: &[Case]| {
        let out = cases.iter().filter(|case| is_outside(case)).count();
        let none = cases.iter().filter(|case| {
            is_outside(case)
                || likeliest(&curves.probabilities(&case.features)) == CLASSES.len() - 1
        });
        let _ = writeln!(
            text,
            "| {name} | {} | {out} | {} |",
            cases.len(),
            none.count()
        );
    };
    line("spheres held out", held);
    for kind in ["anew", "stiff", "limit"] {
        let rows = table
            .iter()
            .filter(|row| row.kind == kind && row.is_held_out());
        line(kind, &Design::for_curves().cases(rows));
    }
    for kind in ["cone", "layer", "plastic"] {
        let rows = table.iter().filter(|row| row.kind == kind);
        line(kind, &Design::for_curves().cases(rows));
    }
    text
}

/// Probabilities against Tabor number and roughness, and how true they are.
pub fn draw(
    table: &[Row],
    curves: &Classifier,
    numbers: &Classifier,
) -> Result<(), Box<dyn Error>> {
    const POINTS: usize = 80;
    let share = |at: usize| at as f64 / (POINTS - 1) as f64;
    let lines = |place: &dyn Fn(usize) -> (f64, Numbers)| -> Vec<Series> {
        let each = 0..CLASSES.len();
        each.map(|class| {
            let points = (0..POINTS).map(|at| {
                let (x, numbers_here) = place(at);
                let features = numbers_here.features().map(Some);
                PlotPoint::new(x, numbers.probabilities(&features)[class])
            });
            Series::line(class, points.collect())
        })
        .collect()
    };
    let smooth = Numbers {
        tabor: 1.0,
        rms_height: 0.0,
        noise: 0.01,
        load: 5.0,
    };
    let by_tabor = lines(&|at| {
        let tabor = TABORS.0 * (TABORS.1 / TABORS.0).powf(share(at));
        (tabor, Numbers { tabor, ..smooth })
    });
    let by_roughness = lines(&|at| {
        let rms_height = 0.01 * 200.0_f64.powf(share(at));
        (
            rms_height,
            Numbers {
                rms_height,
                ..smooth
            },
        )
    });
    let held = table
        .iter()
        .filter(|row| row.kind == "sphere" && row.is_held_out());
    let cases = Design::for_curves().cases(held);
    let reliability = score(&answers(curves, &cases)).reliability;
    let points = reliability
        .iter()
        .map(|(_, stated, right)| PlotPoint::new(*stated, *right));
    let ideal = [0.2, 1.0].map(|share| PlotPoint::new(share, share));
    let panel = |title: &str, x: Axis, series| Panel {
        title: title.to_owned(),
        x,
        y: Axis::linear(title, ""),
        series,
    };
    let mut names: Vec<String> = CLASSES.map(str::to_owned).to_vec();
    names.extend(["curves held out", "right as often as stated"].map(str::to_owned));
    let figure = Figure {
        title: "Which model gives w and E* within 15 %".to_owned(),
        note: "noise 1 % of 2 pi w R, load 5 times it; a smooth sphere (left), Tabor number 1 (middle)".to_owned(),
        names,
        pens: DISTINCT,
        panels: vec![
            panel("probability", Axis::logarithmic("Tabor number", ""), by_tabor),
            panel("probability", Axis::logarithmic("rms height over the range", ""), by_roughness),
            panel(
                "share right",
                Axis::linear("probability stated by fit --advise", ""),
                vec![
                    Series::marked_line(5, points.collect()),
                    Series::line(6, ideal.to_vec()),
                ],
            ),
        ],
        columns: 3,
        ..Figure::default()
    };
    figure.write(Path::new("docs/pictures/advise.png"))?;
    Ok(())
}
