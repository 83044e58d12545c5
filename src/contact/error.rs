//! Why a contact is not solved.

use thiserror::Error;

use super::phrases::{in_rust, method_of};
use crate::backend::BackendError;
use crate::device::DeviceError;
use crate::run::MemoryError;
use crate::scene::{Mistake, SceneError, SceneErrors};
use crate::surface::SurfaceError;

/// Why a contact is not solved. A load that does not converge is no error: [`Solution`](super::Solution) says so.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ContactError {
    /// Values that are out of range or cannot stand together, all of them.
    #[error(transparent)]
    Mistakes(#[from] ContactMistakes),
    /// Heights or a map of adhesion that cannot be used.
    #[error("{}", in_rust(.0))]
    Surface(#[from] SurfaceError),
    /// The memory of this machine does not hold it.
    #[error("{}", in_rust(.0))]
    Memory(#[from] MemoryError),
    /// The device that it asks for cannot be used.
    #[error("{}", in_rust(.0))]
    Device(#[from] DeviceError),
    /// The device failed.
    #[error(transparent)]
    Backend(#[from] BackendError),
    /// What [`Contact::watch`](super::Contact::watch) was given ended the load.
    #[error("the load was ended before its solution; the loads before it are solved")]
    Interrupted,
}

impl From<SceneErrors> for ContactError {
    fn from(errors: SceneErrors) -> Self {
        let mistakes = errors.0.into_iter();
        ContactMistakes(mistakes.map(ContactMistake::from).collect()).into()
    }
}

impl From<ContactMistake> for ContactError {
    fn from(mistake: ContactMistake) -> Self {
        ContactMistakes(vec![mistake]).into()
    }
}

/// All mistakes of a contact, shown one a line.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{}", one_a_line(.0))]
pub struct ContactMistakes(pub Vec<ContactMistake>);

/// A mistake in a value, and the method that it was given to.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{method}, {}: {}", key.rsplit('.').next().unwrap_or_default(), in_rust(.error))]
#[non_exhaustive]
pub struct ContactMistake {
    /// The method, such as `Contact::hardness`.
    pub method: &'static str,
    /// The key of the value in a scene, such as `solid.hardness`.
    pub key: String,
    /// The mistake, as a scene file words it.
    #[source]
    pub error: SceneError,
}

impl ContactMistake {
    /// A mistake at a key of the scene.
    pub(super) fn new(key: &str, error: SceneError) -> Self {
        ContactMistake {
            method: method_of(key),
            key: key.to_owned(),
            error,
        }
    }

    /// Values that cannot stand together.
    pub(super) fn conflict(key: &str, reason: impl Into<String>) -> Self {
        let reason = reason.into();
        ContactMistake::new(key, SceneError::Conflict { reason })
    }
}

impl From<Mistake> for ContactMistake {
    fn from(mistake: Mistake) -> Self {
        ContactMistake::new(&mistake.key, mistake.error)
    }
}

/// Mistakes one a line.
fn one_a_line(mistakes: &[ContactMistake]) -> String {
    let lines: Vec<String> = mistakes.iter().map(ContactMistake::to_string).collect();
    lines.join("\n")
}
