//! The multilevel preconditioner, which takes a tenth of a transform and keeps the count of iterations nearly
//! free of the grid.
//!
//! The compliance of an elastic solid is in proportion to the length of a wave. So the waves that only the
//! full grid holds are answered by one number, those that half the points each way hold by twice that number,
//! and so on, point by point, without transforms; what is left of the compliance is a convolution on the coarsest level.
//! The inverse of the stiffness would carry waves across contacts, where they do not belong: interpolation
//! reaches no further than its cells, and the coarsest level is weighed by the share of free points there.

use std::f64::consts::TAU;

use super::kernel_set::{KernelSet, LevelSet};
use super::problem::Problem;
use super::stiffness::on_level;
use crate::backend::{Backend, Factors, Field, Level, Shape, Spectrum};
use crate::elastic::Stiffness;
use crate::kernel::{Gate, Params, displacement, multilevel};

/// Halvings of the grid at most.
const MOST_LEVELS: usize = 3;
/// Fewest points each way of the coarsest level.
const FEWEST_COARSE: usize = 8;
/// Compliance of a level over that of the shortest wave along an axis there.
const OVER_SHORTEST: f64 = 1.4;
/// Share of its four neighbours in the residual that the finest level answers. The next level sees waves of four pixels
/// only in part and the shortest not at all: these would else be answered by as much.
const SMOOTHED_SHARE: f64 = 0.3;
/// Share of the compliance of long waves that the coarsest level answers over a wall; the finer ones answer them too.
const COARSEST_SHARE: f64 = 0.5;
/// Growth of the compliance from a level's shortest wave to the next one's, twofold on a half-space, from
/// which another level pays: a thin layer answers all long waves alike.
const LEAST_GROWTH: f64 = 1.5;
/// Sides of a pixel over each other from which one number does not stand for its shortest waves.
const LONGEST_PIXEL: f64 = 2.0;
/// Residual below which the levels precondition with adhesion over a wall. Above it fronts move, and the compliance
/// itself leads more straightly to the nearest of several solutions: points that a detour closes would stick.
pub(super) const EXACT_UNTIL: f64 = 1e-2;
/// Fine pixels over which the share of free points is smoothed.
const SMOOTHED: f64 = 1.0;

/// Most of the factor on the slope of an attraction in the second sweep.
const MOST_SOFTENING: f64 = 2.0;
/// Least of it: below, pixels are too long for the law, and a second sweep saves less than it costs.
const LEAST_SOFTENING: f64 = 0.5;
/// Most solved points of a second sweep. On larger grids long waves set the rate, which slopes at the edges hardly change:
/// rough contact on 1024 x 1024 points takes 0.96 of the transforms and 1.04 of the seconds.
const MOST_SOFTENED: usize = 1 << 19;
/// The steepest slope times that factor over E*/dx, at most.
const SOFTENED: f64 = 1.0 / 3.0;

/// Most fields of a step's update: direction, step, gap, pressure, and the residuals after and before it.
const MOST_UPDATED: usize = 6;

/// Stiffness of the shortest wave along an axis after so many halvings, the larger one.
fn shortest(problem: &Problem, halvings: usize) -> f64 {
    let [nx, ny] = problem.shape.points.map(|points| (points >> halvings) / 2);
    problem.stiffness.at(nx, 0).max(problem.stiffness.at(0, ny))
}

/// Whether it is known: a sketch has no table, whose waves are those of a half-space, nearly.
fn has_shortest(problem: &Problem) -> bool {
    !(problem.is_sketch() && matches!(problem.stiffness, Stiffness::Table(_)))
}

/// Compliance by which each level of a problem answers its own waves, in the measure of its scaled residual.
pub(super) fn level_compliance(problem: &Problem) -> f64 {
    let stiffness = if has_shortest(problem) {
        shortest(problem, 0)
    } else {
        0.0
    };
    if stiffness > 0.0 {
        OVER_SHORTEST / stiffness
    } else {
        0.0
    }
}

/// The same of the finest level for the residual at a point itself, and at each of its neighbours.
pub(super) fn finest_compliances(problem: &Problem) -> [f64; 2] {
    let compliance = level_compliance(problem);
    [
        (1.0 - SMOOTHED_SHARE) * compliance,
        SMOOTHED_SHARE / 4.0 * compliance,
    ]
}

/// Share of the compliance of long waves that the coarsest level answers: all of it where a law repels by itself, since
/// all points are free there.
pub(super) fn coarsest_share(problem: &Problem) -> f64 {
    if problem.law.has_wall() {
        COARSEST_SHARE
    } else {
        1.0
    }
}

/// Factor a on D, the slope with which an attraction falls as the gap grows, in the second sweep: M (r + a D M r) has two
/// terms of the inverse of 1/M - D. 0, for one sweep, where no attraction falls, or too steeply for the pixels, without
/// levels, and on large grids.
pub(super) fn softening(problem: &Problem) -> f64 {
    let factor = own_softening(problem);
    if factor == 0.0 {
        return 0.0;
    }
    let strongest = match &problem.law_factor {
        // Of all ranks.
        Some(factors) if !problem.is_sketch() => problem.share.greatest_of(factors),
        _ => 1.0,
    };
    (factor / strongest).min(MOST_SOFTENING)
}

/// That factor for the law alone, without a map of it; 0 where there is one sweep alone.
fn own_softening(problem: &Problem) -> f64 {
    let law = problem.law;
    let falls = law.has_wall() && law.has_tail();
    let levels = halvings(problem) > 0 && problem.shape.len() <= MOST_SOFTENED;
    if !falls || !levels {
        return 0.0;
    }
    // E* in reduced units is the unit of lengths along the surface.
    let pixel = problem.grid.longer_pixel() / problem.scales.lateral;
    let factor = SOFTENED / (pixel * law.steepest_fall());
    if factor < LEAST_SOFTENING {
        return 0.0;
    }
    factor
}

/// Halvings of the grid that pay for a problem; none where it cannot be halved.
pub(super) fn halvings(problem: &Problem) -> usize {
    let pixel = [problem.grid.dx(), problem.grid.dy()];
    if pixel[0].max(pixel[1]) > LONGEST_PIXEL * pixel[0].min(pixel[1]) {
        return 0;
    }
    let fits = |level: &usize| {
        problem
            .shape
            .points
            .iter()
            .all(|points| points.is_multiple_of(2 << level) && points >> level >= FEWEST_COARSE)
    };
    let grows = |level: &usize| {
        *level == 1
            || !has_shortest(problem)
            || shortest(problem, level - 2) >= LEAST_GROWTH * shortest(problem, level - 1)
    };
    (1..=MOST_LEVELS)
        .take_while(|level| fits(level) && grows(level))
        .count()
}

/// Whether solves of a problem take the compliance itself far from a solution: if there are several solutions and
/// a wall to which points stick. Where a law repels by itself, nothing sticks.
pub(super) fn sticks(problem: &Problem) -> bool {
    problem.law.is_adhesive() && problem.law.has_wall()
}

/// The factor of a wave that smooths the share of free points.
pub(super) fn smoothing(problem: &Problem, waves: [usize; 2]) -> f64 {
    // Their phases from one fine pixel to the next.
    let points = problem.shape.points;
    let phase = |axis: usize| TAU * waves[axis] as f64 / points[axis] as f64;
    (-SMOOTHED * SMOOTHED * (phase(0).powi(2) + phase(1).powi(2))).exp()
}

/// What the coarsest level answers a wave of this stiffness with: a share of the compliance, in the measure of its scaled
/// residual; 0 at the zero wavevector. To take off what the finer levels answer saves nothing.
fn coarsest_compliance(problem: &Problem, stiffness: f64, halvings: usize) -> f64 {
    if stiffness > 0.0 {
        coarsest_share(problem) / (stiffness * (1_usize << halvings) as f64)
    } else {
        0.0
    }
}

/// The levels and their fields.
pub(super) struct Multilevel {
    fine: Level,
    halvings: usize,
    /// The projected residual on the fine level.
    residual: Field,
    /// The residual of the second sweep, where an attraction falls with the gap.
    softened: Option<Field>,
    /// Restricted residuals on the levels, the coarsest one last; on those before it z comes in their place.
    restricted: Vec<Field>,
    share: Field,
    weight: Field,
    coarsest_z: Field,
    smoothing: Spectrum,
    compliance: Spectrum,
    kernels: LevelSet,
}

impl Multilevel {
    /// Plans the levels of a problem; `None` where its grid cannot be halved.
    pub fn plan(backend: &mut dyn Backend, fine: Level, problem: &Problem) -> Option<Self> {
        let halved = |times: usize| {
            let [nx, ny] = problem.shape.points.map(|points| points >> times);
            Shape::whole(nx, ny)
        };
        let halvings = halvings(problem);
        if halvings == 0 || !(1..=halvings).all(|times| backend.suits(halved(times))) {
            return None;
        }
        let residual = backend.field(fine, "projected_residual");
        let softened =
            (own_softening(problem) > 0.0).then(|| backend.field(fine, "softened_residual"));
        let mut restricted = Vec::new();
        for times in 1..halvings {
            let level = backend.sweep_level("between", halved(times));
            restricted.push(backend.field(level, "restricted"));
        }
        let level = backend.level("coarsest", halved(halvings));
        restricted.push(backend.field(level, "restricted"));
        let share = problem.share.of(halved(halvings));
        // Where a rank has ended nothing is answered, and the next exchange says so.
        let known = (!problem.is_sketch())
            .then(|| on_level(&problem.stiffness, &problem.share, &share).ok())
            .flatten();
        let smoothing = |waves| smoothing(problem, waves);
        let compliance = |[kx, ky]: [usize; 2]| match &known {
            Some(stiffness) if kx + ky > 0 => {
                coarsest_compliance(problem, stiffness.at(kx, ky), halvings)
            }
            _ => 0.0,
        };
        Some(Multilevel {
            fine,
            halvings,
            residual,
            softened,
            restricted,
            share: backend.field(level, "share"),
            weight: backend.field(level, "weight"),
            coarsest_z: backend.field(level, "coarsest_z"),
            smoothing: backend.spectrum(level, "smoothing", Factors::Each(&smoothing)),
            compliance: backend.spectrum(level, "coarsest_compliance", Factors::Each(&compliance)),
            kernels: KernelSet::new(problem).levels,
        })
    }

    /// The fields of the residuals on the fine level.
    pub fn residuals(&self) -> impl Iterator<Item = Field> + use<> {
        [self.residual].into_iter().chain(self.softened)
    }

    /// Sets the compliance of the zero mode.
    pub fn set_zero_mode(&self, backend: &mut dyn Backend, value: f64) {
        let cell = (1_usize << self.halvings) as f64;
        backend.set_zero_mode(self.compliance, value / cell);
    }

    /// Records the projected residual of a state, with its measure.
    pub fn load_residual(&self, backend: &mut dyn Backend, [gap, pressure]: [Field; 2]) {
        let fields = [gap, pressure, self.residual];
        backend.run(self.kernels.store_residual, self.fine, &fields);
    }

    /// Records the step and the projected residual after it; `state` is what the kernel takes beside it, of which the
    /// residual before the step comes last.
    pub fn update_state(&self, backend: &mut dyn Backend, state: &[Field]) {
        // An array, since an iteration allocates nothing.
        let mut fields = [self.residual; MOST_UPDATED];
        let count = state.len();
        fields[..count - 1].copy_from_slice(&state[..count - 1]);
        fields[count] = state[count - 1];
        let update_state = self.kernels.update_state;
        backend.run(update_state, self.fine, &fields[..=count]);
    }

    /// Records the preconditioned residual z of the projected one; `state` is gap, pressure and the residual
    /// before, `direction` where the mean gap is prescribed; `params` say whether the levels sweep twice.
    pub fn descend(
        &self,
        backend: &mut dyn Backend,
        params: &Params,
        state: [Field; 3],
        direction: Option<Field>,
    ) {
        let [gap, pressure, previous] = state;
        let residual = self.residual;
        let coarsest = self.restrict(backend, residual);
        let level = coarsest.level;
        backend.run(&multilevel::FREE_SHARE, level, &[self.share, residual]);
        backend.run(&displacement::LOAD_FIELD_AHEAD, level, &[self.share]);
        backend.multiply(self.smoothing, false, Gate::Ahead);
        let fields = [coarsest, self.weight];
        backend.run(&multilevel::WEIGH, level, &fields);
        let mut coarser = self.refine(backend);
        let mut answered = residual;
        let softened = self.softened.filter(|_| params.softening > 0.0);
        if let (Some(soften), Some(softened)) = (self.kernels.soften, softened) {
            let fields = [gap, residual, residual, coarser];
            backend.run(soften, self.fine, &fields);
            backend.run(&multilevel::STORE_RETAINED, self.fine, &[softened]);
            let fields = [self.restrict(backend, softened), self.weight];
            backend.run(&multilevel::LOAD_WEIGHTED, level, &fields);
            coarser = self.refine(backend);
            answered = softened;
        }
        match direction {
            Some(direction) => {
                let fields = [gap, pressure, previous, direction, answered, coarser];
                backend.run(self.kernels.mean_gap_descent, self.fine, &fields);
            }
            None => {
                let of_state = [gap, pressure, previous, answered, coarser];
                // At a wall the projected residual says all.
                let at_wall = [residual, previous, answered, coarser];
                let descent = self.kernels.descent;
                let fields = if descent.law { &of_state[..] } else { &at_wall };
                backend.run(descent, self.fine, fields);
            }
        }
    }

    /// Records a residual on all coarser levels; gives that of the coarsest one.
    fn restrict(&self, backend: &mut dyn Backend, residual: Field) -> Field {
        let mut finer = residual;
        for &restricted in &self.restricted {
            backend.run(&multilevel::COARSEN, restricted.level, &[restricted, finer]);
            finer = restricted;
        }
        finer
    }

    /// Records z of the coarser levels, from the weighed rows of the coarsest one on; gives that of the finest of them.
    fn refine(&self, backend: &mut dyn Backend) -> Field {
        backend.multiply(self.compliance, false, Gate::Ahead);
        let fields = [self.weight, self.coarsest_z];
        let level = self.weight.level;
        backend.run(&multilevel::STORE_WEIGHTED, level, &fields);
        let mut coarser = self.coarsest_z;
        for &z in self.restricted.iter().rev().skip(1) {
            backend.run(&multilevel::REFINE, z.level, &[z, coarser]);
            coarser = z;
        }
        coarser
    }
}
