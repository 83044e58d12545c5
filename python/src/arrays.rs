//! Arrays of NumPy: heights in and fields out, both without a copy.

use std::{ptr, slice};

use numpy::{PyArray1, PyArray2, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::prelude::*;
use tabor::{GridValues, SharedValues};

use crate::errors;

/// The numbers of an array, where they lie.
struct NumpyValues {
    /// Keeps them there.
    _array: Py<PyArray2<f64>>,
    /// Where the first one lies, which only Python's lock lets one ask the array for.
    address: usize,
    count: usize,
}

impl AsRef<[f64]> for NumpyValues {
    #[expect(
        unsafe_code,
        reason = "no safe crate lends the memory of an array across threads: those that do take Python's buffers, \
                  which its stable interface has from 3.11 on, and borrows of the crate numpy end with its lock"
    )]
    fn as_ref(&self) -> &[f64] {
        // SAFETY: `shared` saw an aligned array of `count` numbers of this type, one after another, from `address` on;
        // any bits are such a number. NumPy moves the memory of an array in `resize(refcheck=False)` only, of which
        // its manual says that nobody else may hold the array; `Lent::check` sees it between solves. A solver only
        // reads. A write of Python's at that moment is a race as it is with every borrow of the crate numpy, whose
        // readers let the lock go: a manual can forbid it (that of `Contact` does) and no lock of ours prevent it.
        unsafe { slice::from_raw_parts(ptr::with_exposed_provenance(self.address), self.count) }
    }
}

/// Where the numbers of an array begin, and how many there are.
fn place(array: &Bound<'_, PyArray2<f64>>) -> (usize, usize) {
    (array.data().expose_provenance(), array.len())
}

/// The numbers of an array in C order, shared with it.
pub fn shared(array: &Bound<'_, PyArray2<f64>>) -> PyResult<SharedValues> {
    let (address, count) = place(array);
    if !array.is_c_contiguous() || !address.is_multiple_of(align_of::<f64>()) {
        let words = "an array in C order and aligned is expected";
        return Err(errors::failed(array.py(), words));
    }
    Ok(SharedValues::from_owner(NumpyValues {
        _array: array.clone().unbind(),
        address,
        count,
    }))
}

/// An array of values on the grid that a scene shares with whoever gave it.
pub struct Lent {
    argument: &'static str,
    array: Py<PyArray2<f64>>,
    place: (usize, usize),
    values: GridValues,
    checksum: u32,
}

impl Lent {
    /// An array of shape (ny, nx), in C order, that was given as `argument`.
    pub fn new(array: &Bound<'_, PyArray2<f64>>, argument: &'static str) -> PyResult<Self> {
        let &[rows, columns] = array.shape() else {
            return Err(errors::failed(array.py(), "an array of rows is expected"));
        };
        let values = GridValues::from_shared(shared(array)?, [columns, rows]);
        let checksum = array.py().detach(|| values.checksum());
        Ok(Lent {
            argument,
            place: place(array),
            array: array.clone().unbind(),
            values,
            checksum,
        })
    }

    /// Its values.
    pub fn values(&self) -> GridValues {
        self.values.clone()
    }

    /// Another holder of it.
    pub fn share(&self, py: Python<'_>) -> Self {
        Lent {
            array: self.array.clone_ref(py),
            values: self.values.clone(),
            ..*self
        }
    }

    /// Refuses arrays that were written to: what was worked out from their numbers no longer holds.
    pub fn check(py: Python<'_>, lent: &[Lent]) -> PyResult<()> {
        for each in lent {
            let stays = each.place == place(each.array.bind(py));
            if !stays || py.detach(|| each.values.checksum()) != each.checksum {
                let words = format!(
                    "{}: this array has been written to since it was given; make a new contact of it, or give a copy \
                     of it before writing",
                    each.argument
                );
                return Err(errors::raise(py, "SceneError", &words));
            }
        }
        Ok(())
    }
}

/// A field as an array of shape (ny, nx), without a copy.
pub fn array<'py>(
    py: Python<'py>,
    values: Vec<f64>,
    points: [usize; 2],
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    PyArray1::from_vec(py, values).reshape([points[1], points[0]])
}
