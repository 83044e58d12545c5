//! How a scene is run.

use crate::device::Device;

/// How a scene is run; the default is what `tabor run` does without options.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RunOptions {
    pub(super) resume: bool,
    pub(super) overwrite: bool,
    pub(super) images: bool,
    pub(super) threads: Option<usize>,
    pub(super) device: Option<Device>,
    /// Seconds that reading the scene took.
    pub(super) reading_seconds: f64,
}

impl Default for RunOptions {
    fn default() -> Self {
        RunOptions {
            resume: false,
            overwrite: true,
            images: true,
            threads: None,
            device: None,
            reading_seconds: 0.0,
        }
    }
}

impl RunOptions {
    /// The default.
    pub fn new() -> Self {
        RunOptions::default()
    }

    /// Continues after the last finished step of an earlier run of the same scene; by default a run begins at
    /// its first step. The results are those of one run, to the last bit.
    pub fn resume(self, resume: bool) -> Self {
        RunOptions { resume, ..self }
    }

    /// Whether a run that does not resume may replace the files of an earlier run of the same scene (the
    /// default), or is refused. Folders of another scene, and files that tabor did not write, are never touched.
    pub fn overwrite(self, overwrite: bool) -> Self {
        RunOptions { overwrite, ..self }
    }

    /// Whether pictures and the report are written (the default); without the feature `images` they never are.
    pub fn images(self, images: bool) -> Self {
        RunOptions { images, ..self }
    }

    /// Threads of the processor; one a core by default.
    pub fn threads(self, threads: usize) -> Self {
        RunOptions {
            threads: Some(threads),
            ..self
        }
    }

    /// Where to compute, in place of what the scene names.
    pub fn device(self, device: Device) -> Self {
        RunOptions {
            device: Some(device),
            ..self
        }
    }

    /// Tells how long reading the scene took, s, for the summary.
    #[cfg(feature = "cli")]
    pub(crate) fn reading_seconds(self, reading_seconds: f64) -> Self {
        RunOptions {
            reading_seconds,
            ..self
        }
    }

    /// Whether pictures are written.
    pub(super) fn draws(&self) -> bool {
        self.images && cfg!(feature = "images")
    }
}
