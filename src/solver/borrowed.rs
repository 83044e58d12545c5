//! What a solver works with, which it borrows or, where it outlives whoever made it, holds itself.

use std::ops::{Deref, DerefMut};
use std::sync::Arc;

use super::problem::Problem;
use crate::backend::Backend;

/// A backend.
pub(super) enum BackendRef<'a> {
    Borrowed(&'a mut (dyn Backend + Send)),
    Own(Box<dyn Backend + Send>),
}

impl<'a> Deref for BackendRef<'a> {
    type Target = dyn Backend + Send + 'a;

    fn deref(&self) -> &Self::Target {
        match self {
            BackendRef::Borrowed(backend) => *backend,
            BackendRef::Own(backend) => &**backend,
        }
    }
}

impl DerefMut for BackendRef<'_> {
    fn deref_mut(&mut self) -> &mut Self::Target {
        match self {
            BackendRef::Borrowed(backend) => *backend,
            BackendRef::Own(backend) => &mut **backend,
        }
    }
}

/// A problem.
#[derive(Clone)]
pub(super) enum ProblemRef<'a> {
    Borrowed(&'a Problem),
    Shared(Arc<Problem>),
}

impl Deref for ProblemRef<'_> {
    type Target = Problem;

    fn deref(&self) -> &Problem {
        match self {
            ProblemRef::Borrowed(problem) => problem,
            ProblemRef::Shared(problem) => problem,
        }
    }
}
