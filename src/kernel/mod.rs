//! The catalogue of kernels: what is done at each point, as a twin that the CPU runs and against
//! which a shader of the same name is compared.
//!
//! A kernel is a *sweep* over points, or it works on the rows of a transform: it takes those of an
//! inverse transform or rows that were retained, and gives rows to be retained or to a forward transform
//! (see [`Form`]). It reads some fields, writes or updates others, and hands back a few [`Sums`].
//! Each is written once; where a constraint, a prescribed mean gap or a retained field makes a difference
//! it has a variant for each, which binds as many of its fields as it needs.
//! Scalar kernels ([`scalar`], [`step_length`], [`mean_gap`]) work on the [`Scalars`] alone; they hold all of
//! the algorithm's decisions, so that a device can keep them.

pub mod constraint;
pub mod declare;
pub mod descent;
pub mod displacement;
pub mod mean_gap;
pub mod measure;
pub mod multilevel;
pub mod refinement;
pub mod scalar;
pub mod search;
pub mod smooth;
pub mod step_length;
pub mod trial;
pub mod update;

mod catalogue;
mod params;
mod points;
mod rows;
mod seek;
mod sums;

pub use catalogue::{KERNELS, SCALAR_KERNELS};
pub use constraint::Constraint;
pub use params::{Gate, LawNumbers, Params, Scalars, Status, TRIED};
pub use rows::{Rows, Whole};
pub use scalar::ScalarKernel;
pub use sums::{MOST_SUMS as SUMS, Sum, Sums};

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

/// Where the lines of a kernel come from and where they go. Rows are retained in the work space of the
/// level's transforms, so that they cost no field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Points, no lines.
    Sweep,
    /// Fills the rows of a forward transform.
    Load,
    /// Takes the lines of an inverse transform.
    Store,
    /// Takes the lines of an inverse transform and leaves others to be kept.
    RetainRows,
    /// Makes lines to be kept, with no transform before them.
    Retain,
    /// Takes the lines that were kept; they stay.
    ReadRetained,
    /// Takes the lines that were kept and fills those of a forward transform.
    FromRetained,
    /// Takes the lines of an inverse transform and fills those of a forward transform.
    InverseThenForward,
}

impl Form {
    /// Whether an inverse transform goes before it.
    pub fn after_inverse(self) -> bool {
        matches!(
            self,
            Form::Store | Form::RetainRows | Form::InverseThenForward
        )
    }

    /// Whether a forward transform comes after it.
    pub fn before_forward(self) -> bool {
        matches!(
            self,
            Form::Load | Form::FromRetained | Form::InverseThenForward
        )
    }

    /// Whether it leaves lines to be kept.
    pub fn retains(self) -> bool {
        matches!(self, Form::RetainRows | Form::Retain)
    }

    /// One-dimensional transforms of all rows that go with it, in two-dimensional ones.
    pub fn transforms(self) -> f64 {
        let rows = u8::from(self.after_inverse()) + u8::from(self.before_forward());
        0.5 * f64::from(rows)
    }

    /// Whether it takes lines that were kept.
    pub fn takes_retained(self) -> bool {
        matches!(self, Form::ReadRetained | Form::FromRetained)
    }
}

/// A twin: a serial loop over the points of some rows.
pub type Twin<T> = fn(&mut Rows<T>, &Params, &Scalars, &mut [f64; SUMS]);

/// One kernel of the catalogue, or a variant of one. Fields are bound in the order read, written, around, whole.
pub struct Kernel {
    /// The word under which it is found everywhere; the same of all its variants.
    pub name: &'static str,
    /// The file of its twin.
    pub file: &'static str,
    /// The constraint of the gap for which it is made, if it asks for one.
    pub constraint: Option<Constraint>,
    /// What else sets its variants apart.
    pub flag: Option<(&'static str, bool)>,
    /// Where its rows come from and go.
    pub form: Form,
    /// Fields that it reads point by point.
    pub reads: &'static [&'static str],
    /// Fields that it writes or updates.
    pub writes: &'static [&'static str],
    /// How many of these, the last ones, it writes without reading what was there.
    pub fresh: usize,
    /// A field of its level that it also reads at the neighbours of each point.
    pub around: Option<&'static str>,
    /// Whether it also reads one field, of any level, at points of its own choice.
    pub whole: bool,
    /// Fields that other variants bind; here they are zero and written nowhere.
    pub unbound: &'static [&'static str],
    /// What it sums.
    pub sums: &'static [Sum],
    /// How these are put together.
    pub reduces: &'static [Reduce],
    /// When it runs.
    pub gate: Gate,
    /// Whether it asks for the law.
    pub law: bool,
    /// Twin in double precision.
    pub twin: Twin<f64>,
    /// Twin in single precision.
    pub twin_single: Twin<f32>,
}

impl Kernel {
    /// How many fields it is given.
    pub fn fields(&self) -> usize {
        self.reads.len()
            + self.writes.len()
            + usize::from(self.around.is_some())
            + usize::from(self.whole)
    }

    /// Which of the fields that it is given are written.
    pub fn written(&self) -> std::ops::Range<usize> {
        self.reads.len()..self.reads.len() + self.writes.len()
    }

    /// Its name with what sets the variant apart.
    pub fn variant(&self) -> String {
        let mut name = self.name.to_owned();
        if let Some(constraint) = self.constraint {
            name += match constraint {
                Constraint::Unilateral => "-unilateral",
                Constraint::HardnessLimit => "-hardness_limit",
                Constraint::Smooth => "-smooth",
            };
        }
        if let Some((flag, true)) = self.flag {
            name += "-";
            name += &flag.to_lowercase();
        }
        if self.writes.last() == Some(&"projected_residual") && self.flag.is_none() {
            name += "-stored";
        }
        if self.gate == Gate::Ahead && self.name == "load_field" {
            name += "-ahead";
        }
        name
    }
}

/// A catalogue entry. Its twins may name the lengths of its lists, `READS`, `WRITES` and `TERMS`.
macro_rules! catalogue_entry {
    ($name:ident, $form:ident, gate $gate:ident, law $law:literal, constraint $constraint:expr,
     flag [$($flag:ident = $set:literal)?], twins [$twin:expr, $twin_single:expr],
     reads [$($read:ident),*], writes [$($write:ident),*] $(, fresh $fresh:literal)? $(, around $around:ident)? $(, whole $whole:literal)?
     $(, unbound [$($unbound:ident),*])? $(, sums [$($group:ident),*])?) => {{
        #[allow(dead_code)]
        const READS: usize = <[&str]>::len(&[$(stringify!($read)),*]);
        #[allow(dead_code)]
        const WRITES: usize = <[&str]>::len(&[$(stringify!($write)),*]);
        const TERMS: usize = 0 $($(+ $group::<()>::SUMS.len())*)?;
        const SUMS_OF_IT: [$crate::kernel::Sum; TERMS] =
            $crate::kernel::sums::joined(&[$($($group::<()>::SUMS),*)?]);
        const REDUCES: [$crate::kernel::Reduce; TERMS] = $crate::kernel::sums::reduces(&SUMS_OF_IT);
        const _: () = assert!($crate::kernel::sums::contiguous(
            &[$($($group::<()>::FIRST,)*)? TERMS],
            &[0 $($(, $group::<()>::END)*)?],
        ));
        $crate::kernel::Kernel {
            name: stringify!($name),
            file: file!(),
            constraint: $constraint,
            flag: $crate::kernel::first(&[$((stringify!($flag), $set))?]),
            form: $crate::kernel::Form::$form,
            reads: &[$(stringify!($read)),*],
            writes: &[$(stringify!($write)),*],
            fresh: 0 $(+ $fresh)?,
            around: $crate::kernel::first(&[$(stringify!($around))?]),
            whole: false $(| $whole)?,
            unbound: &[$($(stringify!($unbound)),*)?],
            sums: &SUMS_OF_IT,
            reduces: &REDUCES,
            gate: $crate::kernel::Gate::$gate,
            law: $law,
            twin: $twin,
            twin_single: $twin_single,
        }
    }};
}
pub(crate) use catalogue_entry;

/// What a list of at most one holds.
pub(crate) const fn first<T: Copy>(list: &[T]) -> Option<T> {
    match list {
        [first, ..] => Some(*first),
        [] => None,
    }
}

/// A catalogue entry whose twins are one generic function over rows.
macro_rules! rows_kernel {
    ($twin:ident $([$flag:ident = $set:literal, $($size:literal),*])?, $form:ident, gate $gate:ident,
     law $law:literal, $($rest:tt)*) => {
        $crate::kernel::catalogue_entry!(
            $twin, $form, gate $gate, law $law, constraint None, flag [$($flag = $set)?],
            twins [$twin::<f64 $(, $set, $($size),*)?>, $twin::<f32 $(, $set, $($size),*)?>],
            $($rest)*
        )
    };
}
pub(crate) use rows_kernel;

/// A catalogue entry of a kernel that looks at one point at a time, over a constraint of the gap.
macro_rules! point_kernel {
    ($name:ident, $form:ident, gate $gate:ident,
     $kernel:ident over $constraint:ident [$($flag:ident = $set:literal)?] without law, $($rest:tt)*) => {
        point_kernel!(@entry $name, $form, $gate, $constraint, [$($flag = $set)?], law false,
            each_point_without_law, $kernel $(<$set>)?, $($rest)*)
    };
    ($name:ident, $form:ident, gate $gate:ident,
     $kernel:ident over $constraint:ident [$($flag:ident = $set:literal)?], $($rest:tt)*) => {
        point_kernel!(@entry $name, $form, $gate, $constraint, [$($flag = $set)?], law true,
            each_point, $kernel $(<$set>)?, $($rest)*)
    };
    (@entry $name:ident, $form:ident, $gate:ident, $constraint:ident, $flags:tt, law $law:literal,
     $walk:ident, $kernel:ty, $($rest:tt)*) => {
        $crate::kernel::catalogue_entry!(
            $name, $form, gate $gate, law $law,
            constraint Some($crate::kernel::Constraint::$constraint), flag $flags,
            twins [
                $crate::kernel::points::$walk::<f64, $constraint<f64>, $kernel, READS, WRITES, TERMS>,
                $crate::kernel::points::$walk::<f32, $constraint<f32>, $kernel, READS, WRITES, TERMS>
            ],
            $($rest)*
        )
    };
}
pub(crate) use point_kernel;

/// The variants of such a kernel for each constraint, where these bind the same fields.
macro_rules! point_kernels {
    ($(#[$doc:meta])* $constant:ident, $name:ident, $form:ident, gate $gate:ident, $kernel:ident $flags:tt,
     $($rest:tt)*) => {
        $(#[$doc])*
        pub static $constant: [$crate::kernel::Kernel; 3] = [
            point_kernel!($name, $form, gate $gate, $kernel over Unilateral $flags, $($rest)*),
            point_kernel!($name, $form, gate $gate, $kernel over HardnessLimit $flags, $($rest)*),
            point_kernel!($name, $form, gate $gate, $kernel over Smooth $flags, $($rest)*),
        ];
    };
}
pub(crate) use point_kernels;
