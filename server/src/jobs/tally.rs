//! What is known about the jobs that this process has worked on.

use crate::base::metrics::{Histogram, head, sample};
use crate::store::{EndCode, Ended, JobRow, JobState};
use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Upper ends of the classes of times, s.
const TIMES: [f64; 9] = [0.01, 0.1, 0.5, 1.0, 5.0, 15.0, 60.0, 300.0, 3600.0];
/// Upper ends of the classes of relative gaps.
const GAPS: [f64; 7] = [0.0, 1e-4, 1e-3, 1e-2, 0.05, 0.1, 0.5];

/// Waits, solves, gaps and failures since the start.
#[derive(Debug)]
pub(crate) struct JobTally(Mutex<Counts>);

#[derive(Debug)]
struct Counts {
    waits: Histogram,
    solves: Histogram,
    gaps: Histogram,
    /// Ends without a plan, by their cause.
    failures: BTreeMap<&'static str, u64>,
}

impl Default for JobTally {
    fn default() -> Self {
        Self(Mutex::new(Counts {
            waits: Histogram::new(&TIMES),
            solves: Histogram::new(&TIMES),
            gaps: Histogram::new(&GAPS),
            failures: BTreeMap::new(),
        }))
    }
}

impl JobTally {
    fn lock(&self) -> MutexGuard<'_, Counts> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Counts the begin of a job's first attempt.
    pub(super) fn begun(&self, job: &JobRow) {
        if let (1, Some(started)) = (job.attempt, job.started_us) {
            let wait_us = started - job.submitted_us;
            self.lock().waits.count(wait_us as f64 / 1e6);
        }
    }

    /// Counts the end of a job, some time after its begin, s.
    pub(super) fn ended(&self, ended: &Ended, solved_s: f64) {
        let mut counts = self.lock();
        counts.solves.count(solved_s);
        if let (Some(total), Some(bound)) = (ended.incumbent_s, ended.lower_bound_s) {
            counts.gaps.count(((total - bound) / total).max(0.0));
        }
        if matches!(ended.state, JobState::Failed | JobState::Infeasible) {
            let cause = ended.code.map_or("unknown", EndCode::as_str);
            *counts.failures.entry(cause).or_default() += 1;
        }
    }

    /// Writes everything in the text form of Prometheus.
    pub(crate) fn write(&self, text: &mut String) {
        let counts = self.lock();
        let histograms = [
            (
                "slewplan_queue_wait_seconds",
                "Time from submission to begin.",
                &counts.waits,
            ),
            (
                "slewplan_solve_seconds",
                "Time from begin to end of a job.",
                &counts.solves,
            ),
            (
                "slewplan_gap_at_end",
                "Relative gap of plans at their end.",
                &counts.gaps,
            ),
        ];
        for (name, help, histogram) in histograms {
            head(text, name, "histogram", help);
            histogram.write(text, name, "");
        }
        let name = "slewplan_jobs_without_plan_total";
        head(
            text,
            name,
            "counter",
            "Jobs that ended without a plan, by the first cause.",
        );
        for (cause, count) in &counts.failures {
            sample(text, name, &format!("cause=\"{cause}\""), count);
        }
    }
}
