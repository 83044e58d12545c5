//! Reads scalars and fields back; the host waits here.

use super::level::ROW_TRANSFORMS_PER_TRANSFORM;
use super::recorder::Part;
use super::{GpuBackend, GpuError, layout};
use crate::backend::Field;
use crate::backend::long_field::LongField;
use crate::kernel::{Scalars, Status};

impl GpuBackend {
    /// Waits, and reads the scalars and what was counted.
    pub(super) fn look(&mut self) -> Result<Scalars, GpuError> {
        self.checked()?;
        self.settle()?;
        self.traffic.looks += 1;
        let length = layout::scalars_length(self.wide);
        let mut parts = vec![Part {
            buffer: &self.scalars,
            start: 0,
            length,
        }];
        let spaces = || self.levels.iter().flatten();
        parts.extend(spaces().map(|space| Part {
            buffer: &space.partials,
            start: 0,
            length: 4,
        }));
        let bytes = self.recorder.read(&parts)?;
        let first = spaces().next().map_or(1, |space| space.plan.points());
        let mut transforms = 0.0;
        for (count, space) in bytes[length..].chunks_exact(4).zip(spaces()) {
            let rows = count.try_into().map_or(0, u32::from_le_bytes);
            let share = space.plan.points() as f64 / first as f64;
            transforms += f64::from(rows) * share / ROW_TRANSFORMS_PER_TRANSFORM;
        }
        self.transforms = transforms;
        let scalars = layout::scalars_of(&bytes[..length], self.wide);
        if self.expects_finite && scalars.status == Status::NotFinite {
            let adapter = self.device.description().name.clone();
            return Err(GpuError::NotFinite(adapter));
        }
        Ok(scalars)
    }

    pub(super) fn fetch(&mut self, field: Field) -> Result<LongField<f64>, GpuError> {
        self.checked()?;
        self.settle()?;
        self.traffic.fields_down += 1;
        let plan = self.level_space(field.level)?.plan.clone();
        let slabs = self.field_space(field)?.slabs.clone();
        // Zeros cost nothing until they are written, which many threads do.
        let mut values = LongField::zeros(plan.points());
        for (slab, buffer) in slabs.iter().enumerate() {
            let mut start = 0;
            for range in plan.slab_ranges(slab) {
                let count = range.len();
                self.recorder
                    .read_numbers(buffer, start, &mut values[range], self.number)?;
                start += self.number.bytes() * count;
            }
        }
        Ok(values)
    }
}
