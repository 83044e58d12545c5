//! A field as a PNG that is readable without the scene: with colour bar, scale bar and load.

use std::io;
use std::path::Path;

use image::RgbImage;

use super::canvas::{self, FRAME, INK, QUIET_INK, WHITE, printable};
use super::colour_scale::ColourScale;
use super::error::OutputError;
use super::fields::FieldRows;
use super::folder::write_within;
use super::layout::{Contents, Layout, Rect, tick_mark};
use super::resample::resample;
use crate::grid::{Grid, LONGEST_DRAWN};
use crate::scene::{Control, FieldName, LoadingScene};
use crate::units::format_si;

/// The load of a step as a picture shows it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Load {
    /// The quantity, in words.
    pub name: &'static str,
    /// Its value, SI; positive in compression or closer.
    pub value: f64,
    /// Its SI unit.
    pub unit: &'static str,
}

impl Load {
    /// The prescribed `value` of the quantity that the path controls.
    pub fn new(control: Control, value: f64) -> Load {
        let (name, unit) = match control {
            Control::Pressure => ("mean pressure", "Pa"),
            Control::Force => ("force", "N"),
            Control::Approach => ("approach", "m"),
            Control::MeanGap => ("mean gap", "m"),
        };
        Load { name, value, unit }
    }

    /// A `value` on the path of a scene: with a spring its far end is prescribed, not the approach of the body.
    pub(crate) fn on_path(loading: &LoadingScene, value: f64) -> Load {
        let load = Load::new(loading.control, value);
        match loading.spring {
            Some(_) => Load {
                name: "base position",
                ..load
            },
            None => load,
        }
    }

    /// As in "mean pressure 10 MPa".
    pub fn words(&self) -> String {
        format!("{} {}", self.name, format_si(self.value, self.unit))
    }
}

/// Contents of a picture.
#[derive(Clone, Copy, Debug)]
pub struct Picture<'a> {
    /// The scene's title.
    pub title: Option<&'a str>,
    /// Which field.
    pub field: FieldName,
    /// The step, numbered from 1; `None` where there are no steps.
    pub step: Option<usize>,
    /// The load of the step.
    pub load: Option<Load>,
    /// The grid of the field.
    pub grid: Grid,
    /// Shape `[ny, nx]`, row-major, SI units; row 0 is y = 0 and is drawn at the bottom.
    pub values: &'a [f64],
}

/// A drawn picture with the data needed to read it back.
#[derive(Clone, Debug)]
pub struct Snapshot {
    /// The pixels.
    pub image: RgbImage,
    /// Positions of its elements.
    pub layout: Layout,
    /// Its colour scale.
    pub scale: ColourScale,
    /// Keywords and texts stored in the file.
    pub texts: Vec<(&'static str, String)>,
}

impl Picture<'_> {
    /// Draws the picture; refuses non-finite values.
    pub fn draw(&self) -> Result<Snapshot, OutputError> {
        debug_assert_eq!(self.values.len(), self.grid.len(), "one value a point");
        self.draw_rows(&mut |take| take(self.values))
    }

    /// The same of rows that are handed out in place of the values, twice.
    fn draw_rows(&self, rows: &mut FieldRows) -> Result<Snapshot, OutputError> {
        let (mut unfit, mut ends) = (0, [f64::INFINITY, f64::NEG_INFINITY]);
        rows(&mut |values| {
            unfit += values.iter().filter(|value| !value.is_finite()).count();
            ends = values.iter().fold(ends, |[least, greatest], v| {
                [least.min(*v), greatest.max(*v)]
            });
        });
        if unfit > 0 {
            return Err(OutputError::NotFinite {
                field: self.field.name(),
                count: unfit,
                points: self.grid.len(),
            });
        }
        let scale = ColourScale::between(self.field, ends);
        let field = self.grid.drawn_size(LONGEST_DRAWN);
        let layout = Layout::new(&Contents {
            title: self.title,
            caption: &self.caption(),
            note: &self.note(field),
            field,
            pixel_length: self.grid.lx / f64::from(field[0]),
            scale: &scale,
            unit: self.field.unit(),
        });
        let mut image = RgbImage::from_pixel(layout.page[0], layout.page[1], image::Rgb(WHITE));
        draw_furniture(&mut image, &layout);
        draw_bar(&mut image, &layout, &scale);
        draw_field(
            &mut image,
            layout.image,
            &resample(&self.grid, rows, field),
            &scale,
        );
        let texts = self.texts(&layout, &scale);
        Ok(Snapshot {
            image,
            layout,
            scale,
            texts,
        })
    }

    /// As in "pressure   step 3   mean pressure 10 MPa".
    fn caption(&self) -> String {
        let mut parts = vec![self.field.name().to_owned()];
        parts.extend(self.step.map(|step| format!("step {step}")));
        parts.extend(self.load.map(|load| load.words()));
        printable(&parts.join("   "))
    }

    /// The number of points, and whether a pixel is the mean of several.
    fn note(&self, field: [u32; 2]) -> String {
        let averaged = (field[0] as usize) < self.grid.nx || (field[1] as usize) < self.grid.ny;
        format!(
            "{} × {} points{}",
            self.grid.nx,
            self.grid.ny,
            if averaged { ", averaged" } else { "" }
        )
    }

    fn texts(&self, layout: &Layout, scale: &ColourScale) -> Vec<(&'static str, String)> {
        let corners = |rect: Rect| {
            let Rect {
                x,
                y,
                width,
                height,
            } = rect;
            format!("{x} {y} {width} {height}")
        };
        let mut texts = Vec::new();
        texts.extend(self.title.map(|title| ("Title", title.to_owned())));
        texts.push(("tabor field", self.field.name().to_owned()));
        texts.extend(self.step.map(|step| ("tabor step", step.to_string())));
        if let Some(load) = self.load {
            texts.push(("tabor load", load.words()));
            texts.push(("tabor load value", format!("{:?}", load.value)));
        }
        texts.extend([
            ("tabor unit", self.field.unit().to_owned()),
            ("tabor bar low", format!("{:?}", scale.low)),
            ("tabor bar high", format!("{:?}", scale.high)),
            ("tabor bar zero in the middle", scale.two_sided.to_string()),
            ("tabor bar pixels", corners(layout.bar)),
            ("tabor field pixels", corners(layout.image)),
            (
                "tabor scale bar metres",
                format!("{:?}", layout.scale_length),
            ),
            ("tabor scale bar pixels", layout.scale_bar.width.to_string()),
        ]);
        texts
    }
}

impl Snapshot {
    /// The PNG file: 8-bit sRGB, with its texts.
    pub fn encode(&self) -> io::Result<Vec<u8>> {
        canvas::png(&self.image, &self.texts)
    }
}

/// Draws `picture` and writes it to `path`, in one piece.
pub fn write_picture(path: &Path, picture: &Picture) -> Result<(), OutputError> {
    let bytes = picture
        .draw()?
        .encode()
        .map_err(OutputError::write("write", path))?;
    write_within(path, &bytes)
}

/// The same of rows that are handed out in place of the picture's values.
pub(crate) fn write_picture_rows(
    path: &Path,
    picture: &Picture,
    rows: &mut FieldRows,
) -> Result<(), OutputError> {
    let bytes = picture
        .draw_rows(rows)?
        .encode()
        .map_err(OutputError::write("write", path))?;
    write_within(path, &bytes)
}

/// Texts, frames, ticks and the scale bar.
fn draw_furniture(page: &mut RgbImage, layout: &Layout) {
    for line in &layout.title {
        canvas::write(page, line, INK);
    }
    canvas::write(page, &layout.caption, INK);
    canvas::frame(page, layout.image, FRAME);
    canvas::frame(page, layout.bar, FRAME);
    canvas::write(page, &layout.unit, INK);
    for tick in &layout.ticks {
        canvas::fill(page, tick_mark(layout.bar, tick), INK);
        canvas::write(page, &tick.label, INK);
    }
    canvas::fill(page, layout.scale_bar, INK);
    canvas::write(page, &layout.scale_label, INK);
    if let Some(note) = &layout.note {
        canvas::write(page, note, QUIET_INK);
    }
}

fn draw_bar(page: &mut RgbImage, layout: &Layout, scale: &ColourScale) {
    let bar = layout.bar;
    for row in 0..bar.height {
        let colour = if scale.is_constant() {
            scale.colour(scale.low)
        } else {
            scale.colour_at(1.0 - f64::from(row) / f64::from(bar.height - 1))
        };
        let line = Rect {
            y: bar.y + row,
            height: 1,
            ..bar
        };
        canvas::fill(page, line, colour);
    }
}

/// `pixels` has row 0 at y = 0, which is the bottom row of `place`.
fn draw_field(page: &mut RgbImage, place: Rect, pixels: &[f64], scale: &ColourScale) {
    let rows = pixels.chunks_exact(place.width as usize);
    for (row, values) in rows.enumerate() {
        let y = place.bottom() - 1 - row as u32;
        for (x, value) in (place.x..).zip(values) {
            page.put_pixel(x, y, image::Rgb(scale.colour(*value)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::layout::LONGEST_SIDE;

    fn picture(grid: Grid, values: &[f64]) -> Picture<'_> {
        Picture {
            title: Some(
                "A title that is long enough to be broken into two lines, and then to be cut",
            ),
            field: FieldName::Pressure,
            step: Some(12),
            load: Some(Load::new(Control::Pressure, -123.4e6)),
            grid,
            values,
        }
    }

    #[test]
    fn pictures_stay_within_the_longest_side() {
        for (nx, ny) in [
            (4096, 4096),
            (1780, 1780),
            (1781, 64),
            (3, 2049),
            (1, 1),
            (900, 900),
        ] {
            let grid = Grid::new([nx, ny], [nx as f64 * 1e-9, ny as f64 * 1e-9]);
            let values: Vec<f64> = (0..nx * ny)
                .map(|point| -0.012_345e6 + (point % 97) as f64 * 1.234e7)
                .collect();
            let image = picture(grid, &values).draw().unwrap().image;
            let longer = image.width().max(image.height());
            assert!(longer <= LONGEST_SIDE, "{nx} x {ny} gives {longer}");
        }
    }

    #[test]
    fn a_path_with_a_spring_is_that_of_its_far_end() {
        let mut loading = LoadingScene {
            control: Control::Approach,
            path: vec![160e-9],
            durations: None,
            spring: None,
            pull_off_tolerance: 0.01,
            until_apart: false,
        };
        assert_eq!(Load::on_path(&loading, 160e-9).words(), "approach 160 nm");
        loading.spring = Some(2.0);
        assert_eq!(
            Load::on_path(&loading, 160e-9).words(),
            "base position 160 nm"
        );
    }

    #[test]
    fn nan_is_refused_by_count() {
        let grid = Grid::new([2, 2], [1.0, 1.0]);
        let outcome = picture(grid, &[0.0, f64::NAN, 1.0, f64::INFINITY]).draw();
        assert!(matches!(
            outcome,
            Err(OutputError::NotFinite {
                count: 2,
                points: 4,
                ..
            })
        ));
    }

    #[test]
    fn constant_fields_can_be_drawn() {
        let grid = Grid::new([4, 4], [1e-6, 1e-6]);
        for value in [0.0, 5.0, -5.0] {
            let snapshot = picture(grid, &[value; 16]).draw().unwrap();
            let Rect { x, y, .. } = snapshot.layout.image;
            assert_eq!(
                snapshot.image.get_pixel(x, y).0,
                snapshot.scale.colour(value)
            );
        }
    }
}
