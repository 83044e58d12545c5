//! Processor time of this process.

/// Clock ticks a second in `/proc/self/stat`, on every current Linux.
const TICKS_A_SECOND: f64 = 100.0;

/// CPU seconds of all threads so far, to 0.01 s; Linux only.
pub fn cpu_seconds() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/stat").ok()?;
    // The command's name may contain anything and ends at the last parenthesis.
    let (_, fields) = text.rsplit_once(')')?;
    let mut ticks = fields.split_whitespace().skip(11);
    let user: f64 = ticks.next()?.parse().ok()?;
    let system: f64 = ticks.next()?.parse().ok()?;
    Some((user + system) / TICKS_A_SECOND)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(target_os = "linux")]
    #[test]
    fn work_takes_processor_time() {
        let before = cpu_seconds().expect("known on Linux");
        let clock = std::time::Instant::now();
        let mut sum = 0.0_f64;
        // Until a tick has passed: 0.01 s of work, however busy the machine.
        while cpu_seconds().expect("known on Linux") == before {
            sum += (0..10_000).map(f64::from).map(f64::sqrt).sum::<f64>();
            assert!(clock.elapsed().as_secs() < 60, "no tick after {sum:e}");
        }
    }
}
