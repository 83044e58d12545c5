//! Real transforms of the eight rows of a block: complex ones of half the length, whose bins are paired.
//!
//! A row of n real numbers, two of them taken as one complex number, has a spectrum of n/2 bins. Bins k and n/2 - k of it
//! make those of the row's own half spectrum, by one twiddle factor. `realfft` pairs a row at a time, one bin after another; here
//! the spectra are in tiles first, where a bin of all eight rows lies together, so that rows are paired side by side. The
//! arithmetic is that of `realfft`, to the same bits. Rows of an odd length, which nothing pairs, are its own.

use std::f64::consts::TAU;
use std::sync::Arc;

use pulp::{Arch, Simd, WithSimd};
use realfft::{ComplexToReal, RealToComplex};
use rustfft::Fft;
use rustfft::num_complex::Complex;

use super::CpuReal;
use super::blocks::{BLOCK, Tile};
use crate::real::Real;

/// One bin of the rows of a block.
type Bin<T> = [Complex<T>; BLOCK];

/// Transforms of rows of one length.
pub(super) enum RowTransform<T: Real> {
    /// Of an even length.
    Paired {
        /// Complex transforms of half the length.
        forward: Arc<dyn Fft<T>>,
        backward: Arc<dyn Fft<T>>,
        /// The last bin of the half spectrum, n/2.
        last: usize,
        /// `exp(-2 pi i k / n)` of the bins before the middle one, from 1 on.
        twiddles: Vec<Complex<T>>,
    },
    /// Of an odd length.
    Plain {
        forward: Arc<dyn RealToComplex<T>>,
        backward: Arc<dyn ComplexToReal<T>>,
    },
}

impl<T: CpuReal> RowTransform<T> {
    /// Transforms of rows of so many points.
    pub fn new(points: usize) -> Self {
        if !points.is_multiple_of(2) {
            return RowTransform::Plain {
                forward: T::real_forward(points),
                backward: T::real_backward(points),
            };
        }
        let step = -TAU / points as f64;
        let twiddle = |bin: usize| {
            let angle = step * bin as f64;
            Complex::new(T::from_double(angle.cos()), T::from_double(angle.sin()))
        };
        RowTransform::Paired {
            forward: T::complex_forward(points / 2),
            backward: T::complex_backward(points / 2),
            last: points / 2,
            twiddles: (1..points.div_ceil(4)).map(twiddle).collect(),
        }
    }

    /// Numbers of work space that a row needs.
    pub fn scratch_len(&self) -> usize {
        match self {
            RowTransform::Paired {
                forward, backward, ..
            } => (forward.get_outofplace_scratch_len()).max(backward.get_outofplace_scratch_len()),
            RowTransform::Plain { forward, backward } => {
                forward.get_scratch_len().max(backward.get_scratch_len())
            }
        }
    }

    /// A row to its spectrum, which is still to be paired; the row is used up.
    pub fn forward(&self, row: &mut [T], spectrum: &mut [Complex<T>], scratch: &mut [Complex<T>]) {
        match self {
            RowTransform::Paired { forward, .. } => {
                let row: &mut [Complex<T>] = bytemuck::cast_slice_mut(row);
                let half = &mut spectrum[..row.len()];
                forward.process_outofplace_with_scratch(row, half, scratch);
            }
            // Lengths are those of the plan, so this cannot fail.
            RowTransform::Plain { forward, .. } => {
                let _ = forward.process_with_scratch(row, spectrum, scratch);
            }
        }
    }

    /// A spectrum, whose pairs have been parted, to its row; the spectrum is used up.
    pub fn backward(&self, spectrum: &mut [Complex<T>], row: &mut [T], scratch: &mut [Complex<T>]) {
        match self {
            RowTransform::Paired { backward, .. } => {
                let row: &mut [Complex<T>] = bytemuck::cast_slice_mut(row);
                let half = &mut spectrum[..row.len()];
                backward.process_outofplace_with_scratch(half, row, scratch);
            }
            RowTransform::Plain { backward, .. } => {
                // The imaginary part of the first bin is rounding; the real transform wants it zero.
                spectrum[0].im = T::zero();
                let _ = backward.process_with_scratch(spectrum, row, scratch);
            }
        }
    }

    /// Makes the spectra of the rows in the tiles of a block.
    pub fn pair(&self, tiles: &mut [Tile<T>]) {
        self.work_on::<true>(tiles);
    }

    /// The inverse of that, but for the factor 2 of a transform there and back.
    pub fn part(&self, tiles: &mut [Tile<T>]) {
        self.work_on::<false>(tiles);
    }

    fn work_on<const FORWARD: bool>(&self, tiles: &mut [Tile<T>]) {
        if let &RowTransform::Paired {
            last, ref twiddles, ..
        } = self
        {
            Arch::new().dispatch(Pairing::<T, FORWARD> {
                tiles,
                last,
                twiddles,
            });
        }
    }
}

/// The bins of a block in its tiles; paired `FORWARD`, parted backward.
struct Pairing<'a, T: Real, const FORWARD: bool> {
    tiles: &'a mut [Tile<T>],
    /// The last bin, n/2.
    last: usize,
    twiddles: &'a [Complex<T>],
}

/// A bin in the tiles of a block.
#[inline(always)]
fn bin<T: Real>(tiles: &mut [Tile<T>], at: usize) -> &mut Bin<T> {
    let (bins, _) = tiles[at / BLOCK].as_chunks_mut::<BLOCK>();
    &mut bins[at % BLOCK]
}

impl<T: Real, const FORWARD: bool> WithSimd for Pairing<'_, T, FORWARD> {
    type Output = ();

    /// The same source for each kind of processor.
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Pairing {
            tiles,
            last,
            twiddles,
        } = self;
        let (first_bin, last_bin) = if FORWARD {
            let both = *bin(tiles, 0);
            (
                both.map(|both| Complex::new(both.re + both.im, T::zero())),
                both.map(|both| Complex::new(both.re - both.im, T::zero())),
            )
        } else {
            // The imaginary parts of both are rounding.
            let (first, last) = (*bin(tiles, 0), *bin(tiles, last));
            let mut both = first;
            for (both, last) in both.iter_mut().zip(&last) {
                *both = Complex::new(both.re + last.re, both.re - last.re);
            }
            (both, last)
        };
        *bin(tiles, 0) = first_bin;
        *bin(tiles, last) = last_bin;
        for (k, &twiddle) in (1..).zip(twiddles) {
            let (low, high) = (*bin(tiles, k), *bin(tiles, last - k));
            let (low, high) = paired::<T, FORWARD>(&low, &high, twiddle);
            *bin(tiles, k) = low;
            *bin(tiles, last - k) = high;
        }
        if last.is_multiple_of(2) {
            for middle in bin(tiles, last / 2) {
                *middle = if FORWARD {
                    middle.conj()
                } else {
                    (*middle + *middle).conj()
                };
            }
        }
    }
}

/// Bins k and n/2 - k of all rows, paired or parted.
#[inline(always)]
fn paired<T: Real, const FORWARD: bool>(
    low: &Bin<T>,
    high: &Bin<T>,
    twiddle: Complex<T>,
) -> (Bin<T>, Bin<T>) {
    let half = T::from_double(0.5);
    // The inverse has the conjugate, and twice as much.
    let factor = if FORWARD {
        Complex::new(half * twiddle.re, half * twiddle.im)
    } else {
        twiddle.conj()
    };
    let (mut first, mut second) = (*low, *high);
    for row in 0..BLOCK {
        let (low, high) = (low[row], high[row]);
        let (sum, difference) = (low + high, low - high);
        let turned = Complex::new(
            sum.im * factor.re + difference.re * factor.im,
            sum.im * factor.im - difference.re * factor.re,
        );
        if FORWARD {
            let (even, odd) = (half * sum.re, half * difference.im);
            first[row] = Complex::new(even + turned.re, odd + turned.im);
            second[row] = Complex::new(even - turned.re, turned.im - odd);
        } else {
            first[row] = Complex::new(sum.re - turned.re, difference.im - turned.im);
            second[row] = Complex::new(sum.re + turned.re, -turned.im - difference.im);
        }
    }
    (first, second)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rustfft::num_traits::Zero;

    /// Rows of many lengths, there and back, beside `realfft`: the same bits.
    fn same_as_realfft<T: CpuReal>(points: usize) {
        let mut state = 1u64;
        let mut draw = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1);
            T::from_double((state >> 33) as f64 / f64::from(1 << 30) - 1.0)
        };
        let rows: Vec<Vec<T>> = (0..BLOCK)
            .map(|_| (0..points).map(|_| draw()).collect())
            .collect();
        let (there, back) = (T::real_forward(points), T::real_backward(points));
        let columns = points / 2 + 1;
        let transform = RowTransform::<T>::new(points);
        let mut scratch = vec![Complex::zero(); transform.scratch_len()];
        let zero = Complex::<T>::zero();
        let mut tiles: Vec<Tile<T>> = (0..columns.div_ceil(BLOCK))
            .map(|_| [zero; BLOCK * BLOCK])
            .collect();
        let mut spectrum = vec![zero; columns];
        for (row, values) in rows.iter().enumerate() {
            transform.forward(&mut values.clone(), &mut spectrum, &mut scratch);
            for (at, value) in spectrum.iter().enumerate() {
                bin(&mut tiles, at)[row] = *value;
            }
        }
        transform.pair(&mut tiles);
        let mut expected = vec![vec![zero; columns]; BLOCK];
        for ((row, values), expected) in rows.iter().enumerate().zip(&mut expected) {
            there
                .process(&mut values.clone(), expected)
                .expect("its lengths");
            for (at, value) in expected.iter().enumerate() {
                assert_eq!(bin(&mut tiles, at)[row], *value, "{points}: {at}");
            }
        }
        transform.part(&mut tiles);
        for (row, expected) in expected.iter_mut().enumerate() {
            let mut wanted = vec![T::zero(); points];
            back.process(expected, &mut wanted).expect("its lengths");
            for (at, value) in spectrum.iter_mut().enumerate() {
                *value = bin(&mut tiles, at)[row];
            }
            let mut found = vec![T::zero(); points];
            transform.backward(&mut spectrum, &mut found, &mut scratch);
            assert_eq!(found, wanted, "{points}");
        }
    }

    #[test]
    fn rows_have_the_bits_of_realfft() {
        for points in (1..=70).chain([96, 122, 126, 128, 250, 256, 486, 1000, 1024]) {
            same_as_realfft::<f64>(points);
            same_as_realfft::<f32>(points);
        }
    }
}
