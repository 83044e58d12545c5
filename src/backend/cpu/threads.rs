//! The pool of threads that work runs on, and the memory that it keeps.

use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::backend::BackendError;

/// Runs `work` on a pool of `threads` threads (all cores if `None`), to which every backend made
/// inside belongs.
pub fn with_threads<R: Send>(
    threads: Option<usize>,
    work: impl FnOnce() -> R + Send,
) -> Result<R, BackendError> {
    Ok(Threads::new(threads)?.run(work))
}

/// Runs `work` on the pool of its caller; of a caller outside of any, on that of all cores. A solve from outside of a pool would
/// wake a thread, and wait for it, for each of its kernels.
pub fn in_pool<R: Send>(work: impl FnOnce() -> R + Send) -> R {
    rayon::scope(|_| work())
}

/// Nearly the longest piece of memory that the allocator keeps when it is let go (glibc on 64 bits).
const LONGEST_KEPT: usize = (32 << 20) - (64 << 10);

/// Has the allocator keep the fields that are let go for those that come next, up to that length: glibc gives back to
/// the system what is longer than any piece that it has seen come and go, and then every page is taken anew. This
/// piece is never written to, so it has no pages.
pub fn keep_memory() {
    if cfg!(all(target_env = "gnu", target_pointer_width = "64")) {
        let mut piece: Vec<u8> = Vec::new();
        // Without so much memory it learns nothing.
        let _ = piece.try_reserve_exact(LONGEST_KEPT);
        std::hint::black_box(&mut piece);
    }
}

/// A pool of threads that is kept between pieces of work: so the memory that one of them lets go is there for the next.
pub struct Threads(ThreadPool);

impl Threads {
    /// So many of them, all cores if `None`.
    pub fn new(threads: Option<usize>) -> Result<Threads, BackendError> {
        let pool = ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0));
        let pool = pool.build();
        pool.map(Threads)
            .map_err(|error| BackendError::Device(format!("no thread pool: {error}")))
    }

    /// Runs `work` on them, to whom every backend made inside belongs.
    pub fn run<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        self.0.install(work)
    }
}

#[cfg(test)]
mod tests {
    use rayon::{current_num_threads, current_thread_index};

    use super::*;

    #[test]
    fn work_is_in_a_pool_that_of_its_caller_where_there_is_one() {
        assert_eq!(current_thread_index(), None);
        assert!(in_pool(current_thread_index).is_some());
        let threads = Threads::new(Some(3)).expect("three threads");
        assert_eq!(threads.run(|| in_pool(current_num_threads)), 3);
    }
}
