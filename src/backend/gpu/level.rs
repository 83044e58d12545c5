//! How the work on a level is split into workgroups.

use super::error::GpuError;
use super::layout::Number;
use super::loops::Loops;
use super::plan::{GroupLimits, LinePlan};
use crate::backend::Shape;
use crate::kernel::{Form, SUMS};

/// Threads in a workgroup of a sweep and of a reduction.
pub const SWEEP_THREADS: usize = 256;
/// Most workgroups of a sweep; each of its threads takes several points beyond.
pub const SWEEP_GROUPS: usize = 1024;
/// Sums that a sweep's workgroup reduces together; their memory is below the least that adapters
/// have.
pub const SWEEP_SUMS_AT_ONCE: usize = 5;
/// Unit in which a level's transforms are counted: transforms of all its rows.
pub const ROW_TRANSFORMS_PER_TRANSFORM: f64 = 2.0;

/// Where partial sums wait to be added up: kernels that run before a decision write elsewhere than those
/// whose sums it needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Place {
    /// Of a kernel.
    Kernel,
    /// Of a kernel that retains transformed rows.
    Retained,
    /// Of the columns.
    Columns,
}

impl Place {
    /// The place for a kernel of the catalogue.
    pub fn for_form(form: Form) -> Place {
        match form {
            form if form.retains() => Place::Retained,
            _ => Place::Kernel,
        }
    }
}

/// How a level is split into workgroups.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct LevelPlan {
    /// Number type of its fields.
    pub number: Number,
    /// Its points.
    pub shape: [usize; 2],
    /// Those of them inside the domain, without the pad.
    pub surface: [usize; 2],
    /// Transforms along x of ny/2 pairs of rows.
    pub rows: LinePlan,
    /// The second pass over rows that are too long for one.
    pub rows_then: Option<LinePlan>,
    /// Transforms along y of nx/2 + 1 columns.
    pub columns: LinePlan,
    /// The second pass over columns that are too long for one.
    pub columns_then: Option<LinePlan>,
    /// Slabs of a field, each of as many pairs of rows; 1 where a binding holds all of it.
    pub slabs: usize,
    /// Parts of a spectrum, each of as many columns but the last.
    pub parts: usize,
    /// What becomes of the loops of its shaders.
    pub loops: Loops,
}

impl LevelPlan {
    /// The plan of a shape in one slab, if its numbers are even, smooth and not too large.
    pub fn new(shape: Shape, limits: GroupLimits, number: Number) -> Result<Self, GpuError> {
        LevelPlan::with_lines(shape, limits, number, usize::MAX)
    }

    /// The same with other shaders.
    pub fn with_loops(self, loops: Loops) -> Self {
        let spread = loops == Loops::Unrolled;
        let with = |line: LinePlan| LinePlan { spread, ..line };
        LevelPlan {
            rows: with(self.rows),
            rows_then: self.rows_then.map(with),
            columns: with(self.columns),
            columns_then: self.columns_then.map(with),
            loops,
            ..self
        }
    }

    /// Number of points.
    pub fn points(&self) -> usize {
        self.shape[0] * self.shape[1]
    }

    /// Pairs of rows, transformed as one complex row each: row y with row y + ny/2.
    pub fn pairs(&self) -> usize {
        self.shape[1] / 2
    }

    /// Columns transformed; each stands for itself and its mirror image.
    pub fn column_count(&self) -> usize {
        self.shape[0] / 2 + 1
    }

    /// Workgroups of a kernel on one slab of this level.
    pub fn slab_groups(&self, form: Form) -> usize {
        match form {
            Form::Sweep => self.slab_points().div_ceil(SWEEP_THREADS).min(SWEEP_GROUPS),
            _ => self.slab_pairs().div_ceil(self.pairs_at_once()),
        }
    }

    /// Workgroups of a kernel on this level, all slabs together.
    pub fn groups(&self, form: Form) -> usize {
        self.slabs * self.slab_groups(form)
    }

    /// Workgroups of the columns of one part of a spectrum.
    pub fn part_groups(&self) -> usize {
        match self.columns_then {
            None => self.columns.groups(self.part_columns()),
            // One works on a column after another, part by part.
            Some(_) => self.part_columns(),
        }
    }

    /// Workgroups of the columns, all parts together.
    pub fn column_groups(&self) -> usize {
        self.parts * self.part_groups()
    }

    /// Partial sums that wait on this level at most: one set in each of their places.
    pub fn partials(&self) -> usize {
        self.first_partial(Place::Columns) + self.column_groups()
    }

    /// The first of the partial sums in a place.
    pub fn first_partial(&self, place: Place) -> usize {
        let kernels = self.groups(Form::Sweep).max(self.groups(Form::Load)) * SUMS;
        match place {
            Place::Kernel => 0,
            Place::Retained => kernels,
            Place::Columns => kernels + self.groups(Form::RetainRows) * SUMS,
        }
    }
}
