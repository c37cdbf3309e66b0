//! Several processes on one database: notices of what others did, and jobs of those that died.

use super::Jobs;
use super::worker::LEASE;
use crate::base::clock::now_us;
use crate::store::{Notice, OtherProcesses};
use slewplan_solver::run::stop::StopSignal;
use std::time::Duration;
use tokio::time::Instant;

/// Interval between two looks for expired leases, half of their duration, and at what waits.
const ROUND: Duration = Duration::from_secs(5);
/// Time between two rounds after which the database must have been away.
const AWAY: Duration = Duration::from_secs(7);
/// Between a look that finds an expired lease and the end of its process's claim: when the database could only be
/// read for a while, its process prolongs the lease in this time.
const DOUBT: Duration = Duration::from_secs(1);

impl Jobs {
    /// Begins to follow what other processes do to the jobs; nothing where there are none.
    pub(crate) fn follow_others(&self, boot_id: String) {
        if !self.store().is_shared() {
            return;
        }
        let jobs = self.clone();
        tokio::spawn(async move {
            let heard = jobs.clone();
            let store = jobs.store().clone();
            store.listen(move |notice| heard.heed(notice)).await;
        });
        tokio::spawn(take_over(self.clone(), boot_id));
    }

    fn heed(&self, notice: Notice) {
        match notice {
            Notice::Queued => self.0.queued.notify_one(),
            Notice::Changed => self.wake(),
            Notice::Requested(id) => {
                // Remembered, in case the job begins here a moment later.
                self.0.active.request(&id, |_| {});
                self.apply_requests_soon(id);
            }
            Notice::Keys => {}
            Notice::Missed => {
                self.0.queued.notify_one();
                self.wake();
                for id in self.0.active.ids() {
                    self.apply_requests_soon(id);
                }
            }
        }
    }

    fn apply_requests_soon(&self, id: String) {
        if self.0.active.ids().contains(&id) {
            let jobs = self.clone();
            tokio::spawn(async move { jobs.apply_requests(&id).await });
        }
    }

    /// Applies the recorded requests on a job to its solve, if it runs in this process.
    pub(super) async fn apply_requests(&self, id: &str) {
        match self.store().job(id).await {
            Ok(Some(job)) => {
                if job.stop_requested_us.is_some() {
                    self.0.active.request(id, StopSignal::request);
                }
                if job.cancel_requested_us.is_some() {
                    self.0.active.request(id, StopSignal::cancel);
                }
            }
            Ok(None) => self.0.active.request(id, StopSignal::cancel),
            Err(error) => tracing::warn!(job_id = id, %error, "requests cannot be read"),
        }
    }
}

/// Takes jobs from processes that no longer prolong their leases, without end. When the database was
/// away or could only be read, nobody could prolong them: the others get the time of a lease to do so.
async fn take_over(jobs: Jobs, boot_id: String) {
    let (mut last, mut patient_until) = (Instant::now(), Instant::now());
    loop {
        tokio::time::sleep(ROUND).await;
        // What a lost notice said is found now.
        jobs.wake();
        let store = jobs.store();
        let standing = match store.compare_clocks().await {
            Ok(standing) => standing,
            Err(error) => {
                tracing::warn!(%error, "the clock of the database cannot be read");
                continue;
            }
        };
        if standing.jobs_wait {
            jobs.0.queued.notify_one();
        }
        if last.elapsed() > AWAY {
            patient_until = Instant::now() + LEASE;
        }
        last = Instant::now();
        if last < patient_until {
            if store.check_writable(now_us()).await.is_err() {
                patient_until = Instant::now() + LEASE;
            }
            continue;
        }
        if !standing.leases_expired {
            continue;
        }
        tokio::time::sleep(DOUBT).await;
        let lease_now_us = store.lease_clock_us();
        let recovered = store.recover(&boot_id, OtherProcesses::MayLive, lease_now_us);
        match recovered.await {
            Ok(recovered) if recovered.is_empty() => {}
            Ok(recovered) => {
                tracing::warn!(?recovered, "leases of other processes have expired");
                jobs.0.queued.notify_one();
                store.tell(Notice::Queued);
                jobs.changed();
            }
            Err(error) => {
                tracing::warn!(%error, "expired leases cannot be looked for");
                patient_until = Instant::now() + LEASE;
            }
        }
    }
}
