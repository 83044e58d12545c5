//! Fields copied from another backend on the same device, converted to this one's number type.

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
    /// Whether it is on this device, in slabs of this many points.
    pub(super) fn suits(&self, device: &GpuDevice, points: usize) -> bool {
        self.device.is(device) && self.points == points
    }
}

impl GpuBackend {
    /// Whether the outer state in double precision that this backend corrects is on the same device.
    pub(super) fn corrects_here(&self, shape: Shape) -> bool {
        let adapter = self.device.description();
        self.corrected && adapter.double && adapter.takes(shape.points, Number::Double)
    }

    /// Whether a shared field has the layout of this backend's fields.
    pub(super) fn takes_over(&self, field: Field, shared: &SharedBuffer) -> bool {
        self.level_space(field.level)
            .is_ok_and(|level| shared.suits(&self.device, level.plan.slab_points()))
    }

    /// Shares a field after submitting all work recorded for it.
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

    /// Overwrites a field with a shared one. Submitted at once, since the owner's next work may change the
    /// shared field.
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
