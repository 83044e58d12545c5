//! Which model suits a curve, or a contact whose numbers are known: classifiers trained on full fields.
//!
//! A model suits if its work of adhesion and modulus are right within 15 %. `docs/advise.md` says on what the classifiers
//! were trained and how often they are right; `examples/regime` trains them.

pub mod classifier;
pub mod features;
pub mod numbers;

use std::sync::LazyLock;

use serde_json::{Map, Value, json};

use super::choice::FitResult;
use super::model::Model;
use classifier::Classifier;
use numbers::Numbers;

/// Trained on features of curves.
pub const FOR_CURVES: &str = include_str!("for_curves.json");
/// Trained on the numbers of contacts.
pub const FOR_NUMBERS: &str = include_str!("for_numbers.json");
/// Features named as reasons of an answer.
const REASONS: usize = 3;
/// Gain in score from which a feature is a reason: it makes the answer 1.1 times as likely.
const LEAST_GAIN: f64 = 0.1;

/// A feature that speaks for the answer.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Reason {
    /// Its name.
    pub feature: String,
    /// Its value here.
    pub value: f64,
    /// Its mean in training; of a ratio the geometric one.
    pub mean: f64,
}

/// A feature that lies beyond what the classifier was trained on.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Beyond {
    /// Its name.
    pub feature: String,
    /// Its value here.
    pub value: f64,
    /// Its least and greatest value in training.
    pub range: [f64; 2],
}

/// The answer of a classifier.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Advice {
    /// Each model with the probability that it suits, and last that none of them does.
    pub probabilities: Vec<(Option<Model>, f64)>,
    /// Distance from what the classifier was trained on, over the greatest at which it answers.
    pub distance: f64,
    /// What speaks for the likeliest answer, the strongest first.
    pub reasons: Vec<Reason>,
    /// What lies beyond its range in training, the farthest first.
    pub beyond: Vec<Beyond>,
}

/// Advice on a fitted curve of a sphere; `None` if not all four models could be fitted.
pub fn advise_curve(result: &FitResult) -> Option<Advice> {
    static CLASSIFIER: LazyLock<Classifier> = LazyLock::new(|| read(FOR_CURVES));
    let found = features::features(result)?;
    Some(Advice::new(&CLASSIFIER, &found, features::plain))
}

/// Advice on a contact whose numbers are known.
pub fn advise_numbers(numbers: &Numbers) -> Advice {
    static CLASSIFIER: LazyLock<Classifier> = LazyLock::new(|| read(FOR_NUMBERS));
    Advice::new(&CLASSIFIER, &numbers.features().map(Some), numbers::plain)
}

fn read(text: &str) -> Classifier {
    serde_json::from_str(text).expect("the committed classifiers are whole: a test reads both")
}

impl Advice {
    fn new(
        classifier: &Classifier,
        features: &[Option<f64>],
        plain: fn(usize, f64) -> f64,
    ) -> Self {
        let models = classifier.classes.iter().map(|class| {
            let named = |model: &Model| model.name() == class;
            Model::ALL.into_iter().find(named)
        });
        let probabilities: Vec<(Option<Model>, f64)> =
            models.zip(classifier.probabilities(features)).collect();
        let reasons = classifier.reasons(features, likeliest(&probabilities));
        let strong = reasons.into_iter().filter(|(_, gain)| *gain > LEAST_GAIN);
        let reasons = strong.filter_map(|(at, _)| {
            Some(Reason {
                feature: classifier.features[at].clone(),
                value: plain(at, features[at]?),
                mean: plain(at, classifier.mean[at]),
            })
        });
        let beyond = classifier.beyond(features).into_iter();
        let beyond = beyond.filter_map(|(at, range)| {
            Some(Beyond {
                feature: classifier.features[at].clone(),
                value: plain(at, features[at]?),
                // No plain value is negative: an end below 0 is the rounding of 0.
                range: range.map(|end| plain(at, end).max(0.0)),
            })
        });
        Advice {
            beyond: beyond.collect(),
            reasons: reasons.take(REASONS).collect(),
            distance: classifier.distance(features),
            probabilities,
        }
    }

    /// Whether the case is unlike all that the classifier was trained on, so that its probabilities mean nothing.
    pub fn is_outside(&self) -> bool {
        // A distance that is no number is outside too.
        !matches!(self.distance.partial_cmp(&1.0), Some(order) if order.is_le())
    }

    /// The model that suits; `None` if none of them is likeliest, or outside.
    pub fn model(&self) -> Option<Model> {
        let (model, _) = self.probabilities[likeliest(&self.probabilities)];
        model.filter(|_| !self.is_outside())
    }

    /// The advice in sentences: the answer, and why.
    pub fn sentences(&self) -> Vec<String> {
        let title = |model: Option<Model>| model.map_or("none of these", Model::title);
        if self.is_outside() {
            let beyond = self.beyond.iter().take(REASONS).map(|beyond| {
                let [value, least, greatest] =
                    [beyond.value, beyond.range[0], beyond.range[1]].map(short);
                format!(
                    "; {} is {value}, trained on {least} to {greatest}",
                    beyond.feature
                )
            });
            return vec![
                format!(
                    "none of these: this lies outside of what the advice was trained on{}",
                    beyond.collect::<String>()
                ),
                "judge by the residuals and the Tabor number (tabor theory tabor-map), or compare with the full field (tabor new afm, tabor run)".to_owned(),
            ];
        }
        let mut ranked = self.probabilities.clone();
        ranked.sort_by(|one, other| other.1.total_cmp(&one.1));
        let others: Vec<String> = ranked[1..]
            .iter()
            .filter(|(_, share)| *share >= 0.005)
            .map(|(model, share)| format!("{} {:.0} %", title(*model), 100.0 * share))
            .collect();
        let (model, share) = ranked[0];
        let others = if others.is_empty() {
            String::new()
        } else {
            format!(" ({})", others.join(", "))
        };
        let percent = 100.0 * share;
        let mut sentences = vec![model.map_or_else(
            || format!("none of these, with {percent:.0} %{others}"),
            |model| {
                let what = if model.adheres() {
                    "the simplest model that gives w and E* within 15 %"
                } else {
                    "adhesion is hidden by the noise, and E* within 15 %"
                };
                format!("{}, with {percent:.0} %: {what}{others}", model.title())
            },
        )];
        if !self.reasons.is_empty() {
            let each = self.reasons.iter().map(|reason| {
                format!(
                    "{} is {} (in training {})",
                    reason.feature,
                    short(reason.value),
                    short(reason.mean)
                )
            });
            sentences.push(format!(
                "what weighs most: {}",
                each.collect::<Vec<_>>().join("; ")
            ));
        }
        if model.is_none() {
            sentences.push(
                "no model is likely to give w and E* within 15 %: lower the noise, load more, take a smoother or cleaner tip, or compare with the full field (tabor new afm, tabor run)"
                    .to_owned(),
            );
        }
        sentences
    }

    /// The advice as it stands in `fit.json`.
    pub fn report(&self) -> Value {
        let name = |model: Option<Model>| model.map_or("none", Model::name);
        let probabilities: Map<String, Value> = self
            .probabilities
            .iter()
            .map(|(model, share)| (name(*model).to_owned(), json!(share)))
            .collect();
        let reasons: Vec<Value> = self
            .reasons
            .iter()
            .map(|reason| json!({ "feature": reason.feature, "value": reason.value, "mean": reason.mean }))
            .collect();
        let beyond: Vec<&str> = self
            .beyond
            .iter()
            .map(|beyond| beyond.feature.as_str())
            .collect();
        json!({
            "model": name(self.model()),
            "probabilities": probabilities,
            "distance": self.distance,
            "outside": self.is_outside(),
            "reasons": reasons,
            "beyond": beyond,
        })
    }
}

fn likeliest(probabilities: &[(Option<Model>, f64)]) -> usize {
    let places = 0..probabilities.len();
    places
        .max_by(|one, other| probabilities[*one].1.total_cmp(&probabilities[*other].1))
        .unwrap_or(0)
}

/// Two or three digits.
fn short(value: f64) -> String {
    if !value.is_finite() {
        "beyond the range of numbers".to_owned()
    } else if value.abs() >= 100.0 || (value != 0.0 && value.abs() < 0.01) {
        format!("{value:.1e}")
    } else {
        format!("{value:.2}")
    }
}
