//! Params and scalars as a shader reads them, for a test of both layouts.

use super::bindings::{Access, WORKING};
use super::layout::Wide;
use super::recorder::Part;
use super::{GpuBackend, GpuError, source};
use crate::backend::BackendError;

impl GpuBackend {
    /// Every word of the params and then of the scalars as a shader reads it.
    ///
    /// # Errors
    /// Where the device fails.
    pub fn words_on_device(&mut self) -> Result<Vec<f64>, BackendError> {
        Ok(self.copy_members()?)
    }

    fn copy_members(&mut self) -> Result<Vec<f64>, GpuError> {
        self.settle()?;
        let (text, count) = source::copy_members(self.wide);
        let found = self.storage("found", count * self.wide.bytes())?;
        let partials = self.storage("partials", 16)?;
        let shared = [&self.params, &self.scalars, &partials];
        let groups: [(&[Access], &[&wgpu::Buffer]); 2] =
            [(WORKING, &shared), (&[Access::Write], &[&found])];
        let prepared = self.prepare("copy_members", text, &groups, [1, 1])?;
        self.recorder.dispatch(prepared)?;
        let bytes = self.recorder.read(&[Part {
            buffer: &found,
            start: 0,
            length: count * self.wide.bytes(),
        }])?;
        Ok(match self.wide {
            Wide::Double => bytemuck::pod_collect_to_vec::<u8, f64>(&bytes),
            Wide::Single | Wide::Compensated => bytemuck::pod_collect_to_vec::<u8, f32>(&bytes)
                .into_iter()
                .map(f64::from)
                .collect(),
        })
    }
}
