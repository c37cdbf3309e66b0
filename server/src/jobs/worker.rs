//! The threads that take jobs from the queue of the asynchronous service and solve them, each one job
//! at a time.
//!
//! A thread leases a job, solves it on its pool and leaves its end on the desk, which stores it with the
//! next lease. It reaches the database through
//! the handle of the runtime; nothing is computed on the runtime's threads. The pools share the threads
//! of the solver, so that every job gets its part.

use super::Jobs;
use super::desk::{BegunJob, EndedJob};
use super::leg_cache::LegCache;
use super::leg_table::{self, TableStore};
use super::memory::MemoryGuard;
use super::progress::{Recorded, Reporter, record};
use super::segments::SegmentCache;
use super::shards;
use super::solve::{self, JobContext};
use crate::base::clock::now_us;
use crate::store::{
    Ended, JobEnd, JobRow, JobState, Lease, NewLeg, Notice, ProgressRow, StoreError, Work,
};
use slewplan_solver::run::pool::SolverPool;
use slewplan_solver::run::stop::StopSignal;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::pin::pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};
use tokio::runtime::Handle;
use tokio::task::AbortHandle;

/// Duration of a lease, and the interval between two prolongations.
pub(super) const LEASE: Duration = Duration::from_secs(10);
const PROLONGATION: Duration = Duration::from_secs(2);
/// Pause before another try to prolong a lease after a failure.
const PROLONGATION_RETRY: Duration = Duration::from_millis(200);
/// Pause before another try after a failure of the database.
const RETRY: Duration = Duration::from_millis(500);
/// Interval between two looks at the queue without a notification.
const POLL: Duration = Duration::from_secs(5);
/// The same where all processes look every few seconds whether jobs wait.
const SHARED_POLL: Duration = Duration::from_mins(1);
/// Time for which a job waits while others, which have room beside the running ones, are begun before
/// it.
pub(super) const PASSED_OVER: Duration = Duration::from_mins(2);

/// The threads that solve.
#[derive(Debug)]
pub(crate) struct Worker {
    jobs: Jobs,
    draining: Arc<AtomicBool>,
    threads: Vec<JoinHandle<()>>,
}

impl Worker {
    /// Starts a thread for each pool; each calls `prepare` first.
    ///
    /// # Errors
    ///
    /// When the operating system refuses one.
    pub(crate) fn start(
        jobs: &Jobs,
        pools: Vec<Arc<SolverPool>>,
        boot_id: &str,
        prepare: fn(),
    ) -> io::Result<Self> {
        let draining = Arc::new(AtomicBool::new(false));
        let threads = pools.into_iter().enumerate().map(|(number, pool)| {
            let worker = WorkerThread {
                jobs: jobs.clone(),
                pool,
                boot_id: boot_id.to_owned(),
                draining: Arc::clone(&draining),
                runtime: Handle::current(),
            };
            let work = move || {
                prepare();
                worker.run();
            };
            std::thread::Builder::new()
                .name(format!("slewplan-job-{number}"))
                .spawn(work)
        });
        Ok(Self {
            threads: threads.collect::<Result<_, _>>()?,
            jobs: jobs.clone(),
            draining,
        })
    }

    /// Leases no more jobs and returns the running ones to the queue; waits for both.
    pub(crate) async fn drain(self) {
        self.draining.store(true, Ordering::SeqCst);
        self.jobs.0.queued.notify_waiters();
        self.jobs.0.active.cancel_all();
        let join = || self.threads.into_iter().map(JoinHandle::join).collect();
        let ended: Result<Vec<_>, _> = tokio::task::spawn_blocking(join).await;
        if !ended.is_ok_and(|ended| ended.iter().all(Result::is_ok)) {
            tracing::error!("a worker ended with a panic");
        }
    }
}

/// The state of a worker's thread.
struct WorkerThread {
    jobs: Jobs,
    pool: Arc<SolverPool>,
    boot_id: String,
    draining: Arc<AtomicBool>,
    runtime: Handle,
}

impl WorkerThread {
    fn run(&self) {
        while !self.draining.load(Ordering::SeqCst) {
            match self.runtime.block_on(self.next()) {
                Ok(Some(begun)) => self.work_contained(begun),
                Ok(None) => {}
                Err(error) => {
                    tracing::error!(%error, "no job can be leased, and no end recorded");
                    retry_later();
                }
            }
        }
        if let Err(error) = self.runtime.block_on(self.jobs.clear_desk()) {
            tracing::error!(%error, "ends of jobs are not recorded");
        }
    }

    /// Begins a job, or waits for a notification or the next look at the queue and returns `None`.
    async fn next(&self) -> Result<Option<BegunJob>, StoreError> {
        let mut queued = pin!(self.jobs.0.queued.notified());
        // Every job that is queued from here on wakes another of the threads that look.
        queued.as_mut().enable();
        if self.draining.load(Ordering::SeqCst) {
            return Ok(None);
        }
        let begun = self.jobs.next(&self.boot_id).await?;
        if begun.is_none() {
            let shared = self.jobs.store().is_shared();
            // A notification from before this wait ends it at once.
            let _ = tokio::time::timeout(if shared { SHARED_POLL } else { POLL }, queued).await;
        }
        Ok(begun)
    }

    /// Works on a job; after a panic the thread goes on to the next.
    fn work_contained(&self, begun: BegunJob) {
        let BegunJob {
            lease,
            memory,
            is_stored,
        } = begun;
        let job = if is_stored {
            lease.job.clone()
        } else {
            lease.job.begun(now_us())
        };
        let begin = Instant::now();
        let work = || self.work(&lease, &job, is_stored, memory);
        let worked = catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|_| Worked {
            begin_is_stored: is_stored,
            progress: None,
            ended: solve::broken(),
            legs: Vec::new(),
            leaves_segments: true,
            has_shards: true,
        });
        let solved_s = begin.elapsed().as_secs_f64();
        self.conclude(lease, job, worked, solved_s);
    }

    /// Solves a job, which is given as it is at its begin.
    fn work(
        &self,
        lease: &Lease,
        job: &JobRow,
        is_stored: bool,
        mut memory: MemoryGuard,
    ) -> Worked {
        let span = tracing::info_span!("job", job_id = job.id, attempt = job.attempt);
        let _entered = span.enter();
        tracing::info!(targets = job.targets, "solve begins");
        self.jobs.metrics().begun(job);
        let stop = StopSignal::new();
        self.runtime.block_on(self.jobs.begin_active(job, &stop));
        if self.draining.load(Ordering::SeqCst) {
            stop.cancel();
        }
        let (reporter, reports) = Reporter::new();
        let offer = self.jobs.shard_offer(job);
        let legs = self.jobs.legs(self.runtime.clone()).offering(offer.clone());
        let recorder = self.runtime.spawn(record(
            self.jobs.clone(),
            job.clone(),
            is_stored,
            legs.unwritten(),
            stop.clone(),
            reports,
        ));
        let prolonging = prolong(self.jobs.clone(), job.clone(), stop.clone());
        let prolonging = AbortOnDrop(self.runtime.spawn(prolonging).abort_handle());
        let segments = SegmentCache::new(self.jobs.store().clone(), &self.runtime, job.clone());
        let writing = AbortOnDrop(self.runtime.spawn(segments.writing()).abort_handle());
        memory.watch(&self.runtime, stop.clone());
        let context = JobContext {
            pool: &self.pool,
            stop: &stop,
            reporter: &reporter,
            legs: &legs,
            segments: &segments,
            memory: &memory,
        };
        let ended = self.solve(lease, job, &legs, &context);
        drop(memory);
        drop(reporter);
        drop((prolonging, writing));
        let recorded = self.runtime.block_on(recorder).unwrap_or_else(|_| {
            tracing::error!("progress was not recorded to its end");
            Recorded {
                begin_is_stored: is_stored,
                progress: None,
            }
        });
        Worked {
            begin_is_stored: recorded.begin_is_stored,
            progress: recorded.progress,
            ended,
            // Stored with the end of the job, so that its observers find them.
            legs: self.runtime.block_on(legs.unwritten().take()),
            leaves_segments: segments.leaves_something(),
            has_shards: offer.is_some_and(|offer| offer.has_offered()),
        }
    }

    fn solve(
        &self,
        lease: &Lease,
        job: &JobRow,
        legs: &LegCache,
        context: &JobContext<'_>,
    ) -> Ended {
        if let Some(parent) = job.parent {
            let writing = self.runtime.spawn(legs.unwritten().keep_writing());
            let _writing = AbortOnDrop(writing.abort_handle());
            return self.solve_shard(lease, parent, context);
        }
        match job.work() {
            Ok(Work::Plan) => solve::solve(&lease.scenario, context),
            Ok(Work::LegTable) => {
                let writing = self.runtime.spawn(legs.unwritten().keep_writing());
                let _writing = AbortOnDrop(writing.abort_handle());
                let parts = TableStore {
                    jobs: &self.jobs,
                    lease: job,
                    runtime: &self.runtime,
                };
                leg_table::solve(&lease.scenario, context, &parts)
            }
            Err(error) => solve::without_plan(JobState::Failed, None, &error.to_string()),
        }
    }

    /// Solves a part of the table of another job. Its end is one that nobody sees: the part is deleted.
    fn solve_shard(&self, lease: &Lease, parent: i64, context: &JobContext<'_>) -> Ended {
        match self.runtime.block_on(self.jobs.store().sharded_job(parent)) {
            Ok(Some(job)) => shards::solve(&lease.scenario, &job, context),
            Ok(None) => {}
            Err(error) => tracing::warn!(%error, "the job of a part of a table cannot be read"),
        }
        solve::without_plan(JobState::Cancelled, None, "a part of a table has no result")
    }

    /// Deletes a part of a table that is done. After an error it is done again, by look-ups.
    fn end_shard(&self, job: &JobRow, legs: &[NewLeg]) {
        let store = self.jobs.store();
        let ended = self.runtime.block_on(async {
            store.put_legs(legs, now_us()).await?;
            store.end_shard(job).await
        });
        if let Err(error) = ended {
            tracing::warn!(%error, "a part of a table is solved again");
        }
    }

    /// Leaves the end of a job on the desk. One that was interrupted by the end of the service is given back.
    fn conclude(&self, lease: Lease, job: JobRow, worked: Worked, solved_s: f64) {
        let interrupted =
            self.draining.load(Ordering::SeqCst) && worked.ended.state == JobState::Cancelled;
        self.jobs.0.active.end(&job.id, job.fence);
        if interrupted && !worked.begin_is_stored {
            self.jobs.0.desk.put_back(lease);
            return;
        }
        if interrupted && self.runtime.block_on(self.released(&job)) {
            return;
        }
        if job.parent.is_some() {
            return self.end_shard(&job, &worked.legs);
        }
        self.jobs.0.desk.put(EndedJob {
            end: JobEnd {
                begun: (!worked.begin_is_stored).then(|| job.clone()),
                lease: job,
                progress: worked.progress,
                ended: worked.ended,
                has_shards: worked.has_shards,
                at_us: now_us(),
            },
            legs: worked.legs,
            solved_s,
            leaves_segments: worked.leaves_segments,
        });
    }

    /// Gives a job back that has been interrupted, unless it shall be cancelled: `false` then.
    async fn released(&self, job: &JobRow) -> bool {
        let store = self.jobs.store();
        let released = async {
            match store.job(&job.id).await? {
                Some(now) if now.cancel_requested_us.is_some() => Ok(false),
                _ => store.release(job, now_us()).await.map(|_| true),
            }
        };
        match released.await {
            Ok(true) => {
                tracing::info!(job_id = job.id, "the job is given back");
                store.tell(Notice::Queued);
                self.jobs.changed();
                true
            }
            Ok(false) => false,
            Err(error) => {
                tracing::error!(job_id = job.id, %error, "the job is not given back");
                true
            }
        }
    }
}

/// What comes of the work on a job.
struct Worked {
    begin_is_stored: bool,
    progress: Option<ProgressRow>,
    ended: Ended,
    legs: Vec<NewLeg>,
    leaves_segments: bool,
    has_shards: bool,
}

/// Aborts a task when it is dropped.
struct AbortOnDrop(AbortHandle);

impl Drop for AbortOnDrop {
    fn drop(&mut self) {
        self.0.abort();
    }
}

pub(super) fn lease_end(now_us: i64) -> i64 {
    now_us.saturating_add(microseconds(LEASE))
}

pub(super) fn microseconds(time: Duration) -> i64 {
    i64::try_from(time.as_micros()).unwrap_or(i64::MAX)
}

/// Prolongs a lease at intervals; cancels the solve when the lease has been lost.
async fn prolong(jobs: Jobs, lease: JobRow, stop: StopSignal) {
    let mut has_failed = false;
    loop {
        let pause = if has_failed {
            PROLONGATION_RETRY
        } else {
            PROLONGATION
        };
        tokio::time::sleep(pause).await;
        let lease_until_us = lease_end(jobs.store().lease_clock_us());
        match jobs.store().prolong(&lease, lease_until_us).await {
            Ok(false) => {
                stop.cancel();
                return;
            }
            Ok(true) => {
                has_failed = false;
                // Another process may have recorded a request, and its notice may be lost.
                if jobs.store().is_shared() {
                    jobs.apply_requests(&lease.id).await;
                }
            }
            Err(error) => {
                if !has_failed {
                    tracing::warn!(job_id = lease.id, %error, "lease not prolonged");
                }
                has_failed = true;
            }
        }
    }
}

/// Blocks the worker's thread, which does nothing else.
#[expect(clippy::disallowed_methods, reason = "blocks the worker's thread only")]
fn retry_later() {
    std::thread::sleep(RETRY);
}
