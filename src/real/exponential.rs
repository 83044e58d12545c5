//! The exponential function without a branch or a table, so that a loop over points takes several at a time.
//!
//! `x = k ln 2 + r` with k whole and `|r| <= ln(2)/2`; ln 2 is kept in two parts, of which the first has so few
//! digits that k times it is exact. `q = exp(r) - 1` is Taylor's sum, cut where what is left is less than a tenth of
//! the rounding of 1: `(ln(2)/2)^14/14!` is 0.04 of 2^-53, `(ln(2)/2)^8/8!` 0.09 of 2^-24. Then `exp(x) = 2^k (1 + q)`,
//! and `exp(x) - 1 = 2^k q + (2^k - 1)` keeps its digits about zero, where k is 0 and r is x. 2^k is multiplied in two
//! halves, so that subnormal numbers and the last ones before infinity are rounded once.
//!
//! The result is within three units of the last place of the library's (two in single precision), the same bits on
//! every processor (no fused multiplication), zero and infinity past the ends, and NaN of NaN.

/// `1/n!`.
const fn inverse_factorial(n: usize) -> f64 {
    let (mut product, mut factor) = (1.0, 2);
    while factor <= n {
        product *= factor as f64;
        factor += 1;
    }
    1.0 / product
}

/// `[exp(x), exp(x) - 1]` in one kind of number.
macro_rules! exponential {
    ($name:ident, $number:ty, ends $ends:expr, ln2 $ln2:expr, terms $first:literal $($term:literal)*) => {
        #[inline(always)]
        pub(super) fn $name(x: $number) -> [$number; 2] {
            const DIGITS: u32 = <$number>::MANTISSA_DIGITS - 1;
            // Added to a number, it leaves the nearest whole one in the last bits.
            const WHOLE: $number = 1.5 * (1u64 << DIGITS) as $number;
            // The exponent of 1, as it is stored.
            const BIAS: u32 = (<$number>::MAX_EXP - 1) as u32;
            // Beyond these ends all is zero or infinite.
            const ENDS: [$number; 2] = $ends;
            const LN2: [$number; 2] = $ln2;
            // 2 to the power of the whole number that WHOLE was added to.
            let power = |whole: $number| {
                <$number>::from_bits(whole.to_bits().wrapping_add(BIAS.into()) << DIGITS)
            };
            // Comparisons that leave NaN as it is.
            let x = if x < ENDS[0] { ENDS[0] } else { x };
            let x = if x > ENDS[1] { ENDS[1] } else { x };
            let k = (x * std::f64::consts::LOG2_E as $number + WHOLE) - WHOLE;
            let r = (x - k * LN2[0]) - k * LN2[1];
            let sum = const { inverse_factorial($first) as $number };
            $(let sum = sum * r + const { inverse_factorial($term) as $number };)*
            let q = r + r * r * sum;
            let half = 0.5 * k + WHOLE;
            let rest = k - (half - WHOLE) + WHOLE;
            let (half, rest) = (power(half), power(rest));
            let value = (1.0 + q) * half * rest;
            let less_one = q * half * rest + (half * rest - 1.0);
            // 1 is nothing beside it, and 2^k may already be infinite.
            let large = k > <$number>::MANTISSA_DIGITS as $number;
            [value, if large { value } else { less_one }]
        }
    };
}

exponential!(
    double, f64, ends [-746.0, 710.0],
    // The first part has 33 digits, the second the rest (fdlibm's).
    ln2 [f64::from_bits(0x3fe6_2e42_fee0_0000), 1.908_214_929_270_587_7e-10],
    terms 13 12 11 10 9 8 7 6 5 4 3 2
);
exponential!(
    single, f32, ends [-105.0, 89.0],
    // 15 digits, and the rest.
    ln2 [f32::from_bits(0x3f31_7200), 1.428_606_8e-6],
    terms 7 6 5 4 3 2
);

#[cfg(test)]
mod tests {
    use super::*;

    /// From end to end, and finely about zero. The library's own error is below one unit of the last place.
    #[test]
    fn double_is_the_library_s() {
        let wide = (-1_500_000..=1_430_000).map(|i| f64::from(i) * 4.987e-4);
        let near = (-200_000..=200_000).map(|i| f64::from(i) * 1.013e-5);
        for x in wide.chain(near) {
            let [value, less_one] = double(x);
            for (own, exact) in [(value, x.exp()), (less_one, x.exp_m1())] {
                // Of a subnormal number the last place is the least number that there is.
                let unit = (exact.abs() * f64::EPSILON).max(f64::from_bits(1));
                let close = own == exact || (own - exact).abs() <= 3.0 * unit;
                assert!(close, "{x:e}: {own:e} {exact:e}");
            }
        }
    }

    /// Against double precision, whose error is nothing here.
    #[test]
    fn single_is_within_two_units() {
        let wide = (-1_050_000..=890_000).map(|i| i as f32 * 1e-4);
        let near = (-200_000..=200_000).map(|i| i as f32 * 1.013e-6);
        for x in wide.chain(near) {
            let [value, less_one] = single(x);
            let x = f64::from(x);
            for (own, exact) in [(value, x.exp()), (less_one, x.exp_m1())] {
                if exact > f64::from(f32::MAX) {
                    assert_eq!(own, f32::INFINITY, "{x:e}");
                    continue;
                }
                let unit = (exact.abs() * f64::from(f32::EPSILON)).max(f32::from_bits(1).into());
                let error = (f64::from(own) - exact).abs();
                assert!(error <= 2.0 * unit, "{x:e}: {own:e} {exact:e}");
            }
        }
    }

    #[test]
    fn what_is_not_an_ordinary_number() {
        assert_eq!(double(0.0), [1.0, 0.0]);
        assert_eq!(single(0.0), [1.0, 0.0]);
        assert_eq!(double(f64::NEG_INFINITY), [0.0, -1.0]);
        assert_eq!(single(f32::NEG_INFINITY), [0.0, -1.0]);
        assert_eq!(double(f64::INFINITY), [f64::INFINITY; 2]);
        assert_eq!(single(f32::INFINITY), [f32::INFINITY; 2]);
        assert!(double(f64::NAN).iter().all(|value| value.is_nan()));
        assert!(single(f32::NAN).iter().all(|value| value.is_nan()));
    }
}
