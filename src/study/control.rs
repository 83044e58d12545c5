//! Translates what a scene prescribes (pressure, force, approach, mean gap, a spring's far end) into the loads
//! of the solver.

use super::setup::Setup;
use crate::grid::Boundary;
use crate::law::Law;
use crate::scene::Control;
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
        Controller::with_spring(
            setup.scene.loading.control,
            setup.spring(),
            highest,
            problem,
        )
    }

    /// The controller of a path whose approach acts through a spring (N/m), if there is one, and counts
    /// from `highest` (m) over the origin of the reduced heights.
    pub(super) fn with_spring(
        control: Control,
        spring: Option<f64>,
        highest: f64,
        problem: &'s Problem,
    ) -> Self {
        Controller {
            problem,
            control,
            spring,
            highest,
        }
    }

    /// Whether the path prescribes a load, which the surfaces may fail to carry.
    pub fn is_load(&self) -> bool {
        self.control.is_load()
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
        1.0 / self.problem.stiffness.zero_mode()
    }

    /// Stiffness between the mean displacement and the point where the approach is prescribed, reduced: spring,
    /// layer and free half-space in series. `None` if it is infinite.
    fn approach_stiffness(&self) -> Option<f64> {
        let scales = self.problem.scales;
        let spring = self.spring.map_or(0.0, |spring| {
            self.solved_area() / spring * scales.pressure / scales.length
        });
        let compliance = spring + self.mean_compliance();
        (compliance > 0.0).then(|| 1.0 / compliance)
    }

    /// Mean displacement under a unit mean pressure, reduced: that of the free half-space or of the
    /// layer; on a periodic half-space the mean displacement is 0.
    fn mean_compliance(&self) -> f64 {
        match self.problem.boundary {
            Boundary::Periodic => self.problem.uniform_compliance(),
            Boundary::Free => self.free_compliance(),
        }
    }

    /// Whether there is a compliance between the mean displacement and a prescribed approach, so that any
    /// approach can be reached.
    pub fn is_sprung(&self) -> bool {
        self.control == Control::Approach && self.approach_stiffness().is_some()
    }

    /// Mean gap of a periodic cell at an approach, m.
    fn gap_at(&self, approach: f64) -> f64 {
        self.highest - approach
    }

    /// Whether a prescribed load exceeds what the solid bears anywhere.
    pub fn is_beyond_hardness(&self, value: f64) -> bool {
        let shape = self.problem.shape;
        let on_surface =
            self.mean_pressure(value) * shape.len() as f64 / shape.surface_len() as f64;
        let pressure = on_surface / self.problem.scales.pressure;
        let hardness = self.problem.hardness;
        self.is_load() && hardness.is_some_and(|hardness| pressure >= hardness)
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

    /// Height of the other body over the origin of the reduced heights, m, where its undeformed surface is
    /// at a clearance (m) from the highest point of the grid.
    fn level_at(&self, clearance: f64) -> f64 {
        self.problem.highest() * self.problem.scales.length + clearance
    }

    /// The load that holds the undeformed surfaces at a clearance (m), where the path prescribes a load.
    pub fn clearance_load(&self, clearance: f64) -> Load {
        self.approach_load(self.highest - self.level_at(clearance))
    }

    /// The gap of the undeformed surfaces at a clearance (m) over all solved points, reduced.
    pub fn gap_at_clearance(&self, clearance: f64) -> Vec<f64> {
        let problem = self.problem;
        let level = self.level_at(clearance) / problem.scales.length;
        let gap: Vec<f64> = problem.heights.iter().map(|h| level - h).collect();
        problem.padded(&gap, 0.0)
    }

    /// The load that holds an approach (m) without a spring, whatever the path prescribes.
    pub fn position_load(&self, approach: f64) -> Load {
        let rigid = Controller {
            spring: None,
            ..*self
        };
        rigid.approach_load(approach)
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
        let Some(zero_stiffness) = self.approach_stiffness() else {
            return self.gap_load(self.gap_at(approach));
        };
        // u = g + h + offset: the spring pulls on the mean of g + h from this far end.
        let offset = (approach - self.highest) / length;
        Load {
            hold: Hold::Pressure(zero_stiffness * offset),
            zero_stiffness,
            zero_compliance: self.sprung_compliance(zero_stiffness),
        }
    }

    /// How far the mean displacement gives way under a unit mean pressure in the preconditioner, where a spring of this
    /// stiffness holds it, reduced. By as much as the spring gives way, all points would first move by its whole step, and where
    /// that is longer than the range of a law, they would leave a contact that holds: no further than under a load.
    fn sprung_compliance(&self, zero_stiffness: f64) -> f64 {
        let compliance = 1.0 / zero_stiffness;
        if self.problem.law == Law::HardWall {
            return compliance;
        }
        compliance.min(self.pressure_load(0.0).zero_compliance)
    }

    /// The approach or mean gap, m, at which a periodic cell is closed everywhere: to a wall, or to the end of a law that repels by
    /// itself. `None` where there is no such end.
    pub fn closure(&self) -> Option<f64> {
        let least = self.problem.law.least_gap() * self.problem.scales.length;
        let is_closed = self.problem.boundary == Boundary::Periodic
            && !self.is_sprung()
            && self.problem.hardness.is_none();
        match self.control {
            _ if !is_closed => None,
            Control::Approach => Some(self.highest - least),
            Control::MeanGap => Some(least),
            Control::Pressure | Control::Force => None,
        }
    }

    /// Whether a prescribed approach or gap lies beyond what a periodic cell can be closed by.
    pub fn is_beyond_closure(&self, value: f64) -> bool {
        self.closure().is_some_and(|closed| match self.control {
            Control::MeanGap => value < closed,
            _ => value > closed,
        })
    }

    /// The undeformed gap over all solved points at a prescribed value, reduced: at first touch
    /// where a load is prescribed, cut at zero where the bodies would overlap. The heights are lowered
    /// by the plastic depths over all held solved points, where there are some.
    pub fn undeformed_gap(&self, value: f64, plastic_depth: Option<&[f64]>) -> Vec<f64> {
        let problem = self.problem;
        let mut heights: Vec<f64> = problem.heights.iter().collect();
        if let Some(depths) = plastic_depth {
            let depths = problem.surface_part(depths);
            heights
                .iter_mut()
                .zip(depths)
                .for_each(|(h, depth)| *h -= depth);
        }
        let level = match self.control {
            Control::Pressure | Control::Force => problem.share.greatest_of(&heights),
            Control::MeanGap => value / problem.scales.length,
            Control::Approach => (self.highest - value) / problem.scales.length,
        };
        // With a spring, a layer or on a free boundary the solver removes the overlap.
        let gap: Vec<f64> = heights.iter().map(|h| (level - h).max(0.0)).collect();
        problem.padded(&gap, 0.0)
    }

    /// Position and load of a solved state, from the mean pressure that is held (reduced), the mean
    /// of g + h over all solved points, and over the grid the mean gap with the mean plastic depth
    /// (reduced).
    pub fn position(
        &self,
        load: &Load,
        held: f64,
        mean_displacement: f64,
        [mean_gap, mean_depth]: [f64; 2],
    ) -> Position {
        let scales = self.problem.scales;
        let mean_pressure = held + load.zero_stiffness * mean_displacement;
        let yielded = self.mean_compliance() * mean_pressure;
        let approach = match self.problem.boundary {
            // The mean of the heights is the origin: mean gap and mean displacement are one.
            Boundary::Periodic => {
                self.highest + (yielded - (mean_gap - mean_depth)) * scales.length
            }
            Boundary::Free => self.highest + (yielded - mean_displacement) * scales.length,
        };
        Position {
            approach,
            mean_gap: mean_gap * scales.length,
            mean_pressure: mean_pressure * scales.pressure,
        }
    }

    /// By how much the net pressures of a state at a position, whose force this is (N), miss what the path prescribes, in its
    /// unit: the load, or the position of the far end of a spring, a layer or a free half-space.
    ///
    /// The residual bounds the imbalance of points against their pressures. Where these are far larger than their mean, as
    /// the tension of a short-ranged law is, all points may be within the tolerance, and their sum not at the load.
    pub fn missed(&self, position: &Position, force: f64) -> f64 {
        let missed = force / self.solved_area() - position.mean_pressure;
        match self.control {
            Control::Force => missed * self.solved_area(),
            Control::Pressure => missed,
            Control::Approach => self.approach_stiffness().map_or(0.0, |stiffness| {
                missed / self.problem.scales.pressure / stiffness * self.problem.scales.length
            }),
            Control::MeanGap => 0.0,
        }
    }

    /// u - g - h of a state, reduced: on a periodic grid what the mean displacement leaves, the rigid
    /// offset on a free one.
    pub fn offset(&self, position: &Position, mean_displacement: f64) -> f64 {
        match self.problem.boundary {
            Boundary::Periodic => {
                let mean_pressure = position.mean_pressure / self.problem.scales.pressure;
                self.mean_compliance() * mean_pressure - mean_displacement
            }
            Boundary::Free => (position.approach - self.highest) / self.problem.scales.length,
        }
    }
}
