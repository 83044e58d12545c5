//! Device times of each kernel, by the device's own timestamps, and the rate at which it copies.
//!
//! Timing costs nothing unless it is on. When it is, each dispatch is a pass of its own with a timestamp at
//! either end, and the host waits for each submission: the times are those of the kernels alone, and the
//! run as a whole is slower.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError, mpsc};

use super::bindings::Access;
use super::device::GpuDevice;
use super::error::GpuError;
use super::recorder::{DISPATCHES, Prepared};
use super::{GpuBackend, source};

/// Threads in a workgroup of the copy kernel.
const COPY_THREADS: usize = 256;
/// Number of copies, of which the fastest counts; the first also pays for mapping the memory.
const COPIES: usize = 6;
/// Bytes of one timestamp.
const STAMP: u64 = 8;

/// Time of one kernel.
#[derive(Clone, Debug, PartialEq)]
pub struct KernelTime {
    /// Its name in the catalogue, or `multiply` of the columns, `decide` of the decisions.
    pub name: String,
    /// Dispatches. One whose gate was shut counts too, though it moved nothing.
    pub dispatches: u64,
    /// Bytes of the fields, tables and work space that it reads and writes, what is updated twice.
    pub bytes: u64,
    /// Seconds on the device.
    pub seconds: f64,
}

impl KernelTime {
    /// Bytes moved a second.
    pub fn rate(&self) -> f64 {
        self.bytes as f64 / self.seconds
    }
}

/// Times of a backend's kernels, in the order in which they first ran.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Timings {
    /// Each kernel.
    pub kernels: Vec<KernelTime>,
}

impl Timings {
    /// Adds a measurement of a kernel.
    fn add(&mut self, more: KernelTime) {
        match self
            .kernels
            .iter_mut()
            .find(|known| known.name == more.name)
        {
            Some(known) => {
                known.dispatches += more.dispatches;
                known.bytes += more.bytes;
                known.seconds += more.seconds;
            }
            None => self.kernels.push(more),
        }
    }

    /// Dispatches, bytes and seconds of all kernels together.
    pub fn total(&self) -> KernelTime {
        let mut total = KernelTime {
            name: "all".to_string(),
            dispatches: 0,
            bytes: 0,
            seconds: 0.0,
        };
        for kernel in &self.kernels {
            total.dispatches += kernel.dispatches;
            total.bytes += kernel.bytes;
            total.seconds += kernel.seconds;
        }
        total
    }
}

/// Queries of a submission, and the times found so far.
pub(super) struct Timer {
    set: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    staging: wgpu::Buffer,
    /// Seconds per tick.
    period: f64,
    watch: Stopwatch,
}

/// Times of a timed backend's kernels, readable while a solver owns the backend.
#[derive(Clone, Debug, Default)]
pub struct Stopwatch {
    timings: Arc<Mutex<Timings>>,
}

impl Stopwatch {
    fn timings(&self) -> MutexGuard<'_, Timings> {
        self.timings.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Times since the last call, of all work that was recorded before the host last waited.
    pub fn take(&self) -> Timings {
        std::mem::take(&mut *self.timings())
    }
}

impl Timer {
    /// A timer, where the device has timestamps.
    fn new(device: &GpuDevice) -> Result<Option<Self>, GpuError> {
        let period = f64::from(device.queue().get_timestamp_period()) * 1e-9;
        let count = 2 * DISPATCHES as u32;
        let size = u64::from(count) * STAMP;
        device.guarded(|device| {
            if !device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
                return None;
            }
            let buffer = |usage| {
                device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some("timestamps"),
                    size,
                    usage,
                    mapped_at_creation: false,
                })
            };
            Some(Timer {
                set: device.create_query_set(&wgpu::QuerySetDescriptor {
                    label: Some("timestamps"),
                    ty: wgpu::QueryType::Timestamp,
                    count,
                }),
                resolved: buffer(wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC),
                staging: buffer(wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ),
                period,
                watch: Stopwatch::default(),
            })
        })
    }

    /// Records dispatches, each as a pass between two timestamps.
    pub fn passes(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        waiting: &[Prepared],
        compiled: &[&wgpu::ComputePipeline],
    ) {
        let each = waiting.iter().zip(compiled);
        for ((prepared, compiled), first) in each.zip((0u32..).step_by(2)) {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: None,
                timestamp_writes: Some(wgpu::ComputePassTimestampWrites {
                    query_set: &self.set,
                    beginning_of_pass_write_index: Some(first),
                    end_of_pass_write_index: Some(first + 1),
                }),
            });
            prepared.record(compiled, &mut pass);
        }
        let stamps = 2 * waiting.len() as u32;
        if stamps > 0 {
            encoder.resolve_query_set(&self.set, 0..stamps, &self.resolved, 0);
            let bytes = u64::from(stamps) * STAMP;
            encoder.copy_buffer_to_buffer(&self.resolved, 0, &self.staging, 0, bytes);
        }
    }

    /// Waits for the submission of these dispatches and adds their times.
    pub fn add(&mut self, device: &GpuDevice, waiting: &[Prepared]) -> Result<(), GpuError> {
        if waiting.is_empty() {
            return Ok(());
        }
        let bytes = 2 * waiting.len() as u64 * STAMP;
        let (sender, receiver) = mpsc::channel();
        let failed = |error: &dyn std::fmt::Display| GpuError::Device(error.to_string());
        device.guarded(|_| {
            self.staging
                .map_async(wgpu::MapMode::Read, 0..bytes, move |result| {
                    // The receiver is gone only if the wait below has failed.
                    let _ = sender.send(result);
                });
        })?;
        device.wait(wgpu::PollType::wait_indefinitely())?;
        receiver
            .recv()
            .map_err(|error| failed(&error))?
            .map_err(|error| failed(&error))?;
        {
            let mapped = self
                .staging
                .get_mapped_range(0..bytes)
                .map_err(|error| failed(&error))?;
            let (stamps, _) = mapped.as_chunks::<8>();
            let mut timings = self.watch.timings();
            for (prepared, [start, end]) in waiting.iter().zip(stamps.as_chunks().0) {
                let ticks = u64::from_le_bytes(*end).saturating_sub(u64::from_le_bytes(*start));
                timings.add(KernelTime {
                    name: prepared.name.clone(),
                    dispatches: 1,
                    bytes: prepared.bytes,
                    seconds: ticks as f64 * self.period,
                });
            }
        }
        self.staging.unmap();
        Ok(())
    }
}

impl GpuBackend {
    /// The same with its kernels timed on the device, and the stopwatch that reads the times; `None` if the
    /// device has no timestamps. Each dispatch is then a pass of its own, and the host waits for each
    /// submission: the times are the kernels' own, and the whole is slower.
    pub fn timed(mut self) -> (Self, Option<Stopwatch>) {
        let watch = self
            .attempt(|backend| {
                backend.recorder.timer = Timer::new(&backend.device)?;
                Ok(backend
                    .recorder
                    .timer
                    .as_ref()
                    .map(|timer| timer.watch.clone()))
            })
            .flatten();
        (self, watch)
    }
}

impl GpuDevice {
    /// Bytes per second, read and written together, at which a kernel copies a buffer of this many bytes
    /// (rounded up to 16, at most one binding): the fastest of some runs after the first. `None` if the
    /// device has no timestamps.
    pub fn copy_rate(&self, bytes: u64) -> Result<Option<f64>, GpuError> {
        let (mut backend, watch) = GpuBackend::new(self)?.timed();
        backend.checked()?;
        let Some(watch) = watch else {
            return Ok(None);
        };
        let bytes = bytes
            .max(16)
            .next_multiple_of(16)
            .min(self.limits().binding);
        let count = bytes as usize / 16;
        let from = backend.storage("copy", 16 * count)?;
        let to = backend.storage("copy", 16 * count)?;
        let (text, workgroups) = source::copy(count, COPY_THREADS);
        let accesses = [Access::Read, Access::Write];
        let groups: [(&[Access], &[&wgpu::Buffer]); 1] = [(&accesses, &[&from, &to])];
        let prepared = backend.prepare("copy", text, &groups, [workgroups, 1])?;
        let mut fastest = f64::INFINITY;
        for run in 0..COPIES {
            backend.recorder.dispatch(prepared.clone())?;
            backend.recorder.hand_over()?;
            let seconds = watch.take().total().seconds;
            if run > 0 {
                fastest = fastest.min(seconds);
            }
        }
        Ok(Some(2.0 * 16.0 * count as f64 / fastest))
    }
}
