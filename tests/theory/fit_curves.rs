//! What curves that tests make have in common.

/// Nearly normal numbers with a variance of 1: sums of twelve even ones.
pub fn normal(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        let even = (0..12).map(|_| {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        });
        even.sum::<f64>() - 6.0
    }
}
