//! `tabor fit FOLDER`: all force curves of a folder, a table of what they give, and its histogram.

use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::fit::FitArguments;
use super::{Failure, say, warn};
use crate::fit::{FitError, FitResult, figure, report, table as curve_table, table_head};
use crate::output::csv_line::{csv_line, csv_number};
use crate::output::plot::{Axis, Figure, Panel, PlotPoint, Series};
use crate::output::{GrowingTable, OutputError, expect_table, write_atomically};
use crate::units::format_si;

/// The table.
const TABLE: &str = "fits.csv";
/// End of the name of a curve's own table, the data of its picture.
const OWN_TABLE: &str = ".fit.csv";
/// First line of the table.
const HEADER: &str = "curve,model,work_of_adhesion,work_uncertainty,contact_modulus,modulus_uncertainty,tabor_parameter,points,warnings,error\n";
/// Extensions of files that are taken for curves.
const EXTENSIONS: [&str; 7] = ["csv", "txt", "tsv", "dat", "asc", "jpk-force", "spm"];
/// Curves that are fitted at a time; their rows are then on the disk.
const BATCH: usize = 32;
/// Most failures that are told one by one.
const TOLD: usize = 10;

/// Fits every curve in the folder at `path`, and writes what they give into `out`.
pub(super) fn fit_folder(arguments: &FitArguments, path: &Path, out: &Path) -> Result<(), Failure> {
    let curves = curves(path)?;
    if curves.is_empty() {
        return Err(Failure::Usage(format!(
            "{}: no curve in this folder; their names end in .{}",
            path.display(),
            EXTENSIONS.join(", .")
        )));
    }
    expect_table(&out.join(TABLE), HEADER)?;
    fs::create_dir_all(out).map_err(OutputError::write("create the folder", out))?;
    let mut table = GrowingTable::create(&out.join(TABLE), HEADER.to_owned())?;
    let (mut fitted, mut failed) = (Vec::new(), Vec::new());
    arguments
        .indenter()
        .doubt()
        .iter()
        .for_each(|doubt| warn(doubt));
    for batch in curves.chunks(BATCH) {
        let results: Vec<_> = batch
            .par_iter()
            .map(|curve| arguments.fit_curve(curve))
            .collect();
        for (curve, result) in batch.iter().zip(results) {
            table.append(&row(curve, &result))?;
            match result {
                Ok(result) => {
                    write_result(curve, &result, out)?;
                    fitted.push(result);
                }
                Err(error) => failed.push(error.to_string()),
            }
        }
    }
    for error in failed.iter().take(TOLD) {
        warn(error);
    }
    if failed.len() > TOLD {
        warn(&format!(
            "{} more curves gave nothing; {TABLE} has the reasons",
            failed.len() - TOLD
        ));
    }
    if fitted.is_empty() {
        return Err(Failure::Usage(format!(
            "{}: none of {} curves could be fitted",
            path.display(),
            curves.len()
        )));
    }
    let quantities = quantities(&fitted);
    for quantity in &quantities {
        say(&quantity.sentence(fitted.len()));
    }
    let panels = quantities.iter().map(Quantity::panel).collect();
    let picture = Figure {
        title: format!("{} of {} curves", fitted.len(), curves.len()),
        names: vec![String::new()],
        panels,
        columns: 2,
        ..Figure::default()
    };
    picture.write(&out.join("fits.png"))?;
    say(&format!(
        "{} of {} curves fitted; {} and fits.png written",
        fitted.len(),
        curves.len(),
        out.join(TABLE).display()
    ));
    Ok(())
}

/// The curves in a folder, by name, without tables that tabor wrote there.
fn curves(folder: &Path) -> Result<Vec<PathBuf>, OutputError> {
    let unreadable = || OutputError::write("read the folder", folder);
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).map_err(unreadable())? {
        let path = entry.map_err(unreadable())?.path();
        let extension = path.extension().and_then(OsStr::to_str).unwrap_or_default();
        let is_text = EXTENSIONS
            .iter()
            .any(|known| known.eq_ignore_ascii_case(extension));
        if is_text && path.is_file() && !is_own(&path) {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

/// Whether a file has the name and the first line of a table that tabor writes. A curve may have the name.
fn is_own(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let head = match &*name {
        TABLE => HEADER.to_owned(),
        name if name.ends_with(OWN_TABLE) => table_head(),
        _ => return false,
    };
    let mut begin = Vec::new();
    let read =
        File::open(path).and_then(|file| file.take(head.len() as u64).read_to_end(&mut begin));
    read.is_ok() && begin == head.as_bytes()
}

/// `NAME.json`, `NAME.fit.csv` and `NAME.png` of a curve.
fn write_result(curve: &Path, result: &FitResult, out: &Path) -> Result<(), OutputError> {
    let name = curve.file_name().unwrap_or_default().to_string_lossy();
    let text = format!("{:#}\n", report(result, curve));
    write_atomically(&out.join(format!("{name}.json")), text.as_bytes())?;
    let table = curve_table(result);
    write_atomically(&out.join(format!("{name}{OWN_TABLE}")), table.as_bytes())?;
    figure(result, &name).write(&out.join(format!("{name}.png")))
}

/// A row of the table.
fn row(curve: &Path, result: &Result<FitResult, FitError>) -> String {
    let name = curve.file_name().unwrap_or_default().to_string_lossy();
    match result {
        Ok(result) => {
            let best = result.best();
            let work = best.parameters.work_of_adhesion;
            csv_line([
                name.into_owned(),
                best.model.name().to_owned(),
                csv_number(best.model.adheres().then_some(work)),
                csv_number(result.work_uncertainty),
                csv_number(Some(best.parameters.contact_modulus)),
                csv_number(result.modulus_uncertainty),
                csv_number(result.tabor_parameter),
                result.measured.samples.len().to_string(),
                result.warnings.len().to_string(),
                String::new(),
            ])
        }
        Err(error) => {
            let mut cells = vec![String::new(); 10];
            cells[0] = name.into_owned();
            cells[9] = error.to_string();
            csv_line(cells)
        }
    }
}

/// A fitted number of all curves that determine it.
struct Quantity {
    name: &'static str,
    unit: &'static str,
    /// In increasing order.
    values: Vec<f64>,
}

/// Work of adhesion and contact modulus, as far as any curve gives them.
fn quantities(fitted: &[FitResult]) -> Vec<Quantity> {
    let work = |fit: &FitResult| {
        let best = fit.best();
        best.model
            .adheres()
            .then_some(best.parameters.work_of_adhesion)
    };
    let modulus = |fit: &FitResult| Some(fit.best().parameters.contact_modulus);
    let quantity = |name, unit, of: &dyn Fn(&FitResult) -> Option<f64>| {
        let mut values: Vec<f64> = fitted.iter().filter_map(of).collect();
        values.sort_by(f64::total_cmp);
        Quantity { name, unit, values }
    };
    let both = [
        quantity("work of adhesion", "J/m^2", &work),
        quantity("contact modulus", "Pa", &modulus),
    ];
    both.into_iter()
        .filter(|quantity| !quantity.values.is_empty())
        .collect()
}

impl Quantity {
    /// The value below which a share of all lies.
    fn quantile(&self, share: f64) -> f64 {
        let place = share * (self.values.len() - 1) as f64;
        let (below, above) = (place.floor() as usize, place.ceil() as usize);
        let weight = place - below as f64;
        (1.0 - weight) * self.values[below] + weight * self.values[above]
    }

    /// Median and quartiles in words, of those of `curves` that have the number.
    fn sentence(&self, curves: usize) -> String {
        let [low, middle, high] = [0.25, 0.5, 0.75].map(|share| self.quantile(share));
        let count = self.values.len();
        let (of, these) = if count < curves {
            (format!(" of {count} of {curves} curves"), "these")
        } else {
            (String::new(), "the curves")
        };
        format!(
            "{}{of}: median {}, half of {these} from {} to {}",
            self.name,
            format_si(middle, self.unit),
            format_si(low, self.unit),
            format_si(high, self.unit)
        )
    }

    /// Its histogram: as many bins as the square root of the count, at least five.
    fn panel(&self) -> Panel {
        let (low, high) = (self.values[0], self.values[self.values.len() - 1]);
        let bins = (self.values.len() as f64).sqrt().ceil().max(5.0);
        let width = match (high - low) / bins {
            width if width > 0.0 => width,
            // All are the same.
            _ => low.abs().max(f64::MIN_POSITIVE) / bins,
        };
        let mut points = vec![PlotPoint::new(low, 0.0)];
        for bin in 0..bins as usize {
            let [from, to] = [bin, bin + 1].map(|edge| low + width * edge as f64);
            let is_last = bin + 1 == bins as usize;
            let count = self
                .values
                .iter()
                .filter(|value| (from..to).contains(*value) || (is_last && **value >= to));
            let count = count.count() as f64;
            points.extend([PlotPoint::new(from, count), PlotPoint::new(to, count)]);
        }
        points.push(PlotPoint::new(low + width * bins, 0.0));
        Panel {
            title: "curves".to_owned(),
            x: Axis::linear(self.name, self.unit),
            y: Axis::linear("curves", ""),
            series: vec![Series::line(0, points)],
        }
    }
}
