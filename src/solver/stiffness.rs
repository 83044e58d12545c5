//! The stiffness of a problem's solid, of the wavevectors that this process transforms.

use crate::backend::{BackendError, Share};
use crate::elastic::{FreeKernel, HalfSpace, Layer, LayeredSpace, Stiffness, StiffnessTable};
use crate::grid::Grid;

/// Of a periodic half-space or layer, with this many metres to a lateral unit; the ranks find the ends of a layer's
/// together.
pub(super) fn periodic(
    grid: Grid,
    lateral: f64,
    layer: Option<&Layer>,
    share: &Share,
) -> Stiffness {
    let Some(layer) = layer else {
        return Stiffness::HalfSpace(HalfSpace::new(grid, lateral));
    };
    let [least, largest] = LayeredSpace::ends(&grid, lateral, layer, share.columns());
    let ends = [share.least(least), share.greatest(largest)];
    Stiffness::Layer(LayeredSpace::new(grid, lateral, *layer, ends))
}

/// Of a layer by its waves along the axes alone, for a sketch: it takes no time on any grid.
pub(super) fn along_axes(grid: Grid, lateral: f64, layer: &Layer) -> Stiffness {
    let lines = [Grid { ny: 1, ..grid }, Grid { nx: 1, ..grid }];
    let ends = lines.map(|line| LayeredSpace::ends(&line, lateral, layer, 0..line.nx / 2 + 1));
    let ends = [ends[0][0].min(ends[1][0]), ends[0][1].max(ends[1][1])];
    Stiffness::Layer(LayeredSpace::new(grid, lateral, *layer, ends))
}

/// Of a free half-space over the points of a share, with these sides of a pixel in reduced units. Where a rank has ended,
/// which the share keeps in mind, it is NaN.
pub(super) fn free(share: &Share, pixel: [f64; 2]) -> Stiffness {
    let kernel = FreeKernel::new(share.shape().points, pixel);
    let table = transformed(share, &kernel).unwrap_or_else(|_| {
        let nothing = |count: usize| vec![f64::NAN; count];
        StiffnessTable::new(
            share.columns(),
            nothing(share.columns().len() * kernel.rows()),
            [nothing(kernel.columns()), nothing(kernel.rows())],
            [f64::NAN; 2],
        )
    });
    Stiffness::Table(table)
}

fn transformed(share: &Share, kernel: &FreeKernel) -> Result<StiffnessTable, BackendError> {
    let (own, rows) = (share.columns(), kernel.rows());
    let mut values = share.columns_of_rows(rows, |rows| kernel.transformed_rows(rows))?;
    kernel.transform_columns(&mut values);
    // The waves along x have a value in each column, those along y are the first one.
    let ranks = 0..share.count();
    let along_x: Vec<f64> = values.iter().step_by(rows).copied().collect();
    let along_x = share.numbers(&along_x, ranks.clone().map(|r| share.columns_of(r).len()))?;
    let has_first = |rank: usize| share.columns_of(rank).contains(&0);
    let first = if has_first(share.rank()) {
        &values[..rows]
    } else {
        &[]
    };
    let along_y = share.numbers(first, ranks.map(|r| if has_first(r) { rows } else { 0 }))?;
    let waves = &values[usize::from(has_first(share.rank()))..];
    let least = waves.iter().copied().fold(f64::INFINITY, f64::min);
    let largest = values.iter().copied().fold(0.0, f64::max);
    let ends = [share.least(least), share.greatest(largest)];
    share.failed()?;
    Ok(StiffnessTable::new(own, values, [along_x, along_y], ends))
}

/// The same stiffness as a coarse level of a share has it: of a table the columns that this process transforms there, of
/// as many waves as the level has.
///
/// # Errors
/// A rank has ended.
pub(super) fn on_level(
    stiffness: &Stiffness,
    fine: &Share,
    coarse: &Share,
) -> Result<Stiffness, BackendError> {
    let Stiffness::Table(table) = stiffness else {
        return Ok(stiffness.clone());
    };
    let [columns, rows] = coarse.shape().points.map(|points| points / 2 + 1);
    let held = |rank: usize| {
        let own = fine.columns_of(rank);
        own.start.min(columns)..own.end.min(columns)
    };
    let low = table.low(held(fine.rank()), rows);
    let wanted = |rank: usize| coarse.columns_of(rank).collect();
    let values = fine.fetch(&low, rows, held, wanted)?;
    Ok(Stiffness::Table(table.below(
        coarse.columns(),
        values,
        [columns, rows],
    )))
}
