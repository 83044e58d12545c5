//! Passes over fields that the host holds, by all threads: what becomes of a point depends on no other, so that the bits are
//! the same on any number of them.

use rayon::prelude::*;

use super::long_field::LongField;

/// A field of so many points from the value at each.
pub fn made(points: usize, value_at: impl Fn(usize) -> f64 + Sync) -> LongField<f64> {
    let mut field = LongField::zeros(points);
    change(&mut field, |point, value| *value = value_at(point));
    field
}

/// A field of one value.
pub fn filled<T: Copy + Send + Sync>(points: usize, value: T) -> Vec<T> {
    (0..points).into_par_iter().map(|_| value).collect()
}

/// Changes each value of a field, given its point.
pub fn change(field: &mut [f64], of: impl Fn(usize, &mut f64) + Sync) {
    let points = field.par_iter_mut().enumerate();
    points.for_each(|(point, value)| of(point, value));
}

/// Changes each row of a field, which has so many points, given its place.
pub fn change_rows(field: &mut [f64], width: usize, of: impl Fn(usize, &mut [f64]) + Sync) {
    let rows = field.par_chunks_exact_mut(width).enumerate();
    rows.for_each(|(row, line)| of(row, line));
}

/// The sum of what is counted in each of so many rows.
pub fn count_in_rows(rows: usize, of: impl Fn(usize) -> usize + Sync) -> usize {
    (0..rows).into_par_iter().map(&of).sum()
}
