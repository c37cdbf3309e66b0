//! The worker pool; the global rayon pool is never used.

use std::num::NonZeroUsize;

/// Shares of short work for each worker.
const SHARES: usize = 4;

/// A fixed set of worker threads for solving.
#[derive(Debug)]
pub struct SolverPool(rayon::ThreadPool);

/// The operating system refused to start worker threads.
#[derive(Debug, thiserror::Error)]
#[error("cannot start the solver's worker threads: {0}")]
pub struct PoolError(#[from] rayon::ThreadPoolBuildError);

impl SolverPool {
    /// Starts the workers; `None` takes one per available core.
    ///
    /// # Errors
    ///
    /// When the threads cannot be started.
    pub fn new(threads: Option<NonZeroUsize>) -> Result<Self, PoolError> {
        Self::prepared(threads, || {})
    }

    /// Starts the workers, each of which calls `prepare` first; `None` takes one per available
    /// core.
    ///
    /// # Errors
    ///
    /// When the threads cannot be started.
    pub fn prepared(
        threads: Option<NonZeroUsize>,
        prepare: impl Fn() + Send + Sync + 'static,
    ) -> Result<Self, PoolError> {
        let count = threads.map_or_else(
            || std::thread::available_parallelism().map_or(1, NonZeroUsize::get),
            NonZeroUsize::get,
        );
        Ok(Self(
            rayon::ThreadPoolBuilder::new()
                .num_threads(count)
                .start_handler(move |_| prepare())
                .thread_name(|index| format!("slewplan-solver-{index}"))
                .build()?,
        ))
    }

    /// Number of workers.
    #[must_use]
    pub fn threads(&self) -> usize {
        self.0.current_num_threads()
    }

    /// Maps items on the workers; results keep the order of the items, so that nothing that is
    /// built from them depends on the number of threads.
    pub fn map<T: Sync, R: Send>(&self, items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
        use rayon::prelude::*;
        self.0.install(|| {
            items
                .par_iter()
                // Solves are long and uneven: steal one at a time.
                .with_max_len(1)
                .map(&work)
                .collect()
        })
    }

    /// Maps items whose work is short and even, many in a row on each worker.
    pub fn map_short<T: Send, R: Send>(
        &self,
        items: Vec<T>,
        work: impl Fn(T) -> R + Sync + Send,
    ) -> Vec<R> {
        use rayon::prelude::*;
        let row = items.len().div_ceil(SHARES * self.threads());
        self.0
            .install(|| items.into_par_iter().with_min_len(row).map(work).collect())
    }

    /// Does two pieces of work, at the same time if there are workers for both; either may give work to
    /// all workers.
    pub fn join<A: Send, B: Send>(
        &self,
        first: impl FnOnce() -> A + Send,
        second: impl FnOnce() -> B + Send,
    ) -> (A, B) {
        self.0.install(|| rayon::join(first, second))
    }
}
