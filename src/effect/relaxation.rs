//! `[[solid.relaxation]]`, a viscoelastic solid: the state of its Maxwell branches from step to step.
//!
//! The pressure of a wave is its stiffness times `E_inf u + sum E_k m_k`, and each branch follows
//! `dm/dt + m/tau = du/dt`. Over a step of constant rate that is exactly
//! `m' = alpha m + beta (u' - u)` with `alpha = exp(-dt/tau)`, `beta = (tau/dt)(1 - alpha)`. So a
//! step is the elastic contact of a solid of modulus `E_inf + sum E_k beta_k` whose surface has
//! been moved by `sum E_k (alpha_k m_k - beta_k u)/E`, point by point.
//!
//! # Source
//! Taylor, Pister & Goudreau 1970; Simo & Hughes 1998, sec. 10.3.

use std::sync::Arc;

use crate::backend::long_field::LongField;
use crate::backend::{BackendError, host_fields};
use crate::scene::{RelaxationScene, Scene, SolidScene};
use crate::solver::{ContactSolver, Problem};
use crate::study::{
    Carry, Checkpoint, CheckpointField, DOUBLE, EVALUATION, Hooks, HostBytes, Plan, Setup, Sizes,
    SolvedStep,
};
use crate::units::format_si;

/// Name of the displacement among the fields of a checkpoint.
const DISPLACEMENT: &str = "displacement";

/// Name of a branch's spring among them; the branch counts from 1.
fn spring_name(branch: usize) -> String {
    format!("spring {branch}")
}

/// A viscoelastic solid.
pub(super) struct Relaxation;

impl Hooks for Relaxation {
    fn name(&self) -> &'static str {
        "relaxation"
    }

    fn purpose(&self) -> &'static str {
        "the solid is viscoelastic: stiff to what is fast, soft to what is slow, and it dissipates"
    }

    fn is_on(&self, scene: &Scene) -> bool {
        !scene.solid.relaxation.is_empty()
    }

    fn remove_from(&self, scene: &mut Scene) {
        scene.solid.relaxation.clear();
    }

    fn example(&self) -> &'static [(&'static str, &'static str)] {
        &[("solid.relaxation", "[{ modulus = 1.0, time = 1.0 }]")]
    }

    fn matters(&self, plan: &Plan) -> String {
        let path: f64 = plan.scene.loading.durations.iter().flatten().sum();
        let branches = plan.scene.solid.relaxation.iter();
        let deborah: Vec<String> = branches
            .map(|branch| format!("{:.2e}", branch.time / path))
            .collect();
        format!(
            "matters where the relaxation times of the branches are near the time of loading: here their times are {} of the path's {} (Deborah numbers)",
            deborah.join(", "),
            format_si(path, "s")
        )
    }

    fn kept_fields(&self, scene: &Scene) -> Vec<&'static str> {
        // The displacement and the spring of each branch.
        vec!["history"; scene.solid.relaxation.len() + 1]
    }

    fn host_bytes(&self, sizes: &Sizes) -> HostBytes {
        HostBytes {
            // The offset of the surface by its history, and the problem of a duration.
            kept: DOUBLE * (sizes.solved + sizes.points),
            // The displacement beside the old one, or the pressure of a spring as it is read beside the results.
            passing: DOUBLE * sizes.solved + EVALUATION * sizes.points,
            ..HostBytes::default()
        }
    }

    // Viscous dissipation cannot be told from that of a jump.
    fn hides_jumps(&self) -> bool {
        true
    }

    fn depends_on_duration(&self) -> bool {
        true
    }

    fn problem_over(&self, setup: &Setup, duration: f64) -> Option<Problem> {
        let modulus = effective_modulus(&setup.scene.solid, duration);
        Some(
            setup
                .problem
                .with_contact_modulus(modulus, setup.solved_law()),
        )
    }

    fn carry(&self, setup: &Setup, checkpoint: &Checkpoint) -> Option<Box<dyn Carry>> {
        let solid = &setup.scene.solid;
        let mut history = History::at_rest(solid, setup.problem.share.len());
        if let Some(values) = checkpoint.shared(DISPLACEMENT) {
            history.displacement = values;
        }
        for (branch, spring) in history.springs.iter_mut().enumerate() {
            if let Some(values) = checkpoint.shared(&spring_name(branch + 1)) {
                *spring = values;
            }
        }
        Some(Box::new(history))
    }
}

/// `(alpha, beta)` of a branch over a step, for the step's share of its relaxation time.
pub fn branch_coefficients(ratio: f64) -> (f64, f64) {
    // A step in no time loads the whole branch.
    let beta = if ratio > 0.0 {
        -(-ratio).exp_m1() / ratio
    } else {
        1.0
    };
    ((-ratio).exp(), beta)
}

/// Effective contact modulus of a step of `duration` (s), Pa: between the instantaneous and the relaxed one.
fn effective_modulus(solid: &SolidScene, duration: f64) -> f64 {
    solid
        .relaxation
        .iter()
        .fold(solid.contact_modulus, |modulus, branch| {
            modulus + branch.modulus * branch_coefficients(duration / branch.time).1
        })
}

/// The state of a viscoelastic solid: its displacement and that of each branch's spring.
///
/// Displacements are reduced and hold one value a solved point. Copies share them until a step changes one.
#[derive(Clone)]
struct History {
    /// Displacement at the end of the last step.
    displacement: Arc<LongField<f64>>,
    /// Displacement of the spring of each branch, in the order of the scene.
    springs: Vec<Arc<LongField<f64>>>,
    /// Offset of the surface by its history in the present step.
    offset: Vec<f64>,
}

impl History {
    /// A solid at rest.
    fn at_rest(solid: &SolidScene, points: usize) -> History {
        History {
            displacement: Arc::new(LongField::zeros(points)),
            springs: solid
                .relaxation
                .iter()
                .map(|_| Arc::new(LongField::zeros(points)))
                .collect(),
            offset: Vec::new(),
        }
    }

    /// Offset of the surface by its history over a step of `duration` (s), reduced: the pressure is the
    /// effective stiffness times the displacement plus this.
    fn offset_over(&self, solid: &SolidScene, duration: f64) -> Vec<f64> {
        let mut offset = vec![0.0; self.displacement.len()];
        let modulus = effective_modulus(solid, duration);
        for (branch, spring) in self.branches(solid) {
            let (alpha, beta) = branch_coefficients(duration / branch.time);
            let weight = branch.modulus / modulus;
            for ((value, m), u) in offset.iter_mut().zip(spring).zip(&*self.displacement) {
                *value += weight * (alpha * m - beta * u);
            }
        }
        offset
    }

    /// Ends a step of `duration` (s) at a displacement.
    fn advance(&mut self, solid: &SolidScene, duration: f64, displacement: LongField<f64>) {
        for (branch, spring) in solid.relaxation.iter().zip(&mut self.springs) {
            let (alpha, beta) = branch_coefficients(duration / branch.time);
            let steps = displacement.iter().zip(&*self.displacement);
            for (m, (new, old)) in Arc::make_mut(spring).iter_mut().zip(steps) {
                *m = alpha * *m + beta * (new - old);
            }
        }
        self.displacement = Arc::new(displacement);
    }

    /// Energy of all springs after a step of `duration` (s), J.
    fn energy(
        &self,
        solid: &SolidScene,
        duration: f64,
        solver: &mut ContactSolver,
    ) -> Result<f64, BackendError> {
        let modulus = effective_modulus(solid, duration);
        let mut energy = solid.contact_modulus / modulus * solver.energy_of(&self.displacement)?;
        for (branch, spring) in self.branches(solid) {
            energy += branch.modulus / modulus * solver.energy_of(spring)?;
        }
        let problem = solver.problem();
        let scales = problem.scales;
        Ok(energy * (scales.length * scales.pressure * problem.grid.pixel_area()))
    }

    /// The branches with their springs.
    fn branches<'a>(
        &'a self,
        solid: &'a SolidScene,
    ) -> impl Iterator<Item = (&'a RelaxationScene, &'a [f64])> {
        let springs = self.springs.iter().map(|spring| &***spring);
        solid.relaxation.iter().zip(springs)
    }
}

impl Carry for History {
    fn copy(&self) -> Box<dyn Carry> {
        Box::new(self.clone())
    }

    fn checkpoint_fields(&self) -> Vec<CheckpointField> {
        let springs = self.springs.iter().enumerate();
        let mut fields: Vec<CheckpointField> = springs
            .map(|(branch, values)| CheckpointField {
                name: spring_name(branch + 1),
                values: Arc::clone(values),
            })
            .collect();
        fields.push(CheckpointField {
            name: DISPLACEMENT.to_owned(),
            values: Arc::clone(&self.displacement),
        });
        fields
    }

    fn before_step(&mut self, setup: &Setup, solver: &mut ContactSolver, duration: f64) {
        self.offset = self.offset_over(&setup.scene.solid, duration);
        solver.set_offset(&self.offset);
    }

    /// Adds the displacement to the history, and the energy of the springs to the step.
    fn after_step(
        &mut self,
        setup: &Setup,
        solver: &mut ContactSolver,
        solved: &mut SolvedStep,
        duration: f64,
    ) -> Result<(), BackendError> {
        let solid = &setup.scene.solid;
        let offset = std::mem::take(&mut self.offset);
        let Some(evaluation) = &mut solved.evaluation else {
            // Without pressure the solid recovers: its displacement cancels the offset.
            let displacement: Vec<f64> = offset.into_iter().map(|moved| -moved).collect();
            self.advance(solid, duration, displacement.into());
            solved.left_energy = self.energy(solid, duration, solver)?;
            return Ok(());
        };
        drop(offset);
        let mut displacement = solver.gap()?;
        let problem = solver.problem();
        let length = problem.scales.length;
        let rigid = (evaluation.displacement_offset + problem.height_origin) / length;
        let width = problem.shape.points[0];
        host_fields::change_rows(&mut displacement, width, |row, line| {
            let height_at = problem.padded_row(row);
            let points = line.iter_mut().enumerate();
            points.for_each(|(x, u)| *u += height_at(x) + rigid);
        });
        let depths = solver.plastic_depths().into_iter().flatten();
        for (u, depth) in displacement.iter_mut().zip(depths) {
            *u -= depth;
        }
        self.advance(solid, duration, displacement);
        evaluation.elastic_energy = self.energy(solid, duration, solver)?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn solid() -> SolidScene {
        SolidScene {
            contact_modulus: 1.0,
            poisson_ratio: None,
            layer: None,
            hardness: None,
            relaxation: vec![RelaxationScene {
                modulus: 9.0,
                time: 0.1,
            }],
        }
    }

    /// One point under a constant pressure creeps as it was computed apart.
    #[test]
    fn creep_under_a_constant_pressure() {
        let solid = solid();
        let mut history = History::at_rest(&solid, 1);
        let step = |history: &mut History, duration: f64| {
            let displacement = 1.0 / effective_modulus(&solid, duration)
                - history.offset_over(&solid, duration)[0];
            history.advance(&solid, duration, vec![displacement].into());
            displacement
        };
        assert!((step(&mut history, 0.0) - 0.1).abs() < 1e-15);
        let mut found = 0.0;
        for _ in 0..50 {
            found = step(&mut history, 0.01);
        }
        assert!((found - 0.454101941).abs() < 1e-9, "{found}");
    }

    #[test]
    fn modulus_from_instant_to_relaxed() {
        assert_eq!(effective_modulus(&solid(), 0.0), 10.0);
        // (1 - exp(-1e9))/1e9 of the branch is left.
        assert!((effective_modulus(&solid(), 1e8) - 1.0 - 9e-9).abs() < 1e-15);
        assert!((effective_modulus(&solid(), 1e-12) - 10.0).abs() < 1e-9);
    }
}
