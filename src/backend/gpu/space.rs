//! Objects that the backend keeps on the device.

use super::source::{FactorSource, LevelPlan};

/// A level: its plan, its partial sums and the work space of its transforms.
pub struct LevelSpace {
    /// How it is split into workgroups.
    pub plan: LevelPlan,
    /// A count of transforms, then partial sums.
    pub partials: wgpu::Buffer,
    /// Transforms of pairs of rows, `[nx, pairs]` complex numbers a slab.
    pub work: Vec<wgpu::Buffer>,
    /// Halves of long columns that are their own mirror images.
    pub spare: Option<wgpu::Buffer>,
    /// The index of each slab or part of a spectrum; empty where there is one of each.
    pub turns: Vec<wgpu::Buffer>,
    /// Roots of unity of the rows' passes.
    pub row_roots: wgpu::Buffer,
    /// Roots of unity of the columns' passes.
    pub column_roots: wgpu::Buffer,
}

/// A field.
pub struct FieldSpace {
    /// Its values, one buffer for each slab.
    pub slabs: Vec<wgpu::Buffer>,
}

/// A spectrum: one factor for each wavevector.
pub struct SpectrumSpace {
    /// How its factors are obtained.
    pub source: FactorSource,
    /// The first part of its table, or the constants in place of the table; the zero wavevector's factor first.
    pub first: wgpu::Buffer,
    /// The other parts of its table.
    pub others: Vec<wgpu::Buffer>,
}

impl SpectrumSpace {
    /// The table that the columns of a part bind.
    pub fn part(&self, part: usize) -> &wgpu::Buffer {
        let other = part.checked_sub(1).and_then(|other| self.others.get(other));
        other.unwrap_or(&self.first)
    }
}

/// A buffer of zeros that can also be written to and read from.
pub fn buffer(
    device: &wgpu::Device,
    name: &str,
    bytes: usize,
    usage: wgpu::BufferUsages,
) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(name),
        // Lengths of copies are multiples of 4.
        size: (bytes as u64).next_multiple_of(4),
        usage: usage | wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    })
}

/// Key of a prepared dispatch.
#[derive(Clone, PartialEq, Eq, Hash)]
pub enum Key {
    /// A variant of a kernel by its place in memory, its level, whether it works on corrections, and its fields.
    Kernel(usize, usize, bool, Vec<usize>),
    /// The second pass over long rows of a level, forward or back, behind a gate.
    RowsThen(usize, bool, &'static str),
    /// The columns with a spectrum, with or without the energy, behind a gate.
    Multiply(usize, bool, &'static str),
    /// Sums by what they are of and their level, and scalar kernels.
    Decide(Vec<(Decided, Option<usize>)>),
}

/// Key of a part of a decision: a variant of a kernel or a scalar kernel by its place in memory, a
/// multiplication by its gate.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub enum Decided {
    /// A kernel.
    Kernel(usize),
    /// A multiplication.
    Gate(&'static str),
}

/// Four bytes from the device as a number.
pub fn single_of(bytes: &[u8]) -> f32 {
    bytes.try_into().map_or(f32::NAN, f32::from_le_bytes)
}
