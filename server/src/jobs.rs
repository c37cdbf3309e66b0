//! Execution of queued jobs: a few at once, each in its turn, on the solver's own threads.

mod active;
mod desk;
mod full_queue;
pub(crate) mod leg_cache;
pub(crate) mod leg_import;
mod leg_snapshot;
mod leg_table;
mod memory;
mod metrics;
mod pace;
mod progress;
pub(crate) mod retention;
pub(crate) mod segments;
mod shards;
pub(crate) mod sharing;
pub(crate) mod slews;
mod solve;
mod worker;

pub(crate) use metrics::JobMetrics;
pub(crate) use worker::Worker;

use crate::base::clock::now_us;
use crate::jobs::active::ActiveJobs;
use crate::jobs::desk::Desk;
use crate::jobs::full_queue::FullQueue;
use crate::jobs::leg_cache::LegCache;
use crate::jobs::leg_snapshot::LegsAtOnce;
use crate::jobs::memory::JobMemory;
use crate::jobs::shards::ShardOffer;
use crate::store::{JobRow, Notice, QueueLimits, Store, StoreError, Submission, Submitted};
use slewplan_solver::run::stop::StopSignal;
use std::sync::Arc;
use tokio::runtime::Handle;
use tokio::sync::{Notify, watch};

/// The state that the API and the worker share.
#[derive(Debug, Clone)]
pub(crate) struct Jobs(Arc<SharedJobs>);

#[derive(Debug)]
struct SharedJobs {
    store: Store,
    /// Counts changes of any job; waiting requests look again at each change.
    changes: watch::Sender<u64>,
    /// Notified when a job has been queued.
    queued: Notify,
    active: ActiveJobs,
    desk: Desk,
    queue: QueueLimits,
    full_queue: FullQueue,
    memory: JobMemory,
    /// Whether parts of large tables of legs are offered to other processes.
    spreads_legs: bool,
    metrics: Arc<JobMetrics>,
}

impl Jobs {
    /// Jobs of a store with limits on the queue and on the memory of the jobs of this process, bytes; where
    /// other processes use the store, parts of large tables of legs may be offered to them.
    pub(crate) fn new(store: Store, queue: QueueLimits, memory: u64, spreads_legs: bool) -> Self {
        let spreads_legs = spreads_legs && store.is_shared();
        Self(Arc::new(SharedJobs {
            store,
            changes: watch::Sender::new(0),
            queued: Notify::new(),
            active: ActiveJobs::default(),
            desk: Desk::default(),
            queue,
            full_queue: FullQueue::default(),
            memory: JobMemory::new(memory),
            spreads_legs,
            metrics: Arc::default(),
        }))
    }

    /// The store behind the jobs.
    pub(crate) fn store(&self) -> &Store {
        &self.0.store
    }

    /// The leg cache, for one solve on threads outside of the runtime.
    pub(crate) fn legs(&self, runtime: Handle) -> LegCache {
        LegCache::new(self.store().clone(), runtime, Arc::clone(&self.0.metrics))
    }

    /// Offers parts of the tables of a leased job to other processes, where that is wanted.
    fn shard_offer(&self, lease: &JobRow) -> Option<ShardOffer> {
        let offers = self.0.spreads_legs && lease.parent.is_none();
        offers.then(|| ShardOffer::new(self.clone(), lease.clone()))
    }

    /// The cached legs of one moment, for look-ups on threads outside of the runtime.
    pub(crate) async fn legs_at_once(&self, runtime: Handle) -> Result<LegsAtOnce, StoreError> {
        LegsAtOnce::new(self.store().clone(), runtime, Arc::clone(&self.0.metrics)).await
    }

    /// Metrics of the jobs of this process.
    pub(crate) fn metrics(&self) -> &JobMetrics {
        &self.0.metrics
    }

    /// A receiver that is notified of every change of any job.
    pub(crate) fn changes(&self) -> watch::Receiver<u64> {
        self.0.changes.subscribe()
    }

    /// Tells waiting requests of all processes that a job has changed.
    fn changed(&self) {
        self.wake();
        self.store().tell(Notice::Changed);
    }

    /// Has waiting requests of this process look again.
    fn wake(&self) {
        self.0
            .changes
            .send_modify(|count| *count = count.wrapping_add(1));
    }

    /// Limits on the number of queued jobs.
    pub(crate) fn queue_limits(&self) -> QueueLimits {
        self.0.queue
    }

    /// Memory of the jobs of this process, bytes: what one may need, and all that run together.
    pub(crate) fn memory_limit(&self) -> u64 {
        self.0.memory.limit()
    }

    /// Whether a further job may be queued, as far as can be said without queueing it.
    pub(crate) async fn have_room(&self) -> Result<bool, StoreError> {
        let limit = self.0.queue.all;
        if self.store().has_ample_room(limit) {
            return Ok(true);
        }
        let changes = *self.0.changes.borrow();
        let ask = async || Ok(!self.store().has_room(limit).await?);
        Ok(!self.0.full_queue.is_full(changes, ask).await?)
    }

    /// Queues a job.
    pub(crate) async fn submit(&self, submission: &Submission) -> Result<Submitted, StoreError> {
        let submitted = self
            .store()
            .submit(submission, self.0.queue, now_us())
            .await?;
        if let Submitted::New(_) = submitted {
            self.0.queued.notify_one();
            self.store().tell(Notice::Queued);
            self.changed();
        }
        Ok(submitted)
    }

    /// Asks a running job to finish with its best plan so far.
    pub(crate) async fn stop(&self, id: &str) -> Result<Option<JobRow>, StoreError> {
        let job = self.store().request_stop(id, now_us()).await?;
        self.0.active.request(id, StopSignal::request);
        self.store().tell(Notice::Requested(id.to_owned()));
        Ok(job)
    }

    /// Cancels a job. Its threads are freed even when the request cannot be recorded.
    pub(crate) async fn cancel(&self, id: &str) -> Result<Option<JobRow>, StoreError> {
        self.0.active.request(id, StopSignal::cancel);
        let job = self.store().request_cancel(id, now_us()).await?;
        // The job may have begun in between.
        self.0.active.request(id, StopSignal::cancel);
        self.store().tell(Notice::Requested(id.to_owned()));
        if job.as_ref().is_some_and(|job| job.finished_us.is_some()) {
            // A job that waited for another attempt leaves the segments of the last one.
            tokio::spawn(segments::delete_of_ended_jobs(self.store().clone()));
        }
        self.changed();
        Ok(job)
    }

    /// Deletes a job; a running one is cancelled first.
    pub(crate) async fn delete(&self, id: &str) -> Result<bool, StoreError> {
        let deleted = self.store().delete(id).await?;
        self.0.active.request(id, StopSignal::cancel);
        self.store().tell(Notice::Requested(id.to_owned()));
        self.changed();
        Ok(deleted)
    }

    /// Number of jobs that this process works on.
    pub(crate) fn running_here(&self) -> usize {
        self.0.active.ids().len()
    }
}
