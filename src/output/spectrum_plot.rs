//! A power spectral density over the wave number as a PNG, both axes logarithmic.

use std::path::Path;

use image::RgbImage;

use super::canvas::{self, FRAME, HEADING, INK, QUIET_INK, TEXT, WHITE, say};
use super::error::OutputError;
use super::folder::write_atomically;
use super::layout::Rect;
use super::palette::{self, Rgb};
use super::pen::Pen;
use super::png_text::{software, with_texts};

/// Size of the page, pixels.
const PAGE: [u32; 2] = [900, 660];
/// Position of the axes.
const AXES: Rect = Rect {
    x: 110,
    y: 92,
    width: 760,
    height: 490,
};
/// Most decades below the greatest density: lower values are rounding.
const DEEPEST: f64 = 16.0;
/// Half the side of a point's mark, pixels.
const MARK: u32 = 3;
/// Ticks of an axis, at most.
const MOST_TICKS: i32 = 8;
/// The grid lines behind the points.
const LATTICE: Rgb = [228, 228, 231];

/// Contents of the plot.
#[derive(Clone, Copy, Debug)]
pub struct SpectrumPlot<'a> {
    /// Its title.
    pub title: &'a str,
    /// Wave number (1/m) and density (m^4) of the rings, all positive.
    pub points: &'a [[f64; 2]],
    /// The same for a fitted line; empty for none.
    pub line: &'a [[f64; 2]],
}

impl SpectrumPlot<'_> {
    /// Draws the plot.
    pub fn draw(&self) -> RgbImage {
        let mut page = RgbImage::from_pixel(PAGE[0], PAGE[1], image::Rgb(WHITE));
        let title = canvas::cut(self.title, HEADING, PAGE[0] - AXES.x);
        say(&mut page, HEADING, INK, [AXES.x, 24], &title);
        let axis = "power spectral density [m^4] over wave number [1/m]";
        say(&mut page, TEXT, INK, [AXES.x, 54], axis);
        let axes = Axes::for_points(self.points, self.line);
        for (axis, ends) in axes.ends.iter().enumerate() {
            draw_ticks(&mut page, &axes, axis, *ends);
        }
        let line = palette::compression()[150];
        for pair in self.line.windows(2) {
            if let [Some(from), Some(to)] = [pair[0], pair[1]].map(|point| axes.place(point)) {
                Pen::new(&mut page, line).line(from.map(f64::from), to.map(f64::from), false);
            }
        }
        let mark = palette::rising()[70];
        for point in self.points {
            let Some([x, y]) = axes.place(*point) else {
                continue;
            };
            let side = 2 * MARK + 1;
            let square = Rect {
                x: x - MARK,
                y: y - MARK,
                width: side,
                height: side,
            };
            canvas::fill(&mut page, square, mark);
        }
        canvas::frame(&mut page, AXES, FRAME);
        let legend = [
            ("map, averaged over directions", mark),
            ("self-affine fit", line),
        ];
        let shown = if self.line.is_empty() { 1 } else { 2 };
        for (row, (words, colour)) in (0..).zip(legend.into_iter().take(shown)) {
            let y = AXES.bottom() - 56 + 22 * row;
            let sample = Rect {
                x: AXES.x + 18,
                y: y + 5,
                width: 18,
                height: 5,
            };
            canvas::fill(&mut page, sample, colour);
            say(&mut page, TEXT, INK, [AXES.x + 48, y], words);
        }
        page
    }

    /// Draws the plot and writes it to `path`, whole or not at all.
    ///
    /// # Errors
    /// What the system says.
    pub fn write(&self, path: &Path) -> Result<(), OutputError> {
        let page = self.draw();
        let png = canvas::png(&page).map_err(OutputError::write("write", path))?;
        let texts = [software(), ("Title", self.title.to_owned())];
        write_atomically(path, &with_texts(&png, &texts))
    }
}

/// Decimal logarithms at the ends of both axes.
struct Axes {
    ends: [[f64; 2]; 2],
}

impl Axes {
    /// Axes that contain all points except those far below the greatest.
    fn for_points(points: &[[f64; 2]], line: &[[f64; 2]]) -> Axes {
        let ends = [0, 1].map(|axis| {
            let logarithms = points.iter().chain(line).map(|point| point[axis].log10());
            let finite = logarithms.filter(|value| value.is_finite());
            let (least, greatest) = finite
                .fold((f64::INFINITY, f64::NEG_INFINITY), |ends, value| {
                    (ends.0.min(value), ends.1.max(value))
                });
            if least > greatest {
                return [-1.0, 1.0];
            }
            let least = if axis == 1 {
                least.max(greatest - DEEPEST)
            } else {
                least
            };
            let margin = 0.04 * (greatest - least).max(1.0);
            [least - margin, greatest + margin]
        });
        Axes { ends }
    }

    /// Position along an axis, from 0 to 1.
    fn share(&self, axis: usize, logarithm: f64) -> f64 {
        let [low, high] = self.ends[axis];
        (logarithm - low) / (high - low)
    }

    /// The pixel of a point; `None` outside the axes.
    fn place(&self, point: [f64; 2]) -> Option<[u32; 2]> {
        let [x, y] = [0, 1].map(|axis| self.share(axis, point[axis].log10()));
        let inside = |share: f64| (0.0..=1.0).contains(&share);
        (inside(x) && inside(y)).then(|| {
            [
                AXES.x + (x * f64::from(AXES.width - 1)).round() as u32,
                AXES.y + ((1.0 - y) * f64::from(AXES.height - 1)).round() as u32,
            ]
        })
    }
}

/// Lines and labels at powers of ten, as many as fit.
fn draw_ticks(page: &mut RgbImage, axes: &Axes, axis: usize, [low, high]: [f64; 2]) {
    let (first, last) = (low.ceil() as i32, high.floor() as i32);
    let every = ((last - first) / MOST_TICKS + 1).max(1);
    for power in (first..=last).filter(|power| power.rem_euclid(every) == 0) {
        let share = axes.share(axis, f64::from(power));
        let label = format!("1e{power}");
        if axis == 0 {
            let x = AXES.x + (share * f64::from(AXES.width - 1)).round() as u32;
            let line = Rect {
                x,
                width: 1,
                ..AXES
            };
            canvas::fill(page, line, LATTICE);
            let left = x.saturating_sub(TEXT.width(&label) / 2);
            say(page, TEXT, QUIET_INK, [left, AXES.bottom() + 10], &label);
        } else {
            let y = AXES.y + ((1.0 - share) * f64::from(AXES.height - 1)).round() as u32;
            let line = Rect {
                y,
                height: 1,
                ..AXES
            };
            canvas::fill(page, line, LATTICE);
            let left = AXES.x.saturating_sub(TEXT.width(&label) + 10);
            let top = y.saturating_sub(TEXT.height() / 2);
            say(page, TEXT, QUIET_INK, [left, top], &label);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_lie_where_their_logarithms_say() {
        let points = [[1e5, 1e-30], [1e6, 1e-32], [1e7, 1e-34]];
        let axes = Axes::for_points(&points, &[]);
        let [low, middle, high] = points.map(|point| axes.place(point).unwrap());
        // The middle one is the mean of the others in both logarithms, to the nearest pixel.
        assert!(middle[0].abs_diff((low[0] + high[0]) / 2) <= 1);
        assert!(middle[1].abs_diff((low[1] + high[1]) / 2) <= 1);
        assert!(low[1] > high[1].min(middle[1]) || low[1] < high[1]);
        let page = SpectrumPlot {
            title: "t",
            points: &points,
            line: &[],
        }
        .draw();
        for place in [low, middle, high] {
            assert_eq!(page.get_pixel(place[0], place[1]).0, palette::rising()[70]);
        }
    }

    #[test]
    fn an_empty_plot_can_be_drawn() {
        for points in [
            &[][..],
            &[[1.0, 1.0]][..],
            &[[1e-300, 1e300], [1e300, 1e-300]][..],
        ] {
            let plot = SpectrumPlot {
                title: "",
                points,
                line: points,
            };
            assert_eq!(plot.draw().dimensions(), (PAGE[0], PAGE[1]));
        }
    }
}
