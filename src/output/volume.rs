//! The fields of a step as VTK image data (`.vti`) for ParaView.

use std::io::{self, Write};
use std::path::Path;

use super::error::OutputError;
use super::folder::stream_within;
use crate::grid::Grid;
use crate::scene::FieldName;

/// Bytes of the length before each array.
const LENGTH_BYTES: usize = 8;

/// Writes fields of one step, each with one value a point of `grid`, in SI units; `rows_of` hands out their rows.
///
/// Values belong to points: point (ix, iy) is at x = ix dx, y = iy dy, z = 0. Numbers are float64,
/// or float32 with `single`, as in the `.npy` files beside it.
///
/// # Source
/// VTK XML file formats, "ImageData" and "Appended raw data": after the underscore stand, for each
/// array at its offset, its length in bytes (as `header_type` says) and its values, x fastest.
pub fn write_volume(
    path: &Path,
    grid: &Grid,
    fields: &[FieldName],
    rows_of: &mut RowsOf,
    single: bool,
) -> Result<(), OutputError> {
    stream_within(path, |file| encode(file, grid, fields, rows_of, single))
}

/// The rows of each field by name, as [`FieldRows`](super::fields::FieldRows) are handed out.
pub type RowsOf<'a> = dyn FnMut(FieldName, &mut dyn FnMut(&[f64])) + 'a;

/// The last bytes of every volume.
pub const VOLUME_END: &[u8] = b"\n</VTKFile>\n";

fn encode(
    out: &mut impl Write,
    grid: &Grid,
    fields: &[FieldName],
    rows_of: &mut RowsOf,
    single: bool,
) -> io::Result<()> {
    let (kind, width) = if single {
        ("Float32", 4)
    } else {
        ("Float64", 8)
    };
    let array = width * grid.len();
    let extent = format!("0 {} 0 {} 0 0", grid.nx - 1, grid.ny - 1);
    let (dx, dy) = (grid.dx(), grid.dy());
    let mut head = format!(
        "<?xml version=\"1.0\"?>\n\
         <VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n\
         \x20 <ImageData WholeExtent=\"{extent}\" Origin=\"0 0 0\" Spacing=\"{dx:?} {dy:?} {dx:?}\">\n\
         \x20   <Piece Extent=\"{extent}\">\n"
    );
    let first = fields.first().map_or("", |field| field.name());
    head.push_str(&format!("      <PointData Scalars=\"{first}\">\n"));
    for (index, field) in fields.iter().enumerate() {
        let offset = index * (LENGTH_BYTES + array);
        head.push_str(&format!(
            "        <DataArray type=\"{kind}\" Name=\"{}\" NumberOfComponents=\"1\" format=\"appended\" offset=\"{offset}\"/>\n",
            field.name()
        ));
    }
    head.push_str(
        "      </PointData>\n      <CellData/>\n    </Piece>\n  </ImageData>\n  <AppendedData encoding=\"raw\">\n_",
    );
    out.write_all(head.as_bytes())?;
    for field in fields {
        out.write_all(&(array as u64).to_le_bytes())?;
        let (mut written, mut count) = (Ok(()), 0);
        rows_of(*field, &mut |values| {
            count += values.len();
            if written.is_ok() {
                written = write_values(out, values, single);
            }
        });
        written?;
        if count != grid.len() {
            return Err(io::Error::other("rows of the field are missing"));
        }
    }
    out.write_all(b"\n  </AppendedData>")?;
    out.write_all(VOLUME_END)
}

/// Values whose bytes are written at once: written one by one, they take longer than the disk.
const AT_ONCE: usize = 1 << 13;

/// Writes values, the lowest byte of each first.
fn write_values(out: &mut impl Write, values: &[f64], single: bool) -> io::Result<()> {
    let mut bytes = Vec::with_capacity(size_of::<f64>() * AT_ONCE);
    for values in values.chunks(AT_ONCE) {
        bytes.clear();
        if single {
            bytes.extend(
                values
                    .iter()
                    .flat_map(|value| (*value as f32).to_le_bytes()),
            );
        } else {
            bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        }
        out.write_all(&bytes)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The text between `before` and the next `after`.
    fn between<'t>(text: &'t str, before: &str, after: &str) -> &'t str {
        let start = text.find(before).expect(before) + before.len();
        let length = text[start..].find(after).expect(after);
        &text[start..start + length]
    }

    /// Arrays by name, read as the format says; fails on anything left over.
    fn parse(bytes: &[u8]) -> Vec<(String, Vec<f64>)> {
        let mark = b"<AppendedData encoding=\"raw\">";
        let at = bytes.windows(mark.len()).position(|w| w == mark).unwrap() + mark.len();
        let head = std::str::from_utf8(&bytes[..at]).unwrap();
        let underscore = at + bytes[at..].iter().position(|byte| *byte == b'_').unwrap();
        assert!(bytes[at..underscore].iter().all(u8::is_ascii_whitespace));
        let data = &bytes[underscore + 1..];
        let extent: Vec<usize> = between(head, "WholeExtent=\"", "\"")
            .split(' ')
            .map(|n| n.parse().unwrap())
            .collect();
        let points = (extent[1] - extent[0] + 1) * (extent[3] - extent[2] + 1);
        let mut end = 0;
        let mut arrays = Vec::new();
        for array in head.split("<DataArray ").skip(1) {
            let offset: usize = between(array, "offset=\"", "\"").parse().unwrap();
            assert_eq!(offset, end, "arrays follow each other");
            let width = match between(array, "type=\"", "\"") {
                "Float64" => 8,
                "Float32" => 4,
                other => panic!("{other}"),
            };
            let length = u64::from_le_bytes(data[offset..offset + 8].try_into().unwrap()) as usize;
            assert_eq!(length, width * points);
            let values = data[offset + 8..offset + 8 + length]
                .chunks_exact(width)
                .map(|chunk| match width {
                    8 => f64::from_le_bytes(chunk.try_into().unwrap()),
                    _ => f32::from_le_bytes(chunk.try_into().unwrap()).into(),
                })
                .collect();
            end = offset + 8 + length;
            arrays.push((between(array, "Name=\"", "\"").to_owned(), values));
        }
        let rest = std::str::from_utf8(&data[end..]).unwrap();
        let rest: String = rest.split_whitespace().collect();
        assert_eq!(rest, "</AppendedData></VTKFile>");
        arrays
    }

    #[test]
    fn fields_read_back_with_their_names_and_places() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("fields/step_0001.vti");
        let grid = Grid::new([3, 2], [3e-6, 1e-6]);
        // Bytes that spell the end marker inside the data are still data.
        let tricky = f64::from_le_bytes(*b"</Append");
        let gap = vec![0.0, -1.5, 2e-9, f64::MIN_POSITIVE, tricky, 5.1];
        let pressure = vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.1];
        let fields = [FieldName::Gap, FieldName::Pressure];
        let mut rows_of = |field: FieldName, take: &mut dyn FnMut(&[f64])| {
            let values = match field {
                FieldName::Gap => &gap,
                _ => &pressure,
            };
            values.chunks(3).for_each(take);
        };
        write_volume(&path, &grid, &fields, &mut rows_of, false).unwrap();
        let bytes = std::fs::read(&path).unwrap();
        assert_eq!(
            parse(&bytes),
            [
                ("gap".to_owned(), gap.clone()),
                ("pressure".to_owned(), pressure.clone())
            ]
        );
        let head = String::from_utf8_lossy(&bytes);
        assert!(head.contains("WholeExtent=\"0 2 0 1 0 0\""));
        assert!(head.contains("Spacing=\"1e-6 5e-7 1e-6\""));

        write_volume(&path, &grid, &fields, &mut rows_of, true).unwrap();
        let arrays = parse(&std::fs::read(&path).unwrap());
        assert_eq!(arrays[1].1[5], f64::from(6.1f32));
    }
}
