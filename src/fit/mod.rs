//! Work of adhesion and contact modulus from a measured force curve of a sphere, a cone or a pyramid.
//!
//! A [`ForceCurve`] is read from a file, divided into loading and unloading segments, and fitted by
//! four models of a sphere ([`model`]): Hertz, DMT, JKR and Maugis-Dugdale; of a cone or pyramid by two. The right model depends
//! on the Tabor number, which only the fit can tell, so [`fit_curve`] iterates until both agree.
//! The numbers of every model are returned, so that the choice can be checked.
//!
//! Signs are those of the results: force is positive in compression, approach is positive closer.
//! Everything is in SI. `docs/fit.md` describes the method and its limits.

#[doc(hidden)]
pub mod advice;
mod akaike;
mod beam;
mod calibration;
mod choice;
mod columns;
mod curve_file;
mod deviations;
mod error;
mod estimate;
mod headline;
mod hysteresis;
mod indenter;
mod inversion;
#[cfg(feature = "images")]
mod jpk;
mod law_error;
mod least_squares;
mod loading;
mod maugis_curve;
mod measured;
mod mixed_rows;
#[doc(hidden)]
pub mod model;
mod nanoscope;
#[cfg(feature = "images")]
mod picture;
mod profile;
mod relaxation;
mod report;
mod request;
mod scatter;
mod search;
mod segments;
mod signs;
mod slope;
mod start;
#[cfg(test)]
mod test_noise;
mod warnings;

pub use calibration::Calibration;
pub use choice::{FitResult, fit_curve};
pub use columns::{ColumnChoice, CurveColumns, CurveQuantity};
pub use curve_file::{ForceCurve, Sample};
pub use deviations::Uncertainties;
pub use error::FitError;
pub use estimate::ModelFit;
pub use headline::headline;
pub use indenter::Indenter;
#[doc(hidden)]
pub use inversion::{Inversion, invert_curve};
pub use law_error::LawError;
pub use measured::Freedom;
#[doc(hidden)]
pub use measured::Measured;
pub use model::Model;
#[cfg(feature = "images")]
pub use picture::figure;
pub use relaxation::{Relaxation, fit_relaxation};
#[cfg(feature = "cli")]
pub(crate) use report::table_head;
pub use report::{report, table};
pub use request::FitRequest;
#[doc(hidden)]
pub use segments::{Segment, segments};
pub use slope::{BaselineSlope, fit_with_slope};
