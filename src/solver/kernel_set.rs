//! The kernel variants for the constraint of a problem, and the numbers that stay fixed during a solve.

use super::load::{Hold, Load};
use super::multilevel::{finest_compliances, level_compliance, softening};
use super::problem::Problem;
use crate::kernel::{Constraint, Kernel, Params};
use crate::kernel::{descent, measure, multilevel, refinement, search, trial, update};

/// The kernels of one constraint. Under a prescribed mean gap those of `mean_gap` replace `descent`, `trial`
/// and `update_state`.
pub(super) struct KernelSet {
    pub residual: &'static Kernel,
    pub load_residual: &'static Kernel,
    pub descent: &'static Kernel,
    pub trial: &'static Kernel,
    pub search: &'static Kernel,
    pub update_state: &'static Kernel,
    pub mean_gap: MeanGapSet,
    /// Those that replace their namesakes with a multilevel preconditioner.
    pub levels: LevelSet,
    /// The kernels of the outer state; `None` under a hardness.
    pub outer: Option<OuterSet>,
}

/// The kernels under a prescribed mean gap.
pub(super) struct MeanGapSet {
    pub descent: &'static Kernel,
    pub trial: MeanGapTrial,
    pub advance: &'static Kernel,
    pub balance: &'static Kernel,
}

/// How a trial is brought back to the mean gap.
pub(super) enum MeanGapTrial {
    /// By linearity, in one pass.
    Linear(&'static Kernel),
    /// By one pass that sums the deviation, and one that corrects it.
    TwoPasses {
        direction: &'static Kernel,
        load_trial: &'static Kernel,
    },
}

/// The kernels that store the projected residual, of the present state and after a step, those that end
/// with z, and the one that begins a second sweep.
#[derive(Clone, Copy)]
pub(super) struct LevelSet {
    pub store_residual: &'static Kernel,
    pub update_state: &'static Kernel,
    pub descent: &'static Kernel,
    pub mean_gap_descent: &'static Kernel,
    /// Of a constraint whose laws may fall with the gap from a wall on.
    pub soften: Option<&'static Kernel>,
}

/// The kernels that add a correction to the outer state and restore its mean gap.
#[derive(Clone, Copy)]
pub(super) struct OuterSet {
    pub add_correction: &'static Kernel,
    pub restore_gap: &'static Kernel,
}

impl KernelSet {
    /// Those of a problem.
    pub(super) fn new(problem: &Problem) -> KernelSet {
        KernelSet::for_constraint(match problem.hardness {
            _ if !problem.law.has_wall() => Constraint::Smooth,
            Some(_) => Constraint::HardnessLimit,
            None => Constraint::Unilateral,
        })
    }

    fn for_constraint(constraint: Constraint) -> KernelSet {
        let at = constraint as usize;
        let trial = match constraint {
            Constraint::Unilateral => MeanGapTrial::Linear(&trial::LINEAR_TRIAL),
            Constraint::HardnessLimit => MeanGapTrial::TwoPasses {
                direction: &trial::TWO_SIDED_DIRECTION,
                load_trial: &trial::TWO_SIDED_LOAD_TRIAL,
            },
            Constraint::Smooth => MeanGapTrial::TwoPasses {
                direction: &trial::SMOOTH_DIRECTION,
                load_trial: &trial::SMOOTH_LOAD_TRIAL,
            },
        };
        let outer = match constraint {
            Constraint::Unilateral => Some(0),
            Constraint::HardnessLimit => None,
            Constraint::Smooth => Some(1),
        };
        KernelSet {
            residual: &measure::RESIDUAL[at],
            load_residual: &measure::LOAD_RESIDUAL[at],
            descent: &descent::DESCENT[at],
            trial: &trial::TRIAL[at],
            search: &search::SEARCH[at],
            update_state: &update::UPDATE_STATE[at],
            mean_gap: MeanGapSet {
                descent: &descent::MEAN_GAP_DESCENT[at],
                trial,
                advance: &update::ADVANCE[at],
                balance: &update::BALANCE[at],
            },
            levels: LevelSet {
                store_residual: &measure::STORE_RESIDUAL[at],
                update_state: &update::UPDATE_AND_STORE[at],
                descent: &multilevel::LEVEL_DESCENT[at],
                mean_gap_descent: &multilevel::MEAN_GAP_LEVEL_DESCENT[at],
                soften: multilevel::SOFTEN.get(at),
            },
            outer: outer.map(|at| OuterSet {
                add_correction: &refinement::ADD_CORRECTION[at],
                restore_gap: &refinement::RESTORE_OUTER_GAP[at],
            }),
        }
    }

    /// Whether a trial is brought back to a prescribed mean gap by linearity.
    pub(super) fn is_linear(&self) -> bool {
        matches!(self.mean_gap.trial, MeanGapTrial::Linear(_))
    }
}

/// The numbers of a problem under a load, for fields of a relative rounding error.
pub(super) fn params_under(problem: &Problem, load: &Load, epsilon: f64) -> Params {
    let mut params = params_of_problem(problem, epsilon);
    params.softening = softening(problem);
    match load.hold {
        Hold::Gap(_) => params.prescribed_mean_gap = true,
        Hold::Pressure(pressure) if load.zero_stiffness > 0.0 => {
            // A spring presses with the whole pressure of its far end, and takes most of it back.
            let pressed = pressure.abs() * params.points.sqrt() / params.stiffness_max;
            params.heights_norm = params.heights_norm.max(pressed);
        }
        Hold::Pressure(pressure) => {
            params.may_detach = pressure < 0.0 || (pressure == 0.0 && problem.law.is_adhesive());
        }
    }
    params
}

/// The numbers of a problem that stay fixed whatever the load.
pub(super) fn params_of_problem(problem: &Problem, epsilon: f64) -> Params {
    let points = problem.shape.surface_len() as f64;
    let [own_compliance, neighbour_compliance] = finest_compliances(problem);
    let stiffness_max = problem.stiffness_max();
    Params {
        law: problem.law,
        stiffness_max,
        pressure_floor: 1e-6
            * (problem.rms_slope * problem.scales.lateral / problem.scales.length)
            * points.sqrt(),
        tolerance: 0.0,
        heights_norm: rounded_beside(problem),
        prescribed_mean_gap: false,
        may_detach: false,
        points,
        smooth_stiffness: 0.2 * stiffness_max,
        level_compliance: level_compliance(problem),
        own_compliance,
        neighbour_compliance,
        softening: 0.0,
        hardness: problem.hardness.unwrap_or(f64::INFINITY),
        epsilon,
    }
}

/// Rounding errors, of its range, in a Lennard-Jones gap: those of the inversion v(g).
const CORE_ROUNDINGS: f64 = 2.0;

/// Norm over the surface points of what sets the rounding of a gap, whatever the load: the heights. A
/// Lennard-Jones law evaluates g + range, and where its traction vanishes that is a difference of two
/// parts, rounded like the range times the slope there, 16 w/range^2.
fn rounded_beside(problem: &Problem) -> f64 {
    let heights = problem.heights.norm();
    if problem.law.has_wall() {
        return heights;
    }
    let steep = problem.law.slope(0.0).abs() / problem.stiffness_max();
    let points = problem.shape.surface_len() as f64;
    heights.max(CORE_ROUNDINGS * problem.law.range() * steep.max(1.0) * points.sqrt())
}
