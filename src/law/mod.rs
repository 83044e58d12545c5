//! Cohesive laws: how strongly two surfaces attract across a gap, one file each.
//!
//! A law is a traction `sigma(gap) >= 0` (attraction positive), the slope of an energy per area
//! that is `-work_of_adhesion` at zero gap and vanishes far away. The net pressure carries the
//! traction with a minus sign. All numbers are in the caller's units; the solver uses reduced ones.

mod adhesion_map;
mod balance;
mod correction;
mod exponential;
mod lennard_jones;
mod maugis_dugdale;
mod meniscus;
pub mod water;

pub use adhesion_map::{AdhesionMap, LawField, Scaled};
pub use balance::{Support, imbalance, net_pressure};
pub use correction::{CorrectedField, Correction};
pub use exponential::Exponential;
pub use lennard_jones::LennardJones;
pub use maugis_dugdale::MaugisDugdale;
pub use meniscus::{GAS_CONSTANT, LEAST_KELVIN_RADIUS, Meniscus, least_humidity};

use crate::real::Real;

/// The formulas of a law in WGSL, as a file beside its Rust.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct LawShader {
    /// Its name.
    pub name: &'static str,
    /// `law_traction`, `law_energy`, `law_slope`, `law_bend`, `law_difference` and `law_repelling_gap` of a gap.
    pub source: &'static str,
}

/// Formulas of the file of this name.
macro_rules! shader {
    ($name:literal) => {
        $crate::law::LawShader {
            name: $name,
            source: include_str!(concat!($name, ".wgsl")),
        }
    };
}

/// What the kernels ask of a law, point by point.
pub trait Cohesion<T: Real>: Copy {
    /// Attraction across the gap, positive.
    fn traction(&self, gap: T) -> T;
    /// Energy per area, not positive; its slope is the traction.
    fn energy(&self, gap: T) -> T;
    /// Slope of the traction.
    fn slope(&self, gap: T) -> T;
    /// Slope of the slope of a law without a wall; 0 of the others.
    #[inline(always)]
    fn bend(&self, _gap: T) -> T {
        T::zero()
    }
    /// What the traction gains where the gap grows by `step`, to the rounding of the gain itself,
    /// however small that is beside the traction.
    fn difference(&self, gap: T, step: T) -> T;

    /// The same as kernels want it: by subtraction where the traction itself is kept.
    #[inline(always)]
    fn change(&self, gap: T, step: T) -> T {
        self.traction(gap + step) - self.traction(gap)
    }
    /// What the energy gains where the gap grows by `step`, and the size of what it was taken from.
    #[inline(always)]
    fn energy_change(&self, gap: T, step: T) -> [T; 2] {
        let energy = self.energy(gap);
        [self.energy(gap + step) - energy, energy.abs()]
    }
    /// The gap itself, where the unknown is only a part of it.
    #[inline(always)]
    fn open(&self, gap: T) -> T {
        gap
    }
    /// The value of the unknown at which the surfaces touch.
    #[inline(always)]
    fn closed_gap(&self) -> T {
        T::zero()
    }
    /// What of a pressure enters the scale of the stopping measure.
    #[inline(always)]
    fn weighed(&self, pressure: T) -> T {
        pressure
    }
    /// Whether the unknown is the correction of a known gap.
    #[inline(always)]
    fn corrects(&self) -> bool {
        false
    }
    /// A tension of the law as it is at this point.
    #[inline(always)]
    fn factored(&self, tension: T) -> T {
        tension
    }
    /// A gap at which a law without a wall repels by at least this pressure; 0 of the others.
    #[inline(always)]
    fn repelling_gap(&self, _pressure: T) -> T {
        T::zero()
    }
}

/// No attraction at all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HardWall;

impl<T: Real> Cohesion<T> for HardWall {
    #[inline(always)]
    fn traction(&self, _gap: T) -> T {
        T::zero()
    }
    #[inline(always)]
    fn difference(&self, _gap: T, _step: T) -> T {
        T::zero()
    }
    #[inline(always)]
    fn energy(&self, _gap: T) -> T {
        T::zero()
    }
    #[inline(always)]
    fn slope(&self, _gap: T) -> T {
        T::zero()
    }
}

/// A law with its constants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// Surfaces that touch and do not attract.
    HardWall,
    /// Constant tension up to a range, then a linear taper.
    MaugisDugdale(MaugisDugdale<f64>),
    /// Tension that falls exponentially.
    Exponential(Exponential<f64>),
    /// The 9-3 law with its own repulsion instead of a wall.
    LennardJones(LennardJones<f64>),
}

/// Runs an expression with the law of the scene as a concrete type of the kernel's number.
#[macro_export]
#[doc(hidden)]
macro_rules! with_law {
    ($law:expr, $T:ty, $name:ident => $body:expr) => {
        match $law {
            $crate::law::Law::HardWall => {
                let $name = $crate::law::HardWall;
                $body
            }
            $crate::law::Law::MaugisDugdale(law) => {
                let $name = law.cast::<$T>();
                $body
            }
            $crate::law::Law::Exponential(law) => {
                let $name = law.cast::<$T>();
                $body
            }
            $crate::law::Law::LennardJones(law) => {
                let $name = law.cast::<$T>();
                $body
            }
        }
    };
}

/// Runs an expression with the law of the scene that has a wall, as a concrete type of the kernel's
/// number. No attraction at all is a constant tension of nothing, which spares the compiler a third of its
/// work; the Lennard-Jones law has no wall, and kernels of its own.
#[macro_export]
#[doc(hidden)]
macro_rules! with_wall_law {
    ($law:expr, $T:ty, $name:ident => $body:expr) => {
        match $law {
            $crate::law::Law::Exponential(law) => {
                let $name = law.cast::<$T>();
                $body
            }
            $crate::law::Law::MaugisDugdale(law) => {
                let $name = law.cast::<$T>();
                $body
            }
            $crate::law::Law::HardWall | $crate::law::Law::LennardJones(_) => {
                let $name = $crate::law::MaugisDugdale::<f64>::NOTHING.cast::<$T>();
                $body
            }
        }
    };
}

impl Law {
    /// Its formulas for a device.
    pub fn shader(&self) -> LawShader {
        match self {
            Law::HardWall => shader!("hard_wall"),
            Law::MaugisDugdale(_) => shader!("maugis_dugdale"),
            Law::Exponential(_) => shader!("exponential"),
            Law::LennardJones(_) => shader!("lennard_jones"),
        }
    }

    /// Attraction across the gap, positive.
    pub fn traction(&self, gap: f64) -> f64 {
        with_law!(*self, f64, law => law.traction(gap))
    }

    /// Energy per area, not positive for an open gap.
    pub fn energy(&self, gap: f64) -> f64 {
        with_law!(*self, f64, law => law.energy(gap))
    }

    /// Slope of the traction.
    pub fn slope(&self, gap: f64) -> f64 {
        with_law!(*self, f64, law => law.slope(gap))
    }

    /// Energy per area to separate the surfaces from their zero-force distance; 0 for the hard wall.
    pub fn work_of_adhesion(&self) -> f64 {
        -self.energy(0.0)
    }

    /// The length over which the law acts, as the scene names it; 0 for the hard wall.
    pub fn range(&self) -> f64 {
        match self {
            Law::HardWall => 0.0,
            Law::MaugisDugdale(law) => law.range,
            Law::Exponential(law) => law.range,
            Law::LennardJones(law) => law.range,
        }
    }

    /// The largest tension of the law; 0 for the hard wall.
    pub fn peak_tension(&self) -> f64 {
        match self {
            Law::HardWall => 0.0,
            Law::MaugisDugdale(law) => law.peak_tension,
            Law::Exponential(law) => law.work_of_adhesion / law.range,
            Law::LennardJones(law) => law.peak_tension(),
        }
    }

    /// The largest tension at any gap from `gap` on: what a point may pull with as it opens.
    pub fn traction_beyond(&self, gap: f64) -> f64 {
        match self {
            // Every other law pulls less the wider the gap.
            Law::LennardJones(law) => self.traction(gap.max(law.peak_gap())),
            _ => self.traction(gap),
        }
    }

    /// Width of the linear end of the tension; 0 without one.
    pub fn taper(&self) -> f64 {
        match self {
            Law::MaugisDugdale(law) => law.taper,
            _ => 0.0,
        }
    }

    /// Gap of the largest tension of a law without a wall; 0 of the others, whose tension is largest there.
    pub fn peak_gap(&self) -> f64 {
        match self {
            Law::LennardJones(law) => law.peak_gap(),
            _ => 0.0,
        }
    }

    /// The steepest slope with which the tension falls beyond a wall, positive; infinite of a sharp end, 0 without a wall.
    pub fn steepest_fall(&self) -> f64 {
        match self {
            Law::HardWall | Law::LennardJones(_) => 0.0,
            Law::MaugisDugdale(law) => law.peak_tension / law.taper,
            Law::Exponential(law) => law.work_of_adhesion / (law.range * law.range),
        }
    }

    /// Whether the surfaces attract at all.
    pub fn is_adhesive(&self) -> bool {
        !matches!(self, Law::HardWall)
    }

    /// The least gap that a state may have: 0 behind a wall, and where the repulsion of a law without one is
    /// evaluated no further.
    pub fn least_gap(&self) -> f64 {
        match self {
            Law::LennardJones(law) => law.least_gap(),
            _ => 0.0,
        }
    }

    /// Whether a wall at zero gap bounds the gap from below.
    pub fn has_wall(&self) -> bool {
        !matches!(self, Law::LennardJones(_))
    }

    /// Whether the traction varies with the gap where it acts, so that a step length is worth a search.
    pub fn has_tail(&self) -> bool {
        match self {
            Law::HardWall => false,
            Law::MaugisDugdale(law) => law.taper > 0.0,
            Law::Exponential(_) | Law::LennardJones(_) => true,
        }
    }

    /// The same law in other units: gaps divided by `length`, tractions by `pressure`.
    pub fn reduced(&self, length: f64, pressure: f64) -> Law {
        match *self {
            Law::HardWall => Law::HardWall,
            Law::MaugisDugdale(law) => Law::MaugisDugdale(MaugisDugdale {
                peak_tension: law.peak_tension / pressure,
                range: law.range / length,
                taper: law.taper / length,
            }),
            Law::Exponential(law) => Law::Exponential(Exponential {
                work_of_adhesion: law.work_of_adhesion / (length * pressure),
                range: law.range / length,
            }),
            Law::LennardJones(law) => Law::LennardJones(LennardJones {
                work_of_adhesion: law.work_of_adhesion / (length * pressure),
                range: law.range / length,
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn laws() -> Vec<(&'static str, Law)> {
        let dugdale = |taper| {
            Law::MaugisDugdale(MaugisDugdale {
                peak_tension: 0.4,
                range: 0.5,
                taper,
            })
        };
        vec![
            ("sharp Maugis-Dugdale", dugdale(0.0)),
            ("tapered Maugis-Dugdale", dugdale(0.3)),
            ("widest taper", dugdale(1.0)),
            (
                "exponential",
                Law::Exponential(Exponential {
                    work_of_adhesion: 0.2,
                    range: 0.5,
                }),
            ),
            (
                "Lennard-Jones",
                Law::LennardJones(LennardJones {
                    work_of_adhesion: 0.2,
                    range: 0.5,
                }),
            ),
        ]
    }

    /// Every law of the house in one table. The central difference of step 1e-6 is good to 1e-9
    /// of second differences, except across the kinks of a Dugdale law, which the gaps avoid.
    #[test]
    fn traction_is_the_slope_of_the_energy_and_integrates_to_the_work() {
        for (name, law) in laws() {
            assert!(
                (law.work_of_adhesion() - 0.2).abs() < 1e-15,
                "{name}: {}",
                law.work_of_adhesion()
            );
            assert!((law.range() - 0.5).abs() < 1e-15, "{name}");
            let step = 1e-6;
            for gap in [0.003, 0.11, 0.27, 0.47, 0.62, 0.81, 1.37, 2.9] {
                let numeric = (law.energy(gap + step) - law.energy(gap - step)) / (2.0 * step);
                let traction = law.traction(gap);
                assert!(
                    (numeric - traction).abs() < 1e-8,
                    "{name} at {gap}: {numeric} {traction}"
                );
                let numeric = (law.traction(gap + step) - law.traction(gap - step)) / (2.0 * step);
                assert!(
                    (numeric - law.slope(gap)).abs() < 1e-7,
                    "{name} slope at {gap}"
                );
                assert!(traction >= 0.0, "{name}: attraction is positive");
                assert!(
                    traction <= law.peak_tension() * (1.0 + 1e-14),
                    "{name}: {traction} above the peak"
                );
            }
            // Simpson's rule over u = x/(1-x), which takes the tail in to the end.
            let pieces = 20_000;
            let integrand = |i: usize| {
                let x = i as f64 / pieces as f64;
                if i == pieces {
                    return 0.0;
                }
                law.traction(x / (1.0 - x)) / (1.0 - x).powi(2)
            };
            let mut work = 0.0;
            for i in (0..pieces).step_by(2) {
                work += integrand(i) + 4.0 * integrand(i + 1) + integrand(i + 2);
            }
            work /= 3.0 * pieces as f64;
            // The step of the sharp law is placed to one interval.
            let bound = if name.starts_with("sharp") {
                1e-4
            } else {
                1e-7
            };
            assert!((work - 0.2).abs() < bound, "{name}: integral {work}");
        }
    }

    #[test]
    fn reduced_units_keep_the_law() {
        for (name, law) in laws() {
            let reduced = law.reduced(3.0, 7.0);
            for gap in [0.01, 0.4, 0.9] {
                let back = 7.0 * reduced.traction(gap / 3.0);
                assert!((back - law.traction(gap)).abs() < 1e-14, "{name}");
                let back = 21.0 * reduced.energy(gap / 3.0);
                assert!((back - law.energy(gap)).abs() < 1e-14, "{name}");
            }
        }
    }
}
