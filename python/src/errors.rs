//! Errors of tabor as exceptions of the package, which `tabor/errors.py` defines.
//!
//! Messages about a scene name its keys and lines. Where no file of a scene is behind them, `tabor/wording.py` tells them
//! to who gave arguments.

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use tabor::scene::SceneErrors;
use tabor::{ContactError, RunError};

/// An exception class of the package with these words.
pub fn raise(py: Python<'_>, class: &str, words: &str) -> PyErr {
    let made = py
        .import("tabor.errors")
        .and_then(|module| module.getattr(class))
        .and_then(|class| class.call1((words,)));
    match made {
        Ok(exception) => PyErr::from_value(exception),
        Err(error) => error,
    }
}

/// Something that no argument caused.
pub fn failed(_py: Python<'_>, words: &str) -> PyErr {
    PyRuntimeError::new_err(words.to_owned())
}

/// Who tells messages about a scene: a function of a key, perhaps empty, and of the words; of a scene file nobody, whose
/// messages have the words of the command line.
pub type Teller<'a> = Option<&'a Py<PyAny>>;

/// The mistakes of a scene that are told; more usually come from a single error.
const MOST_TOLD: usize = 20;

/// A message about a key.
fn told(py: Python<'_>, teller: Teller<'_>, key: &str, words: String) -> PyResult<String> {
    match teller {
        Some(teller) => teller.call1(py, (key, words))?.extract(py),
        None if key.is_empty() => Ok(words),
        None => Ok(format!("{key}: {words}")),
    }
}

/// An exception class of the package with words about no key.
fn raise_told(py: Python<'_>, class: &str, teller: Teller<'_>, words: String) -> PyErr {
    told(py, teller, "", words).map_or_else(|error| error, |words| raise(py, class, &words))
}

/// Mistakes at keys of a scene.
fn mistakes<'a, E: ToString + 'a>(
    py: Python<'_>,
    teller: Teller<'_>,
    each: impl ExactSizeIterator<Item = (&'a str, &'a E)>,
) -> PyErr {
    let left_out = each.len().saturating_sub(MOST_TOLD);
    let lines: PyResult<Vec<String>> = each
        .take(MOST_TOLD)
        .map(|(key, error)| told(py, teller, key, error.to_string()))
        .collect();
    lines.map_or_else(
        |error| error,
        |mut lines| {
            if left_out > 0 {
                lines.push(format!("and {left_out} more"));
            }
            raise(py, "SceneError", &lines.join("\n"))
        },
    )
}

/// Mistakes of a scene.
pub fn of_scene(py: Python<'_>, teller: Teller<'_>, errors: &SceneErrors) -> PyErr {
    match teller {
        Some(_) => mistakes(
            py,
            teller,
            errors.0.iter().map(|each| (each.key.as_str(), &each.error)),
        ),
        None => raise(py, "SceneError", &errors.to_string()),
    }
}

/// Why a contact is not solved.
pub fn of_contact(py: Python<'_>, teller: Teller<'_>, error: &ContactError) -> PyErr {
    let (class, words) = match error {
        ContactError::Mistakes(found) => {
            let each = found.0.iter().map(|each| (each.key.as_str(), &each.error));
            return mistakes(py, teller, each);
        }
        ContactError::Surface(error) => ("SurfaceError", error.to_string()),
        ContactError::Memory(error) => ("NotEnoughMemoryError", error.to_string()),
        ContactError::Device(error) => ("DeviceError", error.to_string()),
        other => ("DeviceError", other.to_string()),
    };
    raise_told(py, class, teller, words)
}

/// Why a run could not begin or go on.
pub fn of_run(py: Python<'_>, teller: Teller<'_>, error: &RunError) -> PyErr {
    let class = match error {
        RunError::Surface(_) => "SurfaceError",
        RunError::Memory(_) => "NotEnoughMemoryError",
        RunError::Output(_) => "OutputError",
        _ => "DeviceError",
    };
    raise_told(py, class, teller, error.to_string())
}
