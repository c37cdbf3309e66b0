//! The threads that take jobs from the queue of the asynchronous service and solve them, each one job
//! at a time.
//!
//! A thread leases a job, solves it on its pool and records its end. It reaches the database through
//! the handle of the runtime; nothing is computed on the runtime's threads. The pools share the threads
//! of the solver, so that every job gets its part.

use super::leg_table::{self, TableStore};
use super::memory::MemoryGuard;
use super::progress::{Reporter, record};
use super::segments::{self, SegmentCache};
use super::solve::{self, JobContext};
use super::{ActiveJob, Jobs};
use crate::base::clock::now_us;
use crate::store::{Ended, JobRow, JobState, Lease, MemoryRoom, Notice, StoreError, Work};
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
/// Pause before another try after a failure of the database.
const RETRY: Duration = Duration::from_millis(500);
/// Interval between two looks at the queue without a notification.
const POLL: Duration = Duration::from_secs(5);
/// Time for which a job waits while others, which have room beside the running ones, are begun before
/// it.
const PASSED_OVER: Duration = Duration::from_mins(2);

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
        for active in &*self.jobs.active() {
            active.stop.cancel();
        }
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
                Ok(Some((lease, memory))) => self.work_contained(&lease, memory),
                Ok(None) => {}
                Err(error) => {
                    tracing::error!(%error, "no job can be leased");
                    retry_later();
                }
            }
        }
    }

    /// Leases a job, or waits for a notification or the next look at the queue and returns `None`.
    async fn next(&self) -> Result<Option<(Lease, MemoryGuard)>, StoreError> {
        let mut queued = pin!(self.jobs.0.queued.notified());
        // Every job that is queued from here on wakes another of the threads that look.
        queued.as_mut().enable();
        if self.draining.load(Ordering::SeqCst) {
            return Ok(None);
        }
        let leased = self.leased().await?;
        if leased.is_none() {
            // A notification from before this wait ends it at once.
            let _ = tokio::time::timeout(POLL, queued).await;
        }
        Ok(leased)
    }

    /// Leases a job that has room beside the running ones, if one is queued, and takes its memory.
    async fn leased(&self) -> Result<Option<(Lease, MemoryGuard)>, StoreError> {
        let (store, memory) = (self.jobs.store(), &self.jobs.0.memory);
        // Two that look at the same time could both find all memory free.
        let _alone = memory.admission().await;
        let now_us = now_us();
        let room = memory.free().map_or(MemoryRoom::ALL, |bytes| MemoryRoom {
            bytes: bytes.try_into().unwrap_or(i64::MAX),
            passed_over_since_us: now_us.saturating_sub(microseconds(PASSED_OVER)),
        });
        let lease_until_us = lease_end(store.lease_clock_us());
        let lease = store.lease(&self.boot_id, lease_until_us, room, now_us);
        let Some(lease) = lease.await? else {
            return Ok(None);
        };
        let memory = memory.admit(lease.memory_bytes.try_into().unwrap_or(0));
        if lease.more_wait {
            self.jobs.0.queued.notify_one();
        }
        Ok(Some((lease, memory)))
    }

    /// Works on a job; after a panic the thread goes on to the next.
    fn work_contained(&self, lease: &Lease, memory: MemoryGuard) {
        let job = &lease.job;
        if catch_unwind(AssertUnwindSafe(|| self.work(lease, memory))).is_err() {
            self.conclude(job, &solve::broken());
        }
        let ended = |active: &ActiveJob| active.id == job.id && active.fence == job.fence;
        self.jobs.active().retain(|active| !ended(active));
        self.jobs.changed();
    }

    fn work(&self, lease: &Lease, mut memory: MemoryGuard) {
        let job = &lease.job;
        let span = tracing::info_span!("job", job_id = job.id, attempt = job.attempt);
        let _entered = span.enter();
        tracing::info!(targets = job.targets, "solve begins");
        self.jobs.metrics().begun(job);
        let begin = Instant::now();
        self.jobs.changed();
        let stop = StopSignal::new();
        self.jobs.active().push(ActiveJob {
            id: job.id.clone(),
            fence: job.fence,
            stop: stop.clone(),
        });
        self.apply_earlier_requests(job, &stop);
        let (reporter, reports) = Reporter::new();
        let legs = self.jobs.legs(self.runtime.clone());
        let recording = record(self.jobs.clone(), job.clone(), legs.unwritten(), reports);
        let recorder = self.runtime.spawn(recording);
        let prolonging = self
            .runtime
            .spawn(prolong(self.jobs.clone(), job.clone(), stop.clone()));
        let prolonging = AbortOnDrop(prolonging.abort_handle());
        let segments = SegmentCache::new(self.jobs.store().clone(), &self.runtime, job.clone());
        let writing = self.runtime.spawn(segments.writing());
        let writing = AbortOnDrop(writing.abort_handle());
        memory.watch(&self.runtime, stop.clone());
        let context = JobContext {
            pool: &self.pool,
            stop: &stop,
            reporter: &reporter,
            legs: &legs,
            segments: &segments,
            memory: &memory,
        };
        let ended = match job.work() {
            Ok(Work::Plan) => solve::solve(&lease.scenario, &context),
            Ok(Work::LegTable) => {
                let writing = self.runtime.spawn(legs.unwritten().keep_writing());
                let _writing = AbortOnDrop(writing.abort_handle());
                let parts = TableStore {
                    jobs: &self.jobs,
                    lease: job,
                    runtime: &self.runtime,
                };
                leg_table::solve(&lease.scenario, &context, &parts)
            }
            Err(error) => solve::without_plan(JobState::Failed, None, &error.to_string()),
        };
        drop(memory);
        // Legs are stored before the end of the job is recorded, so that its observers find them.
        drop(legs);
        drop(reporter);
        drop((prolonging, writing));
        if self.runtime.block_on(recorder).is_err() {
            tracing::error!("progress was not recorded to its end");
        }
        self.conclude(job, &ended);
        if segments.leaves_something() {
            self.runtime
                .spawn(segments::delete_of_ended_jobs(self.jobs.store().clone()));
        }
        let solved_s = begin.elapsed().as_secs_f64();
        self.jobs.metrics().ended(&ended, solved_s);
    }

    /// Applies requests that were recorded between the lease and the creation of the stop signal.
    fn apply_earlier_requests(&self, job: &JobRow, stop: &StopSignal) {
        self.runtime.block_on(self.jobs.apply_requests(&job.id));
        if self.draining.load(Ordering::SeqCst) {
            stop.cancel();
        }
    }

    /// Records the end; tries again until it is recorded, the lease is lost or the service ends.
    fn conclude(&self, job: &JobRow, ended: &Ended) {
        let interrupted =
            self.draining.load(Ordering::SeqCst) && ended.state == JobState::Cancelled;
        loop {
            let recorded = self.runtime.block_on(async {
                match self.jobs.store().job(&job.id).await? {
                    Some(now) if interrupted && now.cancel_requested_us.is_none() => {
                        self.jobs.store().release(job, now_us()).await
                    }
                    _ => self.jobs.store().finish(job, ended, now_us()).await,
                }
            });
            match recorded {
                Ok(true) => {
                    tracing::info!(state = ended.state.into_str(), interrupted, "solve ended");
                    if interrupted {
                        self.jobs.store().tell(Notice::Queued);
                    }
                    return;
                }
                Ok(false) => {
                    tracing::warn!("the job was deleted or taken over; its end is not recorded");
                    return;
                }
                Err(error) if self.draining.load(Ordering::SeqCst) => {
                    tracing::error!(%error, "the end of the job is not recorded");
                    return;
                }
                Err(error) => {
                    tracing::error!(%error, "the end of the job cannot be recorded yet");
                    retry_later();
                }
            }
        }
    }
}

/// Aborts a task when it is dropped.
struct AbortOnDrop(AbortHandle);

impl Drop for AbortOnDrop {
    fn drop(&mut self) {
        self.0.abort();
    }
}

fn lease_end(now_us: i64) -> i64 {
    now_us.saturating_add(microseconds(LEASE))
}

fn microseconds(time: Duration) -> i64 {
    i64::try_from(time.as_micros()).unwrap_or(i64::MAX)
}

/// Prolongs a lease at intervals; cancels the solve when the lease has been lost.
async fn prolong(jobs: Jobs, lease: JobRow, stop: StopSignal) {
    loop {
        tokio::time::sleep(PROLONGATION).await;
        let lease_until_us = lease_end(jobs.store().lease_clock_us());
        match jobs.store().prolong(&lease, lease_until_us).await {
            // Another process may have recorded a request, and its notice may be lost.
            Ok(true) if jobs.store().is_shared() => jobs.apply_requests(&lease.id).await,
            Ok(true) => {}
            Ok(false) => {
                stop.cancel();
                return;
            }
            Err(error) => tracing::warn!(job_id = lease.id, %error, "lease not prolonged"),
        }
    }
}

/// Blocks the worker's thread, which does nothing else.
#[expect(clippy::disallowed_methods, reason = "blocks the worker's thread only")]
fn retry_later() {
    std::thread::sleep(RETRY);
}
