//! Fields taken over from another backend on the same device, in this one's number.

use super::bindings::Access;
use super::device::GpuDevice;
use super::layout::Number;
use super::source;
use super::{GpuBackend, GpuError};
use crate::backend::{Field, Shape};

/// A field shared to another backend on the same device.
pub struct SharedBuffer {
    device: GpuDevice,
    slabs: Vec<wgpu::Buffer>,
    number: Number,
    /// Points in a slab.
    points: usize,
}

impl SharedBuffer {
    /// Whether it lies on this device, in slabs of so many points.
    pub(super) fn suits(&self, device: &GpuDevice, points: usize) -> bool {
        self.device.is(device) && self.points == points
    }
}

impl GpuBackend {
    /// Whether what corrects this backend's state in double precision keeps it on the same device.
    pub(super) fn corrects_here(&self, shape: Shape) -> bool {
        let adapter = self.device.description();
        self.corrected && adapter.double && adapter.takes(shape.points, Number::Double)
    }

    /// Whether a shared field lies as one of this backend's does.
    pub(super) fn takes_over(&self, field: Field, shared: &SharedBuffer) -> bool {
        self.level_space(field.level)
            .is_ok_and(|level| shared.suits(&self.device, level.plan.slab_points()))
    }

    /// Hands a field out, with all that was recorded for it on its way to the device.
    pub(super) fn hand_out(&mut self, field: Field) -> Result<SharedBuffer, GpuError> {
        self.settle()?;
        self.recorder.hand_over()?;
        Ok(SharedBuffer {
            device: self.device.clone(),
            slabs: self.field_space(field)?.slabs.clone(),
            number: self.number,
            points: self.level_space(field.level)?.plan.slab_points(),
        })
    }

    /// Overwrites a field with a shared one. It is handed to the device at once: what the lender records
    /// next may change the field again.
    pub(super) fn convert(&mut self, field: Field, shared: &SharedBuffer) -> Result<(), GpuError> {
        self.settle()?;
        let (text, workgroups) = source::convert(shared.number, self.number, shared.points);
        let accesses = [Access::Read, Access::Write];
        let slabs = self.field_space(field)?.slabs.clone();
        for (from, to) in shared.slabs.iter().zip(&slabs) {
            let groups: [(&[Access], &[&wgpu::Buffer]); 1] = [(&accesses, &[from, to])];
            let prepared = self.prepare("convert", text.clone(), &groups, [workgroups, 1])?;
            self.traffic.dispatches += 1;
            self.device.count_dispatch();
            self.recorder.dispatch(prepared)?;
        }
        self.recorder.hand_over()
    }
}
