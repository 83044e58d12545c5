//! Records dispatches in order, submits them together, and waits for them.

use std::sync::mpsc;

use super::device::GpuDevice;
use super::error::GpuError;
use super::timing::Timer;

/// Bytes written or read at a time; each transfer needs a copy of them.
const PIECE: usize = 64 << 20;
/// Dispatches after which a submission is due, so that the device does not wait for the host.
pub const DISPATCHES: usize = 256;

/// A compiled kernel with all its bindings.
#[derive(Clone)]
pub struct Prepared {
    /// Its name in timings.
    pub name: String,
    /// Bytes of the fields, tables and work space that it moves.
    pub bytes: u64,
    /// The kernel.
    pub pipeline: wgpu::ComputePipeline,
    /// Its bind groups, from 0.
    pub groups: Vec<wgpu::BindGroup>,
    /// Workgroups along x and y.
    pub workgroups: [u32; 2],
}

impl Prepared {
    /// Records it in a pass.
    pub fn record(&self, pass: &mut wgpu::ComputePass) {
        pass.set_pipeline(&self.pipeline);
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
        let staging = self.staging.as_ref();
        let timer = self.timer.as_ref();
        let queue = self.device.queue();
        self.device.guarded(|device| {
            let mut encoder = device.create_command_encoder(&Default::default());
            if let Some(timer) = timer {
                timer.passes(&mut encoder, &waiting);
            } else if !waiting.is_empty() {
                // One pass for all: one pass for each dispatch costs the host three times as much.
                let mut pass = encoder.begin_compute_pass(&Default::default());
                for prepared in &waiting {
                    prepared.record(&mut pass);
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

    /// Overwrites the beginning of a buffer after all work recorded so far.
    pub fn write(
        &mut self,
        buffer: &wgpu::Buffer,
        bytes: impl Iterator<Item = u8>,
    ) -> Result<(), GpuError> {
        self.submit(&[])?;
        let mut bytes = bytes.peekable();
        let mut start = 0;
        while bytes.peek().is_some() {
            let piece: Vec<u8> = bytes.by_ref().take(PIECE).collect();
            let queue = self.device.queue();
            self.device
                .guarded(|_| queue.write_buffer(buffer, start, &piece))?;
            start += piece.len() as u64;
        }
        Ok(())
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

    /// Waits for all work and reads some parts, one after another.
    pub fn read(&mut self, parts: &[Part]) -> Result<Vec<u8>, GpuError> {
        let length: usize = parts.iter().map(|part| part.length).sum();
        if length > PIECE && parts.len() == 1 {
            let part = &parts[0];
            let mut bytes = Vec::with_capacity(length);
            for start in (0..length).step_by(PIECE) {
                bytes.extend(self.read(&[Part {
                    buffer: part.buffer,
                    start: part.start + start,
                    length: PIECE.min(length - start),
                }])?);
            }
            return Ok(bytes);
        }
        let size = length.next_multiple_of(8) as u64;
        if self
            .staging
            .as_ref()
            .is_none_or(|staging| staging.size() < size)
        {
            self.staging = Some(self.device.guarded(|device| {
                device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some("staging"),
                    size,
                    usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
                    mapped_at_creation: false,
                })
            })?);
        }
        self.submit(parts)?;
        let Some(staging) = &self.staging else {
            return Ok(Vec::new());
        };
        let (sender, receiver) = mpsc::channel();
        self.device.guarded(|device| {
            staging.map_async(wgpu::MapMode::Read, 0..size, move |result| {
                // The receiver is gone only if the wait below has failed.
                let _ = sender.send(result);
            });
            device
                .poll(wgpu::PollType::wait_indefinitely())
                .map_err(|error| GpuError::Device(error.to_string()))
        })??;
        receiver
            .recv()
            .map_err(|_| GpuError::Device("a read was given up".to_string()))?
            .map_err(|error| GpuError::Device(error.to_string()))?;
        let bytes = staging
            .get_mapped_range(0..size)
            .map_err(|error| GpuError::Device(error.to_string()))?[..length]
            .to_vec();
        staging.unmap();
        Ok(bytes)
    }
}
