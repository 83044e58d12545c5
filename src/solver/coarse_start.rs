//! A start from coarser grids: each level is solved loosely and its displacement refined.

use std::ops::Range;

use super::contact::ContactSolver;
use super::load::{Hold, Load, Start};
use super::{MakeBackend, problem::Problem};
use crate::backend::long_field::LongField;
use crate::backend::{Backend, BackendError, host_fields};
use crate::kernel::{Scalars, Status};
use crate::law::Law;

/// Tolerance on the coarser grids.
const TOLERANCE: f64 = 1e-3;
/// Iterations on the coarser grids.
const MAX_ITERATIONS: usize = 200;
/// Fewest points each way of a grid with a coarse start.
const FEWEST_HELPED: usize = 128;
/// Fewest points each way of the coarsest grid.
const FEWEST_COARSEST: usize = 32;
/// Halvings.
const LEVELS: usize = 3;

/// A gap to start from and its cost in transforms of the full grid; `None` where a cold start is as
/// good (small grids) or coarse grids might lead to another equilibrium (adhesion). `watch` may end it
/// early, as it may end the solve.
pub(super) fn gap(
    problem: &Problem,
    load: &Load,
    make_backend: MakeBackend,
    watch: &mut dyn FnMut(&Scalars) -> bool,
) -> Result<Option<(LongField<f64>, f64)>, BackendError> {
    let [nx, ny] = problem.shape.points;
    if problem.law != Law::HardWall || nx.min(ny) < FEWEST_HELPED || load.zero_stiffness != 0.0 {
        return Ok(None);
    }
    refine(problem, load, make_backend, watch, LEVELS)
}

fn refine(
    problem: &Problem,
    load: &Load,
    make_backend: MakeBackend,
    watch: &mut dyn FnMut(&Scalars) -> bool,
    levels: usize,
) -> Result<Option<(LongField<f64>, f64)>, BackendError> {
    let [nx, ny] = problem.shape.points;
    if levels == 0 || nx.min(ny) < 2 * FEWEST_COARSEST {
        return Ok(None);
    }
    let Some(coarse) = problem.coarsened()? else {
        return Ok(None);
    };
    let mut backend = make_backend();
    let below = refine(&coarse, load, make_backend, watch, levels - 1)?;
    let (start, mut transforms) = match below {
        Some((gap, transforms)) => (Start::Gap(gap), transforms),
        None => (Start::Cold, 0.0),
    };
    // Single precision has digits enough, but where it stalls: under a load that its rounding hides.
    let mut displacement = None;
    if let Some(mut single) = backend.in_single() {
        let end = solve(&mut *single, &coarse, load, &start, watch)?;
        transforms += end.transforms;
        displacement = (!end.failed).then_some(end.gap);
    }
    let mut displacement = match displacement {
        Some(gap) => gap,
        None => {
            let end = solve(&mut *backend, &coarse, load, &start, watch)?;
            transforms += end.transforms;
            end.gap
        }
    };
    drop((start, backend));
    let height_at = coarse.heights.by_point();
    host_fields::change(&mut displacement, |point, u| *u += height_at(point));
    let height_at = problem.heights.by_point();
    let gap_at = |point: usize, u: f64| (u - height_at(point)).max(0.0);
    let mut gap = refined(&displacement, &coarse, problem, gap_at)?;
    drop(displacement);
    if let Hold::Gap(target) = load.hold {
        let mean = problem.share.sum(&gap) / problem.shape.len() as f64;
        if mean > 0.0 {
            host_fields::change(&mut gap, |_, g| *g *= target / mean);
        }
    }
    Ok(Some((gap, transforms / 4.0)))
}

/// A loose solution of a coarse problem.
struct End {
    gap: LongField<f64>,
    transforms: f64,
    /// Whether it came to nothing.
    failed: bool,
}

/// Solves a coarse problem loosely.
fn solve(
    backend: &mut (dyn Backend + Send),
    coarse: &Problem,
    load: &Load,
    start: &Start,
    watch: &mut dyn FnMut(&Scalars) -> bool,
) -> Result<End, BackendError> {
    let mut solver = ContactSolver::new(backend, coarse);
    solver.begin(load, start, TOLERANCE, false)?;
    let (mut left, mut failed) = (MAX_ITERATIONS, false);
    while left > 0 {
        let (rounds, scalars) = solver.advance(left)?;
        failed = matches!(scalars.status, Status::Stalled | Status::NotFinite);
        if !watch(&scalars) || scalars.status != Status::Running {
            break;
        }
        left -= rounds.min(left);
    }
    Ok(End {
        transforms: solver.transforms(),
        gap: solver.gap()?,
        failed,
    })
}

/// What `of` makes of each point of the fine problem's rows and of the coarse problem's values there.
fn refined(
    values: &[f64],
    coarse: &Problem,
    fine: &Problem,
    of: impl Fn(usize, f64) -> f64 + Sync,
) -> Result<LongField<f64>, BackendError> {
    let points = coarse.shape.points;
    let [nx, ny] = points;
    let rows = fine.share.rows();
    if coarse.share.is_whole() {
        let line = |row: usize| &values[row * nx..(row + 1) * nx];
        return Ok(interpolate(line, points, rows, of));
    }
    // The coarse rows around those of the fine grid, on the ring of all.
    let around = |rows: Range<usize>| -> Vec<usize> {
        if rows.is_empty() {
            return Vec::new();
        }
        let first = rows.start / 2 + ny - 1;
        let last = (rows.end - 1) / 2 + ny + 1;
        (first..=last).map(|row| row % ny).collect()
    };
    let wanted = |rank| around(fine.share.rows_of(rank));
    let held = |rank| coarse.share.rows_of(rank);
    let found = coarse.share.fetch(values, nx, held, wanted)?;
    let first = around(rows.clone()).first().copied().unwrap_or(0);
    let line = |row: usize| {
        let place = (row + ny - first) % ny;
        &found[place * nx..(place + 1) * nx]
    };
    Ok(interpolate(line, points, rows, of))
}

/// Bilinear, between cell centres, these rows of twice the points, of each of which `of` makes another value; the grid wraps
/// round.
fn interpolate<'a>(
    coarse: impl Fn(usize) -> &'a [f64] + Sync,
    [nx, ny]: [usize; 2],
    rows: Range<usize>,
    of: impl Fn(usize, f64) -> f64 + Sync,
) -> LongField<f64> {
    let mut fine = LongField::zeros(2 * nx * rows.len());
    host_fields::change_rows(&mut fine, 2 * nx, |place, line| {
        let y = rows.start + place;
        let row = y / 2;
        let other = if y.is_multiple_of(2) {
            (row + ny - 1) % ny
        } else {
            (row + 1) % ny
        };
        let (near, far) = (coarse(row), coarse(other));
        let at = |x: usize| 0.75 * near[x] + 0.25 * far[x];
        for (x, value) in line.iter_mut().enumerate() {
            let column = x / 2;
            let other = if x.is_multiple_of(2) {
                (column + nx - 1) % nx
            } else {
                (column + 1) % nx
            };
            *value = of(place * 2 * nx + x, 0.75 * at(column) + 0.25 * at(other));
        }
    });
    fine
}
