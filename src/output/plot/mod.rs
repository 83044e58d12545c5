//! Plots: curves in panels with one legend, described once and rendered as PNG and as SVG.

pub(super) mod curves;
mod drawing;
mod raster;
mod scale;
mod svg;

use std::io;
use std::path::Path;

use image::RgbImage;
use noto_sans_mono_bitmap::{FontWeight, RasterHeight};

use super::canvas::{self, Font, HEADING, TEXT};
use super::error::OutputError;
use super::palette::Rgb;
use super::whole_file::write_atomically;
pub use curves::run_figure;
pub use scale::Axis;

/// A point of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlotPoint {
    /// Value along the horizontal axis, SI.
    pub x: f64,
    /// Value along the vertical axis, SI.
    pub y: f64,
    /// Drawn hollow with a dashed line to it.
    pub hollow: bool,
}

impl PlotPoint {
    /// A point that is drawn full.
    pub fn new(x: f64, y: f64) -> PlotPoint {
        PlotPoint {
            x,
            y,
            hollow: false,
        }
    }
}

/// A curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Index into the figure's names and pens.
    pub name: usize,
    /// Its points, in the order in which a line joins them. Points that are not finite, or not
    /// positive on a logarithmic axis, are left out.
    pub points: Vec<PlotPoint>,
    /// Whether a line joins the points.
    pub line: bool,
    /// Whether each point is marked.
    pub marks: bool,
}

impl Series {
    /// A line without marks.
    pub fn line(name: usize, points: Vec<PlotPoint>) -> Series {
        Series {
            name,
            points,
            line: true,
            marks: false,
        }
    }

    /// Marks without a line.
    pub fn marks(name: usize, points: Vec<PlotPoint>) -> Series {
        Series {
            line: false,
            marks: true,
            ..Series::line(name, points)
        }
    }

    /// A line through marks.
    pub fn marked_line(name: usize, points: Vec<PlotPoint>) -> Series {
        Series {
            marks: true,
            ..Series::line(name, points)
        }
    }
}

/// One frame with its curves.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// Title, which names the vertical axis.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// Its curves.
    pub series: Vec<Series>,
}

/// The shape of a mark.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// A disc.
    Disc,
    /// A square.
    Square,
    /// A square on its tip.
    Diamond,
    /// A triangle.
    Triangle,
}

/// What the curves of one name are drawn with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pen {
    /// Colour in a PNG.
    pub colour: Rgb,
    /// Shape of its marks in a PNG; in an SVG they are discs.
    pub shape: Shape,
    /// Class in an SVG, whose page chooses the colour.
    pub class: &'static str,
}

const fn pen(colour: Rgb, shape: Shape) -> Pen {
    let class = "";
    Pen {
        colour,
        shape,
        class,
    }
}

/// Ten curves, distinct in lightness as well as in hue and shape.
pub const DISTINCT: &[Pen] = &[
    pen([28, 28, 30], Shape::Disc),
    pen([0, 104, 190], Shape::Square),
    pen([214, 74, 0], Shape::Diamond),
    pen([0, 140, 105], Shape::Triangle),
    pen([160, 60, 150], Shape::Disc),
    pen([196, 150, 0], Shape::Square),
    pen([90, 170, 225], Shape::Diamond),
    pen([130, 130, 134], Shape::Triangle),
    pen([128, 84, 40], Shape::Disc),
    pen([205, 30, 60], Shape::Square),
];

/// Loading, unloading and a model of both: dark and light, so that they differ in grey too.
pub const DIRECTIONS: &[Pen] = &[
    Pen {
        class: "loading",
        ..pen([24, 66, 140], Shape::Disc)
    },
    Pen {
        class: "unloading",
        ..pen([216, 118, 24], Shape::Disc)
    },
    pen([28, 28, 30], Shape::Disc),
];

/// Sizes, pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Style {
    /// Width of a frame.
    pub width: u32,
    /// Heights of the frames row by row; the last one is that of all further rows.
    pub heights: &'static [u32],
    /// Space left of a frame for numbers, and below it for numbers and the axis label.
    pub room: [u32; 2],
    /// White space around everything.
    pub margin: u32,
    /// Font of all text but the title.
    pub text: Font,
    /// Font of the title.
    pub heading: Font,
    /// Width of a curve.
    pub stroke: f64,
    /// Half the size of a mark.
    pub mark: f64,
    /// Round values within an axis, at most.
    pub ticks: usize,
}

/// Several small panels.
pub const SMALL: Style = Style {
    width: 400,
    heights: &[280],
    room: [92, 62],
    margin: 24,
    text: TEXT,
    heading: HEADING,
    stroke: 2.0,
    mark: 4.5,
    ticks: 4,
};

/// One or two large panels.
pub const LARGE: Style = Style {
    width: 800,
    heights: &[560],
    room: [112, 76],
    margin: 28,
    text: Font {
        weight: FontWeight::Regular,
        size: RasterHeight::Size20,
    },
    heading: Font {
        weight: FontWeight::Bold,
        size: RasterHeight::Size24,
    },
    stroke: 3.0,
    mark: 5.1,
    ticks: 6,
};

/// A figure: panels side by side and in rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Title of the figure; empty for none.
    pub title: String,
    /// A second line in grey; empty for none.
    pub note: String,
    /// Names of the curves, at most as many as there are pens; others share one. An empty name keeps its pen and has
    /// no legend entry.
    pub names: Vec<String>,
    /// The pen of each name.
    pub pens: &'static [Pen],
    /// The panels, row by row.
    pub panels: Vec<Panel>,
    /// Panels in a row.
    pub columns: usize,
    /// Sizes.
    pub style: Style,
}

impl Default for Figure {
    /// A figure without panels, whose pens are [`DISTINCT`] and whose sizes are [`SMALL`].
    fn default() -> Self {
        Figure {
            title: String::new(),
            note: String::new(),
            names: Vec::new(),
            pens: DISTINCT,
            panels: Vec::new(),
            columns: 2,
            style: SMALL,
        }
    }
}

impl Figure {
    /// Draws the figure.
    pub fn draw(&self) -> RgbImage {
        raster::page(self)
    }

    /// The figure as a PNG file.
    ///
    /// # Errors
    /// What the encoder says.
    pub fn png(&self) -> io::Result<Vec<u8>> {
        let title = (!self.title.is_empty()).then(|| ("Title", self.title.clone()));
        canvas::png(&self.draw(), title.as_slice())
    }

    /// Draws the figure and writes it to `path` as a PNG and beside it as an SVG, each in one piece.
    ///
    /// # Errors
    /// What the system says.
    pub fn write(&self, path: &Path) -> Result<(), OutputError> {
        let png = self.png().map_err(OutputError::write("write", path))?;
        write_atomically(path, &png)?;
        write_atomically(&path.with_extension("svg"), self.svg_file().as_bytes())
    }

    fn pen(&self, name: usize) -> &'static Pen {
        &self.pens[name % self.pens.len()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figure(points: Vec<PlotPoint>, logarithmic: bool) -> Figure {
        let axis = |name: &str| Axis {
            logarithmic,
            ..Axis::linear(name, "Pa")
        };
        Figure {
            title: "A figure".into(),
            note: "of one curve".into(),
            names: vec!["one".into(), "two".into()],
            panels: vec![Panel {
                title: "pressure".into(),
                x: axis("load"),
                y: axis("pressure"),
                series: vec![Series::marked_line(1, points)],
            }],
            ..Figure::default()
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
        let colour = DISTINCT[1].colour;
        let solid = count(&figure(points(false), true).draw(), colour);
        let hollow = count(&figure(points(true), true).draw(), colour);
        let none = count(&figure(Vec::new(), true).draw(), colour);
        assert!(
            solid > hollow + 100 && hollow > none + 100,
            "{solid} {hollow} {none}"
        );
        // Only the legend has it.
        assert!(none > 20);
    }

    #[test]
    fn values_off_the_axis_are_left_out() {
        let point = PlotPoint::new;
        let colour = DISTINCT[1].colour;
        let bad = vec![point(f64::NAN, 1.0), point(-1.0, 1.0), point(1.0, 0.0)];
        let drawn = count(&figure(bad, true).draw(), colour);
        assert_eq!(drawn, count(&figure(Vec::new(), true).draw(), colour));
    }

    #[test]
    fn any_numbers_and_none_can_be_drawn() {
        let extremes = [[1e-300, 1e300], [1e300, 1e-300], [-f64::MAX, f64::MAX]];
        for points in [&[][..], &[[1.0, 1.0]][..], &extremes[..]] {
            for logarithmic in [false, true] {
                let points = points
                    .iter()
                    .map(|&[x, y]| PlotPoint { x, y, hollow: true });
                let page = figure(points.collect(), logarithmic).draw();
                assert!(page.width() < 1000 && page.height() < 1000);
            }
        }
        let page = Figure::default().draw();
        assert!(page.pixels().all(|pixel| pixel.0 == canvas::WHITE));
    }

    #[test]
    fn the_two_directions_differ_in_grey() {
        let grey = |pen: &Pen| {
            let [red, green, blue] = pen.colour.map(f64::from);
            0.299 * red + 0.587 * green + 0.114 * blue
        };
        let difference = grey(&DIRECTIONS[1]) - grey(&DIRECTIONS[0]);
        assert!(difference > 60.0, "{difference} of 255");
    }
}
