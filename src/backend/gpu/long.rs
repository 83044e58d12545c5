//! Lines longer than a workgroup holds, as `first * then` points each.
//!
//! Point `then a + b` and wave `c + first d`: the first pass transforms over a for each b and turns the
//! result by `exp(-2 pi i b c / n)`, the second transforms over b for each c. Both work in place, so
//! that wave `c + first d` ends at place `then c + d` of its line. Nothing puts it back in order: the
//! columns look for it there, and the inverse starts from there.

use super::GpuBackend;
use super::bindings::{Access, ROWS};
use super::butterfly::Direction;
use super::dispatching::working;
use super::error::GpuError;
use super::layout::Number;
use super::level::LevelPlan;
use super::loops::Loops;
use super::plan::{GroupLimits, LinePlan};
use super::source::{self, FactorSource, Pass};
use super::space::Key;
use crate::backend::{Level, Shape};
use crate::kernel::Gate;

/// Neighbouring pairs of rows in a workgroup: four complex numbers are one sector of memory.
const MOST_PAIRS: usize = 4;

/// The plan of `count` lines: of a line as it is, or of the parts of its first and its second pass, of
/// which `counts` tells from their lengths how many a workgroup finds side by side.
fn plans(
    length: usize,
    count: usize,
    counts: impl Fn(usize, usize) -> [usize; 2],
    limits: GroupLimits,
    number: Number,
    longest: usize,
) -> Option<(LinePlan, Option<LinePlan>)> {
    if length <= longest
        && let Some(plan) = LinePlan::new(length, count, limits, number)
    {
        return Some((plan, None));
    }
    // The most even shares; the first, whose first radix must be even, is the larger one of equals.
    let mut shares: Vec<(usize, usize)> = (2..=length / 2)
        .step_by(2)
        .filter(|share| length.is_multiple_of(*share))
        .map(|share| (share, length / share))
        .filter(|&(first, then)| first <= longest && then <= longest)
        .collect();
    shares.sort_by_key(|&(first, then)| (first.max(then), then));
    shares.into_iter().find_map(|(first, then)| {
        let [many, many_then] = counts(first, then);
        let plan = |part, count| LinePlan::part(part, length, count, limits, number);
        let (first, mut then) = (plan(first, many)?, plan(then, many_then)?);
        then.roots_at = first.roots_end();
        Some((first, Some(then)))
    })
}

impl LevelPlan {
    /// The plan of a shape in one slab, with lines of up to `longest` points in one pass.
    pub fn with_lines(
        shape: Shape,
        limits: GroupLimits,
        number: Number,
        longest: usize,
    ) -> Result<Self, GpuError> {
        let [nx, ny] = shape.points;
        let refused = || GpuError::Size {
            nx,
            ny,
            largest: LinePlan::longest(limits, number).pow(2),
        };
        if !nx.is_multiple_of(2) || !ny.is_multiple_of(2) {
            return Err(refused());
        }
        let pairs = ny / 2;
        let row_counts = |_, then| [pairs * then, pairs];
        let column_counts = |first, then| [then, first];
        let (rows, rows_then) =
            plans(nx, pairs, row_counts, limits, number, longest).ok_or_else(refused)?;
        let (mut columns, columns_then) =
            plans(ny, nx / 2 + 1, column_counts, limits, number, longest).ok_or_else(refused)?;
        if columns_then.is_none() {
            columns = LinePlan::in_one_piece(ny, nx / 2 + 1, limits, number).ok_or_else(refused)?;
        }
        Ok(LevelPlan {
            number,
            shape: shape.points,
            surface: shape.surface,
            rows,
            rows_then,
            columns,
            columns_then,
            slabs: 1,
            parts: 1,
            loops: Loops::Unrolled,
        })
    }

    /// Parts of a row that the first pass takes for each of its pairs; 1 where rows are not long.
    pub fn row_parts(&self) -> usize {
        self.rows_then.as_ref().map_or(1, |then| then.length)
    }

    /// Parts of a column that the first pass takes; 1 where columns are not long.
    pub fn column_parts(&self) -> usize {
        self.columns_then.as_ref().map_or(1, |then| then.length)
    }

    /// Pairs of rows side by side in a workgroup of a kernel on rows.
    pub fn pairs_at_once(&self) -> usize {
        match self.rows_then {
            None => self.rows.lines,
            Some(_) => {
                let pairs = self.slab_pairs().next_power_of_two();
                self.rows.lines.min(MOST_PAIRS).min(pairs)
            }
        }
    }

    /// Parts of these rows side by side in it.
    pub fn row_parts_at_once(&self) -> usize {
        self.rows.lines / self.pairs_at_once()
    }

    /// The place of a wave along x among the lines of the work space, in WGSL.
    pub fn place_of(&self, wave: &str) -> String {
        match &self.rows_then {
            None => wave.to_string(),
            Some(then) => format!(
                "({wave} % {first}u * {then}u + {wave} / {first}u)",
                first = self.rows.length,
                then = then.length
            ),
        }
    }
}

impl GpuBackend {
    /// The spare halves of a level's long columns.
    pub(super) fn spare(&self, plan: &LevelPlan) -> Result<Option<wgpu::Buffer>, GpuError> {
        let bytes = 2 * self.number.bytes() * plan.shape[1];
        match plan.columns_then {
            None => Ok(None),
            Some(_) => self.storage("spare", bytes).map(Some),
        }
    }

    /// Records the second pass over the rows of a level, if they are long.
    pub(super) fn rows_then(
        &mut self,
        level: Level,
        direction: Direction,
        gate: Gate,
    ) -> Result<(), GpuError> {
        let plan = &self.level_space(level)?.plan;
        let Some(text) = source::rows_then(plan, direction, gate, self.wide) else {
            return Ok(());
        };
        let forward = direction == Direction::Forward;
        let key = Key::RowsThen(level.0, forward, source::gate_name(gate));
        self.dispatch(key, |backend| {
            let space = backend.level_space(level)?;
            let plan = &space.plan;
            let groups = plan
                .rows_then
                .as_ref()
                .map_or(0, |then| then.groups(plan.slab_pairs()));
            let in_slab = |(slab, work): (usize, &wgpu::Buffer)| {
                let shared = backend.shared(space, slab);
                let buffers = [&space.row_roots, work];
                let all: [(&[Access], &[&wgpu::Buffer]); 2] =
                    [(working(&shared), &shared), (ROWS, &buffers)];
                backend.prepare("rows_then", text.clone(), &all, [groups, plan.rows.length])
            };
            space.work.iter().enumerate().map(in_slab).collect()
        })
    }

    /// The passes over the columns: their shaders, and workgroups for one part of a spectrum.
    pub(super) fn column_passes(
        &self,
        plan: &LevelPlan,
        factors: FactorSource,
        energy: bool,
        gate: Gate,
    ) -> Vec<(String, [usize; 2])> {
        if plan.columns_then.is_none() {
            let text = source::multiply(plan, factors, energy, gate, self.wide);
            return vec![(text, [plan.part_groups(), 1])];
        }
        let parts = plan.columns.groups(plan.column_parts());
        Pass::ALL
            .into_iter()
            .filter_map(|pass| {
                let text = source::multiply_long(plan, pass, factors, energy, gate, self.wide)?;
                let along = match pass {
                    Pass::Middle => 1,
                    Pass::First | Pass::Last => parts,
                };
                Some((text, [plan.part_groups(), along]))
            })
            .collect()
    }
}
