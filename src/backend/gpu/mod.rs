//! A graphics processor through wgpu: fields in single or double precision, kernels as WGSL.
//!
//! A convolution is three dispatches: rows, columns with the factors, rows back. The work space of
//! a level holds the transforms along x of its pairs of rows (y with y + ny/2, one complex row),
//! transposed, so it takes no more than a field does. Scalars stay on the device, where the scalar
//! kernels change them; a kernel whose gate is shut returns at once. This is the only place that
//! names wgpu.

mod adapter;
mod bindings;
mod butterfly;
mod catalogue;
mod deciding;
mod device;
mod dispatching;
mod error;
mod faults;
mod fft;
mod filling;
mod layout;
mod level;
mod long;
mod loops;
#[cfg(feature = "fault-injection")]
mod members;
mod pipelines;
mod plan;
mod quiet;
mod reading;
mod recorder;
mod sharing;
mod slabs;
pub mod source;
mod space;
mod sums;
mod timing;
mod traffic;
mod transfer;

use std::collections::HashMap;

use super::cpu;
use super::{Backend, BackendError, Factors, Field, Level, Shape, Spectrum, Values};
use crate::backend::long_field::LongField;
use crate::kernel::{Gate, Kernel, Params, ScalarKernel, Scalars};
use crate::law::{Law, LawShader};
use deciding::Deciding;
use recorder::{Prepared, Recorder};
use space::{FieldSpace, Key, LevelSpace, SpectrumSpace};

pub use adapter::{AdapterChoice, AdapterDescription, AdapterKind, adapters};
pub use butterfly::Direction;
pub use device::{GpuDevice, keeps_waiting};
pub use error::GpuError;
#[cfg(feature = "fault-injection")]
pub use faults::Faults;
pub use layout::{Number, Wide};
pub use loops::Loops;
pub use plan::{Exchange, GroupLimits, LinePlan, radices};
pub use quiet::{quietly, restore_standard_error};
pub use sharing::SharedBuffer;
pub use slabs::Limits;
pub use source::OWN_FACTORS;
pub use timing::{KernelTime, Stopwatch, Timings};
pub use traffic::Traffic;

/// The GPU backend.
pub struct GpuBackend {
    device: GpuDevice,
    /// Number type of the fields.
    number: Number,
    wide: Wide,
    recorder: Recorder,
    params: wgpu::Buffer,
    scalars: wgpu::Buffer,
    levels: Vec<Option<LevelSpace>>,
    fields: Vec<Option<FieldSpace>>,
    spectra: Vec<Option<SpectrumSpace>>,
    /// By the points of a line and of its first pass.
    roots: HashMap<[usize; 2], wgpu::Buffer>,
    prepared: HashMap<Key, Vec<Prepared>>,
    /// Sums and scalar kernels to run after the last field kernel, in one dispatch.
    deciding: Deciding,
    traffic: Traffic,
    law: LawShader,
    /// The field of factors on the law's tension.
    law_factor: Option<Field>,
    /// Gap and residual of the outer state that is corrected.
    outer_gap: Option<Field>,
    /// Whether a state in double precision stands beside the fields.
    corrected: bool,
    /// Whether scalars that are not finite are a failure.
    expects_finite: bool,
    /// The first failure; returned where the host waits.
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

    /// The same without a `Result`: a failure is returned where the host waits.
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
            law: Law::HardWall.shader(),
            law_factor: None,
            outer_gap: None,
            corrected: false,
            expects_finite: false,
            failure,
            transforms: 0.0,
            // A software driver skips shut gates more slowly than it waits.
            look_every: match device.description().software() {
                true => 1,
                false => LOOK_EVERY,
            },
        };
        backend.set_scalars(&Scalars::start(0.0, false));
        backend
    }

    /// The same with this many rounds between two waits.
    pub fn looking_every(self, rounds: usize) -> Self {
        GpuBackend {
            look_every: rounds.max(1),
            ..self
        }
    }

    /// The same with fields of this number type, chosen before any is made. A device without it fails
    /// where the host waits.
    pub fn keeping(mut self, number: Number) -> Self {
        if number == Number::Double && !self.device.description().double {
            let name = self.device.description().name.clone();
            self.failure.get_or_insert(GpuError::Precision(name));
        }
        GpuBackend { number, ..self }
    }

    /// Treats non-finite scalars as a failure of the device.
    pub fn expecting_finite(self) -> Self {
        GpuBackend {
            expects_finite: true,
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

    /// Bytes and dispatches sent to the device so far.
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

    /// Does something unless an earlier call failed, and keeps its failure.
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

    /// The table of roots of unity of a line's passes.
    fn roots(
        &mut self,
        first: &LinePlan,
        then: Option<&LinePlan>,
    ) -> Result<wgpu::Buffer, GpuError> {
        let key = [first.whole, first.length];
        if let Some(buffer) = self.roots.get(&key) {
            return Ok(buffer.clone());
        }
        let (values, number) = (plan::roots(first, then), self.number);
        // No transform of two points turns anything, but something is bound.
        let count = values.len().max(2);
        let buffer = self.storage("roots", number.bytes() * count)?;
        self.recorder.write_numbers(&buffer, 0, &values, number)?;
        self.roots.insert(key, buffer.clone());
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

    /// Submits the recorded work, then overwrites the beginning of a buffer.
    fn overwrite(&mut self, buffer: &wgpu::Buffer, bytes: &[u8]) -> Result<(), GpuError> {
        self.settle()?;
        self.recorder.write(buffer, 0, bytes)
    }

    /// The same with numbers, from a byte on.
    fn overwrite_numbers(
        &mut self,
        buffer: &wgpu::Buffer,
        start: usize,
        values: &[f64],
    ) -> Result<(), GpuError> {
        self.settle()?;
        self.recorder
            .write_numbers(buffer, start, values, self.number)
    }
}

/// Rounds recorded before the host waits: a wait costs about as much as these cost to record.
const LOOK_EVERY: usize = 8;

impl Backend for GpuBackend {
    fn look_every(&self) -> usize {
        self.look_every
    }

    /// A coarser grid costs a device more than the iterations that it saves: 4 of 512 x 512 points, 29 of 16384 x 16384.
    fn starts_coarse(&self) -> bool {
        false
    }

    fn suits(&self, shape: Shape) -> bool {
        self.plan(shape).is_ok()
    }

    fn level(&mut self, name: &'static str, shape: Shape) -> Level {
        let space = self.attempt(|backend| {
            let plan = backend.plan(shape)?;
            let partials = 8 + plan.partials() * backend.wide.part_bytes();
            Ok(LevelSpace {
                row_roots: backend.roots(&plan.rows, plan.rows_then.as_ref())?,
                column_roots: backend.roots(&plan.columns, plan.columns_then.as_ref())?,
                partials: backend.storage(name, partials)?,
                // Half as many complex numbers as points.
                work: backend.slabs(name, &plan)?,
                spare: backend.spare(&plan)?,
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

    fn spectrum(&mut self, level: Level, name: &'static str, factors: Factors) -> Spectrum {
        let space = self.attempt(|backend| {
            let plan = backend.level_space(level)?.plan.clone();
            backend.write_factors(name, &plan, &factors)
        });
        self.spectra.push(space);
        Spectrum {
            level,
            index: self.spectra.len() - 1,
        }
    }

    fn set_zero_mode(&mut self, spectrum: Spectrum, value: f64) {
        self.attempt(|backend| {
            let first = backend.spectrum_space(spectrum)?.first.clone();
            backend.overwrite_numbers(&first, 0, &[value])
        });
    }

    fn write(&mut self, field: Field, values: &[f64]) {
        self.attempt(|backend| {
            backend.traffic.fields_up += 1;
            backend.write_slabs(field, values)
        });
    }

    fn read(&mut self, field: Field) -> Result<LongField<f64>, BackendError> {
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

    fn set_outer_gap(&mut self, outer_gap: Option<Field>) {
        self.outer_gap = outer_gap;
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
                true => Box::new(GpuBackend {
                    expects_finite: self.expects_finite,
                    ..GpuBackend::on(&self.device).keeping(Number::Double)
                }),
                false => cpu::double(None),
            }
        })
    }

    fn copy_from(
        &mut self,
        field: Field,
        from: &mut dyn Backend,
        source: Field,
    ) -> Result<(), BackendError> {
        match from.share_buffer(source) {
            Some(shared) if self.takes_over(field, &shared) => {
                self.attempt(|backend| backend.convert(field, &shared));
            }
            _ => match from.values(source)? {
                Some(Values::Double(values)) => self.write(field, values),
                _ => self.write(field, &from.read(source)?),
            },
        }
        Ok(())
    }

    fn share_buffer(&mut self, field: Field) -> Option<SharedBuffer> {
        self.attempt(|backend| backend.hand_out(field))
    }

    fn set_params(&mut self, params: &Params) {
        let law = params.law.shader();
        if law != self.law {
            // Kernels of another law are others under the same name.
            self.prepared.clear();
            self.law = law;
        }
        let bytes = layout::params_bytes(params, self.wide);
        self.attempt(|backend| {
            let buffer = backend.params.clone();
            backend.overwrite(&buffer, &bytes)
        });
    }

    fn set_scalars(&mut self, scalars: &Scalars) {
        let bytes = layout::scalars_bytes(scalars, self.wide);
        self.attempt(|backend| {
            let buffer = backend.scalars.clone();
            backend.overwrite(&buffer, &bytes)
        });
    }

    fn scalars(&mut self) -> Result<Scalars, BackendError> {
        let result = self.look();
        if let Err(error) = &result {
            self.failure.get_or_insert_with(|| error.clone());
        }
        Ok(result?)
    }

    fn run(&mut self, kernel: &'static Kernel, level: Level, fields: &[Field]) {
        self.attempt(|backend| backend.dispatch_kernel(kernel, level, fields));
    }

    fn scalar(&mut self, kernel: &'static ScalarKernel) {
        self.deciding.decide(kernel);
    }

    fn multiply(&mut self, by: Spectrum, energy: bool, gate: Gate) {
        self.attempt(|backend| backend.columns(by, energy, gate));
    }

    fn epsilon(&self) -> f64 {
        self.number.epsilon()
    }

    /// As counted on the device when the host last waited.
    fn transforms(&self) -> f64 {
        self.transforms
    }
}
