//! Predicts the duration of a run from its work and from the runs measured so far.

use super::setting::{Model, Setting, Taper};
use crate::backend::dry_run::Place;
use crate::grid::Grid;
use crate::scene::{BackendName, Precision, Scene};
use crate::study::Cost;

/// Initial estimate of seconds a point and pass, for one current core; the first run corrects it.
const FIRST_RATE: f64 = 2e-9;
/// Initial estimate of iterations a step.
const FIRST_ITERATIONS: f64 = 60.0;
/// Iterations grow with this power of the number of points: the square root of a side.
const GROWTH: f64 = 0.25;
/// Iterations are proportional to the decades of the tolerance; this many decades correspond to
/// 1e-6.
const DECADES: f64 = 6.0;
/// Initial slow-down of other kinds of runs until one is measured: software rendering in place of a
/// graphics processor, the small steps of a sharp law, the load search of the DMT treatment.
const SOFTWARE: f64 = 10.0;
const SHARP: f64 = 3.0;
const SUMMED: f64 = 3.0;

/// Predicts seconds.
#[derive(Clone, Debug, Default)]
pub struct Forecast {
    measured: Vec<(Kind, f64, f64)>,
}

/// Properties that change the time or the number of iterations.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Kind {
    backend: BackendName,
    precision: Precision,
    sharp: bool,
    model: Model,
}

impl Kind {
    fn from_setting(setting: &Setting) -> Kind {
        Kind {
            backend: setting.backend,
            precision: setting.precision,
            sharp: setting.taper == Taper::Sharp,
            model: setting.model,
        }
    }

    /// Slow-down relative to the processor in double precision with the scene's own law.
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

/// Work of a setting: points times passes; and its points.
#[derive(Clone, Copy, Debug)]
pub struct Work {
    kind: Kind,
    units: f64,
    points: f64,
}

impl Work {
    /// The work of `scene`, derived by `setting`, over `steps` steps.
    pub fn new(setting: &Setting, scene: &Scene, grid: Grid, steps: usize) -> Work {
        let place = match (setting.backend, setting.precision) {
            (BackendName::Gpu, Precision::Double) => Place::GpuDouble,
            (BackendName::Gpu, _) => Place::Gpu,
            (_, Precision::Single) => Place::Single,
            _ => Place::Double,
        };
        let cost = Cost::for_scene(scene, grid, place);
        // A scene that cannot be planned reports its error when it is run.
        let (passes, points) = cost.map_or((1, grid.len()), |cost| {
            (cost.passes.len(), cost.points[0] * cost.points[1])
        });
        let points = points as f64;
        let decades = -setting.tolerance.log10() / DECADES;
        Work {
            kind: Kind::from_setting(setting),
            units: passes as f64 * points * points.max(2.0).log2() * steps as f64 * decades,
            points,
        }
    }
}

impl Forecast {
    /// Records the duration of a run.
    pub fn learn(&mut self, work: &Work, seconds: f64) {
        self.measured
            .push((work.kind, work.points, seconds / work.units));
    }

    /// Predicted seconds of a run.
    pub fn seconds(&self, work: &Work) -> f64 {
        let growth = |from: f64| (work.points / from).powf(GROWTH);
        // The nearest grid of the same kind predicts best; failing that, the nearest of any kind.
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
    fn measurements_correct_predictions() {
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
