//! Fields on their way between the host and the device.
//!
//! Kernels are fast on memory that the host cannot see. So a field passes through buffers that the host maps, a piece at a time.
//! There are two for each way: the device copies one while the host fills or empties the other. They are kept for the
//! next field, since the system takes longer to provide such memory than the device to copy it.

use std::collections::VecDeque;

use super::device::GpuDevice;
use super::error::GpuError;
use super::layout::Number;

/// Bytes of the longest piece, a multiple of any number's.
const PIECE: usize = 32 << 20;
/// Buffers of a way.
const BUFFERS: usize = 2;

/// The buffers of both ways.
pub struct Transfers {
    /// Bytes of the longest piece.
    piece: usize,
    up: Way,
    down: Way,
}

/// The buffers of one way.
struct Way {
    usage: wgpu::BufferUsages,
    /// Those that lie ready, the one that was used first in front.
    ready: VecDeque<Passing>,
}

/// A buffer that the host can map.
struct Passing {
    buffer: wgpu::Buffer,
    /// The copy after which it is mapped.
    copy: Option<wgpu::SubmissionIndex>,
}

impl Default for Transfers {
    fn default() -> Self {
        Transfers::in_pieces(PIECE)
    }
}

impl Transfers {
    fn in_pieces(piece: usize) -> Self {
        let way = |usage| Way {
            usage,
            ready: VecDeque::new(),
        };
        let (write, read) = (wgpu::BufferUsages::MAP_WRITE, wgpu::BufferUsages::MAP_READ);
        Transfers {
            piece,
            up: way(write | wgpu::BufferUsages::COPY_SRC),
            down: way(read | wgpu::BufferUsages::COPY_DST),
        }
    }

    /// Overwrites numbers of a buffer, from a byte on, after all that was submitted before.
    pub fn write(
        &mut self,
        device: &GpuDevice,
        (buffer, start): (&wgpu::Buffer, usize),
        values: &[f64],
        number: Number,
    ) -> Result<(), GpuError> {
        let starts = (start..).step_by(self.piece);
        for (values, at) in values.chunks(self.piece / number.bytes()).zip(starts) {
            let length = (number.bytes() * values.len()) as u64;
            let mut passing = match self.up.ready.len() {
                BUFFERS => self.up.next(device, length)?,
                _ => self.up.made(device, length)?,
            };
            passing.await_copy(device)?;
            device.guarded(|_| -> Result<(), GpuError> {
                let mut mapped = passing.buffer.get_mapped_range_mut(0..length)?;
                number.write_bytes(values, mapped.slice(..));
                drop(mapped);
                passing.buffer.unmap();
                Ok(())
            })??;
            let copied = [(&passing.buffer.clone(), 0), (buffer, at)];
            passing.copy(device, copied, length, wgpu::MapMode::Write)?;
            self.up.ready.push_back(passing);
        }
        Ok(())
    }

    /// Reads numbers of a buffer, from a byte on, after all that was submitted before.
    pub fn read(
        &mut self,
        device: &GpuDevice,
        (buffer, start): (&wgpu::Buffer, usize),
        values: &mut [f64],
        number: Number,
    ) -> Result<(), GpuError> {
        let starts = (start..).step_by(self.piece);
        let mut before = None;
        for (values, at) in values.chunks_mut(self.piece / number.bytes()).zip(starts) {
            let length = (number.bytes() * values.len()) as u64;
            let mut passing = self.down.next(device, length)?;
            let copied = [(buffer, at), (&passing.buffer.clone(), 0)];
            passing.copy(device, copied, length, wgpu::MapMode::Read)?;
            if let Some((passing, values)) = before.replace((passing, values)) {
                self.down.empty(device, passing, values, number)?;
            }
        }
        match before {
            Some((passing, values)) => self.down.empty(device, passing, values, number),
            None => Ok(()),
        }
    }
}

impl Way {
    /// The buffer that was used first of those that lie ready, if it is long enough, or else a new one.
    fn next(&mut self, device: &GpuDevice, length: u64) -> Result<Passing, GpuError> {
        match self.ready.pop_front() {
            Some(passing) if passing.buffer.size() >= length => Ok(passing),
            _ => self.made(device, length),
        }
    }

    /// A new buffer; one that the host writes to is mapped.
    fn made(&self, device: &GpuDevice, length: u64) -> Result<Passing, GpuError> {
        let buffer = device.guarded(|device| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("transfer"),
                size: length.next_multiple_of(wgpu::MAP_ALIGNMENT),
                usage: self.usage,
                mapped_at_creation: self.usage.contains(wgpu::BufferUsages::MAP_WRITE),
            })
        })?;
        Ok(Passing { buffer, copy: None })
    }

    /// Reads the numbers that a buffer was sent, and keeps it for the next.
    fn empty(
        &mut self,
        device: &GpuDevice,
        mut passing: Passing,
        values: &mut [f64],
        number: Number,
    ) -> Result<(), GpuError> {
        passing.await_copy(device)?;
        device.guarded(|_| -> Result<(), GpuError> {
            let length = (number.bytes() * values.len()) as u64;
            number.read_bytes(&passing.buffer.get_mapped_range(0..length)?, values);
            passing.buffer.unmap();
            Ok(())
        })??;
        self.ready.push_back(passing);
        Ok(())
    }
}

impl Passing {
    /// Copies from one place to another, and maps this buffer, which is one of the two, when that is done.
    fn copy(
        &mut self,
        device: &GpuDevice,
        [(from, from_byte), (to, to_byte)]: [(&wgpu::Buffer, usize); 2],
        length: u64,
        mode: wgpu::MapMode,
    ) -> Result<(), GpuError> {
        let queue = device.queue();
        let copy = device.guarded(|device| {
            let mut encoder = device.create_command_encoder(&Default::default());
            let [from_byte, to_byte] = [from_byte as u64, to_byte as u64];
            encoder.copy_buffer_to_buffer(from, from_byte, to, to_byte, length);
            let copy = queue.submit([encoder.finish()]);
            // Whether it is mapped shows where the host takes it.
            self.buffer.map_async(mode, .., |_| {});
            copy
        })?;
        self.copy = Some(copy);
        Ok(())
    }

    /// Waits until the last copy is done and the buffer is mapped.
    fn await_copy(&mut self, device: &GpuDevice) -> Result<(), GpuError> {
        let Some(copy) = self.copy.take() else {
            return Ok(());
        };
        device.wait(wgpu::PollType::Wait {
            submission_index: Some(copy),
            timeout: None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::backend::gpu::device::tests::software_device;
    use crate::backend::gpu::space;

    /// What goes up in pieces, the last of them shorter, comes down the same, again and again through the same buffers.
    #[test]
    fn a_field_passes_in_pieces() {
        let Some(device) = software_device() else {
            return;
        };
        let mut transfers = Transfers::in_pieces(1 << 10);
        for (count, start) in [(5, 4), (1000, 0), (4096, 8), (3, 0)] {
            let bytes = start + Number::Single.bytes() * count;
            let usage = wgpu::BufferUsages::STORAGE;
            let made = device.guarded(|device| space::buffer(device, "field", bytes, usage));
            let buffer = made.expect("a buffer");
            for round in 0..3 {
                // Whole numbers, which single precision holds.
                let values: Vec<f64> = (0..count).map(|i| (7 * i + round) as f64).collect();
                let place = (&buffer, start);
                let up = transfers.write(&device, place, &values, Number::Single);
                up.expect("a field goes up");
                let mut found = vec![0.0; count];
                let down = transfers.read(&device, place, &mut found, Number::Single);
                down.expect("a field comes down");
                assert_eq!(found, values, "{count} numbers");
            }
        }
        let held = [&transfers.up, &transfers.down].map(|way| way.ready.len());
        assert!(held.iter().all(|&held| held <= BUFFERS), "{held:?}");
    }
}
