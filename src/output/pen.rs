//! Lines and marks with smooth edges. The middle of a pixel is at whole numbers.

use image::RgbImage;

use super::palette::Rgb;

/// Width of a line, pixels.
const WIDTH: f64 = 2.0;
/// Length of a dash and of the space after it, pixels.
const DASH: [f64; 2] = [7.0, 5.0];
/// Longest line that is dashed, far more than a page: a place off all pages is no end of a line to walk to.
pub(super) const LONGEST_DASHED: f64 = 1e5;
/// Half the size of a mark, pixels.
const MARK: f64 = 4.5;

/// Draws in one colour on a page.
pub(crate) struct Pen<'a> {
    page: &'a mut RgbImage,
    colour: Rgb,
}

impl<'a> Pen<'a> {
    pub fn new(page: &'a mut RgbImage, colour: Rgb) -> Self {
        Pen { page, colour }
    }

    /// A straight line.
    pub fn line(&mut self, from: [f64; 2], to: [f64; 2], dashed: bool) {
        let along = [to[0] - from[0], to[1] - from[1]];
        let length = along[0].hypot(along[1]);
        if !dashed || length > LONGEST_DASHED {
            self.stroke(from, to, WIDTH);
            return;
        }
        let at = |place: f64| {
            let share = (place / length).min(1.0);
            [from[0] + share * along[0], from[1] + share * along[1]]
        };
        let mut place = 0.0;
        while place < length {
            self.stroke(at(place), at(place + DASH[0]), WIDTH);
            place += DASH[0] + DASH[1];
        }
    }

    /// A line of some width with round ends; a disc where it has no length.
    pub fn stroke(&mut self, from: [f64; 2], to: [f64; 2], width: f64) {
        let along = [to[0] - from[0], to[1] - from[1]];
        let square = along[0] * along[0] + along[1] * along[1];
        self.blend(from, to, 0.5 * width + 1.0, |at| {
            let off = [at[0] - from[0], at[1] - from[1]];
            let share = if square > 0.0 {
                ((off[0] * along[0] + off[1] * along[1]) / square).clamp(0.0, 1.0)
            } else {
                0.0
            };
            (off[0] - share * along[0]).hypot(off[1] - share * along[1]) - 0.5 * width
        });
    }

    /// A mark: disc, square, diamond or triangle by the number of its curve.
    pub fn mark(&mut self, centre: [f64; 2], number: usize, hollow: bool) {
        self.blend(centre, centre, MARK + 2.0, |at| {
            let (x, y) = (at[0] - centre[0], at[1] - centre[1]);
            let outside = match number % 4 {
                0 => x.hypot(y) - MARK,
                1 => x.abs().max(y.abs()) - 0.9 * MARK,
                2 => (x.abs() + y.abs() - 1.3 * MARK) / 2f64.sqrt(),
                _ => (0.87 * x.abs() - 0.5 * y - 0.62 * MARK).max(y - 0.9 * MARK),
            };
            // A hollow mark is a rim.
            if hollow {
                (outside + 0.8).abs() - 0.8
            } else {
                outside
            }
        });
    }

    /// Covers the pixels where `distance` to the shape's edge, negative inside, is below half.
    fn blend(
        &mut self,
        from: [f64; 2],
        to: [f64; 2],
        reach: f64,
        distance: impl Fn([f64; 2]) -> f64,
    ) {
        let range = |axis: usize, size: u32| {
            let low = (from[axis].min(to[axis]) - reach).floor().max(0.0) as u32;
            let high = (from[axis].max(to[axis]) + reach).ceil().max(0.0) as u32;
            low..high.saturating_add(1).min(size)
        };
        let (width, height) = self.page.dimensions();
        for y in range(1, height) {
            for x in range(0, width) {
                let coverage = (0.5 - distance([f64::from(x), f64::from(y)])).clamp(0.0, 1.0);
                if coverage > 0.0 {
                    let pixel = self.page.get_pixel_mut(x, y);
                    for (channel, ink) in pixel.0.iter_mut().zip(self.colour) {
                        let mixed =
                            f64::from(ink) * coverage + f64::from(*channel) * (1.0 - coverage);
                        *channel = mixed.round() as u8;
                    }
                }
            }
        }
    }
}
