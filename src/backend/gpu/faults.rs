//! Injected faults of a device, for tests. A release has none: the feature
//! `fault-injection` lets an [`AdapterChoice`](super::AdapterChoice) ask for it.

use super::slabs::Limits;

/// Faults and narrow limits of a device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Faults {
    /// Whether the device is taken for one without double precision.
    pub without_double: bool,
    /// Whether compensated sums are taken to come out wrong.
    pub plain_sums: bool,
    /// Whether a software driver gets the shaders of a graphics processor.
    pub unrolled: bool,
    /// Bytes that may be bound at a time, if less than the adapter takes.
    pub binding_limit: Option<u64>,
    /// Bytes of a field that go into one buffer, if less than the adapter binds.
    pub slab_bytes: Option<u64>,
    /// Points of a line that is transformed in one pass, if less than a workgroup holds.
    pub longest_line: Option<usize>,
    /// Dispatches after which the device is lost.
    pub lost_after: Option<u64>,
    /// Bytes after which it has no memory left.
    pub memory: Option<u64>,
    /// Dispatches after which each field has a NaN.
    pub not_a_number_after: Option<u64>,
    /// Milliseconds added to the compilation of a shader.
    pub compiling: Option<u64>,
}

impl Faults {
    /// An adapter's limits, narrowed.
    pub(crate) fn narrowed(&self, limits: Limits) -> Limits {
        let binding = limits.binding.min(self.binding_limit.unwrap_or(u64::MAX));
        let slab = binding.min(self.slab_bytes.unwrap_or(u64::MAX));
        Limits {
            binding,
            slab,
            longest_line: self.longest_line.unwrap_or(limits.longest_line),
            ..limits
        }
    }
}
