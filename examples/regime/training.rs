//! Trains the classifiers on the table, and judges them on curves of problems that training has not seen.

use nalgebra::{DMatrix, DVector};
use tabor::fit::advice::classifier::{Classifier, shares};
use tabor::fit::advice::features::CURVE_FEATURES;
use tabor::fit::advice::numbers::{NUMBER_FEATURES, Numbers};

use super::table::{CLASSES, HELD_OUT, Row, scattered};

/// Parts of the training curves for cross-validation.
const FOLDS: usize = 5;
/// Weights of the squares of the weights that are compared, for a curve.
const PENALTIES: [f64; 6] = [0.5, 1.0, 2.0, 4.0, 8.0, 16.0];
/// Share of the training curves that lie within the limit of the distance.
const SEEN_SHARE: f64 = 0.99;
/// Added to the covariance of standardised features, so that features which hardly vary decide nothing.
const LEAST_VARIANCE: f64 = 0.05;
const NEWTON_STEPS: usize = 30;

/// A case: features, class, and the problem it comes from.
#[derive(Clone, Debug)]
pub struct Case {
    /// Features of the curve, or numbers of the problem.
    pub features: Vec<Option<f64>>,
    /// Index into [`CLASSES`].
    pub class: usize,
    /// Problems are divided, not curves.
    pub problem: usize,
}

/// What a classifier takes, and its terms.
#[derive(Clone, Debug)]
pub struct Design {
    features: Vec<String>,
    terms: Vec<Vec<usize>>,
    pick: fn(&Row) -> Option<Vec<Option<f64>>>,
}

impl Design {
    /// Features of curves, with their squares.
    pub fn for_curves() -> Self {
        let features = CURVE_FEATURES.map(str::to_owned).to_vec();
        let each = 0..features.len();
        let mut terms = vec![Vec::new()];
        terms.extend(each.clone().map(|at| vec![at]));
        terms.extend(each.map(|at| vec![at, at]));
        Design {
            features,
            terms,
            pick: |row| Some(row.features.clone()),
        }
    }

    /// Numbers of problems with attraction and a range, with their products, and the cube of the Tabor number's.
    pub fn for_numbers() -> Self {
        let features = NUMBER_FEATURES.map(str::to_owned).to_vec();
        let mut terms = vec![Vec::new()];
        for one in 0..features.len() {
            terms.push(vec![one]);
            terms.extend((one..features.len()).map(|other| vec![one, other]));
        }
        terms.push(vec![0, 0, 0]);
        Design {
            features,
            terms,
            pick: |row| {
                let numbers = Numbers {
                    tabor: row.tabor,
                    rms_height: row.rms_height,
                    noise: row.noise,
                    load: row.load,
                };
                let has_numbers = row.law != "none" && row.kind != "limit";
                has_numbers.then(|| numbers.features().map(Some).to_vec())
            },
        }
    }

    /// Cases of rows of spheres.
    pub fn cases<'a>(&self, rows: impl Iterator<Item = &'a Row>) -> Vec<Case> {
        rows.filter_map(|row| {
            Some(Case {
                features: (self.pick)(row)?,
                class: row.suits(),
                problem: row.problem,
            })
        })
        .collect()
    }

    /// Trains on cases: the penalty and the temperature by cross-validation over problems.
    pub fn train(&self, cases: &[Case]) -> Trained {
        let folds = |case: &Case| scattered(case.problem) / HELD_OUT % FOLDS;
        let mut best: Option<(f64, f64, f64)> = None;
        for penalty in PENALTIES {
            let mut scored: Vec<(Vec<f64>, usize)> = Vec::new();
            for fold in 0..FOLDS {
                let (kept, left): (Vec<Case>, Vec<Case>) =
                    cases.iter().cloned().partition(|case| folds(case) != fold);
                let part = self.weighed(&kept, penalty);
                scored.extend(left.iter().map(|case| (scores(&part, case), case.class)));
            }
            let (temperature, loss) = calibrated(&scored);
            if best.is_none_or(|(least, ..)| loss < least) {
                best = Some((loss, penalty, temperature));
            }
        }
        let (loss, penalty, temperature) = best.unwrap_or((f64::NAN, PENALTIES[0], 1.0));
        let classifier = self.train_with(cases, penalty, temperature);
        Trained { classifier, loss }
    }

    /// Trains with a known penalty and temperature.
    pub fn train_with(&self, cases: &[Case], penalty: f64, temperature: f64) -> Classifier {
        let mut classifier = self.weighed(cases, penalty);
        classifier.temperature = temperature;
        let standard: Vec<(Vec<f64>, usize)> = cases
            .iter()
            .map(|case| (classifier.standardised(&case.features), case.class))
            .collect();
        let size = self.features.len();
        let mut covariance = DMatrix::identity(size, size) * LEAST_VARIANCE;
        for class in 0..CLASSES.len() {
            let own: Vec<&Vec<f64>> = standard
                .iter()
                .filter(|(_, of)| *of == class)
                .map(|(features, _)| features)
                .collect();
            if own.is_empty() {
                continue;
            }
            let mean = |at: usize| own.iter().map(|row| row[at]).sum::<f64>() / own.len() as f64;
            let centre: Vec<f64> = (0..size).map(mean).collect();
            for row in own {
                let away = DVector::from_fn(size, |at, _| row[at] - centre[at]);
                covariance += &away * away.transpose() / standard.len() as f64;
            }
            classifier.centres.push(centre);
        }
        let precision = covariance
            .try_inverse()
            .unwrap_or(DMatrix::identity(size, size));
        classifier.precision = precision
            .row_iter()
            .map(|row| row.iter().copied().collect())
            .collect();
        let ends = |at: usize| {
            let values = standard.iter().map(|(features, _)| features[at]);
            values.fold(
                [f64::INFINITY, f64::NEG_INFINITY],
                |[least, greatest], value| [least.min(value), greatest.max(value)],
            )
        };
        let ranges: Vec<[f64; 2]> = (0..size).map(ends).collect();
        let mut distances: Vec<f64> = cases
            .iter()
            .map(|case| classifier.distance(&case.features))
            .collect();
        distances.sort_by(f64::total_cmp);
        classifier.limit = distances[(SEEN_SHARE * (distances.len() - 1) as f64) as usize];
        classifier.ranges = ranges;
        classifier
    }

    /// Weights that minimise the log loss and the penalty (Newton's method).
    fn weighed(&self, cases: &[Case], penalty: f64) -> Classifier {
        let (mean, deviation) = scales(cases, self.features.len());
        let mut classifier = Classifier {
            classes: CLASSES.map(str::to_owned).to_vec(),
            features: self.features.clone(),
            mean,
            deviation,
            terms: self.terms.clone(),
            weights: Vec::new(),
            penalty,
            temperature: 1.0,
            centres: Vec::new(),
            precision: Vec::new(),
            limit: 1.0,
            ranges: Vec::new(),
        };
        let terms: Vec<Vec<f64>> = cases
            .iter()
            .map(|case| classifier.terms(&classifier.standardised(&case.features)))
            .collect();
        let (width, classes) = (self.terms.len(), CLASSES.len());
        let mut weights = DVector::zeros(width * classes);
        for _ in 0..NEWTON_STEPS {
            let mut slope = DVector::zeros(width * classes);
            let mut curvature = DMatrix::zeros(width * classes, width * classes);
            for (row, case) in terms.iter().zip(cases) {
                let score = |class: usize| -> f64 {
                    row.iter()
                        .enumerate()
                        .map(|(at, value)| value * weights[class * width + at])
                        .sum()
                };
                let share = shares(&(0..classes).map(score).collect::<Vec<_>>());
                for one in 0..classes {
                    let miss = share[one] - if case.class == one { 1.0 } else { 0.0 };
                    for at in 0..width {
                        slope[one * width + at] += miss * row[at];
                    }
                    for other in 0..classes {
                        let own = if one == other { share[one] } else { 0.0 };
                        let factor = own - share[one] * share[other];
                        for at in 0..width {
                            let scaled = factor * row[at];
                            for to in 0..width {
                                curvature[(other * width + to, one * width + at)] +=
                                    scaled * row[to];
                            }
                        }
                    }
                }
            }
            for at in 0..width * classes {
                // The constants are hardly penalised: just so that the sum of all classes is determined.
                let own = if self.terms[at % width].is_empty() {
                    1e-3 * penalty
                } else {
                    penalty
                };
                slope[at] += own * weights[at];
                curvature[(at, at)] += own;
            }
            let Some(step) = curvature.cholesky().map(|factor| factor.solve(&slope)) else {
                break;
            };
            weights -= &step;
            if step.amax() < 1e-8 {
                break;
            }
        }
        classifier.weights = weights
            .as_slice()
            .chunks(width)
            .map(<[f64]>::to_vec)
            .collect();
        classifier
    }
}

/// The classifier as it is committed: four decimals, which change a probability by less than a thousandth.
pub fn rounded(classifier: &Classifier) -> Result<Classifier, serde_json::Error> {
    fn round(value: &mut serde_json::Value) {
        match value {
            serde_json::Value::Array(values) => values.iter_mut().for_each(round),
            serde_json::Value::Object(values) => values.values_mut().for_each(round),
            serde_json::Value::Number(number) if number.is_f64() => {
                let rounded = number.as_f64().map(|number| (1e4 * number).round() / 1e4);
                *value = serde_json::json!(rounded);
            }
            _ => {}
        }
    }
    let mut value = serde_json::to_value(classifier)?;
    round(&mut value);
    serde_json::from_value(value)
}

/// A classifier, with the log loss of its cross-validation.
pub struct Trained {
    /// The classifier.
    pub classifier: Classifier,
    /// Log loss on the curves left out.
    pub loss: f64,
}

fn scales(cases: &[Case], size: usize) -> (Vec<f64>, Vec<f64>) {
    let moments = (0..size).map(|at| {
        let values: Vec<f64> = cases.iter().filter_map(|case| case.features[at]).collect();
        let count = values.len().max(1) as f64;
        let mean = values.iter().sum::<f64>() / count;
        let variance = values
            .iter()
            .map(|value| (value - mean).powi(2))
            .sum::<f64>()
            / count;
        (mean, variance.sqrt().max(1e-6))
    });
    moments.unzip()
}

fn scores(classifier: &Classifier, case: &Case) -> Vec<f64> {
    let terms = classifier.terms(&classifier.standardised(&case.features));
    let score = |weights: &Vec<f64>| {
        weights
            .iter()
            .zip(&terms)
            .map(|(weight, term)| weight * term)
            .sum()
    };
    classifier.weights.iter().map(score).collect()
}

/// Temperature of the least log loss, among steps of 5 %, and that loss.
fn calibrated(scored: &[(Vec<f64>, usize)]) -> (f64, f64) {
    let loss = |temperature: f64| {
        let each = scored.iter().map(|(scores, class)| {
            let cooled: Vec<f64> = scores.iter().map(|score| score / temperature).collect();
            -shares(&cooled)[*class].max(1e-12).ln()
        });
        each.sum::<f64>() / scored.len() as f64
    };
    (-14..=28)
        .map(|step| 1.05_f64.powi(step))
        .map(|temperature| (temperature, loss(temperature)))
        .min_by(|one, other| one.1.total_cmp(&other.1))
        .unwrap_or((1.0, f64::NAN))
}

/// What a classifier achieves.
#[derive(Clone, Debug, Default)]
pub struct Score {
    /// Share of right answers.
    pub accuracy: f64,
    /// Mean of -ln of the probability of the right answer; not of a rule without probabilities.
    pub log_loss: f64,
    /// Expected calibration error: mean distance of the stated probability from the share that was right, in tenths.
    pub calibration_error: f64,
    /// Cases by right class and answer.
    pub confusion: [[usize; CLASSES.len()]; CLASSES.len()],
    /// For each tenth of the stated probability: cases, mean probability, share right.
    pub reliability: Vec<(usize, f64, f64)>,
}

/// Index of the greatest.
pub fn likeliest(probabilities: &[f64]) -> usize {
    let places = 0..probabilities.len();
    places
        .max_by(|one, other| probabilities[*one].total_cmp(&probabilities[*other]))
        .unwrap_or(0)
}

/// Scores answers: the right class, and a probability for each class.
pub fn score(answers: &[(usize, Vec<f64>)]) -> Score {
    let mut score = Score::default();
    let count = answers.len() as f64;
    let mut bins = [(0_usize, 0.0, 0.0); 10];
    for (class, probabilities) in answers {
        let answer = likeliest(probabilities);
        let right = if answer == *class { 1.0 } else { 0.0 };
        score.accuracy += right / count;
        score.log_loss -= probabilities[*class].max(1e-12).ln() / count;
        score.confusion[*class][answer] += 1;
        let bin = &mut bins[((10.0 * probabilities[answer]) as usize).min(9)];
        *bin = (bin.0 + 1, bin.1 + probabilities[answer], bin.2 + right);
    }
    for (cases, stated, right) in bins.into_iter().filter(|bin| bin.0 > 0) {
        let own = cases as f64;
        score.calibration_error += (stated - right).abs() / count;
        score.reliability.push((cases, stated / own, right / own));
    }
    score
}

/// The answers of a classifier to cases.
pub fn answers(classifier: &Classifier, cases: &[Case]) -> Vec<(usize, Vec<f64>)> {
    let answer = |case: &Case| (case.class, classifier.probabilities(&case.features));
    cases.iter().map(answer).collect()
}
