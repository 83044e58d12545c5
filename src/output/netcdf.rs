//! A run in one self-describing file: curve, fields, units and scene as netCDF-4, after the CF conventions, which
//! xarray and ParaView open.
//!
//! It is made of the files of the run's folder, so that any run can be told later in this form.

use std::fs::{self, File};
use std::io::{self, BufReader, Read};
use std::path::{Path, PathBuf};

use csv::StringRecord;
use netcdf::{FileMut, NcTypeDescriptor};
use npyz::{DType, Deserialize, NpyFile};
use serde_json::Value;

use super::curve;
use super::error::OutputError;
use super::folder::files_of_fields;
use super::target::expect_apart;
use super::whole_file::hidden_file;
use crate::scene::FieldName;

/// Conventions that the file keeps.
const CONVENTIONS: &str = "CF-1.10";
/// Rows of a field that are read, and compressed, together.
const ROWS_TOGETHER: usize = 64;
/// Level of compression: the fastest. Pressures are zero over most of a light contact.
const COMPRESSION: i32 = 1;
/// Bytes of a volume's head, in which its spacing stands.
const HEAD: u64 = 4096;

/// Writes the run in the folder `run` to `file`, in one piece.
///
/// `curve.csv` becomes variables over `step`; the fields that the run has written become variables over
/// `(field_step, y, x)`, where `field_step` holds the numbers of their steps; `summary.json`, which has the scene,
/// becomes the attributes `scene` and `summary`, and its numbers attributes of their own.
///
/// # Errors
/// A folder without a run; files of it that are damaged; what the system or the library says.
pub fn write_netcdf(run: &Path, file: &Path) -> Result<(), OutputError> {
    let [curve, summary_path] = ["curve.csv", "summary.json"].map(|name| run.join(name));
    let table = Table::read(&curve)?;
    let summary = read_summary(&summary_path)?;
    let fields = files_of_fields(&run.join("fields"), ".npy");
    let fields_read = fields.iter().map(|(_, _, path)| path.as_path());
    expect_apart([file], fields_read.chain([curve.as_path(), &summary_path]))?;
    let hidden = hidden_file(file);
    let failed = |error: netcdf::Error| {
        OutputError::write("write", file)(match error {
            netcdf::Error::Netcdf(code) if code > 0 => io::Error::from_raw_os_error(code),
            other => io::Error::other(other),
        })
    };
    let written = (|| {
        let mut out = netcdf::create(&hidden).map_err(failed)?;
        write_head(&mut out, &summary).map_err(failed)?;
        table.write(&mut out).map_err(failed)?;
        if !fields.is_empty() {
            Fields::find(run, fields)?.write(&mut out, &failed)?;
        }
        out.close().map_err(failed)?;
        fs::rename(&hidden, file).map_err(OutputError::write("write", file))
    })();
    if written.is_err() {
        // What is left of it is of no use; the message is that of the first failure.
        let _ = fs::remove_file(&hidden);
    }
    written
}

/// Reads `summary.json`.
fn read_summary(path: &Path) -> Result<Value, OutputError> {
    let text = fs::read_to_string(path).map_err(not_a_run(path))?;
    serde_json::from_str(&text)
        .map_err(|error| OutputError::refused(path, format!("is damaged ({error})")))
}

/// The refusal of a folder in which a file of a run is missing; another failure to read it is the system's.
fn not_a_run(path: &Path) -> impl FnOnce(io::Error) -> OutputError {
    let path = path.to_path_buf();
    move |error| match error.kind() {
        io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => OutputError::refused(
            &path,
            "is not there; name the folder of a run that tabor run has ended",
        ),
        _ => OutputError::write("read", &path)(error),
    }
}

/// Attributes of the whole file.
fn write_head(out: &mut FileMut, summary: &Value) -> netcdf::Result<()> {
    out.add_attribute("Conventions", CONVENTIONS)?;
    let title = summary["scene"]["title"].as_str();
    out.add_attribute("title", title.unwrap_or("Contact of rough surfaces"))?;
    let version = summary["version"].as_str().unwrap_or_default();
    out.add_attribute("source", format!("tabor {version}"))?;
    out.add_attribute("scene", summary["scene"].to_string())?;
    out.add_attribute("summary", summary.to_string())?;
    for (name, value) in summary.as_object().into_iter().flatten() {
        if let Some(number) = value.as_f64() {
            out.add_attribute(name, number)?;
        }
    }
    Ok(())
}

/// `curve.csv`, its cells as texts.
struct Table {
    head: StringRecord,
    rows: Vec<StringRecord>,
}

impl Table {
    fn read(path: &Path) -> Result<Table, OutputError> {
        let file = File::open(path).map_err(not_a_run(path))?;
        let damaged = |error: csv::Error| {
            OutputError::refused(path, format!("is not a table that tabor wrote ({error})"))
        };
        let mut reader = csv::Reader::from_reader(file);
        let head = reader.headers().map_err(damaged)?.clone();
        let rows = reader
            .records()
            .collect::<Result<_, _>>()
            .map_err(damaged)?;
        Ok(Table { head, rows })
    }

    fn write(&self, out: &mut FileMut) -> netcdf::Result<()> {
        out.add_dimension("step", self.rows.len())?;
        for (column, name) in self.head.iter().enumerate() {
            let cells = || self.rows.iter().map(move |row| &row[column]);
            match name {
                "state" => {
                    let mut variable = out.add_string_variable(name, &["step"])?;
                    for (row, word) in cells().enumerate() {
                        variable.put_string(word, [row])?;
                    }
                }
                "converged" => {
                    let values: Vec<i8> = cells().map(|cell| i8::from(cell == "true")).collect();
                    put(out, name, &values)?;
                }
                "step" | "iterations" => {
                    let values: Vec<i64> = cells().map(|cell| cell.parse().unwrap_or(-1)).collect();
                    put(out, name, &values)?;
                }
                _ => {
                    let values: Vec<f64> = cells()
                        .map(|cell| cell.parse().unwrap_or(f64::NAN))
                        .collect();
                    put(out, name, &values)?;
                }
            }
            let unit = curve::unit_of(name, |other| self.head.iter().any(|head| head == other));
            describe(out, name, &name.replace('_', " "), unit)?;
        }
        Ok(())
    }
}

/// Adds a variable over the steps.
fn put<T: NcTypeDescriptor>(out: &mut FileMut, name: &str, values: &[T]) -> netcdf::Result<()> {
    out.add_variable::<T>(name, &["step"])?
        .put_values(values, ..)
}

/// Gives a variable its name in words and its unit; a share has the unit 1.
fn describe(out: &mut FileMut, name: &str, words: &str, unit: &str) -> netcdf::Result<()> {
    let Some(mut variable) = out.variable_mut(name) else {
        return Ok(());
    };
    variable.put_attribute("long_name", words)?;
    match unit {
        "" => {}
        "%" => _ = variable.put_attribute("units", "1")?,
        unit => _ = variable.put_attribute("units", unit)?,
    }
    Ok(())
}

/// The fields of a run as files, all of one grid.
struct Fields {
    files: Vec<(usize, FieldName, PathBuf)>,
    /// Numbers of the steps that have some, rising.
    steps: Vec<usize>,
    /// Points along x and y.
    points: [usize; 2],
    /// Distance of two points along x and y, m.
    spacing: [f64; 2],
    in_single: bool,
}

impl Fields {
    /// Reads the heads of the files.
    fn find(run: &Path, files: Vec<(usize, FieldName, PathBuf)>) -> Result<Fields, OutputError> {
        let mut steps: Vec<usize> = files.iter().map(|(step, _, _)| *step).collect();
        steps.dedup();
        let (_, _, first) = &files[0];
        let head = open(first)?;
        let &[ny, nx] = head.shape() else {
            return Err(damaged(first));
        };
        let volume = run.join("fields").join(format!("step_{:04}.vti", steps[0]));
        Ok(Fields {
            steps,
            points: [nx as usize, ny as usize],
            spacing: spacing(&volume)?,
            in_single: is_single(&head.dtype()),
            files,
        })
    }

    fn write(
        &self,
        out: &mut FileMut,
        failed: &impl Fn(netcdf::Error) -> OutputError,
    ) -> Result<(), OutputError> {
        self.write_axes(out).map_err(failed)?;
        for field in FieldName::ALL.iter().copied() {
            if self.in_single {
                self.put::<f32>(out, field, failed)?;
            } else {
                self.put::<f64>(out, field, failed)?;
            }
        }
        Ok(())
    }

    /// Writes a field of all its steps, if it has any.
    fn put<T: NcTypeDescriptor + Deserialize + From<f32>>(
        &self,
        out: &mut FileMut,
        field: FieldName,
        failed: &impl Fn(netcdf::Error) -> OutputError,
    ) -> Result<(), OutputError> {
        let own = self.files.iter().filter(|(_, name, _)| *name == field);
        let own: Vec<_> = own.collect();
        if own.is_empty() {
            return Ok(());
        }
        self.add::<T>(out, field).map_err(failed)?;
        for (step, _, path) in own {
            let place = self.steps.partition_point(|known| known < step);
            self.copy::<T>(out, field, place, path, failed)?;
        }
        Ok(())
    }

    fn write_axes(&self, out: &mut FileMut) -> netcdf::Result<()> {
        for (axis, name) in ["x", "y"].into_iter().enumerate() {
            let values: Vec<f64> = (0..self.points[axis])
                .map(|point| point as f64 * self.spacing[axis])
                .collect();
            out.add_dimension(name, values.len())?;
            let mut variable = out.add_variable::<f64>(name, &[name])?;
            variable.put_values(&values, ..)?;
            variable.put_attribute("axis", name.to_uppercase())?;
            describe(out, name, name, "m")?;
        }
        let steps: Vec<i64> = self.steps.iter().map(|step| *step as i64).collect();
        out.add_dimension("field_step", steps.len())?;
        let mut variable = out.add_variable::<i64>("field_step", &["field_step"])?;
        variable.put_values(&steps, ..)?;
        // ParaView plays along this axis; it would stack the fields otherwise.
        variable.put_attribute("axis", "T")?;
        describe(out, "field_step", "step of the fields", "")
    }

    /// Adds the variable of a field; a step that has none is not a number.
    fn add<T: NcTypeDescriptor + From<f32>>(
        &self,
        out: &mut FileMut,
        field: FieldName,
    ) -> netcdf::Result<()> {
        let name = field.name();
        let mut variable = out.add_variable::<T>(name, &["field_step", "y", "x"])?;
        let [nx, ny] = self.points;
        variable.set_chunking(&[1, ROWS_TOGETHER.min(ny), nx])?;
        variable.set_compression(COMPRESSION, true)?;
        variable.set_fill_value(T::from(f32::NAN))?;
        describe(out, name, name, field.unit())
    }

    /// Copies a field into its variable, some rows at a time.
    fn copy<T: NcTypeDescriptor + Deserialize>(
        &self,
        out: &mut FileMut,
        field: FieldName,
        place: usize,
        path: &Path,
        failed: &impl Fn(netcdf::Error) -> OutputError,
    ) -> Result<(), OutputError> {
        let head = open(path)?;
        let [nx, ny] = self.points;
        if head.shape() != [ny as u64, nx as u64] || is_single(&head.dtype()) != self.in_single {
            return Err(damaged(path));
        }
        let mut values = head.data::<T>().map_err(|_| damaged(path))?;
        let Some(mut variable) = out.variable_mut(field.name()) else {
            return Ok(());
        };
        for first in (0..ny).step_by(ROWS_TOGETHER) {
            let rows = ROWS_TOGETHER.min(ny - first);
            let block: Vec<T> = (&mut values)
                .take(rows * nx)
                .collect::<io::Result<_>>()
                .map_err(OutputError::write("read", path))?;
            if block.len() < rows * nx {
                return Err(damaged(path));
            }
            let extent = (place, first..first + rows, ..);
            variable.put_values(&block, extent).map_err(failed)?;
        }
        Ok(())
    }
}

/// Opens a field.
fn open(path: &Path) -> Result<NpyFile<BufReader<File>>, OutputError> {
    let file = File::open(path).map_err(OutputError::write("read", path))?;
    NpyFile::new(BufReader::new(file)).map_err(|_| damaged(path))
}

fn is_single(kind: &DType) -> bool {
    matches!(kind, DType::Plain(plain) if plain.size_field() == 4)
}

fn damaged(path: &Path) -> OutputError {
    OutputError::refused(
        path,
        "is damaged, or not of this run; solve the run again into another folder",
    )
}

/// The distance of two points along x and y that the head of a volume says, m.
fn spacing(volume: &Path) -> Result<[f64; 2], OutputError> {
    let file = File::open(volume).map_err(not_a_run(volume))?;
    let mut head = Vec::new();
    file.take(HEAD)
        .read_to_end(&mut head)
        .map_err(OutputError::write("read", volume))?;
    let head = String::from_utf8_lossy(&head);
    let (_, after) = head
        .split_once("Spacing=\"")
        .ok_or_else(|| damaged(volume))?;
    let mut numbers = after.split(['"', ' ']).map(str::parse::<f64>);
    match (numbers.next(), numbers.next()) {
        (Some(Ok(x)), Some(Ok(y))) => Ok([x, y]),
        _ => Err(damaged(volume)),
    }
}
