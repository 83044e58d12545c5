//! Where everything in a figure stands, as marks that PNG and SVG render.

use super::scale::Scale;
use super::{Figure, Panel, PlotPoint, Series};

/// Width of the sample of a curve in the legend, pixels.
const SAMPLE: u32 = 28;
/// Space between that sample and its name, and behind the name.
const SPACE: [u32; 2] = [8, 24];

/// Most letters of a unit that stands beside the title of its panel.
const LONGEST_UNIT: usize = 11;

/// The role of a mark; the renderer chooses the colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ink {
    Grid,
    Zero,
    Frame,
    Text,
    Quiet,
    /// Of the curves of this index.
    Curve(usize),
}

/// The part of a text that stands at its position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// How a text is set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Face {
    Text,
    Bold,
    Heading,
}

/// A drawing command; y counts down, lengths are pixels, whose centres are at whole numbers.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Mark {
    Line {
        points: Vec<[f64; 2]>,
        ink: Ink,
        width: f64,
        dashed: bool,
    },
    Symbol {
        at: [f64; 2],
        name: usize,
        hollow: bool,
    },
    /// `at` is the middle of the line's height.
    Text {
        at: [f64; 2],
        text: String,
        anchor: Anchor,
        face: Face,
        ink: Ink,
    },
}

/// All marks of a figure, in order.
pub(super) struct Drawing {
    pub size: [u32; 2],
    pub marks: Vec<Mark>,
}

impl Drawing {
    pub fn new(figure: &Figure) -> Drawing {
        let style = &figure.style;
        let columns = figure.columns.clamp(1, figure.panels.len().max(1));
        let line = style.text.height() + 6;
        let width = columns as u32 * (style.width + style.room[0] + style.margin) + style.margin;
        let mut drawing = Drawing {
            size: [width, 0],
            marks: Vec::new(),
        };
        let mut y = style.margin;
        for (text, face, font) in [
            (&figure.title, Face::Heading, style.heading),
            (&figure.note, Face::Text, style.text),
        ] {
            if !text.is_empty() {
                let fits = (width - 2 * style.margin) / font.advance();
                let ink = if face == Face::Heading {
                    Ink::Text
                } else {
                    Ink::Quiet
                };
                let at = [style.margin, y + font.height() / 2].map(f64::from);
                drawing.write(at, &cut(text, fits), Anchor::Start, face, ink);
                y += font.height() + 6;
            }
        }
        y = drawing.add_legend(figure, y) + 10;
        for (row, panels) in figure.panels.chunks(columns).enumerate() {
            let height = style.heights[row.min(style.heights.len() - 1)];
            let mut x = style.margin + style.room[0];
            for panel in panels {
                let frame = Frame {
                    x: f64::from(x),
                    y: f64::from(y + line),
                    width: f64::from(style.width),
                    height: f64::from(height),
                };
                drawing.add_panel(figure, panel, &frame);
                x += style.width + style.room[0] + style.margin;
            }
            y += line + height + style.room[1] + style.margin;
        }
        drawing.size[1] = y;
        drawing
    }

    fn write(&mut self, at: [f64; 2], text: &str, anchor: Anchor, face: Face, ink: Ink) {
        self.marks.push(Mark::Text {
            at,
            text: text.to_owned(),
            anchor,
            face,
            ink,
        });
    }

    fn join(&mut self, points: Vec<[f64; 2]>, ink: Ink, width: f64, dashed: bool) {
        if points.len() > 1 {
            self.marks.push(Mark::Line {
                points,
                ink,
                width,
                dashed,
            });
        }
    }

    /// Writes the names that curves have, from `y` on; returns the end.
    fn add_legend(&mut self, figure: &Figure, y: u32) -> u32 {
        let style = &figure.style;
        let line = style.text.height() + 6;
        let (mut x, mut y) = (style.margin, y);
        let named = figure.names.iter().enumerate();
        let mut any = false;
        for (name, words) in named.filter(|(_, words)| !words.is_empty()) {
            let wide = SAMPLE + SPACE[0] + style.text.width(words) + SPACE[1];
            if x + wide > self.size[0] && x > style.margin {
                (x, y) = (style.margin, y + line);
            }
            let series: Vec<&Series> = (figure.panels.iter().flat_map(|panel| &panel.series))
                .filter(|series| series.name == name && !series.points.is_empty())
                .collect();
            let mut points = series.iter().flat_map(|series| &series.points);
            let hollow = !series.is_empty() && points.all(|point| point.hollow);
            let middle = f64::from(y + style.text.height() / 2);
            let at = |shift: u32| [f64::from(x + shift), middle];
            // A curve without points still shows its pen.
            if series.is_empty() || series.iter().any(|series| series.line) {
                let ends = vec![at(0), at(SAMPLE)];
                self.join(ends, Ink::Curve(name), style.stroke, hollow);
            }
            if series.is_empty() || series.iter().any(|series| series.marks) {
                self.marks.push(Mark::Symbol {
                    at: at(SAMPLE / 2),
                    name,
                    hollow,
                });
            }
            let at = at(SAMPLE + SPACE[0]);
            self.write(at, words, Anchor::Start, Face::Text, Ink::Text);
            x += wide;
            any = true;
        }
        if any { y + line } else { y }
    }

    fn add_panel(&mut self, figure: &Figure, panel: &Panel, frame: &Frame) {
        let style = &figure.style;
        let text = f64::from(style.text.height());
        let values = |of: fn(&PlotPoint) -> f64| {
            let points = panel.series.iter().flat_map(|series| &series.points);
            points.map(of)
        };
        let x = Scale::new(&panel.x, values(|point| point.x));
        let y = Scale::new(&panel.y, values(|point| point.y));
        let above = frame.y - 0.5 * text - 5.0;
        // The vertical axis is named by the title; its unit stands above the numbers, or there if it is too long.
        let has_room = y.unit().chars().count() <= LONGEST_UNIT;
        let title = if has_room {
            panel.title.clone()
        } else {
            format!("{} ({})", panel.title, y.unit())
        };
        let title = cut(&title, style.width / style.text.advance());
        self.write(
            [frame.x, above],
            &title,
            Anchor::Start,
            Face::Bold,
            Ink::Text,
        );
        for tick in x.ticks(style.ticks) {
            let across = frame.across(tick.share).round();
            let ends = vec![[across, frame.y], [across, frame.bottom() - 1.0]];
            self.join(ends, tick.ink(), 1.0, false);
            let below = [across, frame.bottom() + 6.0 + 0.5 * text];
            self.write(below, &tick.label, Anchor::Middle, Face::Text, Ink::Text);
        }
        for tick in y.ticks(style.ticks) {
            let down = frame.down(tick.share).round();
            let ends = vec![[frame.x, down], [frame.right() - 1.0, down]];
            self.join(ends, tick.ink(), 1.0, false);
            let beside = [frame.x - 8.0, down];
            self.write(beside, &tick.label, Anchor::End, Face::Text, Ink::Text);
        }
        self.join(frame.outline(), Ink::Frame, 1.0, false);
        let middle = frame.x + 0.5 * frame.width;
        let below = [middle, frame.bottom() + 1.5 * text + 12.0];
        self.write(below, &x.label(), Anchor::Middle, Face::Text, Ink::Quiet);
        if has_room {
            let beside = [frame.x - 8.0, above];
            self.write(beside, y.unit(), Anchor::End, Face::Text, Ink::Quiet);
        }
        let place = |point: &PlotPoint| {
            let (across, up) = x.share(point.x).zip(y.share(point.y))?;
            Some([frame.across(across), frame.down(up)])
        };
        for series in &panel.series {
            self.add_series(series, style.stroke, place);
        }
    }

    fn add_series(
        &mut self,
        series: &Series,
        stroke: f64,
        place: impl Fn(&PlotPoint) -> Option<[f64; 2]>,
    ) {
        let ink = Ink::Curve(series.name);
        let mut symbols = Vec::new();
        let mut before: Option<([f64; 2], bool)> = None;
        let (mut run, mut dashed) = (Vec::new(), false);
        for point in &series.points {
            let at = place(point);
            let joins = before.filter(|_| series.line).zip(at);
            if let Some(((last, hollow), at)) = joins {
                if run.is_empty() || dashed != (hollow || point.hollow) {
                    self.join(std::mem::take(&mut run), ink, stroke, dashed);
                    dashed = hollow || point.hollow;
                    run.push(last);
                }
                run.push(at);
            } else {
                self.join(std::mem::take(&mut run), ink, stroke, dashed);
            }
            if series.marks
                && let Some(at) = at
            {
                symbols.push(Mark::Symbol {
                    at,
                    name: series.name,
                    hollow: point.hollow,
                });
            }
            before = at.map(|at| (at, point.hollow));
        }
        self.join(run, ink, stroke, dashed);
        self.marks.extend(symbols);
    }
}

/// The frame of a panel.
struct Frame {
    x: f64,
    y: f64,
    width: f64,
    height: f64,
}

impl Frame {
    fn right(&self) -> f64 {
        self.x + self.width
    }

    fn bottom(&self) -> f64 {
        self.y + self.height
    }

    fn across(&self, share: f64) -> f64 {
        self.x + share * (self.width - 1.0)
    }

    fn down(&self, share: f64) -> f64 {
        self.y + (1.0 - share) * (self.height - 1.0)
    }

    /// The line just outside it.
    fn outline(&self) -> Vec<[f64; 2]> {
        let (left, top) = (self.x - 1.0, self.y - 1.0);
        let (right, bottom) = (self.right(), self.bottom());
        vec![
            [left, top],
            [right, top],
            [right, bottom],
            [left, bottom],
            [left, top],
        ]
    }
}

/// The first `most` characters.
fn cut(text: &str, most: u32) -> String {
    text.chars().take(most as usize).collect()
}
