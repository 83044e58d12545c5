//! Renders a figure as SVG within a page whose style sheet sets the colours.

use maud::{Markup, PreEscaped, html};

use super::Figure;
use super::drawing::{Anchor, Drawing, Face, Ink, Mark};
use super::raster::DASHES;

/// From the middle of a line of text to its baseline, in heights of the line.
const BASELINE: f64 = 0.3;

/// Pixels by which the letters of a page may reach above a line of the PNG's.
const OVERHANG: u32 = 4;

/// Pixels in a millimetre of a figure in a file of its own: a large panel is 156 mm wide, two small ones are 170 mm,
/// the width of a page, and text has 7 to 9 points.
const PIXELS_PER_MILLIMETRE: f64 = 6.2;
/// Size of a font of that file in heights of a line of the PNG's.
const FONT: f64 = 0.95;
/// Style of a figure that stands in a file of its own, but for the size of its font.
const STYLE: &str = "polyline{fill:none} .bold{font-weight:600} .quiet{fill:#5c5f66} \
    .grid{stroke:#e4e6ea} .zero{stroke:#a4a7ae} .frame{stroke:#5c5f66} .open{stroke-width:1.6}";

impl Figure {
    /// The figure as an SVG file, with vector text, in the size of a paper's.
    pub fn svg_file(&self) -> String {
        let Drawing {
            size: [width, height],
            marks,
        } = Drawing::new(self);
        let millimetres =
            |pixels: u32| format!("{:.1}mm", f64::from(pixels) / PIXELS_PER_MILLIMETRE);
        let font = FONT * f64::from(self.style.text.height());
        // No page gives these pens their colours.
        let pens = self.pens.iter().filter(|pen| !pen.class.is_empty());
        let pens: String = pens.map(|pen| {
            let ([red, green, blue], class) = (pen.colour, pen.class);
            let colour = format!("#{red:02x}{green:02x}{blue:02x}");
            format!(".{class}{{stroke:{colour}}} circle.{class}.full{{fill:{colour}}} circle.{class}.open{{fill:#fff}} ")
        }).collect();
        let text = html! {
            svg xmlns="http://www.w3.org/2000/svg" width=(millimetres(width)) height=(millimetres(height))
                viewBox={ "0 0 " (width) " " (height) } {
                style { (PreEscaped(STYLE)) " " (pens) " text{font-size:" (font) "px;font-family:Helvetica,Arial,sans-serif}" }
                rect width="100%" height="100%" fill="#fff" {}
                @for mark in &marks { (self.element(mark)) }
            }
        };
        text.into_string()
    }

    /// The colour of a curve, unless the page chooses it.
    fn colour(&self, ink: Ink) -> Option<String> {
        let Ink::Curve(name) = ink else {
            return None;
        };
        let [red, green, blue] = self.pen(name).colour;
        let is_own = self.pen(name).class.is_empty();
        is_own.then(|| format!("#{red:02x}{green:02x}{blue:02x}"))
    }

    /// The figure as an `svg` element that is named `label`, without the margins above and below: a page has its own.
    pub(in crate::output) fn svg(&self, label: &str) -> Markup {
        let Drawing {
            size: [width, height],
            marks,
        } = Drawing::new(self);
        let top = self.style.margin.saturating_sub(OVERHANG);
        let height = height - top - self.style.margin;
        html! {
            svg viewBox={ "0 " (top) " " (width) " " (height) } role="img" aria-label=(label) {
                @for mark in &marks { (self.element(mark)) }
            }
        }
    }

    fn class(&self, ink: Ink) -> &'static str {
        match ink {
            Ink::Grid => "grid",
            Ink::Zero => "zero",
            Ink::Frame => "frame",
            Ink::Text => "ink",
            Ink::Quiet => "quiet",
            Ink::Curve(name) => self.pen(name).class,
        }
    }

    fn element(&self, mark: &Mark) -> Markup {
        match mark {
            Mark::Line {
                points,
                ink,
                width,
                dashed,
            } => {
                let place = |[x, y]: &[f64; 2]| format!("{x:.1},{y:.1}");
                let places: Vec<String> = points.iter().map(place).collect();
                let [dash, space] = DASHES.map(|length| length * width);
                let dashes = dashed.then(|| format!("{dash} {space}"));
                html! {
                    polyline class=(self.class(*ink)) stroke=[self.colour(*ink)] stroke-width=(width) stroke-dasharray=[dashes]
                        points=(places.join(" ")) {}
                }
            }
            Mark::Symbol {
                at: [x, y],
                name,
                hollow,
            } => {
                let class = self.pen(*name).class;
                let fill = if *hollow { "open" } else { "full" };
                let colour = self.colour(Ink::Curve(*name));
                let inside = colour
                    .as_deref()
                    .map(|own| if *hollow { "#fff" } else { own });
                html! {
                    circle class={ (class) " " (fill) } cx=(format!("{x:.1}")) cy=(format!("{y:.1}"))
                        r=(self.style.mark) stroke=[&colour] fill=[inside] {}
                }
            }
            Mark::Text {
                at: [x, y],
                text,
                anchor,
                face,
                ink,
            } => {
                let anchor = match anchor {
                    Anchor::Start => "start",
                    Anchor::Middle => "middle",
                    Anchor::End => "end",
                };
                let weight = if *face == Face::Text { "" } else { " bold" };
                let base = y + BASELINE * f64::from(self.style.text.height());
                html! {
                    text x=(format!("{x:.1}")) y=(format!("{base:.1}")) text-anchor=(anchor)
                        class={ (self.class(*ink)) (weight) } { (text) }
                }
            }
        }
    }
}
