//! The rough surface of the benches, on a square of side 1 over a solid of contact modulus 1.

/// The text of a scene: rms slope 1, the shortest wave of 8 pixels, a mean pressure of 5 % of E* h';
/// `surface` are further keys of the surface, `tables` further tables.
pub fn rough(points: usize, surface: &str, tables: &str) -> String {
    format!(
        r#"
        [grid]
        points = {points}
        size = 1.0
        [solid]
        contact_modulus = 1.0
        [[surface]]
        kind = "self-affine"
        hurst = 0.8
        rms_slope = 1.0
        longest = 1.0
        rolloff = 0.25
        shortest = {:e}
        {surface}
        [loading]
        control = "pressure"
        path = [{PRESSURE}]
        {tables}
        "#,
        8.0 / points as f64
    )
}

/// Mean pressure over the contact modulus times the rms slope, which is 1.
pub const PRESSURE: f64 = 0.05;
