//! A law that differs from point to point by a factor on its tension.

use super::Cohesion;
use crate::real::Real;

/// A law at each point of a block of rows.
pub trait LawField<T: Real>: Copy {
    /// The law at one point.
    type Here: Cohesion<T>;
    /// The law at the point `index` of the block.
    fn at(&self, index: usize) -> Self::Here;
}

/// The same law at every point.
#[derive(Clone, Copy, Debug)]
pub struct Uniform<L>(pub L);

impl<T: Real, L: Cohesion<T>> LawField<T> for Uniform<L> {
    type Here = L;
    #[inline(always)]
    fn at(&self, _index: usize) -> L {
        self.0
    }
}

/// A law whose tension is multiplied by a factor of its own at each point.
#[derive(Clone, Copy, Debug)]
pub struct Patterned<'a, L, T> {
    /// The law where the factor is 1.
    pub law: L,
    /// One factor a point.
    pub factor: &'a [T],
}

impl<T: Real, L: Cohesion<T>> LawField<T> for Patterned<'_, L, T> {
    type Here = Scaled<L, T>;
    #[inline(always)]
    fn at(&self, index: usize) -> Scaled<L, T> {
        Scaled {
            law: self.law,
            factor: self.factor[index],
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
    fn difference(&self, gap: T, step: T) -> T {
        self.factor * self.law.difference(gap, step)
    }
}

/// Runs an expression with the law of the scene, as a [`LawField`] of the kernel's number:
/// [`Uniform`] where `factor` is empty, [`CorrectedField`](super::CorrectedField) where there is a
/// base (its gap and residual; both empty without one).
#[macro_export]
#[doc(hidden)]
macro_rules! with_law_field {
    ($law:expr, $factor:expr, $base:expr, $T:ty, $name:ident => $body:expr) => {
        $crate::with_law!($law, $T, law => {
            let factor: &[$T] = $factor;
            let base: [&[$T]; 2] = $base;
            if !base[0].is_empty() {
                let $name = $crate::law::CorrectedField { law, factor, base };
                $body
            } else if factor.is_empty() {
                let $name = $crate::law::Uniform(law);
                $body
            } else {
                let $name = $crate::law::Patterned { law, factor };
                $body
            }
        })
    };
}
