//! The numbers of the algorithm as the device holds them: structs of plain members in one order,
//! written once here for the WGSL and for the bytes.
//!
//! `real` is the number of the fields; `wide` the one in which sums and scalars are kept: f64 where the
//! device has it, else f32.

use crate::kernel::{Params, REACHED, SUMS, Scalars, Status, scalar};
use crate::law::Law;

/// The number in which the fields of a level are kept, and all that is done to them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Number {
    /// Single precision.
    Single,
    /// Double precision, where the device has it.
    Double,
}

impl Number {
    /// Its name in WGSL.
    pub fn name(self) -> &'static str {
        match self {
            Number::Single => "f32",
            Number::Double => "f64",
        }
    }

    /// What a shader calls it.
    pub fn declaration(self) -> String {
        format!("alias real = {};\n", self.name())
    }

    /// Bytes of one.
    pub fn bytes(self) -> usize {
        match self {
            Number::Single => size_of::<f32>(),
            Number::Double => size_of::<f64>(),
        }
    }

    /// Relative rounding error.
    pub fn epsilon(self) -> f64 {
        match self {
            Number::Single => f64::from(f32::EPSILON),
            Number::Double => f64::EPSILON,
        }
    }

    /// Doubles as the bytes of these.
    pub fn bytes_of(self, values: impl IntoIterator<Item = f64>) -> impl Iterator<Item = u8> {
        values.into_iter().flat_map(move |value| {
            let (bytes, count) = match self {
                Number::Single => {
                    let mut bytes = [0; size_of::<f64>()];
                    bytes[..size_of::<f32>()].copy_from_slice(&(value as f32).to_le_bytes());
                    (bytes, size_of::<f32>())
                }
                Number::Double => (value.to_le_bytes(), size_of::<f64>()),
            };
            bytes.into_iter().take(count)
        })
    }

    /// The numbers that bytes from the device are.
    pub fn values_of(self, bytes: &[u8]) -> Vec<f64> {
        match self {
            Number::Single => {
                let (values, _) = bytes.as_chunks();
                values
                    .iter()
                    .map(|&bytes| f64::from(f32::from_le_bytes(bytes)))
                    .collect()
            }
            Number::Double => {
                let (values, _) = bytes.as_chunks();
                values
                    .iter()
                    .map(|&bytes| f64::from_le_bytes(bytes))
                    .collect()
            }
        }
    }
}

/// The kind of number that sums and scalars are kept in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Wide {
    /// Single precision, sums plain: where the device undoes compensation.
    Single,
    /// Single precision, sums with what rounding takes from them: where the device has no other.
    Compensated,
    /// Double precision.
    Double,
}

impl Wide {
    /// Its name in WGSL.
    pub fn name(self) -> &'static str {
        match self {
            Wide::Single | Wide::Compensated => "f32",
            Wide::Double => "f64",
        }
    }

    /// Bytes of one number.
    pub fn bytes(self) -> usize {
        match self {
            Wide::Single | Wide::Compensated => 4,
            Wide::Double => 8,
        }
    }

    /// Bytes of what passes between threads of a sum.
    pub fn part_bytes(self) -> usize {
        match self {
            Wide::Single => 4,
            Wide::Compensated | Wide::Double => 8,
        }
    }
}

/// A struct member: so many wide numbers, or one u32 where the count is 0.
type Member = (&'static str, usize);

const SCALARS: &[Member] = &[
    ("sums", SUMS),
    ("mean_pressure", 1),
    ("offset", 1),
    ("descent", 1),
    ("memory", 1),
    ("shift", 1),
    ("trial", 1),
    ("restore", 1),
    ("slope", 1),
    ("curvature", 1),
    ("elastic_slope", 1),
    ("up", 1),
    ("down", 1),
    ("step", 1),
    ("length", 1),
    ("step_first", 1),
    ("largest", 1),
    ("snap", 1),
    ("carried", 2),
    ("low", 3),
    ("reached", REACHED),
    ("high", 2),
    ("slope_at_one", 1),
    ("residual", 1),
    ("numerator", 1),
    ("residual_at_stall", 1),
    ("least_gap", 1),
    ("gap_norm", 1),
    ("status", 0),
    ("repeat", 0),
    ("restart", 0),
    ("accepted", 0),
    ("truncated", 0),
    ("searching", 0),
    ("careful", 0),
    ("evaluations", 0),
    ("lost", 0),
    ("stalls", 0),
    ("at_floor", 0),
    ("iterations", 0),
];

const PARAMS: &[Member] = &[
    ("law_work", 1),
    ("law_range", 1),
    ("law_peak", 1),
    ("law_taper", 1),
    ("law_peak_gap", 1),
    ("stiffness_max", 1),
    ("pressure_floor", 1),
    ("tolerance", 1),
    ("heights_norm", 1),
    ("core_stiffness", 1),
    ("hardness", 1),
    ("epsilon", 1),
    ("infinity", 1),
    ("snap_share", 1),
    ("law_has_tail", 0),
    ("fixed_gap", 0),
    ("may_detach", 0),
    // Zero, which no compiler knows.
    ("zero", 0),
];

fn declaration(name: &str, members: &[Member]) -> String {
    let mut text = format!("struct {name} {{\n");
    for (member, count) in members {
        let kind = match count {
            0 => "u32".to_string(),
            1 => "wide".to_string(),
            _ => format!("array<wide, {count}>"),
        };
        text.push_str(&format!("    {member}: {kind},\n"));
    }
    text.push_str("}\n");
    text
}

/// The WGSL of `Params`, `Scalars` and `wide`.
pub fn declarations(wide: Wide) -> String {
    format!(
        "alias wide = {};\n{}{}",
        wide.name(),
        declaration("Params", PARAMS),
        declaration("Scalars", SCALARS)
    )
}

fn length(members: &[Member], wide: Wide) -> usize {
    let bytes: usize = members
        .iter()
        .map(|&(_, count)| if count == 0 { 4 } else { count * wide.bytes() })
        .sum();
    // A uniform buffer's length is a multiple of 16, which suits storage as well.
    bytes.next_multiple_of(16)
}

/// Bytes of the scalars on the device.
pub fn scalars_length(wide: Wide) -> usize {
    length(SCALARS, wide)
}

/// Bytes of the params on the device.
pub fn params_length(wide: Wide) -> usize {
    length(PARAMS, wide)
}

struct Writer {
    bytes: Vec<u8>,
    wide: Wide,
}

impl Writer {
    fn number(&mut self, value: f64) {
        match self.wide {
            Wide::Single | Wide::Compensated => self.bytes.extend((value as f32).to_le_bytes()),
            Wide::Double => self.bytes.extend(value.to_le_bytes()),
        }
    }

    fn count(&mut self, value: u32) {
        self.bytes.extend(value.to_le_bytes());
    }

    fn finish(mut self, length: usize) -> Vec<u8> {
        debug_assert!(self.bytes.len() <= length);
        self.bytes.resize(length, 0);
        self.bytes
    }
}

/// The params as bytes.
pub fn params_bytes(params: &Params, wide: Wide) -> Vec<u8> {
    let (taper, peak_gap) = match params.law {
        Law::MaugisDugdale(law) => (law.taper, 0.0),
        Law::LennardJones(law) => (0.0, law.peak_gap()),
        _ => (0.0, 0.0),
    };
    let mut writer = Writer {
        bytes: Vec::new(),
        wide,
    };
    for value in [
        params.law.work_of_adhesion(),
        params.law.range(),
        params.law.peak_tension(),
        taper,
        peak_gap,
        params.stiffness_max,
        params.pressure_floor,
        params.tolerance,
        params.heights_norm,
        params.core_stiffness,
        params.hardness,
        params.epsilon,
        f64::INFINITY,
        // Of the largest step: gaps below it after a step to first contact are rounding.
        scalar::LEAST_SNAP.max(scalar::SNAP_ROUNDINGS * params.epsilon),
    ] {
        writer.number(value);
    }
    for value in [params.law.has_tail(), params.fixed_gap, params.may_detach] {
        writer.count(u32::from(value));
    }
    writer.count(0);
    writer.finish(params_length(wide))
}

/// The number by which a status is known in WGSL.
fn status_number(status: Status) -> u32 {
    match status {
        Status::Running => 0,
        Status::Converged => 1,
        Status::Stalled => 2,
        Status::PulledOff => 3,
        Status::NotFinite => 4,
    }
}

/// The status of a number; one that no shader writes means that memory was not what it should be.
fn status_of(number: u32) -> Status {
    match number {
        0 => Status::Running,
        1 => Status::Converged,
        2 => Status::Stalled,
        3 => Status::PulledOff,
        _ => Status::NotFinite,
    }
}

/// The scalars as bytes.
pub fn scalars_bytes(scalars: &Scalars, wide: Wide) -> Vec<u8> {
    let mut writer = Writer {
        bytes: Vec::new(),
        wide,
    };
    let s = scalars;
    let single = [
        s.mean_pressure,
        s.offset,
        s.descent,
        s.memory,
        s.shift,
        s.trial,
        s.restore,
        s.slope,
        s.curvature,
        s.elastic_slope,
        s.up,
        s.down,
        s.step,
        s.length,
        s.step_first,
        s.largest,
        s.snap,
    ];
    let last = [
        s.slope_at_one,
        s.residual,
        s.numerator,
        s.residual_at_stall,
        s.least_gap,
        s.gap_norm,
    ];
    for value in s
        .sums
        .iter()
        .chain(&single)
        .chain(&s.carried)
        .chain(&s.low)
        .chain(&s.reached)
        .chain(&s.high)
        .chain(&last)
    {
        writer.number(*value);
    }
    writer.count(status_number(s.status));
    for value in [
        s.repeat,
        s.restart,
        s.accepted,
        s.truncated,
        s.searching,
        s.careful,
    ] {
        writer.count(u32::from(value));
    }
    for value in [s.evaluations, s.lost, s.stalls, s.at_floor, s.iterations] {
        writer.count(value);
    }
    writer.finish(scalars_length(wide))
}

struct Reader<'a> {
    bytes: &'a [u8],
    wide: Wide,
}

impl Reader<'_> {
    /// The next `N` bytes; zeros beyond the end, which `scalars_of` has excluded.
    fn take<const N: usize>(&mut self) -> [u8; N] {
        match self.bytes.split_first_chunk::<N>() {
            Some((first, rest)) => {
                self.bytes = rest;
                *first
            }
            None => [0; N],
        }
    }

    fn number(&mut self) -> f64 {
        match self.wide {
            Wide::Single | Wide::Compensated => f64::from(f32::from_le_bytes(self.take())),
            Wide::Double => f64::from_le_bytes(self.take()),
        }
    }

    fn numbers<const N: usize>(&mut self) -> [f64; N] {
        std::array::from_fn(|_| self.number())
    }

    fn count(&mut self) -> u32 {
        u32::from_le_bytes(self.take())
    }

    fn flag(&mut self) -> bool {
        self.count() != 0
    }
}

/// The scalars of bytes that the device gave back.
pub fn scalars_of(bytes: &[u8], wide: Wide) -> Scalars {
    debug_assert!(bytes.len() >= scalars_length(wide));
    let mut r = Reader { bytes, wide };
    // Members are read in the order in which they are written here: that of `SCALARS`.
    Scalars {
        sums: r.numbers(),
        mean_pressure: r.number(),
        offset: r.number(),
        descent: r.number(),
        memory: r.number(),
        shift: r.number(),
        trial: r.number(),
        restore: r.number(),
        slope: r.number(),
        curvature: r.number(),
        elastic_slope: r.number(),
        up: r.number(),
        down: r.number(),
        step: r.number(),
        length: r.number(),
        step_first: r.number(),
        largest: r.number(),
        snap: r.number(),
        carried: r.numbers(),
        low: r.numbers(),
        reached: r.numbers(),
        high: r.numbers(),
        slope_at_one: r.number(),
        residual: r.number(),
        numerator: r.number(),
        residual_at_stall: r.number(),
        least_gap: r.number(),
        gap_norm: r.number(),
        status: status_of(r.count()),
        repeat: r.flag(),
        restart: r.flag(),
        accepted: r.flag(),
        truncated: r.flag(),
        searching: r.flag(),
        careful: r.flag(),
        evaluations: r.count(),
        lost: r.count(),
        stalls: r.count(),
        at_floor: r.count(),
        iterations: r.count(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scalars_survive_the_way_there_and_back() {
        let mut scalars = Scalars::start(0.25, true);
        scalars.low = [1.0, 2.0, 3.0];
        scalars.high = [4.0, f64::INFINITY];
        scalars.gap_norm = 5.0;
        scalars.status = Status::PulledOff;
        scalars.iterations = 17;
        scalars.at_floor = 3;
        for wide in [Wide::Single, Wide::Compensated, Wide::Double] {
            let bytes = scalars_bytes(&scalars, wide);
            assert_eq!(bytes.len(), scalars_length(wide));
            let back = scalars_of(&bytes, wide);
            assert_eq!(format!("{scalars:?}"), format!("{back:?}"));
        }
    }
}
