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
mod layout;
mod lending;
mod level;
mod plan;
mod reading;
mod recorder;
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
use bindings::{Access, COLUMNS, ROWS, WORKING};
use deciding::{Decided, Deciding};
use level::{LevelPlan, Place};
use recorder::{Prepared, Recorder};
use source::{Reduction, Results};
use space::{FieldSpace, Key, LevelSpace, SpectrumSpace};

pub use catalogue::LawPart;
pub use device::{AdapterChoice, AdapterDescription, AdapterKind, GpuDevice, adapters};
pub use error::GpuError;
pub use layout::{Number, Wide};
pub use lending::Lent;
pub use plan::{Exchange, GroupLimits, LinePlan, radices};
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
    prepared: HashMap<Key, Prepared>,
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
        let limit = self.device.binding_limit();
        if bytes as u64 > limit {
            return Err(GpuError::TooLarge {
                name: name.to_string(),
                bytes: bytes as u64,
                limit,
            });
        }
        self.device
            .guarded(|device| space::buffer(device, name, bytes, wgpu::BufferUsages::STORAGE))
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

    /// Finds a prepared dispatch or prepares it, and records it.
    fn dispatch(
        &mut self,
        key: Key,
        prepare: impl FnOnce(&Self) -> Result<Prepared, GpuError>,
    ) -> Result<(), GpuError> {
        let prepared = match self.prepared.get(&key) {
            Some(prepared) => prepared.clone(),
            None => {
                let prepared = prepare(self)?;
                self.prepared.insert(key, prepared.clone());
                prepared
            }
        };
        self.traffic.dispatches += 1;
        self.device.count_dispatch();
        self.recorder.dispatch(prepared)
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

    fn kernel(
        &self,
        kernel: &'static Kernel,
        level: Level,
        fields: &[Field],
    ) -> Result<Prepared, GpuError> {
        let space = self.level_space(level)?;
        let mut buffers = Vec::new();
        for &field in fields {
            buffers.push(&self.field_space(field)?.buffer);
        }
        let whole = match (kernel.whole, fields.last()) {
            (true, Some(field)) => self.level_space(field.level)?.plan.shape,
            _ => [0, 0],
        };
        let mut accesses = bindings::fields(kernel.reads, kernel.writes, kernel.whole);
        // Bound behind the kernel's own fields.
        let factor = match self.law_factor {
            Some(field) if field.level == level && catalogue::asks_for_law(kernel.name) => {
                buffers.push(&self.field_space(field)?.buffer);
                accesses.push(Access::Read);
                Some(kernel.fields())
            }
            _ => None,
        };
        let base = match self.base {
            Some(base) if base[0].level == level && catalogue::asks_for_law(kernel.name) => {
                let first = buffers.len();
                for field in base {
                    buffers.push(&self.field_space(field)?.buffer);
                    accesses.push(Access::Read);
                }
                Some(first)
            }
            _ => None,
        };
        let law = source::LawSource {
            part: self.law,
            factor,
            base,
        };
        let text = source::kernel(kernel, &space.plan, whole, law, self.wide)?;
        let shared = [&self.params, &self.scalars, &space.partials];
        let transform = [&space.row_roots, &space.work];
        let mut groups: Vec<(&[Access], &[&wgpu::Buffer])> =
            vec![(WORKING, &shared), (&accesses, &buffers)];
        if kernel.form != Form::Sweep {
            groups.push((ROWS, &transform));
        }
        let mut prepared =
            self.prepare(kernel.name, text, &groups, space.plan.groups(kernel.form))?;
        let only_written = &buffers[kernel.reads + kernel.writes - kernel.fresh..][..kernel.fresh];
        prepared.bytes -= only_written.iter().map(|buffer| buffer.size()).sum::<u64>();
        if matches!(kernel.form, Form::Load | Form::Store | Form::Peek) {
            prepared.bytes -= space.work.size();
        }
        Ok(prepared)
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
            let shared = [&backend.params, &backend.scalars, &space.partials];
            let factors = &backend.spectrum_space(by)?.buffer;
            let buffers = [&space.column_roots, &space.work, factors];
            let groups = space.plan.column_groups();
            backend.prepare(
                "multiply",
                text,
                &[(WORKING, &shared), (COLUMNS, &buffers)],
                groups,
            )
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

/// Rounds recorded before the host waits: a wait costs about as much as these cost to record.
const LOOK_EVERY: usize = 8;

impl Backend for GpuBackend {
    fn look_every(&self) -> usize {
        self.look_every
    }

    fn suits(&self, shape: Shape) -> bool {
        LevelPlan::new(shape, self.device.group_limits(), self.number).is_ok()
    }

    fn level(&mut self, name: &'static str, shape: Shape) -> Level {
        let space = self.attempt(|backend| {
            let number = backend.number;
            let plan = LevelPlan::new(shape, backend.device.group_limits(), number)?;
            // Half as many complex numbers as points.
            let work = backend.storage(name, number.bytes() * plan.points())?;
            let partials = 8 + plan.partials() * backend.wide.part_bytes();
            Ok(LevelSpace {
                row_roots: backend.roots(plan.shape[0])?,
                column_roots: backend.roots(plan.shape[1])?,
                partials: backend.storage(name, partials)?,
                work,
                plan,
            })
        });
        self.levels.push(space);
        Level(self.levels.len() - 1)
    }

    fn field(&mut self, level: Level, name: &'static str) -> Field {
        let space = self.attempt(|backend| {
            let points = backend.level_space(level)?.plan.points();
            let buffer = backend.storage(name, backend.number.bytes() * points)?;
            Ok(FieldSpace { buffer, points })
        });
        self.fields.push(space);
        Field {
            level,
            index: self.fields.len() - 1,
        }
    }

    fn spectrum(&mut self, level: Level, name: &'static str, values: &[f64]) -> Spectrum {
        let space = self.attempt(|backend| {
            let buffer = backend.storage(name, backend.number.bytes() * values.len())?;
            let bytes = backend.number.bytes_of(values.iter().copied());
            backend.overwrite(&buffer, bytes)?;
            Ok(SpectrumSpace { buffer })
        });
        self.spectra.push(space);
        Spectrum {
            level,
            index: self.spectra.len() - 1,
        }
    }

    fn set_zero_mode(&mut self, spectrum: Spectrum, value: f64) {
        self.attempt(|backend| {
            let buffer = backend.spectrum_space(spectrum)?.buffer.clone();
            let bytes = backend.number.bytes_of([value]);
            backend.overwrite(&buffer, bytes)
        });
    }

    fn write(&mut self, field: Field, values: &[f64]) {
        self.attempt(|backend| {
            let buffer = backend.field_space(field)?.buffer.clone();
            backend.traffic.fields_up += 1;
            let bytes = backend.number.bytes_of(values.iter().copied());
            backend.overwrite(&buffer, bytes)
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
            let buffer = backend.field_space(field)?.buffer.clone();
            backend.settle()?;
            backend.recorder.clear(&buffer)
        });
    }

    /// On the device where it has double precision and takes the shape in it, else on the processor.
    fn in_double(&self, shape: Shape) -> Option<Box<dyn Backend + Send>> {
        self.corrected.then(|| -> Box<dyn Backend + Send> {
            let adapter = self.device.description();
            match adapter.double && adapter.takes(shape.points, Number::Double) {
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
            Some(lent) if lent.is_on(&self.device) => {
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
