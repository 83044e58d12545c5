//! The processor: kernels' twins and transforms run at once, rows in parallel.
//!
//! Work is cut into blocks of eight rows whatever the number of threads, and sums add the blocks'
//! partial results in order, so results do not depend on how threads happen to be scheduled. This
//! is the only place that names rayon.
//!
//! Over several ranks each process holds a slab of the rows of every field and all of the scalars, and a caller
//! writes and reads this slab.

mod across;
mod blocks;
mod plans;
mod row_transform;
mod slabs;
mod threads;
mod transform;

use std::ops::Range;
use std::sync::Arc;

use rayon::prelude::*;

use super::ranks::{RankError, Ranks};
use super::{Backend, BackendError, Factors, Field, Level, Shape, Spectrum, Values, check_fields};
use crate::backend::long_field::LongField;
use crate::kernel::{Form, Gate, Kernel, Params, SUMS, ScalarKernel, Scalars, Twin, Whole};
use crate::plans::Planned;
use crate::real::Real;
pub use across::exchange_bytes;
use across::round_bytes;
use blocks::{BLOCK, Held, Job, run_blocks};
pub(super) use slabs::Slabs;
pub use slabs::largest_slab;
pub use threads::{Threads, in_pool, keep_memory, with_threads};
use transform::Transform;

/// A backend in double precision, the reference, with nothing in it; of several ranks each holds its rows.
pub fn double(ranks: Option<Arc<dyn Ranks>>) -> Box<dyn Backend + Send> {
    Box::new(CpuBackend::<f64>::new(ranks, false))
}

/// The same in single precision.
pub fn single(ranks: Option<Arc<dyn Ranks>>) -> Box<dyn Backend + Send> {
    Box::new(CpuBackend::<f32>::new(ranks, false))
}

/// One in single precision for iterations that correct a state kept in double precision.
pub fn mixed(ranks: Option<Arc<dyn Ranks>>) -> Box<dyn Backend + Send> {
    Box::new(CpuBackend::<f32>::new(ranks, true))
}

/// The backend in one kind of number. Nobody else names it: whoever does compiles it again.
struct CpuBackend<T: CpuReal> {
    levels: Vec<LevelSpace<T>>,
    fields: Vec<LongField<T>>,
    spectra: Vec<Vec<T>>,
    /// The field of factors on the law's tension.
    law_factor: Option<Field>,
    /// Gap and residual of the outer state that is corrected.
    outer_gap: Option<Field>,
    /// Whether a state in double precision stands beside the fields.
    corrected: bool,
    params: Option<Params>,
    scalars: Scalars,
    transforms: f64,
    /// The processes that hold the other rows; `None` where this one holds all.
    ranks: Option<Arc<dyn Ranks>>,
    /// Another rank has ended.
    failure: Option<RankError>,
}

struct LevelSpace<T: CpuReal> {
    shape: Shape,
    /// Its rows over the ranks.
    slabs: Option<Slabs>,
    /// Those of this process.
    held: Held,
    /// None where nothing is transformed.
    transform: Option<Transform<T>>,
    partials: Vec<[f64; SUMS]>,
}

impl<T: CpuReal> LevelSpace<T> {
    /// Points that this process holds.
    fn len(&self) -> usize {
        self.held.count * self.shape.points[0]
    }

    /// Columns of the half spectrum whose factors it holds.
    fn columns(&self) -> Range<usize> {
        let all = self.shape.points[0] / 2 + 1;
        match &self.slabs {
            None => 0..all,
            Some(slabs) => slabs.columns_of(slabs.ranks().rank(), all),
        }
    }
}

/// A field that a kernel reads at rows of its own choice, with the rows beside the held ones.
fn whole_field<'a, T: CpuReal>(
    fields: &'a [LongField<T>],
    levels: &[LevelSpace<T>],
    field: Option<Field>,
    edges: &'a [Vec<T>; 2],
) -> Whole<'a, T> {
    let Some(field) = field else {
        return Whole::none();
    };
    let space = &levels[field.level.0];
    let held = space.held.first..space.held.first + space.held.count;
    let values = &fields[field.index];
    let edges = edges.each_ref().map(|row| &row[..]);
    Whole::of_rows(values, space.shape.points, held, edges)
}

/// Numbers that pick their own twins.
pub(super) trait CpuReal: Real + Planned + bytemuck::Pod {
    /// The twin of a kernel for this number.
    fn twin(kernel: &'static Kernel) -> Twin<Self>;
    /// Values in this number, as another backend sees them.
    fn values(values: &[Self]) -> Values<'_>;
}

impl CpuReal for f64 {
    fn twin(kernel: &'static Kernel) -> Twin<f64> {
        kernel.twin
    }

    fn values(values: &[f64]) -> Values<'_> {
        Values::Double(values)
    }
}

impl CpuReal for f32 {
    fn twin(kernel: &'static Kernel) -> Twin<f32> {
        kernel.twin_single
    }

    fn values(values: &[f32]) -> Values<'_> {
        Values::Single(values)
    }
}

/// Values that a thread converts at a time.
const PIECE: usize = 1 << 14;

impl<T: CpuReal> CpuBackend<T> {
    fn new(ranks: Option<Arc<dyn Ranks>>, corrected: bool) -> Self {
        CpuBackend {
            levels: Vec::new(),
            fields: Vec::new(),
            spectra: Vec::new(),
            law_factor: None,
            outer_gap: None,
            corrected,
            params: None,
            scalars: Scalars::start(0.0, false),
            transforms: 0.0,
            ranks: ranks.filter(|ranks| ranks.count() > 1),
            failure: None,
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
            *stored = LongField::zeros(self.levels[field.level.0].len());
        }
    }

    /// Overwrites a field with values in another number.
    fn store<V: Copy + Sync>(&mut self, field: Field, values: &[V], round: impl Fn(V) -> T + Sync) {
        self.take(field);
        debug_assert_eq!(values.len(), self.levels[field.level.0].len());
        let stored = self.fields[field.index].par_chunks_mut(PIECE);
        stored
            .zip(values.par_chunks(PIECE))
            .for_each(|(stored, values)| {
                for (stored, value) in stored.iter_mut().zip(values) {
                    *stored = round(*value);
                }
            });
    }

    fn add_level(&mut self, shape: Shape, transforms: bool) -> Level {
        let rows = shape.points[1];
        let slabs = self.ranks.as_ref().map(|ranks| {
            let first = self.levels.first().and_then(|first| first.slabs.as_ref());
            match first {
                Some(first) => first.halved(rows),
                None => Slabs::of_blocks(Arc::clone(ranks), rows),
            }
        });
        let all = Held {
            first: 0,
            count: rows,
        };
        let held = slabs.as_ref().map_or(all, Slabs::held);
        self.levels.push(LevelSpace {
            shape,
            transform: transforms.then(|| Transform::new(shape, held.count)),
            partials: vec![[0.0; SUMS]; held.count.div_ceil(BLOCK)],
            slabs,
            held,
        });
        Level(self.levels.len() - 1)
    }

    /// The rows beside those of a field that a kernel reads at rows of its own choice.
    fn edges(&mut self, field: Option<Field>) -> [Vec<T>; 2] {
        let Some(field) = field else {
            return Default::default();
        };
        let space = &self.levels[field.level.0];
        let Some(slabs) = &space.slabs else {
            return Default::default();
        };
        match slabs.edges(&self.fields[field.index], space.shape.points[0]) {
            Ok(edges) => edges,
            Err(error) => {
                self.failure = Some(error);
                let row = || vec![T::zero(); space.shape.points[0]];
                [row(), row()]
            }
        }
    }

    /// Says that another rank has ended, if one has: what is computed without it is worth nothing.
    fn failed(&self) -> Result<(), BackendError> {
        match self.failure {
            Some(error) => Err(BackendError::Device(error.to_string())),
            None => Ok(()),
        }
    }

    /// Runs a kernel over the blocks of a level, with the transform's work space where it has one.
    fn run_blocks(&mut self, kernel: &'static Kernel, level: Level, fields: &[Field]) {
        if !self.scalars.is_open(kernel.gate) || self.failure.is_some() {
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
        let (own, has_around) = (kernel.written().end, kernel.around.is_some());
        let at = |present: bool, place: usize| fields.get(place).copied().filter(|_| present);
        let around = at(has_around, own);
        let whole = at(kernel.whole, own + usize::from(has_around));
        let around_edges = self.edges(around);
        let whole_edges = self.edges(whole);
        // Written fields are lifted out, so that the others can be borrowed meanwhile.
        let mut lifted: [LongField<T>; 4] = Default::default();
        for (slot, field) in fields[kernel.written()].iter().enumerate() {
            lifted[slot] = std::mem::take(&mut self.fields[field.index]);
        }
        let mut reads: [&[T]; 4] = [&[]; 4];
        for (slot, field) in fields[..kernel.reads.len()].iter().enumerate() {
            reads[slot] = &self.fields[field.index];
        }
        let around = whole_field(&self.fields, &self.levels, around, &around_edges);
        let whole = whole_field(&self.fields, &self.levels, whole, &whole_edges);
        let factor: &[T] = match self.law_factor {
            Some(field) if field.level == level => &self.fields[field.index],
            _ => &[],
        };
        let outer_gap: &[T] = match self.outer_gap {
            Some(field) if field.level == level => &self.fields[field.index],
            _ => &[],
        };
        let share = self.share_of_first(level);
        let space = &mut self.levels[level.0];
        let blocks = space.held.count.div_ceil(BLOCK);
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
            held: space.held,
            reads,
            writes: [a, b, c, d],
            whole,
            around,
            factor,
            outer_gap,
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
        let space = &self.levels[level.0];
        let gathered = match &space.slabs {
            Some(slabs) if !kernel.sums.is_empty() => {
                debug_assert!(space.held.first.is_multiple_of(BLOCK), "{}", kernel.name);
                slabs.gather_sums(&space.partials[..blocks], kernel.sums.len())
            }
            _ => Ok(Vec::new()),
        };
        let partials = match &gathered {
            Ok(all) if space.slabs.is_some() => all,
            Ok(_) => &space.partials[..blocks],
            Err(error) => {
                self.failure = Some(*error);
                &[]
            }
        };
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
        self.add_level(shape, true)
    }

    fn sweep_level(&mut self, _name: &'static str, shape: Shape) -> Level {
        self.add_level(shape, false)
    }

    fn field(&mut self, level: Level, _name: &'static str) -> Field {
        let points = self.levels[level.0].len();
        self.fields.push(LongField::zeros(points));
        Field {
            level,
            index: self.fields.len() - 1,
        }
    }

    fn spectrum(&mut self, level: Level, _name: &'static str, factors: Factors) -> Spectrum {
        // A table is read faster than roots are taken.
        let space = &self.levels[level.0];
        let columns = space.columns();
        self.spectra
            .push(factors.tabulated_columns(space.shape, columns, T::from_double));
        Spectrum {
            level,
            index: self.spectra.len() - 1,
        }
    }

    fn set_zero_mode(&mut self, spectrum: Spectrum, value: f64) {
        if self.levels[spectrum.level.0].columns().contains(&0) {
            self.spectra[spectrum.index][0] = T::from_double(value);
        }
    }

    fn write(&mut self, field: Field, values: &[f64]) {
        self.store(field, values, T::from_double);
    }

    fn read(&mut self, field: Field) -> Result<LongField<f64>, BackendError> {
        self.take(field);
        self.failed()?;
        let stored = &self.fields[field.index];
        let mut values = LongField::zeros(stored.len());
        let pieces = values.par_chunks_mut(PIECE).zip(stored.par_chunks(PIECE));
        pieces.for_each(|(values, stored)| {
            for (value, stored) in values.iter_mut().zip(stored) {
                *value = stored.double();
            }
        });
        Ok(values)
    }

    fn values(&mut self, field: Field) -> Result<Option<Values<'_>>, BackendError> {
        self.take(field);
        self.failed()?;
        Ok(Some(T::values(&self.fields[field.index])))
    }

    fn copy_from(
        &mut self,
        field: Field,
        from: &mut dyn Backend,
        source: Field,
    ) -> Result<(), BackendError> {
        match from.values(source)? {
            Some(Values::Double(values)) => self.store(field, values, T::from_double),
            Some(Values::Single(values)) => {
                self.store(field, values, |value| T::from_double(value.into()));
            }
            None => self.write(field, &from.read(source)?),
        }
        Ok(())
    }

    fn set_law_factor(&mut self, factor: Field) {
        self.law_factor = Some(factor);
    }

    fn set_outer_gap(&mut self, outer_gap: Option<Field>) {
        self.outer_gap = outer_gap;
    }

    fn clear(&mut self, field: Field) {
        self.fields[field.index].fill(T::zero());
    }

    fn release(&mut self, field: Field) {
        self.fields[field.index] = LongField::default();
    }

    fn release_work(&mut self, level: Level) {
        if let Some(transform) = &mut self.levels[level.0].transform {
            transform.release();
        }
    }

    fn in_double(&self, _shape: Shape) -> Option<Box<dyn Backend + Send>> {
        self.corrected.then(|| double(self.ranks.clone()))
    }

    fn in_single(&self) -> Option<Box<dyn Backend + Send>> {
        (T::EPSILON < f32::EPSILON.into()).then(|| single(self.ranks.clone()))
    }

    fn set_params(&mut self, params: &Params) {
        self.params = Some(*params);
    }

    fn set_scalars(&mut self, scalars: &Scalars) {
        self.scalars = *scalars;
    }

    fn scalars(&mut self) -> Result<Scalars, BackendError> {
        self.failed()?;
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
        if !self.scalars.is_open(gate) || self.failure.is_some() {
            return;
        }
        self.transforms += self.share_of_first(by.level);
        let space = &mut self.levels[by.level.0];
        let Some(transform) = &mut space.transform else {
            debug_assert!(false, "a spectrum on a level without transforms");
            return;
        };
        let factors = &self.spectra[by.index];
        let curvature = match &space.slabs {
            None => Ok(transform.multiply(factors, energy)),
            Some(slabs) => {
                let points = space.shape.points;
                let round = round_bytes(points, size_of::<T>(), slabs.ranks().count());
                transform.multiply_across(factors, energy, slabs, round)
            }
        };
        match curvature {
            Ok(curvature) if energy => self.scalars.curvature = curvature,
            Ok(_) => {}
            Err(error) => self.failure = Some(error),
        }
    }

    fn epsilon(&self) -> f64 {
        T::EPSILON
    }

    fn transforms(&self) -> f64 {
        self.transforms
    }
}
