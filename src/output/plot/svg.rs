//! Renders a figure as SVG within a page whose style sheet sets the colours.

use maud::{Markup, html};

use super::Figure;
use super::drawing::{Anchor, Drawing, Face, Ink, Mark};
use super::raster::DASHES;

/// From the middle of a line of text to its baseline, in heights of the line.
const BASELINE: f64 = 0.3;

impl Figure {
    /// The figure as an `svg` element that is named `label`.
    pub(in crate::output) fn svg(&self, label: &str) -> Markup {
        let Drawing {
            size: [width, height],
            marks,
        } = Drawing::new(self);
        html! {
            svg viewBox={ "0 0 " (width) " " (height) } role="img" aria-label=(label) {
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
                    polyline class=(self.class(*ink)) stroke-width=(width) stroke-dasharray=[dashes]
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
                html! {
                    circle class={ (class) " " (fill) } cx=(format!("{x:.1}")) cy=(format!("{y:.1}"))
                        r=(self.style.mark) {}
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
