//! Positions of the elements of a picture.

use noto_sans_mono_bitmap::{FontWeight, RasterHeight};

use super::canvas::{Font, TextLine, printable};
use super::colour_scale::{ColourScale, round_down};
use super::si::scaled_unit;
use crate::units::format_si;

/// Longest side of a picture, pixels.
pub const LONGEST_SIDE: u32 = 2048;

/// White space around everything.
const MARGIN: u32 = 28;
/// Space between blocks.
const GAP: u32 = 22;
/// From the bar to the tick labels: the tick mark and some space.
const TICK: u32 = 6;
/// Least height of the colour bar's block, for wide fields.
const LEAST_HEIGHT: u32 = 220;
/// From this longer side of a field on texts are larger, pixels.
const LARGE: u32 = 900;
/// Most lines of a title; the rest is cut.
const TITLE_LINES: usize = 2;

/// A rectangle of pixels; y counts down from the top of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rect {
    /// Left column.
    pub x: u32,
    /// Top row.
    pub y: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl Rect {
    /// One past the last column.
    pub fn right(&self) -> u32 {
        self.x + self.width
    }

    /// One past the last row.
    pub fn bottom(&self) -> u32 {
        self.y + self.height
    }
}

/// A tick of the colour bar.
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    /// The value it marks, SI.
    pub value: f64,
    /// Its pixel row.
    pub y: u32,
    /// Its label, in units of the bar's unit.
    pub label: TextLine,
}

/// Positions of all elements of a picture, and the contents of its scales.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// Size of the picture, pixels.
    pub page: [u32; 2],
    /// The scene's title, broken into lines.
    pub title: Vec<TextLine>,
    /// Field, step and load.
    pub caption: TextLine,
    /// The field: its top row of pixels is the greatest y.
    pub image: Rect,
    /// The colour bar: its top row is the scale's `high`, its bottom row `low`.
    pub bar: Rect,
    /// Unit of the tick labels.
    pub unit: TextLine,
    /// Ticks beside the colour bar.
    pub ticks: Vec<Tick>,
    /// The scale bar.
    pub scale_bar: Rect,
    /// Its label.
    pub scale_label: TextLine,
    /// Its length, m.
    pub scale_length: f64,
    /// Number of points, if there is space for it.
    pub note: Option<TextLine>,
}

/// Input of a layout.
pub(super) struct Contents<'a> {
    pub title: Option<&'a str>,
    pub caption: &'a str,
    pub note: &'a str,
    /// Pixels of the field.
    pub field: [u32; 2],
    /// Metres a pixel along x.
    pub pixel_length: f64,
    pub scale: &'a ColourScale,
    /// SI unit of the values.
    pub unit: &'a str,
}

impl Layout {
    pub(super) fn new(contents: &Contents) -> Layout {
        let [field_width, field_height] = contents.field;
        let large = field_width.max(field_height) > LARGE;
        let (title_size, text_size) = if large {
            (RasterHeight::Size24, RasterHeight::Size20)
        } else {
            (RasterHeight::Size20, RasterHeight::Size16)
        };
        let heading = font(FontWeight::Bold, title_size);
        let text = font(FontWeight::Regular, text_size);
        let line = |text: Font, says: String, x: u32, y: u32| TextLine {
            text: says,
            font: text,
            x,
            y,
        };

        let bar_width = if large { 30 } else { 24 };
        let bar_x = MARGIN + field_width + GAP;
        let label_x = bar_x + bar_width + TICK + 5;
        let unit = scaled_unit(contents.scale.magnitude(), contents.unit);
        let labels = contents.scale.ticks(unit.factor);
        let label_width = labels.iter().map(|(_, label)| text.width(label)).max();
        let right = (label_x + label_width.unwrap_or(0))
            .max(bar_x + text.width(&unit.name))
            .max(MARGIN + text.width(contents.caption));

        let mut y = MARGIN;
        let title = wrap(contents.title.unwrap_or_default(), heading, right - MARGIN)
            .into_iter()
            .map(|says| {
                let set = line(heading, says, MARGIN, y);
                y += heading.height() + 4;
                set
            })
            .collect();
        let caption = line(text, contents.caption.to_owned(), MARGIN, y);
        let top = y + text.height() + GAP - 4;

        let height = field_height.max(LEAST_HEIGHT);
        let image = Rect {
            x: MARGIN,
            y: top + (height - field_height) / 2,
            width: field_width,
            height: field_height,
        };
        let bar_drop = text.height() + text.height() / 2 + 2;
        let bar = Rect {
            x: bar_x,
            y: top + bar_drop,
            width: bar_width,
            height: height - bar_drop,
        };
        let ticks = place_ticks(contents.scale, labels, bar, text, label_x);

        let scale_y = top + height + GAP;
        let longest = 0.3 * f64::from(field_width.max(160)) * contents.pixel_length;
        let scale_length = round_down(longest);
        let scale_bar = Rect {
            x: MARGIN,
            y: scale_y + text.height() / 2 - 3,
            width: (scale_length / contents.pixel_length).round() as u32,
            height: 6,
        };
        let scale_label = line(
            text,
            format_si(scale_length, "m"),
            scale_bar.right() + 12,
            scale_y,
        );
        let note_x = image.right().checked_sub(text.width(contents.note));
        let note = note_x
            .filter(|x| *x > scale_label.right() + GAP)
            .map(|x| line(text, contents.note.to_owned(), x, scale_y));

        Layout {
            page: [
                right.max(scale_label.right()) + MARGIN,
                scale_y + text.height() + MARGIN,
            ],
            title,
            caption,
            image,
            bar,
            unit: line(text, unit.name, bar_x, top),
            ticks,
            scale_bar,
            scale_label,
            scale_length,
            note,
        }
    }
}

fn font(weight: FontWeight, size: RasterHeight) -> Font {
    Font { weight, size }
}

/// Keeps the ticks for which there is space; earlier ones take precedence.
fn place_ticks(
    scale: &ColourScale,
    labels: Vec<(f64, String)>,
    bar: Rect,
    text: Font,
    label_x: u32,
) -> Vec<Tick> {
    let mut ticks: Vec<Tick> = Vec::new();
    for (value, label) in labels {
        let fraction = if scale.is_constant() {
            0.5
        } else {
            scale.fraction(value)
        };
        let y = bar.y + ((1.0 - fraction) * f64::from(bar.height - 1)).round() as u32;
        let room = text.height() + text.height() / 2;
        if ticks.iter().all(|tick| tick.y.abs_diff(y) >= room) {
            let label = TextLine {
                text: label,
                font: text,
                x: label_x,
                y: y - text.height() / 2,
            };
            ticks.push(Tick { value, y, label });
        }
    }
    ticks
}

/// Breaks a title between words into lines no wider than `width`; a title that is too long ends in
/// "...".
fn wrap(title: &str, font: Font, width: u32) -> Vec<String> {
    let longest = ((width / font.advance()) as usize).max(4);
    let mut lines: Vec<String> = Vec::new();
    for word in printable(title).split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= longest => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    let cut = lines.len() > TITLE_LINES;
    lines.truncate(TITLE_LINES);
    let last = lines.len().saturating_sub(1);
    for (index, line) in lines.iter_mut().enumerate() {
        if line.chars().count() > longest || (cut && index == last) {
            let kept: String = line.chars().take(longest - 3).collect();
            *line = format!("{}...", kept.trim_end());
        }
    }
    lines
}

/// The tick of the bar: the short line between bar and label.
pub(super) fn tick_mark(bar: Rect, tick: &Tick) -> Rect {
    Rect {
        x: bar.right() + 1,
        y: tick.y,
        width: TICK,
        height: 1,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn titles_break_between_words_and_end_in_dots() {
        let font = font(FontWeight::Bold, RasterHeight::Size20);
        let width = 12 * font.advance();
        let lines = |title| wrap(title, font, width);
        assert_eq!(lines("one two three"), ["one two", "three"]);
        assert_eq!(
            lines("one two three four five six"),
            ["one two", "three fou..."]
        );
        assert_eq!(lines("interferometrically"), ["interfero..."]);
        assert!(lines("  ").is_empty());
    }
}
