//! Grids whose fields are larger than one binding, cut into slabs of a buffer each.
//!
//! A slab holds so many pairs of rows, the same number as any other: first the rows y of its pairs,
//! then their partners y + ny/2. So to a kernel that works on rows or points a slab is a level of
//! its own, of fewer rows, in one dispatch, and the work space of that slab is transposed within
//! it. Only the columns bind the work space of all slabs at once. The factors of a spectrum lie
//! column by column and are cut between columns.

use std::ops::Range;

use super::error::GpuError;
use super::layout::Number;
use super::level::LevelPlan;
use super::plan::GroupLimits;
use crate::backend::Shape;
use crate::kernel::Form;

/// Storage buffers that the columns bind besides the slabs: scalars, partial sums, roots, factors.
/// The kernel that restricts a field of all slabs binds as many.
const BOUND_BESIDES: usize = 4;
/// Longest binding that wgpu makes, whatever the adapter says.
pub const LONGEST_BINDING: u64 = (1 << 31) - 1;
/// Most workgroups of a dispatch along one dimension, which every adapter takes.
const MOST_GROUPS: usize = 65535;

/// What decides how a grid is laid out on a device.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Limits {
    /// What a workgroup may hold.
    pub group: GroupLimits,
    /// Bytes of one binding.
    pub binding: u64,
    /// Bytes of a slab at most, no more than a binding.
    pub slab: u64,
    /// Storage buffers that one kernel may bind.
    pub bindings: usize,
}

impl Limits {
    /// Slabs that one kernel binds at most.
    fn most_slabs(&self) -> usize {
        self.bindings.saturating_sub(BOUND_BESIDES)
    }

    /// Points along the side of the largest square grid that a device with these limits takes in
    /// fields of this number, among the powers of two.
    pub fn largest_side(&self, number: Number) -> usize {
        (1..=20)
            .map(|power| 1usize << power)
            .take_while(|&side| LevelPlan::laid_out(Shape::whole(side, side), self, number).is_ok())
            .last()
            .unwrap_or(0)
    }
}

impl LevelPlan {
    /// The plan of a shape in as few slabs as the limits ask for; most grids take one.
    pub fn laid_out(shape: Shape, limits: &Limits, number: Number) -> Result<Self, GpuError> {
        let plan = LevelPlan::new(shape, limits.group, number)?;
        let number_bytes = number.bytes() as u64;
        let (pairs, width) = (plan.pairs() as u64, plan.shape[0] as u64);
        let field = 2 * pairs * width * number_bytes;
        let too_large = |bytes: u64, limit: u64| GpuError::TooLarge {
            name: "a field".to_string(),
            bytes,
            limit,
        };
        let most = limits.most_slabs();
        let least = field.div_ceil(limits.slab.max(1)).max(1);
        // Slabs alike, so that one shader serves them all.
        let slabs = (least..=most as u64)
            .find(|&slabs| pairs.is_multiple_of(slabs))
            .ok_or_else(|| too_large(field, most as u64 * limits.slab))?;
        let column = (plan.shape[1] as u64 / 2 + 1) * number_bytes;
        let columns = (limits.slab / column)
            .max(1)
            .min(plan.column_count() as u64);
        let parts = plan.column_count().div_ceil(columns as usize);
        let plan = LevelPlan {
            slabs: slabs as usize,
            parts,
            ..plan
        };
        let longest = 2 * number_bytes * plan.shape[0].max(plan.shape[1]) as u64;
        let partials = 8 + (plan.partials() * 8) as u64;
        for bytes in [longest, partials, column] {
            if bytes > limits.binding {
                return Err(too_large(bytes, limits.binding));
            }
        }
        match plan.slab_groups(Form::Load).max(plan.part_groups()) {
            0..=MOST_GROUPS => Ok(plan),
            // Only of a grid far longer than wide.
            _ => Err(too_large(field, limits.slab)),
        }
    }

    /// Pairs of rows in a slab.
    pub fn slab_pairs(&self) -> usize {
        self.pairs() / self.slabs
    }

    /// Points in a slab.
    pub fn slab_points(&self) -> usize {
        self.points() / self.slabs
    }

    /// Columns in a part of a spectrum; the last part may have fewer.
    pub fn part_columns(&self) -> usize {
        self.column_count().div_ceil(self.parts)
    }

    /// Dispatches that go over the slabs or the parts of a spectrum, at most.
    pub fn turns(&self) -> usize {
        self.slabs.max(self.parts)
    }

    /// Points of a field that lie in a slab one after another: the rows of its pairs, then their
    /// partners.
    pub fn slab_ranges(&self, slab: usize) -> [Range<usize>; 2] {
        let length = self.slab_points() / 2;
        let first = slab * length;
        let second = first + self.points() / 2;
        [first..first + length, second..second + length]
    }

    /// Values of a spectrum that lie in a part.
    pub fn part_range(&self, part: usize) -> Range<usize> {
        let column = self.shape[1] / 2 + 1;
        let first = part * self.part_columns();
        let last = (first + self.part_columns()).min(self.column_count());
        first * column..last * column
    }
}
