//! Records dispatches in order, submits them together, and waits for them.

use std::sync::mpsc;

use super::device::GpuDevice;
use super::error::GpuError;
use super::layout::Number;
use super::pipelines::Pipeline;
use super::timing::Timer;

/// Bytes from which numbers pass as a field does; the queue takes fewer as they are.
const FIELD: usize = 1 << 18;
/// Dispatches after which a submission is due, so that the device works while the host records more: two iterations at a wall.
/// On an NVIDIA H200 fewer or more are slower.
pub const DISPATCHES: usize = 32;

/// A compiled kernel with all its bindings.
#[derive(Clone)]
pub struct Prepared {
    /// Its name in timings.
    pub name: String,
    /// Bytes of the fields, tables and work space that it moves.
    pub bytes: u64,
    /// The kernel.
    pub pipeline: Pipeline,
    /// Its bind groups, from 0.
    pub groups: Vec<wgpu::BindGroup>,
    /// Workgroups along x and y.
    pub workgroups: [u32; 2],
}

impl Prepared {
    /// Records it, with its compiled kernel, in a pass.
    pub fn record(&self, compiled: &wgpu::ComputePipeline, pass: &mut wgpu::ComputePass) {
        pass.set_pipeline(compiled);
        for (group, place) in self.groups.iter().zip(0..) {
            pass.set_bind_group(place, group, &[]);
        }
        let [x, y] = self.workgroups;
        pass.dispatch_workgroups(x, y, 1);
    }
}

/// A part of a buffer to be read.
pub struct Part<'a> {
    /// The buffer.
    pub buffer: &'a wgpu::Buffer,
    /// First byte.
    pub start: usize,
    /// Bytes.
    pub length: usize,
}

/// Work that waits to be submitted.
pub struct Recorder {
    device: GpuDevice,
    waiting: Vec<Prepared>,
    staging: Option<wgpu::Buffer>,
    /// Times each dispatch, if asked.
    pub timer: Option<Timer>,
}

impl Recorder {
    /// A recorder with nothing in it.
    pub fn new(device: GpuDevice) -> Self {
        Recorder {
            device,
            waiting: Vec::new(),
            staging: None,
            timer: None,
        }
    }

    /// Adds a dispatch.
    pub fn dispatch(&mut self, prepared: Prepared) -> Result<(), GpuError> {
        self.waiting.push(prepared);
        if self.waiting.len() >= DISPATCHES {
            self.submit(&[])?;
        }
        Ok(())
    }

    /// Submits the waiting work, then copies the parts one after another to `staging`.
    fn submit(&mut self, parts: &[Part]) -> Result<(), GpuError> {
        if self.waiting.is_empty() && parts.is_empty() {
            return Ok(());
        }
        let waiting = std::mem::take(&mut self.waiting);
        let compiled = waiting
            .iter()
            .map(|prepared| prepared.pipeline.ready())
            .collect::<Result<Vec<_>, _>>()?;
        let staging = self.staging.as_ref();
        let timer = self.timer.as_ref();
        let queue = self.device.queue();
        self.device.guarded(|device| {
            let mut encoder = device.create_command_encoder(&Default::default());
            if let Some(timer) = timer {
                timer.passes(&mut encoder, &waiting, &compiled);
            } else if !waiting.is_empty() {
                // One pass for all: one pass for each dispatch costs the host three times as much.
                let mut pass = encoder.begin_compute_pass(&Default::default());
                for (prepared, compiled) in waiting.iter().zip(&compiled) {
                    prepared.record(compiled, &mut pass);
                }
            }
            if let Some(staging) = staging {
                let mut end = 0;
                for part in parts {
                    let length = part.length as u64;
                    encoder.copy_buffer_to_buffer(
                        part.buffer,
                        part.start as u64,
                        staging,
                        end,
                        length,
                    );
                    end += length;
                }
            }
            queue.submit([encoder.finish()]);
        })?;
        match &mut self.timer {
            Some(timer) => timer.add(&self.device, &waiting),
            None => Ok(()),
        }
    }

    /// Submits the waiting work.
    pub fn hand_over(&mut self) -> Result<(), GpuError> {
        self.submit(&[])
    }

    /// Overwrites a part of a buffer from a byte on, after all work recorded so far.
    pub fn write(
        &mut self,
        buffer: &wgpu::Buffer,
        start: usize,
        bytes: &[u8],
    ) -> Result<(), GpuError> {
        self.submit(&[])?;
        let queue = self.device.queue();
        self.device
            .guarded(|_| queue.write_buffer(buffer, start as u64, bytes))
    }

    /// The same with numbers.
    pub fn write_numbers(
        &mut self,
        buffer: &wgpu::Buffer,
        start: usize,
        values: &[f64],
        number: Number,
    ) -> Result<(), GpuError> {
        if number.bytes() * values.len() < FIELD {
            return number.with_bytes(values, |bytes| self.write(buffer, start, bytes));
        }
        self.submit(&[])?;
        let device = &self.device;
        device.transfer(|transfers| transfers.write(device, (buffer, start), values, number))
    }

    /// Sets a buffer to zero after all work recorded so far.
    pub fn clear(&mut self, buffer: &wgpu::Buffer) -> Result<(), GpuError> {
        self.submit(&[])?;
        let queue = self.device.queue();
        self.device.guarded(|device| {
            let mut encoder = device.create_command_encoder(&Default::default());
            encoder.clear_buffer(buffer, 0, None);
            queue.submit([encoder.finish()]);
        })
    }

    /// Waits for all work and reads the numbers that a buffer begins with.
    pub fn read_numbers(
        &mut self,
        buffer: &wgpu::Buffer,
        start: usize,
        values: &mut [f64],
        number: Number,
    ) -> Result<(), GpuError> {
        self.submit(&[])?;
        let device = &self.device;
        device.transfer(|transfers| transfers.read(device, (buffer, start), values, number))
    }

    /// Waits for all work and reads some parts, one after another.
    pub fn read(&mut self, parts: &[Part]) -> Result<Vec<u8>, GpuError> {
        let length: usize = parts.iter().map(|part| part.length).sum();
        let size = length.next_multiple_of(8) as u64;
        let staging = match self.staging.take() {
            Some(staging) if staging.size() >= size => staging,
            _ => self.device.guarded(|device| {
                device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some("staging"),
                    size,
                    usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
                    mapped_at_creation: false,
                })
            })?,
        };
        let staging = self.staging.insert(staging).clone();
        self.submit(parts)?;
        let (sender, receiver) = mpsc::channel();
        self.device.guarded(|_| {
            staging.map_async(wgpu::MapMode::Read, 0..size, move |result| {
                // The receiver is gone only if the wait below has failed.
                let _ = sender.send(result);
            });
        })?;
        self.device.wait(wgpu::PollType::wait_indefinitely())?;
        receiver
            .recv()
            .map_err(|_| GpuError::Device("a read was given up".to_string()))?
            .map_err(|error| GpuError::Device(error.to_string()))?;
        let bytes = staging.get_mapped_range(0..size)?[..length].to_vec();
        staging.unmap();
        Ok(bytes)
    }
}
