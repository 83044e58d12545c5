//! A law that differs from point to point by a factor on its tension.

use super::Cohesion;
use crate::real::Real;

/// A law that differs from point to point.
pub trait LawField<T: Real>: Copy {
    /// The law at one point.
    type Here: Cohesion<T>;
    /// The law at a point with this factor on its tension, and this gap of an outer state.
    fn here(&self, factor: T, outer_gap: T) -> Self::Here;
}

/// A law whose tension is multiplied by a factor of its own at each point; a factor of 1 changes no bit.
#[derive(Clone, Copy, Debug)]
pub struct AdhesionMap<L>(pub L);

impl<T: Real, L: Cohesion<T>> LawField<T> for AdhesionMap<L> {
    type Here = Scaled<L, T>;
    #[inline(always)]
    fn here(&self, factor: T, _: T) -> Scaled<L, T> {
        Scaled {
            law: self.0,
            factor,
        }
    }
}

/// A law with its tension multiplied by a factor; the range stays.
#[derive(Clone, Copy, Debug)]
pub struct Scaled<L, T> {
    law: L,
    factor: T,
}

impl<T: Real, L: Cohesion<T>> Cohesion<T> for Scaled<L, T> {
    #[inline(always)]
    fn traction(&self, gap: T) -> T {
        self.factor * self.law.traction(gap)
    }
    #[inline(always)]
    fn energy(&self, gap: T) -> T {
        self.factor * self.law.energy(gap)
    }
    #[inline(always)]
    fn slope(&self, gap: T) -> T {
        self.factor * self.law.slope(gap)
    }
    #[inline(always)]
    fn bend(&self, gap: T) -> T {
        self.factor * self.law.bend(gap)
    }
    #[inline(always)]
    fn difference(&self, gap: T, step: T) -> T {
        self.factor * self.law.difference(gap, step)
    }
    #[inline(always)]
    fn factored(&self, tension: T) -> T {
        self.factor * tension
    }
    #[inline(always)]
    fn repelling_gap(&self, pressure: T) -> T {
        self.law.repelling_gap(pressure / self.factor)
    }
}
