//! The files of a run: folder, curve, summary, fields and pictures.
//!
//! Everything is in SI units with the signs of the results: pressure is positive in compression.
//! Files appear under their names only when they are complete; only `curve.csv` grows, one row a
//! step.

#[cfg(feature = "images")]
pub(crate) mod canvas;
#[cfg(feature = "images")]
#[doc(hidden)]
pub mod colour_scale;
pub(crate) mod csv_line;
#[doc(hidden)]
pub mod curve;
mod difference;
mod error;
#[doc(hidden)]
pub mod fields;
#[doc(hidden)]
pub mod folder;
#[doc(hidden)]
pub mod growing;
#[cfg(feature = "images")]
#[doc(hidden)]
pub mod layout;
#[doc(hidden)]
pub mod lock;
#[cfg(feature = "netcdf")]
mod netcdf;
#[cfg(feature = "images")]
#[doc(hidden)]
pub mod palette;
#[cfg(feature = "images")]
#[doc(hidden)]
pub mod picture;
#[cfg(feature = "images")]
#[doc(hidden)]
pub mod plot;
#[cfg(feature = "images")]
#[doc(hidden)]
pub mod report;
#[cfg(feature = "images")]
mod resample;
#[cfg(feature = "images")]
mod sentence;
#[cfg(feature = "images")]
pub(crate) mod si;
#[doc(hidden)]
pub mod state;
#[doc(hidden)]
pub mod summary;
mod target;
mod visible;
#[doc(hidden)]
pub mod volume;
mod whole_file;

#[cfg(feature = "images")]
#[doc(hidden)]
pub use canvas::{Font, TextLine};
pub use curve::Curve;
#[doc(hidden)]
pub use curve::CurveWriter;
pub(crate) use curve::{EMPTY_CHECKSUM, rows_from_text, rows_to_text};
#[cfg(feature = "cli")]
pub(crate) use difference::difference;
pub(crate) use error::FRESH;
pub use error::OutputError;
#[doc(hidden)]
pub use fields::FieldRows;
pub(crate) use fields::write_field_rows;
pub use fields::{write_field, write_field_single};
#[doc(hidden)]
pub use folder::{RunFolder, write_within};
#[doc(hidden)]
pub use growing::GrowingTable;
#[doc(hidden)]
pub use lock::FolderLock;
#[cfg(feature = "netcdf")]
pub use netcdf::write_netcdf;
#[cfg(feature = "images")]
#[doc(hidden)]
pub use picture::Snapshot;
#[cfg(feature = "images")]
pub(crate) use picture::write_picture_rows;
#[cfg(feature = "images")]
pub use picture::{Load, Picture, write_picture};
#[cfg(feature = "cli")]
pub(crate) use sentence::sentence;
#[doc(hidden)]
pub use state::SavedState;
pub(crate) use state::{StateFile, hand_over};
pub use summary::{Effects, Seconds, Summary, peak_memory_bytes};
#[cfg(feature = "cli")]
pub(crate) use target::expect_apart;
pub(crate) use target::expect_table;
#[doc(hidden)]
pub use visible::{visible, visible_line};
#[doc(hidden)]
pub use volume::RowsOf;
#[doc(hidden)]
pub use volume::write_volume;
pub use whole_file::{set_aside, write_atomically};

pub use crate::study::Column;
