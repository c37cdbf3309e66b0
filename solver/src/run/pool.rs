//! The worker pool; the global rayon pool is never used.

use super::sharing::{self, Share};
use std::num::NonZeroUsize;
use std::sync::Arc;

/// Shares of short work for each worker.
const SHARES: usize = 4;

/// A fixed set of worker threads for solving.
#[derive(Debug)]
pub struct SolverPool {
    workers: rayon::ThreadPool,
    /// Where the workers of several pools take turns to compute.
    share: Option<Share>,
}

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
        Ok(Self {
            workers: workers(count(threads), prepare)?,
            share: None,
        })
    }

    /// Starts pools for several solves at once that share a number of threads: each has as many
    /// workers, and of all of them no more than that compute at the same time. The solve that has
    /// computed least is the next, so that each gets the same time while all have work.
    ///
    /// # Errors
    ///
    /// When the threads cannot be started.
    pub fn sharing(
        threads: Option<NonZeroUsize>,
        solves: usize,
        prepare: impl Fn() + Send + Sync + 'static,
    ) -> Result<Vec<Self>, PoolError> {
        let (count, prepare) = (count(threads), Arc::new(prepare));
        let pools = Share::of(count, solves).map(|share| {
            let prepare = Arc::clone(&prepare);
            Ok(Self {
                workers: workers(count, move || prepare())?,
                share: Some(share),
            })
        });
        pools.collect()
    }

    /// Number of workers.
    #[must_use]
    pub fn threads(&self) -> usize {
        self.workers.current_num_threads()
    }

    /// Runs on the workers, and meanwhile leaves the slot of this thread to others.
    fn install<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        let _waiting = sharing::wait_for_others();
        self.workers.install(work)
    }

    /// Computes a piece of work, in its turn where threads are shared.
    fn computing(&self) -> Option<sharing::Computing> {
        self.share.as_ref().map(Share::compute)
    }

    /// Maps items on the workers; results keep the order of the items, so that nothing that is
    /// built from them depends on the number of threads.
    pub fn map<T: Sync, R: Send>(&self, items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
        use rayon::prelude::*;
        self.install(|| {
            items
                .par_iter()
                // Solves are long and uneven: steal one at a time.
                .with_max_len(1)
                .map(|item| {
                    let _computing = self.computing();
                    work(item)
                })
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
        self.install(|| {
            items
                .into_par_iter()
                .with_min_len(row)
                .map_init(|| self.computing(), |_, item| work(item))
                .collect()
        })
    }

    /// Does two pieces of work, at the same time if there are workers for both; either may give work to
    /// all workers.
    pub fn join<A: Send, B: Send>(
        &self,
        first: impl FnOnce() -> A + Send,
        second: impl FnOnce() -> B + Send,
    ) -> (A, B) {
        let first = || {
            let _computing = self.computing();
            first()
        };
        let second = || {
            let _computing = self.computing();
            second()
        };
        self.install(|| rayon::join(first, second))
    }
}

fn count(threads: Option<NonZeroUsize>) -> usize {
    threads.map_or_else(
        || std::thread::available_parallelism().map_or(1, NonZeroUsize::get),
        NonZeroUsize::get,
    )
}

fn workers(
    count: usize,
    prepare: impl Fn() + Send + Sync + 'static,
) -> Result<rayon::ThreadPool, PoolError> {
    let builder = rayon::ThreadPoolBuilder::new()
        .num_threads(count)
        .start_handler(move |_| prepare())
        .thread_name(|index| format!("slewplan-solver-{index}"));
    Ok(builder.build()?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::stop::StopSignal;
    use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
    use std::time::{Duration, Instant};

    fn sharing(threads: usize, solves: usize) -> Vec<SolverPool> {
        SolverPool::sharing(NonZeroUsize::new(threads), solves, || {}).expect("threads")
    }

    /// Computes until something is so, at most for a minute; whether it is.
    fn computed_until(so: impl Fn() -> bool) -> bool {
        let (stop, begin) = (StopSignal::new(), Instant::now());
        while !so() && begin.elapsed() < Duration::from_mins(1) {
            assert!(!stop.is_set());
        }
        so()
    }

    #[test]
    fn no_more_workers_compute_than_there_are_threads_and_results_keep_their_order() {
        let (computing, most) = (AtomicUsize::new(0), AtomicUsize::new(0));
        let work = |item: &u32| {
            most.fetch_max(
                computing.fetch_add(1, Ordering::SeqCst) + 1,
                Ordering::SeqCst,
            );
            let squares = (0..20_000).map(|k| u64::from(k ^ item)).sum::<u64>();
            computing.fetch_sub(1, Ordering::SeqCst);
            squares
        };
        let items: Vec<u32> = (0..500).collect();
        let alone = SolverPool::new(NonZeroUsize::new(1)).expect("a thread");
        let expected = alone.map(&items, work);
        let pools = sharing(2, 3);
        std::thread::scope(|scope| {
            for pool in &pools {
                scope.spawn(|| assert_eq!(pool.map(&items, work), expected));
                scope.spawn(|| {
                    let short = pool.map_short(items.clone(), |item| work(&item));
                    assert_eq!(short, expected);
                });
            }
        });
        assert_eq!(most.into_inner(), 2);
    }

    #[test]
    fn a_long_piece_of_work_makes_way_for_those_of_another_solve() {
        let pools = sharing(1, 2);
        let (begun, done) = (AtomicBool::new(false), AtomicBool::new(false));
        std::thread::scope(|scope| {
            let long = scope.spawn(|| {
                pools[0].map(&[()], |()| {
                    begun.store(true, Ordering::SeqCst);
                    computed_until(|| done.load(Ordering::SeqCst))
                })
            });
            assert!(computed_until(|| begun.load(Ordering::SeqCst)));
            pools[1].map(&[(); 8], |()| ());
            done.store(true, Ordering::SeqCst);
            assert_eq!(long.join().expect("no panic"), [true]);
        });
    }

    #[test]
    fn work_within_work_needs_no_further_thread() {
        let pools = sharing(1, 2);
        std::thread::scope(|scope| {
            for pool in &pools {
                scope.spawn(|| {
                    let nested = pool.map(&[1, 2, 3], |item| pool.map(&[10, 20], |ten| ten + item));
                    assert_eq!(nested, [[11, 21], [12, 22], [13, 23]]);
                    let (first, second) = pool.join(|| pool.map(&[1, 2], |item| 2 * item), || 3);
                    assert_eq!((first, second), (vec![2, 4], 3));
                });
            }
        });
    }

    #[test]
    fn after_a_panic_the_thread_is_free_again() {
        let pools = sharing(1, 2);
        let failed = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
            pools[0].map(&[()], |()| panic!("on purpose"));
        }));
        assert!(failed.is_err());
        assert_eq!(pools[1].map(&[7], |item| *item), [7]);
    }
}
