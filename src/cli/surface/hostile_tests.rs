//! Maps with numbers that no instrument writes: a report in numbers or a refusal, never a panic.
//!
//! `TABOR_MUTATIONS=100000 cargo test --release --lib hostile` tries more than the usual few. The cases
//! are the same in every run, more of them begin with the fewer.

use std::cell::Cell;
use std::fmt::Write;
use std::fs;
use std::time::Duration;

use proptest::prelude::*;

use super::super::busy::{Clock, cases};
use super::*;

/// Cases of a usual run.
const CASES: u32 = 1000;
/// Cases of which one has its pictures drawn too.
const DRAWN: u32 = 50;
/// Processor time for one.
const MOST_TIME: Duration = Duration::from_secs(10);

/// Numbers at the ends of what is allowed, and past them.
const EDGES: &[f64] = &[
    1e-30, 1e30, -1e30, 1e-15, 1e15, 0.0, 1.0, 1e308, 1e-308, -1e308, 5e-324, 1e31, 1e-31,
];

/// A number of any magnitude.
fn extreme() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => (-12.0..3.0_f64).prop_map(|power| 10.0_f64.powf(power)),
        3 => (-30.0..30.0_f64).prop_map(|power| 10.0_f64.powf(power)),
        1 => prop::sample::select(EDGES),
    ]
}

/// A map, as the text of a file: noise, waves, a slope, one number, or numbers of all magnitudes.
#[derive(Clone, Debug)]
struct Map {
    points: [usize; 2],
    kind: u8,
    unit: f64,
    offset: f64,
    seed: u32,
}

impl Map {
    fn text(&self) -> String {
        let [nx, ny] = self.points;
        let mut state = self.seed | 1;
        let mut random = move || {
            // xorshift32: Marsaglia 2003, doi:10.18637/jss.v008.i14.
            state ^= state << 13;
            state ^= state >> 17;
            state ^= state << 5;
            f64::from(state) / f64::from(u32::MAX)
        };
        let mut text = String::new();
        for iy in 0..ny {
            for ix in 0..nx {
                let (x, y) = (ix as f64 / nx as f64, iy as f64 / ny as f64);
                let wave = |k: i32, along: f64| {
                    (std::f64::consts::TAU * f64::from(k) * along + f64::from(k * k)).cos()
                };
                let height = match self.kind {
                    0 => random() - 0.5,
                    // Waves up to a third of those that the map holds: its spectrum has an end.
                    1 => (1..=nx as i32 / 6 + 1)
                        .map(|k| wave(k, x) / f64::from(k))
                        .sum(),
                    2 => (1..=ny as i32 / 6 + 1)
                        .map(|k| wave(k, y) / f64::from(k))
                        .sum(),
                    3 => x + 2.0 * y,
                    4 => 1.0,
                    _ => 10.0_f64.powf(60.0 * random() - 30.0) / self.unit,
                };
                let _ = write!(text, "{:e} ", self.offset + height * self.unit);
            }
            text.push('\n');
        }
        text
    }
}

fn map() -> impl Strategy<Value = Map> {
    let side = || prop_oneof![1 => 1..4_usize, 3 => 4..40_usize, 1 => 90..110_usize];
    let offset = prop_oneof![3 => Just(0.0), 1 => extreme()];
    ([side(), side()], 0..6_u8, extreme(), offset, any::<u32>()).prop_map(
        |(points, kind, unit, offset, seed)| Map {
            points,
            kind,
            unit,
            offset,
            seed,
        },
    )
}

#[test]
fn no_hostile_map_is_trouble() {
    let (cases, mut runner) = cases(CASES);
    let [tried, reported, fitted] = [const { Cell::new(0_u32) }; 3];
    let slowest = Cell::new(Duration::ZERO);
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("map.txt");
    let drawn = RunFolder::open(&folder.path().join("drawn"), "hostile").expect("a folder");
    let scale = prop_oneof![4 => Just(1.0), 1 => extreme()];
    let detrends = prop::sample::select(Detrend::ALL);
    let strategy = (
        map(),
        [extreme(), extreme()],
        any::<bool>(),
        scale,
        detrends,
    );
    let result = runner.run(&strategy, |(map, size, free, scale, detrend)| {
        tried.set(tried.get() + 1);
        fs::write(&path, map.text()).expect("a scratch file");
        let boundary = if free {
            Boundary::Free
        } else {
            Boundary::Periodic
        };
        let grid = GridScene {
            points: None,
            size: Some(size),
            boundary,
        };
        let part = SurfacePart::File(HeightFileScene {
            preparation: crate::scene::Preparation::default(),
            path: path.clone(),
            unit: 1.0,
            scale,
            black: None,
            white: None,
            detrend,
            fill: Fill::None,
        });
        let clock = Clock::start();
        let Ok(surface) = Surface::from_parts(&grid, &[part]) else {
            return Ok(());
        };
        let report = Report::new(&path, &surface, boundary);
        for text in [
            report.text(),
            report.table(),
            report.scene().unwrap_or_default(),
        ] {
            let mut words = text.split(|c: char| !c.is_alphanumeric());
            prop_assert!(!words.any(|word| word == "NaN" || word == "inf"), "{text}");
        }
        let quantities = report.text();
        prop_assert!(
            !quantities.contains("rms_slope            -"),
            "{quantities}"
        );
        if tried.get().is_multiple_of(DRAWN) {
            write_pictures(&drawn, &report).expect("a picture");
        }
        reported.set(reported.get() + 1);
        fitted.set(fitted.get() + u32::from(report.fit.is_ok()));
        let time = clock.elapsed();
        prop_assert!(time < MOST_TIME, "{time:?}");
        slowest.set(slowest.get().max(time));
        Ok(())
    });
    let [reported, fitted] = [reported, fitted].map(Cell::into_inner);
    println!(
        "{cases} maps, {reported} reported, {fitted} of them with a fit; the slowest took {:?}",
        slowest.get()
    );
    if let Err(error) = result {
        panic!("{error}");
    }
    // Every end is reached, or the test shows nothing.
    assert!(reported > cases / 10 && reported < cases && fitted > 0);
}
