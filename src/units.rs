//! Dimensional values with units.
