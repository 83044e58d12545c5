//! The catalogue of kernels: what is done at each point, as a twin that the CPU runs and against
//! which a shader of the same name is compared.
//!
//! A kernel is a *sweep* over points, or it works on the lines of a transform: it takes those of an
//! inverse transform or lines that were kept, and gives lines to be kept or to a forward transform
//! (see [`Form`]). It reads some fields, writes or updates others, and hands back a few sums.
//! [`scalar`] kernels work on the [`Scalars`] alone; they hold all of the algorithm's decisions, so
//! that a device can keep them.

pub mod base;
pub mod coarse;
pub mod common;
pub mod core;
pub mod floor;
pub mod held;
pub mod scalar;
pub mod wall;
pub mod yielding;

mod core_step;
mod params;
mod points;
mod rows;
mod step;

pub use params::{Gate, Params, SUMS, Scalars, Status};
pub use rows::{Rows, Whole};
pub use scalar::ScalarKernel;

/// How the terms of a sum are put together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reduce {
    /// Added.
    Add,
    /// The least one.
    Min,
    /// The largest one.
    Max,
}

impl Reduce {
    /// The value that changes nothing.
    pub fn neutral(self) -> f64 {
        match self {
            Reduce::Add => 0.0,
            Reduce::Min => f64::INFINITY,
            Reduce::Max => f64::NEG_INFINITY,
        }
    }

    /// Two partial results put together; a NaN on either side stays one.
    pub fn join(self, a: f64, b: f64) -> f64 {
        match self {
            Reduce::Add => a + b,
            Reduce::Min if b < a || b.is_nan() => b,
            Reduce::Max if b > a || b.is_nan() => b,
            _ => a,
        }
    }
}

/// Where the lines of a kernel come from and where they go. Lines are kept in the work space of the
/// level's transforms, so that they cost no field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Points, no lines.
    Sweep,
    /// Fills the lines of a forward transform.
    Load,
    /// Takes the lines of an inverse transform.
    Store,
    /// Takes the lines of an inverse transform and leaves others to be kept.
    Keep,
    /// Takes the lines that were kept; they stay.
    Peek,
    /// Takes the lines that were kept and fills those of a forward transform.
    Resume,
    /// Takes the lines of an inverse transform and fills those of a forward transform.
    Turn,
}

impl Form {
    /// Whether an inverse transform goes before it.
    pub fn after_inverse(self) -> bool {
        matches!(self, Form::Store | Form::Keep | Form::Turn)
    }

    /// Whether a forward transform comes after it.
    pub fn before_forward(self) -> bool {
        matches!(self, Form::Load | Form::Resume | Form::Turn)
    }

    /// Whether it takes lines that were kept.
    pub fn takes_kept(self) -> bool {
        matches!(self, Form::Peek | Form::Resume)
    }
}

/// A twin: a serial loop over the points of some rows.
pub type Twin<T> = fn(&mut Rows<T>, &Params, &Scalars, &mut [f64; SUMS]);

/// One kernel of the catalogue. Fields are bound in the order read, written, whole.
pub struct Kernel {
    /// The word under which it is found everywhere.
    pub name: &'static str,
    /// Where its lines come from and go.
    pub form: Form,
    /// How many fields it reads point by point.
    pub reads: usize,
    /// How many fields it writes or updates.
    pub writes: usize,
    /// How many of these, the last ones, it writes without reading what was there.
    pub fresh: usize,
    /// Whether it also reads one field, of any level, at points of its own choice.
    pub whole: bool,
    /// How its sums are put together.
    pub sums: &'static [Reduce],
    /// When it runs.
    pub gate: Gate,
    /// Twin in double precision.
    pub twin: Twin<f64>,
    /// Twin in single precision.
    pub twin_single: Twin<f32>,
}

impl Kernel {
    /// How many fields it is given.
    pub fn fields(&self) -> usize {
        self.reads + self.writes + usize::from(self.whole)
    }
}

/// Makes a catalogue entry whose twins are one generic function.
macro_rules! kernel {
    ($(#[$doc:meta])* $constant:ident, $twin:ident, $form:ident, reads $reads:expr, writes $writes:expr $(, fresh $fresh:expr)?, whole $whole:expr, sums [$($sum:ident),*], gate $gate:ident) => {
        $(#[$doc])*
        pub static $constant: $crate::kernel::Kernel = $crate::kernel::Kernel {
            name: stringify!($twin),
            form: $crate::kernel::Form::$form,
            reads: $reads,
            writes: $writes,
            fresh: 0 $(+ $fresh)?,
            whole: $whole,
            sums: &[$($crate::kernel::Reduce::$sum),*],
            gate: $crate::kernel::Gate::$gate,
            twin: $twin::<f64>,
            twin_single: $twin::<f32>,
        };
    };
}
pub(crate) use kernel;

/// Makes a catalogue entry of a kernel that looks at one point at a time, over a floor of the gap.
macro_rules! point_kernel {
    ($(#[$doc:meta])* $constant:ident, $name:ident, $form:ident, $kernel:ident over $floor:ident by $each:ident, reads $reads:literal, writes $writes:literal $(, fresh $fresh:expr)?, sums [$($sum:ident),*], gate $gate:ident) => {
        $(#[$doc])*
        pub static $constant: $crate::kernel::Kernel = {
            const SUMS_OF_IT: &[$crate::kernel::Reduce] = &[$($crate::kernel::Reduce::$sum),*];
            $crate::kernel::Kernel {
                name: stringify!($name),
                form: $crate::kernel::Form::$form,
                reads: $reads,
                writes: $writes,
                fresh: 0 $(+ $fresh)?,
                whole: false,
                sums: SUMS_OF_IT,
                gate: $crate::kernel::Gate::$gate,
                twin: $crate::kernel::points::$each::<
                    f64, $kernel<f64, $floor<f64>>, $reads, $writes, { SUMS_OF_IT.len() },
                >,
                twin_single: $crate::kernel::points::$each::<
                    f32, $kernel<f32, $floor<f32>>, $reads, $writes, { SUMS_OF_IT.len() },
                >,
            }
        };
    };
}
pub(crate) use point_kernel;
