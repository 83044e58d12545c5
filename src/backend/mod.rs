//! Where the arithmetic runs: the one trait through which the solver works.
//!
//! A backend holds fields (one number a point) and spectra (one real factor a wavevector), runs
//! the catalogue's kernels over them, and keeps the algorithm's [`Scalars`] beside them. The
//! solver is written against this trait alone: it names no thread and no graphics library.
//! A convolution is three calls, so that what happens to a point as it enters the first row transform
//! and as it leaves the last one is fused into those rows: [`run`](Backend::run) with a kernel that fills
//! the rows of a forward transform, [`multiply`](Backend::multiply), `run` with a kernel that takes the
//! rows of the inverse one. Where one convolution ends in the rows in which the next one starts, one kernel
//! does both. Its [`Form`](crate::kernel::Form) says which.

pub mod cpu;
pub mod dry_run;
mod factors;
#[cfg(feature = "gpu")]
pub mod gpu;
pub(crate) mod host_fields;
pub mod long_field;
pub mod ranks;
mod share;
/// What remains of graphics processors without the feature `gpu`: a buffer that nobody can have.
#[cfg(not(feature = "gpu"))]
mod gpu {
    /// A field on a device that another backend may copy.
    #[derive(Debug)]
    pub enum SharedBuffer {}
}

use crate::kernel::{Gate, Kernel, Params, ScalarKernel, Scalars};
pub use factors::{Factors, Response};
use long_field::LongField;
pub use share::Share;

/// A grid on which fields live: the fine one, or a coarse one of the preconditioner.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Level(pub usize);

/// One number a point of a level.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Field {
    /// The level it lives on.
    pub level: Level,
    /// Its place among the backend's fields.
    pub index: usize,
}

/// One real, even factor a wavevector of a level.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Spectrum {
    /// The level it lives on.
    pub level: Level,
    /// Its place among the backend's spectra.
    pub index: usize,
}

/// The points of a level, and which of them are surface.
///
/// On a periodic grid `surface` equals `points`. On a free boundary the surface is the first
/// `surface[0]` points of the first `surface[1]` rows, and the rest is the pad that keeps the
/// images apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shape {
    /// Points along x and y.
    pub points: [usize; 2],
    /// Surface points along x and y.
    pub surface: [usize; 2],
}

impl Shape {
    /// A shape without a pad.
    pub fn whole(nx: usize, ny: usize) -> Self {
        Shape {
            points: [nx, ny],
            surface: [nx, ny],
        }
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.points[0] * self.points[1]
    }

    /// Whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of surface points.
    pub fn surface_len(&self) -> usize {
        self.surface[0] * self.surface[1]
    }

    /// Values that a [`Spectrum`] of this shape holds: `nx/2 + 1` columns of `ny/2 + 1`, the
    /// column index running slowest; the other half follows from evenness.
    pub fn spectrum_len(&self) -> usize {
        (self.points[0] / 2 + 1) * (self.points[1] / 2 + 1)
    }
}

/// What may go wrong where the arithmetic runs.
#[derive(Debug, thiserror::Error)]
pub enum BackendError {
    /// A kernel was given fields that it does not take.
    #[error("kernel `{kernel}` takes {expected} fields and was given {given}")]
    Fields {
        /// The kernel.
        kernel: &'static str,
        /// How many fields it declares.
        expected: usize,
        /// How many it was given.
        given: usize,
    },
    /// The device failed.
    #[error("the device failed: {0}")]
    Device(String),
}

/// The values of a field in the host's own memory.
#[derive(Clone, Copy, Debug)]
pub enum Values<'a> {
    /// In double precision.
    Double(&'a [f64]),
    /// In single precision.
    Single(&'a [f32]),
}

/// Fields, spectra, kernels and the scalars of the algorithm, wherever they are.
///
/// Recording work does not fail: what goes wrong surfaces where the host waits, in
/// [`scalars`](Backend::scalars) and [`read`](Backend::read).
pub trait Backend {
    /// Whether it has transforms for a level of this shape.
    fn suits(&self, _shape: Shape) -> bool {
        true
    }
    /// Rounds to record before looking at the scalars. The gates idle those that turn out to be
    /// too many, so a result does not depend on it; only looking, where it is dear, happens less.
    fn look_every(&self) -> usize {
        1
    }
    /// Whether a cold solve without adhesion gains time by a start from coarser grids: where an iteration takes time in
    /// proportion to its points.
    fn starts_coarse(&self) -> bool {
        true
    }
    /// Makes a level and the work space of its transforms.
    fn level(&mut self, name: &'static str, shape: Shape) -> Level;
    /// Makes a level on which nothing is transformed, and which takes no work space where a backend can do
    /// without.
    fn sweep_level(&mut self, name: &'static str, shape: Shape) -> Level {
        self.level(name, shape)
    }
    /// Makes a field of zeros.
    fn field(&mut self, level: Level, name: &'static str) -> Field;
    /// Makes a spectrum of these factors. Those of a half-space are 0 at the zero wavevector until it is set.
    fn spectrum(&mut self, level: Level, name: &'static str, factors: Factors) -> Spectrum;
    /// Overwrites a spectrum's value at the zero wavevector.
    fn set_zero_mode(&mut self, spectrum: Spectrum, value: f64);
    /// Overwrites a field: the rows of it that this process holds.
    fn write(&mut self, field: Field, values: &[f64]);
    /// Waits, and reads a field: the rows of it that this process holds.
    fn read(&mut self, field: Field) -> Result<LongField<f64>, BackendError>;
    /// Multiplies the law's tension by this field, in every kernel of its level from now on. Without
    /// a call the law is the same everywhere and nothing is read for it.
    fn set_law_factor(&mut self, factor: Field);
    /// From now on the unknown of every kernel of the laws is the correction of this outer gap, and the pressure
    /// that of the correction and the outer residual. Without one it is the gap itself.
    fn set_outer_gap(&mut self, outer_gap: Option<Field>);
    /// Sets a field to zero where it is.
    fn clear(&mut self, field: Field);
    /// Lets go of the memory of a field whose values nobody needs any more, where it is the host's. The field
    /// takes memory again, and begins with zeros, as soon as it is used.
    fn release(&mut self, _field: Field) {}
    /// The same of the work space of a level's transforms, and of the rows that were kept there.
    fn release_work(&mut self, _level: Level) {}
    /// An empty backend in double precision for a level of this shape, where the solver is asked to keep
    /// its state in double precision and to iterate here on corrections of it. `None` where this one's
    /// numbers will do.
    fn in_double(&self, _shape: Shape) -> Option<Box<dyn Backend + Send>> {
        None
    }
    /// An empty backend in single precision at the same place, for a solve whose result need not be exact. `None`
    /// where it would not be faster than this one.
    fn in_single(&self) -> Option<Box<dyn Backend + Send>> {
        None
    }
    /// Looks at the values of a field where the host holds them; `None` where a device does.
    ///
    /// # Errors
    /// Those of [`read`](Backend::read).
    fn values(&mut self, _field: Field) -> Result<Option<Values<'_>>, BackendError> {
        Ok(None)
    }
    /// Overwrites a field with one of another backend, of as many points, rounded to this one's number.
    /// It passes through the host, unless both are on one device.
    ///
    /// # Errors
    /// Those of [`read`](Backend::read) there.
    fn copy_from(
        &mut self,
        field: Field,
        from: &mut dyn Backend,
        source: Field,
    ) -> Result<(), BackendError> {
        if let Some(Values::Double(values)) = from.values(source)? {
            self.write(field, values);
        } else {
            self.write(field, &from.read(source)?);
        }
        Ok(())
    }
    /// A field for another backend on the same device to take; `None` where there is no device.
    fn share_buffer(&mut self, _field: Field) -> Option<gpu::SharedBuffer> {
        None
    }
    /// Sets the numbers that stay fixed during a solve.
    fn set_params(&mut self, params: &Params);
    /// Overwrites the scalars.
    fn set_scalars(&mut self, scalars: &Scalars);
    /// Waits, and reads the scalars.
    fn scalars(&mut self) -> Result<Scalars, BackendError>;
    /// Runs a kernel over the points of a level, with the transforms of rows before and after it that its
    /// form asks for; its sums go to the scalars.
    fn run(&mut self, kernel: &'static Kernel, level: Level, fields: &[Field]);
    /// Runs a scalar kernel.
    fn scalar(&mut self, kernel: &'static ScalarKernel);
    /// Multiplies the work space by a spectrum. With `energy`, `sum K |s_q|^2` over all
    /// wavevectors, divided by the number of points, goes to `scalars.curvature`. It changes no field,
    /// so a backend may run it before it knows that the gate shuts.
    fn multiply(&mut self, by: Spectrum, energy: bool, gate: Gate);
    /// Relative rounding error of the fields' numbers.
    fn epsilon(&self) -> f64;
    /// Real two-dimensional transforms run so far, forward and inverse one each, those of other
    /// levels in proportion to their points.
    fn transforms(&self) -> f64;
}

/// Checks a kernel's field list against its declaration.
pub(crate) fn check_fields(kernel: &'static Kernel, fields: &[Field]) -> Result<(), BackendError> {
    if fields.len() == kernel.fields() {
        Ok(())
    } else {
        Err(BackendError::Fields {
            kernel: kernel.name,
            expected: kernel.fields(),
            given: fields.len(),
        })
    }
}
