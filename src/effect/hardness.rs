//! `hardness` in `[solid]`, a perfectly plastic solid: the permanent indentation of the heights.
//!
//! Within a step the solver lets the gap go below zero where the pressure has reached the hardness,
//! see [`kernel::constraint`](crate::kernel::constraint). At its end that depth is taken off the heights, and
//! the gap there is zero again: displacement and pressure stay as they are, and the next step starts
//! from the indented heights. A step thus minimises the stored energy plus the hardness times the volume
//! of its plastic indentation.

use std::sync::Arc;

use crate::backend::long_field::LongField;
use crate::backend::{BackendError, Share};
use crate::scene::{Control, Scene};
use crate::solver::{ContactSolver, Hold, Load, Problem};
use crate::study::{
    Carry, Checkpoint, CheckpointField, Column, Hooks, Plan, Setup, Unreachable,
    control::Controller,
};

/// Name of the depths among the fields of a checkpoint, as versions before wrote it.
const DEPTHS: &str = "flowed";

/// Energy that plastic indentation has dissipated since the path began, J.
const ENERGY: Column = Column {
    is_dissipated_energy: true,
    ..Column::new("plastic_energy", "J", 1)
};

/// A bound on the pressure.
pub(super) struct Hardness;

impl Hooks for Hardness {
    fn name(&self) -> &'static str {
        "hardness"
    }

    fn purpose(&self) -> &'static str {
        "the pressure saturates at the hardness; plastic indentation there lowers the heights for good"
    }

    fn is_on(&self, scene: &Scene) -> bool {
        scene.solid.hardness.is_some()
    }

    fn remove_from(&self, scene: &mut Scene) {
        scene.solid.hardness = None;
    }

    fn example(&self) -> &'static [(&'static str, &'static str)] {
        &[("solid.hardness", "0.05")]
    }

    fn matters(&self, plan: &Plan) -> String {
        let scene = &plan.scene;
        let hardness = scene.solid.hardness.unwrap_or(f64::INFINITY);
        let flattening = 0.5 * scene.solid.contact_modulus * plan.outline.moments.rms_slope();
        let largest = scene.loading.path.iter().copied().fold(0.0, f64::max);
        let mean = match scene.loading.control {
            Control::Pressure => Some(largest),
            Control::Force => Some(largest / plan.outline.grid.area()),
            Control::Approach | Control::MeanGap => None,
        };
        let path = mean.map_or(String::new(), |mean| {
            format!(
                ", and the largest mean pressure of the path {:.2e}",
                mean / hardness
            )
        });
        format!(
            "matters where pressures reach it: here what flattens the roughness (E* rms slope/2) is {:.2e} of it{path}",
            flattening / hardness
        )
    }

    fn pose(&self, problem: Problem, scene: &Scene, _: Option<&[f64]>) -> Problem {
        match scene.solid.hardness {
            Some(hardness) => problem.with_hardness(hardness),
            None => problem,
        }
    }

    fn kept_fields(&self, _: &Scene) -> Vec<&'static str> {
        // The depths, kept for the path and for the solver.
        vec!["plastic_depth"; 2]
    }

    fn refuses(&self, controller: &Controller, value: f64) -> Option<Unreachable> {
        let is_beyond = controller.is_beyond_hardness(value);
        is_beyond.then_some(Unreachable::BeyondHardness)
    }

    fn columns(&self) -> &'static [Column] {
        &[ENERGY]
    }

    fn carry(&self, setup: &Setup, checkpoint: &Checkpoint) -> Option<Box<dyn Carry>> {
        let hardness = setup.scene.solid.hardness?;
        Some(Box::new(Indentation {
            depths: checkpoint.shared(DEPTHS),
            share: setup.problem.share.clone(),
            unit: hardness * setup.problem.scales.length * setup.problem.grid.pixel_area(),
        }))
    }
}

/// Depths by which plastic indentation has lowered the heights, reduced, one a solved point.
#[derive(Clone)]
struct Indentation {
    /// `None` until the solid yields anywhere. Copies share them until a step changes them.
    depths: Option<Arc<LongField<f64>>>,
    /// The points that this process holds.
    share: Share,
    /// Hardness times the volume of a unit of depth over a pixel, J.
    unit: f64,
}

impl Carry for Indentation {
    fn copy(&self) -> Box<dyn Carry> {
        Box::new(self.clone())
    }

    fn checkpoint_fields(&self) -> Vec<CheckpointField> {
        let depths = self.depths.as_ref().map(|depths| CheckpointField {
            name: DEPTHS.to_owned(),
            values: Arc::clone(depths),
        });
        depths.into_iter().collect()
    }

    fn restore(&self, solver: &mut ContactSolver) {
        if self.depths.is_some() || solver.plastic_depths().is_some() {
            solver.set_plastic_depths(self.depths.as_deref().map(|depths| &**depths));
        }
    }

    /// The plastic depths widen a mean gap.
    fn load(&self, solver: &ContactSolver, load: Load) -> Load {
        match (load.hold, solver.plastic_depths()) {
            (Hold::Gap(target), Some(depths)) => {
                let mean = self.share.sum(depths) / solver.problem().shape.len() as f64;
                Load {
                    hold: Hold::Gap(target + mean),
                    ..load
                }
            }
            _ => load,
        }
    }

    /// Takes the part of the gap below zero off the heights.
    fn settle(&mut self, solver: &mut ContactSolver) -> Result<(), BackendError> {
        let share = &self.share;
        let mut gap = solver.gap()?;
        let problem = solver.problem();
        let shape = problem.shape;
        let yields = problem.on_surface(&gap).any(|gap| gap < 0.0);
        if share.any(yields) {
            let depths = self
                .depths
                .get_or_insert_with(|| Arc::new(LongField::zeros(share.len())));
            let depths = Arc::make_mut(depths);
            let lines = gap.chunks_exact_mut(shape.points[0]);
            let lines = lines.take(share.surface_rows().len());
            for (row, line) in lines.enumerate() {
                for (column, gap) in line[..shape.surface[0]].iter_mut().enumerate() {
                    if *gap < 0.0 {
                        depths[row * shape.points[0] + column] -= *gap;
                        *gap = 0.0;
                    }
                }
            }
            solver.set_plastic_depths(self.depths.as_deref().map(|depths| &**depths));
            solver.set_gap(&gap);
        }
        Ok(())
    }

    fn values(&self) -> Vec<(Column, f64)> {
        let depths = self.depths.as_ref();
        let sum = depths.map_or(0.0, |depths| self.share.sum(depths));
        vec![(ENERGY, self.unit * sum)]
    }
}
