//! Kernels of the two-band preconditioner: long waves are corrected on a coarse grid, where the
//! share of free points weighs them, so that they do not reach across contacts.

use super::wall::neighbours;
use crate::kernel::{Params, Rows, SUMS, Scalars, kernel};
use crate::real::Real;

/// The transpose of the bilinear interpolation, over the number of fine points in a coarse cell.
fn coarse_restrict<T: Real>(rows: &mut Rows<T>, _: &Params, _: &Scalars, _: &mut [f64; SUMS]) {
    let whole = rows.whole;
    let [fine_x, fine_y] = whole.points;
    let (width, first, count) = (rows.width, rows.first, rows.count);
    let ratio = fine_x / width;
    let coarse_rows = fine_y / ratio;
    let (restricted, rest) = rows.writes.split_at_mut(1);
    let (restricted, share) = (&mut *restricted[0], &mut *rest[0]);
    let scale = T::one() / T::of((ratio * ratio) as f64);
    for row in 0..count {
        let out = &mut restricted[row * width..(row + 1) * width];
        let free = &mut share[row * width..(row + 1) * width];
        out.fill(T::zero());
        free.fill(T::zero());
        let cell = first + row;
        // The fine rows of this cell and the nearer halves of its neighbours touch it.
        let half = ratio / 2;
        for offset in 0..2 * ratio {
            let fine = (cell * ratio + fine_y + offset - half) % fine_y;
            let (below, above, part) = neighbours(fine, ratio, coarse_rows);
            let weight = if below == cell {
                1.0 - part
            } else if above == cell {
                part
            } else {
                0.0
            };
            let weight = T::of(weight);
            let inside = offset >= half && offset < half + ratio;
            let line = &whole.values[fine * fine_x..(fine + 1) * fine_x];
            gather(out, line, ratio, weight * scale);
            if inside {
                for (x, &value) in line.iter().enumerate() {
                    if value != T::zero() {
                        free[x / ratio] += scale;
                    }
                }
            }
        }
    }
}
kernel!(
    /// Restricts the fine yF and the share of free points. Writes both; whole: the fine yF.
    COARSE_RESTRICT, coarse_restrict, Sweep, reads 0, writes 2, whole true, sums [], gate Fresh
);

/// Adds `weight` times the horizontal restriction of a fine line.
#[inline(always)]
fn gather<T: Real>(out: &mut [T], line: &[T], ratio: usize, weight: T) {
    if weight == T::zero() {
        return;
    }
    let coarse = out.len();
    for place in 0..ratio {
        let (_, _, share) = neighbours(place, ratio, coarse);
        let before = place < ratio / 2;
        let (near, far) = if before {
            (share, 1.0 - share)
        } else {
            (1.0 - share, share)
        };
        let (near, far) = (T::of(near) * weight, T::of(far) * weight);
        for (cell, chunk) in line.chunks_exact(ratio).enumerate() {
            let value = chunk[place];
            out[cell] += near * value;
            let other = if before {
                if cell == 0 { coarse - 1 } else { cell - 1 }
            } else if cell + 1 == coarse {
                0
            } else {
                cell + 1
            };
            out[other] += far * value;
        }
    }
}

fn coarse_weight<T: Real>(rows: &mut Rows<T>, _: &Params, _: &Scalars, _: &mut [f64; SUMS]) {
    let lines = &*rows.lines;
    for (out, &m) in rows.writes[0].iter_mut().zip(lines) {
        let m = m.max(T::zero()).min(T::one());
        *out = m * m;
    }
}
kernel!(
    /// Stores the square of the smoothed share of free points, clipped to [0, 1].
    COARSE_WEIGHT, coarse_weight, Store, reads 0, writes 1, whole false, sums [], gate Fresh
);

fn coarse_load<T: Real>(rows: &mut Rows<T>, _: &Params, _: &Scalars, _: &mut [f64; SUMS]) {
    let [field, weight, ..] = rows.reads;
    for (i, line) in rows.lines.iter_mut().enumerate() {
        *line = field[i] * weight[i];
    }
}
kernel!(
    /// Loads a field times its weight.
    COARSE_LOAD, coarse_load, Load, reads 2, writes 0, whole false, sums [], gate Fresh
);

fn coarse_share<T: Real>(rows: &mut Rows<T>, _: &Params, _: &Scalars, _: &mut [f64; SUMS]) {
    let count = rows.len();
    rows.lines[..count].copy_from_slice(&rows.reads[0][..count]);
}
kernel!(
    /// Loads the share of free points.
    COARSE_SHARE, coarse_share, Load, reads 1, writes 0, whole false, sums [], gate Fresh
);

fn coarse_store<T: Real>(rows: &mut Rows<T>, _: &Params, _: &Scalars, _: &mut [f64; SUMS]) {
    let weight = rows.reads[0];
    let lines = &*rows.lines;
    for (i, out) in rows.writes[0].iter_mut().enumerate() {
        *out = weight[i] * lines[i];
    }
}
kernel!(
    /// Stores the lines times the weight: the long-wave part of z.
    COARSE_STORE, coarse_store, Store, reads 1, writes 1, whole false, sums [], gate Fresh
);
