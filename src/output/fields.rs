//! Fields as `.npy`, for notebooks.

use std::path::Path;

use npyz::WriterBuilder;

use super::error::OutputError;
use super::folder::stream_within;
use crate::grid::Grid;

/// Writes a field as a float64 array of shape `[ny, nx]`, row-major, in SI units.
///
/// `values` has one value a point of `grid`.
pub fn write_field(path: &Path, grid: &Grid, values: &[f64]) -> Result<(), OutputError> {
    write_array(path, grid, &mut |take| take(values), |value| value)
}

/// The same in float32, the precision of a run in single precision.
pub fn write_field_single(path: &Path, grid: &Grid, values: &[f64]) -> Result<(), OutputError> {
    write_array(path, grid, &mut |take| take(values), |value| value as f32)
}

/// The rows of a field: hands them to what takes them one after another, some at once, and to its end whatever becomes
/// of those before.
pub type FieldRows<'a> = dyn FnMut(&mut dyn FnMut(&[f64])) + 'a;

/// The same of rows that are handed out one after another, in float32 with `single`.
pub fn write_field_rows(
    path: &Path,
    grid: &Grid,
    rows: &mut FieldRows,
    single: bool,
) -> Result<(), OutputError> {
    if single {
        write_array(path, grid, rows, |value| value as f32)
    } else {
        write_array(path, grid, rows, |value| value)
    }
}

/// Fails where the number of values is not that of the points.
fn write_array<T>(
    path: &Path,
    grid: &Grid,
    rows: &mut FieldRows,
    number: impl Fn(f64) -> T,
) -> Result<(), OutputError>
where
    T: npyz::AutoSerialize,
{
    stream_within(path, |file| {
        let mut writer = npyz::WriteOptions::new()
            .default_dtype()
            .shape(&[grid.ny as u64, grid.nx as u64])
            .writer(file)
            .begin_nd()?;
        let mut written = Ok(());
        rows(&mut |values| {
            if written.is_ok() {
                written = writer.extend(values.iter().map(|value| number(*value)));
            }
        });
        written?;
        writer.finish()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_read_back_with_rows_along_y() {
        let place = tempfile::tempdir().unwrap();
        let grid = Grid::new([3, 2], [1.0, 1.0]);
        let values = [0.0, -1.5, 2e-9, f64::MIN_POSITIVE, 4.0, 5.1];
        let path = place.path().join("fields/step_0001_gap.npy");
        write_field(&path, &grid, &values).unwrap();
        let bytes = std::fs::read(&path).unwrap();
        let file = npyz::NpyFile::new(&bytes[..]).unwrap();
        assert_eq!(file.shape(), [2, 3]);
        assert_eq!(file.order(), npyz::Order::C);
        assert_eq!(file.into_vec::<f64>().unwrap(), values);

        write_field_single(&path, &grid, &values).unwrap();
        let bytes = std::fs::read(&path).unwrap();
        let file = npyz::NpyFile::new(&bytes[..]).unwrap();
        assert_eq!(file.into_vec::<f32>().unwrap()[5], 5.1f32);
    }
}
