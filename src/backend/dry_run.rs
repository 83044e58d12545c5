//! Runs nothing and counts everything: what a scene costs before anything is allocated.

use super::{Backend, BackendError, Factors, Field, Level, Shape, Spectrum, check_fields};
use crate::backend::long_field::LongField;
use crate::kernel::{Gate, Kernel, Params, ScalarKernel, Scalars};

/// One thing that would be held in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Allocation {
    /// Its name.
    pub name: &'static str,
    /// The level it lives on.
    pub level: Level,
    /// Bytes in the place that is counted for.
    pub bytes: usize,
}

/// The place that is counted for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The processor in double precision.
    Double,
    /// The processor in single precision.
    Single,
    /// A graphics processor in single precision.
    Gpu,
    /// A graphics processor in double precision.
    GpuDouble,
}

impl Place {
    /// Whether it is a graphics processor.
    pub fn on_gpu(self) -> bool {
        matches!(self, Place::Gpu | Place::GpuDouble)
    }

    /// Bytes of a number of its fields.
    pub fn number(self) -> usize {
        match self {
            Place::Double | Place::GpuDouble => size_of::<f64>(),
            Place::Single | Place::Gpu => size_of::<f32>(),
        }
    }

    /// Bytes of the work space of a level's transforms.
    fn work(self, shape: Shape) -> usize {
        let [nx, ny] = shape.points;
        match self {
            // Tiles of complex numbers, and a reference to each in the order of the columns.
            Place::Double | Place::Single => {
                let tiles = (nx / 2 + 1).div_ceil(TILE) * ny.div_ceil(TILE);
                tiles * (TILE * TILE * 2 * self.number() + REFERENCE)
            }
            // Half as many complex numbers as points.
            Place::Gpu | Place::GpuDouble => shape.len() * self.number(),
        }
    }
}

/// Counts what a solver asks of a backend.
#[derive(Debug)]
pub struct DryRun {
    place: Place,
    /// Levels and their shapes.
    pub levels: Vec<Shape>,
    /// Fields, in the order in which they were made.
    pub fields: Vec<Allocation>,
    /// Spectra that are tables.
    pub spectra: Vec<Allocation>,
    /// Work space of transforms, one entry a level.
    pub work: Vec<Allocation>,
    /// Names of the passes, in order: kernels, `multiply` for the columns of a convolution.
    pub passes: Vec<&'static str>,
    /// Places of the fields whose memory was let go, and levels of work space.
    released: Vec<usize>,
    released_work: Vec<usize>,
    /// The first mistake in a field list.
    pub mistake: Option<BackendError>,
    scalars: Scalars,
    spectra_made: usize,
    transforms: f64,
}

/// Side of the tiles in which the CPU stores spectra.
const TILE: usize = 8;
/// Bytes of a reference to one.
const REFERENCE: usize = 8;

impl Default for DryRun {
    fn default() -> Self {
        Self::new()
    }
}

impl DryRun {
    /// Nothing counted yet, for the processor in double precision.
    pub fn new() -> Self {
        DryRun::on(Place::Double)
    }

    /// Nothing counted yet, for this place.
    pub fn on(place: Place) -> Self {
        DryRun {
            place,
            levels: Vec::new(),
            fields: Vec::new(),
            spectra: Vec::new(),
            work: Vec::new(),
            passes: Vec::new(),
            released: Vec::new(),
            released_work: Vec::new(),
            mistake: None,
            scalars: Scalars::start(0.0, false),
            spectra_made: 0,
            transforms: 0.0,
        }
    }

    /// Bytes of the fields and of the work space that were released.
    pub fn released_bytes(&self) -> usize {
        let fields = self.released.iter().map(|&index| self.fields[index].bytes);
        let work = self.work.iter();
        let work = work.filter(|held| self.released_work.contains(&held.level.0));
        fields.chain(work.map(|held| held.bytes)).sum()
    }

    fn share_of_first(&self, level: Level) -> f64 {
        self.levels[level.0].len() as f64 / self.levels[0].len() as f64
    }
}

impl Backend for DryRun {
    fn starts_coarse(&self) -> bool {
        !self.place.on_gpu()
    }

    fn level(&mut self, name: &'static str, shape: Shape) -> Level {
        let level = Level(self.levels.len());
        self.levels.push(shape);
        self.work.push(Allocation {
            name,
            level,
            bytes: self.place.work(shape),
        });
        level
    }

    fn sweep_level(&mut self, name: &'static str, shape: Shape) -> Level {
        if self.place.on_gpu() {
            return self.level(name, shape);
        }
        self.levels.push(shape);
        Level(self.levels.len() - 1)
    }

    fn field(&mut self, level: Level, name: &'static str) -> Field {
        let bytes = self.levels[level.0].len() * self.place.number();
        self.fields.push(Allocation { name, level, bytes });
        Field {
            level,
            index: self.fields.len() - 1,
        }
    }

    fn spectrum(&mut self, level: Level, name: &'static str, factors: Factors) -> Spectrum {
        // A graphics processor computes those of a half-space in its registers.
        if !(self.place.on_gpu() && matches!(factors, Factors::HalfSpace(..))) {
            let bytes = self.levels[level.0].spectrum_len() * self.place.number();
            self.spectra.push(Allocation { name, level, bytes });
        }
        self.spectra_made += 1;
        Spectrum {
            level,
            index: self.spectra_made - 1,
        }
    }

    fn set_zero_mode(&mut self, _spectrum: Spectrum, _value: f64) {}

    fn write(&mut self, _field: Field, _values: &[f64]) {}

    fn read(&mut self, field: Field) -> Result<LongField<f64>, BackendError> {
        Ok(LongField::zeros(self.levels[field.level.0].len()))
    }

    fn set_law_factor(&mut self, _factor: Field) {}

    fn set_outer_gap(&mut self, _outer_gap: Option<Field>) {}

    fn clear(&mut self, _field: Field) {}

    fn release(&mut self, field: Field) {
        if !self.place.on_gpu() && !self.released.contains(&field.index) {
            self.released.push(field.index);
        }
    }

    fn release_work(&mut self, level: Level) {
        if !self.place.on_gpu() && !self.released_work.contains(&level.0) {
            self.released_work.push(level.0);
        }
    }

    fn set_params(&mut self, _params: &Params) {}

    fn set_scalars(&mut self, scalars: &Scalars) {
        self.scalars = *scalars;
    }

    fn scalars(&mut self) -> Result<Scalars, BackendError> {
        Ok(self.scalars)
    }

    fn run(&mut self, kernel: &'static Kernel, level: Level, fields: &[Field]) {
        if self.mistake.is_none() {
            self.mistake = check_fields(kernel, fields).err();
        }
        self.passes.push(kernel.name);
        self.transforms += kernel.form.transforms() * self.share_of_first(level);
        // One search of a step length is one pass here, whatever the numbers would say.
        if kernel.gate == Gate::Searching {
            self.scalars.searching = false;
        }
    }

    fn scalar(&mut self, kernel: &'static ScalarKernel) {
        if kernel.name == "step_length" {
            self.scalars.searching = true;
        }
    }

    fn multiply(&mut self, by: Spectrum, _energy: bool, _gate: Gate) {
        self.passes.push("multiply");
        self.transforms += self.share_of_first(by.level);
    }

    fn epsilon(&self) -> f64 {
        f64::EPSILON
    }

    fn transforms(&self) -> f64 {
        self.transforms
    }
}
