//! What a run writes: the folder, the curve, the summary, fields and pictures.
//!
//! Everything here is in SI units and has the signs of the results: pressure is positive in
//! compression. Files that are written whole appear under their name only when they are complete;
//! `curve.csv` alone grows, a row a step.

mod canvas;
pub mod colour_scale;
mod cpu_time;
pub mod curve;
mod error;
pub mod fields;
pub mod folder;
pub mod layout;
pub mod palette;
pub mod panels;
pub mod picture;
mod png_text;
pub mod progress;
mod resample;
mod si;
pub mod summary;

pub use canvas::{Font, TextLine};
pub use cpu_time::cpu_seconds;
pub use curve::CurveWriter;
pub use error::OutputError;
pub use fields::{write_field, write_field_single};
pub use folder::{RunFolder, write_atomically};
pub use picture::{Load, Picture, Snapshot, write_picture};
pub use progress::Progress;
pub use summary::{Effects, Seconds, Summary, peak_memory_bytes};
