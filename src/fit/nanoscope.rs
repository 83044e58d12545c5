//! Force curves of Bruker's Nanoscope (.spm, .000 and so on): a header of text in sections, then blocks of integers.
//!
//! A block holds the extension and the retraction of a ramp of the piezo, whose length the header states. Reads the
//! deflection.
//!
//! # Source
//! Bruker, "NanoScope Software 8.10 User Guide" (D 004-1025-000), on CIAO parameters and force files, and public readers of
//! such files.

use std::path::Path;

use super::columns::CurveColumns;
use super::curve_file::{ForceCurve, Sample, name};
use super::error::FitError;
use crate::surface::instrument_header::{
    NANOSCOPE_FORCE, Section, nanoscope_sections, sensitivity, volts,
};

/// First bytes of a file of one curve.
pub(super) const MAGIC: &[u8] = NANOSCOPE_FORCE;
/// The sections of channels.
const CHANNELS: &str = "ciao force image list";
/// Share of a part, and fewest points, at each of its ends that are compared.
const END: f64 = 0.1;
const LEAST_END: usize = 4;
/// Times that the deflection must change more at one end than at the other, and share of its range, to be the less level one.
const LESS_LEVEL: f64 = 3.0;
const UNEVEN: f64 = 0.02;

/// Reads the curve.
pub(super) fn read(bytes: &[u8], path: &Path, how: &CurveColumns) -> Result<ForceCurve, FitError> {
    let broken = |what: String| FitError::Broken {
        path: name(path),
        format: "Nanoscope",
        what,
    };
    if !how.choices.is_empty() {
        return Err(broken("its columns are known; choose none".to_owned()));
    }
    let sections = nanoscope_sections(bytes);
    let channels = sections.iter().filter(|section| section.name == CHANNELS);
    let is_deflection = |section: &&Section| {
        let kind = section.find("@4:image data").unwrap_or_default();
        kind.to_ascii_lowercase().contains("deflection")
    };
    let Some(channel) = channels.clone().find(is_deflection) else {
        return Err(broken("it holds no deflection of a force curve".to_owned()));
    };
    let text = |key: &str| {
        let own = channel.find(key);
        let any = || sections.iter().rev().find_map(|section| section.find(key));
        own.or_else(any)
            .ok_or_else(|| broken(format!("its header has no {key:?}")))
    };
    let whole = |key: &str| {
        let number = text(key)?.split_whitespace().next();
        let number = number.and_then(|number| number.parse::<usize>().ok());
        number.ok_or_else(|| broken(format!("{key:?} is not a count")))
    };
    let (offset, length, size) = (
        whole("data offset")?,
        whole("data length")?,
        whole("bytes/pixel")?,
    );
    // "512 512": of the retraction and of the extension.
    let counts: Vec<usize> = text("samps/line")?
        .split_whitespace()
        .filter_map(|count| count.parse().ok())
        .collect();
    let counts = match counts[..] {
        [both] if both > 0 => [both; 2],
        [retraction, extension] if retraction > 0 && extension > 0 => [extension, retraction],
        _ => return Err(broken("\"samps/line\" is not one count or two".to_owned())),
    };
    let points = counts[0].saturating_add(counts[1]);
    let block = offset
        .checked_add(length)
        .and_then(|end| bytes.get(offset..end))
        .ok_or_else(|| broken("it ends within its numbers".to_owned()))?;
    // From version 9.2 on two bytes of resolution are stored in four.
    let stored = if length / points.max(1) >= 4 { 4 } else { 2 };
    if length / stored < points || !(size == 2 || size == 4) {
        return Err(broken(format!(
            "{length} bytes hold no {points} numbers of {size} bytes"
        )));
    }
    // `V [Sens. DeflSens] (0.000375 V/LSB) 24.576 V`: what an integer is.
    let scale = text("@4:z scale")?;
    let step = scale
        .split_once('(')
        .and_then(|(_, rest)| rest.split_once("/LSB)"))
        .and_then(|(step, range)| Some(unrounded(step, volts(step)?, volts(range))))
        .ok_or_else(|| broken("\"@4:z scale\" states no volts of an integer".to_owned()))?;
    let to_length = match how.sensitivity {
        Some(own) => own,
        None => sensitivity(scale, &sections)
            .ok_or_else(|| FitError::NoSensitivity { path: name(path) })?,
    };
    let own = channel
        .find("spring constant")
        .and_then(|text| text.parse().ok());
    let spring = how.spring.or(own).filter(|spring| *spring > 0.0);
    let spring = spring.ok_or_else(|| FitError::NoSpring {
        path: name(path),
        column: "deflection",
    })?;
    // `V [Sens. Zsens] (0.006713867 V/LSB) 7.5 V`: the ramp.
    let ramp = text("@4:ramp size")?;
    let ramp = ramp
        .rsplit_once(')')
        .and_then(|(_, size)| volts(size))
        .zip(sensitivity(ramp, &sections))
        .map(|(volts, per_volt)| volts * per_volt)
        .filter(|length| *length > 0.0)
        .ok_or_else(|| broken("\"@4:ramp size\" states no length".to_owned()))?;
    let deflection: Vec<f64> = block
        .chunks_exact(stored)
        .take(points)
        .map(|chunk| {
            let integer = match *chunk {
                [a, b] => i32::from(i16::from_le_bytes([a, b])),
                [a, b, c, d] => i32::from_le_bytes([a, b, c, d]),
                _ => 0,
            };
            f64::from(integer) * step * to_length
        })
        .collect();
    let (extension, retraction) = deflection.split_at(counts[0]);
    let (mut extension, mut retraction) = (extension.to_vec(), retraction.to_vec());
    turn(&mut extension, &mut retraction);
    let mut curve = ForceCurve {
        spring: Some(spring),
        has_positions: true,
        ..ForceCurve::default()
    };
    let mut add = |deflections: &[f64], is_extension: bool| {
        let last = (deflections.len().max(2) - 1) as f64;
        for (index, deflection) in deflections.iter().enumerate() {
            let share = index as f64 / last;
            let position = ramp * if is_extension { share } else { 1.0 - share };
            curve.samples.push(Sample {
                approach: position - deflection,
                force: spring * deflection,
            });
        }
    };
    add(&extension, true);
    add(&retraction, false);
    Ok(curve)
}

/// The volts of an integer, which a header prints to few digits: where they are those of the whole range over the integers of 16 or 32
/// bits, to the last digit of the `text`, these. A curve of deflections magnifies their rounding.
fn unrounded(text: &str, printed: f64, range: Option<f64>) -> f64 {
    let number = text.trim_start().split(' ').next().unwrap_or_default();
    let decimals = number.split_once('.').map_or("", |(_, decimals)| decimals);
    if decimals.is_empty() || !decimals.bytes().all(|digit| digit.is_ascii_digit()) {
        return printed;
    }
    let unit = printed / number.parse().unwrap_or(f64::NAN);
    let last_digit = 0.1_f64.powi(decimals.len() as i32) * unit;
    let whole = [16, 32].map(|bits| range.unwrap_or(f64::NAN) / 2_f64.powi(bits));
    let is_printed = |exact: &f64| (exact - printed).abs() <= 0.5001 * last_digit;
    let exact = whole.into_iter().find(is_printed);
    exact.filter(|exact| *exact > 0.0).unwrap_or(printed)
}

/// Brings both parts into the order of time: they meet where the ramp turns. Versions store the extension in either order.
fn turn(extension: &mut [f64], retraction: &mut [f64]) {
    let [Some(&first), Some(&last)] = [extension.first(), extension.last()] else {
        return;
    };
    let [Some(&begin), Some(&end)] = [retraction.first(), retraction.last()] else {
        return;
    };
    let is_nearer = |a: f64, b: f64, to: f64| (a - to).abs() < (b - to).abs();
    let (extends, retracts) = match (turns_at_end(extension), turns_at_end(retraction)) {
        (Some(extends), Some(retracts)) => {
            // Where pull-off is late the end of the retraction is the less level one. The extension has no pull-off, so that
            // it is right if the parts do not meet.
            let there = if extends { last } else { first };
            let (meets, other) = if retracts { (end, begin) } else { (begin, end) };
            (extends, retracts != is_nearer(other, meets, there))
        }
        (Some(extends), None) => {
            let there = if extends { last } else { first };
            (extends, is_nearer(end, begin, there))
        }
        (None, Some(retracts)) => {
            let there = if retracts { end } else { begin };
            (is_nearer(last, first, there), retracts)
        }
        // The deflection is usually largest where the ramp turns.
        (None, None) => (last >= first, end > begin),
    };
    if !extends {
        extension.reverse();
    }
    if retracts {
        retraction.reverse();
    }
}

/// Whether the ramp turns at the end of a part, not at its beginning: the other end lies on the baseline, which is level.
/// `None` where neither end is clearly less level, as at the limit of the detector. The size of the deflection does not tell it: it is
/// below the baseline where the ramp turns in net tension.
fn turns_at_end(part: &[f64]) -> Option<bool> {
    let count = ((END * part.len() as f64) as usize).max(LEAST_END);
    if part.len() < 2 * count {
        return None;
    }
    let (begin, end) = (change(&part[..count]), change(&part[part.len() - count..]));
    let span = part.iter().copied().fold(f64::NEG_INFINITY, f64::max)
        - part.iter().copied().fold(f64::INFINITY, f64::min);
    let is_clear = |less: f64, more: f64| more > LESS_LEVEL * less && more > UNEVEN * span;
    if is_clear(begin, end) {
        Some(true)
    } else {
        is_clear(end, begin).then_some(false)
    }
}

/// Difference of the means of both halves.
fn change(values: &[f64]) -> f64 {
    let (first, second) = values.split_at(values.len() / 2);
    let mean = |half: &[f64]| half.iter().sum::<f64>() / half.len() as f64;
    (mean(second) - mean(first)).abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounded_volts_of_an_integer_are_those_of_the_range() {
        let of =
            |text: &str, range: &str| unrounded(text, volts(text).expect("volts"), volts(range));
        let exact = 24.576 / 2_f64.powi(32);
        assert_eq!(of("0.0000000057 V", " 24.57600 V"), exact);
        assert_eq!(of("0.00000000572205 V", "24.576 V"), exact);
        assert_eq!(of("0.000375 V", "24.576 V"), 24.576 / 65536.0);
        assert_eq!(of("0.3750 mV", "24.576 V"), 24.576 / 65536.0);
        // Another range, or a number that is not of this form.
        assert_eq!(of("0.0000000057 V", "20 V"), 0.0000000057);
        assert_eq!(
            of("0.3750 mV", "24.6 V"),
            volts("0.3750 mV").expect("volts")
        );
        assert_eq!(of("5.7e-9 V", "24.576 V"), 5.7e-9);
        assert_eq!(of("0.0000000057 V", "?"), 0.0000000057);
    }

    /// Noise of a part in a thousand of the deflections below.
    fn noise(index: usize) -> f64 {
        1e-3 * ((7 * index % 11) as f64 / 11.0 - 0.5)
    }

    fn part(of: impl Fn(f64) -> f64) -> Vec<f64> {
        let at = |index: usize| of(index as f64 / 99.0) + noise(index);
        (0..100).map(at).collect()
    }

    fn reversed(part: &[f64]) -> Vec<f64> {
        part.iter().rev().copied().collect()
    }

    /// The order of each part is that of time whichever way it is stored: pressed, in net tension where the ramp turns, at
    /// the limit of the detector, and with a pull-off just before the end.
    #[test]
    fn parts_are_put_in_the_order_of_time() {
        let pressed = part(|x| 5.0 * (x - 0.7).max(0.0));
        let limited = part(|x| (20.0 * (x - 0.7).max(0.0)).min(1.0));
        let jumped = part(|x| {
            if x > 0.95 {
                -1.0 + 4.0 * (x - 0.95)
            } else {
                0.0
            }
        });
        // After a jump at the end of the extension the retraction pulls further and lets go.
        let released = part(|x| if x < 0.3 { -0.8 - 2.0 * x } else { 0.0 });
        // Pull-off in the last tenth of the retraction changes the deflection more there than contact does where it begins.
        let late = part(|x| {
            if x < 0.94 {
                (1.0 - 2.0 * x).max(-0.7)
            } else {
                0.0
            }
        });
        assert_eq!(turns_at_end(&late), Some(true));
        let touched = part(|x| (5.0 * (x - 0.8)).max(0.0));
        for (extension, retraction) in [
            (pressed.clone(), reversed(&pressed)),
            (limited.clone(), reversed(&limited)),
            (jumped, released),
            (touched, late),
        ] {
            for turned in [[false, false], [true, false], [false, true], [true, true]] {
                let [mut first, mut second] = [(&extension, turned[0]), (&retraction, turned[1])]
                    .map(|(part, turned)| if turned { reversed(part) } else { part.clone() });
                turn(&mut first, &mut second);
                assert_eq!(first, extension, "{turned:?}");
                assert_eq!(second, retraction, "{turned:?}");
            }
        }
    }
}
