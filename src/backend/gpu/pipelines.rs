//! Compiled shaders. A driver takes a fraction of a second to compile one, and a solve asks for some tens: each is compiled by a
//! thread of its own while the host records the others, and waited for before it is handed to the device.

use std::collections::HashMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::thread::{self, JoinHandle};

use super::device::GpuDevice;
use super::error::GpuError;

/// A shader that is being compiled, or has been.
#[derive(Clone, Default)]
pub struct Pipeline {
    compiled: Arc<OnceLock<Result<wgpu::ComputePipeline, GpuError>>>,
    /// The thread that compiles it, until it has been waited for.
    thread: Arc<Mutex<Option<JoinHandle<()>>>>,
}

impl Pipeline {
    /// Waits for it, and for the end of the thread that compiled it: a driver must not be closed while one of its threads
    /// ends.
    pub fn ready(&self) -> Result<&wgpu::ComputePipeline, GpuError> {
        let compiled = self.compiled.wait().as_ref().map_err(Clone::clone);
        let thread = self.thread();
        // A thread that panics has said so in its result.
        let _ = thread.map(JoinHandle::join);
        compiled
    }

    fn thread(&self) -> Option<JoinHandle<()>> {
        let mut thread = self.thread.lock().unwrap_or_else(PoisonError::into_inner);
        thread.take()
    }

    /// Compiles it, whatever comes of that: others wait.
    fn compile(&self, compile: impl FnOnce() -> Result<wgpu::ComputePipeline, GpuError>) {
        let compiled = catch_unwind(AssertUnwindSafe(compile));
        let failed = |_| Err(GpuError::Device("a shader was not compiled".to_string()));
        let compiled = compiled.unwrap_or_else(failed);
        self.compiled.get_or_init(|| compiled);
    }
}

/// The shaders of a device, by their source.
#[derive(Default)]
pub struct Pipelines {
    known: Mutex<HashMap<String, Pipeline>>,
}

impl Pipelines {
    /// The compiled shader of a source. If it is not ready, another thread compiles it.
    pub fn of(
        &self,
        source: String,
        compile: impl FnOnce(&str) -> Result<wgpu::ComputePipeline, GpuError> + Send + 'static,
    ) -> Pipeline {
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(pipeline) = known.get(&source) {
            return pipeline.clone();
        }
        let pipeline = Pipeline::default();
        known.insert(source.clone(), pipeline.clone());
        let there = pipeline.clone();
        let compiling = thread::Builder::new()
            .name("shader".to_string())
            .spawn(move || there.compile(|| compile(&source)));
        match compiling {
            Ok(thread) => {
                let mut place = pipeline
                    .thread
                    .lock()
                    .unwrap_or_else(PoisonError::into_inner);
                *place = Some(thread);
            }
            Err(error) => {
                let refused = Err(GpuError::Device(format!(
                    "no thread compiles a shader: {error}"
                )));
                pipeline.compiled.get_or_init(|| refused);
            }
        }
        pipeline
    }
}

impl GpuDevice {
    /// Compiles a shader, or reuses its pipeline.
    pub(super) fn pipeline(
        &self,
        name: &str,
        source: String,
        layouts: Vec<wgpu::BindGroupLayout>,
    ) -> Pipeline {
        let (device, name) = (self.clone(), name.to_owned());
        let compile = move |source: &str| device.compiled(&name, source, &layouts);
        self.pipelines().of(source, compile)
    }
}
