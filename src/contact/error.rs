//! Why a contact is not solved.

use std::fmt;

use super::phrases::{in_rust, method_of};
use crate::backend::BackendError;
use crate::device::DeviceError;
use crate::run::MemoryError;
use crate::scene::{Mistake, SceneError, SceneErrors};
use crate::surface::SurfaceError;

/// Why a contact is not solved. A load that does not converge is no error: [`Solution`](super::Solution) says so.
#[derive(Debug)]
#[non_exhaustive]
pub enum ContactError {
    /// Values that are out of range or cannot stand together, all of them.
    Mistakes(ContactMistakes),
    /// Heights or a map of adhesion that cannot be used.
    Surface(SurfaceError),
    /// The memory of this machine does not hold it.
    Memory(MemoryError),
    /// The device that it asks for cannot be used.
    Device(DeviceError),
    /// The device failed.
    Backend(BackendError),
}

impl fmt::Display for ContactError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ContactError::Mistakes(mistakes) => mistakes.fmt(formatter),
            ContactError::Surface(error) => formatter.write_str(&in_rust(&error.to_string())),
            ContactError::Memory(error) => formatter.write_str(&in_rust(&error.to_string())),
            ContactError::Device(error) => formatter.write_str(&in_rust(&error.to_string())),
            ContactError::Backend(error) => error.fmt(formatter),
        }
    }
}

impl std::error::Error for ContactError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            ContactError::Mistakes(mistakes) => Some(mistakes),
            ContactError::Surface(error) => Some(error),
            ContactError::Memory(error) => Some(error),
            ContactError::Device(error) => Some(error),
            ContactError::Backend(error) => Some(error),
        }
    }
}

impl From<SceneErrors> for ContactError {
    fn from(errors: SceneErrors) -> Self {
        let mistakes = errors.0.into_iter().map(ContactMistake::from).collect();
        ContactError::Mistakes(ContactMistakes(mistakes))
    }
}

impl From<ContactMistake> for ContactError {
    fn from(mistake: ContactMistake) -> Self {
        ContactError::Mistakes(ContactMistakes(vec![mistake]))
    }
}

impl From<SurfaceError> for ContactError {
    fn from(error: SurfaceError) -> Self {
        ContactError::Surface(error)
    }
}

impl From<MemoryError> for ContactError {
    fn from(error: MemoryError) -> Self {
        ContactError::Memory(error)
    }
}

impl From<DeviceError> for ContactError {
    fn from(error: DeviceError) -> Self {
        ContactError::Device(error)
    }
}

impl From<BackendError> for ContactError {
    fn from(error: BackendError) -> Self {
        ContactError::Backend(error)
    }
}

/// All mistakes of a contact, shown one a line.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactMistakes(pub Vec<ContactMistake>);

impl fmt::Display for ContactMistakes {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, mistake) in self.0.iter().enumerate() {
            if index > 0 {
                formatter.write_str("\n")?;
            }
            mistake.fmt(formatter)?;
        }
        Ok(())
    }
}

impl std::error::Error for ContactMistakes {}

/// What is wrong with a value, and the method that it was given to.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ContactMistake {
    /// The method, such as `Contact::hardness`.
    pub method: &'static str,
    /// The key of the value in a scene, such as `solid.hardness`.
    pub key: String,
    /// What is wrong, as a scene file says it.
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

impl fmt::Display for ContactMistake {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let value = self.key.rsplit('.').next().unwrap_or_default();
        write!(
            formatter,
            "{}, {value}: {}",
            self.method,
            in_rust(&self.error.to_string())
        )
    }
}

impl std::error::Error for ContactMistake {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(&self.error)
    }
}
