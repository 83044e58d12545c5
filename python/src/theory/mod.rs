//! Theories over arrays: each function of `tabor::theory` once an element, in one loop here.

pub mod asperities;
mod effects;
mod functions;
mod lennard_jones;

use std::sync::Arc;

use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use tabor::theory::dmt::Method;
use tabor::theory::fuller_tabor::Path;
use tabor::theory::{Law, TheoryError};

use crate::errors;
use crate::waiting::{Talk, wait};

/// Values of one element after those of its words.
type Evaluate = fn(&Words, &[f64]) -> Result<Vec<f64>, TheoryError>;

/// Words that an evaluation takes, read once.
struct Words {
    law: Law,
    method: Method,
    path: Path,
}

impl Words {
    /// The words of a call; what is not given is the first of its kind.
    fn read(words: &[(String, String)]) -> Result<Self, String> {
        let mut read = Words {
            law: Law::LennardJones,
            method: Method::Thermodynamic,
            path: Path::Unloading,
        };
        for (name, word) in words {
            match (name.as_str(), word.as_str()) {
                ("law", "lennard-jones") => read.law = Law::LennardJones,
                ("law", "cubic") => read.law = Law::Cubic,
                ("law", "exponential") => read.law = Law::Exponential,
                ("law", "maugis-dugdale") => read.law = Law::Dugdale,
                ("method", "thermodynamic") => read.method = Method::Thermodynamic,
                ("method", "force") => read.method = Method::Force,
                ("method", "constant") => read.method = Method::Constant,
                ("direction", "apart") => read.path = Path::Unloading,
                ("direction", "together") => read.path = Path::Loading,
                _ => {
                    let known = match name.as_str() {
                        "law" => "lennard-jones, cubic, exponential, maugis-dugdale",
                        "method" => "thermodynamic, force, constant",
                        _ => "apart, together",
                    };
                    return Err(format!("{name}: \"{word}\" is not one of {known}"));
                }
            }
        }
        Ok(read)
    }
}

/// Arrays of results, and how many elements did not converge.
type Results<'py> = (Vec<Bound<'py, PyArray1<f64>>>, usize);

/// How a loop over elements ended.
enum Loop {
    /// The results, and how many elements a method did not converge for.
    Done(Vec<Vec<f64>>, usize),
    /// An element that the theory refuses.
    Refused(usize, TheoryError),
}

/// Results of the function `name` for each element of `columns`, which are of one length. An element for which the
/// theory has no state is NaN. Also returns how many did not converge.
#[pyfunction]
pub fn theory<'py>(
    py: Python<'py>,
    name: &str,
    words: Vec<(String, String)>,
    columns: Vec<PyReadonlyArray1<'py, f64>>,
) -> PyResult<Results<'py>> {
    let mut functions = functions::FUNCTIONS.iter().chain(effects::FUNCTIONS);
    let known = functions.find(|(known, ..)| *known == name);
    let Some(&(_, results, evaluate)) = known else {
        return Err(errors::failed(py, &format!("no theory is called {name}")));
    };
    let words = Words::read(&words).map_err(|words| errors::raise(py, "TheoryError", &words))?;
    let columns: Vec<Vec<f64>> = columns
        .iter()
        .map(|column| column.as_array().to_vec())
        .collect();
    let length = columns.first().map_or(0, Vec::len);
    let is_one = length == 1;
    let end = if is_one && !name.starts_with(lennard_jones::NAME) {
        py.detach(|| evaluate_all(evaluate, results, &words, &columns, || true))
    } else {
        // What may take a while hears Ctrl-C.
        let talk = Arc::new(Talk::default());
        let heard = Arc::clone(&talk);
        wait(py, &talk, None, move || {
            evaluate_all(evaluate, results, &words, &columns, || heard.goes_on())
        })?
    };
    match end {
        Loop::Done(found, not_converged) => {
            let arrays = found
                .into_iter()
                .map(|values| PyArray1::from_vec(py, values));
            Ok((arrays.collect(), not_converged))
        }
        Loop::Refused(element, error) => {
            let place = if is_one {
                String::new()
            } else {
                format!(" (element {element})")
            };
            Err(errors::raise(
                py,
                "TheoryError",
                &format!("{name}: {error}{place}"),
            ))
        }
    }
}

/// Goes through the elements for as long as `goes_on` says.
fn evaluate_all(
    evaluate: Evaluate,
    results: usize,
    words: &Words,
    columns: &[Vec<f64>],
    goes_on: impl Fn() -> bool,
) -> Loop {
    let length = columns.first().map_or(0, Vec::len);
    let mut found = vec![Vec::with_capacity(length); results];
    let mut not_converged = 0;
    let mut inputs = vec![0.0; columns.len()];
    for element in (0..length).take_while(|_| goes_on()) {
        for (input, column) in inputs.iter_mut().zip(columns) {
            *input = column[element];
        }
        match evaluate(words, &inputs) {
            Ok(values) => {
                for (list, value) in found.iter_mut().zip(values) {
                    list.push(value);
                }
            }
            Err(error) => {
                match error {
                    TheoryError::NoSolution { .. } => {}
                    TheoryError::NotConverged { .. } => not_converged += 1,
                    refused => return Loop::Refused(element, refused),
                }
                found.iter_mut().for_each(|list| list.push(f64::NAN));
            }
        }
    }
    Loop::Done(found, not_converged)
}

/// What `tabor theory` prints for the words of a call.
#[pyfunction]
pub fn theory_table(py: Python<'_>, words: Vec<String>) -> PyResult<String> {
    py.detach(|| tabor::theory_table(&words))
        .map_err(|words| errors::raise(py, "TheoryError", &words))
}
