//! Charts as a PNG: lines and dots with smooth edges on the white page of the pictures.

use std::io;

use image::RgbImage;
use noto_sans_mono_bitmap::{FontWeight, RasterHeight};

use super::super::canvas::{self, Font, WHITE, printable};
use super::super::palette::Rgb;
use super::super::pen::{LONGEST_DASHED, Pen};
use super::super::png_text::{software, with_texts};
use super::{Anchor, Chart, DASHES, Ink, Mark, Panel};

/// Size of one chart, pixels.
const SIZE: [u32; 2] = [960, 720];
/// Height of the title's strip.
const TITLE: u32 = 44;
/// White space around everything.
const MARGIN: u32 = 16;
/// What is left of a dash below this is rounding, pixels: less would not move along a line.
const ROUNDING: f64 = 1e-6;

/// Charts side by side under a title.
pub(super) fn png(title: Option<&str>, charts: &[Chart]) -> io::Result<Vec<u8>> {
    let [width, height] = SIZE;
    let strip = if title.is_some() { TITLE } else { 0 };
    let page_width = 2 * MARGIN + width * charts.len() as u32;
    let mut page = RgbImage::from_pixel(page_width, 2 * MARGIN + strip + height, image::Rgb(WHITE));
    if let Some(title) = title {
        let font = font(true, RasterHeight::Size24);
        let title = canvas::cut(title, font, page_width - 2 * MARGIN);
        canvas::say(&mut page, font, canvas::INK, [MARGIN + 5, MARGIN], &title);
    }
    let regular = font(false, RasterHeight::Size20);
    let panel = Panel {
        size: SIZE.map(f64::from),
        advance: f64::from(regular.advance()),
        line: f64::from(regular.height()) + 4.0,
        stroke: 3.0,
    };
    for (index, chart) in charts.iter().enumerate() {
        let corner = [
            f64::from(MARGIN + index as u32 * width),
            f64::from(MARGIN + strip),
        ];
        for mark in chart.marks(&panel) {
            draw(&mut page, corner, &mark);
        }
    }
    Ok(with_texts(&canvas::png(&page)?, &[software()]))
}

fn font(bold: bool, size: RasterHeight) -> Font {
    Font {
        weight: match bold {
            true => FontWeight::Bold,
            false => FontWeight::Regular,
        },
        size,
    }
}

/// Dark for loading and light for unloading, so that grey keeps them apart as the dashes do.
fn colour(ink: Ink) -> Rgb {
    match ink {
        Ink::Grid => [228, 228, 232],
        Ink::Zero => [170, 170, 176],
        Ink::Frame => [90, 90, 96],
        Ink::Loading => [24, 66, 140],
        Ink::Unloading => [216, 118, 24],
    }
}

fn draw(page: &mut RgbImage, corner: [f64; 2], mark: &Mark) {
    let moved = |at: &[f64; 2]| [at[0] + corner[0], at[1] + corner[1]];
    match mark {
        Mark::Line {
            points,
            ink,
            width,
            dashed,
        } => {
            let points: Vec<[f64; 2]> = points.iter().map(moved).collect();
            let pieces = match dashed {
                true => dashes(&points, DASHES.map(|length| length * width)),
                false => points.windows(2).map(|pair| [pair[0], pair[1]]).collect(),
            };
            for [from, to] in pieces {
                stroke(page, from, to, 0.5 * width, colour(*ink));
            }
        }
        Mark::Dot {
            at,
            radius,
            ink,
            filled,
        } => {
            let at = moved(at);
            stroke(page, at, at, *radius, colour(*ink));
            if !filled {
                stroke(page, at, at, 0.55 * radius, WHITE);
            }
        }
        Mark::Text {
            at,
            text,
            anchor,
            bold,
        } => {
            let [x, y] = moved(at);
            let font = font(*bold, RasterHeight::Size20);
            let text = printable(text);
            let width = f64::from(font.width(&text));
            let left = match anchor {
                Anchor::Start => x,
                Anchor::Middle => x - 0.5 * width,
                Anchor::End => x - width,
            };
            let top = y - 0.5 * f64::from(font.height());
            let place = [left, top].map(|at| at.round().max(0.0) as u32);
            canvas::say(page, font, canvas::INK, place, &text);
        }
    }
}

/// A polyline in dashes, whose lengths run on around its corners.
fn dashes(points: &[[f64; 2]], [dash, space]: [f64; 2]) -> Vec<[[f64; 2]; 2]> {
    let mut pieces = Vec::new();
    // Length left of the present dash or space.
    let (mut drawing, mut left) = (true, dash);
    for pair in points.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        let length = (to[0] - from[0]).hypot(to[1] - from[1]);
        let at = |way: f64| {
            let share = way / length;
            [
                from[0] + share * (to[0] - from[0]),
                from[1] + share * (to[1] - from[1]),
            ]
        };
        if length > LONGEST_DASHED {
            pieces.push([from, to]);
            continue;
        }
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

/// Draws a line with round ends; a dot is a line of no length. The corners of pixels are at whole numbers.
fn stroke(page: &mut RgbImage, from: [f64; 2], to: [f64; 2], radius: f64, colour: Rgb) {
    let [from, to] = [from, to].map(|place| place.map(|at| at - 0.5));
    Pen::new(page, colour).stroke(from, to, 2.0 * radius);
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
        // Lengths that leave rounding dust behind end as well: a long line of odd corners.
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
        // Nor is a line walked along whose end is off all pages.
        for end in [1e9, f64::INFINITY, f64::NAN] {
            let pieces = dashes(&[[0.0, 0.0], [end, 0.0]], [1.2, 0.9]);
            assert!(pieces.len() <= 1, "{end}");
        }
    }

    #[test]
    fn lines_cover_their_area() {
        // A level line of width 4 and length 20 between pixel corners covers 80 pixels and a disc's worth.
        let mut page = RgbImage::from_pixel(60, 20, image::Rgb(WHITE));
        stroke(&mut page, [20.0, 10.0], [40.0, 10.0], 2.0, [0, 0, 0]);
        let covered: f64 = page.pixels().map(|p| 1.0 - f64::from(p.0[0]) / 255.0).sum();
        let expected = 80.0 + std::f64::consts::PI * 4.0;
        // The ends' edge is a linear ramp over curved pixels: off by less than a pixel a side.
        assert!((covered - expected).abs() < 2.0, "{covered} {expected}");
    }

    #[test]
    fn the_two_directions_differ_in_grey() {
        let grey = |rgb: Rgb| {
            0.299 * f64::from(rgb[0]) + 0.587 * f64::from(rgb[1]) + 0.114 * f64::from(rgb[2])
        };
        let difference = grey(colour(Ink::Unloading)) - grey(colour(Ink::Loading));
        assert!(difference > 60.0, "{difference} of 255");
    }
}
