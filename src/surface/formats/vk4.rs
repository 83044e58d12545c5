//! Keyence's maps (.vk3, .vk4): a table of offsets, the settings, images; heights as unsigned integers. Those of .vk6 and
//! .vk7 are the same in a ZIP archive behind a prefix.
//!
//! # Source
//! Keyence, "VK4 file format", as in Walker, "vk4-driver", OSTI 1419732 (2017).

use std::fs::File;
use std::io::BufReader;

use super::bytes::{Bytes, Opening, checked_shape};
use crate::surface::file_error::FileError;
use crate::surface::matrix::{Map, Matrix, Size};

/// First bytes of a file.
pub(super) const MAGIC: [&[u8]; 4] = [b"VK3_", b"VK4_", b"VK6", b"VK7"];

/// The map within an archive.
#[cfg(feature = "images")]
const MEMBER: &str = "Vk4File";

/// Offsets of the table, and of the entry for heights in it.
const TABLE: usize = 12;
const HEIGHTS: usize = TABLE + 6 * 4;

/// Offset of the lengths of a pixel and of a step of the heights in the settings, pm.
const LENGTHS: usize = 42 * 4;

/// Metres in the format's unit of length.
const PICOMETRE: f64 = 1e-12;

/// Bytes of the palette before the heights.
const PALETTE: usize = 768;

/// Points along x and y, which the length of an archive does not tell.
pub(super) fn claimed_points(file: BufReader<File>) -> Option<[usize; 2]> {
    let length = usize::try_from(file.get_ref().metadata().ok()?.len()).ok()?;
    let map = read(Bytes::new(file, length, Opening::Glance)).ok()?;
    Some([map.columns, map.rows])
}

/// Reads the first map of heights.
pub(super) fn read(file: Bytes) -> Result<Map, FileError> {
    let start = file.beginning(MAGIC[2].len())?;
    if start == MAGIC[2] || start == MAGIC[3] {
        return read_map(member(file)?);
    }
    read_map(file)
}

/// The map within an archive.
#[cfg(feature = "images")]
fn member(file: Bytes) -> Result<Bytes, FileError> {
    use super::zip_entry::ZipEntry;

    let file = file.named(".vk6");
    let broken = |what: String| file.broken(0, what);
    let archive = zip::ZipArchive::new(file.stream());
    let mut archive =
        archive.map_err(|error| broken(format!("its archive is not whole ({error})")))?;
    let entry = ZipEntry::open(&file, &mut archive, MEMBER);
    let entry = entry
        .map_err(|error| broken(format!("{MEMBER} of its archive cannot be read ({error})")))?;
    let length = usize::try_from(entry.length()).unwrap_or(usize::MAX);
    let opening = file.opening();
    Ok(Bytes::new(entry, length, opening))
}

#[cfg(not(feature = "images"))]
fn member(_: Bytes) -> Result<Bytes, FileError> {
    Err(FileError::NotSupported {
        what: "Keyence archives (.vk6, .vk7) in a build without images",
        instead: "save the map as .vk4",
    })
}

/// Reads the first map of heights of a file that is no archive.
fn read_map(file: Bytes) -> Result<Map, FileError> {
    let mut file = file.named(".vk4");
    file.seek(TABLE, "the table of offsets")?;
    let settings = file.u32("the offset of the settings")? as usize;
    file.seek(HEIGHTS, "the table of offsets")?;
    let heights = file.u32("the offset of the heights")? as usize;
    if heights == 0 {
        return Err(file.broken(HEIGHTS, "it holds no heights"));
    }
    file.seek(settings.saturating_add(LENGTHS), "the settings")?;
    let mut lengths = [0.0; 3];
    for length in &mut lengths {
        *length = f64::from(file.u32("the settings")?) * PICOMETRE;
    }
    let [dx, dy, step] = lengths;
    file.seek(heights, "the heights")?;
    let columns = file.u32("the number of columns")?;
    let rows = file.u32("the number of rows")?;
    let place = file.offset();
    let bits = file.u32("the bits of a height")?;
    let shape = checked_shape(rows.into(), columns.into())?;
    file.take(4 * 4 + PALETTE, "the palette")?;
    let values = match bits {
        8 => file.packed(shape, |number| u8::from_le_bytes(number).into())?,
        16 => file.packed(shape, |number| u16::from_le_bytes(number).into())?,
        32 => file.packed(shape, |number| u32::from_le_bytes(number).into())?,
        other => {
            let what = format!("heights of {other} bits; 8, 16 and 32 are known");
            return Err(file.broken(place, what));
        }
    };
    let size = [dx * f64::from(columns), dy * f64::from(rows)];
    Ok(Matrix {
        size: (dx > 0.0 && dy > 0.0).then_some(Size::Metres(size)),
        unit: (step > 0.0).then_some(step),
        ..Matrix::new(values, shape)
    })
}
