//! Multinomial logistic regression, and whether a case lies where the classifier has seen any.

use serde::{Deserialize, Serialize};

/// Standardised features are cut here in the probabilities, so that one far outside does not decide alone.
const MOST_DEVIATIONS: f64 = 4.0;
/// Standard deviations by which a feature may lie beyond its range in training.
const MARGIN: f64 = 0.25;

/// A classifier: scores are sums of weighted products of standardised features, probabilities the shares of their
/// exponentials.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Classifier {
    /// Names of the classes.
    pub classes: Vec<String>,
    /// Names of the features.
    pub features: Vec<String>,
    /// Mean of each feature in training.
    pub mean: Vec<f64>,
    /// Standard deviation of each.
    pub deviation: Vec<f64>,
    /// The terms: products of the features with these indices; an empty one is the constant.
    pub terms: Vec<Vec<usize>>,
    /// Weight of each term, for each class.
    pub weights: Vec<Vec<f64>>,
    /// Weight of the squares of the weights in training, chosen by cross-validation.
    pub penalty: f64,
    /// Scores are divided by this: calibrated on curves that the weights were not trained on.
    pub temperature: f64,
    /// Mean of the standardised features of each class.
    pub centres: Vec<Vec<f64>>,
    /// Inverse of their covariance around these means.
    pub precision: Vec<Vec<f64>>,
    /// Greatest squared distance from the nearest centre at which the classifier answers.
    pub limit: f64,
    /// Least and greatest standardised value of each feature in training.
    pub ranges: Vec<[f64; 2]>,
}

impl Classifier {
    /// Features in standard deviations from the mean; one that is missing is the mean.
    pub fn standardised(&self, features: &[Option<f64>]) -> Vec<f64> {
        let scales = self.mean.iter().zip(&self.deviation);
        let each = features.iter().zip(scales);
        each.map(|(value, (mean, deviation))| value.map_or(0.0, |value| (value - mean) / deviation))
            .collect()
    }

    /// The terms of standardised features.
    pub fn terms(&self, standardised: &[f64]) -> Vec<f64> {
        let cut = |at: &usize| standardised[*at].clamp(-MOST_DEVIATIONS, MOST_DEVIATIONS);
        let product = |term: &Vec<usize>| term.iter().map(cut).product();
        self.terms.iter().map(product).collect()
    }

    /// Probability of each class.
    pub fn probabilities(&self, features: &[Option<f64>]) -> Vec<f64> {
        let terms = self.terms(&self.standardised(features));
        let score = |weights: &Vec<f64>| {
            let weighted = weights.iter().zip(&terms);
            weighted.map(|(weight, term)| weight * term).sum::<f64>() / self.temperature
        };
        shares(&self.weights.iter().map(score).collect::<Vec<_>>())
    }

    /// How far a case lies from what the classifier has seen, above 1 too far: the squared distance from the nearest
    /// centre (Mahalanobis) over its limit, or, if greater, how far a feature lies beyond its range.
    pub fn distance(&self, features: &[Option<f64>]) -> f64 {
        let here = self.standardised(features);
        let from = |centre: &Vec<f64>| {
            let away: Vec<f64> = here
                .iter()
                .zip(centre)
                .map(|(one, other)| one - other)
                .collect();
            let rows = self.precision.iter().zip(&away);
            rows.map(|(row, own)| {
                own * row
                    .iter()
                    .zip(&away)
                    .map(|(value, other)| value * other)
                    .sum::<f64>()
            })
            .sum::<f64>()
        };
        let from_centres = self.centres.iter().map(from).fold(f64::INFINITY, f64::min) / self.limit;
        let beyond = here
            .iter()
            .zip(&self.ranges)
            .map(|(value, [least, greatest])| (least - value).max(value - greatest) / MARGIN);
        beyond.fold(from_centres, f64::max)
    }

    /// Features that lie beyond their range in training, the farthest first: index, least and greatest value there.
    pub fn beyond(&self, features: &[Option<f64>]) -> Vec<(usize, [f64; 2])> {
        let here = self.standardised(features);
        let excess = |at: usize| {
            let [least, greatest] = self.ranges[at];
            (least - here[at]).max(here[at] - greatest)
        };
        let mut found: Vec<usize> = (0..here.len()).filter(|at| excess(*at) > MARGIN).collect();
        found.sort_by(|one, other| excess(*other).total_cmp(&excess(*one)));
        let plain =
            |at: usize| self.ranges[at].map(|value| self.mean[at] + value * self.deviation[at]);
        found.into_iter().map(|at| (at, plain(at))).collect()
    }

    /// What each feature adds to the score of a class above the mean score of the classes, greatest first.
    pub fn reasons(&self, features: &[Option<f64>], class: usize) -> Vec<(usize, f64)> {
        let terms = self.terms(&self.standardised(features));
        let classes = self.weights.len() as f64;
        let mut by_feature = vec![0.0; self.features.len()];
        for (at, (indices, value)) in self.terms.iter().zip(&terms).enumerate() {
            let mean = self.weights.iter().map(|weights| weights[at]).sum::<f64>() / classes;
            let gain = (self.weights[class][at] - mean) * value / self.temperature;
            for feature in indices {
                by_feature[*feature] += gain / indices.len() as f64;
            }
        }
        let mut reasons: Vec<(usize, f64)> = by_feature.into_iter().enumerate().collect();
        reasons.sort_by(|one, other| other.1.total_cmp(&one.1));
        reasons
    }
}

/// Shares of the exponentials of scores.
pub fn shares(scores: &[f64]) -> Vec<f64> {
    let greatest = scores.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let parts: Vec<f64> = scores
        .iter()
        .map(|score| (score - greatest).exp())
        .collect();
    let sum: f64 = parts.iter().sum();
    parts.iter().map(|part| part / sum).collect()
}
