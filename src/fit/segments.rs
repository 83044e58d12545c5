//! Divides a force curve into loading and unloading segments.

use std::ops::Range;

use super::curve_file::Sample;

/// Share of the whole approach that a reversal must cover: smaller ones are noise of the approach.
const LEAST_TURN: f64 = 0.02;

/// Consecutive points of loading (surfaces approach) or unloading (surfaces separate).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Segment {
    /// Indices of its points.
    pub points: Range<usize>,
    /// Whether the surfaces approach.
    pub loading: bool,
}

/// Divides a curve where its approach reverses.
pub fn segments(samples: &[Sample]) -> Vec<Segment> {
    let Some(first) = samples.first() else {
        return Vec::new();
    };
    let (low, high) = samples
        .iter()
        .fold((first.approach, first.approach), |(low, high), sample| {
            (low.min(sample.approach), high.max(sample.approach))
        });
    let turn = LEAST_TURN * (high - low);
    let mut segments = Vec::new();
    let mut begin = 0;
    // The extreme point of the current segment in its direction; no direction before the first
    // reversal.
    let mut direction: Option<bool> = None;
    let mut furthest = 0;
    let mut lowest = 0;
    for (i, sample) in samples.iter().enumerate() {
        let beyond = |other: usize| sample.approach - samples[other].approach;
        match direction {
            None => {
                if beyond(furthest) > 0.0 {
                    furthest = i;
                }
                if beyond(lowest) < 0.0 {
                    lowest = i;
                }
                if beyond(lowest) > turn {
                    (direction, furthest) = (Some(true), i);
                } else if beyond(furthest) < -turn {
                    (direction, furthest) = (Some(false), i);
                }
            }
            Some(loading) => {
                let sign = if loading { 1.0 } else { -1.0 };
                if sign * beyond(furthest) >= 0.0 {
                    furthest = i;
                } else if sign * beyond(furthest) < -turn {
                    segments.push(Segment {
                        points: begin..furthest + 1,
                        loading,
                    });
                    begin = furthest + 1;
                    (direction, furthest) = (Some(!loading), i);
                }
            }
        }
    }
    segments.push(Segment {
        points: begin..samples.len(),
        loading: direction.unwrap_or(true),
    });
    segments
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_loop_has_two_segments_and_noise_none() {
        let noise = [0.0, 0.004, -0.006, 0.005, -0.003];
        let loop_of = |i: usize| if i < 100 { i } else { 200 - i } as f64 / 100.0;
        let samples: Vec<Sample> = (0..=200)
            .map(|i| Sample {
                approach: loop_of(i) + noise[i % 5],
                force: 0.0,
            })
            .collect();
        let found = segments(&samples);
        assert_eq!(found.len(), 2, "{found:?}");
        assert!(found[0].loading && !found[1].loading);
        assert!(found[0].points.end.abs_diff(100) <= 2);
        assert_eq!(found[1].points, found[0].points.end..201);
    }
}
