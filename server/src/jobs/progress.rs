//! From the solver's observer, called on any of its threads, to recorded events.

use super::Jobs;
use crate::base::clock::now_us;
use crate::base::contradictions;
use crate::documents;
use crate::jobs::leg_cache::Unwritten;
use crate::store::{JobRow, NewIncumbent, PackedPlan, ProgressRow};
use slewplan_solver::model::plan::Plan;
use slewplan_solver::model::problem::Problem;
use slewplan_solver::run::contradiction::Contradiction;
use slewplan_solver::run::progress::{Observer, Progress};
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::watch;

/// Time between two recorded events of a job: what comes faster is dropped except for the newest.
const PAUSE: Duration = Duration::from_millis(100);

/// The newest of a solve.
#[derive(Debug, Clone, Default)]
pub(super) struct Report {
    progress: Option<Progress>,
    incumbent: Option<Arc<NewIncumbent>>,
}

/// Keeps the newest progress and plan for the recorder; never waits.
pub(super) struct Reporter(watch::Sender<Report>);

impl Reporter {
    /// A reporter and where its reports arrive.
    pub(super) fn new() -> (Self, watch::Receiver<Report>) {
        let (sender, receiver) = watch::channel(Report::default());
        (Self(sender), receiver)
    }

    /// The observer of the solve of a scenario about which there are doubts.
    pub(super) fn observer<'a>(&'a self, doubts: &'a [Problem]) -> impl Observer + use<'a> {
        Watch {
            reports: &self.0,
            doubts,
        }
    }
}

struct Watch<'a> {
    reports: &'a watch::Sender<Report>,
    doubts: &'a [Problem],
}

impl Observer for Watch<'_> {
    fn progress(&self, progress: Progress) {
        self.reports
            .send_modify(|report| report.progress = Some(progress));
    }

    fn incumbent(&self, plan: &Plan) {
        let document = match serde_json::to_vec(&documents::plan::plan(plan, self.doubts)) {
            Ok(document) => PackedPlan::of(&document),
            Err(error) => return tracing::error!(%error, "the best plan so far cannot be written"),
        };
        let incumbent = Arc::new(NewIncumbent {
            document,
            total_time_s: plan.total_time_s,
            lower_bound_s: plan.lower_bound_s,
        });
        // The progress that tells of it wakes the recorder: both are recorded together.
        self.reports.send_if_modified(|report| {
            report.incumbent = Some(incumbent);
            false
        });
    }

    fn contradicted(&self, contradiction: &Contradiction) {
        contradictions::record(contradiction);
    }
}

/// Records reports until the reporter is dropped or the lease is lost. The legs that a report rests
/// on are written before it: whoever takes the job over does not solve them again.
pub(super) async fn record(
    jobs: Jobs,
    lease: JobRow,
    legs: Unwritten,
    mut reports: watch::Receiver<Report>,
) {
    let mut recorded = None;
    let mut kept: Option<Arc<NewIncumbent>> = None;
    loop {
        let open = reports.changed().await.is_ok();
        let Report {
            progress,
            incumbent,
        } = reports.borrow_and_update().clone();
        let newest = progress.as_ref().map(row);
        if let Some(progress) = newest.filter(|row| recorded.as_ref() != Some(row)) {
            legs.write().await;
            // Written once, and again after a failure.
            let fresh =
                incumbent.filter(|plan| !kept.as_ref().is_some_and(|k| Arc::ptr_eq(k, plan)));
            let written = jobs
                .store()
                .progress(&lease, &progress, fresh.as_deref(), now_us());
            match written.await {
                Ok(true) => {
                    kept = fresh.or(kept);
                    jobs.changed();
                }
                Ok(false) => return,
                Err(error) => tracing::warn!(job_id = lease.id, %error, "progress not recorded"),
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
        stage: progress.stage.into(),
        done: count(progress.done),
        total: progress.total.map(count),
        incumbent_s: seconds(progress.incumbent_s),
        lower_bound_s: seconds(progress.lower_bound_s),
    }
}
