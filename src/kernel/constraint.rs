//! What bounds the gap: nothing below zero (a unilateral constraint), a hardness that limits the pressure, or
//! nothing at all where the law repels by itself ([`Smooth`](super::smooth::Smooth)). Each kernel over points is
//! written once, over this trait; the WGSL parts `unilateral`, `hardness_limit` and `smooth` define the same
//! functions.
//!
//! Notation: g gap, p = K*(g+h), y = p + mean_pressure + sigma(g), F the free points (g > 0 or y < 0), d
//! direction, s trial step. Points of a pad have neither constraint nor law: they are always free.
//!
//! Under a hardness the gap goes below zero, by the depth of plastic indentation, where the pressure does not
//! grow. The energy of a point then has a kink at zero: its slope is `p + mean_pressure + sigma(0)` upwards and
//! `p + mean_pressure - hardness` downwards. A point rests at zero while the first is not negative and the
//! second not positive; else it is free to the side to which the energy falls. No step takes a point across zero.

use std::marker::PhantomData;

use super::points::{Numbers, PointKernel, side_by_side};
use super::seek::Variable;
use super::{Params, Rows, SUMS};
use crate::law::{AdhesionMap, Cohesion, CorrectedField, imbalance};
use crate::real::Real;
use crate::with_wall_law;

/// Which constraint a problem has; a kernel has a variant for each.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Constraint {
    /// g >= 0.
    Unilateral,
    /// g >= 0 until the pressure reaches the hardness.
    HardnessLimit,
    /// None: the law repels by itself.
    Smooth,
}

/// A point as the kernels see it.
#[derive(Clone, Copy)]
pub struct Here<T> {
    /// The unknown: the gap, or its correction.
    pub gap: T,
    /// The gap itself.
    pub open: T,
    /// p + mean_pressure.
    pub elastic: T,
    /// Attraction at the gap, or at zero for a gap below it; none on a pad.
    pub pull: T,
    /// y: the slope of the energy to the side to which the point may move; 0 of a point that rests at its
    /// hardness.
    pub y: T,
    /// Whether it may move.
    pub free: bool,
    /// By how much the unknown changes with the variable of the iteration: 1, of a smooth law S2.
    pub weight: T,
    /// D, the local stiffness of a smooth law; 0 of others.
    pub hardening: T,
}

/// A point of its gap and p + mean_pressure, at which the law is looked at once.
#[inline(always)]
pub fn here_at<T: Real>(
    constraint: &impl GapConstraint<T>,
    law: &impl Cohesion<T>,
    gap: T,
    elastic: T,
    in_domain: bool,
) -> Here<T> {
    if in_domain {
        return constraint.state(law, gap, elastic);
    }
    Here {
        gap,
        open: law.open(gap),
        elastic,
        pull: T::zero(),
        y: elastic,
        free: true,
        weight: T::one(),
        hardening: T::zero(),
    }
}

impl<T: Real, C: GapConstraint<T>> Numbers<T, C> {
    /// A point of its gap and elastic pressure.
    #[inline(always)]
    pub fn here_at(
        &self,
        law: &impl Cohesion<T>,
        [gap, pressure]: [T; 2],
        in_domain: bool,
    ) -> Here<T> {
        let elastic = pressure + self.mean_pressure;
        here_at(&self.constraint, law, gap, elastic, in_domain)
    }
}

/// What r is on a free point in exact balance: less than any rounding, and not 0.
const BALANCED: f64 = 1.2e-38;

/// r: y on free points in the measure of the iteration's variable, 0 elsewhere and nowhere else.
#[inline(always)]
pub fn projected_residual<T: Real>(here: &Here<T>) -> T {
    let residual = here.weight * here.y;
    let on_free = if residual == T::zero() {
        T::from_double(BALANCED)
    } else {
        residual
    };
    if here.free { on_free } else { T::zero() }
}

/// What a point adds to the stopping measure.
#[derive(Clone, Copy)]
pub struct Violation<T> {
    /// The pressure by which the point is out of balance.
    pub violation: T,
    /// Reaction of the constraint.
    pub reaction: T,
    /// Attraction.
    pub traction: T,
}

/// The trial step of a point.
#[derive(Clone, Copy)]
pub struct Tried<T> {
    /// s.
    pub step: T,
    /// Whether the constraint cut it.
    pub cut: bool,
}

/// A move along the direction.
#[derive(Clone, Copy)]
pub struct Move<T> {
    /// By how much the iteration's variable changes.
    pub moved: T,
    /// The share of the gap after it that is added.
    pub correction: T,
    /// Of a smooth law the gap after it, if it was sought.
    pub found: T,
}

/// A constraint of the gap, point by point of the surface.
pub trait GapConstraint<T: Real>: Variable<T> {
    /// Whether trial steps are kept in a field, since they cost too much to be found twice.
    const STORES_STEP: bool = false;
    /// The constraint of a solve.
    fn new(params: &Params) -> Self;
    /// A point.
    fn state(&self, law: &impl Cohesion<T>, gap: T, elastic: T) -> Here<T>;
    /// What it adds to the stopping measure.
    fn violation(&self, here: &Here<T>, stiffness_max: T) -> Violation<T>;
    /// z of a point, of its line of the preconditioned residual; also on a pad.
    #[inline(always)]
    fn preconditioned(&self, here: &Here<T>, line: T) -> T {
        if here.free { line } else { T::zero() }
    }
    /// Whether the point is below zero or may only go there.
    #[inline(always)]
    fn goes_down(&self, _open: T, _y: T) -> bool {
        false
    }
    /// s of a move along the direction.
    fn trial_step(&self, law: &impl Cohesion<T>, here: &Here<T>, way: Move<T>) -> Tried<T>;
    /// A kept s with this multiple of the local compliance taken off; also on a pad. Where none is kept, s.
    #[inline(always)]
    fn corrected_step(
        &self,
        _law: &impl Cohesion<T>,
        _here: &Here<T>,
        step: T,
        _correction: T,
        _in_domain: bool,
    ) -> T {
        step
    }
    /// Whether a step takes a point at this gap towards its constraint.
    fn touches(&self, open: T, step: T) -> bool;
    /// The gap after t of a step; what a step closes to less than `snap` is closed, at the unknown `closed`.
    fn land(&self, here: &Here<T>, step: T, t: T, snap: T, closed: T) -> T;
    /// The weight of a point in the mean pressure that a prescribed gap asks for.
    fn pressure_weight(&self, here: &Here<T>) -> T;
    /// The outer gap with a correction of it that was found in single precision.
    #[inline(always)]
    fn corrected_gap(&self, gap: T, correction: T) -> T {
        gap + correction
    }
    /// Attraction on the side of zero on which the point is, less the hardness below.
    #[inline(always)]
    fn net_traction(&self, here: &Here<T>) -> T {
        here.pull
    }
    /// Runs a kernel over some rows with each law as a concrete type.
    fn run<K, const READS: usize, const WRITES: usize, const TERMS: usize>(
        numbers: Numbers<T, Self>,
        params: &Params,
        rows: &mut Rows<T>,
        sums: &mut [f64; SUMS],
    ) where
        K: PointKernel<T, Self, READS, WRITES, TERMS>;
}

/// max(y, 0) where the point is closed.
#[inline(always)]
fn reaction<T: Real>(open: T, y: T) -> T {
    if open > T::zero() {
        T::zero()
    } else {
        y.most(T::zero())
    }
}

/// A gap that is not negative: whatever presses is carried.
#[derive(Clone, Copy, Default)]
pub struct Unilateral<T>(PhantomData<T>);

impl<T: Real> Variable<T> for Unilateral<T> {}

impl<T: Real> GapConstraint<T> for Unilateral<T> {
    #[inline(always)]
    fn new(_: &Params) -> Self {
        Unilateral(PhantomData)
    }

    #[inline(always)]
    fn state(&self, law: &impl Cohesion<T>, gap: T, elastic: T) -> Here<T> {
        let (open, pull) = (law.open(gap), law.traction(gap));
        let y = imbalance(elastic, pull);
        Here {
            gap,
            open,
            elastic,
            pull,
            y,
            free: (open > T::zero()) | (y < T::zero()),
            weight: T::one(),
            hardening: T::zero(),
        }
    }

    #[inline(always)]
    fn violation(&self, here: &Here<T>, stiffness_max: T) -> Violation<T> {
        Violation {
            violation: here.y.least(here.open * stiffness_max),
            reaction: reaction(here.open, here.y),
            traction: here.pull,
        }
    }

    /// s = s0 + correction (g + s0) with s0 = max(-g, moved). The correction is small and kept as itself, not
    /// as a factor near one, which would cost it its digits.
    #[inline(always)]
    fn trial_step(&self, _: &impl Cohesion<T>, here: &Here<T>, way: Move<T>) -> Tried<T> {
        let Move {
            moved, correction, ..
        } = way;
        let step = moved.most(-here.open);
        Tried {
            step: step + correction * (here.open + step),
            cut: here.open + moved < T::zero(),
        }
    }

    #[inline(always)]
    fn touches(&self, _: T, step: T) -> bool {
        step < T::zero()
    }

    #[inline(always)]
    fn land(&self, here: &Here<T>, step: T, t: T, snap: T, closed: T) -> T {
        // By what is left of the gap, which a cut makes exactly zero.
        let left = here.open + t * step;
        let lands = (left <= T::zero()) | ((step < T::zero()) & (left < snap));
        if lands { closed } else { here.gap + t * step }
    }

    #[inline(always)]
    fn pressure_weight(&self, here: &Here<T>) -> T {
        here.open
    }

    #[inline(always)]
    fn corrected_gap(&self, gap: T, correction: T) -> T {
        // A correction closes the points where it undoes the outer gap as single precision has it.
        let undone = -T::from_double(f64::from(gap.double() as f32));
        let moved = gap + correction;
        if (correction <= undone) | (moved < T::zero()) {
            T::zero()
        } else {
            moved
        }
    }

    fn run<K, const READS: usize, const WRITES: usize, const TERMS: usize>(
        numbers: Numbers<T, Self>,
        params: &Params,
        rows: &mut Rows<T>,
        sums: &mut [f64; SUMS],
    ) where
        K: PointKernel<T, Self, READS, WRITES, TERMS>,
    {
        if rows.outer_gap.is_empty() {
            with_wall_law!(params.law, T, law => side_by_side::<_, _, K, READS, WRITES, TERMS>(numbers, AdhesionMap(law), rows, sums));
        } else {
            with_wall_law!(params.law, T, law => side_by_side::<_, _, K, READS, WRITES, TERMS>(numbers, CorrectedField(law), rows, sums));
        }
    }
}

/// A pressure that is limited by the hardness of a perfectly plastic solid. The unknown is the gap itself,
/// never a part of it.
#[derive(Clone, Copy)]
pub struct HardnessLimit<T> {
    /// The largest net pressure, reduced.
    hardness: T,
}

impl<T: Real> Variable<T> for HardnessLimit<T> {}

impl<T: Real> GapConstraint<T> for HardnessLimit<T> {
    #[inline(always)]
    fn new(params: &Params) -> Self {
        HardnessLimit {
            hardness: T::from_double(params.hardness),
        }
    }

    #[inline(always)]
    fn state(&self, law: &impl Cohesion<T>, gap: T, elastic: T) -> Here<T> {
        let pull = law.traction(gap.most(T::zero()));
        let excess = elastic - self.hardness;
        let y = imbalance(elastic, pull);
        let below = gap < T::zero();
        let above = (gap > T::zero()) | (y < T::zero());
        let yields = below | (!above & (excess > T::zero()));
        let rests = if above { y } else { T::zero() };
        Here {
            gap,
            open: gap,
            elastic,
            pull,
            y: if yields { excess } else { rests },
            free: yields | above,
            weight: T::one(),
            hardening: T::zero(),
        }
    }

    #[inline(always)]
    fn violation(&self, here: &Here<T>, stiffness_max: T) -> Violation<T> {
        let y = imbalance(here.elastic, here.pull);
        let open = here.gap * stiffness_max;
        // The middle one of the two slopes and the gap: 0 just where one of the three states is met.
        let violation = y.least(open).most(here.elastic - self.hardness);
        Violation {
            violation,
            reaction: reaction(here.gap, y),
            traction: here.pull,
        }
    }

    #[inline(always)]
    fn goes_down(&self, open: T, y: T) -> bool {
        // A closed point that is free and does not open has a positive y, that of the hardness.
        (open < T::zero()) | ((open == T::zero()) & (y > T::zero()))
    }

    /// s = s0 + correction (g + s0) with s0 the way to clip(g + moved); below zero with the opposite sign of
    /// the correction, so that a prescribed mean is kept on either side.
    #[inline(always)]
    fn trial_step(&self, _: &impl Cohesion<T>, here: &Here<T>, way: Move<T>) -> Tried<T> {
        let Move {
            moved, correction, ..
        } = way;
        let open = here.open;
        if self.goes_down(open, here.y) {
            let step = moved.least(-open);
            Tried {
                step: step - correction * (open + step),
                cut: open + moved > T::zero(),
            }
        } else {
            let step = moved.most(-open);
            Tried {
                step: step + correction * (open + step),
                cut: open + moved < T::zero(),
            }
        }
    }

    #[inline(always)]
    fn touches(&self, open: T, step: T) -> bool {
        ((open >= T::zero()) & (step < T::zero())) | ((open < T::zero()) & (step > T::zero()))
    }

    #[inline(always)]
    fn land(&self, here: &Here<T>, step: T, t: T, snap: T, closed: T) -> T {
        // No point crosses zero. NaN stays NaN.
        let moved = here.gap + t * step;
        let lands = if self.goes_down(here.gap, here.y) {
            (moved > T::zero()) | ((step > T::zero()) & (moved > -snap))
        } else {
            (moved < T::zero()) | ((step < T::zero()) & (moved < snap))
        };
        if lands { closed } else { moved }
    }

    #[inline(always)]
    fn pressure_weight(&self, here: &Here<T>) -> T {
        here.gap.abs()
    }

    #[inline(always)]
    fn net_traction(&self, here: &Here<T>) -> T {
        if here.gap < T::zero() {
            -self.hardness
        } else {
            here.pull
        }
    }

    fn run<K, const READS: usize, const WRITES: usize, const TERMS: usize>(
        numbers: Numbers<T, Self>,
        params: &Params,
        rows: &mut Rows<T>,
        sums: &mut [f64; SUMS],
    ) where
        K: PointKernel<T, Self, READS, WRITES, TERMS>,
    {
        with_wall_law!(params.law, T, law => side_by_side::<_, _, K, READS, WRITES, TERMS>(numbers, AdhesionMap(law), rows, sums));
    }
}
