//! A curve ready to be fitted.

use super::curve_file::Sample;
use super::ways::{Way, ways};

/// What is free besides the numbers of the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Freedom {
    /// Where the undeformed surfaces first touch is not known.
    pub approach_offset: bool,
    /// The force where nothing acts is not known.
    pub force_offset: bool,
    /// Range of the attraction, m, where it is known: `w` over the tension, as in a scene.
    pub range: Option<f64>,
}

/// Which signs of a curve are turned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Turned {
    approach: bool,
    force: bool,
}

impl Turned {
    /// Every way to turn a sign.
    pub(super) const ALL: [Turned; 3] = [
        Turned {
            approach: true,
            force: false,
        },
        Turned {
            approach: false,
            force: true,
        },
        Turned {
            approach: true,
            force: true,
        },
    ];
}

/// A curve ready to be fitted.
#[derive(Clone, Debug)]
pub struct Measured {
    /// Points in the order of the file.
    pub samples: Vec<Sample>,
    /// Ways together and apart.
    pub ways: Vec<Way>,
    /// R, m.
    pub radius: f64,
    /// What is free.
    pub freedom: Freedom,
    pub(super) approaches: Vec<f64>,
    /// Greatest less least force, N.
    pub(super) force_span: f64,
    /// Greatest less least approach, m.
    pub(super) approach_span: f64,
}

impl Measured {
    /// A curve of a sphere of `radius` (m).
    pub fn new(samples: Vec<Sample>, radius: f64, freedom: Freedom) -> Self {
        let span = |of: fn(&Sample) -> f64| {
            let ends = samples
                .iter()
                .map(of)
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                    (low.min(value), high.max(value))
                });
            ends.1 - ends.0
        };
        Measured {
            ways: ways(&samples),
            radius,
            freedom,
            approaches: samples.iter().map(|sample| sample.approach).collect(),
            force_span: span(|sample| sample.force),
            approach_span: span(|sample| sample.approach),
            samples,
        }
    }

    /// The same curve with signs turned.
    pub(super) fn turned(&self, turned: Turned) -> Measured {
        let sign = |turned: bool| if turned { -1.0 } else { 1.0 };
        let samples = self.samples.iter().map(|sample| Sample {
            approach: sign(turned.approach) * sample.approach,
            force: sign(turned.force) * sample.force,
        });
        Measured::new(samples.collect(), self.radius, self.freedom)
    }

    /// Force where nothing acts, as far as it can be guessed: the median of the tenth of the
    /// points that are farthest apart; 0 where it is known.
    pub(super) fn baseline(&self) -> f64 {
        if !self.freedom.force_offset {
            return 0.0;
        }
        let mut far = self.samples.clone();
        far.sort_by(|a, b| a.approach.total_cmp(&b.approach));
        far.truncate((far.len() / 10).max(1));
        far.sort_by(|a, b| a.force.total_cmp(&b.force));
        far[far.len() / 2].force
    }

    /// The points of the least and the greatest force.
    pub(super) fn extremes(&self) -> (Sample, Sample) {
        let by_force = |a: &&Sample, b: &&Sample| a.force.total_cmp(&b.force);
        let least = self.samples.iter().min_by(by_force);
        let greatest = self.samples.iter().max_by(by_force);
        let first = self.samples[0];
        (*least.unwrap_or(&first), *greatest.unwrap_or(&first))
    }
}
