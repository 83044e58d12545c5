//! Renders a figure on a page of pixels: antialiased lines and marks, and the text of the pictures.

use image::RgbImage;
use noto_sans_mono_bitmap::FontWeight;

use super::super::canvas::{self, FRAME, Font, INK, QUIET_INK, WHITE, printable};
use super::super::palette::Rgb;
use super::drawing::{Anchor, Drawing, Face, Ink, Mark};
use super::{Figure, Shape};

/// Length of a dash and of the space after it, in widths of the line.
pub(super) const DASHES: [f64; 2] = [3.5, 2.5];
/// A shorter remainder of a dash is rounding, pixels, and would not advance along a line.
const ROUNDING: f64 = 1e-6;
/// Half the width of the ring of a hollow mark, pixels.
const RING: f64 = 0.8;

/// The figure on its page.
pub(super) fn page(figure: &Figure) -> RgbImage {
    let Drawing { size, marks } = Drawing::new(figure);
    let mut page = RgbImage::from_pixel(size[0], size[1], image::Rgb(WHITE));
    for mark in &marks {
        draw(&mut page, figure, mark);
    }
    page
}

fn colour(figure: &Figure, ink: Ink) -> Rgb {
    match ink {
        Ink::Grid => [232, 232, 236],
        Ink::Zero => [170, 170, 176],
        Ink::Frame => FRAME,
        Ink::Text => INK,
        Ink::Quiet => QUIET_INK,
        Ink::Curve(name) => figure.pen(name).colour,
    }
}

fn draw(page: &mut RgbImage, figure: &Figure, mark: &Mark) {
    match mark {
        Mark::Line {
            points,
            ink,
            width,
            dashed,
        } => {
            let pieces = if *dashed {
                dashes(points, DASHES.map(|length| length * width))
            } else {
                points.windows(2).map(|pair| [pair[0], pair[1]]).collect()
            };
            for [from, to] in pieces {
                stroke(page, from, to, *width, colour(figure, *ink));
            }
        }
        Mark::Symbol { at, name, hollow } => {
            let pen = figure.pen(*name);
            let size = figure.style.mark;
            let outside = |place: [f64; 2]| {
                let (x, y) = (place[0] - at[0], place[1] - at[1]);
                match pen.shape {
                    Shape::Disc => x.hypot(y) - size,
                    Shape::Square => x.abs().max(y.abs()) - 0.9 * size,
                    Shape::Diamond => (x.abs() + y.abs() - 1.3 * size) / 2f64.sqrt(),
                    Shape::Triangle => (0.87 * x.abs() - 0.5 * y - 0.62 * size).max(y - 0.9 * size),
                }
            };
            let reach = size + 2.0;
            if *hollow {
                blend(page, [*at; 2], reach, WHITE, outside);
                let ring = |place| (outside(place) + RING).abs() - RING;
                blend(page, [*at; 2], reach, pen.colour, ring);
            } else {
                blend(page, [*at; 2], reach, pen.colour, outside);
            }
        }
        Mark::Text {
            at: [x, y],
            text,
            anchor,
            face,
            ink,
        } => {
            let font = match face {
                Face::Text => figure.style.text,
                Face::Bold => Font {
                    weight: FontWeight::Bold,
                    ..figure.style.text
                },
                Face::Heading => figure.style.heading,
            };
            let text = printable(text);
            let width = f64::from(font.width(&text));
            let left = match anchor {
                Anchor::Start => *x,
                Anchor::Middle => x - 0.5 * width,
                Anchor::End => x - width,
            };
            let top = y - 0.5 * f64::from(font.height());
            let corner = [left, top].map(|at| at.round().max(0.0) as u32);
            canvas::say(page, font, colour(figure, *ink), corner, &text);
        }
    }
}

/// Divides a polyline into dashes that continue around its corners.
fn dashes(points: &[[f64; 2]], [dash, space]: [f64; 2]) -> Vec<[[f64; 2]; 2]> {
    let mut pieces = Vec::new();
    // Length left of the current dash or space.
    let (mut drawing, mut left) = (true, dash);
    for pair in points.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        let length = (to[0] - from[0]).hypot(to[1] - from[1]);
        let at = |way: f64| [0, 1].map(|axis| from[axis] + way / length * (to[axis] - from[axis]));
        let mut way = 0.0;
        while way < length {
            let next = (way + left).min(length);
            if drawing {
                pieces.push([at(way), at(next)]);
            }
            left -= next - way;
            way = next;
            if left <= ROUNDING {
                drawing = !drawing;
                left = if drawing { dash } else { space };
            }
        }
    }
    pieces
}

/// Draws a line of some width with round ends.
fn stroke(page: &mut RgbImage, from: [f64; 2], to: [f64; 2], width: f64, colour: Rgb) {
    let along = [to[0] - from[0], to[1] - from[1]];
    let square = along[0] * along[0] + along[1] * along[1];
    blend(page, [from, to], 0.5 * width + 1.0, colour, |at| {
        let off = [at[0] - from[0], at[1] - from[1]];
        let share = if square > 0.0 {
            ((off[0] * along[0] + off[1] * along[1]) / square).clamp(0.0, 1.0)
        } else {
            0.0
        };
        (off[0] - share * along[0]).hypot(off[1] - share * along[1]) - 0.5 * width
    });
}

/// Colours the pixels within `reach` of a line whose signed `distance` to the shape's edge, negative inside, is below
/// half.
fn blend(
    page: &mut RgbImage,
    [from, to]: [[f64; 2]; 2],
    reach: f64,
    colour: Rgb,
    distance: impl Fn([f64; 2]) -> f64,
) {
    let range = |axis: usize, size: u32| {
        let low = (from[axis].min(to[axis]) - reach).floor().max(0.0) as u32;
        let high = (from[axis].max(to[axis]) + reach).ceil().max(0.0) as u32;
        low..high.saturating_add(1).min(size)
    };
    let (width, height) = page.dimensions();
    for y in range(1, height) {
        for x in range(0, width) {
            let coverage = (0.5 - distance([f64::from(x), f64::from(y)])).clamp(0.0, 1.0);
            if coverage > 0.0 {
                let pixel = page.get_pixel_mut(x, y);
                for (channel, ink) in pixel.0.iter_mut().zip(colour) {
                    let mixed = f64::from(ink) * coverage + f64::from(*channel) * (1.0 - coverage);
                    *channel = mixed.round() as u8;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dashes_cover_their_share_and_turn_corners() {
        let points = [[0.0, 0.0], [35.0, 0.0], [35.0, 35.0]];
        let pieces = dashes(&points, [4.0, 3.0]);
        let drawn: f64 = pieces
            .iter()
            .map(|[a, b]| (b[0] - a[0]).hypot(b[1] - a[1]))
            .sum();
        assert!((drawn - 40.0).abs() < 1e-9, "{drawn}");
        // Dash lengths that accumulate rounding errors also terminate: a long line with odd
        // corners.
        let points: Vec<[f64; 2]> = (0..3000)
            .map(|k| [f64::from(k) * 0.1, f64::from(k * k % 97) * 0.1])
            .collect();
        let way: f64 = points
            .windows(2)
            .map(|pair| (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]))
            .sum();
        let pieces = dashes(&points, [1.2, 0.9]);
        // A dash in 2.1 of length, and at most one corner more each.
        assert!((pieces.len() as f64) < way / 2.1 + 3001.0);
    }

    #[test]
    fn lines_cover_their_area() {
        // A horizontal line of width 4 and length 20 covers 80 pixels plus a disc.
        let mut page = RgbImage::from_pixel(60, 20, image::Rgb(WHITE));
        stroke(&mut page, [19.5, 9.5], [39.5, 9.5], 4.0, [0, 0, 0]);
        let covered: f64 = page.pixels().map(|p| 1.0 - f64::from(p.0[0]) / 255.0).sum();
        let expected = 80.0 + std::f64::consts::PI * 4.0;
        // The edge of the round ends is a linear ramp over curved pixels: off by less than a pixel
        // a side.
        assert!((covered - expected).abs() < 2.0, "{covered} {expected}");
    }
}
