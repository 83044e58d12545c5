//! Whether a shader repeats code or goes round a loop.

/// What becomes of a loop of known length in a shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Loops {
    /// Its body is written out for each turn. wgpu bounds every loop, and a compiler does not unroll a bounded one, which
    /// costs a graphics processor registers and time.
    Unrolled,
    /// It stays a loop. A software driver compiles each copy of a body for longer than most tests and trials run it.
    Kept,
}

/// A count that no compiler knows: it would unroll a short loop.
pub fn hidden(count: usize) -> String {
    format!("{count}u + params.zero")
}
