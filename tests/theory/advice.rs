//! The advice on models: trained as committed, as right on curves held out as `docs/advise.md` says, and free of units.

use std::path::Path;

use tabor::fit::advice::classifier::Classifier;
use tabor::fit::advice::{Advice, FOR_CURVES, FOR_NUMBERS, advise_curve};
use tabor::fit::model::{IndenterModel, Parameters};
use tabor::fit::{ForceCurve, Freedom, Model, Sample, fit_curve};

use crate::shared::random::Random;

#[path = "../../examples/regime/table.rs"]
#[expect(
    dead_code,
    reason = "the example writes the table, these tests only read it"
)]
mod table;
#[path = "../../examples/regime/training.rs"]
#[expect(
    dead_code,
    reason = "the example chooses the penalty too, and tells how reliable the answers are"
)]
mod training;

use table::Row;
use training::{Design, answers, rounded, score};

/// Place of the feature that weighs JKR against DMT.
const EVIDENCE: usize = 20;
const TABLE: &str = include_str!("../../examples/regime/curves.csv");

fn rows(wanted: impl Fn(&Row) -> bool) -> Vec<Row> {
    let rows = table::read(TABLE).expect("the committed table is whole");
    rows.into_iter().filter(wanted).collect()
}

fn committed() -> [(Design, Classifier); 2] {
    [
        (Design::for_curves(), FOR_CURVES),
        (Design::for_numbers(), FOR_NUMBERS),
    ]
    .map(|(design, text)| (design, serde_json::from_str(text).expect("a classifier")))
}

/// Training on the committed table, with the committed penalty and temperature, gives the committed numbers: to the
/// last of their four decimals, where roundings may fall apart, and its share of large ones.
#[test]
fn training_gives_the_committed_classifiers() {
    let rows = rows(|row| row.is_of_sphere() && !row.is_held_out());
    for (design, kept) in committed() {
        let cases = design.cases(rows.iter());
        let trained = design.train_with(&cases, kept.penalty, kept.temperature);
        let trained = rounded(&trained).expect("numbers");
        assert_eq!(
            (&trained.terms, &trained.features),
            (&kept.terms, &kept.features)
        );
        let numbers = |classifier: &Classifier| -> Vec<f64> {
            let tables = [
                &classifier.weights,
                &classifier.centres,
                &classifier.precision,
            ];
            let mut all: Vec<f64> = tables.into_iter().flatten().flatten().copied().collect();
            all.extend(classifier.mean.iter().chain(&classifier.deviation));
            all.extend(classifier.ranges.iter().flatten());
            all.push(classifier.limit);
            all
        };
        let (trained, kept) = (numbers(&trained), numbers(&kept));
        assert_eq!(trained.len(), kept.len());
        for (new, old) in trained.iter().zip(&kept) {
            assert!((new - old).abs() < 2e-4 + 2e-4 * old.abs(), "{new} {old}");
        }
    }
}

/// On curves of problems that training has not seen. The floors lie two standard errors (4 %, of the 75 problems held
/// out) below what the docs state; the baseline is what `tabor fit` chooses by its fitted Tabor number.
#[test]
fn advice_on_curves_held_out_is_right_as_often_as_stated() {
    let held = |kind| rows(move |row| row.kind == kind && row.is_held_out());
    let (rows, limits) = (held("sphere"), held("limit"));
    let [(curves, by_curve), (numbers, by_number)] = committed();
    let fitted = score(&answers(&by_curve, &curves.cases(rows.iter())));
    let known = score(&answers(&by_number, &numbers.cases(rows.iter())));
    let is_right = |row: &&Row| table::CLASSES[row.suits()] == row.chosen;
    let baseline = rows.iter().filter(is_right).count() as f64 / rows.len() as f64;
    println!(
        "right: {:.3}, {:.3} from known numbers, {baseline:.3} by the fitted Tabor number; calibration error {:.3}, {:.3}",
        fitted.accuracy, known.accuracy, fitted.calibration_error, known.calibration_error
    );
    assert!(fitted.accuracy > 0.68 && known.accuracy > 0.58);
    assert!(fitted.accuracy > baseline + 0.2);
    // Fields that were solved after all else was settled: 75 % and 0.035, of 60 problems.
    let anew = score(&answers(&by_curve, &curves.cases(held("anew").iter())));
    println!(
        "right on fields solved anew: {:.3}, {:.3}",
        anew.accuracy, anew.calibration_error
    );
    assert!(anew.accuracy > 0.65 && anew.calibration_error < 0.1);
    assert!(fitted.calibration_error < 0.1 && known.calibration_error < 0.12);
    // A curve of DMT taken for one of JKR gives a w a third too high, and the reverse. Where the curve is 20 times as
    // likely under one of them (AIC differ by 6) it must not be told the other.
    let decided = |row: &&Row| {
        row.features[EVIDENCE].is_some_and(|evidence| evidence.abs() > 1.0_f64.asinh())
    };
    let decided: Vec<&Row> = limits.iter().filter(decided).collect();
    let told = answers(&by_curve, &curves.cases(decided.iter().copied()));
    assert!(told.len() > 10, "{}", told.len());
    for (class, shares) in told {
        assert!(
            class != 1 || shares[2] < 0.5,
            "DMT is told JKR: {shares:.2?}"
        );
        assert!(
            class != 2 || shares[1] < 0.5,
            "JKR is told DMT: {shares:.2?}"
        );
    }
    // Roughness of a range is beyond all models. They are 19 of 23; two standard errors of such a share are 17 %.
    let rough: Vec<&Row> = rows
        .iter()
        .filter(|row| row.rms_height > 1.0 && row.noise < 0.3)
        .collect();
    let told = curves.cases(rough.iter().copied());
    let none = answers(&by_curve, &told)
        .iter()
        .filter(|(_, shares)| shares[4] > 0.5)
        .count();
    println!("{none} of {} rough ones are none of these", rough.len());
    assert!(rough.len() > 10 && 10 * none >= 6 * rough.len());
}

/// The same contact with other lengths, forces and moduli, and so with another radius over range.
#[test]
fn advice_is_free_of_units() {
    let of = |radius: f64, modulus: f64, work: f64| -> Advice {
        let truth = Parameters {
            contact_modulus: modulus,
            work_of_adhesion: work,
            maugis_parameter: 0.8,
            approach_offset: 0.0,
            force_offset: 0.0,
            baseline_slope: 0.0,
        };
        let stiffness = 4.0 / 3.0 * modulus;
        let force = std::f64::consts::PI * work * radius;
        let unit = (force * force / (stiffness * stiffness * radius)).cbrt();
        let sphere = IndenterModel::new(Model::MaugisDugdale, radius);
        let mut random = Random(3);
        let samples = (-80..=160).chain((-80..160).rev()).map(|i| {
            let approach = unit * f64::from(i) / 40.0;
            let free = i < -30;
            let contact = sphere.forces(&truth, &[approach]).expect("a force")[0];
            Sample {
                approach,
                force: if free { 0.0 } else { contact } + 0.03 * force * random.normal(),
            }
        });
        let curve = ForceCurve {
            samples: samples.collect(),
            ..ForceCurve::default()
        };
        let freedom = Freedom {
            approach_offset: true,
            force_offset: false,
            baseline_slope: false,
            range: None,
        };
        let result = fit_curve(&curve, Path::new("made"), radius, freedom).expect("a fit");
        advise_curve(&result).expect("advice")
    };
    let one = of(1e-6, 1e9, 0.05);
    for (radius, modulus, work) in [(3e-3, 1e6, 0.1), (2e-8, 7e10, 0.02)] {
        let other = of(radius, modulus, work);
        for (one, other) in one.probabilities.iter().zip(&other.probabilities) {
            // The searches of both fits end at their tolerance, not at the same bits.
            assert!((one.1 - other.1).abs() < 0.01, "{one:?} {other:?}");
        }
    }
}
