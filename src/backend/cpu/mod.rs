//! The processor: kernels' twins and transforms run at once, rows in parallel.
//!
//! Work is cut into blocks of eight rows whatever the number of threads, and sums add the blocks'
//! partial results in order, so results do not depend on how threads happen to be scheduled. This
//! is the only place that names rayon.

mod blocks;
mod plans;
mod transform;

use rayon::ThreadPoolBuilder;
use rayon::prelude::*;

use super::{Backend, BackendError, Factors, Field, Level, Shape, Spectrum, check_fields};
use crate::kernel::{Form, Gate, Kernel, Params, SUMS, ScalarKernel, Scalars, Twin, Whole};
use crate::plans::Planned;
use crate::real::Real;
use blocks::{BLOCK, Job, run_blocks};
use transform::Transform;

/// The CPU backend in one kind of number; `CpuBackend<f64>` is the reference.
pub struct CpuBackend<T: Real> {
    levels: Vec<LevelSpace<T>>,
    fields: Vec<Vec<T>>,
    spectra: Vec<Vec<T>>,
    /// The field of factors on the law's tension.
    law_factor: Option<Field>,
    /// Gap and residual of the outer state that is corrected.
    outer: Option<[Field; 2]>,
    /// Whether a state in double precision stands beside the fields.
    corrected: bool,
    params: Option<Params>,
    scalars: Scalars,
    transforms: f64,
}

struct LevelSpace<T: Real> {
    shape: Shape,
    /// None where nothing is transformed.
    transform: Option<Transform<T>>,
    partials: Vec<[f64; SUMS]>,
}

/// Numbers that pick their own twins.
pub trait CpuReal: Real + Planned {
    /// The twin of a kernel for this number.
    fn twin(kernel: &'static Kernel) -> Twin<Self>;
}

impl CpuReal for f64 {
    fn twin(kernel: &'static Kernel) -> Twin<f64> {
        kernel.twin
    }
}

impl CpuReal for f32 {
    fn twin(kernel: &'static Kernel) -> Twin<f32> {
        kernel.twin_single
    }
}

/// Runs `work` on a pool of `threads` threads (all cores if `None`), to which every backend made
/// inside belongs.
pub fn with_threads<R: Send>(
    threads: Option<usize>,
    work: impl FnOnce() -> R + Send,
) -> Result<R, BackendError> {
    let pool = ThreadPoolBuilder::new()
        .num_threads(threads.unwrap_or(0))
        .build()
        .map_err(|error| BackendError::Device(format!("no thread pool: {error}")))?;
    Ok(pool.install(work))
}

impl<T: CpuReal> Default for CpuBackend<T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: CpuReal> CpuBackend<T> {
    /// A backend with nothing in it.
    pub fn new() -> Self {
        CpuBackend {
            levels: Vec::new(),
            fields: Vec::new(),
            spectra: Vec::new(),
            law_factor: None,
            outer: None,
            corrected: false,
            params: None,
            scalars: Scalars::start(0.0, false),
            transforms: 0.0,
        }
    }

    /// The same for iterations that correct a state kept in double precision.
    pub fn corrected(self) -> Self {
        CpuBackend {
            corrected: true,
            ..self
        }
    }

    /// Points of a level over those of the first one, in which transforms are counted.
    fn share_of_first(&self, level: Level) -> f64 {
        self.levels[level.0].shape.len() as f64 / self.levels[0].shape.len() as f64
    }

    /// Takes memory for a field that was released.
    fn take(&mut self, field: Field) {
        let stored = &mut self.fields[field.index];
        if stored.is_empty() {
            *stored = vec![T::zero(); self.levels[field.level.0].shape.len()];
        }
    }

    fn add_level(&mut self, shape: Shape, transform: Option<Transform<T>>) -> Level {
        self.levels.push(LevelSpace {
            shape,
            transform,
            partials: vec![[0.0; SUMS]; shape.points[1].div_ceil(BLOCK)],
        });
        Level(self.levels.len() - 1)
    }

    /// Runs a kernel over the blocks of a level, with the transform's work space where it has one.
    fn run_blocks(&mut self, kernel: &'static Kernel, level: Level, fields: &[Field]) {
        if !self.scalars.is_open(kernel.gate) {
            return;
        }
        if let Err(error) = check_fields(kernel, fields) {
            // A wrong list is a mistake in this crate, found by the first test that runs it.
            debug_assert!(false, "{error}");
            return;
        }
        let Some(params) = self.params else {
            return;
        };
        fields.iter().for_each(|&field| self.take(field));
        let twin = T::twin(kernel);
        // Written fields are lifted out, so that the others can be borrowed meanwhile.
        let mut lifted: [Vec<T>; 4] = Default::default();
        for (slot, field) in fields[kernel.written()].iter().enumerate() {
            lifted[slot] = std::mem::take(&mut self.fields[field.index]);
        }
        let mut reads: [&[T]; 4] = [&[]; 4];
        for (slot, field) in fields[..kernel.reads.len()].iter().enumerate() {
            reads[slot] = &self.fields[field.index];
        }
        let anywhere = |present: bool, place: usize| match (present, fields.get(place)) {
            (true, Some(&field)) => Whole {
                values: &self.fields[field.index][..],
                points: self.levels[field.level.0].shape.points,
            },
            _ => Whole {
                values: &[],
                points: [0, 0],
            },
        };
        let (own, has_around) = (kernel.written().end, kernel.around.is_some());
        let around = anywhere(has_around, own);
        let whole = anywhere(kernel.whole, own + usize::from(has_around));
        let factor: &[T] = match self.law_factor {
            Some(field) if field.level == level => &self.fields[field.index],
            _ => &[],
        };
        let outer: [&[T]; 2] = match self.outer {
            Some(outer) if outer[0].level == level => {
                outer.map(|field| &self.fields[field.index][..])
            }
            _ => [&[]; 2],
        };
        let share = self.share_of_first(level);
        let space = &mut self.levels[level.0];
        let blocks = space.shape.points[1].div_ceil(BLOCK);
        let mut neutral = [0.0; SUMS];
        for (slot, reduce) in kernel.reduces.iter().enumerate() {
            neutral[slot] = reduce.neutral();
        }
        let partials = &mut space.partials[..blocks];
        partials.fill(neutral);
        let [a, b, c, d] = &mut lifted;
        let job = Job {
            blocks: 0..blocks,
            shape: space.shape,
            reads,
            writes: [a, b, c, d],
            whole,
            around,
            factor,
            outer,
            partials,
            work: &mut [],
            work_per_block: 0,
            params: &params,
            scalars: &self.scalars,
            reduces: kernel.reduces,
            twin,
        };
        match (kernel.form, &mut space.transform) {
            (Form::Sweep, _) => run_blocks(job, &|mut job| job.call(&mut [])),
            // A mistake in this crate, found by the first test that runs it.
            (_, None) => debug_assert!(false, "{} on a level without transforms", kernel.name),
            (form, Some(transform)) => {
                transform.rows(job, form);
                self.transforms += share * form.transforms();
            }
        }
        let partials = &self.levels[level.0].partials[..blocks];
        for (slot, &sum) in kernel.sums.iter().enumerate() {
            let reduce = sum.reduce();
            let total = partials.iter().fold(reduce.neutral(), |total, block| {
                reduce.join(total, block[slot])
            });
            self.scalars.sums.set(sum, total);
        }
        for (slot, field) in fields[kernel.written()].iter().enumerate() {
            self.fields[field.index] = std::mem::take(&mut lifted[slot]);
        }
    }
}

impl<T: CpuReal> Backend for CpuBackend<T> {
    fn level(&mut self, _name: &'static str, shape: Shape) -> Level {
        self.add_level(shape, Some(Transform::new(shape)))
    }

    fn sweep_level(&mut self, _name: &'static str, shape: Shape) -> Level {
        self.add_level(shape, None)
    }

    fn field(&mut self, level: Level, _name: &'static str) -> Field {
        let points = self.levels[level.0].shape.len();
        self.fields.push(vec![T::zero(); points]);
        Field {
            level,
            index: self.fields.len() - 1,
        }
    }

    fn spectrum(&mut self, level: Level, _name: &'static str, factors: Factors) -> Spectrum {
        // A table is read faster than roots are taken.
        let shape = self.levels[level.0].shape;
        self.spectra.push(factors.tabulated(shape, T::from_double));
        Spectrum {
            level,
            index: self.spectra.len() - 1,
        }
    }

    fn set_zero_mode(&mut self, spectrum: Spectrum, value: f64) {
        self.spectra[spectrum.index][0] = T::from_double(value);
    }

    fn write(&mut self, field: Field, values: &[f64]) {
        self.take(field);
        let stored = &mut self.fields[field.index];
        debug_assert_eq!(values.len(), stored.len());
        stored
            .par_iter_mut()
            .zip(values)
            .for_each(|(stored, &value)| *stored = T::from_double(value));
    }

    fn read(&mut self, field: Field) -> Result<Vec<f64>, BackendError> {
        self.take(field);
        let stored = self.fields[field.index].par_iter();
        Ok(stored.map(|value| value.double()).collect())
    }

    fn set_law_factor(&mut self, factor: Field) {
        self.law_factor = Some(factor);
    }

    fn set_outer_state(&mut self, outer: Option<[Field; 2]>) {
        self.outer = outer;
    }

    fn clear(&mut self, field: Field) {
        self.fields[field.index].fill(T::zero());
    }

    fn release(&mut self, field: Field) {
        self.fields[field.index] = Vec::new();
    }

    fn release_work(&mut self, level: Level) {
        if let Some(transform) = &mut self.levels[level.0].transform {
            transform.release();
        }
    }

    fn in_double(&self, _shape: Shape) -> Option<Box<dyn Backend + Send>> {
        self.corrected
            .then(|| Box::new(CpuBackend::<f64>::new()) as Box<dyn Backend + Send>)
    }

    fn set_params(&mut self, params: &Params) {
        self.params = Some(*params);
    }

    fn set_scalars(&mut self, scalars: &Scalars) {
        self.scalars = *scalars;
    }

    fn scalars(&mut self) -> Result<Scalars, BackendError> {
        Ok(self.scalars)
    }

    fn run(&mut self, kernel: &'static Kernel, level: Level, fields: &[Field]) {
        self.run_blocks(kernel, level, fields);
    }

    fn scalar(&mut self, kernel: &'static ScalarKernel) {
        if let Some(params) = &self.params {
            (kernel.run)(params, &mut self.scalars);
        }
    }

    fn multiply(&mut self, by: Spectrum, energy: bool, gate: Gate) {
        if !self.scalars.is_open(gate) {
            return;
        }
        self.transforms += self.share_of_first(by.level);
        let space = &mut self.levels[by.level.0];
        let Some(transform) = &mut space.transform else {
            debug_assert!(false, "a spectrum on a level without transforms");
            return;
        };
        let curvature = transform.multiply(&self.spectra[by.index], energy);
        if energy {
            self.scalars.curvature = curvature;
        }
    }

    fn epsilon(&self) -> f64 {
        T::EPSILON
    }

    fn transforms(&self) -> f64 {
        self.transforms
    }
}
