//! The bridge between the asynchronous service and the solver's threads.
//!
//! One plain thread leases a job, solves it on the pool and records its end. The database is
//! reached through the handle of the runtime; nothing is computed on the runtime's threads.

use super::memory::MemoryGuard;
use super::progress::{Reporter, record};
use super::segments::{self, SegmentCache};
use super::solve::{self, JobContext};
use super::{Active, Jobs};
use crate::base::clock::now_us;
use crate::store::{Ended, JobRow, JobState, Lease, StoreError};
use slewplan_solver::run::pool::SolverPool;
use slewplan_solver::run::stop::StopSignal;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};
use tokio::runtime::Handle;
use tokio::task::AbortHandle;

/// How long a lease lasts without a beat, and how often it beats.
const LEASE: Duration = Duration::from_secs(10);
const BEAT: Duration = Duration::from_secs(2);
/// Pause after a failure of the database before it is asked again.
const RETRY: Duration = Duration::from_millis(500);
/// How often the queue is looked at when nobody said that something is in it.
const POLL: Duration = Duration::from_secs(5);

/// The thread that solves.
#[derive(Debug)]
pub(crate) struct Worker {
    jobs: Jobs,
    draining: Arc<AtomicBool>,
    thread: JoinHandle<()>,
}

impl Worker {
    /// Starts the thread.
    ///
    /// # Errors
    ///
    /// When the operating system refuses it.
    pub(crate) fn start(jobs: Jobs, pool: Arc<SolverPool>, boot_id: String) -> io::Result<Self> {
        let draining = Arc::new(AtomicBool::new(false));
        let bench = Bench {
            jobs: jobs.clone(),
            pool,
            boot_id,
            draining: Arc::clone(&draining),
            runtime: Handle::current(),
        };
        let thread = std::thread::Builder::new()
            .name("slewplan-worker".into())
            .spawn(move || bench.run())?;
        Ok(Self {
            jobs,
            draining,
            thread,
        })
    }

    /// Claims nothing more and gives a running job back to the queue; returns when that is done.
    pub(crate) async fn drain(self) {
        self.draining.store(true, Ordering::SeqCst);
        self.jobs.0.queued.notify_one();
        {
            let active = self.jobs.0.active.lock();
            let active = active.unwrap_or_else(std::sync::PoisonError::into_inner);
            if let Some(active) = active.as_ref() {
                active.stop.cancel();
            }
        }
        let ended = tokio::task::spawn_blocking(move || self.thread.join()).await;
        if !matches!(ended, Ok(Ok(()))) {
            tracing::error!("the worker ended with a panic");
        }
    }
}

/// What the thread works with.
struct Bench {
    jobs: Jobs,
    pool: Arc<SolverPool>,
    boot_id: String,
    draining: Arc<AtomicBool>,
    runtime: Handle,
}

impl Bench {
    fn run(&self) {
        while !self.draining.load(Ordering::SeqCst) {
            match self.runtime.block_on(self.next()) {
                Ok(Some(lease)) => self.contain(&lease),
                Ok(None) => {}
                Err(error) => {
                    tracing::error!(%error, "no job can be claimed");
                    retry_later();
                }
            }
        }
    }

    /// Waits for a job and leases it; `None` when it is time to look around.
    async fn next(&self) -> Result<Option<Lease>, StoreError> {
        let now = now_us();
        let lease = self
            .jobs
            .store()
            .lease(&self.boot_id, lease_end(now), now)
            .await?;
        if lease.is_none() {
            // A notification that came before this wait is kept for it.
            let _ = tokio::time::timeout(POLL, self.jobs.0.queued.notified()).await;
        }
        Ok(lease)
    }

    /// Works on a job; whatever goes wrong, the thread goes on to the next.
    fn contain(&self, lease: &Lease) {
        if catch_unwind(AssertUnwindSafe(|| self.work(lease))).is_err() {
            self.conclude(&lease.job, &solve::broken());
        }
        self.jobs.set_active(None);
        self.jobs.changed();
    }

    fn work(&self, lease: &Lease) {
        let job = &lease.job;
        let span = tracing::info_span!("job", job_id = job.id, attempt = job.attempt);
        let _entered = span.enter();
        tracing::info!(targets = job.targets, "solve begins");
        self.jobs.metrics().begun(job);
        let begin = Instant::now();
        self.jobs.changed();
        let stop = StopSignal::new();
        self.jobs.set_active(Some(Active {
            id: job.id.clone(),
            stop: stop.clone(),
        }));
        self.catch_up(job, &stop);
        let (reporter, reports) = Reporter::new();
        let legs = self.jobs.legs(self.runtime.clone());
        let recording = record(self.jobs.clone(), job.clone(), legs.unwritten(), reports);
        let recorder = self.runtime.spawn(recording);
        let heart = self
            .runtime
            .spawn(beat(self.jobs.clone(), job.clone(), stop.clone()));
        let heart = Attendant(heart.abort_handle());
        let segments = SegmentCache::new(self.jobs.store().clone(), &self.runtime, job.clone());
        let writing = self.runtime.spawn(segments.writing());
        let writing = Attendant(writing.abort_handle());
        let memory = MemoryGuard::watch(&self.runtime, self.jobs.memory_limit(), stop.clone());
        let context = JobContext {
            pool: &self.pool,
            stop: &stop,
            reporter: &reporter,
            legs: &legs,
            segments: &segments,
            memory: &memory,
        };
        let ended = solve::solve(&lease.scenario, &context);
        drop(memory);
        // Legs are written before the end is told: whoever asks then finds them.
        drop(legs);
        drop(reporter);
        drop((heart, writing));
        if self.runtime.block_on(recorder).is_err() {
            tracing::error!("progress was not recorded to its end");
        }
        self.conclude(job, &ended);
        if segments.leaves_something() {
            self.runtime
                .spawn(segments::forget(self.jobs.store().clone()));
        }
        let solved_s = begin.elapsed().as_secs_f64();
        self.jobs.metrics().ended(&ended, solved_s);
    }

    /// Obeys requests that came between the lease and the moment when the signal was in place.
    fn catch_up(&self, job: &JobRow, stop: &StopSignal) {
        match self.runtime.block_on(self.jobs.store().job(&job.id)) {
            Ok(Some(job)) => {
                if job.stop_requested_us.is_some() {
                    stop.request();
                }
                if job.cancel_requested_us.is_some() {
                    stop.cancel();
                }
            }
            Ok(None) => stop.cancel(),
            Err(error) => tracing::warn!(%error, "requests of the past cannot be read"),
        }
        if self.draining.load(Ordering::SeqCst) {
            stop.cancel();
        }
    }

    /// Records the end; tries again until the database takes it or the lease is lost.
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

/// A task that attends to a job while this lives.
struct Attendant(AbortHandle);

impl Drop for Attendant {
    fn drop(&mut self) {
        self.0.abort();
    }
}

fn lease_end(now_us: i64) -> i64 {
    now_us.saturating_add(i64::try_from(LEASE.as_micros()).unwrap_or(i64::MAX))
}

/// Prolongs the lease of a lease; a lost lease is not worked on any longer.
async fn beat(jobs: Jobs, lease: JobRow, stop: StopSignal) {
    loop {
        tokio::time::sleep(BEAT).await;
        match jobs.store().beat(&lease, lease_end(now_us())).await {
            Ok(true) => {}
            Ok(false) => {
                stop.cancel();
                return;
            }
            Err(error) => tracing::warn!(job_id = lease.id, %error, "lease not prolonged"),
        }
    }
}

/// Waits on the worker's own thread, which nothing else runs on.
#[expect(clippy::disallowed_methods, reason = "blocks the worker's thread only")]
fn retry_later() {
    std::thread::sleep(RETRY);
}
