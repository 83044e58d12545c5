//! Time that passes: the one place that asks the system for it.
//!
//! In a browser (`wasm32-unknown-unknown`) there is nobody to ask, and [`std::time`] would panic: there all
//! times are 0.

/// A clock that began to run at some moment.
#[derive(Clone, Copy, Debug)]
pub struct Clock {
    #[cfg(not(target_family = "wasm"))]
    began: std::time::Instant,
}

impl Clock {
    /// Starts it now.
    pub fn start() -> Self {
        Clock {
            #[cfg(not(target_family = "wasm"))]
            began: std::time::Instant::now(),
        }
    }

    /// Seconds since it was started; 0 in a browser.
    pub fn seconds(&self) -> f64 {
        #[cfg(not(target_family = "wasm"))]
        return self.began.elapsed().as_secs_f64();
        #[cfg(target_family = "wasm")]
        return 0.0;
    }
}

/// Whole seconds since 1970; 0 in a browser.
pub fn seconds_since_epoch() -> u64 {
    #[cfg(not(target_family = "wasm"))]
    return std::time::SystemTime::now()
        .duration_since(std::time::UNIX_EPOCH)
        .map_or(0, |since| since.as_secs());
    #[cfg(target_family = "wasm")]
    return 0;
}
