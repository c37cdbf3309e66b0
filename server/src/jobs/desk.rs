//! What a process has to tell the database of its jobs, collected for one transaction.
//!
//! Ends wait here until the next claim, which takes them along: a thread that has ended its job looks for
//! another at once. While jobs are tiny and many wait, a few are claimed ahead, and lie here until a thread
//! is free. A job that turns out not to be tiny takes all of it along when its begin is stored: ends are not
//! held back, and no worker sits on jobs that another could begin.

use super::Jobs;
use super::memory::MemoryGuard;
use super::pace::Pace;
use super::segments;
use super::worker::{PASSED_OVER, lease_end, microseconds};
use crate::base::clock::now_us;
use crate::store::{
    Claim, Exchange, Exchanged, JobEnd, JobRow, JobState, Lease, MemoryRoom, NewLeg, Notice,
    StoreError,
};
use slewplan_solver::run::stop::StopSignal;
use std::collections::VecDeque;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// A job that has ended here.
#[derive(Debug)]
pub(super) struct EndedJob {
    /// What is to be stored.
    pub(super) end: JobEnd,
    /// Legs of its solve that are not stored yet.
    pub(super) legs: Vec<NewLeg>,
    /// Time of the solve, s.
    pub(super) solved_s: f64,
    /// Whether it has left segments that are to be deleted.
    pub(super) leaves_segments: bool,
}

/// A job that a thread begins.
#[derive(Debug)]
pub(super) struct BegunJob {
    /// The claim.
    pub(super) lease: Lease,
    /// Its memory.
    pub(super) memory: MemoryGuard,
    /// Whether its begin is stored.
    pub(super) is_stored: bool,
}

/// Ends that are not stored yet, and jobs that are claimed ahead.
#[derive(Debug, Default)]
pub(super) struct Desk(Mutex<Papers>);

#[derive(Debug, Default)]
struct Papers {
    ends: Vec<EndedJob>,
    claimed: VecDeque<Lease>,
    pace: Pace,
}

impl Desk {
    fn papers(&self) -> MutexGuard<'_, Papers> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes the end of a job, to be stored with the next exchange.
    pub(super) fn put(&self, end: EndedJob) {
        let mut papers = self.papers();
        // A cancelled job does not say how long jobs take.
        if end.end.ended.state != JobState::Cancelled {
            papers.pace.ended(end.solved_s);
        }
        papers.ends.push(end);
    }

    /// Takes a claimed job back that was to begin, and has not been worked on.
    pub(super) fn put_back(&self, lease: Lease) {
        self.papers().claimed.push_front(lease);
    }
}

/// What a job may need of the memory, bytes.
fn needed(lease: &Lease) -> u64 {
    lease.memory_bytes.try_into().unwrap_or(0)
}

impl Jobs {
    /// Begins the next job that has room beside the running ones: one that was claimed ahead, or else one of
    /// the queue, whose claim takes all ends along.
    pub(super) async fn next(&self, boot_id: &str) -> Result<Option<BegunJob>, StoreError> {
        // Two that look at the same time could both find all memory free.
        let _alone = self.0.memory.admission().await;
        if let Some(begun) = self.begin_claimed()? {
            return Ok(Some(begun));
        }
        let desk = &self.0.desk;
        let (at_most, begins_later) = {
            let pace = &desk.papers().pace;
            (pace.claim(), pace.is_fast())
        };
        let room = self
            .0
            .memory
            .free()
            .map_or(MemoryRoom::ALL, |bytes| MemoryRoom {
                bytes: bytes.try_into().unwrap_or(i64::MAX),
                passed_over_since_us: now_us().saturating_sub(microseconds(PASSED_OVER)),
            });
        let claim = Claim {
            boot_id,
            lease_until_us: lease_end(self.store().lease_clock_us()),
            room,
            takes_shards: self.0.memory.free().is_none(),
            at_most,
            begins_later,
        };
        let mut leases = VecDeque::from(self.exchange(&[], Some(claim)).await?.leases);
        let first = leases.pop_front().map(|lease| self.begun(lease));
        desk.papers().claimed.extend(leases);
        let Some(first) = first.transpose()? else {
            return Ok(None);
        };
        if first.is_stored {
            self.changed();
        }
        Ok(Some(first))
    }

    /// Begins the first job that was claimed ahead, if it has room.
    fn begin_claimed(&self) -> Result<Option<BegunJob>, StoreError> {
        let lease = {
            let mut papers = self.0.desk.papers();
            let has_room = |lease: &Lease| {
                self.0
                    .memory
                    .free()
                    .is_none_or(|free| needed(lease) <= free)
            };
            if !papers.claimed.front().is_some_and(has_room) {
                return Ok(None);
            }
            papers.claimed.pop_front()
        };
        lease.map(|lease| self.begun(lease)).transpose()
    }

    /// Takes the memory of a claimed job.
    fn begun(&self, lease: Lease) -> Result<BegunJob, StoreError> {
        Ok(BegunJob {
            is_stored: lease.has_begun()?,
            memory: self.0.memory.admit(needed(&lease)),
            lease,
        })
    }

    /// Stores that a job has begun which turns out to take its time, and gives back what was claimed ahead;
    /// `false` when its lease has been lost.
    pub(super) async fn store_begin(&self, begun: &JobRow) -> Result<bool, StoreError> {
        self.0.desk.papers().pace.slow();
        let exchanged = self.exchange(std::slice::from_ref(begun), None).await?;
        Ok(exchanged.lost_begins.is_empty())
    }

    /// Stores all ends, and gives back what was claimed ahead.
    pub(super) async fn clear_desk(&self) -> Result<(), StoreError> {
        let is_clear = {
            let papers = self.0.desk.papers();
            papers.ends.is_empty() && papers.claimed.is_empty()
        };
        if !is_clear {
            self.exchange(&[], None).await?;
        }
        Ok(())
    }

    /// Stores what is on the desk. Jobs that were claimed ahead are given back: who claims has none left that
    /// it could begin.
    async fn exchange(
        &self,
        begun: &[JobRow],
        claim: Option<Claim<'_>>,
    ) -> Result<Exchanged, StoreError> {
        let desk = &self.0.desk;
        let (ends, returned) = {
            let mut papers = desk.papers();
            let ends = std::mem::take(&mut papers.ends);
            (ends, std::mem::take(&mut papers.claimed))
        };
        let stored: Vec<JobEnd> = ends.iter().map(|ended| ended.end.clone()).collect();
        let legs: Vec<NewLeg> = ends.iter().flat_map(|ended| ended.legs.clone()).collect();
        let given_back: Vec<JobRow> = returned.iter().map(|lease| lease.job.clone()).collect();
        let exchange = Exchange {
            ends: &stored,
            legs: &legs,
            begun,
            returned: &given_back,
            claim,
        };
        let exchanged = match self.store().exchange(&exchange, now_us()).await {
            Ok(exchanged) => exchanged,
            Err(error) => {
                self.keep(ends, returned, &error);
                return Err(error);
            }
        };
        if claim.is_some() {
            desk.papers().pace.left(exchanged.waiting);
        }
        let others_could_begin =
            exchanged.leases.len() > 1 || (exchanged.waiting > 0 && !exchanged.leases.is_empty());
        if others_could_begin || !given_back.is_empty() {
            self.0.queued.notify_one();
        }
        if !given_back.is_empty() {
            self.store().tell(Notice::Queued);
        }
        if !(ends.is_empty() && begun.is_empty()) {
            self.changed();
        }
        self.tell_ends(ends, &exchanged.lost_ends);
        Ok(exchanged)
    }

    /// Puts back what could not be stored.
    fn keep(&self, mut ends: Vec<EndedJob>, returned: VecDeque<Lease>, error: &StoreError) {
        if !error.is_away() {
            // Not an error of the jobs: a lost leg is solved again.
            for ended in &mut ends {
                ended.legs.clear();
            }
        }
        let mut papers = self.0.desk.papers();
        ends.append(&mut papers.ends);
        papers.ends = ends;
        papers.claimed.extend(returned);
    }

    /// Counts and logs jobs that have ended.
    fn tell_ends(&self, ends: Vec<EndedJob>, lost: &[i64]) {
        let mut leaves_segments = false;
        for EndedJob {
            end,
            solved_s,
            leaves_segments: leaves,
            ..
        } in ends
        {
            let job_id = &end.lease.id;
            if lost.contains(&end.lease.sequence) {
                tracing::warn!(
                    job_id,
                    "the job was deleted or taken over; its end is not recorded"
                );
            } else {
                tracing::info!(job_id, state = end.ended.state.into_str(), "solve ended");
            }
            self.metrics().ended(&end.ended, solved_s);
            leaves_segments |= leaves;
        }
        if leaves_segments {
            tokio::spawn(segments::delete_of_ended_jobs(self.store().clone()));
        }
    }

    /// Registers a job whose solve begins, and applies the requests on it.
    pub(super) async fn begin_active(&self, job: &JobRow, stop: &StopSignal) {
        let requested = self.0.active.begin(&job.id, job.fence, stop);
        if requested || job.stop_requested_us.is_some() || job.cancel_requested_us.is_some() {
            self.apply_requests(&job.id).await;
        }
    }
}
