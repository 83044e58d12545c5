//! Python bindings of tabor: scenes and arrays in, NumPy arrays out.
//!
//! This module holds what needs Rust; the package `tabor` in Python gives it names, defaults and documentation.
//! Solvers run on threads of their own ([`waiting`]), so that Python hears Ctrl-C meanwhile.

mod arrays;
mod errors;
mod fit;
mod path;
mod pictures;
mod quantity;
mod run;
mod scene;
mod surface;
mod theory;
mod waiting;

use pyo3::prelude::*;

/// The part of the package `tabor` that is compiled.
#[pymodule]
mod _tabor {
    #[pymodule_export]
    use super::fit::fit;
    #[pymodule_export]
    use super::path::SolvedPath;
    #[pymodule_export]
    use super::pictures::colours;
    #[pymodule_export]
    use super::quantity::{quantity, share};
    #[pymodule_export]
    use super::run::{command_line, run};
    #[pymodule_export]
    use super::scene::{LoadedScene, json_from_toml, toml_from_json, toml_value_from_json};
    #[pymodule_export]
    use super::surface::{scales, self_affine_like, spectrum, statistics};
    #[pymodule_export]
    use super::theory::asperities::icha;
    #[pymodule_export]
    use super::theory::{theory, theory_table};

    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
