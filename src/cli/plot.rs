//! `tabor plot`: several runs in one picture.

use std::path::{Path, PathBuf};

use clap::Args;
use csv::StringRecord;

use super::{Failure, say, warn};
use crate::fit::ColumnChoice;
use crate::output::csv_line::csv_line;
use crate::output::curve::unit_of;
use crate::output::plot::{Axis, DISTINCT, Figure, Panel, PlotPoint, Series};
use crate::output::{expect_apart, expect_table, write_atomically};
use crate::units::parse_any_quantity;

/// Points of a curve up to which each is marked.
const MARKED: usize = 60;
/// The column that says whether a step converged.
const CONVERGED: &str = "converged";
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
        (Some(x), Some(y)) => {
            vec![[x, y].map(|column| Column::read(column, &StringRecord::new()).name)]
        }
        _ => usual(&runs),
    };
    for run in &runs {
        for name in pairs.iter().flatten() {
            run.expect(name)?;
        }
    }
    warn_of_unconverged(&runs);
    expect_points(&pairs, &runs)?;
    expect_one_unit(&pairs, &runs)?;
    warn_of_empty(&pairs, &runs);
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

/// Refuses a picture without any point.
fn expect_points(pairs: &[[String; 2]], runs: &[Table]) -> Result<(), Failure> {
    let is_drawn = |pair: &[String; 2]| {
        let mut points = runs.iter().flat_map(|run| run.points(pair));
        points.any(|point| point.is_some())
    };
    if pairs.iter().any(is_drawn) {
        return Ok(());
    }
    let Some((run, [x, y])) = runs.first().zip(pairs.first()) else {
        return Ok(());
    };
    let names = run.columns.iter().map(|column| column.name.as_str());
    let with_numbers: Vec<&str> = names.filter(|name| run.has_numbers(name)).collect();
    Err(Failure::Usage(format!(
        "{}: no row has a number both in {x} and in {y}, so there is nothing to draw; choose columns with numbers by --x and --y: {}",
        run.path.display(),
        with_numbers.join(", ")
    )))
}

/// Refuses a picture of a column that has two units, as the conductance of heat and that of a current.
fn expect_one_unit(pairs: &[[String; 2]], runs: &[Table]) -> Result<(), Failure> {
    for name in pairs.iter().flatten() {
        let unit = |run: &Table| Some(run.columns[run.place(name)?].unit);
        let mut with_units = runs
            .iter()
            .filter_map(|run| Some((run.path.display(), unit(run)?)))
            .filter(|(_, unit)| !unit.is_empty());
        let Some((one, unit)) = with_units.next() else {
            continue;
        };
        if let Some((other, its)) = with_units.find(|(_, its)| *its != unit) {
            return Err(Failure::Usage(format!(
                "{name} is in {unit} in {one} and in {its} in {other}; draw them apart"
            )));
        }
    }
    Ok(())
}

/// Says which rows are left out, as the picture of a run leaves them out.
fn warn_of_unconverged(runs: &[Table]) {
    for run in runs {
        let rows = run.converged.iter().enumerate();
        for (index, _) in rows.filter(|(_, converged)| !**converged) {
            warn(&format!(
                "{}: the step of row {} did not converge, and is not drawn",
                run.path.display(),
                index + 1
            ));
        }
    }
}

/// Says which runs are in the legend and without a curve.
fn warn_of_empty(pairs: &[[String; 2]], runs: &[Table]) {
    for run in runs {
        for pair @ [x, y] in pairs {
            if run.points(pair).iter().all(Option::is_none) {
                warn(&format!(
                    "{}: no row has a number both in {x} and in {y}, so this run has no curve of {y} against {x}",
                    run.path.display()
                ));
            }
        }
    }
}

/// A column as its head names it.
struct Column {
    name: String,
    /// SI unit of its values; empty where neither the head nor tabor gives one.
    unit: &'static str,
    /// What turns its numbers into that unit.
    factor: f64,
}

impl Column {
    /// Reads a head such as `approach [nm]`, as the columns of a force curve are read, of a table with these `heads`.
    fn read(head: &str, heads: &StringRecord) -> Column {
        let plain = || Column {
            name: head.to_owned(),
            unit: unit_of(head, |name| heads.iter().any(|head| head.trim() == name)),
            factor: 1.0,
        };
        let Ok(ColumnChoice {
            column,
            unit: Some(unit),
            reversed: false,
            ..
        }) = ColumnChoice::parse(&format!("approach={head}"))
        else {
            return plain();
        };
        match parse_any_quantity(&format!("1 {unit}")) {
            Some((factor, dimension)) => Column {
                name: column,
                unit: dimension.unit(),
                factor,
            },
            None => plain(),
        }
    }
}

/// The columns of a table, as numbers where they are.
struct Table {
    path: PathBuf,
    columns: Vec<Column>,
    /// In SI units.
    rows: Vec<Vec<Option<f64>>>,
    /// Whether the step of each row converged; in a table that does not say so, all did.
    converged: Vec<bool>,
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
        let mut reader = csv::ReaderBuilder::new();
        let reader = reader.comment(Some(b'#')).from_path(&path);
        let mut reader = reader.map_err(unreadable)?;
        let head = reader.headers().map_err(unreadable)?;
        let columns: Vec<Column> = head
            .iter()
            .map(|one| Column::read(one.trim(), head))
            .collect();
        let number = |(cell, column): (&str, &Column)| {
            let value = cell
                .trim()
                .parse()
                .ok()
                .map(|value: f64| value * column.factor);
            value.filter(|value| value.is_finite())
        };
        let verdict = columns.iter().position(|column| column.name == CONVERGED);
        let (mut rows, mut converged) = (Vec::new(), Vec::new());
        for row in reader.records() {
            let row = row.map_err(unreadable)?;
            let verdict = verdict.and_then(|place| row.get(place));
            converged.push(verdict.is_none_or(|word| word.trim() != "false"));
            rows.push(row.iter().zip(&columns).map(number).collect());
        }
        Ok(Table {
            path,
            columns,
            rows,
            converged,
        })
    }

    fn place(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column.name == name)
    }

    fn has_numbers(&self, name: &str) -> bool {
        self.place(name)
            .is_some_and(|place| self.rows.iter().any(|row| row[place].is_some()))
    }

    /// Refuses a column that the table lacks.
    fn expect(&self, name: &str) -> Result<(), Failure> {
        match self.place(name) {
            Some(_) => Ok(()),
            None => {
                let names = self.columns.iter().map(|column| column.name.as_str());
                Err(Failure::Usage(format!(
                    "{}: there is no column {name}; there are {}",
                    self.path.display(),
                    names.collect::<Vec<_>>().join(", ")
                )))
            }
        }
    }

    /// The values of two columns, row by row.
    fn points(&self, [x, y]: &[String; 2]) -> Vec<Option<[f64; 2]>> {
        let (Some(x), Some(y)) = (self.place(x), self.place(y)) else {
            return Vec::new();
        };
        let rows = self.rows.iter().zip(&self.converged);
        let point = |(row, converged): (&Vec<Option<f64>>, &bool)| {
            converged.then_some(())?;
            Some([row[x]?, row[y]?])
        };
        rows.map(point).collect()
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
    let unit = |name: &str| {
        let places = runs.iter().filter_map(|run| Some((run, run.place(name)?)));
        let mut units = places.map(|(run, place)| run.columns[place].unit);
        units.find(|unit| !unit.is_empty()).unwrap_or_default()
    };
    let [x, y] = pair
        .each_ref()
        .map(|name| Axis::linear(&name.replace('_', " "), unit(name)));
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
