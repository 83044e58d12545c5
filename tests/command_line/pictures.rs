//! Pictures, decoded and read back as a person would: colours against the bar, lengths against the
//! scale bar, words letter by letter.

use image::RgbImage;
use noto_sans_mono_bitmap::get_raster;
use tabor::grid::Grid;
use tabor::output::{Load, Picture, RunFolder, Snapshot, TextLine, write_picture};
use tabor::scene::{Control, FieldName};

use crate::shared::trials::tests;

const TITLE: &str = "Two humps and a tense dip";

/// Asymmetric in x and y, so that a flip or a transposition shows; tension is much the smaller.
fn pressure(grid: &Grid) -> Vec<f64> {
    let mut values = Vec::with_capacity(grid.len());
    for iy in 0..grid.ny {
        for ix in 0..grid.nx {
            let (x, y) = (ix as f64 / grid.nx as f64, iy as f64 / grid.ny as f64);
            let hump = |x0: f64, y0: f64, width: f64| {
                (-((x - x0).powi(2) + (y - y0).powi(2)) / (2.0 * width * width)).exp()
            };
            values.push(
                12.3e6 * hump(0.2, 0.15, 0.08) + 5e6 * hump(0.7, 0.4, 0.1)
                    - 0.8e6 * hump(0.6, 0.8, 0.12),
            );
        }
    }
    values
}

struct Drawn {
    grid: Grid,
    values: Vec<f64>,
    snapshot: Snapshot,
    bytes: Vec<u8>,
    image: RgbImage,
}

/// Writes the picture, and decodes the file.
fn drawn() -> Drawn {
    let grid = Grid::new([160, 128], [25e-6, 20e-6]);
    let values = pressure(&grid);
    let picture = Picture {
        title: Some(TITLE),
        field: FieldName::Pressure,
        step: Some(3),
        load: Some(Load::new(Control::Pressure, 10e6)),
        grid,
        values: &values,
    };
    let place = tempfile::tempdir().unwrap();
    let folder = RunFolder::open(place.path(), "test").unwrap();
    let path = folder.image_path(3, FieldName::Pressure);
    assert!(path.ends_with("images/step_0003_pressure.png"));
    write_picture(&path, &picture).unwrap();
    // To look at it: TABOR_KEEP_PICTURE=picture.png cargo test --test command_line pictures
    if let Some(kept) = std::env::var_os("TABOR_KEEP_PICTURE") {
        std::fs::copy(&path, kept).unwrap();
    }
    let bytes = std::fs::read(&path).unwrap();
    let image = image::load_from_memory(&bytes).unwrap().to_rgb8();
    let snapshot = picture.draw().unwrap();
    Drawn {
        grid,
        values,
        snapshot,
        bytes,
        image,
    }
}

/// Reads a line cell by cell: the printable character whose glyph has the darkness found there.
fn read(image: &RgbImage, line: &TextLine) -> String {
    let advance = line.font.advance();
    let darkness = |x: u32, y: u32| 255 - i32::from(image.get_pixel(x, y).0[1]);
    let candidates: Vec<char> = (' '..='~').chain('\u{a1}'..='\u{ff}').collect();
    let cells = (0..line.text.chars().count() as u32).map(|index| {
        let left = line.x + index * advance;
        let distance = |candidate: char| -> i32 {
            let Some(glyph) = get_raster(candidate, line.font.weight, line.font.size) else {
                return i32::MAX;
            };
            let mut sum = 0;
            for (row, coverages) in glyph.rows().enumerate() {
                for (column, coverage) in coverages.iter().enumerate() {
                    let found = darkness(left + column as u32, line.y + row as u32);
                    sum += (found - i32::from(*coverage)).abs();
                }
            }
            sum
        };
        candidates
            .iter()
            .copied()
            .min_by_key(|candidate| distance(*candidate))
            .unwrap()
    });
    cells.collect()
}

/// Value of a colour, looked up on the drawn bar: the place of the nearest colour there.
fn value_on_bar(drawn: &Drawn, colour: [u8; 3]) -> f64 {
    let bar = drawn.snapshot.layout.bar;
    let difference = |row: u32| -> i32 {
        let found = drawn.image.get_pixel(bar.x + bar.width / 2, bar.y + row).0;
        let channels = found.iter().zip(colour);
        channels
            .map(|(left, right)| (i32::from(*left) - i32::from(right)).pow(2))
            .sum()
    };
    let row = (0..bar.height).min_by_key(|row| difference(*row)).unwrap();
    let fraction = 1.0 - f64::from(row) / f64::from(bar.height - 1);
    drawn.snapshot.scale.value(fraction)
}

fn colours_stand_for_the_values_of_the_bar() {
    let drawn = drawn();
    let layout = &drawn.snapshot.layout;
    let least = drawn.values.iter().copied().fold(f64::INFINITY, f64::min);
    let greatest = drawn
        .values
        .iter()
        .copied()
        .fold(f64::NEG_INFINITY, f64::max);
    assert_eq!(
        (drawn.snapshot.scale.low, drawn.snapshot.scale.high),
        (least, greatest)
    );

    // The labels at the ends say the range of the data, in the unit above the bar.
    assert_eq!(read(&drawn.image, &layout.unit), "MPa");
    let label_at = |y: u32| {
        let tick = layout.ticks.iter().find(|tick| tick.y == y).unwrap();
        read(&drawn.image, &tick.label).parse::<f64>().unwrap() * 1e6
    };
    assert!((label_at(layout.bar.y) / greatest - 1.0).abs() < 0.005);
    assert!((label_at(layout.bar.bottom() - 1) / least - 1.0).abs() < 0.005);

    // Each point of the grid is a block of pixels; row 0 is at the bottom.
    let block = layout.image.width / drawn.grid.nx as u32;
    assert_eq!(layout.image.width, block * drawn.grid.nx as u32);
    assert_eq!(layout.image.height, block * drawn.grid.ny as u32);
    for (iy, ix) in [
        (0, 0),
        (19, 32),
        (51, 112),
        (102, 96),
        (127, 159),
        (90, 100),
    ] {
        let x = layout.image.x + block * ix as u32 + block / 2;
        let y = layout.image.bottom() - 1 - (block * iy as u32 + block / 2);
        let value = drawn.values[iy * drawn.grid.nx + ix];
        let found = value_on_bar(&drawn, drawn.image.get_pixel(x, y).0);
        // A row of the bar and a colour are each a few thousandths of it; near zero that crosses
        // from one arm into the other, so places on the bar are compared.
        let scale = &drawn.snapshot.scale;
        let apart = scale.fraction(found) - scale.fraction(value);
        assert!(apart.abs() < 0.005, "({ix}, {iy}): {found} for {value}");
    }
}

fn the_scale_bar_is_as_long_as_it_says() {
    let drawn = drawn();
    let layout = &drawn.snapshot.layout;
    let middle = layout.scale_bar.y + layout.scale_bar.height / 2;
    let dark = |x: u32| drawn.image.get_pixel(x, middle).0[1] < 60;
    let start = (0..drawn.image.width()).find(|x| dark(*x)).unwrap();
    let pixels = (start..).take_while(|x| dark(*x)).count() as f64;

    assert_eq!(read(&drawn.image, &layout.scale_label), "5 µm");
    let pixel_length = drawn.grid.lx / f64::from(layout.image.width);
    assert!((pixels - 5e-6 / pixel_length).abs() <= 1.0);
}

fn title_step_and_load_can_be_read() {
    let drawn = drawn();
    let layout = &drawn.snapshot.layout;
    let title: Vec<String> = layout
        .title
        .iter()
        .map(|line| read(&drawn.image, line))
        .collect();
    assert_eq!(title.join(" "), TITLE);
    assert_eq!(
        read(&drawn.image, &layout.caption),
        "pressure   step 3   mean pressure 10 MPa"
    );
}

fn the_file_carries_its_numbers() {
    let drawn = drawn();
    let texts = texts(&drawn.bytes);
    let text = |keyword: &str| {
        let found = texts.iter().find(|(name, _)| name == keyword);
        found.map(|(_, text)| text.as_str()).unwrap()
    };
    assert_eq!(text("Title"), TITLE);
    assert_eq!(text("tabor load"), "mean pressure 10 MPa");
    assert_eq!(text("tabor unit"), "Pa");
    assert_eq!(text("tabor bar low").parse(), Ok(drawn.snapshot.scale.low));
    assert_eq!(
        text("tabor bar high").parse(),
        Ok(drawn.snapshot.scale.high)
    );
    assert_eq!(text("tabor scale bar metres").parse(), Ok(5e-6));
    let pixels: u32 = text("tabor scale bar pixels").parse().unwrap();
    assert_eq!(pixels, drawn.snapshot.layout.scale_bar.width);
}

/// Keywords and texts of the plain text chunks of a PNG file.
fn texts(png: &[u8]) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let mut rest = &png[8..];
    while rest.len() >= 12 {
        let length = u32::from_be_bytes(rest[..4].try_into().unwrap()) as usize;
        if &rest[4..8] == b"tEXt" {
            let content = String::from_utf8(rest[8..8 + length].to_vec()).unwrap();
            let (keyword, text) = content.split_once('\0').unwrap();
            found.push((keyword.to_owned(), text.to_owned()));
        }
        rest = &rest[12 + length..];
    }
    found
}

tests![
    colours_stand_for_the_values_of_the_bar,
    the_scale_bar_is_as_long_as_it_says,
    title_step_and_load_can_be_read,
    the_file_carries_its_numbers,
];
