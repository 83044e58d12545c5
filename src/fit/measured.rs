//! A curve prepared for fitting.

use super::beam::Beam;
use super::curve_file::Sample;
use super::indenter::Indenter;
use super::segments::{Segment, segments};

/// An approach is held where this share of the points, and so many, lie within this share of the whole approach.
const HOLD_SHARE: f64 = 0.05;
const LEAST_HELD: usize = 5;
const HOLD_BAND: f64 = 0.01;

/// Parameters fitted in addition to the model's own; none by default.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Freedom {
    /// The approach of first touch of the undeformed surfaces is unknown.
    pub approach_offset: bool,
    /// The baseline force is unknown.
    pub force_offset: bool,
    /// The baseline has a slope that is unknown, and hence an unknown force.
    pub baseline_slope: bool,
    /// Range of the attraction, m, if it is known: `w` over the tension, as in a scene.
    pub range: Option<f64>,
}

/// The signs of a curve that are reversed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ReversedSigns {
    approach: bool,
    force: bool,
}

impl ReversedSigns {
    /// Every combination of reversed signs.
    pub(super) const ALL: [ReversedSigns; 3] = [
        ReversedSigns {
            approach: true,
            force: false,
        },
        ReversedSigns {
            approach: false,
            force: true,
        },
        ReversedSigns {
            approach: true,
            force: true,
        },
    ];

    /// What a curve with these signs reversed looks like, and what is to be done.
    pub(super) fn remedy(self) -> &'static str {
        match (self.approach, self.force) {
            (true, false) => {
                "the force grows as the surfaces separate; approach must be positive closer: turn its sign"
            }
            (false, _) => {
                "the tension grows as the surfaces close; force must be positive in compression: turn its sign"
            }
            (true, true) => {
                "approach and force are both reversed; approach must be positive closer, and force in compression: turn both signs"
            }
        }
    }
}

/// A curve prepared for fitting.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Measured {
    /// Points in the order of the file.
    pub samples: Vec<Sample>,
    /// Loading and unloading segments.
    pub segments: Vec<Segment>,
    /// The tip.
    pub indenter: Indenter,
    /// The fitted offsets.
    pub freedom: Freedom,
    pub(super) approaches: Vec<f64>,
    /// Range of the force, N.
    pub(super) force_span: f64,
    /// Range of the approach, m.
    pub(super) approach_span: f64,
    /// Mean approach, m.
    pub(super) middle: f64,
    /// The cantilever, if the base of one is at known positions and its spring gives way.
    pub(super) beam: Option<Beam>,
}

impl Measured {
    /// A curve of a sphere of a radius (m), or of another tip.
    pub fn new(samples: Vec<Sample>, indenter: impl Into<Indenter>, freedom: Freedom) -> Self {
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
            segments: segments(&samples),
            indenter: indenter.into(),
            freedom,
            approaches: samples.iter().map(|sample| sample.approach).collect(),
            force_span: span(|sample| sample.force),
            approach_span: span(|sample| sample.approach),
            middle: samples.iter().map(|sample| sample.approach).sum::<f64>()
                / samples.len().max(1) as f64,
            beam: None,
            samples,
        }
    }

    /// Where the slope of the baseline acts on a point, m.
    pub(super) fn place(&self, at: usize) -> f64 {
        let approach = self.approaches[at];
        let beam = self.beam.as_ref();
        beam.map_or(approach, |beam| beam.place(at, approach))
    }

    /// The greatest approach, m.
    pub(super) fn closest(&self) -> f64 {
        let approaches = self.approaches.iter().copied();
        approaches.fold(f64::NEG_INFINITY, f64::max)
    }

    /// The same curve without the points at which the approach is held.
    pub(super) fn without_holds(&self) -> Measured {
        let points = self.approaches.len();
        let band = HOLD_BAND * self.approach_span;
        let mut moving = Vec::with_capacity(points);
        let mut from = 0;
        while from < points {
            let (mut low, mut high) = (self.approaches[from], self.approaches[from]);
            let stays = |approach: &&f64| {
                (low, high) = (low.min(**approach), high.max(**approach));
                high - low <= band
            };
            let count = self.approaches[from..].iter().take_while(stays).count();
            if count < LEAST_HELD || (count as f64) < HOLD_SHARE * points as f64 {
                moving.extend(from..from + count);
            }
            from += count;
        }
        let samples = moving.iter().map(|at| self.samples[*at]).collect();
        Measured {
            beam: self.beam.as_ref().map(|beam| beam.of_points(&moving)),
            ..Measured::new(samples, self.indenter, self.freedom)
        }
    }

    /// The same curve with signs reversed.
    pub(super) fn with_reversed(&self, reversed: ReversedSigns) -> Measured {
        let sign = |reversed: bool| if reversed { -1.0 } else { 1.0 };
        let samples = self.samples.iter().map(|sample| Sample {
            approach: sign(reversed.approach) * sample.approach,
            force: sign(reversed.force) * sample.force,
        });
        Measured::new(samples.collect(), self.indenter, self.freedom)
    }

    /// Estimated baseline force: the median of the tenth of the points that are farthest apart; 0
    /// if it is known.
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

    /// The points of least and greatest force.
    pub(super) fn extremes(&self) -> (Sample, Sample) {
        let by_force = |a: &&Sample, b: &&Sample| a.force.total_cmp(&b.force);
        let least = self.samples.iter().min_by(by_force);
        let greatest = self.samples.iter().max_by(by_force);
        let first = self.samples[0];
        (*least.unwrap_or(&first), *greatest.unwrap_or(&first))
    }
}
