//! Plastic flow: what the heights of a path have lost for good.
//!
//! Within a step the solver lets the gap go below zero where the pressure has reached the hardness,
//! see [`kernel::floor`](crate::kernel::floor). At its end that depth is taken off the heights, and
//! the gap there is zero again: displacement and pressure stay as they are, and the next step starts
//! from heights that do not come back. A step is thus the minimum of the stored energy and of the
//! hardness times the volume that flows in it.

use super::hand_over::{HandOver, HandedField};
use super::setup::Setup;
use crate::backend::BackendError;
use crate::solver::{ContactSolver, Hold, Load};

/// Name of the depths among the fields that are handed on.
const FLOWED: &str = "flowed";

/// Depths by which flow has lowered the heights, reduced, one a solved point.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Flow {
    /// Empty until something flows.
    depths: Vec<f64>,
    /// Hardness times the volume that a unit of depth over a pixel holds, J.
    unit: f64,
}

impl Flow {
    /// What has flowed on a path so far; `None` for a solid that cannot.
    pub fn of(setup: &Setup, hand_over: &HandOver) -> Option<Flow> {
        let hardness = setup.scene.solid.hardness?;
        let depths = hand_over.field(FLOWED).unwrap_or_default().to_vec();
        let unit = hardness * setup.problem.scales.length * setup.problem.grid.pixel_area();
        Some(Flow { depths, unit })
    }

    /// The field from which a path goes on, if anything has flowed.
    pub fn handed_field(&self) -> Option<HandedField> {
        (!self.depths.is_empty()).then(|| HandedField {
            name: FLOWED.to_owned(),
            values: self.depths.clone(),
        })
    }

    /// Tells a solver what has flowed.
    pub fn lower(&self, solver: &mut ContactSolver) {
        if !(self.depths.is_empty() && solver.plastic_depths().is_empty()) {
            solver.set_plastic_depths(&self.depths);
        }
    }

    /// Ends a step: what its gap has below zero is taken off the heights.
    pub fn settle(&mut self, solver: &mut ContactSolver) -> Result<(), BackendError> {
        let shape = solver.problem().shape;
        let mut gap = solver.gap()?;
        let mut flows = false;
        let lines = gap.chunks_exact_mut(shape.points[0]).take(shape.surface[1]);
        for (row, line) in lines.enumerate() {
            for (column, gap) in line[..shape.surface[0]].iter_mut().enumerate() {
                if *gap < 0.0 {
                    if self.depths.is_empty() {
                        self.depths = vec![0.0; shape.len()];
                    }
                    self.depths[row * shape.points[0] + column] -= *gap;
                    *gap = 0.0;
                    flows = true;
                }
            }
        }
        if flows {
            solver.set_plastic_depths(&self.depths);
            solver.set_gap(&gap);
        }
        Ok(())
    }

    /// Energy that the flow has dissipated, J.
    pub fn energy(&self) -> f64 {
        self.unit * self.depths.iter().sum::<f64>()
    }
}

/// A load as the solver holds it on heights that have flowed: a mean gap is wider by what they have
/// lost.
pub(super) fn load_on(solver: &ContactSolver, load: Load) -> Load {
    let depths = solver.plastic_depths();
    match load.hold {
        Hold::Gap(target) if !depths.is_empty() => Load {
            hold: Hold::Gap(target + depths.iter().sum::<f64>() / depths.len() as f64),
            ..load
        },
        _ => load,
    }
}
