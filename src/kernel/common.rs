//! Kernels that serve every law.

use crate::kernel::{Params, Rows, SUMS, Scalars, kernel};
use crate::real::Real;

fn load_displacement<T: Real>(
    rows: &mut Rows<T>,
    _: &Params,
    scalars: &Scalars,
    _: &mut [f64; SUMS],
) {
    let count = rows.len();
    let (gap, heights) = (&rows.reads[0][..count], &rows.reads[1][..count]);
    let offset = T::of(scalars.offset);
    for (i, line) in rows.lines[..count].iter_mut().enumerate() {
        *line = (gap[i] - offset) + heights[i];
    }
}
kernel!(
    /// Loads g + h less the offset. Reads gap, heights.
    LOAD_DISPLACEMENT, load_displacement, Load, reads 2, writes 0, whole false, sums [], gate Always
);

fn store_pressure<T: Real>(rows: &mut Rows<T>, _: &Params, _: &Scalars, _: &mut [f64; SUMS]) {
    let count = rows.len();
    let lines = &rows.lines[..count];
    rows.writes[0][..count].copy_from_slice(lines);
}
kernel!(
    /// Stores the lines as they are. Writes one field.
    STORE_PRESSURE, store_pressure, Store, reads 0, writes 1, fresh 1, whole false, sums [], gate Always
);

fn load_field<T: Real>(rows: &mut Rows<T>, _: &Params, _: &Scalars, _: &mut [f64; SUMS]) {
    let count = rows.len();
    rows.lines[..count].copy_from_slice(&rows.reads[0][..count]);
}
kernel!(
    /// Loads a field as it is.
    LOAD_FIELD, load_field, Load, reads 1, writes 0, whole false, sums [], gate Always
);
