//! `tabor plot`: several runs in one picture.

use std::path::{Path, PathBuf};

use clap::Args;
use csv::StringRecord;

use super::{Failure, say};
use crate::output::csv_line::csv_line;
use crate::output::curve::unit_of;
use crate::output::plot::{Axis, DISTINCT, Figure, Panel, PlotPoint, Series};
use crate::output::{expect_apart, expect_table, write_atomically};

/// Points of a curve up to which each is marked.
const MARKED: usize = 60;
/// First columns of the data.
const HEAD: [&str; 2] = ["run", "row"];

#[derive(Debug, Args)]
pub(super) struct PlotArguments {
    /// Folders of runs, or tables like their curve.csv
    #[arg(value_name = "RUN", required = true)]
    runs: Vec<PathBuf>,
    /// The picture, a PNG; beside it are written an SVG and the data as CSV
    #[arg(long, value_name = "FILE", default_value = "plot.png")]
    out: PathBuf,
    /// Column along x [default: of the distance that the runs have, and the load]
    #[arg(long, value_name = "COLUMN", requires = "y")]
    x: Option<String>,
    /// Column along y
    #[arg(long, value_name = "COLUMN", requires = "x")]
    y: Option<String>,
}

/// Draws the curves of several runs.
pub(super) fn plot(arguments: &PlotArguments) -> Result<(), Failure> {
    if arguments.runs.len() > DISTINCT.len() {
        return Err(Failure::Usage(format!(
            "{} runs are more than can be told apart; name at most {}",
            arguments.runs.len(),
            DISTINCT.len()
        )));
    }
    let runs = (arguments.runs.iter())
        .map(|path| Table::read(path))
        .collect::<Result<Vec<Table>, Failure>>()?;
    let pairs = match (&arguments.x, &arguments.y) {
        (Some(x), Some(y)) => vec![[x.clone(), y.clone()]],
        _ => usual(&runs),
    };
    for run in &runs {
        for name in pairs.iter().flatten() {
            run.expect(name)?;
        }
    }
    let figure = Figure {
        names: names(&arguments.runs),
        panels: pairs.iter().map(|pair| panel(pair, &runs)).collect(),
        ..Figure::default()
    };
    let [picture, vectors, data] =
        ["png", "svg", "csv"].map(|end| arguments.out.with_extension(end));
    let read = runs.iter().map(|run| run.path.as_path());
    expect_apart([&picture, &vectors, &data], read)?;
    expect_table(&data, &HEAD.join(","))?;
    figure.write(&picture)?;
    write_atomically(&data, table(&pairs, &figure.names, &runs).as_bytes())?;
    say(&format!(
        "{}, {} and {} written",
        picture.display(),
        vectors.display(),
        data.display()
    ));
    Ok(())
}

/// The columns of a table, as numbers where they are.
struct Table {
    path: PathBuf,
    names: Vec<String>,
    rows: Vec<Vec<Option<f64>>>,
}

impl Table {
    /// Reads a table, or `curve.csv` of a folder.
    fn read(path: &Path) -> Result<Table, Failure> {
        let path = if path.is_dir() {
            path.join("curve.csv")
        } else {
            path.to_path_buf()
        };
        let unreadable = |error: csv::Error| {
            Failure::Usage(format!("{}: cannot be read: {error}", path.display()))
        };
        let mut reader = csv::Reader::from_path(&path).map_err(unreadable)?;
        let head = reader.headers().map_err(unreadable)?;
        let names = head.iter().map(|name| name.trim().to_owned()).collect();
        let number = |cell: &str| {
            cell.trim()
                .parse()
                .ok()
                .filter(|value: &f64| value.is_finite())
        };
        let rows = reader
            .records()
            .map(|row| row.map(|row: StringRecord| row.iter().map(number).collect()))
            .collect::<Result<Vec<Vec<_>>, csv::Error>>()
            .map_err(unreadable)?;
        Ok(Table { path, names, rows })
    }

    fn place(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|known| known == name)
    }

    fn has_numbers(&self, name: &str) -> bool {
        self.place(name)
            .is_some_and(|place| self.rows.iter().any(|row| row[place].is_some()))
    }

    /// Refuses a column that the table lacks.
    fn expect(&self, name: &str) -> Result<(), Failure> {
        match self.place(name) {
            Some(_) => Ok(()),
            None => Err(Failure::Usage(format!(
                "{}: there is no column {name}; there are {}",
                self.path.display(),
                self.names.join(", ")
            ))),
        }
    }

    /// The values of two columns, row by row.
    fn points(&self, [x, y]: &[String; 2]) -> Vec<Option<[f64; 2]>> {
        let (Some(x), Some(y)) = (self.place(x), self.place(y)) else {
            return Vec::new();
        };
        let point = |row: &Vec<Option<f64>>| Some([row[x]?, row[y]?]);
        self.rows.iter().map(point).collect()
    }
}

/// Load against distance and contact area against load: the force and the approach where all runs have them.
fn usual(runs: &[Table]) -> Vec<[String; 2]> {
    let all = |name: &str| runs.iter().all(|run| run.has_numbers(name));
    let either = |first: &'static str, second: &'static str| {
        if all(first) { first } else { second }
    };
    let distance = either("approach", "mean_gap");
    let load = either("force", "mean_pressure");
    [[distance, load], [load, "contact_area_fraction"]]
        .map(|pair| pair.map(str::to_owned))
        .into()
}

/// What is different in the paths of the runs.
fn names(runs: &[PathBuf]) -> Vec<String> {
    let text = |path: &PathBuf| path.display().to_string();
    let last = |path: &PathBuf| {
        let name = path.file_name().map(|name| name.to_string_lossy());
        name.map_or_else(|| text(path), |name| name.into_owned())
    };
    let short: Vec<String> = runs.iter().map(last).collect();
    let mut distinct = short.clone();
    distinct.sort();
    distinct.dedup();
    if distinct.len() == short.len() {
        short
    } else {
        runs.iter().map(text).collect()
    }
}

fn panel(pair: &[String; 2], runs: &[Table]) -> Panel {
    let [x, y] = pair
        .each_ref()
        .map(|name| Axis::linear(&name.replace('_', " "), unit_of(name)));
    let series = (runs.iter().enumerate()).flat_map(|(name, run)| {
        let points = run.points(pair);
        let count = points.iter().flatten().count();
        // A row without values interrupts the curve.
        let stretches = points
            .split(Option::is_none)
            .filter(|stretch| !stretch.is_empty());
        let line = |stretch: &[Option<[f64; 2]>]| {
            let points = stretch.iter().flatten();
            let points = points.map(|[x, y]| PlotPoint::new(*x, *y)).collect();
            if count <= MARKED {
                Series::marked_line(name, points)
            } else {
                Series::line(name, points)
            }
        };
        stretches.map(line).collect::<Vec<Series>>()
    });
    Panel {
        title: format!("{} against {}", y.name, x.name),
        series: series.collect(),
        x,
        y,
    }
}

/// What is drawn: one row a run and row of its table, and the columns of all panels.
fn table(pairs: &[[String; 2]], names: &[String], runs: &[Table]) -> String {
    let mut columns: Vec<&str> = Vec::new();
    for name in pairs.iter().flatten() {
        if !columns.contains(&name.as_str()) {
            columns.push(name);
        }
    }
    let mut text = csv_line(HEAD.iter().chain(&columns));
    for (name, run) in names.iter().zip(runs) {
        for (index, row) in run.rows.iter().enumerate() {
            let value = |column: &&str| {
                let value = run.place(column).and_then(|place| row[place]);
                value.map(|value| format!("{value:?}")).unwrap_or_default()
            };
            let first = [name.clone(), (index + 1).to_string()];
            text.push_str(&csv_line(
                first.into_iter().chain(columns.iter().map(value)),
            ));
        }
    }
    text
}
