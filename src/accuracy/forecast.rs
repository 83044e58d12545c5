//! How long a run will take, from what it does and from the runs measured so far.

use super::setting::{Model, Setting, Taper};
use crate::backend::dry_run::Place;
use crate::grid::Grid;
use crate::scene::{BackendName, Precision, Scene};
use crate::study::Cost;

/// Seconds a point of a pass at first, before anything is measured: a core of today. Corrected by
/// the first run.
const FIRST_RATE: f64 = 2e-9;
/// Iterations of a step at first.
const FIRST_ITERATIONS: f64 = 60.0;
/// Power of the number of points with which iterations grow: the square root of a side.
const GROWTH: f64 = 0.25;
/// Decades of a tolerance to which iterations are in proportion.
const DECADES: f64 = 6.0;
/// A run of another kind, over what its passes say, until one is measured: software that stands for
/// a graphics processor, the careful walk of a sharp law, the search of a summed attraction.
const SOFTWARE: f64 = 10.0;
const SHARP: f64 = 3.0;
const SUMMED: f64 = 3.0;

/// Predicts seconds.
#[derive(Clone, Debug, Default)]
pub struct Forecast {
    measured: Vec<(Kind, f64, f64)>,
}

/// What changes the time of an iteration, or their number, at once.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Kind {
    backend: BackendName,
    precision: Precision,
    sharp: bool,
    model: Model,
}

impl Kind {
    fn of(setting: &Setting) -> Kind {
        Kind {
            backend: setting.backend,
            precision: setting.precision,
            sharp: setting.taper == Taper::Sharp,
            model: setting.model,
        }
    }

    /// Against the processor in double precision with the scene's own law.
    fn guess(&self) -> f64 {
        let mut factor = 1.0;
        if self.backend == BackendName::Gpu {
            factor *= SOFTWARE;
        }
        if self.sharp {
            factor *= SHARP;
        }
        if self.model == Model::Dmt {
            factor *= SUMMED;
        }
        factor
    }
}

/// Work of a setting, points times passes; and its points.
#[derive(Clone, Copy, Debug)]
pub struct Work {
    kind: Kind,
    units: f64,
    points: f64,
}

impl Work {
    /// Counts what a scene does, made by `setting` with `steps` steps.
    pub fn of(setting: &Setting, scene: &Scene, grid: Grid, steps: usize) -> Work {
        let place = match (setting.backend, setting.precision) {
            (BackendName::Gpu, Precision::Double) => Place::GpuDouble,
            (BackendName::Gpu, _) => Place::Gpu,
            (_, Precision::Single) => Place::Single,
            _ => Place::Double,
        };
        let cost = Cost::of_scene(scene, grid, place);
        // A scene that cannot be planned fails where it is run, and says why.
        let (passes, points) = cost.map_or((1, grid.len()), |cost| {
            (cost.passes.len(), cost.points[0] * cost.points[1])
        });
        let points = points as f64;
        let decades = -setting.tolerance.log10() / DECADES;
        Work {
            kind: Kind::of(setting),
            units: passes as f64 * points * points.max(2.0).log2() * steps as f64 * decades,
            points,
        }
    }
}

impl Forecast {
    /// Keeps what a run took.
    pub fn learn(&mut self, work: &Work, seconds: f64) {
        self.measured
            .push((work.kind, work.points, seconds / work.units));
    }

    /// Seconds that a run will take.
    pub fn seconds(&self, work: &Work) -> f64 {
        let growth = |from: f64| (work.points / from).powf(GROWTH);
        // The nearest grid of the same kind says most; then the nearest of any.
        let nearest = |same: bool| {
            self.measured
                .iter()
                .filter(|(kind, ..)| !same || *kind == work.kind)
                .min_by(|a, b| {
                    let far = |points: f64| (points / work.points).ln().abs();
                    far(a.1).total_cmp(&far(b.1))
                })
        };
        let rate = match (nearest(true), nearest(false)) {
            (Some((_, points, rate)), _) => rate * growth(*points),
            (None, Some((kind, points, rate))) => {
                rate * growth(*points) * work.kind.guess() / kind.guess()
            }
            (None, None) => FIRST_RATE * FIRST_ITERATIONS * work.kind.guess(),
        };
        rate * work.units
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_measured_corrects_what_is_predicted() {
        let kind = Kind {
            backend: BackendName::Cpu,
            precision: Precision::Double,
            sharp: false,
            model: Model::Full,
        };
        let work = |points: f64, kind: Kind| Work {
            kind,
            units: points,
            points,
        };
        let mut forecast = Forecast::default();
        let first = forecast.seconds(&work(1e4, kind));
        assert!(first > 0.0);
        forecast.learn(&work(1e4, kind), 2.0);
        assert!((forecast.seconds(&work(1e4, kind)) - 2.0).abs() < 1e-12);
        // Sixteen times the points, and twice the iterations.
        assert!((forecast.seconds(&work(16e4, kind)) - 64.0).abs() < 1e-9);
        let sharp = Kind {
            sharp: true,
            ..kind
        };
        assert!((forecast.seconds(&work(1e4, sharp)) - 6.0).abs() < 1e-12);
        forecast.learn(&work(1e4, sharp), 3.0);
        assert!((forecast.seconds(&work(1e4, sharp)) - 3.0).abs() < 1e-12);
    }
}
