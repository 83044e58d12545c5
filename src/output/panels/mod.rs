//! Plots of several curves in several panels, as one PNG. Curves share names, colours and marks
//! over all panels, with one legend above them.

mod axis;

use std::path::Path;

use image::RgbImage;

use super::canvas::{self, BOLD, FRAME, Font, HEADING, INK, QUIET_INK, TEXT, WHITE};
use super::canvas::{cut, printable, say};
use super::error::OutputError;
use super::folder::write_atomically;
use super::layout::Rect;
use super::palette::Rgb;
use super::pen::Pen;
pub use axis::Axis;
use axis::Scale;

/// Size of the frame of a panel, pixels.
const FRAME_SIZE: [u32; 2] = [400, 280];
/// Space left of a frame for numbers, and below it for numbers and the axis label.
const ROOM: [u32; 2] = [92, 62];
/// White space around everything.
const MARGIN: u32 = 24;
/// Lines of the grid behind the curves.
const GRID: Rgb = [232, 232, 236];
/// Colours of curves, distinct in lightness as well as in hue; marks differ too.
const COLOURS: [Rgb; 10] = [
    [28, 28, 30],
    [0, 104, 190],
    [214, 74, 0],
    [0, 140, 105],
    [160, 60, 150],
    [196, 150, 0],
    [90, 170, 225],
    [130, 130, 134],
    [128, 84, 40],
    [205, 30, 60],
];

/// A point of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlotPoint {
    /// Value along the horizontal axis, SI.
    pub x: f64,
    /// Value along the vertical axis, SI.
    pub y: f64,
    /// Drawn hollow with a dashed line to it: the curve is not reliable here.
    pub hollow: bool,
}

/// A curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Index into the figure's names.
    pub name: usize,
    /// Its points, in the order in which a line joins them. Points that are not finite, or not
    /// positive on a logarithmic axis, are left out.
    pub points: Vec<PlotPoint>,
    /// Whether a line joins the points.
    pub line: bool,
    /// Whether each point is marked.
    pub marks: bool,
}

/// One frame with its curves.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// Title.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// Its curves.
    pub series: Vec<Series>,
}

/// A figure: panels side by side and in rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Title of the figure.
    pub title: String,
    /// A second line in grey.
    pub note: String,
    /// Names of the curves, at most as many as there are colours (10); others share a colour. An
    /// empty name keeps its colour and has no legend entry.
    pub names: Vec<String>,
    /// The panels, row by row.
    pub panels: Vec<Panel>,
    /// Panels in a row.
    pub columns: usize,
}

impl Figure {
    /// Draws the figure.
    pub fn draw(&self) -> RgbImage {
        let columns = self.columns.clamp(1, self.panels.len().max(1)) as u32;
        let rows = (self.panels.len() as u32).div_ceil(columns);
        let line = TEXT.height() + 6;
        let cell = [
            FRAME_SIZE[0] + ROOM[0] + MARGIN,
            FRAME_SIZE[1] + ROOM[1] + line + MARGIN,
        ];
        let width = columns * cell[0] + MARGIN;
        let entries = self.legend(width);
        let legend_lines = entries.last().map_or(0, |entry| entry.2 + 1);
        let head = MARGIN + HEADING.height() + 6 + line + legend_lines * line + 10;
        let mut page = RgbImage::from_pixel(width, head + rows * cell[1], image::Rgb(WHITE));
        let fit = |text: &str, font: Font| cut(text, font, width - 2 * MARGIN);
        say(
            &mut page,
            HEADING,
            INK,
            [MARGIN, MARGIN],
            &fit(&self.title, HEADING),
        );
        let second = MARGIN + HEADING.height() + 6;
        say(
            &mut page,
            TEXT,
            QUIET_INK,
            [MARGIN, second],
            &fit(&self.note, TEXT),
        );
        for (index, x, row, name) in &entries {
            let index = *index;
            let y = second + line + row * line;
            let middle = f64::from(y + TEXT.height() / 2);
            let mut pen = Pen::new(&mut page, colour(index));
            let at = |shift: u32| [f64::from(x + shift), middle];
            pen.line(at(0), at(28), false);
            pen.mark(at(14), index, false);
            say(&mut page, TEXT, INK, [x + 36, y], name);
        }
        for (index, panel) in self.panels.iter().enumerate() {
            let (column, row) = (index as u32 % columns, index as u32 / columns);
            let frame = Rect {
                x: MARGIN + column * cell[0] + ROOM[0],
                y: head + row * cell[1] + line,
                width: FRAME_SIZE[0],
                height: FRAME_SIZE[1],
            };
            draw_panel(&mut page, panel, frame);
        }
        page
    }

    /// Index, position and line of each legend entry.
    fn legend(&self, width: u32) -> Vec<(usize, u32, u32, String)> {
        let mut entries: Vec<(usize, u32, u32, String)> = Vec::new();
        let (mut x, mut row) = (MARGIN, 0);
        let given = self.names.iter().enumerate();
        for (index, name) in given.filter(|(_, name)| !name.is_empty()) {
            let name = printable(name);
            let wide = 36 + TEXT.width(&name) + 24;
            if x + wide > width && x > MARGIN {
                (x, row) = (MARGIN, row + 1);
            }
            entries.push((index, x, row, name));
            x += wide;
        }
        entries
    }

    /// Draws the figure and writes it to `path` as a PNG, in one piece.
    pub fn write(&self, path: &Path) -> Result<(), OutputError> {
        let page = self.draw();
        let png = canvas::png(&page).map_err(OutputError::write("write", path))?;
        write_atomically(path, &png)
    }
}

fn colour(name: usize) -> Rgb {
    COLOURS[name % COLOURS.len()]
}

fn draw_panel(page: &mut RgbImage, panel: &Panel, frame: Rect) {
    let values = |of: fn(&PlotPoint) -> f64| {
        let points = panel.series.iter().flat_map(|series| &series.points);
        points.map(of).collect::<Vec<f64>>()
    };
    let x = Scale::new(&panel.x, &values(|point| point.x));
    let y = Scale::new(&panel.y, &values(|point| point.y));
    let right = |share: f64| f64::from(frame.x) + share * f64::from(frame.width - 1);
    let down = |share: f64| f64::from(frame.y) + (1.0 - share) * f64::from(frame.height - 1);
    let title: String = printable(&panel.title).chars().take(56).collect();
    say(
        page,
        BOLD,
        INK,
        [frame.x, frame.y - TEXT.height() - 5],
        &title,
    );
    for (share, label) in x.ticks() {
        let place = right(share).round() as u32;
        let grid = Rect {
            x: place,
            width: 1,
            ..frame
        };
        canvas::fill(page, grid, GRID);
        let left = place.saturating_sub(TEXT.width(&label) / 2);
        say(page, TEXT, INK, [left, frame.bottom() + 6], &label);
    }
    for (share, label) in y.ticks() {
        let place = down(share).round() as u32;
        let grid = Rect {
            y: place,
            height: 1,
            ..frame
        };
        canvas::fill(page, grid, GRID);
        let left = frame.x.saturating_sub(TEXT.width(&label) + 8);
        let top = place.saturating_sub(TEXT.height() / 2);
        say(page, TEXT, INK, [left, top], &label);
    }
    canvas::frame(page, frame, FRAME);
    let label = x.label();
    let middle = frame.x + (frame.width.saturating_sub(TEXT.width(&label))) / 2;
    let below = frame.bottom() + TEXT.height() + 12;
    say(page, TEXT, QUIET_INK, [middle, below], &label);
    // The vertical axis is named by the title; its unit stands above the numbers.
    let unit = y.unit();
    let left = frame.x.saturating_sub(TEXT.width(unit) + 8);
    say(
        page,
        TEXT,
        QUIET_INK,
        [left, frame.y - TEXT.height() - 5],
        unit,
    );
    for series in &panel.series {
        let mut pen = Pen::new(page, colour(series.name));
        let mut before: Option<([f64; 2], bool)> = None;
        for point in &series.points {
            let shares = (x.share(point.x), y.share(point.y));
            let (Some(across), Some(up)) = shares else {
                before = None;
                continue;
            };
            let at = [right(across), down(up)];
            if let (true, Some((last, hollow))) = (series.line, before) {
                pen.line(last, at, hollow || point.hollow);
            }
            if series.marks {
                pen.mark(at, series.name, point.hollow);
            }
            before = Some((at, point.hollow));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figure(points: Vec<PlotPoint>, logarithmic: bool) -> Figure {
        let axis = |name: &str| Axis {
            name: name.into(),
            unit: "Pa".into(),
            logarithmic,
        };
        Figure {
            title: "A figure".into(),
            note: "of one curve".into(),
            names: vec!["one".into(), "two".into()],
            panels: vec![Panel {
                title: "pressure".into(),
                x: axis("load"),
                y: axis("pressure"),
                series: vec![Series {
                    name: 1,
                    points,
                    line: true,
                    marks: true,
                }],
            }],
            columns: 2,
        }
    }

    fn count(image: &RgbImage, colour: Rgb) -> usize {
        image.pixels().filter(|pixel| pixel.0 == colour).count()
    }

    #[test]
    fn a_curve_is_drawn_in_its_colour_and_hollow_points_take_less_of_it() {
        let points = |hollow| {
            (1..9)
                .map(|i| PlotPoint {
                    x: f64::from(i),
                    y: f64::from(i * i),
                    hollow,
                })
                .collect::<Vec<_>>()
        };
        let solid = count(&figure(points(false), true).draw(), COLOURS[1]);
        let hollow = count(&figure(points(true), true).draw(), COLOURS[1]);
        let none = count(&figure(Vec::new(), true).draw(), COLOURS[1]);
        assert!(
            solid > hollow + 100 && hollow > none + 100,
            "{solid} {hollow} {none}"
        );
        // Only the legend has both colours.
        assert!(none > 20 && count(&figure(Vec::new(), false).draw(), COLOURS[0]) > 20);
    }

    #[test]
    fn values_off_the_axis_are_left_out() {
        let point = |x, y| PlotPoint {
            x,
            y,
            hollow: false,
        };
        let bad = vec![point(f64::NAN, 1.0), point(-1.0, 1.0), point(1.0, 0.0)];
        let drawn = count(&figure(bad, true).draw(), COLOURS[1]);
        assert_eq!(drawn, count(&figure(Vec::new(), true).draw(), COLOURS[1]));
    }
}
