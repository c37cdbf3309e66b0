//! From the solver's observer, called on any of its threads, to recorded events.

use super::Jobs;
use crate::clock::now_us;
use crate::store::{JobRow, ProgressRow};
use slewplan_solver::progress::{Observer, Progress};
use std::time::Duration;
use tokio::sync::watch;

/// Time between two recorded events of a job: what comes faster is dropped except for the newest.
const PAUSE: Duration = Duration::from_millis(100);

/// Keeps the newest progress for the recorder; never waits.
pub(super) struct Reporter(watch::Sender<Option<Progress>>);

impl Reporter {
    /// A reporter and where its reports arrive.
    pub(super) fn new() -> (Self, watch::Receiver<Option<Progress>>) {
        let (sender, receiver) = watch::channel(None);
        (Self(sender), receiver)
    }
}

impl Observer for Reporter {
    fn progress(&self, progress: Progress) {
        self.0.send_replace(Some(progress));
    }
}

/// Records reports until the reporter is dropped or the claim is lost.
pub(super) async fn record(
    jobs: Jobs,
    claim: JobRow,
    mut reports: watch::Receiver<Option<Progress>>,
) {
    let mut recorded = None;
    loop {
        let open = reports.changed().await.is_ok();
        let newest = reports.borrow_and_update().as_ref().map(row);
        if let Some(progress) = newest.filter(|row| recorded.as_ref() != Some(row)) {
            match jobs.store().progress(&claim, &progress, now_us()).await {
                Ok(true) => jobs.changed(),
                Ok(false) => return,
                Err(error) => tracing::warn!(job_id = claim.id, %error, "progress not recorded"),
            }
            recorded = Some(progress);
        }
        if !open {
            return;
        }
        // Cut short when the reporter is gone: the end of the job waits for this.
        let _ = tokio::time::timeout(PAUSE, reports.clone().wait_for(|_| false)).await;
    }
}

fn row(progress: &Progress) -> ProgressRow {
    let count = |value| i64::try_from(value).unwrap_or(i64::MAX);
    let seconds = |value: Option<f64>| value.filter(|value| value.is_finite());
    ProgressRow {
        stage: progress.stage.as_str(),
        done: count(progress.done),
        total: progress.total.map(count),
        incumbent_s: seconds(progress.incumbent_s),
        lower_bound_s: seconds(progress.lower_bound_s),
    }
}
