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
    slabs: Vec<wgpu::Buffer>,
    number: Number,
    slab_points: usize,
}

impl GpuBackend {
    /// Hands a field out, with all that was recorded for it on its way to the device.
    pub(super) fn hand_out(&mut self, field: Field) -> Result<Lent, GpuError> {
        self.settle()?;
        self.recorder.hand_over()?;
        Ok(Lent {
            device: self.device.clone(),
            slabs: self.field_space(field)?.slabs.clone(),
            number: self.number,
            slab_points: self.level_space(field.level)?.plan.slab_points(),
        })
    }

    /// Whether a lent field lies on this device, in the same slabs as a field here.
    pub(super) fn takes(&self, field: Field, lent: &Lent) -> bool {
        let slabs = self.field_space(field).map_or(0, |space| space.slabs.len());
        lent.device.is(&self.device) && lent.slabs.len() == slabs
    }

    /// Overwrites a field with a lent one. It is handed to the device at once: what the lender records
    /// next may change the field again.
    pub(super) fn convert(&mut self, field: Field, lent: &Lent) -> Result<(), GpuError> {
        self.settle()?;
        let slabs = self.field_space(field)?.slabs.clone();
        let points = self.level_space(field.level)?.plan.slab_points();
        let points = points.min(lent.slab_points);
        let (text, workgroups) = source::convert(lent.number, self.number, points);
        let accesses = [Access::Read, Access::Write];
        for (there, here) in lent.slabs.iter().zip(&slabs) {
            let groups: [(&[Access], &[&wgpu::Buffer]); 1] = [(&accesses, &[there, here])];
            let prepared = self.prepare("convert", text.clone(), &groups, [workgroups, 1])?;
            self.traffic.dispatches += 1;
            self.device.count_dispatch();
            self.recorder.dispatch(prepared)?;
        }
        self.recorder.hand_over()
    }
}
