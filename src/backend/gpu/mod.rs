//! A graphics processor through wgpu: fields in single or double precision, kernels as WGSL.
//!
//! A convolution is three dispatches: rows, columns with the factors, rows back. The work space of
//! a level holds the transforms along x of its pairs of rows (y with y + ny/2, one complex row),
//! transposed, so it takes no more than a field does. Scalars stay on the device, where the scalar
//! kernels change them; a kernel whose gate is shut returns at once. This is the only place that
//! names wgpu.

mod bindings;
mod butterfly;
mod catalogue;
mod deciding;
mod device;
mod error;
mod fft;
mod filling;
mod layout;
mod lending;
mod level;
mod plan;
mod reading;
mod recorder;
mod slabs;
pub mod source;
mod space;
mod sums;
mod timing;
mod traffic;

use std::collections::HashMap;
use std::f64::consts::TAU;

use super::cpu::CpuBackend;
use super::{Backend, BackendError, Field, Level, Shape, Spectrum};
use crate::kernel::{Form, Gate, Kernel, Params, ScalarKernel, Scalars};
use bindings::{Access, ROWS, WORKING, WORKING_IN_TURNS};
use deciding::{Decided, Deciding};
use level::Place;
use recorder::{Prepared, Recorder};
use source::{Reduction, Results};
use space::{FieldSpace, Key, LevelSpace, SpectrumSpace};

pub use catalogue::LawPart;
pub use device::{AdapterChoice, AdapterDescription, AdapterKind, GpuDevice, adapters};
pub use error::GpuError;
pub use layout::{Number, Wide};
pub use lending::Lent;
pub use plan::{Exchange, GroupLimits, LinePlan, radices};
pub use slabs::Limits;
pub use timing::{KernelTime, Stopwatch, Timings};
pub use traffic::Traffic;

/// The GPU backend.
pub struct GpuBackend {
    device: GpuDevice,
    /// The number of the fields.
    number: Number,
    wide: Wide,
    recorder: Recorder,
    params: wgpu::Buffer,
    scalars: wgpu::Buffer,
    levels: Vec<Option<LevelSpace>>,
    fields: Vec<Option<FieldSpace>>,
    spectra: Vec<Option<SpectrumSpace>>,
    roots: HashMap<usize, wgpu::Buffer>,
    prepared: HashMap<Key, Vec<Prepared>>,
    /// What is decided after the last kernel over points, in one dispatch.
    deciding: Deciding,
    traffic: Traffic,
    law: LawPart,
    /// The field of factors on the law's tension.
    law_factor: Option<Field>,
    /// Gap and residual of the base that is corrected.
    base: Option<[Field; 2]>,
    /// Whether a state in double precision stands beside the fields.
    corrected: bool,
    /// Whether scalars that are not finite are a failure.
    expects_numbers: bool,
    /// The first thing that went wrong; told where the host waits.
    failure: Option<GpuError>,
    transforms: f64,
    look_every: usize,
}

impl GpuBackend {
    /// A backend in single precision with nothing in it.
    pub fn new(device: &GpuDevice) -> Result<Self, GpuError> {
        let backend = Self::on(device);
        backend.checked()?;
        Ok(backend)
    }

    /// The same for where nothing may fail yet: what goes wrong is told where the host waits.
    pub fn on(device: &GpuDevice) -> Self {
        let wide = device.wide();
        let ((params, scalars), failure) = device.watched(|device| {
            let params = space::buffer(
                device,
                "params",
                layout::params_length(wide),
                wgpu::BufferUsages::UNIFORM,
            );
            let scalars = space::buffer(
                device,
                "scalars",
                layout::scalars_length(wide),
                wgpu::BufferUsages::STORAGE,
            );
            (params, scalars)
        });
        let mut backend = GpuBackend {
            device: device.clone(),
            number: Number::Single,
            wide,
            recorder: Recorder::new(device.clone()),
            params,
            scalars,
            levels: Vec::new(),
            fields: Vec::new(),
            spectra: Vec::new(),
            roots: HashMap::new(),
            prepared: HashMap::new(),
            deciding: Deciding::default(),
            traffic: Traffic::default(),
            law: LawPart::HardWall,
            law_factor: None,
            base: None,
            corrected: false,
            expects_numbers: false,
            failure,
            transforms: 0.0,
            // Software idles through shut gates slower than it waits.
            look_every: match device.description().software() {
                true => 1,
                false => LOOK_EVERY,
            },
        };
        backend.set_scalars(&Scalars::start(0.0, false));
        backend
    }

    /// The same, looking after so many rounds.
    pub fn looking_every(self, rounds: usize) -> Self {
        GpuBackend {
            look_every: rounds.max(1),
            ..self
        }
    }

    /// The same with its fields in this number, before there are any. Where the device lacks it that is
    /// told where the host waits.
    pub fn keeping(mut self, number: Number) -> Self {
        if number == Number::Double && !self.device.description().double {
            let name = self.device.description().name.clone();
            self.failure.get_or_insert(GpuError::Precision(name));
        }
        GpuBackend { number, ..self }
    }

    /// The same where numbers that are none are a failure of the device, not an answer.
    pub fn expecting_numbers(self) -> Self {
        GpuBackend {
            expects_numbers: true,
            ..self
        }
    }

    /// The same for iterations that correct a state kept in double precision.
    pub fn corrected(self) -> Self {
        GpuBackend {
            corrected: true,
            ..self
        }
    }

    /// What went over the bus and to the device so far.
    pub fn traffic(&self) -> Traffic {
        self.traffic
    }

    /// The device it computes on.
    pub fn device(&self) -> &GpuDevice {
        &self.device
    }

    /// The first failure, if there was one.
    fn checked(&self) -> Result<(), GpuError> {
        match &self.failure {
            Some(error) => Err(error.clone()),
            None => Ok(()),
        }
    }

    /// Does something unless something has failed before, and remembers its failure.
    fn attempt<R>(&mut self, work: impl FnOnce(&mut Self) -> Result<R, GpuError>) -> Option<R> {
        if self.failure.is_some() {
            return None;
        }
        match work(self) {
            Ok(result) => Some(result),
            Err(error) => {
                self.failure = Some(error);
                None
            }
        }
    }

    /// A table of the roots of unity `exp(-2 pi i m / n)`, computed in double precision.
    fn roots(&mut self, length: usize) -> Result<wgpu::Buffer, GpuError> {
        if let Some(buffer) = self.roots.get(&length) {
            return Ok(buffer.clone());
        }
        let buffer = self.storage("roots", 2 * self.number.bytes() * length)?;
        let values = (0..length).flat_map(|m| {
            let angle = TAU * m as f64 / length as f64;
            [angle.cos(), -angle.sin()]
        });
        self.recorder.write(&buffer, self.number.bytes_of(values))?;
        self.roots.insert(length, buffer.clone());
        Ok(buffer)
    }

    /// A storage buffer of zeros, if the adapter can bind it.
    fn storage(&self, name: &str, bytes: usize) -> Result<wgpu::Buffer, GpuError> {
        let limit = self.device.limits().binding;
        if bytes as u64 > limit {
            return Err(GpuError::TooLarge {
                name: name.to_string(),
                bytes: bytes as u64,
                limit,
            });
        }
        self.device.allocate(name, bytes)
    }

    fn level_space(&self, level: Level) -> Result<&LevelSpace, GpuError> {
        self.levels
            .get(level.0)
            .and_then(Option::as_ref)
            .ok_or_else(|| GpuError::Device("a level that was not made".to_string()))
    }

    fn field_space(&self, field: Field) -> Result<&FieldSpace, GpuError> {
        self.fields
            .get(field.index)
            .and_then(Option::as_ref)
            .ok_or_else(|| GpuError::Device("a field that was not made".to_string()))
    }

    fn spectrum_space(&self, spectrum: Spectrum) -> Result<&SpectrumSpace, GpuError> {
        self.spectra
            .get(spectrum.index)
            .and_then(Option::as_ref)
            .ok_or_else(|| GpuError::Device("a spectrum that was not made".to_string()))
    }

    /// Compiles a shader and binds its buffers, group by group.
    fn prepare(
        &self,
        name: &str,
        source: String,
        groups: &[(&[Access], &[&wgpu::Buffer])],
        workgroups: usize,
    ) -> Result<Prepared, GpuError> {
        // All but what decisions are taken from; what is written is taken to be updated.
        let bytes = groups
            .iter()
            .filter(|(accesses, _)| !accesses.contains(&Access::Uniform))
            .flat_map(|(accesses, buffers)| accesses.iter().zip(*buffers))
            .map(|(access, buffer)| match access {
                Access::Write => 2 * buffer.size(),
                Access::Read | Access::Uniform => buffer.size(),
            })
            .sum();
        let (layouts, groups) = self.device.guarded(|device| {
            groups
                .iter()
                .map(|(accesses, buffers)| {
                    let layout = bindings::layout(device, accesses);
                    let group = bindings::group(device, &layout, buffers);
                    (layout, group)
                })
                .collect::<(Vec<_>, Vec<_>)>()
        })?;
        let layouts: Vec<_> = layouts.iter().collect();
        let pipeline = self.device.pipeline(name, source, &layouts)?;
        Ok(Prepared {
            name: name.to_owned(),
            bytes,
            pipeline,
            groups,
            // Plans keep it far below the 65535 that every adapter takes.
            workgroups: workgroups as u32,
        })
    }

    /// Finds what is prepared, a dispatch each slab, or prepares it, and records it.
    fn dispatch(
        &mut self,
        key: Key,
        prepare: impl FnOnce(&Self) -> Result<Vec<Prepared>, GpuError>,
    ) -> Result<(), GpuError> {
        let prepared = match self.prepared.get(&key) {
            Some(prepared) => prepared.clone(),
            None => {
                let prepared = prepare(self)?;
                self.prepared.insert(key, prepared.clone());
                prepared
            }
        };
        for each in prepared {
            self.traffic.dispatches += 1;
            self.device.count_dispatch();
            self.recorder.dispatch(each)?;
        }
        match self.device.poisons() {
            true => self.poison(),
            false => Ok(()),
        }
    }

    /// Records a kernel of the catalogue and the reduction of its sums.
    fn run(
        &mut self,
        kernel: &'static Kernel,
        level: Level,
        fields: &[Field],
    ) -> Result<(), GpuError> {
        if fields.len() != kernel.fields() {
            return Err(GpuError::Fields {
                kernel: kernel.name,
                expected: kernel.fields(),
                given: fields.len(),
            });
        }
        let indices = fields.iter().map(|field| field.index).collect();
        let key = Key::Kernel(kernel.name, level.0, self.base.is_some(), indices);
        let place = Place::of(kernel.form);
        if kernel.gate != Gate::Ahead {
            self.settle()?;
        } else if !kernel.sums.is_empty() {
            self.make_room(level, place)?;
        }
        self.dispatch(key, |backend| backend.kernel(kernel, level, fields))?;
        if kernel.sums.is_empty() {
            return Ok(());
        }
        let plan = &self.level_space(level)?.plan;
        let reduction = Reduction {
            results: Results::Sums(kernel.sums),
            groups: plan.groups(kernel.form),
            first: plan.first_partial(place),
            gate: kernel.gate,
        };
        self.put_off(Decided {
            name: kernel.name,
            level,
            place,
            reduction,
        });
        Ok(())
    }

    /// Hands over what waits, then overwrites the beginning of a buffer.
    fn overwrite(
        &mut self,
        buffer: &wgpu::Buffer,
        bytes: impl Iterator<Item = u8>,
    ) -> Result<(), GpuError> {
        self.settle()?;
        self.recorder.write(buffer, bytes)
    }

    /// The dispatches of a kernel, one a slab.
    fn kernel(
        &self,
        kernel: &'static Kernel,
        level: Level,
        fields: &[Field],
    ) -> Result<Vec<Prepared>, GpuError> {
        let space = self.level_space(level)?;
        let mut bound = Vec::new();
        for &field in fields {
            bound.push(&self.field_space(field)?.slabs);
        }
        let own = kernel.reads + kernel.writes;
        let whole = match (kernel.whole, fields.last()) {
            (true, Some(field)) => source::Whole::of(&self.level_space(field.level)?.plan),
            _ => source::Whole::default(),
        };
        let mut accesses = bindings::fields(kernel.reads, kernel.writes, whole.slabs);
        let mut behind = Vec::new();
        let mut follow = |fields: &[Field]| -> Result<usize, GpuError> {
            let first = accesses.len();
            for &field in fields {
                behind.push(&self.field_space(field)?.slabs);
                accesses.push(Access::Read);
            }
            Ok(first)
        };
        // Bound behind the kernel's own fields.
        let asks = catalogue::asks_for_law(kernel.name);
        let factor = match self.law_factor {
            Some(field) if field.level == level && asks => Some(follow(&[field])?),
            _ => None,
        };
        let base = match self.base {
            Some(base) if base[0].level == level && asks => Some(follow(&base)?),
            _ => None,
        };
        let law = source::LawSource {
            part: self.law,
            factor,
            base,
        };
        let text = source::kernel(kernel, &space.plan, whole, law, self.wide)?;
        let groups = space.plan.slab_groups(kernel.form);
        let in_slab = |slab: usize| {
            let shared = self.shared(space, slab);
            let mut buffers: Vec<_> = bound[..own].iter().map(|slabs| &slabs[slab]).collect();
            // A field read as a whole is bound in all its slabs.
            buffers.extend(bound[own..].iter().copied().flatten());
            buffers.extend(behind.iter().map(|slabs| &slabs[slab]));
            let transform = [&space.row_roots, &space.work[slab]];
            let mut all: Vec<(&[Access], &[&wgpu::Buffer])> =
                vec![(working(&shared), &shared), (&accesses, &buffers)];
            if kernel.form != Form::Sweep {
                all.push((ROWS, &transform));
            }
            let mut prepared = self.prepare(kernel.name, text.clone(), &all, groups)?;
            let only_written = &buffers[own - kernel.fresh..own];
            prepared.bytes -= only_written.iter().map(|buffer| buffer.size()).sum::<u64>();
            if matches!(kernel.form, Form::Load | Form::Store | Form::Peek) {
                prepared.bytes -= space.work[slab].size();
            }
            Ok(prepared)
        };
        (0..space.plan.slabs).map(in_slab).collect()
    }

    /// Group 0 of a kernel in one of its turns over slabs or parts of a spectrum.
    fn shared<'a>(&'a self, space: &'a LevelSpace, turn: usize) -> Vec<&'a wgpu::Buffer> {
        let mut shared = vec![&self.params, &self.scalars, &space.partials];
        shared.extend(space.turns.get(turn));
        shared
    }

    fn columns(&mut self, by: Spectrum, energy: bool, gate: Gate) -> Result<(), GpuError> {
        // It changes the work space alone, so it need not wait for the decision whether to run.
        let gate = match gate {
            Gate::Accepted => Gate::Running,
            other => other,
        };
        let word = source::gate_name(gate);
        if energy {
            self.make_room(by.level, Place::Columns)?;
        }
        self.dispatch(Key::Multiply(by.index, energy, word), |backend| {
            let space = backend.level_space(by.level)?;
            let text = source::multiply(&space.plan, energy, gate, backend.wide);
            let accesses = bindings::columns(space.plan.slabs);
            let in_part = |(part, factors): (usize, &wgpu::Buffer)| {
                let shared = backend.shared(space, part);
                let mut buffers = vec![&space.column_roots];
                buffers.extend(&space.work);
                buffers.push(factors);
                let all: [(&[Access], &[&wgpu::Buffer]); 2] =
                    [(working(&shared), &shared), (&accesses, &buffers)];
                let groups = space.plan.part_groups();
                let mut prepared = backend.prepare("multiply", text.clone(), &all, groups)?;
                // Each part goes through its own columns of the work space alone.
                let work: u64 = space.work.iter().map(|slab| slab.size()).sum();
                prepared.bytes -= 2 * (work - work / space.plan.parts as u64);
                Ok(prepared)
            };
            let parts = &backend.spectrum_space(by)?.parts;
            parts.iter().enumerate().map(in_part).collect()
        })?;
        if !energy {
            return Ok(());
        }
        let plan = &self.level_space(by.level)?.plan;
        let reduction = Reduction {
            results: Results::Curvature(plan.points()),
            groups: plan.column_groups(),
            first: plan.first_partial(Place::Columns),
            gate,
        };
        self.put_off(Decided {
            name: word,
            level: by.level,
            place: Place::Columns,
            reduction,
        });
        Ok(())
    }
}

/// What group 0 is to a kernel over points, by what is bound.
fn working(shared: &[&wgpu::Buffer]) -> &'static [Access] {
    match shared.len() == WORKING.len() {
        true => WORKING,
        false => WORKING_IN_TURNS,
    }
}

/// Rounds recorded before the host waits: a wait costs about as much as these cost to record.
const LOOK_EVERY: usize = 8;

impl Backend for GpuBackend {
    fn look_every(&self) -> usize {
        self.look_every
    }

    fn suits(&self, shape: Shape) -> bool {
        self.plan(shape).is_ok()
    }

    fn level(&mut self, name: &'static str, shape: Shape) -> Level {
        let space = self.attempt(|backend| {
            let plan = backend.plan(shape)?;
            let partials = 8 + plan.partials() * backend.wide.part_bytes();
            Ok(LevelSpace {
                row_roots: backend.roots(plan.shape[0])?,
                column_roots: backend.roots(plan.shape[1])?,
                partials: backend.storage(name, partials)?,
                // Half as many complex numbers as points.
                work: backend.slabs(name, &plan)?,
                turns: backend.turns(&plan)?,
                plan,
            })
        });
        self.levels.push(space);
        Level(self.levels.len() - 1)
    }

    fn field(&mut self, level: Level, name: &'static str) -> Field {
        let space = self.attempt(|backend| {
            let slabs = backend.slabs(name, &backend.level_space(level)?.plan)?;
            Ok(FieldSpace { slabs })
        });
        self.fields.push(space);
        Field {
            level,
            index: self.fields.len() - 1,
        }
    }

    fn spectrum(&mut self, level: Level, name: &'static str, values: &[f64]) -> Spectrum {
        let space = self.attempt(|backend| {
            let plan = backend.level_space(level)?.plan.clone();
            let parts = backend.write_parts(name, &plan, values)?;
            Ok(SpectrumSpace { parts })
        });
        self.spectra.push(space);
        Spectrum {
            level,
            index: self.spectra.len() - 1,
        }
    }

    fn set_zero_mode(&mut self, spectrum: Spectrum, value: f64) {
        self.attempt(|backend| {
            let first = backend.spectrum_space(spectrum)?.parts[0].clone();
            let bytes = backend.number.bytes_of([value]);
            backend.overwrite(&first, bytes)
        });
    }

    fn write(&mut self, field: Field, values: &[f64]) {
        self.attempt(|backend| {
            backend.traffic.fields_up += 1;
            backend.write_slabs(field, values)
        });
    }

    fn read(&mut self, field: Field) -> Result<Vec<f64>, BackendError> {
        let result = self.fetch(field);
        if let Err(error) = &result {
            self.failure.get_or_insert_with(|| error.clone());
        }
        Ok(result?)
    }

    fn set_law_factor(&mut self, factor: Field) {
        // Kernels with a factor bind one field more.
        self.prepared.clear();
        self.law_factor = Some(factor);
    }

    fn set_base(&mut self, base: Option<[Field; 2]>) {
        self.base = base;
    }

    fn clear(&mut self, field: Field) {
        self.attempt(|backend| {
            backend.settle()?;
            let slabs = backend.field_space(field)?.slabs.clone();
            slabs
                .iter()
                .try_for_each(|slab| backend.recorder.clear(slab))
        });
    }

    /// On the device where it has double precision and takes the shape in it, else on the processor.
    fn in_double(&self, shape: Shape) -> Option<Box<dyn Backend + Send>> {
        self.corrected.then(|| -> Box<dyn Backend + Send> {
            match self.corrects_here(shape) {
                true => Box::new(GpuBackend::on(&self.device).keeping(Number::Double)),
                false => Box::new(CpuBackend::<f64>::new()),
            }
        })
    }

    fn take(
        &mut self,
        field: Field,
        from: &mut dyn Backend,
        source: Field,
    ) -> Result<(), BackendError> {
        match from.lend(source) {
            Some(lent) if self.takes_over(field, &lent) => {
                self.attempt(|backend| backend.convert(field, &lent));
            }
            _ => self.write(field, &from.read(source)?),
        }
        Ok(())
    }

    fn lend(&mut self, field: Field) -> Option<Lent> {
        self.attempt(|backend| backend.hand_out(field))
    }

    fn set_params(&mut self, params: &Params) {
        let law = LawPart::of(&params.law);
        if law != self.law {
            // Kernels of another law are others under the same name.
            self.prepared.clear();
            self.law = law;
        }
        let bytes = layout::params_bytes(params, self.wide);
        self.attempt(|backend| {
            let buffer = backend.params.clone();
            backend.overwrite(&buffer, bytes.into_iter())
        });
    }

    fn set_scalars(&mut self, scalars: &Scalars) {
        let bytes = layout::scalars_bytes(scalars, self.wide);
        self.attempt(|backend| {
            let buffer = backend.scalars.clone();
            backend.overwrite(&buffer, bytes.into_iter())
        });
    }

    fn scalars(&mut self) -> Result<Scalars, BackendError> {
        let result = self.look();
        if let Err(error) = &result {
            self.failure.get_or_insert_with(|| error.clone());
        }
        Ok(result?)
    }

    fn sweep(&mut self, kernel: &'static Kernel, level: Level, fields: &[Field]) {
        self.attempt(|backend| backend.run(kernel, level, fields));
    }

    fn scalar(&mut self, kernel: &'static ScalarKernel) {
        self.deciding.decide(kernel);
    }

    fn forward(&mut self, kernel: &'static Kernel, level: Level, fields: &[Field]) {
        self.attempt(|backend| backend.run(kernel, level, fields));
    }

    fn multiply(&mut self, by: Spectrum, energy: bool, gate: Gate) {
        self.attempt(|backend| backend.columns(by, energy, gate));
    }

    fn backward(&mut self, kernel: &'static Kernel, level: Level, fields: &[Field]) {
        self.attempt(|backend| backend.run(kernel, level, fields));
    }

    fn turn(&mut self, kernel: &'static Kernel, level: Level, fields: &[Field]) {
        self.attempt(|backend| backend.run(kernel, level, fields));
    }

    fn epsilon(&self) -> f64 {
        self.number.epsilon()
    }

    /// As counted on the device when the host last waited.
    fn transforms(&self) -> f64 {
        self.transforms
    }
}
