//! Colours for fields: ordered by lightness, so that they survive a grey printer and colour-blind eyes.
//!
//! Each map is a path through CIELAB (D65) along which L* falls or rises evenly while hue and
//! chroma follow simple formulas. Lightness alone therefore orders the values; hue distinguishes
//! tension from compression. The tests check that order for normal vision and under simulated
//! deuteranopia and protanopia.

use std::sync::LazyLock;

/// Red, green and blue of a pixel, sRGB, 8 bits each.
pub type Rgb = [u8; 3];

/// L* of the neutral colour: light, but distinct from the white page.
const LIGHT: f64 = 96.0;
/// L* at the end of a branch: dark, but with a visible hue.
const DARK: f64 = 16.0;
/// Steps from the neutral colour to the end of a branch.
const STEPS: usize = 255;

/// From neutral to dark through amber and crimson: compression. 256 colours.
pub fn compression() -> &'static [Rgb] {
    static COLOURS: LazyLock<Vec<Rgb>> = LazyLock::new(|| sample(warm));
    &COLOURS
}

/// From dark blue to neutral: tension, the most negative value first. 256 colours.
pub fn tension() -> &'static [Rgb] {
    static COLOURS: LazyLock<Vec<Rgb>> = LazyLock::new(|| {
        let mut colours = sample(cool);
        colours.reverse();
        colours
    });
    &COLOURS
}

/// From tension over neutral to compression. 511 colours, neutral in the middle.
pub fn signed() -> &'static [Rgb] {
    static COLOURS: LazyLock<Vec<Rgb>> =
        LazyLock::new(|| [tension(), &compression()[1..]].concat());
    &COLOURS
}

/// From dark violet over teal to pale yellow, higher values lighter: heights and gaps. 256 colours.
pub fn rising() -> &'static [Rgb] {
    static COLOURS: LazyLock<Vec<Rgb>> = LazyLock::new(|| sample(dark_to_light));
    &COLOURS
}

/// A colour as lightness, chroma and hue in degrees (CIELAB).
#[derive(Clone, Copy, Debug)]
struct Colour {
    lightness: f64,
    chroma: f64,
    hue: f64,
}

/// The branch of compression. Chroma rises steeply in both branches, so that a light pressure
/// differs visibly from none.
fn warm(fraction: f64) -> Colour {
    Colour {
        lightness: LIGHT + (DARK - LIGHT) * fraction,
        chroma: 30.0 * fraction + 160.0 * fraction.powf(0.7) * (1.0 - fraction),
        hue: 92.0 - 74.0 * fraction,
    }
}

/// The branch of tension.
fn cool(fraction: f64) -> Colour {
    Colour {
        lightness: LIGHT + (DARK - LIGHT) * fraction,
        chroma: 34.0 * fraction + 60.0 * fraction.powf(0.65) * (1.0 - fraction),
        hue: 215.0 + 75.0 * fraction,
    }
}

/// The map of heights.
fn dark_to_light(fraction: f64) -> Colour {
    Colour {
        lightness: DARK + (LIGHT - DARK) * fraction,
        // The gamut is narrow at teal and wider at green and yellow.
        chroma: 23.0
            + 16.0 * (1.0 - fraction).powi(4)
            + 480.0 * fraction.powi(6) * (1.0 - fraction),
        hue: 305.0 - 205.0 * fraction,
    }
}

fn sample(path: fn(f64) -> Colour) -> Vec<Rgb> {
    (0..=STEPS)
        .map(|step| nearest_rgb(path(step as f64 / STEPS as f64)))
        .collect()
}

/// The 8-bit colour near `colour` whose lightness is closest to the requested one.
///
/// Rounding each channel separately can shift L* by more than one step of the map and break its
/// order; one of the eight neighbours is always close.
fn nearest_rgb(colour: Colour) -> Rgb {
    let exact = encoded(into_gamut(colour)).map(|channel| channel * 255.0);
    let neighbours = (0..8u8).map(|corner| {
        std::array::from_fn(|channel| {
            let up = corner >> channel & 1 == 1;
            let value: f64 = exact[channel];
            (if up { value.ceil() } else { value.floor() }) as u8
        })
    });
    let distance = |rgb: &Rgb| (lightness(linear(*rgb)) - colour.lightness).abs();
    neighbours
        .min_by(|left, right| distance(left).total_cmp(&distance(right)))
        .expect("there are eight neighbours")
}

/// Linear red, green and blue of `colour`, with its chroma reduced until it fits the gamut.
fn into_gamut(colour: Colour) -> [f64; 3] {
    let at = |chroma: f64| to_linear(Colour { chroma, ..colour });
    let shown = |rgb: [f64; 3]| rgb.iter().all(|channel| (0.0..=1.0).contains(channel));
    let asked = at(colour.chroma);
    if shown(asked) {
        return asked;
    }
    let (mut low, mut high) = (0.0, colour.chroma);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if shown(at(middle)) {
            low = middle;
        } else {
            high = middle;
        }
    }
    at(low).map(|channel| channel.clamp(0.0, 1.0))
}

/// White point of D65, Y = 1.
const WHITE: [f64; 3] = [0.950_47, 1.0, 1.088_83];

/// CIELAB to linear sRGB (CIE 15:2004 for L*a*b*, IEC 61966-2-1 for the primaries).
fn to_linear(colour: Colour) -> [f64; 3] {
    let angle = colour.hue.to_radians();
    let y = (colour.lightness + 16.0) / 116.0;
    let x = y + colour.chroma * angle.cos() / 500.0;
    let z = y - colour.chroma * angle.sin() / 200.0;
    let inverse = |value: f64| {
        if value > 6.0 / 29.0 {
            value.powi(3)
        } else {
            3.0 * (6.0f64 / 29.0).powi(2) * (value - 4.0 / 29.0)
        }
    };
    let [x, y, z] = [
        WHITE[0] * inverse(x),
        WHITE[1] * inverse(y),
        WHITE[2] * inverse(z),
    ];
    [
        3.240_454_2 * x - 1.537_138_5 * y - 0.498_531_4 * z,
        -0.969_266_0 * x + 1.876_010_8 * y + 0.041_556_0 * z,
        0.055_643_4 * x - 0.204_025_9 * y + 1.057_225_2 * z,
    ]
}

/// The transfer curve of sRGB, linear to encoded.
fn encoded(linear: [f64; 3]) -> [f64; 3] {
    linear.map(|channel| {
        if channel <= 0.003_130_8 {
            12.92 * channel
        } else {
            1.055 * channel.powf(1.0 / 2.4) - 0.055
        }
    })
}

/// Its inverse, from 8 bits.
fn linear(rgb: Rgb) -> [f64; 3] {
    rgb.map(|channel| {
        let channel = f64::from(channel) / 255.0;
        if channel <= 0.040_45 {
            channel / 12.92
        } else {
            ((channel + 0.055) / 1.055).powf(2.4)
        }
    })
}

/// CIE L* of a linear sRGB colour.
fn lightness(linear: [f64; 3]) -> f64 {
    let y = 0.212_672_9 * linear[0] + 0.715_152_2 * linear[1] + 0.072_175_0 * linear[2];
    if y > (6.0f64 / 29.0).powi(3) {
        116.0 * y.cbrt() - 16.0
    } else {
        (29.0f64 / 3.0).powi(3) * y
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    /// Machado, Oliveira & Fernandes 2009, doi:10.1109/TVCG.2009.113, severity 1, on linear sRGB.
    const DEUTERANOPIA: [[f64; 3]; 3] = [
        [0.367_322, 0.860_646, -0.227_968],
        [0.280_085, 0.672_501, 0.047_413],
        [-0.011_820, 0.042_940, 0.968_881],
    ];
    const PROTANOPIA: [[f64; 3]; 3] = [
        [0.152_286, 1.052_583, -0.204_868],
        [0.114_503, 0.786_281, 0.099_216],
        [-0.003_882, -0.048_116, 1.051_998],
    ];

    fn seen(linear: [f64; 3], eye: [[f64; 3]; 3]) -> [f64; 3] {
        eye.map(|row| {
            let sum: f64 = row
                .iter()
                .zip(linear)
                .map(|(weight, channel)| weight * channel)
                .sum();
            sum.clamp(0.0, 1.0)
        })
    }

    fn falls(values: &[f64]) -> bool {
        values.windows(2).all(|pair| pair[0] > pair[1])
    }

    #[test]
    fn lightness_orders_every_map() {
        let of = |colours: &[Rgb]| -> Vec<f64> {
            colours.iter().map(|rgb| lightness(linear(*rgb))).collect()
        };
        assert!(falls(&of(compression())));
        let mut rising_lightness = of(rising());
        rising_lightness.reverse();
        assert!(falls(&rising_lightness));
        let mut tension_lightness = of(tension());
        tension_lightness.reverse();
        assert!(falls(&tension_lightness));
        assert!(of(compression())[0] > 95.0 && of(compression())[STEPS] < 17.0);
    }

    #[test]
    fn maps_are_ordered_for_colour_blind_eyes() {
        for eye in [DEUTERANOPIA, PROTANOPIA] {
            for path in [warm, cool, |fraction| dark_to_light(1.0 - fraction)] {
                let exact: Vec<f64> = (0..=STEPS)
                    .map(|step| {
                        let colour = path(step as f64 / STEPS as f64);
                        lightness(seen(into_gamut(colour), eye))
                    })
                    .collect();
                assert!(falls(&exact));
                assert!(exact[0] - exact[STEPS] > 70.0);
            }
        }
    }

    #[test]
    fn the_arms_stay_apart_for_colour_blind_eyes() {
        // Blue against yellow remains visible to those eyes: the excess of the blue channel changes
        // sign.
        for eye in [DEUTERANOPIA, PROTANOPIA] {
            for step in (STEPS / 4)..=STEPS {
                let excess = |path: fn(f64) -> Colour| {
                    let [red, _, blue] =
                        encoded(seen(into_gamut(path(step as f64 / STEPS as f64)), eye));
                    blue - red
                };
                assert!(excess(cool) > 0.1 && excess(warm) < 0.0, "step {step}");
            }
        }
    }

    #[test]
    fn every_colour_stands_for_one_value_and_fits_the_screen() {
        for colours in [compression(), tension(), signed(), rising()] {
            let distinct: HashSet<&Rgb> = colours.iter().collect();
            assert_eq!(distinct.len(), colours.len());
        }
        for path in [warm, cool, dark_to_light] {
            for step in 0..=STEPS {
                let asked = to_linear(path(step as f64 / STEPS as f64));
                assert_eq!(
                    asked,
                    into_gamut(path(step as f64 / STEPS as f64)),
                    "step {step} is out of gamut"
                );
            }
        }
        assert_eq!(signed().len(), 2 * STEPS + 1);
        assert_eq!(signed()[STEPS], compression()[0]);
        assert_eq!(signed()[STEPS], tension()[STEPS]);
    }
}
