//! Renders a chart as SVG within a page whose style sheet sets the colours.

use std::fmt::Write as _;

use super::super::report::escape;
use super::{Anchor, Chart, DASHES, Ink, Mark, Panel};

/// The panel, in units of the picture; the page scales it.
const PANEL: Panel = Panel {
    size: [560.0, 420.0],
    // A sans-serif face of 14 has glyphs of some 7 on average.
    advance: 7.6,
    line: 17.0,
    stroke: 2.0,
};

/// The chart as an `svg` element with a title.
pub fn svg(chart: &Chart) -> String {
    let [width, height] = PANEL.size;
    let mut text = format!(
        "<svg viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{}\">\n",
        escape(&chart.title)
    );
    for mark in chart.marks(&PANEL) {
        push(&mut text, &mark);
    }
    text.push_str("</svg>\n");
    text
}

fn class(ink: Ink) -> &'static str {
    match ink {
        Ink::Grid => "grid",
        Ink::Zero => "zero",
        Ink::Frame => "frame",
        Ink::Loading => "loading",
        Ink::Unloading => "unloading",
    }
}

fn push(text: &mut String, mark: &Mark) {
    // Writing to a string cannot fail.
    let _ = match mark {
        Mark::Line {
            points,
            ink,
            width,
            dashed,
        } => {
            let places: Vec<String> = points
                .iter()
                .map(|[x, y]| format!("{x:.1},{y:.1}"))
                .collect();
            let dash = if *dashed {
                format!(
                    " stroke-dasharray=\"{} {}\"",
                    DASHES[0] * width,
                    DASHES[1] * width
                )
            } else {
                String::new()
            };
            writeln!(
                text,
                "<polyline class=\"{}\" stroke-width=\"{width}\"{dash} points=\"{}\"/>",
                class(*ink),
                places.join(" ")
            )
        }
        Mark::Dot {
            at: [x, y],
            radius,
            ink,
            filled,
        } => writeln!(
            text,
            "<circle class=\"{}{}\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\"/>",
            class(*ink),
            if *filled { " full" } else { " open" }
        ),
        Mark::Text {
            at: [x, y],
            text: words,
            anchor,
            bold,
        } => {
            let anchor = match anchor {
                Anchor::Start => "start",
                Anchor::Middle => "middle",
                Anchor::End => "end",
            };
            writeln!(
                text,
                "<text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"{anchor}\"{}>{}</text>",
                // From the middle of a line to its baseline.
                y + 0.28 * PANEL.line,
                if *bold { " class=\"bold\"" } else { "" },
                escape(words)
            )
        }
    };
}
