//! Records what the solver's observer reports from any of its threads as events of the job.

use super::Jobs;
use super::pace::TINY;
use crate::base::clock::now_us;
use crate::base::contradictions;
use crate::documents;
use crate::jobs::leg_cache::Unwritten;
use crate::store::{JobRow, NewIncumbent, PackedPlan, ProgressRow};
use slewplan_solver::model::plan::Plan;
use slewplan_solver::model::problem::Problem;
use slewplan_solver::run::contradiction::Contradiction;
use slewplan_solver::run::progress::{Observer, Progress};
use slewplan_solver::run::stop::StopSignal;
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::watch;

/// Minimum time between two recorded events of a job; of reports in between only the newest is
/// recorded.
const PAUSE: Duration = Duration::from_millis(100);

/// The newest progress and incumbent of a solve.
#[derive(Debug, Clone, Default)]
pub(super) struct ProgressReport {
    progress: Option<Progress>,
    incumbent: Option<Arc<FoundPlan>>,
}

/// The best plan so far, and the warnings of its scenario.
#[derive(Debug)]
struct FoundPlan {
    plan: Plan,
    doubts: Arc<[Problem]>,
}

impl FoundPlan {
    /// The plan as it is stored; `None` if it cannot be written.
    fn packed(&self) -> Option<NewIncumbent> {
        let plan = &self.plan;
        let document = serde_json::to_vec(&documents::plan::plan(plan, &self.doubts));
        let document = document
            .inspect_err(|error| tracing::error!(%error, "the best plan so far cannot be written"));
        Some(NewIncumbent {
            document: PackedPlan::of(&document.ok()?),
            total_time_s: plan.total_time_s,
            lower_bound_s: plan.lower_bound_s,
            value: plan.schedule.as_ref().map(|schedule| schedule.value),
            keep_out_violated: plan.margins.violates_cones(),
        })
    }
}

/// Holds the newest progress and plan for the recorder; never blocks.
pub(super) struct Reporter(watch::Sender<ProgressReport>);

impl Reporter {
    /// A reporter, and the receiver of its reports.
    pub(super) fn new() -> (Self, watch::Receiver<ProgressReport>) {
        let (sender, receiver) = watch::channel(ProgressReport::default());
        (Self(sender), receiver)
    }

    /// The observer of a solve; `doubts` are the warnings of its scenario.
    pub(super) fn observer<'a>(&'a self, doubts: &[Problem]) -> impl Observer + use<'a> {
        ReportingObserver {
            reports: &self.0,
            doubts: doubts.into(),
        }
    }
}

struct ReportingObserver<'a> {
    reports: &'a watch::Sender<ProgressReport>,
    doubts: Arc<[Problem]>,
}

impl Observer for ReportingObserver<'_> {
    fn progress(&self, progress: Progress) {
        self.reports
            .send_modify(|report| report.progress = Some(progress));
    }

    fn incumbent(&self, plan: &Plan) {
        // Packed when it is stored: of plans that follow one another quickly only the last one is.
        let incumbent = Arc::new(FoundPlan {
            plan: plan.clone(),
            doubts: Arc::clone(&self.doubts),
        });
        // The next progress wakes the recorder, which records both together.
        self.reports.send_if_modified(|report| {
            report.incumbent = Some(incumbent);
            false
        });
    }

    fn contradicted(&self, contradiction: &Contradiction) {
        contradictions::record(contradiction);
    }
}

/// What the recorder leaves to be stored with the end of the job.
#[derive(Debug)]
pub(super) struct Recorded {
    /// Whether the begin of the job is stored.
    pub(super) begin_is_stored: bool,
    /// How the job stood last, if that is not stored.
    pub(super) progress: Option<ProgressRow>,
}

/// Records the begin of a job, unless that is stored, when it turns out to take its time, and its reports
/// until the reporter is dropped or the lease is lost; the lease is the job at its begin.
pub(super) async fn record(
    jobs: Jobs,
    lease: JobRow,
    mut begin_is_stored: bool,
    legs: Unwritten,
    stop: StopSignal,
    reports: watch::Receiver<ProgressReport>,
) -> Recorded {
    while !begin_is_stored {
        if ends_within(TINY, &reports).await {
            let progress = reports.borrow().progress.as_ref().map(row);
            return Recorded {
                begin_is_stored,
                progress,
            };
        }
        match jobs.store_begin(&lease).await {
            Ok(true) => begin_is_stored = true,
            Ok(false) => {
                stop.cancel();
                break;
            }
            Err(error) => {
                tracing::warn!(job_id = lease.id, %error, "the begin of a job is not recorded yet");
                tokio::time::sleep(PAUSE).await;
            }
        }
    }
    record_reports(jobs, lease, legs, reports).await;
    Recorded {
        begin_is_stored,
        progress: None,
    }
}

/// Whether the reporter is dropped within a time. Returns at once when it is, because the end of the job
/// waits for this.
async fn ends_within(time: Duration, reports: &watch::Receiver<ProgressReport>) -> bool {
    let mut reports = reports.clone();
    tokio::time::timeout(time, reports.wait_for(|_| false))
        .await
        .is_ok()
}

/// Records reports until the reporter is dropped or the lease is lost. The legs that a report rests
/// on are stored before it, so that another attempt does not solve them again.
async fn record_reports(
    jobs: Jobs,
    lease: JobRow,
    legs: Unwritten,
    mut reports: watch::Receiver<ProgressReport>,
) {
    let mut recorded = None;
    let mut kept: Option<Arc<FoundPlan>> = None;
    loop {
        let open = reports.changed().await.is_ok();
        let ProgressReport {
            progress,
            incumbent,
        } = reports.borrow_and_update().clone();
        let newest = progress.as_ref().map(row);
        if let Some(progress) = newest.filter(|row| recorded.as_ref() != Some(row)) {
            legs.write().await;
            // Stored once, and again after a failure.
            let fresh =
                incumbent.filter(|plan| !kept.as_ref().is_some_and(|k| Arc::ptr_eq(k, plan)));
            let packed = match &fresh {
                Some(found) => packed(Arc::clone(found)).await,
                None => None,
            };
            let written = jobs
                .store()
                .progress(&lease, &progress, packed.as_ref(), now_us());
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
        ends_within(PAUSE, &reports).await;
    }
}

/// Packs a plan beside the threads of the runtime.
async fn packed(found: Arc<FoundPlan>) -> Option<NewIncumbent> {
    let packed = tokio::task::spawn_blocking(move || found.packed()).await;
    packed.ok().flatten()
}

fn row(progress: &Progress) -> ProgressRow {
    let count = |value| i64::try_from(value).unwrap_or(i64::MAX);
    let finite = |value: Option<f64>| value.filter(|value| value.is_finite());
    ProgressRow {
        stage: progress.stage.into(),
        done: count(progress.done),
        total: progress.total.map(count),
        incumbent_s: finite(progress.incumbent_s),
        lower_bound_s: finite(progress.lower_bound_s),
        value: finite(progress.value),
        value_bound: finite(progress.value_bound),
    }
}
