//! Params and scalars on the device: WGSL and bytes of the structs that are declared once, in
//! [`kernel`](crate::kernel).
//!
//! `real` is the number type of the fields, `wide` that of sums and scalars: f64 where the device has it,
//! else f32.

use rayon::prelude::*;

use crate::kernel::declare::{DeviceValue, FromDevice, Kind, Word, members};
use crate::kernel::{Params, Scalars, Status};

/// The number type of the fields of a level and of the arithmetic on them.
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

    /// Its name in a shader.
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

    /// Calls a function with the bytes of these doubles as numbers of this type.
    pub fn with_bytes<R>(self, values: &[f64], take: impl FnOnce(&[u8]) -> R) -> R {
        match self {
            Number::Single => {
                let singles: Vec<f32> = values.par_iter().map(|&value| value as f32).collect();
                take(bytemuck::cast_slice(&singles))
            }
            Number::Double => take(bytemuck::cast_slice(values)),
        }
    }

    /// Writes doubles as numbers of this type to as many bytes.
    pub fn write_bytes(self, values: &[f64], bytes: wgpu::WriteOnly<[u8]>) {
        let (shares, rest) = bytes.into_chunks::<SHARE>();
        let count = SHARE / self.bytes();
        let (whole, last) = values.split_at(count * shares.len());
        let shares: Vec<_> = shares.into_iter().zip(whole.chunks_exact(count)).collect();
        shares
            .into_par_iter()
            .for_each(|(bytes, values)| self.write_share(values, bytes.into()));
        self.write_share(last, rest);
    }

    fn write_share(self, values: &[f64], mut bytes: wgpu::WriteOnly<[u8]>) {
        match self {
            Number::Single => {
                let (numbers, _) = bytes.into_chunks();
                for (number, &value) in numbers.into_iter().zip(values) {
                    number.write((value as f32).to_ne_bytes());
                }
            }
            Number::Double => bytes.copy_from_slice(bytemuck::cast_slice(values)),
        }
    }

    /// Converts bytes of this type to as many doubles.
    pub fn read_bytes(self, bytes: &[u8], values: &mut [f64]) {
        match self {
            Number::Single => {
                let (numbers, _) = bytes.as_chunks();
                let each = values.par_iter_mut().zip(numbers);
                each.for_each(|(value, &number)| *value = f64::from(f32::from_ne_bytes(number)));
            }
            Number::Double => {
                let (numbers, _) = bytes.as_chunks();
                let each = values.par_iter_mut().zip(numbers);
                each.for_each(|(value, &number)| *value = f64::from_ne_bytes(number));
            }
        }
    }
}

/// Bytes that one thread writes at a time.
const SHARE: usize = 1 << 17;

/// The number type of sums and scalars.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Wide {
    /// Single precision, plain sums: where the compiler undoes compensation.
    Single,
    /// Single precision, compensated sums: where the device has no double precision.
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

    /// Bytes that a thread passes to others in a sum.
    pub fn part_bytes(self) -> usize {
        match self {
            Wide::Single => 4,
            Wide::Compensated | Wide::Double => 8,
        }
    }
}

/// Members of the params on a device: those of [`Params`], infinity, which WGSL cannot write as a literal,
/// and a zero that the compiler does not know to be zero.
pub fn params_members() -> Vec<(String, Kind)> {
    let mut all = members(Params::KIND);
    all.push(("infinity".to_owned(), Kind::Wide(1)));
    all.push(("zero".to_owned(), Kind::Count));
    all
}

fn declaration(name: &str, members: &[(String, Kind)]) -> String {
    let mut text = format!("struct {name} {{\n");
    for (member, kind) in members {
        let kind = match kind {
            Kind::Wide(1) => "wide".to_string(),
            Kind::Wide(count) => format!("array<wide, {count}>"),
            Kind::Count | Kind::Group(_) => "u32".to_string(),
        };
        text.push_str(&format!("    {member}: {kind},\n"));
    }
    text.push_str("}\n");
    text
}

/// The WGSL of `wide`, `Params`, `Scalars` and the names of a status.
pub fn declarations(wide: Wide) -> String {
    let mut text = format!(
        "alias wide = {};\n{}{}",
        wide.name(),
        declaration("Params", &params_members()),
        declaration("Scalars", &members(Scalars::KIND))
    );
    // Brings every finite number among those of single precision.
    let in_single = match wide {
        Wide::Double => "1e-270",
        Wide::Single | Wide::Compensated => "1.0",
    };
    text.push_str(&format!("const IN_SINGLE: wide = {in_single};\n"));
    for (number, (_, name)) in Status::ALL.iter().enumerate() {
        text.push_str(&format!("const {name}: u32 = {number}u;\n"));
    }
    text
}

fn length(members: &[(String, Kind)], wide: Wide) -> usize {
    let end = members.iter().fold(0usize, |end, (_, kind)| match kind {
        Kind::Wide(count) => end.next_multiple_of(wide.bytes()) + count * wide.bytes(),
        Kind::Count | Kind::Group(_) => end + size_of::<u32>(),
    });
    // A uniform buffer's length is a multiple of 16, which suits storage as well.
    end.next_multiple_of(16)
}

/// Bytes of the scalars on the device.
pub fn scalars_length(wide: Wide) -> usize {
    length(&members(Scalars::KIND), wide)
}

/// Bytes of the params on the device.
pub fn params_length(wide: Wide) -> usize {
    length(&params_members(), wide)
}

/// Appends a word where WGSL has its member.
fn append(bytes: &mut Vec<u8>, word: Word, wide: Wide) {
    match word {
        Word::Wide(value) => {
            bytes.resize(bytes.len().next_multiple_of(wide.bytes()), 0);
            match wide {
                Wide::Single | Wide::Compensated => {
                    bytes.extend(bytemuck::bytes_of(&(value as f32)));
                }
                Wide::Double => bytes.extend(bytemuck::bytes_of(&value)),
            }
        }
        Word::Count(value) => bytes.extend(bytemuck::bytes_of(&value)),
    }
}

/// The params as bytes.
pub fn params_bytes(params: &Params, wide: Wide) -> Vec<u8> {
    let mut bytes = Vec::new();
    params.give(&mut |word| append(&mut bytes, word, wide));
    append(&mut bytes, Word::Wide(f64::INFINITY), wide);
    append(&mut bytes, Word::Count(0), wide);
    bytes.resize(params_length(wide), 0);
    bytes
}

/// The scalars as bytes.
pub fn scalars_bytes(scalars: &Scalars, wide: Wide) -> Vec<u8> {
    let mut bytes = Vec::new();
    scalars.give(&mut |word| append(&mut bytes, word, wide));
    bytes.resize(scalars_length(wide), 0);
    bytes
}

/// The scalars from bytes read back; zeros beyond the end.
pub fn scalars_of(bytes: &[u8], wide: Wide) -> Scalars {
    debug_assert!(bytes.len() >= scalars_length(wide));
    let mut at = 0usize;
    let mut part = |size: usize| -> &[u8] {
        let start = at.next_multiple_of(size);
        at = start + size;
        bytes.get(start..at).unwrap_or(&[])
    };
    let single = size_of::<u32>();
    Scalars::take(&mut |kind| match (kind, wide) {
        (Kind::Wide(_), Wide::Double) => {
            let value: Option<f64> = bytemuck::try_pod_read_unaligned(part(wide.bytes())).ok();
            Word::Wide(value.unwrap_or(0.0))
        }
        (Kind::Wide(_), Wide::Single | Wide::Compensated) => {
            let value: Option<f32> = bytemuck::try_pod_read_unaligned(part(single)).ok();
            Word::Wide(f64::from(value.unwrap_or(0.0)))
        }
        (Kind::Count | Kind::Group(_), _) => {
            Word::Count(bytemuck::try_pod_read_unaligned(part(single)).unwrap_or(0))
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every member has another value, and each comes back where it was.
    #[test]
    fn scalars_survive_the_way_there_and_back() {
        for wide in [Wide::Single, Wide::Compensated, Wide::Double] {
            let mut next = 0u32;
            let scalars = Scalars::take(&mut |kind| {
                next += 1;
                match kind {
                    Kind::Wide(_) => Word::Wide(f64::from(next) + 0.5),
                    _ => Word::Count(next),
                }
            });
            assert!(next > 70, "{next} words");
            let bytes = scalars_bytes(&scalars, wide);
            assert_eq!(bytes.len(), scalars_length(wide));
            let back = scalars_of(&bytes, wide);
            assert_eq!(format!("{scalars:?}"), format!("{back:?}"));
        }
    }
}
