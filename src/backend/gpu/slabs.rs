//! Grids whose fields are larger than one binding, split into slabs of one buffer each.
//!
//! All slabs hold the same number of pairs of rows: first the rows y of its pairs, then their partners
//! y + ny/2. A kernel on rows or points treats a slab as a level with fewer rows, in one dispatch, with a
//! transposed work space of its own. Only the columns bind the work space of all slabs at once. The factors
//! of a spectrum are stored column by column and split between columns.

use std::ops::Range;

use super::error::GpuError;
use super::layout::Number;
use super::level::LevelPlan;
use super::plan::GroupLimits;
use crate::backend::Shape;
use crate::kernel::Form;

/// Storage buffers that the columns bind besides the slabs: scalars, partial sums, roots, factors, without
/// the spare halves of long columns. The kernel that restricts a field of all slabs binds as many.
const BOUND_BESIDES: usize = 4;
/// Longest binding that wgpu allows, whatever the adapter's limit.
pub const LONGEST_BINDING: u64 = (1 << 31) - 1;
/// Most workgroups of a dispatch along one dimension, which every adapter takes.
const MOST_GROUPS: usize = 65535;

/// The limits that decide how a grid is laid out on a device.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Limits {
    /// Limits of a workgroup.
    pub group: GroupLimits,
    /// Bytes of one binding.
    pub binding: u64,
    /// Bytes of a slab at most, no more than a binding.
    pub slab: u64,
    /// Most storage buffers that one kernel may bind.
    pub bindings: usize,
    /// Points of a line that is transformed in one pass, at most.
    pub longest_line: usize,
}

impl Limits {
    /// Slabs that one kernel binds at most.
    fn most_slabs(&self, plan: &LevelPlan) -> usize {
        let besides = BOUND_BESIDES + usize::from(plan.columns_then.is_some());
        self.bindings.saturating_sub(besides)
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
    /// The plan of a shape in as few slabs as the limits allow; most grids need one.
    pub fn laid_out(shape: Shape, limits: &Limits, number: Number) -> Result<Self, GpuError> {
        let plan = LevelPlan::with_lines(shape, limits.group, number, limits.longest_line)?;
        let number_bytes = number.bytes() as u64;
        let (pairs, width) = (plan.pairs() as u64, plan.shape[0] as u64);
        let field = 2 * pairs * width * number_bytes;
        let too_large = |bytes: u64, limit: u64| GpuError::TooLarge {
            name: "a field".to_string(),
            bytes,
            limit,
        };
        let most = limits.most_slabs(&plan);
        let least = field.div_ceil(limits.slab.max(1)).max(1);
        // Equal slabs, so that one shader serves all.
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
