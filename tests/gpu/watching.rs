//! A backend that notes which kernels ran in it, and in the one of double precision beside it.

use std::sync::{Arc, Mutex};

use tabor::backend::gpu::SharedBuffer;
use tabor::backend::{Backend, BackendError, Factors, Field, Level, Shape, Spectrum, Values};
use tabor::kernel::{Gate, Kernel, Params, ScalarKernel, Scalars};

/// Variants of kernels in the order in which they were asked for; `multiply` where factors are computed,
/// `multiply_by_table` where they are read.
pub type Seen = Arc<Mutex<Vec<String>>>;

/// Passes everything on, and notes the kernels.
pub struct Watching<B> {
    /// Who does the work.
    pub inner: B,
    /// What ran here.
    pub here: Seen,
    /// What ran beside it in double precision.
    pub double: Seen,
    /// Which spectra are tables.
    tables: Vec<bool>,
}

/// The backend beside, which has none beside itself.
struct Beside {
    inner: Box<dyn Backend + Send>,
    here: Seen,
    tables: Vec<bool>,
}

impl<B> Watching<B> {
    /// A watch that has seen nothing.
    pub fn over(inner: B) -> Self {
        Watching {
            inner,
            here: Seen::default(),
            double: Seen::default(),
            tables: Vec::new(),
        }
    }

    fn note(&self, name: String) {
        self.here.lock().expect("nobody panics here").push(name);
    }
}

impl<B: Backend> Watching<B> {
    fn beside(&self, shape: Shape) -> Option<Box<dyn Backend + Send>> {
        let inner = self.inner.in_double(shape)?;
        let here = Arc::clone(&self.double);
        Some(Box::new(Beside {
            inner,
            here,
            tables: Vec::new(),
        }))
    }
}

impl Beside {
    fn beside(&self, _shape: Shape) -> Option<Box<dyn Backend + Send>> {
        None
    }

    fn note(&self, name: String) {
        self.here.lock().expect("nobody panics here").push(name);
    }
}

/// Everything passed on.
macro_rules! passed_on {
    () => {
        fn suits(&self, shape: Shape) -> bool {
            self.inner.suits(shape)
        }
        fn look_every(&self) -> usize {
            self.inner.look_every()
        }
        fn level(&mut self, name: &'static str, shape: Shape) -> Level {
            self.inner.level(name, shape)
        }
        fn field(&mut self, level: Level, name: &'static str) -> Field {
            self.inner.field(level, name)
        }
        fn spectrum(&mut self, level: Level, name: &'static str, factors: Factors) -> Spectrum {
            let computed = matches!(factors, Factors::HalfSpace(..));
            self.tables.push(!computed);
            self.inner.spectrum(level, name, factors)
        }
        fn set_zero_mode(&mut self, spectrum: Spectrum, value: f64) {
            self.inner.set_zero_mode(spectrum, value);
        }
        fn write(&mut self, field: Field, values: &[f64]) {
            self.inner.write(field, values);
        }
        fn read(
            &mut self,
            field: Field,
        ) -> Result<tabor::backend::long_field::LongField<f64>, BackendError> {
            self.inner.read(field)
        }
        fn set_law_factor(&mut self, factor: Field) {
            self.inner.set_law_factor(factor);
        }
        fn set_outer_gap(&mut self, outer_gap: Option<Field>) {
            self.inner.set_outer_gap(outer_gap);
        }
        fn clear(&mut self, field: Field) {
            self.inner.clear(field);
        }
        fn in_double(&self, shape: Shape) -> Option<Box<dyn Backend + Send>> {
            self.beside(shape)
        }
        fn values(&mut self, field: Field) -> Result<Option<Values<'_>>, BackendError> {
            self.inner.values(field)
        }
        fn copy_from(
            &mut self,
            field: Field,
            from: &mut dyn Backend,
            source: Field,
        ) -> Result<(), BackendError> {
            self.inner.copy_from(field, from, source)
        }
        fn share_buffer(&mut self, field: Field) -> Option<SharedBuffer> {
            self.inner.share_buffer(field)
        }
        fn set_params(&mut self, params: &Params) {
            self.inner.set_params(params);
        }
        fn set_scalars(&mut self, scalars: &Scalars) {
            self.inner.set_scalars(scalars);
        }
        fn scalars(&mut self) -> Result<Scalars, BackendError> {
            self.inner.scalars()
        }
        fn run(&mut self, kernel: &'static Kernel, level: Level, fields: &[Field]) {
            self.note(kernel.variant());
            self.inner.run(kernel, level, fields);
        }
        fn scalar(&mut self, kernel: &'static ScalarKernel) {
            self.inner.scalar(kernel);
        }
        fn multiply(&mut self, by: Spectrum, energy: bool, gate: Gate) {
            let tabulated = self.tables[by.index];
            let name = if tabulated {
                "multiply_by_table"
            } else {
                "multiply"
            };
            self.note(name.to_owned());
            self.inner.multiply(by, energy, gate);
        }
        fn epsilon(&self) -> f64 {
            self.inner.epsilon()
        }
        fn transforms(&self) -> f64 {
            self.inner.transforms()
        }
    };
}

impl<B: Backend> Backend for Watching<B> {
    passed_on!();
}

impl Backend for Beside {
    passed_on!();
}
