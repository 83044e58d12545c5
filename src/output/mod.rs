//! What a run writes: the folder, the curve, the summary, fields and pictures.
//!
//! Everything here is in SI units and has the signs of the results: pressure is positive in
//! compression. Files that are written whole appear under their name only when they are complete;
//! `curve.csv` alone grows, a row a step.

#[cfg(feature = "images")]
pub(crate) mod canvas;
#[cfg(feature = "images")]
pub mod chart;
#[cfg(feature = "images")]
pub mod colour_scale;
mod cpu_time;
pub mod curve;
mod difference;
mod error;
pub mod fields;
pub mod folder;
pub mod growing;
#[cfg(feature = "images")]
pub mod layout;
pub mod lock;
#[cfg(feature = "images")]
pub mod palette;
#[cfg(feature = "images")]
pub mod panels;
#[cfg(feature = "images")]
pub(crate) mod pen;
#[cfg(feature = "images")]
pub mod picture;
#[cfg(feature = "images")]
mod png_text;
#[cfg(feature = "images")]
pub mod report;
#[cfg(feature = "images")]
mod resample;
#[cfg(feature = "images")]
pub(crate) mod si;
#[cfg(feature = "images")]
pub mod spectrum_plot;
pub mod state;
pub mod summary;
mod visible;
pub mod volume;

#[cfg(feature = "images")]
pub use canvas::{Font, TextLine};
pub use cpu_time::cpu_seconds;
pub use curve::{Curve, CurveWriter};
pub(crate) use error::FRESH;
pub use error::OutputError;
pub use fields::{write_field, write_field_single};
pub use folder::{RunFolder, set_aside, write_atomically, write_within};
pub use growing::GrowingTable;
pub use lock::FolderLock;
#[cfg(feature = "images")]
pub use picture::{Load, Picture, Snapshot, write_picture};
#[cfg(feature = "images")]
pub use spectrum_plot::SpectrumPlot;
pub use state::SavedState;
pub use summary::{Effects, Seconds, Summary, peak_memory_bytes};
pub use visible::{visible, visible_line};
pub use volume::write_volume;
