//! A white page with rectangles and text.

use std::io;

use image::RgbImage;
use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

use super::layout::Rect;
use super::palette::Rgb;
use super::visible::visible;

/// The name of this program in a PNG file.
const SOFTWARE: &str = concat!("tabor ", env!("CARGO_PKG_VERSION"));
/// The page.
pub(crate) const WHITE: Rgb = [255, 255, 255];
/// Text, ticks and the scale bar.
pub(crate) const INK: Rgb = [28, 28, 30];
/// Text of less importance.
pub(crate) const QUIET_INK: Rgb = [100, 100, 104];
/// Frames.
pub(crate) const FRAME: Rgb = [150, 150, 154];

/// A size and weight of the one typeface, whose glyphs all have the same width.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Font {
    /// Regular or bold.
    pub weight: FontWeight,
    /// Height of a line of glyphs.
    pub size: RasterHeight,
}

impl Font {
    /// Width of one glyph, pixels.
    pub fn advance(self) -> u32 {
        get_raster_width(self.weight, self.size) as u32
    }

    /// Height of one glyph, pixels.
    pub fn height(self) -> u32 {
        self.size.val() as u32
    }

    /// Width of `text`, pixels.
    pub fn width(self, text: &str) -> u32 {
        text.chars().count() as u32 * self.advance()
    }
}

/// Text of plots.
pub(crate) const TEXT: Font = Font {
    weight: FontWeight::Regular,
    size: RasterHeight::Size16,
};
/// Titles of plots.
pub(crate) const HEADING: Font = Font {
    weight: FontWeight::Bold,
    size: RasterHeight::Size20,
};

/// A line of text and its position.
#[derive(Clone, Debug, PartialEq)]
pub struct TextLine {
    /// Its characters, which the typeface has.
    pub text: String,
    /// Its font.
    pub font: Font,
    /// Left edge of the first glyph, pixels.
    pub x: u32,
    /// Top edge of the glyphs, pixels.
    pub y: u32,
}

impl TextLine {
    /// One past the last pixel column.
    pub fn right(&self) -> u32 {
        self.x + self.font.width(&self.text)
    }
}

/// `text` in characters that the typeface has (Latin-1); others become a similar one or `?`.
pub(crate) fn printable(text: &str) -> String {
    text.chars()
        .map(|character| match character {
            '\u{2010}'..='\u{2015}' | '\u{2212}' => '-',
            '\u{2018}' | '\u{2019}' => '\'',
            '\u{201c}' | '\u{201d}' => '"',
            '\u{3bc}' => 'µ',
            character if character.is_whitespace() => ' ',
            character => {
                let known = get_raster(character, FontWeight::Regular, RasterHeight::Size16);
                if known.is_some() { character } else { '?' }
            }
        })
        .collect()
}

/// Writes text with its upper left corner at a position, pixels.
pub(crate) fn say(page: &mut RgbImage, font: Font, ink: Rgb, [x, y]: [u32; 2], text: &str) {
    let text = printable(text);
    write(page, &TextLine { text, font, x, y }, ink);
}

/// The page as a PNG file, 8-bit sRGB, with the name of this program and a text for each keyword. Control characters
/// are escaped: programs print these texts.
pub(crate) fn png(page: &RgbImage, texts: &[(&str, String)]) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, page.width(), page.height());
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fast);
    encoder.set_filter(png::Filter::Adaptive);
    encoder.add_text_chunk("Software".to_owned(), SOFTWARE.to_owned())?;
    for (keyword, text) in texts {
        let (keyword, text) = ((*keyword).to_owned(), visible(text).into_owned());
        if text.is_ascii() {
            encoder.add_text_chunk(keyword, text)?;
        } else {
            encoder.add_itxt_chunk(keyword, text)?;
        }
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(page.as_raw())?;
    writer.finish()?;
    Ok(bytes)
}

/// Fills a rectangle as far as it lies on the page.
pub(crate) fn fill(page: &mut RgbImage, rect: Rect, colour: Rgb) {
    for y in rect.y..rect.bottom().min(page.height()) {
        for x in rect.x..rect.right().min(page.width()) {
            page.put_pixel(x, y, image::Rgb(colour));
        }
    }
}

/// Draws a line one pixel wide around a rectangle, just outside it.
pub(crate) fn frame(page: &mut RgbImage, rect: Rect, colour: Rgb) {
    let outer = Rect {
        x: rect.x.saturating_sub(1),
        y: rect.y.saturating_sub(1),
        width: rect.width + 2,
        height: rect.height + 2,
    };
    let side = |x, y, width, height| Rect {
        x,
        y,
        width,
        height,
    };
    fill(page, side(outer.x, outer.y, outer.width, 1), colour);
    fill(page, side(outer.x, rect.bottom(), outer.width, 1), colour);
    fill(page, side(outer.x, outer.y, 1, outer.height), colour);
    fill(page, side(rect.right(), outer.y, 1, outer.height), colour);
}

/// Draws a line of text in `ink` on the page.
pub(crate) fn write(page: &mut RgbImage, line: &TextLine, ink: Rgb) {
    let advance = line.font.advance();
    for (index, character) in line.text.chars().enumerate() {
        let Some(glyph) = get_raster(character, line.font.weight, line.font.size) else {
            continue;
        };
        let left = line.x + index as u32 * advance;
        for (row, coverages) in glyph.rows().enumerate() {
            for (column, &coverage) in coverages.iter().enumerate() {
                let (x, y) = (left + column as u32, line.y + row as u32);
                if coverage > 0 && x < page.width() && y < page.height() {
                    page.put_pixel(x, y, image::Rgb(blend(ink, coverage)));
                }
            }
        }
    }
}

/// Ink on the white page at a coverage of 0 to 255.
fn blend(ink: Rgb, coverage: u8) -> Rgb {
    let coverage = u32::from(coverage);
    std::array::from_fn(|channel| {
        let mixed =
            u32::from(ink[channel]) * coverage + u32::from(WHITE[channel]) * (255 - coverage);
        ((mixed + 127) / 255) as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unknown_characters_are_replaced() {
        assert_eq!(printable("E* − µ\tµ² \u{3bc} “λ”"), "E* - µ µ² µ \"?\"");
    }

    #[test]
    fn full_coverage_is_ink_and_none_is_page() {
        assert_eq!(blend(INK, 255), INK);
        assert_eq!(blend(INK, 0), WHITE);
    }
}
