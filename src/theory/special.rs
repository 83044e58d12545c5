//! Special functions, to nearly full precision for real arguments.

use std::f64::consts::PI;

/// Euler's constant.
const EULER: f64 = 0.577_215_664_901_532_9;

/// Error function, `2/sqrt(pi) int_0^x exp(-t^2) dt`.
pub fn erf(x: f64) -> f64 {
    libm::erf(x)
}

/// Complementary error function, `1 - erf(x)`, with a small relative error also for large x.
pub fn erfc(x: f64) -> f64 {
    libm::erfc(x)
}

/// Exponential integral `E1(x) = int_x^inf exp(-t)/t dt` for x > 0; infinite at 0.
pub fn exponential_integral(x: f64) -> f64 {
    if x.is_nan() || x < 0.0 {
        f64::NAN
    } else if x == 0.0 {
        f64::INFINITY
    } else if x <= 1.5 {
        let (mut term, mut sum, mut n) = (-1.0, 0.0, 0.0);
        // Some 25 terms, by the factorial.
        while f64::abs(term) > 1e-18 {
            n += 1.0;
            term *= -x / n;
            sum += term / n;
        }
        -EULER - x.ln() + sum
    } else if x > 745.0 {
        0.0
    } else {
        // Continued fraction, Abramowitz & Stegun 5.1.22, from the far end.
        let terms = (20.0 + 120.0 / x) as usize;
        let mut tail = x;
        for k in (1..=terms).rev() {
            let k = k as f64;
            tail = x + k / (1.0 + k / tail);
        }
        (-x).exp() / tail
    }
}

/// Complete elliptic integrals `(K(m), E(m))` of parameter `m = k^2 <= 1`, by the
/// arithmetic-geometric mean. K is infinite at 1.
pub fn elliptic(m: f64) -> (f64, f64) {
    elliptic_complement(1.0 - m)
}

/// The same from the complement `1 - m >= 0`, which is precise near the singularity of K.
pub fn elliptic_complement(complement: f64) -> (f64, f64) {
    if complement <= 0.0 {
        return if complement == 0.0 {
            (f64::INFINITY, 1.0)
        } else {
            (f64::NAN, f64::NAN)
        };
    }
    let (mut a, mut b) = (1.0, complement.sqrt());
    let mut sum = 0.5 * (1.0 - complement);
    let mut power = 0.5;
    for _ in 0..40 {
        let c = 0.5 * (a - b);
        if f64::abs(c) <= 1e-16 * a {
            break;
        }
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
        power *= 2.0;
        sum += power * c * c;
    }
    let k = 0.5 * PI / a;
    (k, k * (1.0 - sum))
}

/// Gamma function of a real argument (Lanczos 1964, g = 7, n = 9; relative error 1e-15).
pub fn gamma(x: f64) -> f64 {
    const COEFFICIENTS: [f64; 9] = [
        0.999_999_999_999_809_9,
        676.520_368_121_885_1,
        -1_259.139_216_722_402_8,
        771.323_428_777_653_1,
        -176.615_029_162_140_6,
        12.507_343_278_686_905,
        -0.138_571_095_265_720_12,
        9.984_369_578_019_572e-6,
        1.505_632_735_149_311_6e-7,
    ];
    if x < 0.5 {
        return PI / ((PI * x).sin() * gamma(1.0 - x));
    }
    let x = x - 1.0;
    let mut sum = COEFFICIENTS[0];
    for (i, coefficient) in COEFFICIENTS.iter().enumerate().skip(1) {
        sum += coefficient / (x + i as f64);
    }
    let t = x + 7.5;
    (2.0 * PI).sqrt() * t.powf(x + 0.5) * (-t).exp() * sum
}

/// Beta function `Gamma(a) Gamma(b) / Gamma(a + b)`.
pub fn beta(a: f64, b: f64) -> f64 {
    gamma(a) * gamma(b) / gamma(a + b)
}

/// Standard normal density `exp(-z^2/2) / sqrt(2 pi)`.
pub fn normal_density(z: f64) -> f64 {
    (-0.5 * z * z).exp() / (2.0 * PI).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(got: f64, expected: f64) {
        assert!(
            (got - expected).abs() <= 4e-14 * expected.abs(),
            "{got} is not {expected}"
        );
    }

    // Values from Abramowitz & Stegun and 30-digit arithmetic.
    #[test]
    fn known_values() {
        close(erf(0.5), 0.520_499_877_813_046_5);
        close(erf(-1.0), -0.842_700_792_949_714_9);
        close(erfc(1.9), 0.007_209_570_764_742_533);
        close(erfc(2.0), 0.004_677_734_981_047_266);
        close(erfc(5.0), 1.537_459_794_428_035e-12);
        close(erfc(-3.0), 1.999_977_909_503_001_5);
        close(exponential_integral(0.1), 1.822_923_958_419_390_7);
        close(exponential_integral(1.0), 0.219_383_934_395_520_27);
        close(exponential_integral(2.0), 0.048_900_510_708_061_12);
        close(exponential_integral(10.0), 4.156_968_929_685_324e-6);
        close(elliptic(0.5).0, 1.854_074_677_301_371_9);
        close(elliptic(0.5).1, 1.350_643_881_047_675_5);
        close(elliptic(1.0).1, 1.0);
        close(gamma(0.25), 3.625_609_908_221_908);
        close(gamma(-0.5), -2.0 * PI.sqrt());
        close(gamma(9.0), 40_320.0);
    }

    #[test]
    fn branches_meet() {
        for (function, at) in [
            (erf as fn(f64) -> f64, 2.5),
            (erfc, 1.0),
            (exponential_integral, 1.5),
        ] {
            let jump = function(at * (1.0 + 1e-15)) / function(at * (1.0 - 1e-15)) - 1.0;
            assert!(jump.abs() < 1e-13, "{jump:e} at {at}");
        }
    }
}
