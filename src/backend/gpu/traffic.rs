//! Costs of a solve besides arithmetic: dispatches, waits and transfers.

/// Counts since a backend was made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Traffic {
    /// Dispatches recorded.
    pub dispatches: u64,
    /// Times that the host waited for the scalars.
    pub looks: u64,
    /// Fields written to the device.
    pub fields_up: u64,
    /// Fields read from it.
    pub fields_down: u64,
}
