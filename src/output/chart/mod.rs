//! Curves of a run, described once and rendered as SVG for the report and as PNG.

mod axis;
mod curves;
mod raster;
mod svg;

use axis::Axis;
pub(super) use svg::svg;

use std::io;

use crate::scene::Scene;
use crate::study::StepRow;

/// Points of a curve up to which each is marked by a dot.
const DOTTED: usize = 120;
/// Dashes and the spaces between them, in line widths.
const DASHES: [f64; 2] = [4.0, 3.0];

/// A stretch of a curve in one direction.
#[derive(Clone, Debug, PartialEq)]
struct Stretch {
    loading: bool,
    points: Vec<[f64; 2]>,
}

/// One curve against one quantity.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Chart {
    /// Title.
    pub title: String,
    x: Axis,
    y: Axis,
    stretches: Vec<Stretch>,
}

/// The role of a mark; the renderer chooses the colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Ink {
    Grid,
    Zero,
    Frame,
    Loading,
    Unloading,
}

/// Alignment of a text at its position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Anchor {
    Start,
    Middle,
    End,
}

/// A drawing command; y counts down, lengths are pixels.
#[derive(Clone, Debug, PartialEq)]
enum Mark {
    Line {
        points: Vec<[f64; 2]>,
        ink: Ink,
        width: f64,
        dashed: bool,
    },
    Dot {
        at: [f64; 2],
        radius: f64,
        ink: Ink,
        filled: bool,
    },
    /// `at` is the middle of the line's height.
    Text {
        at: [f64; 2],
        text: String,
        anchor: Anchor,
        bold: bool,
    },
}

/// The size of a panel and of its texts, pixels.
#[derive(Clone, Copy, Debug)]
struct Panel {
    size: [f64; 2],
    /// Width of a glyph.
    advance: f64,
    /// Height of a line of text.
    line: f64,
    /// Width of a curve.
    stroke: f64,
}

/// The curves of a run as a PNG file, side by side.
pub fn picture(scene: &Scene, rows: &[StepRow]) -> io::Result<Vec<u8>> {
    raster::png(scene.title.as_deref(), &curves::charts(scene, rows))
}

/// The curves of a run.
pub(super) fn charts(scene: &Scene, rows: &[StepRow]) -> Vec<Chart> {
    curves::charts(scene, rows)
}

impl Chart {
    /// All drawing commands, in order.
    fn marks(&self, panel: &Panel) -> Vec<Mark> {
        let Panel {
            size: [width, height],
            advance,
            line,
            stroke,
        } = *panel;
        let ticks_x = self.x.ticks(6);
        let ticks_y = self.y.ticks(6);
        let widest = ticks_y.iter().map(|(_, label)| label.chars().count()).max();
        let left = (widest.unwrap_or(1) as f64 + 1.0) * advance + 0.5 * line;
        let right = width - 1.5 * advance - 0.5 * line;
        let top = 3.4 * line;
        let bottom = height - 3.2 * line;
        let place = |at: [f64; 2]| -> [f64; 2] {
            [
                left + self.x.share(at[0]) * (right - left),
                bottom - self.y.share(at[1]) * (bottom - top),
            ]
        };
        let mut marks = Vec::new();
        let mut rule = |from: [f64; 2], to: [f64; 2], ink: Ink| {
            marks.push(Mark::Line {
                points: vec![from, to],
                ink,
                width: 0.5 * stroke,
                dashed: false,
            });
        };
        let ink_at = |value: f64| if value == 0.0 { Ink::Zero } else { Ink::Grid };
        for (value, _) in &ticks_x {
            let [x, _] = place([*value, 0.0]);
            rule([x, top], [x, bottom], ink_at(*value));
        }
        for (value, _) in &ticks_y {
            let [_, y] = place([0.0, *value]);
            rule([left, y], [right, y], ink_at(*value));
        }
        for (from, to) in [
            ([left, top], [left, bottom]),
            ([left, bottom], [right, bottom]),
        ] {
            rule(from, to, Ink::Frame);
        }
        let mut write = |at: [f64; 2], text: &str, anchor: Anchor, bold: bool| {
            marks.push(Mark::Text {
                at,
                text: text.to_owned(),
                anchor,
                bold,
            });
        };
        for (value, label) in &ticks_x {
            let [x, _] = place([*value, 0.0]);
            write([x, bottom + 0.8 * line], label, Anchor::Middle, false);
        }
        for (value, label) in &ticks_y {
            let [_, y] = place([0.0, *value]);
            write([left - 0.4 * line, y], label, Anchor::End, false);
        }
        let middle = 0.5 * (left + right);
        write(
            [middle, bottom + 2.1 * line],
            &self.x.label(),
            Anchor::Middle,
            false,
        );
        write(
            [0.5 * advance, 0.9 * line],
            &self.title,
            Anchor::Start,
            true,
        );
        write(
            [0.5 * advance, 2.4 * line],
            &self.y.label(),
            Anchor::Start,
            false,
        );
        self.add_legend(&mut marks, panel, right);
        self.add_curves(&mut marks, panel, &place);
        marks
    }

    /// Labels the directions, if there are two.
    fn add_legend(&self, marks: &mut Vec<Mark>, panel: &Panel, right: f64) {
        let has = |loading: bool| self.stretches.iter().any(|s| s.loading == loading);
        if !(has(true) && has(false)) {
            return;
        }
        let (advance, line) = (panel.advance, panel.line);
        let y = 2.4 * line;
        let mut x = right;
        for (loading, text) in [(false, "unloading"), (true, "loading")] {
            marks.push(Mark::Text {
                at: [x, y],
                text: text.to_owned(),
                anchor: Anchor::End,
                bold: false,
            });
            x -= (text.len() as f64 + 0.8) * advance;
            let ink = if loading {
                Ink::Loading
            } else {
                Ink::Unloading
            };
            marks.push(Mark::Line {
                points: vec![[x - 2.2 * line, y], [x, y]],
                ink,
                width: panel.stroke,
                dashed: !loading,
            });
            marks.push(Mark::Dot {
                at: [x - 1.1 * line, y],
                radius: 1.7 * panel.stroke,
                ink,
                filled: loading,
            });
            x -= 2.2 * line + 1.6 * advance;
        }
    }

    fn add_curves(
        &self,
        marks: &mut Vec<Mark>,
        panel: &Panel,
        place: &impl Fn([f64; 2]) -> [f64; 2],
    ) {
        let count: usize = self.stretches.iter().map(|s| s.points.len()).sum();
        let mut ended: Option<&[f64; 2]> = None;
        for stretch in &self.stretches {
            let points: Vec<[f64; 2]> = stretch.points.iter().map(|at| place(*at)).collect();
            let ink = if stretch.loading {
                Ink::Loading
            } else {
                Ink::Unloading
            };
            // A stretch starts at the last point of the one before; that point belongs to the one
            // before.
            let shared = ended.is_some() && ended == stretch.points.first();
            ended = stretch.points.last();
            let dots = points.iter().skip(usize::from(shared)).map(|at| Mark::Dot {
                at: *at,
                radius: 1.7 * panel.stroke,
                ink,
                filled: stretch.loading,
            });
            let dots: Vec<Mark> = if count <= DOTTED {
                dots.collect()
            } else {
                Vec::new()
            };
            if points.len() > 1 {
                marks.push(Mark::Line {
                    points,
                    ink,
                    width: panel.stroke,
                    dashed: !stretch.loading,
                });
            }
            marks.extend(dots);
        }
    }
}
