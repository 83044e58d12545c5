//! Buffers of slabs: their sizes, creation and writing.

use super::layout::Number;
use super::level::LevelPlan;
use super::slabs::Limits;
use super::source::{FactorSource, OWN_FACTORS};
use super::space::{self, FieldSpace, SpectrumSpace};
use super::{GpuBackend, GpuError};
use crate::backend::{Factors, Field, Shape};

/// Bytes of the buffer that tells a kernel its slab: the least that a uniform takes.
const TURN_BYTES: usize = 16;

impl GpuBackend {
    /// How a level of this shape lies on the device; in as many slabs as its correction in double
    /// precision takes, if that is there too.
    pub(super) fn plan(&self, shape: Shape) -> Result<LevelPlan, GpuError> {
        let limits: Limits = self.device.limits();
        let own = LevelPlan::laid_out(shape, &limits, self.number)?.with_loops(self.device.loops());
        if !self.corrects_here(shape) {
            return Ok(own);
        }
        let slabs = LevelPlan::laid_out(shape, &limits, Number::Double)?.slabs;
        Ok(LevelPlan { slabs, ..own })
    }

    /// A field of zeros, in slabs.
    pub(super) fn slabs(
        &self,
        name: &str,
        plan: &LevelPlan,
    ) -> Result<Vec<wgpu::Buffer>, GpuError> {
        let bytes = self.number.bytes() * plan.slab_points();
        (0..plan.slabs).map(|_| self.storage(name, bytes)).collect()
    }

    /// Indices that tell a kernel its slab or part, where there are several.
    pub(super) fn turns(&mut self, plan: &LevelPlan) -> Result<Vec<wgpu::Buffer>, GpuError> {
        let count = match plan.turns() {
            1 => 0,
            turns => turns as u32,
        };
        (0..count)
            .map(|turn| {
                let buffer = self.device.guarded(|device| {
                    space::buffer(device, "turn", TURN_BYTES, wgpu::BufferUsages::UNIFORM)
                })?;
                self.overwrite(&buffer, &turn.to_ne_bytes())?;
                Ok(buffer)
            })
            .collect()
    }

    /// Sets the first number of every field to NaN, for tests.
    pub(super) fn poison(&mut self) -> Result<(), GpuError> {
        let first = |field: &FieldSpace| field.slabs[0].clone();
        let buffers: Vec<_> = self.fields.iter().flatten().map(first).collect();
        buffers.iter().try_for_each(|buffer| {
            let (recorder, number) = (&mut self.recorder, self.number);
            recorder.write_numbers(buffer, 0, &[f64::NAN], number)
        })
    }

    /// Overwrites a field, slab by slab.
    pub(super) fn write_slabs(&mut self, field: Field, values: &[f64]) -> Result<(), GpuError> {
        let plan = self.level_space(field.level)?.plan.clone();
        let slabs = self.field_space(field)?.slabs.clone();
        for (slab, buffer) in slabs.iter().enumerate() {
            let mut start = 0;
            for range in plan.slab_ranges(slab) {
                let values = values.get(range).unwrap_or_default();
                self.overwrite_numbers(buffer, start, values)?;
                start += self.number.bytes() * values.len();
            }
        }
        Ok(())
    }

    /// A spectrum: its table in parts, or the few constants that its factors are computed from.
    pub(super) fn write_factors(
        &mut self,
        name: &str,
        plan: &LevelPlan,
        factors: &Factors,
    ) -> Result<SpectrumSpace, GpuError> {
        let source = FactorSource::new(factors);
        let mut buffer = |numbers: usize, values: &[f64]| -> Result<wgpu::Buffer, GpuError> {
            let buffer = self.storage(name, self.number.bytes() * numbers)?;
            self.overwrite_numbers(&buffer, 0, values)?;
            Ok(buffer)
        };
        let (first, others) = match *factors {
            Factors::Table(values) => {
                let mut part = |part| {
                    let range = plan.part_range(part);
                    buffer(range.len(), values.get(range).unwrap_or_default())
                };
                (
                    part(0)?,
                    (1..plan.parts).map(part).collect::<Result<_, _>>()?,
                )
            }
            Factors::Each(_) => {
                // One part at a time is a table here.
                let shape = Shape::whole(plan.shape[0], plan.shape[1]);
                let column = plan.shape[1] / 2 + 1;
                let mut part = |part| {
                    let range = plan.part_range(part);
                    let columns = range.start / column..range.end / column;
                    buffer(
                        range.len(),
                        &factors.tabulated_columns(shape, columns, |factor| factor),
                    )
                };
                (
                    part(0)?,
                    (1..plan.parts).map(part).collect::<Result<_, _>>()?,
                )
            }
            Factors::HalfSpace(half_space, _) => {
                let [x, y] = half_space.steps();
                let own: [f64; OWN_FACTORS] = [0.0, x, y];
                (buffer(OWN_FACTORS, &own)?, Vec::new())
            }
        };
        Ok(SpectrumSpace {
            source,
            first,
            others,
        })
    }
}
