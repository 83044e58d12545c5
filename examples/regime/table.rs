//! The table of features and errors, one row a measured curve, and the model that suits each.

use std::error::Error;
use std::fmt::Write as _;

use tabor::fit::advice::features::CURVE_FEATURES;

/// Relative error of w and of E* within which a model suits.
pub const TOLERANCE: f64 = 0.15;
/// Adhesion that is less than so many deviations of the noise is none that Hertz would miss.
pub const SEEN: f64 = 3.0;
/// The answers, from the simplest.
pub const CLASSES: [&str; 5] = ["hertz", "dmt", "jkr", "maugis-dugdale", "none"];
/// One problem in so many is kept out of training, with all its curves.
pub const HELD_OUT: usize = 4;

/// Columns before the features.
const TRUTH: [&str; 8] = [
    "problem",
    "kind",
    "law",
    "tabor",
    "rms_height",
    "load",
    "noise",
    "spring",
];
/// Relative errors of the fits, columns behind the features; then what `tabor fit` chooses.
const ERRORS: [&str; 7] = [
    "hertz_modulus",
    "dmt_work",
    "dmt_modulus",
    "jkr_work",
    "jkr_modulus",
    "maugis_work",
    "maugis_modulus",
];

/// A measured curve.
#[derive(Clone, Debug)]
pub struct Row {
    /// Number of its field.
    pub problem: usize,
    /// `sphere` of a full field, `anew` of one that is only judged, `stiff` or `limit` in closed form, or what else was measured.
    pub kind: String,
    /// Law of the attraction, or `none`.
    pub law: String,
    /// Tabor number; 0 without attraction, as the next two.
    pub tabor: f64,
    /// Rms height over the range.
    pub rms_height: f64,
    /// Greatest load over `2 pi w R`.
    pub load: f64,
    /// Noise over the same.
    pub noise: f64,
    /// Spring constant over that of the tip.
    pub spring: f64,
    /// Features of the curve.
    pub features: Vec<Option<f64>>,
    /// Relative errors, as in [`ERRORS`].
    pub errors: [f64; ERRORS.len()],
    /// Model that `tabor fit` takes; `none` where it does not describe the curve.
    pub chosen: String,
}

impl Row {
    /// Whether it is kept out of training.
    pub fn is_held_out(&self) -> bool {
        self.kind == "anew" || scattered(self.problem).is_multiple_of(HELD_OUT)
    }

    /// Whether models of a sphere can suit it.
    pub fn is_of_sphere(&self) -> bool {
        ["sphere", "anew", "stiff", "limit"].contains(&self.kind.as_str())
    }

    /// Index into [`CLASSES`]: the simplest model whose w and E* are right within [`TOLERANCE`]; of DMT and JKR, which
    /// have as many numbers, that which is nearer.
    pub fn suits(&self) -> usize {
        let [
            hertz,
            dmt_work,
            dmt_modulus,
            jkr_work,
            jkr_modulus,
            work,
            modulus,
        ] = self.errors;
        let worse = |work: f64, modulus: f64| {
            let error = work.abs().max(modulus.abs());
            if error.is_finite() {
                error
            } else {
                f64::INFINITY
            }
        };
        let (dmt, jkr) = (worse(dmt_work, dmt_modulus), worse(jkr_work, jkr_modulus));
        if !self.is_of_sphere() {
            4
        } else if self.hides_adhesion() {
            // The work of adhesion is nothing that the curve could tell.
            if hertz.abs() <= TOLERANCE { 0 } else { 4 }
        } else if dmt.min(jkr) <= TOLERANCE {
            if dmt <= jkr { 1 } else { 2 }
        } else if worse(work, modulus) <= TOLERANCE {
            3
        } else {
            4
        }
    }

    fn hides_adhesion(&self) -> bool {
        self.law == "none" || self.noise * SEEN > 1.0
    }

    /// A line of the table.
    pub fn line(&self) -> String {
        let mut line = format!(
            "{},{},{},{},{},{},{},{}",
            self.problem,
            self.kind,
            self.law,
            short(self.tabor),
            short(self.rms_height),
            short(self.load),
            short(self.noise),
            short(self.spring),
        );
        for value in &self.features {
            // Writing to a String cannot fail.
            let _ = write!(
                line,
                ",{}",
                value.map(|value| plain(value, 2)).unwrap_or_default()
            );
        }
        for value in &self.errors {
            let _ = write!(line, ",{}", plain(value.clamp(-9.0, 9.0), 2));
        }
        let _ = writeln!(line, ",{}", self.chosen);
        line
    }
}

/// A number without zeros at its end; an error of a work that is 0 is empty.
fn plain(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return String::new();
    }
    let text = format!("{value:.digits$}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        "0".to_owned()
    } else {
        text.to_owned()
    }
}

/// A number that has nothing to do with the order in which problems are drawn (Knuth's multiplicative hash).
pub fn scattered(problem: usize) -> usize {
    ((problem as u32).wrapping_mul(2_654_435_761) >> 16) as usize
}

/// Three digits.
fn short(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let digits = (2 - value.abs().log10().floor() as i32).max(0) as usize;
    format!("{value:.digits$}")
}

/// The head of the table.
pub fn head() -> String {
    let features = CURVE_FEATURES.map(|name| name.replace(' ', "_"));
    let names = TRUTH.map(str::to_owned).into_iter().chain(features);
    let names = names.chain(ERRORS.map(str::to_owned));
    names.collect::<Vec<_>>().join(",") + ",chosen\n"
}

/// Reads the table.
pub fn read(text: &str) -> Result<Vec<Row>, Box<dyn Error>> {
    let lines = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    lines.map(read_line).collect()
}

fn read_line(line: &str) -> Result<Row, Box<dyn Error>> {
    let cells: Vec<&str> = line.split(',').collect();
    let expected = TRUTH.len() + CURVE_FEATURES.len() + ERRORS.len() + 1;
    if cells.len() != expected {
        return Err(format!("{} cells, not {expected}: {line}", cells.len()).into());
    }
    let behind = TRUTH.len() + CURVE_FEATURES.len();
    let mut errors = [0.0; ERRORS.len()];
    for (error, cell) in errors.iter_mut().zip(&cells[behind..]) {
        *error = if cell.is_empty() {
            f64::INFINITY
        } else {
            cell.parse()?
        };
    }
    let features = cells[TRUTH.len()..behind].iter();
    let features = features.map(|cell| (!cell.is_empty()).then(|| cell.parse()).transpose());
    Ok(Row {
        problem: cells[0].parse()?,
        kind: cells[1].to_owned(),
        law: cells[2].to_owned(),
        tabor: cells[3].parse()?,
        rms_height: cells[4].parse()?,
        load: cells[5].parse()?,
        noise: cells[6].parse()?,
        spring: cells[7].parse()?,
        features: features.collect::<Result<_, _>>()?,
        errors,
        chosen: cells[expected - 1].to_owned(),
    })
}
