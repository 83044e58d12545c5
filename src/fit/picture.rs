//! `fit.png`: the curve with the fitted model, and the residuals.

use std::io;

use image::RgbImage;

use super::choice::FitResult;
use crate::output::canvas::{self, FRAME, HEADING, INK, QUIET_INK, TEXT, WHITE, say};
use crate::output::colour_scale::round_values;
use crate::output::layout::Rect;
use crate::output::palette::Rgb;
use crate::output::pen::Pen;
use crate::output::si::{ScaledUnit, scaled_unit};
use crate::units::format_si;

const PAGE: [u32; 2] = [1100, 900];
/// The panel of the curve.
const CURVE: Rect = Rect {
    x: 120,
    y: 90,
    width: 940,
    height: 500,
};
/// The panel of the residuals.
const RESIDUALS: Rect = Rect {
    x: 120,
    y: 650,
    width: 940,
    height: 170,
};
/// Colours of the points on loading and on unloading.
const LOADING: Rgb = [216, 132, 44];
const UNLOADING: Rgb = [40, 96, 168];
/// Most ticks of an axis.
const TICKS: usize = 8;
/// Pixels of a tick mark.
const MARK: u32 = 6;
/// Width of the model's line, pixels.
const LINE: f64 = 1.0;
/// Share of an axis left empty at its ends.
const MARGIN: f64 = 0.04;

/// One axis: the values at its ends and their pixels.
struct Axis {
    low: f64,
    high: f64,
    from: f64,
    to: f64,
    unit: ScaledUnit,
}

impl Axis {
    fn over(values: impl Iterator<Item = f64>, (from, to): (u32, u32), unit: &str) -> Axis {
        let (mut low, mut high) = values
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                (low.min(value), high.max(value))
            });
        // A constant still needs a range.
        let room = (MARGIN * (high - low))
            .max(1e-6 * high.abs())
            .max(f64::MIN_POSITIVE);
        (low, high) = (low - room, high + room);
        Axis {
            low,
            high,
            from: f64::from(from),
            to: f64::from(to),
            unit: scaled_unit(low.abs().max(high.abs()), unit),
        }
    }

    fn pixel(&self, value: f64) -> f64 {
        let share = (value - self.low) / (self.high - self.low);
        self.from + share * (self.to - self.from)
    }

    fn ticks(&self) -> Vec<(f64, String)> {
        let factor = self.unit.factor;
        round_values(self.low / factor, self.high / factor, TICKS)
            .into_iter()
            .map(|(value, label)| (value * factor, label))
            .collect()
    }
}

/// The picture as a PNG file.
pub fn draw(result: &FitResult, title: &str) -> io::Result<Vec<u8>> {
    let mut page = RgbImage::from_pixel(PAGE[0], PAGE[1], image::Rgb(WHITE));
    let fit = result.best();
    let samples = &result.measured.samples;
    let approach = Axis::over(
        samples.iter().map(|sample| sample.approach),
        (CURVE.x, CURVE.right() - 1),
        "m",
    );
    let forces = samples.iter().map(|sample| sample.force);
    let force = Axis::over(
        forces.chain(fit.fitted.iter().copied()),
        (CURVE.bottom() - 1, CURVE.y),
        "N",
    );
    let rest = |i: usize| samples[i].force - fit.fitted[i];
    let residual = Axis::over(
        (0..samples.len()).map(rest).chain([0.0]),
        (RESIDUALS.bottom() - 1, RESIDUALS.y),
        "N",
    );
    heading(&mut page, result, title);
    panel(&mut page, CURVE, &approach, &force, "force");
    panel(&mut page, RESIDUALS, &approach, &residual, "data - model");
    for segment in &result.measured.segments {
        let colour = if segment.loading { LOADING } else { UNLOADING };
        for i in segment.points.clone() {
            let x = approach.pixel(samples[i].approach);
            dot(&mut page, (x, force.pixel(samples[i].force)), colour);
            dot(&mut page, (x, residual.pixel(rest(i))), colour);
        }
    }
    for segment in &result.measured.segments {
        let mut before: Option<[f64; 2]> = None;
        for i in segment.points.clone() {
            let here = [
                approach.pixel(samples[i].approach),
                force.pixel(fit.fitted[i]),
            ];
            Pen::new(&mut page, INK).stroke(before.unwrap_or(here), here, LINE);
            before = Some(here);
        }
    }
    let zero = residual.pixel(0.0);
    let ends = [RESIDUALS.x, RESIDUALS.right() - 1].map(|x| [f64::from(x), zero]);
    Pen::new(&mut page, INK).stroke(ends[0], ends[1], LINE);
    canvas::png(&page)
}

fn heading(page: &mut RgbImage, result: &FitResult, title: &str) {
    let fit = result.best();
    let mut says = format!("{}: ", fit.model.title());
    if fit.model.adheres() {
        says += &format!(
            "w = {}, ",
            format_si(fit.parameters.work_of_adhesion, "J/m^2")
        );
    }
    says += &format!("E* = {}", format_si(fit.parameters.contact_modulus, "Pa"));
    if let Some(mu) = result.tabor_parameter {
        says += &format!(", Tabor number {mu:.2}");
    }
    let title = canvas::cut(title, HEADING, CURVE.width);
    say(page, HEADING, INK, [CURVE.x, 22], &title);
    say(page, TEXT, INK, [CURVE.x, 54], &says);
    let keys = [
        ("loading", LOADING),
        ("unloading", UNLOADING),
        ("model", INK),
    ];
    let mut x = CURVE.right() - 330;
    for (name, colour) in keys {
        dot(page, (f64::from(x), 62.0), colour);
        say(page, TEXT, QUIET_INK, [x + 10, 54], name);
        x += 30 + TEXT.width(name);
    }
}

fn panel(page: &mut RgbImage, place: Rect, across: &Axis, up: &Axis, name: &str) {
    canvas::frame(page, place, FRAME);
    for (value, label) in across.ticks() {
        let x = across.pixel(value).round() as u32;
        let mark = Rect {
            x,
            y: place.bottom(),
            width: 1,
            height: MARK,
        };
        canvas::fill(page, mark, INK);
        let left = x.saturating_sub(TEXT.width(&label) / 2);
        say(page, TEXT, INK, [left, place.bottom() + MARK + 2], &label);
    }
    for (value, label) in up.ticks() {
        let y = up.pixel(value).round() as u32;
        let mark = Rect {
            x: place.x - MARK,
            y,
            width: MARK,
            height: 1,
        };
        canvas::fill(page, mark, INK);
        let left = (place.x - MARK - 4).saturating_sub(TEXT.width(&label));
        say(page, TEXT, INK, [left, y.saturating_sub(8)], &label);
    }
    let above = [place.x, place.y - TEXT.height() - 2];
    let name = format!("{name} [{}]", up.unit.name);
    say(page, TEXT, QUIET_INK, above, &name);
    let says = format!("approach [{}]", across.unit.name);
    let left = place.right() - TEXT.width(&says);
    say(page, TEXT, QUIET_INK, [left, place.bottom() + 26], &says);
}

/// A square of three pixels.
fn dot(page: &mut RgbImage, (x, y): (f64, f64), colour: Rgb) {
    let place = Rect {
        x: (x.round() as u32).saturating_sub(1),
        y: (y.round() as u32).saturating_sub(1),
        width: 3,
        height: 3,
    };
    canvas::fill(page, place, colour);
}
