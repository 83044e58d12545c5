//! Errors of tabor as exceptions of the package, which `tabor/errors.py` defines.

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

/// Mistakes of a scene.
pub fn of_scene(py: Python<'_>, errors: &SceneErrors) -> PyErr {
    raise(py, "SceneError", &errors.to_string())
}

/// Why a contact is not solved, in the words of a scene's keys.
pub fn of_contact(py: Python<'_>, error: &ContactError) -> PyErr {
    match error {
        ContactError::Mistakes(mistakes) => {
            let lines: Vec<String> = mistakes
                .0
                .iter()
                .map(|mistake| format!("{}: {}", mistake.key, mistake.error))
                .collect();
            raise(py, "SceneError", &lines.join("\n"))
        }
        ContactError::Surface(error) => raise(py, "SurfaceError", &error.to_string()),
        ContactError::Memory(error) => raise(py, "NotEnoughMemoryError", &error.to_string()),
        ContactError::Device(error) => raise(py, "DeviceError", &error.to_string()),
        other => raise(py, "DeviceError", &other.to_string()),
    }
}

/// Why a run could not begin or go on.
pub fn of_run(py: Python<'_>, error: &RunError) -> PyErr {
    let class = match error {
        RunError::Surface(_) => "SurfaceError",
        RunError::Memory(_) => "NotEnoughMemoryError",
        RunError::Output(_) => "OutputError",
        _ => "DeviceError",
    };
    raise(py, class, &error.to_string())
}
