//! Fields taken over from another backend on the same device, in this one's number.

use super::bindings::Access;
use super::device::GpuDevice;
use super::layout::Number;
use super::source;
use super::{GpuBackend, GpuError};
use crate::backend::Field;

/// A field lent to another backend on the same device.
pub struct Lent {
    device: GpuDevice,
    buffer: wgpu::Buffer,
    number: Number,
    points: usize,
}

impl Lent {
    /// Whether it lies on this device.
    pub(super) fn is_on(&self, device: &GpuDevice) -> bool {
        self.device.is(device)
    }
}

impl GpuBackend {
    /// Hands a field out, with all that was recorded for it on its way to the device.
    pub(super) fn hand_out(&mut self, field: Field) -> Result<Lent, GpuError> {
        self.settle()?;
        self.recorder.hand_over()?;
        let space = self.field_space(field)?;
        Ok(Lent {
            device: self.device.clone(),
            buffer: space.buffer.clone(),
            number: self.number,
            points: space.points,
        })
    }

    /// Overwrites a field with a lent one. It is handed to the device at once: what the lender records
    /// next may change the field again.
    pub(super) fn convert(&mut self, field: Field, lent: &Lent) -> Result<(), GpuError> {
        self.settle()?;
        let space = self.field_space(field)?;
        let points = space.points.min(lent.points);
        let (text, workgroups) = source::convert(lent.number, self.number, points);
        let accesses = [Access::Read, Access::Write];
        let buffers = [&lent.buffer, &space.buffer];
        let prepared = self.prepare("convert", text, &[(&accesses, &buffers)], workgroups)?;
        self.traffic.dispatches += 1;
        self.device.count_dispatch();
        self.recorder.dispatch(prepared)?;
        self.recorder.hand_over()
    }
}
