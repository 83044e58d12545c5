//! Binds kernels to their buffers and records them, one dispatch for each slab.

use super::bindings::{self, Access, ROWS, WORKING, WORKING_IN_TURNS};
use super::butterfly::Direction;
use super::deciding::Decided;
use super::level::Place;
use super::recorder::Prepared;
use super::source::{self, Reduction, Results};
use super::space::{self, Key, LevelSpace};
use super::{GpuBackend, GpuError};
use crate::backend::{Field, Level, Spectrum};
use crate::kernel::{Form, Gate, Kernel};

impl GpuBackend {
    /// Compiles a shader and binds its buffers, group by group.
    pub(super) fn prepare(
        &self,
        name: &str,
        source: String,
        groups: &[(&[Access], &[&wgpu::Buffer])],
        workgroups: [usize; 2],
    ) -> Result<Prepared, GpuError> {
        // All but what decisions are taken from; what is written is taken to be updated.
        let bytes = groups
            .iter()
            .filter(|(accesses, _)| !accesses.contains(&Access::Uniform))
            .flat_map(|(accesses, buffers)| accesses.iter().zip(*buffers))
            .map(|(access, buffer)| match access {
                Access::Write => 2 * buffer.size(),
                Access::Read | Access::Uniform => buffer.size(),
            })
            .sum();
        let (layouts, groups) = self.device.guarded(|device| {
            groups
                .iter()
                .map(|(accesses, buffers)| {
                    let layout = bindings::layout(device, accesses);
                    let group = bindings::group(device, &layout, buffers);
                    (layout, group)
                })
                .collect::<(Vec<_>, Vec<_>)>()
        })?;
        let pipeline = self.device.pipeline(name, source, layouts);
        Ok(Prepared {
            name: name.to_owned(),
            bytes,
            pipeline,
            groups,
            // Plans keep it far below the 65535 that every adapter takes.
            workgroups: workgroups.map(|count| count as u32),
        })
    }

    /// Records a kernel's dispatches, one for each slab, prepared once and reused.
    pub(super) fn dispatch(
        &mut self,
        key: Key,
        prepare: impl FnOnce(&Self) -> Result<Vec<Prepared>, GpuError>,
    ) -> Result<(), GpuError> {
        let prepared = match self.prepared.get(&key) {
            Some(prepared) => prepared.clone(),
            None => {
                let prepared = prepare(self)?;
                self.prepared.insert(key, prepared.clone());
                prepared
            }
        };
        for each in prepared {
            self.traffic.dispatches += 1;
            self.device.count_dispatch();
            self.recorder.dispatch(each)?;
        }
        match self.device.poisons() {
            true => self.poison(),
            false => Ok(()),
        }
    }

    /// Records a kernel of the catalogue and the reduction of its sums.
    pub(super) fn dispatch_kernel(
        &mut self,
        kernel: &'static Kernel,
        level: Level,
        fields: &[Field],
    ) -> Result<(), GpuError> {
        if fields.len() != kernel.fields() {
            return Err(GpuError::Fields {
                kernel: kernel.name,
                expected: kernel.fields(),
                given: fields.len(),
            });
        }
        let indices = fields.iter().map(|field| field.index).collect();
        let variant = std::ptr::from_ref(kernel).addr();
        let key = Key::Kernel(variant, level.0, self.outer_gap.is_some(), indices);
        let place = Place::for_form(kernel.form);
        if kernel.gate != Gate::Ahead {
            self.settle()?;
        } else if !kernel.sums.is_empty() {
            self.make_room(level, place)?;
        }
        if kernel.form.after_inverse() {
            self.rows_then(level, Direction::Inverse, kernel.gate)?;
        }
        self.dispatch(key, |backend| backend.kernel(kernel, level, fields))?;
        if kernel.form.before_forward() {
            self.rows_then(level, Direction::Forward, kernel.gate)?;
        }
        if kernel.sums.is_empty() {
            return Ok(());
        }
        let plan = &self.level_space(level)?.plan;
        let reduction = Reduction {
            results: Results::Sums(kernel.sums),
            groups: plan.groups(kernel.form),
            first: plan.first_partial(place),
            gate: kernel.gate,
        };
        self.put_off(Decided {
            of: space::Decided::Kernel(variant),
            level,
            place,
            reduction,
        });
        Ok(())
    }

    /// The dispatches of a kernel, one for each slab.
    pub(super) fn kernel(
        &self,
        kernel: &'static Kernel,
        level: Level,
        fields: &[Field],
    ) -> Result<Vec<Prepared>, GpuError> {
        let space = self.level_space(level)?;
        let mut bound = Vec::new();
        for &field in fields {
            bound.push(&self.field_space(field)?.slabs);
        }
        let own = kernel.written().end;
        let whole = match (kernel.whole, fields.last()) {
            (true, Some(field)) => source::Whole::new(&self.level_space(field.level)?.plan),
            _ => source::Whole::default(),
        };
        let around = kernel.around.map_or(0, |_| space.plan.slabs);
        let slabs = around + whole.slabs;
        let mut accesses = bindings::fields(kernel.reads.len(), kernel.writes.len(), slabs);
        let mut behind = Vec::new();
        let mut follow = |fields: &[Field]| -> Result<usize, GpuError> {
            let first = accesses.len();
            for &field in fields {
                behind.push(&self.field_space(field)?.slabs);
                accesses.push(Access::Read);
            }
            Ok(first)
        };
        // Bound after the kernel's own fields.
        let factor = match self.law_factor {
            Some(field) if field.level == level && kernel.law => Some(follow(&[field])?),
            _ => None,
        };
        let outer_gap = match self.outer_gap {
            Some(field) if field.level == level && kernel.law => Some(follow(&[field])?),
            _ => None,
        };
        let law = source::LawSource {
            shader: self.law,
            factor,
            outer_gap,
        };
        let text = source::kernel(kernel, &space.plan, whole, law, self.wide)?;
        let groups = space.plan.slab_groups(kernel.form);
        let in_slab = |slab: usize| {
            let shared = self.shared(space, slab);
            let mut buffers: Vec<_> = bound[..own].iter().map(|slabs| &slabs[slab]).collect();
            // Fields read as a whole are bound in all their slabs.
            buffers.extend(bound[own..].iter().copied().flatten());
            buffers.extend(behind.iter().map(|slabs| &slabs[slab]));
            let transform = [&space.row_roots, &space.work[slab]];
            let mut all: Vec<(&[Access], &[&wgpu::Buffer])> =
                vec![(working(&shared), &shared), (&accesses, &buffers)];
            if kernel.form != Form::Sweep {
                all.push((ROWS, &transform));
            }
            let mut prepared = self.prepare(kernel.name, text.clone(), &all, [groups, 1])?;
            let only_written = &buffers[own - kernel.fresh..own];
            prepared.bytes -= only_written.iter().map(|buffer| buffer.size()).sum::<u64>();
            if matches!(
                kernel.form,
                Form::Load | Form::Store | Form::ReadRetained | Form::Retain
            ) {
                prepared.bytes -= space.work[slab].size();
            }
            Ok(prepared)
        };
        (0..space.plan.slabs).map(in_slab).collect()
    }

    /// Group 0 of a kernel for one slab or one part of a spectrum.
    pub(super) fn shared<'a>(
        &'a self,
        space: &'a LevelSpace,
        turn: usize,
    ) -> Vec<&'a wgpu::Buffer> {
        let mut shared = vec![&self.params, &self.scalars, &space.partials];
        shared.extend(space.turns.get(turn));
        shared
    }

    pub(super) fn columns(
        &mut self,
        by: Spectrum,
        energy: bool,
        gate: Gate,
    ) -> Result<(), GpuError> {
        // It changes only the work space, so it need not wait for its gate.
        let gate = match gate {
            Gate::Accepted => Gate::Running,
            other => other,
        };
        let word = source::gate_name(gate);
        if energy {
            self.make_room(by.level, Place::Columns)?;
        }
        self.dispatch(Key::Multiply(by.index, energy, word), |backend| {
            let space = backend.level_space(by.level)?;
            let spectrum = backend.spectrum_space(by)?;
            let passes = backend.column_passes(&space.plan, spectrum.source, energy, gate);
            let accesses = bindings::columns(space.plan.slabs, space.spare.is_some());
            let mut prepared = Vec::new();
            for (text, workgroups) in passes {
                for part in 0..space.plan.parts {
                    let shared = backend.shared(space, part);
                    let mut buffers = vec![&space.column_roots];
                    buffers.extend(&space.work);
                    buffers.push(spectrum.part(part));
                    buffers.extend(&space.spare);
                    let all: [(&[Access], &[&wgpu::Buffer]); 2] =
                        [(working(&shared), &shared), (&accesses, &buffers)];
                    let mut each = backend.prepare("multiply", text.clone(), &all, workgroups)?;
                    // Each part uses only its own columns of the work space.
                    let work: u64 = space.work.iter().map(|slab| slab.size()).sum();
                    each.bytes -= 2 * (work - work / space.plan.parts as u64);
                    prepared.push(each);
                }
            }
            Ok(prepared)
        })?;
        if !energy {
            return Ok(());
        }
        let plan = &self.level_space(by.level)?.plan;
        let reduction = Reduction {
            results: Results::Curvature(plan.points()),
            groups: plan.column_groups(),
            first: plan.first_partial(Place::Columns),
            gate,
        };
        self.put_off(Decided {
            of: space::Decided::Gate(word),
            level: by.level,
            place: Place::Columns,
            reduction,
        });
        Ok(())
    }
}

/// Layout of group 0 of a field kernel.
pub(super) fn working(shared: &[&wgpu::Buffer]) -> &'static [Access] {
    match shared.len() == WORKING.len() {
        true => WORKING,
        false => WORKING_IN_TURNS,
    }
}
