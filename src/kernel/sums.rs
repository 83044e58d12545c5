//! What kernels sum over the points, by name: one table for the kernels that fill it, the scalar kernels
//! that read it, and the WGSL of both.

use super::Reduce;
use super::declare::device_struct;

/// Sums that one kernel may hand back.
pub const MOST_SUMS: usize = 10;

/// Declares all sums with how each is put together.
macro_rules! sum_table {
    ($($(#[$doc:meta])* $name:ident: $reduce:ident,)*) => {
        device_struct! {
            /// The last value of each sum.
            pub struct Sums and back {
                $($(#[$doc])* $name: f64,)*
            }
        }

        /// One of the sums, named as the member of [`Sums`] that takes it.
        #[allow(non_camel_case_types)]
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Sum {
            $($(#[$doc])* $name,)*
        }

        impl Sum {
            /// All of them, as declared.
            pub const ALL: &'static [Sum] = &[$(Sum::$name),*];

            /// Its name.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Sum::$name => stringify!($name),)*
                }
            }

            /// How it is put together.
            pub const fn reduce(self) -> Reduce {
                match self {
                    $(Sum::$name => Reduce::$reduce,)*
                }
            }
        }

        impl Sums {
            /// The value of a sum.
            pub fn get(&self, sum: Sum) -> f64 {
                match sum {
                    $(Sum::$name => self.$name,)*
                }
            }

            /// Sets the value of a sum.
            pub fn set(&mut self, sum: Sum, value: f64) {
                match sum {
                    $(Sum::$name => self.$name = value,)*
                }
            }
        }
    };
}

sum_table! {
    /// Squares of the pressures by which points are out of balance.
    violation: Add,
    /// Squares of the reactions of the constraint and of the tractions.
    pressures: Add,
    /// The least gap.
    least_gap: Min,
    /// Squares of the unknown gaps.
    gap_squares: Add,
    /// `<z, r>`: preconditioned residual and residual.
    z_residual: Add,
    /// `<z, r - r_old>`.
    z_change: Add,
    /// `<d, r - r_old>`, d the direction.
    direction_change: Add,
    /// `<d, r>`.
    direction_residual: Add,
    /// `<w, z>`, w the measure in which a prescribed mean gap is kept: 1 on free points, S2 of a smooth law.
    weighted_z: Add,
    /// Sum of w.
    free_weight: Add,
    /// Sum of r over the free points.
    free_residual: Add,
    /// Sum of r - r_old over the free points.
    free_change: Add,
    /// `<w, d>`.
    weighted_direction: Add,
    /// `<s, y>`, s the trial step.
    slope: Add,
    /// The least step length at which a further point touches.
    first_touch: Min,
    /// The largest s.
    largest_step: Max,
    /// The least s.
    least_step: Min,
    /// Whether the constraint cut some s.
    cut: Max,
    /// The part of the slope that the elastic pressure makes.
    elastic_slope: Add,
    /// Largest share of its gap that an open point loses.
    closing: Max,
    /// Sum of s.
    step_sum: Add,
    /// Sum of g.
    gap_sum: Add,
    /// `<g, y>`.
    gap_slope: Add,
    /// `<s, K g>`.
    step_gap_curvature: Add,
    /// `<g, K g>`.
    gap_curvature: Add,
    /// Depths below zero gap after the trial step.
    depth_sum: Add,
    /// S2 after the trial step.
    compliance_sum: Add,
    /// `<sigma(g + t s) - sigma(g), s>` at the first step length t that a pass of the search tries.
    change_at_first: Add,
    /// The same at the second.
    change_at_second: Add,
    /// At the third.
    change_at_third: Add,
    /// At the fourth.
    change_at_fourth: Add,
    /// Change of the energy of adhesion.
    energy_change: Add,
    /// Size of the energy that it was taken from.
    energy_size: Add,
    /// `<w, p + sigma>`, w the weight of a point in the mean pressure.
    weighted_pressure: Add,
    /// Sum of w.
    pressure_weight: Add,
    /// The least p + sigma.
    least_pressure: Min,
    /// By how much the gap is above the prescribed one, summed.
    gap_excess: Add,
    /// Weights of the points that bring it back.
    restoring_weight: Add,
}

/// Some sums that are made together, as places of a kernel's terms: a struct with their values, which
/// `put` lays down from the place where the group begins.
macro_rules! sum_group {
    ($(#[$doc:meta])* $name:ident $(after $before:ident)? { $($sum:ident),* $(,)? }) => {
        $(#[$doc])*
        #[derive(Clone, Copy)]
        pub(crate) struct $name<T> {
            $(pub $sum: T,)*
        }

        impl $name<()> {
            /// Its sums.
            pub const SUMS: &'static [$crate::kernel::Sum] = &[$($crate::kernel::Sum::$sum),*];
            /// Where its sums begin among those of a kernel.
            pub const FIRST: usize = 0 $(+ $before::<()>::END)?;
            /// Where they end.
            pub const END: usize = Self::FIRST + Self::SUMS.len();
        }

        impl<T> $name<T> {
            /// Lays its values down among a kernel's terms.
            #[inline(always)]
            pub fn put<const TERMS: usize>(self, terms: &mut [T; TERMS]) {
                // One after another, so that every place is a constant: the compiler makes no vectors of a loop.
                let place = $name::<()>::FIRST;
                $(
                    terms[place] = self.$sum;
                    let place = place + 1;
                )*
                debug_assert!(place == $name::<()>::END);
            }
        }
    };
}
pub(crate) use sum_group;

/// Lists put one after another.
pub(crate) const fn joined<const COUNT: usize>(groups: &[&[Sum]]) -> [Sum; COUNT] {
    let mut all = [Sum::violation; COUNT];
    let (mut group, mut at) = (0, 0);
    while group < groups.len() {
        let mut place = 0;
        while place < groups[group].len() {
            all[at] = groups[group][place];
            at += 1;
            place += 1;
        }
        group += 1;
    }
    all
}

/// How each of some sums is put together.
pub(crate) const fn reduces<const COUNT: usize>(sums: &[Sum]) -> [Reduce; COUNT] {
    let mut all = [Reduce::Add; COUNT];
    let mut place = 0;
    while place < COUNT {
        all[place] = sums[place].reduce();
        place += 1;
    }
    all
}

/// Whether groups lie one after another: each begins where the one before it ends.
pub(crate) const fn contiguous(firsts: &[usize], ends: &[usize]) -> bool {
    let mut place = 0;
    while place < firsts.len() {
        if firsts[place] != ends[place] {
            return false;
        }
        place += 1;
    }
    firsts.len() == ends.len()
}
