//! Metrics of the jobs that this process has worked on, and of the legs that it looked up.

use crate::base::metrics::{Scrape, counter, histogram};
use crate::store::{EndCode, Ended, JobRow, JobState};
use prometheus::{HistogramVec, IntCounter, IntCounterVec};

/// Upper ends of the buckets of times, s.
const TIMES_S: [f64; 9] = [0.01, 0.1, 0.5, 1.0, 5.0, 15.0, 60.0, 300.0, 3600.0];
/// Upper ends of the buckets of relative gaps.
const GAPS: [f64; 7] = [0.0, 1e-4, 1e-3, 1e-2, 0.05, 0.1, 0.5];
const NO_LABELS: [&str; 0] = [];

/// Waits, solves, gaps, failures and look-ups since the process started.
#[derive(Debug)]
pub(crate) struct JobMetrics {
    waits: HistogramVec,
    solves: HistogramVec,
    gaps: HistogramVec,
    /// Ends without a plan, by their cause.
    failures: IntCounterVec,
    leg_lookups: IntCounterVec,
    legs_solved: IntCounter,
}

impl Default for JobMetrics {
    fn default() -> Self {
        let waits = "Time from submission to begin.";
        let solves = "Time from begin to end of a job.";
        let gaps = "Relative gap of plans at their end.";
        let metrics = Self {
            waits: histogram("slewplan_queue_wait_seconds", waits, &[], &TIMES_S),
            solves: histogram("slewplan_solve_seconds", solves, &[], &TIMES_S),
            gaps: histogram("slewplan_gap_at_end", gaps, &[], &GAPS),
            failures: counter(
                "slewplan_jobs_without_plan_total",
                "Jobs that ended without a plan, by the first cause.",
                &["cause"],
            ),
            legs_solved: IntCounter::new(
                "slewplan_legs_solved_total",
                "Legs that were solved, or proved again, and given to the cache.",
            )
            .expect("a valid metric"),
            leg_lookups: counter(
                "slewplan_leg_lookups_total",
                "Legs that the solver looked up.",
                &["outcome"],
            ),
        };
        // A series is reported from its first use on; these shall begin at zero.
        for histogram in [&metrics.waits, &metrics.solves, &metrics.gaps] {
            histogram.with_label_values(&NO_LABELS);
        }
        for outcome in ["hit", "miss"] {
            metrics.leg_lookups.with_label_values(&[outcome]);
        }
        metrics
    }
}

impl JobMetrics {
    /// Counts the begin of a job's first attempt.
    pub(super) fn begun(&self, job: &JobRow) {
        if let (1, Some(started), None) = (job.attempt, job.started_us, job.parent) {
            let wait_us = started - job.submitted_us;
            self.waits
                .with_label_values(&NO_LABELS)
                .observe(wait_us as f64 / 1e6);
        }
    }

    /// Counts the end of a job, some time after its begin, s.
    pub(super) fn ended(&self, ended: &Ended, solved_s: f64) {
        self.solves.with_label_values(&NO_LABELS).observe(solved_s);
        if let (Some(total), Some(bound)) = (ended.incumbent_s, ended.lower_bound_s) {
            let gap = ((total - bound) / total).max(0.0);
            self.gaps.with_label_values(&NO_LABELS).observe(gap);
        }
        if matches!(ended.state, JobState::Failed | JobState::Infeasible) {
            let cause = ended.code.map_or("unknown", EndCode::as_str);
            self.failures.with_label_values(&[cause]).inc();
        }
    }

    /// Counts look-ups of legs by what they found.
    pub(super) fn looked_up<T>(&self, legs: &[Option<T>]) {
        let found = legs.iter().flatten().count();
        for (outcome, count) in [("hit", found), ("miss", legs.len() - found)] {
            let series = self.leg_lookups.with_label_values(&[outcome]);
            series.inc_by(count as u64);
        }
    }

    /// Counts a solved leg.
    pub(super) fn leg_solved(&self) {
        self.legs_solved.inc();
    }

    /// Adds them to a scrape.
    pub(crate) fn report(&self, scrape: &Scrape) {
        for histogram in [&self.waits, &self.solves, &self.gaps] {
            scrape.add(histogram);
        }
        scrape.add(&self.failures);
        scrape.add(&self.leg_lookups);
        scrape.add(&self.legs_solved);
    }
}
