//! Between what a scene prescribes (pressure, force, approach, mean gap, a spring's far end) and
//! what the solver holds.

use super::setup::Setup;
use crate::scene::{Boundary, Control, LoadingScene};
use crate::solver::{ContactSolver, Hold, Load, Problem};

/// Rigid positions and total load of a solved state, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Position {
    /// Rigid displacement towards the solid since first touch, m.
    pub approach: f64,
    /// Mean gap over the grid, m.
    pub mean_gap: f64,
    /// Net mean pressure over all solved points, Pa.
    pub mean_pressure: f64,
}

/// Translates the values of a path.
#[derive(Clone, Copy, Debug)]
pub struct Controller<'s> {
    problem: &'s Problem,
    control: Control,
    /// Spring constant, N/m.
    spring: Option<f64>,
    /// The point from which approach counts, over the origin of the reduced heights, m.
    highest: f64,
}

impl<'s> Controller<'s> {
    /// The controller of a scene for one of its problems (with or without its law).
    pub fn new(setup: &Setup, problem: &'s Problem) -> Self {
        let highest = setup.surface.highest - problem.height_origin;
        Controller::of(&setup.scene.loading, highest, problem)
    }

    /// The controller of a path whose approach counts from `highest` (m) over the origin of the
    /// reduced heights.
    pub(super) fn of(loading: &LoadingScene, highest: f64, problem: &'s Problem) -> Self {
        Controller {
            problem,
            control: loading.control,
            spring: loading.spring,
            highest,
        }
    }

    /// Whether the path prescribes a load, which the surfaces may fail to carry.
    pub fn is_load(&self) -> bool {
        matches!(self.control, Control::Pressure | Control::Force)
    }

    /// Area over which the solved mean pressure is a mean, m^2.
    fn solved_area(&self) -> f64 {
        self.problem.shape.len() as f64 * self.problem.grid.pixel_area()
    }

    /// Force of a mean pressure over all solved points, N.
    pub fn force(&self, mean_pressure: f64) -> f64 {
        mean_pressure * self.solved_area()
    }

    /// Mean pressure over all solved points of a prescribed load, Pa.
    pub fn mean_pressure(&self, value: f64) -> f64 {
        match self.control {
            Control::Force => value / self.solved_area(),
            _ => value,
        }
    }

    /// Compliance of the free half-space to a uniform pressure on all solved points, reduced.
    fn free_compliance(&self) -> f64 {
        1.0 / self.problem.stiffness[0]
    }

    /// Stiffness with which the spring holds the mean displacement, reduced; `None` without one.
    fn spring_stiffness(&self) -> Option<f64> {
        let scales = self.problem.scales;
        self.spring.map(|spring| {
            let compliance = self.solved_area() / spring * scales.pressure / scales.length;
            match self.problem.boundary {
                Boundary::Periodic => 1.0 / compliance,
                Boundary::Free => 1.0 / (self.free_compliance() + compliance),
            }
        })
    }

    /// Mean gap of a periodic cell at an approach, m.
    fn gap_at(&self, approach: f64) -> f64 {
        self.highest - approach
    }

    /// The load of a prescribed value.
    pub fn load(&self, value: f64) -> Load {
        match self.control {
            Control::Pressure | Control::Force => self.pressure_load(self.mean_pressure(value)),
            Control::MeanGap => self.gap_load(value),
            Control::Approach => self.approach_load(value),
        }
    }

    /// The load of a mean pressure over all solved points, Pa.
    pub fn pressure_load(&self, mean_pressure: f64) -> Load {
        let pressure = mean_pressure / self.problem.scales.pressure;
        Load {
            hold: Hold::Pressure(pressure),
            zero_stiffness: 0.0,
            zero_compliance: match self.problem.boundary {
                Boundary::Periodic => ContactSolver::pressure_compliance(self.problem, pressure),
                Boundary::Free => self.free_compliance(),
            },
        }
    }

    fn gap_load(&self, mean_gap: f64) -> Load {
        Load {
            hold: Hold::Gap(mean_gap / self.problem.scales.length),
            zero_stiffness: 0.0,
            zero_compliance: 1.0 / self.problem.stiffness_min(),
        }
    }

    fn approach_load(&self, approach: f64) -> Load {
        let length = self.problem.scales.length;
        let zero_stiffness = match (self.problem.boundary, self.spring_stiffness()) {
            (Boundary::Periodic, None) => return self.gap_load(self.gap_at(approach)),
            (_, Some(stiffness)) => stiffness,
            (Boundary::Free, None) => self.problem.stiffness[0],
        };
        // u = g + h + offset: the spring pulls on the mean of g + h from this far end.
        let offset = (approach - self.highest) / length;
        Load {
            hold: Hold::Pressure(zero_stiffness * offset),
            zero_stiffness,
            zero_compliance: 1.0 / zero_stiffness,
        }
    }

    /// Whether a prescribed approach lies beyond what a periodic cell can be closed by.
    pub fn is_beyond_closure(&self, value: f64) -> bool {
        self.problem.boundary == Boundary::Periodic
            && self.spring.is_none()
            && self.problem.law.has_wall()
            && match self.control {
                Control::Approach => self.gap_at(value) < 0.0,
                Control::MeanGap => value < 0.0,
                _ => false,
            }
    }

    /// The undeformed gap over all solved points at a prescribed value, reduced: at first touch
    /// where a load is prescribed, cut at zero where the bodies would overlap.
    pub fn undeformed_gap(&self, value: f64) -> Vec<f64> {
        let problem = self.problem;
        let level = match self.control {
            Control::Pressure | Control::Force => problem.highest(),
            Control::MeanGap => value / problem.scales.length,
            Control::Approach => (self.highest - value) / problem.scales.length,
        };
        // With a spring or on a free boundary an overlap is left to the solver to push out.
        let gap: Vec<f64> = problem
            .heights
            .iter()
            .map(|h| (level - h).max(0.0))
            .collect();
        problem.padded(&gap, 0.0)
    }

    /// Position and load of a solved state, from the mean pressure that is held (reduced), the mean
    /// of g + h over all solved points and the mean gap over the grid (reduced).
    pub fn position(
        &self,
        load: &Load,
        held: f64,
        mean_displacement: f64,
        mean_gap: f64,
    ) -> Position {
        let scales = self.problem.scales;
        let mean_pressure = held + load.zero_stiffness * mean_displacement;
        let approach = match self.problem.boundary {
            Boundary::Periodic => self.highest - mean_gap * scales.length,
            Boundary::Free => {
                let offset = self.free_compliance() * mean_pressure - mean_displacement;
                self.highest + offset * scales.length
            }
        };
        Position {
            approach,
            mean_gap: mean_gap * scales.length,
            mean_pressure: mean_pressure * scales.pressure,
        }
    }

    /// u - g - h of a state, reduced: 0 mean displacement on a periodic grid, the rigid offset on a
    /// free one.
    pub fn offset(&self, position: &Position, mean_displacement: f64) -> f64 {
        match self.problem.boundary {
            Boundary::Periodic => -mean_displacement,
            Boundary::Free => (position.approach - self.highest) / self.problem.scales.length,
        }
    }
}
