//! Kernels around a convolution of fields as they are.

use crate::kernel::{Kernel, Params, Rows, SUMS, Scalars, rows_kernel};
use crate::real::Real;

fn load_displacement<T: Real>(
    rows: &mut Rows<T>,
    _: &Params,
    scalars: &Scalars,
    _: &mut [f64; SUMS],
) {
    let count = rows.len();
    let (gap, heights) = (&rows.reads[0][..count], &rows.reads[1][..count]);
    let offset = T::from_double(scalars.offset);
    for (i, line) in rows.lines[..count].iter_mut().enumerate() {
        *line = (gap[i] - offset) + heights[i];
    }
}

/// Fills the rows of a transform with g + h less the offset: the beginning of `plain::fresh_state`.
pub static LOAD_DISPLACEMENT: Kernel = rows_kernel!(
    load_displacement, Load, gate Always, law false,
    reads [gap, heights], writes []
);

fn store_field<T: Real>(rows: &mut Rows<T>, _: &Params, _: &Scalars, _: &mut [f64; SUMS]) {
    let count = rows.len();
    let lines = &rows.lines[..count];
    rows.writes[0][..count].copy_from_slice(lines);
}

/// Stores the rows of a transform as they are: the end of `plain::fresh_state`.
pub static STORE_FIELD: Kernel = rows_kernel!(
    store_field, Store, gate Always, law false,
    reads [], writes [field], fresh 1
);

fn load_field<T: Real>(rows: &mut Rows<T>, _: &Params, _: &Scalars, _: &mut [f64; SUMS]) {
    let count = rows.len();
    rows.lines[..count].copy_from_slice(&rows.reads[0][..count]);
}

/// Fills the rows of a transform with a field as it is: the beginning of K*s in `plain::trial`.
pub static LOAD_FIELD: Kernel = rows_kernel!(
    load_field, Load, gate Always, law false,
    reads [field], writes []
);
/// The same for what readies a direction: of the share of free points on the coarse level.
pub static LOAD_FIELD_AHEAD: Kernel = rows_kernel!(
    load_field, Load, gate Ahead, law false,
    reads [field], writes []
);
